// SPDX-License-Identifier: MIT
#include "design/exports/picture.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

#include "core/base/contract.hpp"

namespace fettle::design::exports {

namespace {

using core::kinematics::Pose;

constexpr std::size_t most_named = 24;                   // in the legend
constexpr int least_with_inset = 300;                    // pixels
constexpr double hole_share = 0.11, inset_share = 0.36;  // of the picture's shorter side
constexpr double least_magnified = 1.6;                  // by the inset

// A bar of 1, 2 or 5 times a power of ten of millimetres, up to a sixth of the width.
void choose_scale(double pixels_per_metre, int width, Picture& out) {
    const double most = 1000.0 * width / 6 / pixels_per_metre;  // [mm]
    const double power = std::pow(10, std::floor(std::log10(most)));
    const double millimetres = most >= 5 * power ? 5 * power : most >= 2 * power ? 2 * power : power;
    char text[40];
    if (millimetres >= 1000) {
        std::snprintf(text, sizeof text, "%g m", millimetres / 1000);
    } else {
        std::snprintf(text, sizeof text, "%g mm", millimetres);
    }
    out.scale_pixels = millimetres / 1000 * pixels_per_metre;
    out.scale_text = text;
}

// A view with the marker in the picture's plane, else one as near to `view` as that allows.
ProjectionView view_across(const PictureMarker& marker, const ProjectionView& view) {
    const Vector3 along = (marker.b - marker.a).stableNormalized();
    if (!(std::abs(along.dot(view.towards)) > 0.3)) return view;
    Vector3 towards = view.towards - along.dot(view.towards) * along;
    if (towards.norm() < 0.1) towards = view.up - along.dot(view.up) * along;
    towards.normalize();
    Vector3 right = view.up.cross(towards);
    if (right.norm() < 0.1) right = view.right;
    right = (right - right.dot(towards) * towards).normalized();
    return {right, towards.cross(right), towards};
}

// Nearest points often lie in a face, which is not to be the cut's: a little before it.
double cut_depth(const PictureMarker& marker, const Projection& projection, double diagonal) {
    return projection((marker.a + marker.b) / 2).z() + 0.002 * diagonal * projection.scale;
}

PictureLine marker_line(const PictureMarker& marker, const Projection& projection) {
    return {projection(marker.a).head<2>(), projection(marker.b).head<2>()};
}

Picture inset_of(const PartsView& parts, const PictureMarker& marker, const Projection& whole, int side) {
    Projection projection{view_across(marker, whole.view)};
    const double size = marker.size > 0 ? marker.size : (marker.b - marker.a).norm(), diagonal = parts.diagonal();
    const double shown = std::clamp(8 * size, 0.06 * diagonal, std::max(0.06 * diagonal, side / (least_magnified * whole.scale)));
    const Vector3 middle = (marker.a + marker.b) / 2;
    projection.scale = side / std::max(shown, 1e-12);
    projection.centre = Vector2(projection.view.right.dot(middle), projection.view.up.dot(middle));
    projection.middle = Vector2::Constant(0.5 * side);
    Cut cut;
    cut.depth = cut_depth(marker, projection, shown);
    ViewedParts seen = parts.seen(projection, side, side, cut);
    Picture out;
    out.surfaces = std::move(seen.surfaces);
    out.edges = std::move(seen.edges);
    out.marker = marker_line(marker, projection);
    out.marker_colour = marker.is_shared ? alarm : nearest;
    choose_scale(projection.scale, 2 * side, out);
    return out;
}

// The corner where least is hidden; below the legend, above the scale, and not over the marker.
Vector2 free_corner(const Picture& picture, int side) {
    const double right = picture.surfaces.width - side - 14, bottom = picture.surfaces.height - side - 14;
    const double under_legend = 44 + legend_pitch * static_cast<double>(picture.legend.size());
    const std::array<Vector2, 4> corners{Vector2(right, 14), Vector2(right, bottom), Vector2(14, bottom - 40), Vector2(14, under_legend)};
    const auto covered = [&](const Vector2& corner) {
        double sum = 0;
        for (int y = 0; y < side; y += 4)
            for (int x = 0; x < side; x += 4) {
                const int u = static_cast<int>(corner.x()) + x, v = static_cast<int>(corner.y()) + y;
                const bool is_inside = u >= 0 && v >= 0 && u < picture.surfaces.width && v < picture.surfaces.height;
                sum += !is_inside || picture.surfaces.at(u, v) != white ? 1 : 0;
            }
        const Vector2 off = middle_of(*picture.marker) - (corner + Vector2::Constant(0.5 * side));
        const bool hides_marker = off.cwiseAbs().maxCoeff() < 0.5 * side + picture.hole + 30;
        const Vector2 text = text_place(picture) - corner;
        const bool hides_text = text.x() < side + 8 && text.x() + text_width(picture.marker_text, marker_letters) > -8 && text.y() > -12 &&
                                text.y() < side + 30;
        return sum + (hides_marker ? 1e9 : 0) + (hides_text ? 1e6 : 0);
    };
    Vector2 best = corners.front();
    double least = INFINITY;
    for (const Vector2& corner : corners) {
        if (corner.y() < 0 || corner.y() > bottom) continue;
        const double count = covered(corner);
        if (count < least) best = corner;
        least = std::min(least, count);
    }
    return best;
}

void add_marker(const PartsView& parts, const Projection& projection, const PictureOptions& options, Picture& out) {
    const PictureMarker& marker = *options.marker;
    out.marker = marker_line(marker, projection);
    out.marker_text = marker.text;
    out.marker_colour = marker.is_shared ? alarm : nearest;
    const int shorter = std::min(options.width, options.height);
    if (parts.hides((marker.a + marker.b) / 2, projection, options.width, options.height)) {
        out.hole = std::max(hole_share * shorter, 0.6 * (out.marker->to - out.marker->from).norm());
        const Cut cut{middle_of(*out.marker), out.hole, cut_depth(marker, projection, parts.diagonal())};
        ViewedParts seen = parts.seen(projection, options.width, options.height, cut);
        out.surfaces = std::move(seen.surfaces);
        out.edges = std::move(seen.edges);
    }
    if (shorter < least_with_inset) return;
    const int side = static_cast<int>(inset_share * shorter);
    out.inset_place = free_corner(out, side).array().round();
    out.inset.push_back(inset_of(parts, marker, projection, side));
}

}  // namespace

double text_width(std::string_view words, const Letters& letters) {
    const auto count = std::count_if(words.begin(), words.end(), [](char c) { return (c & 0xc0) != 0x80; });
    return (letters.bold ? 0.7 : 0.62) * letters.size * static_cast<double>(count);
}

Vector2 text_place(const Picture& picture) {
    const Vector2 beside = picture.marker->to + Vector2(12 + std::max(0.0, picture.hole - 8), -10 - 0.5 * picture.hole);
    const double width = text_width(picture.marker_text, marker_letters), height = marker_letters.size;
    return {std::clamp(beside.x(), 4.0, std::max(4.0, picture.surfaces.width - width - 4)),
            std::clamp(beside.y(), height + 2, std::max(height + 2, picture.surfaces.height - 8.0))};
}

Picture draw_picture(const Assembly& assembly, const std::vector<Pose>& poses, const PictureOptions& options) {
    FETTLE_ASSERT(std::min(options.width, options.height) >= 16 && std::max(options.width, options.height) <= 16384, "a picture's size");
    const PartsView parts(assembly, poses, options.crease);
    const Projection projection = parts.fitted(options.view, options.width, options.height);
    ViewedParts seen = parts.seen(projection, options.width, options.height);
    Picture out;
    out.surfaces = std::move(seen.surfaces);
    out.edges = std::move(seen.edges);
    out.title = options.title;
    for (std::size_t i = 0; i < assembly.parts.size() && i < most_named; ++i)
        out.legend.push_back({assembly.parts[i].name, assembly.parts[i].colour});
    if (assembly.parts.size() > most_named)
        out.legend.push_back({"and " + std::to_string(assembly.parts.size() - most_named) + " more", white});
    choose_scale(projection.scale, options.width, out);
    if (options.marker) add_marker(parts, projection, options, out);
    return out;
}

}  // namespace fettle::design::exports
