// SPDX-License-Identifier: MIT
#include "core/part_files/curve_reader.hpp"

#include <array>
#include <cstdint>

namespace fettle::core::part_files {
namespace {

using base::Dimension;
using base::ErrorCode;
using expression::DimensionPowers;
using expression::Operation;
using files::JsonNode;

// A number of a law, for parameters of any kind of number. What does not depend on the parameter is computed once.
class LawNumber {
public:
    LawNumber(const PartNumber& number, const std::vector<Number>& values) {
        std::vector<Operand> places;
        for (const expression::Node& node : number.formula.nodes) {
            Step step{node.operation, {}};
            const auto count = static_cast<std::size_t>(expression::operand_count(node.operation));
            const int input = node.operation == Operation::input ? number.positions[node.operands[0]] : 0;
            bool varies = node.operation == Operation::input && input < 0;
            for (std::size_t i = 0; i < count; ++i) {
                step.operands[i] = places[node.operands[i]];
                varies = varies || step.operands[i].varies;
            }
            places.push_back({varies, varies ? steps_.size() : fixed_.size()});
            if (varies)
                steps_.push_back(step);
            else if (node.operation == Operation::constant)
                fixed_.emplace_back(node.number);
            else if (node.operation == Operation::input)
                fixed_.push_back(values[input]);
            else
                fixed_.push_back(expression::applied<Number>(node.operation, fixed(step, 0), fixed(step, 1), fixed(step, 2)));
        }
    }

    template <class T>
    T at(const T& parameter) const {
        if (steps_.empty()) return T(fixed_.back());
        std::vector<T> found;
        found.reserve(steps_.size());
        const auto operand = [&](const Step& step, std::size_t i) -> T {
            const Operand& place = step.operands[i];
            return place.varies ? found[place.index] : place.index < fixed_.size() ? T(fixed_[place.index]) : T(0.0);
        };
        for (const Step& step : steps_) {
            if (step.operation == Operation::input)
                found.push_back(parameter);
            else
                found.push_back(expression::applied<T>(step.operation, operand(step, 0), operand(step, 1), operand(step, 2)));
        }
        return found.back();
    }

private:
    struct Operand {
        bool varies = false;
        std::size_t index = SIZE_MAX;  // into the values of steps, or into fixed_; SIZE_MAX: there is none
    };
    struct Step {
        Operation operation;
        std::array<Operand, 3> operands;
    };
    Number fixed(const Step& step, std::size_t i) const {
        return step.operands[i].index < fixed_.size() ? fixed_[step.operands[i].index] : Number(0);
    }

    std::vector<Step> steps_;
    std::vector<Number> fixed_;
};

// A point of a law as written.
struct WrittenLaw {
    LawNumber first, second;
    bool is_polar = false;

    template <class T>
    std::array<T, 2> operator()(const T& t) const {
        using std::cos, std::sin;
        const T a = first.at(t), b = second.at(t);
        if (!is_polar) return {a, b};
        return {a * cos(b), a * sin(b)};
    }
};

// Both ends have one dimension; a number without a unit takes that of the other.
std::array<PartNumber, 2> read_ends(const JsonNode& node, const PartNumbers& numbers) {
    const std::vector<JsonNode> ends = node.is_array() ? node.elements() : std::vector<JsonNode>();
    if (ends.size() != 2) {
        if (node.exists())
            node.fail(ErrorCode::wrong_type, "expected the two ends of the parameter, [0, \"360deg\"], found " + node.shown());
        return {};
    }
    std::array<PartNumber, 2> out{numbers.number_of_any(ends[0]), numbers.number_of_any(ends[1])};
    for (std::size_t k : {std::size_t{0}, std::size_t{1}}) {
        const DimensionPowers wanted = out[1 - k].formula.dimension;
        if (expression::same(out[k].formula.dimension, wanted)) return out;
        const auto dimension = expression::named_dimension(wanted);
        if (!out[k].formula.dimension.is_number() || !dimension || !out[k].formula.is_constant()) continue;
        out[k] = numbers.number(ends[k], *dimension);
        return out;
    }
    node.fail(ErrorCode::wrong_type, "the parameter begins with " + expression::described(out[0].formula.dimension) + " and ends with " +
                                         expression::described(out[1].formula.dimension) + "; give both one unit");
    return out;
}

}  // namespace

CurveMaker read_law(const JsonNode& node, PartNumbers& numbers) {
    node.allow_keys({"t", "x", "y", "radius", "angle"});
    const auto [from, to] = read_ends(node.require("t"), numbers);
    const bool is_polar = node["radius"].exists();
    if (is_polar && (node["x"].exists() || node["y"].exists()))
        node.fail(ErrorCode::inconsistent, "a law has either `x` and `y`, or `radius` and `angle`");
    if (numbers.scope().find("t") != nullptr)
        node["t"].fail(ErrorCode::inconsistent,
                       "`t` is the parameter of the law here, and a dimension, count or variable too; rename that");
    PartNumber first, second;
    numbers.with_parameter("t", from.formula.dimension, [&] {
        first = numbers.length(is_polar ? node["radius"] : node.require("x"));
        if (!is_polar)
            second = numbers.length(node.require("y"));
        else if (node["angle"].exists())
            second = numbers.angle(node["angle"]);
        else if (const auto t = numbers.parsed("t", node))
            second = *t;
    });
    return [=, begin = from, end = to](Sheet& sheet) {
        return parts::law_curve(parts::Law(WrittenLaw{LawNumber(first, sheet.values), LawNumber(second, sheet.values), is_polar}),
                                begin.at(sheet), end.at(sheet));
    };
}

CurveMaker read_involute(const JsonNode& node, const PartNumbers& numbers) {
    const PartNumber base = numbers.length(node["involute"]), from = numbers.length(node.require("from")),
                     to = numbers.length(node.require("to")), turn = numbers.angle(node["turn"]);
    const bool mirrored = node["mirrored"].boolean().value_or(false);
    return [=](Sheet& sheet) {
        const Number r = base.at(sheet);
        // The roll angle at a distance from the centre: sqrt((distance / base)^2 - 1); below the circle there is no involute.
        const auto roll = [&](const PartNumber& distance) {
            const Number ratio = distance.at(sheet) / r;
            return ratio.value > 1 ? sqrt(ratio * ratio - 1) : Number(0);
        };
        return parts::involute(r, turn.at(sheet), roll(from), roll(to), mirrored);
    };
}

}  // namespace fettle::core::part_files
