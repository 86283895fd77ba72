// SPDX-License-Identifier: MIT
/// Derivative of a clearance over all positions of the joints (core/clearance/range_clearance.hpp): with respect to shapes, poses at the
/// start, places and axes of joints, their limits, pitches of screws, ratios of gears and mimics.
///
/// The distance is a minimum over the coordinates too, so (envelope theorem) those at its witness are held; one that is at the end of its
/// range moves with that end. With a screw d = u - start (core/certificate/linkage.hpp), E = exp([turn d z]), of a force F and a torque M
/// about p that acts on what E has turned, both in the frame of the screws before it:
///   p_bar = F - E^T F,   z_bar = turn d J^T M + slide d F,   d_bar = turn z.M + slide z.F,   slide_bar = d z.F,
/// J the left Jacobian of turn d z.
#pragma once

#include <string>

#include "adjoint/model_gradient.hpp"
#include "core/clearance/range_clearance.hpp"

namespace fettle::adjoint::clearance {

/// The pair with its witness where the distance of the witness's two primitives is least, to within rounding, and with what the search
/// had found if that is not nearer: a search ends within a tolerance, a derivative is of the minimum. `upper` follows.
core::clearance::PairClearance settled_witness(const core::model::Model& model, const core::clearance::JointRanges& ranges,
                                               core::clearance::PairClearance pair);

/// All bodies where the pair is at its witness, as a trajectory without steps: for what is asked of a witness as assembled.
core::stepper::Trajectory at_witness(const core::model::Model& model, const core::clearance::JointRanges& ranges,
                                     const core::clearance::PairClearance& pair);

/// Adds scale * d(distance at pair.witness) to `bar`. @return why it has none, and nothing was added; empty: it was added
[[nodiscard]] std::string range_clearance_adjoint(const core::model::Model& model, const core::clearance::JointRanges& ranges,
                                                  const core::clearance::PairClearance& pair, double scale, ModelGradient& bar);

/// The distance of the witness's primitives where the pair is (`pair.at`), and its derivative in one of the linkage's coordinates, the
/// others held.
struct WitnessSlope {
    double distance = 0;  ///< [m]; 0: they meet, and there is no slope
    double slope = 0;     ///< [m] per unit of the coordinate
};
WitnessSlope witness_slope(const core::model::Model& model, const core::clearance::JointRanges& ranges,
                           const core::clearance::PairClearance& pair, int coordinate);

/// Adds scale * d(u) of the value u of a coordinate at which the distance at pair.witness is what it is (the end of a free range,
/// core/clearance/free_ranges.hpp): du = -(d(distance) with u held) / slope. @return as range_clearance_adjoint; also where the slope is 0
[[nodiscard]] std::string range_end_adjoint(const core::model::Model& model, const core::clearance::JointRanges& ranges,
                                            const core::clearance::PairClearance& pair, int coordinate, double scale, ModelGradient& bar);

}  // namespace fettle::adjoint::clearance
