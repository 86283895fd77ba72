// SPDX-License-Identifier: MIT
// A mesh file with handles, as a scene and a design have it: beside a kernel part, with exact derivatives, within tolerances; refusals.
#include "design/shapes/handled_part.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>

#include "core/clearance/domain.hpp"
#include "core/mesh_files/mesh_reader.hpp"
#include "core/mesh_files/mesh_writer.hpp"
#include "design/clearance/read_subject.hpp"
#include "design/problem/design_problem.hpp"
#include "design/reading/design_reader.hpp"
#include "design/reading/scene_shapes.hpp"
#include "design/shapes/file_part.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fettle::design::shapes::handled_part_test {

namespace {

using tests::support::TemporaryFolder;

// The kernel's plate with a hole of 4 mm, as an STL in mm, and a pin of the kernel in it.
struct Files : TemporaryFolder {
    Files() {
        const auto plate = FilePart::create("plate_with_hole", {{"hole_radius", 4e-3}});
        if (!plate) FAIL(plate.errors().front().message);
        core::geometry::Mesh mesh = description::drawn_mesh(**plate).value();
        mesh.deviation.reset();
        write("plate.stl", core::mesh_files::stl_bytes({{.name = "plate", .mesh = &mesh}}));
    }

    std::string scene(const std::string& handles, const std::string& dimensions, const std::string& more = "") const {
        return R"({"fettle_scene": 1, "units": "mm", "timestep": 0.01, "variables": {"bore": "4.1 mm", "pin": "3.7 mm", "wide": "0 mm"}, "bodies": [
          {"name": "plate", "type": "static", "density": 1000, "shape": {"mesh": "plate.stl", )" +
               more + R"("handles": )" + handles + R"(, "dimensions": )" + dimensions + R"(}},
          {"name": "pin", "type": "static", "density": 1000, "shape": {"part": "cylinder", "dimensions": {"radius": "= pin", "length": 60}},
           "position": [0.02, 0.01, 0]}]})";
    }

    Result<core::scene::Scene> read(const std::string& text) const {
        return core::scene_files::read_scene(write("a.scene.json", text), reading::scene_read_options());
    }
    std::string fault(const std::string& handles, const std::string& dimensions, const std::string& more = "") const {
        const auto scene_read = read(scene(handles, dimensions, more));
        std::string out;
        for (const Error& error : scene_read.errors()) out += error.where + ": " + error.message + "\n";
        return out;
    }
};

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

const char* const bore = R"({"bore": {"bores": ["B1"]}})";
const char* const bore_and_width = R"({"bore": {"bores": ["B1"]}, "wide": {"stretch": "x", "from": 12, "to": 15}})";

}  // namespace

TEST_CASE("handled part: a scene's mesh has the dimensions that its handles give it") {
    const Files files;
    const auto plain = files.read(files.scene(bore, "{}")), wide = files.read(files.scene(bore, R"({"bore": 4.5})"));
    REQUIRE(plain);
    REQUIRE(wide);
    const auto nearest = [](const core::scene::Scene& scene) {
        return scene.bodies[0].mesh.vertices.topRows<2>().colwise().norm().minCoeff();
    };
    CHECK(nearest(*wide) / nearest(*plain) == Approx(4.5 / 4).epsilon(1e-3));
    const auto bound = files.read(files.scene(bore_and_width, R"({"bore": "= bore", "wide": "= 2 * wide"})"));
    REQUIRE(bound);
    REQUIRE(bound->numbers.size() == 3);
    CHECK(bound->numbers[0].place == "/bodies/0/shape/dimensions/bore");
}

TEST_CASE("handled part: faults name the handle and the place in the file") {
    const Files files;
    CHECK(contains(files.fault(R"({"bore": {"bores": ["B7"]}})", "{}"),
                   "/bodies/0/shape: bore: the mesh has no feature `B7`; of that kind it has: B1"));
    CHECK(contains(files.fault(R"({"bore": {"bored": ["B1"]}})", "{}"), "/handles/bore: what the handle moves is missing"));
    CHECK(contains(files.fault(R"({"bore": {"bores": ["B1"], "from": 3}})", "{}"), "/handles/bore/from"));
    CHECK(contains(files.fault(R"({"l": {"stretch": "x", "from": 3, "to": 2}})", "{}"), "/handles/l/to: more than `from`"));
    CHECK(contains(files.fault(R"({"m": {"move": "x"}})", "{}"), "`features`, or what is `inside`"));
    CHECK(contains(files.fault(R"({"m": {"morph": "none.stl"}})", "{}"), "none.stl"));
    CHECK(contains(files.fault("{}", "{}"), "a handle is expected"));
    CHECK(contains(files.fault(bore, R"({"boer": 4})"), "there is no handle 'boer'; did you mean \"bore\"?"));
    CHECK(contains(files.fault(bore, R"({"bore": 40})"), "/bodies/0/shape: B1: "));
    CHECK(contains(files.fault(bore, R"({"bore": 4.5})", R"("wall": 500, )"), "B1: a wall of "));
    CHECK(contains(files.fault(bore, R"({"bore": "30deg"})"), "deg"));
    const std::string beside =
        R"({"fettle_scene": 1, "units": "mm", "bodies": [{"name": "a", "density": 1, "mesh": "plate.stl", "handles": {}}]})";
    const auto misplaced = files.read(beside);
    REQUIRE_FALSE(misplaced);
    CHECK(std::any_of(misplaced.errors().begin(), misplaced.errors().end(),
                      [](const Error& error) { return contains(error.message, "write \"shape\": {\"mesh\""); }));
}

TEST_CASE("handled part: a design leaves as a scene into another folder, whose files are found from there") {
    const Files files;
    std::filesystem::create_directories(files.file("out"));
    const auto wider = core::features::HandledMesh::create(core::mesh_files::read_mesh(files.file("plate.stl"), {.unit = 1e-3}).value(),
                                                           {{.name = "bore", .features = {"B1"}}});
    REQUIRE(wider);
    const core::geometry::Mesh other = wider->at({4.5e-3}).value();
    files.write("other.stl", core::mesh_files::stl_bytes({{.name = "other", .mesh = &other}}));
    files.write("a.scene.json",
                files.scene(R"({"bore": {"bores": ["B1"]}, "like": {"morph": "other.stl"}})", R"({"bore": "= bore", "like": 0.1})"));
    files.write("a.design.json", R"({"fettle_design": 1, "scene": "a.scene.json", "units": "mm", "simulation": {"steps": 1},
        "parameters": [{"name": "bore", "value": 4.3, "lower": 3.5, "upper": 5}], "objective": [{"type": "mass", "bodies": ["plate"]}]})");
    const auto answer = tests::support::run("export " + files.file("a.design.json") + " --to " + files.file("out/b.scene.json"), true);
    CAPTURE(answer.out);
    REQUIRE(answer.code == 0);
    const auto written = core::scene_files::read_scene(files.file("out/b.scene.json"), reading::scene_read_options());
    REQUIRE(written);
    CHECK(written->bodies[0].shape->dimensions.at("bore") == Approx(4.3e-3));
}

TEST_CASE("handled part: a bore of an STL is tuned beside a kernel part, with exact derivatives") {
    const Files files;
    files.write("a.scene.json", files.scene(bore_and_width, R"({"bore": "= bore", "wide": "= wide"})"));
    files.write("a.design.json", R"({"fettle_design": 1, "scene": "a.scene.json", "units": "mm", "simulation": {"steps": 1},
        "parameters": [{"name": "bore", "lower": 3.5, "upper": 5}, {"name": "pin", "lower": 3, "upper": 4}, {"name": "wide", "lower": -1, "upper": 4}],
        "objective": [{"type": "mass", "bodies": ["plate"]}],
        "constraints": [{"type": "clearance", "a": "plate", "b": "pin", "minimum": 0.3}],
        "tolerances": {"bore": "+-0.05 mm", "pin": "+-0.02 mm"}})");
    auto file = reading::read_design(files.file("a.design.json"));
    if (!file) FAIL(file.errors().front().where + file.errors().front().message);
    const auto problem = problem::DesignProblem::create(std::move(file->design));
    if (!problem) FAIL(problem.errors().front().where + problem.errors().front().message);
    VectorX p(3);
    p << 4.15e-3, 3.68e-3, 0.7e-3;
    const auto here = problem->evaluate(p);
    REQUIRE(here.usable);
    for (Eigen::Index k = 0; k < p.size(); ++k) {
        const double step = 1e-6;
        VectorX less = p, more = p;
        less[k] -= step;
        more[k] += step;
        const auto before = problem->evaluate(less), after = problem->evaluate(more);
        CAPTURE(k);
        const double of_mass = (after.objective - before.objective) / (2 * step),
                     of_gap = (after.constraints[0].value - before.constraints[0].value) / (2 * step);
        CHECK(here.gradient[k] == Approx(of_mass).epsilon(1e-7).margin(1e-9));
        CHECK(here.jacobian(0, k) == Approx(of_gap).epsilon(1e-7).margin(1e-7));
    }

    // Within tolerances: the box of deviations against the design made anew at its corners.
    clearance::SubjectOptions options;
    options.path = files.file("a.design.json");
    options.tolerances = true;
    const auto subject = clearance::read_subject(options, {});
    if (!subject) FAIL(subject.errors().front().where + subject.errors().front().message);
    core::clearance::ClearanceOptions search;
    const auto pair = core::clearance::certify(subject->model, subject->domain, {{0, 1}}, search).front();
    double least = 1;
    for (const double b : {4.05, 4.15})
        for (const double r : {3.68, 3.72}) {
            VectorX corner(3);
            corner << 1e-3 * b, 1e-3 * r, 0;
            const auto model = problem->model_at(corner);
            REQUIRE(model);
            least = std::min(least, core::clearance::certify(*model, core::clearance::as_started(*model), {{0, 1}}, search).front().upper);
        }
    CHECK(pair.lower > 0);
    CHECK(pair.lower <= least);
    CHECK(pair.upper == Approx(least).epsilon(1e-4));
}

}  // namespace fettle::design::shapes::handled_part_test
