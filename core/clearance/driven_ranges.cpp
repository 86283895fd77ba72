// SPDX-License-Identifier: MIT
#include "core/clearance/driven_ranges.hpp"

#include <algorithm>
#include <set>
#include <string>

#include "core/base/text.hpp"
#include "core/model/limits.hpp"
#include "core/scene/curve.hpp"

namespace fettle::core::clearance {
namespace {

using base::ErrorCode;
using base::Errors;
using certificate::JointCoordinate;
using certificate::LinkageCoordinate;
using certificate::Screw;
using model::Joint;
using scene::Curve;

Curve curve_of(const scene::MotionCurve& script) {
    return {scene::CurveKind::linear, script.rate, script.times, script.values, script.stop_time};
}

bool is_even(const Curve& curve) { return curve.values.empty(); }

bool moves(const Curve& curve) {
    if (curve.rate != 0) return true;
    return std::any_of(curve.values.begin(), curve.values.end(), [&](double value) { return value != curve.values.front(); });
}

double running_time(const Curve& curve, double duration) { return std::min(duration, curve.stop_time.value_or(duration)); }

// The extent of u(t) - u(0) over the duration.
std::array<double, 2> extent(const Curve& curve, double duration) {
    const double start = curve_value(curve, 0);
    std::array<double, 2> out{0, 0};
    for (const double time : turning_times(curve, duration)) {
        const double value = curve_value(curve, time) - start;
        out = {std::min(out[0], value), std::max(out[1], value)};
    }
    return out;
}

class DrivenRanges {
public:
    DrivenRanges(const model::Model& model, double duration) : model_(model), duration_(duration) {}

    base::Result<LoopedRanges> run() {
        const auto& joints = model_.mechanism.joints;
        const bool has_joints = std::any_of(joints.begin(), joints.end(), [](const Joint& j) { return !j.is_motor && j.frame_a >= 0; });
        if (has_joints) {
            base::Result<LoopedRanges> pinned = looped_ranges(model_, true);
            if (!pinned) return pinned.errors();
            out_ = *std::move(pinned);
        } else {
            out_.ranges.linkage.bodies.resize(model_.bodies.size());
            out_.ranges.joint_of.assign(model_.bodies.size(), -1);
        }
        take_motors();
        take_scripts();
        check_driven();
        std::erase_if(out_.driven, [](const DrivenSource& source) { return !moves(source.curve); });
        if (errors_.empty() && out_.driven.empty())
            fail(ErrorCode::missing_key, "motion", "no motor and no script moves anything as drawn: leave out --kinematic");
        if (!errors_.empty()) return errors_;
        find_screws();
        settle();
        if (!errors_.empty()) return errors_;
        out_.of = LoopedRanges::Of::motion;
        out_.duration = duration_;
        return std::move(out_);
    }

private:
    LinkageCoordinate& coordinate(int k) { return out_.ranges.linkage.coordinates[k]; }
    void fail(ErrorCode code, const std::string& where, const std::string& message) { errors_.push_back({code, where, message}); }

    void take_motors() {
        for (const constraint::Row& row : model_.mechanism.rows) {
            if (row.owner < 0 || !model_.mechanism.joints[row.owner].is_motor) continue;
            const Joint& motor = model_.mechanism.joints[row.owner];
            for (int k = 0; k < count_of(out_.ranges.linkage.coordinates); ++k)
                for (const JointCoordinate& joint : coordinate(k).joints)
                    if (is_of(joint.joint, motor) && row.parts.size() == 1)
                        out_.driven.push_back({.name = motor.name,
                                               .motor = motor.origin.index,
                                               .curve = row.curve,
                                               .coordinate = k,
                                               .units = 1 / (joint.scale * row.parts.front().factor)});
        }
    }
    bool is_of(const std::string& joint, const Joint& motor) const {
        return std::any_of(model_.mechanism.joints.begin(), model_.mechanism.joints.end(), [&](const Joint& each) {
            return !each.is_motor && each.name == joint && each.coordinate >= 0 && each.coordinate == motor.coordinate;
        });
    }

    void take_scripts() {
        for (int i = 0; i < count_of(model_.bodies); ++i) {
            const model::Body& body = model_.bodies[i];
            if (body.type == scene::BodyType::static_body || out_.ranges.joint_of[i] >= 0) continue;
            if (!body.script.empty()) {
                fail(ErrorCode::unsupported, "body `" + body.name + "`",
                     "goes through poses at times: within tolerances a scripted body goes at even speed, or along one coordinate");
                continue;
            }
            const bool is_prescribed =
                std::all_of(body.prescribed.begin(), body.prescribed.end(), [](const auto& dof) { return dof.has_value(); });
            if (is_prescribed) take_script(i, body);
            if (!is_prescribed && out_.ranges.linkage.bodies[i].parent < 0 && out_.ranges.linkage.bodies[i].screws.empty())
                out_.ranges.held.push_back(body.name);
        }
        std::sort(out_.ranges.held.begin(), out_.ranges.held.end());
        out_.ranges.held.erase(std::unique(out_.ranges.held.begin(), out_.ranges.held.end()), out_.ranges.held.end());
    }

    // At even speed along and about axes that stay; or along or about one of the world's, by a table.
    void take_script(int i, const model::Body& body) {
        Vector6 rates = Vector6::Zero();
        std::vector<int> moving;
        for (int dof = 0; dof < 6; ++dof) {
            const Curve curve = curve_of(*body.prescribed[static_cast<std::size_t>(dof)]);
            if (!moves(curve)) continue;
            moving.push_back(dof);
            rates[dof] = curve.rate;
        }
        if (moving.empty()) return;
        Curve curve = curve_of(*body.prescribed[static_cast<std::size_t>(moving.front())]);
        if (moving.size() > 1) {
            const bool is_together = std::all_of(moving.begin(), moving.end(), [&](int dof) {
                const scene::MotionCurve& other = *body.prescribed[static_cast<std::size_t>(dof)];
                return other.values.empty() && other.stop_time == curve.stop_time;
            });
            if (!is_together) {
                fail(ErrorCode::unsupported, "body `" + body.name + "`",
                     "several of its coordinates move, and one by a table: within tolerances a scripted body goes at even speed, or along "
                     "one coordinate");
                return;
            }
            curve.rate = 1;
        } else {
            rates.setZero();
            rates[moving.front()] = 1;
        }
        LinkageCoordinate own;
        const int k = count_of(out_.ranges.linkage.coordinates);
        auto& screws = out_.ranges.linkage.bodies[i].screws;
        const Vector3 way = rates.head<3>(), turn = rates.tail<3>();
        if (way.norm() > 0) {
            screws.push_back({k, body.pose_start.position, way.normalized(), 0, way.norm()});
            own.joints.push_back({body.name, false, way.norm(), 0});
        }
        if (turn.norm() > 0) {
            screws.push_back({k, body.pose_start.position, turn.normalized(), turn.norm(), 0});
            own.joints.push_back({body.name + (way.norm() > 0 ? " (turn)" : ""), true, turn.norm(), 0});
        }
        out_.ranges.linkage.coordinates.push_back(own);
        out_.driven.push_back(
            {.name = body.name, .body = i, .dof = moving.size() == 1 ? moving.front() : -1, .curve = curve, .coordinate = k});
    }

    void check_driven() {
        std::set<int> known;
        for (const DrivenSource& source : out_.driven) known.insert(source.coordinate);
        for (const ClosedLoop& loop : out_.loops) known.insert(loop.unknowns.begin(), loop.unknowns.end());
        for (int k = 0; k < count_of(out_.ranges.linkage.coordinates); ++k)
            if (known.count(k) == 0)
                fail(
                    ErrorCode::missing_key, "joint `" + coordinate(k).joints.front().joint + "`",
                    "no motor drives it, and no loop: where it is would be decided by dynamics. Give it a motor (with speed 0 it is held)");
    }

    void find_screws() {
        const auto& bodies = out_.ranges.linkage.bodies;
        for (DrivenSource& source : out_.driven)
            for (int i = 0; i < count_of(bodies); ++i)
                for (int k = 0; k < count_of(bodies[i].screws); ++k)
                    if (bodies[i].screws[k].coordinate == source.coordinate) source.screws.emplace_back(i, k);
    }

    void settle() {
        if (out_.driven.size() > 1) return share_time();
        const DrivenSource& source = out_.driven.front();
        const bool is_known = is_even(source.curve) || source.curve.kind == scene::CurveKind::linear ||
                              (source.curve.kind == scene::CurveKind::trapezoid && source.curve.rate == 0);
        if (!is_known) {
            fail(ErrorCode::unsupported, "`" + source.name + "`",
                 "goes by a curved table, whose extent is not known exactly: within tolerances say linear, or trapezoid alone, or limits "
                 "and "
                 "--ranges");
            return;
        }
        const auto [low, high] = extent(source.curve, duration_);
        LinkageCoordinate& driven = coordinate(source.coordinate);
        driven.low = driven.start + std::min(source.units * low, source.units * high);
        driven.high = driven.start + std::max(source.units * low, source.units * high);
        check_limits(driven);
    }

    // They say where a joint can be, whatever drives it.
    void check_limits(const LinkageCoordinate& driven) {
        for (const JointCoordinate& of : driven.joints)
            for (const Joint& joint : model_.mechanism.joints) {
                if (joint.is_motor || joint.name != of.joint || joint.coordinate < 0) continue;
                const bool is_beyond = std::any_of(model_.mechanism.terms.begin(), model_.mechanism.terms.end(), [&](const auto& term) {
                    if (term.kind != model::LawKind::stop || term.measure != joint.coordinate) return false;
                    const double room = std::min(room_within(term, of.scale * driven.low + of.offset),
                                                 room_within(term, of.scale * driven.high + of.offset));
                    return room < -model::at_limit * model_.dhat;
                });
                if (!is_beyond) continue;
                const std::array<double, 2> limits = *limits_of(model_.mechanism, joint.coordinate);
                fail(ErrorCode::out_of_range, "joint `" + joint.name + "`",
                     "is led beyond its limits, " + model::range_text(model_, joint.coordinate, limits[0], limits[1]) +
                         ": let what drives it end before, or widen `limits`");
            }
    }

    // All that moves, by the time.
    void share_time() {
        const Curve& first = out_.driven.front().curve;
        for (const DrivenSource& source : out_.driven)
            if (!is_even(source.curve) || source.curve.stop_time != first.stop_time) {
                fail(
                    ErrorCode::unsupported, "`" + source.name + "`",
                    "does not go at even speed from the start to the end, and it is not the only one that moves: within tolerances several "
                    "motors and scripts go at even speed");
                return;
            }
        LinkageCoordinate time;
        time.high = running_time(first, duration_);
        const int shared = out_.driven.front().coordinate;
        std::vector<double> rates(out_.ranges.linkage.coordinates.size(), 0);
        for (const DrivenSource& source : out_.driven) {
            const double rate = source.curve.rate * source.units;
            rates[source.coordinate] = rate;
            const LinkageCoordinate& own = coordinate(source.coordinate);
            for (const JointCoordinate& joint : own.joints)
                time.joints.push_back({joint.joint, joint.is_angle, joint.scale * rate, joint.scale * own.start + joint.offset});
        }
        for (certificate::LinkedBody& body : out_.ranges.linkage.bodies)
            for (Screw& screw : body.screws) {
                const double rate = rates[screw.coordinate];
                if (rate == 0) continue;
                screw.turn *= rate;
                screw.slide *= rate;
                screw.coordinate = shared;
            }
        for (ClosedLoop& loop : out_.loops)
            if (rates[loop.driver] != 0) loop.driver = shared;
        coordinate(shared) = time;
        check_limits(time);
        for (DrivenSource& source : out_.driven) source.coordinate = shared;
    }

    const model::Model& model_;
    double duration_;
    LoopedRanges out_;
    Errors errors_;
};

}  // namespace

std::vector<double> turning_times(const Curve& curve, double duration) {
    const double last = running_time(curve, duration);
    std::vector<double> out{0};
    for (const double time : curve.times)
        if (time > 0 && time < last) out.push_back(time);
    out.push_back(last);
    return out;
}

base::Result<LoopedRanges> driven_ranges(const model::Model& model, double duration) { return DrivenRanges(model, duration).run(); }

}  // namespace fettle::core::clearance
