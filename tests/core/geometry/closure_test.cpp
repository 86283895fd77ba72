// SPDX-License-Identifier: MIT
#include "fettle/core/geometry/closure.hpp"

#include <catch2/catch.hpp>

#include "fettle/core/geometry/mass_moments.hpp"
#include "fettle/core/geometry/point_in_solid.hpp"
#include "fettle/tests/core/geometry/sample_meshes.hpp"

namespace fettle::core::geometry::closure_test {

namespace {

Mesh without(Mesh mesh, std::size_t first, std::size_t count) {
    mesh.triangles.erase(mesh.triangles.begin() + static_cast<std::ptrdiff_t>(first),
                         mesh.triangles.begin() + static_cast<std::ptrdiff_t>(first + count));
    mesh.shell_names.clear();
    build_connectivity(mesh);
    return mesh;
}

}  // namespace

TEST_CASE("an open mesh with lids has no boundary, and the volume that it has its mass by") {
    const Mesh sound = tests::ellipsoid_mesh({1, 2, 3}, 10);
    CHECK(!closure_of(sound));
    for (const std::size_t count : {1, 2, 7, 40}) {
        const Mesh open = without(sound, 30, count);
        const auto closure = closure_of(open);
        REQUIRE(closure);
        CHECK(closure->first_lid == open.triangles.size());
        Mesh closed = make_mesh("closed", closure->vertices, closure->triangles);
        CHECK(bounds_a_solid(closed));
        CHECK(solid_moments(closed.vertices, closed.triangles)(3, 3) ==
              Approx(capped_solid_moments(open.vertices, open.triangles)(3, 3)).epsilon(1e-12));
        CHECK(winding_number({0.1, 0.2, -0.3}, closure->vertices, closure->triangles) == 1);
        CHECK(closure->reach > 0);
        CHECK(closure->reach < 6);  // no more than the mesh is long
    }
}

TEST_CASE("of a sheet that is flat lids enclose nothing") {
    Mesh plane = tests::box_mesh({-1, -1, 0}, {1, 1, 1});
    std::vector<Triangle> bottom;
    for (const Triangle& t : plane.triangles)
        if (plane.vertices(2, t[0]) == 0 && plane.vertices(2, t[1]) == 0 && plane.vertices(2, t[2]) == 0) bottom.push_back(t);
    REQUIRE(bottom.size() == 2);
    CHECK(!closure_of(make_mesh("plane", plane.vertices, bottom)));
    CHECK(closure_of(without(plane, 0, 1)));
}

}  // namespace fettle::core::geometry::closure_test
