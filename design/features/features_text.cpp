// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "core/base/rounded_lengths.hpp"
#include "core/base/text.hpp"
#include "design/features/features_report.hpp"

namespace fettle::design::features {

namespace {

using core::base::formatted;
using core::base::Towards;
using core::features::Feature;
using core::parts::SurfaceKind;

constexpr double millimetre = 1e-3, degree = std::numbers::pi / 180;

std::string number(double si, double unit = millimetre, int digits = 5) {
    const double x = std::abs(si) < 1e-9 ? 0.0 : si / unit;
    return formatted("%.*g", digits, x);
}

// 'x', 'y', 'z' where the axis is one of these; else 0.
char axis_letter(const Vector3& axis) {
    for (int k = 0; k < 3; ++k)
        if (std::abs(axis[k]) > 1 - 1e-9) return "xyz"[k];
    return 0;
}

// "x 6..14 through (-, 44, 20)", or "along 6..14 on (0.6, 0, 0.8) through (1, 2, 3)".
std::string place_text(const Feature& feature) {
    if (feature.surface.kind == SurfaceKind::sphere)
        return "about (" + number(feature.origin.x()) + ", " + number(feature.origin.y()) + ", " + number(feature.origin.z()) + ")";
    const char letter = axis_letter(feature.surface.axis);
    std::string at;
    for (int k = 0; k < 3; ++k) at += (k > 0 ? ", " : "") + (letter == "xyz"[k] ? std::string("-") : number(feature.origin[k]));
    std::string reach;
    for (const core::features::Stretch& piece : feature.pieces)
        reach += (reach.empty() ? "" : " and ") + number(piece.from) + ".." + number(piece.to);
    const Vector3& axis = feature.surface.axis;
    if (letter != 0) return std::string(1, letter) + " " + reach + " on (" + at + ")";
    return "along " + reach + " of (" + formatted("%.5g, %.5g, %.5g", axis.x(), axis.y(), axis.z()) + ") through (" + at + ")";
}

std::string size_text(const Feature& feature) {
    const core::features::Surface& surface = feature.surface;
    switch (surface.kind) {
        case SurfaceKind::cone:
            return "d " + number(2 * feature.radius_at(feature.along.from)) + " to " + number(2 * feature.radius_at(feature.along.to)) +
                   ", " + number(std::atan(std::abs(surface.slope)), degree, 4) + " deg";
        case SurfaceKind::torus:
            return "d " + number(2 * surface.radius) + ", tube d " + number(2 * surface.slope);
        default:
            return "d " + number(2 * surface.radius);
    }
}

std::string ends_text(const Feature& feature) {
    if (feature.surface.kind == SurfaceKind::sphere) return {};
    if (feature.is_hole) return feature.is_through ? ", through" : ", blind";
    using core::features::End;
    if (feature.lower == End::closed && feature.upper == End::closed) return ", shoulders at both ends";
    return feature.lower == End::closed || feature.upper == End::closed ? ", a shoulder at one end" : "";
}

std::string feature_line(const Feature& feature) {
    const std::string kind = feature.surface.kind == SurfaceKind::cylinder
                                 ? role_of(feature)
                                 : (feature.is_hole ? "hollow " : "") + std::string(core::parts::name_of(feature.surface.kind));
    std::string out = feature.name + " " + kind + " " + size_text(feature) + ", " + place_text(feature) + ends_text(feature);
    if (feature.covered < 359.5 * degree) out += ", " + number(feature.covered, degree, 4) + " deg of the turn";
    out += feature.is_exact ? "; exact" : "; fitted, residual " + number(feature.residual, millimetre, 2);
    if (feature.surface.kind == SurfaceKind::cylinder || feature.surface.kind == SurfaceKind::sphere)
        out += ", facets d " + number(2 * feature.facets_least) + ".." + number(2 * feature.facets_largest);
    if (!feature.coaxial.empty()) out += "; on one axis with " + core::base::joined(feature.coaxial);
    return out;
}

std::string plane_line(const Feature& feature) {
    const Vector3 &n = feature.surface.axis, &at = feature.centre;
    return feature.name + " plane (" + formatted("%.5g, %.5g, %.5g", n.x() + 0.0, n.y() + 0.0, n.z() + 0.0) + ") through (" +
           number(at.x()) + ", " + number(at.y()) + ", " + number(at.z()) + "), " + number(feature.area, 1e-6, 4) + " mm^2";
}

std::string part_text(const core::model::Body& body, const core::features::Features& part, bool all) {
    const std::string name = core::base::shown_on_one_line(body.name);
    std::string out, indent = "  ";
    int planes = 0, roundings = 0;
    for (const Feature& feature : part.features) {
        const bool is_plane = feature.surface.kind == SurfaceKind::plane;
        planes += is_plane ? 1 : 0;
        roundings += feature.is_rounding ? 1 : 0;
        if (!all && (is_plane || feature.is_rounding)) continue;
        out += indent + (is_plane ? plane_line(feature) : feature_line(feature)) + "\n";
    }
    std::string also;
    if (planes > 0) also += core::base::counted(planes, "flat face");
    if (roundings > 0) also += (also.empty() ? "" : ", ") + core::base::counted(roundings, "rounded edge");
    std::string head = name + ": " + (also.empty() ? "no flat face" : also);
    if (part.free_form_area > 1e-9 * part.area)
        head += ", " + core::base::percent(part.free_form_area / part.area) + " of the area free-form";
    return head + formatted("; corners lie on their surfaces to within %s mm\n", number(part.tolerance, millimetre, 2).c_str()) + out;
}

std::string processes_text(const FoundFit& found) {
    std::string enough, short_of, unknown;
    for (const ProcessVerdict& verdict : found.processes) {
        const std::string needs = verdict.process + " (" + number(verdict.required, millimetre, 3) + ")";
        if (!verdict.fault.empty()) {
            unknown += (unknown.empty() ? "" : ", ") + verdict.process;
        } else {
            std::string& list = verdict.is_enough ? enough : short_of;
            list += (list.empty() ? "" : ", ") + needs;
        }
    }
    std::string out;
    if (!enough.empty()) out += "; enough for " + enough;
    if (!short_of.empty()) out += "; too little for " + short_of;
    if (!unknown.empty()) out += "; what it needs is not known for " + unknown;
    return out;
}

std::string play_text(const FoundFit& found) {
    const core::base::RoundedLengths lengths("mm", 4);
    const core::features::Fit& fit = found.fit;
    if (found.gap.intersecting || !(found.gap.lower > 0)) {
        const char* what = found.gap.intersecting ? ": their facets meet as assembled" : ": no gap is proven as assembled";
        return what + std::string("; ") + number(fit.play) + " mm per side by the fitted surfaces";
    }
    std::string out = ": " + lengths.fixed(found.gap.lower, Towards::down) + " mm ";
    out += fit.is_centred ? "per side, concentric, proven"
                          : "at the nearest as assembled, proven; " + number(fit.off_centre) + " mm off centre";
    out += "; play " + number(fit.play) + " mm per side by the fitted surfaces, " + number(fit.facets_play) + " by the facets";
    if (!fit.is_held) out += ", less than half round";
    if (fit.lean > 1e-4) out += ", leaning by " + number(fit.lean, degree, 3) + " deg";
    return out;
}

}  // namespace

std::string fit_sentence(const FeaturesReport& report, const FoundFit& found) {
    return report.name_of(found.fit.pin) + " in " + report.name_of(found.fit.hole) + play_text(found);
}

std::string features_text(const FeaturesReport& report, bool all) {
    std::string out = "lengths in mm\n";
    for (std::size_t b = 0; b < report.parts.size(); ++b) out += part_text(report.model.bodies[b], report.parts[b], all);
    // Holes that a pin fits alike stand in one line.
    std::vector<std::pair<std::string, std::string>> lines;
    for (const FoundFit& found : report.fits) {
        const std::string pin = report.name_of(found.fit.pin) + " in ", says = play_text(found) + processes_text(found);
        const auto same =
            std::find_if(lines.begin(), lines.end(), [&](const auto& line) { return line.second == says && line.first.starts_with(pin); });
        if (same != lines.end()) {
            same->first += ", " + report.name_of(found.fit.hole);
        } else {
            lines.emplace_back(pin + report.name_of(found.fit.hole), says);
        }
    }
    if (report.parts.size() > 1) out += lines.empty() ? "fits: none\n" : "fits\n";
    for (const auto& [names, says] : lines) out += "  " + names + says + "\n";
    if (report.interrupted) out += "interrupted: what was not looked at by then is missing\n";
    return out;
}

}  // namespace fettle::design::features
