// SPDX-License-Identifier: MIT
/// The loosest tolerances with which a design holds what it requires: `fettle tolerance DESIGN --allocate`.
///   minimise the sum of the tolerances' costs   so that each requirement has its yield, or holds in the worst case
/// Costs are description::ToleranceCost's: by default 1 as a tolerance stands and 1/f of limits f times as wide, so that the sum is the
/// number of tolerances where nothing changes.
///
/// Solved on a model of each requirement (allocation_model.hpp) from the derivatives of first and second order; the limits that it finds
/// are studied (tolerance_study.hpp), by the second order there and by samples, or the corners of the worst case, where they are asked for;
/// the model is corrected by what was found, and solved again, until it changes nothing. Tolerances with grades are chosen one step at a
/// time, the one that saves most: what is found so need not be the best choice of grades.
///
/// All of it is computed, none of it proven.
#pragma once

#include <string>
#include <vector>

#include "design/studies/allocation_model.hpp"
#include "design/studies/tolerance_study.hpp"

namespace fettle::design::studies {

struct AllocationOptions {
    double yield = 0.9973;    ///< of each requirement. Contract: 0.5 < yield < 1
    bool worst_case = false;  ///< in its place: the linear worst case, and the simulated corners that it names
    ToleranceOptions study;   ///< samples, seed, and who is told; second_order false: linear models
    int most_rounds = 8;      ///< studies at new limits
};

enum class AllocationStatus {
    held,         ///< every requirement is, by the study at the new limits
    not_held,     ///< no allocation holds every requirement: `message` says which and why
    not_settled,  ///< model and studies do not agree within most_rounds
    undecided,    ///< the design as drawn cannot be simulated
    interrupted
};
const char* to_string(AllocationStatus status);

struct AllocatedTolerance {
    double factor = 1;  ///< new width / old width
    double cost_before = 0, cost = 0;
    std::string choice = {};  ///< the grade that was chosen; empty: there is no choice of grades
    bool is_widest = false;   ///< nothing that it changes limits it: it is as wide as is looked at
};

struct AllocatedRequirement {
    int response = 0;  ///< of `study`
    bool is_held = false;
    bool is_limiting = false;  ///< wider tolerances would miss it
    double predicted = 0;      ///< share within the bounds: second-order moments; samples' where these differ by more than chance
};

struct AllocationReport {
    AllocationStatus status = AllocationStatus::undecided;
    std::string message;                             ///< why it is not held
    std::vector<description::Tolerance> tolerances;  ///< with the new limits
    std::vector<AllocatedTolerance> allocated;       ///< per tolerance
    std::vector<AllocatedRequirement> requirements;
    double cost_before = 0, cost = 0;
    int rounds = 0;         ///< studies at new limits
    ToleranceReport study;  ///< at the limits of `tolerances`
};

/// @param problem  The problem of the design as made (description/tolerance.hpp), with a constraint or relation that has a bound.
/// Throws core::base::MissingLibrary where Ipopt is not there.
AllocationReport allocate(const problem::DesignProblem& problem, const std::vector<description::Tolerance>& tolerances,
                          const AllocationOptions& options);

}  // namespace fettle::design::studies
