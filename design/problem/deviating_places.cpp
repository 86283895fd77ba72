// SPDX-License-Identifier: MIT
#include "design/problem/deviating_places.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <string>

#include "core/constraint/assembly.hpp"

namespace fettle::design::problem {

using core::clearance::DrivenSource;
using core::clearance::LoopedRanges;
using core::model::Joint;
using core::model::Model;
using core::scene::JointKind;
using core::scene::MotorKind;
using core::scene::Place;
using core::scene::PlaceKind;

namespace {

std::string joint_pointer(const Joint& joint) { return "/joints/" + std::to_string(joint.origin.index); }

bool has_ends(const Joint& joint) { return !joint.is_motor && joint.frame_a >= 0; }

bool slides(const Joint& joint) {
    return joint.kind == JointKind::prismatic || joint.kind == JointKind::cylindrical || joint.kind == JointKind::screw;
}

// The axis of a joint in the frame of its body a.
Vector3 axis_of(const Model& model, const Joint& joint) { return model.mechanism.set.frames[joint.frame_a].axes.col(2); }

Matrix3 written_rotation(const Model& model, int body) {
    return body < 0 ? Matrix3(Matrix3::Identity()) : model.mechanism.written.poses[body].rotation;
}

// Where an end of a joint is in the world, as the scene has its body.
Number3 written_end(const DeviatingNumbers& numbers, const Model& model, const Joint& joint, bool end_a) {
    const core::scene::Joint& from = numbers.scene().mechanism.joints[joint.origin.index];
    const Number3 point = numbers.vector(joint_pointer(joint) + (end_a ? "/point_a" : "/point_b"), (end_a ? from.a : from.b).point);
    const int body = end_a ? joint.a : joint.b;
    if (body < 0) return point;
    const Number3 position = numbers.vector("/bodies/" + std::to_string(body) + "/position", numbers.scene().bodies[body].pose.position);
    return sum(product(constant_matrix(written_rotation(model, body)), point), position);
}

// From a's point to b's, in a's frame.
Number3 written_gap(const DeviatingNumbers& numbers, const Model& model, const Joint& joint) {
    const Number3 apart = difference(written_end(numbers, model, joint, false), written_end(numbers, model, joint, true));
    return product(constant_matrix(written_rotation(model, joint.a).transpose()), apart);
}

}  // namespace

Number3 written_slide(const DeviatingNumbers& numbers, const Model& model, const Joint& joint) {
    if (!slides(joint) && joint.kind != JointKind::planar) return constant_vector(Vector3::Zero());
    const Number3 gap = written_gap(numbers, model, joint);
    if (joint.kind == JointKind::planar) return difference(gap, constant_vector(value_of(gap)));
    const Vector3 axis = axis_of(model, joint);
    const Number slide = dot(axis, gap), beyond = slide - Number(slide.value);
    return {Number(axis[0]) * beyond, Number(axis[1]) * beyond, Number(axis[2]) * beyond};
}

bool is_unknown_of_loop(const LoopedRanges& ranges, int body) {
    const auto is_unknown = [&](const core::certificate::Screw& screw) {
        return std::any_of(ranges.loops.begin(), ranges.loops.end(), [&](const core::clearance::ClosedLoop& loop) {
            return std::find(loop.unknowns.begin(), loop.unknowns.end(), screw.coordinate) != loop.unknowns.end();
        });
    };
    const auto& screws = ranges.ranges.linkage.bodies[body].screws;
    return !screws.empty() && std::all_of(screws.begin(), screws.end(), is_unknown);
}

namespace {

class PlaceJudge {
public:
    PlaceJudge(const DeviatingNumbers& numbers, const Model& model, const std::optional<LoopedRanges>& ranges)
        : numbers_(numbers), scene_(numbers.scene()), model_(model), ranges_(ranges) {}

    Errors run() {
        // One message for all numbers of one thing.
        std::map<std::string, std::vector<Number>> refused;
        for (const DeviatingNumbers::Moved& moved : numbers_.moved())
            if (const std::string what = refusal(moved.place); !what.empty()) refused[what].push_back(moved.number);
        for (const auto& [what, numbers] : refused) refuse(numbers, what);
        if (!refused_.empty()) return std::move(refused_);
        for (const Group& group : groups()) judge(group);
        for (const Joint& joint : model_.mechanism.joints)
            if (core::scene::couples_joints(joint.kind) && !joint.is_motor && ranges_) judge_coupling(joint);
        return std::move(refused_);
    }

private:
    void refuse(const std::vector<Number>& numbers, const std::string& what) {
        refused_.push_back({ErrorCode::unsupported, "tolerances", numbers_.movers_of(numbers) + " " + what});
    }

    bool is_over(LoopedRanges::Of of) const { return ranges_ && ranges_->of == of; }

    // What a place moves that cannot be dealt with; empty: it is recorded, or is nothing to where bodies are.
    std::string refusal(const Place& place) const {
        switch (core::scene::kind_of(place)) {
            case PlaceKind::shape_dimension:
            case PlaceKind::position:
            case PlaceKind::joint_point:
                return "";
            case PlaceKind::gravity:
            case PlaceKind::minimum_separation:
            case PlaceKind::friction:
            case PlaceKind::density:
            case PlaceKind::start_velocity:
            case PlaceKind::body_load:
            case PlaceKind::spring_point:
            case PlaceKind::coordinate_force:
            case PlaceKind::point_load:
                return "";
            case PlaceKind::rotation:
                return of_rotation(place.item);
            case PlaceKind::joint_axis:
            case PlaceKind::pitch:
                return "the axis or the pitch of joint `" + scene_joint(place).name + "`" + only_lengths;
            case PlaceKind::ratio:
                return ranges_ ? "the ratio of `" + scene_joint(place).name + "`" + only_lengths : "";
            case PlaceKind::joint_limits:
                return is_over(LoopedRanges::Of::joints) ? "the limits of joint `" + scene_joint(place).name + "`" + only_lengths : "";
            case PlaceKind::spring_limits:
                return of_spring_limits(scene_.mechanism.springs[place.item]);
            case PlaceKind::motor_values:
            case PlaceKind::motor_rate:
                return of_motor(place);
            case PlaceKind::prescribed_rate:
                return of_script(place);
        }
        return "what nothing is known of";
    }

    const core::scene::Joint& scene_joint(const Place& place) const { return scene_.mechanism.joints[place.item]; }

    const Joint* joint_at(int body) const {
        const auto& joints = model_.mechanism.joints;
        const auto found = std::find_if(joints.begin(), joints.end(),
                                        [&](const Joint& joint) { return has_ends(joint) && (joint.a == body || joint.b == body); });
        return found == joints.end() ? nullptr : &*found;
    }

    std::string of_rotation(int body) const {
        const Joint* joint = joint_at(body);
        if (joint == nullptr) return "";
        return "the rotation of body `" + model_.bodies[body].name + "`, which joint `" + joint->name + "` holds" + only_lengths;
    }

    std::string of_spring_limits(const core::scene::Spring& spring) const {
        if (!is_over(LoopedRanges::Of::joints) || spring.joint.empty()) return "";
        return "the limits of spring `" + spring.name + "`, which are those of joint `" + spring.joint + "`" + only_lengths;
    }

    std::string of_motor(const Place& place) const {
        const core::scene::Motor& motor = scene_.mechanism.motors[place.item];
        if (motor.kind == MotorKind::effort || is_over(LoopedRanges::Of::joints)) return "";
        if (is_over(LoopedRanges::Of::motion))
            return is_recorded([&](const DrivenSource& source) { return source.motor == place.item; })
                       ? ""
                       : "motor `" + motor.name + "`, which moves nothing as designed" + no_motion;
        const bool is_value = core::scene::kind_of(place) == PlaceKind::motor_values;
        if (!is_value || core::scene::curve_weights(motor.curve, 0)[static_cast<size_t>(place.entry)] == 0) return "";
        return "where motor `" + motor.name + "` has joint `" + motor.joint + "` at the start" + only_lengths;
    }

    std::string of_script(const Place& place) const {
        const std::string& name = model_.bodies[place.item].name;
        if (is_over(LoopedRanges::Of::joints) && joint_at(place.item) != nullptr)
            return "the prescribed motion of body `" + name + "`, which a joint holds" + only_lengths;
        if (!is_over(LoopedRanges::Of::motion)) return "";
        constexpr std::array dofs{"px", "py", "pz", "rx", "ry", "rz"};
        const std::string pointer = core::scene::pointer_to(scene_, place);
        const auto is_this = [&](const DrivenSource& source) {
            return source.body == place.item && source.dof >= 0 &&
                   pointer.ends_with(std::string("/") + dofs[static_cast<size_t>(source.dof)] + "/rate");
        };
        if (is_recorded(is_this)) return "";
        return "the prescribed motion of body `" + name + "`, which goes along several coordinates or, as designed, along none" + no_motion;
    }

    template <class Is>
    bool is_recorded(const Is& is) const {
        const auto found = std::find_if(ranges_->driven.begin(), ranges_->driven.end(), is);
        if (found == ranges_->driven.end()) return false;
        const auto& coordinate = ranges_->ranges.linkage.coordinates[found->coordinate];
        return coordinate.high > coordinate.low;
    }

    // --- what joints join, and nothing holds

    struct Group {
        std::vector<int> bodies;
        std::vector<const Joint*> joints;
        bool is_attached = false;  // to what does not move
    };

    // Does the assembly leave it as written?
    bool is_anchored(int body) const {
        if (body < 0) return true;
        for (int k = 0; k < 6; ++k)
            if (core::model::is_free(model_.bodies[body], k)) return false;
        return true;
    }

    std::vector<Group> groups() const {
        std::vector<int> root(model_.bodies.size());
        std::iota(root.begin(), root.end(), 0);
        const auto root_of = [&](int body) {
            while (root[body] != body) body = root[body];
            return body;
        };
        const auto join = [&](int a, int b) {
            if (!is_anchored(a) && !is_anchored(b)) root[root_of(a)] = root_of(b);
        };
        std::vector<const Joint*> joints;
        for (const Joint& joint : model_.mechanism.joints)
            if (has_ends(joint)) joints.push_back(&joint);
        const auto ends_of_name = [&](const std::string& name) {
            for (const Joint* joint : joints)
                if (joint->name == name) return ends_of(*joint);
            return std::array{-1, -1};
        };
        for (const Joint* joint : joints) join(joint->a, joint->b);
        for (const core::scene::Joint& coupling : scene_.mechanism.joints)
            if (core::scene::couples_joints(coupling.kind))
                for (const int a : ends_of_name(coupling.of[0]))
                    for (const int b : ends_of_name(coupling.of[1])) join(a, b);
        std::map<int, Group> found;
        for (int i = 0; i < count_of(root); ++i)
            if (!is_anchored(i)) found[root_of(i)].bodies.push_back(i);
        for (const Joint* joint : joints)
            for (const int end : ends_of(*joint)) {
                if (is_anchored(end)) continue;
                Group& group = found[root_of(end)];
                group.is_attached = group.is_attached || is_anchored(joint->a) || is_anchored(joint->b);
                if (std::find(group.joints.begin(), group.joints.end(), joint) == group.joints.end()) group.joints.push_back(joint);
            }
        std::vector<Group> out;
        for (auto& [key, group] : found)
            if (!group.joints.empty()) out.push_back(std::move(group));
        return out;
    }
    static std::array<int, 2> ends_of(const Joint& joint) { return {joint.a, joint.b}; }

    void judge(const Group& group) {
        const std::vector<Number> moving = moving_numbers(group);
        if (moving.empty() || is_held(group) || is_met_as_written(group)) return;
        refuse(
            moving,
            "bodies or joints around joint `" + group.joints.front()->name +
                "`, which the positions of the bodies do not meet for all of the tolerances: where the bodies then stand follows from how "
                "little they are moved, by mass, and nothing is proven of that; let positions follow what they are joined to, or give "
                "each joint there a motor (with speed 0 it is held)");
    }

    // What may change where the assembly puts the group.
    std::vector<Number> moving_numbers(const Group& group) const {
        std::vector<Number> out;
        for (const DeviatingNumbers::Moved& moved : numbers_.moved()) {
            const PlaceKind kind = core::scene::kind_of(moved.place);
            const int item = moved.place.item;
            const bool is_of_body = kind == PlaceKind::position || kind == PlaceKind::density || kind == PlaceKind::shape_dimension;
            const bool is_of_joint = kind == PlaceKind::joint_point;
            const bool moves = std::any_of(group.joints.begin(), group.joints.end(), [&](const Joint* joint) {
                if (is_of_joint) return joint->origin.index == item;
                return is_of_body && (joint->a == item || joint->b == item);
            });
            if (moves || kind == PlaceKind::ratio) out.push_back(moved.number);
        }
        return out;
    }

    // Do ranges, motors and loops decide all of its coordinates?
    bool is_held(const Group& group) const {
        if (!group.is_attached) return false;
        for (const int body : group.bodies)
            for (int k = 0; k < 6; ++k)
                if (!core::model::is_free(model_.bodies[body], k)) return false;
        if (ranges_ && ranges_->of != LoopedRanges::Of::start) return true;
        return std::all_of(group.joints.begin(), group.joints.end(), [&](const Joint* joint) { return is_held(*joint); });
    }
    bool is_held(const Joint& joint) const {
        if (joint.kind == JointKind::fixed || (ranges_ && follows_from_loop(joint))) return true;
        if (joint.kind != JointKind::revolute && joint.kind != JointKind::prismatic && joint.kind != JointKind::screw) return false;
        return std::any_of(model_.mechanism.joints.begin(), model_.mechanism.joints.end(), [&](const Joint& motor) {
            return motor.is_motor && joint.coordinate >= 0 && motor.coordinate == joint.coordinate;
        });
    }
    bool follows_from_loop(const Joint& joint) const {
        const int place = static_cast<int>(&joint - model_.mechanism.joints.data());
        const bool closes = std::any_of(ranges_->loops.begin(), ranges_->loops.end(), [&](const core::clearance::ClosedLoop& loop) {
            return std::find(loop.closing.begin(), loop.closing.end(), place) != loop.closing.end();
        });
        const std::vector<int>& joint_of = ranges_->ranges.joint_of;
        const auto hangs = std::find(joint_of.begin(), joint_of.end(), place);
        return closes || (hangs != joint_of.end() && is_unknown_of_loop(*ranges_, static_cast<int>(hangs - joint_of.begin())));
    }

    // Whatever deviates; then the assembly moves nothing.
    bool is_met_as_written(const Group& group) const {
        const auto& written = model_.mechanism.written.poses;
        const double close = core::constraint::closed_gap(model_.diagonal, written);
        for (const int i : group.bodies) {
            const core::kinematics::Pose& start = model_.bodies[i].pose_start;
            if (written[i].rotation != start.rotation || written[i].position != start.position) return false;
        }
        return std::all_of(group.joints.begin(), group.joints.end(), [&](const Joint* joint) {
            const Number3 gap = written_gap(numbers_, model_, *joint);
            const Vector3 axis = axis_of(model_, *joint), side = axis.unitOrthogonal();
            std::vector<Vector3> closed{side, axis.cross(side)};
            if (joint->kind == JointKind::planar) closed.clear();
            if (!slides(*joint)) closed.push_back(axis);
            return std::all_of(closed.begin(), closed.end(), [&](const Vector3& way) { return numbers_.is_none(dot(way, gap), close); });
        });
    }

    // Racks, and gears of what slides, count from where the joints start.
    void judge_coupling(const Joint& coupling) {
        const core::scene::Joint& from = scene_.mechanism.joints[coupling.origin.index];
        for (const Joint& joint : model_.mechanism.joints) {
            if (!has_ends(joint) || !slides(joint) || (joint.name != from.of[0] && joint.name != from.of[1])) continue;
            const Number slide = dot(axis_of(model_, joint), written_slide(numbers_, model_, joint));
            if (!numbers_.is_none(slide, core::constraint::closed_gap(model_.diagonal, model_.mechanism.written.poses)))
                refuse({slide}, "where joint `" + joint.name + "` starts, from which `" + coupling.name + "` counts" + only_lengths);
        }
    }

    static constexpr const char* only_lengths =
        ": within tolerances only lengths, rotations of bodies without joints, and how far motors and scripts go can deviate";
    static constexpr const char* no_motion = ": within tolerances can deviate how far something goes that moves as designed";

    const DeviatingNumbers& numbers_;
    const core::scene::Scene& scene_;
    const Model& model_;
    const std::optional<LoopedRanges>& ranges_;
    Errors refused_;
};

}  // namespace

Errors refused_places(const DeviatingNumbers& numbers, const Model& model, const std::optional<LoopedRanges>& ranges) {
    return PlaceJudge(numbers, model, ranges).run();
}

}  // namespace fettle::design::problem
