// SPDX-License-Identifier: MIT
#include "fettle/design/quantities/marker_position.hpp"

#include "fettle/design/quantities/marker.hpp"

namespace fettle::design::quantities {

using description::Seeds;
using description::Simulated;

std::vector<Vector3> MarkerPosition::vectors(const Simulated& s) const {
    std::vector<Vector3> out;
    for (int t = 0; t < count_of(s.trajectory.poses); ++t) out.emplace_back(marker_position(s, t, of_.body, of_.point) - of_.origin);
    return out;
}

void MarkerPosition::add_vector_seeds(const Simulated& s, const std::vector<Vector3>& weights, Seeds& seeds) const {
    for (int t = 0; t < count_of(weights); ++t)
        if (!weights[t].isZero(0)) add_marker_seed(s, t, of_.body, of_.point, weights[t], seeds);
}

Errors MarkerPosition::check(const core::model::Model& model, int steps) const {
    Errors errors = StepSeries::check(model, steps);
    for (const core::base::Error& error : description::check_body(model, of_.body)) errors.push_back(error);
    return errors;
}

}  // namespace fettle::design::quantities
