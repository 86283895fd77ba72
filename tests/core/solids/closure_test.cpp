// SPDX-License-Identifier: MIT
#include "core/solids/closure.hpp"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <utility>

#include "core/geometry/mass_moments.hpp"
#include "core/solids/point_in_solid.hpp"
#include "tests/core/geometry/sample_meshes.hpp"

namespace fettle::core::solids::closure_test {

namespace {

geometry::Mesh without(geometry::Mesh mesh, std::size_t first, std::size_t count) {
    mesh.triangles.erase(mesh.triangles.begin() + static_cast<std::ptrdiff_t>(first),
                         mesh.triangles.begin() + static_cast<std::ptrdiff_t>(first + count));
    mesh.shell_names.clear();
    geometry::build_connectivity(mesh);
    return mesh;
}

}  // namespace

TEST_CASE("an open mesh with lids has no boundary, and the volume that it has its mass by") {
    const geometry::Mesh sound = tests::ellipsoid_mesh({1, 2, 3}, 10);
    CHECK(!closure_of(sound));
    for (const std::size_t count : {1, 2, 7, 40}) {
        const geometry::Mesh open = without(sound, 30, count);
        const auto closure = closure_of(open);
        REQUIRE(closure);
        CHECK(closure->first_lid == open.triangles.size());
        geometry::Mesh closed = geometry::make_mesh("closed", closure->vertices, closure->triangles);
        CHECK(bounds_a_solid(closed));
        CHECK(geometry::solid_moments(closed.vertices, closed.triangles)(3, 3) ==
              Approx(geometry::capped_solid_moments(open.vertices, open.triangles)(3, 3)).epsilon(1e-12));
        CHECK(winding_number({0.1, 0.2, -0.3}, closure->vertices, closure->triangles) == 1);
        CHECK(closure->reach > 0);
        CHECK(closure->reach < 6);  // no more than the mesh is long
    }
}

TEST_CASE("of a sheet that is flat lids enclose nothing") {
    geometry::Mesh plane = tests::box_mesh({-1, -1, 0}, {1, 1, 1});
    std::vector<geometry::Triangle> bottom;
    for (const geometry::Triangle& t : plane.triangles)
        if (plane.vertices(2, t[0]) == 0 && plane.vertices(2, t[1]) == 0 && plane.vertices(2, t[2]) == 0) bottom.push_back(t);
    REQUIRE(bottom.size() == 2);
    CHECK(!closure_of(geometry::make_mesh("plane", plane.vertices, bottom)));
    CHECK(closure_of(without(plane, 0, 1)));
}

TEST_CASE("parts and faces that are turned over do not cancel what a closure bounds", "[geometry]") {
    const geometry::Mesh open = without(tests::box_mesh({-1, -1, -1}, {1, 1, 1}), 0, 1),
                         beside = without(tests::box_mesh({4, -1, -1}, {6, 1, 1}), 0, 1);
    const auto of_pair = closure_of(tests::joined(open, tests::inside_out(beside)));
    REQUIRE(of_pair);
    CHECK(is_within({0.1, 0.2, 0}, *of_pair));
    CHECK(is_within({5.1, 0.2, 0}, *of_pair));
    CHECK(!is_within({2.5, 0, 0}, *of_pair));
    geometry::Mesh half_turned = tests::ellipsoid_mesh({2, 2, 2}, 10);  // its lower half the wrong way round
    for (geometry::Triangle& t : half_turned.triangles)
        if (half_turned.vertices(2, t[0]) + half_turned.vertices(2, t[1]) + half_turned.vertices(2, t[2]) < 0) std::swap(t[1], t[2]);
    geometry::build_connectivity(half_turned);
    const auto of_halves = closure_of(half_turned);
    REQUIRE(of_halves);
    CHECK(is_within({0.3, 0.2, 0.7}, *of_halves));
    CHECK(is_within({0.3, 0.2, -0.7}, *of_halves));
}

TEST_CASE("of sheets that are flat each, in planes of their own, lids enclose nothing", "[geometry]") {
    const auto sheet = [](const Vector3& normal, const Vector3& place, int n) {
        const Vector3 u = normal.unitOrthogonal(), v = normal.normalized().cross(u);
        Matrix3X x(3, n * n);
        std::vector<geometry::Triangle> triangles;
        for (int i = 0; i < n; ++i) {
            for (int j = 0; j < n; ++j) {
                x.col(i * n + j) = place + i * u + 2 * j * v;
                if (i + 1 == n || j + 1 == n) continue;
                triangles.push_back({i * n + j, (i + 1) * n + j, (i + 1) * n + j + 1});
                triangles.push_back({i * n + j, (i + 1) * n + j + 1, i * n + j + 1});
            }
        }
        return geometry::make_mesh("sheet", x, triangles);
    };
    const geometry::Mesh one = sheet({0.3, -2, 0.7}, {100, 3, -20}, 12), other = sheet({1, 1, 0.1}, {-40, 2, 2}, 5);
    CHECK(!closure_of(one));
    CHECK(!closure_of(tests::joined(one, other)));
    CHECK(closure_of(tests::joined(one, without(tests::box_mesh({-1, -1, -1}, {1, 1, 1}), 0, 1))));
}

}  // namespace fettle::core::solids::closure_test
