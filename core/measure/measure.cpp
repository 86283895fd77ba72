// SPDX-License-Identifier: MIT
#include "core/measure/measure.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fettle::core::measure {
namespace {

using Frames = std::vector<PlacedFrame>;

const PlacedFrame& frame(const Frames& frames, int i) { return frames[i]; }

Vector3 difference(const Measure& m, const Frames& frames) { return frame(frames, m.b).point - frame(frames, m.a).point; }

Vector3 offset_axis(const Measure& m, const Frames& frames) {
    if (m.offset_axis == OffsetAxis::of_world) return Vector3::Unit(m.axis_a);
    return frame(frames, m.offset_axis == OffsetAxis::of_a ? m.a : m.b).axes.col(m.axis_a);
}

void set_block(VectorFunction& f, int i, int j, const Matrix3& block) {
    const auto k = static_cast<std::size_t>(block_number(i, j));
    f.hessian[k] = block;
    f.curved[k] = true;
}

VectorFunction offset_function(const Measure& m, const Frames& frames) {
    VectorFunction f;
    const Vector3 n = offset_axis(m, frames), d = difference(m, frames);
    f.value = n.dot(d);
    f.count = 2;
    f.vectors[0] = {m.a, -1};
    f.vectors[1] = {m.b, -1};
    f.gradient[0] = -n;
    f.gradient[1] = n;
    if (m.offset_axis == OffsetAxis::of_world) return f;
    f.count = 3;
    f.vectors[2] = {m.offset_axis == OffsetAxis::of_a ? m.a : m.b, m.axis_a};
    f.gradient[2] = d;
    set_block(f, 0, 2, -Matrix3::Identity());
    set_block(f, 1, 2, Matrix3::Identity());
    return f;
}

VectorFunction product_function(const Measure& m, const Frames& frames) {
    VectorFunction f;
    const Vector3 u = frame(frames, m.a).axes.col(m.axis_a), v = frame(frames, m.b).axes.col(m.axis_b);
    f.value = u.dot(v);
    f.count = 2;
    f.vectors[0] = {m.a, m.axis_a};
    f.vectors[1] = {m.b, m.axis_b};
    f.gradient[0] = v;
    f.gradient[1] = u;
    set_block(f, 0, 1, Matrix3::Identity());
    return f;
}

VectorFunction distance_function(const Measure& m, const Frames& frames) {
    VectorFunction f;
    const Vector3 d = difference(m, frames);
    f.value = d.norm();
    const Vector3 n = d / f.value;  // at 0 no number: what is solved with it is told as not solved
    f.count = 2;
    f.vectors[0] = {m.a, -1};
    f.vectors[1] = {m.b, -1};
    f.gradient[0] = -n;
    f.gradient[1] = n;
    const Matrix3 across = (Matrix3::Identity() - n * n.transpose()) / f.value;
    set_block(f, 0, 0, across);
    set_block(f, 0, 1, -across);
    set_block(f, 1, 1, across);
    return f;
}

// atan2(s, c) of c = x . w, s = y . w, x and y the axes of a, w the x axis of b.
VectorFunction angle_function(const Measure& m, const Frames& frames) {
    VectorFunction f;
    const Vector3 x = frame(frames, m.a).axes.col(0), y = frame(frames, m.a).axes.col(1), w = frame(frames, m.b).axes.col(0);
    const double c = x.dot(w), s = y.dot(w), square = c * c + s * s;
    // b's x axis along a's z axis: no number, as above.
    f.value = std::atan2(s, c);
    f.count = 3;
    f.vectors[0] = {m.a, 0};
    f.vectors[1] = {m.a, 1};
    f.vectors[2] = {m.b, 0};
    const double by_c = -s / square, by_s = c / square;
    const double cc = 2 * c * s / (square * square), cs = (s * s - c * c) / (square * square);
    f.gradient[0] = by_c * w;
    f.gradient[1] = by_s * w;
    f.gradient[2] = by_c * x + by_s * y;
    const Matrix3 ww = w * w.transpose();
    const Vector3 along_c = cc * x + cs * y, along_s = cs * x - cc * y;
    set_block(f, 0, 0, cc * ww);
    set_block(f, 0, 1, cs * ww);
    set_block(f, 1, 1, -cc * ww);
    set_block(f, 0, 2, by_c * Matrix3::Identity() + w * along_c.transpose());
    set_block(f, 1, 2, by_s * Matrix3::Identity() + w * along_s.transpose());
    set_block(f, 2, 2, x * along_c.transpose() + y * along_s.transpose());
    return f;
}

// [z] M: the cross product of z with each column.
Matrix3 cross_columns(const Vector3& z, const Matrix3& m) {
    Matrix3 out;
    for (int k = 0; k < 3; ++k) out.col(k) = z.cross(m.col(k));
    return out;
}

// Adds J_i^T M J_j, with J = [I, -[z]] of points and [0, -[z]] of axes.
void add_pulled_back(const Matrix3& m, const Vector3& zi, const Vector3& zj, bool point_i, bool point_j, Eigen::Ref<Matrix6> block) {
    // -M [z] = ([z] M^T)^T.
    const Matrix3 right = cross_columns(zj, m.transpose()).transpose();
    if (point_i && point_j) block.topLeftCorner<3, 3>() += m;
    if (point_i) block.topRightCorner<3, 3>() += right;
    if (point_j) block.bottomLeftCorner<3, 3>() += cross_columns(zi, m);
    block.bottomRightCorner<3, 3>() += cross_columns(zi, right);
}

// How the vectors of a measure move along (dq, phi) of its bodies.
Vector3 change_of(const Measure& m, const FrameVector& v, const Frames& frames, const Vector12& motion) {
    const int at = is_of_b(v, m) ? 6 : 0;
    const Vector3 turned = motion.segment<3>(at + 3).cross(vector_of(v, frames));
    return v.is_point() ? Vector3(turned + motion.segment<3>(at)) : turned;
}

void add_to(const FrameVector& v, const Vector3& bar, std::vector<FrameGradient>& gradients) {
    FrameGradient& g = gradients[v.frame];
    if (v.is_point())
        g.point += bar;
    else
        g.axes.col(v.axis) += bar;
}

// f'' times the changes of all vectors, of vector i.
Vector3 times_hessian(const VectorFunction& f, int i, const std::array<Vector3, 3>& changes) {
    Vector3 sum = Vector3::Zero();
    for (int j = 0; j < f.count; ++j) {
        const auto k = static_cast<std::size_t>(block_number(std::min(i, j), std::max(i, j)));
        if (!f.curved[k]) continue;
        sum += i <= j ? Vector3(f.hessian[k] * changes[j]) : Vector3(f.hessian[k].transpose() * changes[j]);
    }
    return sum;
}

}  // namespace

double value_of(const Measure& m, const Frames& frames) {
    switch (m.kind) {
        case MeasureKind::offset:
            return offset_axis(m, frames).dot(difference(m, frames));
        case MeasureKind::product:
            return frame(frames, m.a).axes.col(m.axis_a).dot(frame(frames, m.b).axes.col(m.axis_b));
        case MeasureKind::distance:
            return difference(m, frames).norm();
        case MeasureKind::angle:
            break;
    }
    const Vector3 w = frame(frames, m.b).axes.col(0);
    return std::atan2(frame(frames, m.a).axes.col(1).dot(w), frame(frames, m.a).axes.col(0).dot(w));
}

double nearest_turn(double value, double reference) {
    return value + 2 * std::numbers::pi * std::round((reference - value) / (2 * std::numbers::pi));
}

VectorFunction vector_function(const Measure& m, const Frames& frames) {
    switch (m.kind) {
        case MeasureKind::offset:
            return offset_function(m, frames);
        case MeasureKind::product:
            return product_function(m, frames);
        case MeasureKind::distance:
            return distance_function(m, frames);
        case MeasureKind::angle:
            break;
    }
    return angle_function(m, frames);
}

PoseGradients pose_gradients(const Measure& m, const VectorFunction& f, const Frames& frames) {
    PoseGradients out;
    for (int i = 0; i < f.count; ++i) {
        const auto at = static_cast<std::size_t>(i);
        const FrameVector& v = f.vectors[at];
        kinematics::PoseGradient& side = is_of_b(v, m) ? out.b : out.a;
        if (v.is_point()) side.force += f.gradient[at];
        side.arm += f.gradient[at] * vector_of(v, frames).transpose();
    }
    return out;
}

Matrix12 gauss_newton_hessian(const Measure& m, const VectorFunction& f, const Frames& frames) {
    Matrix12 out = Matrix12::Zero();
    for (int i = 0; i < f.count; ++i)
        for (int j = i; j < f.count; ++j) {
            const auto k = static_cast<std::size_t>(block_number(i, j));
            if (!f.curved[k]) continue;
            const FrameVector &vi = f.vectors[i], &vj = f.vectors[j];
            Matrix6 block = Matrix6::Zero();
            add_pulled_back(f.hessian[k], vector_of(vi, frames), vector_of(vj, frames), vi.is_point(), vj.is_point(), block);
            const int row = is_of_b(vi, m) ? 6 : 0, column = is_of_b(vj, m) ? 6 : 0;
            out.block<6, 6>(row, column) += block;
            if (i != j) out.block<6, 6>(column, row) += block.transpose();
        }
    return out;
}

void add_placement_gradient(const VectorFunction& f, double weight, const std::vector<Matrix3>& rotations,
                            std::vector<FrameGradient>& gradients) {
    for (int i = 0; i < f.count; ++i) {
        const auto at = static_cast<std::size_t>(i);
        const FrameVector& v = f.vectors[at];
        add_to(v, weight * (rotations[v.frame].transpose() * f.gradient[at]), gradients);
    }
}

// d(f_z . dz) = (f'' dz + f_z x phi) . (psi x z) + (f'' dz) . dq.
Vector12 pose_gradient_of_change(const Measure& m, const VectorFunction& f, const Frames& frames, const Vector12& motion) {
    std::array<Vector3, 3> changes;
    for (int i = 0; i < f.count; ++i) changes[i] = change_of(m, f.vectors[i], frames, motion);
    Vector12 out = Vector12::Zero();
    for (int i = 0; i < f.count; ++i) {
        const auto k = static_cast<std::size_t>(i);
        const FrameVector& v = f.vectors[k];
        const int at = is_of_b(v, m) ? 6 : 0;
        const Vector3 force = times_hessian(f, i, changes), bar = force + f.gradient[k].cross(motion.segment<3>(at + 3));
        if (v.is_point()) out.segment<3>(at) += force;
        out.segment<3>(at + 3) += vector_of(v, frames).cross(bar);
    }
    return out;
}

// With z = R X: d(f_z . dz)/dX = R^T (f'' dz + f_z x phi), for dz holds phi x z.
void add_placement_gradient_of_change(const Measure& m, const VectorFunction& f, double weight, const PlacedAndTurned& at,
                                      const Vector12& motion, std::vector<FrameGradient>& gradients) {
    std::array<Vector3, 3> changes;
    for (int i = 0; i < f.count; ++i) changes[i] = change_of(m, f.vectors[i], at.frames, motion);
    for (int i = 0; i < f.count; ++i) {
        const auto k = static_cast<std::size_t>(i);
        const FrameVector& v = f.vectors[k];
        const Vector3 phi = motion.segment<3>(is_of_b(v, m) ? 9 : 3);
        const Vector3 bar = times_hessian(f, i, changes) + f.gradient[k].cross(phi);
        add_to(v, weight * (at.rotations[v.frame].transpose() * bar), gradients);
    }
}

}  // namespace fettle::core::measure
