// SPDX-License-Identifier: MIT
#include "core/part_files/part_relation.hpp"

#include <string_view>

#include "core/base/text.hpp"
#include "core/base/units.hpp"

namespace fettle::core::part_files {
namespace {

using base::ErrorCode;
using expression::DimensionPowers;
using files::JsonNode;

struct SplitText {
    std::vector<std::string> sides{""}, signs;
};

// At comparisons that stand in no parentheses (those of an `if` do) and in no quoted name.
SplitText split(std::string_view text) {
    SplitText out;
    int depth = 0;
    bool quoted = false;
    for (std::size_t k = 0; k < text.size(); ++k) {
        const char c = text[k];
        if (c == '\'') quoted = !quoted;
        if (!quoted && c == '(') ++depth;
        if (!quoted && c == ')') --depth;
        if (quoted || depth > 0 || (c != '<' && c != '>')) {
            out.sides.back() += c;
            continue;
        }
        std::string sign(1, c);
        if (k + 1 < text.size() && text[k + 1] == '=') sign += text[++k];
        out.signs.push_back(sign);
        out.sides.emplace_back();
    }
    return out;
}

bool holds(double a, const std::string& sign, double b) {
    if (sign == "<") return a < b;
    if (sign == "<=") return a <= b;
    return sign == ">" ? a > b : a >= b;
}

std::vector<double> values_of(const Comparison& comparison, const std::vector<double>& values) {
    std::vector<double> out;
    for (const PartNumber& side : comparison.sides) out.push_back(side.at<double>(values, 0.0));
    return out;
}

// False of NaN.
bool all_hold(const Comparison& comparison, const std::vector<double>& found) {
    for (std::size_t k = 0; k < comparison.signs.size(); ++k)
        if (!holds(found[k], comparison.signs[k], found[k + 1])) return false;
    return true;
}

// Compares in the dimension of the first side that is no bare number; bare ones take its unit.
std::optional<Comparison> read_comparison(const JsonNode& node, const PartNumbers& numbers) {
    const auto text = node.string();
    if (!text) return std::nullopt;
    const SplitText parts = split(*text);
    if (parts.signs.empty()) {
        node.fail(ErrorCode::parse, "expected a comparison, \"a < b\", with <, <=, > or >=; found " + node.shown());
        return std::nullopt;
    }
    Comparison out{{}, parts.signs};
    DimensionPowers wanted;
    for (const std::string& side : parts.sides) {
        const auto number = numbers.parsed(side, node);
        if (!number) return std::nullopt;
        if (wanted.is_number()) wanted = number->formula.dimension;
        out.sides.push_back(*number);
    }
    const auto dimension = expression::named_dimension(wanted);
    for (PartNumber& side : out.sides) {
        const DimensionPowers own = side.formula.dimension;
        if (expression::same(own, wanted)) continue;
        if (!own.is_number() || !side.formula.is_constant() || !dimension) {
            node.fail(ErrorCode::wrong_type, expression::described(own) + " and " + expression::described(wanted) + " cannot be compared" +
                                                 (own.is_number() ? "; give the number a unit" : ""));
            return std::nullopt;
        }
        side = {expression::constant_formula(side.formula.nodes.back().number * numbers.scope().plain_unit(*dimension), wanted)};
    }
    return out;
}

}  // namespace

std::string shown(double si, const DimensionPowers& powers) {
    const auto dimension = expression::named_dimension(powers);
    if (dimension == base::Dimension::length) return base::format_length(si, "mm");
    if (dimension == base::Dimension::angle) return base::format_quantity(si, "deg");
    const std::string number = base::formatted("%.6g", si);
    return dimension && !powers.is_number() ? number + " " + std::string(base::si_unit(*dimension)) : number;
}

std::optional<PartRelation> read_relation(const JsonNode& node, const PartNumbers& numbers) {
    node.allow_keys({"check", "or", "when"});
    const auto comparison = read_comparison(node.require("check"), numbers);
    const auto when = read_comparison(node["when"], numbers);
    if (!comparison || (node["when"].exists() && !when)) return std::nullopt;
    return PartRelation{*node["check"].string(), node["or"].string().value_or(""), node.where(), *comparison, when};
}

std::optional<Error> fault_of(const PartRelation& relation, const std::vector<double>& values) {
    if (relation.when && !all_hold(*relation.when, values_of(*relation.when, values))) return std::nullopt;
    const std::vector<double> found = values_of(relation.comparison, values);
    if (all_hold(relation.comparison, found)) return std::nullopt;
    std::string numbers;
    for (std::size_t k = 0; k < found.size(); ++k)
        numbers +=
            (k == 0 ? "" : " " + relation.comparison.signs[k - 1] + " ") + shown(found[k], relation.comparison.sides[k].formula.dimension);
    return Error{ErrorCode::out_of_range, relation.where,
                 "`" + relation.check + "` must hold" + (relation.otherwise.empty() ? "" : ", or " + relation.otherwise) +
                     "; here it would be " + numbers};
}

}  // namespace fettle::core::part_files
