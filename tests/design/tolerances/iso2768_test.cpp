// SPDX-License-Identifier: MIT
#include "design/tolerances/iso2768.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <string>

namespace fettle::design::tolerances::iso2768_test {

using design::tolerances::iso2768_angle;
using design::tolerances::iso2768_edge;
using design::tolerances::iso2768_linear;

const std::string classes = "fmcv";

/// Half of the tolerance at the upper end of each step, by class.
struct Row {
    double up_to;  // [mm]
    double half[4];
};

template <class Function>
void check_rows(Function limits, std::initializer_list<Row> rows, double first, double unit) {
    double before = first;  // the least size of the step
    for (const Row& row : rows) {
        for (std::size_t i = 0; i < classes.size(); ++i) {
            CAPTURE(row.up_to, classes[i]);
            for (const double size : {before, row.up_to, std::nextafter(row.up_to, 0.0)}) {
                const auto found = limits(classes.substr(i, 1), size * 1e-3, "");
                REQUIRE(found.has_value() == (row.half[i] > 0));
                if (!found) continue;
                CHECK(found->upper == Approx(row.half[i] * unit).epsilon(1e-14));
                CHECK(found->lower == -found->upper);
            }
        }
        before = row.up_to + 1e-6;
    }
}

TEST_CASE("ISO 2768: linear sizes, broken edges and angles", "[design][tolerances]") {
    check_rows(iso2768_linear,
               {{3, {0.05, 0.1, 0.2, 0}},
                {6, {0.05, 0.1, 0.3, 0.5}},
                {30, {0.1, 0.2, 0.5, 1}},
                {120, {0.15, 0.3, 0.8, 1.5}},
                {400, {0.2, 0.5, 1.2, 2.5}},
                {1000, {0.3, 0.8, 2, 4}},
                {2000, {0.5, 1.2, 3, 6}},
                {4000, {0, 2, 4, 8}}},
               0.5, 1e-3);
    check_rows(iso2768_edge, {{3, {0.2, 0.2, 0.4, 0.4}}, {6, {0.5, 0.5, 1, 1}}, {1e5, {1, 1, 2, 2}}}, 0.5, 1e-3);
    check_rows(iso2768_angle,
               {{10, {60, 60, 90, 180}}, {50, {30, 30, 60, 120}}, {120, {20, 20, 30, 60}}, {400, {10, 10, 15, 30}}, {1e5, {5, 5, 10, 20}}},
               1e-3, std::numbers::pi / 180 / 60);
    CHECK(iso2768_linear("m", 0.03, "")->upper == 0.2e-3);
    CHECK(iso2768_linear("m", std::nextafter(0.03, 1.0), "")->upper == 0.2e-3);  // rounding is no size
}

TEST_CASE("ISO 2768: tolerances grow with the size and the class, those of angles fall with the leg", "[design][tolerances]") {
    for (std::size_t i = 0; i < classes.size(); ++i) {
        double linear = 0, edge = 0, angle = 10;
        for (double size = 0.5; size <= 4000; size *= 1.1) {
            CAPTURE(size, classes[i]);
            const std::string name = classes.substr(i, 1), finer = classes.substr(i > 0 ? i - 1 : 0, 1);
            if (const auto found = iso2768_linear(name, size * 1e-3, "")) {
                CHECK(found->upper >= linear);
                linear = found->upper;
                const auto of_finer = iso2768_linear(finer, size * 1e-3, "");
                if (of_finer) CHECK(of_finer->upper <= linear);
            }
            CHECK(iso2768_edge(name, size * 1e-3, "")->upper >= edge);
            edge = iso2768_edge(name, size * 1e-3, "")->upper;
            CHECK(iso2768_edge(finer, size * 1e-3, "")->upper <= edge);
            CHECK(iso2768_angle(name, size * 1e-3, "")->upper <= angle);
            angle = iso2768_angle(name, size * 1e-3, "")->upper;
            CHECK(iso2768_angle(finer, size * 1e-3, "")->upper <= angle);
        }
    }
}

TEST_CASE("ISO 2768: what the standard does not give is refused by name", "[design][tolerances]") {
    const auto message = [](const Result<DeviationLimits>& found) {
        REQUIRE(!found);
        CHECK(found.errors()[0].where == "here");
        return found.errors()[0].message;
    };
    const auto holds = [](const std::string& text, const char* part) { return text.find(part) != std::string::npos; };
    for (const char* name : {"", "M", "mK", "g", "fm"}) {
        CAPTURE(name);
        for (const auto& function : {iso2768_linear, iso2768_edge, iso2768_angle}) {
            CHECK(holds(message(function(name, 0.01, "here")), "f (fine), m (medium), c (coarse) and v (very coarse)"));
        }
    }
    CHECK(message(iso2768_linear("m", 0.0004, "here")) ==
          "0.4 mm: ISO 2768-1 has no general tolerance below 0.5 mm; give this dimension a tolerance of its own");
    CHECK(holds(message(iso2768_linear("m", -0.01, "here")), "below 0.5 mm"));
    CHECK(holds(message(iso2768_edge("v", 0.0004, "here")), "below 0.5 mm"));
    CHECK(holds(message(iso2768_linear("f", 2.5, "here")),
                "up to 2000 mm; give this dimension a tolerance of its own or choose another class"));
    CHECK(holds(message(iso2768_linear("v", 0.003, "here")), "over 3 up to 4000 mm"));
    CHECK(message(iso2768_linear("c", 4.001, "here")) ==
          "4001 mm: ISO 2768-1 gives class c for sizes up to 4000 mm; give this dimension a tolerance of its own");
    CHECK(holds(message(iso2768_angle("m", 0, "here")), "longer than 0"));
    for (const auto& function : {iso2768_linear, iso2768_edge, iso2768_angle}) {
        for (const double size : {double(NAN), double(INFINITY), -double(INFINITY)}) {
            CHECK(function("m", size, "here").errors()[0].code == ErrorCode::not_finite);
        }
    }
}

}  // namespace fettle::design::tolerances::iso2768_test
