// SPDX-License-Identifier: MIT
/// Checks a certificate of clearance (certificate.hpp) against meshes and path. Shares no bounding code with the search that makes
/// certificates: all arithmetic is on intervals rounded outwards (geometry/interval.hpp), boxes are computed from the vertices, and the
/// bound of a leaf is another one.
///
/// What is checked, so that acceptance is a proof (trusting the processor's rounding, the C library's sine to 2 ulps, and this code):
/// - the meshes are those that the certificate names; the elements listed for a body include every triangle, every edge of no triangle and
///   every vertex of no edge; each piece is split into two that together are it;
/// - each segment of the path has a tree of cells whose leaves cover all time and all pairs of elements (halves of intervals are exact);
/// - each leaf's plane proves the claimed lower bound: see prove_leaf in interval_motion.hpp;
/// - the upper bound is attained by its witness: not below the distance there, nor above it by more than rounding.
/// The cost is linear in the certificate: a leaf costs a few microseconds. One that fails at first is halved in time up to twelve times.
#pragma once

#include <string>
#include <vector>

#include "fettle/core/clearance/certificate.hpp"
#include "fettle/core/model/model.hpp"
#include "fettle/core/stepper/trajectory.hpp"
#include "fettle/core/stepper/trajectory_io.hpp"

namespace fettle::core::clearance {

struct CertificateFault {
    std::string where;  ///< "/pairs/3/segments/17, leaf 5"
    std::string message;
};

struct CertificateReport {
    std::vector<CertificateFault> faults;  ///< the first thousand; none: every claim is proven
    long leaves = 0;                       ///< proven
    bool accepted() const { return faults.empty(); }
};

/// Never trusts the certificate: any contents lead to a report. Contract: the trajectory is the model's.
CertificateReport check_certificate(const Certificate& certificate, const model::Model& model, const stepper::Trajectory& trajectory);

inline CertificateReport check_certificate(const Certificate& certificate, const stepper::StoredTrajectory& stored) {
    return check_certificate(certificate, stored.model, stored.trajectory);
}

}  // namespace fettle::core::clearance
