// SPDX-License-Identifier: MIT
/// What is drawn of a picture, where and in which order: the same for every format. png_writer.cpp and svg_writer.cpp have a canvas each.
#pragma once

#include <string>
#include <vector>

#include "design/exports/picture.hpp"

namespace fettle::design::exports {

/// A Canvas has, in pixels from the upper left corner:
///   pixels(image)                         from the corner on
///   lines(lines, colour, width)           with round ends
///   circle(centre, radius, colour, width), box(corner, size, colour, width)     width 0: filled
///   text(place, words, colour, letters)   `place`: the left end of the baseline
///   within(corner, size, draw)            all that draw() draws counts from this corner, and is cut off at the box
///   group(name, draw)                     all that draw() draws belongs together, under a name for those who work on the picture
template <class Canvas>
void put_marks(const Picture& picture, Canvas& canvas);

template <class Canvas>
void put_marker(const Picture& picture, Canvas& canvas) {
    const Colour& colour = picture.marker_colour;
    if (picture.hole > 0) canvas.circle(middle_of(*picture.marker), picture.hole, colour, 2);
    for (const Vector2& end : {picture.marker->from, picture.marker->to}) canvas.circle(end, 5, white, 0);
    canvas.lines({*picture.marker}, colour, 2.5);
    for (const Vector2& end : {picture.marker->from, picture.marker->to}) canvas.circle(end, 3.5, colour, 0);
    if (!picture.marker_text.empty()) canvas.text(text_place(picture), picture.marker_text, colour, marker_letters);
}

template <class Canvas>
void put_marks(const Picture& picture, Canvas& canvas) {
    canvas.pixels(picture.surfaces);
    for (const PartEdges& edges : picture.edges) canvas.lines(edges.lines, edges.colour, 1.2);
    for (const Picture& inset : picture.inset) {
        const Vector2 size(inset.surfaces.width, inset.surfaces.height);
        canvas.within(picture.inset_place, size, [&] { put_marks(inset, canvas); });
        canvas.box(picture.inset_place, size, picture.marker_colour, 2);
    }
    if (picture.marker) canvas.group("witness", [&] { put_marker(picture, canvas); });
    double y = 28;
    if (!picture.title.empty()) {
        canvas.text({12, y}, picture.title, ink, title_letters);
        y += 28;
    }
    for (const LegendEntry& entry : picture.legend) {
        canvas.box({12, y - 12}, {14, 14}, entry.colour, 0);
        canvas.text({34, y}, entry.name, ink, plain_letters);
        y += legend_pitch;
    }
    const double base = picture.surfaces.height - 14, end = 12 + picture.scale_pixels;
    std::vector<PictureLine> bar{{{12, base}, {end, base}}};
    for (const double x : {12.0, end}) bar.push_back({{x, base - 5}, {x, base + 5}});
    canvas.lines(bar, white, 5);
    canvas.lines(bar, ink, 2);
    canvas.text({end + 8, base + 5}, picture.scale_text, ink, plain_letters);
}

}  // namespace fettle::design::exports
