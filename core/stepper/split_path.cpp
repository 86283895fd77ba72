// SPDX-License-Identifier: MIT
#include "core/stepper/split_path.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <sstream>

#include "core/base/text.hpp"
#include "core/ccd/chord_deviation.hpp"
#include "core/constraint/assembly.hpp"

namespace fettle::core::stepper {
namespace {

using kinematics::ChartPoint;
using kinematics::Pose;

constexpr int most_halvings_of_segment = 10;  // 1024 parts
constexpr double farthest_turn = 0.5;         // of a middle from the straight path's [rad]: beyond half a turn the chart has others

// The gap of one segment of a step.
PathGap segment_gap(const model::Model& model, const std::vector<Pose>& poses_t0, const std::vector<ChartPoint>& from,
                    const std::vector<ChartPoint>& to) {
    PathGap out;
    for (std::size_t j = 0; j < model.mechanism.joints.size(); ++j) {
        const model::Joint& joint = model.mechanism.joints[j];
        if (joint.frame_a < 0 || joint.is_motor) continue;
        double gap = 0;
        for (const int f : {joint.frame_a, joint.frame_b}) {
            const measure::Frame& frame = model.mechanism.set.frames[f];
            if (frame.body == measure::world) continue;
            const auto body = static_cast<std::size_t>(frame.body);
            gap += ccd::chord_deviation(path_between(poses_t0[body].rotation, from[body], to[body]), frame.point);
        }
        if (out.joint < 0 || gap > out.gap) {
            out.gap = gap;
            out.joint = static_cast<int>(j);
        }
    }
    return out;
}

class Splitter {
public:
    Splitter(const model::Model& model, double allowed)
        : model_(model), allowed_(allowed), problem_{model.mechanism.set, rows_, {}, {}, free_dofs(model), model.diagonal} {
        for (const constraint::Row& row : model.mechanism.rows)
            if (!model.mechanism.joints[row.owner].is_motor) rows_.push_back(row);
        problem_.targets.resize(rows_.size());
        for (const model::Body& body : model.bodies) problem_.moments.push_back(body.moments);
        angles_ = model.mechanism.angles_start;
    }

    int added = 0;
    std::string refusal;

    void split(const std::vector<Pose>& poses_t0, int step_number, TrajectoryStep& step) {
        poses_t0_ = &poses_t0;
        step_number_ = step_number;
        TrajectoryStep out;
        const bool even = step.fractions.empty();
        const auto last = static_cast<double>(step.nodes.size() - 1);
        const auto fraction = [&](std::size_t k) { return even ? static_cast<double>(k) / last : step.fractions[k]; };
        out.nodes.push_back(step.nodes.front());
        out.fractions.push_back(0);
        const int before = added;
        for (std::size_t k = 1; k < step.nodes.size(); ++k)
            halve({out.nodes.back(), fraction(k - 1)}, {step.nodes[k], fraction(k)}, most_halvings_of_segment, out);
        if (added > before) step = std::move(out);
        angles_ = constraint::angles_at(model_.mechanism.set, poses_of(step.nodes.back()), angles_);
    }

private:
    struct Node {
        std::vector<ChartPoint> points;
        double fraction = 0;
    };

    std::vector<Pose> poses_of(const std::vector<ChartPoint>& points) const {
        std::vector<Pose> out;
        for (std::size_t i = 0; i < points.size(); ++i)
            out.push_back({kinematics::rotation(points[i].rotation_vector) * (*poses_t0_)[i].rotation, points[i].position});
        return out;
    }

    // Everything after `from` up to `to` is appended.
    void halve(const Node& from, const Node& to, int halvings, TrajectoryStep& out) {
        const PathGap gap = segment_gap(model_, *poses_t0_, from.points, to.points);
        if (gap.gap > allowed_ && halvings > 0) {
            if (const auto middle = middle_of(from, to)) {
                ++added;
                halve(from, *middle, halvings - 1, out);
                halve(*middle, to, halvings - 1, out);
                return;
            }
        }
        if (gap.gap > allowed_ && refusal.empty()) {
            std::ostringstream message;
            message << "joint '" << model_.mechanism.joints[gap.joint].name << "' parts by up to "
                    << base::length_text(gap.gap, model_.length_unit) << " between nodes of step " << step_number_ + 1
                    << (halvings > 0 ? ", where the bodies cannot be moved onto their joints" : ", however often it is split")
                    << "; a shorter time step helps";
            refusal = message.str();
        }
        out.nodes.push_back(to.points);
        out.fractions.push_back(to.fraction);
    }

    std::optional<Node> middle_of(const Node& from, const Node& to) {
        Node out{{}, 0.5 * (from.fraction + to.fraction)};
        for (std::size_t i = 0; i < from.points.size(); ++i)
            out.points.push_back({0.5 * (from.points[i].position + to.points[i].position),
                                  0.5 * (from.points[i].rotation_vector + to.points[i].rotation_vector)});
        const std::vector<Pose> straight = poses_of(out.points);
        const std::vector<double> counted = constraint::angles_at(model_.mechanism.set, straight, angles_),
                                  plain = constraint::angles_at(model_.mechanism.set, straight, {});
        for (std::size_t i = 0; i < rows_.size(); ++i) {
            double target = target_at(rows_[i], 0);
            for (const constraint::RowPart& part : rows_[i].parts) target -= part.factor * (counted[part.measure] - plain[part.measure]);
            problem_.targets[i] = target;
        }
        const constraint::Assembly found = assemble(problem_, straight);
        if (!found.is_met) return std::nullopt;
        for (std::size_t i = 0; i < out.points.size(); ++i) {
            if (linear::is_none_free(problem_.dofs.index[i])) continue;
            const Vector3 turn = kinematics::rotation_vector(found.poses[i].rotation * (*poses_t0_)[i].rotation.transpose());
            if (!((turn - out.points[i].rotation_vector).norm() < farthest_turn)) return std::nullopt;
            out.points[i] = {found.poses[i].position, turn};
        }
        return out;
    }

    const model::Model& model_;
    const double allowed_;
    std::vector<constraint::Row> rows_;
    constraint::AssemblyProblem problem_;
    std::vector<double> angles_;
    const std::vector<Pose>* poses_t0_ = nullptr;
    int step_number_ = 0;
};

}  // namespace

PathGap largest_path_gap(const model::Model& model, const Trajectory& trajectory) {
    PathGap out;
    for (std::size_t t = 0; t < trajectory.steps.size(); ++t) {
        const auto& nodes = trajectory.steps[t].nodes;
        for (std::size_t k = 0; k + 1 < nodes.size(); ++k) {
            PathGap gap = segment_gap(model, trajectory.poses[t], nodes[k], nodes[k + 1]);
            if (gap.joint < 0 || (out.joint >= 0 && !(gap.gap > out.gap))) continue;
            gap.step = static_cast<int>(t);
            out = gap;
        }
    }
    return out;
}

SplitPath split_at_joints(const model::Model& model, double allowed, Trajectory& trajectory) {
    SplitPath out;
    Splitter splitter(model, allowed);
    for (std::size_t t = 0; t < trajectory.steps.size(); ++t) splitter.split(trajectory.poses[t], static_cast<int>(t), trajectory.steps[t]);
    out.left = largest_path_gap(model, trajectory);
    out.added = splitter.added;
    out.refusal = splitter.refusal;
    return out;
}

}  // namespace fettle::core::stepper
