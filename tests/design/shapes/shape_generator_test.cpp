// SPDX-License-Identifier: MIT
#include "fettle/design/shapes/shape_generator.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <set>

#include "fettle/core/geometry/mass_moments.hpp"
#include "fettle/core/solids/mesh_validity.hpp"
#include "fettle/tests/support/derivative_check.hpp"

namespace fettle::design::shapes::shape_generator_test {

namespace {

using Values = std::map<std::string, double>;

Values defaults(const GeneratorInfo& info) {
    Values values;
    for (const auto& dimension : info.dimensions) values[dimension.name] = dimension.default_value;
    return values;
}

double volume(const core::geometry::Mesh& mesh) { return core::geometry::solid_moments(mesh.vertices, mesh.triangles)(3, 3); }

// Cross-section of an inscribed and of a circumscribed circle.
double pin_area(int n, double radius) { return n / 2.0 * std::sin(2 * std::numbers::pi / n) * radius * radius; }
double bore_area(int n, double radius) { return n * std::tan(std::numbers::pi / n) * radius * radius; }

double arm_volume(const Values& v, int n) {
    const auto d = [&](const char* name) { return v.at(name); };
    const double ends = (pin_area(n, d("journal_end_radius")) + pin_area(n, d("pin_end_radius"))) / 2;
    const double bar = ends + (d("journal_end_radius") + d("pin_end_radius")) * d("arm_length");
    return bar * d("bar_thickness") + (pin_area(n, d("shoulder_radius")) + pin_area(n, d("foot_radius"))) * d("shoulder_height") +
           pin_area(n, d("journal_radius")) * d("journal_length") +
           pin_area(n, d("journal_collar_radius")) * d("journal_collar_thickness") + pin_area(n, d("pin_radius")) * d("pin_length") +
           pin_area(n, d("pin_head_radius")) * d("pin_head_thickness");
}

double coupler_volume(const Values& v, int n) {
    const auto d = [&](const char* name) { return v.at(name); };
    const double length = d("coupler_length"), r = d("crank_end_radius"), s = d("rocker_end_radius");
    const double ends = (pin_area(n, r) + pin_area(n, s)) / 2;
    const auto side = [&](double x) { return Vector2(x, r + (s - r) * x / length); };
    const Vector2 left = side(r), right = side(length - s), tip(d("point_x"), d("point_y")), half(d("tip_half_width"), 0);
    const auto cross = [](const Vector2& a, const Vector2& b) { return a.x() * b.y() - a.y() * b.x(); };
    const double wing = cross(tip + half - left, tip - half - right) / 2;  // a quadrilateral's diagonals
    return (ends + (r + s) * length + wing - bore_area(n, d("crank_bore_radius")) - bore_area(n, d("rocker_bore_radius"))) * d("thickness");
}

double base_plate_volume(const Values& v, int n) {
    const auto d = [&](const char* name) { return v.at(name); };
    const double plate = (d("reach_left") + d("pivot_x") + d("reach_right")) * (d("reach_below") + d("reach_above"));
    return (plate - bore_area(n, d("crank_bore_radius")) - bore_area(n, d("rocker_bore_radius"))) * d("plate_thickness");
}

// Frusta between the rings of the tip.
double follower_volume(const Values& v, int n) {
    const double r = v.at("tip_radius"), shank = v.at("shank_radius");
    double volume = pin_area(n, v.at("head_radius")) * v.at("head_thickness");
    double lower = 0, lower_z = 0;
    for (int k = 1; k <= n / 2; ++k) {
        const double upper = 2 * k * shank / n, upper_z = r - std::sqrt(r * r - upper * upper);
        volume += pin_area(n, 1) * (lower * lower + lower * upper + upper * upper) * (upper_z - lower_z) / 3;
        lower = upper;
        lower_z = upper_z;
    }
    return volume + pin_area(n, shank) * (v.at("length") - lower_z);
}

double closed_form_volume(const std::string& generator, const Values& v, int n) {
    const auto d = [&](const char* name) { return v.at(name); };
    if (generator == "box") return d("size_x") * d("size_y") * d("size_z");
    if (generator == "pin") return pin_area(n, d("radius")) * d("length");
    if (generator == "plate_with_hole") return (d("size_x") * d("size_y") - bore_area(n, d("hole_radius"))) * d("thickness");
    if (generator == "crank") {
        return pin_area(n, d("journal_collar_radius")) * d("journal_collar_thickness") +
               pin_area(n, d("journal_radius")) * d("journal_length") + pin_area(n, d("shoulder_radius")) * d("shoulder_height") +
               pin_area(n, d("disc_radius")) * d("disc_thickness") + pin_area(n, d("crank_pin_radius")) * d("crank_pin_length") +
               pin_area(n, d("crank_pin_head_radius")) * d("crank_pin_head_thickness");
    }
    if (generator == "rod") {
        const double ends = (pin_area(n, d("big_end_radius")) + pin_area(n, d("small_end_radius"))) / 2;
        const double shank = (d("big_end_radius") + d("small_end_radius")) * d("rod_length");
        return (ends + shank - bore_area(n, d("big_bore_radius")) - bore_area(n, d("small_bore_radius"))) * d("thickness");
    }
    if (generator == "piston") {
        return pin_area(n, d("piston_radius")) * d("piston_length") +
               2 * d("lug_half_width") * d("lug_height") * (d("lug_reach") + d("face_offset")) +
               pin_area(n, d("wrist_pin_radius")) * d("wrist_pin_length") +
               pin_area(n, d("wrist_pin_head_radius")) * d("wrist_pin_head_thickness");
    }
    if (generator == "arm") return arm_volume(v, n);
    if (generator == "coupler") return coupler_volume(v, n);
    if (generator == "base_plate") return base_plate_volume(v, n);
    if (generator == "eccentric") {
        return pin_area(n, d("disc_radius")) * d("width") + 2 * pin_area(n, d("shaft_radius")) * d("shaft_length");
    }
    if (generator == "follower") return follower_volume(v, n);
    REQUIRE(generator == "block");
    const double tall_length = d("wall_far") - d("wall_near");
    const double profile = (d("wall_far") + d("plate_end")) * d("plate_thickness") + tall_length * (d("wall_top") - d("plate_top"));
    return profile * 2 * d("half_width") - bore_area(n, d("bearing_bore_radius")) * d("plate_thickness") -
           bore_area(n, d("cylinder_bore_radius")) * tall_length;
}

void check_solid(const GeneratedShape& shape, const Values& values, int segments) {
    const Errors faults = core::solids::validate_mesh(shape.mesh, {});
    INFO(shape.mesh.name << (faults.empty() ? "" : ": " + faults.front().where + " " + faults.front().message));
    CHECK(faults.empty());
    CHECK(shape.mesh.shell_names.size() == 1);
    CHECK(shape.mesh.codimensional_points.empty());
    CHECK(volume(shape.mesh) == Approx(closed_form_volume(shape.mesh.name, values, segments)).epsilon(1e-12));
    // Euler: V - E + F = 2 - 2 genus, the genus being the number of through holes.
    const std::map<std::string, int> through_holes = {{"rod", 2}, {"block", 2}, {"coupler", 2}, {"base_plate", 2}, {"plate_with_hole", 1}};
    const auto found = through_holes.find(shape.mesh.name);
    const int holes = found == through_holes.end() ? 0 : found->second;
    CHECK(shape.mesh.vertices.cols() - static_cast<Eigen::Index>(shape.mesh.edges.size()) +
              static_cast<Eigen::Index>(shape.mesh.triangles.size()) ==
          2 - 2 * holes);
}

void check_jacobian_columns(const std::string& generator, const Values& values, const ShapeOptions& options) {
    const GeneratedShape shape = generate(generator, values, options).value();
    REQUIRE(shape.jacobian.size() == shape.dimensions.size());
    for (std::size_t k = 0; k < shape.dimensions.size(); ++k) {
        const std::string& name = shape.dimensions[k];
        const auto vertices = [&](const VectorX& shift) -> VectorX {
            Values moved = values;
            moved[name] += shift[0];
            return generate(generator, moved, options).value().mesh.vertices.reshaped();
        };
        const auto check = tests::support::check_jacobian(vertices, VectorX::Zero(1), shape.jacobian[k].reshaped(), {1e-4, 0.25, 6});
        INFO(generator << "/" << name << ": " << check.analytic << " against " << check.difference);
        CHECK(check.relative_error < 1e-9);
        CHECK(shape.jacobian[k].squaredNorm() > 0);  // every dimension moves something
    }
}

TEST_CASE("shapes: every generator's default is a valid solid with its closed-form volume, for any number of segments") {
    std::set<std::string> names;
    for (const GeneratorInfo& info : generator_table()) {
        CHECK(names.insert(info.name).second);
        CHECK_FALSE(info.description.empty());
        for (int segments : {8, 24, 32, 36}) {
            const auto shape = generate(info.name, {}, {segments});
            REQUIRE(shape);
            check_solid(*shape, defaults(info), segments);
        }
    }
    CHECK(names == std::set<std::string>{"crank", "rod", "piston", "block", "box", "pin", "plate_with_hole", "base_plate", "arm", "coupler",
                                         "eccentric", "follower"});
}

TEST_CASE("shapes: Jacobian against central differences, each column by itself") {
    for (const GeneratorInfo& info : generator_table()) check_jacobian_columns(info.name, defaults(info), {});
}

struct Range {
    std::string generator, dimension;
    double lower, upper;
};

// The design parameters of the examples over their bounds.
const std::vector<Range>& parameter_ranges() {
    static const std::vector<Range> ranges = {{"crank", "journal_radius", 0.004, 0.0054},    {"crank", "crank_pin_radius", 0.003, 0.0044},
                                              {"crank", "crank_radius", 0.012, 0.016},       {"rod", "rod_length", 0.036, 0.06},
                                              {"piston", "piston_length", 0.012, 0.036},     {"piston", "piston_radius", 0.0105, 0.012},
                                              {"piston", "wrist_pin_radius", 0.002, 0.0034}, {"arm", "arm_length", 0.0145, 0.05},
                                              {"arm", "journal_radius", 0.00405, 0.00445},   {"arm", "pin_radius", 0.00295, 0.00335},
                                              {"coupler", "coupler_length", 0.042, 0.06},    {"coupler", "point_x", 0.018, 0.032},
                                              {"coupler", "point_y", 0.014, 0.026},          {"base_plate", "pivot_x", 0.03, 0.07},
                                              {"base_plate", "pivot_y", -0.022, 0.005},      {"eccentric", "eccentricity", 0.003, 0.005},
                                              {"eccentric", "disc_radius", 0.01, 0.016},     {"follower", "shank_radius", 0.004, 0.00495},
                                              {"follower", "length", 0.024, 0.044},          {"follower", "tip_radius", 0.006, 0.014}};
    return ranges;
}

TEST_CASE("shapes: the examples' parameters over their ranges keep solids, connectivity and exact derivatives") {
    for (const GeneratorInfo& info : generator_table()) {
        const auto reference = generate(info.name, {}).value().mesh;
        for (double fraction : {0.0, 0.37, 1.0}) {
            Values values = defaults(info);
            bool moved = false;
            for (const Range& range : parameter_ranges()) {
                if (range.generator != info.name) continue;
                values[range.dimension] = range.lower + fraction * (range.upper - range.lower);
                moved = true;
            }
            if (!moved) continue;
            const auto shape = generate(info.name, values);
            REQUIRE(shape);
            check_solid(*shape, values, 24);
            CHECK(shape->mesh.triangles == reference.triangles);
            CHECK(shape->mesh.edges == reference.edges);
            if (fraction == 0.37) check_jacobian_columns(info.name, values, {});
        }
    }
}

TEST_CASE("shapes: whatever dimensions are accepted give a valid solid") {
    std::mt19937 random(20240607);
    std::uniform_real_distribution<double> exponent(-0.6, 0.6);
    for (const GeneratorInfo& info : generator_table()) {
        const auto triangles = generate(info.name, {}, {12}).value().mesh.triangles;
        int accepted = 0, refused = 0;
        for (int trial = 0; trial < 400 && accepted < 30; ++trial) {
            Values values = defaults(info);
            for (auto& [name, value] : values) value *= std::exp(exponent(random));
            const auto shape = generate(info.name, values, {12});
            if (!shape) {
                ++refused;
                for (const Error& error : shape.errors()) CHECK(error.code == ErrorCode::out_of_range);
                continue;
            }
            ++accepted;
            check_solid(*shape, values, 12);
            CHECK(shape->mesh.triangles == triangles);
        }
        INFO(info.name << ": " << accepted << " accepted, " << refused << " refused");
        CHECK(accepted >= 10);
    }
}

TEST_CASE("shapes: a value just inside each limit is a solid, just outside is refused") {
    struct Limit {
        std::string generator, dimension;
        double limit;
        Values others = {};
    };
    const double flat = std::cos(std::numbers::pi / 24);
    const double rim = 0.01165 * flat;
    const std::vector<Limit> limits = {
        {"crank", "crank_radius", (0.021 - 0.00405) * flat},
        {"crank", "journal_radius", 0.0075},
        {"crank", "crank_pin_radius", 0.006, {{"crank_radius", 0.01}}},
        {"rod", "big_bore_radius", (0.0074 - 0.0018 * 0.0074 / 0.045) * flat},  // the side narrows to the small end
        {"rod", "small_bore_radius", 0.0056 * flat * flat},
        {"piston", "wrist_pin_radius", 0.0046},
        {"piston", "wrist_pin_head_radius", 0.0074},
        {"piston", "lug_half_width", std::sqrt(rim * rim - 0.0059 * 0.0059)},
        {"block", "bearing_bore_radius", 0.012 * flat},
        {"block", "cylinder_bore_radius", 0.0143 * flat},
        {"plate_with_hole", "hole_radius", 0.015 * flat},
        {"arm", "journal_radius", 0.0062},
        {"arm", "shoulder_radius", 0.0075 - 0.0015 * 0.0075 / 0.018},  // the side narrows to the pin's end
        {"arm", "pin_radius", 0.0048},
        {"arm", "foot_radius", 0.006},
        {"arm", "journal_end_radius", 0.018 - 0.006},
        {"coupler", "crank_bore_radius", 0.0064 * flat * flat},
        {"coupler", "tip_half_width", 0.025 - 0.0064},
        {"coupler", "tip_half_width", 0.055 - 0.0064 - 0.04, {{"point_x", 0.04}}},
        {"coupler", "crank_end_radius", 0.0075, {{"point_y", 0.0075}}},
        {"coupler", "rocker_end_radius", 0.0075, {{"point_y", 0.0075}}},
        {"base_plate", "crank_bore_radius", 0.025 * flat, {{"pivot_x", 0.05}}},
        {"base_plate", "rocker_bore_radius", 0.022 * flat, {{"pivot_y", -0.006}}},
        {"eccentric", "eccentricity", (0.012 - 0.0035) * flat},
        {"eccentric", "eccentricity", 0.009 * flat, {{"shaft_radius", 0.003}}},
        {"follower", "shank_radius", 0.007},
        {"follower", "shank_radius", 0.006, {{"tip_radius", 0.006}}},
        {"follower", "shank_radius", 0.006, {{"length", 0.006}}}};
    for (const auto& [generator, dimension, limit, others] : limits) {
        INFO(generator << "/" << dimension);
        Values values = others;
        values[dimension] = limit * (1 - 1e-6);
        const auto inside = generate(generator, values);
        REQUIRE(inside);
        CHECK(core::solids::validate_mesh(inside->mesh, {}).empty());
        values[dimension] = limit * (1 + 1e-6);
        const auto outside = generate(generator, values);
        REQUIRE_FALSE(outside);
        CHECK(outside.errors().front().code == ErrorCode::out_of_range);
        CHECK(outside.errors().front().where == generator + "/" + dimension);
        CHECK(outside.errors().front().message.find("allowed: below") != std::string::npos);
    }
}

TEST_CASE("shapes: wrong input is refused with its place and what is allowed") {
    const auto single = [](const Result<GeneratedShape>& result) {
        REQUIRE_FALSE(result);
        REQUIRE(result.errors().size() == 1);
        return result.errors().front();
    };
    Error error = single(generate("crnak", {}));
    CHECK(error.code == ErrorCode::unknown_key);
    CHECK(error.message.find("\"crank\"") != std::string::npos);

    error = single(generate("rod", {{"rod_lenght", 0.05}}));
    CHECK(error.code == ErrorCode::unknown_key);
    CHECK(error.where == "rod/rod_lenght");
    CHECK(error.message.find("\"rod_length\"") != std::string::npos);

    error = single(generate("box", {{"size_x", -0.002}}));
    CHECK(error.code == ErrorCode::out_of_range);
    CHECK(error.message == "size_x is -2 mm; allowed: above 0 mm");

    error = single(generate("box", {{"size_x", std::numeric_limits<double>::quiet_NaN()}}));
    CHECK(error.code == ErrorCode::not_finite);

    error = single(generate("box", {}, {30}));
    CHECK(error.code == ErrorCode::out_of_range);
    CHECK(error.where == "box/segments");

    CHECK(generate("pin", {{"radius", 0.0}, {"lenght", 1.0}}).errors().size() == 2);
}

}  // namespace

}  // namespace fettle::design::shapes::shape_generator_test
