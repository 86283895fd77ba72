// SPDX-License-Identifier: MIT
#include "design/studies/choice_search.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>

#include "core/base/contract.hpp"

namespace fettle::design::studies {

namespace {

using description::Choice;
using description::ChoiceCondition;
using description::Combination;

constexpr std::size_t fewest_neighbours = 4;

// The next one in the order of a counter, the last choice first; false: it was the last.
bool advance(Combination& combination, const std::vector<Choice>& choices) {
    for (std::size_t k = choices.size(); k-- > 0;) {
        if (++combination[k] < static_cast<int>(choices[k].options.size())) return true;
        combination[k] = 0;
    }
    return false;
}

}  // namespace

bool is_better(const ChoiceOutcome& x, const ChoiceOutcome& y) {
    const auto is_number = [](const ChoiceOutcome& one) { return one.usable && one.violation >= 0 && !std::isnan(one.objective); };
    if (is_number(x) != is_number(y)) return is_number(x);
    if (!is_number(x)) return false;
    if (x.violation != y.violation) return x.violation < y.violation;
    return x.objective < y.objective;
}

Result<ChoiceSearch> ChoiceSearch::create(std::vector<Choice> choices, std::vector<ChoiceCondition> conditions, int most) {
    FETTLE_ASSERT(most >= 1 && !choices.empty(), "choices to search");
    const long long count = description::combination_count(choices);
    if (count > most_listed)
        return Error{ErrorCode::out_of_range, "choices",
                     "there are more than " + std::to_string(most_listed) +
                         " combinations: narrow the choices, or fix some of them (a list with one option)"};
    std::vector<Combination> allowed;
    Combination each(choices.size(), 0);
    do {
        if (description::is_allowed(conditions, choices, each)) allowed.push_back(each);
    } while (advance(each, choices));
    if (!allowed.empty()) return ChoiceSearch(std::move(choices), std::move(allowed), most);
    std::string names;
    for (const ChoiceCondition& condition : conditions) names += (names.empty() ? "\"" : ", \"") + condition.name + "\"";
    return Error{ErrorCode::inconsistent, "choices", "none of the " + std::to_string(count) + " combinations meets " + names};
}

ChoiceSearch::ChoiceSearch(std::vector<Choice> choices, std::vector<Combination> allowed, int most)
    : choices_(std::move(choices)), allowed_(std::move(allowed)), is_asked_(allowed_.size(), false), most_(most) {}

// Steps of numbers in their list; any other option of a list without order is one step away.
int ChoiceSearch::distance(const Combination& a, const Combination& b) const {
    int sum = 0;
    for (std::size_t k = 0; k < choices_.size(); ++k) sum += choices_[k].is_ordered ? std::abs(a[k] - b[k]) : (a[k] != b[k] ? 1 : 0);
    return sum;
}

bool ChoiceSearch::is_step(const Combination& a, const Combination& b) const {
    int changed = 0;
    for (std::size_t k = 0; k < choices_.size(); ++k) {
        if (choices_[k].is_ordered && std::abs(a[k] - b[k]) > 1) return false;
        changed += a[k] != b[k] ? 1 : 0;
    }
    return changed == 1 || changed == 2;
}

std::vector<std::size_t> ChoiceSearch::neighbours(const Combination& of) const {
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < allowed_.size(); ++i)
        if (is_step(of, allowed_[i])) found.push_back(i);
    if (found.size() >= fewest_neighbours) return found;
    std::vector<std::size_t> nearest;
    for (std::size_t i = 0; i < allowed_.size(); ++i)
        if (allowed_[i] != of) nearest.push_back(i);
    const auto is_nearer = [&](std::size_t i, std::size_t j) {
        const int x = distance(of, allowed_[i]), y = distance(of, allowed_[j]);
        return x != y ? x < y : i < j;
    };
    const std::size_t count = std::min(nearest.size(), fewest_neighbours);
    std::partial_sort(nearest.begin(), nearest.begin() + static_cast<std::ptrdiff_t>(count), nearest.end(), is_nearer);
    nearest.resize(count);
    found.insert(found.end(), nearest.begin(), nearest.end());
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found;
}

std::vector<Combination> ChoiceSearch::ask(const std::vector<std::size_t>& wanted) {
    for (const std::size_t i : wanted) {
        if (is_asked_[i] || tried_.size() + round_.size() >= static_cast<std::size_t>(most_)) continue;
        is_asked_[i] = true;
        round_.push_back(allowed_[i]);
    }
    return round_;
}

std::vector<Combination> ChoiceSearch::next() {
    FETTLE_ASSERT(round_.empty(), "what was asked for has been told");
    std::vector<std::size_t> all(allowed_.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    if (tried_.empty()) {
        const Combination own = description::combination_of(choices_);
        const auto is_nearer = [&](std::size_t i, std::size_t j) { return distance(own, allowed_[i]) < distance(own, allowed_[j]); };
        return ask({*std::min_element(all.begin(), all.end(), is_nearer)});
    }
    if (best_) {
        if (std::vector<Combination> round = ask(neighbours(tried_[*best_].first)); !round.empty()) return round;
        if (allowed_.size() > static_cast<std::size_t>(most_)) return {};
        return ask(all);
    }
    // Nothing can be evaluated yet: what is next to the last that was tried.
    if (std::vector<Combination> round = ask(neighbours(tried_.back().first)); !round.empty()) return round;
    return ask(all);
}

void ChoiceSearch::tell(const std::vector<ChoiceOutcome>& outcomes) {
    FETTLE_ASSERT(outcomes.size() == round_.size(), "an outcome for each combination that was asked for");
    for (std::size_t i = 0; i < outcomes.size(); ++i) {
        tried_.emplace_back(round_[i], outcomes[i]);
        const bool is_first = !best_ && is_better(outcomes[i], {});
        if (is_first || (best_ && is_better(outcomes[i], tried_[*best_].second))) best_ = tried_.size() - 1;
    }
    round_.clear();
}

bool ChoiceSearch::is_local_optimum() const {
    if (!best_) return false;
    const std::vector<std::size_t> near = neighbours(tried_[*best_].first);
    return std::all_of(near.begin(), near.end(), [&](std::size_t i) { return is_asked_[i]; });
}

}  // namespace fettle::design::studies
