// SPDX-License-Identifier: MIT
/// Random bodies joined as trees, built as scenes are, and where they are for given joint coordinates: in extended precision, from the
/// scene's own numbers, sharing nothing with core/clearance.
#pragma once

#include <catch2/catch.hpp>

#include "core/clearance/range_clearance.hpp"
#include "tests/core/clearance/clearance_oracle.hpp"
#include "tests/support/mechanisms.hpp"

namespace fettle::tests::trees {

using clearance::Real;
using clearance::Real3;
using clearance::Real33;
using core::scene::JointKind;

/// One joint, as it stands in the world at the start. Coordinates are 0 there, but for slides, whose zero is where both points meet.
struct TreeJoint {
    int parent = -1, body = 0;
    JointKind kind = JointKind::revolute;
    Vector3 point = Vector3::Zero(), axis = Vector3::UnitZ();
    double pitch = 0;
    std::array<double, 2> limits{};
};

struct Tree {
    core::scene::Scene scene;
    std::vector<TreeJoint> joints;
    core::model::Model model;
    core::clearance::JointRanges ranges;
    int a = 0, b = 0;  ///< the pair to look at
};

inline std::string joint_name(int k) { return "j" + std::to_string(k); }

/// The value of every joint's coordinate, from the linkage's coordinates `u` (of all of it): by name.
inline double value_of(const Tree& tree, const std::vector<double>& u, const std::string& joint) {
    for (std::size_t k = 0; k < u.size(); ++k)
        for (const auto& each : tree.ranges.linkage.coordinates[k].joints)
            if (each.joint == joint) return each.scale * u[k] + each.offset;
    return 0;
}

/// World positions of a body's vertices.
inline clearance::RealVertices placed_vertices(const Tree& tree, const std::vector<double>& u, int body) {
    const core::model::Body& b = tree.model.bodies[body];
    clearance::RealVertices x =
        (b.pose_start.rotation.cast<Real>() * b.mesh.vertices.cast<Real>()).colwise() + b.pose_start.position.cast<Real>();
    for (int at = body; at >= 0;) {
        int next = -1;
        for (std::size_t k = 0; k < tree.joints.size(); ++k) {
            const TreeJoint& joint = tree.joints[k];
            if (joint.body != at) continue;
            next = joint.parent;
            const std::string name = joint_name(static_cast<int>(k));
            const Real value = value_of(tree, u, name),
                       turn = joint.kind == JointKind::cylindrical ? value_of(tree, u, name + " (turn)") : value;
            const Real3 axis = joint.axis.normalized().cast<Real>(), point = joint.point.cast<Real>();
            const bool turns = joint.kind != JointKind::prismatic && joint.kind != JointKind::fixed;
            const Real slide = joint.kind == JointKind::screw ? value * joint.pitch / (2 * std::numbers::pi_v<Real>)
                               : joint.kind == JointKind::prismatic || joint.kind == JointKind::cylindrical ? value
                                                                                                            : Real(0);
            const Real33 r = turns ? clearance::oracle_rotation(turn * axis) : Real33(Real33::Identity());
            x = (r * (x.colwise() - point)).colwise() + (point + slide * axis);
        }
        at = next;
    }
    return x;
}

inline Real distance_at(const Tree& tree, const std::vector<double>& u) {
    return clearance::oracle_distance(tree.model.bodies[tree.a].mesh, placed_vertices(tree, u, tree.a), tree.model.bodies[tree.b].mesh,
                                      placed_vertices(tree, u, tree.b));
}

inline std::vector<double> random_coordinates(const Tree& tree, std::mt19937& random) {
    std::vector<double> u;
    for (const auto& c : tree.ranges.linkage.coordinates) u.push_back(std::uniform_real_distribution<double>(c.low, c.high)(random));
    return u;
}

inline int pair_coordinates(const Tree& tree) {
    return static_cast<int>(linked_pair(tree.ranges.linkage, tree.a, tree.b).coordinates.size());
}

inline core::scene::Joint scene_joint(const Tree& tree, const TreeJoint& joint, const std::string& name) {
    const auto attachment = [&](int body) {
        core::scene::Attachment out{"", joint.point, joint.axis};
        if (body < 0) return out;
        const core::scene::Body& b = tree.scene.bodies[body];
        out.body = b.name;
        out.point = b.pose.rotation.transpose() * (joint.point - b.pose.position);
        out.axis = b.pose.rotation.transpose() * joint.axis;
        return out;
    };
    core::scene::Joint out = mechanisms::joint(name, joint.kind, attachment(joint.parent), attachment(joint.body));
    out.pitch = joint.pitch;
    if (joint.kind != JointKind::fixed) out.forces.limits = joint.limits;
    return out;
}

inline TreeJoint random_joint(std::mt19937& random, int parent, int body, const Vector3& near) {
    std::uniform_real_distribution<double> u(0, 1);
    const JointKind kinds[] = {JointKind::revolute,  JointKind::revolute, JointKind::revolute, JointKind::revolute,
                               JointKind::prismatic, JointKind::screw,    JointKind::fixed,    JointKind::cylindrical};
    TreeJoint joint{parent, body, kinds[random() % 8], near, clearance::random_vector(random, 1)};
    if (random() % 2 == 0) joint.axis = Vector3::UnitZ();  // parallel axes are the rule in mechanisms
    joint.pitch = 0.02 + 0.05 * u(random);
    const double reach = joint.kind == JointKind::prismatic || joint.kind == JointKind::cylindrical ? 0.08 : 2.5;
    joint.limits = {-reach * u(random), reach * u(random)};
    return joint;
}

/// A post and two to five links of some 0.1 m, in one or two branches from the world, the post where the last link comes near it.
inline Tree random_tree(std::mt19937& random) {
    using clearance::random_vector;
    std::uniform_real_distribution<double> u(0, 1);
    Tree tree;
    const auto add_body = [&](const Vector3& position, double size) {
        core::scene::Body body;
        body.name = "b" + std::to_string(tree.scene.bodies.size());
        body.mesh = random() % 2
                        ? clearance::box(size * Vector3(0.3 + 0.7 * u(random), 0.3 + 0.7 * u(random), 0.2)).mesh
                        : clearance::prism(3 + static_cast<int>(random() % 6), size * (0.3 + 0.5 * u(random)), 2 * size * u(random)).mesh;
        body.pose.position = position;
        body.pose.rotation = core::kinematics::rotation(random_vector(random, 3 * u(random)));
        body.group = 0;
        tree.scene.bodies.push_back(body);
    };
    tree.scene = mechanisms::scene_of({}, 0.01);
    add_body(random_vector(random, 0.12 + 0.3 * u(random)), 0.05);
    tree.scene.bodies[0].type = core::scene::BodyType::static_body;
    const int links = 2 + static_cast<int>(random() % 4);
    std::vector<Vector3> place{tree.scene.bodies[0].pose.position};
    int parent = -1;
    Vector3 at = Vector3::Zero();
    for (int i = 1; i <= links; ++i) {
        if (i > 1 && random() % 4 == 0) {
            parent = static_cast<int>(random() % static_cast<unsigned>(i)) - 1;
            if (parent == 0) parent = -1;
            at = parent < 0 ? Vector3(random_vector(random, 0.1)) : place[parent];
        }
        const Vector3 center = at + random_vector(random, 0.05);
        add_body(center, 0.05);
        tree.joints.push_back(random_joint(random, parent, i, at + random_vector(random, 0.01)));
        tree.scene.mechanism.joints.push_back(scene_joint(tree, tree.joints.back(), joint_name(i - 1)));
        place.push_back(center);
        at = center + random_vector(random, 0.05);
        parent = i;
    }
    std::vector<std::string> turning;
    for (const auto& joint : tree.scene.mechanism.joints)
        if (joint.kind == JointKind::revolute) turning.push_back(joint.name);
    if (turning.size() >= 2 && random() % 3 == 0) {
        core::scene::Joint gear = mechanisms::joint("gear", JointKind::gear, {}, {});
        gear.of = {turning[0], turning[1]};
        gear.ratio = (random() % 2 ? 1 : -1) * (0.3 + u(random));
        tree.scene.mechanism.joints.push_back(gear);
    }
    tree.b = links;
    tree.a = random() % 3 == 0 && links > 2 ? 1 : 0;
    tree.model = mechanisms::built(tree.scene);
    auto ranges = core::clearance::joint_ranges(tree.model);
    REQUIRE(ranges);
    tree.ranges = std::move(ranges).value();
    return tree;
}

}  // namespace fettle::tests::trees
