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

#include "fettle/core/base/result.hpp"
#include "fettle/design/reading/design_reader.hpp"

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

}  // namespace fettle::design::studies
