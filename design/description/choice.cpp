// SPDX-License-Identifier: MIT
#include "design/description/choice.hpp"

#include <algorithm>
#include <limits>
#include <optional>

namespace fettle::design::description {

double value_of(const ChoiceCondition& condition, const std::vector<Choice>& choices, const Combination& combination) {
    using core::expression::Formula;
    std::map<std::string, Formula> numbers;
    core::expression::Scope scope = condition.formula.scope;
    const auto number_of = [&](const core::expression::Scope::Name& name) -> std::optional<Formula> {
        for (std::size_t k = 0; k < choices.size(); ++k)
            if (const auto found = choices[k].variables.find(name.name); found != choices[k].variables.end())
                return core::expression::constant_formula(found->second[static_cast<std::size_t>(combination[k])], name.dimension);
        return std::nullopt;
    };
    for (core::expression::Scope::Name& name : scope.names) {
        if (name.meaning) continue;
        name.meaning = number_of(name);
        if (name.meaning) numbers[name.name] = *name.meaning;
    }
    for (core::expression::Scope::Name& name : scope.names)
        if (name.meaning) name.meaning = core::expression::substituted(*name.meaning, numbers);
    const Result<Formula> formula = core::expression::parse_formula(condition.formula.text, scope);
    return formula && formula->is_constant() ? core::expression::value_of<double>(*formula, {}) : std::numeric_limits<double>::quiet_NaN();
}

bool is_allowed(const std::vector<ChoiceCondition>& conditions, const std::vector<Choice>& choices, const Combination& combination) {
    return std::all_of(conditions.begin(), conditions.end(), [&](const ChoiceCondition& condition) {
        const double value = value_of(condition, choices, combination);
        return value >= condition.bounds.lower && value <= condition.bounds.upper;
    });
}

Combination combination_of(const std::vector<Choice>& choices) {
    Combination out;
    for (const Choice& choice : choices) out.push_back(choice.value);
    return out;
}

std::string text_of(const std::vector<Choice>& choices, const Combination& combination) {
    std::string text;
    for (std::size_t k = 0; k < choices.size(); ++k)
        text += (k == 0 ? "" : ", ") + choices[k].name + " " + choices[k].options[static_cast<std::size_t>(combination[k])];
    return text;
}

long long combination_count(const std::vector<Choice>& choices) {
    constexpr long long most = 1LL << 62;
    long long count = 1;
    for (const Choice& choice : choices) {
        const auto options = static_cast<long long>(choice.options.size());
        if (options > 0 && count > most / options) return most;
        count *= options;
    }
    return count;
}

}  // namespace fettle::design::description
