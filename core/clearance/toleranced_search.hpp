// SPDX-License-Identifier: MIT
/// The least distance of two bodies over a box of tolerances, all positions of the joints between them and all deviations that matter for
/// them (certificate/toleranced.hpp), by branch and bound (box_search.hpp).
///
/// The bound of a cell is the prover's (certificate/toleranced_prover.hpp), rigorous with its rounding; what is chosen here is the vector.
/// For two elements it is one that turns as the direction between their nearest points does, or the best that stays: the direction of the
/// point nearest to the origin of the hull of all x_a(t) - x_b(t), as far as they are linear in t, by Gilbert, Johnson and Keerthi's
/// method. Its supports are corners of the box, so that one vector serves a box of many deviations without halving them: distance is convex
/// in what moves in straight lines. Halved is the larger piece while pieces are larger than what the box moves them, then the variable
/// whose motion is bent most, alone or together with others: with rho_k the angle by which variable k turns one body against the other and
/// mu_k the way that it moves them,
///   bend_k = 1/2 sum over i of (rho_k mu_i + rho_i mu_k).
#pragma once

#include "core/certificate/toleranced_prover.hpp"
#include "core/clearance/box_search.hpp"
#include "core/clearance/made_bodies.hpp"

namespace fettle::core::clearance {

/// Two bodies of a model, as made. What it refers to must stay where it is.
struct TolerancedBodies {
    const certificate::Toleranced& toleranced;
    const certificate::TolerancedPair& pair;
    certificate::TolerancedProver& prover;  ///< of the pair
    const PieceTree &a, &b;                 ///< of the meshes at the base
    double slack = 0;                       ///< rounding of a distance in doubles [m]
};
TolerancedBodies toleranced_bodies(const certificate::Toleranced& toleranced, const certificate::TolerancedPair& pair,
                                   certificate::TolerancedProver& prover, const PieceTree& a, const PieceTree& b);

using certificate::VariableBox;

/// Values of the pair's variables as those of all coordinates and deviations; the others are where they start.
struct AllValues {
    std::vector<double> coordinates, deviations;
};
/// @param dependents  those of the pair there.
AllValues all_values(const certificate::Toleranced& toleranced, const certificate::TolerancedPair& pair, const VariableBox::Values& at,
                     const std::vector<double>& dependents);

struct TolerancedEncounter {
    VariableBox::Values at{};
    std::vector<double> dependents;      ///< the pair's, there
    int element_a = -1, element_b = -1;  ///< -1: none was looked at
    ElementPairDistance pair;            ///< in the world, with the other variables where they start
};

using TolerancedSearchResult = BoxSearchResult<TolerancedEncounter>;

TolerancedSearchResult search_toleranced(const TolerancedBodies& bodies, const BoxSearchOptions& options);

/// The tree of cells that proves `distance` > 0 (certificate.hpp), by the same bounds. Contract: at most what a search has proven.
/// Empty where a stop or the budget ended it.
certificate::BoxProof prove_toleranced(const TolerancedBodies& bodies, double distance, const BoxSearchOptions& options);

}  // namespace fettle::core::clearance
