// SPDX-License-Identifier: MIT
// The table of quantities, row by row, on a design that has each of them once (every_quantity/): what a row and a quantity say of it holds,
// and the schema and the pages say it too.
#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "core/base/units.hpp"
#include "design/problem/design_problem.hpp"
#include "design/quantities/in_scenario.hpp"
#include "design/quantities/step_series.hpp"
#include "design/quantities/worst.hpp"
#include "design/reading/design_reader.hpp"
#include "design/reading/quantity_reader.hpp"
#include "tests/support/text.hpp"

namespace fettle::design::quantities::quantity_table_test {

using description::Quantity;
using description::QuantityFacts;
using nlohmann::json;
using reading::QuantityType;
using tests::support::contents;

namespace {

const char* const path = "tests/design/quantities/every_quantity/every_quantity.design.json";

// The quantities of the file's objective, by their type.
std::map<std::string, std::shared_ptr<const Quantity>> quantities_of(const description::Design& design) {
    const json terms = json::parse(contents(path))["objective"];
    REQUIRE(terms.size() == design.objective.size());
    std::map<std::string, std::shared_ptr<const Quantity>> out;
    for (std::size_t k = 0; k < terms.size(); ++k) out[terms[k]["type"]] = design.objective[k].quantity;
    return out;
}

description::Design every_quantity() {
    auto file = reading::read_design(path);
    for (const Error& error : file.errors()) UNSCOPED_INFO(error.where << ": " << error.message);
    REQUIRE(file);
    return std::move(file->design);
}

bool has_key(const QuantityType& type, std::string_view key) {
    return std::find(type.keys.begin(), type.keys.end(), key) != type.keys.end();
}

bool is_of_several(const QuantityType& type) { return type.name == "largest" || type.name == "least"; }

void check_parts(const QuantityType& type, const QuantityFacts& facts) {
    const bool is_expression = type.name == reading::expression_type;
    const bool has_parts = is_expression || is_of_several(type);
    CHECK((facts.kind == QuantityFacts::Kind::measured) == !has_parts);
    CHECK(facts.parts.empty() == !has_parts);
    CHECK((facts.formula == nullptr) == !is_expression);
    for (const description::NamedQuantity& part : facts.parts) CHECK((part.quantity && part.name.empty() == !is_expression));
}

void check_facts(const QuantityType& type, const Quantity& quantity, const description::Simulated& simulated) {
    const QuantityFacts facts = quantity.facts();
    check_parts(type, facts);
    // An expression is a series with these keys alone.
    const StepSeries* series = series_of(quantity);
    CHECK((series != nullptr) == (has_key(type, "over") && type.name != reading::expression_type));
    CHECK((facts.clearance != nullptr) == (has_key(type, "faces_a")));
    const auto steps = simulated.trajectory.steps.size();
    const std::vector<double> curve = quantity.curve(simulated);
    CHECK(curve.size() == (facts.curve ? steps : 0));
    const description::Measurement measured = quantity.value(simulated);
    CHECK(measured.fault.empty());
    CHECK(std::isfinite(measured.value));
    if (facts.is_number) CHECK((measured.lower == measured.value && measured.upper == measured.value && !measured.is_proven));
    const std::string unit(core::base::si_unit(series != nullptr ? series->instant_dimension() : quantity.dimension()));
    INFO(unit);
    CHECK((type.unit.find(unit) != std::string_view::npos || type.unit == "by its dimension"));
}

}  // namespace

TEST_CASE("quantity table: every row has a quantity in the file, whose facts are true") {
    description::Design design = every_quantity();
    const auto problem = problem::DesignProblem::create(design);
    for (const Error& error : problem.errors()) UNSCOPED_INFO(error.where << ": " << error.message);
    REQUIRE(problem);
    const auto at = problem->evaluate(description::values_of(problem->design().parameters));
    INFO(at.reason);
    REQUIRE(at.usable);
    const problem::SimulatedDesign simulated(problem->design(), at);
    const auto found = quantities_of(problem->design());
    CHECK(found.size() == reading::quantity_table().size());
    std::set<std::string> names;
    for (const description::ObjectiveTerm& term : problem->design().objective) names.insert(term.name);
    CHECK(names.size() == found.size());
    for (const QuantityType& type : reading::quantity_table()) {
        CAPTURE(type.name);
        const auto one = found.find(std::string(type.name));
        if (one == found.end()) FAIL_CHECK("the file has none of this kind");
        if (one != found.end()) check_facts(type, *one->second, simulated.in(0));
    }
}

TEST_CASE("quantity table: a quantity in a scenario, and the worst of two, say what they are made from") {
    for (const auto& [type, quantity] : quantities_of(every_quantity())) {
        CAPTURE(type);
        const auto there = in_scenario(quantity, 1);
        CHECK(has_scenario(*there));
        CHECK(clearance_of(*there) == quantity->facts().clearance);
        if (type == reading::expression_type || type == "largest" || type == "least") continue;  // its parts are there, each
        CHECK(in_scenario(there, 0) == there);
        CHECK(there->facts().kind == QuantityFacts::Kind::in_scenario);
        CHECK(scenario_of(*there) == 1);
        CHECK(&without_scenario(*there) == quantity.get());
        CHECK(there->facts().clearance == nullptr);  // another scenario's is not taken for this one's
        CHECK_FALSE(there->facts().is_number);
        const Worst worst({quantity, there}, true);
        REQUIRE(worst.facts().parts.size() == 2);
        CHECK(worst.facts().parts[1].quantity == there);
    }
}

TEST_CASE("quantity table: every row is in the schema with its keys, and on the pages") {
    const json schema = json::parse(contents("design/reading/design.schema.json"));
    std::map<std::string, json> branches;
    for (const json& branch : schema["$defs"]["quantity"]["oneOf"]) {
        const json& kind = branch["properties"]["type"];
        for (const json& name : kind.contains("const") ? json::array({kind["const"]}) : kind["enum"]) branches[name] = branch;
    }
    CHECK(branches.size() == reading::quantity_table().size());
    const std::string reference = contents("docs/files.md"), pages = contents("docs/interface.md") + contents("docs/method/design.md");
    for (const QuantityType& type : reading::quantity_table()) {
        const std::string name(type.name);
        CAPTURE(name);
        if (branches.count(name) == 0) {
            FAIL_CHECK("the schema does not know it");
            continue;
        }
        std::set<std::string> keys, known(type.keys.begin(), type.keys.end());
        for (const auto& [key, value] : branches[name]["properties"].items()) keys.insert(key);
        known.insert("type");
        CHECK(keys == known);
        CHECK(reference.find('`' + name + '`') != std::string::npos);
        CHECK(pages.find('`' + name + '`') != std::string::npos);
    }
}

}  // namespace fettle::design::quantities::quantity_table_test
