// SPDX-License-Identifier: MIT
// The search over choices against trying every combination.
#include "design/studies/choice_search.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <random>
#include <set>

#include "core/expression/parse_formula.hpp"

namespace fettle::design::studies::choice_search_test {

namespace {

using description::Choice;
using description::ChoiceCondition;
using description::Combination;

Choice numbers(const std::string& name, int from, int to, int value) {
    Choice choice;
    choice.name = name;
    choice.is_ordered = true;
    choice.value = value - from;
    for (int number = from; number <= to; ++number) {
        choice.options.push_back(std::to_string(number));
        choice.variables[name].push_back(number);
    }
    return choice;
}

Choice words(const std::string& name, const std::vector<std::string>& options) {
    Choice choice;
    choice.name = name;
    choice.options = options;
    return choice;
}

ChoiceCondition condition(const std::string& text, double lower, double upper, const std::vector<std::string>& names) {
    core::expression::Scope scope;
    for (const std::string& name : names) scope.names.push_back({name, core::expression::powers_of(Dimension::number)});
    return {text, {.lower = lower, .upper = upper}, {text, scope}};
}

using Tune = std::function<ChoiceOutcome(const Combination&)>;

ChoiceSearch searched(const std::vector<Choice>& choices, const std::vector<ChoiceCondition>& conditions, int most, const Tune& tune) {
    Result<ChoiceSearch> search = ChoiceSearch::create(choices, conditions, most);
    REQUIRE(search);
    std::set<Combination> asked;
    for (std::vector<Combination> round = search->next(); !round.empty(); round = search->next()) {
        std::vector<ChoiceOutcome> outcomes;
        for (const Combination& each : round) {
            CHECK(asked.insert(each).second);
            CHECK(is_allowed(conditions, choices, each));
            outcomes.push_back(tune(each));
        }
        search->tell(outcomes);
        CHECK(asked.size() <= static_cast<size_t>(most));
    }
    return std::move(search).value();
}

}  // namespace

TEST_CASE("choices: what is better is usable, then of less violation, then of less objective") {
    const ChoiceOutcome unusable, violating{true, 0.5, 1}, met{true, 0, 3}, best{true, 0, 2}, no_number{true, NAN, 1};
    CHECK(is_better(violating, unusable));
    CHECK(is_better(met, violating));
    CHECK(is_better(best, met));
    CHECK_FALSE(is_better(met, best));
    CHECK_FALSE(is_better(unusable, unusable));
    CHECK_FALSE(is_better(no_number, violating));
    CHECK(is_better(violating, no_number));
}

TEST_CASE("choices: few combinations are all tried, the design's own first") {
    const std::vector<Choice> choices{numbers("a", 3, 6, 5), words("material", {"PLA", "POM", "PA"})};
    const auto tune = [](const Combination& c) { return ChoiceOutcome{true, 0, std::abs(c[0] - 0.2) + 3 * (c[1] != 2)}; };
    const ChoiceSearch search = searched(choices, {}, 64, tune);
    CHECK(search.tried().size() == 12);
    CHECK(search.tried().front().first == Combination{2, 0});
    REQUIRE(search.best());
    CHECK(search.tried()[*search.best()].first == Combination{0, 2});
    CHECK(search.is_local_optimum());
    CHECK(search.combinations() == 12);
}

TEST_CASE("choices: a bowl of many combinations is followed to its lowest, with a small part of them") {
    std::mt19937 random(7);
    for (int round = 0; round < 40; ++round) {
        const int x = std::uniform_int_distribution<>(0, 59)(random), y = std::uniform_int_distribution<>(0, 59)(random);
        const std::vector<Choice> choices{numbers("a", 0, 59, 30), numbers("b", 0, 59, 30)};
        // A narrow valley along the diagonal: one of the two alone makes it worse.
        const auto tune = [&](const Combination& c) {
            const double u = c[0] - x, v = c[1] - y;
            return ChoiceOutcome{true, 0, (u - v) * (u - v) + 0.01 * (u + v) * (u + v)};
        };
        const ChoiceSearch search = searched(choices, {}, 1000, tune);
        REQUIRE(search.best());
        CHECK(search.tried()[*search.best()].first == Combination{x, y});
        CHECK(search.is_local_optimum());
        CHECK(search.tried().size() < 400);
    }
}

TEST_CASE("choices: a ratio leaves islands, which are all reached") {
    const std::vector<Choice> choices{numbers("pinion", 10, 24, 18), numbers("wheel", 30, 90, 60)};
    const std::vector<ChoiceCondition> conditions{condition("wheel / pinion", 3.68, 3.72, {"pinion", "wheel"})};
    std::set<std::pair<int, int>> expected;
    for (int pinion = 10; pinion <= 24; ++pinion)
        for (int wheel = 30; wheel <= 90; ++wheel)
            if (wheel / static_cast<double>(pinion) >= 3.68 && wheel / static_cast<double>(pinion) <= 3.72)
                expected.insert({pinion, wheel});
    const auto size = [](const Combination& c) { return ChoiceOutcome{true, 0, 10.0 + c[0] + 30 + c[1]}; };
    const ChoiceSearch search = searched(choices, conditions, 64, size);
    std::set<std::pair<int, int>> tried;
    for (const auto& [combination, outcome] : search.tried()) tried.insert({10 + combination[0], 30 + combination[1]});
    CHECK(tried == expected);
    CHECK(search.allowed() == expected.size());
    CHECK(search.combinations() == 15 * 61);
    CHECK(search.tried()[*search.best()].first == Combination{0, 7});  // 10 and 37
    const ChoiceSearch thirds =
        searched(choices, {condition("(wheel + pinion) / 3 - floor((wheel + pinion) / 3)", 0, 0, {"pinion", "wheel"})}, 10, size);
    CHECK(thirds.allowed() == 305);  // of 15 times 61
}

TEST_CASE("choices: a limit is kept, and what is left is said") {
    const std::vector<Choice> choices{numbers("a", 0, 99, 50)};
    const auto slope = [](const Combination& c) { return ChoiceOutcome{true, 0, static_cast<double>(c[0])}; };
    const ChoiceSearch search = searched(choices, {}, 5, slope);
    CHECK(search.tried().size() == 5);
    CHECK_FALSE(search.is_local_optimum());
    CHECK(searched(choices, {}, 60, slope).tried().size() <= 60);
}

TEST_CASE("choices: combinations that nobody can evaluate do not end the search") {
    const std::vector<Choice> choices{numbers("a", 0, 30, 0)};
    const auto tune = [](const Combination& c) { return c[0] < 20 ? ChoiceOutcome{} : ChoiceOutcome{true, 0, std::abs(c[0] - 25.0)}; };
    const ChoiceSearch search = searched(choices, {}, 64, tune);
    REQUIRE(search.best());
    CHECK(search.tried()[*search.best()].first == Combination{25});
    CHECK_FALSE(searched(choices, {}, 64, [](const Combination&) { return ChoiceOutcome{}; }).best());
}

TEST_CASE("choices: what cannot be searched is refused") {
    const std::vector<Choice> many{numbers("a", 0, 999, 0), numbers("b", 0, 999, 0), numbers("c", 0, 9, 0)};
    CHECK(ChoiceSearch::create(many, {}, 64).errors().front().code == ErrorCode::out_of_range);
    const std::vector<Choice> one{numbers("a", 0, 9, 0)};
    const Result<ChoiceSearch> none = ChoiceSearch::create(one, {condition("a", 20, 30, {"a"})}, 64);
    REQUIRE_FALSE(none);
    CHECK(none.errors().front().message.find("none of the 10 combinations meets \"a\"") == 0);
}

}  // namespace fettle::design::studies::choice_search_test
