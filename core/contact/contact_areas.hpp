// SPDX-License-Identifier: MIT
/// What the weights of an area-weighted barrier's contacts are made of (ContactPair::weight): areas of vertices and edges,
///   weight = sum factor area,   half a vertex's area, or half the lesser of two edges', each as often as it counts (counted_contacts.hpp).
/// For derivatives in the shapes; a step takes the weights as they are.
#pragma once

#include <vector>

#include "core/ccd/candidates.hpp"
#include "core/kinematics/path.hpp"

namespace fettle::core::contact {

struct AreaShare {
    int body = 0;
    bool is_edge = false;
    int element = 0;    ///< of Body::vertex_area, or Body::edge_area
    double factor = 0;  ///< 1/2 or -1/2
};

/// Two edges of areas that are the same to 1e-9: the lesser of them has no derivative.
struct EqualAreas {
    int body_a = 0, edge_a = 0, body_b = 0, edge_b = 0;
};

struct ContactAreas {
    std::vector<std::vector<AreaShare>> shares;  ///< [contact], in the order of find_contacts: list after list
    std::vector<EqualAreas> equal;
};

/// The areas of the contacts that find_contacts finds. Contract: the model is area-weighted.
ContactAreas contact_areas(const model::Model& model, const ccd::Candidates& candidates, const std::vector<kinematics::Pose>& poses);

}  // namespace fettle::core::contact
