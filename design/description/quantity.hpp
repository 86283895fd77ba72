// SPDX-License-Identifier: MIT
/// A number that a simulated design has, for an objective to sum or a constraint to bound. Value and derivative are two functions, so that
/// their times can be distinguished; the derivative starts from what the value found (witness, extremal nodes), so nothing is searched
/// twice. Those of the program: ../quantities. Add one: derive from Quantity, and hand it to the design (design.hpp).
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "adjoint/model_gradient.hpp"
#include "core/base/result.hpp"
#include "core/base/units.hpp"
#include "core/clearance/pair_clearance.hpp"
#include "core/model/model.hpp"
#include "core/stepper/trajectory.hpp"
#include "design/description/quantity_facts.hpp"

namespace fettle::design::description {

using adjoint::Seeds;

/// A design, simulated, in one of its scenarios. The trajectory was computed from the model.
struct Simulated {
    const core::model::Model& model;
    const core::stepper::Trajectory& trajectory;
    double clearance_tolerance = 1e-9;     ///< upper - lower wanted of certified distances [m]
    std::vector<std::string> names{};      ///< of the design's parameters
    VectorX parameters{};                  ///< their values, SI
    int scenario = 0;                      ///< which of the design's this is
    const Simulated* scenarios = nullptr;  ///< all of them, in their order; null: there is this one alone

    const Simulated& in(int other) const { return scenarios == nullptr ? *this : scenarios[other]; }
};

/// The optimiser sees, and derivatives are taken of, `value`, which is in [lower, upper].
///   is_proven:  lower <= true value <= upper, rounding included: certified distances, and formulas of these alone.
///   otherwise:  as computed. Nothing bounds the error of the time step, of facets, of the solver's tolerance, of rounding.
/// Requirements are judged by lower and upper either way.
struct Measurement {
    double value = 0, lower = 0, upper = 0;                   ///< SI
    bool is_proven = false;                                   ///< what lower and upper are, above
    std::optional<core::clearance::PairClearance> clearance;  ///< where the value comes from, if it is a certified distance
    std::string fault;  ///< why no bound on it can be met, whatever the numbers (a body lies inside the other); empty: nothing of the kind
    std::vector<Measurement> parts{};  ///< what it was made from, if it is an expression of other quantities
};
inline Measurement computed(double value) { return {value, value, value, false, std::nullopt, {}, {}}; }

/// One of the smooth functions that a value is the least of: a distance between two features at one instant.
struct Branch {
    double value = 0;                               ///< at least the quantity's
    std::function<void(double, Seeds&)> add_seeds;  ///< adds scale * d(value); holds references to what it was made from
};

/// A value for a search in place of one that has come to an end where it does not change any more, short of what is required: a force of
/// contact is 0 however far apart the bodies are. It goes on from there, so that it says how far the design is from the requirement, and
/// which way leads there. Reports show the value itself, and requirements are judged by it.
struct Continuation {
    double value = 0;                               ///< SI; the quantity's own value where that has only just come to its end
    std::function<void(double, Seeds&)> add_seeds;  ///< adds scale * d(value); holds references to what it was made from
    std::string reason;                             ///< for people: "`arm` and `workpiece` are 0.31 mm apart"
};

struct Bounds;  // constraint.hpp

class Quantity {
public:
    virtual ~Quantity() = default;

    /// What it measures: a bound in a unit of another dimension is an error, and reports count in a unit of this one.
    virtual Dimension dimension() const = 0;

    /// What others have to know of it. Const and pure, as all of these functions.
    virtual QuantityFacts facts() const { return {}; }

    /// Const and pure: called from several threads at once.
    virtual Measurement value(const Simulated& simulated) const = 0;

    /// Adds scale * d(value) to the seeds: by the simulation, and by the parameters that it follows from itself (Seeds::parameters_bar).
    /// `measured` is what value() returned for the same `simulated`.
    virtual void add_seeds(const Simulated& simulated, const Measurement& measured, double scale, Seeds& seeds) const = 0;

    /// The deviations r_i of which the value is the sum of squares; empty: it is no such sum. For Gauss-Newton's curvature.
    virtual VectorX deviations(const Simulated& simulated) const;

    /// Adds scale * d(r_i) to the seeds. Contract: 0 <= i < deviations().size().
    virtual void add_deviation_seeds(const Simulated& simulated, int i, double scale, Seeds& seeds) const;

    /// The numbers to draw over the motion, at the steps' ends, where facts() has the dimension of a curve.
    virtual std::vector<double> curve(const Simulated& simulated) const;

    /// The branches of a value that is the least of several smooth functions (a clearance: of the distances at its witnesses): first the
    /// one that add_seeds differentiates, then a few of the others that are at most `limit` (SI), which say most about where the value can
    /// go. Empty: it is no such value. Not to outlive `simulated` and `measured`.
    virtual std::vector<Branch> branches(const Simulated& simulated, const Measurement& measured, double limit) const;

    /// Which of its branches the value is: the least (a clearance) or the greatest (the worst of several scenarios; then `limit` is above
    /// the value by as much as branches that are asked for may be below it).
    virtual bool is_greatest_branch() const { return false; }

    /// How its value goes on where it has come to an end short of these bounds. Nothing: it has not, or no quantity of this kind comes to
    /// one. Not to outlive `simulated`. Those that seeds are added for are of a scenario that it is about.
    virtual std::optional<Continuation> continuation(const Simulated& simulated, const Measurement& measured, const Bounds& bounds) const;

    /// Whether a simulation changes nothing of it: of the parts as assembled, or of their shapes alone.
    virtual bool is_at_rest() const { return false; }

    /// Does its value follow from that scenario's motion? Seeds are added in each scenario of which this is so. A quantity that knows of
    /// none is about the one in which it is asked: of a design without scenarios, 0 (quantities/in_scenario.hpp).
    virtual bool is_about(int scenario) const { return scenario == 0; }

    /// The names of the parameters that it follows from itself, and not through the scene: those of a formula of its own, such as a target.
    virtual std::vector<std::string> parameters() const { return {}; }

    /// What may make the value jump, or take it away, at a small change of the design, in a sentence for people: an event that is hardly
    /// reached. Empty: nothing of the kind.
    virtual std::string doubt(const Simulated& simulated, const Measurement& measured) const;

    /// What a value came from, where that says why it is not a finite number: "force = 3 N, mass = 0 kg". Empty: nothing to say.
    virtual std::string explanation(const Measurement& measured) const;

    /// What makes it meaningless for these bodies and this number of steps: a body that is not there, a volume of an open mesh. Asked once,
    /// of the scene as written. `where` is left to the caller.
    virtual Errors check(const core::model::Model& model, int steps) const;
};

/// The error of Quantity::check for an index that is none of the model's bodies.
Errors check_body(const core::model::Model& model, int body);

}  // namespace fettle::design::description
