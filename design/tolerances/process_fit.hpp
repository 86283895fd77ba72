// SPDX-License-Identifier: MIT
/// Bias and spread of a process (process.hpp) from measured features of a print, kind by kind.
///
/// Feature i of nominal size d_i, measured m_i times, is y_i = mean of its measurements - d_i. Model: y_i = b0 + b1 d_i + e_i, the e_i
/// independent and normal, of variance s_p^2 + r^2 / m_i, by the process and by measuring.
///   r        repeatability: pooled standard deviation of the measurements of one feature, over all features of all kinds
///   b0, b1   weighted least squares with weights (s_p^2 + r^2 / m) / (s_p^2 + r^2 / m_i), m the harmonic mean of the m_i, s_p by the rule
///            of Paule and Mandel; all 1 where every feature was measured as often. Without b1 where fewer than 5 features are measured, or
///            fewer than 3 sizes
///   s        residual standard deviation: s^2 = sum w_i e_i^2 / f, f = n - 2 or n - 1. Holds what measuring adds: r^2 / m of it
/// Intervals hold the truth in 95 of 100 prints, where m_i are alike: of the bias at the mean size by Student's t, of s by chi-square:
/// s sqrt(f / chi2(97.5%)) to s sqrt(f / chi2(2.5%)).
///
/// Nothing in one print shows how much the next one differs as a whole: what all its features share is in the bias. P prints have the model
/// y_pi = b0 + b1 d_i + u_p + e_pi, u_p normal of variance s_b^2, a number of the kind and the print.
///   b1       least squares within the prints, each with a constant of its own; f = n - P - 1, or n - P without it; s^2 = sum e_i^2 / f
///   b0       mean of the prints' constants at the mean size; its interval by Student's t of P - 1, from how these differ
///   s_b      variance_components.hpp, and the share s_b^2 / (s_b^2 + s^2) that features of one print have in common
/// All measurements count alike there, whatever their number.
/// Sources: Paule and Mandel 1982, J. Research NBS 87(5); Cook and Weisberg 1982, Residuals and Influence in Regression, 2.2 (outliers).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "design/tolerances/process.hpp"
#include "design/tolerances/variance_components.hpp"

namespace fettle::design::tolerances {

struct MeasuredFeature {
    std::string name;  ///< "hole 3"
    FeatureKind kind = FeatureKind::length;
    double nominal = 0;            ///< [m]
    std::vector<double> measured;  ///< [m]; none: not measured
    int print = 0;                 ///< 0, 1, ...: that it is of
};

/// A feature further from the fit than one of its number by chance, at 5%: its residual over the standard deviation that the others say.
struct OutlyingFeature {
    std::string name;
    double residual = 0;     ///< y_i - fit [m]
    double studentised = 0;  ///< [1]
};

struct KindFit {
    FeatureKind kind = FeatureKind::length;
    int features = 0, measurements = 0;
    double from = 0, up_to = 0;  ///< sizes measured [m]
    double mean_size = 0;        ///< weighted [m]
    Interval bias;               ///< at the mean size [m]
    Interval bias_per_size;      ///< b1 [1]; all 0 where has_slope is not
    bool has_slope = false;
    Interval spread;                                    ///< s [m]
    int degrees_of_freedom = 0;                         ///< f
    double process_spread = 0;                          ///< s less what measuring adds: sqrt(max(0, s^2 - r^2 / m)) [m]
    double spread_bound = 0;                            ///< s sqrt(f / chi2(5%)): at most this, with 95% confidence [m]
    std::vector<OutlyingFeature> outliers;              ///< they stay in the fit; not looked for where there are several prints
    int prints = 1;                                     ///< that it was measured in
    std::optional<VarianceComponents> components = {};  ///< of several prints
};

/// With fewer prints, how much they differ has no upper bound that is of use (of two, 16 times the estimate): the estimate counts.
inline constexpr int least_bounded_prints = 4;

/// One standard deviation as tolerances take it [m]: spread_bound of one print; of several the total's bound, or, of fewer than
/// least_bounded_prints, spread_bound with s_b as it is found.
double taken_spread(const KindFit& fit);

/// Is there more than rounding? Where all features are off by the same, the measuring tool's steps hide what they spread.
bool has_spread(const KindFit& fit);

/// b0 [m].
double bias_at_no_size(const KindFit& fit);

struct ProcessFit {
    std::vector<KindFit> kinds;
    struct TooFew {
        FeatureKind kind = FeatureKind::length;
        int features = 0;  ///< measured
    };
    std::vector<TooFew> too_few;  ///< kinds that are measured, but fewer than least_features of them
    double repeatability = 0;     ///< r [m]; 0 where nothing was measured twice
    int repeats = 0;              ///< degrees of freedom of r; 0: it is not known, and counted as 0
    int prints = 1;               ///< that something was measured in
};

inline constexpr int least_features = 3;

/// Errors: no kind with enough measured features (out_of_range).
/// Contract: sizes over 0, everything finite, no angles.
Result<ProcessFit> fit_process(const std::vector<MeasuredFeature>& features, const std::string& where);

/// The fit as a process: what it does not have, of `base`. Its tolerance is three times taken_spread, not three times s: of few features
/// s is too small in more than half of the prints, of six features by half in one of ten, and a yield that rests on it promises too much.
/// What the features of a kind share is, of several prints, the share that was found.
/// Where no spread is seen (has_spread), the limits about the bias are those of `base`.
Process fitted_process(const ProcessFit& fit, const std::string& name, const Process& base);

}  // namespace fettle::design::tolerances
