// SPDX-License-Identifier: MIT
/// A certificate of clearance as data, so that someone else can check it: certificate_checker.hpp does, without the search that made it
/// (what the two share is said there). It claims, for each pair of bodies and over all that it is asked for,
///   lower <= min dist(A, B) <= upper   of their surfaces, and what is known of their solids: `Solids`,
/// about the meshes and the path of a trajectory (records/trajectory_io.hpp), both of which must be at hand to check it: hashes name them.
/// Pairs that it does not list it says nothing of: uncovered_pairs.
///
/// Over what. The bodies of a pair move over boxes of k coordinates u:
///   over a path (`motion`)               a box for each segment, in the order of the path; k = 1, u = s in [0, 1]
///   as assembled                         one, the start pose (step -1); k = 1, and nothing moves
///   over ranges of joints (`linkage`)    one: all positions of the joints, in every combination; k <= 6, the coordinates that move one
///                                        body against the other (linked_pair), in their ranges. The trajectory's steps have no effect
///   over a box of tolerances (`toleranced`)  one: the joints' positions together with every deviation between its limits; k <= 12, the
///                                        coordinates and then the deviations that matter for the two (toleranced_pair)
/// With `joints` a certificate over a path claims, too, how far the bodies are from that path where the joints are met at all times: bounds
/// of their distances are those of the path, wider by joint_charge.
///
/// How it proves `lower`. For every box there is a tree of cells. A cell is a part of the box, a piece of A and a piece of B; the root is
/// the whole box and both whole bodies. `splits` lists the cells in preorder, one character each:
///   0..9  halved along this coordinate: first [low, m], then [m, high], m = (low + high)/2 as rounded (of a path exact: s is dyadic)
///   A, B  the same of the coordinates 10 and 11
///   a     piece of A split into its two parts, in their order;   b  the same of B
///   .     a leaf whose proof is one vector;   :  a leaf whose proof is 2^k vectors, one for each corner of its part of the box, bit j of
///         the corner's number set where coordinate j is high; `normals` has them, in the order of the leaves
///   o     over ranges of joints, where all screws between the two turn about one axis and slide along it, or turn about one point
///         (revolution_of): a leaf whose proof is two numbers, a vector m = (m_r, m_z, 0) among `normals`
/// So the leaves cover the box and all pairs of elements by construction.
/// A leaf's proof is that vector, or those, in world axes: with n(u) the one, or the multilinear interpolant of them,
///   n(u).(x_a(u) - x_b(u)) >= lower max |n| > 0   for all u of the cell and all points x_a, x_b of the two pieces,
/// which is what a checker has to verify, for the corners of the elements. A leaf o claims, with r(x) a point's distance from the axis or
/// the point and z(x) how far along the axis it is (0 about a point),
///   m_r (r(x_b) - r(x_a)) + m_z (z(x_b) - z(x_a)) >= lower |m| > 0   for all points of the two pieces, wherever the coordinates of the box
/// are: x -> (r, z) takes no two points farther apart, so that their distance is at least as much (round_prover.hpp).
/// How far above the claim a leaf lies is not recorded: ours leave a room of at least 4 times the search's own bound of its rounding
/// (PairSegment::slack, ScrewedPair::slack), and 1/16 of the tolerance, for a checker's rounding and for its own way of bounding curves.
/// Over a path leaves are as large and vectors as rounded as this room and this checker allow (clearance/segment_proof.hpp). Over a box of
/// tolerances vectors are in B's frame; a leaf : has 1 + k of them, for n(t) = n_0 + sum n_j t_j, t in [-1, 1] over the cell's part of the
/// box (toleranced_prover.hpp). `upper` is the distance of two points of the bodies at one place of one box.
///
/// Pieces. A body's elements are its triangles, the edges of no triangle, and the vertices of no edge, numbered
///   triangle i: i;   mesh.edges[i]: T + i;   vertex i: T + E + i;   T = number of triangles, E = number of all edges of the mesh.
/// `elements` is a list of them; a piece is a range of this list. The root is all of it; `cuts` has for each piece of more than one
/// element, in preorder, how many elements the first part takes.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "core/base/types.hpp"
#include "core/certificate/ideal_joints.hpp"
#include "core/certificate/linkage.hpp"
#include "core/certificate/toleranced.hpp"
#include "core/files/atomic_file.hpp"

namespace fettle::core::certificate {

/// The proof over one box: see the top of the file.
struct BoxProof {
    std::string splits;
    std::vector<Vector3> normals;  ///< about as long as 1
};

/// How a cell is halved along variable k: '0' to '9', then 'A', 'B'.
char split_along(int k);
/// -1: it is no such halving.
int variable_of_split(char kind);

/// Kinds of leaves: of one vector, and of several.
inline constexpr char still_leaf = '.', turning_leaf = ':', round_leaf = 'o';

/// A leaf's vectors where there is one coordinate: at its low and its high end.
struct LeafPlane {
    Vector3 n0 = Vector3::Zero(), n1 = Vector3::Zero();
};
void add_leaf(BoxProof& proof, const LeafPlane& plane);  ///< with one vector if both are the same

enum class Primitive { vertex, edge, triangle };

/// A point of a body: sum of weight[i] x_i over the corners of a primitive, over the sum of the weights.
struct CertifiedPoint {
    Primitive kind = Primitive::vertex;
    int index = -1;                         ///< into vertices, mesh.edges or mesh.triangles
    std::array<double, 3> weight{1, 0, 0};  ///< not negative; of the corners in the mesh's order
};

/// Beside the distance of the surfaces: how the solids lie that they bound (disjoint_solids.hpp).
enum class Solids {
    unproven,    ///< nothing is claimed: the surfaces are not proven to stay apart
    disjoint,    ///< no point is in both, over all the time
    overlap,     ///< one lies inside the other's material
    not_closed,  ///< a body is not closed, so that nothing is in both; neither does one come where the other would be if it were closed,
                 ///< unless the scene says that it is a sheet, which has no inside: of that it was not looked at
    unverified,  ///< one may lie inside the other: a mesh is not closed, and the other is within what would close it, or may come there
};
const char* to_string(Solids solids);  ///< "unproven", "disjoint", "overlap", "not closed", "not verified"

/// Does this leave no way for one to lie inside the other? Bodies are reported as clear of each other only then.
inline bool are_apart(Solids solids) { return solids == Solids::disjoint || solids == Solids::not_closed; }

struct PairCertificate {
    int a = 0, b = 0;
    double lower = 0, upper = 0;  ///< [m]
    Solids solids = Solids::unproven;
    int step = -1, segment = 0;  ///< the box where `upper` is attained; step -1: that of the start pose, or of the joints' ranges
    std::vector<double> at;      ///< and where in it: its coordinates
    CertifiedPoint point_a, point_b;
    std::vector<BoxProof> boxes;  ///< one for each; none at all if lower is 0
    /// What is required of the two [m], by whoever made this: no claim, and nothing proves it. Nothing: no one said.
    std::optional<double> minimum{};
};

struct BodyPieces {
    std::vector<int> elements;
    std::vector<int> cuts;
};

/// A file of the bodies' meshes, for a printer or another program, that the certificate is about too.
struct ExportedFile {
    std::string file;     ///< relative to the certificate's folder, or absolute
    std::string hash;     ///< files::hash_of its bytes
    double rounding = 0;  ///< how far a vertex of the file may be from that of the trajectory [m]: every bound is wider by 2 of it there
};

inline constexpr int certificate_version = 4;  ///< what is written

struct Certificate {
    int version = certificate_version;
    std::uint64_t geometry_hash = 0;   ///< of the bodies (records/trajectory_io.hpp)
    std::uint64_t path_hash = 0;       ///< of the trajectory (same)
    double length_unit = 1;            ///< of the scene [m]: what its lengths are shown in
    std::string source;                ///< the file whose bodies these are, as it was named; empty: none
    std::string scenario;              ///< of a design: in which of its scenarios; empty: the first
    std::string process;               ///< within tolerances: what makes the parts in place of the design's; a name or a file; empty: none
    bool motion = false;               ///< over the trajectory; false: at its first poses, or from there on over the joints' ranges
    std::optional<Linkage> linkage{};  ///< of one over ranges of joints
    std::vector<BodyPieces> bodies;    ///< one per body of the model; empty lists for those of no pair
    std::vector<PairCertificate> pairs;
    std::vector<ExportedFile> exports{};
    /// That hold the bodies at all times, and how far from the path; nothing: the bounds are of the path as stored, and of nothing else.
    std::optional<IdealJoints> joints{};
    /// Said by whoever made it: the path as stored is what is asked about, not joints that may have the bodies elsewhere between its nodes.
    /// Without that and without `joints` it is not known what its bounds of moving bodies are good for.
    bool is_of_path = false;
    std::optional<Toleranced> toleranced{};  ///< of one over a box of tolerances
};

/// Pairs of `bodies` bodies that the certificate says nothing of, a < b.
std::vector<std::array<int, 2>> uncovered_pairs(const Certificate& certificate, int bodies);

/// One JSON object (*.certificate.json), SI, with the names used here; every number reads back to the same bits.
///   fettle_certificate 4, geometry_hash, path_hash (hexadecimal), length_unit, source, scenario, process (both optional), motion,
///   bodies [{elements, cuts}],
///   exports (optional) [{file, hash, rounding}], joints (optional, ideal_joints.hpp), path_as_stored (optional, is_of_path),
///   over ranges of joints coordinates [{start, low, high, is_whole_turn, joints [{joint, is_angle, scale, offset}]}] and
///   links [{parent, screws [{coordinate, point, axis, turn, slide}]}],
///   pairs [{a, b, lower, upper, solids, minimum (optional), step, segment, at, point_a {kind, index, weight}, point_b,
///   boxes [{splits, normals}]}], `normals` flat. Written whole or not at all.
/// Read, too, are the formats before it: fettle_certificate 3, which has neither leaves o nor more than four coordinates of joints, 2, of
/// a path (`segments` [{splits, planes}] for `boxes`, `t` for `0`, `s`
/// for `at`), and fettle_range_certificate 1 (a pair's one `splits` and `normals` beside its bounds).
[[nodiscard]] base::Errors write_certificate(const std::filesystem::path& path, const Certificate& certificate);
/// The same as one of a set of files.
[[nodiscard]] base::Errors add_certificate(files::FilesTogether& files, const std::filesystem::path& path, const Certificate& certificate);
base::Result<Certificate> read_certificate(const std::filesystem::path& path);

/// Is this file a certificate, as far as its keys show? False for anything that cannot be read.
bool is_certificate_file(const std::filesystem::path& path);

}  // namespace fettle::core::certificate
