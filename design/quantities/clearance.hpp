// SPDX-License-Identifier: MIT
/// Certified clearance of two bodies [m], as assembled, over the motion (or a part of it: the least distance over a long motion jumps
/// between times that are far apart, and is not smooth there; as one quantity per window each follows its own), or over all positions of
/// the joints within their limits, whatever the motion. As assembled, for a pin in a bore drawn concentric, it is the play of the fit (half
/// the diametral one), as long as the fit is where the two are closest.
///
/// Between faces that the parts name (core/geometry/named_faces.hpp) it is the least distance of these faces, whatever else is nearer: of a
/// pin and a slot. Faces have no inside: that the solids do not overlap is what the clearance of the whole pair says.
///
/// Else it is the clearance of solids: where they are found to pass through each other no bound is met; where one lies wholly inside the
/// other's material (PairClearance::solids) it is minus the distance of the surfaces, and no bound is met either. For bodies that are not
/// closed, which have no inside, it is the distance of the surfaces.
#pragma once

#include <utility>
#include <vector>

#include "core/clearance/faces_alone.hpp"
#include "design/description/quantity.hpp"

namespace fettle::design::quantities {

using description::ClearanceRange;

class Clearance : public description::Quantity {
public:
    /// @param minimum  What the certificate's verdict (PairClearance::status) is about [m]; changes no bound.
    explicit Clearance(const ClearanceRange& range, double minimum = 0) : range_(range), minimum_(minimum) {}

    const ClearanceRange& range() const { return range_; }
    double minimum() const { return minimum_; }
    Dimension dimension() const override { return Dimension::length; }
    description::QuantityFacts facts() const override { return {.clearance = &range_}; }
    description::Measurement value(const description::Simulated& simulated) const override;
    void add_seeds(const description::Simulated& simulated, const description::Measurement& measured, double scale,
                   description::Seeds& seeds) const override;
    /// The witness, then the others that say most about where the clearance can go (adjoint/clearance/local_witnesses.hpp): of the range's
    /// time, or of the joints' ranges, in `branch_parts` equal parts.
    std::vector<description::Branch> branches(const description::Simulated& simulated, const description::Measurement& measured,
                                              double limit) const override;
    bool is_at_rest() const override { return !range_.motion; }
    Errors check(const core::model::Model& model, int steps) const override;

    /// At most so many; each over the motion is one seed more in the sweep, those as assembled and over ranges cost next to nothing.
    static constexpr int most_branches = 6, most_branches_at_rest = 12, branch_parts = 8;

private:
    bool has_faces() const { return !range_.faces_a.empty() || !range_.faces_b.empty(); }
    void add_seeds_of(const description::Simulated& simulated, const core::clearance::PairClearance& pair, double scale,
                      description::Seeds& seeds) const;
    std::vector<core::clearance::PairClearance> others(const description::Simulated& simulated, const core::clearance::PairClearance& pair,
                                                       double room) const;
    core::clearance::PairClearance certify(const description::Simulated& simulated) const;
    core::clearance::PairClearance certify_ranges(const core::model::Model& model, const core::clearance::ClearanceOptions& options) const;

    ClearanceRange range_;
    double minimum_;
};

/// The steps [first, last) that a range is over, of so many of `timestep` [s].
std::pair<int, int> steps_of(const ClearanceRange& range, double timestep, int steps);

/// Steps [first, last) of window w of n: [floor(w steps / n), floor((w + 1) steps / n)), and one step where that is empty (n > steps).
std::pair<int, int> window_steps(int steps, int window, int windows);

}  // namespace fettle::design::quantities
