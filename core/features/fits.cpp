// SPDX-License-Identifier: MIT
#include "core/features/fits.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace fettle::core::features {

namespace {

bool may_fit(const Feature& feature, SurfaceKind kind) {
    return feature.surface.kind == kind && !feature.is_rounding && (kind == SurfaceKind::cylinder || kind == SurfaceKind::sphere);
}

// The distance of a point from a feature's axis.
double from_axis(const Feature& feature, const Vector3& x) {
    const Vector3 d = x - feature.surface.point;
    return (d - feature.surface.axis.dot(d) * feature.surface.axis).norm();
}

// Pin and hole along the pin's axis.
bool measure_cylinders(const Feature& pin, const Feature& hole, Fit& fit) {
    const double cosine = pin.surface.axis.dot(hole.surface.axis);
    fit.lean = std::atan2(pin.surface.axis.cross(hole.surface.axis).norm(), std::abs(cosine));
    constexpr double most_lean = 0.2;  // [rad] no play allows more in a hole as long as wide
    if (fit.lean > most_lean) return false;
    const auto along_pin = [&](double height) { return pin.surface.axis.dot(hole.origin + height * hole.surface.axis); };
    const auto [low, high] = std::minmax({along_pin(hole.along.from), along_pin(hole.along.to)});
    const double from = std::max(low, pin.along.from), to = std::min(high, pin.along.to);
    fit.overlap = to - from;
    if (!(fit.overlap > 0)) return false;
    const auto at = [&](double height) -> Vector3 { return pin.origin + height * pin.surface.axis; };
    fit.off_centre = std::max(from_axis(hole, at(from)), from_axis(hole, at(to)));
    return true;
}

std::optional<Fit> fit_of(const Feature& pin, const Feature& hole, double tolerance, const FitLimits& limits) {
    Fit fit;
    fit.play = hole.surface.radius - pin.surface.radius;
    fit.facets_play = hole.facets_least - pin.facets_largest;
    if (fit.play > limits.loosest * hole.surface.radius || fit.play < -limits.tightest * hole.surface.radius) return std::nullopt;
    if (pin.surface.kind == SurfaceKind::cylinder) {
        if (!measure_cylinders(pin, hole, fit)) return std::nullopt;
    } else {
        fit.off_centre = (pin.surface.point - hole.surface.point).norm();
        fit.overlap = 2 * pin.surface.radius;
    }
    const double known = tolerance + 2 * (pin.residual + hole.residual);
    if (fit.off_centre > std::max(fit.play, 0.0) + known) return std::nullopt;
    fit.is_centred = fit.off_centre <= known;
    constexpr double half_turn = std::numbers::pi, a_little = 0.1;
    fit.is_held = pin.surface.kind == SurfaceKind::sphere || (hole.covered > half_turn + a_little && pin.covered > half_turn - a_little);
    return fit;
}

}  // namespace

std::vector<Fit> find_fits(const std::vector<Features>& parts, const FitLimits& limits) {
    std::vector<Fit> out;
    for (int a = 0; a < count_of(parts); ++a)
        for (int p = 0; p < count_of(parts[a].features); ++p) {
            const Feature& pin = parts[a].features[p];
            if (pin.is_hole || !may_fit(pin, pin.surface.kind)) continue;
            for (int b = 0; b < count_of(parts); ++b)
                for (int h = 0; h < count_of(parts[b].features) && b != a; ++h) {
                    const Feature& hole = parts[b].features[h];
                    if (!hole.is_hole || !may_fit(hole, pin.surface.kind)) continue;
                    std::optional<Fit> fit = fit_of(pin, hole, std::max(parts[a].tolerance, parts[b].tolerance), limits);
                    if (!fit) continue;
                    fit->pin = {a, p};
                    fit->hole = {b, h};
                    out.push_back(*fit);
                }
        }
    return out;
}

}  // namespace fettle::core::features
