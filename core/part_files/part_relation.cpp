// SPDX-License-Identifier: MIT
#include "fettle/core/part_files/part_relation.hpp"

#include <string_view>

#include "fettle/core/base/text.hpp"
#include "fettle/core/base/units.hpp"

namespace fettle::core::part_files {
namespace {

using base::ErrorCode;
using expression::DimensionPowers;
using files::JsonNode;

struct SplitText {
    std::vector<std::string> sides{""}, comparisons;
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
        std::string comparison(1, c);
        if (k + 1 < text.size() && text[k + 1] == '=') comparison += text[++k];
        out.comparisons.push_back(comparison);
        out.sides.emplace_back();
    }
    return out;
}

bool holds(double a, const std::string& comparison, double b) {
    if (comparison == "<") return a < b;
    if (comparison == "<=") return a <= b;
    return comparison == ">" ? a > b : a >= b;
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
    node.allow_keys({"check", "or"});
    const auto check = node.require("check").string();
    if (!check) return std::nullopt;
    PartRelation out{*check, node["or"].string().value_or(""), node.where(), {}, {}};
    const SplitText parts = split(*check);
    out.comparisons = parts.comparisons;
    if (parts.comparisons.empty()) {
        node["check"].fail(ErrorCode::parse, "a relation compares: \"a < b\", with <, <=, > or >=; found " + node["check"].shown());
        return std::nullopt;
    }
    DimensionPowers wanted;  // of the first side that is no bare number
    for (const std::string& side : parts.sides) {
        const auto number = numbers.parsed(side, node["check"]);
        if (!number) return std::nullopt;
        if (wanted.is_number()) wanted = number->formula.dimension;
        out.sides.push_back(*number);
    }
    for (std::size_t k = 0; k < out.sides.size(); ++k) {
        const DimensionPowers& own = out.sides[k].formula.dimension;
        if (expression::same(own, wanted)) continue;
        const auto dimension = expression::named_dimension(wanted);
        if (own.is_number() && out.sides[k].formula.is_constant() && dimension) {
            const double unit = numbers.scope().plain_unit(*dimension);
            const double value = out.sides[k].formula.nodes.back().number;
            out.sides[k] = {expression::constant_formula(value * unit, wanted)};
            continue;
        }
        node["check"].fail(ErrorCode::wrong_type, expression::described(own) + " and " + expression::described(wanted) +
                                                      " cannot be compared" + (own.is_number() ? "; give the number a unit" : ""));
        return std::nullopt;
    }
    return out;
}

std::optional<Error> fault_of(const PartRelation& relation, const std::vector<double>& values) {
    std::vector<double> found;
    for (const PartNumber& side : relation.sides) found.push_back(side.at<double>(values, 0.0));
    bool all_hold = true;
    for (std::size_t k = 0; k < relation.comparisons.size(); ++k)
        all_hold = all_hold && holds(found[k], relation.comparisons[k], found[k + 1]);
    if (all_hold) return std::nullopt;
    std::string numbers;
    for (std::size_t k = 0; k < found.size(); ++k)
        numbers += (k == 0 ? "" : " " + relation.comparisons[k - 1] + " ") + shown(found[k], relation.sides[k].formula.dimension);
    return Error{ErrorCode::out_of_range, relation.where,
                 "`" + relation.check + "` must hold" + (relation.otherwise.empty() ? "" : ", or " + relation.otherwise) +
                     "; here it would be " + numbers};
}

}  // namespace fettle::core::part_files
