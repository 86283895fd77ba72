// SPDX-License-Identifier: MIT
#include "design/exports/svg_writer.hpp"

#include <cstdio>

#include "core/base/text.hpp"
#include "design/exports/base64.hpp"
#include "design/exports/picture_marks.hpp"
#include "design/exports/png_writer.hpp"

namespace fettle::design::exports {

namespace {

/// Hundredths of a pixel, without zeros at the end.
std::string number(double x) {
    char text[40];
    std::snprintf(text, sizeof text, "%.2f", x);
    std::string out = text;
    out.erase(out.find_last_not_of('0') + 1);
    if (out.back() == '.') out.pop_back();
    return out == "-0" ? "0" : out;
}

std::string attribute(const char* name, double x) { return std::string(" ") + name + "=\"" + number(x) + "\""; }

std::string size_of(double width, double height) { return attribute("width", width) + attribute("height", height); }

/// A Canvas of picture_marks.hpp.
class SvgCanvas {
public:
    void pixels(const Image& image) {
        out += "<image" + size_of(image.width, image.height) + " href=\"data:image/png;base64," + base64(png_bytes(image)) + "\"/>\n";
    }

    void lines(const std::vector<PictureLine>& lines, const Colour& colour, double width) {
        if (lines.empty()) return;
        std::string path;
        for (const PictureLine& line : lines)
            path += "M" + number(line.from.x()) + " " + number(line.from.y()) + "L" + number(line.to.x()) + " " + number(line.to.y());
        out += "<path d=\"" + path + "\"" + ink(colour, width) + " stroke-linecap=\"round\"/>\n";
    }

    void circle(const Vector2& centre, double radius, const Colour& colour, double width) {
        out += "<circle" + attribute("cx", centre.x()) + attribute("cy", centre.y()) + attribute("r", radius) + ink(colour, width) + "/>\n";
    }

    void box(const Vector2& corner, const Vector2& size, const Colour& colour, double width) {
        out +=
            "<rect" + attribute("x", corner.x()) + attribute("y", corner.y()) + size_of(size.x(), size.y()) + ink(colour, width) + "/>\n";
    }

    void text(const Vector2& place, const std::string& words, const Colour& colour, const Letters& letters) {
        out += "<text" + attribute("x", place.x()) + attribute("y", place.y()) + attribute("font-size", letters.size) +
               (letters.bold ? " font-weight=\"bold\"" : "") + ink(colour, 0) + " stroke=\"" + css_colour(white) + "\"" +
               attribute("stroke-width", letters.rim) + " stroke-linejoin=\"round\" paint-order=\"stroke\">" + core::base::xml_text(words) +
               "</text>\n";
    }

    template <class Draw>
    void within(const Vector2& corner, const Vector2& size, const Draw& draw) {
        out += "<svg" + attribute("x", corner.x()) + attribute("y", corner.y()) + size_of(size.x(), size.y()) + ">\n";
        draw();
        out += "</svg>\n";
    }

    template <class Draw>
    void group(const char* name, const Draw& draw) {
        out += std::string("<g class=\"") + name + "\">\n";
        draw();
        out += "</g>\n";
    }

    std::string out;

private:
    static std::string ink(const Colour& colour, double width) {
        if (width == 0) return " fill=\"" + css_colour(colour) + "\"";
        return " fill=\"none\" stroke=\"" + css_colour(colour) + "\"" + attribute("stroke-width", width);
    }
};

}  // namespace

std::string svg_text(const Picture& picture) {
    const Image& image = picture.surfaces;
    SvgCanvas canvas;
    canvas.out = "<svg xmlns=\"http://www.w3.org/2000/svg\"" + size_of(image.width, image.height) + " viewBox=\"0 0 " +
                 std::to_string(image.width) + " " + std::to_string(image.height) +
                 "\" font-family=\"'DejaVu Sans', Verdana, sans-serif\">\n";
    put_marks(picture, canvas);
    return canvas.out + "</svg>\n";
}

}  // namespace fettle::design::exports
