// SPDX-License-Identifier: MIT
/// One pair of bodies, from the search for its least distance to a verdict (clearance.hpp does it for all of them):
/// 1. bounds of the distance of the surfaces (pair_search.hpp), with a finer tolerance where the lower bound is 0 but need not be;
/// 2. where it stays 0: do the surfaces cross somewhere along the path, or can that be refuted (crossing.hpp)? do the solids share a ball
///    at one of some instants (overlap.hpp)? since when?
///    Are they no deeper in each other than bodies that touch (touching.hpp)? Then that is said, and they are no clash.
/// 3. where it is greater than 0: do the solids lie apart, or one inside the other (certificate/disjoint_solids.hpp)?
#pragma once

#include <optional>
#include <string>

#include "core/clearance/certificate_builder.hpp"
#include "core/clearance/pair_details.hpp"

namespace fettle::core::clearance {

/// The proof of one pair, in the making.
struct PairRecord {
    certificate::PairCertificate& certificate;
    const certificate::CertifiedBody &a, &b;
};

/// @param contact_distance  bodies as near as that push each other: dmin + dhat [m]
PairClearance certify_pair(const PairMotion& pair, const PairRequest& request, double contact_distance, const ClearanceOptions& options,
                           const std::optional<PairRecord>& record);

/// The search ends as soon as it is known whether the surfaces stay at least `reach` apart, rounding included: their lower bound if they
/// do, else nothing (nor where the budget or a stop ended it, or rounding hides the distance).
std::optional<double> proven_apart(const PairMotion& pair, double reach, const ClearanceOptions& options);

/// Judges a pair by its bounds and by what is known of the solids, over a path and over ranges of joints alike: sets `status` and, where
/// that is undecided, `reason`.
/// @param contact_distance  as above; 0: nothing pushes
/// @param crosses           of bodies that touch: their surfaces were found passing through each other
void judge(PairClearance& pair, const PairRequest& request, double contact_distance, bool crosses);

/// Undecided, with nothing known.
PairClearance unmeasured(const PairRequest& request, const std::string& reason);

}  // namespace fettle::core::clearance
