// SPDX-License-Identifier: MIT
/// The `choices` of a design's file: numbers of teeth, parts, materials, processes that are one of a list.
///     "choices": {
///       "slots":    { "from": 4, "to": 12 },                         whole numbers, which the scene's variable `slots` takes
///       "module":   { "values": [0.8, 1, 1.25], "value": 1 },        numbers in a list
///       "material": { "options": { "PLA": { "set": { "/bodies/wheel/density": 1240 } }, "POM": { "set": { ... } } } }
///     }
/// Part of design_reader.hpp.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/files/json_document.hpp"
#include "design/description/choice.hpp"
#include "design/description/parameter.hpp"

namespace fettle::design::reading {

/// Reads the choices of a design's file, and puts the options that it has into the scene.
class ChoiceReader {
public:
    /// Faults go to the node. Contract: it and the scene outlive this.
    ChoiceReader(const core::files::JsonNode& node, core::files::JsonDocument& scene);

    const std::vector<description::Choice>& choices() const { return choices_; }
    /// The name of the process that the options bring; nothing: none does.
    const std::optional<core::files::JsonNode>& process() const { return process_; }
    /// Puts the chosen numbers, and what the chosen options set, into a document of the scene. Faults go to the options.
    void apply(core::files::JsonDocument& scene);

    /// What formulas of the design may name, where the variables of the choices are names and no numbers: which relations follow from them?
    /// @param design, scene  Documents of their own, whose faults are told elsewhere.
    core::expression::Scope scope(core::files::JsonDocument& design, core::files::JsonDocument& scene, double length_unit,
                                  const std::vector<description::Parameter>& parameters) const;

private:
    struct Set {
        std::string pointer;
        core::files::JsonNode value;
    };
    struct Variable {
        std::vector<double> values;  ///< by option, SI
        core::expression::DimensionPowers dimension;
    };

    void read(const std::string& name, const core::files::JsonNode& node);
    void read_numbers(const core::files::JsonNode& node, const std::vector<double>& numbers, description::Choice& choice);
    void read_options(const core::files::JsonNode& node, description::Choice& choice);
    void take_variable(description::Choice& choice, const std::string& name, Variable variable);
    std::optional<std::vector<double>> numbers_of(const core::files::JsonNode& node) const;
    std::optional<double> number_in_scene(const std::string& name) const;

    core::files::JsonDocument& scene_;
    std::vector<description::Choice> choices_;
    std::optional<core::files::JsonDocument> chosen_;  ///< the numbers that were chosen, as a document
    std::vector<std::string> numbers_;                 ///< choices whose variable takes a number
    std::vector<Set> sets_;                            ///< of the chosen options
    std::map<std::string, core::expression::DimensionPowers> dimensions_;
    std::optional<core::files::JsonNode> process_;
};

}  // namespace fettle::design::reading
