// SPDX-License-Identifier: MIT
#include "fettle/core/model/choose_kappa.hpp"

#include <algorithm>
#include <numeric>

namespace fettle::core::model {
namespace {

bool is_loaded(const Model& model) {
    return std::any_of(model.bodies.begin(), model.bodies.end(), [&](const Body& body) {
        return body.type == scene::BodyType::dynamic_body && !(model.gravity + body.force / body.moments(3, 3)).isZero(0);
    });
}

}  // namespace

double choose_kappa(const Model& model) {
    const bool loads_alone = model.integrator == scene::Integrator::quasi_static && is_loaded(model);
    double kappa = 0;
    for (const Body& body : model.bodies) {
        if (body.type != scene::BodyType::dynamic_body) continue;
        const double mass = body.moments(3, 3);
        const double acceleration = (model.gravity + body.force / mass).norm();
        const double inertial = loads_alone ? 0 : 0.1 * mass / (model.timestep * model.timestep);
        const double wanted = std::max(inertial, 4 * mass * acceleration / model.dhat);
        // Half of a twentieth of its surface is what a body may rest on.
        const double area = std::accumulate(body.vertex_area.begin(), body.vertex_area.end(), 0.0) / 40;
        kappa = std::max(kappa, model.area_weighted && area > 0 ? wanted / area : wanted);
    }
    return kappa > 0 ? kappa : 1;
}

}  // namespace fettle::core::model
