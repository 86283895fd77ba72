// SPDX-License-Identifier: MIT
/// What a certification of clearance is asked and answers: clearance.hpp.
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/base/types.hpp"
#include "core/certificate/certificate.hpp"

namespace fettle::core::clearance {

using certificate::Primitive;

using certificate::Solids;

enum class PairStatus {
    clear,      ///< lower >= minimum, and lower > 0
    violated,   ///< upper < minimum, or the bodies clash: they pass through each other, or one lies inside the other
    undecided,  ///< the minimum lies between the bounds, closer than the tolerance (or the budget ran out, or the search was stopped); or
                ///< neither a clash nor lower > 0 is proven. `reason` says which
    contact  ///< minimum is 0 and the bodies come within the activation distance, 0 < lower: reported, not judged; or they touch, and may
};
const char* to_string(PairStatus status);

/// What is known of the two solids, for people: "disjoint solids".
const char* words(Solids solids);

/// Why solids are not certificate::are_apart, though their surfaces are, and what helps.
const char* why_not_apart(Solids solids);

/// Which two primitives are closest, when, and where. Edge against edge or vertex against triangle; of codimensional parts also vertex
/// against edge and vertex against vertex.
struct Witness {
    int step = -1;            ///< of the trajectory; -1: as assembled (the start pose)
    int segment = 0;          ///< of the step's path
    double s = 0;             ///< in [0, 1] along that segment
    double time = 0;          ///< [s]
    bool edge_edge = false;   ///< both kinds are `edge`
    bool vertex_on_a = true;  ///< kind_a is `vertex`
    int primitive_a = -1;     ///< index into a's mesh: vertex, triangle or edge
    int primitive_b = -1;
    Vector3 point_a = Vector3::Zero();  ///< world [m]
    Vector3 point_b = Vector3::Zero();
    Primitive kind_a = Primitive::vertex, kind_b = Primitive::triangle;
    double distance = 0;  ///< of the two points, as evaluated [m]
};

/// Certified bounds of the distance during one path segment.
struct MarginInterval {
    int step = -1;                        ///< of the trajectory; -1: as assembled
    int segment = 0;                      ///< of the step's path
    double time_start = 0, time_end = 0;  ///< [s]
    double lower = 0, upper = 0;          ///< [m] upper - lower <= max(tolerance, upper/1000), unless rounding or the budget prevents it
};

struct PairRequest {
    int a = 0, b = 0;    ///< bodies
    double minimum = 0;  ///< required clearance [m]
    /// A pair that is proven to stay at least so far apart is not measured: PairClearance::is_far. Contract: > 0, >= minimum
    /// [m]
    double far = std::numeric_limits<double>::infinity();
    bool may_touch = false;  ///< that they touch (Touch) is accepted, and so is every gap: the minimum does not count
    /// How deep they may be in each other and still touch [m]; 0: a hundred-thousandth of the larger body's size (touching.hpp)
    double touch_depth = 0;
    /// How far the two may be from the path, together, where joints have them [m]. Bounds are of the path and do not contain it; that one
    /// is not inside the other holds wherever they are within that (certificate::PairStart)
    double charge = 0;
};

/// What is judged: a pair that may touch is not wanted apart.
inline double required_gap(const PairRequest& request) { return request.may_touch ? 0 : request.minimum; }

/// Two bodies whose surfaces meet, and of which it is proven that they are nowhere deeper in each other than faces are that lie on each
/// other to within rounding.
struct Touch {
    double area = 0;       ///< of the faces that do, the most at up to 32 instants looked at [m^2]; 0: none, they meet in edges and points
    double time = 0;       ///< of that instant [s]
    double depth = 0;      ///< at no time a ball of this diameter is in both [m]
    double room = 0;       ///< by how much places may be off without undoing that proof [m]
    bool is_whole = true;  ///< false: there were too many faces to look at all of them, the area is at least so large
};

/// How far two solids are in each other at one instant (overlap.hpp).
struct Overlap {
    double depth_lower = 0, depth_upper = 0;    ///< [m]; depth_lower > 0 proves that the solids overlap
    double volume_lower = 0, volume_upper = 0;  ///< [m^3]
    double time = 0;                            ///< [s]
    Vector3 center = Vector3::Zero();           ///< of the largest ball found in both, world [m]; of no meaning if depth_lower is 0
};

struct ClearanceOptions {
    double tolerance = 1e-6;                        ///< wanted upper - lower [m]; less will do: answer_is_enough
    bool motion = false;                            ///< over the whole trajectory; false: at poses[0]
    long max_evaluations = 50'000'000;              ///< box pairs per pair of bodies; beyond it: undecided with true bounds
    std::function<void(int done, int of)> on_pair;  ///< optional progress
    bool margin_curve = false;                      ///< fill PairClearance::margin: costs a search per path segment
    double witness_tolerance = 0;                   ///< greater than 0: fill PairClearance::witnesses with all within it of the least [m]
    int max_witnesses = 64;                         ///< at most so many, the nearest; faces that slide along each other have no end of them
    bool measure_overlap = true;                    ///< fill PairClearance::overlap of a clash, ::touch: a fraction of a second each
    bool sample_nodes = true;                       ///< fill PairClearance::sampled, to a hundredth of the tolerance
    double enough = std::numeric_limits<double>::infinity();  ///< the search stops at a pair proven so far apart, whatever the gap [m]
    std::function<bool()> should_stop;  ///< optional, asked often, on any thread: true ends the search with true bounds
    bool answer_is_enough = false;      ///< bounds may be farther apart than the tolerance where the minimum is decided (stop_rule.hpp)
    // Over ranges of joints, which are asked for nothing else than the tolerance and the two functions:
    double coarse = 0;            ///< tolerance of pairs that more than two coordinates move, as a share of the bodies' radii; 0: as others
    long max_bounds = 4'000'000;  ///< per pair of bodies; beyond it: undecided with true bounds
};

/// What is wanted where nothing is said: to 1 um, or to 0.1% of the least minimum if that is less; of pairs that more than two coordinates
/// of joints move, whose search grows with the power of these, to 1% of the bodies' radii; and where that takes long, only as near as the
/// answer needs it (stop_rule.hpp). A tolerance that is given holds for all.
ClearanceOptions usual_options(const std::vector<PairRequest>& pairs, std::optional<double> tolerance = std::nullopt);

/// Bounds are of the distance of the surfaces; of bodies that clash `lower` is 0.
struct PairClearance {
    int a = 0, b = 0;
    double minimum = 0;
    double lower = 0, upper = 0;  ///< [m]
    bool is_bounded = true;  ///< false: undecided, and `lower` 0, `upper` infinite for want of anything proven; the witness is the path's
    bool is_far = false;     ///< clear: lower >= PairRequest::far. Not measured: `upper`, `sampled` are infinite, there is no witness
    PairStatus status = PairStatus::undecided;
    Witness witness;       ///< attains `upper`; of a clash of surfaces, where they meet first; of one inside the other, nearest surfaces
    bool complete = true;  ///< false: budget or should_stop ended the search before its bounds were as near as was wanted
    bool intersecting = false;         ///< the surfaces were found passing through each other, or the solids to share a ball: a clash
    Solids solids = Solids::unproven;  ///< `overlap`: one lies inside the other's material (bounds are then 0), or shares a ball with it
    std::optional<Overlap> overlap;    ///< of a clash of closed bodies: how deep, the deepest of up to 32 instants looked at; over ranges
                                       ///< at the witness, within tolerances not known
    std::optional<Touch> touch;        ///< of bodies that touch: then they are no clash
    double clash_not_before = 0;       ///< of a clash: proven, there is none before this time [s]
    double clash_time = 0;             ///< of a clash: when it was found first, to within the tolerance over the speed [s]
    std::string reason;                ///< why it is undecided; empty: it is not
    double sampled = 0;  ///< least distance at the nodes of the path: what a tool that samples would say [m]; infinite if not asked for
    std::vector<MarginInterval> margin;  ///< one per path segment, in order; empty unless asked for
    std::vector<Witness> witnesses;      ///< the first is `witness`; of two with the same instant and points only one
    bool as_assembled = false;           ///< looked at where the bodies start alone, whatever the others are looked at over
    // Over ranges of joints:
    double tolerance = 0;                 ///< that was asked for, of this pair [m]
    std::vector<int> coordinates;         ///< of the linkage: those that move one body against the other
    std::vector<double> at;               ///< their values at the witness
    std::vector<int> deviations;          ///< within tolerances: those that matter for the pair (certificate/toleranced.hpp)
    std::vector<double> deviations_at{};  ///< their values at the witness [SI]
    long bounds = 0;                      ///< computed

    bool is_clash() const { return intersecting || solids == Solids::overlap; }
};

/// With the proofs as data. `lower` of a pair is what its proof claims: less than was found by at most the tolerance.
struct ProvenClearances {
    std::vector<PairClearance> pairs;
    certificate::Certificate certificate;
};

}  // namespace fettle::core::clearance
