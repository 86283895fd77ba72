// SPDX-License-Identifier: MIT
/// Surfaces fitted to points by least squares of the distances (docs/method/features.md): starts from normals, then Gauss-Newton.
#pragma once

#include <optional>
#include <vector>

#include "core/features/surface.hpp"

namespace fettle::core::features {

/// What a surface is fitted to.
struct SurfaceSamples {
    std::vector<Vector3> points;            ///< that lie on it [m]
    std::vector<Vector3> centres, normals;  ///< of facets beside it; unit, all on one side [m]
    std::vector<double> weights;            ///< of the facets, such as their areas
};

/// A surface of this kind that is near, from the normals. Exact for facets of a tessellation along an axis, but for tori:
///     plane     through the mean, across the least eigenvector of the points' covariance
///     cylinder  axis: the least eigenvector of the normals' covariance; radius and place: circle through the points seen along it
///     cone      axis: the least eigenvector of the covariance of the normals about their mean; apex: nearest to all facets' planes
///     sphere    algebraic: |x|^2 = 2 c x + k
///     torus     axis: the line nearest to all normals' lines as a linear complex; then a circle in the meridian plane
/// Nothing: the samples have no such surface, as flat ones have no sphere.
/// Source: Pottmann, Wallner 2001, Computational Line Geometry, 7.1 (surfaces of revolution from normals); Marshall, Lukacs, Martin 2001,
/// Robust segmentation of primitives from range data.
std::optional<Surface> near_surface(SurfaceKind kind, const SurfaceSamples& samples);

/// Gauss-Newton with Levenberg's damping from a start: least sum of squared distances of the points. Its `point` is beside the points'
/// mean (of cylinders and cones); its axis has a length of 1. Nothing: fewer points than numbers, or no end was reached.
/// @param hopeless  [m]; > 0: nothing, as soon as the root mean square stays above this while a step takes off less than three quarters of
///                  the sum of squares: points of no such surface
std::optional<Surface> fitted_surface(const Surface& start, const std::vector<Vector3>& points, double hopeless = 0);

}  // namespace fettle::core::features
