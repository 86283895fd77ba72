// SPDX-License-Identifier: MIT
#include "adjoint/scene/mass_kind_adjoint.hpp"

#include <catch2/catch.hpp>

#include "core/geometry/mass_moments.hpp"
#include "tests/support/box_mesh.hpp"
#include "tests/support/derivative_check.hpp"

namespace fettle::adjoint::scene::mass_kind_adjoint_test {

namespace {

using core::geometry::Mesh;
using core::scene::MassKind;

// A box away from the origin, none of whose vertices stands straight.
Mesh skewed_box() {
    Mesh mesh = tests::support::box_mesh(Vector3(0.2, -0.1, 0.4), Vector3(0.5, 0.3, 0.9));
    for (Eigen::Index i = 0; i < mesh.vertices.cols(); ++i) {
        const auto k = static_cast<double>(i);
        mesh.vertices.col(i) += 0.02 * Vector3(std::sin(3 * k), std::cos(5 * k), std::sin(7 * k + 1));
    }
    return mesh;
}

// One triangle of its side is left out.
Mesh nearly_closed_box() {
    Mesh mesh = skewed_box();
    mesh.triangles.erase(mesh.triangles.begin() + 4);
    core::geometry::build_connectivity(mesh);
    return mesh;
}

double relative_error(const Mesh& mesh, MassKind kind) {
    const Eigen::Index n = mesh.vertices.cols();
    Matrix3X bar = Matrix3X::Zero(3, n);
    adjoint::scene::amount_adjoint(mesh, kind, 1.7, bar);
    return tests::support::check_gradient(
               [&](const VectorX& x) {
                   Mesh moved = mesh;
                   moved.vertices += x.reshaped(3, n);
                   return 1.7 * core::scene::unit_moments(moved, kind)(3, 3);
               },
               VectorX::Zero(3 * n), bar.reshaped(), {1e-2, 0.25, 5})
        .relative_error;
}

}  // namespace

TEST_CASE("the derivative of what a density counts, for each kind") {
    CHECK(relative_error(skewed_box(), MassKind::volume) < 1e-9);
    CHECK(relative_error(skewed_box(), MassKind::area) < 1e-9);
    CHECK(relative_error(skewed_box(), MassKind::length) < 1e-9);
    Matrix3X bar = Matrix3X::Zero(3, 8);
    adjoint::scene::amount_adjoint(skewed_box(), MassKind::vertex, 1, bar);
    CHECK(bar.isZero(0));
}

TEST_CASE("the volume of a nearly closed mesh takes its caps along") {
    const Mesh mesh = nearly_closed_box();
    REQUIRE(core::geometry::openings(mesh.vertices, mesh.triangles).size() == 1);
    CHECK(relative_error(mesh, MassKind::volume) < 1e-9);
}

}  // namespace fettle::adjoint::scene::mass_kind_adjoint_test
