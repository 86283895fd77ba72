// SPDX-License-Identifier: MIT
#include "design/shapes/part_library.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <optional>
#include <random>

#include "core/parts/solid_booleans.hpp"
#include "design/shapes/file_part.hpp"
#include "tests/design/shapes/part_campaign.hpp"
#include "tests/support/solid_oracle.hpp"

namespace fettle::design::shapes::part_library_test {

namespace {

using core::part_files::Counts;
using core::part_files::PartDimension;
using core::part_files::PartFile;
using core::parts::DrawnPart;
using part_campaign::defaults;
using part_campaign::MeshDistance;
using part_campaign::Values;

constexpr double pi = std::numbers::pi;

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

// Are drawn in tens of milliseconds: curves of laws, threads, Booleans.
bool takes_long(const std::string& part) {
    return part.find("gear") != std::string::npos || part.starts_with("plate_cam") || part.starts_with("lead_") ||
           part.starts_with("cone_") || part == "spiral_disc";
}

bool can_be_drawn(const std::string& part) { return core::parts::has_solid_booleans() || !part.starts_with("cone_"); }

// At random dimensions; of those, shares are compared with differences, judged by CGAL, and sampled.
void check_random(const PartFile& file, int count, std::uint32_t seed) {
    std::mt19937 random(seed);
    const int differences = takes_long(file.name()) ? 20 : 2;
    int valid = 0, compared = 0;
    for (int trial = 0; trial < count; ++trial) {
        const Values values = part_campaign::random_values(file, random);
        if (values.empty()) break;
        ++valid;
        INFO(file.name() << ", number " << trial);
        for (std::size_t k = 0; k < values.size(); ++k) UNSCOPED_INFO(file.dimensions()[k].name << " of " << values[k]);
        const auto shape = file.drawn(values);
        if (!shape && shape.errors().front().message.find("undercut") != std::string::npos) continue;  // a cam: no relation says it
        for (const Error& error : shape.errors()) UNSCOPED_INFO(error.where << ": " << error.message);
        CHECK(shape);
        if (!shape) continue;
        if (trial % differences == 0) CHECK(part_campaign::jacobian_fault(file, values, *shape, compared) == "");
        if (trial % 10 == 0) CHECK(tests::support::fault_of_solid(shape->mesh) == "");
        if (trial % 20 == 0) CHECK(part_campaign::deviation_fault(file, values, *shape, 1000, random) == "");
    }
    INFO(file.name());
    CHECK(valid == count);
    CHECK(2 * compared * differences > count * static_cast<int>(file.dimensions().size()));  // or triangles change all the time
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

// The same points, in any order: as far as they can be told apart along some directions.
bool same_points(const Matrix3X& x, const Matrix3X& y) {
    if (x.cols() != y.cols()) return false;
    const auto sorted_along = [](const Matrix3X& points, const Vector3& direction) {
        std::vector<double> out;
        for (Eigen::Index i = 0; i < points.cols(); ++i) out.push_back(direction.dot(points.col(i)));
        std::sort(out.begin(), out.end());
        return out;
    };
    const double tolerance = 1e-9 * x.cwiseAbs().maxCoeff();
    for (const Vector3& direction : {Vector3(0.5, 0.7, 0.3), Vector3(-0.6, 0.4, 0.8), Vector3(0.2, -0.9, 0.5)}) {
        const std::vector<double> a = sorted_along(x, direction), b = sorted_along(y, direction);
        for (std::size_t i = 0; i < a.size(); ++i)
            if (!(std::abs(a[i] - b[i]) <= tolerance)) return false;
    }
    return true;
}

// A part alone at these values, and the part as drawn that is remade there: have they the same facets? Nothing: neither can be made.
struct Remade {
    bool is_same = false;
    std::vector<std::string> other_facets;
};
std::optional<Remade> remade(const FilePart& shape, const Values& values) {
    std::map<std::string, double> given;
    for (std::size_t k = 0; k < values.size(); ++k) given[shape.dimensions()[k].name] = values[k];
    const auto alone = FilePart::create(shape.part(), given, shape.options());
    const auto kept = shape.remade(values);
    if (!alone || !kept) {
        CHECK(alone.has_value() == kept.has_value());
        return std::nullopt;
    }
    const Matrix3X x = description::drawn_mesh(**alone)->vertices, y = kept->mesh.vertices;
    return Remade{same_points(x, y), kept->other_facets};
}

// Each dimension at both ends of its tolerance, and all of them at once.
void check_remade(const std::string& part, const std::vector<double>& shares) {
    const auto shape = *FilePart::create(part);
    const Values drawn = description::drawn_values(*shape);
    for (const double share : shares)
        for (std::size_t k = 0; k <= drawn.size(); ++k) {
            Values values = drawn;
            for (std::size_t i = 0; i < drawn.size(); ++i)
                if (i == k || (k == drawn.size() && (i % 2 == 0) == (share > 0))) values[i] += share * (drawn[i] != 0 ? drawn[i] : 1e-3);
            INFO(part << ", " << (k < drawn.size() ? shape->dimensions()[k].name : "some") << " at " << 1 + share);
            const auto found = remade(*shape, values);
            if (!found) continue;
            for (const std::string& other : found->other_facets) UNSCOPED_INFO(other);
            CHECK(found->is_same == found->other_facets.empty());
        }
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
        if (!can_be_drawn(file.name())) continue;
        const DrawnPart shape = drawn(file, defaults(file));
        int compared = 0;
        if (!takes_long(file.name())) CHECK(part_campaign::jacobian_fault(file, defaults(file), shape, compared) == "");
        for (std::size_t k = 0; k < shape.jacobian.size(); ++k) {  // every dimension moves something
            INFO(file.dimensions()[k].name);
            const bool needs_count = file.name() == "link" && file.dimensions()[k].name == "middle";
            CHECK((needs_count || shape.jacobian[k].squaredNorm() > 0));
        }
    }
}

TEST_CASE("part library: 200 random valid dimensions of every part: solids, exact derivatives, deviations that hold", "[slow]") {
    for (const LibraryPart& each : part_library())
        if (can_be_drawn(std::string(each.name))) check_random(part(std::string(each.name)), 200, 11);
    check_random(part("link", {{"mid_hole", 1}}), 200, 12);
    for (const int slots : {3, 4, 5, 8}) check_random(part("geneva_wheel", {{"slots", slots}}), 50, 13);
}

TEST_CASE("part library: volumes in closed form") {
    // The volume of the mesh is the part's, but for what its facets leave out or add: their area by the chord, at most.
    const auto check = [](const std::string& name, const Counts& counts,
                          const std::function<double(const std::map<std::string, double>&)>& exact) {
        const PartFile file = part(name, counts);
        std::map<std::string, double> values;
        for (const PartDimension& dimension : file.dimensions()) values[dimension.name] = dimension.value;
        const DrawnPart shape = drawn(file, defaults(file), takes_long(name) ? core::parts::Facets{} : fine(1e-6));
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
    check("box", {}, [](auto d) { return d["size_x"] * d["size_y"] * d["size_z"]; });
    check("cylinder", {}, [](auto d) { return pi * std::pow(d["radius"], 2) * d["length"]; });
    check("plate_with_hole", {}, [](auto d) { return (d["size_x"] * d["size_y"] - pi * std::pow(d["hole_radius"], 2)) * d["thickness"]; });
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
    check("screw_boss", {}, [](auto d) {
        const double hole = d["screw_radius"] - d["bite"], mouth = d["screw_radius"] + d["clearance"];
        return pi * (std::pow(d["screw_radius"] + d["wall"], 2) * d["height"] - hole * hole * (d["hole_depth"] - d["mouth_depth"]) -
                     mouth * mouth * d["mouth_depth"]);
    });
    check("spiral_bolt", {}, [](auto d) {
        const double half = d["guide_width"] / 2 - d["clearance"];
        return (2 * half * (d["length"] + d["back"]) - d["nose"] * d["nose"]) * d["bar_thickness"] +
               pi * std::pow(d["pin_radius"], 2) * d["pin_length"];
    });
    // The part of a ball of radius r above z = -a.
    const auto ball_above = [](double r, double a) { return pi * (r * r * (r + a) - (r * r * r + a * a * a) / 3); };
    check("ball_stud", {}, [&](auto d) {
        const double neck = d["neck_radius"], at = std::sqrt(std::pow(d["ball_radius"], 2) - neck * neck);
        return pi * std::pow(d["flange_radius"], 2) * d["flange_thickness"] + pi * neck * neck * (d["neck_length"] - at) +
               ball_above(d["ball_radius"], at);
    });
    check("ball_socket", {}, [&](auto d) {
        const double hollow = d["ball_radius"] + d["clearance"];
        return pi * std::pow(hollow + d["wall"], 2) * (d["grip"] + hollow + d["roof"]) - ball_above(hollow, d["grip"]);
    });
    check("fork_link", {}, [](auto d) {
        const double hole = d["pin_radius"] + d["clearance"], half = hole + d["wall"], throat = d["length"] - half - d["clearance"];
        return (2 * half * d["length"] + pi * half * half - 2 * pi * hole * hole) * 2 * d["tine"] +
               (2 * half * throat + pi * half * half / 2 - pi * hole * hole) * (d["link_thickness"] + 2 * d["clearance"]);
    });
    check("lead_screw", {}, [](auto d) {
        const double per_length = 2 * pi / d["pitch"], rise = d["depth"] / 2 * std::tan(d["flank_angle"]),
                     crest = (d["pitch"] / 4 - rise) * per_length, foot = (d["pitch"] / 4 + rise) * per_length,
                     core = d["radius"] - d["depth"];
        return d["length"] * (core * core * (pi - foot) + std::pow(d["radius"], 2) * crest +
                              (foot - crest) * (core * core + core * d["depth"] + std::pow(d["depth"], 2) / 3));
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

TEST_CASE("part library: a Geneva wheel's tips and slots pass its driver with their clearance") {
    for (const int slots : {3, 6, 8, 12}) {
        for (const double lip : {1e-3, 3e-3}) {
            const PartFile of_wheel = part("geneva_wheel", {{"slots", slots}}), of_driver = part("geneva_driver", {{"slots", slots}});
            Values wheel_values = defaults(of_wheel), driver_values = defaults(of_driver);
            const double c = slots == 3 ? 60e-3 : slots > 8 ? 100e-3 : 40e-3, clearance = wheel_values[2], crank = c * std::sin(pi / slots);
            wheel_values[0] = driver_values[0] = c;
            wheel_values[3] = driver_values[3] = lip;
            wheel_values[5] = driver_values[7] = 2e-3;  // of the shafts
            const DrawnPart wheel = drawn(of_wheel, wheel_values, fine(1e-5)), driver = drawn(of_driver, driver_values, fine(1e-5));
            const Figure low = figure_at(wheel.mesh, 0), high = figure_at(driver.mesh, driver_values[4]);
            const double entry = pi / 2 - pi / slots;
            double least = INFINITY;
            for (int k = -20; k <= 20; ++k) {
                const double t = entry * k / 20, turned = std::atan2(-crank * std::sin(t), c - crank * std::cos(t));
                std::vector<std::array<Vector2, 2>> near_wheel, near_driver;
                for (const auto& line : low.lines) {
                    const Vector2 p = Eigen::Rotation2Dd(turned) * line[0], q = Eigen::Rotation2Dd(turned) * line[1];
                    if ((p - Vector2(c, 0)).norm() < 1.2 * crank) near_wheel.push_back({p, q});
                }
                for (const auto& line : high.lines)
                    near_driver.push_back(
                        {Eigen::Rotation2Dd(pi + t) * line[0] + Vector2(c, 0), Eigen::Rotation2Dd(pi + t) * line[1] + Vector2(c, 0)});
                for (const auto& a : near_wheel)
                    for (const auto& b : near_driver) {
                        least = std::min({least, distance(a[0], b), distance(b[0], a)});
                        if (cross(a, b)) least = -1;
                    }
            }
            INFO(slots << " slots, lips of " << 1e3 * lip << " mm");
            CHECK(least == Approx(clearance).margin(wheel.deviation.in + driver.deviation.in + 1e-9));
        }
    }
}

// Whatever a part may be counted with is drawn, or one of its own relations says why not. Once gears of more than 50 teeth were taken for
// half a million facets.
TEST_CASE("part library: every count from its least to its most is drawn, or refused by a relation of the part") {
    int drawn_ones = 0;
    for (const LibraryPart& each : part_library()) {
        const std::string name(each.name);
        const PartFile as_it_is = part(name);
        for (const core::part_files::PartCount& count : as_it_is.counts()) {
            const int middle = static_cast<int>(std::sqrt(static_cast<double>(std::max(1, count.least)) * count.most));
            for (const int value : {count.least, std::min(count.most, std::max(count.least, middle)), std::min(count.most, 120)}) {
                INFO(name << ", " << value << " " << count.name);
                const auto file = find_part(name, {{count.name, value}});
                REQUIRE(file);
                const auto shape = file->drawn(defaults(*file));
                drawn_ones += shape ? 1 : 0;
                for (const Error& error : shape.errors()) {
                    INFO(error.where << ": " << error.message);
                    CHECK(error.where.find("relations/") != std::string::npos);
                }
            }
        }
    }
    CHECK(drawn_ones > 30);
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

TEST_CASE("part library: an internal Geneva ring lets its pin pass with its clearance") {
    for (const int slots : {3, 4, 6, 8}) {
        const PartFile file = part("internal_geneva_wheel", {{"slots", slots}});
        const Values values = defaults(file);
        const DrawnPart ring = drawn(file, values, fine(2e-6));
        const Figure figure = figure_at(ring.mesh, 0);
        const double c = values[0], crank = c * std::sin(pi / slots), entry = pi / 2 + pi / slots;
        double least = INFINITY;
        for (int k = -20; k <= 20; ++k) {
            const double t = entry * k / 20;  // of the driver, from the line of centres, outwards
            const Vector2 place(c + crank * std::cos(t), crank * std::sin(t));
            const Vector2 p = Eigen::Rotation2Dd(-std::atan2(place.y(), place.x())) * place;
            for (const auto& line : figure.lines) least = std::min(least, distance(p, line));
        }
        INFO(slots);
        CHECK(least == Approx(values[1] + values[2]).margin(ring.deviation.in + 1e-9));
    }
}

TEST_CASE("part library: cams move their followers by their laws") {
    const auto polynomial = [](double x) { return x * x * x * (10 - 15 * x + 6 * x * x); };
    const auto cycloid = [](double x) { return x - std::sin(2 * pi * x) / (2 * pi); };
    const auto modified_sine = [](double x) {
        if (x < 0.125) return (pi * x - std::sin(4 * pi * x) / 4) / (4 + pi);
        if (x > 0.875) return (4 + pi * x - std::sin(4 * pi * x) / 4) / (4 + pi);
        return (2 + pi * x - 9.0 / 4 * std::sin((pi + 4 * pi * x) / 3)) / (4 + pi);
    };
    enum class Follower { roller, flat, knife };
    const auto check = [&](const std::string& name, Follower follower, const std::function<double(double)>& law) {
        const PartFile file = part(name);
        std::map<std::string, double> d;
        for (const PartDimension& dimension : file.dimensions()) d[dimension.name] = dimension.value;
        const DrawnPart cam = drawn(file, defaults(file), fine(1e-5));
        const Figure figure = figure_at(cam.mesh, 0);
        for (int k = 0; k < 48; ++k) {
            const double angle = 2 * pi * (k + 0.3) / 48, falls_at = d["rise"] + d["dwell"];
            const double lift = d["lift"] * (angle < d["rise"]              ? law(angle / d["rise"])
                                             : angle < falls_at             ? 1
                                             : angle < falls_at + d["fall"] ? 1 - law((angle - falls_at) / d["fall"])
                                                                            : 0);
            const Vector2 towards(std::cos(angle), std::sin(angle));
            double found = follower == Follower::roller ? INFINITY : 0;
            for (const auto& line : figure.lines) {
                if (follower == Follower::roller)
                    found = std::min(found, distance((d["base_radius"] + d["roller_radius"] + lift) * towards, line));
                if (follower == Follower::flat) found = std::max({found, line[0].dot(towards), line[1].dot(towards)});
                if (follower == Follower::knife) {  // where the ray leaves the cam
                    const Vector2 normal(-towards.y(), towards.x());
                    const double a = line[0].dot(normal), b = line[1].dot(normal);
                    if (a * b <= 0 && a != b) found = std::max(found, (line[0] + a / (a - b) * (line[1] - line[0])).dot(towards));
                }
            }
            const double wanted = follower == Follower::roller ? d["roller_radius"] : d["base_radius"] + lift;
            INFO(name << " at " << angle * 180 / pi << " degrees");
            CHECK(found == Approx(wanted).margin(2e-5));
        }
    };
    check("plate_cam_345", Follower::roller, polynomial);
    check("plate_cam_cycloidal", Follower::roller, cycloid);
    check("plate_cam_modified_sine", Follower::roller, modified_sine);
    check("plate_cam_345_flat", Follower::flat, polynomial);
    check("plate_cam_345_knife", Follower::knife, polynomial);

    const PartFile file = part("plate_cam_spline");  // the lifts that it is given
    const Values values = defaults(file);
    const DrawnPart cam = drawn(file, values, fine(1e-5));
    const Figure figure = figure_at(cam.mesh, 0);
    for (std::size_t k = 0; k < 12; ++k) {
        const double angle = static_cast<double>(k) * pi / 6, at = values[0] + values[1] + values[2 + k];
        double found = INFINITY;
        for (const auto& line : figure.lines) found = std::min(found, distance({at * std::cos(angle), at * std::sin(angle)}, line));
        INFO(k);
        CHECK(found == Approx(values[1]).margin(2e-5));
    }
}

TEST_CASE("part library: a cam is refused where its roller would undercut it, and says where") {
    const PartFile file = part("plate_cam_345");
    Values values = defaults(file);
    values[2] = 20e-3;          // radius of the roller
    values[3] = 50 * pi / 180;  // rise
    CHECK(file.drawn(values));
    values[2] = 24e-3;
    const auto refused = file.drawn(values);
    REQUIRE_FALSE(refused);
    // The least radius of curvature of the roller's path, from its polar form.
    const double low = values[0] + values[2], lift = values[1], rise = values[3];
    double least = INFINITY, place = 0;
    for (int k = 1; k < 1000; ++k) {
        const double x = k / 1000.0, r = low + lift * x * x * x * (10 - 15 * x + 6 * x * x),
                     first = lift / rise * 30 * x * x * (1 - x) * (1 - x), second = lift / (rise * rise) * 60 * x * (1 - 3 * x + 2 * x * x);
        const double radius = std::pow(r * r + first * first, 1.5) / (r * r + 2 * first * first - r * second);
        if (!(radius > 0 && radius < least)) continue;
        least = radius;
        place = x * 50;
    }
    double said_place = 0, said_radius = 0;
    const std::string& message = refused.errors().front().message;
    INFO(message);
    CHECK(std::sscanf(message.c_str(), "`rise` is undercut at %lf deg", &said_place) == 1);
    CHECK(std::sscanf(message.c_str() + std::min(message.size(), message.find("radius of")), "radius of %lf mm", &said_radius) == 1);
    CHECK(said_place == Approx(place).margin(1));
    CHECK(said_radius == Approx(1e3 * least).margin(0.06));
    CHECK(refused.errors().size() == 1);
}

TEST_CASE("part library: the rollers of a chain come to their seats on a sprocket, and rest in them with its clearance") {
    for (const int teeth : {9, 14, 40}) {
        const PartFile file = part("sprocket", {{"teeth", teeth}});
        Values values = defaults(file);
        const double pitch = values[0], seat = values[1] + values[5], pitch_radius = pitch / 2 / std::sin(pi / teeth);
        const DrawnPart sprocket = drawn(file, values, fine(1e-6));
        const Figure figure = figure_at(sprocket.mesh, 0);
        const auto gap = [&](const Vector2& p) {
            double least = INFINITY;
            for (const auto& line : figure.lines) least = std::min(least, distance(p, line));
            return least;
        };
        const Vector2 here(pitch_radius, 0), next = Eigen::Rotation2Dd(2 * pi / teeth) * here;
        for (int k = 0; k <= 10; ++k) {  // the chain comes off: a roller swings about its neighbour, outwards
            const Vector2 p = next + Eigen::Rotation2Dd(0.1 * k) * Vector2(here - next);
            INFO(teeth << " teeth, " << 0.1 * k << " rad");
            CHECK(gap(p) > seat - 3e-6);
            if (k == 0) CHECK(gap(p) == Approx(seat).margin(3e-6));
        }
    }
}

TEST_CASE("part library: a latch turns off its strike's pin") {
    const PartFile file = part("latch");
    const Values values = defaults(file);
    const DrawnPart latch = drawn(file, values, fine(2e-6));
    const Figure figure = figure_at(latch.mesh, 0);
    for (int k = 0; k <= 20; ++k) {  // of the pin, seen from the latch
        const double angle = -0.02 * k;
        double least = INFINITY;
        for (const auto& line : figure.lines)
            least = std::min(least, distance({values[0] * std::cos(angle), values[0] * std::sin(angle)}, line));
        CHECK(least > values[1] + values[5] - latch.deviation.in - 1e-9);
    }
}

TEST_CASE("part library: a lock box's pins follow their spirals with their clearance") {
    const PartFile file = part("spiral_disc");
    const Values values = defaults(file);
    const DrawnPart disc = drawn(file, values, fine(2e-6));
    const Figure figure = figure_at(disc.mesh, 0);
    for (int k = 0; k <= 20; ++k) {
        const double share = k / 20.0, radius = values[0] + values[1] * share, angle = values[2] * share;
        double least = INFINITY;
        for (const auto& line : figure.lines) least = std::min(least, distance({radius * std::cos(angle), radius * std::sin(angle)}, line));
        CHECK(least == Approx(values[3] + values[4]).margin(1e-5));
    }
}

TEST_CASE("part library: what goes together leaves its clearance, and nothing lies in the other") {
    // b turned about z, then moved along z and x.
    const auto check = [](const DrawnPart& a, DrawnPart b, double turn, const Vector3& move, double clearance) {
        b.mesh.vertices = (Eigen::AngleAxisd(turn, Vector3::UnitZ()).toRotationMatrix() * b.mesh.vertices).colwise() + move;
        const MeshDistance to_a(a.mesh), to_b(b.mesh);
        double least = INFINITY;
        bool inside = false;
        for (Eigen::Index v = 0; v < b.mesh.vertices.cols(); ++v) {
            least = std::min(least, to_a(b.mesh.vertices.col(v)));
            inside = inside || core::solids::point_in_solid(b.mesh.vertices.col(v), a.mesh.vertices, a.mesh.triangles);
        }
        for (Eigen::Index v = 0; v < a.mesh.vertices.cols(); ++v) {
            least = std::min(least, to_b(a.mesh.vertices.col(v)));
            inside = inside || core::solids::point_in_solid(a.mesh.vertices.col(v), b.mesh.vertices, b.mesh.triangles);
        }
        const double facets = std::max(a.deviation.in, a.deviation.out) + std::max(b.deviation.in, b.deviation.out);
        CHECK_FALSE(inside);
        CHECK(least > clearance - facets - 1e-9);
        CHECK(least < clearance + facets + 1e-9);
    };
    const auto with = [](const std::string& name, const core::parts::Facets& facets) {
        const PartFile file = part(name);
        return drawn(file, defaults(file), facets);
    };
    for (const double turn : {0.0, 0.4, -2.0}) {
        INFO("turned by " << turn);
        check(with("ball_stud", fine(5e-6)), with("ball_socket", fine(5e-6)), turn, {0, 0, 0}, 0.2e-3);
        check(with("fork_link", fine(5e-6)), with("link", fine(5e-6)), turn, {40e-3, 0, -2e-3}, 0.2e-3);
        if (can_be_drawn("cone_hinge_leaf"))
            check(with("cone_hinge_leaf", fine(1e-5)), with("cone_hinge_inner_leaf", fine(1e-5)), turn < 0 ? turn : pi + turn, {0, 0, 0},
                  0.3e-3);
        check(with("hinge_leaf", fine(1e-5)), with("hinge_inner_leaf", fine(1e-5)), turn < 0 ? turn : pi + turn, {0, 0, 0}, 0.2e-3);
    }
    // In a section across the axis, a thread's least gap is that of its rounds.
    const DrawnPart screw = with("lead_screw", {}), nut = with("lead_nut", {});
    const Figure of_screw = figure_at(screw.mesh, 0), of_nut = figure_at(nut.mesh, 0);
    double least = INFINITY;
    for (const auto& a : of_screw.lines)
        for (const auto& b : of_nut.lines) {
            CHECK_FALSE(cross(a, b));
            least = std::min({least, distance(a[0], b), distance(b[0], a)});
        }
    CHECK(least == Approx(0.2e-3).margin(4e-5));  // the facets of both take as much
}

TEST_CASE("part library: helical gears of opposite hands mesh from face to face", "[slow]") {
    const PartFile a = part("helical_gear", {{"teeth", 17}}), b = part("helical_gear", {{"teeth", 24}});
    Values values_a = defaults(a), values_b = defaults(b);
    values_b[2] = -values_b[2];
    const DrawnPart drawn_a = drawn(a, values_a), drawn_b = drawn(b, values_b);
    const double module = values_a[0], r_a = module * 17 / 2, r_b = module * 24 / 2, width = values_a[8];
    for (const double height : {0.0, width}) {
        const Figure of_a = figure_at(drawn_a.mesh, height), of_b = figure_at(drawn_b.mesh, height);
        REQUIRE(of_a.lines.size() > 100);
        for (int k = 0; k < 4; ++k) {
            const double angle = 2 * pi / 17 * k / 4, angle_b = pi + pi / 24 - angle * 17 / 24;
            int crossings = 0;
            for (auto l : of_a.lines) {
                for (Vector2& p : l) p = Eigen::Rotation2Dd(angle) * p;
                if ((l[0] - Vector2(r_a, 0)).norm() > 4 * module) continue;
                for (auto m : of_b.lines) {
                    for (Vector2& p : m) p = Eigen::Rotation2Dd(angle_b) * p + Vector2(r_a + r_b, 0);
                    crossings += cross(l, m) ? 1 : 0;
                }
            }
            INFO(height << ", " << k);
            CHECK(crossings == 0);
        }
    }
}

TEST_CASE("part library: what is asked for by a wrong name") {
    CHECK(find_part("geneva_whel").errors().front().message.find("geneva_wheel") != std::string::npos);
    CHECK(find_part("none.part.json").errors().front().code == ErrorCode::file_not_found);
    const auto washer = FilePart::create("washer", {{"shaft_radius", 4e-3}});
    REQUIRE(washer);
    CHECK((*washer)->dimensions().front().value == 4e-3);
    CHECK(FilePart::create("washer", {{"shaft_radios", 4e-3}}).errors().front().where == "washer/shaft_radios");
    const Values values{4e-3, 0.2e-3, 2e-3, 1e-3};
    const auto at = (*washer)->at(values);
    REQUIRE(at);
    CHECK(at->mesh.vertices == (*washer)->mesh(values)->vertices);
    CHECK(at->jacobian.size() == 4);
}

// The ball's arc is 20 segments just: a neck that is thinner makes it 21.
TEST_CASE("library: a part within tolerances is told of the facets that it would have by itself") {
    const auto stud = *FilePart::create("ball_stud");
    Values values = description::drawn_values(*stud);
    CHECK(stud->remade(values)->other_facets.empty());
    values[1] = 2.4875e-3;
    CHECK(stud->remade(values)->other_facets == std::vector<std::string>{"segments of `ball`: 21, not 20"});
    CHECK(stud->mesh(values)->vertices.cols() == stud->mesh(description::drawn_values(*stud))->vertices.cols());
    for (const LibraryPart& part : part_library())
        if (can_be_drawn(std::string(part.name)) && !takes_long(std::string(part.name)))
            check_remade(std::string(part.name), {-0.01, 0.01});
}

TEST_CASE("library: of every part, at both ends of narrow and wide tolerances", "[slow]") {
    for (const LibraryPart& part : part_library())
        if (can_be_drawn(std::string(part.name)))
            check_remade(std::string(part.name), {-0.08, -0.02, -1e-3, -1e-6, 1e-6, 1e-3, 0.02, 0.08});
}

}  // namespace fettle::design::shapes::part_library_test
