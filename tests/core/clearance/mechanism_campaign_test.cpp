// SPDX-License-Identifier: MIT
// Over generated mechanisms and motions the certified lower bound never exceeds the least of 100,000 samples in extended precision
// (dense_sampling.hpp says how they are taken), the upper bound is attained at its witness, and the certificate is accepted.
#include <catch2/catch.hpp>

#include <atomic>

#include "core/base/parallel.hpp"
#include "core/clearance/pair_search.hpp"
#include "tests/core/clearance/mechanism_samples.hpp"

namespace fettle::core::clearance::mechanism_campaign_test {

using namespace fettle::tests::clearance;

namespace {

struct Outcome {
    std::string name;
    double lower = 0, upper = 0, tolerance = 0, slack = 0;
    double sampled = 0, at_witness = 0;
    long taken = 0;
    bool apart = false;
};

Outcome examine(int seed, int samples) {
    std::mt19937 random(static_cast<unsigned>(seed));
    const SampleMechanism mechanism = sample_mechanism(random, seed);
    const MovingBodies& m = mechanism.bodies;
    const PieceTree a = m.a.search(), b = m.b.search();
    std::vector<PairSegment> segments;
    Outcome outcome;
    outcome.name = mechanism.name;
    for (std::size_t i = 0; i < m.path_a.size(); ++i) {
        segments.push_back(pair_segment(m.path_a[i], m.path_b[i], a.radius(), b.radius()));
        outcome.slack = std::max(outcome.slack, segments.back().slack);
    }
    SearchOptions options;
    options.tolerance = outcome.tolerance = (a.radius() + b.radius()) * 1e-5;
    const SearchResult found = search_pair(a, b, segments, options);
    outcome.lower = found.lower;
    outcome.upper = found.upper;
    outcome.apart = found.lower > 0;
    DenseSampling sampling(m);
    const auto vertices = [](const PieceTree& tree, int element) {
        const PieceElement& e = tree.elements[element];
        std::array<int, 3> v = e.vertices;
        for (int k = e.corners.count; k < 3; ++k) v[k] = v[e.corners.count - 1];
        return v;
    };
    const Encounter& n = found.nearest;
    outcome.at_witness = static_cast<double>(sampling.distance(n.segment, n.s, vertices(a, n.element_a), vertices(b, n.element_b)));
    if (!outcome.apart) return outcome;
    outcome.sampled = static_cast<double>(sampling.least(samples));
    outcome.taken = sampling.taken();
    return outcome;
}

void campaign(int first, int count, int samples, int least_apart) {
    std::vector<Outcome> outcomes(count);
    core::base::parallel_for(count, 1, [&](int i) { outcomes[i] = examine(first + i, samples); });
    int apart = 0;
    for (int i = 0; i < count; ++i) {
        const Outcome& o = outcomes[i];
        CAPTURE(first + i, o.name, o.lower, o.upper, o.sampled, o.at_witness, o.tolerance, o.taken);
        CHECK(o.upper >= o.lower);
        if (!o.apart) continue;
        ++apart;
        CHECK(o.lower <= o.sampled);
        CHECK(o.sampled <= o.upper + o.tolerance);  // or the samples saw little
        CHECK(o.taken >= samples);
        CHECK(std::abs(o.at_witness - o.upper) <= 2 * o.slack);
        CHECK(o.at_witness <= o.upper);
        CHECK(o.upper - o.lower <= o.tolerance + 8 * o.slack);
    }
    CHECK(apart >= least_apart);
}

}  // namespace

TEST_CASE("Bounds of a few generated mechanisms hold against samples in extended precision", "[clearance]") { campaign(0, 16, 1000, 11); }

TEST_CASE("Bounds of 400 generated mechanisms hold against 100,000 samples each", "[clearance][slow]") { campaign(1000, 400, 100000, 300); }

}  // namespace fettle::core::clearance::mechanism_campaign_test
