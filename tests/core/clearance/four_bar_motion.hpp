// SPDX-License-Identifier: MIT
/// A four-bar that a motor turns, below a plate, and where trigonometry has its bars: an oracle that knows nothing of joints.
#pragma once

#include <array>
#include <cmath>

#include "core/stepper/jointed_motion.hpp"
#include "tests/support/mechanisms.hpp"

namespace fettle::tests::four_bar {

inline constexpr double crank = 0.1, coupler = 0.25, rocker = 0.2, ground = 0.3, half = 0.01, plate_height = 0.25;
enum Bodies { crank_body = 0, coupler_body = 1, rocker_body = 2, plate_body = 3 };

/// Place of a bar's file frame in the plane, and how it is turned.
struct Bar {
    double x = 0, y = 0, angle = 0;
};
inline std::array<Bar, 3> bars_at(double angle) {
    const double bx = crank * std::cos(angle), by = crank * std::sin(angle);
    const double dx = ground - bx, dy = -by, distance = std::hypot(dx, dy);
    const double along = std::acos((coupler * coupler + distance * distance - rocker * rocker) / (2 * coupler * distance));
    const double of_coupler = std::atan2(dy, dx) + along;
    const double ex = bx + coupler * std::cos(of_coupler), ey = by + coupler * std::sin(of_coupler);
    return {Bar{0, 0, angle}, Bar{bx, by, of_coupler}, Bar{ground, 0, std::atan2(ey, ex - ground)}};
}

inline core::scene::Scene four_bar_scene(const core::scene::Curve& drive, double h) {
    using core::scene::JointKind;
    const auto bars = bars_at(0);
    const Vector3 z = Vector3::UnitZ(), origin = Vector3::Zero();
    const auto body = [&](const char* name, double length, const Bar& at) {
        return mechanisms::bar(name, length, Vector3(at.x, at.y, 0), Vector3(0, 0, at.angle), half);
    };
    core::scene::Body plate;
    plate.name = "plate";
    plate.where = "a.scene.json#/bodies/plate";
    plate.mesh = support::box_mesh(Vector3(-1, plate_height, -0.1), Vector3(1, plate_height + 0.1, 0.1));
    plate.type = core::scene::BodyType::static_body;
    for (auto& held : plate.prescribed) held = core::scene::MotionCurve{};
    core::scene::Scene out =
        mechanisms::scene_of({body("crank", crank, bars[0]), body("coupler", coupler, bars[1]), body("rocker", rocker, bars[2]), plate}, h);
    out.mechanism.joints = {
        mechanisms::joint("main", JointKind::revolute, {"", origin, z}, {"crank", origin, z}),
        mechanisms::joint("pin", JointKind::revolute, {"crank", Vector3(crank, 0, 0), z}, {"coupler", origin, z}),
        mechanisms::joint("end", JointKind::revolute, {"coupler", Vector3(coupler, 0, 0), z}, {"rocker", Vector3(rocker, 0, 0), z}),
        mechanisms::joint("pivot", JointKind::revolute, {"", Vector3(ground, 0, 0), z}, {"rocker", origin, z})};
    out.mechanism.motors = {mechanisms::motor("drive", "main", drive)};
    return out;
}

/// Where trigonometry has a vertex of a bar.
inline Vector3 vertex_at(const core::model::Model& model, int body, Eigen::Index vertex, double angle) {
    const core::model::Body& b = model.bodies[body];
    const Bar at = bars_at(angle)[body];
    return Vector3(at.x, at.y, 0) + core::kinematics::rotation(Vector3(0, 0, at.angle)) * (b.mesh.vertices.col(vertex) + b.reference_point);
}

/// The plate's lower face less the coupler's highest vertex.
inline double gap_at(const core::model::Model& model, double angle) {
    double highest = -1;
    for (Eigen::Index v = 0; v < model.bodies[coupler_body].mesh.vertices.cols(); ++v)
        highest = std::max(highest, vertex_at(model, coupler_body, v, angle).y());
    return plate_height - highest;
}

/// The least over a turn: the best of many angles, and then by thirds about it.
inline double least_gap(const core::model::Model& model) {
    constexpr int count = 3600;
    double best = 0;
    for (int i = 0; i < count; ++i)
        if (gap_at(model, 2 * M_PI * i / count) < gap_at(model, best)) best = 2 * M_PI * i / count;
    double low = best - 2 * M_PI / count, high = best + 2 * M_PI / count;
    for (int i = 0; i < 200; ++i) {
        const double third = (high - low) / 3;
        (gap_at(model, low + third) < gap_at(model, high - third) ? high : low) =
            gap_at(model, low + third) < gap_at(model, high - third) ? high - third : low + third;
    }
    return gap_at(model, 0.5 * (low + high));
}

}  // namespace fettle::tests::four_bar
