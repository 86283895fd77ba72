// SPDX-License-Identifier: MIT
#include "design/quantities/expression.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/contract.hpp"
#include "core/base/text.hpp"
#include "core/geometry/range.hpp"
#include "design/quantities/own_formula.hpp"

namespace fettle::design::quantities {

using core::expression::Formula;
using description::Measurement;
using description::Seeds;
using description::Simulated;

std::vector<core::expression::Scope::Name> names_of(const std::vector<NamedQuantity>& parts) {
    std::vector<core::expression::Scope::Name> names;
    for (const NamedQuantity& part : parts) names.push_back({part.name, core::expression::powers_of(part.quantity->dimension())});
    return names;
}

Result<std::shared_ptr<const Expression>> Expression::create(Formula formula, const std::vector<NamedQuantity>& parts) {
    const auto dimension = named_dimension(formula.dimension);
    if (!dimension)
        return Error{ErrorCode::wrong_type, "",
                     "the expression is " + described(formula.dimension) +
                         ", for which there is no unit: divide what it names by amounts, such as `mass / 1 g * stroke / 1 mm`"};
    std::vector<NamedQuantity> used;
    for (const NamedQuantity& part : parts)
        if (std::find(formula.inputs.begin(), formula.inputs.end(), part.name) != formula.inputs.end()) used.push_back(part);
    return std::shared_ptr<const Expression>(new Expression(std::move(formula), std::move(used), *dimension));
}

Result<Formula> formula_of_quantities(std::string_view text, std::vector<core::expression::Scope::Name> names,
                                      const std::vector<description::Parameter>& parameters) {
    core::expression::Scope scope = description::scope_of(parameters);
    scope.what = "quantity or parameter";
    for (core::expression::Scope::Name& name : names) {
        std::erase_if(scope.names, [&](const auto& other) { return other.name == name.name; });
        scope.names.push_back(std::move(name));
    }
    return core::expression::parse_formula(text, scope);
}

Result<std::shared_ptr<const Expression>> Expression::parse(std::string_view text, const std::vector<NamedQuantity>& parts,
                                                            const std::vector<description::Parameter>& parameters) {
    Result<Formula> formula = formula_of_quantities(text, names_of(parts), parameters);
    if (!formula) return formula.errors();
    return create(std::move(formula).value(), parts);
}

Expression::Expression(Formula formula, std::vector<NamedQuantity> parts, Dimension dimension)
    : formula_(std::move(formula)), parts_(std::move(parts)), dimension_(dimension) {}

int Expression::part_of(const std::string& input) const {
    const auto found = std::find_if(parts_.begin(), parts_.end(), [&](const NamedQuantity& part) { return part.name == input; });
    return found == parts_.end() ? -1 : static_cast<int>(found - parts_.begin());
}

template <class T, class PartValue>
std::vector<T> Expression::inputs(const Simulated& simulated, PartValue part_value) const {
    std::vector<T> out;
    for (const std::string& input : formula_.inputs) {
        const int part = part_of(input);
        if (part >= 0) {
            out.push_back(part_value(part));
            continue;
        }
        const auto found = std::find(simulated.names.begin(), simulated.names.end(), input);
        FETTLE_ASSERT(found != simulated.names.end(), "what an expression names is a quantity or a parameter of the design");
        out.push_back(T(simulated.parameters[found - simulated.names.begin()]));
    }
    return out;
}

description::QuantityFacts Expression::facts() const {
    return {.kind = description::QuantityFacts::Kind::formula, .parts = parts_, .formula = &formula_};
}

Measurement Expression::value(const Simulated& simulated) const {
    Measurement out;
    bool single = true;  // a number each, and no bounds
    bool is_number = true;
    for (const NamedQuantity& part : parts_) {
        Measurement measured = part.quantity->value(simulated);
        is_number = is_number && !std::isnan(measured.value);
        single = single && !measured.is_proven && measured.lower == measured.value && measured.upper == measured.value;
        if (out.fault.empty()) out.fault = measured.fault;
        out.parts.push_back(std::move(measured));
    }
    const auto at = [&](int part) -> const Measurement& { return out.parts[part]; };
    const std::vector<double> values = inputs<double>(simulated, [&](int part) { return at(part).value; });
    out.value = out.lower = out.upper = core::expression::value_of<double>(formula_, values);
    if (!is_number) out.value = out.lower = out.upper = std::numeric_limits<double>::quiet_NaN();  // nor is a formula of `if` one
    if (single || !is_number) return out;
    const auto bounds =
        inputs<core::geometry::Range>(simulated, [&](int part) { return core::geometry::Range(at(part).lower, at(part).upper); });
    const core::geometry::Range found = core::expression::value_of<core::geometry::Range>(formula_, bounds);
    out.lower = std::min(found.low, out.value);
    out.upper = std::max(found.high, out.value);
    out.is_proven = std::all_of(out.parts.begin(), out.parts.end(), [](const Measurement& part) { return part.is_proven; });
    return out;
}

void Expression::add_seeds(const Simulated& simulated, const Measurement& measured, double scale, Seeds& seeds) const {
    const std::vector<double> values = inputs<double>(simulated, [&](int part) { return measured.parts[part].value; });
    const VectorX gradient = core::expression::differentiated(formula_, values).gradient;
    // What follows from parameters directly counts once: in the first of the scenarios that it is about.
    bool is_first = true;
    for (int s = 0; s < simulated.scenario; ++s) is_first = is_first && !is_about(s);
    for (size_t k = 0; k < formula_.inputs.size(); ++k) {
        const double slope = scale * gradient[k];
        const int part = part_of(formula_.inputs[k]);
        if (slope == 0) continue;  // the side of min, max or if that is not taken may have no derivative
        if (!std::isfinite(slope)) {
            seeds.refusal = "the derivative of the expression" + (formula_.text.empty() ? "" : " `" + formula_.text + "`") + " by `" +
                            formula_.inputs[k] + "` is not a finite number here";
            return;
        }
        if (part < 0 && !is_first) continue;
        if (part < 0)
            add_parameter_seed(formula_.inputs[k], simulated, slope, seeds);
        else
            parts_[part].quantity->add_seeds(simulated, measured.parts[part], slope, seeds);
    }
}

bool Expression::is_at_rest() const {
    return std::all_of(parts_.begin(), parts_.end(), [](const NamedQuantity& part) { return part.quantity->is_at_rest(); });
}

bool Expression::is_about(int scenario) const {
    if (parts_.empty()) return scenario == 0;
    return std::any_of(parts_.begin(), parts_.end(), [&](const NamedQuantity& part) { return part.quantity->is_about(scenario); });
}

std::vector<std::string> Expression::parameters() const {
    std::vector<std::string> out;
    for (const std::string& input : formula_.inputs)
        if (part_of(input) < 0) out.push_back(input);
    for (const NamedQuantity& part : parts_) {
        const std::vector<std::string> own = part.quantity->parameters();
        out.insert(out.end(), own.begin(), own.end());
    }
    return out;
}

std::string Expression::doubt(const Simulated& simulated, const Measurement& measured) const {
    for (size_t k = 0; k < parts_.size(); ++k)
        if (std::string found = parts_[k].quantity->doubt(simulated, measured.parts[k]); !found.empty()) return found;
    return {};
}

std::string Expression::explanation(const Measurement& measured) const {
    std::vector<std::string> words;
    for (size_t k = 0; k < parts_.size(); ++k) {
        const Dimension dimension = parts_[k].quantity->dimension();
        const std::string unit = dimension == Dimension::number ? "" : " " + std::string(core::base::si_unit(dimension));
        words.push_back(parts_[k].name + core::base::formatted(" = %.6g", measured.parts[k].value) + unit);
    }
    return core::base::joined(words);
}

Errors Expression::check(const core::model::Model& model, int steps) const {
    Errors errors;
    for (const NamedQuantity& part : parts_)
        for (Error error : part.quantity->check(model, steps)) {
            error.message = "quantity `" + part.name + "`: " + error.message;
            errors.push_back(std::move(error));
        }
    return errors;
}

}  // namespace fettle::design::quantities
