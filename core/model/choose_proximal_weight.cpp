// SPDX-License-Identifier: MIT
#include "core/model/choose_proximal_weight.hpp"

#include <algorithm>
#include <limits>

namespace fettle::core::model {
namespace {

bool is_movable(const Body& body) {
    for (int k = 0; k < 6; ++k)
        if (is_free(body, k)) return true;
    return false;
}

}  // namespace

double load_magnitude(const Model& model, const Body& body) {
    if (!is_movable(body)) return 0;
    return body.moments(3, 3) * model.gravity.norm() + body.force.norm() + body.torque.norm() / std::max(body.radius, model.dhat);
}

std::vector<double> reference_loads(const Model& model) {
    std::vector<double> loads;
    double largest = 0;
    for (const Body& body : model.bodies) {
        loads.push_back(load_magnitude(model, body));
        largest = std::max(largest, loads.back());
    }
    for (std::size_t i = 0; i < loads.size(); ++i)
        if (loads[i] == 0 && is_movable(model.bodies[i])) loads[i] = largest;
    return loads;
}

double choose_proximal_weight(const Model& model) {
    const std::vector<double> loads = reference_loads(model);
    double least = std::numeric_limits<double>::infinity();
    bool movable = false;
    for (std::size_t i = 0; i < loads.size(); ++i) {
        const double mass = model.bodies[i].moments(3, 3);
        if (!is_movable(model.bodies[i]) || !(mass > 0)) continue;
        movable = true;
        if (loads[i] > 0) least = std::min(least, loads[i] / mass);
    }
    if (!movable) return 1;
    if (least == std::numeric_limits<double>::infinity()) least = model.dhat / (40 * model.timestep * model.timestep);
    return model.diagonal / (allowed_proximal_share * least);
}

}  // namespace fettle::core::model
