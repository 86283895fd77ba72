// SPDX-License-Identifier: MIT
// The tables of an optimised design: requirements, parameters, starts, and what finer facets and time steps change.
#include "design/report/design_rows.hpp"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <vector>

#include "design/reading/design_reader.hpp"
#include "tests/design/small_design.hpp"

namespace fettle::design::report::design_rows_test {

namespace {

using Json = nlohmann::ordered_json;
using fettle::tests::design_support::DesignFolder;

}  // namespace

TEST_CASE("design rows: requirements, what is required in mm, what it costs per mm") {
    const DesignFolder folder;
    const auto file = reading::read_design(folder.design());
    REQUIRE(file);
    Json result = Json::parse(R"({"status": "optimal", "parameters_start": {"height": 10, "density": 1000}, "parameters": {"height": 9},
        "constraints": [{"name": "x", "lower": 0.0151, "upper": 0.0152, "proven": true, "met": true}],
        "optimality": {"worth": 0.01, "held_by": {"height": "lower bound"}, "improvable": [{"parameter": "width", "step": 0.5}]}})");
    const auto& constraints = file->design.constraints;
    result["optimality"]["multipliers"][constraints[0].name] = 3.0;
    const Json rows = requirement_rows(file->design, result);
    REQUIRE(rows.size() == constraints.size());
    CHECK(rows[0]["unit"] == "mm");
    CHECK(rows[0]["required_lower"].get<double>() == Approx(15));
    CHECK(rows[0]["required_upper"].is_null());
    CHECK(rows[0]["lower"].get<double>() == Approx(15.1));
    CHECK(rows[0]["proven"] == true);
    CHECK(rows[1]["proven"] == false);
    CHECK(rows[0]["met"] == true);
    CHECK(rows[0]["cost"] == 3.0);
    CHECK(rows[0]["counts"] == true);
    CHECK(rows[0]["pair"].is_null());  // the answer has no pairs
    CHECK(rows[1]["met"] == false);    // of what is not told nothing is met
    const Json& mass = rows.back();
    CHECK(mass["unit"] != "mm");
    const Json parameters = parameter_rows(file->design, result);
    CHECK(parameters[0]["start"] == 10);
    CHECK(parameters[0]["end"] == 9);
    CHECK(parameters[0]["lower"] == 6);
    CHECK(parameters[0]["held"] == "lower bound");
    CHECK(parameters[1]["step"] == 0.5);
    CHECK(parameters[1]["start"].is_null());
    CHECK(parameters[3]["unit"] == "kg/m^3");
}

TEST_CASE("design rows: starts, the one taken first, then as they would be chosen") {
    const DesignFolder folder;
    const auto file = reading::read_design(folder.design());
    REQUIRE(file);
    const auto values = [](double height, double place) {
        return Json{{"height", height}, {"width", 20}, {"place", place}, {"density", 1000}, {"speed", 40}};
    };
    const auto start = [&](int seed, const char* status, const Json& objective, const Json& violation, const Json& parameters) {
        return Json{{"seed", seed},
                    {"status", status},
                    {"message", "why"},
                    {"objective", objective},
                    {"evaluations", seed + 1},
                    {"constraint_violation", violation},
                    {"parameters", parameters},
                    {"limited_by", {"mass"}}};
    };
    Json result{{"seed", 7}, {"parameters", values(10, 5)}, {"starts", Json::array()}};
    CHECK(start_rows(file->design, Json::object()).empty());
    result["starts"] = {start(0, "infeasible", 0.5, 0.3, values(10, 0)), start(6, "optimal", 3.0, 0.0, values(12, 5)),
                        start(7, "optimal", 2.0, 0.0, values(10, 5)), start(8, "failed", Json(), Json(), Json())};
    const Json rows = start_rows(file->design, result);
    REQUIRE(rows.size() == 4);
    std::vector<int> order;
    for (const Json& row : rows) order.push_back(row["seed"].get<int>());
    CHECK(order == std::vector<int>{7, 6, 0, 8});
    CHECK(rows[0]["taken"] == true);
    CHECK(rows[0]["away"] == 0.0);
    CHECK(rows[1]["taken"] == false);
    CHECK(rows[1]["away"].get<double>() == Approx(2.0 / 8));  // of height, between 6 and 14
    CHECK(rows[2]["away"].get<double>() == Approx(5.0 / 25));
    CHECK(rows[2]["violation"] == 0.3);
    CHECK(rows[3]["away"].is_null());
    CHECK(rows[3]["objective"].is_null());
    CHECK(rows[3]["message"] == "why");
    CHECK(rows[0]["limits"] == Json({"mass"}));
}

TEST_CASE("design rows: the check of resolution, in the units that are shown") {
    const DesignFolder folder;
    const auto file = reading::read_design(folder.design());
    REQUIRE(file);
    description::Design design = file->design;
    design.objective.resize(1);
    Json result{{"objective", 2.0}, {"resolution", Json()}};
    CHECK(resolution_data(design, result).is_null());
    CHECK(resolution_data(design, Json::object()).is_null());
    Json terms = Json::array(), constraints = Json::array();
    terms.push_back(
        {{"name", design.objective[0].name}, {"found", 2e-3}, {"finer_facets", 2.1e-3}, {"finer_steps", Json()}, {"change", 0.05}});
    for (const auto& constraint : design.constraints)
        constraints.push_back({{"name", constraint.name},
                               {"found", 0.0151},
                               {"finer_facets", 0.0149},
                               {"finer_steps", Json()},
                               {"change", 0.02},
                               {"met", true},
                               {"met_finer", &constraint != &design.constraints[0]}});
    result["resolution"] = {{"runs",
                             {{{"run", "finer_facets"}, {"objective", 2.1}, {"change_of_best", 0.1}},
                              {{"run", "finer_steps"}, {"objective", Json()}, {"change_of_best", Json()}, {"failure", "it jams"}}}},
                            {"terms", terms},
                            {"constraints", constraints},
                            {"flips", {design.constraints[0].name}}};
    const Json data = resolution_data(design, result);
    REQUIRE(data["runs"].size() == 2);
    CHECK(data["runs"][0]["failure"].is_null());
    CHECK(data["runs"][0]["change_of_best"] == 0.1);
    CHECK(data["runs"][1]["failure"] == "it jams");
    REQUIRE(data["rows"].size() == 1 + design.constraints.size());
    CHECK(data["rows"][0]["of"] == "term");
    CHECK(data["rows"][0]["met"].is_null());
    const Json& gap = data["rows"][1];
    CHECK(gap["of"] == "constraint");
    CHECK(gap["unit"] == "mm");
    CHECK(gap["found"].get<double>() == Approx(15.1));
    CHECK(gap["finer"][0].get<double>() == Approx(14.9));
    CHECK(gap["finer"][1].is_null());
    CHECK(gap["change"] == 0.02);
    CHECK(gap["met"] == true);
    CHECK(gap["met_finer"] == false);
    CHECK(gap["flips"] == true);
    for (std::size_t i = 1; i < design.constraints.size(); ++i) CHECK(data["rows"][1 + i]["flips"] == false);
    // Where no run has numbers, why is told; of several terms their sum is a row of its own.
    Json failed = result;
    failed["resolution"]["terms"] = failed["resolution"]["constraints"] = failed["resolution"]["flips"] = Json::array();
    CHECK(resolution_data(design, failed)["rows"].empty());
    CHECK(resolution_data(design, failed)["runs"].size() == 2);
    description::Design two = design;
    two.objective.push_back(design.objective[0]);
    result["resolution"]["terms"].push_back(terms[0]);
    const Json whole = resolution_data(two, result)["rows"][0];
    CHECK(whole["of"] == "objective");
    CHECK(whole["found"] == 2.0);
    CHECK(whole["finer"][0] == 2.1);
    CHECK(whole["change"].get<double>() == Approx(0.1 / 2.1));
}

}  // namespace fettle::design::report::design_rows_test
