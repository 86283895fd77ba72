// SPDX-License-Identifier: MIT
#include "design/quantities/joint_load.hpp"

#include <algorithm>

#include "adjoint/stepper/row_multipliers.hpp"
#include "core/model/row_choice.hpp"

namespace fettle::design::quantities {

namespace {

using core::constraint::Row;
using core::constraint::RowPart;
using core::measure::Measure;
using core::measure::PlacedFrame;
using core::model::Joint;
using core::model::Mechanism;
using description::Seeds;
using description::Simulated;

// A joint's place in the model's list, -1: none. Motors are in it too.
int find_joint(const Mechanism& mechanism, const std::string& name, bool is_motor) {
    for (size_t k = 0; k < mechanism.joints.size(); ++k)
        if (mechanism.joints[k].name == name && mechanism.joints[k].is_motor == is_motor) return static_cast<int>(k);
    return -1;
}

// The rows of one joint at the end of one step.
class JointAtStep {
public:
    JointAtStep(const Simulated& s, int joint, size_t step, const VectorX& multipliers, double weight)
        : mechanism_(s.model.mechanism),
          rows_(all_rows(mechanism_)),
          joint_(mechanism_.joints[joint]),
          owner_(joint),
          multipliers_(multipliers),
          weight_(weight),
          poses_(s.trajectory.poses[step + 1]),
          frames_(placed(mechanism_.set.frames, poses_)),
          body_(joint_.b != core::measure::world ? joint_.b : joint_.a),
          frame_(joint_.b != core::measure::world ? joint_.frame_b : joint_.frame_a) {
        for (const core::measure::Frame& f : mechanism_.set.frames)
            rotations_.push_back(f.body == core::measure::world ? Matrix3(Matrix3::Identity()) : poses_[f.body].rotation);
    }

    double effort() const {
        double sum = 0;
        for_each_row([&](size_t i) { sum -= multipliers_[i] / weight_; });
        return sum;
    }

    Vector3 force() const { return load(false); }
    Vector3 torque() const { return load(true) - frames_[frame_].arm.cross(force()); }

    // Adds the seeds of scale (effort).
    void add_effort_seeds(double scale, VectorX& multiplier_bar) const {
        for_each_row([&](size_t i) { multiplier_bar[i] -= scale / weight_; });
    }

    // Adds the seeds of scale (force . n), or of the torque.
    void add_load_seeds(bool is_torque, const Vector3& n, double scale, size_t step, Seeds& seeds) const {
        const Vector3& arm = frames_[frame_].arm;
        Vector6 motion = Vector6::Zero();
        if (is_torque)
            motion << arm.cross(n), n;
        else
            motion.head<3>() = n;
        std::vector<Vector6> pose_bar(poses_.size(), Vector6::Zero());
        VectorX& multiplier_bar = seeds.trajectory_bar.multiplier_bar[step];
        for_each_part([&](size_t i, const RowPart& part, const Measure& m) {
            const core::measure::VectorFunction f = vector_function(m, frames_);
            const core::measure::PoseGradients g = pose_gradients(m, f, frames_);
            Vector12 v = Vector12::Zero();
            if (body_of(m.a) == body_) v.head<6>() = motion;
            if (body_of(m.b) == body_) v.tail<6>() = motion;
            const double change = tangent_gradient(g.a).dot(v.head<6>()) + tangent_gradient(g.b).dot(v.tail<6>());
            const double along = -scale * part.factor / weight_, carried = along * multipliers_[i];
            multiplier_bar[i] += along * change;
            add_placement_gradient_of_change(m, f, carried, {frames_, rotations_}, v, seeds.model_bar.mechanism.frames);
            seeds.model_bar.mechanism.row_factors[i][&part - rows_[i].parts.data()] += carried / part.factor * change;
            const Vector12 of_poses = carried * pose_gradient_of_change(m, f, frames_, v);
            if (body_of(m.a) != core::measure::world) pose_bar[body_of(m.a)] += of_poses.head<6>();
            if (body_of(m.b) != core::measure::world) pose_bar[body_of(m.b)] += of_poses.tail<6>();
        });
        if (is_torque) add_arm(scale * n.cross(force()), pose_bar, seeds);
        for (size_t i = 0; i < poses_.size(); ++i)
            if (!pose_bar[i].isZero(0)) seeds.trajectory_bar.pose_bar[step + 1][i] += pose_entries(pose_bar[i], poses_[i].rotation);
    }

private:
    int body_of(int frame) const { return mechanism_.set.frames[frame].body; }

    template <class Do>
    void for_each_row(const Do& act) const {
        for (size_t i = 0; i < rows_.size(); ++i)
            if (rows_[i].owner == owner_) act(i);
    }

    template <class Do>
    void for_each_part(const Do& act) const {
        for_each_row([&](size_t i) {
            for (const RowPart& part : rows_[i].parts) act(i, part, mechanism_.set.measures[part.measure]);
        });
    }

    Vector3 load(bool is_turning) const {
        Vector6 sum = Vector6::Zero();
        for_each_part([&](size_t i, const RowPart& part, const Measure& m) {
            const core::measure::PoseGradients g = pose_gradients(m, vector_function(m, frames_), frames_);
            const double carried = -part.factor * multipliers_[i] / weight_;
            if (body_of(m.a) == body_) sum += carried * tangent_gradient(g.a);
            if (body_of(m.b) == body_) sum += carried * tangent_gradient(g.b);
        });
        return is_turning ? sum.tail<3>() : sum.head<3>();
    }

    // The turn is about the joint's point: (arm x n) . F has n x F for its gradient in the arm R X.
    void add_arm(const Vector3& bar, std::vector<Vector6>& pose_bar, Seeds& seeds) const {
        pose_bar[body_].tail<3>() += frames_[frame_].arm.cross(bar);
        seeds.model_bar.mechanism.frames[frame_].point += rotations_[frame_].transpose() * bar;
    }

    const Mechanism& mechanism_;
    const std::vector<Row> rows_;  // [number]
    const Joint& joint_;
    int owner_;
    const VectorX& multipliers_;
    double weight_;
    const std::vector<core::kinematics::Pose>& poses_;
    const std::vector<PlacedFrame> frames_;
    int body_, frame_;
    std::vector<Matrix3> rotations_;
};

}  // namespace

Dimension JointLoad::instant_dimension() const {
    if (of_.kind == JointLoadKind::effort) return of_.effort_dimension;
    return of_.kind == JointLoadKind::force ? Dimension::force : Dimension::torque;
}

std::vector<double> JointLoad::series(const Simulated& s) const {
    const int joint = find_joint(s.model.mechanism, of_.name, of_.kind == JointLoadKind::effort);
    std::vector<double> weights_of_steps;
    const std::vector<VectorX> multipliers = adjoint::stepper::row_multipliers(s.model, s.trajectory, &weights_of_steps);
    std::vector<double> out;
    for (size_t t = 0; t < multipliers.size(); ++t) {
        const JointAtStep at(s, joint, t, multipliers[t], weights_of_steps[t]);
        if (of_.kind == JointLoadKind::effort) {
            out.push_back(at.effort());
            continue;
        }
        const Vector3 load = of_.kind == JointLoadKind::torque ? at.torque() : at.force();
        out.push_back(of_.axis.isZero(0) ? load.norm() : of_.axis.dot(load));
    }
    return out;
}

void JointLoad::add_series_seeds(const Simulated& s, const std::vector<double>& weights, Seeds& seeds) const {
    const int joint = find_joint(s.model.mechanism, of_.name, of_.kind == JointLoadKind::effort);
    std::vector<double> weights_of_steps;
    const std::vector<VectorX> multipliers = adjoint::stepper::row_multipliers(s.model, s.trajectory, &weights_of_steps);
    seeds.trajectory_bar.multiplier_bar.resize(multipliers.size());
    for (size_t t = 0; t < multipliers.size(); ++t) {
        if (weights[t] == 0) continue;
        VectorX& bar = seeds.trajectory_bar.multiplier_bar[t];
        if (bar.size() == 0) bar = VectorX::Zero(multipliers[t].size());
        const JointAtStep at(s, joint, t, multipliers[t], weights_of_steps[t]);
        if (of_.kind == JointLoadKind::effort) {
            at.add_effort_seeds(weights[t], bar);
            continue;
        }
        const bool is_torque = of_.kind == JointLoadKind::torque;
        const Vector3 load = is_torque ? at.torque() : at.force();
        if (of_.axis.isZero(0) && load.isZero(0)) continue;
        at.add_load_seeds(is_torque, of_.axis.isZero(0) ? load.normalized() : of_.axis, weights[t], t, seeds);
    }
}

Errors JointLoad::check(const core::model::Model& model, int steps) const {
    Errors errors = StepSeries::check(model, steps);
    const bool is_motor = of_.kind == JointLoadKind::effort;
    const int joint = find_joint(model.mechanism, of_.name, is_motor);
    if (joint < 0)
        errors.push_back({ErrorCode::out_of_range, "",
                          is_motor ? "the scene has no motor `" + of_.name +
                                         "` of an angle, travel or speed (one of torque or force has what "
                                         "its curve says)"
                                   : "the scene has no joint `" + of_.name + "`"});
    else if (!is_motor && model.mechanism.joints[joint].frame_b < 0)
        errors.push_back({ErrorCode::inconsistent, "", "`" + of_.name + "` couples two joints: it has no point that a force acts at"});
    return errors;
}

}  // namespace fettle::design::quantities
