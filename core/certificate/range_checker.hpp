// SPDX-License-Identifier: MIT
/// Checks a certificate of clearance over ranges of joints (range_certificate.hpp) against meshes and start poses, as
/// certificate_checker.hpp does one over a path, with the same trust and nothing in common with the search. The joints are those that the
/// certificate lists; whether they are a scene's is for whoever has the scene to compare (clearance/joint_ranges.hpp).
///
/// What is checked:
/// - meshes and start poses are those that the certificate names, by their hashes (else it is stale); pieces as there;
/// - the linkage is one: check_linkage; the start lies in the ranges, so that one configuration decides for all of them how solids lie;
/// - each pair has a tree of cells whose leaves cover the whole box of its coordinates and all pairs of elements;
/// - each leaf's vectors prove the claimed lower bound: RangeProver;
/// - the upper bound is attained by its witness, at a configuration in the ranges; solids as there; there is a pair.
#pragma once

#include "fettle/core/certificate/certificate_checker.hpp"
#include "fettle/core/certificate/range_certificate.hpp"

namespace fettle::core::certificate {

/// Never trusts the certificate: any contents lead to a report. Contract: the trajectory is the model's; its first poses are the start.
CertificateReport check_range_certificate(const RangeCertificate& certificate, const model::Model& model,
                                          const stepper::Trajectory& trajectory);

inline CertificateReport check_range_certificate(const RangeCertificate& certificate, const records::StoredTrajectory& stored) {
    return check_range_certificate(certificate, stored.model, stored.trajectory);
}

}  // namespace fettle::core::certificate
