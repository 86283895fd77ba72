// SPDX-License-Identifier: MIT
// positive_part.hpp: against a matrix whose eigenvalues are known, and the two properties that make it the nearest one.
#include "core/linear/positive_part.hpp"

#include <catch2/catch.hpp>
#include <random>

namespace fettle::core::linear::positive_part_test {

TEST_CASE("positive part: M - P has no positive curvature, P no negative, and they are across each other") {
    const Eigen::Vector2d u(0.6, 0.8), v(-0.8, 0.6);
    MatrixX known = 3 * u * u.transpose() - 2 * v * v.transpose();
    const MatrixX part = positive_part(symmetric_eigen<Eigen::Dynamic>(known));
    CHECK((part - 3 * u * u.transpose()).norm() < 1e-14);
    std::mt19937 random(1);
    std::normal_distribution<double> normal;
    for (int trial = 0; trial < 20; ++trial) {
        Matrix6 m;
        for (double& x : m.reshaped()) x = normal(random);
        m = (m + m.transpose()).eval();
        const Matrix6 p = positive_part(symmetric_eigen<6>(m)), rest = m - p;
        CHECK(symmetric_eigenvalues<6>(p).minCoeff() > -1e-13);
        CHECK(symmetric_eigenvalues<6>(rest).maxCoeff() < 1e-13);
        CHECK((p * rest).norm() < 1e-12);
    }
}

}  // namespace fettle::core::linear::positive_part_test
