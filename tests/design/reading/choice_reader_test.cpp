// SPDX-License-Identifier: MIT
#include "design/reading/choice_reader.hpp"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "core/base/text.hpp"
#include "core/scene_files/scene_reader.hpp"
#include "design/reading/design_text.hpp"
#include "design/reading/scene_shapes.hpp"
#include "design/reading/scene_text.hpp"
#include "tests/design/choice_design.hpp"
#include "tests/support/text.hpp"

namespace fettle::design::reading::choice_reader_test {

namespace {

using namespace fettle::tests::design_support;
using description::Choice;
using description::Combination;
using fettle::tests::support::replaced;

DesignFile read(const std::string& text) {
    const ChoiceFolder folder(text);
    const Result<DesignFile> file = read_design(folder.design());
    for (const Error& error : file.errors()) UNSCOPED_INFO(error.where << ": " << error.message);
    REQUIRE(file);
    return *file;
}

int teeth_of(const DesignFile& file) { return file.design.scene.bodies[0].shape->counts.at("teeth"); }

// The choice `teeth` replaced.
std::string with_teeth(const std::string& teeth) { return replaced(choice_design, R"({ "from": 11, "to": 20 })", teeth); }

}  // namespace

TEST_CASE("choices are read with the option that the design has: the scene's number, or the first") {
    const DesignFile file = read(choice_design);
    REQUIRE(file.choices.size() == 2);
    const Choice &material = file.choices[0], &teeth = file.choices[1];
    CHECK(material.name == "material");
    CHECK(material.options == std::vector<std::string>{"PLA", "POM"});  // by name
    CHECK_FALSE(material.is_ordered);
    CHECK(teeth.options.size() == 10);
    CHECK(teeth.options[teeth.value] == "15");
    CHECK(teeth.is_ordered);
    CHECK(teeth_of(file) == 15);
    CHECK(file.design.scene.bodies[0].density == 1240);
    const DesignFile other = read(with_teeth(R"({ "values": [12, 18, 24] })"));
    CHECK(teeth_of(other) == 12);  // 15 is none of them
    CHECK(read(with_teeth(R"({ "from": 11, "to": 20, "step": 3, "value": 17 })")).choices[1].options ==
          std::vector<std::string>{"11", "14", "17", "20"});
    CHECK(teeth_of(read(with_teeth(R"({ "from": 11, "to": 20, "step": 3, "value": 17 })"))) == 17);
}

TEST_CASE("a relation that follows from choices alone is a condition, judged for every combination") {
    const DesignFile file = read(choice_design);
    REQUIRE(file.design.relations.size() == 2);
    CHECK_FALSE(file.design.relations[0].by_choices);
    CHECK(file.design.relations[1].by_choices);
    REQUIRE(file.conditions.size() == 1);
    CHECK(file.conditions[0].name == "not 14");
    for (int option = 0; option < 10; ++option) {
        const Combination combination{0, option};
        const double teeth = 11 + option;
        CHECK(value_of(file.conditions[0], file.choices, combination) == Approx((teeth / 2 - 7) * (teeth / 2 - 7)).margin(1e-15));
        CHECK(is_allowed(file.conditions, file.choices, combination) == (teeth != 14));
    }
    // Without the choice it is a mistake, as ever.
    const ChoiceFolder folder(with_teeth(R"({ "values": [15], "value": 15 })").replace(0, 0, ""));
    CHECK(read_design(folder.design()));
    const std::string none = replaced(choice_design, R"(,
    "teeth": { "from": 11, "to": 20 })",
                                      "");
    const ChoiceFolder without(none);
    const Result<DesignFile> refused = read_design(without.design());
    REQUIRE_FALSE(refused);
    CHECK(refused.errors()[0].message.find("this names no parameter") == 0);
}

TEST_CASE("a design with other options has them in its scene, its text and the scene that is written of it") {
    const ChoiceFolder folder;
    const Result<DesignFile> file = read_design(folder.design());
    REQUIRE(file);
    const std::string text = text_with_choices(*file, {1, 2});
    const Result<DesignFile> other = parse_design(text, folder.design());
    REQUIRE(other);
    CHECK(description::combination_of(other->choices) == Combination{1, 2});
    CHECK(description::text_of(other->choices, {1, 2}) == "material POM, teeth 13");
    CHECK(teeth_of(*other) == 13);
    CHECK(other->design.scene.bodies[0].density == 1410);
    CHECK(design_hash(*other) != design_hash(*file));
    CHECK(text_with_choices(*other, description::combination_of(file->choices)) ==
          text_with_choices(*file, description::combination_of(file->choices)));
    // All else is as it was, but for the values that are asked for.
    auto before = nlohmann::json::parse(choice_design), after = nlohmann::json::parse(text);
    for (auto* json : {&before, &after})
        for (auto& [name, choice] : (*json)["choices"].items()) choice.erase("value");
    CHECK(before == after);
    const Result<DesignFile> wider = parse_design(text_with_choices(*file, {1, 2}, VectorX::Constant(1, 6e-3)), folder.design());
    REQUIRE(wider);
    CHECK(wider->design.parameters[0].value == 6e-3);
    auto parts = std::make_shared<std::vector<MadePart>>();
    const auto options = scene_read_options({}, Programs::refused, parts, 1);
    const Result<std::string> written = scene_text(*other, folder.file("out.scene.json"), options);
    for (const Error& error : written.errors()) UNSCOPED_INFO(error.where << ": " << error.message);
    REQUIRE(written);
    const auto scene = nlohmann::json::parse(*written);
    CHECK(scene["variables"]["teeth"] == 13);
    CHECK(scene["bodies"][0]["density"] == 1410);
}

TEST_CASE("a scenario has the design's options too") {
    const DesignFile file = read(replaced(with_teeth(R"({ "from": 11, "to": 20, "value": 16 })"), "\"objective\"",
                                          R"("scenarios": [{ "name": "light", "set": { "/gravity": [0, 0, -1] } }, { "name": "heavy" }],
  "objective")"));
    for (const description::Scenario& scenario : file.design.scenarios) CHECK(scenario.scene.bodies[0].shape->counts.at("teeth") == 16);
}

TEST_CASE("what is wrong with choices is told at its place") {
    const auto fault = [](const std::string& text) {
        const ChoiceFolder folder(text);
        const Result<DesignFile> file = read_design(folder.design());
        return file ? std::string("none")
                    : file.errors().front().where.substr(file.errors().front().where.find('#')) + " " + file.errors().front().message;
    };
    CHECK(fault(with_teeth(R"({ "from": 20, "to": 11 })")).find("#/choices/teeth/to `to` is below `from`") == 0);
    CHECK(fault(with_teeth("{}")).find("#/choices/teeth a choice is one of these") == 0);
    CHECK(fault(with_teeth(R"({ "from": 11, "to": 20, "values": [1] })")).find("#/choices/teeth a choice is one of these") == 0);
    CHECK(fault(with_teeth(R"({ "values": [12, 12] })")).find("#/choices/teeth/values the values of a choice grow") == 0);
    CHECK(fault(with_teeth(R"({ "values": [] })")).find("#/choices/teeth/values there is nothing to choose") == 0);
    CHECK(fault(with_teeth(R"({ "from": 1, "to": 100000 })")).find("#/choices/teeth these are more than 1000 options") == 0);
    CHECK(fault(with_teeth(R"({ "from": 11, "to": 20, "value": 21 })")).find("#/choices/teeth/value 21 is none of") == 0);
    CHECK(fault(with_teeth(R"({ "from": 11, "to": 20, "steps": 2 })")).find("#/choices/teeth/steps") == 0);
    CHECK(fault(replaced(choice_design, R"("teeth": { "from")", R"("tooth": { "from")"))
              .find("#/choices/tooth the scene has no variable `tooth`") == 0);
    CHECK(
        fault(replaced(choice_design, R"(/bodies/wheel/density": 1240)", R"(/bodies/weel/density": 1240)")).find("has no element `weel`") !=
        std::string::npos);
    CHECK(fault(replaced(choice_design, R"("options": {)", R"("value": "ABS", "options": {)")).find("#/choices/material/value") == 0);
    CHECK(fault(with_teeth(R"({ "from": 0, "to": 2147483647, "step": 2147483647 })")) != "none");  // no such gear
    const std::string width = replaced(choice_design, R"("choices": {)", R"("choices": { "both": { "options": {
        "one": { "set": { "/variables/width": "6mm" } }, "other": { "set": { "/variables/width": "7mm" } } } },)");
    CHECK(fault(width).find("#/choices/both `width` is a parameter already") == 0);
    // A number of teeth that the part does not have, found in the scene.
    CHECK(fault(with_teeth(R"({ "values": [2] })")) != "none");
}

}  // namespace fettle::design::reading::choice_reader_test
