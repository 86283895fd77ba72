// SPDX-License-Identifier: MIT
/// Capability indices: how many times a result's spread fits between the limits of its requirement.
///   Cp  = (U - L) / (6 s),                      where both limits are there
///   Cpk = min(U - mean, mean - L) / (3 s),      one-sided where one limit is missing
/// Their usual reading (Cpk 1: at most 2700 ppm outside, Cpk 1.33: 66 ppm) holds for a normal result; yield.hpp gives shares for others.
#pragma once

#include <optional>

#include "design/tolerances/yield.hpp"

namespace fettle::design::tolerances {

/// A number [1] and its standard error; of error 0 where it follows from moments that are no estimates.
struct CapabilityIndex {
    double value = 0, error = 0;
};

struct Capability {
    std::optional<CapabilityIndex> cp;   ///< nothing where a limit is missing
    std::optional<CapabilityIndex> cpk;  ///< nothing where both are; negative where the mean lies outside of the limits
};

/// From known moments. Both indices are nothing where nothing varies. Contract: standard_deviation >= 0, limits in order.
Capability capability_of(double mean, double standard_deviation, const RequirementLimits& limits);

/// From mean and standard deviation of a sample of n values. The errors hold for independent values of a normal distribution:
///   Cp: Cp / sqrt(2 (n - 1));   Cpk: sqrt(1 / (9 n) + Cpk^2 / (2 (n - 1)))
/// Where the mean is near the middle of the limits, Cpk is a minimum of two that err in opposite directions: it comes out too small by
/// up to 0.27 / sqrt(n) on average, and its error is too large.
/// Source: Bissell 1990, How reliable is your capability index?, Applied Statistics 39(3).
/// @param n  Contract: n >= 2.
Capability estimated_capability(double mean, double standard_deviation, const RequirementLimits& limits, int n);

}  // namespace fettle::design::tolerances
