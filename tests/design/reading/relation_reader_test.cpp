// SPDX-License-Identifier: MIT
#include "design/reading/relation_reader.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <tuple>

#include "design/description/requirement_text.hpp"
#include "design/reading/design_reader.hpp"
#include "tests/design/small_design.hpp"

namespace fettle::design::reading::relation_reader_test {

namespace {

using namespace fettle::tests::design_support;
using fettle::design::description::Relation;
using fettle::design::description::values_of;

// The small design with further constraints: relation(s) as JSON.
std::string with(const std::string& constraints) {
    return replaced(small_design, "\"constraints\": [", "\"constraints\": [\n" + constraints + ",");
}

Result<DesignFile> read(const std::string& constraints) {
    const DesignFolder folder(with(constraints));
    return read_design(folder.design());
}

Relation relation(const std::string& text) {
    const Result<DesignFile> file = read(text);
    for (const Error& error : file.errors()) UNSCOPED_INFO(error.where << ": " << error.message);
    REQUIRE(file);
    REQUIRE(file->design.relations.size() == 1);
    CHECK(file->design.constraints.size() == 5);
    return file->design.relations[0];
}

struct Fault {
    const char* text;
    ErrorCode code;
    const char *pointer, *words;
};

}  // namespace

TEST_CASE("a ratio, a sum and a formula are read as relations between the parameters") {
    const DesignFolder folder;
    const VectorX p = values_of(read_design(folder.design())->design.parameters);  // 10 mm, 20 mm, 3 mm, 1000 kg/m^3, 40 deg/s
    const Relation ratio = relation(R"({ "type": "relation", "name": "slender", "expression": "height / width", "upper": 0.6 })");
    CHECK(ratio.name == "slender");
    CHECK(ratio.bounds.upper == 0.6);
    CHECK(std::isinf(ratio.bounds.lower));
    CHECK(ratio.at(p).value == 0.5);
    CHECK(ratio.at(p).gradient[1] == Approx(-0.01 / 4e-4));
    // 1e-5 of what it changes by: 8 mm / 20 mm + 10 mm / 400 mm^2 * 15 mm
    CHECK(ratio.bounds.margin == Approx(1e-5 * (0.4 + 0.375)));
    CHECK(ratio.tolerance == 0);

    const Relation sum = relation(R"({ "type": "relation", "expression": "height + width", "lower": "3cm", "upper": 30 })");
    CHECK(sum.name == "height + width");
    CHECK(sum.bounds.lower == 0.03);
    CHECK(sum.bounds.upper == 0.03);
    CHECK(sum.bounds.unit == 1e-2);
    CHECK(sum.bounds.margin == 0);
    CHECK(sum.tolerance == Approx(1e-5 * 23e-3));
    CHECK(violation(sum, sum.at(p).value) == 0);

    const Relation spin = relation(
        R"({ "type": "relation", "expression": "speed * 2 s", "lower": "45 deg", "upper": "1.5 rad", "margin": "1 deg", "tolerance": "0.1 deg" })");
    CHECK(spin.bounds.lower == Approx(std::acos(-1.0) / 4));
    CHECK(spin.bounds.margin == Approx(std::acos(-1.0) / 180));
    CHECK(spin.tolerance == Approx(std::acos(-1.0) / 1800));
    CHECK(description::unit_name(spin) == "rad");
    CHECK(description::required_text(spin.bounds, description::unit_name(spin)) == "0.7853982 to 1.5 rad");
}

TEST_CASE("a relation is told in the unit of its bound, whatever its dimension") {
    const auto told = [](const std::string& expression, const std::string& upper) {
        const Relation found = relation(R"({ "type": "relation", "expression": ")" + expression + R"(", "upper": )" + upper + " }");
        return description::required_text(found.bounds, description::unit_name(found));
    };
    CHECK(told("speed * 2 s", R"("250 deg")") == "at most 250 deg");
    CHECK(told("height / width", "3") == "at most 3");
    CHECK(told("height + width", "30") == "at most 30 mm");
    CHECK(told("1 N * height", R"("60 N mm")") == "at most 60 N mm");
    CHECK(told("1 kg * height", R"("1 kg * 20 mm")") == "at most 0.02");  // no unit has that dimension: SI
}

TEST_CASE("a relation names variables: of the scene, of the design, those that follow from a parameter and those that have a tolerance") {
    const std::string scene = replaced(small_scene, "\"bodies\": [", R"("variables": {"gap": "2 mm", "twice": "2 * gap"}, "bodies": [)");
    const auto read_it = [&](const std::string& relation, const std::string& also, bool as_made) {
        std::string text =
            replaced(with(relation), "\"objective\"", "\"variables\": {\"half\": \"height / 2\"}, " + also + " \"objective\"");
        text = replaced(text, "\"parameters\": [", R"("parameters": [{"name": "shim", "value": 1, "lower": 0.5, "upper": 3},)");
        const DesignFolder folder(text, scene);
        DesignReadOptions options;
        options.as_made = as_made;
        return read_design(folder.design(), options);
    };
    const std::string both = R"({"type": "relation", "expression": "half + twice - shim", "upper": "9 mm"})";
    const std::string alone = R"({"type": "relation", "name": "play", "expression": "twice - gap", "lower": "1 mm"},)" + both;
    const std::string tolerances = R"("tolerances": {"gap": "+-0.1 mm"},)";

    const Result<DesignFile> plain = read_it(both, "", false);
    for (const Error& error : plain.errors()) UNSCOPED_INFO(error.where << ": " << error.message);
    REQUIRE(plain);
    const VectorX p = values_of(plain->design.parameters);
    CHECK(plain->design.relations[0].at(p).value == Approx(8e-3));
    CHECK(plain->design.relations[0].at(p).gradient[0] == -1);
    CHECK(plain->design.relations[0].at(p).gradient[1] == 0.5);

    const Result<DesignFile> refused = read_it(alone, "", false);
    REQUIRE(refused.errors().size() == 1);
    CHECK(refused.errors()[0].message == "this names no parameter, and no variable that follows from one, so no design could change it");

    const Result<DesignFile> drawn = read_it(alone, tolerances, false);
    REQUIRE(drawn);
    CHECK(drawn->design.relations.size() == 1);
    REQUIRE_FALSE(drawn->warnings.empty());
    CHECK(drawn->warnings[0].find("`fettle tolerance` alone looks at it") != std::string::npos);

    const Result<DesignFile> made = read_it(alone, tolerances, true);
    REQUIRE(made);
    REQUIRE(made->design.relations.size() == 2);
    const Relation& play = made->design.relations[0];
    const VectorX d = values_of(made->design.parameters);
    CHECK(play.at(d).value == Approx(2e-3));
    CHECK(play.at(d).gradient[d.size() - 1] == 1);
}

TEST_CASE("a variable is what `set` makes of it, in relations, expressions and bounds; what a scenario has otherwise is refused") {
    const std::string scene = replaced(small_scene, "\"bodies\": [", R"("variables": {"gap": "2 mm", "twice": "2 * gap"}, "bodies": [)");
    const std::string relation = R"({"type": "relation", "expression": "height + twice", "upper": "99 mm"})";
    const std::string stroke = R"({"type": "stroke", "body": "cube", "axis": [0, 0, 1], "upper": "= twice + width"})";
    const auto read_it = [&](const std::string& constraint, const std::string& set, const std::string& also) {
        std::string text = replaced(with(constraint), "\"set\": {", "\"set\": {" + set);
        const DesignFolder folder(replaced(text, "\"objective\"", also + "\"objective\""), scene);
        return read_design(folder.design());
    };
    const auto fault = [&](const auto&... words) {
        const Result<DesignFile> file = read_it(words...);
        REQUIRE(file.errors().size() == 1);
        return file.errors()[0].where.substr(file.errors()[0].where.find('#')) + ": " + file.errors()[0].message;
    };
    for (const auto& [set, value, slope] :
         {std::tuple{"", 14e-3, 1.0}, {R"("/variables/gap": "5 mm",)", 20e-3, 1.0}, {R"("/variables/gap": "= 3 * height",)", 70e-3, 7.0}}) {
        CAPTURE(set);
        const Result<DesignFile> file = read_it(relation, set, "");
        REQUIRE(file);
        const VectorX p = values_of(file->design.parameters);
        CHECK(file->design.relations[0].at(p).value == Approx(value));
        CHECK(file->design.relations[0].at(p).gradient[0] == Approx(slope));
        REQUIRE(read_it(stroke, set, ""));
    }
    CHECK(fault(relation, R"("/variables/gap": "5 mm",)", R"("variables": {"half": "gap / 2"},)") ==
          "#/variables/half: `gap` is a variable that this design's `set` changes: name here what it is set to");
    const std::string scenarios = R"("scenarios": [{"name": "tight"}, {"name": "loose", "set": {"/variables/gap": "3 mm"}}],)";
    const std::string words = "`twice` is another number in the scenario `loose`: write the number that is meant";
    CHECK(fault(relation, "", scenarios) == "#/constraints/0/expression: " + words);
    CHECK(fault(stroke, "", scenarios) == "#/constraints/0/upper: " + words);
    CHECK(fault(R"({"type": "expression", "expression": "twice / height", "upper": 1})", "", scenarios) ==
          "#/constraints/0/expression: " + words);
}

TEST_CASE("relations and other constraints share their names") {
    const Result<DesignFile> file = read(
        R"({ "type": "relation", "expression": "height / width", "upper": 0.6 },
           { "type": "relation", "name": "height / width", "expression": "height / width", "lower": 0.1 },
           { "type": "relation", "name": "mass cube", "expression": "width", "lower": 15 })");
    REQUIRE(file);
    REQUIRE(file->design.relations.size() == 3);
    CHECK(file->design.relations[1].name == "height / width 2");
    CHECK(file->design.relations[2].name == "mass cube 2");
}

TEST_CASE("every fault of a relation is named, with its place") {
    const Fault faults[] = {
        {R"({ "type": "relatoin", "expression": "height / width", "upper": 1 })", ErrorCode::out_of_range, "/type", "relation"},
        {R"({ "type": "relation", "expresion": "height / width", "upper": 1 })", ErrorCode::unknown_key, "/expresion", "expression"},
        {R"({ "type": "relation", "upper": 1 })", ErrorCode::missing_key, "", "expression"},
        {R"({ "type": "relation", "expression": 3, "upper": 1 })", ErrorCode::wrong_type, "/expression", ""},
        {R"({ "type": "relation", "expression": "height / width" })", ErrorCode::missing_key, "", "`lower`, `upper` or both"},
        {R"({ "type": "relation", "expression": "height / widht", "upper": 1 })", ErrorCode::out_of_range, "/expression",
         "did you mean `width`?"},
        {R"({ "type": "relation", "expression": "height + density", "upper": 1 })", ErrorCode::wrong_type, "/expression",
         "a length and a density cannot be added"},
        {R"({ "type": "relation", "expression": "2 * 3", "upper": 1 })", ErrorCode::inconsistent, "/expression", "names no parameter"},
        {R"x({ "type": "relation", "expression": "sqrt(height / width - 1)", "upper": 1 })x", ErrorCode::not_finite, "/expression",
         "not a finite number"},
        {R"({ "type": "relation", "expression": "height + width", "upper": "30 g" })", ErrorCode::wrong_type, "/upper",
         "\"30 g\" is a mass; the expression is a length"},
        {R"({ "type": "relation", "expression": "height + width", "upper": "30 mmm" })", ErrorCode::parse, "/upper", "no such unit"},
        {R"({ "type": "relation", "expression": "height + width", "upper": "width" })", ErrorCode::unsupported, "/upper",
         "subtract it from the expression"},
        {R"({ "type": "relation", "expression": "height + width", "upper": "depth" })", ErrorCode::out_of_range, "/upper",
         "there is no parameter `depth`"},
        {R"({ "type": "relation", "expression": "speed * 2 s", "upper": 1 })", ErrorCode::wrong_type, "/upper",
         "the expression is an angle; write 1 with its unit"},
        {R"({ "type": "relation", "expression": "height / width", "lower": 2, "upper": 1 })", ErrorCode::inconsistent, "/lower", "above"},
        {R"({ "type": "relation", "expression": "height / width", "upper": 1, "margin": -0.1 })", ErrorCode::out_of_range, "/margin",
         "not negative"},
        {R"({ "type": "relation", "expression": "height / width", "upper": 1, "tolerance": -0.1 })", ErrorCode::out_of_range, "/tolerance",
         "not negative"},
    };
    for (const Fault& fault : faults) {
        const Result<DesignFile> file = read(fault.text);
        INFO(fault.text);
        REQUIRE_FALSE(file);
        for (const Error& error : file.errors()) UNSCOPED_INFO(error.where << ": " << error.message);
        CHECK(file.errors().size() == (fault.code == ErrorCode::unknown_key ? 2 : 1));
        const Error& error = file.errors()[0];
        CHECK(error.code == fault.code);
        CHECK(error.where.ends_with(std::string("#/constraints/0") + fault.pointer));
        CHECK(error.message.find(fault.words) != std::string::npos);
    }
}

}  // namespace fettle::design::reading::relation_reader_test
