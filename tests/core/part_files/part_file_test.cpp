// SPDX-License-Identifier: MIT
#include "core/part_files/part_file.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <numbers>

namespace fettle::core::part_files::part_file_test {

namespace {

// A part of one solid, with some dimensions to name.
std::string part(const std::string& rest) {
    return R"({"fettle_part": 1, "about": "for a test", "units": "mm", "dimensions": {
        "wide": {"value": 20, "about": "along x"}, "high": 10, "tilt": {"value": 30, "kind": "angle"}, "ratio": {"value": 0.5, "kind": "number"},
        "aside": {"value": -3, "kind": "coordinate"}}, "counts": {"holes": {"value": 4, "least": 0, "most": 8}}, )" +
           rest + "}";
}

std::vector<double> defaults(const PartFile& file) {
    std::vector<double> out;
    for (const PartDimension& dimension : file.dimensions()) out.push_back(dimension.value);
    return out;
}

Errors reading_faults(const std::string& text) { return PartFile::parse(text, "a.part.json").errors(); }

bool is_told(const Errors& errors, const std::string& where, const std::string& words) {
    return std::any_of(errors.begin(), errors.end(),
                       [&](const Error& error) { return error.where.ends_with(where) && error.message.find(words) != std::string::npos; });
}

// The area of a profile, drawn 1 mm thick [mm^2]. Arcs count as polygons.
double area(const std::string& profile, const std::string& more = "", double chord = 1e-6) {
    const auto file = PartFile::parse(part(more + R"("solid": {"extrude": )" + profile + R"(, "to": 1})"), "a.part.json");
    for (const Error& error : file.errors()) UNSCOPED_INFO(error.where << ": " << error.message);
    REQUIRE(file);
    parts::Facets facets;
    facets.chord = chord;
    const auto drawn = file->drawn(defaults(*file), facets, {}, {.jacobian = false});
    for (const Error& error : drawn.errors()) UNSCOPED_INFO(error.where << ": " << error.message);
    REQUIRE(drawn);
    double six_volumes = 0;
    const auto& mesh = drawn->mesh;
    for (const auto& t : mesh.triangles)
        six_volumes += mesh.vertices.col(t[0]).dot(Vector3(mesh.vertices.col(t[1])).cross(Vector3(mesh.vertices.col(t[2]))));
    return six_volumes / 6 * 1e9;
}

constexpr double pi = std::numbers::pi;

}  // namespace

TEST_CASE("part file: segments of a circle, where nobody asks for others") {
    const std::string disc = R"("solid": {"extrude": {"circle": 1}, "to": 1})";
    CHECK(PartFile::parse(part(disc), "a.part.json")->facets().segments == 48);
    CHECK(PartFile::parse(part(R"("facets": {"segments": 12}, )" + disc), "a.part.json")->facets().segments == 12);
    CHECK(is_told(reading_faults(part(R"("facets": {"segments": 7}, )" + disc)), "#/facets/segments", "8"));
}

TEST_CASE("part file: an offset that is undercut is cut, or refused where the file says so") {
    const auto drawn = [](const std::string& more) {
        const auto file = PartFile::parse(
            part(R"("solid": {"extrude": {"offset": {"rectangle": [20, 10], "name": "rim"}, "by": -2)" + more + R"(}, "to": 1})"),
            "a.part.json");
        REQUIRE(file);
        return file->drawn(defaults(*file)).errors();
    };
    CHECK(drawn("").empty());
    CHECK(drawn(R"(, "undercut": "cut")").empty());
    CHECK(is_told(drawn(R"(, "undercut": "refused")"), "#/solid/extrude", "`rim` is undercut at"));
    CHECK_FALSE(reading_faults(part(R"("solid": {"extrude": {"offset": {"circle": 3}, "by": -2, "undercut": "no"}, "to": 1})")).empty());
}

TEST_CASE("part file: what it says of itself") {
    const auto file = PartFile::parse(part(R"("solid": {"extrude": {"circle": 1}, "to": 1})"), "some/where/knob.part.json");
    REQUIRE(file);
    CHECK(file->name() == "knob");
    CHECK(file->about() == "for a test");
    REQUIRE(file->dimensions().size() == 5);
    CHECK(file->dimensions()[0].name == "wide");  // as written, not by the alphabet
    CHECK(file->dimensions()[0].about == "along x");
    CHECK(file->dimensions()[0].value == 0.02);
    CHECK(file->dimensions()[2].kind == PartDimensionKind::angle);
    CHECK(file->dimensions()[2].value == Approx(pi / 6));
    CHECK(file->dimensions()[3].value == 0.5);
    CHECK(file->dimensions()[4].value == -0.003);
    REQUIRE(file->counts().size() == 1);
    CHECK(file->counts()[0].value == 4);
    CHECK(PartFile::parse(part(R"("solid": {"extrude": {"circle": 1}, "to": 1})"), "a.part.json", {{"holes", 7}})->counts()[0].value == 7);
}

TEST_CASE("part file: profiles have the area of what they describe") {
    CHECK(area(R"({"rectangle": ["= wide", "= high"]})") == Approx(200));
    CHECK(area(R"({"rectangle": ["2cm", 10], "corner": ["= aside", 0]})") == Approx(200));
    CHECK(area(R"({"circle": "= wide / 2", "centre": {"polar": [5, "= tilt"]}})") == Approx(100 * pi).epsilon(1e-3));
    CHECK(area(R"({"polygon": [[0, 0], ["= wide", 0], [0, "= high"]]})") == Approx(100));
    CHECK(area(R"({"slot": [[0, 0], ["= wide", 0]], "radius": 3})") == Approx(120 + 9 * pi).epsilon(1e-3));
    CHECK(
        area(R"({"path": [[0, 0], ["= wide", 0], {"arc_to": ["= wide", "= high"], "centre": ["= wide", "= high / 2"]}, [0, "= high"]]})") ==
        Approx(200 + 12.5 * pi).epsilon(1e-3));
    CHECK(area(R"({"path": [[0, 0], ["= wide", 0], {"arc_to": ["= wide", "= high"], "bulge": 1}, [0, "= high"]]})") ==
          Approx(200 + 12.5 * pi).epsilon(1e-3));
    CHECK(area(R"({"path": [[0, 0], ["= wide", 0], {"to": ["= wide", "= high"], "round": 2}, {"to": [0, "= high"], "chamfer": 2}]})") ==
          Approx(200 - (4 - pi) - 2).epsilon(1e-3));
    CHECK(area(R"j({"law": {"t": [0, "360deg"], "x": "= wide * cos(t)", "y": "= high * sin(t)"}})j") == Approx(200 * pi).epsilon(2e-3));
    CHECK(area(R"j({"law": {"t": [0, "360deg"], "radius": "= wide + aside * cos(2 * t)"}})j") == Approx(pi * (400 + 4.5)).epsilon(2e-3));
    CHECK(area(R"({"holes": {"repeat": {"circle": 1, "centre": [6, 0]}, "count": "= holes"}, "in": {"circle": 10}})") ==
          Approx(96 * pi).epsilon(2e-3));
    CHECK(area(R"({"holes": {"repeat": {"circle": 1}, "count": 0}, "in": {"circle": 10}})") == Approx(100 * pi).epsilon(1e-3));
    CHECK(area(R"({"round": {"rectangle": [20, 10]}, "radius": 2})") == Approx(200 - 4 * (4 - pi)).epsilon(1e-3));
    CHECK(area(R"({"chamfer": {"rectangle": [20, 10]}, "by": 2})") == Approx(192));
    CHECK(area(R"({"mirror": {"move": {"turn": "it", "by": "= tilt", "about": [1, 2]}, "by": [30, "= aside"]}, "across": "y"})",
               R"("profiles": {"it": {"rectangle": [20, 10]}}, )") == Approx(200));
    CHECK(area(R"({"together": [{"repeat": {"circle": 1}, "count": 3, "step": [4, 0]}]})") == Approx(3 * pi).epsilon(1e-3));
    // A wheel of three teeth as one path: each is half of a square on the circle's chord.
    CHECK(area(R"({"path": [{"polar": [10, 0]}, {"repeat": [{"polar": [20, "60deg"]}, {"polar": [10, "120deg"]}], "count": 3}]})") ==
          Approx(6 * 0.5 * 200 * std::sin(pi / 3)));
}

TEST_CASE("part file: faults of the file, with place and remedy") {
    CHECK(is_told(reading_faults("{}"), "#", "`fettle_part` is missing"));
    CHECK(is_told(reading_faults(R"({"fettle_part": 2})"), "/fettle_part", "1"));
    CHECK(is_told(reading_faults(part(R"("solod": 1, "solid": {"extrude": {"circle": 1}, "to": 1})")), "/solod", "`solid`"));
    CHECK(is_told(reading_faults(part(R"("solid": {"extrud": {"circle": 1}, "to": 1})")), "/solid", "did you mean `extrude`"));
    CHECK(is_told(reading_faults(part(R"("solid": {"extrude": {"circel": 1}, "to": 1})")), "/solid/extrude", "did you mean `circle`"));
    CHECK(
        is_told(reading_faults(part(R"("solid": {"extrude": {"circle": 1, "center": [0, 0]}, "to": 1})")), "/extrude/center", "`centre`"));
    CHECK(is_told(reading_faults(part(R"("solid": {"extrude": {"circle": "= wied"}, "to": 1})")), "/extrude/circle", "`wide`"));
    CHECK(is_told(reading_faults(part(R"("solid": {"extrude": {"circle": "= tilt"}, "to": 1})")), "/extrude/circle", "an angle"));
    CHECK(is_told(reading_faults(part(R"("solid": {"extrude": "rign", "to": 1}, "profiles": {"ring": {"circle": 1}})")), "/solid/extrude",
                  "`ring`"));
    CHECK(is_told(reading_faults(part(R"("solid": {"extrude": {"circle": 1, "slot": 2}, "to": 1})")), "/solid/extrude",
                  "`circle` and `slot`"));
    CHECK(is_told(reading_faults(part(R"("solid": {"extrude": {"path": [[0, 0], {"arcto": [1, 1]}]}, "to": 1})")), "/path/1", "`arc_to`"));
    CHECK(is_told(reading_faults(part(R"("relations": [{"check": "wide"}], "solid": {"sphere": 1})")), "/relations/0/check", "a < b"));
    CHECK(is_told(reading_faults(part(R"("relations": [{"check": "wide < tilt"}], "solid": {"sphere": 1})")), "/check",
                  "cannot be compared"));
    CHECK(is_told(reading_faults(part(R"("variables": {"wide": "= high"}, "solid": {"sphere": 1})")), "/variables/wide", "unique"));
    CHECK(is_told(reading_faults(part(R"("solid": {"extrude": {"repeat": {"circle": 1}, "count": "= ratio"}, "to": 1})")), "/count",
                  "counts alone"));
    CHECK(is_told(PartFile::parse(part(R"("solid": {"sphere": 1})"), "a.part.json", {{"hols", 3}}).errors(), "counts/hols", "`holes`"));
    CHECK(
        is_told(PartFile::parse(part(R"("solid": {"sphere": 1})"), "a.part.json", {{"holes", 9}}).errors(), "counts/holes", "from 0 to 8"));
}

TEST_CASE("part file: relations hold in the designer's words") {
    const auto file = PartFile::parse(part(R"("relations": [{"check": "high + aside < wide / 2 <= 12", "or": "it falls over"},
                              {"check": "ratio < 0", "or": "never", "when": "holes > 5"}], "solid": {"extrude": {"circle": 1}, "to": 1})"),
                                      "a.part.json");
    REQUIRE(file);
    std::vector<double> values = defaults(*file);
    CHECK(file->faults(values).empty());
    values[1] = 14e-3;
    const Errors faults = file->faults(values);
    REQUIRE(faults.size() == 1);
    CHECK(faults[0].where == "a.part.json#/relations/0");
    CHECK(faults[0].message == "`high + aside < wide / 2 <= 12` must hold, or it falls over; here it would be 11 mm < 10 mm <= 12 mm");
    values[1] = -1;
    CHECK(is_told(file->faults(values), "a/high", "above 0 mm"));
    values[1] = std::nan("");
    CHECK(is_told(file->faults(values), "a/high", "finite"));
}

TEST_CASE("part file: what asks for too much, or for itself, ends") {
    const auto fault_of_drawing = [](const std::string& rest) {
        const auto file = PartFile::parse(part(rest), "a.part.json");
        for (const Error& error : file.errors()) UNSCOPED_INFO(error.where << ": " << error.message);
        REQUIRE(file);
        const auto drawn = file->drawn(defaults(*file));
        REQUIRE_FALSE(drawn);
        return drawn.errors().front().message;
    };
    CHECK(fault_of_drawing(
              R"("profiles": {"a": {"move": "b", "by": [1, 0]}, "b": {"move": "a", "by": [1, 0]}}, "solid": {"extrude": "a", "to": 1})")
              .find("made of itself") != std::string::npos);
    CHECK(fault_of_drawing(R"("profiles": {"a": {"together": ["a", "a"]}}, "solid": {"extrude": "a", "to": 1})").find("made of itself") !=
          std::string::npos);
    const std::string thousand = R"({"repeat": {"circle": 0.001}, "count": 1000, "step": [0.01, 0]})";
    CHECK(fault_of_drawing(R"("solid": {"extrude": {"together": [{"repeat": {"together": [)" + thousand +
                           R"(]}, "count": 1000, "step": [0, 0.01]}]}, "to": 1})")
              .find("at most 100000") != std::string::npos);
    // Before what is too large is put together: a union of unions of twice as much, copies of copies of copies.
    const std::string few = R"("facets": {"segments": 12}, )";
    std::string doubled = R"("s0": {"sphere": 1})";
    for (int k = 1; k < 60; ++k)
        doubled += ", \"s" + std::to_string(k) + R"(": {"union": ["s)" + std::to_string(k - 1) + R"(", {"move": "s)" +
                   std::to_string(k - 1) + R"(", "by": [)" + std::to_string(3LL << std::min(k, 40)) + ", 0, 0]}]}";
    CHECK(fault_of_drawing(few + R"("solids": {)" + doubled + R"(}, "solid": "s59")").find("at most 500000 are drawn") !=
          std::string::npos);
    CHECK(fault_of_drawing(few + R"("solid": {"repeat": {"repeat": {"repeat": {"sphere": 1}, "count": 100, "step": [3, 0, 0]}, "count": 100,
        "step": [0, 3, 0]}, "count": 100, "step": [0, 0, 3]})")
              .find("at most 500000 are drawn") != std::string::npos);
    for (const char* round : {R"({"sphere": 1e6})", R"({"torus": [1e6, 1e5]})"})
        CHECK(fault_of_drawing(R"("facets": {"chord": 1e-8}, "solid": )" + std::string(round)).find("at most 500000 are drawn") !=
              std::string::npos);
    // A chord that is kept by no number of facets that are drawn.
    const std::string fine = R"("facets": {"chord": "1e-12mm"}, "solid": )";
    for (const char* round : {R"({"extrude": {"circle": 3}, "to": 5})", R"({"cone": [3, 0], "height": 5})",
                              R"({"revolve": {"rectangle": [4, 1], "corner": [0, 0]}})"})
        CHECK(fault_of_drawing(fine + round).find("at most 500000 are drawn") != std::string::npos);
    CHECK(fault_of_drawing(fine + R"({"extrude": {"spline": [[0, 0], [9, 1], [3, 8]]}, "to": 5})").find("take a larger chord") !=
          std::string::npos);
    CHECK(fault_of_drawing(R"("solid": {"repeat": {"sphere": 1}, "count": 3, "axis": [0, 0, 0]})").find("an axis has a direction") !=
          std::string::npos);
    CHECK(fault_of_drawing(R"("solid": {"extrude": {"circle": "= wide * 1e30 * 1e30"}, "to": 1})").find("farther away than 1e30 m") !=
          std::string::npos);
    std::string nested = R"({"circle": 1})";
    for (int k = 0; k < 60; ++k) nested = R"({"move": )" + nested + R"(, "by": [0, 0]})";
    CHECK(reading_faults(part(R"("solid": {"extrude": )" + nested + R"(, "to": 1})")).empty());
    CHECK(is_told(reading_faults(part(R"("solid": {"extrude": {"repeat": {"circle": 1}, "count": 1e9}, "to": 1})")), "/count", "10000"));
}

}  // namespace fettle::core::part_files::part_file_test
