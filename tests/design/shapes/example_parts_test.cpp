// SPDX-License-Identifier: MIT
// The parts of the examples, as files beside their scenes: solids of the volume that closed forms say, exact derivatives, relations.
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <numbers>
#include <random>

#include "core/geometry/mass_moments.hpp"
#include "core/solids/mesh_validity.hpp"
#include "design/shapes/file_part.hpp"
#include "design/shapes/part_library.hpp"
#include "tests/design/shapes/example_parts.hpp"
#include "tests/design/shapes/part_campaign.hpp"

namespace fettle::design::shapes::example_parts_test {

namespace {

using core::geometry::Mesh;
using core::parts::DrawnPart;
using part_campaign::PartFile;
using tests::design_support::can_be_drawn;
using tests::design_support::example_part;
using tests::design_support::example_parts;
using Named = std::map<std::string, double>;

PartFile file_of(const std::string& name) { return find_part(example_part(name)).value(); }

std::vector<double> values_of(const PartFile& file, const Named& changes = {}) {
    std::vector<double> values;
    std::size_t used = 0;
    for (const auto& dimension : file.dimensions()) {
        const auto change = changes.find(dimension.name);
        used += change == changes.end() ? 0 : 1;
        values.push_back(change == changes.end() ? dimension.value : change->second);
    }
    REQUIRE(used == changes.size());
    return values;
}

Named named(const PartFile& file, const std::vector<double>& values) {
    Named out;
    for (std::size_t k = 0; k < values.size(); ++k) out[file.dimensions()[k].name] = values[k];
    return out;
}

double volume(const Mesh& mesh) { return core::geometry::solid_moments(mesh.vertices, mesh.triangles)(3, 3); }

// Cross-section of an inscribed and of a circumscribed circle.
double inscribed(int n, double radius) { return n / 2.0 * std::sin(2 * std::numbers::pi / n) * radius * radius; }
double circumscribed(int n, double radius) { return n * std::tan(std::numbers::pi / n) * radius * radius; }

// Areas of facets within the material.
double pin_area(int n, double radius) { return inscribed(n, radius); }
double bore_area(int n, double radius) { return circumscribed(n, radius); }

double arm_volume(const Named& v, int n) {
    const auto d = [&](const char* name) { return v.at(name); };
    const double ends = (pin_area(n, d("journal_end_radius")) + pin_area(n, d("pin_end_radius"))) / 2;
    const double bar = ends + (d("journal_end_radius") + d("pin_end_radius")) * d("arm_length");
    return bar * d("bar_thickness") + (pin_area(n, d("shoulder_radius")) + pin_area(n, d("foot_radius"))) * d("shoulder_height") +
           pin_area(n, d("journal_radius")) * d("journal_length") +
           pin_area(n, d("journal_collar_radius")) * d("journal_collar_thickness") + pin_area(n, d("pin_radius")) * d("pin_length") +
           pin_area(n, d("pin_head_radius")) * d("pin_head_thickness");
}

double coupler_volume(const Named& v, int n) {
    const auto d = [&](const char* name) { return v.at(name); };
    const double length = d("coupler_length"), r = d("crank_end_radius"), s = d("rocker_end_radius");
    const double ends = (pin_area(n, r) + pin_area(n, s)) / 2;
    const auto side = [&](double x) { return Vector2(x, r + (s - r) * x / length); };
    const Vector2 left = side(r), right = side(length - s), tip(d("point_x"), d("point_y")), half(d("tip_half_width"), 0);
    const auto cross = [](const Vector2& a, const Vector2& b) { return a.x() * b.y() - a.y() * b.x(); };
    const double wing = cross(tip + half - left, tip - half - right) / 2;  // a quadrilateral's diagonals
    return (ends + (r + s) * length + wing - bore_area(n, d("crank_bore_radius")) - bore_area(n, d("rocker_bore_radius"))) * d("thickness");
}

// Frusta between the rings of the tip.
double follower_volume(const Named& v, int n) {
    const double r = v.at("tip_radius"), shank = v.at("shank_radius"), angle = std::asin(shank / r);
    double volume = pin_area(n, v.at("head_radius")) * v.at("head_thickness");
    double lower = 0, lower_z = 0;
    for (int k = 1; k <= 12; ++k) {
        const double upper = r * std::sin(angle * k / 12), upper_z = r - r * std::cos(angle * k / 12);
        volume += pin_area(n, 1) * (lower * lower + lower * upper + upper * upper) * (upper_z - lower_z) / 3;
        lower = upper;
        lower_z = upper_z;
    }
    return volume + pin_area(n, shank) * (v.at("length") - lower_z);
}

// The engine's facets cover the round surfaces, for its clearances are proven; those of the others lie within.
core::parts::Lean lean_of(const std::string& name) {
    const bool is_of_engine = name == "block" || name == "crank" || name == "rod" || name == "piston";
    return is_of_engine ? core::parts::Lean::cover : core::parts::Lean::within;
}

double closed_form_volume(const std::string& name, const Named& v, int n) {
    const auto d = [&](const char* dimension) { return v.at(dimension); };
    const bool covers = lean_of(name) == core::parts::Lean::cover;
    const auto pin_area = [covers](int count, double radius) { return covers ? circumscribed(count, radius) : inscribed(count, radius); };
    const auto bore_area = [covers](int count, double radius) { return covers ? inscribed(count, radius) : circumscribed(count, radius); };
    if (name == "crank") {
        return pin_area(n, d("journal_collar_radius")) * d("journal_collar_thickness") +
               pin_area(n, d("journal_radius")) * d("journal_length") + pin_area(n, d("shoulder_radius")) * d("shoulder_height") +
               pin_area(n, d("disc_radius")) * d("disc_thickness") + pin_area(n, d("crank_pin_radius")) * d("crank_pin_length") +
               pin_area(n, d("crank_pin_head_radius")) * d("crank_pin_head_thickness");
    }
    if (name == "rod") {
        const double ends = (pin_area(n, d("big_end_radius")) + pin_area(n, d("small_end_radius"))) / 2;
        const double shank = (d("big_end_radius") + d("small_end_radius")) * d("rod_length");
        return (ends + shank - bore_area(n, d("big_bore_radius")) - bore_area(n, d("small_bore_radius"))) * d("thickness");
    }
    if (name == "piston") {
        return pin_area(n, d("piston_radius")) * d("piston_length") +
               2 * d("lug_half_width") * d("lug_height") * (d("lug_reach") + d("face_offset")) +
               pin_area(n, d("wrist_pin_radius")) * d("wrist_pin_length") +
               pin_area(n, d("wrist_pin_head_radius")) * d("wrist_pin_head_thickness");
    }
    if (name == "base") {
        const double plate = (d("reach_left") + d("pivot_x") + d("reach_right")) * (d("reach_below") + d("reach_above"));
        return (plate - bore_area(n, d("crank_bore_radius")) - bore_area(n, d("rocker_bore_radius"))) * d("plate_thickness");
    }
    if (name == "arm") return arm_volume(v, n);
    if (name == "coupler") return coupler_volume(v, n);
    if (name == "eccentric") return pin_area(n, d("disc_radius")) * d("width") + 2 * pin_area(n, d("shaft_radius")) * d("shaft_length");
    if (name == "follower") return follower_volume(v, n);
    if (name == "guide") return (d("size") * d("size") - bore_area(n, d("hole_radius"))) * d("thickness");
    REQUIRE(name == "block");
    const double tall_length = d("wall_far") - d("wall_near");
    const double profile = (d("wall_far") + d("plate_end")) * d("plate_thickness") + tall_length * (d("wall_top") - d("plate_top"));
    return profile * 2 * d("half_width") - bore_area(n, d("bearing_bore_radius")) * d("plate_thickness") -
           bore_area(n, d("cylinder_bore_radius")) * tall_length;
}

void check_solid(const Mesh& mesh, const std::string& name, const Named& values, int segments) {
    INFO(name << ", " << segments << " segments");
    CHECK(core::solids::validate_mesh(mesh, {}).empty());
    CHECK(mesh.shell_names.size() == 1);
    CHECK(volume(mesh) == Approx(closed_form_volume(name, values, segments)).epsilon(1e-12));
    // Euler: V - E + F = 2 - 2 genus, the genus being the number of through holes.
    const std::map<std::string, int> through_holes = {{"rod", 2}, {"block", 2}, {"coupler", 2}, {"base", 2}, {"guide", 1}};
    const auto found = through_holes.find(name);
    const int holes = found == through_holes.end() ? 0 : found->second;
    CHECK(mesh.vertices.cols() - static_cast<Eigen::Index>(mesh.edges.size()) + static_cast<Eigen::Index>(mesh.triangles.size()) ==
          2 - 2 * holes);
}

struct Range {
    std::string part, dimension;
    double lower, upper;  // [mm]
};

// The design parameters of the examples over their bounds.
const std::vector<Range> parameter_ranges = {{"crank", "journal_radius", 5.06, 5.35},
                                             {"crank", "crank_pin_radius", 4.05, 4.35},
                                             {"crank", "crank_radius", 12, 16},
                                             {"rod", "rod_length", 39, 50},
                                             {"piston", "piston_length", 14, 24},
                                             {"piston", "piston_radius", 9.2, 9.95},
                                             {"piston", "wrist_pin_radius", 3.04, 3.35},
                                             {"arm", "arm_length", 14.5, 50},
                                             {"arm", "journal_radius", 4.05, 4.45},
                                             {"arm", "pin_radius", 2.95, 3.35},
                                             {"coupler", "coupler_length", 42, 60},
                                             {"coupler", "point_x", 18, 32},
                                             {"coupler", "point_y", 14, 26},
                                             {"base", "pivot_x", 30, 70},
                                             {"base", "pivot_y", -22, 5},
                                             {"eccentric", "eccentricity", 3, 5},
                                             {"eccentric", "disc_radius", 12, 16},
                                             {"follower", "shank_radius", 4, 4.95},
                                             {"follower", "length", 24, 44},
                                             {"follower", "tip_radius", 6, 14}};

}  // namespace

TEST_CASE("example parts: each says what it is, and is a solid of its closed-form volume, for any number of segments") {
    for (const std::string& name : example_parts()) {
        if (!can_be_drawn(name)) continue;
        const PartFile file = file_of(name);
        INFO(name);
        CHECK_FALSE(file.about().empty());
        for (const auto& dimension : file.dimensions()) CHECK_FALSE(dimension.about.empty());
        for (const auto& relation : file.relations()) CHECK_FALSE(relation.otherwise.empty());
        CHECK(file.facets().lean == lean_of(name));
        for (const int segments : {8, 24, 32, 36}) {
            const auto part = FilePart::create(example_part(name), {}, {.counts = {{"segments", segments}}});
            for (const Error& error : part.errors()) UNSCOPED_INFO(error.where << ": " << error.message);
            REQUIRE(part);
            check_solid(description::drawn_mesh(**part).value(), name, named(file, values_of(file)), segments);
        }
    }
}

TEST_CASE("example parts: the parameters over their ranges keep solids and exact derivatives") {
    for (const std::string& name : example_parts()) {
        if (!can_be_drawn(name)) continue;
        const PartFile file = file_of(name);
        const auto reference = file.drawn(values_of(file)).value().structure;
        for (const double fraction : {-1.0, 0.0, 0.37, 1.0}) {  // below 0: as the file says
            Named changes;
            for (const Range& range : parameter_ranges)
                if (range.part == name && fraction >= 0)
                    changes[range.dimension] = 1e-3 * (range.lower + fraction * (range.upper - range.lower));
            const std::vector<double> values = values_of(file, changes);
            const auto part = file.drawn(values, {}, reference);
            for (const Error& error : part.errors()) UNSCOPED_INFO(name << ", " << error.where << ": " << error.message);
            REQUIRE(part);
            check_solid(part->mesh, name, named(file, values), file.facets().segments);
            int compared = 0;
            CHECK(part_campaign::jacobian_fault(file, values, *part, compared) == "");
            CHECK(compared >= static_cast<int>(values.size()) - 1);
            for (std::size_t k = 0; k < values.size(); ++k) {
                INFO(name << "/" << file.dimensions()[k].name);
                CHECK(part->jacobian[k].squaredNorm() > 0);  // every dimension moves something
            }
        }
    }
}

TEST_CASE("example parts: whatever dimensions are accepted give a solid") {
    std::mt19937 random(20240607);
    core::parts::Facets facets;  // that cover the part: round parts that do not meet have polygons that do not
    facets.segments = 12;
    for (const std::string& name : example_parts()) {
        if (!can_be_drawn(name)) continue;
        const PartFile file = file_of(name);
        for (int trial = 0; trial < 30; ++trial) {
            const std::vector<double> values = part_campaign::random_values(file, random);
            REQUIRE_FALSE(values.empty());
            const auto part = file.drawn(values, facets);
            INFO(name << ", number " << trial);
            for (const Error& error : part.errors()) UNSCOPED_INFO(error.where << ": " << error.message);
            CHECK(part);
        }
    }
}

TEST_CASE("example parts: relations hold just inside their limits and refuse just outside, with their reason") {
    struct Limit {
        std::string part, dimension;
        double limit;  // [mm]
        std::string reason;
        Named others = {};
        bool is_lower = false;
    };
    const double rod_slope = 45 / std::hypot(45, 1.8), arm_slope = 18 / std::hypot(18, 1.5);
    const std::vector<Limit> limits = {
        {"crank", "crank_radius", 21 - 4.05, "the crank pin leaves the disc"},
        {"crank", "journal_radius", 7.5, "the collar does not retain the journal"},
        {"crank", "crank_pin_radius", 6, "the pin's head does not retain the rod", {{"crank_radius", 10}}},
        {"rod", "big_bore_radius", 7.4 * rod_slope, "the bore breaks through a side"},
        {"rod", "small_bore_radius", 5.6 * rod_slope, "the bore breaks through a side"},
        {"piston", "wrist_pin_radius", 4.6, "the wrist pin leaves the lug"},
        {"piston", "wrist_pin_head_radius", 7.4, "the pin's head runs into the piston's face"},
        {"piston", "lug_half_width", std::sqrt(11.65 * 11.65 - 5.9 * 5.9), "the lug's corners leave the piston's face"},
        {"block", "bearing_bore_radius", 12, "the bearing bore leaves the plate"},
        {"block", "cylinder_bore_radius", 14.3, "the cylinder bore breaks through the plate's top face"},
        {"arm", "journal_radius", 6.2, "the collar does not retain the journal"},
        {"arm", "shoulder_radius", 7.5 * arm_slope, "the shoulder leaves the bar"},
        {"arm", "pin_radius", 4.8, "the pin's head does not retain the coupler"},
        {"arm", "foot_radius", 6 * arm_slope, "the foot leaves the bar"},
        {"arm", "journal_end_radius", 18 - 6, "the two ends overlap"},
        {"coupler", "crank_bore_radius", 6.4, "the crank pin's bore breaks through a side"},
        {"coupler", "tip_half_width", 25 - 6.4, "the wing stands over the crank's end"},
        {"coupler", "tip_half_width", 55 - 6.4 - 40, "the wing stands over the rocker's end", {{"point_x", 40}}},
        {"coupler", "crank_end_radius", 7.5, "the point does not stand out of the bar", {{"point_y", 7.5}}},
        {"coupler", "rocker_end_radius", 7.5, "the point does not stand out of the bar", {{"point_y", 7.5}}},
        {"base", "crank_bore_radius", 28, "the crank's bore breaks through the plate's edge"},
        {"base", "rocker_bore_radius", 22, "the rocker's bore breaks through the plate's edge", {{"pivot_y", -6}}},
        {"base", "rocker_bore_radius", 20 - 4.5, "the bores meet", {{"pivot_x", 20}}},
        {"eccentric", "eccentricity", 12 - 3.5, "the shaft leaves the disc"},
        {"eccentric", "eccentricity", 9, "the shaft leaves the disc", {{"shaft_radius", 3}}},
        {"follower", "shank_radius", 7, "the head does not stand out of the shank"},
        {"follower", "shank_radius", 6, "the tip does not reach the shank", {{"tip_radius", 6}}},
        {"follower", "length", 9 - std::sqrt(81 - 4.8 * 4.8), "the tip reaches the head", {}, true},
        {"guide", "hole_radius", 12, "the hole breaks through the plate's sides"}};
    for (const Limit& limit : limits) {
        INFO(limit.part << "/" << limit.dimension);
        const PartFile file = file_of(limit.part);
        const auto at = [&](double share) {
            Named changes;
            for (const auto& [name, value] : limit.others) changes[name] = 1e-3 * value;
            changes[limit.dimension] = 1e-3 * limit.limit * (limit.is_lower ? 2 - share : share);
            return values_of(file, changes);
        };
        CHECK(file.faults(at(1 - 1e-6)).empty());
        const Errors faults = file.faults(at(1 + 1e-6));
        REQUIRE_FALSE(faults.empty());
        CHECK(faults.front().code == ErrorCode::out_of_range);
        CHECK(faults.front().message.find("or " + limit.reason) != std::string::npos);
        if (!can_be_drawn(limit.part)) continue;
        const auto part = file.drawn(at(0.97));
        for (const Error& error : part.errors()) UNSCOPED_INFO(error.where << ": " << error.message);
        CHECK(part);
    }
}

}  // namespace fettle::design::shapes::example_parts_test
