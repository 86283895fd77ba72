// SPDX-License-Identifier: MIT
/// Bodies as made, as data: what a certificate over a box of tolerances (certificate.hpp) is about. Their vertices, and the frames that
/// their joints turn about, are formulas of deviations, each anywhere between its limits. Made from a design by
/// design/problem/toleranced_bodies.hpp.
///
/// `nodes` (expression/operation.hpp) are operations on the deviations; everything that may depend on them is the number of a node:
///   vertices       of a body, in its frame, one for each of its mesh's; none: as the mesh has them. Triangles and edges are the mesh's
///   a body's pose  in its parent's frame, where every coordinate is at its start: x -> rotation x + place
///   its screws     as those of a linkage (linkage.hpp), but in the parent's frame: they carry the body from that pose, the one next to the
///                  parent comes first. A screw goes by d = u - start of its coordinate, or, where how far it goes deviates (a motor's
///                  curve), by shift + scale d
/// So a claim is about the bodies with the triangles that they have at `base`, and vertices that move by these formulas. Coordinates and
/// their ranges are the same for all of them.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "core/certificate/linkage.hpp"
#include "core/certificate/taylor_model.hpp"
#include "core/expression/operation.hpp"

namespace fettle::core::certificate {

struct Deviation {
    std::string of;               ///< what deviates, as the design names it
    double lower = 0, upper = 0;  ///< its limits [SI]
    double base = 0;              ///< between them: where the meshes and poses at hand are [SI]
    std::string unit{};           ///< that people read it in: "mm"; empty: a plain number
    bool operator==(const Deviation&) const = default;
};

using NodePoint = std::array<int, 3>;

/// How far a screw goes, of nodes; 1 and 0 at the base.
struct DrivenNodes {
    int scale = 0, shift = 0;
    bool operator==(const DrivenNodes&) const = default;
};

struct TolerancedScrew {
    int coordinate = 0;
    NodePoint point{}, axis{};  ///< the axis as long as 1
    double turn = 0;            ///< [rad] per unit of the coordinate
    double slide = 0;           ///< [m] per unit of the coordinate
    std::optional<DrivenNodes> driven{};
    bool operator==(const TolerancedScrew&) const = default;
};

struct TolerancedBody {
    int parent = -1;  ///< body; -1: the world
    std::vector<TolerancedScrew> screws;
    std::array<NodePoint, 3> rotation{};  ///< rows
    NodePoint place{};
    std::vector<NodePoint> vertices;
    bool operator==(const TolerancedBody&) const = default;
};

/// What its frame depends on, in arrays of nodes: all but the vertices.
template <class Visit>
void for_frame_nodes(const TolerancedBody& body, const Visit& visit) {
    for (const TolerancedScrew& screw : body.screws) {
        visit(screw.point);
        visit(screw.axis);
        if (screw.driven) visit(std::array{screw.driven->scale, screw.driven->shift});
    }
    for (const NodePoint& row : body.rotation) visit(row);
    visit(body.place);
}

/// A joint that closes a loop of the tree: points and axes of its two ends, in the frames of their bodies (-1: the world's), which meet.
struct TolerancedClosure {
    int a = -1, b = -1;
    NodePoint point_a{}, axis_a{}, point_b{}, axis_b{};
    bool operator==(const TolerancedClosure&) const = default;
};

/// Coordinates that follow from others, because joints close loops (toleranced_loop.hpp); their `start` is where the loop is at the base,
/// on the branch that is meant, and their ranges are nothing but that.
struct TolerancedLoop {
    std::vector<TolerancedClosure> closures;
    std::vector<int> unknowns;  ///< coordinates. All others of the loop's joints are one, which drives it
    std::vector<int> rows;      ///< as many of the closures' conditions: ModelledLoop::rows
    double size = 1;            ///< [m], of the bodies
    bool operator==(const TolerancedLoop&) const = default;
};

struct Toleranced {
    std::vector<Deviation> deviations;
    expression::Nodes nodes;  ///< Operation::input counts through `deviations`
    std::vector<LinkageCoordinate> coordinates;
    std::vector<TolerancedBody> bodies;  ///< of the model
    std::vector<TolerancedLoop> loops{};
    /// Says which ranges the coordinates have. 0: the joints' own (or none, as assembled); else where motors and scripts have them in this
    /// time from the start [s] (clearance/driven_ranges.hpp).
    double duration = 0;
};

/// Does any coordinate move? Else it is about the bodies as assembled.
bool is_over_ranges(const Toleranced& toleranced);

/// The same formulas, limits and joints?
bool same_toleranced(const Toleranced& x, const Toleranced& y);

/// |shift + scale (u - start)| at most, or |u - start|, whatever the deviations. Contract: checked.
double farthest(const Toleranced& toleranced, const TolerancedScrew& screw);

/// More deviations than this that matter for one pair are not dealt with, nor more than most_variables of coordinates and deviations.
inline constexpr int most_deviations = 8;
static_assert(std::max(most_deviations, most_coordinates) <= most_variables);

/// Two bodies: what moves one against the other. What carries both alike is left out.
struct TolerancedPair {
    int of_a = 0, of_b = 0;
    std::vector<int> a, b;  ///< bodies from below the nearest that carries both on to each of the two
    /// Its variables: coordinates first, then deviations; indices of the list, increasing. No other deviation reaches a vertex of the two
    /// or a frame between them.
    std::vector<int> coordinates, deviations;
    /// What else moves them: coordinates that follow from these, by loops.
    std::vector<int> dependents, loops;

    int variables() const { return count_of(coordinates) + count_of(deviations); }
};

/// {deviations [{of, lower, upper, base, unit}], operations "constant input multiply ...", operands of those that have some and numbers of
///  constants one after the other, coordinates, bodies [{parent, screws [{coordinate, point, axis, turn, slide}], rotation, place,
///  vertices}]}, points as numbers of nodes, three each; a driven screw has {scale, shift, turn, slide} as `driven` in place of its turn
///  and slide.
void write_toleranced(files::JsonWriter& out, const Toleranced& toleranced);
Toleranced read_toleranced(const files::JsonNode& node);

/// Bodies from below what carries both on to each of the two, outermost first. -1: the world, of which there is none.
struct BodyLines {
    std::vector<int> a, b;
};
BodyLines lines_between(const Toleranced& toleranced, int a, int b);

/// Contract: checked; a, b are bodies of it.
TolerancedPair toleranced_pair(const Toleranced& toleranced, int a, int b);

/// Numbers finite, limits in order, nodes after their operands, indices of what is there, no body its own ancestor. `vertices` of the
/// model's meshes. `where` is /tolerances and what is below.
base::Errors check_toleranced(const Toleranced& toleranced, const std::vector<int>& vertices);

}  // namespace fettle::core::certificate
