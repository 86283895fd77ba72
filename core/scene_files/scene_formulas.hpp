// SPDX-License-Identifier: MIT
/// The formulas of a scene's file: its `variables`, and the numbers that follow from them.
///     "variables": { "bore": "5mm", "gap": "0.2mm", "pin": "= bore - gap", "teeth ratio": 1.5 }
///     "position": ["= crank + rod * cos(phi)", 0, 0]
/// A variable that names no other can be moved by a design, by the parameter of its name; so can all numbers that follow from it. While the
/// file is read its numbers are those at the variables' values, and how they are computed is recorded (core/expression/tape.hpp): what the
/// reader computes from them (a joint's point in its bodies' frames) is a formula of the variables too. Part of scene_reader.hpp.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/expression/parse_formula.hpp"
#include "core/files/json_document.hpp"
#include "core/scene/read_options.hpp"

namespace fettle::core::scene_files {

using Number3 = std::array<expression::Number, 3>;

/// rotation_of (angles.hpp) on numbers: the rows of R.
std::array<Number3, 3> rotation_of_angles(const Number3& angles);
std::array<Number3, 3> rotation_of_vector(const Number3& vector);

class SceneFormulas {
public:
    /// Reads the formulas of this document from now on. Outlives the reading of its nodes.
    SceneFormulas(files::JsonDocument& document, const std::vector<scene::FormulaInput>& inputs);
    SceneFormulas(const SceneFormulas&) = delete;
    SceneFormulas& operator=(const SceneFormulas&) = delete;
    ~SceneFormulas();

    /// The units of numbers without one in formulas: lengths and speeds `unit` [m], angles degrees, others SI.
    void set_length_unit(double unit);
    /// `variables`, in any order. Faults: a name that is not possible or is an input's, a circle.
    void read_variables(const files::JsonNode& node);

    /// The number that was read at a node as `value`; if it is a formula there, with the variables that it follows from.
    expression::Number number(const files::JsonNode& node, double value) const;
    Number3 vector(const files::JsonNode& node, const Vector3& value) const;

    /// What a name of the file's formulas stands for at present, if there is one: its number, its quantity, and whether it follows from an
    /// input, which a design moves.
    struct Named {
        expression::Number number;
        expression::DimensionPowers dimension;
        bool is_moved = false;
    };
    std::optional<Named> named(const std::string& name) const;

    /// A number that the reader has computed: `pointer` says where it is (place.hpp), as what is computed from nodes that `use` names,
    /// which stand for nothing else then. Does nothing if no formula is in it.
    void bind(const std::string& pointer, const expression::Number& number);
    void use(const files::JsonNode& node);

    const std::vector<scene::Variable>& variables() const { return variables_; }

    /// Gives the scene its variables and the numbers that follow from them. Faults: formulas of inputs, which a design moves, where no
    /// design can move the number (how many teeth, how long the time step is).
    void finish(scene::Scene& scene);

private:
    struct Found {
        files::JsonNode node;
        expression::Number number;
        bool is_used = false;  // for numbers that were computed
    };

    expression::Number value_of(const expression::Formula& formula) const;
    /// The first input that the number follows from; empty: none.
    std::string moved_by(const expression::Number& number) const;
    std::optional<double> read(const files::JsonNode& node, const std::string& text, base::Dimension dimension, double si_per_number);

    files::JsonDocument& document_;
    expression::Scope scope_;
    expression::Tape tape_;
    std::vector<std::string> input_names_;  // of the tape's inputs
    std::map<std::string, expression::Number> inputs_;
    std::set<std::string> taken_;                       // names that are not the file's to give
    std::map<std::string, scene::FormulaInput> added_;  // by the variable
    std::vector<scene::Variable> variables_;
    std::map<std::string, Found> found_;  // by pointer
    std::map<std::string, expression::Number> bound_;
};

}  // namespace fettle::core::scene_files
