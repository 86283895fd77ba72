// SPDX-License-Identifier: MIT
/// A small moving pair with its certificate, for the tests of certificates.
#pragma once

#include <span>

#include "core/clearance/clearance.hpp"
#include "tests/core/clearance/clearance_oracle.hpp"

namespace fettle::tests::certificate {

using namespace tests::clearance;

struct Case {
    core::model::Model model;
    core::stepper::Trajectory trajectory;
    core::certificate::Certificate certificate;
    std::vector<core::clearance::PairClearance> results;
};

inline double uniform(std::mt19937& random, double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); }

// The leaves of a proof over boxes of k coordinates: where each stands in `splits`, and which of the vectors are its.
struct LeafPlace {
    std::size_t at = 0, first = 0, count = 0;
};
inline std::vector<LeafPlace> leaves_of(const core::certificate::BoxProof& proof, std::size_t k) {
    std::vector<LeafPlace> leaves;
    std::size_t used = 0;
    for (std::size_t at = 0; at < proof.splits.size(); ++at) {
        const char kind = proof.splits[at];
        if (kind != '.' && kind != ':') continue;
        leaves.push_back({at, used, kind == '.' ? 1 : std::size_t{1} << k});
        used += leaves.back().count;
    }
    return leaves;
}
inline std::span<Vector3> normals_of(core::certificate::BoxProof& proof, const LeafPlace& leaf) {
    return std::span(proof.normals).subspan(leaf.first, leaf.count);
}

// Two solids side by side, wandering and turning for a few steps of one or two segments.
inline Case random_case(std::mt19937& random, double size, int steps, double tolerance) {
    Case c;
    const std::array<Solid, 2> solids{random_solid(random, size), random_solid(random, size)};
    const double apart = solids[0].radius() + solids[1].radius() + size * uniform(random, 0.1, 0.5);
    c.trajectory.timestep = 0.1;
    c.trajectory.poses.resize(1);
    for (int b = 0; b < 2; ++b) {
        core::model::Body body;
        body.name = "body " + std::to_string(b);
        body.mesh = solids[b].mesh;
        body.hierarchy = solids[b].hierarchy;
        c.model.bodies.push_back(body);
        c.trajectory.body_names.push_back(body.name);
        c.trajectory.poses[0].push_back({core::kinematics::rotation(random_vector(random, 2)), Vector3(b * apart, 0, 0)});
    }
    for (int t = 0; t < steps; ++t) {
        core::stepper::TrajectoryStep step;
        const auto from = c.trajectory.poses.back();
        step.nodes.push_back({{from[0].position, Vector3::Zero()}, {from[1].position, Vector3::Zero()}});
        for (int k = 0, segments = 1 + static_cast<int>(random() % 2); k < segments; ++k) {
            auto next = step.nodes.back();
            for (int b = 0; b < 2; ++b) {
                next[b].position += random_vector(random, 0.1 * size * uniform(random, 0, 1));
                next[b].rotation_vector += random_vector(random, random() % 4 == 0 ? 0 : uniform(random, 0, 0.8));
            }
            step.nodes.push_back(next);
        }
        c.trajectory.poses.emplace_back();
        for (int b = 0; b < 2; ++b)
            c.trajectory.poses.back().push_back(
                {core::kinematics::rotation(step.nodes.back()[b].rotation_vector) * from[b].rotation, step.nodes.back()[b].position});
        c.trajectory.steps.push_back(step);
    }
    core::clearance::ClearanceOptions options;
    options.motion = true;
    options.tolerance = tolerance;
    auto proven = certify_with_proof(c.model, c.trajectory, {{0, 1, 0}}, options);
    c.results = std::move(proven.pairs);
    c.certificate = std::move(proven.certificate);
    return c;
}

}  // namespace fettle::tests::certificate
