// SPDX-License-Identifier: MIT
#include "design/studies/random_start.hpp"

#include <algorithm>
#include <optional>

#include "core/base/contract.hpp"
#include "design/optimisers/projection.hpp"
#include "design/problem/buildable.hpp"
#include "design/problem/optimiser_problem.hpp"
#include "design/problem/periodic_parameters.hpp"

namespace fettle::design::studies {

namespace {

// SplitMix64 (Steele, Lea, Flood 2014): unlike the distributions of <random>, the same everywhere.
std::uint64_t next(std::uint64_t& state) {
    state += 0x9e3779b97f4a7c15;
    std::uint64_t z = state;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
    z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
    return z ^ (z >> 31);
}

// In [0, 1), all 53 bits of a double's fraction.
double next_fraction(std::uint64_t& state) { return static_cast<double>(next(state) >> 11) * 0x1p-53; }

// @param share  of each range, about the parameter's value, of one that is periodic all of it; 1: the bounds.
VectorX drawn(const description::Design& design, double share, std::uint64_t& state) {
    VectorX sample(design.parameters.size());
    const std::vector<bool> has_no_ends = share < 1 ? problem::periodic_parameters(design) : std::vector<bool>(sample.size(), true);
    for (Eigen::Index k = 0; k < sample.size(); ++k) {
        const description::Parameter& p = design.parameters[k];
        double lower = p.lower, upper = p.upper;
        if (!has_no_ends[static_cast<size_t>(k)]) {
            const double width = share * (p.upper - p.lower);
            lower = std::clamp(p.value - width / 2, p.lower, p.upper - width);
            upper = std::min(p.upper, lower + width);
        }
        sample[k] = lower + next_fraction(state) * (upper - lower);
    }
    return sample;
}

bool meets_relations(const description::Design& design, const VectorX& p) {
    return std::all_of(design.relations.begin(), design.relations.end(),
                       [&](const description::Relation& relation) { return description::violation(relation, relation.at(p).value) <= 0; });
}

// The nearest point that meets the relations, in numbers that a file can hold.
VectorX onto_relations(const problem::DesignProblem& problem, const VectorX& p) {
    const description::Design& design = problem.design();
    if (meets_relations(design, p)) return p;
    const optimisers::Problem seen = problem::optimiser_problem(problem, {});
    optimisers::CheapConstraints cheap{seen.lower, seen.upper, seen.relation_lower, seen.relation_upper, {}};
    cheap.rows = [&](const VectorX& at) -> std::optional<optimisers::Rows> {
        optimisers::Rows rows = problem.relations(at);
        if (!rows.values.allFinite() || !rows.jacobian.allFinite()) return std::nullopt;
        return rows;
    };
    return seen.representable(optimisers::project(p, cheap)).cwiseMax(seen.lower).cwiseMin(seen.upper);
}

// The first of the draws that follow from a state that meets the relations and can be made and assembled.
VectorX made_start(const problem::DesignProblem& problem, double share, std::uint64_t state) {
    const description::Design& design = problem.design();
    std::optional<VectorX> first, first_related;
    for (int draws = problem::has_costly_shapes(design) ? most_costly_draws : most_draws; draws > 0; --draws) {
        const VectorX p = onto_relations(problem, drawn(design, share, state));
        if (!first) first = p;
        if (!meets_relations(design, p)) continue;
        if (problem.obstacles(p).empty()) return p;
        if (!first_related) first_related = p;
    }
    return first_related ? *first_related : *first;
}

}  // namespace

VectorX sample_of_seed(const description::Design& design, std::uint64_t seed) {
    std::uint64_t state = seed;
    return seed == 0 ? description::values_of(design.parameters) : drawn(design, 1, state);
}

VectorX start_of_seed(const problem::DesignProblem& problem, std::uint64_t seed) {
    if (seed == 0) return description::values_of(problem.design().parameters);
    return made_start(problem, 1, seed);
}

VectorX later_start_of_seed(const problem::DesignProblem& problem, std::uint64_t seed, int k) {
    FETTLE_ASSERT(k >= 1, "start_of_seed is the first");
    std::uint64_t state = seed;
    constexpr double near = 0.25;
    return made_start(problem, k % 2 == 1 ? near : 1, next(state) + static_cast<std::uint64_t>(k));
}

std::vector<std::uint64_t> seeds_of_list(std::uint64_t list, int n) {
    FETTLE_ASSERT(n >= 1, "a list has a start");
    std::vector<std::uint64_t> seeds{0};
    for (int k = 1; k < n; ++k) seeds.push_back(1000 * list + static_cast<std::uint64_t>(k));
    return seeds;
}

}  // namespace fettle::design::studies
