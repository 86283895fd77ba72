// SPDX-License-Identifier: MIT
#include "fettle/core/solver/newton.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "fettle/core/contact/safe_step.hpp"
#include "fettle/core/solver/failure.hpp"

namespace fettle::core::solver {
namespace {

using contact::HessianKind;
using kinematics::ChartPoint;
using kinematics::PathSegment;
using kinematics::Pose;

constexpr double sufficient_decrease = 1e-4;
constexpr double smallest_step = 1e-12;
constexpr double stalled_step = 1e-3;  // a step this short, again and again, means that the way is blocked
constexpr double smallest_drive = 1e-4;
constexpr double short_step = 0.1;
constexpr int careful_iterations = 4;
constexpr int longest_rest = 12;         // iterations
constexpr double relaxed_motion = 0.25;  // of dhat: pushed bodies that move no more have given way
constexpr int stalled_iterations = 50;
constexpr double prescribed_tolerance = 1e-9;  // of the scene's size (method.md section 9)
constexpr double largest_turn = 0.3;           // of one iteration [rad], or twice what the body turns in a step as it goes
constexpr double largest_shift = 0.1;          // of the scene's size, or twice what the body moves
constexpr int stagnant_iterations = 12;        // without a smaller residual, when rounding is all that is left
constexpr int most_friction_rounds = 30;     // when they are to converge: normal forces that do not settle must not hold up the simulation
constexpr double friction_resolution = 0.1;  // of eps_v
constexpr double usable_residual = 1e-8;     // of a solve to rounding that stagnates: the adjoint's accuracy

Vector6 coordinates(const ChartPoint& p) {
    Vector6 y;
    y << p.position, p.rotation_vector;
    return y;
}

ChartPoint chart_point(const Vector6& y) { return {y.head<3>(), y.tail<3>()}; }

struct Direction {
    std::vector<Vector6> step;       // per body
    std::vector<Vector6> remaining;  // of the prescribed coordinates
    double remaining_norm = 0;       // l1, rotations times the body's radius [m]
    double drive = 1;                // share of what remains that the step takes
    double slope = 0;                // g . step
    double motion = 0;               // bound on the largest motion of a point of a body that is solved for [m]
    double residual = 0;
    double rounding = 0;  // of the potential's value here: what a difference of two values may be wrong by
    HessianKind kind = HessianKind::exact;
};

class Minimiser {
public:
    Minimiser(energy::StepProblem problem, const std::vector<Vector6>& targets, NewtonWorkspace& workspace, const NewtonOptions& options)
        : problem_(std::move(problem)),
          model_(*problem_.model),
          targets_(targets),
          dofs_(workspace.dofs),
          linear_(workspace.linear),
          candidates_(workspace.candidates),
          clock_(workspace.clock),
          options_(options) {
        for (const Pose& pose : problem_.poses_t0) points_.push_back({pose.position, Vector3::Zero()});
        result_.poses = problem_.poses_t0;
        result_.path.push_back(points_);
    }

    NewtonResult run() {
        const std::vector<PathSegment> here = segments_to(points_);
        cover(here);
        settle(result_.poses, candidates_);
        find_contacts();
        const bool frictional = model_.friction.rounds != 0 && model_.friction.mu.maxCoeff() > 0;
        do {
            if (frictional) lag_friction();
            value_ = potential(points_, result_.poses);
            first_of_round_ = result_.iterations;
            while (iterate()) {
            }
        } while (frictional && another_round());
        result_.contacts = std::move(contacts_);
        result_.friction = std::move(problem_.friction);
        return std::move(result_);
    }

private:
    bool stop(NewtonStatus status, const std::string& message = {}) {
        result_.status = status;
        result_.message = message;
        return false;
    }

    void find_contacts() {
        const auto span = clock_.charge(SolvePhase::contacts);
        contacts_ = contact::find_contacts(model_, candidates_, result_.poses);
    }

    double potential(const std::vector<ChartPoint>& points, const std::vector<Pose>& poses) {
        const auto span = clock_.charge(SolvePhase::potential);
        return energy::incremental_potential(problem_, points, poses, candidates_);
    }

    energy::ChartDerivatives derivatives(HessianKind kind) {
        const auto span = clock_.charge(SolvePhase::derivatives);
        return energy::chart_derivatives(problem_, points_, result_.poses, contacts_, kind);
    }

    bool factorise(const kinematics::BlockHessian& hessian) {
        const auto span = clock_.charge(SolvePhase::linear_solve);
        return linear_.factorise(hessian);
    }

    void cover(const std::vector<PathSegment>& segments) {
        const auto span = clock_.charge(SolvePhase::broad_phase);
        contact::cover(model_, segments, candidate_allowance(model_), candidates_);
    }

    // Normal forces and tangents of where we are.
    void lag_friction() {
        problem_.friction =
            contact::lag_friction(model_, contacts_, result_.poses, problem_.barrier, problem_.slip_reference, problem_.slip_time);
        ++result_.friction_rounds;
    }

    // A round that needed no step has met its own normal forces: the fixed point.
    bool another_round() const {
        if (result_.status != NewtonStatus::converged) return false;
        if (problem_.friction.pairs.empty() && contacts_.count == 0) return false;
        const bool settled = result_.friction_rounds > 1 && result_.iterations == first_of_round_;
        const int rounds = model_.friction.rounds;
        return rounds > 0 ? result_.friction_rounds < rounds : !settled && result_.friction_rounds < most_friction_rounds;
    }

    // A step is due unless this round has made one, or an earlier round has and this one starts where it ended.
    bool has_moved() const { return result_.iterations > first_of_round_ || result_.friction_rounds > 1; }

    // Velocities below eps_v are what friction tells sticking from sliding by: they must be resolved.
    double velocity_tolerance() const {
        if (problem_.friction.pairs.empty()) return options_.velocity_tolerance;
        return std::min(options_.velocity_tolerance, friction_resolution * model_.friction.eps_v);
    }

    // One Newton iteration. @return whether to go on.
    bool iterate() {
        if (options_.should_stop && options_.should_stop())
            return stop(NewtonStatus::interrupted, "stopped on request; the steps before it are whole");
        if (result_.iterations > 0) find_contacts();
        const HessianKind kind = projected_iterations_ > 0 ? HessianKind::projected : HessianKind::exact;
        projected_iterations_ = std::max(0, projected_iterations_ - 1);
        Direction direction;
        if (!find_direction(kind, direction))
            return stop(NewtonStatus::not_converged, "the Newton matrix could not be made positive definite");
        result_.residual = direction.residual;
        const bool arrived = direction.remaining_norm == 0;
        const bool slow = direction.motion <= velocity_tolerance() * model_.timestep;
        if (!options_.to_rounding && has_moved() && arrived && slow) return stop(NewtonStatus::converged);
        if (result_.iterations >= options_.max_iterations)
            return stop(failure(direction), failure_message(direction, "too many Newton iterations"));

        if (options_.to_rounding && has_moved() && arrived && slow && is_stagnant(direction)) {
            if (direction.residual <= usable_residual) return stop(NewtonStatus::converged);
            return stop(NewtonStatus::not_converged,
                        failure_message(direction, "rounding stops the solve before it is accurate enough for a gradient"));
        }

        ++result_.iterations;
        const double fraction = search(direction);
        // Cut short by the potential, not by CCD: contacts that change from sliding one way to the other, over the valley where they stick.
        if (!problem_.friction.pairs.empty() && fraction < short_step * limiting_.fraction)
            projected_iterations_ = std::max(projected_iterations_, careful_iterations);
        // What is pushed must have time to give way: drive less where little was possible, more where much was.
        if (resting_ > 0) {
            const bool relaxed = fraction == 1 && direction.motion <= relaxed_motion * model_.dhat;
            resting_ = relaxed ? 0 : resting_ - 1;
        } else if (!arrived) {
            drive_ = fraction < 0.25 ? std::max(smallest_drive, 0.25 * drive_) : std::min(1.0, 2 * drive_);
            resting_ = fraction < 0.25 ? longest_rest : 0;
        }
        if (fraction == 0 && !arrived && drive_ > smallest_drive) {
            penalty_ *= 10;
            return true;
        }
        if (fraction == 0 && direction.kind == HessianKind::exact) {
            projected_iterations_ = 3;
            return true;
        }
        if (fraction == 0) {
            if (near_enough(direction) && slow) return stop(NewtonStatus::converged);
            return stop(failure(direction), failure_message(direction, "no step decreases the potential"));
        }
        if (direction.drive > 0) stalled_ = fraction * direction.drive < stalled_step ? stalled_ + 1 : 0;
        if (!arrived && stalled_ >= stalled_iterations && near_enough(direction)) return stop(NewtonStatus::converged);
        if (!arrived && stalled_ >= stalled_iterations)
            return stop(NewtonStatus::blocked, failure_message(direction, "its way is blocked"));
        // A full exact step this small leaves an error of its square over the gap: rounding.
        const double rounding_motion = 1e-7 * std::min(model_.dhat, contacts_.minimum_distance - model_.dmin);
        if (options_.to_rounding && fraction == 1 && arrived && direction.kind == HessianKind::exact && direction.motion <= rounding_motion)
            return finish_at_rounding();
        return true;
    }

    // Rounding is all that is left when the potential has nothing to gain and the residual no longer shrinks. (Passing a saddle, the
    // residual grows for a while, but the potential falls.)
    bool is_stagnant(const Direction& direction) {
        if (direction.residual < 0.5 * least_residual_ || -direction.slope > 100 * direction.rounding) {
            least_residual_ = std::min(least_residual_, direction.residual);
            since_least_ = 0;
            return false;
        }
        return ++since_least_ >= stagnant_iterations;
    }

    // The residual that is reported belongs to the final point.
    bool finish_at_rounding() {
        find_contacts();
        const energy::ChartDerivatives d = derivatives(HessianKind::projected);
        result_.residual = residual_of(d);
        return stop(NewtonStatus::converged);
    }

    double residual_of(const energy::ChartDerivatives& d) const {
        double square = 0, magnitude = 0;
        for (std::size_t i = 0; i < d.gradient.size(); ++i) {
            for (int k = 0; k < 6; ++k) {
                if (dofs_.index[i][k] < 0) continue;
                const double g = k < 3 ? d.gradient[i][k] : d.gradient[i][k] / std::max(model_.bodies[i].radius, model_.dhat);
                square += g * g;
            }
            magnitude += d.force_magnitude[i] + model_.bodies[i].moments(3, 3) * model_.velocity_tolerance * model_.timestep;
        }
        return magnitude > 0 ? std::sqrt(square) / magnitude : std::sqrt(square);
    }

    // Positions carry an error of a few ulp of their size; the value moves by force times that, and by its square through the inertia.
    double rounding_of(const energy::ChartDerivatives& d) const {
        double sum = 0;
        for (std::size_t i = 0; i < points_.size(); ++i) {
            const model::Body& body = model_.bodies[i];
            const double ulp = 16 * std::numeric_limits<double>::epsilon() * (points_[i].position.norm() + body.radius);
            sum += d.force_magnitude[i] * ulp + body.moments(3, 3) * ulp * ulp;
        }
        return sum;
    }

    bool find_direction(HessianKind kind, Direction& direction) {
        energy::ChartDerivatives d = derivatives(kind);
        bool definite = dofs_.count == 0 || factorise(d.hessian);
        if (!definite && kind == HessianKind::exact) {
            projected_iterations_ = 1;
            kind = HessianKind::projected;
            d = derivatives(kind);
            definite = factorise(d.hessian);
        }
        for (double shift = 1e-12; !definite && shift < 1e3; shift *= 100) {
            for (Matrix6& block : d.hessian.diagonal) block.diagonal() *= 1 + shift;
            definite = factorise(d.hessian);
        }
        if (!definite) return false;
        direction.kind = kind;
        direction.residual = residual_of(d);
        direction.rounding = rounding_of(d);
        fill_direction(d, direction);
        return true;
    }

    void fill_direction(const energy::ChartDerivatives& d, Direction& direction) {
        const std::size_t n = points_.size();
        direction.remaining.assign(n, Vector6::Zero());
        for (std::size_t i = 0; i < n; ++i) {
            const Vector6 current = coordinates(points_[i]);
            for (int k = 0; k < 6; ++k) {
                if (dofs_.index[i][k] >= 0) continue;
                direction.remaining[i][k] = targets_[i][k] - current[k];
                direction.remaining_norm += std::abs(direction.remaining[i][k]) * (k < 3 ? 1.0 : model_.bodies[i].radius);
            }
        }
        direction.drive = direction.remaining_norm > 0 ? (resting_ > 0 ? 0 : drive_) : 1;
        direction.step = direction.remaining;
        for (Vector6& step : direction.step) step *= direction.drive;
        if (dofs_.count > 0) {
            VectorX rhs = -gather(dofs_, d.gradient);
            if (direction.remaining_norm > 0) rhs -= gather(dofs_, multiply(d.hessian, direction.step));
            const auto span = clock_.charge(SolvePhase::linear_solve);
            scatter(dofs_, linear_.solve(rhs), direction.step);
        }
        shorten(direction);
        for (std::size_t i = 0; i < n; ++i) {
            direction.slope += d.gradient[i].dot(direction.step[i]);
            bool solved_for = false;
            for (int index : dofs_.index[i]) solved_for = solved_for || index >= 0;
            if (solved_for)
                direction.motion = std::max(
                    direction.motion, direction.step[i].head<3>().norm() + direction.step[i].tail<3>().norm() * model_.bodies[i].radius);
        }
    }

    // A nearly singular Hessian sends bodies round the world, where every search is dear and nothing is gained.
    void shorten(Direction& direction) const {
        double fraction = 1;
        for (std::size_t i = 0; i < points_.size(); ++i) {
            const Matrix34 stride = problem_.pose_hat[i] - pose_matrix(problem_.poses_t0[i]);
            const Vector6 &step = direction.step[i], &remaining = direction.remaining[i];
            const double shift = std::max(largest_shift * model_.diagonal, 2 * (stride.col(3).norm() + remaining.head<3>().norm()));
            const double turn = std::max(largest_turn, 2 * (stride.leftCols<3>().norm() + remaining.tail<3>().norm()));
            fraction = std::min(fraction, shift / std::max(shift, step.head<3>().norm()));
            fraction = std::min(fraction, turn / std::max(turn, step.tail<3>().norm()));
        }
        if (fraction == 1) return;
        for (Vector6& step : direction.step) step *= fraction;
        direction.drive *= fraction;
    }

    std::vector<ChartPoint> moved(const Direction& direction, double fraction) const {
        std::vector<ChartPoint> out(points_.size());
        for (std::size_t i = 0; i < points_.size(); ++i) {
            Vector6 y = coordinates(points_[i]) + fraction * direction.step[i];
            if (fraction == 1 && direction.drive == 1)  // prescribed coordinates arrive exactly
                for (int k = 0; k < 6; ++k)
                    if (dofs_.index[i][k] < 0) y[k] = targets_[i][k];
            out[i] = chart_point(y);
        }
        return out;
    }

    // The slope cannot foresee a contact that is not active yet: the penalty must outweigh a barrier's force and the push of all bodies.
    double least_penalty(double remaining) const {
        double mass = 0;
        for (const model::Body& body : model_.bodies) mass += body.moments(3, 3);
        return 100 * problem_.weight * problem_.kappa * model_.dhat + 10 * mass * remaining;
    }

    std::vector<PathSegment> segments_to(const std::vector<ChartPoint>& end) const {
        std::vector<PathSegment> segments(points_.size());
        for (std::size_t i = 0; i < points_.size(); ++i) segments[i] = path_between(problem_.poses_t0[i].rotation, points_[i], end[i]);
        return segments;
    }

    // How far all bodies may go.
    contact::SafeStep safe_step(const Direction& direction) {
        const std::vector<PathSegment> segments = segments_to(moved(direction, 1));
        cover(segments);
        const auto span = clock_.charge(SolvePhase::ccd);
        return contact::longest_safe_step(model_, candidates_, segments);
    }

    // CCD, then backtracking; accepts the point found. @return the fraction of the direction taken, 0 if none.
    double search(const Direction& direction) {
        const contact::SafeStep safe = safe_step(direction);
        limiting_ = safe;
        const double remaining = direction.drive * direction.remaining_norm;
        if (remaining > 0) penalty_ = std::max({penalty_, 2 * direction.slope / remaining, least_penalty(remaining)});
        const double slope = direction.slope - penalty_ * remaining;
        for (double fraction = safe.fraction; fraction > smallest_step; fraction *= 0.5) {
            std::vector<ChartPoint> trial = moved(direction, fraction);
            std::vector<Pose> poses = poses_of(problem_, trial);
            const double value = potential(trial, poses);
            const double change = value - value_ - penalty_ * fraction * remaining;
            if (!(change <= sufficient_decrease * fraction * slope + direction.rounding)) continue;
            settle(poses, candidates_);
            points_ = std::move(trial);
            result_.poses = std::move(poses);
            value_ = value;
            result_.path.push_back(points_);
            return fraction;
        }
        settle(result_.poses, candidates_);
        return 0;
    }

    // Prescribed coordinates are met to this where contact leaves no more (a gap that closes altogether).
    bool near_enough(const Direction& direction) const { return direction.remaining_norm <= prescribed_tolerance * model_.diagonal; }

    NewtonStatus failure(const Direction& direction) const {
        return direction.remaining_norm > 0 ? NewtonStatus::blocked : NewtonStatus::not_converged;
    }

    std::string failure_message(const Direction& direction, const std::string& cause) const {
        return describe_failure({problem_, contacts_, direction.remaining, limiting_, direction.residual, cause});
    }

    energy::StepProblem problem_;  // the friction lag changes from round to round
    const model::Model& model_;
    const std::vector<Vector6>& targets_;
    const FreeDofs& dofs_;
    LinearSolver& linear_;
    contact::Candidates& candidates_;
    base::PhaseClock<SolvePhase>& clock_;
    const NewtonOptions& options_;
    std::vector<ChartPoint> points_;
    contact::ContactSet contacts_;
    contact::SafeStep limiting_;
    double value_ = 0;
    double penalty_ = 0;
    double drive_ = 1;
    int resting_ = 0;         // iterations that leave the prescribed coordinates where they are
    int first_of_round_ = 0;  // iterations before this round of friction
    int projected_iterations_ = 0;
    int stalled_ = 0;
    double least_residual_ = std::numeric_limits<double>::infinity();
    int since_least_ = 0;
    NewtonResult result_;
};

}  // namespace

const char* to_string(SolvePhase phase) {
    static constexpr std::array names{"broad_phase", "contacts", "derivatives", "linear_solve", "ccd", "potential"};
    static_assert(names.size() == static_cast<std::size_t>(SolvePhase::count));
    return names[static_cast<std::size_t>(phase)];
}

double candidate_allowance(const model::Model& model) { return model.dhat; }

NewtonResult minimise(energy::StepProblem problem, const std::vector<Vector6>& targets, NewtonWorkspace& workspace,
                      const NewtonOptions& options) {
    return Minimiser(std::move(problem), targets, workspace, options).run();
}

}  // namespace fettle::core::solver
