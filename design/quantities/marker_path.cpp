// SPDX-License-Identifier: MIT
#include "design/quantities/marker_path.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/contract.hpp"
#include "design/quantities/marker.hpp"

namespace fettle::design::quantities {

using description::Measurement;
using description::Seeds;
using description::Simulated;

MarkerPath::MarkerPath(int body, OwnPoint point, std::vector<OwnPoint> targets, std::vector<double> times)
    : body_(body), point_(std::move(point)), targets_(std::move(targets)), times_(std::move(times)) {
    FETTLE_ASSERT(!targets_.empty(), "a path of no points");
    FETTLE_ASSERT(times_.empty() || times_.size() == targets_.size(), "one time per target, or none");
}

MarkerPath::Place MarkerPath::nearest(const std::vector<Vector3>& path, const Vector3& target) const {
    Place best;
    double best_distance = std::numeric_limits<double>::infinity();
    for (size_t t = 0; t + 1 < path.size(); ++t) {
        const Vector3 along = path[t + 1] - path[t];
        const double length_squared = along.squaredNorm();
        const double s = length_squared > 0 ? std::clamp(along.dot(target - path[t]) / length_squared, 0.0, 1.0) : 0.0;
        const Vector3 position = path[t] + s * along;
        const double distance = (position - target).squaredNorm();
        if (distance < best_distance) {
            best_distance = distance;
            best = {static_cast<int>(t), s, position, target};
        }
    }
    return best;
}

std::vector<MarkerPath::Place> MarkerPath::places(const Simulated& s) const {
    std::vector<Vector3> path;
    const int last = count_of(s.trajectory.poses) - 1;
    const Vector3 point = point_.value(s);
    for (int t = 0; t <= last; ++t) path.push_back(marker_position(s, t, body_, point));
    FETTLE_ASSERT(last >= 1, "a marker's path needs a step");
    std::vector<Place> result;
    for (size_t k = 0; k < targets_.size(); ++k) {
        const Vector3 target = targets_[k].value(s);
        if (times_.empty()) {
            result.push_back(nearest(path, target));
            continue;
        }
        const double steps = (times_[k] - s.trajectory.time_start) / s.trajectory.timestep;
        const int t = std::clamp(static_cast<int>(std::floor(steps)), 0, last - 1);
        const double fraction = std::clamp(steps - t, 0.0, 1.0);
        const auto i = static_cast<size_t>(t);
        result.push_back({t, fraction, path[i] + fraction * (path[i + 1] - path[i]), target});
    }
    return result;
}

Measurement MarkerPath::value(const Simulated& simulated) const {
    const std::vector<Place> found = places(simulated);
    double sum = 0;
    for (const Place& place : found) sum += (place.position - place.target).squaredNorm();
    return description::computed(sum / static_cast<double>(targets_.size()));
}

void MarkerPath::add_seeds(const Simulated& simulated, const Measurement&, double scale, Seeds& seeds) const {
    const std::vector<Place> found = places(simulated);
    for (int k = 0; k < count_of(targets_); ++k) {
        const Vector3 gradient = scale * 2 / static_cast<double>(targets_.size()) * (found[k].position - found[k].target);
        add_place_seeds(simulated, found[k], k, gradient, seeds);
    }
}

void MarkerPath::add_place_seeds(const Simulated& simulated, const Place& place, int k, const Vector3& direction, Seeds& seeds) const {
    add_marker_seed(simulated, place.index, body_, point_, (1 - place.fraction) * direction, seeds);
    add_marker_seed(simulated, place.index + 1, body_, point_, place.fraction * direction, seeds);
    targets_[k].add_seed(simulated, -direction, seeds);
}

VectorX MarkerPath::deviations(const Simulated& simulated) const {
    const std::vector<Place> found = places(simulated);
    VectorX r(3 * static_cast<Eigen::Index>(found.size()));
    for (size_t k = 0; k < found.size(); ++k)
        r.segment<3>(3 * static_cast<Eigen::Index>(k)) =
            (found[k].position - found[k].target) / std::sqrt(static_cast<double>(targets_.size()));
    return r;
}

// Where timing is free and the place is inside a piece of the path, the place moves along with the path, so that only the distance across
// it changes.
void MarkerPath::add_deviation_seeds(const Simulated& simulated, int i, double scale, Seeds& seeds) const {
    const Place found = places(simulated)[i / 3];
    Vector3 direction = Vector3::Unit(i % 3) * scale / std::sqrt(static_cast<double>(targets_.size()));
    if (times_.empty() && found.fraction > 0 && found.fraction < 1) {
        const Vector3 point = point_.value(simulated), along = (marker_position(simulated, found.index + 1, body_, point) -
                                                                marker_position(simulated, found.index, body_, point))
                                                                   .normalized();
        direction -= along * along.dot(direction);
    }
    add_place_seeds(simulated, found, i / 3, direction, seeds);
}

std::vector<std::string> MarkerPath::parameters() const {
    std::vector<std::string> names;
    point_.add_parameters(names);
    for (const OwnPoint& target : targets_) target.add_parameters(names);
    return names;
}

Errors MarkerPath::check(const core::model::Model& model, int steps) const {
    Errors errors = description::check_body(model, body_);
    if (steps < 1) errors.push_back({ErrorCode::out_of_range, "", "a marker's path needs a step"});
    return errors;
}

}  // namespace fettle::design::quantities
