// SPDX-License-Identifier: MIT
/// What an optimisation's verdict rests on, for people and for programs alike.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "design/studies/optimise_design.hpp"

namespace fettle::design::answers {

/// What a run was asked for, and where its files are.
struct RunFacts {
    std::string out;
    std::uint64_t seed = 0;
    bool repair = false;
};

struct Cost {
    std::string requirement;     ///< a constraint's name, or a relation's
    description::Bounds bounds;  ///< its
    std::string unit;            ///< that bounds are shown in; empty: plain numbers
    double per_unit;             ///< in the objective; > 0: a lower bound that is raised costs, < 0: an upper one that is lowered
};

/// The costs of the requirements, relations too, whose hundredth of a unit is worth a tenth of what counts; the dearest first.
std::vector<Cost> costs_of(const description::Design& design, const optimisers::Optimality& o);

/// By what the best objective near by would change with a finer run's numbers (studies::change_of_best); NaN: not known, or the run did not
/// end with a design that is optimal in its own objective.
double change_of_best(const studies::OptimiseOutcome& outcome, const RunFacts& run, const studies::FinerRun& finer);

/// Which requirement has most of the noise that hides an optimum, by name; "the objective".
std::string roughest_name(const description::Design& design, const optimisers::Optimality& o);

/// Why a design that meets every requirement ("feasible") is not shown to be the best near by: for the text, result.json and the report
/// alike. Clauses without a full stop at the end; empty where the status is another one.
std::string why_not_optimal(const description::Design& design, const studies::OptimiseOutcome& outcome, const RunFacts& run);

}  // namespace fettle::design::answers
