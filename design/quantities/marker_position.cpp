// SPDX-License-Identifier: MIT
#include "design/quantities/marker_position.hpp"

#include "design/quantities/marker.hpp"

namespace fettle::design::quantities {

using description::Seeds;
using description::Simulated;

std::vector<Vector3> MarkerPosition::vectors(const Simulated& s) const {
    std::vector<Vector3> out;
    const Vector3 point = of_.point.value(s), origin = of_.origin.value(s);
    for (int t = 0; t < count_of(s.trajectory.poses); ++t) out.emplace_back(marker_position(s, t, of_.body, point) - origin);
    return out;
}

void MarkerPosition::add_vector_seeds(const Simulated& s, const std::vector<Vector3>& weights, Seeds& seeds) const {
    Vector3 of_origin = Vector3::Zero();
    for (int t = 0; t < count_of(weights); ++t) {
        if (weights[t].isZero(0)) continue;
        add_marker_seed(s, t, of_.body, of_.point, weights[t], seeds);
        of_origin -= weights[t];
    }
    of_.origin.add_seed(s, of_origin, seeds);
}

std::vector<std::string> MarkerPosition::parameters() const {
    std::vector<std::string> names;
    of_.point.add_parameters(names);
    of_.origin.add_parameters(names);
    return names;
}

Errors MarkerPosition::check(const core::model::Model& model, int steps) const {
    Errors errors = StepSeries::check(model, steps);
    for (const core::base::Error& error : description::check_body(model, of_.body)) errors.push_back(error);
    return errors;
}

}  // namespace fettle::design::quantities
