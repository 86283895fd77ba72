// SPDX-License-Identifier: MIT
// Clearance over a box of tolerances and all positions of joints: samples of random trees in extended precision, certificates.
#include "core/clearance/toleranced_clearance.hpp"

#include "core/certificate/certificate_checker.hpp"
#include "core/clearance/clearance.hpp"
#include "tests/core/clearance/random_tolerances.hpp"

namespace fettle::core::clearance::toleranced_clearance_test {

using namespace fettle::tests::tolerances;

namespace {

double in_range(std::mt19937& random, double low, double high) {
    // Corners are where most designs are worst.
    const unsigned which = random() % 4;
    return which == 0 ? low : which == 1 ? high : low + (high - low) * std::uniform_real_distribution<double>(0, 1)(random);
}

struct Samples {
    double least = 1e9;
};

// Everywhere, and near where it was found to be worst.
Samples sampled(const TolerancedTree& tree, const PairClearance& found, std::mt19937& random, int deviations, int positions) {
    Samples out;
    const auto& of = tree.toleranced;
    for (int i = 0; i < deviations; ++i) {
        const bool is_near = i % 2 == 1 && std::isfinite(found.upper);
        std::vector<double> d;
        for (const auto& each : of.deviations) d.push_back(in_range(random, each.lower, each.upper));
        for (std::size_t k = 0; is_near && k < found.deviations.size(); ++k) d[found.deviations[k]] = found.deviations_at[k];
        const RealBodies bodies(tree, d);
        for (int j = 0; j < positions; ++j) {
            std::vector<double> u;
            for (const auto& c : of.coordinates) u.push_back(in_range(random, c.low, c.high));
            for (std::size_t k = 0; is_near && k < found.coordinates.size(); ++k) {
                const auto& c = of.coordinates[found.coordinates[k]];
                const double spread = j % 2 == 0 ? 0.01 : 1e-4;
                u[found.coordinates[k]] = std::clamp(
                    found.at[k] + spread * (c.high - c.low) * std::uniform_real_distribution<double>(-1, 1)(random), c.low, c.high);
            }
            out.least = std::min(out.least, static_cast<double>(bodies.distance(u)));
        }
    }
    return out;
}

// What a budget of `bounds` leaves open is undecided, and as true.
PairClearance certified(const TolerancedTree& tree, double tolerance, long bounds, ProvenClearances* proven = nullptr) {
    ClearanceOptions options;
    options.tolerance = tolerance;
    options.max_bounds = bounds;
    if (proven == nullptr) return certify(tree.tree.model, tree.toleranced, {{tree.a, tree.b}}, options).front();
    *proven = certify_with_proof(tree.tree.model, tree.toleranced, {{tree.a, tree.b}}, options);
    return proven->pairs.front();
}

double size_of(const TolerancedTree& tree) { return tree.tree.model.bodies[tree.a].radius + tree.tree.model.bodies[tree.b].radius; }

void check_samples(int seed, int cases, int deviations, int positions, long bounds) {
    std::mt19937 random(static_cast<unsigned>(seed));
    int apart = 0, complete = 0;
    for (int i = 0; i < cases; ++i) {
        const TolerancedTree tree = random_toleranced_tree(random, i % 2 == 0 ? 1e-3 : 1e-4);
        // To within a hundredth, or a micrometre, of what there is.
        const double near = certified(tree, 1e-2 * size_of(tree), bounds / 10).upper;
        const PairClearance found = certified(tree, std::isfinite(near) ? std::max(1e-6, 5e-3 * near) : 1e-6, bounds);
        INFO("case " << i << " lower " << found.lower << " upper " << found.upper << " bounds " << found.bounds << " coordinates "
                     << found.coordinates.size() << " deviations " << found.deviations.size() << " " << found.reason);
        if (!std::isfinite(found.upper)) {  // more than four coordinates
            CHECK(found.coordinates.size() > 4);
            continue;
        }
        const Samples samples = sampled(tree, found, random, deviations, positions);
        CHECK(samples.least >= found.lower);
        apart += found.lower > 0 ? 1 : 0;
        complete += found.complete ? 1 : 0;
        if (!found.is_clash() && found.lower > 0) {
            std::vector<double> d, u;
            for (const auto& each : tree.toleranced.deviations) d.push_back(each.base);
            for (const auto& each : tree.toleranced.coordinates) u.push_back(each.start);
            for (std::size_t k = 0; k < found.deviations.size(); ++k) d[found.deviations[k]] = found.deviations_at[k];
            for (std::size_t k = 0; k < found.coordinates.size(); ++k) u[found.coordinates[k]] = found.at[k];
            const double there = static_cast<double>(RealBodies(tree, d).distance(u));
            CHECK(there <= found.upper + 1e-11);
            CHECK(there >= found.lower);
            CHECK(std::abs((found.witness.point_a - found.witness.point_b).norm() - found.upper) <= 1e-11);
            const double best = std::min(samples.least, there);
            if (found.complete) CHECK(best - found.lower <= std::max(1e-6, 1e-2 * best));
        }
    }
    INFO("apart " << apart << " complete " << complete << " of " << cases);
    CHECK(2 * complete > cases);
    CHECK(4 * apart > cases);
}

}  // namespace

TEST_CASE("Samples of random trees are never below the bound", "[toleranced]") { check_samples(1, 8, 20, 40, 30'000); }

TEST_CASE("A hundred thousand samples of each of many random trees are never below the bound", "[toleranced][slow]") {
    check_samples(2, 100, 300, 340, 400'000);
}

TEST_CASE("Certificates of random trees within tolerances are accepted", "[toleranced]") {
    std::mt19937 random(11);
    int accepted = 0;
    for (int i = 0; i < 6; ++i) {
        const TolerancedTree tree = random_toleranced_tree(random, 3e-4);
        ProvenClearances proven;
        const PairClearance found = certified(tree, 1e-2 * size_of(tree), 20'000, &proven);
        if (proven.certificate.pairs.empty() || !(found.lower > 0)) continue;
        const auto report = certificate::check_certificate(proven.certificate, tree.tree.model, as_assembled(tree.tree.model));
        INFO("case " << i << " lower " << found.lower << " upper " << found.upper);
        for (const auto& fault : report.faults) UNSCOPED_INFO(fault.where << ": " << fault.message);
        CHECK(report.accepted());
        ++accepted;
    }
    CHECK(accepted >= 2);
}

}  // namespace fettle::core::clearance::toleranced_clearance_test
