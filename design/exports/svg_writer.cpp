// SPDX-License-Identifier: MIT
#include "fettle/design/exports/svg_writer.hpp"

#include <cstdio>

#include "fettle/core/base/text.hpp"

namespace fettle::design::exports {

namespace {

/// Hundredths of a pixel.
std::string number(double x) {
    char text[40];
    std::snprintf(text, sizeof text, "%.2f", x);
    return text;
}

std::string path_of(const PictureLine& line) {
    return "M" + number(line.from.x()) + " " + number(line.from.y()) + "L" + number(line.to.x()) + " " + number(line.to.y());
}

std::string text_at(double x, double y, const std::string& text, const char* more = "") {
    return "<text x=\"" + number(x) + "\" y=\"" + number(y) + "\"" + more + ">" + core::base::xml_text(text) + "</text>\n";
}

std::string circle_at(const Vector2& centre, double radius, const char* more = "") {
    return "<circle cx=\"" + number(centre.x()) + "\" cy=\"" + number(centre.y()) + "\" r=\"" + number(radius) + "\"" + more + "/>\n";
}

std::string marker_text(const Picture& picture) {
    if (!picture.marker) return "";
    const Vector2 &a = picture.marker->from, &b = picture.marker->to;
    const std::string colour = css_colour(picture.marker_colour);
    std::string out = "<g class=\"witness\" stroke=\"" + colour + "\" stroke-width=\"2\" fill=\"" + colour + "\">\n<path d=\"" +
                      path_of(*picture.marker) + "\"/>\n";
    for (const Vector2& p : {a, b}) out += circle_at(p, 3);
    if (picture.hole > 0) out += circle_at(middle_of(*picture.marker), picture.hole, " fill=\"none\" stroke-width=\"1.5\"");
    const Vector2 at = text_place(picture);
    if (!picture.marker_text.empty())
        out += text_at(at.x(), at.y(), picture.marker_text, " stroke=\"#ffffff\" stroke-width=\"4\" paint-order=\"stroke\"");
    return out + "</g>\n";
}

std::string legend_text(const Picture& picture) {
    std::string out = "<g>\n";
    double y = 26;
    if (!picture.title.empty()) {
        out += text_at(12, y, picture.title, " font-weight=\"bold\"");
        y += 26;
    }
    for (const LegendEntry& entry : picture.legend) {
        out += "<rect x=\"12\" y=\"" + number(y - 12) + "\" width=\"14\" height=\"14\" fill=\"" + css_colour(entry.colour) + "\"/>\n" +
               text_at(34, y, entry.name);
        y += 20;
    }
    const double base = picture.surfaces.height - 14, end = 12 + picture.scale_pixels;
    return out + "<path d=\"M12 " + number(base - 5) + "V" + number(base + 5) + "M12 " + number(base) + "H" + number(end) + "M" +
           number(end) + " " + number(base - 5) + "V" + number(base + 5) + "\" stroke=\"" + css_colour(ink) +
           "\" stroke-width=\"2\" fill=\"none\"/>\n" + text_at(end + 8, base + 5, picture.scale_text) + "</g>\n";
}

std::string size_of(const Picture& picture) {
    return "width=\"" + std::to_string(picture.surfaces.width) + "\" height=\"" + std::to_string(picture.surfaces.height) + "\"";
}

std::string content_of(const Picture& picture) {
    std::string edges, out;
    for (const PictureLine& line : picture.edges) edges += path_of(line);
    out = "<image " + size_of(picture) + " href=\"data:image/png;base64," + base64(png_bytes(picture.surfaces)) +
          "\"/>\n<path fill=\"none\" stroke=\"" + css_colour(ink) + "\" stroke-width=\"1\" stroke-linecap=\"round\" d=\"" + edges +
          "\"/>\n";
    for (const Picture& inset : picture.inset)
        out += "<svg x=\"" + number(picture.inset_place.x()) + "\" y=\"" + number(picture.inset_place.y()) + "\" " + size_of(inset) +
               ">\n" + content_of(inset) + "<rect " + size_of(inset) + " fill=\"none\" stroke=\"" + css_colour(picture.marker_colour) +
               "\" stroke-width=\"4\"/>\n</svg>\n";
    return out + marker_text(picture) + legend_text(picture);
}

}  // namespace

std::string svg_text(const Picture& picture) {
    return "<svg xmlns=\"http://www.w3.org/2000/svg\" " + size_of(picture) + " viewBox=\"0 0 " + std::to_string(picture.surfaces.width) +
           " " + std::to_string(picture.surfaces.height) + "\" font-family=\"sans-serif\" font-size=\"15\" fill=\"" + css_colour(ink) +
           "\">\n" + content_of(picture) + "</svg>\n";
}

}  // namespace fettle::design::exports
