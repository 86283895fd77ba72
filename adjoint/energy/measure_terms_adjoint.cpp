// SPDX-License-Identifier: MIT
#include "fettle/adjoint/energy/measure_terms_adjoint.hpp"

#include "fettle/adjoint/measure/measure_tangent.hpp"
#include "fettle/core/energy/measure_law.hpp"

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
                add_at_start(m, law.second * change, s);
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

    // m_slip_bar, into the start's poses and the frames.
    void add_at_start(const Measure& m, double bar, std::size_t s) {
        const VectorFunction f = vector_function(m, start_.frames);
        const core::measure::PoseGradients g = pose_gradients(m, f, start_.frames);
        add_placement_gradient(f, bar, start_.rotations, model_bar_[s].mechanism.frames);
        for (const auto& [frame, gradient] : {std::pair(m.a, g.a), std::pair(m.b, g.b)}) {
            const int body = mechanism_.set.frames[frame].body;
            if (body == core::measure::world) continue;
            Matrix34 of_pose;  // dm/dR = S R
            of_pose << gradient.arm * start_.poses[body].rotation, gradient.force;
            step_bar_.slip_reference_bar[s][body] += bar * of_pose;
        }
    }

    const StepEnd& at_;
    const Mechanism& mechanism_;
    const Placed end_, start_;
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

// Change of g' with all that it hangs on.
double first_dot(const StepEnd& at, std::size_t k, const LawValue& law, double m_dot, double slip_dot, const ModelTangent& direction) {
    const MeasureTerm& term = at.problem.model->mechanism.terms[k];
    const MechanismTangent& dot = direction.mechanism;
    double out = law.second * m_dot + law.first / term.coefficient * dot.term_coefficient[k];
    if (looks_back(term)) return out - law.second * slip_dot;
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
        const measure::MeasureTangent before =
            measure::measure_tangent(mechanism.set, m, {at.problem.poses_t0, step.slip_reference_dot, direction.mechanism.frames});
        const double dot = first_dot(at, k, law, t.value_dot, before.value_dot, direction);
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
