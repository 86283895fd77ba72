// SPDX-License-Identifier: MIT
#include "core/constraint/branch.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/kinematics/rotation.hpp"

namespace fettle::core::constraint {
namespace {

using kinematics::Pose;
using measure::PlacedFrame;
using Slide = Branch::Slide;

constexpr int z_axis = 2;

Vector3 across(const Vector3& v, const Vector3& axis) { return v - axis * axis.dot(v); }

// About the axis n, from one vector across it to another.
double angle_between(const Vector3& n, const Vector3& from, const Vector3& to) { return std::atan2(n.dot(from.cross(to)), from.dot(to)); }

struct Legs {
    Vector3 axis, first, second;
};

Legs legs_of(const Branch& branch, const std::vector<PlacedFrame>& frames) {
    const Vector3 n = frames[branch.first].axes.col(z_axis);
    return {n, across(frames[branch.first].point - frames[branch.start].point, n),
            across(frames[branch.end].point - frames[branch.second].point, n)};
}

struct LegAlongSlide {
    Vector3 leg, axis;
};

LegAlongSlide leg_along_slide(const Branch& branch, const std::vector<PlacedFrame>& frames) {
    const auto point = [&](int frame) -> const Vector3& { return frames[frame].point; };
    if (branch.slide == Slide::to) return {point(branch.first) - point(branch.start), frames[branch.end].axes.col(z_axis)};
    if (branch.slide == Slide::from) return {point(branch.end) - point(branch.second), frames[branch.start].axes.col(z_axis)};
    return {point(branch.end) - point(branch.start), frames[branch.first].axes.col(z_axis)};
}

// The shortest turn from one vector to another of its length; half a turn is about `about`, as nearly as it stands across them.
Vector3 turn_between(const Vector3& from, const Vector3& to, const Vector3& about) {
    const Vector3 normal = from.cross(to);
    const double angle = std::atan2(normal.norm(), from.dot(to));
    if (normal.norm() > 1e-9 * from.norm() * to.norm()) return angle * normal.normalized();
    if (from.dot(to) > 0) return Vector3::Zero();
    Vector3 axis = across(about, from.normalized());
    if (!(axis.norm() > 1e-9)) axis = from.unitOrthogonal();
    return angle * axis.normalized();
}

class Turner {
public:
    Turner(const Branch& branch, const std::vector<measure::Frame>& frames, const linear::FreeDofs& dofs, std::vector<Pose>& poses)
        : branch_(branch), frames_(frames), dofs_(dofs), poses_(poses) {}

    void bend_to(std::optional<double> wanted) {
        const std::vector<PlacedFrame> at = placed(frames_, poses_);
        const auto [n, l1, l2] = legs_of(branch_, at);
        const double now = angle_between(n, l1, l2);
        const double size = wanted.value_or(std::clamp(std::abs(now), least_bend, std::numbers::pi - least_bend));
        const double bend = branch_.sign * size;
        if (!can_move(branch_.with_first)) return turn(branch_.with_second, at[branch_.second].point, (bend - now) * n);
        if (!can_move(branch_.with_second)) return turn(branch_.with_first, at[branch_.first].point, (now - bend) * n);
        // The triangle of both legs and the bend, with its long side where the ends are.
        const Vector3 chord = across(at[branch_.end].point - at[branch_.start].point, n);
        const double to_chord = chord.norm() > 0 ? angle_between(n, l1, chord) : 0;
        const double in_triangle = std::atan2(l2.norm() * std::sin(bend), l1.norm() + l2.norm() * std::cos(bend));
        const double turn_first = to_chord - in_triangle;
        turn(branch_.with_first, at[branch_.start].point, turn_first * n);
        turn(branch_.with_second, at[branch_.second].point, (turn_first + bend - now) * n);
        join(branch_.with_second, branch_.second, branch_.first);
    }

    void slide_to(std::optional<double> wanted) {
        const std::vector<PlacedFrame> at = placed(frames_, poses_);
        const auto [leg, axis] = leg_along_slide(branch_, at);
        const double length = leg.norm(), now = leg.dot(axis);
        const double share = wanted ? std::cos(*wanted) : std::max(std::abs(now) / length, std::sin(least_bend));
        const double along = branch_.sign * share * length;
        if (branch_.slide == Slide::middle) {
            const Vector3 moved = leg + (along - now) * axis;
            const Vector3 back = turn_between(moved, leg, at[branch_.start].axes.col(z_axis));
            shift(branch_.with_second, (along - now) * axis);
            turn(branch_.with_first, at[branch_.start].point, back);
            turn(branch_.with_second, at[branch_.start].point, back);
            return;
        }
        const Vector3 beside = across(leg, axis);
        const double width = std::sqrt(std::max(0.0, length * length - along * along));
        const Vector3 to = along * axis + (beside.norm() > 0 ? Vector3(width * beside.normalized()) : Vector3(Vector3::Zero()));
        const Vector3 way = turn_between(leg, to, at[branch_.first].axes.col(z_axis));
        if (branch_.slide == Slide::to) {
            turn(branch_.with_first, at[branch_.start].point, way);
            join(branch_.with_second, branch_.second, branch_.first);
        } else {
            turn(branch_.with_second, at[branch_.end].point, way);
            join(branch_.with_first, branch_.first, branch_.second);
        }
    }

private:
    bool can_move(const std::vector<int>& bodies) const {
        return std::any_of(bodies.begin(), bodies.end(), [&](int body) { return !linear::is_none_free(dofs_.index[body]); });
    }

    void turn(const std::vector<int>& bodies, const Vector3& centre, const Vector3& rotation_vector) {
        const Matrix3 rotation = kinematics::rotation(rotation_vector);
        for (const int body : bodies) {
            Pose& pose = poses_[body];
            move(body, centre + rotation * (pose.position - centre) - pose.position, rotation_vector);
        }
    }

    void shift(const std::vector<int>& bodies, const Vector3& way) {
        for (const int body : bodies) move(body, way, Vector3::Zero());
    }

    // Brings one frame's point to another's.
    void join(const std::vector<int>& bodies, int frame, int to) {
        shift(bodies, placed(frames_[to], poses_).point - placed(frames_[frame], poses_).point);
    }

    // In what is free.
    void move(int body, Vector3 way, Vector3 rotation_vector) {
        for (int k = 0; k < 3; ++k) {
            if (dofs_.index[body][k] < 0) way[k] = 0;
            if (dofs_.index[body][k + 3] < 0) rotation_vector[k] = 0;
        }
        Pose& pose = poses_[body];
        pose.position += way;
        pose.rotation = kinematics::orthonormalised(kinematics::rotation(rotation_vector) * pose.rotation);
    }

    const Branch& branch_;
    const std::vector<measure::Frame>& frames_;
    const linear::FreeDofs& dofs_;
    std::vector<Pose>& poses_;
};

}  // namespace

double side_of(const Branch& branch, const std::vector<PlacedFrame>& frames) {
    if (branch.slide == Slide::none) {
        const auto [n, l1, l2] = legs_of(branch, frames);
        return n.dot(l1.cross(l2)) / (l1.norm() * l2.norm());
    }
    const auto [leg, axis] = leg_along_slide(branch, frames);
    return leg.dot(axis) / leg.norm();
}

void turn_over(const Branch& branch, const std::vector<measure::Frame>& frames, const linear::FreeDofs& dofs, std::optional<double> bend,
               std::vector<Pose>& poses) {
    Turner turner(branch, frames, dofs, poses);
    if (branch.slide == Slide::none)
        turner.bend_to(bend);
    else
        turner.slide_to(bend);
}

}  // namespace fettle::core::constraint
