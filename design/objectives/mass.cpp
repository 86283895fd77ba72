// SPDX-License-Identifier: MIT
#include "fettle/design/objectives/mass.hpp"

#include "fettle/adjoint/geometry/mass_moments_adjoint.hpp"
#include "fettle/core/geometry/mass_moments.hpp"

namespace fettle::design::objectives {

Quantity Mass::value(const Simulated& s) const {
    double sum = 0;
    for (const int index : bodies_) {
        const core::model::Body& body = s.model.bodies[static_cast<size_t>(index)];
        sum += body.density * core::geometry::solid_moments(body.mesh.vertices, body.mesh.triangles)(3, 3);
    }
    return exact(sum);
}

void Mass::add_seeds(const Simulated& s, const Quantity&, double scale, Seeds& seeds) const {
    for (const int index : bodies_) {
        const core::model::Body& body = s.model.bodies[static_cast<size_t>(index)];
        adjoint::BodyGradient& bar = seeds.model_bar.bodies[static_cast<size_t>(index)];
        Matrix4 volume_bar = Matrix4::Zero();
        volume_bar(3, 3) = scale * body.density;
        adjoint::geometry::solid_moments_adjoint(body.mesh.vertices, body.mesh.triangles, volume_bar, bar.vertices_bar);
        bar.density_bar += scale * core::geometry::solid_moments(body.mesh.vertices, body.mesh.triangles)(3, 3);
    }
}

}  // namespace fettle::design::objectives
