// SPDX-License-Identifier: MIT
#include "core/solids/shells.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "core/geometry/mass_moments.hpp"
#include "core/solids/mesh_validity.hpp"
#include "tests/core/geometry/sample_meshes.hpp"

namespace fettle::core::solids::shells_test {

namespace {

using geometry::Mesh;

Mesh cube(double half, double at = 0) { return tests::box_mesh(Vector3(at - half, -half, -half), Vector3(at + half, half, half)); }
Mesh inwards(const Mesh& mesh) { return tests::inside_out(mesh); }
Mesh without_a_triangle(Mesh mesh) {
    mesh.triangles.pop_back();
    return geometry::make_mesh(mesh.name, mesh.vertices, mesh.triangles);
}
Mesh together(const std::vector<Mesh>& meshes) {
    Mesh out = meshes.front();
    for (std::size_t i = 1; i < meshes.size(); ++i) out = tests::joined(out, meshes[i]);
    return out;
}
double volume(const Mesh& mesh) { return geometry::solid_moments(mesh.vertices, mesh.triangles)(3, 3); }

std::vector<double> volumes_of_solids(const std::vector<Mesh>& shells) {
    std::vector<double> out;
    for (const Mesh& solid : split_solids(together(shells))) out.push_back(std::round(volume(solid)));
    return out;
}

}  // namespace

TEST_CASE("A cavity belongs to the solid right round it; what lies in it is a solid of its own") {
    using Volumes = std::vector<double>;
    const double hollow = 27 - 8;
    CHECK(volumes_of_solids({cube(1.5), inwards(cube(1))}) == Volumes{hollow});
    CHECK(volumes_of_solids({inwards(cube(1)), cube(1.5)}) == Volumes{hollow});                   // the cavity first
    CHECK(volumes_of_solids({cube(1.5), inwards(cube(1)), cube(0.5)}) == Volumes{hollow, 1});     // a rattle
    CHECK(volumes_of_solids({cube(0.5), inwards(cube(1)), cube(1.5)}) == Volumes{1, hollow});     // and the other way round
    CHECK(volumes_of_solids({cube(1.5), cube(0.5, 9), inwards(cube(1))}) == Volumes{hollow, 1});  // one far away between them
    CHECK(volumes_of_solids({cube(2), inwards(cube(1.5)), cube(1), inwards(cube(0.5))}) == Volumes{64 - 27, 8 - 1});
    CHECK(volumes_of_solids({cube(4), inwards(cube(0.5, -1)), inwards(cube(0.5, 1))}) == Volumes{512 - 2});  // two cavities
    CHECK(volumes_of_solids({cube(1.5), cube(1)}) == Volumes{27, 8});                                        // a solid within a solid
    CHECK(volumes_of_solids({cube(2), cube(1.5), inwards(cube(1))}) == Volumes{64, hollow});                 // the inner one's
    CHECK(volumes_of_solids({cube(1), inwards(cube(1, 5))}) == Volumes{8, -8});                              // inside out, in nothing
}

TEST_CASE("Nothing lies in what is open") {
    for (const auto& [outer, inner] :
         {std::pair{without_a_triangle(cube(1.5)), inwards(cube(1))}, std::pair{cube(1.5), without_a_triangle(inwards(cube(1)))}}) {
        const auto solids = split_solids(together({outer, inner}));
        REQUIRE(solids.size() == 2);
        CHECK(solids[0].triangles.size() == outer.triangles.size());
        CHECK(is_closed(solids[1]) == is_closed(inner));
    }
    const auto shells = shells_of(together({without_a_triangle(cube(1.5)), cube(1)}));
    CHECK_FALSE(shells[0].is_closed);
    CHECK(shells[1].is_closed);
    CHECK(shells[1].depth == 0);
}

}  // namespace fettle::core::solids::shells_test
