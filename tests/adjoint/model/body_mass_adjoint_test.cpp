// SPDX-License-Identifier: MIT
#include "adjoint/model/body_mass_adjoint.hpp"

#include <catch2/catch.hpp>
#include <random>

#include "core/model/body_mass.hpp"
#include "tests/support/derivative_check.hpp"
#include "tests/support/test_models.hpp"

namespace fettle::adjoint::model::body_mass_adjoint_test {

namespace {

using core::geometry::Mesh;
using core::model::Body;
using core::scene::MassKind;

constexpr double dhat = 1e-3;

Body body_of(Mesh mesh, MassKind kind, double density) {
    Body body = tests::support::make_body("body", std::move(mesh), {}, core::scene::BodyType::dynamic_body, density);
    body.mass_kind = kind;
    body.moments = core::model::mass_moments(body, dhat);
    return body;
}

Mesh skewed_box() {
    Mesh mesh = tests::support::box_mesh(Vector3(-0.2, -0.1, -0.3), Vector3(0.3, 0.3, 0.4));
    for (Eigen::Index i = 0; i < mesh.vertices.cols(); ++i) {
        const auto k = static_cast<double>(i);
        mesh.vertices.col(i) += 0.02 * Vector3(std::sin(3 * k), std::cos(5 * k), std::sin(7 * k + 1));
    }
    return mesh;
}

Mesh nearly_closed_box() {
    Mesh mesh = skewed_box();
    mesh.triangles.erase(mesh.triangles.begin() + 4);
    core::geometry::build_connectivity(mesh);
    return mesh;
}

Mesh wire(int ends) {
    Matrix3X x(3, ends);
    for (int k = 0; k < ends; ++k) x.col(k) = k < 2 ? Vector3(0.3 * k - 0.1, 0.1 * k, 0.05) : Vector3(0.2, 0.3, 0.1 * k);
    Mesh mesh = core::geometry::make_mesh("wire", x, {});
    std::vector<core::geometry::Edge> edges;
    for (int k = 0; k + 1 < ends; ++k) edges.push_back({k, k + 1});
    core::geometry::build_connectivity(mesh, edges);
    return mesh;
}

Mesh points(int count) {
    Matrix3X x(3, count);
    for (int k = 0; k < count; ++k) x.col(k) = Vector3(0.1 * k, 0.05 * std::sin(k), k > 2 ? 0.2 : 0.01);
    return core::geometry::make_mesh("points", x, {});
}

}  // namespace

TEST_CASE("a body's moments follow vertices and density: solid, capped, shell, wires, points", "[adjoint]") {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> unit(-1, 1);
    const std::pair<const char*, Body> cases[] = {
        {"solid", body_of(skewed_box(), MassKind::volume, 900)},    {"capped", body_of(nearly_closed_box(), MassKind::volume, 900)},
        {"shell", body_of(skewed_box(), MassKind::area, 3)},        {"open shell", body_of(nearly_closed_box(), MassKind::area, 3)},
        {"edges", body_of(skewed_box(), MassKind::length, 0.2)},    {"bent wire", body_of(wire(4), MassKind::length, 0.2)},
        {"straight wire", body_of(wire(2), MassKind::length, 0.2)}, {"points", body_of(points(4), MassKind::vertex, 0.1)},
        {"two points", body_of(points(2), MassKind::vertex, 0.1)},  {"one point", body_of(points(1), MassKind::vertex, 0.1)}};
    for (const auto& [name, body] : cases) {
        CAPTURE(name);
        REQUIRE(has_moments_of_mesh(body, dhat));
        const Eigen::Index n = body.mesh.vertices.cols();
        const auto moments = [&, &body = body](const VectorX& x) {
            Body moved = body;
            moved.mesh.vertices += x.head(3 * n).reshaped(3, n);
            moved.density += x[3 * n];
            tests::support::refresh(moved);
            return VectorX(core::model::mass_moments(moved, dhat).reshaped());
        };
        const auto tangent = [&, &body = body](const VectorX& v) {
            return VectorX(
                mass_moments_tangent(
                    body, dhat,
                    {v.head(3 * n).reshaped(3, n), Vector6::Zero(), Matrix34::Zero(), v[3 * n], Vector3::Zero(), Vector3::Zero(), {}})
                    .reshaped());
        };
        const auto transposed = [&, &body = body](const VectorX& w) {
            BodyGradient bar;
            bar.vertices_bar = Matrix3X::Zero(3, n);
            mass_moments_adjoint(body, dhat, w.reshaped(4, 4), bar);
            VectorX out(3 * n + 1);
            out << bar.vertices_bar.reshaped(), bar.density_bar;
            return out;
        };
        VectorX along = VectorX::NullaryExpr(3 * n + 1, [&] { return unit(random); });
        along[3 * n] *= body.density;
        const VectorX zero = VectorX::Zero(3 * n + 1);
        CHECK(tests::support::check_directional(moments, zero, along, tangent(along), {1e-3, 0.25, 8}).relative_error < 1e-8);
        CHECK(tests::support::check_transpose(tangent, transposed, static_cast<int>(3 * n + 1), 16) < 1e-13);
    }
}

TEST_CASE("moments from elsewhere are not those of the mesh", "[adjoint]") {
    core::model::Model model;
    model.bodies = {body_of(skewed_box(), MassKind::area, 3)};
    CHECK(check_masses(model).empty());
    model.bodies[0].moments(0, 0) *= 1.001;
    CHECK(check_masses(model).size() == 1);
    for (int k = 0; k < 6; ++k) tests::support::prescribe(model.bodies[0], k);
    CHECK(check_masses(model).empty());
}

}  // namespace fettle::adjoint::model::body_mass_adjoint_test
