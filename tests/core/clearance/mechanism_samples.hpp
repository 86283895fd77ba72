// SPDX-License-Identifier: MIT
/// Generated pairs of mechanism parts with motions of several segments: gears, linkages, pins in slots, random convex and non-convex
/// solids, thin plates, near-parallel faces, codimensional parts. Deterministic for a given generator state.
#pragma once

#include <functional>
#include <string>

#include "tests/core/clearance/dense_sampling.hpp"

namespace fettle::tests::clearance {

struct SampleMechanism {
    std::string name;
    MovingBodies bodies;
};

inline double between(std::mt19937& random, double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); }

/// Prism over a polygon that is star-shaped about the origin, given by its corners in order.
inline Solid star_prism(const std::vector<Vector2>& polygon, double height) {
    const int n = count_of(polygon);
    Matrix3X x(3, 2 * n + 2);
    std::vector<core::geometry::Triangle> triangles;
    for (int i = 0; i < n; ++i) {
        x.col(i) << polygon[i], -height / 2;
        x.col(n + i) << polygon[i], height / 2;
        const int j = (i + 1) % n;
        triangles.push_back({i, j, n + j});
        triangles.push_back({i, n + j, n + i});
        triangles.push_back({2 * n, j, i});
        triangles.push_back({2 * n + 1, n + i, n + j});
    }
    x.col(2 * n) << 0, 0, -height / 2;
    x.col(2 * n + 1) << 0, 0, height / 2;
    return make_solid(x, triangles);
}

/// Trapezoidal teeth; at angle 0 the middle of a tooth.
inline Solid gear(int teeth, double pitch_radius, double height) {
    const double tooth = 2 * M_PI / teeth, depth = pitch_radius * tooth / 3;
    std::vector<Vector2> polygon;
    for (int i = 0; i < teeth; ++i)
        for (const auto& [at, r] : {std::pair{-0.30, pitch_radius - depth},
                                    {-0.12, pitch_radius + 0.8 * depth},
                                    {0.12, pitch_radius + 0.8 * depth},
                                    {0.30, pitch_radius - depth}})
            polygon.push_back(r * Vector2(std::cos((i + at) * tooth), std::sin((i + at) * tooth)));
    return star_prism(polygon, height);
}

/// A plate with a slot of two half circles and two straight sides; the slot along x.
inline Solid slotted_plate(int n, double half_length, double slot_radius, double wall, double height) {
    Matrix3X x(3, 4 * n);
    std::vector<core::geometry::Triangle> triangles;
    for (int i = 0; i < n; ++i) {
        const double angle = 2 * M_PI * (i + 0.5) / n, c = std::cos(angle), s = std::sin(angle), shift = c > 0 ? half_length : -half_length;
        x.col(i) << shift + slot_radius * c, slot_radius * s, -height / 2;
        x.col(n + i) << shift + slot_radius * c, slot_radius * s, height / 2;
        x.col(2 * n + i) << shift + (slot_radius + wall) * c, (slot_radius + wall) * s, -height / 2;
        x.col(3 * n + i) << shift + (slot_radius + wall) * c, (slot_radius + wall) * s, height / 2;
        const int j = (i + 1) % n;
        for (const auto& q : {std::array{i, n + i, n + j, j},
                              {2 * n + i, 2 * n + j, 3 * n + j, 3 * n + i},
                              {n + i, 3 * n + i, 3 * n + j, n + j},
                              {i, j, 2 * n + j, 2 * n + i}}) {
            triangles.push_back({q[0], q[1], q[2]});
            triangles.push_back({q[0], q[2], q[3]});
        }
    }
    return make_solid(x, triangles);
}

inline Solid random_star(std::mt19937& random, double size) {
    std::vector<Vector2> polygon;
    for (int i = 0, n = 5 + static_cast<int>(random() % 12); i < n; ++i)
        polygon.push_back(size * between(random, 0.3, 1) * Vector2(std::cos(2 * M_PI * i / n), std::sin(2 * M_PI * i / n)));
    return star_prism(polygon, size * between(random, 0.2, 1));
}

/// A piece of wire and a few points: no triangle at all, or a solid with such things beside it.
inline Solid codimensional(std::mt19937& random, double size) {
    const int n = 3 + static_cast<int>(random() % 4);
    Solid solid;
    solid.mesh.name = "wire";
    solid.mesh.vertices.resize(3, n + 2);
    for (int i = 0; i < n + 2; ++i) solid.mesh.vertices.col(i) = random_vector(random, size * between(random, 0.2, 1));
    std::vector<core::geometry::Edge> edges;
    for (int i = 0; i + 1 < n && random() % 8; ++i) edges.push_back({i, i + 1});
    core::geometry::build_connectivity(solid.mesh, edges);
    solid.hierarchy = std::make_shared<core::geometry::BodyHierarchy>(solid.mesh);
    return solid;
}

/// A path from poses, one chart per step.
inline std::vector<core::kinematics::PathSegment> path_through(const std::vector<Vector3>& positions, const Matrix3& start,
                                                               const std::vector<Vector3>& turns) {
    std::vector<core::kinematics::PathSegment> path;
    Matrix3 rotation = start;
    for (std::size_t t = 0; t < turns.size(); ++t) {
        core::kinematics::PathSegment p;
        p.base = rotation;
        p.rotation_vector_step = turns[t];
        p.position_t0 = positions[t];
        p.position_step = positions[t + 1] - positions[t];
        path.push_back(p);
        rotation = core::kinematics::orthonormalised(core::kinematics::rotation(turns[t]) * rotation);
    }
    return path;
}

inline std::vector<core::kinematics::PathSegment> turning_about_z(const Vector3& at, double phase, double turn, int steps) {
    return path_through(std::vector<Vector3>(static_cast<std::size_t>(steps) + 1, at), core::kinematics::rotation({0, 0, phase}),
                        std::vector<Vector3>(steps, Vector3(0, 0, turn)));
}

inline MovingBodies gear_pair(std::mt19937& random) {
    const int na = 7 + static_cast<int>(random() % 8), nb = 7 + static_cast<int>(random() % 14), steps = 4 + static_cast<int>(random() % 8);
    const double module = std::pow(10, between(random, -3.3, -1.5)), ra = module * na / 2, rb = module * nb / 2;
    const double turn = between(random, 0.05, 0.4), backlash = between(random, 0.02, 0.3) * module;
    return {gear(na, ra, module * 3), gear(nb, rb, module * 4), turning_about_z(Vector3::Zero(), 0, turn, steps),
            turning_about_z(Vector3(ra + rb + backlash, 0, between(random, -1, 1) * module), M_PI + M_PI / nb, -turn * na / nb, steps)};
}

/// Crank and rocker of a four-bar linkage, bars beside or above each other.
inline MovingBodies linkage_pair(std::mt19937& random) {
    const double ground = between(random, 0.08, 0.12), crank = between(random, 0.02, 0.03), coupler = between(random, 0.08, 0.1),
                 rocker = between(random, 0.05, 0.07), layer = between(random, 0.0052, 0.008);
    const int steps = 6 + static_cast<int>(random() % 8);
    std::vector<double> crank_angle, coupler_angle;
    std::vector<Vector3> middle_crank, middle_coupler;
    for (int t = 0; t <= steps; ++t) {
        const double a = 2 * M_PI * t / steps;
        const Vector3 pin(crank * std::cos(a), crank * std::sin(a), 0), pivot(ground, 0, 0);
        const Vector3 to_pivot = pivot - pin;
        const double l = to_pivot.norm(), c = (coupler * coupler + l * l - rocker * rocker) / (2 * coupler * l);
        const double angle = std::atan2(to_pivot.y(), to_pivot.x()) + std::acos(std::min(1.0, std::max(-1.0, c)));
        crank_angle.push_back(a);
        coupler_angle.push_back(angle);
        middle_crank.push_back(0.5 * pin);
        middle_coupler.push_back(pin + 0.5 * coupler * Vector3(std::cos(angle), std::sin(angle), 0) + Vector3(0, 0, layer));
    }
    const auto bar = [&](double length) { return box({length / 2 + 0.004, 0.004, 0.0025}); };
    const auto path = [&](const std::vector<Vector3>& at, const std::vector<double>& angle) {
        std::vector<Vector3> turns;
        for (int t = 0; t < steps; ++t) turns.emplace_back(0, 0, angle[t + 1] - angle[t]);
        return path_through(at, core::kinematics::rotation({0, 0, angle[0]}), turns);
    };
    return {bar(crank), bar(coupler), path(middle_crank, crank_angle), path(middle_coupler, coupler_angle)};
}

inline MovingBodies pin_in_slot(std::mt19937& random) {
    const double radius = std::pow(10, between(random, -3, -1)), play = radius * std::pow(10, between(random, -2.5, -0.7)),
                 half = 3 * radius;
    const int n = 8 + 2 * static_cast<int>(random() % 8), steps = 4 + static_cast<int>(random() % 6);
    std::vector<Vector3> positions;
    for (int t = 0; t <= steps; ++t)
        positions.emplace_back(half * 0.9 * std::sin(2 * M_PI * t / steps), 0.3 * play * std::cos(5.0 * t), 0.2 * radius * t / steps);
    const std::vector<Vector3> turns(steps, Vector3(0, 0, between(random, -0.5, 0.5)));
    return {slotted_plate(n, half, radius + play, radius, radius), prism(n, radius * std::cos(M_PI / n), 3 * radius),
            turning_about_z(Vector3::Zero(), 0, between(random, -0.002, 0.002), steps),
            path_through(positions, Matrix3::Identity(), turns)};
}

/// Two solids that pass each other, turning all the way.
inline MovingBodies passing(std::mt19937& random, Solid a, Solid b, double turn) {
    const double reach = a.radius() + b.radius();
    const int steps = 2 + static_cast<int>(random() % 4);
    const Vector3 away = random_vector(random, reach * between(random, 0.6, 1.1)),
                  along = away.cross(random_vector(random, 1)).normalized() * reach;
    const auto wander = [&](const Vector3& from, const Vector3& to) {
        std::vector<Vector3> positions, turns;
        for (int t = 0; t <= steps; ++t)
            positions.push_back(from + (to - from) * t / steps + random_vector(random, 0.05 * reach * between(random, 0, 1)));
        for (int t = 0; t < steps; ++t)
            turns.push_back(random() % 6 ? random_vector(random, turn * between(random, 0, 1)) : Vector3(0, 0, 0));
        return path_through(positions, core::kinematics::rotation(random_vector(random, 2)), turns);
    };
    const auto path_a = wander(Vector3::Zero(), Vector3::Zero()), path_b = wander(away - along, away + along);
    return {std::move(a), std::move(b), path_a, path_b};
}

inline MovingBodies near_parallel(std::mt19937& random) {
    const double size = std::pow(10, between(random, -2.5, 0)), tilt = random() % 4 ? std::pow(10, between(random, -10, -2)) : 0;
    const double gap = size * std::pow(10, between(random, -4, -1));
    const int steps = 2 + static_cast<int>(random() % 3);
    std::vector<Vector3> positions, turns;
    for (int t = 0; t <= steps; ++t)
        positions.emplace_back(size * (0.4 * t / steps - 0.2), size * between(random, -0.2, 0.2), size * (0.8 + tilt * 2) + gap);
    for (int t = 0; t < steps; ++t)
        turns.emplace_back(tilt * between(random, -0.3, 0.3), tilt * between(random, -0.3, 0.3), between(random, -0.5, 0.5));
    return {box(size * Vector3(1, 1.2, 0.5)), box(size * Vector3(0.5, 0.6, 0.3)), turning_about_z(Vector3::Zero(), 0, 0, steps),
            path_through(positions, core::kinematics::rotation({tilt, -0.5 * tilt, 0.3}), turns)};
}

inline SampleMechanism sample_mechanism(std::mt19937& random, int kind) {
    const double size = std::pow(10, between(random, -3, 0.5));
    const auto convex = [&] {
        return random() % 2 ? prism(3 + static_cast<int>(random() % 6), size * between(random, 0.3, 1), size) : tetrahedron(random, size);
    };
    const auto plate = [&] { return box(size * Vector3(1, between(random, 0.3, 1), std::pow(10, between(random, -4, -1.5)))); };
    switch (kind % 8) {
        case 0:
            return {"gears", gear_pair(random)};
        case 1:
            return {"linkage", linkage_pair(random)};
        case 2:
            return {"pin in slot", pin_in_slot(random)};
        case 3:
            return {"convex", passing(random, convex(), convex(), 1.5)};
        case 4:
            return {"non-convex", passing(random, random_star(random, size), random_star(random, size), 1.5)};
        case 5:
            return {"thin plates", passing(random, plate(), plate(), 0.8)};
        case 6:
            return {"near-parallel", near_parallel(random)};
        default:
            return {"codimensional", passing(random, codimensional(random, size),
                                             random() % 2 ? codimensional(random, size) : random_solid(random, size), 1)};
    }
}

}  // namespace fettle::tests::clearance
