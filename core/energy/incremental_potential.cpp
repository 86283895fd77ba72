// SPDX-License-Identifier: MIT
#include "core/energy/incremental_potential.hpp"

#include <Eigen/Cholesky>
#include <array>
#include <utility>

#include "core/base/parallel.hpp"
#include "core/energy/body_terms.hpp"
#include "core/energy/contact_terms.hpp"
#include "core/energy/measure_terms.hpp"
#include "core/linear/positive_part.hpp"

namespace fettle::core::energy {
namespace {

using kinematics::ChartPoint;
using kinematics::Pose;

constexpr int bodies_a_piece = 16;   // that a thread takes at a time
constexpr int bodies_to_clear = 64;  // the same, of sums to begin
constexpr int values_a_piece = 32;   // the same, of values alone

Matrix6 positive_part(const Matrix6& h) {
    const Eigen::LLT<Matrix6> cholesky(h);
    return cholesky.info() == Eigen::Success ? h : Matrix6(linear::positive_part(linear::symmetric_eigen<6>(h)));
}

// h from (dq, phi) of the rows' and of the columns' body to (dq, dtheta): phi = J dtheta.
void pull_back(const Matrix3& j_rows, const Matrix3& j_columns, Matrix6& h) {
    const Eigen::Matrix<double, 6, 3> columns = h.rightCols<3>().lazyProduct(j_columns);
    h.rightCols<3>() = columns;
    const Eigen::Matrix<double, 3, 6> rows = j_rows.transpose().lazyProduct(h.bottomRows<3>());
    h.bottomRows<3>() = rows;
}

// The sums of the terms that couple bodies. Their memory stays from call to call: who has taken a body's sums leaves them clear, while they
// are at hand.
struct CouplingSums {
    CouplingDerivatives d;
    bool are_clear = false;

    // All of `bodies`.
    void begin(std::size_t bodies) {
        const bool usable = std::exchange(are_clear, false) && d.gradient.size() == bodies;
        d.hessian.off_diagonal.clear();
        if (usable) return;
        d.gradient.resize(bodies);
        d.hessian.diagonal.resize(bodies);
        d.magnitude.resize(bodies);
        base::parallel_for(static_cast<int>(bodies), bodies_to_clear, [&](int i) { clear(static_cast<std::size_t>(i)); });
    }
    void clear(std::size_t body) {
        d.gradient[body] = {};
        d.hessian.diagonal[body].setZero();
        d.magnitude[body] = 0;
    }
};

}  // namespace

std::span<const BodyTerm* const> body_terms() {
    static constexpr std::array list{&inertia_term, &loads_term, &damping_term};
    return list;
}

std::span<const CouplingTerm* const> coupling_terms() {
    static constexpr std::array list{&barrier_term, &contact_damping_term, &friction_term, &measure_terms};
    return list;
}

double incremental_potential(const StepProblem& problem, const std::vector<ChartPoint>& points, const std::vector<Pose>& poses,
                             const contact::ContactSet& contacts) {
    const ValueAt at{problem, points, poses, contacts};
    std::vector<double> values(poses.size(), 0.0);
    base::parallel_for(count_of(poses), values_a_piece, [&](int i) {
        for (const BodyTerm* term : body_terms()) term->add_value(at, static_cast<std::size_t>(i), values[i]);
    });
    double sum = 0;
    for (const double value : values) sum += value;
    for (const CouplingTerm* term : coupling_terms()) sum += term->value(at);
    return sum;
}

ChartDerivatives chart_derivatives(const StepProblem& problem, const std::vector<ChartPoint>& points, const std::vector<Pose>& poses,
                                   const contact::ContactSet& contacts, contact::HessianKind kind) {
    static thread_local CouplingSums memory;
    CouplingSums& sums = memory;
    CouplingDerivatives& d = sums.d;
    const DerivativesAt at{problem, poses, contacts, kind};
    sums.begin(poses.size());
    for (const CouplingTerm* term : coupling_terms()) {
        if (term == &measure_terms)  // whose forces count one by one
            for (std::size_t i = 0; i < poses.size(); ++i) d.magnitude[i] += d.gradient[i].force.norm();
        term->add_derivatives(at, d);
    }
    ChartDerivatives out;
    const std::size_t n = poses.size();
    out.gradient.resize(n);
    if (kind != contact::HessianKind::none) out.hessian.diagonal.resize(n);
    out.force_magnitude.resize(n);
    std::vector<Matrix3> jacobian(n);
    base::parallel_for(static_cast<int>(n), bodies_a_piece, [&](int i) {
        BodyDerivatives own;
        for (const BodyTerm* term : body_terms()) term->add_derivatives(at, static_cast<std::size_t>(i), own);
        const Vector3& theta = points[i].rotation_vector;
        jacobian[i] = kinematics::left_jacobian(theta);
        out.force_magnitude[i] = d.magnitude[i] + own.magnitude;
        const kinematics::PoseGradient gradient{d.gradient[i].force + own.gradient.force, d.gradient[i].arm + own.gradient.arm};
        const Matrix6 coupled = d.hessian.diagonal[i];
        sums.clear(static_cast<std::size_t>(i));
        out.gradient[i] = tangent_gradient(gradient);
        const Vector3 turning = jacobian[i].transpose() * out.gradient[i].tail<3>();
        out.gradient[i].tail<3>() = turning + own.chart_gradient;
        if (kind == contact::HessianKind::none) return;
        const Matrix3 curvature = kinematics::chart_curvature(gradient.arm, theta);
        Matrix6& sum = out.hessian.diagonal[i];
        if (kind == contact::HessianKind::projected) {
            pull_back(jacobian[i], jacobian[i], own.hessian);
            own.hessian.bottomRightCorner<3, 3>() += curvature;
            sum = coupled;
            pull_back(jacobian[i], jacobian[i], sum);
            sum += positive_part(own.hessian);
        } else {
            sum = own.hessian + coupled;
            pull_back(jacobian[i], jacobian[i], sum);
            sum.bottomRightCorner<3, 3>() += curvature;
        }
    });
    sums.are_clear = true;
    if (kind == contact::HessianKind::none) return out;
    out.hessian.off_diagonal = std::move(d.hessian.off_diagonal);
    base::parallel_for(count_of(out.hessian.off_diagonal), bodies_a_piece, [&](int k) {
        kinematics::OffDiagonalBlock& b = out.hessian.off_diagonal[k];
        pull_back(jacobian[b.a], jacobian[b.b], b.block);
    });
    return out;
}

TermReport term_report(const SolvedStep& step) {
    TermReport report;
    for (const BodyTerm* term : body_terms()) term->add_report(step, report);
    for (const CouplingTerm* term : coupling_terms()) term->add_report(step, report);
    return report;
}

}  // namespace fettle::core::energy
