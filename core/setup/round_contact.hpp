// SPDX-License-Identifier: MIT
/// Where contact takes the smooth surfaces that facets stand for (geometry/round_surfaces.hpp, contact/round_contacts.hpp): everywhere, but
/// for pairs of sides that these would not suit.
#pragma once

#include <optional>
#include <vector>

#include "core/model/model.hpp"

namespace fettle::core::setup {

/// Fills Body::round, round_reach and facet_sides, and warns of sides whose contact takes facets. The covers of two round surfaces contain
/// the meshes and need some room, r phi^2/8 each; these pairs of sides keep their facets:
///   - a pin in a bore, or an arc in an arc, that leave it less play than that;
///   - an arc in an arc over part of a circle whose play is less than dmin + dhat (their potential would have a kink);
///   - sides whose covers overlap at the start, though the surfaces within do not.
/// The first two are looked for in bodies that are near each other at the start, wherever their sides are. Nothing is round with
/// area-weighted or damped contacts.
/// @param wanted  false: none. True is told where it cannot be had
/// @param facet_sides  of the first design; all designs of an optimisation have the same
void add_round_contact(const std::optional<bool>& wanted, const std::optional<std::vector<model::FacetSides>>& facet_sides,
                       model::Model& model);

}  // namespace fettle::core::setup
