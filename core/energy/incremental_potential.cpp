// SPDX-License-Identifier: MIT
#include "fettle/core/energy/incremental_potential.hpp"

#include <Eigen/Cholesky>
#include <array>

#include "fettle/core/base/factorisations.hpp"
#include "fettle/core/base/parallel.hpp"
#include "fettle/core/energy/barrier.hpp"
#include "fettle/core/energy/contact_damping.hpp"
#include "fettle/core/energy/damping.hpp"
#include "fettle/core/energy/friction.hpp"
#include "fettle/core/energy/inertia.hpp"
#include "fettle/core/energy/loads.hpp"
#include "fettle/core/energy/measure_terms.hpp"

namespace fettle::core::energy {
namespace {

using kinematics::ChartPoint;
using kinematics::Pose;

constexpr int bodies_a_piece = 16;   // that a thread takes at a time
constexpr int bodies_to_clear = 32;  // the same, of sums to begin

Matrix6 positive_part(const Matrix6& h) {
    const Eigen::LLT<Matrix6> cholesky(h);
    if (cholesky.info() == Eigen::Success) return h;
    const SymmetricEigen<6> eigen = symmetric_eigen<6>(h);
    const Vector6 positive = eigen.values.cwiseMax(0.0);
    return eigen.vectors * positive.asDiagonal() * eigen.vectors.transpose();
}

// h from (dq, phi) of the rows' and of the columns' body to (dq, dtheta): phi = J dtheta.
void pull_back(const Matrix3& j_rows, const Matrix3& j_columns, Matrix6& h) {
    const Eigen::Matrix<double, 6, 3> columns = h.rightCols<3>().lazyProduct(j_columns);
    h.rightCols<3>() = columns;
    const Eigen::Matrix<double, 3, 6> rows = j_rows.transpose().lazyProduct(h.bottomRows<3>());
    h.bottomRows<3>() = rows;
}

// `d` is memory to use again: what it held is lost.
void sum_terms(const DerivativesAt& at, TermDerivatives& d) {
    const std::size_t n = at.poses.size();
    d.own.resize(n);
    d.coupling.resize(n);
    d.own_hessian.resize(n);
    d.coupling_hessian.diagonal.resize(n);
    d.coupling_hessian.off_diagonal.clear();
    d.chart_gradient.resize(n);
    d.own_magnitude.resize(n);
    base::parallel_for(static_cast<int>(n), bodies_to_clear, [&](int i) {
        d.own[i] = d.coupling[i] = {};
        d.own_hessian[i].setZero();
        d.coupling_hessian.diagonal[i].setZero();
        d.chart_gradient[i].setZero();
        d.own_magnitude[i] = 0;
    });
    for (const Term* term : terms()) term->add_derivatives(at, d);
}

}  // namespace

std::span<const Term* const> terms() {
    static const std::array list{&inertia_term,         &loads_term,    &damping_term, &barrier_term,
                                 &contact_damping_term, &friction_term, &measure_terms};
    return list;
}

double incremental_potential(const StepProblem& problem, const std::vector<ChartPoint>& points, const std::vector<Pose>& poses,
                             const contact::ContactSet& contacts) {
    TermValues values{std::vector<double>(poses.size(), 0.0), {}};
    for (const Term* term : terms()) term->add_value({problem, points, poses, contacts}, values);
    double sum = 0;
    for (const double value : values.bodies) sum += value;
    for (const double value : values.couplings) sum += value;
    return sum;
}

ChartDerivatives chart_derivatives(const StepProblem& problem, const std::vector<ChartPoint>& points, const std::vector<Pose>& poses,
                                   const contact::ContactSet& contacts, contact::HessianKind kind) {
    static thread_local TermDerivatives memory;  // stays from call to call
    TermDerivatives& d = memory;
    sum_terms({problem, poses, contacts, kind}, d);
    ChartDerivatives out;
    const std::size_t n = poses.size();
    out.gradient.resize(n);
    if (kind != contact::HessianKind::none) out.hessian.diagonal.resize(n);
    out.force_magnitude.resize(n);
    std::vector<Matrix3> jacobian(n);
    base::parallel_for(static_cast<int>(n), bodies_a_piece, [&](int i) {
        const Vector3& theta = points[i].rotation_vector;
        jacobian[i] = kinematics::left_jacobian(theta);
        out.force_magnitude[i] = d.coupling[i].force.norm() + d.own_magnitude[i];
        const kinematics::PoseGradient gradient{d.coupling[i].force + d.own[i].force, d.coupling[i].arm + d.own[i].arm};
        out.gradient[i] = tangent_gradient(gradient);
        const Vector3 turning = jacobian[i].transpose() * out.gradient[i].tail<3>();
        out.gradient[i].tail<3>() = turning + d.chart_gradient[i];
        if (kind == contact::HessianKind::none) return;
        const Matrix3 curvature = kinematics::chart_curvature(gradient.arm, theta);
        Matrix6& sum = out.hessian.diagonal[i];
        if (kind == contact::HessianKind::projected) {
            Matrix6 own = d.own_hessian[i];
            pull_back(jacobian[i], jacobian[i], own);
            own.bottomRightCorner<3, 3>() += curvature;
            sum = d.coupling_hessian.diagonal[i];
            pull_back(jacobian[i], jacobian[i], sum);
            sum += positive_part(own);
        } else {
            sum = d.own_hessian[i] + d.coupling_hessian.diagonal[i];
            pull_back(jacobian[i], jacobian[i], sum);
            sum.bottomRightCorner<3, 3>() += curvature;
        }
    });
    if (kind == contact::HessianKind::none) return out;
    out.hessian.off_diagonal = std::move(d.coupling_hessian.off_diagonal);
    base::parallel_for(static_cast<int>(out.hessian.off_diagonal.size()), bodies_a_piece, [&](int k) {
        kinematics::OffDiagonalBlock& b = out.hessian.off_diagonal[k];
        pull_back(jacobian[b.a], jacobian[b.b], b.block);
    });
    return out;
}

TermReport term_report(const SolvedStep& step) {
    TermReport report;
    for (const Term* term : terms()) term->add_report(step, report);
    return report;
}

}  // namespace fettle::core::energy
