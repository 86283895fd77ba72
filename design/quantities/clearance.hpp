// SPDX-License-Identifier: MIT
/// Certified clearance of two bodies [m], as assembled or over the motion (or a window of it: the least distance over a long motion jumps
/// between times that are far apart, and is not smooth there; as one quantity per window each follows its own). As assembled, for a pin in
/// a bore drawn concentric, it is the play of the fit (half the diametral one), as long as the fit is where the two are closest.
///
/// It is the clearance of solids: where they are found to pass through each other no bound is met; where one lies wholly inside the other's
/// material (PairClearance::solids) it is minus the distance of the surfaces, and no bound is met either. For bodies that are not closed,
/// which have no inside, it is the distance of the surfaces.
#pragma once

#include <utility>

#include "fettle/design/description/quantity.hpp"

namespace fettle::design::quantities {

struct ClearanceRange {
    int a = 0, b = 0;             ///< bodies
    bool motion = false;          ///< over the trajectory; false: as assembled
    int window = 0, windows = 1;  ///< which of how many equal parts of the motion
};

class Clearance : public description::Quantity {
public:
    /// @param minimum  What the certificate's verdict (PairClearance::status) is about [m]; changes no bound.
    explicit Clearance(const ClearanceRange& range, double minimum = 0) : range_(range), minimum_(minimum) {}

    const ClearanceRange& range() const { return range_; }
    double minimum() const { return minimum_; }
    Dimension dimension() const override { return Dimension::length; }
    description::Measurement value(const description::Simulated& simulated) const override;
    void add_seeds(const description::Simulated& simulated, const description::Measurement& measured, double scale,
                   description::Seeds& seeds) const override;
    /// The witness, then the most distinct (adjoint/clearance/distinct_witnesses.hpp) of the features that come as near at its instant, and
    /// of the nearest instants in each of `branch_windows` equal parts of the range's time.
    std::vector<description::Branch> branches(const description::Simulated& simulated, const description::Measurement& measured,
                                              double limit) const override;
    bool is_at_rest() const override { return !range_.motion; }
    Errors check(const core::model::Model& model, int steps) const override;

    /// At most so many; each over the motion is one seed more in the sweep, those as assembled cost next to nothing.
    static constexpr int most_branches = 6, most_branches_at_rest = 12, branch_windows = 8;

private:
    std::vector<core::clearance::Witness> other_witnesses(const description::Simulated& simulated,
                                                          const core::clearance::PairClearance& pair, double room) const;
    core::clearance::PairClearance certify(const description::Simulated& simulated) const;

    ClearanceRange range_;
    double minimum_;
};

/// Steps [first, last) of window w of n: [floor(w steps / n), floor((w + 1) steps / n)), and one step where that is empty (n > steps).
std::pair<int, int> window_steps(int steps, int window, int windows);

}  // namespace fettle::design::quantities
