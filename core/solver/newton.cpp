// SPDX-License-Identifier: MIT
#include "core/solver/newton.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "core/base/parallel.hpp"
#include "core/ccd/linear_ccd.hpp"
#include "core/ccd/safe_step.hpp"
#include "core/solver/caution.hpp"
#include "core/solver/coasting.hpp"
#include "core/solver/failure.hpp"
#include "core/solver/newton_direction.hpp"
#include "core/solver/prescribed_drive.hpp"
#include "core/solver/touching_groups.hpp"

namespace fettle::core::solver {
namespace {

using contact::HessianKind;
using kinematics::ChartPoint;
using kinematics::PathSegment;
using kinematics::Pose;

constexpr double sufficient_decrease = 1e-4;
constexpr double smallest_step = 1e-12;
constexpr double short_step = 0.1;
constexpr int careful_iterations = 4;
constexpr int patient_shifts = 8;              // of the exact Hessian, where nothing is driven
constexpr double relaxed_motion = 0.25;        // of dhat: pushed bodies that move no more have given way
constexpr double prescribed_tolerance = 1e-9;  // of the scene's size (docs/method/joints.md#prescribed-coordinates)
constexpr int stagnant_iterations = 12;        // without a smaller residual, when rounding is all that is left
constexpr int usual_iterations = 40;           // of a round; one that takes more under joints has its solves refined fully
constexpr double saddle_growth = 10;           // of the residual over its least: more than rounding makes it waver
constexpr double telling_shift = 1;            // of the inertia: up to it a step is at least half of the one under inertia alone
constexpr int most_friction_rounds = 30;      // when they are to converge: normal forces that do not settle must not hold up the simulation
constexpr int most_settling_rounds = 100;     // when they are to agree to rounding, for a gradient
constexpr double settled_motion = 1e-13;      // of the scene's size: that
constexpr double friction_resolution = 0.1;   // of eps_v
constexpr double stop_range = 0.1;            // of what a joint's stop gives way by
constexpr double usable_residual = 1e-8;      // of a solve to rounding: the adjoint's accuracy
constexpr double rounding_of_places = 1e-14;  // of the scene's size
constexpr int bodies_a_loop = 32;             // that a thread takes

class Minimiser {
public:
    Minimiser(energy::StepProblem& problem, const std::vector<Vector6>& targets, NewtonWorkspace& workspace, const NewtonOptions& options)
        : problem_(problem),
          model_(*problem_.model),
          targets_(targets),
          workspace_(workspace),
          options_(options),
          caution_(options.caution),
          joints_rub_(std::any_of(model_.mechanism.terms.begin(), model_.mechanism.terms.end(),
                                  [](const model::MeasureTerm& term) { return term.kind == model::LawKind::friction; })),
          joints_stop_(std::any_of(model_.mechanism.terms.begin(), model_.mechanism.terms.end(),
                                   [](const model::MeasureTerm& term) { return term.kind == model::LawKind::stop; })) {
        for (const model::Body& body : model_.bodies)
            if (energy::has_free_dof(body)) smallest_radius_ = std::min(smallest_radius_, std::max(body.radius, model_.dhat));
        at_ = options_.start.empty() ? start_of_step() : Iterate{options_.start, poses_of(problem_, options_.start), {}};
        result_.path.push_back(at_.points);
    }

    NewtonResult run() {
        if (workspace_.rows) workspace_.rows->refine_fully(false);
        if (!take_known_contacts()) find_first_contacts();
        frictional_ = model_.friction.rounds != 0 && model_.friction.mu.maxCoeff() > 0;
        do {
            if (frictional_) lag_friction_of_round();
            value_ = potential(at_);
            if (result_.friction_rounds == 1 && may_coast()) begin_where_bodies_coast();
            first_of_round_ = result_.iterations;
            least_share_ = std::numeric_limits<double>::infinity();
            since_least_share_ = 0;
            while (iterate()) {
            }
            if (frictional_ && options_.keep_rounds) keep_round();
        } while (frictional_ && another_round());
        result_.poses = std::move(at_.poses);
        result_.contacts = std::move(at_.contacts);
        result_.friction = std::exchange(problem_.friction, {});
        workspace_.slides = mostly_slides(result_.friction, result_.poses);
        if (workspace_.rows) result_.multipliers = workspace_.rows->multipliers();
        return std::move(result_);
    }

private:
    Iterate start_of_step() const {
        Iterate start;
        start.points.reserve(problem_.poses_t0.size());
        for (const Pose& pose : problem_.poses_t0) start.points.push_back({pose.position, Vector3::Zero()});
        start.poses = problem_.poses_t0;
        return start;
    }

    bool stop(NewtonStatus status, const std::string& message = {}) {
        result_.status = status;
        result_.message = message;
        return false;
    }

    void find_contacts(Iterate& at) {
        const auto span = workspace_.clock.charge(SolvePhase::contacts);
        at.contacts = contact::find_contacts(model_, workspace_.candidates, at.poses, &workspace_.contact_plans);
    }

    void find_first_contacts() {
        cover(segments_to(at_.points));
        settle(at_.poses, workspace_.candidates);
        find_contacts(at_);
    }

    // Those of the step before, where it ended.
    bool take_known_contacts() {
        KnownContacts known = std::exchange(workspace_.contacts, {});
        const auto same = [](const Pose& a, const Pose& b) { return a.position == b.position && a.rotation == b.rotation; };
        if (!std::equal(known.poses.begin(), known.poses.end(), at_.poses.begin(), at_.poses.end(), same)) return false;
        at_.contacts = std::move(known.contacts);
        return true;
    }

    double potential(const Iterate& at) {
        const auto span = workspace_.clock.charge(SolvePhase::potential);
        return energy::incremental_potential(problem_, at.points, at.poses, at.contacts);
    }

    void cover(const std::vector<PathSegment>& segments) {
        const auto span = workspace_.clock.charge(SolvePhase::broad_phase);
        ccd::cover(model_, segments, candidate_allowance(model_), workspace_.candidates);
    }

    // Normal forces and tangents of where we are.
    void lag_friction() { lag_friction(at_.contacts, at_.poses); }
    void lag_friction(const contact::ContactSet& contacts, const std::vector<Pose>& poses) {
        problem_.friction = contact::lag_friction(model_, contacts, poses, problem_.barrier, problem_.slip_reference, problem_.slip_time);
        ++result_.friction_rounds;
    }

    // The first are those of the step's start, also where this solve begins on the step's way: so the end does not depend on that way. With
    // caution the first are irrelevant.
    void lag_friction_of_round() {
        const bool begins_on_the_way = result_.friction_rounds == 0 && !options_.start.empty() && !(options_.caution > 0);
        if (!begins_on_the_way) return lag_friction();
        const std::vector<Pose>& start = problem_.poses_t0;
        lag_friction(contact::find_contacts(model_, ccd::find_candidates(model_, start, 0), start), start);
    }

    static bool mostly_slides(const contact::FrictionSet& friction, const std::vector<Pose>& poses) {
        return sliding_share(friction, poses) > 0.5;
    }

    // Not with joints, which straight ways leave.
    bool may_coast() const { return workspace_.slides && !caution_.is_on() && !workspace_.rows && options_.start.empty(); }

    // From the start of a step friction holds what slides, and Newton steps are no longer than it takes to tell sticking from sliding: half
    // a dozen of them go by before it slides again. Bodies that coast do not have to get going.
    void begin_where_bodies_coast() {
        std::vector<ChartPoint> points = coasted(problem_, targets_, workspace_.dofs());
        if (points.empty()) return;
        Iterate ahead{std::move(points), {}, {}};
        ahead.poses = poses_of(problem_, ahead.points);
        if (!mostly_slides(problem_.friction, ahead.poses)) return;
        if (is_clear_to(ahead)) {
            find_contacts(ahead);
            if (const double value = potential(ahead); value <= value_) {
                settle(ahead.poses, workspace_.candidates);
                at_ = std::move(ahead);
                value_ = value;
                result_.path.push_back(at_.points);
                return;
            }
        }
        settle(at_.poses, workspace_.candidates);
    }

    // Searches the straight way there.
    bool is_clear_to(const Iterate& ahead) {
        const std::vector<PathSegment> segments = segments_to(ahead.points);
        cover(segments);
        const auto span = workspace_.clock.charge(SolvePhase::ccd);
        return ccd::longest_safe_step(model_, workspace_.candidates, segments, &at_.contacts.distances).fraction == 1;
    }

    // On the way to an equilibrium that may be far: with the normal forces of where it begins a block would be off its incline before
    // they are there. They are held from where caution ends.
    void follow_friction() {
        lag_friction();
        --result_.friction_rounds;
        value_ = potential(at_);
    }

    // A round that needed no step has met its own normal forces: the fixed point. One that ends where an earlier one did would only be
    // followed by what has followed that one: normal forces that go to and fro.
    bool another_round() {
        if (result_.status != NewtonStatus::converged) return false;
        if (problem_.friction.pairs.empty() && at_.contacts.count == 0) return false;
        if (options_.keep_rounds && options_.caution > 0) return !is_fixed_point();
        const int rounds = model_.friction.rounds;
        if (rounds > 0) return result_.friction_rounds < rounds;
        const bool settled = result_.friction_rounds > 1 && result_.iterations == first_of_round_;
        if (settled || result_.friction_rounds >= most_friction_rounds || has_been_here()) return false;
        ends_of_rounds_.push_back(at_.points);
        return true;
    }

    // The first lag of a cautious step is that of a point on the way, which is no solution of anything: a derivative needs the normal
    // forces of the end. Then the last two ends tell whether the lag has these.
    bool is_fixed_point() const {
        const auto& ends = result_.round_ends;
        return result_.friction_rounds >= most_settling_rounds ||
               (ends.size() > 1 && is_within(ends.front(), settled_motion * model_.diagonal));
    }

    void keep_round() {
        auto& ends = result_.round_ends;
        ends.push_back(at_.points);
        result_.round_contacts.push_back({at_.poses, at_.contacts});
        if (options_.caution > 0 && ends.size() > 2) {
            ends.erase(ends.begin());
            result_.round_contacts.erase(result_.round_contacts.begin());
        }
    }

    bool is_within(const std::vector<ChartPoint>& end, double enough) const {
        for (std::size_t i = 0; i < end.size(); ++i) {
            Vector6 way;
            way << at_.points[i].position - end[i].position, at_.points[i].rotation_vector - end[i].rotation_vector;
            if (!(motion_of(model_.bodies[i], way) <= enough)) return false;
        }
        return true;
    }

    // To the tolerance.
    bool has_been_here() const {
        const double enough = velocity_tolerance() * model_.timestep;
        return std::any_of(ends_of_rounds_.begin(), ends_of_rounds_.end(),
                           [&](const std::vector<ChartPoint>& end) { return is_within(end, enough); });
    }

    // A step is due unless this round has made one, or an earlier round has and this one starts where it ended.
    bool has_moved() const { return result_.iterations > first_of_round_ || result_.friction_rounds > 1; }

    // Velocities below eps_v are what friction tells sticking from sliding by: they must be resolved.
    double velocity_tolerance() const {
        if (!is_rubbing()) return options_.velocity_tolerance;
        return std::min(options_.velocity_tolerance, friction_resolution * model_.friction.eps_v);
    }

    bool is_rubbing() const { return joints_rub_ || !problem_.friction.pairs.empty(); }

    // The motion whose square, in units of this, is what a whole Newton step leaves: within it the potential is nearly quadratic.
    double quadratic_range() const {
        double range = smallest_radius_;
        if (at_.contacts.count > 0) range = std::min({range, model_.dhat, at_.contacts.minimum_distance - model_.dmin});
        if (joints_stop_) range = std::min(range, stop_range * model::stop_give * model_.dhat);
        if (is_rubbing()) range = std::min(range, model_.friction.eps_v * problem_.slip_time);
        return range;
    }

    // Is this share of a body's forces still too much to be unbalanced when a whole Newton step with this motion has been taken? The step
    // leaves about as much of a stiff force as it was out of balance times its length. Friction of a joint that is about to slide has next
    // to no stiffness left: what the step leaves is the bend of its law, however little it was out of balance.
    bool leaves_too_much(double share, double motion) const {
        const double length = std::min(1.0, motion / quadratic_range());
        return options_.accuracy > 0 && !(std::max(share, joints_rub_ ? length : 0) * length <= options_.accuracy);
    }

    // Asked once in each iteration: keeps the least share and counts the iterations since. Where rounding keeps it from getting there, the
    // least that it gets to is taken.
    bool has_become_accurate(const Direction& direction) {
        constexpr int tries = 3;  // without halving it
        const double share = *std::max_element(direction.unbalanced.begin(), direction.unbalanced.end());
        if (options_.accuracy == 0 || share <= options_.accuracy) return true;
        if (share < 0.5 * least_share_) {
            least_share_ = share;
            since_least_share_ = 0;
            return false;
        }
        return ++since_least_share_ >= tries;
    }

    // Where contact is far stiffer than the freedoms that joints leave, the errors that the usual solves leave keep the iteration going.
    void refine_fully() {
        workspace_.rows->refine_fully(true);
        refines_fully_ = true;
    }

    // One Newton iteration. @return whether to go on.
    bool iterate() {
        if (options_.should_stop && options_.should_stop())
            return stop(NewtonStatus::interrupted, "stopped on request; the steps before it are whole");
        const std::optional<Direction> direction = find_direction();
        if (!direction) return stop(NewtonStatus::not_converged, "forces or their derivatives are too large, or not numbers");
        result_.residual = direction->residual;
        result_.shift = std::max(result_.shift, direction->shift);
        const bool solved = has_moved() && has_arrived(*direction) && is_slow(*direction);
        if (solved && !options_.to_rounding && (has_become_accurate(*direction) || result_.iterations >= options_.max_iterations))
            return stop(NewtonStatus::converged);
        const char* too_rough = "rounding stops the solve before it is accurate enough for a gradient";
        if (result_.iterations >= options_.max_iterations)  // solved, in numbers that jump by more than such accuracy at each step
            return stop(failure(*direction),
                        failure_message(*direction, solved ? too_rough : "not solved within `max_newton_iterations` iterations"));
        if (solved && is_stagnant(*direction)) {
            if (direction->residual <= usable_residual || is_as_near_as_numbers(*direction)) return stop(NewtonStatus::converged);
            if (workspace_.rows && !refines_fully_)
                refine_fully();
            else if (direction->residual <= saddle_growth * least_residual_)
                return stop(NewtonStatus::not_converged, failure_message(*direction, too_rough));
            since_least_ = 0;  // by better solves, or leaving a saddle, whose first gains are below rounding
        }
        ++result_.iterations;
        if (workspace_.rows && !refines_fully_ && result_.iterations >= first_of_round_ + usual_iterations) refine_fully();
        const double fraction = search(*direction);
        // Cut short by the potential, not by CCD: contacts that change from sliding one way to the other, over the valley where they stick.
        if (!problem_.friction.pairs.empty() && fraction < short_step * limiting_.fraction)
            projected_iterations_ = std::max(projected_iterations_, careful_iterations);
        const bool relaxed = fraction == 1 && direction->motion <= relaxed_motion * room_to_give();
        drive_.adapt(fraction, has_arrived(*direction), relaxed);
        if (caution_.is_on()) adapt_caution(*direction, fraction);
        if (fraction > 0 && frictional_ && caution_.shift() > 0) follow_friction();
        return fraction > 0 ? go_on_from_step(*direction, fraction) : go_on_without_step(*direction);
    }

    // A whole step of Newton's that is short enough to end with is followed by one of its square: no need to look at it.
    bool was_the_last(const Direction& direction, double fraction) const {
        const bool newton = direction.kind == HessianKind::exact && direction.shift == 0 && !caution_.is_on();
        return !options_.to_rounding && newton && fraction == 1 && has_arrived(direction) && is_slow(direction) &&
               !leaves_too_much(*std::max_element(direction.unbalanced.begin(), direction.unbalanced.end()), direction.motion);
    }

    // Bodies that touch one another are a problem of their own. Each such group may be done for its own reason: a whole step of Newton's
    // that was short enough to end with; or one that leaves so little that inertia alone makes the next one short enough, as in free
    // flight. Then no second derivative is needed to know it.
    bool leaves_nothing(const Direction& direction, double fraction) {
        constexpr double foretold = 0.1;  // how far the gain may be off what a quadratic potential would give
        const bool newton = direction.kind == HessianKind::exact && direction.shift == 0 && !caution_.is_on();
        if (options_.to_rounding || !newton || fraction < 1 || !has_arrived(direction)) return false;
        if (workspace_.rows || !model_.mechanism.terms.empty()) return false;  // joints and springs couple what does not touch
        if (!(std::abs(value_change_ - 0.5 * direction.slope) <= -foretold * 0.5 * direction.slope)) return false;
        const double enough = velocity_tolerance() * model_.timestep;
        const std::vector<int> group = touching_groups(model_, at_.contacts, problem_.friction);
        std::vector<double> step(group.size(), 0), share = step;  // [group] the longest, the largest
        for (std::size_t i = 0; i < group.size(); ++i) {
            if (!energy::has_free_dof(model_.bodies[i])) continue;
            const auto g = static_cast<std::size_t>(group[i]);
            step[g] = std::max(step[g], motion_of(model_.bodies[i], direction.step[i]));
            share[g] = std::max(share[g], direction.unbalanced[i]);
        }
        const auto was_short = [&](int g) { return step[g] <= enough && !leaves_too_much(share[g], step[g]); };
        const auto is_hopeless = [&](const contact::BodyPairContacts& pair) {  // contact leaves more than inertia could bear
            return !was_short(group[pair.first]) || !was_short(group[pair.second]);
        };
        if (std::any_of(at_.contacts.pairs.begin(), at_.contacts.pairs.end(), is_hopeless)) return false;
        std::vector<int> far;  // bodies whose step was not short
        for (std::size_t i = 0; i < group.size(); ++i)
            if (!was_short(group[i])) far.push_back(static_cast<int>(i));
        const Remainder remainder = remainder_at(problem_, at_, far, workspace_);
        for (std::size_t k = 0; k < far.size(); ++k)
            if (!(remainder.motion[k] <= enough) || (options_.accuracy > 0 && !(remainder.unbalanced[k] <= options_.accuracy)))
                return false;
        result_.residual = remainder.residual;
        return true;
    }

    // The exact Hessian, but for a few iterations after it has failed.
    std::optional<Direction> find_direction() {
        const HessianKind kind = projected_iterations_ > 0 ? HessianKind::projected : HessianKind::exact;
        projected_iterations_ = std::max(0, projected_iterations_ - 1);
        // What is pushed must not be made heavy: until all has arrived the projected Hessian is better than a large shift.
        const HessianChoice hessian{kind, caution_.is_on() ? std::optional(caution_.shift()) : std::nullopt, arrived_ ? patient_shifts : 1};
        const std::optional<Direction> direction = newton_direction(problem_, at_, targets_, hessian, drive_.share(), workspace_);
        if (direction && direction->kind != kind && !caution_.is_on()) projected_iterations_ = 1;
        if (direction) arrived_ = has_arrived(*direction);
        return direction;
    }

    bool go_on_without_step(const Direction& direction) {
        if (!has_arrived(direction) && drive_.try_less()) return true;
        if (caution_.is_on()) {
            if (caution_.may_try_again()) return true;
        } else if (direction.kind == HessianKind::exact) {
            projected_iterations_ = 3;
            return true;
        }
        if (is_near_enough(direction) && is_slow(direction) && is_accurate_enough(direction.residual)) return stop(NewtonStatus::converged);
        return stop(failure(direction), failure_message(direction, "no move brings the forces nearer to balance"));
    }

    bool go_on_from_step(const Direction& direction, double fraction) {
        if (const std::string lost = lost_bodies(); !lost.empty()) return stop(NewtonStatus::not_held, lost);
        if (was_the_last(direction, fraction) || leaves_nothing(direction, fraction)) return stop(NewtonStatus::converged);
        if (direction.drive > 0) drive_.count_stalls(fraction * direction.drive);
        if (!has_arrived(direction) && (drive_.is_stalled() || closes_altogether(direction))) {
            if (!is_near_enough(direction)) return stop(NewtonStatus::blocked, failure_message(direction, "its way is blocked"));
            if (is_slow(direction) && is_accurate_enough(direction.residual)) return stop(NewtonStatus::converged);
        }
        // A full exact step this small leaves an error of its square over the gap: rounding.
        const double rounding_motion = 1e-7 * std::min(model_.dhat, at_.contacts.minimum_distance - model_.dmin);
        const bool exact =
            fraction == 1 && has_arrived(direction) && direction.kind == HessianKind::exact && direction.shift <= negligible_shift;
        if (!options_.to_rounding || !exact || direction.motion > rounding_motion) return true;
        result_.residual = residual_at(problem_, at_, workspace_);
        return is_accurate_enough(result_.residual) ? stop(NewtonStatus::converged) : true;
    }

    // What has gone farther than anything that is held would. @return empty if nothing has
    std::string lost_bodies() const {
        constexpr double company = 0.5;  // others that have gone half as far go with it
        if (!std::isfinite(options_.farthest) && !std::isfinite(options_.widest_turn)) return {};
        double most = 0;
        std::vector<double> gone(at_.points.size(), 0);
        for (std::size_t i = 0; i < gone.size(); ++i) {
            if (!energy::has_free_dof(model_.bodies[i])) continue;
            const double way = (at_.points[i].position - problem_.poses_t0[i].position).norm() / options_.farthest;
            gone[i] = std::max(way, at_.points[i].rotation_vector.norm() / options_.widest_turn);
            most = std::max(most, gone[i]);
        }
        if (most < 1) return {};
        std::string names;
        for (std::size_t i = 0; i < gone.size(); ++i)
            if (gone[i] >= company) names += (names.empty() ? "'" : ", '") + model_.bodies[i].name + "'";
        return names + ": not held: loads move it out of the scene, or round a whole turn, and nothing stops it";
    }

    // Far inside the activation distance a step of Newton's doubles the gap, and is short all the same: without inertia to drive against,
    // what is pushed has given way when it moves by little of the gap.
    double room_to_give() const {
        return caution_.is_on() ? std::min(model_.dhat, at_.contacts.minimum_distance - model_.dmin) : model_.dhat;
    }

    void adapt_caution(const Direction& direction, double fraction) {
        const double curvature = direction.inertia > 0 ? -direction.slope / direction.inertia : 0;
        const double gain_share = fraction > 0 ? value_change_ / direction.slope : 0;
        caution_.adapt({fraction, direction.shift, curvature, gain_share, has_arrived(direction)});
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

    // The slope cannot foresee a contact that is not active yet: the penalty must outweigh a barrier's force and the push of all bodies.
    double least_penalty(double remaining) const {
        double mass = 0;
        for (const model::Body& body : model_.bodies) mass += body.moments(3, 3);
        return 100 * problem_.weight * problem_.kappa * model_.dhat + 10 * mass * remaining;
    }

    std::vector<PathSegment> segments_to(const std::vector<ChartPoint>& end) const {
        std::vector<PathSegment> segments(at_.points.size());
        base::parallel_for(count_of(end), bodies_a_loop,
                           [&](int i) { segments[i] = path_between(problem_.poses_t0[i].rotation, at_.points[i], end[i]); });
        return segments;
    }

    // Where the fraction of a step leads.
    Iterate moved_by(const Direction& direction, double fraction) const {
        Iterate out;
        out.points.resize(at_.points.size());
        out.poses.resize(at_.points.size());
        base::parallel_for(count_of(out.points), bodies_a_loop, [&](int i) {
            out.points[i] = moved(i, at_.points, direction, fraction, targets_, workspace_.dofs());
            out.poses[i] = pose_of(problem_, i, out.points[i]);
        });
        return out;
    }

    // The whole way.
    std::vector<PathSegment> segments_along(const Direction& direction) const {
        std::vector<PathSegment> segments(at_.points.size());
        base::parallel_for(count_of(segments), bodies_a_loop, [&](int i) {
            const ChartPoint end = moved(i, at_.points, direction, 1, targets_, workspace_.dofs());
            segments[i] = path_between(problem_.poses_t0[i].rotation, at_.points[i], end);
        });
        return segments;
    }

    // How far all bodies may go.
    ccd::SafeStep safe_step(const Direction& direction) {
        const std::vector<PathSegment> segments = segments_along(direction);
        cover(segments);
        const auto span = workspace_.clock.charge(SolvePhase::ccd);
        return ccd::longest_safe_step(model_, workspace_.candidates, segments, &at_.contacts.distances);
    }

    // From the straight step onto the rows, and whether the way there is clear too.
    bool reach_by_rows(const Direction& direction, double fraction, Iterate& trial) {
        const double left = 1 - fraction * direction.drive;
        if (!workspace_.rows->put_on_rows(problem_, workspace_.system, left, trial.points)) return false;
        trial.poses = poses_of(problem_, trial.points);
        return is_clear_to(trial);
    }

    // CCD, then backtracking; accepts the point found. @return the fraction of the direction taken, 0 if none.
    double search(const Direction& direction) {
        limiting_ = safe_step(direction);
        const double remaining = direction.drive * direction.remaining_norm;
        if (remaining > 0) drive_.outweigh(direction.slope, remaining, least_penalty(remaining));
        const double slope = direction.slope - drive_.penalty() * remaining;
        double fraction = 2 * limiting_.fraction;
        while ((fraction *= 0.5) > smallest_step) {
            Iterate trial = moved_by(direction, fraction);
            if (workspace_.rows && !reach_by_rows(direction, fraction, trial)) continue;
            find_contacts(trial);
            if (closes_too_much(trial)) continue;
            const double value = potential(trial);
            const double change = value - value_ - drive_.penalty() * fraction * remaining;
            if (!(change <= sufficient_decrease * fraction * slope + direction.rounding)) continue;
            settle(trial.poses, workspace_.candidates);
            at_ = std::move(trial);
            value_change_ = value - value_;
            value_ = value;
            result_.path.push_back(at_.points);
            return fraction;
        }
        settle(at_.poses, workspace_.candidates);
        return 0;
    }

    // Collision detection leaves the meshes a tenth of their distance. Round surfaces lie before them: where a drive outweighs the barrier,
    // nothing else would leave them more than the next to nothing from which no solve returns.
    bool closes_too_much(const Iterate& trial) const {
        if (model_.round_reach == 0) return false;
        const double gap = std::min(model_.dhat, at_.contacts.minimum_distance - model_.dmin);
        return trial.contacts.minimum_distance - model_.dmin < ccd::hit_share * gap;
    }

    bool has_arrived(const Direction& direction) const { return direction.remaining_norm == 0; }

    // A step that a large shift has shortened says nothing of how far the solution is.
    bool is_slow(const Direction& direction) const {
        const bool telling = direction.shift <= telling_shift || direction.residual <= usable_residual;
        return telling && direction.motion <= velocity_tolerance() * model_.timestep;
    }

    // What is left would move nothing by more than the rounding of places. Where all forces are next to nothing (free flight, the first
    // touch of a soft contact) that is all there can be, and much beside them.
    bool is_as_near_as_numbers(const Direction& direction) const {
        const bool newton = direction.kind == HessianKind::exact && direction.shift <= negligible_shift;
        return newton && has_arrived(direction) && direction.motion <= rounding_of_places * model_.diagonal;
    }

    bool is_accurate_enough(double residual) const { return !options_.to_rounding || residual <= usable_residual; }

    // What remains to be driven is all the gap there is: to go on would only leave less of it than can be proven.
    bool closes_altogether(const Direction& direction) const {
        return is_near_enough(direction) && at_.contacts.minimum_distance - model_.dmin <= direction.remaining_norm;
    }

    // Prescribed coordinates are met to this where contact leaves no more (a gap that closes altogether).
    bool is_near_enough(const Direction& direction) const { return direction.remaining_norm <= prescribed_tolerance * model_.diagonal; }

    NewtonStatus failure(const Direction& direction) const {
        return direction.remaining_norm > 0 ? NewtonStatus::blocked : NewtonStatus::not_converged;
    }

    std::string failure_message(const Direction& direction, const std::string& cause) const {
        return describe_failure({problem_, at_.contacts, direction.remaining, limiting_, direction.residual, cause,
                                 workspace_.rows ? &*workspace_.rows : nullptr, &at_.points, &at_.poses});
    }

    energy::StepProblem& problem_;  // the friction lag changes from round to round
    const model::Model& model_;
    const std::vector<Vector6>& targets_;
    NewtonWorkspace& workspace_;
    const NewtonOptions& options_;
    Iterate at_;
    double value_ = 0;         // of the potential, there
    double value_change_ = 0;  // by the last step
    bool frictional_ = false;
    bool arrived_ = false;  // prescribed coordinates, at the last iteration
    PrescribedDrive drive_;
    Caution caution_;
    bool joints_rub_ = false, joints_stop_ = false;                     // terms of the mechanism
    double smallest_radius_ = std::numeric_limits<double>::infinity();  // of what is solved for
    ccd::SafeStep limiting_;
    int first_of_round_ = 0;  // iterations before this round of friction
    std::vector<std::vector<ChartPoint>> ends_of_rounds_;
    int projected_iterations_ = 0;
    double least_residual_ = std::numeric_limits<double>::infinity();
    int since_least_ = 0;
    bool refines_fully_ = false;
    double least_share_ = std::numeric_limits<double>::infinity();  // the same of the largest Direction::unbalanced
    int since_least_share_ = 0;
    NewtonResult result_;
};

}  // namespace

const char* to_string(SolvePhase phase) {
    static constexpr std::array names{"broad_phase", "contacts", "derivatives", "linear_solve", "ccd", "potential"};
    static_assert(names.size() == static_cast<std::size_t>(SolvePhase::count));
    return names[static_cast<std::size_t>(phase)];
}

double candidate_allowance(const model::Model& model) { return model.dhat; }

NewtonResult minimise(energy::StepProblem& problem, const std::vector<Vector6>& targets, NewtonWorkspace& workspace,
                      const NewtonOptions& options) {
    return Minimiser(problem, targets, workspace, options).run();
}

}  // namespace fettle::core::solver
