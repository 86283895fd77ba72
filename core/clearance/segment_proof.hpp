// SPDX-License-Identifier: MIT
/// The proof that two bodies stay a given distance apart over a path (certificate.hpp), made from above once the distance is known. All
/// elements of two pieces whose convex hulls are that far apart are one leaf, along the direction in which the hulls are nearest
/// (hull_direction.hpp); else the larger one is split, or time is halved. Whether a leaf proves it is asked of the checker's own
/// mathematics (certificate/interval_motion.hpp), which takes pieces by their corners: so a proof has few leaves, and all of them hold.
/// The search that finds the distance looks at many segments at once, and at what is near alone; a certificate has to say of each segment
/// why everything else is far.
#pragma once

#include <functional>
#include <vector>

#include "core/certificate/certified_body.hpp"
#include "core/clearance/pair_details.hpp"

namespace fettle::core::clearance {

/// One proof for each of the pair's segments. Empty where one is not found: a stop, or rounding.
/// @param a, b      the bodies' pieces, cut as the pair's trees are
/// @param distance  [m] Contract: greater than 0, and less than what is proven of the pair by a room for rounding
std::vector<certificate::BoxProof> prove_path(const PairMotion& pair, const certificate::CertifiedBody& a,
                                              const certificate::CertifiedBody& b, const certificate::PairCertificate& of, double distance,
                                              const std::function<bool()>& should_stop);

}  // namespace fettle::core::clearance
