// SPDX-License-Identifier: MIT
#include "design/reading/named_formula.hpp"

#include <algorithm>
#include <optional>

#include "core/expression/parse_formula.hpp"
#include "design/quantities/expression.hpp"

namespace fettle::design::reading {

namespace {

using core::expression::Formula;
using core::files::JsonNode;

// What a formula may name. Nothing: a name means two things; the fault is the node's.
std::optional<core::expression::Scope> scope_of_named(const JsonNode& node, const std::string& text, const ReadContext& context,
                                                      bool is_over_steps) {
    core::expression::Scope scope = context.formulas.scope();
    scope.what = "quantity, parameter or variable";
    const auto names = is_over_steps ? quantities::step_names_of(context.quantities) : quantities::names_of(context.quantities);
    const std::vector<std::string> used = core::expression::names_in(text);
    for (const core::expression::Scope::Name& name : names) {
        if (is_over_steps && scope.find(name.name) != nullptr) {  // the step's `time`; a quantity has no name of a parameter's
            if (std::find(used.begin(), used.end(), name.name) == used.end()) continue;
            node.fail(ErrorCode::inconsistent, "a parameter or variable is called `" + name.name +
                                                   "`, which in an expression over the steps is the step's; rename it");
            return std::nullopt;
        }
        scope.names.push_back(name);
    }
    return scope;
}

std::optional<Formula> parse_named(const JsonNode& node, const ReadContext& context, bool is_over_steps) {
    const auto text = node.string();
    if (!text) return std::nullopt;
    const auto scope = scope_of_named(node, *text, context, is_over_steps);
    if (!scope) return std::nullopt;
    Result<Formula> formula = core::expression::parse_formula(*text, *scope);
    for (const Error& error : formula.errors()) node.fail(error.code, error.message);
    if (!formula) return std::nullopt;
    if (const std::string refused = context.formulas.refusal(*text); !refused.empty()) {
        node.fail(ErrorCode::inconsistent, refused);
        return std::nullopt;
    }
    if (formula->is_constant()) {
        node.fail(ErrorCode::inconsistent, "this names no quantity and no parameter, so no design could change it");
        return std::nullopt;
    }
    return std::move(formula).value();
}

template <class Made>
auto told(const JsonNode& node, const Result<Made>& made) {
    for (const Error& error : made.errors()) node.fail(error.code, error.message);
    return made ? *made : Made();
}

}  // namespace

std::shared_ptr<const description::Quantity> read_formula(const JsonNode& text, const ReadContext& context) {
    auto formula = parse_named(text, context, false);
    return formula ? told(text, quantities::Expression::create(std::move(*formula), context.quantities)) : nullptr;
}

std::shared_ptr<const quantities::StepSeries> read_step_formula(const JsonNode& text, const ReadContext& context,
                                                                const std::function<quantities::Reduction(Dimension)>& reduction_of) {
    auto formula = parse_named(text, context, true);
    if (!formula) return nullptr;
    const auto dimension = named_dimension(formula->dimension);  // without one it is refused
    const quantities::Reduction reduction = reduction_of(dimension.value_or(Dimension::number));
    return told(text, quantities::StepExpression::create(std::move(*formula), context.quantities, reduction));
}

}  // namespace fettle::design::reading
