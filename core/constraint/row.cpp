// SPDX-License-Identifier: MIT
#include "core/constraint/row.hpp"

#include <algorithm>

namespace fettle::core::constraint {
namespace {

using measure::Measure;
using measure::MeasureKind;
using measure::MeasureSet;
using measure::PlacedFrame;

const Measure& measure_of(const MeasureSet& set, int i) { return set.measures[i]; }

int body_of(const MeasureSet& set, int frame) { return set.frames[frame].body; }

void add_entry(int body, const Vector6& gradient, std::size_t first, std::vector<RowGradient>& entries) {
    if (body == measure::world) return;
    const auto begin = entries.begin() + static_cast<std::ptrdiff_t>(first);
    const auto at = std::lower_bound(begin, entries.end(), body, [](const RowGradient& e, int wanted) { return e.body < wanted; });
    if (at != entries.end() && at->body == body)
        at->gradient += gradient;
    else
        entries.insert(at, {body, gradient});
}

// Second derivatives of a sum of weighted measures, in tangent coordinates but for the rotations' curvature, which follows from `arms`.
struct Curvature {
    std::vector<Matrix6> diagonal;
    std::vector<Matrix3> arms;
    std::vector<bool> touched;
    std::vector<kinematics::OffDiagonalBlock> blocks;

    explicit Curvature(std::size_t bodies) : diagonal(bodies, Matrix6::Zero()), arms(bodies, Matrix3::Zero()), touched(bodies, false) {}

    void add(const MeasureSet& set, const Measure& m, double weight, const std::vector<PlacedFrame>& frames) {
        const measure::VectorFunction f = vector_function(m, frames);
        const measure::PoseGradients g = pose_gradients(m, f, frames);
        const int a = body_of(set, m.a), b = body_of(set, m.b);
        Matrix12 h = Matrix12::Zero();
        if (!f.is_linear()) h = weight * gauss_newton_hessian(m, f, frames);
        add_body(a, h.topLeftCorner<6, 6>(), weight * g.a.arm);
        add_body(b, h.bottomRightCorner<6, 6>(), weight * g.b.arm);
        if (a == measure::world || b == measure::world) return;
        if (a < b)
            add_block(a, b, h.topRightCorner<6, 6>());
        else
            add_block(b, a, h.bottomLeftCorner<6, 6>());
    }

    // Rows of one joint follow one another.
    void add_block(int a, int b, const Matrix6& block) {
        if (!blocks.empty() && blocks.back().a == a && blocks.back().b == b)
            blocks.back().block += block;
        else
            blocks.push_back({a, b, block});
    }

    void add_body(int body, const Matrix6& block, const Matrix3& arm) {
        if (body == measure::world) return;
        const auto i = static_cast<std::size_t>(body);
        diagonal[i] += block;
        arms[i] += arm;
        touched[i] = true;
    }
};

// A row of several measures couples all their bodies.
void add_row_pattern(const MeasureSet& set, const Row& row, std::vector<kinematics::OffDiagonalBlock>& blocks) {
    if (row.parts.size() < 2) return;
    std::vector<int> bodies;
    for (const RowPart& part : row.parts)
        for (const int frame : {measure_of(set, part.measure).a, measure_of(set, part.measure).b})
            if (body_of(set, frame) != measure::world) bodies.push_back(body_of(set, frame));
    std::sort(bodies.begin(), bodies.end());
    bodies.erase(std::unique(bodies.begin(), bodies.end()), bodies.end());
    for (std::size_t i = 0; i < bodies.size(); ++i)
        for (std::size_t j = i + 1; j < bodies.size(); ++j) blocks.push_back({bodies[i], bodies[j], Matrix6::Zero()});
}

}  // namespace

double target_at(const Row& row, double time) { return row.constant + curve_value(row.curve, time); }

std::vector<double> angles_at(const MeasureSet& set, const std::vector<kinematics::Pose>& poses, const std::vector<double>& before) {
    std::vector<double> out(set.measures.size(), 0.0);
    const bool any = std::any_of(set.measures.begin(), set.measures.end(), [](const Measure& m) { return m.kind == MeasureKind::angle; });
    if (!any) return out;
    const std::vector<PlacedFrame> frames = placed(set.frames, poses);
    for (std::size_t i = 0; i < out.size(); ++i) {
        if (set.measures[i].kind != MeasureKind::angle) continue;
        const double value = value_of(set.measures[i], frames);
        out[i] = before.empty() ? value : measure::nearest_turn(value, before[i]);
    }
    return out;
}

double value_at(const MeasureSet& set, int measure, const std::vector<PlacedFrame>& frames, const std::vector<double>& angles) {
    const Measure& m = measure_of(set, measure);
    const double value = value_of(m, frames);
    return m.kind == MeasureKind::angle ? measure::nearest_turn(value, angles[measure]) : value;
}

VectorX row_values(const MeasureSet& set, const std::vector<Row>& rows, const std::vector<PlacedFrame>& frames,
                   const std::vector<double>& angles) {
    VectorX out = VectorX::Zero(rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i)
        for (const RowPart& part : rows[i].parts) out[i] += part.factor * value_at(set, part.measure, frames, angles);
    return out;
}

RowJacobian row_jacobian(const MeasureSet& set, const std::vector<Row>& rows, const std::vector<PlacedFrame>& frames) {
    RowJacobian out;
    out.first.reserve(rows.size() + 1);
    out.entries.reserve(2 * rows.size());
    for (const Row& row : rows) {
        const std::size_t first = out.entries.size();
        out.first.push_back(static_cast<int>(first));
        for (const RowPart& part : row.parts) {
            const Measure& m = measure_of(set, part.measure);
            const measure::PoseGradients g = pose_gradients(m, vector_function(m, frames), frames);
            add_entry(body_of(set, m.a), part.factor * tangent_gradient(g.a), first, out.entries);
            add_entry(body_of(set, m.b), part.factor * tangent_gradient(g.b), first, out.entries);
        }
    }
    out.first.push_back(count_of(out.entries));
    return out;
}

void to_chart(const std::vector<Matrix3>& left_jacobians, RowJacobian& jacobian) {
    for (RowGradient& entry : jacobian.entries)
        entry.gradient.tail<3>() = left_jacobians[entry.body].transpose() * entry.gradient.tail<3>();
}

void add_row_curvature(const MeasureSet& set, const std::vector<Row>& rows, const VectorX& multipliers,
                       const std::vector<PlacedFrame>& frames, const std::vector<Vector3>& rotation_vectors,
                       kinematics::BlockHessian& hessian) {
    Curvature sum(hessian.diagonal.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
        for (const RowPart& part : rows[i].parts) sum.add(set, measure_of(set, part.measure), part.factor * multipliers[i], frames);
        add_row_pattern(set, rows[i], sum.blocks);
    }
    std::vector<Matrix6> to_tangent(hessian.diagonal.size(), Matrix6::Identity());
    for (std::size_t i = 0; i < to_tangent.size(); ++i) {
        if (!sum.touched[i]) continue;
        to_tangent[i].bottomRightCorner<3, 3>() = kinematics::left_jacobian(rotation_vectors[i]);
        hessian.diagonal[i] += to_tangent[i].transpose() * sum.diagonal[i] * to_tangent[i];
        hessian.diagonal[i].bottomRightCorner<3, 3>() += kinematics::chart_curvature(sum.arms[i], rotation_vectors[i]);
    }
    for (kinematics::OffDiagonalBlock& b : sum.blocks) b.block = to_tangent[b.a].transpose() * b.block * to_tangent[b.b];
    linear::add_blocks(sum.blocks, hessian);
}

}  // namespace fettle::core::constraint
