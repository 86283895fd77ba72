// SPDX-License-Identifier: MIT
/// The extremes of a made design's number over all deviations within their limits, searched for by whole simulations: from the corner that
/// its derivatives name and from the one that its second order names, by the optimiser. What is found is attained; that nothing lies beyond
/// it is not proven.
#pragma once

#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "design/studies/made_responses.hpp"

namespace fettle::design::studies {

/// What is known of the number before the search.
struct LocalModel {
    double nominal = 0;
    VectorX gradient;   ///< per tolerance
    MatrixX curvature;  ///< empty: not known
};

struct FoundExtreme {
    double value = 0;      ///< NaN: nothing that was tried could be simulated
    VectorX deviations;    ///< where
    bool settled = false;  ///< the optimiser sees no more to gain
    std::string failure;   ///< of a mechanism within the limits that could not be simulated, the first that was met; empty: none
    VectorX failed_at;     ///< its deviations
    int simulations = 0;   ///< that were looked at, those too that another number's search had made
};

/// Searches for extremes of several numbers of one design, which share their simulations.
class WorstCaseSearch {
public:
    /// Contract: outlives this.
    explicit WorstCaseSearch(const MadeResponses& design);

    /// @param number  One of the design's numbers. @param side  1: its largest value, -1: its least.
    /// Throws optimisers::Interrupted. May be called from several threads at once.
    FoundExtreme extreme(int number, double side, const LocalModel& model);

private:
    MadeEvaluation evaluated(const VectorX& deviations);

    const MadeResponses& design_;
    VectorX lower_, upper_;
    std::mutex mutex_;
    std::map<std::vector<double>, MadeEvaluation> known_;  // by deviations
};

/// The deviations in the box at which side * (g . d + d^T H d / 2) is largest, as far as it is found: the best end of climbs along one
/// coordinate after the other, from every corner of a small box, else from the middle and the corners that g and -g name.
VectorX quadratic_corner(const LocalModel& model, double side, const VectorX& lower, const VectorX& upper);

}  // namespace fettle::design::studies
