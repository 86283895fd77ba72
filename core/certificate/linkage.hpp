// SPDX-License-Identifier: MIT
/// Bodies joined as trees, as data: what a certificate over ranges of joints (certificate.hpp) is about. Made from a model by
/// clearance/joint_ranges.hpp.
///
/// A configuration is a value u_k of each coordinate in its range [low, high]. Each body is attached to its parent, or to the world, by
/// screws; the one next to the parent comes first. A screw, d = u_k - start_k, takes a point y, where everything is as at the start, to
///   S(y) = p + exp([turn d z]) (y - p) + slide d z,
/// p and z in the world at the start, so that the body's pose is S_1 S_2 ... S_m (its pose at the start), over its ancestors' screws first.
/// z is about as long as 1; the formula takes it as it is, so that a configuration is defined exactly.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "core/base/types.hpp"
#include "core/files/json_document.hpp"
#include "core/files/json_writer.hpp"

namespace fettle::core::certificate {

struct Screw {
    int coordinate = 0;
    Vector3 point = Vector3::Zero();  ///< p [m]
    Vector3 axis = Vector3::UnitZ();  ///< z
    double turn = 0;                  ///< [rad] per unit of the coordinate
    double slide = 0;                 ///< [m] per unit of the coordinate
    bool operator==(const Screw&) const = default;
};

struct LinkedBody {
    int parent = -1;  ///< body; -1: the world
    std::vector<Screw> screws;
    bool operator==(const LinkedBody&) const = default;
};

/// A joint's own coordinate, as a function of the one that moves it: scale u + offset.
struct JointCoordinate {
    std::string joint;
    bool is_angle = false;  ///< rad, else m
    double scale = 1, offset = 0;
    bool operator==(const JointCoordinate&) const = default;
};

struct LinkageCoordinate {
    double start = 0, low = 0, high = 0;  ///< of the first of its joints [rad or m]; low <= start <= high
    bool is_whole_turn = false;           ///< no limits: the range is one turn (of several joints: until all are where they were)
    std::vector<JointCoordinate> joints;  ///< more than one where gears couple them
    bool operator==(const LinkageCoordinate&) const = default;
};

struct Linkage {
    std::vector<LinkageCoordinate> coordinates;
    std::vector<LinkedBody> bodies;  ///< of the model
    bool operator==(const Linkage&) const = default;
};

/// More screws between two bodies than this are not dealt with, nor more coordinates.
inline constexpr int most_screws = 16;
inline constexpr int most_coordinates = 6;

using Coordinates = std::array<double, most_coordinates>;  ///< those beyond a box's own are 0

/// What two bodies are moved over: of a path's segment one coordinate in [0, 1], of a linked pair its own.
struct CoordinateBox {
    Coordinates low{}, high{};
};

/// What all screws between two bodies leave of every point, wherever their coordinates are: they turn about one axis and slide along it, so
/// that the distance from the axis stays; or they turn about axes through one point, so that the distance from the point does.
struct Revolution {
    Vector3 point = Vector3::Zero();  ///< in the world at the start [m]
    Vector3 axis = Vector3::Zero();   ///< 0: it is the point's
    bool is_about_axis() const { return !axis.isZero(0); }
};

/// Two bodies of a linkage: what moves one against the other. Screws that carry both bodies, and what they move together, is left out.
struct LinkedPair {
    std::vector<Screw> a, b;       ///< Screw::coordinate is a place in `coordinates`; outermost first
    std::vector<int> coordinates;  ///< of the linkage, increasing
};

/// Numbers finite, ranges in order, indices of what is there, no body its own ancestor. `where` is /coordinates/k or /links/k.
base::Errors check_linkage(const Linkage& linkage, std::size_t bodies);

/// {start, low, high, is_whole_turn, joints [{joint, is_angle, scale, offset}]}
void write_coordinate(files::JsonWriter& out, const LinkageCoordinate& coordinate);
LinkageCoordinate read_coordinate(const files::JsonNode& node);

/// Points and axes are compared bit by bit: those of one joint are the same. Nothing: no screw moves one against the other, or there is no
/// such axis or point.
std::optional<Revolution> revolution_of(const LinkedPair& pair);

/// Contract: checked; a, b are bodies of it.
LinkedPair linked_pair(const Linkage& linkage, int a, int b);

}  // namespace fettle::core::certificate
