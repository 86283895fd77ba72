// SPDX-License-Identifier: MIT
#include "adjoint/energy/body_terms_adjoint.hpp"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <random>

namespace fettle::adjoint::energy::body_terms_adjoint_test {

TEST_CASE("the inertia's gradient follows pose_hat and moments", "[adjoint][energy]") {
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> uniform(-1, 1);
    const auto pose = [&] { return Matrix34(Matrix34::NullaryExpr([&] { return uniform(random); })); };
    const auto symmetric = [&] {
        const Matrix4 m = Matrix4::NullaryExpr([&] { return uniform(random); });
        return Matrix4(m + m.transpose());
    };
    const Matrix34 p = pose(), hat = pose(), v = pose(), p_dot = pose(), hat_dot = pose();
    const Matrix4 m = symmetric(), m_dot = symmetric();
    const auto residual = [&](const Matrix34& at, const Matrix34& target, const Matrix4& moments) {
        return ((at - target) * moments).cwiseProduct(v).sum();
    };
    // Bilinear: differences over a unit step are exact.
    const double by_hat = residual(p, hat + hat_dot, m) - residual(p, hat, m);
    CHECK(adjoint::energy::inertia_pose_hat_adjoint(v, m).cwiseProduct(hat_dot).sum() == Approx(by_hat).epsilon(1e-13));
    const double by_moments = residual(p, hat, m + m_dot) - residual(p, hat, m);
    CHECK(adjoint::energy::inertia_moments_adjoint(v, p - hat).cwiseProduct(m_dot).sum() == Approx(by_moments).epsilon(1e-13));
    const double by_pose = residual(p + p_dot, hat, m) - residual(p, hat, m);
    const Matrix34 tangent = adjoint::energy::inertia_gradient_tangent(p - hat, m, p_dot - hat_dot, m_dot);
    CHECK(tangent.cwiseProduct(v).sum() == Approx(by_pose + by_hat + by_moments).epsilon(1e-13));
}

}  // namespace fettle::adjoint::energy::body_terms_adjoint_test
