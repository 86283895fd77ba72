// SPDX-License-Identifier: MIT
/// Flat faces of two parts that face each other: where one part stops the other, as assembled.
#pragma once

#include <vector>

#include "core/features/feature.hpp"
#include "core/geometry/mesh.hpp"

namespace fettle::core::features {

struct Facing {
    int of_a = 0, of_b = 0;            ///< features of the two parts, both planes
    Vector3 normal = Vector3::Zero();  ///< of a's face, outwards: b lies there, and the other way it is stopped
    double gap = 0;                    ///< from a's face to b's [m]; negative: one in the other, by no more than the tolerances
};

/// All pairs of flat faces, of parts in one frame, that look at each other to within a degree, no farther apart than `most`, and overlap
/// when one is seen from the other. In the order of a's features, then of b's.
std::vector<Facing> facing_planes(const geometry::Mesh& mesh_a, const Features& a, const geometry::Mesh& mesh_b, const Features& b,
                                  double most);

}  // namespace fettle::core::features
