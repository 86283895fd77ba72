// SPDX-License-Identifier: MIT
/// A mesh as flat patches and the creases between them, in an order that follows from where things are alone: the same mesh with its
/// vertices and triangles in another order gives the same patches, to the bit.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry/mesh.hpp"

namespace fettle::core::features {

/// Lists of whole numbers, one after another.
class IndexLists {
public:
    /// Members 0 .. owner.size()-1, each in its owner's list, in their order; a negative owner: in none.
    IndexLists() = default;
    IndexLists(int lists, const std::vector<int>& owner);
    void add(std::span<const int> list);
    int count() const { return static_cast<int>(first_.size()) - 1; }
    std::span<const int> operator[](int list) const { return {all_.data() + first_[list], all_.data() + first_[list + 1]}; }

private:
    std::vector<int> first_ = {0}, all_;
};

/// Triangles that lie in one plane to within the tolerance, connected over edges with one triangle on each side.
struct Patch {
    Vector3 normal = Vector3::UnitZ(), centre = Vector3::Zero();  ///< outwards; of the area [m]
    double area = 0;                                              ///< [m^2]
};

/// An edge between two patches.
struct Crease {
    int p = 0, q = 0;  ///< patches, p < q
    int a = 0, b = 0;  ///< vertices
    double angle = 0;  ///< between their normals [rad], positive where the material is convex
};

struct Patches {
    Matrix3X vertices;                          ///< sorted by x, y, z [m]
    std::vector<geometry::Triangle> triangles;  ///< sorted
    std::vector<int> in_mesh;                   ///< per triangle: its index in the mesh
    std::vector<Vector3> normals;               ///< per triangle; zero where it has no area
    std::vector<double> areas;                  ///< per triangle [m^2]
    std::vector<int> patch_of;                  ///< per triangle
    std::vector<Patch> patches;
    std::vector<Crease> creases;
    IndexLists patch_triangles, patch_creases, patch_vertices;
    std::vector<std::uint8_t> is_sharp;  ///< per vertex: at an edge that is open, or leans by more than the limit
    double size = 0;                     ///< diagonal of the box [m]
};

/// @param flatness  How far a patch's vertices may lie from its plane [m].
/// @param limit     Creases that lean by at most so much may be a tessellation's own [rad].
Patches patches_of(const geometry::Mesh& mesh, double flatness, double limit);

}  // namespace fettle::core::features
