// SPDX-License-Identifier: MIT
/// Parts from other programs: what a command must name, how one is run, which are refused, and that none runs unasked. The program here is
/// a script of the shell's, which writes a box.
#include "design/shapes/mesh_program.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "design/problem/design_problem.hpp"
#include "design/reading/design_reader.hpp"
#include "design/reading/model_file.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/text.hpp"

namespace fettle::design::shapes::mesh_program_test {

namespace {

using Dimensions = std::vector<description::ShapeDimension>;

// Writes a tetrahedron with one edge of the length that it is given, in the folder that it runs in it looks for.
constexpr const char* script =
    "#!/bin/sh\n"
    "echo \"$2\" >> \"$(dirname \"$0\")/it_ran\"\n"
    "case \"$2\" in -*) echo 'a negative length' >&2; exit 4;; esac\n"
    "printf 'OFF\\n4 4 0\\n0 0 0\\n%s 0 0\\n0 10 0\\n0 0 10\\n3 0 2 1\\n3 0 1 3\\n3 1 2 3\\n3 0 3 2\\n' \"$2\" > \"$1\"\n";

struct Shop {
    tests::support::TemporaryFolder folder;
    MeshProgram program;
    Shop() {
        folder.write("part.sh", script);
        program = {.command = {"sh", "part.sh", "{out}", "{length}"}, .directory = folder.path.string(), .format = "off", .unit = 1e-3};
    }
    bool ran() const { return std::filesystem::exists(folder.path / "it_ran"); }
    std::ptrdiff_t all_runs() const {
        std::ifstream lines(folder.path / "it_ran");
        return std::distance(std::istream_iterator<std::string>(lines), {});
    }
    // How often it made a part of that length.
    std::ptrdiff_t runs(const std::string& length) const {
        std::ifstream lines(folder.path / "it_ran");
        return std::count(std::istream_iterator<std::string>(lines), {}, length);
    }
};

const Dimensions length{{"length", 0.0125}};

}  // namespace

TEST_CASE("a program makes a part, in its own unit, in its own folder") {
    const Shop shop;
    const auto part = ProgramPart::create(shop.program, length);
    REQUIRE(part);
    const auto drawn = description::as_drawn(**part);
    INFO((drawn ? "" : drawn.errors()[0].message));
    REQUIRE(drawn);
    CHECK(drawn->mesh.vertices.row(0).maxCoeff() == Approx(0.0125));
    CHECK(drawn->mesh.triangles.size() == 4);
    Matrix3X expected = Matrix3X::Zero(3, 4);
    expected(0, 3) = 1;  // in the order of their coordinates it is the last
    CHECK((drawn->jacobian[0] - expected).cwiseAbs().maxCoeff() < 1e-9);
}

TEST_CASE("the same triangles written in another order are the same mesh") {
    const auto made = [](const char* rows) {
        const tests::support::TemporaryFolder folder;
        folder.write("part.off", std::string("OFF\n4 4 0\n") + rows);
        const MeshProgram copy{
            .command = {"sh", "-c", "cp part.off $0; : $1", "{out}", "{length}"}, .directory = folder.path.string(), .format = "off"};
        return run_program(copy, length, {1.0}).value();
    };
    const auto one = made("0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n");
    const auto other = made("0 0 1\n0 1 0\n1 0 0\n0 0 0\n3 1 3 0\n3 0 2 1\n3 2 3 1\n3 0 3 2\n");
    CHECK(one.vertices == other.vertices);
    CHECK(one.triangles == other.triangles);
}

TEST_CASE("what is wrong with a command is told") {
    Shop shop;
    const auto messages = [&](std::vector<std::string> command, const Dimensions& dimensions) {
        shop.program.command = std::move(command);
        std::string all;
        for (const Error& error : check_program(shop.program, dimensions)) all += error.message + "\n";
        return all;
    };
    CHECK(messages({"sh", "{out}", "{length}"}, length).empty());
    CHECK(messages({}, length).find("has a command") != std::string::npos);
    CHECK(messages({"sh", "{length}"}, length).find("{out}") != std::string::npos);
    CHECK(messages({"sh", "{out}"}, length).find("changes nothing") != std::string::npos);
    CHECK(messages({"sh", "{out}", "{lenght}{length}"}, length).find("did you mean \"length\"") != std::string::npos);
    CHECK(messages({"sh", "{out}"}, {}).find("has dimensions") != std::string::npos);
}

TEST_CASE("a program that fails, hangs, writes nothing or is not there is told with its last words") {
    Shop shop;
    const auto message = [&](double value) {
        const auto mesh = run_program(shop.program, length, {value});
        return mesh ? std::string() : mesh.errors()[0].message;
    };
    CHECK(message(0.01).empty());
    CHECK(message(-0.01).find("code 4") != std::string::npos);
    CHECK(message(-0.01).find("a negative length") != std::string::npos);
    shop.program.command = {"sh", "-c", "sleep 60", "{out}", "{length}"};
    shop.program.time_limit = 0.2;
    CHECK(message(0.01).find("longer than 0.2 s") != std::string::npos);
    shop.program.command = {"true", "{out}", "{length}"};
    CHECK(message(0.01).find("wrote no off file") != std::string::npos);
    shop.program.command = {"no_such_program_anywhere", "{out}", "{length}"};
    CHECK(message(0.01).find("could not be started") != std::string::npos);
    shop.program.command = {"sh", "-c", "echo nonsense > $0", "{out}", "{length}"};
    CHECK_FALSE(message(0.01).empty());
}

TEST_CASE("no program runs from a file alone") {
    const Shop shop;
    const std::string scene = R"({ "fettle_scene": 1, "units": "mm", "bodies": [ { "name": "part", "density": 1000, "shape": {
        "program": ["sh", "part.sh", "{out}", "{length}"], "format": "off", "dimensions": { "length": 12.5 } } } ] })";
    const std::string design = R"({ "fettle_design": 1, "scene": "a.scene.json", "units": "mm", "simulation": { "steps": 1 },
        "parameters": [ { "name": "length", "value": 12.5, "lower": 10, "upper": 20 } ], "set": { "/bodies/part/shape/dimensions/length": "= length" },
        "objective": [ { "type": "mass", "bodies": ["part"] } ] })";
    shop.folder.write("a.scene.json", scene);
    const std::string path = shop.folder.write("a.design.json", design);
    const auto refused = reading::read_design(path);
    REQUIRE_FALSE(refused);
    CHECK(refused.errors()[0].code == ErrorCode::unsupported);
    CHECK(refused.errors()[0].message.find("--allow-programs") != std::string::npos);
    CHECK_FALSE(shop.ran());
    const auto allowed = reading::read_design(path, {{}, reading::Programs::allowed});
    INFO((allowed ? "" : allowed.errors()[0].where + ": " + allowed.errors()[0].message));
    REQUIRE(allowed);
    CHECK(shop.ran());
    CHECK(shop.runs("12.5") == 1);
    CHECK_FALSE(allowed->warnings.empty());  // says how the derivative is found
    const auto problem = problem::DesignProblem::create(allowed->design);
    REQUIRE(problem);
    const auto at = problem->evaluate(VectorX::Constant(1, 0.0125));
    INFO(at.reason);
    REQUIRE(at.usable);
    // volume = length * 10 * 10 / 6 mm^3; grams per metre of length
    CHECK(at.gradient[0] == Approx(1000.0 * 1e-4 / 6 * 1000).epsilon(1e-6));
    CHECK(shop.runs("12.5") == 1);  // read, checked, built and simulated
}

TEST_CASE("fettle's own threads are all that it has: libraries of linear algebra, and programs, are told to have one") {
    const tests::support::TemporaryFolder folder;
    const std::string seen = folder.file("seen");
    const std::string path =
        folder.write("a.scene.json", R"({ "fettle_scene": 1, "units": "mm", "bodies": [ { "name": "part", "density": 1000, "shape": {
            "program": ["sh", "-c", "echo $OPENBLAS_NUM_THREADS $OMP_NUM_THREADS $MKL_NUM_THREADS $BLIS_NUM_THREADS > ')" +
                                         seen +
                                         R"('; cp part.off $0; : $1", "{out}", "{length}"],
            "format": "off", "dimensions": { "length": 12.5 } } } ] })");
    folder.write("part.off", "OFF\n4 4 0\n0 0 0\n10 0 0\n0 10 0\n0 0 10\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n");
    const auto told = [&](const std::string& before) {
        std::filesystem::remove(seen);
        const auto answer = tests::support::run("validate " + path + " --allow-programs", true, before);
        CAPTURE(answer.out);
        CHECK(answer.code == 0);
        return tests::support::contents(seen);
    };
    const std::string unset = "unset OPENBLAS_NUM_THREADS OMP_NUM_THREADS MKL_NUM_THREADS BLIS_NUM_THREADS; ";
    CHECK(told(unset) == "1 1 1 1\n");
    CHECK(told(unset + "export OPENBLAS_NUM_THREADS=3; ") == "3 1 1 1\n");  // what the user has set holds
}

TEST_CASE("parts that are alike are made once") {
    const Shop shop;
    const auto body = [](const std::string& name, const std::string& x) {
        return "{ \"name\": \"" + name + "\", \"density\": 1000, \"position\": [" + x + R"(, 0, 0], "shape": {
            "program": ["sh", "part.sh", "{out}", "{length}"], "format": "off", "dimensions": { "length": 12.5 } } })";
    };
    const std::string path = shop.folder.write(
        "a.scene.json", "{ \"fettle_scene\": 1, \"units\": \"mm\", \"bodies\": [" + body("one", "0") + ", " + body("two", "50") + "] }");
    const auto scene = core::scene_files::read_scene(path, reading::scene_read_options({}, reading::Programs::allowed));
    REQUIRE(scene);
    CHECK(scene->bodies[1].mesh.vertices == scene->bodies[0].mesh.vertices);
    CHECK(shop.runs("12.5") == 1);

    // What is to be said of their derivative is said once.
    const std::string design = shop.folder.write("a.design.json", R"({ "fettle_design": 1, "scene": "a.scene.json", "units": "mm",
        "parameters": [ { "name": "length", "value": 12.5, "lower": 10, "upper": 20 } ],
        "set": { "/bodies/one/shape/dimensions/length": "= length", "/bodies/two/shape/dimensions/length": "= length" },
        "objective": [ { "type": "mass", "bodies": ["one", "two"] } ] })");
    const auto file = reading::read_design(design, {{}, reading::Programs::allowed});
    REQUIRE(file);
    REQUIRE(file->warnings.size() == 1);
    CHECK(file->warnings[0].starts_with("bodies one, two: d/d length: "));
    CHECK(shop.all_runs() == 2 + 4);  // the scene's and the design's part as drawn, and the design's four beside it
}

TEST_CASE("a part is made once for a design that is read strictly, in which scenarios are simulated at the same time") {
    const Shop shop;
    shop.folder.write("a.scene.json", R"({ "fettle_scene": 1, "units": "mm", "bodies": [ { "name": "part", "density": 1000, "shape": {
        "program": ["sh", "part.sh", "{out}", "{length}"], "format": "off", "dimensions": { "length": 12.5 } } } ] })");
    const std::string path = shop.folder.write("a.design.json", R"({ "fettle_design": 1, "scene": "a.scene.json", "units": "mm",
        "simulation": { "steps": 1 }, "parameters": [ { "name": "length", "value": 12.5, "lower": 10, "upper": 20 } ],
        "set": { "/bodies/part/shape/dimensions/length": "= length" },
        "scenarios": [ { "name": "up", "set": { "/gravity": [0, 0, 1] } }, { "name": "down", "set": { "/gravity": [0, 0, -1] } } ],
        "objective": [ { "type": "mass", "bodies": ["part"] } ] })");
    reading::InputOptions options;
    options.programs = reading::Programs::allowed;
    options.strict = true;
    auto file = reading::open_design(path, options);
    for (const Error& error : file.errors()) UNSCOPED_INFO(error.where + ": " + error.message);
    REQUIRE(file);
    CHECK(shop.all_runs() == 1 + 4);
    const auto problem = problem::DesignProblem::create(std::move(file->design));
    REQUIRE(problem);
    CHECK(problem->evaluate(VectorX::Constant(1, 0.0125)).usable);
    CHECK(shop.all_runs() == 1 + 4);
    CHECK(problem->evaluate(VectorX::Constant(1, 0.015)).usable);
    CHECK(shop.all_runs() == 2 * (1 + 4));
}

}  // namespace fettle::design::shapes::mesh_program_test
