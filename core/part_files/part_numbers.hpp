// SPDX-License-Identifier: MIT
/// The numbers of a part's file (part_file.hpp): what they may name, how they are read, and their values while the part is drawn.
///     12      "12mm"      "= bore / 2 + clearance"
/// A number without a unit counts in the file's unit of lengths, in degrees, or is a plain number, as its place wants it.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/expression/parse_formula.hpp"
#include "core/files/json_document.hpp"
#include "core/parts/drawing.hpp"
#include "core/parts/profile.hpp"
#include "core/parts/solid.hpp"

namespace fettle::core::part_files {

using expression::Number;

/// One drawing of a part: the values that its formulas name, and the named shapes that have been drawn.
struct Sheet {
    parts::Drawing& drawing;
    std::vector<Number> values;  ///< of dimensions and variables, in the order of PartNumbers::names()
    std::map<std::string, Result<parts::Profile>> profiles;
    std::map<std::pair<std::string, parts::Lean>, Result<parts::Solid>> solids;  ///< what is cut away is drawn with the other lean
    int depth = 0;                                                               ///< shapes within one another that are being drawn
};

/// A number as written.
struct PartNumber {
    expression::Formula formula = expression::constant_formula(0);
    std::vector<int> positions = {};  ///< of its inputs among Sheet::values; -1: the parameter of a law

    /// @tparam T  double, Number, or a jet of either (parts/jet.hpp).
    template <class T, class Value>
    T at(const std::vector<Value>& values, const T& parameter) const {
        std::vector<T> inputs;
        inputs.reserve(positions.size());
        for (const int k : positions) inputs.push_back(k < 0 ? parameter : T(values[k]));
        return expression::value_of<T>(formula, inputs);
    }
    Number at(const Sheet& sheet) const { return at<Number>(sheet.values, Number(0)); }
};

/// Names and units, and the reading of numbers. Faults go to the document.
class PartNumbers {
public:
    explicit PartNumbers(double length_unit);

    double length_unit() const { return unit_; }
    /// The inputs of formulas, in the order in which they were added.
    const std::vector<std::string>& names() const { return names_; }
    const expression::Scope& scope() const { return scope_; }

    /// Adds a dimension, which is an input of formulas; a count, which is a constant.
    void add_dimension(const std::string& name, base::Dimension dimension);
    void add_count(const std::string& name, int value);
    /// `variables`: names and formulas, in any order.
    void add_variables(const files::JsonNode& node);
    /// The values of all names, of the dimensions'.
    std::vector<Number> values(std::vector<Number> dimensions) const;

    PartNumber number(const files::JsonNode& node, base::Dimension dimension) const;
    PartNumber length(const files::JsonNode& node) const { return number(node, base::Dimension::length); }
    PartNumber angle(const files::JsonNode& node) const { return number(node, base::Dimension::angle); }
    /// A number of any dimension; one without a unit is a plain one.
    PartNumber number_of_any(const files::JsonNode& node) const;
    /// A count, which no dimension changes. Nothing if it is wrong, which the document is told.
    std::optional<int> count(const files::JsonNode& node, int least, int most) const;
    std::optional<PartNumber> parsed(const std::string& text, const files::JsonNode& node) const;
    /// The number that the formula is.
    PartNumber number_of(expression::Formula formula) const;

    /// read() while formulas may name the parameter of a law, too.
    void with_parameter(const std::string& name, const expression::DimensionPowers& dimension, const std::function<void()>& read);

private:
    double si_per_number(base::Dimension dimension) const { return scope_.plain_unit(dimension); }
    PartNumber given(const files::JsonNode& node, const Result<expression::Formula>& formula) const;

    double unit_;
    expression::Scope scope_;
    std::vector<std::string> names_;
    std::vector<std::pair<std::string, PartNumber>> variables_;  // each after those that it names
    std::string parameter_;
};

/// A point of a profile, [x, y], or {"polar": [distance from the origin, angle]}.
struct PartPoint {
    PartNumber first, second;
    bool is_polar = false;

    parts::Point2 at(const Sheet& sheet) const;
};
PartPoint read_point(const files::JsonNode& node, const PartNumbers& numbers);
/// Is it written as one?
bool is_point(const files::JsonNode& node);

/// A point of a solid, [x, y, z]; a direction, as plain numbers.
struct PartPoint3 {
    PartNumber x, y, z;

    parts::Point3 at(const Sheet& sheet) const { return {x.at(sheet), y.at(sheet), z.at(sheet)}; }
};
PartPoint3 read_point3(const files::JsonNode& node, const PartNumbers& numbers, base::Dimension dimension = base::Dimension::length);

/// Faults of the kernel with the place of what was drawn; those that have a place of a file keep it.
Errors located(Errors errors, const std::string& where);
template <class T>
Result<T> located(Result<T> result, const std::string& where) {
    return result ? std::move(result) : Result<T>(located(result.errors(), where));
}

}  // namespace fettle::core::part_files
