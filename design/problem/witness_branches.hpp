// SPDX-License-Identifier: MIT
/// The branches (description/quantity.hpp) of a design's clearances, extremes over the steps and worst of several, beside the one that is
/// differentiated: as rows that optimisers take, or as ties that are reported.
#pragma once

#include <vector>

#include "design/description/design.hpp"
#include "design/optimisers/problem.hpp"

namespace fettle::design::problem {

/// Several branches attain the value of a quantity, with derivatives that differ: it has a kink there, and no derivative.
struct Tie {
    bool of_objective = false;  ///< a term of the objective; else a constraint
    int index = 0;              ///< of the term or constraint
    int branches = 0;           ///< with derivatives of their own, at least 2; of those that were looked at
    VectorX least, greatest;    ///< derivatives among them, per parameter, SI
};

/// The branches of one term or constraint, and their place among the seeds of an evaluation.
struct QuantityBranches {
    bool of_objective = false;
    int index = 0;
    bool is_in_one_row = false;                 ///< the first one's derivative is the constraint's own, which has a row already
    std::vector<description::Branch> branches;  ///< the first is the one that the value's own derivative is of
    MatrixX jacobian;                           ///< a row each, per parameter; take_jacobians
};

/// What is measured of a design.
struct Measurements {
    const std::vector<description::Measurement>&terms, &constraints;
};

enum class BranchReach {
    none,  ///< they are not asked for
    /// What a step can run into: of constraints with a lower bound those below twice the bound, of a greatest value with an upper bound
    /// those as far above 0, of terms of the objective with a negative weight (which want the value large) those up to twice the value, and
    /// all of a value that is the greatest and is wanted small.
    near,
    tied  ///< of all constraints and terms, those that attain the value to within the tolerance of certified distances
};

/// Left out are quantities without branches, and constraints of one scenario that have only one.
std::vector<QuantityBranches> branches_of(const description::Design& design, const description::Simulated& simulated,
                                          const Measurements& measured, BranchReach reach);

/// Appends the seeds of the branches: without the first where its derivative is the constraint's own.
void add_seeds(const QuantityBranches& quantity, const description::Simulated& simulated, std::vector<adjoint::Seeds>& seeds);

/// Fills in the Jacobians of all from the rows that belong to those seeds, in their order, and from the constraints' own.
void take_jacobians(const MatrixX& rows, const MatrixX& constraint_jacobian, std::vector<QuantityBranches>& all);

/// Which of the branches say something beside the first: branch j is left out where, for a branch k that is not, d_j + d_j' dp cannot be
/// less than d_k + d_k' dp for any dp within the parameters' whole ranges (up to 1e-6 of what the first can change by): round a concentric
/// pin all branches have one derivative by its radius.
/// @param ranges  upper - lower of the parameters.  @return  indices, without the first's.
std::vector<int> telling_branches(const VectorX& values, const MatrixX& jacobian, const VectorX& ranges);

/// As optimisers take them; of constraints without the first, of terms times weight / unit and with it.
optimisers::Branches constraint_rows(const description::Design& design, const std::vector<QuantityBranches>& all);
optimisers::Branches objective_rows(const description::Design& design, const std::vector<QuantityBranches>& all);

/// Ties of branches within reach `tied`.
std::vector<Tie> ties_of(const description::Design& design, const std::vector<QuantityBranches>& all);

}  // namespace fettle::design::problem
