// SPDX-License-Identifier: MIT
/// The shells of a mesh (its edge-connected parts) and which lies within which: what orientation is judged by.
#pragma once

#include <vector>

#include "fettle/core/geometry/mesh.hpp"
#include "fettle/core/geometry/overlapping_boxes.hpp"

namespace fettle::core::solids {

struct Shell {
    int index = 0;  ///< of mesh.shell_names
    std::vector<geometry::Triangle> triangles;
    std::vector<int> vertices;  ///< sorted, distinct
    geometry::Box box;
    int volume_sign = 0;  ///< of the signed volume, exactly
    int depth = 0;        ///< within how many other shells it lies
    int around = -1;      ///< the innermost of these, -1: none

    /// A solid turned outwards within an even number of others, or a cavity turned inwards within an odd one.
    bool is_oriented() const { return depth % 2 == 0 ? volume_sign > 0 : volume_sign < 0; }
};

/// All shells of a mesh with connectivity. Depths have a meaning only where shells do not cross.
std::vector<Shell> shells_of(const geometry::Mesh& mesh);

}  // namespace fettle::core::solids
