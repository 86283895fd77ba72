// SPDX-License-Identifier: MIT
/// The formulas of a design's file: over its parameters, its own `variables`, and those of its scene.
///     "variables": { "room": "= bore - pin" }          of parameters, and of the scene's variables
///     "clearance_margin": "= layer / 100"              any number of the file, if no parameter changes it
///     "upper": "= 2 * gap"                             bounds, targets and points, which parameters may change
/// Part of design_reader.hpp.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/expression/parse_formula.hpp"
#include "core/files/json_document.hpp"
#include "core/scene/read_options.hpp"
#include "design/description/parameter.hpp"

namespace fettle::design::reading {

inline constexpr double grams = 1e-3;  ///< the unit of masses without a unit in designs [kg]

class DesignFormulas {
public:
    /// Reads the formulas of this document from now on. @param length_unit  The unit of numbers without one [m].
    DesignFormulas(core::files::JsonDocument& document, double length_unit, std::vector<core::scene::Variable> scene_variables);
    DesignFormulas(const DesignFormulas&) = delete;
    DesignFormulas& operator=(const DesignFormulas&) = delete;
    ~DesignFormulas();

    const std::vector<core::scene::Variable>& scene_variables() const { return scene_variables_; }

    /// Formulas may name these parameters from here on; they replace the scene's variables of their names. Faults go to the node.
    void add_parameters(const core::files::JsonNode& node, const std::vector<description::Parameter>& parameters);
    /// From here on a number is added to a variable of the design or of the scene: how far it is off as made. The design's own formulas
    /// follow from it; settings of the file that can follow from nothing are what they are where it is 0 (Measuring).
    /// @param names  The names of the added numbers, by variable. @param scene  Whose variables are read again.
    void add_deviations(const std::map<std::string, std::string>& names, core::files::JsonDocument& scene);
    /// The design's own `variables`.
    void read_variables(const core::files::JsonNode& node);

    /// From here on the scene's variables are those of the scene as the design's `set` leaves it. Faults, at this node (the design's
    /// `variables`): one of them names a variable that `set` changes, whose value it cannot have had.
    void take_scene(const std::vector<core::scene::Variable>& variables, const core::files::JsonNode& node);
    /// From here on a variable that this scenario has otherwise is refused: a formula would not be one number.
    void take_scenario(const std::string& scenario, const std::vector<core::scene::Variable>& variables);
    /// Why a formula may not name what this one names; empty: it may.
    std::string refusal(std::string_view text) const;

    /// What formulas may name by now, and in which units numbers without one count.
    const core::expression::Scope& scope() const { return scope_; }
    /// The formula of a number that parameters change: a text that begins with "=". Nothing where it is another number, or is wrong; then
    /// reading the number as such tells what is wrong with it.
    std::optional<core::expression::Formula> followed(const core::files::JsonNode& node, Dimension dimension, double si_per_number) const;
    /// While one lives, what is read is a measured number: where a deviation reaches it and it cannot follow, it is refused, as it is where
    /// a parameter does. Other numbers of the file (margins, weights, settings) are as they are without deviations.
    class Measuring {
    public:
        explicit Measuring(const DesignFormulas& formulas) : formulas_(formulas) { ++formulas_.measuring_; }
        ~Measuring() { --formulas_.measuring_; }
        Measuring(const Measuring&) = delete;
        Measuring& operator=(const Measuring&) = delete;

    private:
        const DesignFormulas& formulas_;
    };
    /// At the parameters' reference values.
    double value_of(const core::expression::Formula& formula) const;

    /// The names that formulas of the scene may use: the parameters, and the design's variables.
    std::vector<core::scene::FormulaInput> inputs_of_scene() const;

private:
    std::optional<double> read(const core::files::JsonNode& node, const std::string& text, Dimension dimension, double si_per_number);
    std::vector<core::expression::Scope::Name> meanings(const std::vector<core::scene::Variable>& variables) const;
    std::vector<std::string> changed(const std::vector<core::scene::Variable>& variables) const;
    void take_scene_variables();
    void take_deviation(const std::string& name, const core::expression::DimensionPowers& dimension, const std::string& variable);
    bool is_deviation(const std::string& name) const;

    core::files::JsonDocument& document_;
    std::vector<core::scene::Variable> scene_variables_;
    core::expression::Scope scope_;
    std::map<std::string, double> values_;  // of parameters, where they are references
    std::vector<core::scene::FormulaInput> own_;
    std::map<std::string, std::string> own_deviations_;  // to come, by variable
    std::vector<core::scene::FormulaInput> deviations_;  // that are in the scope
    mutable int measuring_ = 0;                          // how many Measuring live
    std::map<std::string, std::string> refused_;         // variables, and the scenario that has them otherwise
};

}  // namespace fettle::design::reading
