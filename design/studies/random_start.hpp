// SPDX-License-Identifier: MIT
/// Where runs of an optimiser begin: a design can have several optima, and many starts find more of them than one.
#pragma once

#include <cstdint>
#include <vector>

#include "design/problem/design_problem.hpp"

namespace fettle::design::studies {

/// Seed 0: the design's own values. Any other: every parameter drawn from its bounds, uniformly and independently of the others; the same
/// seed gives the same sample, on any machine.
VectorX sample_of_seed(const description::Design& design, std::uint64_t seed);

/// Where the run of a seed begins: its sample; where that breaks a relation, the nearest point that meets them all; where no mechanism can
/// be made and assembled there (DesignProblem::obstacles), the next sample of the seed. Nothing is simulated. After `most_draws` of them,
/// of shapes that cost much (programs) `most_costly_draws`, the first that meets the relations, else the first.
VectorX start_of_seed(const problem::DesignProblem& problem, std::uint64_t seed);
inline constexpr int most_draws = 64, most_costly_draws = 8;

/// Where the run of a seed searches for the k-th time, k >= 1, when its search before has ended with evaluations to spare: as
/// start_of_seed, of other samples. Every other time, k = 1 the first, a parameter is drawn from a quarter of its bounds, about its own
/// value, since bounds are often far wider than what is meant; of an angle whose bounds go all round, from all of them.
VectorX later_start_of_seed(const problem::DesignProblem& problem, std::uint64_t seed, int k);

/// The seeds of a list of n starts: 0, then 1000 list + k for k = 1, ..., n - 1. Lists of different numbers that have at most 1000 starts
/// share seed 0 alone. Contract: n >= 1.
std::vector<std::uint64_t> seeds_of_list(std::uint64_t list, int n);

}  // namespace fettle::design::studies
