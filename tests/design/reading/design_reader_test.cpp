// SPDX-License-Identifier: MIT
#include "design/reading/design_reader.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <fstream>

#include "tests/design/small_design.hpp"

namespace fettle::design::reading::design_reader_test {

namespace {

using fettle::design::description::representable;
using fettle::design::description::values_of;
using namespace fettle::tests::design_support;

struct Fault {
    const char *from, *to;
    ErrorCode code;
    const char *pointer, *words;
};

bool has(const Errors& errors, const Fault& fault) {
    for (const Error& error : errors) {
        if (error.code == fault.code && error.where.find(fault.pointer) != std::string::npos &&
            error.message.find(fault.words) != std::string::npos) {
            return true;
        }
    }
    return false;
}

std::string all(const Errors& errors) {
    std::string text;
    for (const Error& error : errors) text += error.where + ": " + error.message + "\n";
    return text;
}

}  // namespace

TEST_CASE("a design file is read in SI units") {
    const DesignFolder folder;
    const Result<DesignFile> file = read_design(folder.design());
    INFO(all(file.errors()));
    REQUIRE(file);
    const design::description::Design& design = file->design;
    REQUIRE(design.parameters.size() == 5);
    CHECK(design.parameters[0].value == 0.01);
    REQUIRE(design.numbers.size() == 6);
    const auto height = std::find_if(design.numbers.begin(), design.numbers.end(),
                                     [](const auto& number) { return number.place == "/bodies/1/position/2"; });
    REQUIRE(height != design.numbers.end());
    CHECK(core::expression::value_of<double>(height->formula, std::vector<double>{0.02}) == Approx(0.01012));
    CHECK(design.parameters[3].value == 1000);
    CHECK(design.parameters[4].value == Approx(40 * std::acos(-1.0) / 180));
    CHECK(design.steps == 20);
    REQUIRE(design.objective.size() == 5);
    CHECK(design.objective[0].name == "mass cube");
    REQUIRE(design.constraints.size() == 5);  // one of them in two windows
    CHECK(design.constraints[0].bounds.lower == 0.015);
    CHECK(target_lower(design.constraints[0].bounds) == Approx(0.015002));
    CHECK(design.constraints[1].name == "clearance cube:wall over the motion 2 window 1");
    CHECK(design.constraints[4].bounds.upper == Approx(0.004));
    CHECK(design.optimiser.name == "mma");
}

TEST_CASE("every fault of a design is named, with its place") {
    const Fault faults[] = {
        {"\"lower\": 6,", "\"lower\": 16,", ErrorCode::inconsistent, "#/parameters/0/lower", "above the upper bound"},
        {"\"value\": 10,", "\"value\": 15,", ErrorCode::out_of_range, "#/parameters/0/value",
         "the value 15 lies outside the bounds [6, 14] mm"},
        {"\"value\": 10,", "\"value\": \"ten\",", ErrorCode::parse, "#/parameters/0/value", "is not a length"},
        {"\"value\": 10,", "\"valeu\": 10,", ErrorCode::unknown_key, "#/parameters/0/valeu", "value"},
        {"dimensions/size_z", "dimensions/size_zz", ErrorCode::unknown_key, "small.scene.json#/bodies/1/shape", "size_z"},
        {"/bodies/cube/shape/dimensions/size_z", "/bodies/cubes/shape/dimensions/size_z", ErrorCode::out_of_range, "#/set/~1bodies~1cubes",
         "did you mean `cube`?"},
        {"/bodies/table/prescribed", "/bodies/cube/prescribed", ErrorCode::out_of_range, "#/set/~1bodies~1cube",
         "there is no `prescribed`"},
        {"= height / 2 + 0.12", "= heigth / 2", ErrorCode::out_of_range, "#/set/~1bodies~1cube~1position~12", "did you mean `height`?"},
        {"= height / 2 + 0.12", "= height / 2 +", ErrorCode::parse, "#/set/~1bodies~1cube~1position~12", "the formula ends"},
        {"= height / 2 + 0.12", "= height * width", ErrorCode::wrong_type, "#/set/~1bodies~1cube~1position~12", "this is an area"},
        {"\"/bodies/cube/density\"", "\"/timestep\"", ErrorCode::wrong_type, "#/set/~1timestep", "a density, a number is expected"},
        {"\"unit\": \"deg/s\"", "\"unit\": \"deg/sec\"", ErrorCode::out_of_range, "#/parameters/4/unit", "deg/s"},
        {"\"unit\": \"deg/s\"", "\"unit\": \"mm\"", ErrorCode::wrong_type, "#/set/~1bodies~1table~1prescribed~1ry~1rate",
         "this is a length, an angular speed is expected"},
        {"\"name\": \"width\"", "\"name\": \"height\"", ErrorCode::inconsistent, "#/parameters/1/name", "already"},
        {"\"type\": \"play\"", "\"type\": \"plays\"", ErrorCode::out_of_range, "#/objective/3/type", "play"},
        {"\"weight\": 0.5", "\"wieght\": 0.5", ErrorCode::unknown_key, "#/objective/3/wieght", "weight"},
        {"[0, 0, 2]", "[0, 0, 0]", ErrorCode::out_of_range, "#/objective/4/axis", "zero"},
        {"[0.052, 0.1]", "[0.052]", ErrorCode::inconsistent, "#/objective/1/times", "one time for each"},
        {"[0.052, 0.1]", "[0.052, 0.2]", ErrorCode::out_of_range, "#/objective/1/times/1", ""},
        {"\"minimum\": 15", "\"minimum\": -15", ErrorCode::out_of_range, "#/constraints/0/minimum", ""},
        {"\"a\": \"cube\", \"b\": \"wall\", \"minimum\": 15", "\"a\": \"cube\", \"b\": \"cube\", \"minimum\": 15", ErrorCode::inconsistent,
         "#/constraints/0", "the same"},
        {"\"lower\": 1.5, \"upper\": 4", "\"lower\": 5, \"upper\": 4", ErrorCode::inconsistent, "#/constraints/3/lower", "above"},
        // a quantity has a dimension: 30 mm is no mass, and a squared distance is no length
        {"\"lower\": 1.5, \"upper\": 4", "\"lower\": 1.5, \"upper\": \"30mm\"", ErrorCode::wrong_type, "#/constraints/3/upper",
         "a mass is expected"},
        {"\"lower\": 0, \"upper\": 30", "\"lower\": 0, \"upper\": \"30 g\"", ErrorCode::wrong_type, "#/constraints/2/upper",
         "a length is expected"},
        {"\"type\": \"mass\", \"bodies\": [\"cube\"], \"lower\": 1.5, \"upper\": 4",
         "\"type\": \"marker_path\", \"body\": \"cube\", \"point\": [0, 0, 0], \"points\": [[0, 0, 0]], \"upper\": \"4mm\"",
         ErrorCode::wrong_type, "#/constraints/3/upper", "an area is expected"},
        {"\"name\": \"mma\"", "\"name\": \"mna\"", ErrorCode::out_of_range, "#/optimiser/name", "mma"},
        {"\"max_evaluations\": 8", "\"max_evaluations\": 0", ErrorCode::out_of_range, "#/optimiser/max_evaluations", ""},
        {"\"scene\": \"small.scene.json\"", "\"scene\": \"smal.scene.json\"", ErrorCode::file_not_found, "#/scene", "smal.scene.json"},
        {"\"scene\": \"small.scene.json\"", "\"scene\": \"part.STL\"", ErrorCode::unsupported, "#/scene", "is a mesh"},
        {"\"scene\": \"small.scene.json\"", "\"scene\": \"\"", ErrorCode::out_of_range, "#/scene", "the path of a scene file"},
        {"\"scene\": \"small.scene.json\"", "\"scene\": \".\"", ErrorCode::unsupported, "#/scene", "is a folder"},
        {"\"units\": \"mm\"", "\"units\": \"furlong\"", ErrorCode::out_of_range, "#/units", "mm"},
        {"\"value\": 10,", "\"value\": NaN,", ErrorCode::not_finite, "", ""},
        {"\"fettle_design\": 1", "\"fettle_design\": 2", ErrorCode::out_of_range, "#/fettle_design", ""},
    };
    for (const Fault& fault : faults) {
        const DesignFolder folder(replaced(small_design, fault.from, fault.to));
        const Result<DesignFile> design = read_design(folder.design());
        INFO(fault.from << " -> " << fault.to << "\n" << all(design.errors()));
        REQUIRE_FALSE(design);
        CHECK(has(design.errors(), fault));
    }
}

TEST_CASE("`moves` of before are refused, with the formulas that say the same") {
    const DesignFolder folder(replaced(small_design, "\"name\": \"height\",",
                                       "\"name\": \"height\", \"moves\": [{ \"body\": \"cube\", \"dimension\": \"size_z\" }, "
                                       "{ \"body\": \"cube\", \"position\": [0, 0, 0.5], \"offset\": [0, 0, 0.12] }],"));
    const Result<DesignFile> design = read_design(folder.design());
    INFO(all(design.errors()));
    REQUIRE_FALSE(design);
    CHECK(
        has(design.errors(), {"", "", ErrorCode::unsupported, "#/parameters/0/moves",
                              "\"/bodies/cube/shape/dimensions/size_z\": \"= height\", \"/bodies/cube/position/2\": \"= 0.5 * height\""}));
    for (const char* value : {"\"\"", "{}", "[1e8]", "[[]]", "null", "true"}) {
        const DesignFolder odd(
            replaced(small_design, "\"name\": \"height\",", std::string("\"name\": \"height\", \"moves\": ") + value + ","));
        CAPTURE(value);
        CHECK(has(read_design(odd.design()).errors(), {"", "", ErrorCode::unsupported, "#/parameters/0/moves", "formulas"}));
    }
}

TEST_CASE("a scene in a design's place is called one; what is no object is said once") {
    const DesignFolder folder(replaced(small_design, "{ \"name\": \"mma\", \"max_evaluations\": 8 }", "\"ipopt\""));
    const Result<DesignFile> scene = read_design(folder.file("small.scene.json"));
    REQUIRE_FALSE(scene);
    CHECK(has(scene.errors(), {"", "", ErrorCode::inconsistent, "small.scene.json", "this is a scene, not a design"}));
    const Result<DesignFile> word = read_design(folder.design());
    INFO(all(word.errors()));
    REQUIRE_FALSE(word);
    CHECK(word.errors().size() == 1);
    CHECK(has(word.errors(), {"", "", ErrorCode::wrong_type, "#/optimiser", "an object is expected, found \"ipopt\""}));
}

TEST_CASE("all faults are told at once") {
    const std::string twice = replaced(replaced(small_design, "\"lower\": 6,", "\"lower\": 16,"), "\"minimum\": 15", "\"minimum\": -15");
    const DesignFolder folder(twice);
    CHECK(read_design(folder.design()).errors().size() == 2);
}

TEST_CASE("a scaled part cannot be moved by a dimension") {
    const DesignFolder folder(small_design, replaced(small_scene, "\"angular_velocity\"", "\"scale\": 2, \"angular_velocity\""));
    const Result<DesignFile> design = read_design(folder.design());
    REQUIRE_FALSE(design);
    CHECK(design.errors()[0].code == ErrorCode::unsupported);
}

TEST_CASE("a number that no design can move, and a parameter that nothing follows from") {
    const auto errors_with = [](const char* from, const char* to) {
        const DesignFolder folder(replaced(small_design, from, to));
        return read_design(folder.design()).errors();
    };
    CHECK(has(errors_with("\"/bodies/cube/density\": \"= density\"", "\"/timestep\": \"= density / density\""),
              {"", "", ErrorCode::unsupported, "#/set/~1timestep", "no design can move this number"}));
    CHECK(has(errors_with("\"= place\"", "3"), {"", "", ErrorCode::inconsistent, "#/parameters/2", "no number of the scene follows from"}));
}

TEST_CASE("variables: of a design, and of its scene, whose place a parameter takes") {
    const std::string scene = replaced(
        replaced(small_scene, "\"gravity\"", R"("variables": { "height": "11mm", "gap": 0.12, "top": "= height + 3" }, "gravity")"),
        "\"position\": [3, 1, 5.12]", R"("position": [3, "= top / 13", 5.12])");
    const std::string wide = replaced(replaced(small_design, "\"value\": 10, ", ""), "\"set\": {",
                                      R"("variables": { "half": "= height / 2", "least": "1cm" }, "set": {)");
    const DesignFolder folder(
        replaced(replaced(wide, "= height / 2 + 0.12", "= half + gap * 1 mm"), "\"minimum\": 15", "\"minimum\": \"= 1.5 * least\""), scene);
    const Result<DesignFile> file = read_design(folder.design());
    INFO(all(file.errors()));
    REQUIRE(file);
    CHECK(file->design.parameters[0].value == 0.011);  // the scene's
    CHECK(file->design.scene.bodies[1].pose.position.z() == Approx(0.0055 + 0.00012));
    CHECK(file->design.scene.bodies[1].pose.position.y() == Approx(0.014 / 13));
    CHECK(file->design.constraints[0].bounds.lower == 0.015);
    CHECK(file->design.numbers.size() == 7);
    const auto errors_with = [&](const char* to) {
        const DesignFolder other(replaced(small_design, "\"set\": {", to), scene);
        return read_design(other.design()).errors();
    };
    CHECK(has(errors_with(R"("variables": { "a": "= b", "b": "= a" }, "set": {)"),
              {"", "", ErrorCode::inconsistent, "#/variables/", "follows from itself"}));
    CHECK(
        has(errors_with(R"("variables": { "height": 3 }, "set": {)"), {"", "", ErrorCode::inconsistent, "#/variables/height", "already"}));
    CHECK(has(errors_with(R"("variables": { "it's": 3 }, "set": {)"), {"", "", ErrorCode::out_of_range, "#/variables/it's", "quote"}));
}

TEST_CASE("bounds are plain numbers in the file's units, or carry a unit of their dimension") {
    const auto upper_of = [](const std::string& bounds) {
        const DesignFolder folder(replaced(small_design, "\"lower\": 1.5, \"upper\": 4", bounds));
        const Result<DesignFile> file = read_design(folder.design());
        INFO(all(file.errors()));
        REQUIRE(file);
        return file->design.constraints[4].bounds.upper;
    };
    CHECK(upper_of("\"upper\": 4") == 0.004);
    CHECK(upper_of("\"upper\": \"4 g\"") == 0.004);
    CHECK(upper_of("\"upper\": \"0.004kg\"") == 0.004);
    CHECK(upper_of("\"upper\": \"4000 mg\"") == 0.004);
}

TEST_CASE("a bound of 0 has a margin too: of the unit") {
    const std::string mass = R"({ "type": "mass", "bodies": ["cube"], "lower": 1.5, "upper": 4 })";
    const auto margin = [&](const std::string& bounds) {
        const std::string with = R"({ "type": "mass", "bodies": ["cube"], )" + bounds + " }";
        const DesignFolder folder(tests::support::replaced(small_design, mass, with));
        const auto file = read_design(folder.design());
        INFO(all(file.errors()));
        REQUIRE(file);
        return file->design.constraints.back().bounds.margin;
    };
    CHECK(margin(R"("lower": 1.5, "upper": 4)") == Approx(1e-4 * 4e-3));
    CHECK(margin(R"("lower": 0)") == Approx(1e-4 * 1e-3));  // masses are counted in g
    CHECK(margin(R"("lower": 0, "upper": 0)") == 0);
}

TEST_CASE("a density that is not per volume has no unit of a density per volume") {
    const std::string scene = replaced(small_scene, "\"density\": 1000", "\"density\": 2, \"mass_per\": \"area\"");
    const DesignFolder folder(small_design, scene);
    const Result<DesignFile> wrong = read_design(folder.design());
    REQUIRE_FALSE(wrong);
    CHECK(wrong.errors()[0].where.find("#/set/~1bodies~1cube~1density") != std::string::npos);
    CHECK(wrong.errors()[0].message.find("this is a density, a number is expected") != std::string::npos);
    const DesignFolder right(
        replaced(replaced(small_design, "\"value\": 1000, \"lower\": 500, \"upper\": 2000", "\"value\": 2, \"lower\": 1, \"upper\": 3"),
                 "\"unit\": \"kg/m^3\"", "\"unit\": \"1\""),
        scene);
    CHECK(read_design(right.design()));
}

TEST_CASE("an end time that no whole number of steps meets is covered, not cut short") {
    const DesignFolder folder(small_design,
                              replaced(small_scene, "\"timestep\": 0.005, \"end_time\": 0.1", "\"timestep\": 0.03, \"end_time\": 0.1"));
    const Result<DesignFile> file = read_design(folder.design());
    INFO(all(file.errors()));
    REQUIRE(file);
    CHECK(file->design.steps == 4);
}

}  // namespace fettle::design::reading::design_reader_test
