// SPDX-License-Identifier: MIT
#include "design/problem/doubtful_extremes.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "core/base/text.hpp"
#include "design/description/requirement_text.hpp"
#include "design/quantities/step_series.hpp"

namespace fettle::design::problem {

namespace {

using description::Quantity;
using description::QuantityFacts;
using description::Simulated;
using quantities::Over;
using quantities::StepSeries;

constexpr double clearly = 1.01;        // by so much larger is the other sign's
constexpr double clearly_more = 0.002;  // such a share of an extreme hidden between steps is told

/// A series as it is asked for, in one scenario.
struct Asked {
    const StepSeries* series;
    const Simulated* simulated;
    bool in_expression;
    bool both_extremes;  // the expression takes the other one, too
};

class Search {
public:
    Search(const description::Design& design, const DesignEvaluation& evaluation)
        : design_(design), evaluation_(evaluation), simulated_(design, evaluation) {}

    std::vector<std::string> run() {
        for (std::size_t k = 0; k < design_.objective.size(); ++k) {
            const description::ObjectiveTerm& term = design_.objective[k];
            look_at(*term.quantity, evaluation_.terms[k], "objective `" + term.name + "`", term.unit);
        }
        for (std::size_t i = 0; i < design_.constraints.size(); ++i) {
            const description::Constraint& constraint = design_.constraints[i];
            const StepSeries* series = quantities::series_of(*constraint.quantity);
            const bool is_to_be_negative = series != nullptr && series->over() == Over::largest && constraint.bounds.upper < 0;
            look_at(*constraint.quantity, evaluation_.constraints[i], "constraint `" + constraint.name + "`", constraint.bounds.unit,
                    is_to_be_negative);
        }
        return std::move(sentences_);
    }

private:
    void look_at(const Quantity& quantity, const description::Measurement& measured, const std::string& name, double unit,
                 bool is_sign_meant = false) {
        const Simulated& simulated = simulated_.in(0);
        if (const std::string doubt = quantity.doubt(simulated, measured); !doubt.empty()) sentences_.push_back(name + ": " + doubt);
        std::vector<Asked> asked;
        collect(quantity, simulated, false, asked);
        for (const Asked& one : asked) {
            if (told_.count(one.series) > 0) continue;
            const bool may_be_other_sign = one.series->over() != Over::peak && one.series->has_direction() && !one.both_extremes;
            std::string sentence;
            if (may_be_other_sign && !is_sign_meant) sentence = on_the_sign(one, one.in_expression ? 1 : unit);
            if (sentence.empty()) sentence = on_the_steps(one, one.in_expression ? 1 : unit);
            if (sentence.empty()) continue;
            told_.insert(one.series);
            sentences_.push_back(name + ": " + sentence);
        }
    }

    void collect(const Quantity& quantity, const Simulated& in, bool in_expression, std::vector<Asked>& out) const {
        if (const StepSeries* series = quantities::series_of(quantity)) {
            if (quantities::is_extreme(series->over())) out.push_back({series, &in, in_expression, false});
            return;
        }
        const QuantityFacts facts = quantity.facts();
        const bool is_formula = facts.kind == QuantityFacts::Kind::formula;
        const Simulated& there = facts.kind == QuantityFacts::Kind::in_scenario ? in.in(facts.scenario) : in;
        std::vector<Asked> own;
        for (const description::NamedQuantity& part : facts.parts) collect(*part.quantity, there, in_expression || is_formula, own);
        for (Asked& a : own)
            if (is_formula) a.both_extremes = std::any_of(own.begin(), own.end(), [&](const Asked& b) { return is_opposite(a, b); });
        out.insert(out.end(), own.begin(), own.end());
    }

    // The same numbers, of which the other extreme is taken.
    static bool is_opposite(const Asked& a, const Asked& b) {
        return a.series->over() != b.series->over() && a.series->window(*a.simulated).numbers == b.series->window(*b.simulated).numbers;
    }

    // The largest has another sign than what is larger.
    static std::string on_the_sign(const Asked& asked, double unit) {
        const auto [numbers, first] = asked.series->window(*asked.simulated);
        const auto [least, largest] = std::minmax_element(numbers.begin(), numbers.end());
        const bool is_largest = asked.series->over() == Over::largest;
        const double extreme = is_largest ? *largest : *least, other = is_largest ? *least : *largest;
        const bool is_told = is_largest ? extreme < 0 || -other > clearly * extreme : extreme < 0 && other > -clearly * extreme;
        if (!is_told) return {};
        const auto amount = [&](double value) { return amount_text(asked, value, unit); };
        const std::string what = "\"over\": \"peak\" takes the largest absolute value";
        if (is_largest && extreme < 0)
            return "all steps are negative, and the largest, " + amount(extreme) + ", is the one with the least absolute value: " + what;
        const int instant = static_cast<int>((is_largest ? least : largest) - numbers.begin()) + first;
        return std::string(is_largest ? "the largest" : "the least") + " of the steps is " + amount(extreme) + ", but " +
               quantities::instant_words(instant) + " has " + amount(other) + ", a larger absolute value: " + what;
    }

    // One step stands above the others, and the true extreme may lie between.
    static std::string on_the_steps(const Asked& asked, double unit) {
        const StepSeries::Window window = asked.series->window(*asked.simulated);
        const quantities::Extreme extreme = quantities::extreme_of(asked.series->over(), window.numbers).extreme;
        if (!(extreme.doubt > clearly_more * std::abs(extreme.value))) return {};
        const int at = extreme.first + 2, step = window.first + at;
        const auto amount = [&](int k) { return amount_text(asked, window.numbers[k], unit); };
        const char* word = asked.series->over() == Over::least ? "the least, " : "the largest, ";
        return word + amount(at) + ", falls on step " + std::to_string(step) + " alone, at " +
               core::base::formatted("%.6g s", step * asked.simulated->trajectory.timestep) + " (the steps before and after it have " +
               amount(at - 1) + " and " + amount(at + 1) + "): between steps it may be beyond that by " +
               amount_text(asked, extreme.doubt, unit) +
               ", and values jump from design to design. Smaller steps, or a slower motion there, show it";
    }

    static std::string amount_text(const Asked& asked, double value, double unit) {
        return description::amount_text(value, unit, core::base::unit_name(asked.series->dimension(), unit), 4);
    }

    const description::Design& design_;
    const DesignEvaluation& evaluation_;
    const SimulatedDesign simulated_;
    std::set<const StepSeries*> told_;
    std::vector<std::string> sentences_;
};

}  // namespace

std::vector<std::string> doubtful_extremes(const description::Design& design, const DesignEvaluation& evaluation) {
    if (!evaluation.usable || evaluation.runs.empty()) return {};
    return Search(design, evaluation).run();
}

}  // namespace fettle::design::problem
