// SPDX-License-Identifier: MIT
#include "core/solver/newton_direction.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include "core/base/parallel.hpp"
#include "core/kinematics/mass_matrix.hpp"

namespace fettle::core::solver {
namespace {

using contact::HessianKind;
using energy::ChartDerivatives;
using energy::StepProblem;
using kinematics::ChartPoint;

constexpr int bodies_at_once = 16;               // that a thread takes,
constexpr int bodies_a_pass = 32;                // where there is little to do for each,
constexpr int blocks_a_pass = 64;                // and blocks
constexpr double largest_turn = 0.3;             // of one iteration [rad], or twice what the body turns in a step as it goes
constexpr double largest_shift = 0.1;            // of the scene's size, or twice what the body moves
constexpr double rounding_shift = 1e-12;         // of the diagonal
constexpr double smallest_hessian_shift = 1e-2;  // of the body's inertia
constexpr double diagonal_share = 1e-10;         // of the diagonal, for one of the inertia

Vector6 coordinates(const ChartPoint& p) {
    Vector6 y;
    y << p.position, p.rotation_vector;
    return y;
}

ChartDerivatives derivatives(const StepProblem& problem, const Iterate& at, HessianKind kind, NewtonWorkspace& workspace) {
    const auto span = workspace.clock.charge(SolvePhase::derivatives);
    ChartDerivatives d = energy::chart_derivatives(problem, at.points, at.poses, at.contacts, kind);
    if (workspace.rows) workspace.rows->linearise(problem, at.points, at.poses, kind, d.hessian);
    return d;
}

// Adds the constraint forces of the Lagrangian, with the multipliers of the last solve.
void add_row_forces(const model::Model& model, const NewtonWorkspace& workspace, ChartDerivatives& d) {
    if (!workspace.rows) return;
    const std::vector<double> magnitude = workspace.rows->add_forces(model, d.gradient);
    for (std::size_t i = 0; i < magnitude.size(); ++i) d.force_magnitude[i] += magnitude[i];
}

// The share of one body: its free forces, squared, and what they are measured by.
struct ResidualShare {
    double square = 0, magnitude = 0;
};

ResidualShare residual_share(const ChartDerivatives& d, const model::Model& model, const linear::FreeDofs& dofs, std::size_t i) {
    const model::Body& body = model.bodies[i];
    ResidualShare share;
    for (int k = 0; k < 6; ++k) {
        if (dofs.index[i][k] < 0) continue;
        const double g = k < 3 ? d.gradient[i][k] : d.gradient[i][k] / std::max(body.radius, model.dhat);
        share.square += g * g;
    }
    share.magnitude = d.force_magnitude[i] + body.moments(3, 3) * model.velocity_tolerance * model.timestep;
    return share;
}

double residual_of(const ResidualShare& sum) { return sum.magnitude > 0 ? std::sqrt(sum.square) / sum.magnitude : std::sqrt(sum.square); }

double residual_of(const ChartDerivatives& d, const model::Model& model, const linear::FreeDofs& dofs) {
    ResidualShare sum;
    for (std::size_t i = 0; i < d.gradient.size(); ++i) {
        const ResidualShare share = residual_share(d, model, dofs, i);
        sum.square += share.square;
        sum.magnitude += share.magnitude;
    }
    return residual_of(sum);
}

// Positions carry an error of a few ulp of their size; the value moves by force times that, and by its square through the inertia.
double rounding_share(const ChartDerivatives& d, const model::Body& body, const ChartPoint& point, std::size_t i) {
    const double ulp = 16 * std::numeric_limits<double>::epsilon() * (point.position.norm() + body.radius);
    return d.force_magnitude[i] * ulp + body.moments(3, 3) * ulp * ulp;
}

// Direction::unbalanced. What moves the body by no more than the rounding of places counts for none.
double unbalanced_share(const StepProblem& problem, const ChartDerivatives& d, const linear::FreeDofs& dofs, const ChartPoint& point,
                        std::size_t i, double motion) {
    const model::Body& body = problem.model->bodies[i];
    const double rounding = 64 * std::numeric_limits<double>::epsilon() * (point.position.norm() + body.radius);
    if (motion <= rounding) return 0;
    const double weight = problem.weight * problem.model->gravity.norm(), mass = body.moments(3, 3);  // gravity is in pose_hat
    return std::sqrt(residual_share(d, *problem.model, dofs, i).square) / (d.force_magnitude[i] + mass * std::max(weight, rounding));
}

// x - x is 0 but for what is infinite or no number; so is their sum.
template <class Matrix>
bool all_finite(const Matrix& m) {
    return (m - m).sum() == 0;
}

bool is_finite(const ChartDerivatives& d, const linear::FreeDofs& dofs) {
    const auto bodies = count_of(d.gradient), blocks = count_of(d.hessian.off_diagonal);
    std::atomic<bool> finite = true;
    base::parallel_for(bodies + blocks, blocks_a_pass, [&](int i) {
        if (i >= bodies) {
            if (!all_finite(d.hessian.off_diagonal[i - bodies].block)) finite = false;
            return;
        }
        if (all_finite(d.gradient[i]) && all_finite(d.hessian.diagonal[i])) return;
        for (int k = 0; k < 6; ++k)
            if (dofs.index[i][k] >= 0 && !(std::isfinite(d.gradient[i][k]) && all_finite(d.hessian.diagonal[i].col(k)))) finite = false;
    });
    return finite;
}

// The inertia of body i.
Matrix6 inertia_in_chart(const StepProblem& problem, const Iterate& at, std::size_t i) {
    Matrix6 to_tangent = Matrix6::Identity();
    to_tangent.bottomRightCorner<3, 3>() = kinematics::left_jacobian(at.points[i].rotation_vector);
    const Matrix6 inertia = kinematics::mass_matrix(at.poses[i].rotation, problem.model->bodies[i].moments);
    return to_tangent.transpose() * inertia * to_tangent;
}

// What the shift is measured in: each body's inertia, which is definite whatever contact makes of the rest, and a share of the diagonal, as
// rounding is a share of it. A diagonal entry that is exactly zero, as of a spike balanced on an edge, cannot be raised by a factor.
std::vector<Matrix6> shift_unit(const StepProblem& problem, const Iterate& at, const ChartDerivatives& d) {
    std::vector<Matrix6> unit(d.hessian.diagonal.size());
    double largest = 0;
    for (std::size_t i = 0; i < unit.size(); ++i) {
        unit[i] = inertia_in_chart(problem, at, i);
        unit[i].diagonal() += diagonal_share * d.hessian.diagonal[i].diagonal().cwiseAbs();
        largest = std::max(largest, unit[i].diagonal().maxCoeff());
    }
    for (Matrix6& block : unit)  // a body without mass that nothing holds
        for (int k = 0; k < 6; ++k)
            if (!(block(k, k) > 0)) block(k, k) = largest > 0 ? largest : 1;
    return unit;
}

// Leaves the linear solver with a factor of d's Hessian, made definite. A matrix that is finite is always made so: each unit is positive on
// its diagonal, and grows until it outweighs everything else.
// @return the shift; nullopt if numbers are not finite.
std::optional<double> factorise(const StepProblem& problem, const Iterate& at, NewtonWorkspace& workspace, ChartDerivatives& d,
                                HessianKind& kind) {
    const auto is_definite = [&] {
        const auto span = workspace.clock.charge(SolvePhase::linear_solve);
        return workspace.factorise(d.hessian);
    };
    if (!is_finite(d, workspace.dofs())) return std::nullopt;
    if (workspace.dofs().count == 0 || is_definite()) return 0;
    if (kind == HessianKind::exact) {
        kind = HessianKind::projected;
        d = derivatives(problem, at, kind, workspace);
        if (!is_finite(d, workspace.dofs())) return std::nullopt;
        if (is_definite()) return 0;
    }
    const std::vector<Matrix6> unit = shift_unit(problem, at, d);
    const std::vector<Matrix6> unshifted = d.hessian.diagonal;
    for (Matrix6& block : d.hessian.diagonal) block.diagonal() *= 1 + rounding_shift;
    if (is_definite()) return 0;
    for (double shift = smallest_hessian_shift;; shift *= 100) {
        for (std::size_t i = 0; i < unit.size(); ++i) d.hessian.diagonal[i] = unshifted[i] + shift * unit[i];
        if (!is_finite(d, workspace.dofs())) return std::nullopt;
        if (is_definite()) return shift;
    }
}

constexpr double shift_growth = 10;

// The same with a shift that is asked for: the exact Hessian is kept as long as its tries last.
std::optional<double> factorise_shifted(const StepProblem& problem, const Iterate& at, NewtonWorkspace& workspace, ChartDerivatives& d,
                                        const HessianChoice& choice, HessianKind& kind) {
    if (!is_finite(d, workspace.dofs())) return std::nullopt;
    if (workspace.dofs().count == 0) return 0;
    std::vector<Matrix6> unit = shift_unit(problem, at, d);
    std::vector<Matrix6> unshifted = d.hessian.diagonal;
    double shift = *choice.shift;
    for (int tries = 1;; ++tries) {
        for (std::size_t i = 0; i < unit.size(); ++i) d.hessian.diagonal[i] = unshifted[i] + shift * unit[i];
        if (!is_finite(d, workspace.dofs())) return std::nullopt;
        {
            const auto span = workspace.clock.charge(SolvePhase::linear_solve);
            if (workspace.factorise(d.hessian)) return shift;
        }
        if (kind == HessianKind::exact && tries == choice.exact_shifts) {
            kind = HessianKind::projected;
            d = derivatives(problem, at, kind, workspace);
            if (!is_finite(d, workspace.dofs())) return std::nullopt;
            unshifted = d.hessian.diagonal;
            shift = *choice.shift;
        } else {
            shift = std::max(smallest_hessian_shift, shift_growth * shift);
        }
    }
}

// step . inertia step.
double inertia_along(const StepProblem& problem, const Iterate& at, const std::vector<Vector6>& steps) {
    double sum = 0;
    for (std::size_t i = 0; i < steps.size(); ++i) {
        Vector6 step = steps[i];
        step.tail<3>() = kinematics::left_jacobian(at.points[i].rotation_vector) * step.tail<3>();
        sum += step.dot(kinematics::mass_matrix(at.poses[i].rotation, problem.model->bodies[i].moments) * step);
    }
    return sum;
}

void measure_remaining(const std::vector<Vector6>& targets, const std::vector<ChartPoint>& points, const model::Model& model,
                       const linear::FreeDofs& dofs, Direction& direction) {
    direction.remaining.assign(points.size(), Vector6::Zero());
    for (const auto& [i, k] : dofs.prescribed) {
        direction.remaining[i][k] = targets[i][k] - coordinates(points[i])[k];
        direction.remaining_norm += std::abs(direction.remaining[i][k]) * (k < 3 ? 1.0 : model.bodies[i].radius);
    }
}

void solve_for_step(const ChartDerivatives& d, NewtonWorkspace& workspace, Direction& direction) {
    direction.step = direction.remaining;
    for (Vector6& step : direction.step) step *= direction.drive;
    if (workspace.dofs().count == 0) return;
    VectorX rhs = -gather(workspace.dofs(), d.gradient);
    if (workspace.rows) {
        if (direction.remaining_norm > 0) rhs -= gather(workspace.dofs(), linear::multiply(d.hessian, direction.step));
        const auto span = workspace.clock.charge(SolvePhase::linear_solve);
        workspace.rows->solve_for_step(workspace.system, d.hessian, rhs, direction.drive, direction.step);
        return;
    }
    if (direction.remaining_norm > 0) rhs -= gather(workspace.dofs(), linear::multiply(d.hessian, direction.step));
    const auto span = workspace.clock.charge(SolvePhase::linear_solve);
    scatter(workspace.dofs(), workspace.system.solve(rhs).y, direction.step);
}

// The share of its step that a body may take: a nearly singular Hessian sends bodies round the world, where every search is dear and
// nothing is gained.
double allowed_share(const StepProblem& problem, const Direction& direction, std::size_t i) {
    const Matrix34 stride = problem.pose_hat[i] - pose_matrix(problem.poses_t0[i]);
    const Vector6 &step = direction.step[i], &remaining = direction.remaining[i];
    const double shift = std::max(largest_shift * problem.model->diagonal, 2 * (stride.col(3).norm() + remaining.head<3>().norm()));
    const double turn = std::max(largest_turn, 2 * (stride.leftCols<3>().norm() + remaining.tail<3>().norm()));
    return std::min(shift / std::max(shift, step.head<3>().norm()), turn / std::max(turn, step.tail<3>().norm()));
}

// Slope, motion, residual and rounding of the step as it is. @return what all bodies may take of it: if less than the whole, it is to be
// shortened, and measured again.
double measure(const StepProblem& problem, const ChartDerivatives& d, const linear::FreeDofs& dofs, const std::vector<ChartPoint>& points,
               Direction& direction) {
    const model::Model& model = *problem.model;
    struct Shares {
        double slope = 0, motion = 0, unbalanced = 0, rounding = 0, allowed = 1;
        ResidualShare residual;
    };
    std::vector<Shares> shares(points.size());
    base::parallel_for(count_of(points), bodies_a_pass, [&](int k) {
        const auto i = static_cast<std::size_t>(k);
        const Vector6& step = direction.step[i];
        const bool solved_for = std::any_of(dofs.index[i].begin(), dofs.index[i].end(), [](int index) { return index >= 0; });
        const double motion = solved_for ? motion_of(model.bodies[i], step) : 0;
        shares[i] = {d.gradient[i].dot(step),
                     motion,
                     unbalanced_share(problem, d, dofs, points[i], i, motion),
                     rounding_share(d, model.bodies[i], points[i], i),
                     allowed_share(problem, direction, i),
                     residual_share(d, model, dofs, i)};
    });
    Shares sum;
    for (const Shares& share : shares) {
        sum.slope += share.slope;
        sum.motion = std::max(sum.motion, share.motion);
        sum.rounding += share.rounding;
        sum.allowed = std::min(sum.allowed, share.allowed);
        sum.residual.square += share.residual.square;
        sum.residual.magnitude += share.residual.magnitude;
    }
    direction.unbalanced.resize(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) direction.unbalanced[i] = shares[i].unbalanced;
    direction.slope = sum.slope;
    direction.motion = sum.motion;
    direction.rounding = sum.rounding;
    direction.residual = residual_of(sum.residual);
    return sum.allowed;
}

void shorten(Direction& direction, double share) {
    for (Vector6& step : direction.step) step *= share;
    direction.drive *= share;
}

}  // namespace

std::optional<Direction> newton_direction(const StepProblem& problem, const Iterate& at, const std::vector<Vector6>& targets,
                                          const HessianChoice& hessian, double drive, NewtonWorkspace& workspace) {
    const model::Model& model = *problem.model;
    const linear::FreeDofs& dofs = workspace.dofs();
    Direction direction;
    HessianKind kind = hessian.kind;
    ChartDerivatives d = derivatives(problem, at, kind, workspace);
    const std::optional<double> shift =
        hessian.shift ? factorise_shifted(problem, at, workspace, d, hessian, kind) : factorise(problem, at, workspace, d, kind);
    if (!shift) return std::nullopt;
    direction.kind = kind;
    direction.shift = *shift;
    measure_remaining(targets, at.points, model, dofs, direction);
    if (workspace.rows) direction.remaining_norm += workspace.rows->unmet_norm();
    direction.drive = direction.remaining_norm > 0 ? drive : 1;
    solve_for_step(d, workspace, direction);
    add_row_forces(model, workspace, d);
    if (const double share = measure(problem, d, dofs, at.points, direction); share != 1) {
        shorten(direction, share);
        measure(problem, d, dofs, at.points, direction);
    }
    if (workspace.rows) {
        direction.slope -= workspace.rows->work_of_unmet(direction.drive);
        direction.rounding += workspace.rows->work_of_rounding();
    }
    if (hessian.shift) direction.inertia = inertia_along(problem, at, direction.step);
    if (!std::isfinite(direction.residual + direction.rounding + direction.slope + direction.motion)) return std::nullopt;
    return direction;
}

ChartPoint moved(int i, const std::vector<ChartPoint>& points, const Direction& direction, double fraction,
                 const std::vector<Vector6>& targets, const linear::FreeDofs& dofs) {
    Vector6 y = coordinates(points[i]) + fraction * direction.step[i];
    if (fraction == 1 && direction.drive == 1)
        for (int k = 0; k < 6; ++k)
            if (dofs.index[i][k] < 0) y[k] = targets[i][k];
    return {y.head<3>(), y.tail<3>()};
}

double residual_at(const StepProblem& problem, const Iterate& at, NewtonWorkspace& workspace) {
    ChartDerivatives d = derivatives(problem, at, HessianKind::none, workspace);
    add_row_forces(*problem.model, workspace, d);
    return residual_of(d, *problem.model, workspace.dofs());
}

namespace {

// The step of a body under its inertia alone; not finite without.
Vector6 inertial_step(const StepProblem& problem, const Iterate& at, const ChartDerivatives& d, const linear::FreeDofs& dofs, int body) {
    Matrix6 inertia = inertia_in_chart(problem, at, static_cast<std::size_t>(body));
    Vector6 force = d.gradient[body];
    for (int k = 0; k < 6; ++k) {
        if (dofs.index[body][k] >= 0) continue;
        inertia.row(k).setZero();
        inertia.col(k).setZero();
        inertia(k, k) = 1;
        force[k] = 0;
    }
    const Eigen::LLT<Matrix6> factor(inertia);
    return factor.info() == Eigen::Success ? Vector6(factor.solve(force))
                                           : Vector6(Vector6::Constant(std::numeric_limits<double>::infinity()));
}

}  // namespace

double motion_of(const model::Body& body, const Vector6& step) { return step.head<3>().norm() + step.tail<3>().norm() * body.radius; }

Remainder remainder_at(const StepProblem& problem, const Iterate& at, const std::vector<int>& bodies, NewtonWorkspace& workspace) {
    const model::Model& model = *problem.model;
    const ChartDerivatives d = derivatives(problem, at, HessianKind::none, workspace);
    const std::vector<double> none(bodies.size(), 0.0);
    Remainder out{none, none, residual_of(d, model, workspace.dofs())};
    base::parallel_for(count_of(bodies), bodies_at_once, [&](int k) {
        const int body = bodies[k];
        if (!energy::has_free_dof(model.bodies[body])) return;
        out.motion[k] = motion_of(model.bodies[body], inertial_step(problem, at, d, workspace.dofs(), body));
        out.unbalanced[k] = unbalanced_share(problem, d, workspace.dofs(), at.points[body], static_cast<std::size_t>(body), out.motion[k]);
    });
    return out;
}

}  // namespace fettle::core::solver
