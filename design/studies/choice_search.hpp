// SPDX-License-Identifier: MIT
/// The search over the choices of a design (description/choice.hpp), each combination of which somebody else tunes: it asks for rounds of
/// combinations, and is told their outcomes. All that it asks for follows from these alone, so that a search can be stopped, and done again
/// up to there.
///
///     ChoiceSearch search(file.choices, file.conditions, 64);
///     for (auto round = search.next(); !round.empty(); round = search.next()) {
///         std::vector<ChoiceOutcome> found;
///         for (const Combination& each : round) found.push_back(tune(each));   // in parallel; from the values of search.best()
///         search.tell(found);
///     }
///
/// Combinations that break a condition are never asked for. The first round is the design's own combination, or the nearest one that is
/// allowed. Each further round is what is left of the neighbours of the best so far: those that differ in one or two choices by one step
/// (of a list without order: by another option), and where a condition leaves fewer than four of these, the nearest that there are. When
/// the neighbours of the best are known and all that is allowed is few enough, the rest follows in one round.
#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/result.hpp"
#include "design/description/choice.hpp"

namespace fettle::design::studies {

/// What the tuning of a combination gave.
struct ChoiceOutcome {
    bool usable = false;   ///< could any design be evaluated?
    double violation = 0;  ///< largest of the requirements; 0: all are met
    double objective = 0;
};
/// Is x better than y: usable, then of less violation, then of less objective?
bool is_better(const ChoiceOutcome& x, const ChoiceOutcome& y);

class ChoiceSearch {
public:
    /// More combinations than these are not listed one by one.
    static constexpr long long most_listed = 200'000;

    /// Errors: more than most_listed combinations, none that meets the conditions (inconsistent).
    /// @param most  How many to ask for at most. Contract: at least 1.
    static Result<ChoiceSearch> create(std::vector<description::Choice> choices, std::vector<description::ChoiceCondition> conditions,
                                       int most);

    /// Empty: the search is over. Contract: what was asked for last has been told.
    std::vector<description::Combination> next();
    /// Contract: an outcome for each of next(), in its order.
    void tell(const std::vector<ChoiceOutcome>& outcomes);

    /// None: nothing was told, or nothing is usable.
    std::optional<std::size_t> best() const { return best_; }
    const std::vector<std::pair<description::Combination, ChoiceOutcome>>& tried() const { return tried_; }
    /// How many combinations meet the conditions, and how many there are.
    std::size_t allowed() const { return allowed_.size(); }
    long long combinations() const { return description::combination_count(choices_); }
    /// Have all neighbours of the best been tried? None of them is better then.
    bool is_local_optimum() const;

private:
    ChoiceSearch(std::vector<description::Choice> choices, std::vector<description::Combination> allowed, int most);
    int distance(const description::Combination& a, const description::Combination& b) const;
    bool is_step(const description::Combination& a, const description::Combination& b) const;
    std::vector<std::size_t> neighbours(const description::Combination& of) const;
    std::vector<description::Combination> ask(const std::vector<std::size_t>& wanted);

    std::vector<description::Choice> choices_;
    std::vector<description::Combination> allowed_;
    std::vector<bool> is_asked_;  ///< of allowed_
    std::vector<description::Combination> round_;
    std::vector<std::pair<description::Combination, ChoiceOutcome>> tried_;
    std::optional<std::size_t> best_;
    int most_ = 0;
};

}  // namespace fettle::design::studies
