// SPDX-License-Identifier: MIT
#include "design/quantities/joint_position.hpp"

#include <algorithm>

#include "core/measure/measure.hpp"

namespace fettle::design::quantities {

namespace {

using core::measure::Measure;
using core::measure::MeasureKind;
using core::model::Mechanism;
using description::Seeds;
using description::Simulated;

// -1: there is no such joint, or it has no coordinate.
int coordinate_of(const Mechanism& mechanism, const std::string& name) {
    for (const core::model::Joint& joint : mechanism.joints)
        if (joint.name == name && !joint.is_motor) return joint.coordinate;
    return -1;
}

}  // namespace

std::vector<double> JointPosition::series(const Simulated& s) const {
    const core::measure::MeasureSet& set = s.model.mechanism.set;
    const Measure& measure = set.measures[coordinate_of(s.model.mechanism, of_.joint)];
    std::vector<double> out;
    double before = s.model.mechanism.angles_start[coordinate_of(s.model.mechanism, of_.joint)];
    for (const std::vector<core::kinematics::Pose>& poses : s.trajectory.poses) {
        double value = value_of(measure, placed(set.frames, poses));
        if (measure.kind == MeasureKind::angle) value = core::measure::nearest_turn(value, before);
        out.push_back(before = value);
    }
    return out;
}

void JointPosition::add_series_seeds(const Simulated& s, const std::vector<double>& weights, Seeds& seeds) const {
    const core::measure::MeasureSet& set = s.model.mechanism.set;
    const Measure& measure = set.measures[coordinate_of(s.model.mechanism, of_.joint)];
    for (size_t t = 0; t < weights.size(); ++t) {
        if (weights[t] == 0) continue;
        const std::vector<core::kinematics::Pose>& poses = s.trajectory.poses[t];
        const std::vector<core::measure::PlacedFrame> frames = placed(set.frames, poses);
        const core::measure::VectorFunction f = vector_function(measure, frames);
        const core::measure::PoseGradients gradients = pose_gradients(measure, f, frames);
        const auto add = [&](int frame, const core::kinematics::PoseGradient& gradient) {
            const int body = set.frames[frame].body;
            if (body == core::measure::world) return;
            seeds.trajectory_bar.pose_bar[t][body] += pose_entries(weights[t] * tangent_gradient(gradient), poses[body].rotation);
        };
        add(measure.a, gradients.a);
        add(measure.b, gradients.b);
        std::vector<Matrix3> rotations;
        for (const core::measure::Frame& frame : set.frames)
            rotations.push_back(frame.body == core::measure::world ? Matrix3(Matrix3::Identity()) : poses[frame.body].rotation);
        add_placement_gradient(f, weights[t], rotations, seeds.model_bar.mechanism.frames);
    }
}

Errors JointPosition::check(const core::model::Model& model, int steps) const {
    Errors errors = StepSeries::check(model, steps);
    const int coordinate = coordinate_of(model.mechanism, of_.joint);
    if (coordinate < 0) {
        errors.push_back({ErrorCode::out_of_range, "", "the scene has no joint `" + of_.joint + "` with an angle or a travel"});
        return errors;
    }
    const bool turns = model.mechanism.set.measures[coordinate].kind == MeasureKind::angle;
    if (turns != (of_.dimension == Dimension::angle))
        errors.push_back(
            {ErrorCode::wrong_type, "", "the coordinate of joint `" + of_.joint + "` is " + (turns ? "an angle" : "a length")});
    return errors;
}

}  // namespace fettle::design::quantities
