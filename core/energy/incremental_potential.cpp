// SPDX-License-Identifier: MIT
#include "fettle/core/energy/incremental_potential.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <array>

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

constexpr int bodies_a_piece = 16;  // that a thread takes at a time

Matrix6 positive_part(const Matrix6& h) {
    const Eigen::LLT<Matrix6> cholesky(h);
    if (cholesky.info() == Eigen::Success) return h;
    const Eigen::SelfAdjointEigenSolver<Matrix6> eigen(h);
    const Vector6 positive = eigen.eigenvalues().cwiseMax(0.0);
    return eigen.eigenvectors() * positive.asDiagonal() * eigen.eigenvectors().transpose();
}

// (dq, dtheta) -> (dq, phi).
Matrix6 chart_to_tangent(const Vector3& theta) {
    Matrix6 t = Matrix6::Identity();
    t.bottomRightCorner<3, 3>() = kinematics::left_jacobian(theta);
    return t;
}

TermDerivatives sum_of_terms(const DerivativesAt& at) {
    const std::size_t n = at.poses.size();
    TermDerivatives d;
    d.own.resize(n);
    d.coupling.resize(n);
    d.own_hessian.assign(n, Matrix6::Zero());
    d.coupling_hessian.diagonal.assign(n, Matrix6::Zero());
    d.chart_gradient.assign(n, Vector3::Zero());
    d.own_magnitude.assign(n, 0);
    for (const Term* term : terms()) term->add_derivatives(at, d);
    return d;
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
    TermDerivatives d = sum_of_terms({problem, poses, contacts, kind});
    ChartDerivatives out;
    const std::size_t n = poses.size();
    out.gradient.resize(n);
    if (kind != contact::HessianKind::none) out.hessian.diagonal.resize(n);
    out.force_magnitude.resize(n);
    std::vector<Matrix6> to_tangent(n);
    base::parallel_for(static_cast<int>(n), bodies_a_piece, [&](int i) {
        const Vector3& theta = points[i].rotation_vector;
        to_tangent[i] = chart_to_tangent(theta);
        out.force_magnitude[i] = d.coupling[i].force.norm() + d.own_magnitude[i];
        const kinematics::PoseGradient gradient{d.coupling[i].force + d.own[i].force, d.coupling[i].arm + d.own[i].arm};
        out.gradient[i] = to_tangent[i].transpose() * tangent_gradient(gradient);
        out.gradient[i].tail<3>() += d.chart_gradient[i];
        if (kind == contact::HessianKind::none) return;
        Matrix6 own = to_tangent[i].transpose() * d.own_hessian[i] * to_tangent[i];
        own.bottomRightCorner<3, 3>() += chart_curvature(gradient.arm, kinematics::rotation_derivatives(theta));
        if (kind == contact::HessianKind::projected) own = positive_part(own);
        out.hessian.diagonal[i] = own + to_tangent[i].transpose() * d.coupling_hessian.diagonal[i] * to_tangent[i];
    });
    if (kind == contact::HessianKind::none) return out;
    out.hessian.off_diagonal = std::move(d.coupling_hessian.off_diagonal);
    base::parallel_for(static_cast<int>(out.hessian.off_diagonal.size()), bodies_a_piece, [&](int k) {
        kinematics::OffDiagonalBlock& b = out.hessian.off_diagonal[k];
        b.block = to_tangent[b.a].transpose() * b.block * to_tangent[b.b];
    });
    return out;
}

TermReport term_report(const SolvedStep& step) {
    TermReport report;
    for (const Term* term : terms()) term->add_report(step, report);
    return report;
}

}  // namespace fettle::core::energy
