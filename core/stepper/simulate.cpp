// SPDX-License-Identifier: MIT
#include "core/stepper/simulate.hpp"

#include <algorithm>
#include <chrono>
#include <sstream>

#include "core/base/contract.hpp"
#include "core/base/stop.hpp"
#include "core/base/text.hpp"
#include "core/model/row_choice.hpp"
#include "core/scene/step_count.hpp"
#include "core/stepper/step.hpp"

namespace fettle::core::stepper {
int step_count(const model::Model& model, const SimulationOptions& options) {
    if (options.steps >= 0) return options.steps;
    return model.end_time >= 0 ? scene::step_count(model.end_time, model.timestep).value() : scene::default_step_count;
}

const char* to_string(SimulationStatus status) {
    switch (status) {
        case SimulationStatus::ok:
            return "ok";
        case SimulationStatus::blocked:
            return "blocked";
        case SimulationStatus::not_held:
            return "not_held";
        case SimulationStatus::not_converged:
            return "not_converged";
        case SimulationStatus::energy_gained:
            return "energy_gained";
        case SimulationStatus::interrupted:
            return "interrupted";
    }
    return "unknown";
}

namespace {

// What an earlier run did up to its checkpoint; a new run if there is none.
Simulation taken_up(const model::Model& model, const SimulationOptions& options) {
    Simulation out;
    out.trajectory.timestep = model.timestep;
    for (const model::Body& body : model.bodies) out.trajectory.body_names.push_back(body.name);
    out.checkpoint = {0, start_state(model)};
    out.trajectory.poses.push_back(out.checkpoint.state.history.poses);
    if (!options.resume) return out;
    const Simulation& earlier = *options.resume;
    const int done = earlier.checkpoint.step;
    FETTLE_ASSERT(count_of(earlier.trajectory.steps) >= done, "the checkpoint lies beyond the trajectory");
    out.checkpoint = earlier.checkpoint;
    const auto take = [done](auto& to, const auto& from) {
        to.assign(from.begin(), from.begin() + std::min<std::ptrdiff_t>(done, static_cast<std::ptrdiff_t>(from.size())));
    };
    take(out.trajectory.steps, earlier.trajectory.steps);
    out.trajectory.poses.assign(earlier.trajectory.poses.begin(), earlier.trajectory.poses.begin() + done + 1);
    take(out.report.steps, earlier.report.steps);
    take(out.outputs, earlier.outputs);
    for (const StepReport& report : out.report.steps) out.report.newton_iterations += report.newton_iterations;
    // Files hold no turns: they are counted along the motion.
    std::vector<double>& angles = out.checkpoint.state.history.angles;
    angles = model.mechanism.angles_start;
    for (int t = 1; t <= done && !angles.empty(); ++t) angles = constraint::angles_at(model.mechanism.set, out.trajectory.poses[t], angles);
    return out;
}

std::size_t contacts_of(const TrajectoryStep& step) {
    std::size_t count = 0;
    for (const auto& kept : step.contacts) count += 1 + static_cast<std::size_t>(kept->contacts.count);
    return count;
}

// A step that is stopped in the middle of its searches is one that did not happen.
StepResult stoppable_step(const model::Model& model, const StepState& state, solver::NewtonWorkspace& workspace,
                          const SimulationOptions& options) {
    const base::StopScope scope(options.should_stop);
    try {
        return step(model, state, workspace, options);
    } catch (const base::Stopped&) {
        StepResult stopped;
        stopped.status = SimulationStatus::interrupted;
        stopped.message = "stopped on request; the steps before it are whole";
        return stopped;
    }
}

std::vector<kinematics::Pose> end_of_path(const StepState& state, const TrajectoryStep& path) {
    std::vector<kinematics::Pose> out = state.history.poses;
    for (std::size_t i = 0; i < out.size() && !path.nodes.empty(); ++i) {
        const kinematics::ChartPoint& end = path.nodes.back()[i];
        out[i] = {kinematics::orthonormalised(kinematics::rotation(end.rotation_vector) * out[i].rotation), end.position};
    }
    return out;
}

// Steps with the rows that are independent where the bodies are. Rows that were independent where they were chosen serve until a step
// fails; it is then tried with those of where it has led, and of where it began.
class StepsOnRows {
public:
    StepsOnRows(const model::Model& model, const SimulationOptions& options) : model_(model), options_(options) { begin_anew(); }

    StepResult take(const StepState& state) {
        StepResult first = stoppable_step(*current_, state, *workspace_, options_);
        if (first.status == SimulationStatus::ok || first.status == SimulationStatus::interrupted) return first;
        for (const std::vector<kinematics::Pose>& poses : {end_of_path(state, first.path), state.history.poses}) {
            const std::optional<std::vector<int>> left_out = rows_to_leave_out(*current_, poses);
            if (!left_out) continue;
            use(without_rows(model_, *left_out));
            StepResult again = stoppable_step(*current_, state, *workspace_, options_);
            if (again.status == SimulationStatus::ok || again.status == SimulationStatus::interrupted) return again;
        }
        return first;
    }

    /// Nothing but the state is carried on from the steps before.
    void begin_anew() {
        if (!workspace_ || chosen_) use(std::nullopt);
        workspace_->forget();
    }

    const auto& seconds() const { return workspace_->clock.seconds(); }

private:
    void use(std::optional<model::Model> chosen) {
        chosen_ = std::move(chosen);
        current_ = chosen_ ? &*chosen_ : &model_;
        const auto clock = workspace_ ? workspace_->clock : decltype(workspace_->clock){};
        workspace_.emplace(*current_);
        workspace_->clock = clock;
    }

    const model::Model& model_;
    const SimulationOptions& options_;
    std::optional<model::Model> chosen_;
    const model::Model* current_ = nullptr;
    std::optional<solver::NewtonWorkspace> workspace_;
};

}  // namespace

Simulation simulate(const model::Model& model, const SimulationOptions& options) {
    const auto begin = std::chrono::steady_clock::now();
    Simulation out = taken_up(model, options);
    StepState state = out.checkpoint.state;
    SimulationOptions watched = options;
    watched.outputs = options.outputs || model.integrator == scene::Integrator::newmark;
    StepsOnRows stepping(model, watched);
    const int steps = step_count(model, options);
    // At once, where they grow too large to be copied time and again; what is not used of it costs nothing.
    constexpr int most_at_once = 1 << 20;
    const auto expected = static_cast<std::size_t>(std::clamp(steps, 0, most_at_once));
    out.trajectory.steps.reserve(expected);
    out.trajectory.poses.reserve(expected + 1);
    out.report.steps.reserve(expected);
    std::size_t kept_contacts = 0;
    for (const TrajectoryStep& earlier : out.trajectory.steps) kept_contacts += contacts_of(earlier);
    std::optional<BalanceSum> balance;
    if (watched.outputs && model.integrator != scene::Integrator::quasi_static) {
        const double work = largest_work(model);
        balance.emplace(start_report(model, state), model.timestep, work, work * (model.dhat / model.diagonal));
    }
    for (int t = out.checkpoint.step; t < steps; ++t) {
        state.time = t * model.timestep;  // not accumulated: no drift over many steps
        if (t % checkpoint_interval == 0) {
            stepping.begin_anew();
            out.checkpoint = {t, state};
        }
        StepResult result = stepping.take(state);
        out.report.newton_iterations += result.report.newton_iterations;
        if (result.status != SimulationStatus::ok) {
            std::ostringstream message;
            message << "step " << t + 1 << " (t = " << state.time << " s to " << state.time + model.timestep << " s): " << result.message;
            out.report.status = result.status;
            out.report.message = message.str();
            break;
        }
        out.report.steps.push_back(result.report);
        if (options.last_outputs_only && !options.for_gradient) {  // a long motion, which nobody differentiates
            result.path.friction_rounds = {};
            result.path.contacts = {};
        }
        out.trajectory.steps.push_back(std::move(result.path));
        if (kept_contacts += contacts_of(out.trajectory.steps.back()); kept_contacts > most_kept_contacts) {
            out.trajectory.steps.back().contacts.clear();
            kept_contacts = most_kept_contacts;  // nor any later
        }
        if (balance) {
            balance->add(result.outputs);
            out.balance = balance->balance();
        }
        if (options.last_outputs_only) out.outputs.clear();
        if (options.outputs) out.outputs.push_back(std::move(result.outputs));
        state = std::move(result.state);
        out.trajectory.poses.push_back(state.history.poses);
        if (options.on_step) options.on_step({t + 1, steps, &out});
        if (!out.balance || !is_of_nowhere(*out.balance)) continue;
        out.report.status = SimulationStatus::energy_gained;
        out.report.message =
            base::formatted("by step %d (t = %.6g s) ", t + 1, (t + 1) * model.timestep) + balance_warning(model, *out.balance);
        break;
    }
    out.report.phase_seconds = stepping.seconds();
    out.report.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return out;
}

}  // namespace fettle::core::stepper
