// SPDX-License-Identifier: MIT
// Every certificate of ours is accepted: over generated mechanisms, at tolerances from 1e-3 to 1e-10 of the size, turns of up to 3 rad a
// segment, charts away from their origin, bodies near the origin and 1e4 sizes away from it, pairs far apart, close, touching and passing
// through each other, searches that end early, with and without what else a search can be asked for.
#include <catch2/catch.hpp>

#include "core/base/parallel.hpp"
#include "core/certificate/certificate_checker.hpp"
#include "core/clearance/clearance.hpp"
#include "tests/core/clearance/mechanism_samples.hpp"

namespace fettle::core::certificate::certificate_campaign_test {

using namespace fettle::tests::clearance;
using namespace fettle::core::clearance;
namespace kinematics = fettle::core::kinematics;

namespace {

// A plate or prism that turns on the spot about its axis, just above another: nearly as close all the time, all over.
MovingBodies turntable(std::mt19937& random) {
    const double size = std::pow(10, between(random, -3, 1)), gap = size * std::pow(10, between(random, -6, -1));
    const int steps = 1 + static_cast<int>(random() % 3), n = 4 + static_cast<int>(random() % 9);
    const double tilt = random() % 2 ? 0 : std::pow(10, between(random, -12, -3));
    Solid a = random() % 2 ? prism(n, size, size) : slotted_plate(2 * n, size, 0.3 * size, 0.3 * size, size);
    const auto path = turning_about_z(Vector3::Zero(), 0.3, random() % 2 ? 0 : between(random, -3, 3), steps);
    const Vector3 turn(tilt, -tilt, between(random, -3, 3));
    return {std::move(a), prism(n + 1, size * between(random, 0.2, 1), size), path,
            path_through(std::vector<Vector3>(static_cast<std::size_t>(steps) + 1, Vector3(0, 0, size * (1 + tilt) + gap)),
                         Matrix3::Identity(), std::vector<Vector3>(steps, turn))};
}

// A pin that turns in a bore, next to it somewhere: bodies of many elements.
MovingBodies pin_in_bore(std::mt19937& random) {
    const double size = std::pow(10, between(random, -3, 1)), play = size * std::pow(10, between(random, -4, -1));
    const int n = 30 + static_cast<int>(random() % 40), steps = 1 + static_cast<int>(random() % 2);
    std::vector<Vector3> positions, turns;
    for (int t = 0; t <= steps; ++t) positions.push_back(random_vector(random, 0.7 * play));
    for (int t = 0; t < steps; ++t) turns.push_back(Vector3(0, 0, between(random, -3, 3)) + random_vector(random, 0.1 * play / size));
    return {ring(n, size, 1.2 * size, 0.5 * size), prism(n - 7, size * std::cos(M_PI / n) - play, size),
            turning_about_z(Vector3::Zero(), 0, random() % 2 ? 0 : between(random, -3, 3), steps),
            path_through(positions, Matrix3::Identity(), turns)};
}

// Boxes face to face, or edge to face, with no room at all or next to none, one of them sliding.
MovingBodies touching(std::mt19937& random) {
    const double size = std::pow(10, between(random, -3, 1)), gap = random() % 2 ? 0 : size * std::pow(10, between(random, -16, -5));
    const auto still = turning_about_z(Vector3::Zero(), 0, 0, 2);
    const double turn = random() % 2 ? 0 : between(random, -1, 1);
    return {box(Vector3::Constant(size)), box(Vector3(0.5, 0.3, 0.25) * size), still,
            path_through({Vector3(0, 0, 1.25 * size + gap), Vector3(0.1, 0, 1.25) * size, Vector3(0.1, 0.2, 1.25) * size},
                         Matrix3::Identity(), {Vector3(0, 0, turn), Vector3(0, 0, -turn)})};
}

MovingBodies bodies_of_kind(std::mt19937& random, int kind) {
    const double size = std::pow(10, between(random, -3, 1));
    switch (kind % 16) {
        case 8:
        case 9:
            return turntable(random);
        case 10:
        case 11:
            return passing(random, random_solid(random, size), random_star(random, size), 3);
        case 12:
            return passing(random, random_solid(random, size), random_solid(random, size * between(random, 0.01, 1)), 3);
        case 13:
            return touching(random);
        case 14:
            return pin_in_bore(random);
        case 15:
            return passing(random, ring(20 + static_cast<int>(random() % 60), size, 1.3 * size, size), random_star(random, 2 * size), 3);
        default:
            return sample_mechanism(random, kind % 16).bodies;
    }
}

// Steps of one segment, or of two that meet where the chart is away from its origin.
core::stepper::Trajectory trajectory_of(std::mt19937& random, const MovingBodies& bodies, const Vector3& origin, bool broken, double size) {
    core::stepper::Trajectory trajectory;
    trajectory.timestep = 0.1;
    trajectory.body_names = {"a", "b"};
    const std::array<const std::vector<kinematics::PathSegment>*, 2> paths{&bodies.path_a, &bodies.path_b};
    for (std::size_t t = 0; t < bodies.path_a.size(); ++t) {
        core::stepper::TrajectoryStep step;
        step.nodes.assign(broken ? 3 : 2, std::vector<kinematics::ChartPoint>(2));
        trajectory.poses.emplace_back();
        for (std::size_t b = 0; b < 2; ++b) {
            const kinematics::PathSegment& p = (*paths[b])[t];
            trajectory.poses.back().push_back({p.base, origin + p.position_t0});
            step.nodes.front()[b] = {origin + p.position_t0, p.rotation_vector_t0};
            step.nodes.back()[b] = {origin + p.position_t0 + p.position_step, p.rotation_vector_t0 + p.rotation_vector_step};
            if (!broken) continue;
            const double aside = between(random, 0, 0.5) * p.rotation_vector_step.norm();
            step.nodes[1][b] = {origin + p.position_t0 + 0.5 * p.position_step + random_vector(random, 1e-3 * size),
                                0.5 * p.rotation_vector_step + random_vector(random, aside)};
        }
        trajectory.steps.push_back(step);
    }
    trajectory.poses.push_back(trajectory.poses.back());  // of no consequence for the path
    return trajectory;
}

struct Outcome {
    double size = 0, tolerance = 0, lower = 0, upper = 0;
    bool complete = false, accepted = false;
    long leaves = 0, pieces = 0;
    std::string fault;
};

Outcome examine(int seed) {
    std::mt19937 random(static_cast<unsigned>(seed));
    const MovingBodies bodies = bodies_of_kind(random, seed);
    Outcome outcome;
    outcome.size = bodies.a.radius() + bodies.b.radius();
    outcome.tolerance = outcome.size * std::pow(10, between(random, -10, -3));
    const Vector3 origin = random_vector(random, random() % 3 ? 0 : outcome.size * std::pow(10, between(random, 0, 4)));
    const auto trajectory = trajectory_of(random, bodies, origin, random() % 3 == 0, outcome.size);
    core::model::Model model;
    for (const Solid* solid : {&bodies.a, &bodies.b}) {
        core::model::Body body;
        body.mesh = solid->mesh;
        body.hierarchy = solid->hierarchy;
        model.bodies.push_back(body);
    }
    ClearanceOptions options;
    options.motion = random() % 16 != 0;
    options.tolerance = outcome.tolerance;
    options.max_evaluations = random() % 4 ? 200000 : static_cast<long>(std::pow(10, between(random, 1, 4)));
    options.measure_overlap = false;
    options.sample_nodes = random() % 2;
    options.margin_curve = random() % 8 == 0;
    const double minimum = random() % 3 ? 0 : outcome.size * std::pow(10, between(random, -4, -1));
    if (random() % 2 && minimum > 0) options.enough = minimum;
    const auto [pairs, certificate] = certify_with_proof(model, trajectory, {{0, 1, minimum}}, options);
    const PairClearance& found = pairs.front();
    outcome.lower = found.lower;
    outcome.upper = found.upper;
    outcome.complete = found.complete;
    const CertificateReport report = check_certificate(certificate, model, trajectory);
    outcome.accepted = report.accepted();
    outcome.leaves = report.leaves;
    outcome.pieces = report.pieces;
    if (!report.accepted()) outcome.fault = report.faults[0].where + ": " + report.faults[0].message;
    return outcome;
}

void campaign(int first, int count, int least_proven) {
    std::vector<Outcome> outcomes(count);
    core::base::parallel_for(count, 1, [&](int i) { outcomes[i] = examine(first + i); });
    int proven = 0;
    for (int i = 0; i < count; ++i) {
        const Outcome& o = outcomes[i];
        CAPTURE(first + i, o.size, o.tolerance / o.size, o.lower, o.upper, o.complete, o.leaves, o.pieces, o.fault);
        CHECK(o.accepted);
        CHECK((o.leaves > 0) == (o.lower > 0));
        CHECK(o.pieces <= 16 * o.leaves);  // the checker's bound is about as tight as the search's
        proven += o.lower > 0;
    }
    CHECK(proven >= least_proven);
}

}  // namespace

TEST_CASE("Certificates of a few generated mechanisms are accepted", "[clearance]") { campaign(0, 64, 32); }

TEST_CASE("Certificates of 3,000 generated mechanisms are accepted", "[clearance][slow]") { campaign(1000, 3000, 1500); }

}  // namespace fettle::core::certificate::certificate_campaign_test
