// SPDX-License-Identifier: MIT
#include "fettle/design/studies/resolution.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "fettle/design/problem/design_problem.hpp"
#include "fettle/tests/support/temporary_folder.hpp"

namespace fettle::design::studies::resolution_test {

namespace {

// A round post that falls freely, beside a block of a mesh that the scene writes itself.
const char* const scene = R"({"fettle_scene": 1, "units": "mm", "gravity": [0, 0, -9.81], "timestep": 0.01, "end_time": 0.2,
    "bodies": [
      {"name": "post", "density": 1000, "shape": {"part": "cylinder", "dimensions": {"radius": 5, "length": 10}, "counts": {"segments": 24}}},
      {"name": "block", "type": "static", "position": [20, 0, 0],
       "vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], "triangles": [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]}]})";
const char* const design = R"({"fettle_design": 1, "scene": "post.scene.json", "units": "mm",
    "parameters": [{"name": "length", "value": 10, "lower": 5, "upper": 20}], "set": {"/bodies/post/shape/dimensions/length": "= length"},
    "objective": [{"type": "mass", "bodies": ["post"]}],
    "constraints": [{"type": "stroke", "body": "post", "axis": [0, 0, 1], "upper": 500}]SCENARIOS})";

struct Folder : tests::support::TemporaryFolder {
    explicit Folder(const std::string& scenarios = "") {
        write("post.scene.json", scene);
        std::string text = design;
        write("post.design.json", text.replace(text.find("SCENARIOS"), 9, scenarios));
    }
    std::string path() const { return file("post.design.json"); }
};

}  // namespace

TEST_CASE("resolution: facets change what they make, and the time step what falls, as their closed forms say") {
    const Folder folder;
    const auto report = check_resolution(folder.path(), {});
    REQUIRE(report);
    CHECK(report->failure.empty());
    CHECK(report->fixed_meshes == std::vector<std::string>{"block"});
    REQUIRE(report->quantities.size() == 2);
    // A polygon round a circle: area n r^2 tan(pi / n).
    const ResolvedQuantity& mass = report->quantities[0];
    const auto about = [](int n) { return n * std::tan(std::numbers::pi / n); };
    CHECK(mass.of_objective);
    CHECK(mass.as_written == Approx(about(24) * 25e-6 * 10e-3 * 1000));
    CHECK(mass.finer_facets == Approx(about(48) * 25e-6 * 10e-3 * 1000));
    CHECK(mass.finer_steps == mass.as_written);
    CHECK(mass.finer_both == mass.finer_facets);
    CHECK(mass.change() == Approx(1 - about(48) / about(24)));
    // Implicit Euler falls g h^2 n (n + 1) / 2 in n steps.
    const ResolvedQuantity& fall = report->quantities[1];
    CHECK(fall.as_written == Approx(9.81 * 0.2 * 0.21 / 2).epsilon(1e-6));
    CHECK(fall.finer_facets == Approx(fall.as_written).epsilon(1e-6));
    CHECK(fall.finer_steps == Approx(9.81 * 0.2 * 0.205 / 2).epsilon(1e-6));
    CHECK(fall.finer_both == Approx(fall.finer_steps).epsilon(1e-6));
}

TEST_CASE("resolution: scenarios are refined too, and contact is that of the design as written") {
    const Folder folder(R"(, "scenarios": [{"name": "a"}, {"name": "b", "set": {"/timestep": 0.02}}])");
    const auto report = check_resolution(folder.path(), {});
    REQUIRE(report);
    REQUIRE(report->quantities.size() == 3);
    CHECK(report->quantities[2].name == "stroke post [b]");
    CHECK(report->quantities[2].as_written == Approx(9.81 * 0.2 * 0.22 / 2).epsilon(1e-6));
    CHECK(report->quantities[2].finer_both == Approx(9.81 * 0.2 * 0.21 / 2).epsilon(1e-6));
}

TEST_CASE("resolution: what cannot be measured says which") {
    const Folder folder;
    ResolutionOptions options;
    int asked = 0;
    options.should_stop = [&] { return ++asked > 3; };
    const auto stopped = check_resolution(folder.path(), {}, options);
    REQUIRE(stopped);
    CHECK(stopped->interrupted);
    CHECK(stopped->failure.starts_with("as written: "));
    CHECK_FALSE(check_resolution(folder.file("none.design.json"), {}));
}

}  // namespace fettle::design::studies::resolution_test
