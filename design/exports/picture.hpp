// SPDX-License-Identifier: MIT
/// Pictures of an assembly without a browser: orthographic, hidden surfaces removed by a depth buffer, edges where faces meet at an angle.
/// As PNG: png_writer.hpp (`inked`); as SVG with edges and text as vectors: svg_writer.hpp.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fettle/design/exports/assembly.hpp"
#include "fettle/design/exports/png_writer.hpp"
#include "fettle/design/exports/projection_view.hpp"

namespace fettle::design::exports {

/// Two points of the world and what is written beside them, such as a worst witness.
struct PictureMarker {
    Vector3 a = Vector3::Zero(), b = Vector3::Zero();  ///< [m]
    std::string text;
};

struct PictureOptions {
    ProjectionView view;
    int width = 1200, height = 900;  ///< pixels
    double crease = M_PI / 6;        ///< faces that meet at a larger angle have an edge between them [rad]
    std::optional<PictureMarker> marker;
    std::string title;  ///< one line at the top
};

struct PictureLine {
    Vector2 from = Vector2::Zero(), to = Vector2::Zero();  ///< pixels from the upper left corner
};

struct LegendEntry {
    std::string name;
    Colour colour{};
};

struct Picture {
    Image surfaces;                  ///< shaded, on white, no edges, no text
    std::vector<PictureLine> edges;  ///< their visible stretches
    std::optional<PictureLine> marker;
    std::string marker_text, title;
    std::vector<LegendEntry> legend;
    double scale_pixels = 0;  ///< length of the scale's bar
    std::string scale_text;   ///< what it is long: "20 mm"
};

/// The parts where `poses` have them (of the reference points' frames, one per part), as large as the picture allows.
/// Contract: one pose per part; width and height from 16 to 16384.
Picture draw_picture(const Assembly& assembly, const std::vector<core::kinematics::Pose>& poses, const PictureOptions& options);

/// Pixels of all of it.
Image inked(const Picture& picture);

}  // namespace fettle::design::exports
