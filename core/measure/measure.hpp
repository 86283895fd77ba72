// SPDX-License-Identifier: MIT
/// Scalar functions m(P_a, P_b) of two frames, with derivatives in both bodies' poses and in the frames' placement. Springs, joints, motors
/// and loads know geometry through these alone. docs/method/joints.md#measures.
///   offset    n . (x_b - x_a), n an axis of a, of b or of the world [m]
///   product   u . v, u an axis of a, v of b [1]
///   distance  |x_b - x_a| [m]; contract: > 0 where derivatives are taken
///   angle     from a's x axis to b's, about a's z axis: atan2(y_a . x_b, x_a . x_b) [rad], turns counted by a reference;
///             contract: b's x axis is not along a's z axis
/// Every one is a function f of at most three vectors, each fixed in a body: a frame's point or an axis. With phi the rotation of its body,
/// a vector z moves by dz = dq + phi x z (points, z from the reference point) or phi x z (axes), and all derivatives follow from f's: the
/// gradient as force and arm, the Hessian as J^T f'' J; the curvature of the rotations follows from the arms
/// (kinematics/tangent_system.hpp).
#pragma once

#include <array>
#include <vector>

#include "core/kinematics/tangent_system.hpp"
#include "core/measure/frame.hpp"

namespace fettle::core::measure {

enum class MeasureKind { offset, product, distance, angle };
enum class OffsetAxis { of_a, of_b, of_world };

struct Measure {
    MeasureKind kind = MeasureKind::distance;
    int a = 0, b = 0;                           ///< frames, of different bodies
    int axis_a = 0, axis_b = 0;                 ///< product: which axes; offset: axis_a is which
    OffsetAxis offset_axis = OffsetAxis::of_a;  ///< whose axis an offset is along
};

/// Frames and what is measured between them.
struct MeasureSet {
    std::vector<Frame> frames;
    std::vector<Measure> measures;
};

/// A frame's point (axis -1) or one of its axes.
struct FrameVector {
    int frame = 0;
    int axis = -1;
    bool is_point() const { return axis < 0; }
};

/// The function of the vectors at one place: value, gradient, Hessian. Blocks of the Hessian that are zero are marked so.
struct VectorFunction {
    double value = 0;
    int count = 0;
    std::array<FrameVector, 3> vectors;
    std::array<Vector3, 3> gradient;
    std::array<Matrix3, 6> hessian;  ///< (0,0), (0,1), (0,2), (1,1), (1,2), (2,2)
    std::array<bool, 6> curved{};    ///< which of them are there
    bool is_linear() const {
        for (const bool c : curved)
            if (c) return false;
        return true;
    }
};
/// Number of the block (i, j), i <= j, in the list above.
constexpr int block_number(int i, int j) { return i == 0 ? j : i + j + 1; }

/// Value; of an angle in (-pi, pi].
double value_of(const Measure& measure, const std::vector<PlacedFrame>& frames);

/// The angle that differs from `value` by whole turns and from `reference` by at most half of one.
double nearest_turn(double value, double reference);

/// Value as of value_of, and derivatives.
VectorFunction vector_function(const Measure& measure, const std::vector<PlacedFrame>& frames);

/// What a vector is, from its body's reference point.
inline Vector3 vector_of(const FrameVector& v, const std::vector<PlacedFrame>& frames) {
    const PlacedFrame& f = frames[v.frame];
    return v.is_point() ? f.arm : Vector3(f.axes.col(v.axis));
}

/// Is the vector one of frame b's?
inline bool is_of_b(const FrameVector& v, const Measure& measure) { return v.frame == measure.b; }

/// Gradient in the two bodies' poses, as force and arm.
struct PoseGradients {
    kinematics::PoseGradient a, b;
};
PoseGradients pose_gradients(const Measure& measure, const VectorFunction& f, const std::vector<PlacedFrame>& frames);

/// J^T f'' J in (q, phi) of a, then of b.
Matrix12 gauss_newton_hessian(const Measure& measure, const VectorFunction& f, const std::vector<PlacedFrame>& frames);

/// Derivatives in a frame's placement, entry by entry, in its body's frame: of the axes too, as if they could be anything.
struct FrameGradient {
    Vector3 point = Vector3::Zero();
    Matrix3 axes = Matrix3::Zero();
};

/// Adds weight dm/d(placement) to the gradients of the measure's frames. @param rotations  per frame: R of its body, I of the world.
void add_placement_gradient(const VectorFunction& f, double weight, const std::vector<Matrix3>& rotations,
                            std::vector<FrameGradient>& gradients);

/// Where frames are, and how their bodies are turned.
struct PlacedAndTurned {
    const std::vector<PlacedFrame>& frames;
    const std::vector<Matrix3>& rotations;  ///< per frame, as above
};

/// d(dm . v)/d(poses) along (q, phi) of a, then of b, the motion v held.
/// @param motion  v: (dq, phi) of a, then of b.
Vector12 pose_gradient_of_change(const Measure& measure, const VectorFunction& f, const std::vector<PlacedFrame>& frames,
                                 const Vector12& motion);

/// Adds weight d(dm . v)/d(placement), where dm . v is the measure's change along a motion (dq, phi) of both bodies.
/// @param motion  of a, then of b.
void add_placement_gradient_of_change(const Measure& measure, const VectorFunction& f, double weight, const PlacedAndTurned& at,
                                      const Vector12& motion, std::vector<FrameGradient>& gradients);

}  // namespace fettle::core::measure
