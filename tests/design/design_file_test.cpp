// SPDX-License-Identifier: MIT
#include "fettle/design/design_file.hpp"

#include <catch2/catch.hpp>
#include <fstream>

#include "fettle/tests/design/small_design.hpp"

namespace {

using namespace fettle;
using namespace fettle::design;
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
    const Result<Design> design = read_design(folder.design());
    INFO(all(design.errors()));
    REQUIRE(design);
    REQUIRE(design->parameters.size() == 5);
    CHECK(design->parameters[0].value == 0.01);
    CHECK(design->parameters[0].moves.size() == 2);
    CHECK(design->parameters[0].moves[1].position_offset.z() == Approx(0.00012));
    CHECK(design->parameters[3].value == 1000);
    CHECK(design->parameters[4].value == Approx(40 * std::acos(-1.0) / 180));
    CHECK(design->steps == 20);
    REQUIRE(design->objective.size() == 5);
    CHECK(design->objective[0].name == "mass cube");
    REQUIRE(design->constraints.size() == 5);  // one of them in two windows
    CHECK(design->constraints[0]->bounds().lower == 0.015);
    CHECK(design->constraints[0]->target_lower() == Approx(0.015002));
    CHECK(design->constraints[1]->name() == "clearance cube:wall over the motion 2 window 1");
    CHECK(design->constraints[4]->bounds().upper == Approx(0.004));
    CHECK(design->optimiser.name == "mma");
}

TEST_CASE("every fault of a design is named, with its place") {
    const Fault faults[] = {
        {"\"lower\": 6,", "\"lower\": 16,", ErrorCode::inconsistent, "#/parameters/0/lower", "above the upper bound"},
        {"\"value\": 10,", "\"value\": 15,", ErrorCode::out_of_range, "#/parameters/0/value", "outside the bounds"},
        {"\"value\": 10,", "\"value\": \"ten\",", ErrorCode::wrong_type, "#/parameters/0/value", ""},
        {"\"value\": 10,", "\"valeu\": 10,", ErrorCode::unknown_key, "#/parameters/0/valeu", "value"},
        {"\"dimension\": \"size_z\"", "\"dimension\": \"size_zz\"", ErrorCode::out_of_range, "#/parameters/0/moves/0/dimension", "size_z"},
        {"\"body\": \"cube\", \"dimension\"", "\"body\": \"cubes\", \"dimension\"", ErrorCode::out_of_range, "#/parameters/0/moves/0/body",
         "did you mean \"cube\"?"},
        {"\"motor\": \"table\"", "\"motor\": \"cube\"", ErrorCode::inconsistent, "#/parameters/4/moves/0/rate", "no motor"},
        {"\"unit\": \"deg/s\"", "\"unit\": \"deg/sec\"", ErrorCode::out_of_range, "#/parameters/4/unit", "deg/s"},
        {"\"unit\": \"deg/s\"", "\"unit\": \"mm\"", ErrorCode::inconsistent, "#/parameters/4/moves/0", "not a measure"},
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
        {"\"name\": \"mma\"", "\"name\": \"mna\"", ErrorCode::out_of_range, "#/optimiser/name", "mma"},
        {"\"max_evaluations\": 8", "\"max_evaluations\": 0", ErrorCode::out_of_range, "#/optimiser/max_evaluations", ""},
        {"\"scene\": \"small.scene.json\"", "\"scene\": \"smal.scene.json\"", ErrorCode::file_not_found, "smal.scene.json", ""},
        {"\"units\": \"mm\"", "\"units\": \"furlong\"", ErrorCode::out_of_range, "#/units", "mm"},
        {"\"value\": 10,", "\"value\": NaN,", ErrorCode::not_finite, "", ""},
        {"\"fettle_design\": 1", "\"fettle_design\": 2", ErrorCode::out_of_range, "#/fettle_design", ""},
    };
    for (const Fault& fault : faults) {
        const DesignFolder folder(replaced(small_design, fault.from, fault.to));
        const Result<Design> design = read_design(folder.design());
        INFO(fault.from << " -> " << fault.to << "\n" << all(design.errors()));
        REQUIRE_FALSE(design);
        CHECK(has(design.errors(), fault));
    }
}

TEST_CASE("all faults are told at once") {
    const std::string twice = replaced(replaced(small_design, "\"lower\": 6,", "\"lower\": 16,"), "\"minimum\": 15", "\"minimum\": -15");
    const DesignFolder folder(twice);
    CHECK(read_design(folder.design()).errors().size() == 2);
}

TEST_CASE("a scaled part cannot be moved by a dimension") {
    const DesignFolder folder(small_design, replaced(small_scene, "\"angular_velocity\"", "\"scale\": 2, \"angular_velocity\""));
    const Result<Design> design = read_design(folder.design());
    REQUIRE_FALSE(design);
    CHECK(design.errors()[0].code == ErrorCode::unsupported);
}

TEST_CASE("a rewritten design reads back bit for bit, from another folder, and has the same hash but for its values") {
    const DesignFolder folder;
    const Result<Design> design = read_design(folder.design());
    REQUIRE(design);
    VectorX values(5);
    values << 0.0123456789012345678, 0.2 / 11, -1e-3 / 3, 1234.5678901234567, 0.98765432109876543;
    for (Eigen::Index k = 0; k < 5; ++k) values[k] = representable(values[k], design->parameters[static_cast<size_t>(k)].unit);
    values[2] = design->parameters[2].upper;
    const auto out = folder.path / "out";
    std::filesystem::create_directories(out);
    const std::string path = (out / "design.final.json").string();
    std::ofstream(path) << design_text(*design, values, out.string());
    const Result<Design> again = read_design(path);
    INFO(all(again.errors()));
    REQUIRE(again);
    for (Eigen::Index k = 0; k < 5; ++k) CHECK(again->parameters[static_cast<size_t>(k)].value == values[k]);
    CHECK(design_hash(*again) != design_hash(*design));
    std::ofstream(path) << design_text(*design, values_of(design->parameters), out.string());
    CHECK(design_hash(*read_design(path)) == design_hash(*design));

    const DesignFolder moved(small_design, replaced(small_scene, "\"size_y\": 12", "\"size_y\": 12.5"));
    CHECK(design_hash(*read_design(moved.design())) != design_hash(*design));
    const DesignFolder other_optimiser(replaced(small_design, "\"max_evaluations\": 8", "\"max_evaluations\": 9"));
    CHECK(design_hash(*read_design(other_optimiser.design())) == design_hash(*design));
}
