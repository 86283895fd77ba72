// SPDX-License-Identifier: MIT
#include "core/clearance/joint_ranges.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>

#include "core/base/limits.hpp"
#include "core/base/text.hpp"
#include "core/constraint/whole_turns.hpp"
#include "core/model/limits.hpp"
#include "core/model/row_choice.hpp"

namespace fettle::core::clearance {
namespace {

using base::ErrorCode;
using base::Errors;
using certificate::JointCoordinate;
using certificate::LinkageCoordinate;
using certificate::Screw;
using model::Joint;
using scene::JointKind;

constexpr double pi = std::numbers::pi;
constexpr double covered = 1 + 1e-15;  // a turn in spite of rounding
constexpr double least_left = 1e-2;    // of a joint's own range, by the limits of what follows it

bool is_held(const model::Body& body) {
    for (int k = 0; k < 6; ++k) {
        if (model::is_free(body, k)) return false;
        const scene::MotionCurve& curve = *body.prescribed[k];
        const bool still = std::all_of(curve.values.begin(), curve.values.end(), [](double u) { return u == 0; });
        if (curve.rate != 0 || !still) return false;
    }
    return true;
}

// What all joints come to: scale u + offset of a coordinate u that is free.
struct Affine {
    int free = 0;  // place in the list of variables
    double scale = 1, offset = 0;
};

// A coordinate of a joint, with the number of its measure; -1: it has none that gears or limits are about.
struct Variable {
    const Joint* joint = nullptr;
    int measure = -1;
    bool is_angle = false;
    double start = 0;
    Affine is;
    const char* what = "";                              // of the joint's coordinates, where it has more than one
    std::optional<std::array<double, 2>> between = {};  // its range, whatever limits there are
    int direction = -1;                                 // of a swing: the variable that is its direction
    bool is_limited = false;                            // the range is one that the scene states
};

// Axes that are as good as one [rad].
constexpr double one_axis = 1e-12;

class RangeBuilder {
public:
    RangeBuilder(const model::Model& model, std::optional<double> reach) : model_(model), reach_(reach) {
        for (const model::Body& body : model.bodies) poses_.push_back(body.pose_start);
        frames_ = placed(model.mechanism.set.frames, poses_);
    }

    base::Result<JointRanges> build() {
        for (const Joint& joint : model_.mechanism.joints)
            if (!joint.is_motor && joint.frame_a >= 0) joints_.push_back(&joint);
        if (joints_.empty())
            return base::Error{ErrorCode::missing_key, "joints", "there is no joint that moves, so there are no positions to look at"};
        out_.linkage.bodies.resize(model_.bodies.size());
        out_.joint_of.assign(model_.bodies.size(), -1);
        check_joints();
        if (errors_.empty()) hang_bodies();
        if (errors_.empty()) couple();
        if (errors_.empty()) bound();
        if (!errors_.empty()) return errors_;
        return std::move(out_);
    }

private:
    void fail(ErrorCode code, const std::string& joint, const std::string& message) {
        errors_.push_back({code, "joint `" + joint + "`", message});
    }

    bool is_world(int body) const {
        if (body < 0) return true;
        const model::Body& b = model_.bodies[body];
        return b.type == scene::BodyType::static_body || is_held(b);
    }

    const std::string& name_of(int body) const { return model_.bodies[body].name; }

    void check_joints() {
        for (const Joint* joint : joints_) {
            for (const int body : {joint->a, joint->b}) {
                if (is_world(body)) continue;
                const model::Body& b = model_.bodies[body];
                bool free = b.type == scene::BodyType::dynamic_body;
                for (int k = 0; k < 6; ++k) free = free && model::is_free(b, k);
                if (!free)
                    fail(
                        ErrorCode::unsupported, joint->name,
                        "coordinates of `" + b.name + "` are prescribed beside its joints: ranges work with bodies that joints alone hold");
            }
        }
    }

    // Trees from the world, then from the first body of each part that is not attached to the world.
    void hang_bodies() {
        std::vector<bool> reached(model_.bodies.size(), false);
        std::vector<bool> used(joints_.size(), false);
        std::vector<int> pending;
        for (int i = 0; i < count_of(model_.bodies); ++i) reached[i] = is_world(i);
        grow(-1, reached, used, pending);
        for (int i = 0; i < count_of(model_.bodies); ++i) {
            if (reached[i]) continue;
            out_.held.push_back(name_of(i));
            reached[i] = true;
            grow(i, reached, used, pending);
        }
    }

    void grow(int root, std::vector<bool>& reached, std::vector<bool>& used, std::vector<int>& pending) {
        pending.assign(1, root);
        while (!pending.empty()) {
            const int at = pending.front();
            pending.erase(pending.begin());
            const auto is_at = [&](int body) { return at < 0 ? is_world(body) : body == at; };
            for (std::size_t k = 0; k < joints_.size(); ++k) {
                const Joint& joint = *joints_[k];
                if (used[k] || (!is_at(joint.a) && !is_at(joint.b))) continue;
                used[k] = true;
                const int other = is_at(joint.a) ? joint.b : joint.a;
                if (is_at(other)) continue;  // between two things that do not move
                if (reached[other]) {
                    name_loop(joint, at, other);
                    continue;
                }
                reached[other] = true;
                hang(joint, at, other);
                pending.push_back(other);
            }
        }
    }

    std::vector<const Joint*> line_of(int body) const {
        std::vector<const Joint*> out;
        for (int at = body; at >= 0; at = out_.linkage.bodies[at].parent) {
            const auto by = hung_by_.find(at);
            if (by != hung_by_.end()) out.push_back(by->second);
        }
        return out;
    }

    void name_loop(const Joint& joint, int a, int b) {
        std::vector<const Joint*> line = line_of(a), other = line_of(b);
        while (!line.empty() && !other.empty() && line.back() == other.back()) {
            line.pop_back();
            other.pop_back();
        }
        line.insert(line.end(), other.rbegin(), other.rend());
        std::string names = "`" + joint.name + "`";
        for (const Joint* each : line) names += ", `" + each->name + "`";
        fail(ErrorCode::unsupported, joint.name,
             "closes a loop (" + names +
                 "), whose positions depend on one another: this works with trees. `fettle clearance --ranges` takes loops of revolute "
                 "joints that one motor drives, --kinematic and --motion go along a motion");
    }

    void hang(const Joint& joint, int parent, int body) {
        certificate::LinkedBody& link = out_.linkage.bodies[body];
        link.parent = parent;
        hung_by_[body] = &joint;
        if (joint.kind == JointKind::fixed) return;
        out_.joint_of[body] = static_cast<int>(&joint - model_.mechanism.joints.data());
        const std::vector<Screw> from_a = screws_of(joint);
        link.screws = body == joint.b ? from_a : reversed(from_a);
    }

    // What carries b, seen from a, by the joint's coordinates; outermost first.
    std::vector<Screw> screws_of(const Joint& joint) {
        if (joint.kind == JointKind::ball) return screws_of_ball(joint);
        if (joint.kind == JointKind::planar) return screws_of_planar(joint);
        const measure::PlacedFrame& frame = frames_[joint.frame_a];
        Screw screw{0, frame.point, frame.axes.col(2), 0, 0};
        const bool turns = joint.kind == JointKind::revolute || joint.kind == JointKind::screw;
        screw.coordinate = add_variable(joint, joint.coordinate, turns);
        (turns ? screw.turn : screw.slide) = 1;
        if (joint.kind == JointKind::screw) screw.slide = slide_of_screw(joint);
        if (joint.kind != JointKind::cylindrical) return {screw};
        Screw turn = screw;
        turn.coordinate = add_free(joint, " (turn)", whole_turn());
        turn.turn = 1;
        turn.slide = 0;
        return {screw, turn};
    }

    // The same of a, seen from b. Two along one axis keep their order, which makes no difference.
    static std::vector<Screw> reversed(std::vector<Screw> screws) {
        if (screws.size() > 2) std::reverse(screws.begin(), screws.end());
        for (Screw& screw : screws) {
            screw.turn = -screw.turn;
            screw.slide = -screw.slide;
        }
        return screws;
    }

    // b's axis swings from a's in some direction, and b is turned about it: all that b can be turned to, with that swing at most.
    std::vector<Screw> screws_of_ball(const Joint& joint) {
        const measure::PlacedFrame &a = frames_[joint.frame_a], &b = frames_[joint.frame_b];
        const Vector3 axis_a = a.axes.col(2), axis_b = b.axes.col(2), across = axis_a.cross(axis_b);
        const double sine = across.norm(), swing = std::atan2(sine, axis_a.dot(axis_b));
        const bool are_one = swing < one_axis || swing > pi - one_axis;
        const std::optional<double> most = swing_of(joint);
        const int direction = add_free(joint, " (direction)", whole_turn());
        const int swings = add_free(joint, "", {0, most.value_or(pi * covered)});
        variables_[swings].start = swing < one_axis ? 0 : swing;
        variables_[swings].direction = direction;
        variables_[swings].is_limited = most.has_value();
        const int turn = add_free(joint, " (turn)", whole_turn());
        return {{direction, a.point, axis_a, 1, 0},
                {swings, a.point, are_one ? Vector3(a.axes.col(1)) : Vector3(across / sine), 1, 0},
                {turn, a.point, are_one && swing < 1 ? axis_a : axis_b, 1, 0}};
    }

    std::optional<double> swing_of(const Joint& joint) const {
        for (const model::MeasureTerm& term : model_.mechanism.terms)
            if (term.kind == model::LawKind::stop && model::is_swing(model_.mechanism, term) && is_of(term, joint))
                return std::acos(term.reference);
        return std::nullopt;
    }

    static bool is_of(const model::MeasureTerm& term, const Joint& joint) {
        return term.origin.list == joint.origin.list && term.origin.index == joint.origin.index;
    }

    // b's point slides along two axes of a, and b turns about it.
    std::vector<Screw> screws_of_planar(const Joint& joint) {
        const measure::PlacedFrame &a = frames_[joint.frame_a], &b = frames_[joint.frame_b];
        std::vector<Screw> out;
        for (const int k : {0, 1}) {
            const Vector3 axis = a.axes.col(k);
            const int slide = add_variable(joint, -1, false);
            variables_[slide].what = k == 0 ? " (x)" : " (y)";
            variables_[slide].start = axis.dot(b.point - a.point);
            out.push_back({slide, a.point, axis, 0, 1});
        }
        out.push_back({add_free(joint, " (turn)", whole_turn()), b.point, a.axes.col(2), 1, 0});
        return out;
    }

    static std::array<double, 2> whole_turn() { return {-pi * covered, pi * covered}; }

    // An angle that nothing couples to others.
    int add_free(const Joint& joint, const char* what, const std::array<double, 2>& between) {
        const int place = add_variable(joint, -1, true);
        variables_[place].what = what;
        variables_[place].between = between;
        return place;
    }

    int add_variable(const Joint& joint, int measure, bool is_angle) {
        const auto place = count_of(variables_);
        double start = 0;
        if (measure >= 0) {
            const auto m = static_cast<std::size_t>(measure);
            start = is_angle ? model_.mechanism.angles_start[m] : value_of(model_.mechanism.set.measures[m], frames_);
        }
        variables_.push_back({&joint, measure, is_angle, start, {place, 1, 0}});
        return place;
    }

    template <class Visit>
    void for_rows(const Visit& visit) const {
        for (const constraint::Row& row : all_rows(model_.mechanism)) visit(row, model_.mechanism.joints[row.owner]);
    }

    // [m] per radian: the row is slide + factor angle = constant.
    double slide_of_screw(const Joint& joint) const {
        double out = 0;
        for_rows([&](const constraint::Row& row, const Joint& owner) {
            if (&owner == &joint && row.parts.size() == 2) out = -row.parts[1].factor;
        });
        return out;
    }

    int variable_of(int measure) const {
        for (std::size_t i = 0; i < variables_.size(); ++i)
            if (variables_[i].measure == measure) return static_cast<int>(i);
        return -1;
    }

    // Gears and racks: factor_0 m_0 + factor_1 m_1 = constant.
    void couple() {
        for_rows([&](const constraint::Row& row, const Joint& owner) {
            if (!couples_joints(owner.kind)) return;
            const int first = variable_of(row.parts[0].measure), second = variable_of(row.parts[1].measure);
            if (first < 0 || second < 0) return;  // of joints between what does not move
            const Affine a = variables_[first].is, b = variables_[second].is;
            const double f = row.parts[0].factor, g = row.parts[1].factor;
            if (a.free == b.free) {
                if (std::abs(f * a.scale + g * b.scale) > 1e-12 * std::abs(f * a.scale))
                    fail(ErrorCode::unsupported, owner.name,
                         "couples what other gears couple already, in another ratio: it lets nothing move");
                return;
            }
            // f (a.scale u + a.offset) + g (b.scale v + b.offset) = constant; v follows u.
            const double scale = -f * a.scale / (g * b.scale), offset = (row.constant - f * a.offset - g * b.offset) / (g * b.scale);
            for (Variable& each : variables_)
                if (each.is.free == b.free) each.is = {a.free, each.is.scale * scale, each.is.scale * offset + each.is.offset};
        });
    }

    void bound() {
        std::vector<int> place(variables_.size(), -1);
        for (std::size_t i = 0; i < variables_.size(); ++i) {
            if (variables_[i].is.free != static_cast<int>(i)) continue;
            place[i] = count_of(out_.linkage.coordinates);
            const Variable& variable = variables_[i];
            out_.linkage.coordinates.push_back(variable.between ? free_coordinate(variable) : coordinate_of(static_cast<int>(i)));
            out_.direction_of.push_back(variable.direction < 0 ? -1 : place[variable.direction]);
        }
        for (certificate::LinkedBody& body : out_.linkage.bodies)
            for (Screw& screw : body.screws) {
                const Affine& is = variables_[screw.coordinate].is;
                screw.coordinate = place[is.free];
                screw.turn *= is.scale;
                screw.slide *= is.scale;
            }
    }

    LinkageCoordinate free_coordinate(const Variable& variable) {
        LinkageCoordinate out;
        const auto& [low, high] = *variable.between;
        out.start = variable.start;
        out.low = std::min(low, out.start);
        out.high = std::max(high, out.start);
        out.joints = {{variable.joint->name + variable.what, true, 1, 0}};
        out.is_whole_turn = variable.direction < 0;
        out_.has_limits.push_back(variable.is_limited);
        return out;
    }

    LinkageCoordinate coordinate_of(int free) {
        LinkageCoordinate out;
        out.start = variables_[free].start;
        out.low = -base::infinity;
        out.high = base::infinity;
        apply_limits(variables_[free], out);
        const std::array<double, 2> own{out.low, out.high};
        const Variable* slides = nullptr;
        std::vector<std::string> followers;
        for (const Variable& each : variables_) {
            if (each.is.free != free) continue;
            out.joints.push_back({each.joint->name + each.what, each.is_angle, each.is.scale, each.is.offset});
            if (!each.is_angle || each.joint->kind == JointKind::screw) slides = &each;
            const std::array<double, 2> before{out.low, out.high};
            apply_limits(each, out);
            if (before != std::array{out.low, out.high}) followers.push_back("`" + each.joint->name + "`");
        }
        const bool has_limits = std::isfinite(out.low) && std::isfinite(out.high);
        out_.has_limits.push_back(has_limits);
        if (has_limits) {
            tell_narrowed(variables_[free], own, followers, out);
            // Limits are closed: what starts at one, to within rounding, starts within it (model/limits.hpp).
            out.low = std::min(out.low, out.start);
            out.high = std::max(out.high, out.start);
            return out;
        }
        const std::string& name = out.joints.front().joint;
        const std::optional<double> half = slides != nullptr ? std::nullopt : half_period(out.joints);
        if (reach_ && !half) {
            const double rate = slides == nullptr ? 0 : slides->is.scale * (slides->is_angle ? slide_of_screw(*slides->joint) : 1);
            const double either_way = rate != 0 ? *reach_ / std::abs(rate) : pi * covered;
            out.low = out.start - either_way;
            out.high = out.start + either_way;
            return out;
        }
        if (slides != nullptr && slides->joint->kind == JointKind::planar)
            fail(ErrorCode::missing_key, slides->joint->name,
                 "has no limits on its two slides, and takes none: to look at all its positions, use two prismatic joints and a revolute "
                 "one, "
                 "each with \"limits\", and small bodies between them");
        else if (slides != nullptr)
            fail(ErrorCode::missing_key, slides->joint->name,
                 "has no limits: say \"limits\": [least, greatest], or everything is possible");
        else if (!half)
            fail(ErrorCode::missing_key, name, "its gears come back to where they were after no whole number of turns: give it \"limits\"");
        out.low = out.start - half.value_or(0);
        out.high = out.start + half.value_or(0);
        out.is_whole_turn = true;
        return out;
    }

    void tell_narrowed(const Variable& drive, const std::array<double, 2>& own, const std::vector<std::string>& followers,
                       const LinkageCoordinate& out) {
        if (followers.empty() || drive.measure < 0) return;
        const double low = std::min(out.low, out.high), high = std::max(out.low, out.high);
        const std::string left = "the range of `" + drive.joint->name + "` is " + model::range_text(model_, drive.measure, low, high) +
                                 ": " + base::joined(followers) + (followers.size() > 1 ? " narrow it" : " narrows it") +
                                 (std::isfinite(own[0]) ? " from " + model::range_text(model_, drive.measure, own[0], own[1]) : "");
        const bool is_lost = !(out.high > out.low) || out.high - out.low < least_left * (own[1] - own[0]);
        (is_lost && (std::isfinite(own[0]) || !(out.high > out.low)) ? out_.lost : out_.narrowed).push_back(left);
    }

    void apply_limits(const Variable& variable, LinkageCoordinate& out) const {
        for (const model::MeasureTerm& term : model_.mechanism.terms) {
            if (term.kind != model::LawKind::stop || variable.measure < 0 || term.measure != variable.measure) continue;
            const double u = (term.reference - variable.is.offset) / variable.is.scale;
            (term.sign * variable.is.scale > 0 ? out.low : out.high) =
                term.sign * variable.is.scale > 0 ? std::max(out.low, u) : std::min(out.high, u);
        }
    }

    // Half of the turns after which all of them are where they were.
    static std::optional<double> half_period(const std::vector<JointCoordinate>& joints) {
        std::vector<double> rates;
        for (const JointCoordinate& joint : joints) rates.push_back(joint.scale);
        const std::optional<int> turns = constraint::turns_to_return(rates);
        return turns ? std::optional(*turns * pi * covered) : std::nullopt;
    }

    const model::Model& model_;
    const std::optional<double> reach_;
    std::vector<kinematics::Pose> poses_;
    std::vector<measure::PlacedFrame> frames_;
    std::vector<const Joint*> joints_;
    std::map<int, const Joint*> hung_by_;
    std::vector<Variable> variables_;
    JointRanges out_;
    Errors errors_;
};

}  // namespace

bool is_direction(const JointRanges& ranges, int coordinate) {
    return std::find(ranges.direction_of.begin(), ranges.direction_of.end(), coordinate) != ranges.direction_of.end();
}

base::Result<JointRanges> joint_ranges(const model::Model& model, std::optional<double> reach) {
    return RangeBuilder(model, reach).build();
}

}  // namespace fettle::core::clearance
