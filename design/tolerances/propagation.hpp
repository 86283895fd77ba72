// SPDX-License-Identifier: MIT
/// What deviations d of the inputs do to a result y, from its derivatives at the nominal: y = y0 + g . d + 1/2 d . H d.
/// The inputs are independent of each other. How far y departs from its linear or quadratic model is not seen here: only evaluations show.
#pragma once

#include <vector>

#include "design/tolerances/moments.hpp"

namespace fettle::design::tolerances {

/// Statistics of y0 + g . d with inputs of means m_j and standard deviations s_j.
struct LinearPrediction {
    double mean = 0;                ///< y0 + g . m
    double standard_deviation = 0;  ///< sqrt(sum g_j^2 s_j^2); with s_j = t_j / 3, a third of the "root sum of squares" of tolerances t_j
    VectorX shares;                 ///< g_j^2 s_j^2 / variance [1], which sum to 1; all 0 where the variance is
};

/// @param nominal   y0.
/// @param gradient  g. Contract: as many as inputs.
LinearPrediction predict_linearly(double nominal, const VectorX& gradient, const std::vector<Moments>& inputs);

/// The least and the most that y0 + g . d takes with each d_j from lower_j to upper_j, and the deviations at which it does: the corners
/// that the signs of g name, and where g_j = 0 the middle.
struct LinearWorstCase {
    double least = 0, most = 0;
    VectorX at_least, at_most;
};

/// Contract: lower <= upper, as many as g has; finite.
LinearWorstCase linear_worst_case(double nominal, const VectorX& gradient, const VectorX& lower, const VectorX& upper);

/// Moments of y0 + g . d + 1/2 d . H d. About the inputs' means: e = d - m, gradient h = g + H m, variances s_j^2, central moments t_j
/// (third) and f_j (fourth), with a_j = h_j s_j and B_jk = s_j H_jk s_k, and k_j = f_j - 3 s_j^4 (0 for normal inputs):
///   mean               y0 + g . m + 1/2 m . H m + 1/2 tr B
///   variance           a . a + 1/2 tr B^2 + sum (h_j H_jj t_j + 1/4 H_jj^2 k_j)
///   third moment       3 a . B a + tr B^3 + sum (h_j^3 t_j + 3/2 h_j^2 H_jj k_j)
///   fourth cumulant    12 a . B^2 a + 3 tr B^4 + sum h_j^4 k_j;   fourth moment = fourth cumulant + 3 variance^2
/// Exact for normal inputs (the cumulants of a quadratic form: Mathai and Provost 1992, Quadratic Forms in Random Variables, chapter 3).
/// For others mean and variance are exact, and what is neglected is
///   of the third moment:    terms in H^3 that inputs of a fourth cumulant add; where t is not 0 also terms in H^2
///   of the fourth cumulant: terms in H^2 and higher that inputs of a fourth cumulant add; where t is not 0 also terms in H
/// No term that is linear in H is neglected for symmetric inputs, nor any term for H = 0.
/// @param hessian  H, symmetric. Contract: square, as many rows as inputs.
Moments predict_quadratically(double nominal, const VectorX& gradient, const MatrixX& hessian, const std::vector<Moments>& inputs);

/// Third derivatives of y at the inputs' means, as far as moments need them. They follow, for a y with an adjoint, from the gradients by
/// which H is found: (g(d + h e_j) - 2 g(d) + g(d - h e_j)) / h^2 is row j of `twice`, and `along` from two gradients more, at d +- h v.
struct ThirdDerivatives {
    MatrixX twice;     ///< T_jjl = d^3 y / dd_j^2 dd_l, row j, column l
    double along = 0;  ///< sum over j, k, l of T_jkl v_j v_k v_l, with v_j = g_j s_j^2
};

/// The same with the first terms of third derivatives, which are of the order of what H adds:
///   variance         + sum over l != j of g_j T_llj s_j^2 s_l^2  + 1/3 sum g_j T_jjj f_j
///   fourth cumulant  + 4 sum over j, k, l of T_jkl v_j v_k v_l
/// For normal inputs whose deviations are of the size s, mean and third moment are then in error by terms in s^4 and s^6, where their own
/// first terms are in s^2 and s^4; the variance by s^6 (first: s^2), the fourth cumulant by s^8 (first: s^6).
/// @param inputs  Contract: of mean 0; derivatives of shifted inputs are to be taken at their means.
/// Source: Evans 1975, Statistical Tolerancing: The State of the Art, Part II, J. Quality Technology 7(1), for the first terms.
Moments predict_with_third_derivatives(double nominal, const VectorX& gradient, const MatrixX& hessian, const ThirdDerivatives& third,
                                       const std::vector<Moments>& inputs);

}  // namespace fettle::design::tolerances
