// SPDX-License-Identifier: MIT
#include "adjoint/energy/time_integration_adjoint.hpp"

#include <array>

#include "adjoint/energy/body_terms_adjoint.hpp"
#include "core/energy/damping_moments.hpp"
#include "core/kinematics/mass_matrix.hpp"
#include "core/kinematics/tangent_system.hpp"
#include "core/linear/factorisations.hpp"

namespace fettle::adjoint::energy {
namespace {

using core::kinematics::pose_matrix;
using core::model::Body;

constexpr int solves = 4;  // core's

// <X, [d]> = twice_axial(X) . d.
Vector3 twice_axial(const Matrix3& x) { return {x(2, 1) - x(1, 2), x(0, 2) - x(2, 0), x(1, 0) - x(0, 1)}; }
Vector3 axial_vector(const Matrix3& x) { return 0.5 * twice_axial(x); }

// The change of axial_vector(x R^T) along changes of x and R.
Vector3 axial_change(const Matrix3& x, const Matrix3& R, const Matrix3& x_dot, const Matrix3& R_dot) {
    return axial_vector(x_dot * R.transpose() + x * R_dot.transpose());
}

// The same backwards.
void add_axial_gradient(const Matrix3& x, const Matrix3& R, const Vector3& bar, Eigen::Ref<Matrix3> x_bar, Eigen::Ref<Matrix3> R_bar) {
    const Matrix3 half = 0.5 * cross_matrix(bar);
    x_bar += half * R;
    R_bar += half.transpose() * x;
}

Matrix3 spin_of(const Vector3& omega, const Vector3& alpha) { return cross_matrix(alpha) + cross_matrix(omega) * cross_matrix(omega); }

Matrix3 spin_change(const Vector3& omega, const Vector3& omega_dot, const Vector3& alpha_dot) {
    return cross_matrix(alpha_dot) + cross_matrix(omega_dot) * cross_matrix(omega) + cross_matrix(omega) * cross_matrix(omega_dot);
}

// Q of accelerations (a_q, alpha).
Matrix34 acceleration_of(const Matrix3& R, const Vector3& omega, const Vector6& a) {
    Matrix34 q;
    q << spin_of(omega, a.tail<3>()) * R, a.head<3>();
    return q;
}

// <G, [[e_phi] R, e_q]> for the unit motions.
Vector6 along_motions(const Matrix34& g, const Matrix3& R) {
    Vector6 out;
    out << g.col(3), twice_axial(g.leftCols<3>() * R.transpose());
    return out;
}

// Newton's and Euler's equations of one body at one rotation: the free accelerations that balance a given F = N M, or forces besides.
class Balance {
public:
    Balance(const Body& body, const Matrix3& R) : body_(body), R_(R), factor_(free_part(body, R)) {}

    // @param loads  <N M, unit motions> and what acts besides.  @param held  prescribed accelerations, others irrelevant
    Vector6 accelerations(const Vector3& omega, const Vector6& loads, const Vector6& held) const {
        Vector6 known = held;
        mask(known, false);
        const Vector6 rhs = loads - along_motions(acceleration_of(R_, omega, known) * body_.moments, R_);
        return solved(rhs) + known;
    }

    // The free part of H^-1 of the free part.
    Vector6 solved(Vector6 rhs) const {
        mask(rhs, true);
        return factor_.solve(rhs);
    }

    // Zero but the free, or but the prescribed.
    void mask(Vector6& a, bool keep_free) const {
        for (int k = 0; k < 6; ++k)
            if (is_free(body_, k) != keep_free) a[k] = 0;
    }

private:
    // The mass matrix over the free coordinates; the identity where nothing is free.
    static Matrix6 free_part(const Body& body, const Matrix3& R) {
        Matrix6 h = core::kinematics::mass_matrix(R, body.moments);
        for (int k = 0; k < 6; ++k) {
            if (is_free(body, k)) continue;
            h.row(k).setZero();
            h.col(k).setZero();
            h(k, k) = 1;
        }
        return h;
    }

    const Body& body_;
    Matrix3 R_;
    core::linear::SymmetricFactor factor_;
};

// Everything that newmark_rates comes by.
struct Worked {
    Matrix3 R0, R;
    Matrix34 numeric;  // N
    Vector6 start, held;
    Vector3 omega0;
    std::array<Vector3, solves + 1> omega;
    std::array<Vector6, solves> a;
    Balance balance;

    explicit Worked(const NewmarkStep& s)
        : R0(s.before.leftCols<3>()),
          R(s.end.rotation),
          numeric((pose_matrix(s.end) - s.before - s.timestep * s.velocity) / (0.25 * s.timestep * s.timestep) - s.acceleration),
          balance(s.body, R) {
        omega0 = axial_vector(s.velocity.leftCols<3>() * R0.transpose());
        start << s.acceleration.col(3), axial_vector(s.acceleration.leftCols<3>() * R0.transpose());
        held << numeric.col(3), axial_vector(numeric.leftCols<3>() * R.transpose());
        const Vector6 loads = along_motions(numeric * s.body.moments, R);
        omega[0] = omega0 + s.timestep * start.tail<3>();
        for (int k = 0; k < solves; ++k) {
            a[k] = balance.accelerations(omega[k], loads, held);
            omega[k + 1] = omega0 + 0.5 * s.timestep * (start + a[k]).tail<3>();
        }
    }
    const Vector6& last() const { return a[solves - 1]; }
    const Vector3& last_omega() const { return omega[solves]; }
};

// Gradients in what one balance is made of.
struct BalanceGradient {
    Vector3 omega = Vector3::Zero();
    Vector6 held = Vector6::Zero();
    Matrix34 numeric = Matrix34::Zero();
    Matrix3 rotation = Matrix3::Zero();
    Matrix4 moments = Matrix4::Zero();
    Vector6 mu = Vector6::Zero();  // of forces besides
};

// Into omega, alpha, a_q and R of Q = acceleration_of(R, omega, a).
void add_acceleration_gradient(const Matrix3& R, const Vector3& omega, const Vector6& a, const Matrix34& bar, BalanceGradient& out,
                               Vector6& a_bar) {
    const Matrix3 s = bar.leftCols<3>() * R.transpose(), w = cross_matrix(omega);
    out.omega += twice_axial(s * w.transpose() + w.transpose() * s);
    a_bar.head<3>() += bar.col(3);
    a_bar.tail<3>() += twice_axial(s);
    out.rotation += spin_of(omega, a.tail<3>()).transpose() * bar.leftCols<3>();
}

// a = accelerations(omega, <N M, .>, held) backwards. @param numeric  N
BalanceGradient balance_gradient(const Body& body, const Matrix3& R, const Balance& balance, const Vector3& omega, const Vector6& a,
                                 const std::pair<Matrix34, Vector6>& numeric_and_bar) {
    const auto& [numeric, a_bar] = numeric_and_bar;
    BalanceGradient out;
    out.mu = balance.solved(a_bar);
    Matrix34 v;
    v << cross_matrix(out.mu.tail<3>()) * R, out.mu.head<3>();
    const Matrix34 left = numeric - acceleration_of(R, omega, a);
    out.numeric = v * body.moments;
    const Matrix4 m = v.transpose() * left;
    out.moments = 0.5 * (m + m.transpose());
    out.rotation = cross_matrix(out.mu.tail<3>()).transpose() * (left * body.moments).leftCols<3>();
    Vector6 of_all = Vector6::Zero();
    add_acceleration_gradient(R, omega, a, -v * body.moments, out, of_all);
    out.held = a_bar + of_all;
    balance.mask(out.held, false);
    return out;
}

}  // namespace

NewmarkRates newmark_rates(const NewmarkStep& s) {
    const Worked w(s);
    NewmarkRates out;
    out.velocity << cross_matrix(w.last_omega()) * w.R, Vector3(s.velocity.col(3) + 0.5 * s.timestep * (w.start + w.last()).head<3>());
    out.acceleration = acceleration_of(w.R, w.last_omega(), w.last());
    return out;
}

NewmarkRates newmark_rates_tangent(const NewmarkStep& s, const NewmarkStepChange& dot) {
    const Worked w(s);
    const double h = s.timestep;
    const Matrix3 R0_dot = dot.before.leftCols<3>(), R_dot = dot.end.leftCols<3>();
    const Matrix34 numeric_dot = (dot.end - dot.before - h * dot.velocity) / (0.25 * h * h) - dot.acceleration;
    const Vector3 omega0_dot = axial_change(s.velocity.leftCols<3>(), w.R0, dot.velocity.leftCols<3>(), R0_dot);
    Vector6 start_dot, held_dot;
    start_dot << dot.acceleration.col(3), axial_change(s.acceleration.leftCols<3>(), w.R0, dot.acceleration.leftCols<3>(), R0_dot);
    held_dot << numeric_dot.col(3), axial_change(w.numeric.leftCols<3>(), w.R, numeric_dot.leftCols<3>(), R_dot);
    w.balance.mask(held_dot, false);
    Vector3 omega_dot = omega0_dot + h * start_dot.tail<3>();
    Vector6 a_dot;
    for (int k = 0; k < solves; ++k) {
        const Matrix34 left = w.numeric - acceleration_of(w.R, w.omega[k], w.a[k]);
        Matrix34 q_dot;
        q_dot << spin_change(w.omega[k], omega_dot, held_dot.tail<3>()) * w.R + spin_of(w.omega[k], w.a[k].tail<3>()) * R_dot,
            held_dot.head<3>();
        const Matrix34 g = left * s.body.moments, g_dot = (numeric_dot - q_dot) * s.body.moments + left * dot.moments;
        Vector6 residual_dot = along_motions(g_dot, w.R);
        residual_dot.tail<3>() += twice_axial(g.leftCols<3>() * R_dot.transpose());
        a_dot = w.balance.solved(residual_dot) + held_dot;
        omega_dot = omega0_dot + 0.5 * h * (start_dot + a_dot).tail<3>();
    }
    NewmarkRates out;
    out.velocity << cross_matrix(omega_dot) * w.R + cross_matrix(w.last_omega()) * R_dot,
        Vector3(dot.velocity.col(3) + 0.5 * h * (start_dot + a_dot).head<3>());
    out.acceleration << spin_change(w.last_omega(), omega_dot, a_dot.tail<3>()) * w.R + spin_of(w.last_omega(), w.last().tail<3>()) * R_dot,
        a_dot.head<3>();
    return out;
}

NewmarkStepChange newmark_rates_adjoint(const NewmarkStep& s, const NewmarkRates& bar) {
    const Worked w(s);
    const double h = s.timestep;
    NewmarkStepChange out;
    BalanceGradient sum;
    Vector6 a_bar = Vector6::Zero(), start_bar = Vector6::Zero();
    Vector3 omega0_bar = Vector3::Zero();
    // V' and A'.
    out.velocity.col(3) += bar.velocity.col(3);
    start_bar.head<3>() += 0.5 * h * bar.velocity.col(3);
    a_bar.head<3>() += 0.5 * h * bar.velocity.col(3);
    Vector3 omega_bar = twice_axial(bar.velocity.leftCols<3>() * w.R.transpose());
    sum.rotation += cross_matrix(w.last_omega()).transpose() * bar.velocity.leftCols<3>();
    add_acceleration_gradient(w.R, w.last_omega(), w.last(), bar.acceleration, sum, a_bar);
    omega_bar += sum.omega;
    for (int k = solves - 1; k >= 0; --k) {
        omega0_bar += omega_bar;
        start_bar.tail<3>() += 0.5 * h * omega_bar;
        a_bar.tail<3>() += 0.5 * h * omega_bar;
        const BalanceGradient g = balance_gradient(s.body, w.R, w.balance, w.omega[k], w.a[k], {w.numeric, a_bar});
        sum.held += g.held;
        sum.numeric += g.numeric;
        sum.rotation += g.rotation;
        sum.moments += g.moments;
        omega_bar = g.omega;
        a_bar.setZero();
    }
    omega0_bar += omega_bar;
    start_bar.tail<3>() += h * omega_bar;
    // What the first omega, the start's and the held accelerations are read from.
    add_axial_gradient(s.velocity.leftCols<3>(), w.R0, omega0_bar, out.velocity.leftCols<3>(), out.before.leftCols<3>());
    out.acceleration.col(3) += start_bar.head<3>();
    add_axial_gradient(s.acceleration.leftCols<3>(), w.R0, start_bar.tail<3>(), out.acceleration.leftCols<3>(), out.before.leftCols<3>());
    sum.numeric.col(3) += sum.held.head<3>();
    add_axial_gradient(w.numeric.leftCols<3>(), w.R, sum.held.tail<3>(), sum.numeric.leftCols<3>(), sum.rotation);
    const Matrix34 scaled = sum.numeric / (0.25 * h * h);
    out.end += scaled;
    out.end.leftCols<3>() += sum.rotation;
    out.before -= scaled;
    out.velocity -= h * scaled;
    out.acceleration -= sum.numeric;
    out.moments = sum.moments;
    return out;
}

Matrix34 start_acceleration_tangent(const StartOf& at, const StartChange& dot) {
    const Body& body = at.body;
    const Matrix3& R = body.pose_start.rotation;
    const bool is_damped = core::energy::is_damped(body);
    const Matrix4 damping = is_damped ? core::energy::damping_moments(body) : Matrix4(Matrix4::Zero());
    const Matrix4 damping_dot = is_damped ? damping_moments_tangent(body, dot.moments) : Matrix4(Matrix4::Zero());
    const Balance balance(body, R);
    const Vector3 omega = axial_vector(body.velocity_start.leftCols<3>() * R.transpose());
    const Vector3 omega_dot = axial_change(body.velocity_start.leftCols<3>(), R, dot.velocity.leftCols<3>(), dot.rotation);
    Matrix34 weight = Matrix34::Zero(), weight_dot = Matrix34::Zero();
    weight.col(3) = at.gravity;
    weight_dot.col(3) = dot.gravity;
    const Vector6 loads = along_motions(weight * body.moments - body.velocity_start * damping, R) + at.loads;
    const Vector6 a = balance.accelerations(omega, loads, Vector6::Zero());
    const Matrix34 q = acceleration_of(R, omega, a);
    Matrix34 q_dot;
    q_dot << spin_change(omega, omega_dot, Vector3::Zero()) * R + spin_of(omega, a.tail<3>()) * dot.rotation, Vector3::Zero();
    const Matrix34 g = (weight - q) * body.moments - body.velocity_start * damping;
    const Matrix34 g_dot =
        (weight_dot - q_dot) * body.moments + (weight - q) * dot.moments - dot.velocity * damping - body.velocity_start * damping_dot;
    Vector6 residual_dot = along_motions(g_dot, R);
    residual_dot += dot.loads;
    residual_dot.tail<3>() += twice_axial(g.leftCols<3>() * dot.rotation.transpose());
    const Vector6 a_dot = balance.solved(residual_dot);
    Matrix34 out;
    out << spin_change(omega, omega_dot, a_dot.tail<3>()) * R + spin_of(omega, a.tail<3>()) * dot.rotation, a_dot.head<3>();
    return out;
}

StartChange start_acceleration_adjoint(const StartOf& at, const Matrix34& bar) {
    const Body& body = at.body;
    const Matrix3& R = body.pose_start.rotation;
    const bool is_damped = core::energy::is_damped(body);
    const Matrix4 damping = is_damped ? core::energy::damping_moments(body) : Matrix4(Matrix4::Zero());
    const Balance balance(body, R);
    const Vector3 omega = axial_vector(body.velocity_start.leftCols<3>() * R.transpose());
    Matrix34 weight = Matrix34::Zero();
    weight.col(3) = at.gravity;
    const Vector6 loads = along_motions(weight * body.moments - body.velocity_start * damping, R) + at.loads;
    const Vector6 a = balance.accelerations(omega, loads, Vector6::Zero());
    BalanceGradient sum;
    Vector6 a_bar = Vector6::Zero();
    add_acceleration_gradient(R, omega, a, bar, sum, a_bar);
    const BalanceGradient g = balance_gradient(body, R, balance, omega, a, {weight, a_bar});
    // The damping's - <V C, v>.
    Matrix34 v;
    v << cross_matrix(g.mu.tail<3>()) * R, g.mu.head<3>();
    StartChange out;
    out.velocity = -v * damping;
    out.rotation = sum.rotation + g.rotation - cross_matrix(g.mu.tail<3>()).transpose() * (body.velocity_start * damping).leftCols<3>();
    out.gravity = g.numeric.col(3);
    out.loads = g.mu;
    out.moments = g.moments;
    if (is_damped) {
        const Matrix4 m = v.transpose() * body.velocity_start;
        out.moments -= damping_moments_adjoint(body, 0.5 * (m + m.transpose()));
    }
    add_axial_gradient(body.velocity_start.leftCols<3>(), R, sum.omega + g.omega, out.velocity.leftCols<3>(), out.rotation);
    return out;
}

namespace {

// J_l(psi)^T tau = tau - a psi x tau + b psi x (psi x tau), and the parts of its derivative.
struct ChartTorque {
    Vector3 psi;
    double a = 0.5, b = 1.0 / 6, a_slope = -1.0 / 12, b_slope = -1.0 / 60;  // slopes: da/dx / x, db/dx / x
    Vector3 across, twice;                                                  // psi x tau, psi x (psi x tau)

    ChartTorque(const Vector3& torque, const Matrix3& rotation, const Matrix34& pose_hat)
        : psi(axial_vector(pose_hat.leftCols<3>() * rotation.transpose())), across(psi.cross(torque)), twice(psi.cross(across)) {
        const double x_squared = psi.squaredNorm(), x = std::sqrt(x_squared);
        constexpr double small = 1e-5;  // the next terms of the series are of size x^2
        if (x < small) return;
        const double half = core::kinematics::sinc(x / 2);
        a = 0.5 * half * half;
        b = (1 - core::kinematics::sinc(x)) / x_squared;
        a_slope = 0.25 * half * core::kinematics::sinc_g(x / 2);
        b_slope = -(core::kinematics::sinc_g(x) + 2 * b) / x_squared;
    }
};

}  // namespace

Vector3 chart_torque_tangent(const Vector3& torque, const Matrix3& rotation, const Matrix34& pose_hat, const ChartTorqueChange& dot) {
    const ChartTorque t(torque, rotation, pose_hat);
    const Vector3 psi_dot = axial_change(pose_hat.leftCols<3>(), rotation, dot.hat, dot.rotation);
    const Vector3 across_dot = psi_dot.cross(torque) + t.psi.cross(dot.torque);
    const double along = t.psi.dot(psi_dot);
    return dot.torque - t.a_slope * along * t.across - t.a * across_dot + t.b_slope * along * t.twice +
           t.b * (psi_dot.cross(t.across) + t.psi.cross(across_dot));
}

ChartTorqueChange chart_torque_adjoint(const Vector3& torque, const Matrix3& rotation, const Matrix34& pose_hat, const Vector3& bar) {
    const ChartTorque t(torque, rotation, pose_hat);
    ChartTorqueChange out;
    const Vector3 across_bar = t.b * bar.cross(t.psi) - t.a * bar;
    out.torque = bar + across_bar.cross(t.psi);
    const Vector3 psi_bar =
        (t.b_slope * bar.dot(t.twice) - t.a_slope * bar.dot(t.across)) * t.psi + t.b * t.across.cross(bar) + torque.cross(across_bar);
    add_axial_gradient(pose_hat.leftCols<3>(), rotation, psi_bar, out.hat, out.rotation);
    return out;
}

}  // namespace fettle::adjoint::energy
