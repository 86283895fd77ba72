// SPDX-License-Identifier: MIT
// Clearance within tolerances, from design files: closed forms, designs that are made anew at samples of deviations and positions, and
// what is refused.
#include "core/clearance/toleranced_clearance.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "core/certificate/certificate_checker.hpp"
#include "design/clearance/certificate_claims.hpp"
#include "design/clearance/read_subject.hpp"
#include "design/clearance/report_json.hpp"
#include "design/problem/toleranced_bodies.hpp"
#include "tests/core/clearance/clearance_oracle.hpp"
#include "tests/design/two_bars.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fettle::design::clearance::toleranced_clearance_test {

namespace {

using core::certificate::Certificate;
using core::clearance::ClearanceOptions;
using core::clearance::PairClearance;
using core::clearance::PairStatus;
using tests::clearance::Real;
using tests::design_support::two_bars;

// A pin in the middle of a bore.
const char* const pin_in_bore = R"json({"fettle_scene": 1, "units": "mm", "timestep": 0.01,
    "variables": {"pin": "4.8 mm", "bore": "5 mm", "x": "0 mm", "y": "0 mm"},
    "bodies": [
      {"name": "plate", "type": "static", "shape": {"part": "washer", "counts": {"segments": 16},
       "dimensions": {"shaft_radius": "= bore", "clearance": "0.2 um", "wall": 3, "thickness": 4}}, "position": [0, 0, -2]},
      {"name": "pin", "type": "static", "density": 1240, "shape": {"part": "cylinder", "counts": {"segments": 16},
       "dimensions": {"radius": "= pin", "length": 12}}, "position": ["= x", "= y", 0]},
      {"name": "far", "type": "static", "shape": {"part": "box", "dimensions": {"size_x": 2, "size_y": 2, "size_z": 2}},
       "position": [30, 0, 0]}]})json";
const char* const pin_design = R"json({"fettle_design": 1, "scene": "x.scene.json", "units": "mm", "simulation": {"steps": 1},
    "parameters": [{"name": "pin", "lower": 4, "upper": 5}],
    "objective": [{"type": "mass", "bodies": ["pin"]}],
    "tolerances": {"pin": "+-0.02 mm", "bore": {"lower": -0.01, "upper": 0.03}, "x": "+-0.03 mm", "y": "+-0.03 mm"}})json";

const char* const bars_design = R"json({"fettle_design": 1, "scene": "x.scene.json", "units": "mm", "simulation": {"steps": 1},
    "parameters": [{"name": "upper_length", "lower": 50, "upper": 70}],
    "objective": [{"type": "mass", "bodies": ["fore"]}],
    "tolerances": {"upper_length": "+-0.1 mm", "fore_length": {"lower": -0.3, "upper": 0.2}, "width": "+-0.1 mm", "post_at": "+-0.4 mm",
                   "/bodies/upper/density": "+-1"}})json";

struct Folder : tests::support::TemporaryFolder {
    Folder(const std::string& scene, const std::string& design) {
        write("x.scene.json", scene);
        write("x.design.json", design);
    }
    Result<Subject> read(bool ranges) {
        SubjectOptions options;
        options.path = file("x.design.json");
        options.tolerances = true;
        options.ranges = ranges;
        return read_subject(options, {});
    }
    Subject subject(bool ranges) {
        Result<Subject> read_one = read(ranges);
        for (const Error& error : read_one.errors()) UNSCOPED_INFO(error.where << ": " << error.message);
        REQUIRE(read_one);
        return *std::move(read_one);
    }
};

std::string fault_of(const std::string& scene, const std::string& design, bool ranges) {
    Folder folder(scene, design);
    const Result<Subject> subject = folder.read(ranges);
    return subject ? "" : subject.errors().front().where + ": " + subject.errors().front().message;
}

int body_named(const Subject& subject, const std::string& name) {
    for (int i = 0; i < count_of(subject.model.bodies); ++i)
        if (subject.model.bodies[i].name == name) return i;
    FAIL(name);
    return -1;
}

PairClearance certified(const Subject& subject, const std::string& a, const std::string& b, double tolerance = 1e-7) {
    ClearanceOptions options;
    options.tolerance = tolerance;
    return certify(subject.model, subject.domain, {{body_named(subject, a), body_named(subject, b)}}, options).front();
}

// In alphabetical order: what a design lists is a set.
std::vector<std::string> names_of(const Subject& subject, const std::vector<int>& deviations) {
    std::vector<std::string> out;
    for (const int k : deviations) out.push_back(subject.domain.made()->deviations[k].of);
    std::sort(out.begin(), out.end());
    return out;
}

core::certificate::Deviation& deviation_of(core::certificate::Toleranced& toleranced, const std::string& name) {
    const auto found =
        std::find_if(toleranced.deviations.begin(), toleranced.deviations.end(), [&](const auto& each) { return each.of == name; });
    REQUIRE(found != toleranced.deviations.end());
    return *found;
}

double worst_of(const Subject& subject, const PairClearance& found, const std::string& name) {
    for (std::size_t k = 0; k < found.deviations.size(); ++k)
        if (subject.domain.made()->deviations[found.deviations[k]].of == name) return found.deviations_at[k];
    FAIL(name);
    return 0;
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
    const auto at = text.find(what);
    REQUIRE(at != std::string::npos);
    return text.replace(at, what.size(), by);
}

core::certificate::CertificateReport checked(const Certificate& certificate, const Subject& subject) {
    return core::certificate::check_certificate(certificate, subject.model, subject.domain.path());
}

}  // namespace

TEST_CASE("A pin in a bore, as assembled, against the closed form", "[toleranced]") {
    Folder folder(pin_in_bore, pin_design);
    const Subject subject = folder.subject(false);
    // Polygons of 16 sides that lie parallel: flats of the pin touch its circle, vertices of the bore lie on theirs; the pin is moved
    // towards the flat at 45 degrees.
    const double bore = 5e-3 + 0.2e-6 - 0.01e-3, pin = 4.82e-3;
    const auto towards = [](double angle) { return 0.03e-3 * (std::abs(std::cos(angle)) + std::abs(std::sin(angle))); };
    double wanted = 1;
    for (int k = 0; k < 16; ++k) wanted = std::min(wanted, bore * std::cos(M_PI / 16) - pin - towards((k + 0.5) * 2 * M_PI / 16));
    const PairClearance found = certified(subject, "pin", "plate");
    INFO(found.lower << " " << found.upper << " " << found.bounds << " " << found.reason);
    CHECK(found.lower <= wanted + 1e-12);
    CHECK(found.upper >= wanted - 1e-12);
    CHECK(found.upper - found.lower <= 1e-7);
    CHECK(found.solids == core::certificate::Solids::disjoint);
    CHECK(names_of(subject, found.deviations) == std::vector<std::string>{"bore", "pin", "x", "y"});
    CHECK(worst_of(subject, found, "pin") == Approx(0.02e-3));
    CHECK(worst_of(subject, found, "bore") == Approx(-0.01e-3));
    CHECK(found.bounds < 20000);
    // Deviations without influence are proven so.
    const PairClearance other = certified(subject, "plate", "far");
    CHECK(names_of(subject, other.deviations) == std::vector<std::string>{"bore"});
    CHECK(deviations_without_influence(subject, other) == std::vector<std::string>{"pin", "x", "y"});
    const double least = 29e-3 - (5e-3 + 0.2e-6 + 0.03e-3 + 3e-3);  // a vertex of the rim, or a flat, on the axis
    CHECK(std::abs(other.upper - least) < 0.2e-3);
}

TEST_CASE("Two bars over all positions, against the closed form", "[toleranced]") {
    Folder folder(two_bars, bars_design);
    const Subject subject = folder.subject(true);
    const double wanted = (115e-3 - 0.4e-3) - (60.1e-3 + std::hypot(40.2e-3, 6.05e-3));
    const PairClearance found = certified(subject, "fore", "post", 1e-6);
    INFO(found.lower << " " << found.upper << " wanted " << wanted << " bounds " << found.bounds);
    CHECK(found.lower <= wanted + 1e-12);
    CHECK(found.upper >= wanted - 1e-12);
    CHECK(found.upper - found.lower <= 1e-6);
    CHECK(names_of(subject, found.deviations) == std::vector<std::string>{"fore_length", "post_at", "upper_length", "width"});
    CHECK(found.coordinates.size() == 2);
    CHECK(found.solids == core::certificate::Solids::disjoint);
    // As assembled the bars lie along the axis.
    const PairClearance still = certified(folder.subject(false), "fore", "post");
    CHECK(still.lower <= 115e-3 - 0.4e-3 - 100.3e-3 + 1e-12);
    CHECK(still.upper == Approx(115e-3 - 0.4e-3 - 100.3e-3).epsilon(1e-9));
}

TEST_CASE("Its certificate is checked, and damaged ones are rejected", "[toleranced]") {
    Folder folder(two_bars, bars_design);
    const Subject subject = folder.subject(true);
    ClearanceOptions options;
    options.tolerance = 1e-4;
    const int a = body_named(subject, "fore"), b = body_named(subject, "post");
    const auto proven = certify_with_proof(subject.model, subject.domain, {{a, b}}, options);
    const Certificate& certificate = proven.certificate;
    REQUIRE(certificate.pairs.size() == 1);
    const core::certificate::PairCertificate& pair = certificate.pairs.front();
    CHECK(pair.lower > 0);
    CHECK(pair.upper - pair.lower <= 1e-4);
    {
        const auto report = checked(certificate, subject);
        for (const auto& fault : report.faults) UNSCOPED_INFO(fault.where << ": " << fault.message);
        CHECK(report.accepted());
        CHECK(report.leaves > 10);
    }
    REQUIRE(write_certificate(folder.file("x.certificate.json"), certificate).empty());
    const auto read = core::certificate::read_certificate(folder.file("x.certificate.json"));
    for (const Error& error : read.errors()) UNSCOPED_INFO(error.where << ": " << error.message);
    REQUIRE(read);
    REQUIRE(read->toleranced);
    CHECK(same_toleranced(*read->toleranced, *subject.domain.made()));
    CHECK(checked(*read, subject).accepted());
    const auto is_rejected = [&](const auto& damage) {
        Certificate damaged = certificate;
        damage(damaged);
        return !checked(damaged, subject).accepted();
    };
    CHECK(is_rejected([](Certificate& c) { c.pairs[0].lower += 3e-4; }));
    CHECK(is_rejected([](Certificate& c) { c.pairs[0].upper -= 1e-7; }));
    CHECK(is_rejected([](Certificate& c) { c.pairs[0].upper += 1e-7; }));
    CHECK(is_rejected([](Certificate& c) { deviation_of(*c.toleranced, "upper_length").upper *= 1.5; }));
    CHECK(is_rejected([](Certificate& c) { deviation_of(*c.toleranced, "post_at").lower *= 1.5; }));
    CHECK(is_rejected([](Certificate& c) { deviation_of(*c.toleranced, "upper_length").base = 1; }));
    CHECK(is_rejected([](Certificate& c) { c.toleranced->coordinates[0].high += 1; }));
    CHECK(is_rejected([&](Certificate& c) { c.toleranced->bodies[static_cast<std::size_t>(a)].screws.clear(); }));
    CHECK(is_rejected([&](Certificate& c) { c.toleranced->bodies[static_cast<std::size_t>(a)].vertices.clear(); }));
    CHECK(is_rejected([&](Certificate& c) { c.toleranced->bodies[static_cast<std::size_t>(a)].parent = a; }));
    CHECK(is_rejected([](Certificate& c) { c.toleranced->nodes[0].operands[0] = 99; }));
    CHECK(is_rejected([](Certificate& c) { c.toleranced.reset(); }));
    CHECK(is_rejected([](Certificate& c) { c.pairs[0].boxes[0].splits.back() = 'a'; }));
    CHECK(is_rejected([](Certificate& c) { c.pairs[0].boxes[0].splits.pop_back(); }));
    CHECK(is_rejected([](Certificate& c) { c.pairs[0].boxes[0].normals.pop_back(); }));
    CHECK(is_rejected([](Certificate& c) { c.pairs[0].at[0] += 10; }));
    CHECK(is_rejected([](Certificate& c) { c.motion = true; }));
    // Every leaf counts.
    std::mt19937 random(7);
    int missed = 0;
    for (int i = 0; i < 20; ++i)
        missed += is_rejected([&](Certificate& c) {
            Vector3& n = c.pairs[0].boxes[0].normals[random() % c.pairs[0].boxes[0].normals.size()];
            n = -n;
        })
                      ? 0
                      : 1;
    CHECK(missed == 0);
}

TEST_CASE("What cannot be proven within tolerances is refused by name", "[toleranced]") {
    const std::string scene = two_bars, design = bars_design;
    SECTION("a scene has no tolerances") {
        Folder folder(scene, design);
        SubjectOptions options;
        options.path = folder.file("x.scene.json");
        options.tolerances = true;
        const auto subject = read_subject(options, {});
        REQUIRE_FALSE(subject);
        CHECK_THAT(subject.errors().front().message, Catch::Contains("a scene alone has none"));
    }
    SECTION("a design without") {
        const std::string without = replaced(design, R"("tolerances")", R"("# tolerances")");
        CHECK_THAT(fault_of(scene, without, true), Catch::Contains("it has no `tolerances`"));
    }
    SECTION("limits of joints") {
        const std::string more = replaced(design, R"("width": "+-0.1 mm")", R"("/joints/elbow/limits/1": "+-1 deg")");
        CHECK_THAT(fault_of(scene, more, true), Catch::Contains("`/joints/elbow/limits/1` moves the limits of joint `elbow`"));
    }
    SECTION("axes of joints") {
        const std::string more = replaced(design, R"("width": "+-0.1 mm")", R"("/joints/elbow/axis_a/0": "+-0.01")");
        CHECK_THAT(fault_of(scene, more, true), Catch::Contains("the axis or the pitch of joint `elbow`"));
    }
    SECTION("rotations of bodies that joints hold") {
        const std::string more = replaced(design, R"("width": "+-0.1 mm")", R"("/bodies/fore/rotation/2": "+-1 deg")");
        const std::string in_frames =
            replaced(scene, R"("point": ["= upper_length", 0, 0], "axis": [0, 0, 1])",
                     R"("point_a": ["= upper_length", 0, 0], "point_b": [0, 0, 0], "axis_a": [0, 0, 1], "axis_b": [0, 0, 1])");
        CHECK_THAT(fault_of(in_frames, more, true), Catch::Contains("the rotation of body `fore`"));
        CHECK_THAT(fault_of(scene, more, true), Catch::Contains("joint `elbow` is given in the world"));
    }
    SECTION("parts that are not made everywhere") {
        const std::string more = replaced(design, R"("width": "+-0.1 mm")", R"("width": "+-12 mm")");
        CHECK_THAT(fault_of(scene, more, true), Catch::Contains("within the tolerances it cannot be made"));
    }
    SECTION("parts that are made of other facets at an end") {
        // 20 segments of the ball's arc turn by 150 degrees just: with a thinner neck it would have 21.
        const char* const stud = R"json({"fettle_scene": 1, "units": "mm", "variables": {"neck": "2.5 mm"}, "bodies": [
            {"name": "stud", "type": "static", "density": 1000, "shape": {"part": "ball_stud", "dimensions": {"neck_radius": "= neck"}}},
            {"name": "box", "type": "static", "position": [30, 0, 0],
             "shape": {"part": "box", "dimensions": {"size_x": 2, "size_y": 2, "size_z": 2}}}]})json";
        const auto design_of = [](const std::string& deviation) {
            return R"json({"fettle_design": 1, "scene": "x.scene.json", "units": "mm",
                "parameters": [{"name": "neck", "lower": 2, "upper": 3}], "objective": [{"type": "mass", "bodies": ["stud"]}],
                "tolerances": {"neck": )json" +
                   deviation + "}}";
        };
        CHECK_THAT(fault_of(stud, design_of(R"("+-0.01 mm")"), false),
                   Catch::Contains("body stud: its part is made of other facets") && Catch::Contains("segments of `ball`: 21, not 20"));
        CHECK(fault_of(stud, design_of(R"({"lower": 0, "upper": 0.01})"), false).empty());
        CHECK_THAT(fault_of(stud, design_of(R"({"lower": -0.02, "upper": -0.01})"), false), Catch::Contains("21, not 20"));
        const std::string other = replaced(stud, R"("part": "ball_stud",)", R"("part": "ball_stud", "counts": {"segments": 49},)");
        CHECK(fault_of(other, design_of(R"("+-0.01 mm")"), false).empty());
    }
    SECTION("more than eight that matter") {
        std::string many = R"("width": "+-0.1 mm")";
        for (const char* place : {"post/shape/dimensions/size_y", "post/shape/dimensions/size_z", "fore/shape/dimensions/size_z",
                                  "post/position/1", "post/position/2", "post/shape/dimensions/size_x"})
            many += std::string(", \"/bodies/") + place + "\": \"+-0.01 mm\"";
        Folder folder(scene, replaced(design, R"("width": "+-0.1 mm")", many));
        const PairClearance found = certified(folder.subject(false), "fore", "post");
        CHECK(found.status == PairStatus::undecided);
        CHECK_THAT(found.reason, Catch::Contains("tolerances matter for the two; at most 8") && Catch::Contains("`post_at`"));
    }
}

// Which went on for 4 million bounds for a gap of a nanometre.
TEST_CASE("Within tolerances a search ends where the minimum is decided", "[toleranced]") {
    Folder folder(two_bars, bars_design);
    const Subject subject = folder.subject(true);
    const auto judged = [&](double minimum, bool proof) {
        Question question;
        question.pairs.pairs = "fore:post";
        question.pairs.minimum = minimum;
        question.proof = proof;
        return judge_clearances(subject, question)->pairs.front().least;
    };
    for (const bool proof : {false, true}) {
        const PairClearance far = judged(1e-7, proof), near = judged(30e-3, proof);
        INFO(far.lower << " " << far.upper << " " << far.bounds << ", " << near.lower << " " << near.upper << " " << near.bounds);
        CHECK(far.status == PairStatus::clear);
        CHECK(far.bounds < 50'000);
        CHECK(far.upper - far.lower <= 0.2 * far.lower);
        CHECK(near.status == PairStatus::violated);
        CHECK(near.bounds < 50'000);
        CHECK(near.complete);
    }
}

}  // namespace fettle::design::clearance::toleranced_clearance_test
