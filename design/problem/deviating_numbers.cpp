// SPDX-License-Identifier: MIT
#include "design/problem/deviating_numbers.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "core/base/text.hpp"
#include "design/problem/vanishing_number.hpp"

namespace fettle::design::problem {

using description::Design;
using description::Tolerance;

Number3 constant_vector(const Vector3& x) { return {Number(x[0]), Number(x[1]), Number(x[2])}; }

NumberMatrix constant_matrix(const Matrix3& m) {
    return {constant_vector(m.row(0).transpose()), constant_vector(m.row(1).transpose()), constant_vector(m.row(2).transpose())};
}

Number3 sum(const Number3& a, const Number3& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Number3 difference(const Number3& a, const Number3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

Number3 product(const NumberMatrix& m, const Number3& x) {
    Number3 out;
    for (size_t i = 0; i < 3; ++i) out[i] = m[i][0] * x[0] + m[i][1] * x[1] + m[i][2] * x[2];
    return out;
}

Number dot(const Vector3& a, const Number3& b) { return Number(a[0]) * b[0] + Number(a[1]) * b[1] + Number(a[2]) * b[2]; }

Vector3 value_of(const Number3& x) { return {x[0].value, x[1].value, x[2].value}; }

bool varies(const Number3& x) {
    return std::any_of(x.begin(), x.end(), [](const Number& number) { return !number.is_constant(); });
}

bool varies(const std::vector<Number>& numbers) {
    return std::any_of(numbers.begin(), numbers.end(), [](const Number& x) { return !x.is_constant(); });
}

DeviatingNumbers::DeviatingNumbers(const Design& design, const std::vector<Tolerance>& tolerances, const VectorX& base,
                                   core::scene::Scene scene)
    : scene_(std::move(scene)) {
    std::vector<Number> parameters;
    for (const description::Parameter& parameter : design.parameters) parameters.emplace_back(parameter.value);
    for (int k = 0; k < count_of(tolerances); ++k) {
        const Tolerance& tolerance = tolerances[k];
        const core::base::Unit& unit = design.parameters[tolerance.parameter].unit;
        const double lower = tolerance.deviation.lower, upper = tolerance.deviation.upper;
        deviations_.push_back({tolerance.of, lower, upper, base[k], unit.dimension == Dimension::number ? "" : std::string(unit.name)});
        ranges_.emplace_back(lower, upper);
        parameters[tolerance.parameter] = parameters[tolerance.parameter] + tape_.input(base[k]);
    }
    const std::vector<std::string> names = description::names_of(design.parameters);
    const core::scene::Scene described = description::described_scene(design);
    for (const core::scene::BoundNumber& bound : design.numbers) {
        const core::scene::Place place = core::scene::find_place(described, bound.place).value();
        std::vector<Number> inputs;
        for (const int position : core::expression::positions_of(bound.formula, names)) inputs.push_back(parameters[position]);
        const Number number = core::expression::value_of<Number>(bound.formula, inputs);
        numbers_[core::scene::pointer_to(described, place)] = number;
        if (!number.is_constant()) moved_.push_back({place, number});
    }
}

Number DeviatingNumbers::number(const std::string& pointer, double value) const {
    const auto found = numbers_.find(pointer);
    return found == numbers_.end() ? Number(value) : found->second;
}

Number3 DeviatingNumbers::vector(const std::string& pointer, const Vector3& value) const {
    Number3 out;
    for (int k = 0; k < 3; ++k) out[static_cast<size_t>(k)] = number(pointer + "/" + std::to_string(k), value[k]);
    return out;
}

std::set<int> DeviatingNumbers::deviations_of(const std::vector<Number>& numbers) const {
    std::set<int> found;
    std::vector<bool> reached(nodes().size(), false);
    for (const Number& x : numbers)
        if (!x.is_constant()) reached[x.node] = true;
    for (size_t k = reached.size(); k-- > 0;) {
        if (!reached[k]) continue;
        const core::expression::Node& node = nodes()[k];
        if (node.operation == core::expression::Operation::input) found.insert(node.operands[0]);
        for (int i = 0; i < core::expression::operand_count(node.operation); ++i) reached[node.operands[static_cast<size_t>(i)]] = true;
    }
    return found;
}

std::vector<std::string> DeviatingNumbers::tolerances_of(const std::vector<Number>& numbers) const {
    std::vector<std::string> names;
    for (const int k : deviations_of(numbers)) names.push_back("`" + deviations_[k].of + "`");
    return names;
}

std::string DeviatingNumbers::names_of(const std::vector<Number>& numbers) const { return core::base::joined(tolerances_of(numbers)); }

std::string DeviatingNumbers::movers_of(const std::vector<Number>& numbers) const {
    const std::vector<std::string> names = tolerances_of(numbers);
    return core::base::joined(names) + (names.size() == 1 ? " moves" : " move");
}

int DeviatingNumbers::node_of(const Number& x) {
    if (!x.is_constant()) return x.node;
    const auto [found, is_new] = constants_.try_emplace(x.value, 0);
    if (is_new) found->second = tape_.node_of(x);
    return found->second;
}

bool DeviatingNumbers::is_none(const Number& x, double allowed) const { return vanishes(x, ranges_, allowed); }

}  // namespace fettle::design::problem
