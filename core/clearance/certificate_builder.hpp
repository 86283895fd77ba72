// SPDX-License-Identifier: MIT
/// From what a search found to a certificate (certificate.hpp).
#pragma once

#include <cstddef>
#include <vector>

#include "core/certificate/certificate.hpp"
#include "core/certificate/certified_body.hpp"
#include "core/clearance/pair_details.hpp"
#include "core/model/model.hpp"

namespace fettle::core::clearance {

/// Hashes, unit, pieces of the bodies (null: of no pair), room for the pairs.
certificate::Certificate start_certificate(const model::Model& model, const stepper::Trajectory& trajectory,
                                           const std::vector<const PieceTree*>& trees, bool motion, std::size_t pairs);

/// A feature of an element, as ElementPairDistance names it.
struct ElementFeature {
    Primitive kind = Primitive::vertex;
    int corner = 0;
};
/// A witness's point as a certificate has it. @param X  in the body's frame
certificate::CertifiedPoint certified_witness(const PieceTree& tree, int element, bool intersecting, const ElementFeature& feature,
                                              const Vector3& X);

/// Bounds and witness from `found`; the proofs are there already, and are dropped where there is nothing to prove (lower 0).
void complete_certificate(const PairMotion& pair, const SearchResult& found, certificate::PairCertificate& certificate);

/// Drops pairs that could not be measured: nothing is certified of them.
void drop_unmeasured(certificate::Certificate& certificate);

/// The bodies as the certificate cuts them; empty ones for those of no pair.
std::vector<certificate::CertifiedBody> certified_bodies(const certificate::Certificate& certificate, const model::Model& model);

}  // namespace fettle::core::clearance
