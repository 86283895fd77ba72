// SPDX-License-Identifier: MIT
/// Makes a certificate smaller, with the checker's own proofs (interval_motion.hpp) as the judge. The search splits until its bounds reach
/// the upper bound that it knows at that time, along directions at hand; what is claimed in the end is less, and the checker's bound of
/// many elements, by their corners, is better than the search's by boxes.
#pragma once

#include "fettle/core/certificate/certificate.hpp"
#include "fettle/core/certificate/certified_body.hpp"
#include "fettle/core/certificate/interval_motion.hpp"

namespace fettle::core::certificate {

/// Two leaves of one cell become one where a plane of theirs proves it, and normals are rounded to as few decimals as will do: everything
/// without halving time. What cannot be proven so stays as it is.
/// @param proof           of a segment of a path
/// @param path_a, path_b  the bodies' paths over the segment (interval_motion.hpp)
/// @param distance        that every leaf proves [m]: a little room above the claim
BoxProof thinned(const BoxProof& proof, const CertifiedBody& a, const CertifiedBody& b, const BodyPath& path_a, const BodyPath& path_b,
                 double distance);

}  // namespace fettle::core::certificate
