// SPDX-License-Identifier: MIT
// Clearance within tolerances of a closed loop: a four-bar linkage whose lengths deviate, against the linkage solved by two circles.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "core/certificate/certificate_checker.hpp"
#include "core/clearance/clearance.hpp"
#include "design/clearance/read_subject.hpp"
#include "tests/core/clearance/clearance_oracle.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fettle::design::clearance::toleranced_loops_test {

namespace {

using core::certificate::Certificate;
using core::clearance::ClearanceOptions;
using core::clearance::PairClearance;
using core::clearance::PairStatus;
using tests::clearance::Real;
using tests::clearance::Real3;
using tests::clearance::RealVertices;

const char* const four_bar = R"json({"fettle_scene": 1, "units": "mm", "timestep": 0.01,
    "variables": {"crank": "20 mm", "coupler": "60 mm", "rocker": "45 mm", "coupler_angle": "47 deg", "rocker_angle": "100 deg",
      "crank_drawn": "20 mm", "coupler_drawn": "60 mm", "rocker_drawn": "45 mm", "base_x": "0 mm",
      "pivot_x": "= crank_drawn + coupler_drawn * cos(coupler_angle) - rocker_drawn * cos(rocker_angle) + base_x",
      "pivot_y": "= coupler_drawn * sin(coupler_angle) - rocker_drawn * sin(rocker_angle)"},
    "bodies": [
      {"name": "crank", "density": 1240, "shape": {"part": "box", "dimensions": {"size_x": "= crank", "size_y": 6, "size_z": 3}},
       "position": ["= crank / 2", 0, -4]},
      {"name": "coupler", "density": 1240, "shape": {"part": "box", "dimensions": {"size_x": "= coupler", "size_y": 8, "size_z": 3}},
       "position": ["= crank + coupler / 2 * cos(coupler_angle)", "= coupler / 2 * sin(coupler_angle)", 0],
       "rotation": [0, 0, "= coupler_angle"]},
      {"name": "rocker", "density": 1240, "shape": {"part": "box", "dimensions": {"size_x": "= rocker", "size_y": 6, "size_z": 3}},
       "position": ["= pivot_x + rocker / 2 * cos(rocker_angle)", "= pivot_y + rocker / 2 * sin(rocker_angle)", 4],
       "rotation": [0, 0, "= rocker_angle"]},
      {"name": "post", "type": "static", "shape": {"part": "box", "dimensions": {"size_x": 10, "size_y": 10, "size_z": 10}},
       "position": [58, 62, 0]}],
    "joints": [
      {"name": "drive", "type": "revolute", "b": "crank", "point_a": [0, 0, 0], "point_b": ["= -crank / 2", 0, 4], "axis": [0, 0, 1]},
      {"name": "crank_pin", "type": "revolute", "a": "crank", "b": "coupler", "point_a": ["= crank / 2", 0, 4],
       "point_b": ["= -coupler / 2", 0, 0], "axis": [0, 0, 1]},
      {"name": "pivot", "type": "revolute", "b": "rocker", "point_a": ["= pivot_x", "= pivot_y", 0], "point_b": ["= -rocker / 2", 0, -4],
       "axis": [0, 0, 1]},
      {"name": "rocker_pin", "type": "revolute", "a": "rocker", "b": "coupler", "point_a": ["= rocker / 2", 0, -4],
       "point_b": ["= coupler / 2", 0, 0], "axis": [0, 0, 1]}],
    "motors": [{"name": "motor", "joint": "drive", "speed": 360}]})json";

std::string design(const std::string& tolerances) {
    return R"json({"fettle_design": 1, "scene": "x.scene.json", "units": "mm", "simulation": {"steps": 1},
        "parameters": [{"name": "crank", "lower": 10, "upper": 30}], "objective": [{"type": "mass", "bodies": ["coupler"]}],
        "tolerances": )json" +
           tolerances + "}";
}
const char* const tight = R"({"crank": "+-0.1 mm", "coupler": "+-0.2 mm", "rocker": {"lower": -0.1, "upper": 0.3}, "base_x": "+-0.1 mm"})";

Subject subject_of(const tests::support::TemporaryFolder& folder, const std::string& tolerances) {
    folder.write("x.scene.json", four_bar);
    folder.write("x.design.json", design(tolerances));
    SubjectOptions options;
    options.path = folder.file("x.design.json");
    options.tolerances = options.ranges = true;
    Result<Subject> subject = read_subject(options, {});
    for (const Error& error : subject.errors()) UNSCOPED_INFO(error.where << ": " << error.message);
    REQUIRE(subject);
    return *std::move(subject);
}

int body_named(const Subject& subject, const std::string& name) {
    const auto& bodies = subject.model.bodies;
    const auto found = std::find_if(bodies.begin(), bodies.end(), [&](const auto& body) { return body.name == name; });
    REQUIRE(found != bodies.end());
    return static_cast<int>(found - bodies.begin());
}

struct Lengths {
    Real crank = 20e-3, coupler = 60e-3, rocker = 45e-3, base_x = 0;
};

// Its box, from the end on the crank to the end on the rocker, of the branch that is drawn.
RealVertices coupler_at(const Lengths& lengths, Real angle) {
    const Real degree = std::numbers::pi_v<Real> / 180;
    const Real pivot_x = 20e-3L + 60e-3L * std::cos(47 * degree) - 45e-3L * std::cos(100 * degree) + lengths.base_x,
               pivot_y = 60e-3L * std::sin(47 * degree) - 45e-3L * std::sin(100 * degree);
    const Real from_x = lengths.crank * std::cos(angle), from_y = lengths.crank * std::sin(angle);
    const Real x = pivot_x - from_x, y = pivot_y - from_y, square = x * x + y * y, apart = std::sqrt(square);
    const Real along = (lengths.coupler * lengths.coupler - lengths.rocker * lengths.rocker + square) / (2 * apart),
               beside = std::sqrt(lengths.coupler * lengths.coupler - along * along);
    const Real to_x = (along * x - beside * y) / apart, to_y = (along * y + beside * x) / apart;  // as long as the coupler
    RealVertices out(3, 8);
    for (int k = 0; k < 8; ++k) {
        const Real share = (k & 1) != 0 ? 1 : 0, side = (k & 2) != 0 ? 4e-3L : -4e-3L;
        out.col(k) = Real3(from_x + share * to_x - side * to_y / lengths.coupler, from_y + share * to_y + side * to_x / lengths.coupler,
                           (k & 4) != 0 ? 1.5e-3L : -1.5e-3L);
    }
    return out;
}

// The distance of two boxes that stand upright in z and overlap there is that of their rectangles.
Real distance_to_post(const RealVertices& box) {
    const Real low_x = 53e-3L, high_x = 63e-3L, low_y = 57e-3L, high_y = 67e-3L;
    Real least = 1;
    const auto to_segment = [](Real px, Real py, Real ax, Real ay, Real bx, Real by) {
        const Real dx = bx - ax, dy = by - ay, t = std::clamp(((px - ax) * dx + (py - ay) * dy) / (dx * dx + dy * dy), Real(0), Real(1));
        return std::hypot(px - ax - t * dx, py - ay - t * dy);
    };
    const int round[] = {0, 1, 3, 2};
    const Real corners[4][2] = {{low_x, low_y}, {high_x, low_y}, {high_x, high_y}, {low_x, high_y}};
    for (int k = 0; k < 4; ++k) {
        const auto a = box.col(round[k]), b = box.col(round[(k + 1) % 4]);
        for (int j = 0; j < 4; ++j) {
            least = std::min(least, to_segment(corners[j][0], corners[j][1], a[0], a[1], b[0], b[1]));
            const auto *c = corners[j], *d = corners[(j + 1) % 4];
            least = std::min(least, to_segment(a[0], a[1], c[0], c[1], d[0], d[1]));
        }
    }
    return least;
}

}  // namespace

TEST_CASE("A four-bar linkage's coupler over the whole turn and all lengths within tolerance", "[toleranced]") {
    const tests::support::TemporaryFolder folder;
    const Subject subject = subject_of(folder, tight);
    const int coupler = body_named(subject, "coupler"), post = body_named(subject, "post");
    ClearanceOptions options;
    options.tolerance = 1e-4;
    const auto proven = certify_with_proof(subject.model, subject.domain, {{coupler, post}}, options);
    const PairClearance& found = proven.pairs.front();
    INFO(found.lower << " " << found.upper << " " << found.bounds << " " << found.reason);
    REQUIRE(found.lower > 0);
    CHECK(found.upper - found.lower <= 1e-4);
    CHECK(found.deviations.size() == 4);

    // Samples, among them all corners, everywhere and near the worst angle.
    std::mt19937 random(1);
    std::uniform_real_distribution<double> u(0, 1);
    Real least = 1, nominal = 1;
    for (int i = 0; i < 20000; ++i) {
        const auto share = [&](int bit) { return i % 2 == 0 ? (i / 2 >> bit & 1) : u(random); };
        const Lengths made{20e-3L + (0.2 * share(0) - 0.1) * 1e-3L, 60e-3L + (0.4 * share(1) - 0.2) * 1e-3L,
                           45e-3L + (0.4 * share(2) - 0.1) * 1e-3L, (0.2 * share(3) - 0.1) * 1e-3L};
        const Real angle = 2 * std::numbers::pi_v<Real> * u(random);
        least = std::min(least, distance_to_post(coupler_at(made, angle)));
        nominal = std::min(nominal, distance_to_post(coupler_at({}, angle)));
    }
    CHECK(static_cast<double>(least) >= found.lower);
    CHECK(static_cast<double>(least) <= found.upper + 1e-5);
    CHECK(nominal - least > 1e-4);  // the tolerances matter

    const auto checked = [&](const Certificate& certificate) {
        return core::certificate::check_certificate(certificate, subject.model, subject.domain.path());
    };
    const auto report = checked(proven.certificate);
    for (const auto& fault : report.faults) UNSCOPED_INFO(fault.where << ": " << fault.message);
    CHECK(report.accepted());
    const auto is_rejected = [&](const auto& damage) {
        Certificate damaged = proven.certificate;
        damage(damaged);
        return !checked(damaged).accepted();
    };
    auto& loops = proven.certificate.toleranced->loops;
    REQUIRE(loops.size() == 1);
    CHECK(is_rejected([](Certificate& c) { c.toleranced->coordinates[c.toleranced->loops[0].unknowns[0]].start += 0.5; }));
    CHECK(is_rejected([](Certificate& c) { c.toleranced->loops[0].rows[0] = c.toleranced->loops[0].rows[1]; }));
    CHECK(is_rejected([](Certificate& c) { c.toleranced->loops[0].closures.clear(); }));
    CHECK(is_rejected([](Certificate& c) { c.toleranced->loops[0].unknowns.pop_back(); }));
    CHECK(is_rejected([](Certificate& c) { c.toleranced->loops.clear(); }));
    CHECK(is_rejected([](Certificate& c) { c.toleranced->loops[0].closures[0].point_a = c.toleranced->loops[0].closures[0].point_b; }));
}

TEST_CASE("A loop that does not close for all lengths is undecided, with its reason", "[toleranced]") {
    const tests::support::TemporaryFolder folder;
    // With 9.9 mm more on the crank and as much less on coupler and rocker it has no whole turn.
    const Subject subject = subject_of(folder, R"({"crank": "+-9.9 mm", "coupler": "+-9.9 mm", "rocker": "+-9.9 mm"})");
    const PairClearance found =
        certify(subject.model, subject.domain, {{body_named(subject, "coupler"), body_named(subject, "post")}}, {}).front();
    CHECK(found.status == PairStatus::undecided);
    CHECK_THAT(found.reason, Catch::Contains("cannot be enclosed for all of their range and all tolerances"));
}

}  // namespace fettle::design::clearance::toleranced_loops_test
