// SPDX-License-Identifier: MIT
// Clearance within tolerances over a prescribed motion: closed forms, samples of scripted bodies, what is refused.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "core/certificate/certificate_checker.hpp"
#include "design/clearance/read_subject.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fettle::design::clearance::toleranced_motion_test {

namespace {

using core::clearance::ClearanceOptions;
using core::clearance::PairClearance;

// An arm that turns half round, and a slide that goes towards it.
std::string scene(const std::string& arm_motion, const std::string& slide_motion, const std::string& more = "") {
    return R"json({"fettle_scene": 1, "units": "mm", "timestep": 0.01, "end_time": 1,
        "variables": {"arm": "30 mm", "width": "8 mm", "slide_at": "40 mm"},
        "bodies": [
          {"name": "arm", "type": "kinematic", "density": 1240, "prescribed": )json" +
           arm_motion +
           R"json(, "shape": {"part": "box", "dimensions": {"size_x": "= arm", "size_y": "= width", "size_z": 4}}},
          {"name": "slide", "type": "kinematic", "prescribed": )json" +
           slide_motion +
           R"json(, "shape": {"part": "box", "dimensions": {"size_x": 10, "size_y": 30, "size_z": 4}}, "position": ["= slide_at", 0, 0]},
          {"name": "loose", "density": 1240, "shape": {"part": "box", "dimensions": {"size_x": 5, "size_y": 5, "size_z": 5}},
           "position": [0, 90, 0]}])json" +
           more + "}";
}
const char* const design = R"json({"fettle_design": 1, "scene": "x.scene.json", "units": "mm", "simulation": {"steps": 100},
    "parameters": [{"name": "arm", "lower": 20, "upper": 40}], "objective": [{"type": "mass", "bodies": ["arm"]}],
    "tolerances": {"arm": "+-0.2 mm", "width": "+-0.1 mm", "slide_at": "+-0.3 mm"}})json";

struct Folder : tests::support::TemporaryFolder {
    explicit Folder(const std::string& text) {
        write("x.scene.json", text);
        write("x.design.json", design);
    }
    Result<Subject> read(double time = -1) const {
        SubjectOptions options;
        options.path = file("x.design.json");
        options.tolerances = options.kinematic = true;
        options.time = time;
        return read_subject(options, {});
    }
    Subject subject(double time = -1) const {
        Result<Subject> found = read(time);
        for (const Error& error : found.errors()) UNSCOPED_INFO(error.where << ": " << error.message);
        REQUIRE(found);
        return *std::move(found);
    }
    std::string fault() const {
        const Result<Subject> found = read();
        return found ? "" : found.errors().front().where + ": " + found.errors().front().message;
    }
};

PairClearance of_arm_and_slide(const Subject& subject, double tolerance = 1e-6) {
    ClearanceOptions options;
    options.tolerance = tolerance;
    return certify(subject.model, subject.domain, {{0, 1}}, options).front();
}

// The arm's far corner from the slide's face, where both are at `time`; the arm ends beside no corner of the slide.
double apart(double arm, double width, double slide_at, double angle, double way) {
    const double reach = std::abs(arm / 2 * std::cos(angle)) + std::abs(width / 2 * std::sin(angle));
    return slide_at + way - 5e-3 - reach;
}

}  // namespace

TEST_CASE("Two scripted bodies at even speed share the time, within tolerances", "[toleranced]") {
    const Folder folder(scene(R"({"rz": {"rate": 180}})", R"({"px": {"rate": -10}})"));
    const Subject subject = folder.subject();
    CHECK(subject.source == SubjectSource::prescribed);
    const PairClearance found = of_arm_and_slide(subject);
    std::mt19937 random(1);
    std::uniform_real_distribution<double> u(0, 1);
    double least = 1;
    for (int i = 0; i < 100'000; ++i) {
        const auto share = [&](int bit) { return i % 2 == 0 ? (i / 2 >> bit & 1) : u(random); };
        const double time = u(random);
        least = std::min(least, apart(30e-3 + (0.4 * share(0) - 0.2) * 1e-3, 8e-3 + (0.2 * share(1) - 0.1) * 1e-3,
                                      40e-3 + (0.6 * share(2) - 0.3) * 1e-3, M_PI * time, -10e-3 * time));
    }
    INFO(found.lower << " " << found.upper << " sampled " << least);
    CHECK(found.lower <= least);
    CHECK(found.upper - found.lower <= 1e-6);
    CHECK(std::abs(found.upper - least) <= 2e-6);
    CHECK(found.coordinates.size() == 1);
    ClearanceOptions options;
    options.tolerance = 1e-5;
    const auto proven = certify_with_proof(subject.model, subject.domain, {{0, 1}}, options);
    const auto checked = core::certificate::check_certificate(proven.certificate, subject.model, subject.domain.path());
    for (const auto& fault : checked.faults) UNSCOPED_INFO(fault.where << ": " << fault.message);
    CHECK(checked.accepted());
    CHECK(proven.certificate.toleranced->duration == 1);
    // The half of the time, in which the arm stands across, and the slide has gone half its way.
    const double half = of_arm_and_slide(folder.subject(0.5)).upper;
    double least_of_half = 1;
    for (int i = 0; i <= 10'000; ++i)
        least_of_half = std::min(least_of_half, apart(30.2e-3, 8.1e-3, 39.7e-3, M_PI * 0.5e-4 * i, -10e-3 * 0.5e-4 * i));
    CHECK(std::abs(half - least_of_half) <= 2e-6);
}

TEST_CASE("One body that a table moves goes over all that the table reaches", "[toleranced]") {
    const Folder folder(scene(R"({"rz": {"rate": 0}})", R"({"px": {"times": [0, 0.4, 1], "values": [0, -12, 3]}})"));
    const PairClearance found = of_arm_and_slide(folder.subject());
    CHECK(found.lower <= 39.7e-3 - 12e-3 - 5e-3 - 15.1e-3 + 1e-12);
    CHECK(found.upper == Approx(39.7e-3 - 12e-3 - 5e-3 - 15.1e-3).epsilon(1e-9));
    const PairClearance begun = of_arm_and_slide(folder.subject(0.1));
    CHECK(begun.upper == Approx(39.7e-3 - 3e-3 - 5e-3 - 15.1e-3).epsilon(1e-9));
}

TEST_CASE("Prescribed motions that cannot be proven within tolerances are refused by name", "[toleranced]") {
    const std::string still = R"({"rz": {"rate": 0}})", turning = R"({"rz": {"rate": 180}})";
    CHECK_THAT(Folder(scene(still, R"({"px": {"rate": 0}})")).fault(), Catch::Contains("no motor and no script moves anything"));
    CHECK_THAT(Folder(scene(turning, R"({"px": {"times": [0, 1], "values": [0, -3]}})")).fault(),
               Catch::Contains("`slide`") && Catch::Contains("several motors and scripts go at even speed"));
    CHECK_THAT(Folder(scene(still, R"({"px": {"times": [0, 1], "values": [0, -3]}, "py": {"rate": 1}})")).fault(),
               Catch::Contains("body `slide`") && Catch::Contains("one by a table"));
    const std::string hinge = R"json(, "joints": [{"name": "hinge", "type": "revolute", "b": "loose", "point": [0, 90, 0],
        "axis": [0, 0, 1]}])json";
    CHECK_THAT(Folder(scene(turning, still, hinge)).fault(), Catch::Contains("joint `hinge`") && Catch::Contains("no motor drives it"));
    const auto moved_by = [&](const std::string& motor) {
        return Folder(scene(still, still, hinge + R"json(, "motors": [{"name": "m", "joint": "hinge", )json" + motor + "}]")).fault();
    };
    CHECK_THAT(moved_by(R"("angle": {"times": [0, 0.5, 1], "values": [0, 20, 0], "profile": "cubic"})"), Catch::Contains("curved table"));
    CHECK(moved_by(R"("angle": {"times": [0, 0.5, 1], "values": [0, 20, 0], "profile": "trapezoid"})").empty());
    CHECK(moved_by(R"("speed": 20)").empty());
}

namespace {

// A lever that a motor swings towards a stop. @param swing, size  as text
std::string lever(const std::string& swing, const std::string& size) {
    return R"json({"fettle_scene": 1, "units": "mm", "timestep": 0.1, "end_time": 1,
        "variables": {"arm": "50 mm", "swing": ")json" +
           swing + R"json(", "size": ")json" + size + R"json("},
        "bodies": [
          {"name": "lever", "density": 1000, "position": ["= arm / 2", 0, 0],
           "shape": {"part": "box", "dimensions": {"size_x": "= arm", "size_y": 6, "size_z": 6}}},
          {"name": "stop", "type": "static", "position": [35, 40, 0],
           "shape": {"part": "box", "dimensions": {"size_x": "= size", "size_y": 10, "size_z": 10}}}],
        "joints": [{"name": "hinge", "type": "revolute", "b": "lever", "point": [0, 0, 0], "axis": [0, 0, 1]}],
        "motors": [{"name": "drive", "joint": "hinge", "angle": {"times": [0, 0.4, 1], "values": [0, "= swing", "= swing"]}}]})json";
}

}  // namespace

TEST_CASE("How far a motor goes deviates: the lever made anew at the end of its tolerance", "[toleranced]") {
    tests::support::TemporaryFolder folder;
    folder.write("x.scene.json", lever("30 deg", "10 mm"));
    folder.write("x.design.json", R"json({"fettle_design": 1, "scene": "x.scene.json", "units": "mm",
        "parameters": [{"name": "arm", "lower": 40, "upper": 60}], "objective": [{"type": "mass", "bodies": ["lever"]}],
        "tolerances": {"swing": "+-2 deg", "size": "+-0.1 mm"}})json");
    const auto read = [&](const std::string& file, bool tolerances) {
        SubjectOptions options;
        options.path = folder.file(file);
        options.kinematic = true;
        options.tolerances = tolerances;
        Result<Subject> found = read_subject(options, {});
        for (const Error& error : found.errors()) UNSCOPED_INFO(error.where << ": " << error.message);
        REQUIRE(found);
        return *std::move(found);
    };
    const Subject subject = read("x.design.json", true);
    const PairClearance found = of_arm_and_slide(subject);
    CHECK(found.deviations.size() == 2);
    double least = 1;
    for (const char* swing : {"28 deg", "32 deg"})
        for (const char* size : {"9.9 mm", "10.1 mm"}) {
            folder.write("anew.scene.json", lever(swing, size));
            const Subject anew = read("anew.scene.json", false);
            ClearanceOptions over_motion;
            over_motion.motion = true;
            least = std::min(least, certify(anew.model, anew.domain, {{0, 1}}, over_motion).front().upper);
        }
    INFO(found.lower << " " << found.upper << " anew " << least);
    CHECK(found.lower <= least);
    CHECK(found.upper == Approx(least).margin(1e-5));  // along the path the lever's corners are cut by a little
    CHECK(found.upper < 7e-3);
    ClearanceOptions options;
    options.tolerance = 1e-5;
    const auto proven = certify_with_proof(subject.model, subject.domain, {{0, 1}}, options);
    REQUIRE(write_certificate(folder.file("x.certificate.json"), proven.certificate).empty());
    const auto stored = core::certificate::read_certificate(folder.file("x.certificate.json"));
    REQUIRE(stored);
    CHECK(same_toleranced(*stored->toleranced, *subject.domain.made()));
    CHECK(core::certificate::check_certificate(*stored, subject.model, subject.domain.path()).accepted());
    // Without the curve's formulas, or with less of them, it is another claim.
    core::certificate::Certificate damaged = *stored;
    damaged.toleranced->bodies[0].screws[0].driven.reset();
    CHECK_FALSE(same_toleranced(*damaged.toleranced, *subject.domain.made()));
    damaged.toleranced->bodies[0].screws[0].driven = {9999, 0};
    CHECK_FALSE(core::certificate::check_certificate(damaged, subject.model, subject.domain.path()).accepted());
}

}  // namespace fettle::design::clearance::toleranced_motion_test
