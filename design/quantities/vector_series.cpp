// SPDX-License-Identifier: MIT
#include "design/quantities/vector_series.hpp"

namespace fettle::design::quantities {

using description::Seeds;
using description::Simulated;

std::vector<double> VectorSeries::series(const Simulated& s) const { return series_derivative(s, 0); }

void VectorSeries::add_series_seeds(const Simulated& s, const std::vector<double>& weights, Seeds& seeds) const {
    add_series_derivative_seeds(s, 0, weights, seeds);
}

std::vector<double> VectorSeries::series_derivative(const Simulated& s, int order) const {
    std::vector<double> out;
    for (const Vector3& v : time_derivative(vectors(s), s.trajectory.timestep, order))
        out.push_back(axis_.isZero(0) ? v.norm() : axis_.dot(v));
    return out;
}

void VectorSeries::add_series_derivative_seeds(const Simulated& s, int order, const std::vector<double>& weights, Seeds& seeds) const {
    std::vector<Vector3> along(weights.size(), axis_);
    if (axis_.isZero(0)) {
        const std::vector<Vector3> at = time_derivative(vectors(s), s.trajectory.timestep, order);
        for (std::size_t t = 0; t < along.size(); ++t) along[t] = at[t].isZero(0) ? Vector3(Vector3::Zero()) : at[t].normalized();
    }
    for (std::size_t t = 0; t < along.size(); ++t) along[t] *= weights[t];
    add_vector_seeds(s, time_derivative_adjoint(along, s.trajectory.timestep, order), seeds);
}

}  // namespace fettle::design::quantities
