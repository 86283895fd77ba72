// SPDX-License-Identifier: MIT
/// What reading a part of a design file needs to know of the rest: the scene, the file's unit, the time simulated.
#pragma once

#include <initializer_list>
#include <optional>
#include <set>
#include <string>

#include "core/base/units.hpp"
#include "core/files/json_document.hpp"
#include "core/scene/scene.hpp"
#include "design/description/over_tolerances.hpp"
#include "design/quantities/expression.hpp"
#include "design/reading/design_formulas.hpp"
#include "design/reading/scenario_choice.hpp"

namespace fettle::design::reading {

struct ReadContext {
    const core::scene::Scene& scene;
    double length_unit = 1;  ///< of the file [m]
    double end_time = 0;     ///< of the simulation [s]
    const DesignFormulas& formulas;
    const std::vector<quantities::NamedQuantity>& quantities;  ///< the file's `quantities`, which expressions may name
    const ScenarioNames& scenarios;
    std::optional<description::OverTolerances> over_tolerances = {};  ///< of requirements that do not say it themselves

    /// Index of the body that a node names; unknown_key with the nearest name otherwise.
    std::optional<int> body(const core::files::JsonNode& node) const;
    /// A direction, normalised. Errors: zero.
    std::optional<Vector3> axis(const core::files::JsonNode& node) const;
    /// SI value of the unit that plain numbers of this dimension are in: lengths, areas and speeds by the file's unit, masses
    /// in grams, angles in degrees, else SI.
    double unit(Dimension dimension) const;
    /// SI value of the unit in which bounds are shown: that of the first that is a text ("60 N mm" -> 0.001), else unit(dimension).
    double unit_of(std::initializer_list<core::files::JsonNode> bounds, Dimension dimension) const;
};

/// `wanted`, or "wanted 2", "wanted 3", ... if it is taken; takes it.
std::string unique_name(const std::string& wanted, std::set<std::string>& taken);

}  // namespace fettle::design::reading
