// SPDX-License-Identifier: MIT
/// Checks a certificate of clearance (certificate.hpp) against meshes and path. Calls nothing of the search that makes
/// certificates: all arithmetic is on intervals rounded outwards (geometry/interval.hpp), boxes are computed from the vertices. Over a path
/// and over ranges of joints the bound of a leaf is another one than the search's, but for leaves o, whose formula is the same and whose
/// evaluation is the checker's own (round_prover.hpp). Over tolerances (toleranced_prover.hpp) and of joints
/// (joint_prover.hpp) the search calls these provers to find its bounds: there a check is one of the record, and an error of a prover would
/// stand in both.
///
/// What is checked, so that acceptance is a proof (trusting the processor's rounding, the C library's sine to 2 ulps, and this code):
/// - meshes and path are those that the certificate names, by their hashes (else it is stale); the elements listed for a body include every
/// triangle, every edge of no triangle and
///   every vertex of no edge; each piece is split into two that together are it;
/// - over ranges of joints the linkage is one (check_linkage); the start lies in the ranges, so that one configuration decides for all of
///   them how solids lie (whether the joints are a scene's is for whoever has the scene to compare: clearance/joint_ranges.hpp);
/// - each box (a segment of the path; the ranges) has a tree of cells whose leaves cover all of it and all pairs of elements;
/// - each leaf's vectors prove the claimed lower bound: PathProver in interval_motion.hpp, RangeProver in range_prover.hpp, two proofs that
///   have nothing in common but intervals;
/// - the claim about the solids is what exact predicates say at one instant, given the lower bound (disjoint_solids.hpp): for a body inside
///   another's material no bound is accepted, whatever its certificate claims; where one is not closed the claim has to say so;
/// - there is a pair;
/// - no body is farther from where the joints have it, if the certificate has joints, than it claims: joint_prover.hpp (whether they are a
///   scene's is for whoever has the scene to compare);
/// - the upper bound is attained by its witness: not below the distance there, nor above it by more than rounding.
/// The cost is linear in the certificate: a few microseconds a leaf, on all threads. A false leaf ends at its first piece without proof.
///
/// Why every certificate of ours over a path is accepted, not only those that were tried. Each of its leaves was asked of this checker's
/// prover, with half of the room above the claim, before it was written (clearance/segment_proof.hpp). And why one is found: the search
/// has proven n(u).(x_a - x_b) >= lower + room in real numbers, for the corners of the two pieces' elements, which are what the checker
/// looks at too, and time can be halved. The room that a claim leaves is at least 8 slack, the search's bound of its own rounding
/// (segment_bound.hpp): with u = 2^-53, P the sum of the bodies' |q| and |q'|, r a body's radius, w its turn during the segment,
///   slack >= the sum over the bodies of (208 + 48 (|theta0| + w)) 2u r,   + 24u P.
/// What remains to be shown is that the checker loses less than the room. It halves a leaf k times, k <= 24.
/// - Rounding. An operation on intervals moves an end by at most 4u of the result. Rotations, functionals and their products with corners
///   are some 30 operations deep, less than 300u r a body for |theta| <= 1 and growing slower with it than the slack; places and planes
///   are off by some 50u (P + 2r). That is less than 3 slack.
/// - Curvature. Half the length of a piece is e <= 2^-k/2, half the difference of its normals |N'| <= 2^-k. The coefficients of the
///   polynomial of two corners differ from n.(x_a - x_b) at v = -1, -1/3, 1/3, 1 by at most 4/9 |p_2| + 28/27 |p_3| + 2 |rest|, p_k that of
///   v^k; and with w^j r the larger ones of both bodies,
///   |p_2| <= e |N'| (P + 2 w r) + e^2 w^2 r,   |p_3| <= e^2 |N'| w^2 r,   |rest| <= e^3 w^3 r/3.
///   So the least coefficients over the pieces are above lower as soon as all this is less than 5 slack. For k = 24 it is, as long as no
///   body turns by more than 100 rad: e |N'| <= 16u, e^2 <= 8u. (Where s has no digits left for so many, the leaf is so much shorter.)
/// That depth is for the proof: along the normal the rests of prove() are of third order, as the search's are, and its leaves are hardly
/// ever halved at all (tests/core/clearance/certificate_campaign_test.cpp).
///
///     const auto certificate = core::certificate::read_certificate("fit.certificate.json");
///     const auto stored = core::records::read_trajectory("trajectory.json");  // that it is about
///     if (!certificate || !stored) return 3;
///     const auto check = core::certificate::check_certificate(*certificate, *stored);
///     for (const auto& fault : check.faults) std::printf("%s: %s\n", fault.where.c_str(), fault.message.c_str());
///     if (check.accepted()) std::printf("all is proven, in %ld leaves\n", check.leaves);
#pragma once

#include <string>
#include <vector>

#include "core/certificate/certificate.hpp"
#include "core/model/model.hpp"
#include "core/records/trajectory_io.hpp"
#include "core/stepper/trajectory.hpp"

namespace fettle::core::certificate {

struct CertificateFault {
    std::string where;  ///< "/pairs/3/boxes/17, leaf 5"
    std::string message;
};

struct CertificateReport {
    std::vector<CertificateFault> faults;  ///< the first thousand; none: every claim is proven
    bool stale = false;                    ///< meshes or path are not those that it is about: nothing else was looked at
    long leaves = 0;                       ///< proven
    long pieces = 0;                       ///< into which these were halved for it
    bool accepted() const { return faults.empty(); }
};

/// Never trusts the certificate: any contents lead to a report. Contract: the trajectory is the model's; its first poses are the start.
CertificateReport check_certificate(const Certificate& certificate, const model::Model& model, const stepper::Trajectory& trajectory);

inline CertificateReport check_certificate(const Certificate& certificate, const records::StoredTrajectory& stored) {
    return check_certificate(certificate, stored.model, stored.trajectory);
}

}  // namespace fettle::core::certificate
