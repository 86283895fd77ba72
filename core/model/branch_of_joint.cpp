// SPDX-License-Identifier: MIT
#include "core/model/branch_of_joint.hpp"

#include <algorithm>
#include <optional>
#include <set>
#include <string>

namespace fettle::core::model {
namespace {

using base::ErrorCode;
using base::Errors;
using constraint::Branch;
using scene::AssembleSide;
using scene::JointKind;

bool slides(const Joint& joint) { return joint.kind == JointKind::prismatic; }

// Has it a point, or a direction, that a leg can lead to?
bool can_end_leg(const Joint& joint) {
    return slides(joint) || joint.kind == JointKind::revolute || joint.kind == JointKind::ball || joint.kind == JointKind::cylindrical ||
           joint.kind == JointKind::screw;
}

bool has_ends(const Joint& joint) { return joint.frame_a >= 0; }
bool joins(const Joint& joint, int body) { return has_ends(joint) && (joint.a == body || joint.b == body); }
int frame_on(const Joint& joint, int body) { return joint.a == body ? joint.frame_a : joint.frame_b; }

class BranchBuilder {
public:
    BranchBuilder(const scene::Joint& from, int middle, const Model& model) : from_(from), model_(model), middle_(middle) {}

    Errors build(std::vector<Branch>& out) {
        const Joint& joint = joints()[middle_];
        if (joint.kind != JointKind::revolute && joint.kind != JointKind::prismatic) return fail("a revolute or prismatic joint has one");
        const scene::Assemble& said = *from_.assemble;
        int start = -1, end = -1;
        int first = joint.a, second = joint.b;
        if (!said.from.empty() && !find(said.from, start)) return errors_;
        if (!said.to.empty() && !find(said.to, end)) return errors_;
        const bool is_other_way = (start >= 0 && !joins(joints()[start], first)) || (end >= 0 && !joins(joints()[end], second));
        if (is_other_way) std::swap(first, second);
        if (start >= 0 && !joins(joints()[start], first)) return not_there("from", said.from, first);
        if (end >= 0 && !joins(joints()[end], second)) return not_there("to", said.to, second);
        if (start < 0 && !find_only("from", first, end, start)) return errors_;
        if (end < 0 && !find_only("to", second, start, end)) return errors_;
        if (start == end) return fail("`from` and `to` are the same joint");
        return add(first, start, second, end, out);
    }

private:
    const std::vector<Joint>& joints() const { return model_.mechanism.joints; }
    std::string name_of(int body) const { return body == measure::world ? "the world" : "`" + model_.bodies[body].name + "`"; }

    Errors fail(const std::string& message) {
        errors_.push_back({ErrorCode::inconsistent, from_.where.empty() ? "joint `" + from_.name + "`" : from_.where + "/assemble",
                           "`assemble` of joint `" + from_.name + "`: " + message});
        return errors_;
    }

    Errors not_there(const std::string& key, const std::string& name, int body) {
        return fail("`" + key + "` is a joint at the other end of one of its two bodies, `to` at that of the other; `" + name +
                    "` does not join " + name_of(body));
    }

    bool find(const std::string& name, int& found) {
        for (int i = 0; i < count_of(joints()); ++i)
            if (joints()[i].name == name && i != middle_) found = i;
        if (found < 0)
            fail("no other joint is called `" + name + "`");
        else if (!can_end_leg(joints()[found]))
            fail("`" + name + "` has neither a point nor a slide: a revolute, ball, cylindrical, screw or prismatic joint is expected");
        return errors_.empty();
    }

    // The only joint of this body besides.
    bool find_only(const std::string& key, int body, int besides, int& found) {
        std::string all;
        int count = 0;
        for (int i = 0; i < count_of(joints()); ++i) {
            if (i == middle_ || i == besides || !joins(joints()[i], body) || !can_end_leg(joints()[i])) continue;
            found = i;
            all += (count++ == 0 ? "`" : ", `") + joints()[i].name + "`";
        }
        if (count != 1)
            fail("`" + key + "` is expected, " +
                 (count == 0 ? "but no other joint is at " + name_of(body) : "one of the joints of " + name_of(body) + ": " + all));
        return count == 1;
    }

    Errors add(int first, int start, int second, int end, std::vector<Branch>& out) {
        const AssembleSide side = from_.assemble->side;
        const bool along = side == AssembleSide::ahead || side == AssembleSide::behind;
        Branch branch;
        branch.from = start;
        branch.joint = middle_;
        branch.to = end;
        branch.sign = side == AssembleSide::left || side == AssembleSide::ahead ? 1 : -1;
        int count = 0;
        for (const auto& [joint, slide] :
             {std::pair{start, Branch::Slide::from}, {middle_, Branch::Slide::middle}, {end, Branch::Slide::to}})
            if (slides(joints()[joint])) branch.slide = slide, ++count;
        if (along ? count != 1 : count != 0)
            return fail(count == 0   ? "`left` or `right` is expected: none of the three joints slides"
                        : count == 1 ? "`ahead` or `behind` is expected: one of the three joints slides"
                                     : "there is nothing to choose where two of the three joints slide");
        branch.start = frame_on(joints()[start], first);
        branch.first = frame_on(joints()[middle_], first);
        branch.second = frame_on(joints()[middle_], second);
        branch.end = frame_on(joints()[end], second);
        const std::vector<int> cut{start, middle_, end};
        branch.with_first = carried(first, second, cut);
        branch.with_second = carried(second, first, cut);
        if (!has_legs(branch)) return fail("a leg has no length: two of the three joints are on one line along the axis");
        out.push_back(std::move(branch));
        return {};
    }

    // Does every leg that is fixed in one body have a length?
    bool has_legs(const Branch& branch) const {
        const std::vector<measure::Frame>& frames = model_.mechanism.set.frames;
        const auto leg = [&](int from, int to, int axis) {
            const Vector3 n = frames[axis].axes.col(2), v = frames[to].point - frames[from].point;
            return Vector3(v - n * n.dot(v)).norm() > 1e-9 * model_.diagonal;
        };
        const bool needs_first = branch.slide == Branch::Slide::none || branch.slide == Branch::Slide::to;
        const bool needs_second = branch.slide == Branch::Slide::none || branch.slide == Branch::Slide::from;
        return (!needs_first || leg(branch.start, branch.first, branch.first)) &&
               (!needs_second || leg(branch.second, branch.end, branch.second));
    }

    bool is_movable(int body) const {
        for (int k = 0; k < 6; ++k)
            if (body != measure::world && is_free(model_.bodies[body], k)) return true;
        return false;
    }

    // All that hangs on a body by joints other than these; where that is joined to something else again, only what is fixed to it.
    std::vector<int> carried(int body, int other, const std::vector<int>& cut) const {
        if (body == measure::world) return {};
        for (const bool all : {true, false}) {
            std::set<int> found{body};
            bool is_loose = true;
            for (bool grows = true; grows;) {
                grows = false;
                for (int i = 0; i < count_of(joints()); ++i) {
                    const Joint& joint = joints()[i];
                    if (!has_ends(joint) || std::find(cut.begin(), cut.end(), i) != cut.end()) continue;
                    if (!all && joint.kind != JointKind::fixed) continue;
                    if (found.count(joint.a) == found.count(joint.b)) continue;
                    const int next = found.count(joint.a) != 0 ? joint.b : joint.a;
                    if (next == other || !is_movable(next)) {
                        is_loose = false;
                        continue;
                    }
                    found.insert(next);
                    grows = true;
                }
            }
            if (is_loose || !all) return {found.begin(), found.end()};
        }
        return {body};
    }

    const scene::Joint& from_;
    const Model& model_;
    const int middle_;
    Errors errors_;
};

// Finds the pairs of bodies that a motor's motion leaves two places for (dyads), one after another outwards from what does not move.
class OpenSides {
public:
    explicit OpenSides(const Model& model) : model_(model), poses_(start_poses(model)) {
        const int bodies = count_of(model.bodies);
        is_placed_.assign(bodies, false);
        for (int i = 0; i < bodies; ++i) {
            is_placed_[i] = true;
            for (int k = 0; k < 6; ++k)
                if (is_free(model.bodies[i], k)) is_placed_[i] = false;
        }
        for (const Joint& motor : joints())
            for (const Joint& joint : joints())
                if (motor.is_motor && !joint.is_motor && has_ends(joint) && joint.frame_a == motor.frame_a &&
                    joint.frame_b == motor.frame_b)
                    driven_.insert(joint.name);
        for (const Branch& branch : model.mechanism.branches) said_.insert(joints()[branch.joint].name);
    }

    void find() {
        while (place_driven() || place_pair()) {
        }
    }
    const std::vector<JointSide>& sides() const { return found_; }
    const std::vector<Branch>& branches() const { return branches_; }

private:
    const std::vector<Joint>& joints() const { return model_.mechanism.joints; }
    bool is_placed(int body) const { return body == measure::world || is_placed_[body]; }

    // The joints between a body and another, or between it and what is placed (`other` is the world).
    std::vector<int> between(int body, int other) const {
        std::vector<int> all;
        for (int i = 0; i < count_of(joints()); ++i) {
            if (joints()[i].is_motor || !joins(joints()[i], body)) continue;
            const int beyond = joints()[i].a == body ? joints()[i].b : joints()[i].a;
            if (other == measure::world ? is_placed(beyond) : beyond == other) all.push_back(i);
        }
        return all;
    }

    bool place_driven() {
        for (int i = 0; i < count_of(joints()); ++i) {
            const Joint& joint = joints()[i];
            if (joint.is_motor || !has_ends(joint) || is_placed(joint.a) == is_placed(joint.b)) continue;
            const int body = is_placed(joint.a) ? joint.b : joint.a;
            if (joint.kind != JointKind::fixed && driven_.count(joint.name) == 0 && between(body, measure::world).size() < 2) continue;
            is_placed_[body] = true;
            return true;
        }
        return false;
    }

    bool place_pair() {
        for (int i = 0; i < count_of(joints()); ++i) {
            const Joint& joint = joints()[i];
            if (joint.is_motor || !has_ends(joint) || is_placed(joint.a) || is_placed(joint.b)) continue;
            const std::vector<int> from = between(joint.a, measure::world), to = between(joint.b, measure::world);
            if (from.size() != 1 || to.size() != 1 || between(joint.a, joint.b).size() != 1) continue;
            add(from.front(), i, to.front());
            is_placed_[joint.a] = is_placed_[joint.b] = true;
            return true;
        }
        return false;
    }

    Vector3 axis(int joint) const {
        const Joint& j = joints()[joint];
        return placed(model_.mechanism.set.frames, poses_)[j.frame_b].axes.col(2);
    }

    bool is_in_a_plane(const std::vector<int>& three) const {
        constexpr double nearly = 1e-6;
        std::optional<Vector3> normal;
        int slides_seen = 0;
        for (const int joint : three) {
            if (joints()[joint].kind != JointKind::revolute && !slides(joints()[joint])) return false;
            if (slides(joints()[joint])) {
                ++slides_seen;
                continue;
            }
            if (normal && normal->cross(axis(joint)).norm() > nearly) return false;
            normal = axis(joint);
        }
        return slides_seen == 0 || (slides_seen == 1 && std::all_of(three.begin(), three.end(), [&](int joint) {
                                        return !slides(joints()[joint]) || std::abs(normal->dot(axis(joint))) < nearly;
                                    }));
    }

    void add(int from, int middle, int to) {
        const std::vector<int> three{from, middle, to};
        const std::string& name = joints()[middle].name;
        if (said_.count(name) != 0 || driven_.count(name) != 0 || !is_in_a_plane(three)) return;
        const bool along = std::any_of(three.begin(), three.end(), [&](int joint) { return slides(joints()[joint]); });
        scene::Joint joint;
        joint.name = name;
        joint.kind = joints()[middle].kind;
        joint.assemble = scene::Assemble{along ? AssembleSide::ahead : AssembleSide::left, joints()[from].name, joints()[to].name};
        std::vector<Branch> branch;
        if (!BranchBuilder(joint, middle, model_).build(branch).empty()) return;
        const double side = side_of(branch.front(), placed(model_.mechanism.set.frames, poses_));
        constexpr double dead_centre = 1e-6;
        if (!(std::abs(side) > dead_centre)) return;
        if (side < 0) joint.assemble->side = along ? AssembleSide::behind : AssembleSide::right;
        branch.front().sign = side < 0 ? -1 : 1;
        branches_.push_back(branch.front());
        found_.push_back({name, *joint.assemble});
    }

    const Model& model_;
    std::vector<kinematics::Pose> poses_;
    std::vector<bool> is_placed_;
    std::set<std::string> driven_, said_;
    std::vector<JointSide> found_;
    std::vector<Branch> branches_;
};

}  // namespace

std::vector<JointSide> sides_left_open(const Model& model) {
    OpenSides open(model);
    open.find();
    return open.sides();
}

std::vector<Branch> branches_left_open(const Model& model) {
    OpenSides open(model);
    open.find();
    return open.branches();
}

Errors add_branches(const scene::Scene& scene, Model& model) {
    Errors errors;
    for (const scene::Joint& from : scene.mechanism.joints) {
        if (!from.assemble) continue;
        const std::vector<Joint>& joints = model.mechanism.joints;
        const auto middle = std::find_if(joints.begin(), joints.end(), [&](const Joint& joint) { return joint.name == from.name; });
        const Errors more = BranchBuilder(from, static_cast<int>(middle - joints.begin()), model).build(model.mechanism.branches);
        errors.insert(errors.end(), more.begin(), more.end());
    }
    return errors;
}

const char* to_string(AssembleSide side) {
    switch (side) {
        case AssembleSide::left:
            return "left";
        case AssembleSide::right:
            return "right";
        case AssembleSide::ahead:
            return "ahead";
        case AssembleSide::behind:
            return "behind";
    }
    return "unknown";
}

AssembleSide other_side(AssembleSide side) {
    switch (side) {
        case AssembleSide::left:
            return AssembleSide::right;
        case AssembleSide::right:
            return AssembleSide::left;
        case AssembleSide::ahead:
            return AssembleSide::behind;
        case AssembleSide::behind:
            return AssembleSide::ahead;
    }
    return side;
}

std::vector<kinematics::Pose> start_poses(const Model& model) {
    std::vector<kinematics::Pose> out;
    for (const Body& body : model.bodies) out.push_back(body.pose_start);
    return out;
}

std::string words_of_side(const Mechanism& mechanism, const Branch& branch, double sign) {
    const auto name = [&](int joint) { return "`" + mechanism.joints[joint].name + "`"; };
    const std::string from = name(branch.from), middle = name(branch.joint), to = name(branch.to);
    if (branch.slide == Branch::Slide::none)
        return "the way from " + from + " over " + middle + " to " + to + " turns " + (sign > 0 ? "left" : "right");
    const char* side = sign > 0 ? " is ahead of " : " is behind ";
    if (branch.slide == Branch::Slide::to) return middle + side + from + " along " + to;
    if (branch.slide == Branch::Slide::from) return to + side + middle + " along " + from;
    return to + side + from + " along " + middle;
}

bool is_on_side(const Mechanism& mechanism, const Branch& branch, const std::vector<kinematics::Pose>& poses) {
    return branch.sign * side_of(branch, placed(mechanism.set.frames, poses)) > 0;
}

}  // namespace fettle::core::model
