// SPDX-License-Identifier: MIT
#include "core/stepper/prescribed_path.hpp"

#include <algorithm>
#include <optional>

#include "core/base/parallel.hpp"
#include "core/stepper/rotation_lift.hpp"

namespace fettle::core::stepper {
namespace {

using kinematics::Pose;

constexpr double negligible_time = 1e-9;  // of a step

// Coordinates of one body after a share of the step.
struct Waypoint {
    double fraction = 1;
    Vector6 coordinates = Vector6::Zero();
};

Vector6 curve_increments(const scene::PrescribedMotion& prescribed, double from, double to) {
    Vector6 out = Vector6::Zero();
    for (int k = 0; k < 6; ++k)
        if (prescribed[k]) out[k] = scene::motion_value(*prescribed[k], to) - scene::motion_value(*prescribed[k], from);
    return out;
}

// One body within one step.
class BodyPath {
public:
    BodyPath(const model::Body& body, const Pose& pose, double from, double to) : body_(body), pose_(pose), from_(from), to_(to) {}

    // None where nothing is prescribed.
    std::vector<Waypoint> waypoints() const {
        const auto& prescribed = body_.prescribed;
        if (body_.script.empty() && std::none_of(prescribed.begin(), prescribed.end(), [](const auto& curve) { return bool(curve); }))
            return {};
        const std::vector<double> inside = changes();
        if (!is_scripted()) return along_curves(inside);
        if (inside.empty()) return {{1, scripted_end()}};
        return along_script(inside);
    }

private:
    bool is_scripted() const { return !body_.script.empty() && from_ < body_.script.times.back(); }

    double fraction(double time) const { return (time - from_) / (to_ - from_); }

    // Times inside the step at which the script or a curve has an entry.
    std::vector<double> changes() const {
        const double least = negligible_time * (to_ - from_);
        std::vector<double> times;
        const auto add = [&](const std::vector<double>& sorted) {
            times.insert(times.end(), std::upper_bound(sorted.begin(), sorted.end(), from_ + least),
                         std::lower_bound(sorted.begin(), sorted.end(), to_ - least));
        };
        if (is_scripted()) add(body_.script.times);
        for (const auto& curve : body_.prescribed) {
            if (!curve || (curve->rate == 0 && curve->times.empty() && body_.script.empty())) continue;
            add(curve->times);
            if (curve->stop_time) add({*curve->stop_time});
        }
        std::sort(times.begin(), times.end());
        std::vector<double> out;
        for (const double time : times)
            if (time < to_ - least && time > (out.empty() ? from_ : out.back()) + least) out.push_back(time);
        return out;
    }

    std::vector<Waypoint> along_curves(const std::vector<double>& inside) const {
        std::vector<Waypoint> out;
        out.reserve(inside.size() + 1);
        for (const double time : inside) out.push_back({fraction(time), curve_increments(body_.prescribed, from_, time)});
        out.push_back({1, curve_increments(body_.prescribed, from_, to_)});
        for (Waypoint& waypoint : out) waypoint.coordinates.head<3>() += pose_.position;
        return out;
    }

    // Up to when the script is followed: it stops with its curves.
    double followed_until(double time) const {
        const auto& stop = body_.prescribed[0] ? body_.prescribed[0]->stop_time : std::nullopt;
        const double stopped = stop ? std::min(time, std::max(from_, *stop)) : time;
        return std::min(stopped, body_.script.times.back());
    }

    // What is left of the step after the script's last pose goes on with the curves.
    Pose scripted(double time) const {
        const double end = followed_until(time);
        const Pose target = model::scripted_pose(body_, end);
        const Vector6 rest = curve_increments(body_.prescribed, end, time);
        return {kinematics::rotation(rest.tail<3>()) * target.rotation, target.position + rest.head<3>()};
    }

    // Without an entry inside the turn is no more than half of one.
    Vector6 scripted_end() const {
        const Pose end = scripted(to_);
        Vector6 out;
        out << end.position, kinematics::rotation_vector(end.rotation * pose_.rotation.transpose());
        return out;
    }

    // By its half: which way a stretch of half a turn goes is the script's to say.
    Vector3 turn_between(double begin, double end) const {
        if (begin >= body_.script.times.back()) return curve_increments(body_.prescribed, begin, end).tail<3>();
        return 2 * kinematics::rotation_vector(scripted(0.5 * (begin + end)).rotation * scripted(begin).rotation.transpose());
    }

    std::vector<Waypoint> along_script(const std::vector<double>& inside) const {
        std::vector<double> ends = inside;
        ends.push_back(to_);
        std::vector<Waypoint> out;
        Vector6 reached;
        reached << pose_.position, Vector3::Zero();
        double begin = from_;
        for (const double end : ends) {
            const Vector3 start = reached.head<3>(), arrival = scripted(end).position;
            for (const RotationNode& node : lifted_turn(reached.tail<3>(), turn_between(begin, end))) {
                reached << (node.s == 1 ? arrival : (start + node.s * (arrival - start)).eval()), node.theta;
                out.push_back({node.s == 1 && end == to_ ? 1 : fraction(begin + node.s * (end - begin)), reached});
            }
            begin = end;
        }
        return out;
    }

    const model::Body& body_;
    const Pose& pose_;
    double from_, to_;
};

Vector6 coordinates_at(const std::vector<Waypoint>& way, const Pose& start, double fraction) {
    Waypoint before{0, Vector6::Zero()};
    before.coordinates.head<3>() = start.position;
    for (const Waypoint& after : way) {
        if (fraction == after.fraction) return after.coordinates;
        if (fraction < after.fraction) {
            const double share = (fraction - before.fraction) / (after.fraction - before.fraction);
            return before.coordinates + share * (after.coordinates - before.coordinates);
        }
        before = after;
    }
    return before.coordinates;
}

}  // namespace

std::vector<PrescribedNode> prescribed_path(const model::Model& model, const std::vector<Pose>& poses, double time) {
    constexpr int bodies_at_once = 64;  // that a thread takes
    const auto count = count_of(poses);
    std::vector<std::vector<Waypoint>> ways(poses.size());
    base::parallel_for(count, bodies_at_once,
                       [&](int i) { ways[i] = BodyPath(model.bodies[i], poses[i], time, time + model.timestep).waypoints(); });
    std::vector<double> fractions{1};
    for (const std::vector<Waypoint>& way : ways)
        for (const Waypoint& waypoint : way) fractions.push_back(waypoint.fraction);
    std::sort(fractions.begin(), fractions.end());
    fractions.erase(std::unique(fractions.begin(), fractions.end()), fractions.end());
    std::vector<PrescribedNode> out;
    for (const double fraction : fractions) {
        out.push_back({fraction, std::vector<Vector6>(poses.size())});
        base::parallel_for(count, bodies_at_once, [&](int i) { out.back().targets[i] = coordinates_at(ways[i], poses[i], fraction); });
    }
    return out;
}

}  // namespace fettle::core::stepper
