// SPDX-License-Identifier: MIT
// From the coupon to tolerances by what was measured of it, as a user does.
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/design/small_design.hpp"
#include "tests/support/program.hpp"

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

TEST_CASE("process: of several prints") {
    const TemporaryFolder folder;
    const std::string in = "cd '" + folder.path.string() + "' && ";
    const double shift[] = {-0.05, 0.02, 0.06, -0.03};  // of the prints, mm
    std::string forms;
    for (int p = 0; p < 4; ++p) {
        std::string text = "feature,kind,nominal_mm,measured_1_mm\n";
        for (int d = 3; d <= 8; ++d)
            text += "H" + std::to_string(d) + ",hole," + std::to_string(d) + "," +
                    std::to_string(d - 0.1 + shift[p] + (d % 2 ? 0.01 : -0.01)) + "\n";
        folder.write("print" + std::to_string(p) + ".csv", text);
        forms += "print" + std::to_string(p) + ".csv ";
    }
    const Answer told = run("process " + forms + "--name mine", true, in);
    CAPTURE(told.out);
    REQUIRE(told.code == 0);
    CHECK(told.says("between 4 prints, which share 9"));
    CHECK(told.says("how prints differ is what the features of one print share"));
    const Json json = run("process " + forms + "--name mine --replace --json", false, in).json();
    CHECK(json.at("prints") == 4);
    const Json& hole = json.at("kinds").at(0);
    CHECK(hole.at("prints") == 4);
    // Standard deviation of the shifts, but for what 6 features within a print add.
    CHECK(hole.at("between_prints").at("value").get<double>() == Approx(49.67e-6).epsilon(0.01));
    CHECK(hole.at("between_prints").at("least").get<double>() < 30e-6);
    CHECK(hole.at("between_prints").at("most").get<double>() > 100e-6);
    CHECK(hole.at("taken").get<double>() > 100e-6);
    const Json file = Json::parse(text_of(folder.file("mine.process.json")));
    CHECK(file.at("features").at("hole").at("correlation").get<double>() == Approx(hole.at("shared").at("value").get<double>()));
    // What the parts of one print share is that.
    folder.write("small.scene.json",
                 R"({"fettle_scene": 1, "units": "mm", "timestep": 0.01, "end_time": 0.01, "variables": {"bore": "6 mm"},
        "bodies": [{"name": "plate", "type": "static", "shape": {"part": "plate_with_hole",
                    "dimensions": {"size_x": 40, "size_y": 40, "thickness": 8, "hole_radius": "= bore / 2"}}}]})");
    folder.write("small.design.json", R"json({"fettle_design": 1, "scene": "small.scene.json", "units": "mm",
        "parameters": [{"name": "depth", "value": 8, "lower": 5, "upper": 20}], "set": {"/bodies/plate/shape/dimensions/thickness": "= depth"},
        "objective": [{"type": "expression", "expression": "depth / 1 mm"}], "tolerances": {"bore": "hole"}})json");
    const Answer made = run("tolerance small.design.json --process mine --first-order --json", false, in);
    CAPTURE(made.out);
    CHECK(made.json().at("tolerances").at(0).at("correlation").get<double>() == Approx(-hole.at("shared").at("value").get<double>()));

    CHECK(run("process print0.csv print1.csv --name two", true, in).says("of 2 prints it is taken as it was found, and may be far more"));
    const auto refused = [&](const std::string& arguments, const std::string& says) {
        const Answer answer = run(arguments, true, in);
        CAPTURE(arguments, answer.out);
        CHECK(answer.code == 3);
        CHECK(answer.says(says));
    };
    refused("process print0.csv ./print0.csv --name twice", "is given twice");
    refused("process print0.csv none.csv --name none", "none.csv");
    folder.write("empty.csv", "feature,kind,nominal_mm,measured_1_mm\nH3,hole,3,\n");
    refused("process print0.csv empty.csv --name none", "nothing is measured in it");
    refused("process --name none", "FORMS");
    CHECK(!std::filesystem::exists(folder.file("none.process.json")));
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
    refused("coupon --out x.3mf --sizes bore=3mm..8mm", "has no features of kind \"bore\"");
    refused("coupon --out x.3mf --sizes length=3mm..8mm", "a coupon to print has no features of kind \"length\"");
    refused("coupon --out x.svg --sizes pin=3mm..8mm", "a coupon to cut has no features of kind \"pin\"");
    CHECK_FALSE(run("coupon --out x.3mf --sizes bore=3mm..8mm", true, in).says("angle"));
    CHECK_FALSE(run("coupon --out x.3mf --sizes bore=3mm..8mm", true, in).says("length"));
    refused("coupon --out x.3mf --sizes hole", "sizes are given as hole=3mm..8mm");
    refused("process none.csv --name mine", "none.csv");
    refused("process plate.csv --name fdm", "is a known process; give yours another name: my_fdm");
    refused("process plate.csv --name a/b", "without folders");
    refused("process plate.csv --name mine --based-on fdn", "fdn");
    CHECK(!std::filesystem::exists(folder.file("x.3mf")));
    CHECK(!std::filesystem::exists(folder.file("x.csv")));
}

}  // namespace fettle::design::cli::coupon_command_test
