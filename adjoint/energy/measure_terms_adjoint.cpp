// SPDX-License-Identifier: MIT
#include "adjoint/energy/measure_terms_adjoint.hpp"

#include <tuple>

#include "adjoint/measure/measure_tangent.hpp"
#include "core/energy/measure_terms.hpp"

namespace fettle::adjoint::energy {
namespace {

using core::energy::LawValue;
using core::kinematics::Pose;
using core::measure::Measure;
using core::measure::PlacedFrame;
using core::measure::VectorFunction;
using core::model::LawKind;
using core::model::MeasureTerm;
using core::model::Mechanism;

bool looks_back(const MeasureTerm& term) { return term.kind == LawKind::damper || term.kind == LawKind::friction; }

// Frames with the poses of the end or of the start.
struct Placed {
    const std::vector<Pose>& poses;
    std::vector<PlacedFrame> frames;
    std::vector<Matrix3> rotations;
    Placed(const Mechanism& mechanism, const std::vector<Pose>& at) : poses(at), frames(placed(mechanism.set.frames, at)) {
        for (const core::measure::Frame& f : mechanism.set.frames)
            rotations.push_back(f.body == core::measure::world ? Matrix3(Matrix3::Identity()) : at[f.body].rotation);
    }
};

// What m_slip is made of, besides m(P0).
enum class Slip { start, bdf2, newmark };

Slip slip_of(const StepEnd& at) {
    const core::model::Model& model = *at.problem.model;
    if (model.integrator == core::scene::Integrator::newmark) return Slip::newmark;
    const bool has_two_steps = model.integrator == core::scene::Integrator::bdf2 && at.problem.slip_time < model.timestep;
    return has_two_steps ? Slip::bdf2 : Slip::start;
}

// P_-1 of BDF2, from P_slip = (4 P0 - P_-1)/3.
std::vector<Pose> poses_before(const StepEnd& at) {
    std::vector<Pose> out;
    if (slip_of(at) != Slip::bdf2) return out;
    for (std::size_t i = 0; i < at.poses.size(); ++i) {
        const Matrix34 before = 4 * pose_matrix(at.problem.poses_t0[i]) - 3 * at.problem.slip_reference[i];
        out.push_back({before.leftCols<3>(), before.col(3)});
    }
    return out;
}

// P_slip - P0.
std::vector<Matrix34> slips(const StepEnd& at) {
    std::vector<Matrix34> out;
    for (std::size_t i = 0; i < at.poses.size(); ++i) out.push_back(at.problem.slip_reference[i] - pose_matrix(at.problem.poses_t0[i]));
    return out;
}

Errors check_measure_terms(const core::model::Model&) { return {}; }

double measure_at(const StepEnd& at, int measure, const Placed& where) {
    return core::constraint::value_at(at.problem.model->mechanism.set, measure, where.frames, at.problem.mechanism.angles);
}

class ReverseTerms {
public:
    ReverseTerms(const StepEnd& at, StepGradient& step_bar, std::vector<ModelGradient>& model_bar)
        : at_(at),
          mechanism_(at.problem.model->mechanism),
          end_(mechanism_, at.poses),
          start_(mechanism_, at.problem.poses_t0),
          poses_before_(poses_before(at)),
          slips_(slips(at)),
          step_bar_(step_bar),
          model_bar_(model_bar) {}

    void subtract(std::size_t k, const std::vector<std::vector<Vector6>>& motion) {
        const MeasureTerm& term = mechanism_.terms[k];
        const Measure& m = mechanism_.set.measures[term.measure];
        const VectorFunction f = vector_function(m, end_.frames);
        const core::measure::PoseGradients g = pose_gradients(m, f, end_.frames);
        const LawValue law = core::energy::measure_law(at_.problem, term, measure_at(at_, term.measure, end_));
        const int a = mechanism_.set.frames[m.a].body, b = mechanism_.set.frames[m.b].body;
        for (std::size_t s = 0; s < motion.size(); ++s) {
            Vector12 v = Vector12::Zero();
            if (a != core::measure::world) v.head<6>() = motion[s][a];
            if (b != core::measure::world) v.tail<6>() = motion[s][b];
            const double change = tangent_gradient(g.a).dot(v.head<6>()) + tangent_gradient(g.b).dot(v.tail<6>());
            MechanismGradient& bar = model_bar_[s].mechanism;
            add_placement_gradient(f, -law.second * change, end_.rotations, bar.frames);
            add_placement_gradient_of_change(m, f, -law.first, {end_.frames, end_.rotations}, v, bar.frames);
            bar.term_coefficient[k] -= law.first / term.coefficient * change;
            if (looks_back(term))
                add_slip(m, law.second * change, s);
            else
                bar.term_reference[k] += term.kind == LawKind::force ? 0 : law.second * change;
            if (term.kind == LawKind::force) subtract_curve(k, change, bar);
        }
    }

private:
    // g' of a force is -weight coefficient f.
    void subtract_curve(std::size_t k, double change, MechanismGradient& bar) const {
        const MeasureTerm& term = mechanism_.terms[k];
        const std::vector<double> weights = core::scene::curve_weights(term.curve, at_.problem.mechanism.end_time);
        const double along = at_.problem.weight * term.coefficient * change;
        for (std::size_t i = 0; i < weights.size(); ++i) bar.term_values[k][i] += along * weights[i];
        bar.term_rate[k] += along * core::scene::curve_running_time(term.curve, at_.problem.mechanism.end_time);
    }

    // m_slip_bar, into the poses that it is of and the frames.
    void add_slip(const Measure& m, double bar, std::size_t s) {
        switch (slip_of(at_)) {
            case Slip::start:
                return add_measure(m, bar, start_, s, step_bar_.start_bar[s]);
            case Slip::bdf2:
                add_measure(m, 4.0 / 3 * bar, start_, s, step_bar_.start_bar[s]);
                return add_measure(m, -1.0 / 3 * bar, Placed(mechanism_, poses_before_), s, step_bar_.before_bar[s]);
            case Slip::newmark:
                add_measure(m, bar, start_, s, step_bar_.slip_reference_bar[s]);  // G . P_slip; P0's own G cancels
                return add_change_of_slip(m, bar, s);
        }
    }

    void add_measure(const Measure& m, double bar, const Placed& where, std::size_t s, std::vector<Matrix34>& poses_bar) {
        const VectorFunction f = vector_function(m, where.frames);
        const core::measure::PoseGradients g = pose_gradients(m, f, where.frames);
        add_placement_gradient(f, bar, where.rotations, model_bar_[s].mechanism.frames);
        for (const auto& [frame, gradient] : {std::pair(m.a, g.a), std::pair(m.b, g.b)}) {
            const int body = mechanism_.set.frames[frame].body;
            if (body == core::measure::world) continue;
            Matrix34 of_pose;  // dm/dR = S R
            of_pose << gradient.arm * where.poses[body].rotation, gradient.force;
            poses_bar[body] += bar * of_pose;
        }
    }

    // Adds the derivative of G . (P_slip - P0) in G: the second derivative along the slip.
    void add_change_of_slip(const Measure& m, double bar, std::size_t s) {
        const std::vector<core::measure::FrameGradient> still(mechanism_.set.frames.size());
        const measure::MeasureTangent t = measure::measure_tangent(mechanism_.set, m, {start_.poses, slips_, still});
        Vector12 along = Vector12::Zero();
        for (const auto& [frame, gradient_dot, begin] : {std::tuple(m.a, t.gradient_a_dot, 0), std::tuple(m.b, t.gradient_b_dot, 6)}) {
            const int body = mechanism_.set.frames[frame].body;
            if (body == core::measure::world) continue;
            step_bar_.start_bar[s][body] += bar * gradient_dot;
            const Matrix3 turn = slips_[body].leftCols<3>() * start_.poses[body].rotation.transpose();
            along.segment<3>(begin) = slips_[body].col(3);
            along.segment<3>(begin + 3) = 0.5 * Vector3(turn(2, 1) - turn(1, 2), turn(0, 2) - turn(2, 0), turn(1, 0) - turn(0, 1));
        }
        const VectorFunction f = vector_function(m, start_.frames);
        add_placement_gradient_of_change(m, f, bar, {start_.frames, start_.rotations}, along, model_bar_[s].mechanism.frames);
    }

    const StepEnd& at_;
    const Mechanism& mechanism_;
    const Placed end_, start_;
    const std::vector<Pose> poses_before_;
    const std::vector<Matrix34> slips_;
    StepGradient& step_bar_;
    std::vector<ModelGradient>& model_bar_;
};

void subtract_reverse_of_measure_terms(const StepEnd& at, const std::vector<std::vector<Vector6>>& motion, StepGradient& step_bar,
                                       std::vector<ModelGradient>& model_bar) {
    const std::size_t count = at.problem.model->mechanism.terms.size();
    if (count == 0) return;
    ReverseTerms terms(at, step_bar, model_bar);
    for (std::size_t k = 0; k < count; ++k) terms.subtract(k, motion);
}

// How m_slip changes.
double slip_dot(const StepEnd& at, const StepTangent& step, const Measure& m, const ModelTangent& direction) {
    const core::measure::MeasureSet& set = at.problem.model->mechanism.set;
    const auto& frames_dot = direction.mechanism.frames;
    const measure::MeasureTangent start = measure::measure_tangent(set, m, {at.problem.poses_t0, step.start_dot, frames_dot});
    const Slip slip = slip_of(at);
    if (slip == Slip::start) return start.value_dot;
    if (slip == Slip::bdf2) {
        const std::vector<Pose> before = poses_before(at);
        return (4 * start.value_dot - measure::measure_tangent(set, m, {before, step.before_dot, frames_dot}).value_dot) / 3;
    }
    const std::vector<Matrix34> along = slips(at);
    double out = start.value_dot;
    for (const auto& [frame, gradient, gradient_dot] :
         {std::tuple(m.a, start.gradient_a, start.gradient_a_dot), std::tuple(m.b, start.gradient_b, start.gradient_b_dot)}) {
        const int body = set.frames[frame].body;
        if (body == core::measure::world) continue;
        out += gradient_dot.cwiseProduct(along[body]).sum();
        out += gradient.cwiseProduct(step.slip_reference_dot[body] - step.start_dot[body]).sum();
    }
    return out;
}

// Change of g' with all that it depends on.
double first_dot(const StepEnd& at, std::size_t k, const LawValue& law, double m_dot, double m_slip_dot, const ModelTangent& direction) {
    const MeasureTerm& term = at.problem.model->mechanism.terms[k];
    const MechanismTangent& dot = direction.mechanism;
    double out = law.second * m_dot + law.first / term.coefficient * dot.term_coefficient[k];
    if (looks_back(term)) return out - law.second * m_slip_dot;
    if (term.kind != LawKind::force) return out - law.second * dot.term_reference[k];
    const std::vector<double> weights = core::scene::curve_weights(term.curve, at.problem.mechanism.end_time);
    for (std::size_t i = 0; i < weights.size(); ++i) out -= at.problem.weight * term.coefficient * weights[i] * dot.term_values[k][i];
    const double running_time = core::scene::curve_running_time(term.curve, at.problem.mechanism.end_time);
    return out - at.problem.weight * term.coefficient * running_time * dot.term_rate[k];
}

void add_tangent_of_measure_terms(const StepEnd& at, const StepTangent& step, const ModelTangent& direction,
                                  contact::PoseGradientTangent& out) {
    const Mechanism& mechanism = at.problem.model->mechanism;
    if (mechanism.terms.empty()) return;
    const Placed end(mechanism, at.poses);
    for (std::size_t k = 0; k < mechanism.terms.size(); ++k) {
        const MeasureTerm& term = mechanism.terms[k];
        const Measure& m = mechanism.set.measures[term.measure];
        const LawValue law = core::energy::measure_law(at.problem, term, measure_at(at, term.measure, end));
        const measure::MeasureTangent t =
            measure::measure_tangent(mechanism.set, m, {at.poses, step.poses_dot, direction.mechanism.frames});
        const double m_slip_dot = looks_back(term) ? slip_dot(at, step, m, direction) : 0;
        const double dot = first_dot(at, k, law, t.value_dot, m_slip_dot, direction);
        const int a = mechanism.set.frames[m.a].body, b = mechanism.set.frames[m.b].body;
        if (a != core::measure::world) {
            out.value[a] += law.first * t.gradient_a;
            out.dot[a] += dot * t.gradient_a + law.first * t.gradient_a_dot;
        }
        if (b != core::measure::world) {
            out.value[b] += law.first * t.gradient_b;
            out.dot[b] += dot * t.gradient_b + law.first * t.gradient_b_dot;
        }
    }
}

}  // namespace

const TermAdjoint measure_terms_adjoint{"springs, dampers, stops and forces along measures", check_measure_terms,
                                        subtract_reverse_of_measure_terms, add_tangent_of_measure_terms};

}  // namespace fettle::adjoint::energy
