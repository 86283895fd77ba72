// SPDX-License-Identifier: MIT
#include "design/reading/event_reader.hpp"

#include <algorithm>
#include <cmath>

#include "core/expression/parse_formula.hpp"
#include "design/quantities/event_time.hpp"
#include "design/quantities/expression.hpp"
#include "design/quantities/step_expression.hpp"
#include "design/quantities/time_share.hpp"
#include "design/quantities/value_at.hpp"
#include "design/quantities/worst.hpp"
#include "design/reading/named_formula.hpp"

namespace fettle::design::reading {

namespace {

using core::files::JsonNode;
using description::Quantity;
using quantities::StepSeries;

std::optional<quantities::NamedQuantity> find_named(const std::string& name, const ReadContext& context) {
    for (const quantities::NamedQuantity& each : context.quantities)
        if (each.name == name) return each;
    return std::nullopt;
}

// Nothing where there is no unit of its derivative.
std::shared_ptr<const StepSeries> with_unit(const JsonNode& node, std::shared_ptr<const StepSeries> series) {
    if (!series || dimension_of(series->reduction(), series->instant_dimension())) return series;
    node.fail(ErrorCode::wrong_type, "there is no unit for this derivative; divide by an amount, such as `force / 1 N`");
    return nullptr;
}

// At the steps as they are, or its derivative.
std::shared_ptr<const StepSeries> series_of_named(const JsonNode& node, const quantities::NamedQuantity& named, int derivative) {
    const auto series = quantities::series_of(quantities::over_steps(named.quantity));
    if (!series) {
        node.fail(ErrorCode::out_of_range, node.shown() + " is no quantity that each instant has a number of");
        return nullptr;
    }
    if (!series->reduction().is_plain()) {
        node.fail(ErrorCode::inconsistent, node.shown() +
                                               " is one number: what is taken `over` the steps, in a window or `at` a time. Name a "
                                               "quantity that says nothing of the kind, and so has a number at each instant");
        return nullptr;
    }
    if (derivative == 0) return series;
    const auto name = core::expression::input_formula(named.name, core::expression::powers_of(series->numbers_dimension()));
    const auto made = quantities::StepExpression::create(name, {{named.name, series}}, {quantities::Over::end, derivative});
    for (const Error& error : made.errors()) node.fail(error.code, error.message);
    return made ? with_unit(node, *made) : nullptr;
}

core::expression::Formula read_threshold(const JsonNode& node, Dimension dimension, const ReadContext& context) {
    const double unit = context.unit(dimension);
    if (auto formula = context.formulas.followed(node, dimension, unit)) {
        if (!std::isfinite(context.formulas.value_of(*formula)))
            node.fail(ErrorCode::not_finite, "at the parameters' values this is not a finite number");
        return std::move(*formula);
    }
    return core::expression::constant_formula(node.quantity(dimension, unit).value_or(0), core::expression::powers_of(dimension));
}

std::optional<double> read_time(const JsonNode& node) { return node.quantity(Dimension::time, 1, core::files::not_negative); }

// With how often it is differentiated: "`slide`", "the rate of `slide`".
std::string name_in_messages(const JsonNode& node, int derivative) {
    const std::string name = "`" + node.string().value_or("") + "`";
    return derivative == 0 ? name : derivative == 1 ? "the rate of " + name : "the second derivative of " + name;
}

std::shared_ptr<const Quantity> read_extreme(const JsonNode& node, const ReadContext& context, bool is_largest) {
    std::vector<std::shared_ptr<const Quantity>> parts;
    const JsonNode list = node.require("of");
    const std::vector<JsonNode> entries = list.elements();
    for (const JsonNode& entry : entries) {
        auto part = read_named(entry, context);
        if (!part) continue;
        if (!parts.empty() && part->dimension() != parts.front()->dimension())
            entry.fail(ErrorCode::wrong_type, entry.shown() + " is in " + std::string(core::base::si_unit(part->dimension())) + ", and " +
                                                  entries.front().shown() + " in " +
                                                  std::string(core::base::si_unit(parts.front()->dimension())) +
                                                  ": the largest is of quantities of one dimension");
        parts.push_back(std::move(part));
    }
    if (list.is_array() && entries.empty()) list.fail(ErrorCode::out_of_range, "name at least one quantity");
    if (parts.empty()) return nullptr;
    return std::make_shared<quantities::Worst>(std::move(parts), is_largest);
}

}  // namespace

std::shared_ptr<const StepSeries> read_series(const JsonNode& node, const ReadContext& context, int derivative) {
    const auto text = node.string();
    if (!text) return nullptr;
    if (const auto named = find_named(*text, context)) return series_of_named(node, *named, derivative);
    const quantities::Reduction reduction(quantities::Over::end, derivative);
    return with_unit(node, read_step_formula(node, context, [&](Dimension) { return reduction; }));
}

std::shared_ptr<const Quantity> read_named(const JsonNode& node, const ReadContext& context) {
    const auto text = node.string();
    if (!text) return nullptr;
    if (const auto named = find_named(*text, context)) return named->quantity;
    return read_formula(node, context);
}

std::shared_ptr<const Quantity> read_event_time(const JsonNode& node, const ReadContext& context) {
    static const std::vector<std::string_view> directions{"either", "rising", "falling"};
    const int derivative = node["derivative"].integer(0, 2).value_or(0);
    quantities::EventTime::Of of;
    of.series = read_series(node.require("of"), context, derivative);
    const std::string direction = node["direction"].choice(directions).value_or("either");
    of.direction = static_cast<quantities::Direction>(std::find(directions.begin(), directions.end(), direction) - directions.begin());
    of.occurrence = node["occurrence"].integer(-1000000, 1000000).value_or(1);
    if (of.occurrence == 0)
        node["occurrence"].fail(ErrorCode::out_of_range, "it counts from 1, the first, or back from -1, the last; 0 is none");
    of.from = read_time(node["from"]);
    of.to = read_time(node["to"]);
    of.name = name_in_messages(node["of"], derivative);
    if (!of.series) return nullptr;
    of.threshold = read_threshold(node["threshold"], of.series->numbers_dimension(), context);
    return std::make_shared<quantities::EventTime>(std::move(of));
}

std::shared_ptr<const Quantity> read_value_at(const JsonNode& node, const ReadContext& context) {
    quantities::ValueAt::Of of;
    of.series = read_series(node.require("of"), context, node["derivative"].integer(0, 2).value_or(0));
    of.time = read_named(node.require("time"), context);
    if (of.time && of.time->dimension() != Dimension::time)
        node["time"].fail(ErrorCode::wrong_type, "this is in " + std::string(core::base::si_unit(of.time->dimension())) +
                                                     "; the time of an event is wanted, or an expression of such times");
    if (!of.series || !of.time) return nullptr;
    return std::make_shared<quantities::ValueAt>(std::move(of));
}

std::shared_ptr<const Quantity> read_time_share(const JsonNode& node, const ReadContext& context) {
    const int derivative = node["derivative"].integer(0, 2).value_or(0);
    quantities::TimeShare::Of of;
    of.series = read_series(node.require("of"), context, derivative);
    if (node["along"].exists()) of.along = read_series(node["along"], context, 0);
    of.is_above = !node["below"].exists();
    if (node["above"].exists() == node["below"].exists())
        node.fail(ErrorCode::inconsistent, "a share of the time is that `above` a threshold, or `below` one: say one of them");
    of.from = read_time(node["from"]);
    of.to = read_time(node["to"]);
    of.name = name_in_messages(node["of"], derivative);
    if (!of.series || (node["along"].exists() && !of.along)) return nullptr;
    of.threshold = read_threshold(node[of.is_above ? "above" : "below"], of.series->numbers_dimension(), context);
    return std::make_shared<quantities::TimeShare>(std::move(of));
}

std::shared_ptr<const Quantity> read_largest(const JsonNode& node, const ReadContext& context) { return read_extreme(node, context, true); }

std::shared_ptr<const Quantity> read_least(const JsonNode& node, const ReadContext& context) { return read_extreme(node, context, false); }

}  // namespace fettle::design::reading
