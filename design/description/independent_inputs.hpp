// SPDX-License-Identifier: MIT
/// What the deviations of a design's tolerances follow from, independent of each other: each tolerance's own part and, for each group of
/// tolerances that vary together (the parts of one print), one number that they share:
///   d_j = own_j + c_j z_g,   c_j = sign(r_j) sqrt(|r_j|) s_j,   z_g standard normal,   own_j of variance (1 - |r_j|) s_j^2
/// so that d_j keeps its mean and standard deviation s_j, and d_j and d_k of one group have the correlation sign(r_j r_k) sqrt(|r_j r_k|).
/// With H and g in the deviations, those in the inputs x are map^T H map and map^T g.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "design/description/tolerance.hpp"
#include "design/tolerances/moments.hpp"
#include "design/tolerances/sobol.hpp"

namespace fettle::design::description {

struct IndependentInputs {
    std::vector<tolerances::Moments> moments;  ///< as many as tolerances, of what is theirs alone, then one per group
    std::vector<std::string> groups;
    MatrixX map;  ///< d = map x

    int count() const { return count_of(moments); }
};

/// Contract: what is in a group is normal.
IndependentInputs independent_inputs(const std::vector<Tolerance>& tolerances);

/// Samples of the deviations: at the points of a scrambled Sobol sequence (tolerances/sobol.hpp).
class DeviationSamples {
public:
    /// Contract: `tolerances` outlives this, and is not empty.
    DeviationSamples(const std::vector<Tolerance>& tolerances, std::uint64_t seed);

    /// One per tolerance, of sample k = 0, 1, ...; the same however many are asked for.
    VectorX at(int k) const;

private:
    const std::vector<Tolerance>& tolerances_;
    const IndependentInputs inputs_;
    const tolerances::SobolPoints points_;
};

}  // namespace fettle::design::description
