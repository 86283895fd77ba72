// SPDX-License-Identifier: MIT
// The program from outside: exit codes, one JSON object on stdout, messages.
#include <catch2/catch.hpp>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/design/pin_in_bore.hpp"
#include "tests/design/small_design.hpp"
#include "tests/support/program.hpp"

namespace fettle::design::cli::cli_test {

namespace {

using Json = nlohmann::json;
using namespace fettle::tests::design_support;
using fettle::tests::support::Answer;
using fettle::tests::support::run;

}  // namespace

TEST_CASE("usage: version, help, unknown commands and options") {
    CHECK(run("--version").code == 0);
    CHECK(run("--version").out.find("fettle ") == 0);
    const Answer help = run("--help");
    CHECK(help.code == 0);
    for (const char* word : {"validate", "simulate", "clearance", "gradient", "optimise", "Example", "--threads", "--mesh-dir"}) {
        CHECK(help.out.find(word) != std::string::npos);
    }
    for (const char* command : {"validate", "simulate", "clearance", "gradient", "optimise", "optimize"}) {
        const Answer each = run(std::string(command) + " --help");
        CHECK(each.code == 0);
        CHECK(each.out.find("Example") != std::string::npos);
    }
    CHECK(run("").code == 3);
    CHECK(run("validate").code == 3);
    CHECK(run("validate x --nonsense").code == 3);
    const Answer typo = run("optmise x --json");
    CHECK(typo.code == 3);
    CHECK(typo.json()["status"] == "error");
    CHECK(typo.out.find("optimise") != std::string::npos);
}

TEST_CASE("validate: what is usable, and every fault with its place") {
    const DesignFolder good;
    const Answer design = run("validate " + good.design() + " --json");
    CHECK(design.code == 0);
    CHECK(design.json()["status"] == "ok");
    CHECK(design.json()["kind"] == "design");
    const Answer scene = run("--json validate " + (good.path / "small.scene.json").string());
    CHECK(scene.code == 0);
    CHECK(scene.json()["bodies"].size() == 3);

    const DesignFolder bad(replaced(small_design, "\"lower\": 6,", "\"lower\": 16,"));
    const Answer faulty = run("validate " + bad.design() + " --json");
    CHECK(faulty.code == 3);
    CHECK(faulty.json()["errors"][0]["code"] == "inconsistent");
    CHECK(faulty.json()["errors"][0]["where"].get<std::string>().find("#/parameters/0/lower") != std::string::npos);

    CHECK(run("validate /nowhere/x.scene.json").code == 3);
    const DesignFolder touching(small_design, replaced(small_scene, "\"position\": [0, 0, -5]", "\"position\": [0, 0, -4]"));
    const Answer intersecting = run("validate " + touching.design() + " --json");
    CHECK(intersecting.code == 3);
    CHECK(intersecting.json()["errors"][0]["code"] == "bodies_intersect");
}

TEST_CASE("simulate: keys, and a trajectory that clearance takes") {
    const DesignFolder folder;
    const std::string out = (folder.path / "out").string();
    const Answer answer = run("simulate " + (folder.path / "small.scene.json").string() + " --steps 6 --json --out " + out);
    CHECK(answer.code == 0);
    const Json json = answer.json();
    for (const char* key : {"status", "steps", "newton_iterations", "wall_seconds", "minimum_distance", "bodies", "peak_memory_bytes"}) {
        CHECK(json.contains(key));
    }
    CHECK(json.at("status") == "ok");
    CHECK(json.at("steps") == 6);
    CHECK(json.at("minimum_distance").get<double>() > 0);
    CHECK(json.at("bodies").at(1).at("name") == "cube");
    CHECK(json.at("bodies").at(1).at("rotation").size() == 3);
    CHECK(json.at("peak_memory_bytes").get<long>() > 1000000);
    const Answer certified = run("clearance " + out + "/trajectory.json --minimum 1mm --pairs cube:wall --json");
    CHECK(certified.code == 0);
    CHECK(certified.json()["motion"] == true);
    CHECK(certified.json()["pairs"][0]["status"] == "clear");
}

TEST_CASE("clearance: exit codes by status, lengths with units") {
    const DesignFolder folder;
    const std::string scene = (folder.path / "small.scene.json").string();
    const Answer clear = run("clearance " + scene + " --minimum 0.1mm --json");
    CHECK(clear.code == 0);
    CHECK(clear.json()["status"] == "clear");
    CHECK(clear.json()["minimum"] == 1e-4);
    for (const char* key : {"a", "b", "lower", "upper", "status", "time", "point_a", "point_b"})
        CHECK(clear.json()["pairs"][0].contains(key));
    CHECK(run("clearance " + scene + " --minimum 130um --pairs cube:table").code == 1);
    CHECK(run("clearance " + scene + " --minimum 0.12mm --pairs cube:table --tolerance 0.01mm").code == 2);
    CHECK(run("clearance " + scene + " --minimum 0.1").code == 3);
    CHECK(run("clearance " + scene).code == 0);  // only distances
    const Answer name = run("clearance " + scene + " --minimum 1mm --pairs cube:tabel", true);
    CHECK(name.code == 3);
    CHECK(name.out.find("did you mean \"table\"") != std::string::npos);
    CHECK(run("clearance " + folder.design() + " --minimum 0.1mm").code == 0);
}

TEST_CASE("tolerance: spreads, contributors and samples, as text and as JSON") {
    const char* const block = R"({"fettle_scene": 1, "units": "mm", "timestep": 0.01, "end_time": 0.02, "bodies": [
        {"name": "block", "density": 1000, "shape": {"part": "box", "dimensions": {"size_x": 10, "size_y": 10, "size_z": 10}}}]})";
    const auto design_with = [](const std::string& tolerances) {
        return R"({"fettle_design": 1, "scene": "small.scene.json", "units": "mm",
            "parameters": [{"name": "size", "value": 10, "lower": 5, "upper": 20}], "set": {"/bodies/block/shape/dimensions/size_y": "= size"},
            "objective": [{"type": "mass", "bodies": ["block"]}],
            "constraints": [{"type": "mass", "name": "weight", "bodies": ["block"], "upper": "1.02 g"}])" +
               tolerances + "}";
    };
    const DesignFolder folder(design_with(R"(, "tolerances": {"size": "+-0.3 mm"})"), block);
    const Answer told = run("tolerance " + folder.design() + " --samples 16 --worst-case --json");
    CHECK(told.code == 0);
    const Json json = told.json();
    CHECK(json.at("status") == "ok");
    CHECK(json.at("tolerances").at(0).at("standard_deviation").get<double>() == Approx(0.1));
    const Json& weight = json.at("responses").at(1);
    CHECK(weight.at("name") == "weight");
    CHECK(weight.at("linear").at("standard_deviation").get<double>() == Approx(1e-5));
    CHECK(weight.at("most_found").at("value").get<double>() == Approx(1.03e-3));
    CHECK(weight.at("most_found").at("deviations").at("size").get<double>() == Approx(0.3));
    CHECK(weight.at("most_found").at("settled") == true);
    CHECK(weight.at("contributions").at(0).at("of") == "size");
    CHECK(weight.at("sampled").at("met").get<int>() == json.at("samples").at("met").get<int>());
    CHECK(json.at("samples").at("count") == 16);
    CHECK(json.at("tighten").at(0).at("of") == "size");
    CHECK(run("tolerance " + folder.design() + " --samples 16 --worst-case --json --threads 1").out == told.out);
    const std::string kept = " --samples-file " + folder.file("made.jsonl");
    CHECK(run("tolerance " + folder.design() + " --samples 5 --first-order" + kept).code == 0);
    CHECK(run("tolerance " + folder.design() + " --samples 16 --worst-case --json" + kept).out == told.out);  // five of them from there
    const Answer others = run("tolerance " + folder.design() + " --samples 5 --seed 2" + kept, true);
    CHECK(others.code == 3);
    CHECK(others.says("these are samples of another design, version, seed, or of other tolerances"));
    CHECK(run("tolerance " + folder.design() + " --samples 5 --samples-file " + folder.design(), true).code == 3);
    const Answer text = run("tolerance " + folder.design());
    CHECK(text.says("weight: 1 g as drawn, required at most 1.02 g"));
    CHECK(text.says("by size 100% (+-0.03 g)"));
    CHECK(text.says("weight: for Cpk 1 move its mean by 0.01 g away from the bound, or tighten size to 67% (sigma 0.00667 g)"));
    const DesignFolder without(design_with(""), block);
    const Answer none = run("tolerance " + without.design(), true);
    CHECK(none.code == 3);
    CHECK(none.says("it has no `tolerances`"));
    CHECK(run("tolerance " + folder.design() + " --samples -1").code == 3);
}

TEST_CASE("check: every requirement at the values as they are, as exit code") {
    const auto checked = [](const std::string& limit) {
        const std::string weight = R"("constraints": [ {"type": "mass", "name": "weight", "bodies": ["cube"], "upper": )" + limit + "},";
        const DesignFolder folder(replaced(small_design, "\"constraints\": [", weight));
        return run("check " + folder.design() + " --json");
    };
    const Answer heavy = checked("1e-9"), light = checked("1e9");
    CHECK(heavy.code == 1);
    CHECK(heavy.json().at("status") == "violated");
    CHECK(heavy.json().at("constraints").at(0).at("met") == false);
    CHECK(heavy.json().at("summary").at("rows").at(0).at("verdict") == "violated");
    CHECK(light.json().at("constraints").at(0).at("met") == true);
    CHECK(light.json().at("resolution").is_null());
    // The same numbers as the gradient's, which simulates it too.
    const DesignFolder folder;
    const Json gradient = run("gradient " + folder.design() + " --json").json(), check = run("check " + folder.design() + " --json").json();
    CHECK(check.at("objective") == gradient.at("objective"));
    CHECK(run("check " + folder.design()).says("asked for"));
    CHECK(run("check " + folder.path.string(), true).says("design.final.json"));
}

TEST_CASE("check-resolution: the numbers of what can be simulated, and why the rest cannot") {
    // A post of eight sides whose corners, with twice the facets, would reach into the block.
    const DesignFolder folder(R"({"fettle_design": 1, "scene": "small.scene.json", "units": "mm",
        "parameters": [{"name": "size", "value": 10, "lower": 5, "upper": 20}], "set": {"/bodies/block/shape/dimensions/size_y": "= size"},
        "objective": [{"type": "stroke", "body": "block", "axis": [1, 0, 0]}]})",
                              R"({"fettle_scene": 1, "units": "mm", "timestep": 0.01, "end_time": 0.02, "bodies": [
        {"name": "post", "type": "static", "rotation": [0, 0, 22.5],
         "shape": {"part": "cylinder", "dimensions": {"radius": 5, "length": 10}, "counts": {"segments": 8}}},
        {"name": "block", "density": 1000, "linear_velocity": [1, 0, 0], "position": [10.05, 0, 0],
         "shape": {"part": "box", "dimensions": {"size_x": 10, "size_y": 10, "size_z": 10}}}]})");
    const Answer told = run("check-resolution " + folder.design() + " --json");
    CHECK(told.code == 2);
    const Json json = told.json();
    CHECK(json.at("status") == "undecided");
    CHECK(json.at("message") == "not simulated: with twice the facets, with both");
    const Json& stroke = json.at("quantities").at(0);
    CHECK(stroke.at("as_written").get<double>() == Approx(2e-5));
    CHECK(stroke.at("finer_steps").get<double>() == Approx(2e-5));
    CHECK(stroke.at("finer_facets").is_null());
    CHECK(stroke.at("change").is_null());
    REQUIRE(json.at("failures").size() == 2);
    CHECK(json.at("failures").at(1).at("run") == "finer_both");
    CHECK(json.at("failures").at(1).at("reason").get<std::string>().find("post") != std::string::npos);
    const Answer text = run("check-resolution " + folder.design());
    CHECK(text.code == 2);
    CHECK(text.says("stroke block [mm]"));
    CHECK(text.says("not simulated with twice the facets: "));
    CHECK(text.says("undecided: not all could be simulated"));
}

TEST_CASE("relations between parameters, and bounds within which no part can be made, are told without a simulation's results") {
    const std::string relation =
        R"x("constraints": [ { "type": "relation", "name": "flat", "expression": "height / width", "upper": 0.45, "margin": 0 },)x";
    const DesignFolder folder(
        replaced(replaced(small_design, "\"constraints\": [", relation), "\"lower\": -5, \"upper\": 20", "\"lower\": -5, \"upper\": 43"));
    const Json gradient = run("gradient " + folder.design() + " --json").json();
    const Json& flat = gradient.at("relations").at(0);
    CHECK(flat.at("name") == "flat");
    CHECK(flat.at("value") == 0.5);
    CHECK(flat.at("upper") == 0.45);
    CHECK(flat.at("lower").is_null());
    CHECK(flat.at("met") == false);
    CHECK(flat.at("gradient").at("height").get<double>() == Approx(0.05));  // per mm
    CHECK(run("gradient " + folder.design()).out.find("is 0.5, required at most 0.45: VIOLATED") != std::string::npos);
    const Json valid = run("validate " + folder.design() + " --json").json();
    CHECK(valid.at("relations").at(0) == "flat");
    CHECK(valid.at("warnings").dump().find("bounds: `place` above 27.4") != std::string::npos);
}

TEST_CASE("gradient tells of witnesses that tie, and of none where none do") {
    const DesignFolder centred(bore_design("0", "0", least_play), bore_scene);
    const Json constraint = run("gradient " + centred.design() + " --json").json().at("constraints").at(0);
    CHECK(constraint.at("ties").at("witnesses").get<int>() >= 3);
    CHECK(constraint.at("ties").at("gradient_least").at("x").get<double>() < -0.5e-3);  // per mm
    CHECK(constraint.at("ties").at("gradient_greatest").at("x").get<double>() > 0.5e-3);
    CHECK(run("gradient " + centred.design()).out.find("witnesses tie, d/d x from -") != std::string::npos);
    const DesignFolder aside(bore_design("0.1", "0.03", large_play), bore_scene);
    const Answer without = run("gradient " + aside.design() + " --json");
    CHECK(without.code == 0);
    CHECK(without.out.find("ties") == std::string::npos);
}

TEST_CASE("a file of another program, given for a design, is told with what is read") {
    const fettle::tests::support::TemporaryFolder folder;
    std::ofstream(folder.file("rod.scad")) << "cube(1);\n";
    std::ofstream(folder.file("rod.stl")) << "solid rod\nendsolid rod\n";
    for (const char* command : {"optimise", "gradient", "simulate"}) {
        for (const char* name : {"rod.scad", "rod.stl"}) {
            const Answer answer = run(std::string(command) + " " + folder.file(name) + " --json");
            CAPTURE(command, name);
            CHECK(answer.code == 3);
            CHECK(answer.json()["errors"][0]["code"] == "unsupported");
            CHECK(answer.out.find(".stl .obj .off .ply .3mf") != std::string::npos);
        }
    }
}

TEST_CASE("gradient --check tells which contacts are about to change") {
    const DesignFolder folder(R"({
  "fettle_design": 1, "scene": "small.scene.json", "units": "mm",
  "parameters": [
    { "name": "lift", "value": 5, "lower": 0, "upper": 10 }
  ],
  "set": { "/bodies/block/position/2": "= lift + 0.12" },
  "objective": [{ "type": "mass", "bodies": ["block"] }]
})",
                              R"({
  "fettle_scene": 1, "units": "mm", "gravity": [0, 0, 0], "timestep": 0.001, "end_time": 0.003, "contact": { "dhat": 0.1 },
  "bodies": [
    { "name": "table", "type": "static", "position": [0, 0, -5],
      "shape": { "part": "box", "dimensions": { "size_x": 60, "size_y": 60, "size_z": 10 } } },
    { "name": "block", "density": 1000, "fixed": ["px", "pz", "rx", "ry", "rz"], "position": [0, 0, 5.12],
      "shape": { "part": "box", "dimensions": { "size_x": 20, "size_y": 12, "size_z": 10 } } }
  ]
})");
    const Json changes = run("gradient " + folder.design() + " --check --json").json().at("contact_changes");
    REQUIRE(changes.size() == 1);
    CHECK(changes.at(0).at("parameter") == "lift");
    CHECK(changes.at(0).at("event") == "touch");
    CHECK(changes.at(0).at("a") == "table");
    CHECK(changes.at(0).at("b") == "block");
    CHECK(changes.at(0).at("features") == Json({"a face", "a vertex"}));
    CHECK(changes.at(0).at("from").get<double>() == Approx(-0.01));  // mm; it is at -0.02
    CHECK(changes.at(0).at("to").get<double>() == Approx(-0.1));
    for (const char* key : {"features_before", "time", "place", "contacts", "others", "gradient_jumps"}) CHECK(changes.at(0).contains(key));
    const std::string text = run("gradient " + folder.design() + " --check").out;
    CAPTURE(text);
    CHECK(text.find("at t = 0.001 s 'table' and 'block' begin to touch, a face of 'table' on a vertex of 'block', near (") !=
          std::string::npos);
    CHECK(text.find("12 contacts in all: if lift falls by 0.01 to 0.1 mm") != std::string::npos);
}

TEST_CASE("optimise: \"ipopt\" is Ipopt's own optimiser, \"sqp\" the one that a design has by itself") {
    const std::string settings = R"({ "name": "mma", "max_evaluations": 8 })",
                      own_settings = R"({ "name": "ipopt", "max_evaluations": 20 })";
    const DesignFolder folder(replaced(small_design, settings, own_settings));
    const auto answer = [&](const std::string& options) {
        return run("optimise " + folder.design() + options + " --json --no-report --out " + folder.file("out")).json();
    };
    const Json own = answer(""), by_steps = answer(" --optimiser sqp");
    for (const Json& each : {own, by_steps}) {
        CAPTURE(each.dump());
        CHECK(each.at("constraint_violation") == 0);
        CHECK(each.at("objective").get<double>() < each.at("objective_start").get<double>());
    }
    CHECK(own.at("evaluations").get<int>() <= 20);
    CHECK(own.at("parameters") != by_steps.at("parameters"));
    CHECK(run("optimisers").says("the default"));
}

TEST_CASE("optimise notes what is proven of the meshes, and not of the round surfaces") {
    const char* scene = R"({"fettle_scene": 1, "units": "mm", "timestep": 0.01, "end_time": 0.01, "bodies": [
        {"name": "plate", "type": "static", "shape": {"part": "plate_with_hole", "dimensions": {"hole_radius": 5}, "counts": {"segments": 24}}},
        {"name": "pin", "type": "static", "shape": {"part": "rod.part.json", "dimensions": {"radius": 4.5}}}]})";
    const char* design = R"({"fettle_design": 1, "scene": "small.scene.json", "units": "mm",
        "parameters": [{"name": "radius", "value": 4.5, "lower": 4, "upper": 4.9}], "set": {"/bodies/1/shape/dimensions/radius": "= radius"},
        "objective": [{"type": "play", "a": "pin", "b": "plate"}],
        "constraints": [{"type": "clearance", "a": "pin", "b": "plate", "minimum": 0.2}]})";
    const std::string rod = R"({"fettle_part": 1, "facets": {"segments": 24, "lean": "LEAN"}, "dimensions": {"radius": 4.5},
        "solid": {"extrude": {"circle": "= radius"}, "from": -20, "to": 20}})";
    for (const std::string lean : {"within", "cover"}) {
        const DesignFolder folder(design, scene);
        folder.write("rod.part.json", replaced(rod, "LEAN", lean));
        const Answer answer = run("optimise " + folder.design() + " --details --no-report --out " + folder.file("out"));
        CAPTURE(lean, answer.out);
        CHECK(answer.says("  proven for the facets\n") == (lean == "within"));
        CHECK(answer.says("  proven\n") == (lean == "cover"));
        CHECK(answer.code == 0);
        CHECK(answer.says("for the round surfaces that their facets stand for") == (lean == "within"));
        CHECK(answer.says("what to do: require more") == (lean == "within"));
    }
}

TEST_CASE("gradient and optimise: keys, exit codes, resume", "[slow]") {
    const DesignFolder folder;
    const Answer gradient = run("gradient " + folder.design() + " --check --json");
    CHECK(gradient.code == 0);
    const Json g = gradient.json();
    CHECK(g.at("gradient").size() == 5);
    CHECK(g.at("constraints").at(0).contains("gradient"));
    CHECK(g.at("largest_relative_error").get<double>() < 1e-5);
    CHECK(g.at("check").size() == 30);
    for (const Json& row : g.at("check")) CHECK(row.at("resolved") == true);
    const Json& roughness = g.at("roughness");
    CHECK(roughness.at("measured") == true);
    CHECK(roughness.at("spacing") == 1e-3);
    CHECK(roughness.at("direction").size() == 5);
    REQUIRE(roughness.at("quantities").size() == 6);
    for (const char* key : {"quantity", "noise", "noise_status", "rounding", "holds", "breaks", "tolerance", "rough"})
        CHECK(roughness.at("quantities").at(0).contains(key));
    CHECK(roughness.at("remedies").is_array());
    CHECK(g.at("contacts_reach").at("width") == Json({1e-2, 1e-2}));
    CHECK(g.at("contact_changes").is_array());
    CHECK(g.at("sweeps_disagreement").get<double>() < 1e-9);
    REQUIRE(g.at("along_gradient").size() == 6);
    for (const Json& row : g.at("along_gradient")) CHECK(row.at("relative_error").get<double>() < 1e-5);
    const Json& slope = g.at("along_gradient").at(0).at("remainder_slope");
    CHECK(slope.get<double>() == Approx(2).margin(0.1));
    CHECK(g.at("left_out").empty());
    const Json cut = run("gradient " + folder.design() + " --check --check-parameters 2 --json").json();
    CHECK(cut.at("check").size() == 12);
    CHECK(cut.at("left_out").size() == 3);
    const std::string told = run("gradient " + folder.design() + " --check --check-parameters 2").out;
    CHECK(told.find("left out: ") != std::string::npos);
    for (const Json& name : cut.at("left_out")) CHECK(told.find("not examined: " + name.get<std::string>()) == std::string::npos);
    CHECK(cut.at("check_simulations").get<int>() <= 58);
    CHECK(run("gradient " + folder.design() + " --check", true).out.find("the check takes up to 94 simulations") != std::string::npos);
    CHECK(g.contains("forward_seconds"));
    CHECK(g.contains("backward_seconds"));

    const std::string out = (folder.path / "out").string();
    const Answer optimise = run("optimize " + folder.design() + " --json --out " + out);
    const Json o = optimise.json();
    for (const char* key : {"status", "objective_start", "objective", "parameters", "evaluations", "iterations", "constraint_violation",
                            "clearance", "out"}) {
        CHECK(o.contains(key));
    }
    CHECK((optimise.code == 0 || optimise.code == 2));
    CHECK(o.at("objective").get<double>() < o.at("objective_start").get<double>());
    const Answer again = run("optimise " + folder.design() + " --json --resume --out " + out);
    CHECK(again.json()["parameters"] == o.at("parameters"));
    CHECK(again.json()["replayed_evaluations"] == o.at("evaluations"));
    CHECK(run("validate " + out + "/design.final.json").code == 0);

    const DesignFolder impossible(replaced(small_design, "\"minimum\": 15", "\"minimum\": 60"));
    const Answer unreachable = run("optimise " + impossible.design() + " --json --out " + out + "2");
    CHECK(unreachable.code == 1);
    CHECK(unreachable.json()["limits"].size() > 0);
    CHECK(unreachable.json()["constraint_violation"].get<double>() > 0);
    CHECK(unreachable.json()["relations"].empty());
    CHECK(unreachable.json()["unbuildable"].empty());
}

}  // namespace fettle::design::cli::cli_test
