// SPDX-License-Identifier: MIT
/// A design: a scene, its parameters, objective and requirements. Plain data, SI units; made by a program, or read from a file
/// (reading/design_reader.hpp). Evaluation: problem/design_problem.hpp, which also says what is wrong with one.
///
///     Design design;
///     design.scene.timestep = 0.01;
///     core::scene::Body pin;
///     pin.name = "pin";
///     add_part(design, pin, shape);                       // the mesh is the shape's as drawn
///     design.parameters.push_back({.name = "radius", .value = 5e-3, .lower = 4e-3, .upper = 6e-3, .unit = *find_unit("mm")});
///     set_number(design, "/bodies/pin/shape/dimensions/radius", "radius");
///     set_number(design, "/bodies/pin/position/2", "2 * radius + 0.5 mm");
///     design.objective.push_back({.name = "mass", .quantity = mass});
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/scene/scene.hpp"
#include "design/description/constraint.hpp"
#include "design/description/parameter.hpp"
#include "design/description/quantity.hpp"
#include "design/description/relation.hpp"
#include "design/description/shape.hpp"

namespace fettle::design::description {

/// Contributes weight * value / unit to the objective, a plain number.
struct ObjectiveTerm {
    std::string name;
    double weight = 1;
    double unit = 1;  ///< SI value of the unit that `weight` is per
    std::shared_ptr<const Quantity> quantity;
    std::optional<OverTolerances> over_tolerances = {};  ///< the value with its reserve for the tolerances counts; nothing: as drawn
};

struct MadeDesign;

struct OptimiserSettings {
    std::string name = "sqp";  ///< optimisers/optimisation.hpp knows which there are
    int max_evaluations = 100;
    double tolerance = 1e-4;
    bool keep_sides = false;  ///< random starts assemble closed linkages on the sides as written alone (studies/starting_sides.hpp)
};

/// A setting beside which the design is simulated: the scene with other loads, friction, motors, start, time step ...
struct Scenario {
    std::string name;
    core::scene::Scene scene;                          ///< with the same bodies and joints as the design's
    std::vector<std::shared_ptr<const Shape>> shapes;  ///< as Design::shapes
    std::vector<core::scene::BoundNumber> numbers;     ///< as Design::numbers
    int steps = 0;
};

struct Design {
    core::scene::Scene scene;                          ///< at the parameters' reference values
    std::vector<std::shared_ptr<const Shape>> shapes;  ///< per body; null, or beyond its end: the body's mesh stays as it is
    int steps = 0;                                     ///< of the simulation
    double clearance_tolerance = 1e-9;                 ///< upper - lower wanted of certified distances [m]
    std::vector<Parameter> parameters;
    /// The numbers of the scene that follow from the parameters, each by a formula of their names; one for a place.
    std::vector<core::scene::BoundNumber> numbers;
    /// What is simulated; empty: the scene as it stands, for `steps` steps. Quantities are about the first, or about the one that
    /// quantities::in_scenario says.
    std::vector<Scenario> scenarios;
    std::vector<ObjectiveTerm> objective;
    std::vector<Constraint> constraints;
    std::vector<Relation> relations;  ///< between parameters; judged before anything is simulated
    OptimiserSettings optimiser;
    /// The same design as made, where something is asked for over the tolerances (made_design.hpp); else null.
    std::shared_ptr<const MadeDesign> as_made = nullptr;
};

/// 1 if it has none: the scene as it stands.
int scenario_count(const Design& design);
/// The design with the scene, shapes, numbers and steps of one of its scenarios as its own, and no scenarios: the same one if it has none.
/// Contract: 0 <= scenario < scenario_count.
Design design_of_scenario(const Design& design, int scenario);
/// "upside down: " before what is said of a scenario; empty if the design has none.
std::string scenario_prefix(const Design& design, int scenario);

/// The shape of a body; null if its mesh is fixed.
inline const Shape* shape_of(const Design& design, int body) {
    return static_cast<size_t>(body) < design.shapes.size() ? design.shapes[body].get() : nullptr;
}

/// Puts all dimensions as drawn into the body's description of its shape, those left to their defaults too.
void describe(const Shape& shape, core::scene::Body& body);
/// The scene with its shapes described, and no others: what parameters can move has a place there.
core::scene::Scene described_scene(const Design& design);

/// For each dimension of a body's shape: is it one of the numbers that follow from the parameters?
/// @param scene  With its shapes described; @param numbers  As Design::numbers; places that are not there are left out.
std::vector<bool> moved_dimensions(const core::scene::Scene& scene, const std::vector<core::scene::BoundNumber>& numbers, int body,
                                   const Shape& shape);

/// Lets the number at a place of the scene (core/scene/place.hpp) follow from the parameters, in place of what it followed from.
/// @param formula  A formula of the parameters (core/expression/parse_formula.hpp); numbers without a unit count in SI.
/// @return what is wrong with it, or with the place; then nothing is changed.
Errors set_number(Design& design, const std::string& place, const std::string& formula);

/// Adds a body with the shape as drawn for its mesh. @return its index, or what keeps the shape from being made.
Result<int> add_part(Design& design, core::scene::Body body, std::shared_ptr<const Shape> shape);

}  // namespace fettle::design::description
