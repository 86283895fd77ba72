// SPDX-License-Identifier: MIT
#include "core/features/merged_regions.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/features/fit_surface.hpp"

namespace fettle::core::features {

namespace {

// Corners of a region, a few or many.
std::vector<Vector3> some_corners(const Patches& patches, const Region& region, double limit, std::size_t most) {
    const std::vector<int> corners = corners_on(patches, region.surface.kind, region.patches, limit);
    std::vector<Vector3> out;
    const std::size_t stride = (corners.size() + most - 1) / most;
    for (std::size_t k = 0; k < corners.size(); k += std::max<std::size_t>(stride, 1)) out.push_back(patches.vertices.col(corners[k]));
    return out;
}

Reach reach_of(const Patches& patches, const Region& region, const Vector3& direction) {
    Reach out{INFINITY, -INFINITY};
    for (const int member : region.patches) {
        const Reach of = reach_along(patches, member, direction);
        out = {std::min(out.low, of.low), std::max(out.high, of.high)};
    }
    return out;
}

bool is_near(const Patches& patches, const Region& a, const Region& b, const Surface& axis_of) {
    if (a.surface.kind != SurfaceKind::cylinder && a.surface.kind != SurfaceKind::cone) return true;
    const Reach of_a = reach_of(patches, a, axis_of.axis), of_b = reach_of(patches, b, axis_of.axis);
    const double gap = std::max(of_a.low, of_b.low) - std::min(of_a.high, of_b.high);
    return gap <= 0.5 * std::min(of_a.high - of_a.low, of_b.high - of_b.low);
}

std::optional<Region> joined(const Patches& patches, const Region& a, const Region& b, const RegionOptions& options) {
    constexpr std::size_t most = 400;
    std::vector<Vector3> points = some_corners(patches, a, options.limit, most);
    const std::vector<Vector3> more = some_corners(patches, b, options.limit, most);
    points.insert(points.end(), more.begin(), more.end());
    const std::optional<Surface> surface = fitted_surface(a.surface, points);
    if (!surface || !is_near(patches, a, b, *surface)) return std::nullopt;
    Region out{*surface, a.hollow, a.patches, 0, a.area + b.area};
    out.patches.insert(out.patches.end(), b.patches.begin(), b.patches.end());
    std::sort(out.patches.begin(), out.patches.end());
    for (const Region* each : {&a, &b})
        for (const int v : corners_on(patches, a.surface.kind, each->patches, options.limit))
            out.residual = std::max(out.residual, std::abs(signed_distance(*surface, patches.vertices.col(v))));
    if (out.residual > options.tolerance) return std::nullopt;
    return out;
}

// Is it worth a fit? A few corners of each lie near the other's surface.
bool may_be_one(const Patches& patches, const Region& a, const Region& b, const RegionOptions& options) {
    if (a.surface.kind != b.surface.kind || a.hollow != b.hollow) return false;
    if (std::abs(a.surface.radius - b.surface.radius) > 0.3 * (a.surface.radius + b.surface.radius)) return false;
    const Region& larger = a.area < b.area ? b : a;
    const double near = 20 * options.tolerance + 0.05 * larger.surface.radius;
    for (const Vector3& x : some_corners(patches, a.area < b.area ? a : b, options.limit, 8))
        if (!(std::abs(signed_distance(larger.surface, x)) <= near)) return false;
    return true;
}

}  // namespace

Reach reach_along(const Patches& patches, int patch, const Vector3& direction) {
    Reach out{INFINITY, -INFINITY};
    for (const int v : patches.patch_vertices[patch]) {
        const double at = direction.dot(patches.vertices.col(v));
        out = {std::min(out.low, at), std::max(out.high, at)};
    }
    return out;
}

std::vector<Region> merged_regions(const Patches& patches, std::vector<Region> regions, const RegionOptions& options) {
    for (std::size_t i = 0; i < regions.size(); ++i)
        for (std::size_t j = i + 1; j < regions.size();) {
            std::optional<Region> one;
            if (may_be_one(patches, regions[i], regions[j], options)) one = joined(patches, regions[i], regions[j], options);
            if (!one) {
                ++j;
                continue;
            }
            regions[i] = std::move(*one);
            regions.erase(regions.begin() + static_cast<std::ptrdiff_t>(j));
            j = i + 1;  // what was too far along the axis may be near now
        }
    return regions;
}

}  // namespace fettle::core::features
