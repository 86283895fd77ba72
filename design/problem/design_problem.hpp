// SPDX-License-Identifier: MIT
/// Owns the chain from parameters to numbers and their gradients, and holds no mathematics of its own:
///   parameters -> parts and poses -> Scene -> Model -> simulate -> objective and constraints -> seeds -> reverse sweep -> d/d(parameters)
/// Of a design with scenarios each is simulated and swept by itself, at the same time; derivatives of a quantity are the sums of theirs.
/// Fixed once, from the scene as written, so that they are no hidden function of the parameters: reference points, barrier stiffness kappa,
/// activation distance, solver tolerance, stiffness of stops and the radii by which stops and friction of angles are measured. The same
/// design has the same numbers, bit for bit, whether a program made it or a file.
#pragma once

#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fettle/core/base/result.hpp"
#include "fettle/core/model/build_mechanism.hpp"
#include "fettle/core/model/model.hpp"
#include "fettle/core/stepper/simulate.hpp"
#include "fettle/design/description/design.hpp"
#include "fettle/design/optimisers/problem.hpp"
#include "fettle/design/problem/moved_scene.hpp"
#include "fettle/design/problem/witness_branches.hpp"

namespace fettle::design::problem {

struct EvaluateOptions {
    bool gradients = true;
    std::function<void(const core::stepper::Progress&)> on_step;  ///< optional
    std::function<bool()> should_stop;                            ///< optional
    bool balance = false;                      ///< fill in each run's Simulation::balance, for the warnings on energy: costs a few percent
    BranchReach branches = BranchReach::near;  ///< with gradients: `near` fills in the evaluation's branches, `tied` its ties
};

/// What was simulated.
struct Run {
    std::shared_ptr<const core::model::Model> model;  ///< null if it could not be built
    core::stepper::Simulation simulation;             ///< as far as it came
};

/// A constraint whose value has come to an end short of its bounds: how it goes on (description::Continuation).
struct ContinuedRow {
    int constraint = 0;
    double value = 0;    ///< SI
    std::string reason;  ///< for people
    VectorX gradient;    ///< d value / d parameters, SI; empty unless asked for
};

/// A design, simulated and measured.
struct DesignEvaluation {
    bool usable = false;
    VectorX parameters;        ///< where, SI
    std::string reason;        ///< why not: the part that cannot be made, the bodies that intersect, what blocks the motor ...
    bool interrupted = false;  ///< not usable, because should_stop said so
    std::vector<Run> runs;     ///< one per scenario, at least one; none: a relation is not defined there
    std::vector<description::Measurement> terms;        ///< per objective term, SI
    std::vector<description::Measurement> constraints;  ///< per constraint, SI
    std::vector<ContinuedRow> continued;                ///< of some constraints, in their order: what a search sees of these instead
    optimisers::Rows relations;                         ///< values and gradients, of an unusable trial too
    double objective = std::nan("");                    ///< sum of weight * value / unit; NaN: not usable
    double violation = std::nan("");           ///< largest of the constraints' and relations' (description/constraint.hpp); NaN: not usable
    VectorX gradient;                          ///< d objective / d parameters, SI; empty unless asked for
    MatrixX jacobian;                          ///< d constraint values / d parameters, SI
    VectorX residuals;                         ///< the objective's deviations (optimisers/problem.hpp)
    MatrixX residual_jacobian;                 ///< of the objective's squared deviations (optimisers/problem.hpp), a row each
    optimisers::Branches constraint_branches;  ///< of clearances (optimisers/problem.hpp)
    optimisers::Branches objective_branches;   ///< the same of terms with a negative weight
    std::vector<Tie> ties;                     ///< if asked for: quantities whose derivative is one of several
    double forward_seconds = 0;                ///< parts, model, simulation, values
    double backward_seconds = 0;               ///< seeds, sweep, chain
};

/// What a search sees of the constraints, with those that are continued: values, and derivatives (those of `jacobian`), SI.
VectorX search_values(const DesignEvaluation& evaluation);
MatrixX search_jacobian(const DesignEvaluation& evaluation);
/// What is to be known of a constraint beside its numbers: its fault, or why it is continued; empty: nothing.
std::string remark(const DesignEvaluation& evaluation, std::size_t constraint);

/// What quantities are asked about: every scenario, simulated. Contract: the evaluation has its models, and outlives this.
class SimulatedDesign {
public:
    SimulatedDesign(const description::Design& design, const DesignEvaluation& evaluation);
    SimulatedDesign(const SimulatedDesign&) = delete;
    SimulatedDesign& operator=(const SimulatedDesign&) = delete;

    const description::Simulated& in(int scenario) const { return scenarios_[scenario]; }

private:
    std::vector<description::Simulated> scenarios_;
};

/// Const after creation: evaluate may be called from several threads at once.
class DesignProblem {
public:
    /// Errors: the scene as written cannot be built (its bodies intersect, a mesh is open ...), and what check_design finds.
    static Result<DesignProblem> create(description::Design design);

    /// With places by number (core/scene/place.hpp).
    const description::Design& design() const { return design_; }
    int parameter_count() const { return count_of(design_.parameters); }
    int scenario_count() const { return count_of(settings_); }                      ///< at least 1
    int steps(int scenario = 0) const { return settings_[scenario].design.steps; }  ///< of its simulation
    /// That all designs are simulated with [N/m], in that scenario.
    double kappa(int scenario = 0) const { return settings_[scenario].kappa; }
    /// What is odd about the scene as written: its meshes, its start.
    const std::vector<std::string>& warnings() const { return warnings_; }

    /// The model of a scenario at parameter values p (SI).
    Result<core::model::Model> model_at(const VectorX& p, int scenario = 0) const;

    /// Indices of the constraints that a simulation changes nothing of.
    std::vector<int> rest_constraints() const;
    /// Their values and Jacobian at p, without a simulation; nothing where the parts cannot be made or intersect, or a
    /// number is not finite.
    std::optional<optimisers::Rows> rest_rows(const VectorX& p) const;

    /// The same design with contact of another width dhat [m], and the stiffness that goes with it; of facets as they are, whose sum stays
    /// smooth where contact is wider than the play, as round surfaces' least distance does not.
    Result<DesignProblem> with_contact_width(double dhat) const;
    /// The design's relations at p: k values and their k x n Jacobian, exact; nothing is built.
    optimisers::Rows relations(const VectorX& p) const;

    /// Why the design at p cannot be simulated at all: a relation that is not defined there, a part that cannot be made (`where` names body
    /// and dimension), parts that intersect as assembled; empty: nothing of the kind. Builds the model, simulates nothing.
    Errors obstacles(const VectorX& p) const;
    /// The same as one text, which is also the reason that `evaluate` gives.
    std::string refusal(const VectorX& p) const;

    /// Deterministic. A trial that cannot be built or simulated is not usable, and says why; no number stands in for it.
    DesignEvaluation evaluate(const VectorX& p, const EvaluateOptions& options = {}) const;

private:
    /// What is fixed once, of a scenario.
    struct Setting {
        description::Design design;  ///< design_of_scenario
        std::vector<Vector3> reference_points;
        double kappa = 0;
        std::vector<core::model::FacetSides> facet_sides;
        core::model::TermScales term_scales;
        std::optional<double> proximal_weight;  ///< of quasi-static steps
    };
    /// Rows of derivatives that one scenario adds to.
    struct Share;

    DesignProblem() = default;
    static Result<Setting> fixed(description::Design design, core::model::Model model);
    static Result<core::model::Model> build(const Setting& setting, const core::scene::Scene& scene);
    static Result<MovedScene> trial_scene(const Setting& setting, const VectorX& p, SceneDerivative derivative);
    Errors undefined(const optimisers::Rows& relations) const;
    std::string simulate(int scenario, const EvaluateOptions& options, Run& run) const;
    void measure(DesignEvaluation& evaluation) const;
    void differentiate(const std::vector<MovedScene>& moved, BranchReach reach, DesignEvaluation& evaluation) const;
    Result<Share> share_of(int scenario, const MovedScene& moved, const SimulatedDesign& simulated, BranchReach reach,
                           const DesignEvaluation& evaluation) const;

    description::Design design_;
    std::vector<Setting> settings_;  // one per scenario
    std::vector<std::string> warnings_;
};

}  // namespace fettle::design::problem
