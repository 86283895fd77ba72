// SPDX-License-Identifier: MIT
#include "fettle/design/shapes/part_library.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <random>

#include "fettle/design/shapes/file_part.hpp"

namespace fettle::design::shapes::part_library_test {

namespace {

using core::part_files::Counts;
using core::part_files::PartDimension;
using core::part_files::PartFile;
using core::parts::DrawnPart;
using Values = std::vector<double>;

constexpr double pi = std::numbers::pi;

Values defaults(const PartFile& file) {
    Values out;
    for (const PartDimension& dimension : file.dimensions()) out.push_back(dimension.value);
    return out;
}

core::parts::Facets fine(double chord) {
    core::parts::Facets out;
    out.chord = chord;
    return out;
}

DrawnPart drawn(const PartFile& file, const Values& values, const core::parts::Facets& facets = {}) {
    const Result<DrawnPart> part = file.drawn(values, facets);
    INFO(file.name());
    for (const Error& error : part.errors()) UNSCOPED_INFO(error.where << ": " << error.message);
    REQUIRE(part);
    return *part;
}

// Central differences, where the triangles are the same on either side.
void check_jacobian(const PartFile& file, const Values& values, const DrawnPart& part) {
    REQUIRE(part.jacobian.size() == values.size());
    for (std::size_t k = 0; k < values.size(); ++k) {
        const double step = std::max(1e-8, 1e-5 * std::abs(values[k]));
        Values low = values, high = values;
        low[k] -= step;
        high[k] += step;
        const auto below = file.drawn(low, {}, part.structure, {.jacobian = false, .check = false}),
                   above = file.drawn(high, {}, part.structure, {.jacobian = false, .check = false});
        if (!below || !above || !below->changes.empty() || !above->changes.empty()) continue;
        REQUIRE(below->mesh.vertices.cols() == part.mesh.vertices.cols());
        REQUIRE(above->mesh.vertices.cols() == part.mesh.vertices.cols());
        const Matrix3X difference = (above->mesh.vertices - below->mesh.vertices) / (2 * step);
        const double scale = 1 + part.jacobian[k].cwiseAbs().maxCoeff();
        INFO(file.name() << ", " << file.dimensions()[k].name << " of " << values[k]);
        CHECK((difference - part.jacobian[k]).cwiseAbs().maxCoeff() < 1e-7 * scale);
    }
}

// Random dimensions about the defaults, those that the relations allow.
void check_random(const PartFile& file, int count, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> factor(0.6, 1.4);
    int valid = 0;
    for (int trial = 0; trial < 40 * count && valid < count; ++trial) {
        Values values = defaults(file);
        for (double& value : values) value *= factor(random);
        if (!file.faults(values).empty()) continue;
        ++valid;
        check_jacobian(file, values, drawn(file, values));
    }
    INFO(file.name());
    CHECK(valid == count);
}

double volume(const core::geometry::Mesh& mesh) {
    double six = 0;
    for (const auto& t : mesh.triangles)
        six += mesh.vertices.col(t[0]).dot(Vector3(mesh.vertices.col(t[1])).cross(Vector3(mesh.vertices.col(t[2]))));
    return six / 6;
}

// The outline in the plane z = height: pieces of it and of the triangles within, which lie in the material.
struct Figure {
    std::vector<std::array<Vector2, 2>> lines;
};
Figure figure_at(const core::geometry::Mesh& mesh, double height) {
    Figure out;
    for (const auto& t : mesh.triangles)
        for (int i = 0; i < 3; ++i) {
            const Vector3 a = mesh.vertices.col(t[i]), b = mesh.vertices.col(t[(i + 1) % 3]);
            if (std::abs(a.z() - height) < 1e-9 && std::abs(b.z() - height) < 1e-9) out.lines.push_back({a.head<2>(), b.head<2>()});
        }
    return out;
}

double distance(const Vector2& p, const std::array<Vector2, 2>& line) {
    const Vector2 d = line[1] - line[0];
    return (line[0] + std::clamp((p - line[0]).dot(d) / d.squaredNorm(), 0.0, 1.0) * d - p).norm();
}

bool cross(const std::array<Vector2, 2>& a, const std::array<Vector2, 2>& b) {
    const auto side = [](const std::array<Vector2, 2>& l, const Vector2& p) {
        const Vector2 d = l[1] - l[0], e = p - l[0];
        return d.x() * e.y() - d.y() * e.x();
    };
    return side(a, b[0]) * side(a, b[1]) < 0 && side(b, a[0]) * side(b, a[1]) < 0;
}

PartFile part(const std::string& name, const Counts& counts = {}) {
    auto file = find_part(name, counts);
    for (const Error& error : file.errors()) UNSCOPED_INFO(error.where << ": " << error.message);
    REQUIRE(file);
    return *file;
}

}  // namespace

TEST_CASE("part library: every part says what it is, is a solid as it stands, and its derivative is exact") {
    CHECK(part_library().size() >= 10);
    for (const LibraryPart& each : part_library()) {
        const PartFile file = part(std::string(each.name));
        INFO(each.name);
        CHECK_FALSE(file.about().empty());
        for (const PartDimension& dimension : file.dimensions()) {
            INFO(dimension.name);
            CHECK_FALSE(dimension.about.empty());
        }
        for (const auto& count : file.counts()) CHECK_FALSE(count.about.empty());
        for (const auto& relation : file.relations()) CHECK_FALSE(relation.otherwise.empty());
        CHECK(file.faults(defaults(file)).empty());
        const DrawnPart shape = drawn(file, defaults(file));
        const bool takes_long =
            each.name == "spur_gear" || each.name == "ring_gear" || each.name.starts_with("plate_cam");  // laws: in the slow test
        if (!takes_long) check_jacobian(file, defaults(file), shape);
        for (std::size_t k = 0; k < shape.jacobian.size(); ++k) {  // every dimension moves something
            INFO(file.dimensions()[k].name);
            const bool needs_count = file.name() == "link" && file.dimensions()[k].name == "middle";
            CHECK((needs_count || shape.jacobian[k].squaredNorm() > 0));
        }
    }
}

TEST_CASE("part library: 200 random valid dimensions of every part", "[slow]") {
    for (const LibraryPart& each : part_library()) check_random(part(std::string(each.name)), 200, 11);
    check_random(part("link", {{"mid_hole", 1}}), 200, 12);
    for (const int slots : {3, 4, 5, 8}) check_random(part("geneva_wheel", {{"slots", slots}}), 50, 13);
}

TEST_CASE("part library: volumes in closed form") {
    // The volume of the mesh is that of the part but for what its facets leave out or add: their area by the chord, at most.
    const auto check = [](const std::string& name, const Counts& counts,
                          const std::function<double(const std::map<std::string, double>&)>& exact) {
        const PartFile file = part(name, counts);
        std::map<std::string, double> values;
        for (const PartDimension& dimension : file.dimensions()) values[dimension.name] = dimension.value;
        const DrawnPart shape = drawn(file, defaults(file), fine(1e-6));
        double surface = 0;
        for (const auto& t : shape.mesh.triangles) {
            const Vector3 a = shape.mesh.vertices.col(t[0]), b = shape.mesh.vertices.col(t[1]), c = shape.mesh.vertices.col(t[2]);
            surface += (b - a).cross(c - a).norm() / 2;
        }
        INFO(name);
        CHECK(std::abs(volume(shape.mesh) - exact(values)) < surface * std::max(shape.deviation.in, shape.deviation.out));
    };
    check("washer", {}, [](auto d) {
        const double r = d["shaft_radius"] + d["clearance"];
        return pi * (std::pow(r + d["wall"], 2) - r * r) * d["thickness"];
    });
    check("plate", {{"columns", 0}},
          [](auto d) { return (d["length"] * d["width"] - (4 - pi) * std::pow(d["corner_radius"], 2)) * d["thickness"]; });
    check("plate", {}, [](auto d) {
        return (d["length"] * d["width"] - (4 - pi) * std::pow(d["corner_radius"], 2) -
                4 * pi * std::pow(d["pin_radius"] + d["clearance"], 2)) *
               d["thickness"];
    });
    check("slotted_link", {}, [](auto d) {
        const double r = d["pin_radius"] + d["clearance"], outer = r + d["wall"], far = d["slot_start"] + d["travel"] + d["clearance"];
        const double slot = d["travel"] + 2 * d["clearance"];
        return (pi * outer * outer + 2 * outer * far - 2 * pi * r * r - 2 * r * slot) * d["thickness"];
    });
    check("eccentric", {},
          [](auto d) { return pi * (std::pow(d["radius"], 2) - std::pow(d["shaft_radius"] + d["clearance"], 2)) * d["thickness"]; });
    check("pin", {}, [](auto d) {
        const double r = d["bore_radius"] - d["clearance"], top = r - d["chamfer"];
        return pi * (std::pow(d["head_radius"], 2) * d["head_thickness"] + r * r * (d["length"] - d["chamfer"]) +
                     (r * r + r * top + top * top) / 3 * d["chamfer"]);
    });
    check("shaft", {}, [](auto d) {
        const double r = d["radius"], half = std::acos((r - d["flat_depth"]) / r);
        const double segment = r * r * (half - std::sin(half) * std::cos(half));
        return pi * r * r * d["length"] - segment * d["flat_length"];
    });
}

TEST_CASE("part library: a Geneva wheel lets its pin pass with its clearance") {
    for (const int slots : {3, 4, 5, 6, 8}) {
        const PartFile file = part("geneva_wheel", {{"slots", slots}});
        Values values = defaults(file);
        if (slots == 3) values[5] = 2e-3;  // the slots of a wheel of three are deep
        for (const Error& error : file.faults(values)) UNSCOPED_INFO(error.message);
        REQUIRE(file.faults(values).empty());
        const DrawnPart wheel = drawn(file, values, fine(2e-6));
        const Figure figure = figure_at(wheel.mesh, 0);
        const double c = values[0], crank = c * std::sin(pi / slots), pin = values[1], clearance = values[2];
        double least = INFINITY;
        const double entry = pi / 2 - pi / slots;  // of the driver, from the line of centres
        for (int k = -20; k <= 20; ++k) {
            const double t = entry * k / 20, turned = std::atan2(crank * std::sin(t), c - crank * std::cos(t));
            // In the wheel's frame the pin lies along the slot.
            const Vector2 place(c - crank * std::cos(t), crank * std::sin(t));
            const Vector2 p = Eigen::Rotation2Dd(-turned) * place;
            for (const auto& line : figure.lines) least = std::min(least, distance(p, line));
        }
        INFO(slots);
        CHECK(least == Approx(pin + clearance).margin(wheel.deviation.in + 1e-9));
    }
}

TEST_CASE("part library: gears mesh over a pitch, and their play is the backlash of both", "[slow]") {
    struct Pair {
        int teeth_a, teeth_b;
        double shift;
    };
    for (const Pair& pair : {Pair{20, 33, 0}, Pair{14, 25, 0.35}}) {
        const PartFile a = part("spur_gear", {{"teeth", pair.teeth_a}}), b = part("spur_gear", {{"teeth", pair.teeth_b}});
        Values values_a = defaults(a), values_b = defaults(b);
        values_a[2] = pair.shift;  // what one gains in the shift the other loses: the centre distance stays
        values_b[2] = -pair.shift;
        values_a[8] = values_b[8] = 2e-3;
        const Figure of_a = figure_at(drawn(a, values_a, fine(1e-6)).mesh, 0), of_b = figure_at(drawn(b, values_b, fine(1e-6)).mesh, 0);
        const double module = values_a[0], r_a = module * pair.teeth_a / 2, r_b = module * pair.teeth_b / 2,
                     play = values_a[3] + values_b[3];
        const auto clash = [&](double angle_a, double extra) {
            // A tooth of a towards b, a gap of b towards a, then rolled; b turned on by `extra` of arc.
            const double angle_b = pi + pi / pair.teeth_b - angle_a * pair.teeth_a / pair.teeth_b + extra / r_b;
            const auto placed = [](const Figure& figure, double angle, const Vector2& at, const Vector2& near, double within) {
                std::vector<std::array<Vector2, 2>> out;
                for (const auto& line : figure.lines) {
                    const Vector2 p = Eigen::Rotation2Dd(angle) * line[0] + at, q = Eigen::Rotation2Dd(angle) * line[1] + at;
                    if ((p - near).norm() < within) out.push_back({p, q});
                }
                return out;
            };
            const Vector2 pitch_point(r_a, 0);
            const auto lines_a = placed(of_a, angle_a, Vector2::Zero(), pitch_point, 4 * module),
                       lines_b = placed(of_b, angle_b, Vector2(r_a + r_b, 0), pitch_point, 4 * module);
            for (const auto& l : lines_a)
                for (const auto& m : lines_b)
                    if (cross(l, m)) return true;
            return false;
        };
        for (int k = 0; k < 8; ++k) {
            const double angle = 2 * pi / pair.teeth_a * k / 8;
            INFO(pair.teeth_a << " and " << pair.teeth_b << " teeth, step " << k);
            CHECK_FALSE(clash(angle, 0));
            CHECK_FALSE(clash(angle, 0.45 * play));
            CHECK_FALSE(clash(angle, -0.45 * play));
            CHECK(clash(angle, 0.6 * play));
            CHECK(clash(angle, -0.6 * play));
        }
    }
}

TEST_CASE("part library: what is asked for by a wrong name") {
    CHECK(find_part("geneva_whel").errors().front().message.find("geneva_wheel") != std::string::npos);
    CHECK(find_part("none.part.json").errors().front().code == ErrorCode::file_not_found);
    const auto washer = FilePart::create(part("washer"), {{"shaft_radius", 4e-3}});
    REQUIRE(washer);
    CHECK((*washer)->dimensions().front().value == 4e-3);
    CHECK(FilePart::create(part("washer"), {{"shaft_radios", 4e-3}}).errors().front().where == "washer/shaft_radios");
    const Values values{4e-3, 0.2e-3, 2e-3, 1e-3};
    const auto at = (*washer)->at(values);
    REQUIRE(at);
    CHECK(at->mesh.vertices == (*washer)->mesh(values)->vertices);
    CHECK(at->jacobian.size() == 4);
}

}  // namespace fettle::design::shapes::part_library_test
