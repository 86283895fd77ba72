// SPDX-License-Identifier: MIT
/// Dimensions of a mesh that has none: what each moves, and how far. A handle moves corners of the mesh as drawn, each by its own way from
/// where it is drawn; of several handles the ways add up, so that the order does not matter. docs/method/features.md#handles.
#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "core/features/feature.hpp"
#include "core/geometry/mesh.hpp"

namespace fettle::core::features {

/// Where a handle takes hold, where it is not of features.
struct HandleRegion {
    enum class Kind { box, sphere };
    Kind kind = Kind::box;
    Vector3 low = Vector3::Zero(), high = Vector3::Zero();  ///< of a box [m]
    Vector3 centre = Vector3::Zero();                       ///< of a sphere [m]
    double radius = 0;                                      ///< of a sphere [m]
    double falloff = 0;                                     ///< width of the band round it in which the hold ends [m]
    /// 1 within, 0 beyond the band, s^2 (3 - 2 s) with s = 1 - distance / falloff in it.
    double weight(const Vector3& x) const;
};

enum class HandleKind {
    radius,    ///< of bores, pins, sockets, balls [m]: corners move along the radius, in proportion to it
    diameter,  ///< the same, twice the radius
    offset,    ///< of flat faces, outwards [m]; 0 as drawn. A boss is made longer by its end face
    move,      ///< of features or a region, along `axis` [m]
    turn,      ///< of features or a region, about the line through `point` along `axis` [rad]
    stretch,   ///< corners beyond the height `to` along `axis` move along it, those before `from` stay, between them in proportion [m]
    lattice,   ///< control points of a Bezier volume over a box move along `axis` [m]
    morph      ///< corners go towards those of another mesh with the same triangles: 0 as drawn, 1 there
};

struct Handle {
    std::string name;
    HandleKind kind = HandleKind::radius;
    std::vector<std::string> features{};         ///< by name; of move and turn: empty, then `region` counts
    std::optional<bool> holes{};                 ///< are its features holes? Nothing: either
    HandleRegion region{};                       ///< of a lattice: its box
    Vector3 axis = Vector3::UnitX();             ///< of length 1
    Vector3 point = Vector3::Zero();             ///< [m]
    double from = 0, to = 0;                     ///< [m], from < to
    std::array<int, 3> lattice{2, 2, 2};         ///< how many control points along x, y and z, at least 2
    std::vector<std::array<int, 3>> controls{};  ///< those that move, counted from 0
    Matrix3X target{};                           ///< [m]
};

/// Is the dimension an angle, or a plain number, and no length?
inline bool is_angle(HandleKind kind) { return kind == HandleKind::turn; }
inline bool is_number(HandleKind kind) { return kind == HandleKind::morph; }

/// What a handle does to the corners that it moves: from x to x + change of value * `by`; of a turn by the angle weight * change.
struct Displacement {
    HandleKind kind = HandleKind::move;
    double drawn = 0;             ///< value as drawn
    std::vector<int> vertices;    ///< those that it moves, ascending
    std::vector<Vector3> by;      ///< of each, but for a turn [m per unit of the value]
    std::vector<double> weights;  ///< of each, of a turn
    std::vector<int> features;    ///< those that it is of
    bool has_band = false;        ///< its hold ends in one
    Vector3 axis = Vector3::UnitX(), point = Vector3::Zero();

    /// How far its k-th corner, drawn at x, is moved: on numbers of type T.
    template <class T>
    std::array<T, 3> at(std::size_t k, const Vector3& x, const T& change) const {
        if (kind != HandleKind::turn) return {change * T(by[k][0]), change * T(by[k][1]), change * T(by[k][2])};
        using std::cos, std::sin;
        const Vector3 from = x - point, across = from - axis.dot(from) * axis, ahead = axis.cross(from);
        const T angle = change * T(weights[k]), sine = sin(angle), less = cos(angle) - T(1.0);
        const auto moved = [&](int i) { return less * T(across[i]) + sine * T(ahead[i]); };
        return {moved(0), moved(1), moved(2)};
    }
    /// Its derivative in the value.
    Vector3 slope(std::size_t k, const Vector3& x, double change) const;
};

/// Errors (inconsistent, out_of_range), with `where` the handle's name: features that the mesh does not have or that are of another
/// kind, radii that are not one, a handle that moves nothing.
base::Result<Displacement> displacement_of(const Handle& handle, const geometry::Mesh& mesh, const Features& features);

}  // namespace fettle::core::features
