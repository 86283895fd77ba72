// SPDX-License-Identifier: MIT
#include "adjoint/model/mechanism_start_adjoint.hpp"

#include <optional>

#include "adjoint/constraint/assembly_adjoint.hpp"
#include "adjoint/model/body_mass_adjoint.hpp"
#include "core/base/contract.hpp"
#include "core/kinematics/mass_matrix.hpp"
#include "core/linear/linear_system.hpp"
#include "core/model/mechanism_start.hpp"

namespace fettle::adjoint::model {
namespace {

using core::constraint::AssemblyProblem;
using core::constraint::RowPart;
using core::kinematics::Pose;
using core::measure::Measure;
using core::model::Body;
using core::model::Model;
using Motions = std::vector<Vector6>;

// <bar, [phi] R> = axial . phi.
Vector3 axial_of(const Matrix3& bar, const Matrix3& rotation) {
    const Matrix3 s = bar * rotation.transpose();
    return {s(2, 1) - s(1, 2), s(0, 2) - s(2, 0), s(1, 0) - s(0, 1)};
}

Matrix34 pose_change(const Vector6& motion, const Matrix3& rotation) {
    Matrix34 out;
    out << cross_matrix(motion.tail<3>()) * rotation, motion.head<3>();
    return out;
}

// A gradient entry by entry whose product with each motion is that of the tangent gradient.
Matrix34 entries_of(const Vector6& tangent, const Matrix3& rotation) {
    Matrix34 out;
    out << 0.5 * cross_matrix(tangent.tail<3>()) * rotation, tangent.head<3>();
    return out;
}

std::vector<Pose> start_poses(const Model& model) {
    std::vector<Pose> out;
    for (const Body& body : model.bodies) out.push_back(body.pose_start);
    return out;
}

std::vector<Matrix3> frame_rotations(const Model& model) {
    std::vector<Matrix3> out;
    for (const core::measure::Frame& f : model.mechanism.set.frames)
        out.push_back(f.body == core::measure::world ? Matrix3(Matrix3::Identity()) : model.bodies[f.body].pose_start.rotation);
    return out;
}

// The projection of start velocities backwards.
class AgreedVelocities {
public:
    AgreedVelocities(const Model& model, const AssemblyProblem& problem)
        : model_(model),
          problem_(problem),
          frames_(placed(model.mechanism.set.frames, start_poses(model))),
          rotations_(frame_rotations(model)),
          rows_(row_jacobian(problem.set, problem.rows, frames_)),
          solver_(problem.dofs) {
        const Motions& written = model.mechanism.written.velocities;
        if (written.empty()) return;
        for (const Body& body : model.bodies)
            mass_.diagonal.push_back(core::kinematics::mass_matrix(body.pose_start.rotation, body.moments));
        if (!solver_.factorise(mass_, rows_)) return;  // as forwards: nothing is made to agree
        const VectorX none = VectorX::Zero(problem_.dofs.count);
        found_ = solver_.solve_refined(mass_, rows_, none, rates() - multiply(rows_, written));
    }

    // @param agreed_bar  (v, omega) of what the model has. Adds to the poses' gradients, the moments' and the mechanism's.
    void reverse(const Motions& agreed_bar, WrittenStartGradient& out, std::vector<Matrix4>& moments_bar, ModelGradient& gradient) const {
        if (!found_) return;
        const Motions& written = model_.mechanism.written.velocities;
        const VectorX still = VectorX::Zero(rows_.count());
        const auto back = solver_.solve_refined(mass_, rows_, gather(problem_.dofs, agreed_bar), still);
        Motions& pose_bar = out.pose_bar;
        Motions delta(written.size(), Vector6::Zero()), lambda = delta;
        scatter(problem_.dofs, found_->y, delta);
        scatter(problem_.dofs, back.y, lambda);
        Motions agreed = written, reaction(written.size(), Vector6::Zero());
        add_transposed(rows_, back.multipliers, reaction);
        for (std::size_t i = 0; i < agreed.size(); ++i) {
            agreed[i] += delta[i];
            spread(i, agreed_bar[i], -reaction[i], out);
            add_mass(i, lambda[i], delta[i], pose_bar[i], moments_bar[i]);
        }
        add_rows(-found_->multipliers, lambda, pose_bar, gradient);
        add_rows(-back.multipliers, agreed, pose_bar, gradient);
        add_rates(back.multipliers, gradient.mechanism);
    }

private:
    VectorX rates() const {
        VectorX out(rows_.count());
        for (int i = 0; i < rows_.count(); ++i) out[i] = core::model::rate_at_start(problem_.rows[i].curve, model_.timestep);
        return out;
    }

    // The constraints see the rate of a prescribed coordinate's curve; the body has it only where its velocity had to change.
    void spread(std::size_t i, const Vector6& of_body, const Vector6& of_rows, WrittenStartGradient& out) const {
        const bool is_written = !model_.mechanism.written.is_velocity_changed[i];
        for (int k = 0; k < 6; ++k) {
            const bool is_its_own = is_free(model_.bodies[i], k);
            (is_its_own || is_written ? out.velocity_bar : out.rate_bar)[i][k] += of_body[k];
            (is_its_own ? out.velocity_bar : out.rate_bar)[i][k] += of_rows[k];
        }
    }

    // - lambda . M delta = - <V_lambda moments, V_delta>, in R and in the moments.
    void add_mass(std::size_t i, const Vector6& lambda, const Vector6& delta, Vector6& pose_bar, Matrix4& moments_bar) const {
        const Matrix3& R = model_.bodies[i].pose_start.rotation;
        const Matrix4& moments = problem_.moments[i];
        const Matrix34 a = pose_change(lambda, R), b = pose_change(delta, R);
        const Matrix34 ma = a * moments, mb = b * moments;
        pose_bar.tail<3>() += axial_of(cross_matrix(lambda.tail<3>()) * mb.leftCols<3>(), R);
        pose_bar.tail<3>() += axial_of(cross_matrix(delta.tail<3>()) * ma.leftCols<3>(), R);
        const Matrix4 product = a.transpose() * b;
        moments_bar -= 0.5 * (product + product.transpose());
    }

    // sum weight_i (C motion)_i in poses and frames.
    void add_rows(const VectorX& weights, const Motions& motion, Motions& pose_bar, ModelGradient& gradient) const {
        const core::measure::MeasureSet& set = problem_.set;
        for (std::size_t i = 0; i < problem_.rows.size(); ++i)
            for (std::size_t k = 0; k < problem_.rows[i].parts.size(); ++k) {
                const RowPart& part = problem_.rows[i].parts[k];
                const Measure& m = set.measures[part.measure];
                const core::measure::VectorFunction f = vector_function(m, frames_);
                const int a = set.frames[m.a].body, b = set.frames[m.b].body;
                Vector12 v = Vector12::Zero();
                if (a != core::measure::world) v.head<6>() = motion[a];
                if (b != core::measure::world) v.tail<6>() = motion[b];
                const double of_row = weights[i], weight = part.factor * of_row;
                add_placement_gradient_of_change(m, f, weight, {frames_, rotations_}, v, gradient.mechanism.frames);
                const Vector12 of_poses = weight * pose_gradient_of_change(m, f, frames_, v);
                if (a != core::measure::world) pose_bar[a] += of_poses.head<6>();
                if (b != core::measure::world) pose_bar[b] += of_poses.tail<6>();
                const core::measure::PoseGradients g = pose_gradients(m, f, frames_);
                gradient.mechanism.row_factors[problem_.rows[i].number][k] +=
                    of_row * (tangent_gradient(g.a).dot(v.head<6>()) + tangent_gradient(g.b).dot(v.tail<6>()));
            }
    }

    // core::model::rate_at_start, which is linear in a curve's numbers.
    void add_rates(const VectorX& bar, MechanismGradient& out) const {
        for (std::size_t i = 0; i < problem_.rows.size(); ++i) {
            core::scene::Curve curve = problem_.rows[i].curve;
            const int number = problem_.rows[i].number;
            const double weight = bar[i];
            std::fill(curve.values.begin(), curve.values.end(), 0.0);
            curve.rate = 1;
            out.row_rate[number] += weight * core::model::rate_at_start(curve, model_.timestep);
            curve.rate = 0;
            for (std::size_t k = 0; k < curve.values.size(); ++k) {
                curve.values[k] = 1;
                out.row_values[number][k] += weight * core::model::rate_at_start(curve, model_.timestep);
                curve.values[k] = 0;
            }
        }
    }

    const Model& model_;
    const AssemblyProblem& problem_;
    const std::vector<core::measure::PlacedFrame> frames_;
    const std::vector<Matrix3> rotations_;
    const core::constraint::RowJacobian rows_;
    core::linear::LinearSystem solver_;
    core::kinematics::BlockHessian mass_;
    std::optional<core::linear::LinearSystem::Solution> found_;  // of the velocities; nothing: none were made to agree
};

// The assembly backwards. The gradients of the poses as written take the place of those of the poses.
void reverse_assembly(const Model& model, const AssemblyProblem& problem, const constraint::AssemblyAdjoint& assembly, Motions& pose_bar,
                      std::vector<Matrix4>& moments_bar, MechanismGradient& mechanism) {
    std::vector<Matrix34> entries;
    for (std::size_t i = 0; i < model.bodies.size(); ++i) entries.push_back(entries_of(pose_bar[i], model.bodies[i].pose_start.rotation));
    const constraint::AssemblyGradient found = assembly.reverse(entries);
    pose_bar = found.written_bar;
    for (std::size_t i = 0; i < moments_bar.size(); ++i) moments_bar[i] += found.moments_bar[i];
    for (std::size_t f = 0; f < found.frames.size(); ++f) {
        mechanism.frames[f].point += found.frames[f].point;
        mechanism.frames[f].axes += found.frames[f].axes;
    }
    for (std::size_t i = 0; i < problem.rows.size(); ++i) {
        const double bar = found.targets_bar[i];
        const core::scene::Curve& curve = problem.rows[i].curve;
        const int number = problem.rows[i].number;
        mechanism.row_constant[number] += bar;
        const std::vector<double> weights = core::scene::curve_weights(curve, 0);
        for (std::size_t k = 0; k < weights.size(); ++k) mechanism.row_values[number][k] += weights[k] * bar;
        for (std::size_t k = 0; k < problem.rows[i].parts.size(); ++k) mechanism.row_factors[number][k] += found.factors_bar[i][k];
    }
}

void add_moments(const Model& model, const std::vector<Matrix4>& moments_bar, ModelGradient& gradient) {
    for (std::size_t i = 0; i < moments_bar.size(); ++i)
        mass_moments_adjoint(model.bodies[i], model.dhat, moments_bar[i], gradient.bodies[i]);
}

}  // namespace

struct MechanismStartAdjoint::Rows {
    explicit Rows(const Model& model)
        : problem(core::model::start_problem(model)),
          assembled(start_poses(model)),
          velocities(model, problem),
          assembly(problem, {}, model.mechanism.written.poses, assembled, model.mechanism.angles_start) {}

    const AssemblyProblem problem;
    const std::vector<Pose> assembled;
    const AgreedVelocities velocities;
    const constraint::AssemblyAdjoint assembly;
};

MechanismStartAdjoint::MechanismStartAdjoint(const Model& model)
    : model_(model), rows_(model.mechanism.rows.empty() ? nullptr : std::make_unique<const Rows>(model)) {}

MechanismStartAdjoint::~MechanismStartAdjoint() = default;

WrittenStartGradient MechanismStartAdjoint::reverse(ModelGradient& gradient) const {
    const Model& model = model_;
    const std::size_t n = model.bodies.size();
    WrittenStartGradient out{Motions(n, Vector6::Zero()), Motions(n, Vector6::Zero()), Motions(n, Vector6::Zero())};
    Motions velocity_bar(n, Vector6::Zero());
    for (std::size_t i = 0; i < n; ++i) {
        const Matrix3& R = model.bodies[i].pose_start.rotation;
        const Matrix34 &pose = gradient.bodies[i].pose_start_bar, &velocity = gradient.bodies[i].velocity_start_bar;
        const Matrix34& rate = model.bodies[i].velocity_start;
        velocity_bar[i] << velocity.col(3), axial_of(velocity.leftCols<3>(), R);
        // Pdot = [[omega] R, v] turns with R.
        const Matrix3 omega = rate.leftCols<3>() * R.transpose();
        out.pose_bar[i] << pose.col(3), axial_of(pose.leftCols<3>() + omega.transpose() * velocity.leftCols<3>(), R);
    }
    if (!rows_) {
        out.velocity_bar = velocity_bar;
        return out;
    }
    std::vector<Matrix4> moments_bar(n, Matrix4::Zero());
    rows_->velocities.reverse(velocity_bar, out, moments_bar, gradient);
    reverse_assembly(model, rows_->problem, rows_->assembly, out.pose_bar, moments_bar, gradient.mechanism);
    add_moments(model, moments_bar, gradient);
    return out;
}

}  // namespace fettle::adjoint::model
