// SPDX-License-Identifier: MIT
/// Owns the chain from parameters to numbers and their gradients, and holds no mathematics of its own:
///   parameters -> parts and poses -> Scene -> Model -> simulate -> objective and constraints -> seeds -> reverse sweep -> d/d(parameters)
/// Each scenario of a design is simulated and swept by itself, at the same time; derivatives of a quantity are the sums of theirs.
/// Fixed once, from the scene as written, so that they are no hidden function of the parameters: reference points, barrier stiffness kappa,
/// activation distance, solver tolerance, stiffness of stops and the radii by which stops and friction of angles are measured. The same
/// design has the same numbers, bit for bit, whether a program made it or a file.
/// A robust design (description/made_design.hpp) is simulated as made, without deviations, which is the same motion, bit for
/// bit; what is asked for over the tolerances follows (evaluate_over_tolerances.hpp).
///
///     const auto problem = design::problem::DesignProblem::create(file->design);  // of read_design
///     for (const auto& error : problem.errors()) std::printf("%s: %s\n", error.where.c_str(), error.message.c_str());
///     if (!problem) return 3;
///     const auto at = problem->evaluate(design::description::values_of(problem->design().parameters));
///     if (!at.usable) std::printf("%s\n", at.reason.c_str());
///     for (int k = 0; at.usable && k < problem->parameter_count(); ++k)
///         std::printf("d objective / d %s = %g\n", problem->design().parameters[k].name.c_str(), at.gradient[k]);
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "core/model/build_mechanism.hpp"
#include "design/description/design.hpp"
#include "design/problem/design_evaluation.hpp"
#include "design/problem/evaluate_over_tolerances.hpp"
#include "design/problem/moved_scene.hpp"

namespace fettle::design::problem {

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

    /// The same design with contact of another width dhat [m], and the stiffness that goes with it.
    /// @param surfaces  facets: whose sum stays smooth where contact is wider than the play, as round surfaces' least distance does not
    enum class Surfaces { facets, as_written };
    Result<DesignProblem> with_contact_width(double dhat, Surfaces surfaces = Surfaces::facets) const;
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
    EvaluateAsMade as_made() const;
    DesignEvaluation evaluate_robust(const VectorX& p, const EvaluateOptions& options) const;
    std::string simulate(int scenario, const EvaluateOptions& options, Run& run) const;
    void measure(DesignEvaluation& evaluation) const;
    void differentiate(const std::vector<MovedScene>& moved, BranchReach reach, DesignEvaluation& evaluation) const;
    Result<Share> share_of(int scenario, const MovedScene& moved, const SimulatedDesign& simulated, BranchReach reach,
                           const DesignEvaluation& evaluation) const;

    description::Design design_;
    std::vector<Setting> settings_;                 // one per scenario
    std::shared_ptr<const DesignProblem> as_made_;  // of a robust design
    std::vector<std::string> warnings_;
};

}  // namespace fettle::design::problem
