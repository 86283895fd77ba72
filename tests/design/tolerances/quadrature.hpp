// SPDX-License-Identifier: MIT
/// For tests: expectations by Gauss quadrature, as an oracle that shares nothing with design/tolerances.
#pragma once

#include <Eigen/Eigenvalues>
#include <cmath>
#include <functional>

#include "core/base/types.hpp"
#include "design/tolerances/moments.hpp"

namespace fettle::tests::design_support {

using design::tolerances::Moments;

/// E[f(z)] = sum weights_i f(nodes_i), exact for polynomials of degree 2 n - 1.
struct GaussRule {
    VectorX nodes, weights;
};

/// Golub and Welsch 1969: of the density whose orthogonal polynomials have a recurrence with these off-diagonal entries.
inline GaussRule gauss_rule(int n, const std::function<double(int)>& off_diagonal) {
    MatrixX jacobi = MatrixX::Zero(n, n);
    for (int k = 1; k < n; ++k) jacobi(k, k - 1) = jacobi(k - 1, k) = off_diagonal(k);
    const Eigen::SelfAdjointEigenSolver<MatrixX> solver(jacobi);
    return {solver.eigenvalues(), solver.eigenvectors().row(0).array().square().transpose()};
}

/// z standard normal.
inline GaussRule gauss_hermite(int n) {
    return gauss_rule(n, [](int k) { return std::sqrt(double(k)); });
}

/// z uniform in [-1, 1].
inline GaussRule gauss_legendre(int n) {
    return gauss_rule(n, [](int k) { return k / std::sqrt(4.0 * k * k - 1); });
}

/// E[f(z)] of independent z_1 .. z_dimension, each of the rule's density.
inline double tensor_expectation(const GaussRule& rule, int dimension, const std::function<double(const VectorX&)>& f) {
    VectorX z(dimension);
    const std::function<double(int)> sum_from = [&](int j) -> double {
        if (j == dimension) return f(z);
        double sum = 0;
        for (Eigen::Index i = 0; i < rule.nodes.size(); ++i) {
            z[j] = rule.nodes[i];
            sum += rule.weights[i] * sum_from(j + 1);
        }
        return sum;
    };
    return sum_from(0);
}

inline Moments tensor_moments(const GaussRule& rule, int dimension, const std::function<double(const VectorX&)>& f) {
    Moments result;
    result.mean = tensor_expectation(rule, dimension, f);
    const auto central = [&](int power) {
        return tensor_expectation(rule, dimension, [&](const VectorX& z) { return std::pow(f(z) - result.mean, power); });
    };
    result.standard_deviation = std::sqrt(central(2));
    result.third = central(3);
    result.fourth = central(4);
    return result;
}

}  // namespace fettle::tests::design_support
