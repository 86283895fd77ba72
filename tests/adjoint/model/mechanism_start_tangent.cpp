// SPDX-License-Identifier: MIT
#include "tests/adjoint/model/mechanism_start_tangent.hpp"

#include <Eigen/LU>

#include "adjoint/measure/measure_tangent.hpp"
#include "adjoint/model/body_mass_adjoint.hpp"
#include "core/model/mechanism_start.hpp"

namespace fettle::adjoint::model {
namespace {

using core::constraint::AssemblyProblem;
using core::constraint::Row;
using core::kinematics::Pose;
using core::model::Model;
using Changes = std::vector<Matrix34>;

Matrix34 matrix_of_motion(const Vector6& motion, const Matrix3& rotation) {
    Matrix34 out;
    out << cross_matrix(motion.tail<3>()) * rotation, motion.head<3>();
    return out;
}

// What a start is made of, with how it changes.
struct StartChanges {
    const Model& model;
    const AssemblyProblem& problem;
    std::vector<Pose> poses;  // assembled
    std::vector<Matrix4> moments_dot;
    const MechanismTangent& mechanism_dot;
};

// A row's c, G and their changes along changes of poses, frames and factors.
struct RowChange {
    double value_dot = 0;
    Changes gradient, gradient_dot;
};

RowChange row_change(const StartChanges& at, std::size_t i, const Changes& poses_dot, const MechanismTangent& dot) {
    const Row& row = at.problem.rows[i];
    const std::size_t n = at.poses.size();
    RowChange out{0, Changes(n, Matrix34::Zero()), Changes(n, Matrix34::Zero())};
    const std::vector<core::measure::PlacedFrame> frames = placed(at.problem.set.frames, at.poses);
    for (std::size_t k = 0; k < row.parts.size(); ++k) {
        const core::constraint::RowPart& part = row.parts[k];
        const core::measure::Measure& m = at.problem.set.measures[part.measure];
        const measure::MeasureTangent t = measure::measure_tangent(at.problem.set, m, {at.poses, poses_dot, dot.frames});
        const double factor_dot = dot.row_factors[row.number][k];
        out.value_dot += part.factor * t.value_dot;
        if (factor_dot != 0)
            out.value_dot += factor_dot * core::constraint::value_at(at.problem.set, part.measure, frames, at.model.mechanism.angles_start);
        const auto add = [&](int frame, const Matrix34& gradient, const Matrix34& gradient_dot) {
            const int body = at.problem.set.frames[frame].body;
            if (body == core::measure::world) return;
            out.gradient[body] += part.factor * gradient;
            out.gradient_dot[body] += part.factor * gradient_dot + factor_dot * gradient;
        };
        add(m.a, t.gradient_a, t.gradient_a_dot);
        add(m.b, t.gradient_b, t.gradient_b_dot);
    }
    return out;
}

// Unknowns: the coordinates that may move, then a multiplier per row. Residuals in the same order.
class StartSystem {
public:
    explicit StartSystem(const StartChanges& at)
        : at_(at), count_(at.problem.dofs.count), rows_(count_of(at.problem.rows)), still_(at.poses.size(), Matrix34::Zero()) {
        for (int i = 0; i < rows_; ++i) along_rest_.push_back(row_change(at_, static_cast<std::size_t>(i), still_, zero_mechanism()));
    }

    int size() const { return count_ + rows_; }

    // <G, V_k> of the coordinates that may move.
    void add_along_motions(const Changes& gradient, const std::vector<Matrix3>& rotations, VectorX& out) const {
        for (std::size_t b = 0; b < gradient.size(); ++b)
            for (int k = 0; k < 6; ++k)
                if (const int place = at_.problem.dofs.index[b][k]; place >= 0)
                    out[place] += gradient[b].cwiseProduct(matrix_of_motion(Vector6::Unit(k), rotations[b])).sum();
    }

    std::vector<Matrix3> rotations() const {
        std::vector<Matrix3> out;
        for (const Pose& pose : at_.poses) out.push_back(pose.rotation);
        return out;
    }

    // sum m_i G_i.
    Changes carried(const VectorX& multipliers) const {
        Changes out = still_;
        for (int i = 0; i < rows_; ++i)
            for (std::size_t b = 0; b < out.size(); ++b) out[b] += multipliers[i] * along_rest_[i].gradient[b];
        return out;
    }

    // m with <F + sum m_i G_i, V_k> = 0, nearly.
    VectorX multipliers(const Changes& forces) const {
        VectorX left = VectorX::Zero(count_);
        add_along_motions(forces, rotations(), left);
        MatrixX c(count_, rows_);
        for (int i = 0; i < rows_; ++i) {
            VectorX column = VectorX::Zero(count_);
            add_along_motions(along_rest_[i].gradient, rotations(), column);
            c.col(i) = column;
        }
        return c.fullPivHouseholderQr().solve(-left);
    }

    // The motions of a vector of coordinates; of those that may not move as told.
    std::vector<Vector6> motions(const VectorX& y, std::vector<Vector6> held) const {
        for (std::size_t b = 0; b < held.size(); ++b)
            for (int k = 0; k < 6; ++k)
                if (const int place = at_.problem.dofs.index[b][k]; place >= 0) held[b][k] = y[place];
        return held;
    }

    Changes matrices(const std::vector<Vector6>& motions) const {
        Changes out;
        for (std::size_t b = 0; b < motions.size(); ++b) out.push_back(matrix_of_motion(motions[b], at_.poses[b].rotation));
        return out;
    }

    // x with A x = -b, A's columns by `column(unit vector)`.
    template <class Column>
    VectorX solve(const VectorX& b, const Column& column) const {
        MatrixX a(size(), size());
        for (int k = 0; k < size(); ++k) a.col(k) = column(VectorX(VectorX::Unit(size(), k)));
        return a.fullPivLu().solve(-b);
    }

    MechanismTangent zero_mechanism() const { return zero_model_tangent(at_.model, 0).mechanism; }
    const RowChange& rest(int i) const { return along_rest_[i]; }
    const Changes& still() const { return still_; }
    int count() const { return count_; }
    int rows() const { return rows_; }

private:
    const StartChanges& at_;
    int count_, rows_;
    Changes still_;
    std::vector<RowChange> along_rest_;  // nothing changes: G alone counts
};

// How a row's right-hand side changes at the start, and how fast its curve begins.
double target_change(const Row& row, const MechanismTangent& dot) {
    double out = dot.row_constant[row.number];
    const std::vector<double> weights = core::scene::curve_weights(row.curve, 0);
    for (std::size_t k = 0; k < weights.size(); ++k) out += weights[k] * dot.row_values[row.number][k];
    return out;
}

double rate_change(const Model& model, const Row& row, const MechanismTangent& dot) {
    core::scene::Curve curve = row.curve;
    curve.values = dot.row_values[row.number];
    curve.rate = dot.row_rate[row.number];
    return core::model::rate_at_start(curve, model.timestep);
}

class Assembling {
public:
    explicit Assembling(const StartChanges& at) : at_(at), system_(at) {
        for (std::size_t b = 0; b < at.poses.size(); ++b)
            forces_.push_back((pose_matrix(at.poses[b]) - pose_matrix(at.model.mechanism.written.poses[b])) * at.problem.moments[b]);
        multipliers_ = system_.multipliers(forces_);
        const Changes carried = system_.carried(multipliers_);
        for (std::size_t b = 0; b < forces_.size(); ++b) whole_.push_back(forces_[b] + carried[b]);
    }

    std::vector<Vector6> tangent(const std::vector<Vector6>& written_dot) const {
        const Changes written = written_matrices(written_dot), none = system_.still();
        const std::vector<Vector6> held = system_.motions(VectorX::Zero(system_.count()), written_dot);
        const VectorX known = residual_dot(system_.matrices(held), written, at_.moments_dot, at_.mechanism_dot);
        const std::vector<Matrix4> no_moments(none.size(), Matrix4::Zero());
        const MechanismTangent no_mechanism = system_.zero_mechanism();
        const std::vector<Vector6> nothing(none.size(), Vector6::Zero());
        const VectorX x = system_.solve(known, [&](const VectorX& unit) {
            VectorX out = residual_dot(system_.matrices(system_.motions(unit, nothing)), none, no_moments, no_mechanism);
            system_.add_along_motions(system_.carried(unit.tail(system_.rows())), system_.rotations(), out);
            return out;
        });
        return system_.motions(x, held);
    }

private:
    Changes written_matrices(const std::vector<Vector6>& motions) const {
        Changes out;
        for (std::size_t b = 0; b < motions.size(); ++b)
            out.push_back(matrix_of_motion(motions[b], at_.model.mechanism.written.poses[b].rotation));
        return out;
    }

    // With the multipliers held.
    VectorX residual_dot(const Changes& poses_dot, const Changes& written_dot, const std::vector<Matrix4>& moments_dot,
                         const MechanismTangent& dot) const {
        VectorX out = VectorX::Zero(system_.size());
        Changes force_dot;
        for (std::size_t b = 0; b < poses_dot.size(); ++b) {
            const Matrix34 away = pose_matrix(at_.poses[b]) - pose_matrix(at_.model.mechanism.written.poses[b]);
            force_dot.push_back((poses_dot[b] - written_dot[b]) * at_.problem.moments[b] + away * moments_dot[b]);
        }
        for (int i = 0; i < system_.rows(); ++i) {
            const RowChange row = row_change(at_, static_cast<std::size_t>(i), poses_dot, dot);
            for (std::size_t b = 0; b < force_dot.size(); ++b) force_dot[b] += multipliers_[i] * row.gradient_dot[b];
            out[system_.count() + i] = row.value_dot - target_change(at_.problem.rows[i], dot);
        }
        system_.add_along_motions(force_dot, system_.rotations(), out);
        std::vector<Matrix3> rotations_dot;
        for (const Matrix34& p : poses_dot) rotations_dot.push_back(p.leftCols<3>());
        add_turning(whole_, rotations_dot, out);
        return out;
    }

    // <G, [[e_phi] R_dot, 0]>.
    void add_turning(const Changes& gradient, const std::vector<Matrix3>& rotations_dot, VectorX& out) const {
        Changes turning = gradient;
        for (Matrix34& g : turning) g.col(3).setZero();
        system_.add_along_motions(turning, rotations_dot, out);
    }

    const StartChanges& at_;
    StartSystem system_;
    Changes forces_, whole_;
    VectorX multipliers_;
};

class Agreeing {
public:
    explicit Agreeing(const StartChanges& at) : at_(at), system_(at) {
        const std::vector<Vector6>& written = at.model.mechanism.written.velocities;
        VectorX b = VectorX::Zero(system_.size());
        const Changes moving = system_.matrices(written);
        for (int i = 0; i < system_.rows(); ++i)
            b[system_.count() + i] = change_of_row(i, moving) - core::model::rate_at_start(at.problem.rows[i].curve, at.model.timestep);
        const std::vector<Vector6> nothing(written.size(), Vector6::Zero());
        const VectorX x = system_.solve(b, [&](const VectorX& unit) { return times(unit, nothing); });
        delta_ = system_.motions(x, nothing);
        multipliers_ = x.tail(system_.rows());
        for (std::size_t k = 0; k < written.size(); ++k) agreed_.push_back(written[k] + delta_[k]);
    }

    const std::vector<Vector6>& agreed() const { return agreed_; }

    // @param poses_dot  (q, phi) of the assembled.
    std::vector<Vector6> tangent(const std::vector<Vector6>& poses_dot, const std::vector<Vector6>& written_dot) const {
        const Changes moved = system_.matrices(poses_dot), moving = system_.matrices(agreed_), written = system_.matrices(written_dot);
        const Changes delta = system_.matrices(delta_), carried = system_.carried(multipliers_);
        const std::size_t n = moved.size();
        VectorX known = VectorX::Zero(system_.size());
        Changes force_dot, force, agreed_dot;
        std::vector<Matrix3> rotations_dot;
        for (std::size_t b = 0; b < n; ++b) {
            const Matrix34 delta_turned = turned(delta_[b], moved[b]);
            force_dot.push_back(delta_turned * at_.problem.moments[b] + delta[b] * at_.moments_dot[b]);
            force.push_back(delta[b] * at_.problem.moments[b] + carried[b]);
            force.back().col(3).setZero();
            agreed_dot.push_back(turned(agreed_[b], moved[b]) + written[b]);
            rotations_dot.push_back(moved[b].leftCols<3>());
        }
        for (int i = 0; i < system_.rows(); ++i) {
            const auto row = static_cast<std::size_t>(i);
            const RowChange change = row_change(at_, row, moved, at_.mechanism_dot);
            double& rate = known[system_.count() + i];
            for (std::size_t b = 0; b < n; ++b) {
                force_dot[b] += multipliers_[i] * change.gradient_dot[b];
                rate += change.gradient_dot[b].cwiseProduct(moving[b]).sum() + change.gradient[b].cwiseProduct(agreed_dot[b]).sum();
            }
            rate -= rate_change(at_.model, at_.problem.rows[row], at_.mechanism_dot);
        }
        system_.add_along_motions(force_dot, system_.rotations(), known);
        system_.add_along_motions(force, rotations_dot, known);
        const std::vector<Vector6> nothing(n, Vector6::Zero());
        std::vector<Vector6> out =
            system_.motions(system_.solve(known, [&](const VectorX& unit) { return times(unit, nothing); }), nothing);
        for (std::size_t b = 0; b < n; ++b) out[b] += written_dot[b];
        return out;
    }

private:
    static Matrix34 turned(const Vector6& motion, const Matrix34& pose_dot) {
        Matrix34 out = Matrix34::Zero();
        out.leftCols<3>() = cross_matrix(motion.tail<3>()) * pose_dot.leftCols<3>();
        return out;
    }

    double change_of_row(int i, const Changes& motion) const {
        double out = 0;
        for (std::size_t b = 0; b < motion.size(); ++b) out += system_.rest(i).gradient[b].cwiseProduct(motion[b]).sum();
        return out;
    }

    // The system's matrix.
    VectorX times(const VectorX& x, const std::vector<Vector6>& nothing) const {
        const Changes delta = system_.matrices(system_.motions(x, nothing));
        Changes force = system_.carried(x.tail(system_.rows()));
        for (std::size_t b = 0; b < force.size(); ++b) force[b] += delta[b] * at_.problem.moments[b];
        VectorX out = VectorX::Zero(system_.size());
        system_.add_along_motions(force, system_.rotations(), out);
        for (int i = 0; i < system_.rows(); ++i) out[system_.count() + i] = change_of_row(i, delta);
        return out;
    }

    const StartChanges& at_;
    StartSystem system_;
    std::vector<Vector6> delta_, agreed_;
    VectorX multipliers_;
};

}  // namespace

StartTangent written_start_tangent(const Model& model, const WrittenStartTangent& written, const ModelTangent& direction) {
    const std::size_t n = model.bodies.size();
    StartTangent out{written.pose, Changes(n)};
    std::vector<Vector6> velocity = written.velocity;
    if (!model.mechanism.rows.empty()) {
        const AssemblyProblem problem = core::model::start_problem(model);
        StartChanges at{model, problem, {}, {}, direction.mechanism};
        for (std::size_t i = 0; i < n; ++i) {
            at.poses.push_back(model.bodies[i].pose_start);
            at.moments_dot.push_back(mass_moments_tangent(model.bodies[i], model.dhat, direction.bodies[i]));
        }
        out.pose = Assembling(at).tangent(written.pose);
        if (!model.mechanism.written.velocities.empty()) {
            std::vector<Vector6> seen = written.velocity;  // by the rows: of a prescribed coordinate its curve's rate
            for (std::size_t i = 0; i < n; ++i)
                for (int k = 0; k < 6; ++k)
                    if (!is_free(model.bodies[i], k)) seen[i][k] = written.rate[i][k];
            const std::vector<Vector6> agreed = Agreeing(at).tangent(out.pose, seen);
            for (std::size_t i = 0; i < n; ++i)
                for (int k = 0; k < 6; ++k)
                    if (is_free(model.bodies[i], k) || model.mechanism.written.is_velocity_changed[i]) velocity[i][k] = agreed[i][k];
        }
    }
    for (std::size_t i = 0; i < n; ++i) {
        const Matrix3& R = model.bodies[i].pose_start.rotation;
        const Matrix3 omega = model.bodies[i].velocity_start.leftCols<3>() * R.transpose();
        out.velocity[i] = matrix_of_motion(velocity[i], R);
        out.velocity[i].leftCols<3>() += omega * cross_matrix(out.pose[i].tail<3>()) * R;
    }
    return out;
}

}  // namespace fettle::adjoint::model
