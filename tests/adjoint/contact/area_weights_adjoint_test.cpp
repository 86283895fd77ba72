// SPDX-License-Identifier: MIT
#include "adjoint/contact/area_weights_adjoint.hpp"

#include <catch2/catch.hpp>
#include <random>

#include "tests/support/derivative_check.hpp"
#include "tests/support/test_models.hpp"

namespace fettle::adjoint::contact::area_weights_adjoint_test {

TEST_CASE("areas of vertices and edges follow the vertices", "[adjoint][area_weight]") {
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> unit(-1, 1);
    core::model::Body body = tests::support::make_body("box", tests::support::box_mesh({-0.3, -0.1, -0.2}, {0.5, 0.3, 0.4}), {});
    const Eigen::Index n = body.mesh.vertices.cols(), edges = static_cast<Eigen::Index>(body.mesh.edges.size());
    body.mesh.vertices += 0.05 * Matrix3X::NullaryExpr(3, n, [&] { return unit(random); });
    tests::support::refresh(body);
    const auto areas = [&](const VectorX& x) {
        core::model::Body moved = body;
        moved.mesh.vertices += x.reshaped(3, n);
        tests::support::refresh(moved);
        VectorX out(n + edges);
        for (Eigen::Index k = 0; k < n; ++k) out[k] = moved.vertex_area[k];
        for (Eigen::Index k = 0; k < edges; ++k) out[n + k] = moved.edge_area[k];
        return out;
    };
    const auto tangent = [&](const VectorX& v) {
        const AreaChange change = areas_tangent(body.mesh, v.reshaped(3, n));
        VectorX out(n + edges);
        out << change.vertex, change.edge;
        return out;
    };
    const auto transposed = [&](const VectorX& w) {
        Matrix3X bar = Matrix3X::Zero(3, n);
        areas_adjoint(body.mesh, {w.head(n), w.tail(edges)}, bar);
        return VectorX(bar.reshaped());
    };
    const VectorX along = VectorX::NullaryExpr(3 * n, [&] { return unit(random); });
    const VectorX zero = VectorX::Zero(3 * n);
    CHECK(tests::support::check_directional(areas, zero, along, tangent(along), {1e-3, 0.25, 6}).relative_error < 1e-8);
    CHECK(tests::support::check_transpose(tangent, transposed, static_cast<int>(3 * n), static_cast<int>(n + edges)) < 1e-14);
}

}  // namespace fettle::adjoint::contact::area_weights_adjoint_test
