// SPDX-License-Identifier: MIT
#include "design/quantities/step_expression.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/contract.hpp"
#include "design/quantities/own_formula.hpp"

namespace fettle::design::quantities {

using core::expression::Formula;
using core::expression::powers_of;
using description::Quantity;
using description::Seeds;
using description::Simulated;

namespace {

// Null: the quantity stands for its number.
const StepSeries* stepwise(const Quantity& quantity) {
    const StepSeries* series = series_of(quantity);
    return series != nullptr && series->reduction().is_plain() ? series : nullptr;
}

}  // namespace

std::shared_ptr<const Quantity> over_steps(const std::shared_ptr<const Quantity>& quantity) {
    const description::QuantityFacts facts = quantity->facts();
    if (facts.kind != description::QuantityFacts::Kind::formula) return quantity;
    const auto made = StepExpression::create(*facts.formula, facts.parts, Over::end);
    return made ? *made : quantity;
}

std::vector<core::expression::Scope::Name> step_names_of(const std::vector<NamedQuantity>& parts) {
    std::vector<core::expression::Scope::Name> names;
    bool has_time = false;
    for (const NamedQuantity& part : parts) {
        const auto quantity = over_steps(part.quantity);
        const StepSeries* series = stepwise(*quantity);
        names.push_back({part.name, powers_of(series != nullptr ? series->numbers_dimension() : part.quantity->dimension())});
        has_time = has_time || part.name == StepExpression::time;
    }
    if (!has_time) names.push_back({std::string(StepExpression::time), powers_of(Dimension::time)});
    return names;
}

Result<std::shared_ptr<const StepExpression>> StepExpression::create(Formula formula, const std::vector<NamedQuantity>& parts,
                                                                     const Reduction& reduction) {
    const auto dimension = named_dimension(formula.dimension);
    if (!dimension)
        return Error{ErrorCode::wrong_type, "",
                     "the expression is " + described(formula.dimension) +
                         ", for which there is no unit: divide what it names by amounts, such as `torque * speed / 1 rad`"};
    std::vector<NamedQuantity> used;
    for (const NamedQuantity& part : parts) {
        if (std::find(formula.inputs.begin(), formula.inputs.end(), part.name) == formula.inputs.end()) continue;
        const auto quantity = over_steps(part.quantity);
        if (!quantity->facts().is_number)
            return Error{ErrorCode::unsupported, "",
                         "`" + part.name +
                             "` cannot stand in an expression over the steps: these name what each instant has a number of, strokes and "
                             "masses, without a `scenario` of their own"};
        used.push_back({part.name, quantity});
    }
    return std::shared_ptr<const StepExpression>(new StepExpression(std::move(formula), std::move(used), *dimension, reduction));
}

Result<std::shared_ptr<const StepExpression>> StepExpression::parse(std::string_view text, const std::vector<NamedQuantity>& parts,
                                                                    const Reduction& reduction,
                                                                    const std::vector<description::Parameter>& parameters) {
    Result<Formula> formula = formula_of_quantities(text, step_names_of(parts), parameters);
    if (!formula) return formula.errors();
    return create(std::move(formula).value(), parts, reduction);
}

StepExpression::StepExpression(Formula formula, std::vector<NamedQuantity> parts, Dimension dimension, const Reduction& reduction)
    : StepSeries(reduction), formula_(std::move(formula)), parts_(std::move(parts)), instant_dimension_(dimension) {}

int StepExpression::part_of(const std::string& input) const {
    const auto found = std::find_if(parts_.begin(), parts_.end(), [&](const NamedQuantity& part) { return part.name == input; });
    return found == parts_.end() ? -1 : static_cast<int>(found - parts_.begin());
}

description::QuantityFacts StepExpression::facts() const {
    description::QuantityFacts facts = StepSeries::facts();
    facts.kind = description::QuantityFacts::Kind::step_formula;
    facts.parts = parts_;
    facts.formula = &formula_;
    return facts;
}

bool StepExpression::has_start() const {
    return std::all_of(parts_.begin(), parts_.end(), [](const NamedQuantity& part) {
        const StepSeries* series = stepwise(*part.quantity);
        return series == nullptr || series->has_start();
    });
}

// [instant][input]
std::vector<std::vector<double>> StepExpression::inputs(const Simulated& simulated) const {
    const auto first = static_cast<std::size_t>(first_instant()), count = simulated.trajectory.poses.size() - first;
    std::vector<std::vector<double>> out(count, std::vector<double>(formula_.inputs.size()));
    for (std::size_t k = 0; k < formula_.inputs.size(); ++k) {
        const std::string& input = formula_.inputs[k];
        std::vector<double> numbers;
        if (const int part = part_of(input); part >= 0) {
            const Quantity& quantity = *parts_[part].quantity;
            const StepSeries* series = stepwise(quantity);
            numbers = series != nullptr ? series->numbers(simulated) : std::vector<double>(count, quantity.value(simulated).value);
        } else if (input == time) {
            for (std::size_t t = first; t < first + count; ++t) numbers.push_back(time_at(simulated.trajectory, static_cast<int>(t)));
        } else {
            const auto found = std::find(simulated.names.begin(), simulated.names.end(), input);
            FETTLE_ASSERT(found != simulated.names.end(), "what an expression names is a quantity or a parameter of the design");
            numbers.assign(count, simulated.parameters[found - simulated.names.begin()]);
        }
        const std::size_t earlier = numbers.size() - count;  // a start that others do not have
        for (std::size_t t = 0; t < count; ++t) out[t][k] = numbers[t + earlier];
    }
    return out;
}

std::vector<double> StepExpression::series(const Simulated& simulated) const {
    std::vector<double> out;
    for (const std::vector<double>& at : inputs(simulated)) out.push_back(core::expression::value_of<double>(formula_, at));
    return out;
}

void StepExpression::add_series_seeds(const Simulated& simulated, const std::vector<double>& weights, Seeds& seeds) const {
    const std::vector<std::vector<double>> at = inputs(simulated);
    std::vector<std::vector<double>> slopes(formula_.inputs.size(), std::vector<double>(at.size(), 0.0));  // [input][instant]
    for (std::size_t t = 0; t < at.size(); ++t) {
        if (weights[t] == 0) continue;
        const VectorX gradient = core::expression::differentiated(formula_, at[t]).gradient;
        for (std::size_t k = 0; k < slopes.size(); ++k) {
            if (gradient[k] == 0) continue;  // the side of min, max or if that is not taken may have no derivative
            slopes[k][t] = weights[t] * gradient[k];
            if (std::isfinite(slopes[k][t])) continue;
            seeds.refusal = "the derivative of the expression" + (formula_.text.empty() ? "" : " `" + formula_.text + "`") + " by `" +
                            formula_.inputs[k] + "` is not a finite number at " + instant_words(static_cast<int>(t) + first_instant());
            return;
        }
    }
    for (std::size_t k = 0; k < slopes.size(); ++k) {
        const std::string& input = formula_.inputs[k];
        const int part = part_of(input);
        if (part < 0 && input == time) continue;
        const StepSeries* series = part < 0 ? nullptr : stepwise(*parts_[part].quantity);
        if (series != nullptr) {
            if (first_instant() > series->first_instant()) slopes[k].insert(slopes[k].begin(), 0.0);
            series->add_number_seeds(simulated, slopes[k], seeds);
            continue;
        }
        double sum = 0;
        for (const double slope : slopes[k]) sum += slope;
        if (sum == 0) continue;
        if (part < 0)
            add_parameter_seed(input, simulated, sum, seeds);
        else
            parts_[part].quantity->add_seeds(simulated, parts_[part].quantity->value(simulated), sum, seeds);
    }
}

std::vector<std::string> StepExpression::parameters() const {
    std::vector<std::string> out;
    for (const std::string& input : formula_.inputs)
        if (part_of(input) < 0 && input != time) out.push_back(input);
    for (const NamedQuantity& part : parts_) {
        const std::vector<std::string> own = part.quantity->parameters();
        out.insert(out.end(), own.begin(), own.end());
    }
    return out;
}

Errors StepExpression::check(const core::model::Model& model, int steps) const {
    Errors errors = StepSeries::check(model, steps);
    for (const NamedQuantity& part : parts_)
        for (Error error : part.quantity->check(model, steps)) {
            error.message = "quantity `" + part.name + "`: " + error.message;
            errors.push_back(std::move(error));
        }
    return errors;
}

}  // namespace fettle::design::quantities
