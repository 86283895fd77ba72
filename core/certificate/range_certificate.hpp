// SPDX-License-Identifier: MIT
/// A certificate of clearance over ranges of joints, as data: what certificate.hpp is for a path. It claims, for each pair of bodies and
/// over all positions of the joints within their ranges, in every combination (linkage.hpp),
///   lower <= min dist(A(u), B(u)) <= upper   of their surfaces, and what is known of their solids: `Solids`,
/// about the meshes and the start poses of a trajectory (records/trajectory_io.hpp), whose steps count for nothing. range_checker.hpp
/// checks it.
///
/// How it proves `lower`. A tree of cells per pair. A cell is a box of the n coordinates that move one body against the other
/// (linked_pair), a piece of A and a piece of B; the root is the whole ranges and both whole bodies. `splits` lists the cells in preorder:
///   0..3  the box halved along this coordinate, of the pair's own: first [low, m], then [m, high], m = (low + high)/2 as rounded
///   a, b  a piece split into its two parts, in their order (BodyPieces)
///   .     a leaf; `normals` has its proof, one vector n;      :  a leaf with 2^n vectors, one for each corner of the box, bit k of the
///         corner's number set where coordinate k is high
/// A leaf's proof is the vectors: with n(u) the one, or what interpolates them linearly in each coordinate,
///   n(u).(x_a(u) - x_b(u)) >= lower max |n| > 0   for all u of the box and all points of the two pieces,
/// both bodies moved by the screws of LinkedPair alone, which is what a checker has to verify. `upper` is the distance of two points at one
/// configuration.
#pragma once

#include "fettle/core/certificate/certificate.hpp"
#include "fettle/core/certificate/linkage.hpp"

namespace fettle::core::certificate {

struct RangeProof {
    std::string splits;
    std::vector<Vector3> normals;  ///< of the leaves in their order; about as long as 1
};

struct RangePairCertificate {
    int a = 0, b = 0;
    double lower = 0, upper = 0;  ///< [m]
    Solids solids = Solids::unproven;
    std::vector<double> at;  ///< where `upper` is attained: the pair's own coordinates
    CertifiedPoint point_a, point_b;
    RangeProof proof;  ///< empty if lower is 0
};

struct RangeCertificate {
    int version = 1;
    std::uint64_t geometry_hash = 0;  ///< of the bodies (records/trajectory_io.hpp)
    std::uint64_t path_hash = 0;      ///< of the trajectory (same)
    double length_unit = 1;           ///< of the scene [m]: what its lengths are shown in
    std::string source;               ///< the file whose bodies and joints these are, as it was named
    Linkage linkage;
    std::vector<BodyPieces> bodies;  ///< one per body of the model; empty lists for those of no pair
    std::vector<RangePairCertificate> pairs;
};

std::vector<std::array<int, 2>> uncovered_pairs(const RangeCertificate& certificate, int bodies);

/// One JSON object (*.certificate.json), SI, with the names used here; every number reads back to the same bits.
///   fettle_range_certificate 1, geometry_hash, path_hash (hexadecimal), length_unit, source,
///   coordinates [{start, low, high, is_whole_turn, joints [{joint, is_angle, scale, offset}]}],
///   links [{parent, screws [{coordinate, point, axis, turn, slide}]}], bodies [{elements, cuts}],
///   pairs [{a, b, lower, upper, solids, at, point_a {kind, index, weight}, point_b, splits, normals}], `normals` flat
/// Written whole or not at all.
[[nodiscard]] base::Errors write_range_certificate(const std::filesystem::path& path, const RangeCertificate& certificate);
/// The same beside other files.
[[nodiscard]] base::Errors add_range_certificate(files::FilesTogether& files, const std::filesystem::path& path,
                                                 const RangeCertificate& certificate);
base::Result<RangeCertificate> read_range_certificate(const std::filesystem::path& path);

/// Is this file such a certificate, as far as its keys tell? False for anything that cannot be read.
bool is_range_certificate_file(const std::filesystem::path& path);

}  // namespace fettle::core::certificate
