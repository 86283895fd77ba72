// SPDX-License-Identifier: MIT
/// The formulas of a design's file: over its parameters, its own `variables`, and those of its scene.
///     "variables": { "room": "= bore - pin" }          of parameters, and of the scene's variables
///     "minimum": "= 2 * layer"                         any number of the file, if no parameter changes it
/// Part of design_reader.hpp.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "fettle/core/expression/parse_formula.hpp"
#include "fettle/core/files/json_document.hpp"
#include "fettle/core/scene/read_options.hpp"
#include "fettle/design/description/parameter.hpp"

namespace fettle::design::reading {

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
    /// The design's own `variables`.
    void read_variables(const core::files::JsonNode& node);

    /// The names that formulas of the scene may use: the parameters, and the design's variables.
    std::vector<core::scene::FormulaInput> inputs_of_scene() const;

private:
    std::optional<double> read(const core::files::JsonNode& node, const std::string& text, Dimension dimension, double si_per_number);
    void take_scene_variables();

    core::files::JsonDocument& document_;
    std::vector<core::scene::Variable> scene_variables_;
    core::expression::Scope scope_;
    std::map<std::string, double> values_;  // of parameters
    std::vector<core::scene::FormulaInput> own_;
};

}  // namespace fettle::design::reading
