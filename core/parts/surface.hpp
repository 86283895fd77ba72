// SPDX-License-Identifier: MIT
/// The true surfaces that facets stand for: round is round.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/parts/point.hpp"

namespace fettle::core::parts {

enum class SurfaceKind {
    plane,     ///< through `point`, normal `axis` (outwards)
    cylinder,  ///< about the line through `point` along `axis`: `radius`
    cone,      ///< the same, `radius` in the plane through `point`, growing by `slope` per length along `axis`
    sphere,    ///< about `point`: `radius`
    torus,     ///< about the line: a circle of radius `slope` whose centre runs at `radius` in the plane through `point`
    extruded,  ///< a curve moved along `axis`
    revolved,  ///< a curve turned about the line
    helical    ///< a curve turned about the line while it moves along: `slope` per full turn
};
const char* name_of(SurfaceKind kind);

/// @tparam T  Number while drawing, double once drawn.
template <class T>
struct SurfaceOf {
    SurfaceKind kind = SurfaceKind::plane;
    std::string feature;  ///< the designer's name of the curve that it comes from; of an end, end_of_feature() of the outline's
    std::array<T, 3> point{0, 0, 0}, axis{0, 0, 1};  ///< axis: of length 1
    T radius = 0, slope = 0;
    bool hollow = false;  ///< the material is outside: a bore
};
using Surface = SurfaceOf<Number>;
using DrawnSurface = SurfaceOf<double>;

/// What an end of a solid is called whose outline is `feature`: "rim end".
inline std::string end_of_feature(const std::string& feature) { return feature.empty() ? feature : feature + " end"; }

/// Where the true surface is, seen from a facet that stands for it.
enum class Side {
    on,       ///< it is the facet
    outside,  ///< on the facet or outside of the mesh
    inside,   ///< on the facet or inside
    both
};

/// Per triangle.
struct Facet {
    int surface = 0;  ///< index into the solid's
    Side side = Side::on;
};

}  // namespace fettle::core::parts
