// SPDX-License-Identifier: MIT
/// Choices of a design: what is one of a list, and cannot be moved little by little. How many teeth, which part, which material. A search
/// goes from one combination to another, and tunes the parameters of each: studies/choice_search.hpp.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/expression/parse_formula.hpp"
#include "design/description/constraint.hpp"

namespace fettle::design::description {

struct Choice {
    std::string name;
    std::vector<std::string> options;  ///< as people write them: "12", "PLA"
    int value = 0;                     ///< the option that the design has
    bool is_ordered = false;           ///< numbers, which grow: one has two neighbours; else all others are
    /// What the scene's variables are under each option, SI; those alone that are numbers under all of them.
    std::map<std::string, std::vector<double>> variables = {};
};

/// An option for each choice, by their numbers.
using Combination = std::vector<int>;

/// What choices make of a formula. It is read anew for each combination, with numbers for names: that is how `floor` may be of a choice.
struct ChoiceFormula {
    std::string text;
    core::expression::Scope scope;  ///< the names in it: variables of choices, and what follows from them alone
};

/// A relation that follows from choices alone: a combination meets it or does not, whatever the parameters are.
struct ChoiceCondition {
    std::string name;
    Bounds bounds;
    ChoiceFormula formula;
};

/// The value of a condition; NaN where it is none.
double value_of(const ChoiceCondition& condition, const std::vector<Choice>& choices, const Combination& combination);

/// Does it meet all of them? A value that is not a number meets none.
bool is_allowed(const std::vector<ChoiceCondition>& conditions, const std::vector<Choice>& choices, const Combination& combination);

/// The options that the design has.
Combination combination_of(const std::vector<Choice>& choices);
/// "slots 6, material PLA"
std::string text_of(const std::vector<Choice>& choices, const Combination& combination);
/// How many combinations there are; infinity-free: at most 2^62 are counted.
long long combination_count(const std::vector<Choice>& choices);

}  // namespace fettle::design::description
