// SPDX-License-Identifier: MIT
/// The shells of a mesh (its edge-connected parts) and which lies within which: orientation is judged by it, and solids are made of it,
/// each a shell with its cavities.
#pragma once

#include <vector>

#include "core/geometry/mesh.hpp"
#include "core/geometry/overlapping_boxes.hpp"

namespace fettle::core::solids {

struct Shell {
    int index = 0;  ///< of mesh.shell_names
    std::vector<geometry::Triangle> triangles;
    std::vector<int> vertices;  ///< sorted, distinct
    geometry::Box box;
    bool is_closed = false;
    int volume_sign = 0;  ///< of the signed volume, exactly
    int depth = 0;        ///< within how many other shells it lies
    int around = -1;      ///< the innermost of these, -1: none

    /// A solid turned outwards within an even number of others, or a cavity turned inwards within an odd one.
    bool is_oriented() const { return depth % 2 == 0 ? volume_sign > 0 : volume_sign < 0; }
};

/// All shells of a mesh with connectivity. Depths have a meaning only where shells do not cross; nothing lies within one that is open.
std::vector<Shell> shells_of(const geometry::Mesh& mesh);

/// The solids of a mesh. A closed shell turned inwards right within a closed one turned outwards is that one's cavity; every other shell is
/// a solid of its own: one that lies in a cavity, a solid within a solid, an open one.
struct SolidsOfMesh {
    std::vector<int> of_shell;  ///< from 0, in the order of their first triangles
    int count = 0;
};
SolidsOfMesh solids_of_shells(const geometry::Mesh& mesh);

/// One mesh for each of them, cavities included (geometry::split_parts). A mesh without triangles stays whole.
std::vector<geometry::Mesh> split_solids(const geometry::Mesh& mesh);

}  // namespace fettle::core::solids
