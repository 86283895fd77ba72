// SPDX-License-Identifier: MIT
/// Mass of one or more bodies [kg], static bodies included: density times what it is per, by the body's MassKind
/// (core/scene/mass_kind.hpp): the volume of the solid (small openings capped), the area of the triangles, the length of the edges, the
/// number of vertices. A mass that the scene gives (Body::inertial) is that, whatever the mesh becomes.
#pragma once

#include <vector>

#include "core/scene/scene.hpp"
#include "design/description/quantity.hpp"

namespace fettle::design::quantities {

class Mass : public description::Quantity {
public:
    struct Of {
        int body = 0;
        core::scene::MassKind kind = core::scene::MassKind::volume;  ///< of the body's scene (the model does not keep it)
    };
    explicit Mass(std::vector<Of> bodies) : bodies_(std::move(bodies)) {}
    /// The mass of these bodies of the scene, each by its own kind.
    Mass(const core::scene::Scene& scene, const std::vector<int>& bodies);

    const std::vector<Of>& bodies() const { return bodies_; }
    Dimension dimension() const override { return Dimension::mass; }
    description::QuantityFacts facts() const override { return {.is_number = true}; }
    description::Measurement value(const description::Simulated& simulated) const override;
    void add_seeds(const description::Simulated& simulated, const description::Measurement& measured, double scale,
                   description::Seeds& seeds) const override;
    bool is_at_rest() const override { return true; }
    /// Bodies that have no mass of their kind: an open mesh has no volume.
    Errors check(const core::model::Model& model, int steps) const override;

private:
    std::vector<Of> bodies_;
};

}  // namespace fettle::design::quantities
