// SPDX-License-Identifier: MIT
// From the coupon to tolerances by what was measured of it, as a user does.
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "fettle/tests/design/small_design.hpp"
#include "fettle/tests/support/program.hpp"

namespace fettle::design::cli::coupon_command_test {

namespace {

using Json = nlohmann::json;
using namespace fettle::tests::design_support;
using fettle::tests::support::Answer;
using fettle::tests::support::run;
using fettle::tests::support::TemporaryFolder;

std::string text_of(const std::string& path) {
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    return text.str();
}

// The form, holes 0.1 mm and 1% smaller, pins 0.05 mm larger, give or take.
void fill_in(const std::string& path) {
    std::istringstream form(text_of(path));
    std::ostringstream filled;
    std::string line;
    for (int k = 0; std::getline(form, line); ++k) {
        std::istringstream fields(line);
        std::string name, kind, nominal;
        std::getline(fields, name, ',');
        std::getline(fields, kind, ',');
        std::getline(fields, nominal, ',');
        const double give = 0.01 * ((k * 7) % 5 - 2);
        if (kind == "hole")
            filled << name << "," << kind << "," << nominal << "," << std::stod(nominal) * 0.99 - 0.1 + give << ",,\n";
        else if (kind == "pin")
            filled << name << "," << kind << "," << nominal << "," << std::stod(nominal) + 0.05 + give << ","
                   << std::stod(nominal) + 0.06 + give << ",\n";
        else
            filled << line << "\n";
    }
    std::ofstream(path) << filled.str();
}

}  // namespace

TEST_CASE("coupon, form, process, tolerance") {
    const TemporaryFolder folder;
    const std::string in = "cd '" + folder.path.string() + "' && ";
    const Answer made = run("coupon --process mine --out coupon.3mf", true, in);
    CAPTURE(made.out);
    REQUIRE(made.code == 0);
    CHECK(made.says("minutes of a filament printer"));
    CHECK(made.says("fettle process coupon.csv --name mine\n"));
    CHECK(text_of(folder.file("coupon.3mf")).starts_with("PK"));
    CHECK(run("validate coupon.3mf", false, in).code == 0);
    // Nothing is replaced.
    const std::string before = text_of(folder.file("coupon.csv"));
    const Answer again = run("coupon --out coupon.stl", true, in);
    CHECK(again.code == 3);
    CHECK(again.says("coupon.csv: is there already"));
    CHECK(!std::filesystem::exists(folder.file("coupon.stl")));
    CHECK(run("process coupon.csv --name mine", true, in).says("nothing is measured"));
    fill_in(folder.file("coupon.csv"));
    const Answer fitted = run("process coupon.csv --name mine", true, in);
    CAPTURE(fitted.out);
    REQUIRE(fitted.code == 0);
    CHECK(fitted.says("hole     6, 3 to 8 mm: bias -0.1"));
    CHECK(fitted.says("measuring itself spreads by 0.007 mm"));
    CHECK(std::filesystem::exists(folder.file("mine.process.json")));
    const Answer kept = run("process coupon.csv --name mine", true, in);
    CHECK(kept.code == 3);
    CHECK(kept.says("--replace"));
    const Answer json = run("process coupon.csv --name mine --replace --json", false, in);
    REQUIRE(json.code == 0);
    const Json told = json.json();
    CHECK(told.at("kinds").size() == 2);
    CHECK(told.at("kinds").at(0).at("kind") == "hole");
    CHECK(told.at("kinds").at(0).at("bias_per_size").at("value").get<double>() == Approx(-0.01).margin(0.006));
    CHECK(told.at("repeats") == 6);

    const char* const block = R"({"fettle_scene": 1, "units": "mm", "timestep": 0.01, "end_time": 0.02, "bodies": [
        {"name": "block", "density": 1000, "shape": {"part": "box", "dimensions": {"size_x": 10, "size_y": 10, "size_z": 10}}}]})";
    folder.write("small.scene.json", block);
    folder.write("small.design.json", R"json({"fettle_design": 1, "scene": "small.scene.json", "units": "mm", "process": "fdm",
        "parameters": [{"name": "size", "value": 5, "lower": 5, "upper": 20}, {"name": "force", "value": 1, "lower": 0, "upper": 2, "unit": "N"}],
        "set": {"/bodies/block/shape/dimensions/size_y": "= size + 5 mm * force / (1 N)"},
        "objective": [{"type": "mass", "bodies": ["block"]}], "tolerances": {"*": "hole"}})json");
    const Json fdm = run("tolerance small.design.json --json", false, in).json();
    CHECK(fdm.at("process") == "fdm");
    CHECK(fdm.at("tolerances").at(0).at("mean").get<double>() == Approx(-0.2));
    CHECK(fdm.at("untoleranced").at(0).at("name") == "force");
    const Json mine = run("tolerance small.design.json --process mine --json", false, in).json();
    CHECK(mine.at("process") == "mine");
    CHECK(mine.at("tolerances").at(0).at("mean").get<double>() == Approx(-0.15).margin(0.03));
    CHECK(run("tolerance small.design.json --process mine --samples 3 --samples-file made.jsonl", false, in).code == 0);
    CHECK(run("tolerance small.design.json --process sla --samples 3 --samples-file made.jsonl", true, in).says("or of other tolerances"));
    CHECK(run("tolerance small.design.json --process mine", false, in).says("force: no length or angle"));
    const Answer none = run("tolerance small.design.json --process mien", true, in);
    CHECK(none.code == 3);
    CHECK(none.says("did you mean \"mine\"?"));
    // Clearances go by it too.
    folder.write("two.scene.json", R"({"fettle_scene": 1, "units": "mm", "bodies": [
        {"name": "a", "type": "static", "shape": {"part": "box", "dimensions": {"size_x": 10, "size_y": 10, "size_z": 10}}},
        {"name": "b", "type": "static", "position": [11, 0, 0], "shape": {"part": "box", "dimensions": {"size_x": 10, "size_y": 10, "size_z": 10}}}]})");
    const Answer clear = run("clearance two.scene.json --process mine --json", false, in);
    CHECK(clear.code == 0);
    CHECK(clear.pair("a", "b")["required_by"] == "--process mine");
    CHECK(run("clearance two.scene.json --process mien", true, in).says("did you mean \"mine\"?"));
    CHECK(run("clearance two.scene.json --process cnc", true, in).says("says nothing of the clearance that parts need"));
}

TEST_CASE("coupon: to cut, and what is wrong is told") {
    const TemporaryFolder folder;
    const std::string in = "cd '" + folder.path.string() + "' && ";
    const Answer cut = run("coupon --process laser --out plate.svg --steps 5", true, in);
    CHECK(cut.code == 0);
    CHECK(cut.says("--name my_laser --based-on laser"));
    CHECK(text_of(folder.file("plate.csv")).find("W2,wall,2,,,") != std::string::npos);
    CHECK(run("coupon --out other.dxf", true, in).code == 0);
    CHECK(run("coupon --out small.stl --steps 3 --sizes hole=4mm..6mm --sizes pin=4mm..6mm", true, in).code == 0);
    const auto refused = [&](const std::string& arguments, const std::string& says) {
        const Answer answer = run(arguments, true, in);
        CAPTURE(arguments, answer.out);
        CHECK(answer.code == 3);
        CHECK(answer.says(says));
    };
    refused("coupon", "--out");
    refused("coupon --out x.step", "a coupon to print is X.3mf, X.stl or X.obj");
    refused("coupon --out x.3mf --steps 2", "--steps");
    refused("coupon --out x.3mf --sizes hole=3..8", "--sizes");
    refused("coupon --out x.3mf --sizes bore=3mm..8mm", "\"bore\" is no kind of feature");
    refused("coupon --out x.3mf --sizes hole", "sizes are given as hole=3mm..8mm");
    refused("process none.csv --name mine", "none.csv");
    refused("process plate.csv --name fdm", "is a known process; give yours another name: my_fdm");
    refused("process plate.csv --name a/b", "without folders");
    refused("process plate.csv --name mine --based-on fdn", "fdn");
    CHECK(!std::filesystem::exists(folder.file("x.3mf")));
    CHECK(!std::filesystem::exists(folder.file("x.csv")));
}

}  // namespace fettle::design::cli::coupon_command_test
