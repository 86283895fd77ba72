// SPDX-License-Identifier: MIT
/// From what a search found to a certificate (certificate.hpp).
#pragma once

#include <cstddef>
#include <vector>

#include "fettle/core/clearance/certificate.hpp"
#include "fettle/core/clearance/pair_details.hpp"

namespace fettle::core::clearance {

/// Hash, pieces of the bodies (null: of no pair), room for the pairs.
Certificate start_certificate(const model::Model& model, const std::vector<const PieceTree*>& trees, bool motion, std::size_t pairs);

/// Bounds and witness from `found`; the proofs are there already, and are dropped where there is nothing to prove (lower 0).
void complete_certificate(const PairMotion& pair, const SearchResult& found, PairCertificate& certificate);

}  // namespace fettle::core::clearance
