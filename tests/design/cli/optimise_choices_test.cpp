// SPDX-License-Identifier: MIT
// `fettle optimise` of a design with choices, from outside.
#include "design/cli/optimise_choices.hpp"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "tests/design/choice_design.hpp"
#include "tests/support/program.hpp"
#include "tests/support/text.hpp"

namespace fettle::design::cli::optimise_choices_test {

namespace {

using Json = nlohmann::json;
using namespace fettle::tests::design_support;
using fettle::tests::support::Answer;
using fettle::tests::support::contents;
using fettle::tests::support::run;

}  // namespace

TEST_CASE("optimise tunes each combination of a design's choices, and keeps the best") {
    const ChoiceFolder folder(fettle::tests::support::replaced(choice_design, "\"to\": 20", "\"to\": 15"));
    const std::string out = folder.file("out");
    const Answer answer = run("optimise " + folder.design() + " --out " + out + " --no-report --json");
    INFO(answer.out);
    REQUIRE(answer.code == 0);
    const Json json = answer.json();
    CHECK(json.at("status") == "optimal");
    const Json& choices = json.at("choices");
    CHECK(choices.at("best") == Json{{"material", "PLA"}, {"teeth", 13}});
    CHECK(json.at("parameters").at("width").get<double>() == Approx(100.0 / 13).epsilon(1e-4));
    CHECK(choices.at("combinations") == 10);
    CHECK(choices.at("allowed") == 8);
    CHECK(choices.at("are_all_tried") == true);
    REQUIRE(choices.at("tried").size() == 8);
    double before = 0;
    bool is_feasible = true;
    for (const Json& row : choices["tried"]) {  // best first
        CHECK(row.at("options").at("teeth") != 14);
        const bool meets = row.at("constraint_violation") == 0;
        CHECK((is_feasible || !meets));
        if (meets) CHECK(row.at("objective").get<double>() >= before);
        if (meets) before = row["objective"].get<double>();
        CHECK(meets == (row["options"]["teeth"].get<int>() >= 13));  // 8 mm by 12 teeth is not enough
        is_feasible = meets;
    }
    CHECK(json.at("limited_by") == Json::array({"enough of it"}));
    CHECK(choices["tried"][0].at("objective") == json.at("objective"));
    // What is left is a design with these options, which any command takes.
    const Answer checked = run("check " + out + "/design.final.json --json");
    CHECK(checked.code == 0);
    const Json final = Json::parse(contents(std::filesystem::path(out) / "design.final.json"));
    CHECK(final.at("choices").at("teeth").at("value") == 13);
    // The same again, from what is there, on one thread: the same answer.
    const Answer again = run("optimise " + folder.design() + " --out " + out + " --no-report --resume --threads 1 --json");
    CHECK(again.code == 0);
    for (const char* key : {"status", "objective", "parameters", "choices"}) CHECK(again.json().at(key) == json.at(key));
}

TEST_CASE("optimise keeps to the options that the design has where it is told to, and to a number of combinations") {
    const ChoiceFolder folder;
    const Answer kept = run("optimise " + folder.design() + " --out " + folder.file("kept") + " --keep-choices --no-report --json");
    CHECK(kept.code == 0);
    CHECK_FALSE(kept.json().contains("choices"));
    CHECK(kept.json().at("parameters").at("width").get<double>() == Approx(100.0 / 15).epsilon(1e-4));
    const Answer few =
        run("optimise " + folder.design() + " --out " + folder.file("few") + " --combinations 3 --no-report --no-resolution");
    CHECK(few.code == 0);
    CHECK(few.says("best of the 3 combinations tried, "));
    CHECK(few.says("; not all its neighbours were tried (--combinations)"));
}

TEST_CASE("validate lists the choices of a design, and how many combinations its relations allow") {
    const ChoiceFolder folder;
    const Answer text = run("validate " + folder.design());
    CHECK(text.code == 0);
    CHECK(text.says("choices: material PLA (PLA, POM), teeth 15 (11 to 20); the relations allow 18 of 20 combinations"));
    const Json json = run("validate " + folder.design() + " --json").json();
    CHECK(json.at("choices").at("teeth").at("value") == "15");
    CHECK(json.at("combinations") == 20);
    CHECK(json.at("allowed_combinations") == 18);
}

TEST_CASE("optimise says which relation leaves no combination") {
    const ChoiceFolder folder(fettle::tests::support::replaced(choice_design, "\"lower\": 0.01", "\"lower\": 1000"));
    const Answer answer = run("optimise " + folder.design() + " --out " + folder.file("out"), true);
    CHECK(answer.code == 3);
    CHECK(answer.says("none of the 20 combinations meets \"not 14\""));
}

}  // namespace fettle::design::cli::optimise_choices_test
