// SPDX-License-Identifier: MIT
#include "adjoint/constraint/row_adjoint.hpp"

#include "adjoint/measure/measure_tangent.hpp"

namespace fettle::adjoint::constraint {
namespace {

using core::constraint::Row;
using core::constraint::RowPart;
using core::measure::Measure;
using core::model::Mechanism;

Vector12 motion_of(const Mechanism& mechanism, const Measure& m, const std::vector<Vector6>& motion) {
    Vector12 out = Vector12::Zero();
    const int a = mechanism.set.frames[m.a].body, b = mechanism.set.frames[m.b].body;
    if (a != core::measure::world) out.head<6>() = motion[a];
    if (b != core::measure::world) out.tail<6>() = motion[b];
    return out;
}

std::vector<Matrix3> rotations_of(const Mechanism& mechanism, const std::vector<core::kinematics::Pose>& poses) {
    std::vector<Matrix3> out;
    for (const core::measure::Frame& f : mechanism.set.frames)
        out.push_back(f.body == core::measure::world ? Matrix3(Matrix3::Identity()) : poses[f.body].rotation);
    return out;
}

}  // namespace

void subtract_rows_reverse(const RowsAtEnd& at, const std::vector<std::vector<Vector6>>& motion, const std::vector<VectorX>& mu,
                           std::vector<ModelGradient>& model_bar) {
    const Mechanism& mechanism = at.problem.model->mechanism;
    const std::vector<core::measure::PlacedFrame> frames = placed(mechanism.set.frames, at.poses);
    const std::vector<Matrix3> rotations = rotations_of(mechanism, at.poses);
    for (std::size_t i = 0; i < mechanism.rows.size(); ++i) {
        const Row& row = mechanism.rows[i];
        const std::vector<double> weights = core::scene::curve_weights(row.curve, at.problem.mechanism.end_time);
        const double running_time = core::scene::curve_running_time(row.curve, at.problem.mechanism.end_time);
        for (std::size_t s = 0; s < motion.size(); ++s) {
            MechanismGradient& bar = model_bar[s].mechanism;
            bar.row_constant[row.number] += mu[s][i];
            bar.row_rate[row.number] += running_time * mu[s][i];
            for (std::size_t k = 0; k < weights.size(); ++k) bar.row_values[row.number][k] += weights[k] * mu[s][i];
        }
        for (std::size_t k = 0; k < row.parts.size(); ++k) {
            const RowPart& part = row.parts[k];
            const Measure& m = mechanism.set.measures[part.measure];
            const core::measure::VectorFunction f = vector_function(m, frames);
            const core::measure::PoseGradients g = pose_gradients(m, f, frames);
            const double value = core::constraint::value_at(mechanism.set, part.measure, frames, at.problem.mechanism.angles);
            for (std::size_t s = 0; s < motion.size(); ++s) {
                std::vector<core::measure::FrameGradient>& bars = model_bar[s].mechanism.frames;
                const Vector12 moved = motion_of(mechanism, m, motion[s]);
                add_placement_gradient(f, -part.factor * mu[s][i], rotations, bars);
                add_placement_gradient_of_change(m, f, -part.factor * at.multipliers[i], {frames, rotations}, moved, bars);
                const double change = tangent_gradient(g.a).dot(moved.head<6>()) + tangent_gradient(g.b).dot(moved.tail<6>());
                model_bar[s].mechanism.row_factors[row.number][k] -= at.multipliers[i] * change + mu[s][i] * value;
            }
        }
    }
}

VectorX add_rows_tangent(const RowsAtEnd& at, const std::vector<Matrix34>& poses_dot, const ModelTangent& direction,
                         contact::PoseGradientTangent& out) {
    const Mechanism& mechanism = at.problem.model->mechanism;
    const std::vector<core::measure::PlacedFrame> frames = placed(mechanism.set.frames, at.poses);
    VectorX change = VectorX::Zero(mechanism.rows.size());
    for (std::size_t i = 0; i < mechanism.rows.size(); ++i) {
        const Row& row = mechanism.rows[i];
        for (std::size_t k = 0; k < row.parts.size(); ++k) {
            const RowPart& part = row.parts[k];
            const Measure& m = mechanism.set.measures[part.measure];
            const measure::MeasureTangent t = measure::measure_tangent(mechanism.set, m, {at.poses, poses_dot, direction.mechanism.frames});
            const double weight = part.factor * at.multipliers[i];
            const double factor_dot = direction.mechanism.row_factors[row.number][k], weight_dot = factor_dot * at.multipliers[i];
            const int a = mechanism.set.frames[m.a].body, b = mechanism.set.frames[m.b].body;
            if (a != core::measure::world) {
                out.value[a] += weight * t.gradient_a;
                out.dot[a] += weight * t.gradient_a_dot + weight_dot * t.gradient_a;
            }
            if (b != core::measure::world) {
                out.value[b] += weight * t.gradient_b;
                out.dot[b] += weight * t.gradient_b_dot + weight_dot * t.gradient_b;
            }
            change[i] += part.factor * t.value_dot;
            if (factor_dot != 0)
                change[i] += factor_dot * core::constraint::value_at(mechanism.set, part.measure, frames, at.problem.mechanism.angles);
        }
        const std::vector<double> weights = core::scene::curve_weights(row.curve, at.problem.mechanism.end_time);
        const double running_time = core::scene::curve_running_time(row.curve, at.problem.mechanism.end_time);
        change[i] -= direction.mechanism.row_constant[row.number] + running_time * direction.mechanism.row_rate[row.number];
        for (std::size_t k = 0; k < weights.size(); ++k) change[i] -= weights[k] * direction.mechanism.row_values[row.number][k];
    }
    return change;
}

}  // namespace fettle::adjoint::constraint
