// SPDX-License-Identifier: MIT
#include "fettle/design/studies/random_start.hpp"

#include "fettle/core/base/contract.hpp"

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

}  // namespace

VectorX start_of_seed(const description::Design& design, std::uint64_t seed) {
    VectorX start = description::values_of(design.parameters);
    if (seed == 0) return start;
    std::uint64_t state = seed;
    for (Eigen::Index k = 0; k < start.size(); ++k) {
        const description::Parameter& p = design.parameters[k];
        start[k] = p.lower + next_fraction(state) * (p.upper - p.lower);
    }
    return start;
}

std::vector<std::uint64_t> seeds_of_list(std::uint64_t list, int n) {
    FETTLE_ASSERT(n >= 1, "a list has a start");
    std::vector<std::uint64_t> seeds{0};
    for (int k = 1; k < n; ++k) seeds.push_back(1000 * list + static_cast<std::uint64_t>(k));
    return seeds;
}

}  // namespace fettle::design::studies
