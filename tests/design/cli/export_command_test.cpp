// SPDX-License-Identifier: MIT
// `export` and `draw` as a user runs them, and certificates that name exported files.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/text.hpp"

namespace fettle::design::cli::export_command_test {

namespace {

using fettle::tests::support::Answer;
using fettle::tests::support::contents;
using fettle::tests::support::run;
using fettle::tests::support::TemporaryFolder;

/// Two boxes 1 mm apart, one of which falls; the other with a name that no file can have.
std::string scene(const TemporaryFolder& folder, const std::string& gravity = "[0, 0, -9.81]") {
    return folder.write("fall.scene.json",
                        R"({"fettle_scene": 1, "units": "mm", "gravity": )" + gravity + R"(, "timestep": 0.002, "end_time": 0.006,
        "bodies": [
            {"name": "low/er", "type": "static", "shape": {"part": "box"}, "position": [0, 0, -10]},
            {"name": "upper", "density": 1000, "shape": {"part": "box", "dimensions": {"size_x": 10, "size_y": 10}}, "position": [1, 2, 11]}]})");
}

std::vector<std::string> names(const std::filesystem::path& folder) {
    std::vector<std::string> out;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) out.push_back(entry.path().filename().string());
    std::sort(out.begin(), out.end());
    return out;
}

}  // namespace

TEST_CASE("export: a run's folder becomes all formats, and simulate leaves the same GLB") {
    const TemporaryFolder folder;
    const std::string in = scene(folder), out = folder.file("run");
    REQUIRE(run("simulate " + in + " --out " + out).code == 0);
    const Answer all = run("export " + out + " --to " + folder.file("all") + " --every 2 --json");
    CAPTURE(all.out);
    REQUIRE(all.code == 0);
    CHECK(names(folder.path / "all") == std::vector<std::string>{"contacts.csv", "drives.csv", "poses.csv", "run.3mf", "run.glb", "run.mtl",
                                                                 "run.obj", "run.pvd", "run.stl", "run_0000.vtu", "run_0001.vtu",
                                                                 "run_0002.vtu", "steps.csv"});
    CHECK(all.json()["files"].size() == 13);
    CHECK(contents(out + "/motion.glb") == contents(folder.file("all/run.glb")));
    CHECK(contents(folder.file("all/run.pvd")).find("timestep=\"0.006\"") != std::string::npos);  // the last step is always there
    const Answer mesh = run("validate " + folder.file("all/run.3mf") + " --json");
    CHECK(mesh.json()["unit"] == "mm");
    CHECK(mesh.json()["shells"] == nlohmann::json({"low/er", "upper"}));
    CHECK(mesh.json()["size"][2].get<double>() == Approx(41));
}

TEST_CASE("export: one file by its extension, parts in files of their own, a plate on z = 0") {
    const TemporaryFolder folder;
    const std::string in = scene(folder);
    CHECK(run("export " + in + " --to " + folder.file("x.stl")).code == 0);
    CHECK(run("export " + in + " --to " + folder.file("parts") + " --format stl,3mf --arrange parts").code == 0);
    CHECK(names(folder.path / "parts") == std::vector<std::string>{"low_er.3mf", "low_er.stl", "upper.3mf", "upper.stl"});
    CHECK(run("validate " + folder.file("parts/upper.3mf") + " --json").json()["size"] == nlohmann::json({10, 10, 20}));
    // Each where it stands: judged as meshes they are as far apart as in the scene.
    CHECK(run("export " + in + " --to " + folder.file("placed") + " --format stl --arrange separate --in-place").code == 0);
    CHECK(names(folder.path / "placed") == std::vector<std::string>{"low_er.stl", "upper.stl"});
    const double apart = run("clearance " + in + " --json").json()["least"].get<double>();
    CHECK(run("clearance " + folder.file("placed") + " --unit mm --json").json()["least"].get<double>() == Approx(apart).margin(3e-6));
    CHECK(run("export " + in + " --to " + folder.file("x.stl") + " --in-place").code == 3);
    CHECK(run("export " + in + " --to " + folder.file("plate.3mf") + " --arrange plate").code == 0);
    const Answer plate = run("clearance " + folder.file("plate.3mf") + " --json");
    CHECK(plate.json()["pairs"][0]["lower"].get<double>() >= 0.0049);
    CHECK(plate.json()["pairs"][0]["upper"].get<double>() == Approx(0.005).margin(1e-4));
    CHECK(run("export " + folder.file("x.stl") + " --unit mm --to " + folder.file("y.3mf")).code == 0);  // meshes too
    const std::vector<std::string> refused{" --to " + folder.file("x.gif"), " --to " + folder.file("z.3mf") + " --arrange parts",
                                           " --to " + folder.file("q") + " --format gif",
                                           " --to " + folder.file("z.3mf") + " --format stl"};
    for (const std::string& wrong : refused) CHECK(run("export " + in + wrong).code == 3);
    CHECK(run("export " + in + " --to " + folder.file("a.folder/") + " --format glb").code == 0);
    std::filesystem::create_directory(folder.file("empty"));
    CHECK(run("export " + folder.file("empty") + " --to x.glb", true).says("no trajectory.json"));
}

TEST_CASE("export: a certificate names files of its bodies, and is stale when one changes") {
    const TemporaryFolder folder;
    const std::string in = scene(folder), certificate = folder.file("fit.certificate.json"), file = folder.file("print.3mf");
    CHECK(run("clearance " + in + " --minimum 0.5mm --certificate " + certificate).code == 0);
    CHECK_FALSE(run("validate " + certificate + " --json").json().contains("exports"));
    REQUIRE(run("export " + certificate + " --to " + file).code == 0);
    REQUIRE(run("export " + certificate + " --to " + folder.file("print.stl")).code == 0);
    REQUIRE(run("export " + certificate + " --to " + file).code == 0);  // named once
    const Answer good = run("validate " + certificate + " --minimum 0.5mm --json");
    CAPTURE(good.out);
    CHECK(good.code == 0);
    REQUIRE(good.json()["exports"].size() == 2);
    const auto files = good.json()["exports"];
    for (const auto& exported : files) {
        CHECK(exported["status"] == "same");
        CHECK(exported["rounding"].get<double>() > 0);
        CHECK(exported["rounding"].get<double>() < 1e-7);
    }
    const std::string bytes = contents(file);
    folder.write("print.3mf", bytes + " ");
    const Answer stale = run("validate " + certificate + " --json");
    CHECK(stale.code == 1);
    CHECK(stale.json()["status"] == "stale");
    CHECK(stale.json()["faults"][0]["message"].get<std::string>().find("print.3mf") != std::string::npos);
    folder.write("print.3mf", bytes);
    CHECK(run("validate " + certificate).code == 0);
    std::filesystem::remove(file);
    const Answer gone = run("validate " + certificate + " --json");
    CHECK(gone.code == 0);  // what is not there is no copy that differs; it is told
    CHECK(gone.json()["notes"].dump().find("print.3mf") != std::string::npos);

    // A certificate beside another path names nothing.
    REQUIRE(run("simulate " + in + " --out " + folder.file("run")).code == 0);
    std::filesystem::copy(folder.path / "run/trajectory.json", folder.path / "fit.trajectory.json",
                          std::filesystem::copy_options::overwrite_existing);
    CHECK(run("export " + certificate + " --to " + folder.file("other.3mf"), true).says("is not about"));
}

TEST_CASE("draw, export and validate take a part file by itself, at its defaults") {
    const TemporaryFolder folder;
    const std::string part = folder.write("block.part.json", R"({"fettle_part": 1, "units": "mm", "dimensions": {"side": 4},
        "profiles": {"face": {"rectangle": ["= side", "= side"]}}, "solid": {"extrude": "face", "to": "= 2 * side"}})");
    REQUIRE(run("draw " + part + " --out " + folder.file("a.svg")).code == 0);
    CHECK(contents(folder.file("a.svg")).find("block") != std::string::npos);
    REQUIRE(run("export " + part + " --to " + folder.file("block.3mf")).code == 0);
    CHECK(run("validate " + folder.file("block.3mf") + " --json").json()["size"][2].get<double>() == Approx(8));
    REQUIRE(run("export " + part + " --to " + folder.file("face.dxf")).code == 0);
    CHECK(contents(folder.file("face.dxf")).find("LINE") != std::string::npos);
    CHECK(run("validate " + part).code == 0);
    const std::string wrong =
        folder.write("wrong.part.json", R"({"fettle_part": 1, "dimensions": {}, "solid": {"extrude": {"circle": 0}, "to": 1}})");
    for (const std::string& command : {"draw " + wrong + " --out " + folder.file("b.svg"), "validate " + wrong,
                                       "draw " + folder.file("none.part.json") + " --out " + folder.file("b.svg")})
        CHECK(run(command).code == 3);
}

TEST_CASE("draw: PNG and SVG, the nearest points, an instant of a motion") {
    const TemporaryFolder folder;
    const std::string in = scene(folder), out = folder.file("run");
    const Answer png = run("draw " + in + " --out " + folder.file("a.png") + " --size 320x240 --json");
    CAPTURE(png.out);
    REQUIRE(png.code == 0);
    CHECK(contents(folder.file("a.png")).substr(1, 3) == "PNG");
    CHECK(png.json()["worst"]["upper"].get<double>() == Approx(0.001).margin(1e-5));
    REQUIRE(run("simulate " + in + " --out " + out).code == 0);
    CHECK(run("draw " + out + " --time 0.004 --out " + folder.file("b.svg") + " --view 20,30").code == 0);
    CHECK(contents(folder.file("b.svg")).find("upper") != std::string::npos);
    CHECK(contents(folder.file("b.svg")).find("t = 0.004 s") != std::string::npos);
    for (const std::string& late : {out + " --time 99", in + " --time 0.1"})  // after the motion; of what has none
        CHECK(run("draw " + late + " --out " + folder.file("late.svg")).code == 3);
    const Answer worst = run("draw " + out + " --worst --out " + folder.file("c.svg") + " --json");
    CHECK(worst.json()["time"].get<double>() == Approx(0.006));  // it falls all the while
    CHECK(worst.json()["worst"]["upper"].get<double>() < 0.001);
    CHECK(contents(folder.file("c.svg")).find("class=\"witness\"") != std::string::npos);
    folder.write("deep.scene.json", R"({"fettle_scene": 1, "units": "mm", "bodies": [
        {"name": "plate", "type": "static", "shape": {"part": "box", "dimensions": {"size_x": 60, "size_y": 40, "size_z": 10}}},
        {"name": "low", "type": "static", "position": [-15, 0, 14.5],
         "shape": {"part": "box", "dimensions": {"size_x": 12, "size_y": 12, "size_z": 20}}},
        {"name": "deep", "type": "static", "position": [15, 0, 10],
         "shape": {"part": "box", "dimensions": {"size_x": 12, "size_y": 12, "size_z": 20}}}]})");
    const Answer deep = run("draw " + folder.file("deep.scene.json") + " --out " + folder.file("deep.svg") + " --json");
    CHECK(deep.json()["worst"]["b"] == "deep");  // the deepest of two
    CHECK(contents(folder.file("deep.svg")).find("plate:deep interference, ") != std::string::npos);
    CHECK(contents(folder.file("deep.svg")).find(" mm deep") != std::string::npos);
    CHECK(contents(folder.file("deep.svg")).find("<svg x=") != std::string::npos);  // the inset
    CHECK(run("draw " + in + " --plain --out " + folder.file("d.svg")).code == 0);
    CHECK(contents(folder.file("d.svg")).find("class=\"witness\"") == std::string::npos);
    for (const char* wrong :
         {"--out x.gif", "--out x.png --view izo", "--out x.png --size 3x3", "--out x.png --size 3", "--out x.png --up w"})
        CHECK(run("draw " + in + " " + wrong).code == 3);
}

TEST_CASE("export and draw: only some bodies") {
    const TemporaryFolder folder;
    const std::string in = scene(folder), out = folder.file("run");
    REQUIRE(run("simulate " + in + " --out " + out).code == 0);
    REQUIRE(run("export " + out + " --to " + folder.file("some") + " --bodies upper --format 3mf,csv,glb").code == 0);
    CHECK(names(folder.path / "some") == std::vector<std::string>{"poses.csv", "run.3mf", "run.glb"});
    CHECK(run("validate " + folder.file("some/run.3mf") + " --json").json()["size"] == nlohmann::json({10, 10, 20}));
    const std::string poses = contents(folder.file("some/poses.csv"));
    CHECK(poses.find(",upper,") != std::string::npos);
    CHECK(poses.find("low/er") == std::string::npos);
    CHECK(run("export " + in + " --to " + folder.file("x.stl") + " --bodies uper", true).says("did you mean \"upper\"?"));
    CHECK(run("export " + in + " --to " + folder.file("x.urdf") + " --bodies upper").code == 3);
    const Answer alone = run("draw " + out + " --worst --bodies upper --json --out " + folder.file("x.svg"));
    CHECK(alone.code == 0);
    CHECK(alone.json()["worst"].is_null());
    CHECK(run("draw " + in + " --bodies lower,upper --out " + folder.file("y.svg"), true).says("low/er"));
}

}  // namespace fettle::design::cli::export_command_test
