// SPDX-License-Identifier: MIT
#include "design/description/quantity.hpp"

namespace fettle::design::description {

VectorX Quantity::deviations(const Simulated&) const { return {}; }

void Quantity::add_deviation_seeds(const Simulated&, int, double, Seeds&) const {}

std::vector<double> Quantity::curve(const Simulated&) const { return {}; }

std::vector<Branch> Quantity::branches(const Simulated&, const Measurement&, double) const { return {}; }

std::optional<Continuation> Quantity::continuation(const Simulated&, const Measurement&, const Bounds&) const { return std::nullopt; }

std::string Quantity::doubt(const Simulated&, const Measurement&) const { return {}; }

std::string Quantity::explanation(const Measurement&) const { return {}; }

Errors Quantity::check(const core::model::Model&, int) const { return {}; }

Errors check_body(const core::model::Model& model, int body) {
    if (body >= 0 && body < count_of(model.bodies)) return {};
    return {{ErrorCode::out_of_range, "",
             "there is no body " + std::to_string(body) + "; the scene has " + std::to_string(model.bodies.size()) + ", counted from 0"}};
}

}  // namespace fettle::design::description
