// SPDX-License-Identifier: MIT
/// Owns the chain from parameters to numbers and their gradients, and holds no mathematics of its own:
///   parameters -> parts and poses -> Scene -> Model -> simulate -> objective and constraints -> seeds -> reverse sweep -> d/d(parameters)
/// Fixed once, from the scene as written, so that they are no hidden function of the parameters: reference points, barrier stiffness kappa,
/// activation distance, solver tolerance. A design that is written out and read again has the same numbers, bit for bit.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fettle/core/base/result.hpp"
#include "fettle/core/model/model.hpp"
#include "fettle/core/stepper/simulate.hpp"
#include "fettle/design/design.hpp"
#include "fettle/design/history.hpp"
#include "fettle/design/optimisers/problem.hpp"

namespace fettle::design {

struct EvaluateOptions {
    bool gradients = true;
    std::function<void(const core::stepper::Progress&)> on_step;  ///< optional
    std::function<bool()> should_stop;                            ///< optional
};

/// A design, simulated and measured.
struct DesignEvaluation {
    bool usable = false;
    std::string reason;        ///< why not: the part that cannot be made, the bodies that intersect, what blocks the motor ...
    bool interrupted = false;  ///< not usable, because should_stop said so
    std::shared_ptr<const core::model::Model> model;  ///< null if it could not be built
    core::stepper::Simulation simulation;             ///< as far as it came
    std::vector<objectives::Quantity> terms;          ///< per objective term, SI
    std::vector<objectives::Quantity> constraints;    ///< per constraint, SI
    double objective = 0;                             ///< sum of weight * value / unit
    double violation = 0;                             ///< largest of the constraints' violations (constraint.hpp)
    VectorX gradient;                                 ///< d objective / d parameters, SI; empty unless asked for
    MatrixX jacobian;                                 ///< d constraint values / d parameters, SI
    double forward_seconds = 0;                       ///< parts, model, simulation, values
    double backward_seconds = 0;                      ///< seeds, sweep, chain
};

/// Const after creation: evaluate may be called from several threads at once.
class DesignProblem {
public:
    /// Errors: the scene as written cannot be built (its bodies intersect, a mesh is open ...).
    static Result<DesignProblem> create(Design design);

    const Design& design() const { return design_; }
    int parameter_count() const { return static_cast<int>(design_.parameters.size()); }
    /// That all designs are simulated with [N/m].
    double kappa() const { return kappa_; }

    /// The model at parameter values p (SI).
    Result<core::model::Model> model_at(const VectorX& p) const;

    /// Deterministic. A trial that cannot be built or simulated is not usable, and says why; no number stands in for it.
    DesignEvaluation evaluate(const VectorX& p, const EvaluateOptions& options = {}) const;

    /// What the optimiser works on: values from `design`, bounds narrowed by their margins. `evaluate` is left empty. Must not outlive
    /// this object.
    optimisers::Problem optimiser_problem() const;

    /// An evaluation as the optimiser and the history take it. Throws optimisers::Interrupted if it was.
    HistoryEntry history_entry(const VectorX& p, const DesignEvaluation& evaluation) const;

private:
    struct Gradients;
    DesignProblem() = default;
    Result<core::model::Model> build(const core::scene::Scene& scene) const;
    void measure(DesignEvaluation& evaluation) const;
    void differentiate(const MovedScene& moved, DesignEvaluation& evaluation) const;

    Design design_;
    std::vector<Vector3> reference_points_;
    double kappa_ = 0;
};

}  // namespace fettle::design
