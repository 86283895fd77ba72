// SPDX-License-Identifier: MIT
#include "design/quantities/mass.hpp"

#include "adjoint/scene/mass_kind_adjoint.hpp"
#include "core/base/contract.hpp"
#include "core/scene/mass_kind.hpp"

namespace fettle::design::quantities {

using core::model::Body;

namespace {

double amount(const Body& body, core::scene::MassKind kind) { return core::scene::unit_moments(body.mesh, kind)(3, 3); }

}  // namespace

Mass::Mass(const core::scene::Scene& scene, const std::vector<int>& bodies) {
    for (const int body : bodies) {
        FETTLE_ASSERT(body >= 0 && static_cast<size_t>(body) < scene.bodies.size(), "a mass is that of bodies of the scene");
        bodies_.push_back({body, scene.bodies[body].mass_kind});
    }
}

description::Measurement Mass::value(const description::Simulated& s) const {
    double sum = 0;
    for (const Of& of : bodies_) {
        const Body& body = s.model.bodies[of.body];
        sum += body.given_mass ? *body.given_mass : body.density * amount(body, of.kind);
    }
    return description::computed(sum);
}

void Mass::add_seeds(const description::Simulated& s, const description::Measurement&, double scale, description::Seeds& seeds) const {
    for (const Of& of : bodies_) {
        const Body& body = s.model.bodies[of.body];
        if (body.given_mass) continue;
        adjoint::BodyGradient& bar = seeds.model_bar.bodies[of.body];
        adjoint::scene::amount_adjoint(body.mesh, of.kind, scale * body.density, bar.vertices_bar);
        bar.density_bar += scale * amount(body, of.kind);
    }
}

Errors Mass::check(const core::model::Model& model, int) const {
    Errors errors;
    for (const Of& of : bodies_) {
        Errors found = description::check_body(model, of.body);
        if (found.empty()) {
            const Body& body = model.bodies[of.body];
            if (!body.given_mass && !core::scene::centre_of_mass(body.mesh, of.kind))
                found.push_back({ErrorCode::mesh_invalid, "",
                                 "the mesh of body \"" + body.name + "\" has nothing for a density in " +
                                     core::scene::density_unit(of.kind) + " (of an open mesh there is no volume)"});
        }
        errors.insert(errors.end(), found.begin(), found.end());
    }
    return errors;
}

}  // namespace fettle::design::quantities
