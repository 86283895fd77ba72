// SPDX-License-Identifier: MIT
/// The kinds of objective by the `type` that a design file calls them, and their reading.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fettle/core/files/json_document.hpp"
#include "fettle/core/scene/scene.hpp"
#include "fettle/design/objectives/objective.hpp"

namespace fettle::design::objectives {

/// What reading a term needs to know of the design.
struct ReadContext {
    const core::scene::Scene& scene;
    double length_unit = 1;  ///< of the file [m]
    double end_time = 0;     ///< of the simulation [s]

    /// Index of the body that a node names; unknown_key with the nearest name otherwise.
    std::optional<int> body(const core::files::JsonNode& node) const;
    /// A direction, normalised. Errors: zero.
    std::optional<Vector3> axis(const core::files::JsonNode& node) const;
};

/// Keys that an objective of this type has, besides those common to all terms.
struct ObjectiveType {
    std::string_view name;
    std::vector<std::string_view> keys;
    /// @return nothing if something was wrong; the faults are with the document.
    std::unique_ptr<Objective> (*read)(const core::files::JsonNode& node, const ReadContext& context);
    std::string (*default_name)(const core::files::JsonNode& node);  ///< "stroke piston"
};
const std::vector<ObjectiveType>& objective_table();
const ObjectiveType* find_objective_type(std::string_view name);

}  // namespace fettle::design::objectives
