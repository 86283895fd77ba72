// SPDX-License-Identifier: MIT
// What does it cost to certify a clearance, as the tolerance falls? Prints JSON. Cases: pins in bores with play over a turn (contact-like,
// flat in time), discs of many triangles turning past each other. Each answer is checked against sampled distances before its time counts.
#include <chrono>
#include <cstdio>
#include <string>

#include "fettle/tests/core/clearance/clearance_oracle.hpp"

using namespace fettle;
using namespace fettle::tests::clearance;
using namespace fettle::core::clearance;

namespace {

struct Case {
    std::string name;
    Solid a, b;
    std::vector<core::kinematics::PathSegment> path_a, path_b;
};

// b turns about z by `turns`, its center on a circle of the given radius; a stays.
Case turning(std::string name, Solid a, Solid b, const Vector3& at, double orbit, int steps) {
    Case c{std::move(name), std::move(a), std::move(b), {}, {}};
    const double angle = 2 * M_PI / steps;
    for (int t = 0; t < steps; ++t) {
        const auto place = [&](int k) -> Vector3 { return at + orbit * Vector3(std::cos(k * angle), std::sin(k * angle), 0); };
        core::kinematics::PathSegment p;
        p.base = core::kinematics::rotation(Vector3(0, 0, t * angle));
        p.rotation_vector_step << 0, 0, angle;
        p.position_t0 = place(t);
        p.position_step = place(t + 1) - place(t);
        c.path_b.push_back(p);
        c.path_a.emplace_back();
    }
    return c;
}

bool agrees_with_samples(const Case& c, const SearchResult& result) {
    const std::size_t t = static_cast<std::size_t>(result.witness.step);
    const MovingPair pair{c.a, c.b, c.path_a[t], c.path_b[t]};
    return result.lower <= sampled_minimum(pair, 4, 1) && std::abs(result.upper - pair.distance_at(result.witness.s)) < 1e-12;
}

}  // namespace

int main() {
    std::vector<Case> cases;
    cases.push_back(turning("pin_in_bore_200_steps", ring(32, 0.0053, 0.01, 0.012), prism(32, 0.005, 0.02), Vector3::Zero(), 2e-4, 200));
    cases.push_back(turning("disc_beside_wall_200_steps", box({0.05, 0.05, 0.005}), prism(64, 0.03, 0.01), {0, 0, 0.0105}, 0, 200));
    cases.push_back(turning("ring_in_ring_1000_triangles_200_steps", ring(128, 0.05, 0.06, 0.02), ring(128, 0.03, 0.0495, 0.02),
                            Vector3::Zero(), 2e-4, 200));
    cases.push_back(turning("far_apart_200_steps", ring(128, 0.05, 0.06, 0.02), ring(128, 0.03, 0.0495, 0.02), {0.3, 0, 0}, 0.01, 200));
    bool first = true;
    std::printf("[");
    for (std::size_t i = 0; i < cases.size(); ++i) {
        const Case& c = cases[i];
        std::vector<PairSegment> segments;
        for (std::size_t t = 0; t < c.path_a.size(); ++t) {
            segments.push_back(pair_segment(c.path_a[t], c.path_b[t], c.a.radius(), c.b.radius()));
            segments.back().step = static_cast<int>(t);
        }
        for (const double tolerance : {1e-5, 1e-6, 1e-9}) {
            SearchOptions options;
            options.tolerance = tolerance;
            const auto start = std::chrono::steady_clock::now();
            const SearchResult result = search_pair(c.a.search(), c.b.search(), segments, options);
            const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
            std::printf(
                "%s\n  {\"case\": \"%s\", \"tolerance\": %g, \"seconds\": %.4f, \"evaluations\": %ld, \"lower\": %.9g, \"upper\": %.9g, "
                "\"agrees\": %s}",
                first ? "" : ",", c.name.c_str(), tolerance, seconds, result.evaluations, result.lower, result.upper,
                agrees_with_samples(c, result) ? "true" : "false");
            first = false;
            std::fflush(stdout);
        }
    }
    std::printf("\n]\n");
}
