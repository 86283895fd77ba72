// SPDX-License-Identifier: MIT
/// How much of a design's numbers is its facets' and its time step's: the design measured again with twice as many facets along what is
/// round, with half the time step, and with both. Contact is that of the design as written (dhat, kappa), so that nothing else changes.
/// What changes little with both is about as exact as the change is large, where the error falls with the resolution as it does for smooth
/// motions; it is an estimate, and proves nothing.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "fettle/core/base/result.hpp"
#include "fettle/design/reading/design_reader.hpp"

namespace fettle::design::studies {

/// One quantity, SI.
struct ResolvedQuantity {
    std::string name;
    bool of_objective = false;  ///< a term of the objective; else a constraint
    int index = 0;
    double as_written = 0, finer_facets = 0, finer_steps = 0, finer_both = 0;

    /// By what it changes with both, as a share of the larger of the two; 0 where both are 0.
    double change() const;
};

struct ResolutionReport {
    std::vector<ResolvedQuantity> quantities;  ///< terms of the objective, then constraints
    std::vector<std::string> fixed_meshes;     ///< bodies whose facets stay as they are: of mesh files and programs
    std::string failure;                       ///< why one of the four cannot be measured; empty: all were
    bool interrupted = false;
};

struct ResolutionOptions {
    std::function<bool()> should_stop;                        ///< optional
    std::function<void(const std::string& what)> on_variant;  ///< optional: before each simulation
};

/// @param path, read  Of the design; `read.resolution` and `read.made` are not looked at.
/// Errors: those of reading the design, and of DesignProblem::create.
Result<ResolutionReport> check_resolution(const std::string& path, reading::DesignReadOptions read, const ResolutionOptions& options = {});

}  // namespace fettle::design::studies
