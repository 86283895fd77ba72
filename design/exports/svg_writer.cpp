// SPDX-License-Identifier: MIT
#include "fettle/design/exports/svg_writer.hpp"

#include <cstdio>

namespace fettle::design::exports {

namespace {

std::string escaped(const std::string& text) {
    std::string out;
    for (const char c : text) {
        if (c == '&') {
            out += "&amp;";
        } else if (c == '<') {
            out += "&lt;";
        } else if (c == '"') {
            out += "&quot;";
        } else {
            out += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
        }
    }
    return out;
}

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
    return "<text x=\"" + number(x) + "\" y=\"" + number(y) + "\"" + more + ">" + escaped(text) + "</text>\n";
}

std::string marker_text(const Picture& picture) {
    if (!picture.marker) return "";
    const Vector2 &a = picture.marker->from, &b = picture.marker->to;
    std::string out =
        "<g id=\"witness\" stroke=\"#c80028\" stroke-width=\"2\" fill=\"#c80028\">\n<path d=\"" + path_of(*picture.marker) + "\"/>\n";
    for (const Vector2& p : {a, b}) out += "<circle cx=\"" + number(p.x()) + "\" cy=\"" + number(p.y()) + "\" r=\"3\"/>\n";
    return out + text_at(b.x() + 10, b.y() - 10, picture.marker_text, " stroke=\"#ffffff\" stroke-width=\"4\" paint-order=\"stroke\"") +
           "</g>\n";
}

std::string legend_text(const Picture& picture) {
    std::string out = "<g id=\"legend\">\n";
    double y = 26;
    if (!picture.title.empty()) {
        out += text_at(12, y, picture.title, " font-weight=\"bold\"");
        y += 26;
    }
    for (const LegendEntry& entry : picture.legend) {
        char colour[40];
        std::snprintf(colour, sizeof colour, "#%02x%02x%02x", entry.colour[0], entry.colour[1], entry.colour[2]);
        out += "<rect x=\"12\" y=\"" + number(y - 12) + "\" width=\"14\" height=\"14\" fill=\"" + colour + "\"/>\n" +
               text_at(34, y, entry.name);
        y += 20;
    }
    const double base = picture.surfaces.height - 14, end = 12 + picture.scale_pixels;
    return out + "<path d=\"M12 " + number(base - 5) + "V" + number(base + 5) + "M12 " + number(base) + "H" + number(end) + "M" +
           number(end) + " " + number(base - 5) + "V" + number(base + 5) + "\" stroke=\"#1e1e1e\" stroke-width=\"2\" fill=\"none\"/>\n" +
           text_at(end + 8, base + 5, picture.scale_text) + "</g>\n";
}

}  // namespace

std::string svg_text(const Picture& picture) {
    const std::string size =
        "width=\"" + std::to_string(picture.surfaces.width) + "\" height=\"" + std::to_string(picture.surfaces.height) + "\"";
    std::string edges;
    for (const PictureLine& line : picture.edges) edges += path_of(line);
    return "<svg xmlns=\"http://www.w3.org/2000/svg\" " + size + " viewBox=\"0 0 " + std::to_string(picture.surfaces.width) + " " +
           std::to_string(picture.surfaces.height) + "\" font-family=\"sans-serif\" font-size=\"15\" fill=\"#1e1e1e\">\n<image " + size +
           " href=\"data:image/png;base64," + base64(png_bytes(picture.surfaces)) +
           "\"/>\n<path id=\"edges\" fill=\"none\" stroke=\"#1e1e1e\" stroke-width=\"1\" stroke-linecap=\"round\" d=\"" + edges + "\"/>\n" +
           marker_text(picture) + legend_text(picture) + "</svg>\n";
}

}  // namespace fettle::design::exports
