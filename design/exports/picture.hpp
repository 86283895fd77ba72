// SPDX-License-Identifier: MIT
/// Pictures of an assembly without a browser: orthographic, hidden surfaces removed by a depth buffer, edges where faces meet at an angle
/// (parts_view.hpp). What is marked is seen whatever stands before it: it is cut free, and shown near in an inset.
/// As PNG: png_writer.hpp; as SVG with edges and text as vectors: svg_writer.hpp.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "design/exports/assembly.hpp"
#include "design/exports/image.hpp"
#include "design/exports/parts_view.hpp"
#include "design/exports/projection_view.hpp"

namespace fettle::design::exports {

/// Two points of the world and what is written beside them, such as a worst witness; of material that two bodies share twice its middle.
struct PictureMarker {
    Vector3 a = Vector3::Zero(), b = Vector3::Zero();  ///< [m]
    std::string text;
    bool is_shared = false;  ///< material that two bodies share
    double size = 0;         ///< of what is marked, for the inset [m]; 0: how far the points are apart
};

struct PictureOptions {
    ProjectionView view;
    int width = 1200, height = 900;  ///< pixels
    double crease = 0.6;  ///< faces that meet at a larger angle have an edge between them [rad]; 34 degrees: of a polygon of 12, none
    std::optional<PictureMarker> marker;
    std::string title;  ///< one line at the top
};

struct Letters {
    double size = 15;  ///< of the font [pixels]
    bool bold = false;
    double rim = 3;  ///< a line round them in the paper's colour, so that they can be read on anything
};
inline constexpr Letters plain_letters{}, title_letters{17, true}, marker_letters{15, true, 4};
inline constexpr double legend_pitch = 22;  ///< pixels from one line to the next

/// About how wide a text becomes, whatever the font; mostly less [pixels].
double text_width(std::string_view words, const Letters& letters);

struct LegendEntry {
    std::string name;
    Colour colour{};
};

struct Picture {
    Image surfaces;                ///< shaded, on white, no edges, no text
    std::vector<PartEdges> edges;  ///< of each part, their visible stretches
    std::optional<PictureLine> marker;
    Colour marker_colour{};
    std::string marker_text, title;
    std::vector<LegendEntry> legend;
    double scale_pixels = 0;     ///< length of the scale's bar
    std::string scale_text;      ///< what it is long: "20 mm"
    double hole = 0;             ///< radius round the marker's middle within which what stands before it is cut away; 0: nothing is
    std::vector<Picture> inset;  ///< none or one: the marker from near, cut through
    Vector2 inset_place = Vector2::Zero();  ///< of its upper left corner
};

/// Where a marker's text begins: beside the hole, all of it within the picture if it can be.
Vector2 text_place(const Picture& picture);

/// The middle of a marker in the picture.
inline Vector2 middle_of(const PictureLine& marker) { return (marker.from + marker.to) / 2; }

/// The parts where `poses` have them (of the reference points' frames, one per part), as large as the picture allows. Pictures below 300
/// pixels have no inset.
/// Contract: one pose per part; width and height from 16 to 16384.
Picture draw_picture(const Assembly& assembly, const std::vector<core::kinematics::Pose>& poses, const PictureOptions& options);

}  // namespace fettle::design::exports
