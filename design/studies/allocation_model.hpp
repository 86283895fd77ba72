// SPDX-License-Identifier: MIT
/// The allocation of tolerances as a problem of its own, on models of the requirements: no simulation here.
///
/// Tolerance j has its limits as they stand, times a factor f_j: limits that hold the nominal value are multiplied, others keep their
/// middle; a shift stays. Means m(f), covariance C(f) = F C F. A requirement has, with value y0, gradient g and second derivatives H
///   mean       y0 + g . m + 1/2 m^T H m + 1/2 tr(H C)
///   variance   a^T C a + 1/2 tr(H C H C),   a = g + H m                        exact for normal deviations
/// each corrected by what a study of the tolerances finds (a mean that is off, a standard deviation that is so many times as large).
///   minimise sum cost_j(f_j)   subject to   log sigma <= log sigma_allowed(mean), of each requirement
/// in log f, where it is convex but for the second order: sigma_allowed is the largest sigma with which a normal number of that mean has
/// the yield. In the worst case, y0 + the largest and least of g . d over the limits lie within the bounds.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/base/types.hpp"
#include "design/tolerances/distribution.hpp"
#include "design/tolerances/yield.hpp"

namespace fettle::design::studies {

/// Largest and least factor that a tolerance is given.
inline constexpr double largest_factor = 10, least_factor = 1e-3;

/// Limits times a factor: about the nominal value where they hold it, else about their middle.
tolerances::Distribution scaled(tolerances::Distribution deviation, double factor);

struct RequirementModel {
    tolerances::RequirementLimits limits;
    double nominal = 0;
    VectorX gradient;   ///< per tolerance
    MatrixX curvature;  ///< empty: none
    double mean_correction = 0, sigma_correction = 1;
    double outside = 0.0027;                           ///< largest share of products beyond the limits
    double least_correction = 0, most_correction = 0;  ///< of a worst case: what is found beyond the linear one
};

/// What a tolerance costs at a factor, and the derivative in it.
struct CostAt {
    double value = 0, slope = 0;
};

struct AllocationModel {
    std::vector<tolerances::Distribution> deviations;  ///< as they stand
    MatrixX correlation;                               ///< of the deviations
    std::vector<bool> is_fixed;
    VectorX least;  ///< factors; empty: least_factor
    std::vector<std::function<CostAt(double factor)>> costs;
    std::vector<RequirementModel> requirements;
    bool worst_case = false;
};

/// Mean and standard deviation of a requirement, and its derivatives in the factors.
struct ModelMoments {
    double mean = 0, sigma = 0;
    VectorX mean_slope, sigma_slope;
};
ModelMoments moments_at(const AllocationModel& model, const RequirementModel& requirement, const VectorX& factors);

/// The largest standard deviation with which no more than `outside` of a normal number lies beyond the limits; 0 where the mean does.
/// Contract: 0 < outside < 1/2; a limit is finite.
double allowed_sigma(double mean, const tolerances::RequirementLimits& limits, double outside);

/// By how much each requirement is missed, at most 0 where it is held: log(sigma / allowed), or in the worst case the share of the way from
/// the nominal value to the bound. Infinite where the mean lies beyond a bound.
VectorX misses(const AllocationModel& model, const VectorX& factors);

struct AllocationSolution {
    bool is_held = false;  ///< else: not even with every tolerance that is free as tight as it may be
    VectorX factors;
    double cost = 0;
    std::string message;
};
/// Deterministic. Throws core::base::MissingLibrary where Ipopt is not there.
AllocationSolution solve(const AllocationModel& model);

double cost_of(const AllocationModel& model, const VectorX& factors);

}  // namespace fettle::design::studies
