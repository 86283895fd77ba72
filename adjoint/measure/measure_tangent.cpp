// SPDX-License-Identifier: MIT
#include "adjoint/measure/measure_tangent.hpp"

namespace fettle::adjoint::measure {
namespace {

using core::measure::FrameVector;
using core::measure::Measure;
using core::measure::MeasureSet;
using core::measure::VectorFunction;

// [X; 1] of a point, [A; 0] of an axis, and how it changes.
struct Homogeneous {
    Eigen::Vector4d x, dot;
};

Homogeneous homogeneous(const MeasureSet& set, const FrameVector& v, const PosesAndChanges& at) {
    const auto i = static_cast<std::size_t>(v.frame);
    const core::measure::Frame& frame = set.frames[i];
    Homogeneous out;
    if (v.is_point()) {
        out.x << frame.point, 1;
        out.dot << at.placement_dot[i].point, 0;
    } else {
        out.x << frame.axes.col(v.axis), 0;
        out.dot << at.placement_dot[i].axes.col(v.axis), 0;
    }
    return out;
}

}  // namespace

MeasureTangent measure_tangent(const MeasureSet& set, const Measure& m, const PosesAndChanges& at) {
    const VectorFunction f = vector_function(m, placed(set.frames, at.poses));
    std::array<Homogeneous, 3> x;
    std::array<Vector3, 3> change;
    MeasureTangent out;
    for (int i = 0; i < f.count; ++i) {
        const FrameVector& v = f.vectors[i];
        const int body = set.frames[v.frame].body;
        x[i] = homogeneous(set, v, at);
        if (body == core::measure::world)
            change[i] = x[i].dot.head<3>();
        else
            change[i] = at.poses_dot[body] * x[i].x + pose_matrix(at.poses[body]) * x[i].dot;
        out.value_dot += f.gradient[i].dot(change[i]);
    }
    for (int i = 0; i < f.count; ++i) {
        Vector3 gradient_dot = Vector3::Zero();
        for (int j = 0; j < f.count; ++j) {
            const int k = core::measure::block_number(std::min(i, j), std::max(i, j));
            if (!f.curved[k]) continue;
            gradient_dot += i <= j ? Vector3(f.hessian[k] * change[j]) : Vector3(f.hessian[k].transpose() * change[j]);
        }
        const bool of_b = is_of_b(f.vectors[i], m);
        (of_b ? out.gradient_b : out.gradient_a) += f.gradient[i] * x[i].x.transpose();
        (of_b ? out.gradient_b_dot : out.gradient_a_dot) += gradient_dot * x[i].x.transpose() + f.gradient[i] * x[i].dot.transpose();
    }
    return out;
}

}  // namespace fettle::adjoint::measure
