// SPDX-License-Identifier: MIT
/// Makes a certificate smaller, with the checker's own proofs (interval_motion.hpp) as the judge. The search splits until its bounds reach
/// the upper bound that it knows at that time, along directions at hand; what is claimed in the end is less, and the checker's bound of
/// many elements, by their corners, is better than the search's by boxes.
#pragma once

#include "fettle/core/certificate/certificate.hpp"
#include "fettle/core/certificate/certified_body.hpp"
#include "fettle/core/stepper/trajectory.hpp"

namespace fettle::core::certificate {

/// Two leaves of one cell become one where a plane of theirs proves it, and normals are rounded to as few decimals as will do: everything
/// without halving time, and with `room` [m] above the claim. What cannot be proven so stays as it is.
/// @param step, segment  the place of the path (certificate.hpp)
SegmentProof thinned(const SegmentProof& proof, const PairCertificate& pair, const CertifiedBody& a, const CertifiedBody& b,
                     const stepper::Trajectory& trajectory, int step, int segment, double room);

}  // namespace fettle::core::certificate
