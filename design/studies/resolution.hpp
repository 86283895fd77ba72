// SPDX-License-Identifier: MIT
/// How much of a design's numbers is its facets' and its time step's: the design measured again with twice as many facets along what is
/// round, with half the time step, and with both. Contact is that of the design as written (dhat, kappa), so that nothing else changes.
/// What changes little with both is about as exact as the change is large, where the error falls with the resolution as it does for smooth
/// motions; it is an estimate, and proves nothing.
/// Where friction lags (each step solves a given number of rounds, core/model/model.hpp), the design is also measured as written with
/// rounds until normal forces and directions agree: a lag changes forces by more than a halved time step shows.
#pragma once

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "design/problem/design_problem.hpp"
#include "design/reading/design_reader.hpp"

namespace fettle::design::studies {

/// One quantity, SI. NaN: of a run that failed, or of settled friction where none lags.
struct ResolvedQuantity {
    std::string name;
    bool of_objective = false;  ///< a term of the objective; else a constraint
    int index = 0;
    double as_written = std::nan(""), finer_facets = as_written, finer_steps = as_written, finer_both = as_written,
           settled_friction = as_written;

    /// By what it changes with both, as a share of the larger of the two; 0 where both are 0, NaN where one is not known.
    double change() const;
    /// The same with settled friction.
    double change_by_friction() const;
};

/// One simulation of the design.
struct ResolutionRun {
    std::string name;  ///< "with half the time step"
    double ResolvedQuantity::*value = nullptr;
    std::string failure = {};  ///< why it has no numbers; empty: it has
};

struct ResolutionReport {
    std::vector<ResolutionRun> runs;           ///< as written, finer facets, finer steps, both; with settled friction, if friction lags
    std::vector<ResolvedQuantity> quantities;  ///< terms of the objective, then constraints
    std::vector<std::string> fixed_meshes;     ///< bodies whose facets stay as they are: of mesh files and programs
    bool friction_lags = false;                ///< in one scenario at least
    bool interrupted = false;                  ///< the run that was stopped failed, and those after it were not begun

    /// Have all runs numbers?
    bool is_complete() const;
};

struct ResolutionOptions {
    std::function<bool()> should_stop;                        ///< optional
    std::function<void(const std::string& what)> on_variant;  ///< optional: before each simulation
};

/// A run that fails leaves the others their numbers.
/// @param path, read  Of the design; `read.resolution` and `read.made` are not looked at.
/// Errors: those of reading the design as written, and of its DesignProblem::create.
Result<ResolutionReport> check_resolution(const std::string& path, reading::DesignReadOptions read, const ResolutionOptions& options = {});

/// A design that was found, simulated once more with finer facets or time steps.
struct FinerRun {
    std::string name, key;  ///< "with twice the facets", "finer_facets"
    std::string failure = {};
    double objective = std::nan("");                           ///< NaN: of a run that failed
    std::vector<description::Measurement> terms, constraints;  ///< SI; empty: of a run that failed
};

/// What a design that was found owes to its facets and its time step, each by itself.
struct FinerReport {
    std::vector<FinerRun> runs;  ///< those that were made
    bool interrupted = false;    ///< the last one failed by that, and those after it were not begun
};

/// At most two simulations: with twice the facets, unless no part has other facets then, and with half the time step, unless nothing is
/// simulated. Contact is that of the design as written.
/// @param file, problem  The same design.  @param read  As `file` was read.  @param point  Where it was found, SI.
FinerReport measure_finer(const reading::DesignFile& file, const problem::DesignProblem& problem, const VectorX& point,
                          reading::DesignReadOptions read, const ResolutionOptions& options = {});

/// How one number of a design that was found differs in the run that changes it most, among those that have numbers.
struct FinerValue {
    std::string name;
    bool of_objective = false;  ///< a term of the objective; else a constraint
    int index = 0;
    double found = 0, finer = 0;              ///< SI
    double share = 0;                         ///< of the larger of the two; 0 where both are 0
    bool is_met = true, is_met_finer = true;  ///< of constraints; the latter in all runs
    const FinerRun* run = nullptr;            ///< the one of `finer`: where it is not met any more, if there is one
};
/// Is it met in one and not in the other? What is at its limit as found is beyond it by next to nothing in every other simulation: that is
/// none.
bool is_flip(const FinerValue& value);
/// Terms of the objective, then constraints; none where no run has numbers. It points into the report.
std::vector<FinerValue> finer_values(const description::Design& design, const problem::DesignEvaluation& found, const FinerReport& report);

/// The change of the best objective near by with a run's numbers, to first order: its change where the design is, and the costs of
/// requirements that hold there and are met by more, or less, then.
/// @param multipliers  of the constraints, optimisers::Optimality's; without entries: none holds. NaN: of a run that failed
double change_of_best(const problem::DesignEvaluation& found, const VectorX& multipliers, const FinerRun& run);

}  // namespace fettle::design::studies
