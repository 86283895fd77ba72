// SPDX-License-Identifier: MIT
#include "core/features/find_features.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "core/features/free_form.hpp"
#include "core/features/measured_feature.hpp"
#include "core/features/merged_regions.hpp"

namespace fettle::core::features {

namespace {

// What a mesh is taken apart into, at one tolerance.
struct Parted {
    Patches patches;
    std::vector<Region> regions;
    std::vector<std::uint8_t> free;
    double free_area = 0, area = 0;
};

Parted part(const geometry::Mesh& mesh, const RegionOptions& options) {
    Parted out;
    out.patches = patches_of(mesh, 0.5 * options.tolerance, options.limit);  // two facets in one patch are off by both
    out.regions = curved_regions(out.patches, options);
    out.free = drop_unbounded(out.patches, out.regions, options);
    for (int p = 0; p < count_of(out.patches.patches); ++p) {
        out.area += out.patches.patches[p].area;
        if (out.free[p] != 0) out.free_area += out.patches.patches[p].area;
    }
    return out;
}

double diagonal_of(const geometry::Mesh& mesh) { return geometry::box_sides(mesh.vertices).norm(); }

double of_digits(const geometry::Mesh& mesh) { return std::max(2e-6 * diagonal_of(mesh), 1.2e-5 * mesh.vertices.cwiseAbs().maxCoeff()); }

Parted part_as_needed(const geometry::Mesh& mesh, const FeatureOptions& options, double& tolerance) {
    tolerance = options.tolerance.value_or(of_digits(mesh));
    Parted exact = part(mesh, {tolerance, options.largest_step, options.tolerance.has_value()});
    constexpr double much = 0.02, most = 0.5;
    const double loose = 6e-5 * diagonal_of(mesh);
    if (options.tolerance || !(exact.free_area > much * exact.area) || loose <= tolerance) return exact;
    Parted inexact = part(mesh, {loose, options.largest_step, true});
    if (inexact.free_area > most * exact.free_area) return exact;
    tolerance = loose;
    return inexact;
}

char letter_of(const Feature& feature) {
    switch (feature.surface.kind) {
        case SurfaceKind::cylinder:
            return feature.is_rounding ? 'R' : feature.is_hole ? 'B' : 'P';
        case SurfaceKind::cone:
            return 'C';
        case SurfaceKind::sphere:
            return 'S';
        case SurfaceKind::torus:
            return 'T';
        default:
            return 'F';
    }
}

void name_all(std::vector<Feature>& features) {
    constexpr double step = 1e-5;  // [m] what is as far as that along x is told apart along y
    using Key = std::tuple<std::size_t, double, double, double, double>;
    const auto key = [&](const Feature& f) {
        const bool by_area = f.surface.kind == SurfaceKind::plane;
        const Vector3 at = ((by_area ? f.centre : f.surface.point) / step).array().round();
        return Key(std::string("BPCSTRF").find(letter_of(f)), at.x(), at.y(), at.z(), f.surface.radius);
    };
    std::vector<std::pair<Key, int>> order;
    for (int k = 0; k < count_of(features); ++k) order.emplace_back(key(features[k]), k);
    std::sort(order.begin(), order.end());
    std::vector<Feature> sorted;
    std::map<char, int> counts;
    for (const auto& [of, k] : order) {
        sorted.push_back(std::move(features[k]));
        const char letter = letter_of(sorted.back());
        sorted.back().name = letter + std::to_string(++counts[letter]);
    }
    features = std::move(sorted);
}

bool has_axis(const Feature& f) {
    return f.surface.kind == SurfaceKind::cylinder || f.surface.kind == SurfaceKind::cone || f.surface.kind == SurfaceKind::torus;
}

bool are_coaxial(const Feature& a, const Feature& b, double tolerance) {
    const double near = 2 * (tolerance + a.residual + b.residual), reach = 0.5 * std::max(a.length(), b.length());
    const Vector3 between = b.surface.point - a.surface.point;
    const double lean = a.surface.axis.cross(b.surface.axis).norm();
    return lean * std::max(reach, 1e-3 * between.norm()) <= near &&
           (between - between.dot(a.surface.axis) * a.surface.axis).norm() <= near &&
           (between - between.dot(b.surface.axis) * b.surface.axis).norm() <= near;
}

// A hole that ends at a narrower one on the same axis goes on through that.
bool opens(const std::vector<Feature>& all, const std::vector<std::vector<int>>& coaxial, int k, bool at_upper, double tolerance,
           int depth) {
    const Feature& f = all[k];
    if ((at_upper ? f.upper : f.lower) != End::closed) return true;
    if (depth == 0) return false;
    const double here = at_upper ? f.along.to : f.along.from, near = 1e-3 * f.surface.radius + 2 * tolerance;
    for (const int j : coaxial[k]) {
        if (!all[j].is_hole || f.surface.axis.dot(all[j].surface.axis) < 0) continue;
        const double there = at_upper ? all[j].along.from : all[j].along.to;
        if (std::abs(there - here) <= near && opens(all, coaxial, j, at_upper, tolerance, depth - 1)) return true;
    }
    return false;
}

void relate(std::vector<Feature>& features, double tolerance) {
    std::vector<std::vector<int>> coaxial(features.size());
    for (int i = 0; i < count_of(features); ++i)
        for (int j = i + 1; j < count_of(features) && has_axis(features[i]); ++j)
            if (has_axis(features[j]) && are_coaxial(features[i], features[j], tolerance)) {
                coaxial[i].push_back(j);
                coaxial[j].push_back(i);
            }
    for (int i = 0; i < count_of(features); ++i) {
        for (const int j : coaxial[i]) features[i].coaxial.push_back(features[j].name);
        constexpr int most_steps = 8;
        features[i].is_through = features[i].is_hole && has_axis(features[i]) && opens(features, coaxial, i, true, tolerance, most_steps) &&
                                 opens(features, coaxial, i, false, tolerance, most_steps);
    }
}

}  // namespace

Features find_features(const geometry::Mesh& mesh, const FeatureOptions& options) {
    Features out;
    if (mesh.triangles.empty()) return out;
    Parted parted = part_as_needed(mesh, options, out.tolerance);
    const RegionOptions asked{out.tolerance, options.largest_step};
    out.area = parted.area;
    out.free_form_area = parted.free_area;
    std::vector<std::uint8_t> in_region(parted.patches.patches.size(), 0);
    for (const Region& region : merged_regions(parted.patches, std::move(parted.regions), asked)) {
        for (const int member : region.patches) in_region[member] = 1;
        out.features.push_back(measured_feature(parted.patches, region, asked));
    }
    for (int p = 0; p < count_of(parted.patches.patches); ++p) {
        if (in_region[p] != 0) continue;
        if (parted.free[p] == 0) {
            out.features.push_back(flat_feature(parted.patches, p));
            continue;
        }
        for (const int t : parted.patches.patch_triangles[p]) out.free_form.push_back(parted.patches.in_mesh[t]);
    }
    std::sort(out.free_form.begin(), out.free_form.end());
    name_all(out.features);
    relate(out.features, out.tolerance);
    return out;
}

}  // namespace fettle::core::features
