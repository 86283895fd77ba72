// SPDX-License-Identifier: MIT
/// A design as its file says: a scene, what may be changed in it, what is wanted and what is required. SI units. Reader: design_file.hpp;
/// evaluation: design_problem.hpp.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "fettle/core/scene/scene.hpp"
#include "fettle/design/constraints/constraint.hpp"
#include "fettle/design/objectives/objective.hpp"
#include "fettle/design/parameters.hpp"

namespace fettle::design {

/// Contributes weight * value / unit to the objective, a plain number.
struct ObjectiveTerm {
    std::string name;
    double weight = 1;
    double unit = 1;  ///< SI value of the unit that `weight` is per
    std::unique_ptr<objectives::Objective> objective;
};

struct OptimiserSettings {
    std::string name = "ipopt";
    int max_evaluations = 100;
    double tolerance = 1e-4;
};

struct Design {
    std::string path;  ///< of the design file
    std::string text;  ///< its contents
    std::string scene_path;
    core::scene::Scene scene;  ///< as its file says, before any parameter moves it
    double length_unit = 1;    ///< of the design file [m]
    std::string length_unit_name;
    int steps = 0;                      ///< of the simulation
    double clearance_tolerance = 1e-9;  ///< upper - lower wanted of certified distances [m]
    std::vector<Parameter> parameters;
    std::vector<ObjectiveTerm> objective;
    std::vector<std::unique_ptr<constraints::Constraint>> constraints;
    OptimiserSettings optimiser;
    std::string output;  ///< folder, absolute or relative to the working directory; empty: not said
    std::vector<std::string> warnings;
};

}  // namespace fettle::design
