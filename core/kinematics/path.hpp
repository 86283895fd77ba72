// SPDX-License-Identifier: MIT
/// Poses, and the curved path of a body between two of them.
#pragma once

#include <vector>

#include "core/base/types.hpp"
#include "core/kinematics/rotation.hpp"

namespace fettle::core::kinematics {

/// World position of a body point X (relative to the body's reference point c, model/model.hpp) is rotation * X + position.
struct Pose {
    Matrix3 rotation = Matrix3::Identity();
    Vector3 position = Vector3::Zero();  ///< of the reference point [m]
};

inline Vector3 world_position(const Pose& pose, const Vector3& X) { return pose.rotation * X + pose.position; }

/// P = [R q], the 3 x 4 form that the inertia is linear in.
inline Matrix34 pose_matrix(const Pose& pose) {
    Matrix34 p;
    p << pose.rotation, pose.position;
    return p;
}

/// Velocity of the body's point that is at the world position x, where Pdot = [Rdot qdot].
inline Vector3 point_velocity(const Pose& pose, const Matrix34& velocity, const Vector3& x) {
    return velocity.leftCols<3>() * (pose.rotation.transpose() * (x - pose.position)) + velocity.col(3);
}

/// omega of Rdot = [omega] R; of any other Rdot, that of the part of Rdot R^T that is a rotation's. Likewise alpha of the accelerations
/// Rddot = ([alpha] + [omega]^2) R.
inline Vector3 angular_velocity(const Matrix3& rotation, const Matrix34& velocity) {
    const Matrix3 w = velocity.leftCols<3>() * rotation.transpose();
    return 0.5 * Vector3(w(2, 1) - w(1, 2), w(0, 2) - w(2, 0), w(1, 0) - w(0, 1));
}

/// A point of a step's chart: R = exp([rotation_vector]) R_t0, position absolute. Six numbers, position first:
/// the order of degrees of freedom everywhere (px py pz rx ry rz, world axes).
struct ChartPoint {
    Vector3 position = Vector3::Zero();
    Vector3 rotation_vector = Vector3::Zero();
};

/// Straight path in a chart, curved in space, s in [0, 1]:
///   R(s) = exp([rotation_vector_t0 + s rotation_vector_step]) base,   q(s) = position_t0 + s position_step.
struct PathSegment {
    Matrix3 base = Matrix3::Identity();
    Vector3 rotation_vector_t0 = Vector3::Zero();
    Vector3 rotation_vector_step = Vector3::Zero();
    Vector3 position_t0 = Vector3::Zero();
    Vector3 position_step = Vector3::Zero();
};

inline Pose pose_at(const PathSegment& segment, double s) {
    return {rotation(segment.rotation_vector_t0 + s * segment.rotation_vector_step) * segment.base,
            segment.position_t0 + s * segment.position_step};
}

inline PathSegment path_between(const Matrix3& base, const ChartPoint& a, const ChartPoint& b) {
    return {base, a.rotation_vector, b.rotation_vector - a.rotation_vector, a.position, b.position - a.position};
}

/// The part of a segment between s0 and s1, as a segment of its own.
inline PathSegment sub_segment(const PathSegment& p, double s0, double s1) {
    return {p.base, p.rotation_vector_t0 + s0 * p.rotation_vector_step, (s1 - s0) * p.rotation_vector_step,
            p.position_t0 + s0 * p.position_step, (s1 - s0) * p.position_step};
}

}  // namespace fettle::core::kinematics
