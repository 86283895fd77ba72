// SPDX-License-Identifier: MIT
#include "design/exports/profile_drawing.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <sstream>

#include "core/parts/profile_booleans.hpp"
#include "design/shapes/part_library.hpp"

namespace fettle::design::exports::profile_drawing_test {

namespace {

// What a machine makes of a DXF: its area [mm^2], arcs with their caps, and how many circles and loops there are.
struct Cut {
    double area = 0;
    int circles = 0, loops = 0, arcs = 0, points = 0;
};

Cut read_dxf(const std::string& text) {
    Cut out;
    std::istringstream lines(text);
    std::string code, value, entity;
    struct Knot {
        double x = 0, y = 0, bulge = 0;
    };
    std::vector<Knot> knots;
    double radius = 0;
    bool is_hole = false;
    const auto end_entity = [&] {
        if (entity == "CIRCLE") {
            out.area += (is_hole ? -1 : 1) * M_PI * radius * radius;
            ++out.circles;
        }
        if (entity == "SEQEND") {
            double twice = 0;
            for (std::size_t k = 0; k < knots.size(); ++k) {
                const Knot &a = knots[k], &b = knots[(k + 1) % knots.size()];
                twice += a.x * b.y - a.y * b.x;
                if (a.bulge == 0) continue;
                const double chord = std::hypot(b.x - a.x, b.y - a.y), sweep = 4 * std::atan(a.bulge);
                const double r = chord / (2 * std::sin(std::abs(sweep) / 2));
                twice += r * r * (sweep - std::sin(sweep));
                ++out.arcs;
            }
            out.area += twice / 2;
            out.points += count_of(knots);
            ++out.loops;
            knots.clear();
        }
    };
    while (std::getline(lines, code) && std::getline(lines, value)) {
        const int group = std::stoi(code);
        if (group == 0) {
            end_entity();
            entity = value;
            if (entity == "VERTEX") knots.emplace_back();
        }
        if (group == 8) is_hole = value == "hole";
        if (group == 40) radius = std::stod(value);
        if (entity != "VERTEX") continue;
        if (group == 10) knots.back().x = std::stod(value);
        if (group == 20) knots.back().y = std::stod(value);
        if (group == 42) knots.back().bulge = std::stod(value);
    }
    end_entity();
    return out;
}

// f(profile, drawing) of a part of the library, at the values of its file.
void with_profile(const char* part, const char* profile, const std::function<void(const core::parts::Profile&)>& use) {
    const auto file = shapes::find_part(part, {});
    REQUIRE(file);
    std::vector<double> values;
    for (const auto& dimension : file->dimensions()) values.push_back(dimension.value);
    const Errors errors = file->with_profile(profile, values, use);
    for (const Error& error : errors) UNSCOPED_INFO(error.where << ": " << error.message);
    REQUIRE(errors.empty());
}

}  // namespace

TEST_CASE("a DXF encloses the area of the figure: arcs are arcs, whole circles circles") {
    for (const auto& [part, profile] : {std::pair("washer", "ring"), {"geneva_wheel", "wheel_with_bore"}, {"spur_gear", "gear"}}) {
        with_profile(part, profile, [&](const core::parts::Profile& figure) {
            const Cut cut = read_dxf(profile_dxf(figure, 1e-6));
            CAPTURE(cut.area, cut.loops, cut.arcs);
            CHECK(cut.area == Approx(1e6 * core::parts::area(figure).value).epsilon(1e-4));
            CHECK(cut.circles + cut.loops == count_of(figure.loops));
            CHECK(cut.circles >= 1);  // the bore
        });
    }
    with_profile("geneva_wheel", "wheel", [](const core::parts::Profile& figure) {
        const Cut cut = read_dxf(profile_dxf(figure));
        CHECK(cut.area == Approx(1e6 * core::parts::area(figure).value).epsilon(1e-7));  // nothing but lines and arcs, written to 1e-6 mm
        CHECK(cut.arcs == 6 * 4);
        CHECK(cut.points == 6 * 6);
    });
}

TEST_CASE("an SVG has the figure's size in millimetres, and its arcs") {
    with_profile("washer", "ring", [](const core::parts::Profile& figure) {
        const std::string text = profile_svg(figure);
        double radius = 0;
        for (const auto& loop : figure.loops)
            for (const auto& segment : loop.segments) radius = std::max(radius, std::get<core::parts::Arc>(segment.curve).radius.value);
        std::ostringstream size;
        size << "width=\"" << 2000 * radius << "mm\"";
        CHECK(text.find(size.str()) != std::string::npos);
        CHECK(text.find("A") != std::string::npos);
        CHECK(text.find("L") == std::string::npos);
        CHECK(text.find("nan") == std::string::npos);
    });
    with_profile("spur_gear", "gear", [](const core::parts::Profile& figure) {
        const std::string coarse = profile_svg(figure, 1e-4), fine = profile_svg(figure, 1e-6);
        CHECK(fine.size() > coarse.size());
    });
}

}  // namespace fettle::design::exports::profile_drawing_test
