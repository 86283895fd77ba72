// SPDX-License-Identifier: MIT
#include "adjoint/contact/contact_pair_adjoint.hpp"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <random>

#include "tests/support/derivative_check.hpp"

namespace fettle::adjoint::contact::contact_pair_adjoint_test {

using namespace fettle::tests;

namespace {

using adjoint::contact::is_mollified;
using adjoint::contact::mollifier_eps_gradient;
using adjoint::contact::pair_forces_eps_derivative;
using core::contact::BarrierParameters;
using core::contact::ContactPair;
using core::geometry::PairType;

constexpr double dhat = 1e-2;

BarrierParameters parameters(double dmin) { return core::contact::barrier_parameters(dhat, dmin, 1e4, 1e-4); }

ContactPair edge_pair(const core::geometry::PairVertices& x, double eps) {
    ContactPair pair;
    pair.type = PairType::edge_edge;
    pair.x = x;
    pair.closest = core::contact::closest_points(pair.type, x);
    pair.mollifier_eps = eps;
    return pair;
}

// Two edges about 0.1 m long, crossing at `angle`, a gap apart.
ContactPair crossing(double angle, double gap, double slide = 0) {
    const double c = std::cos(angle), s = std::sin(angle);
    const core::geometry::PairVertices x{Vector3(-0.05, 0, 0), Vector3(0.06, 0.001, 0), Vector3(-0.05 * c + slide, -0.05 * s, gap),
                                         Vector3(0.04 * c + slide, 0.04 * s, gap + 1e-4)};
    // Undeformed lengths a little different from the present ones, as eps and c are independent here.
    return edge_pair(x, core::contact::mollifier_scale * 0.11 * 0.11 * 0.088 * 0.092);
}

VectorX stacked(const std::array<Vector3, 4>& f) {
    VectorX out(12);
    out << f[0], f[1], f[2], f[3];
    return out;
}

}  // namespace

TEST_CASE("forces of nearly parallel edges follow eps", "[adjoint][contact]") {
    for (const double dmin : {0.0, 2e-3})
        for (const double angle : {1e-4, 0.003, 0.011, 0.02, 0.03})
            for (const double slide : {0.0, 0.02, 0.098}) {  // the last one: an end beyond the other edge
                ContactPair pair = crossing(angle, dmin + 0.4 * dhat, slide);
                REQUIRE(is_mollified(pair));
                const BarrierParameters p = parameters(dmin);
                const double eps = pair.mollifier_eps;
                VectorX log_eps = VectorX::Zero(1);  // relative steps: eps is tiny
                const auto forces = [&](const VectorX& s) {
                    ContactPair other = pair;
                    other.mollifier_eps = eps * (1 + s[0]);
                    return stacked(pair_forces(other, p));
                };
                CAPTURE(dmin, angle, slide, core::contact::edge_cross_squared(pair.x) / eps);
                const VectorX derivative = eps * stacked(pair_forces_eps_derivative(pair, p));
                CHECK(derivative.norm() > 1e-9 * stacked(pair_forces(pair, p)).norm());
                CHECK(support::check_directional(forces, log_eps, VectorX::Ones(1), derivative, {1e-2, 0.25, 12}).relative_error < 1e-7);
            }
}

TEST_CASE("edges at an angle do not depend on eps", "[adjoint][contact]") {
    const ContactPair pair = crossing(0.1, 0.4 * dhat);
    CHECK_FALSE(is_mollified(pair));
    CHECK_THROWS(pair_forces_eps_derivative(pair, parameters(0)));
    ContactPair point = pair;
    point.type = PairType::point_triangle;
    CHECK_FALSE(is_mollified(point));
}

TEST_CASE("eps follows the undeformed edges", "[adjoint][contact]") {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> uniform(-1, 1);
    const VectorX x = VectorX::NullaryExpr(12, [&] { return uniform(random); });
    const auto eps = [](const VectorX& y) {
        const double a = (y.segment<3>(3) - y.segment<3>(0)).squaredNorm(), b = (y.segment<3>(9) - y.segment<3>(6)).squaredNorm();
        return core::contact::mollifier_scale * a * b;
    };
    const VectorX gradient = stacked(mollifier_eps_gradient(x.segment<3>(0), x.segment<3>(3), x.segment<3>(6), x.segment<3>(9)));
    CHECK(support::check_gradient(eps, x, gradient).relative_error < 1e-9);
    // Homogeneous of degree 4 (Euler).
    CHECK(gradient.dot(x) == Approx(4 * eps(x)).epsilon(1e-13));
}

}  // namespace fettle::adjoint::contact::contact_pair_adjoint_test
