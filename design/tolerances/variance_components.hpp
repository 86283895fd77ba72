// SPDX-License-Identifier: MIT
/// How much groups (prints) differ as wholes, and how much what is in one of them spreads: y = mean + u + e, u normal of variance B for
/// each group, e normal of variance W for each of its members, of which each group has n.
///   within    mean square of members about their groups, of f2 degrees of freedom: expects W
///   between   n times the variance of the groups' means, of f1 = groups - 1: expects n B + W
/// Estimates of B and of the share r = B / (B + W), where they come out below 0, are 0. With F = between / within:
///   of sqrt(B)   Williams and Tukey: B from f1 (between - F_u within) / (n chi2_u) to f1 (between - F_l within) / (n chi2_l)
///   of r         (F / F_u - 1) / (n + F / F_u - 1) to the same of F_l: exact
///   above B + W  Graybill and Wang, one-sided: theta + sqrt(sum (h_i c_i S_i)^2), c = (1/n, (n - 1)/n), h_i = f_i / chi2(5%) - 1
/// of which u and l are the quantiles at (1 +- confidence) / 2; ends below 0 are 0. Where groups are of different sizes n is their harmonic
/// mean, and all of it holds nearly.
/// Sources: Williams 1962, Biometrika 49; Graybill and Wang 1980, JASA 75; Searle, Casella and McCulloch 1992, Variance Components, 3.6;
/// Thomas and Hultquist 1978, Annals of Statistics 6 (harmonic means).
#pragma once

namespace fettle::design::tolerances {

struct Interval {
    double value = 0, least = 0, most = 0;
};

struct MeanSquares {
    double between = 0, within = 0;               ///< [y^2], at least 0
    int between_freedom = 0, within_freedom = 0;  ///< Contract: at least 1
    double size = 1;                              ///< n. Contract: at least 1
};

struct VarianceComponents {
    Interval between;        ///< sqrt(B) [y]
    Interval share;          ///< r [1]
    double total = 0;        ///< sqrt(B + W) [y]
    double total_bound = 0;  ///< it is at most this, with 95% confidence [y]
};

/// At 95%.
VarianceComponents variance_components(const MeanSquares& squares);

/// The number that a chi-square of `freedom` is below with probability p. Contract: 0 < p < 1.
double chi_square_quantile(int freedom, double p);
/// The same of Fisher's F.
double f_quantile(int freedom1, int freedom2, double p);

}  // namespace fettle::design::tolerances
