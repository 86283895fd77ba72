// SPDX-License-Identifier: MIT
#include "fettle/core/energy/mechanism_step.hpp"

namespace fettle::core::energy {
namespace {

std::vector<double> measures_at(const measure::MeasureSet& set, const std::vector<kinematics::Pose>& poses,
                                const std::vector<double>& angles) {
    const std::vector<measure::PlacedFrame> frames = placed(set.frames, poses);
    std::vector<double> out(set.measures.size());
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = constraint::value_at(set, static_cast<int>(i), frames, angles);
    return out;
}

bool looks_back(const model::Mechanism& mechanism) {
    for (const model::MeasureTerm& term : mechanism.terms)
        if (term.kind == model::LawKind::damper || term.kind == model::LawKind::friction) return true;
    return false;
}

}  // namespace

std::vector<double> measure_rates(const measure::MeasureSet& set, const std::vector<kinematics::Pose>& poses,
                                  const std::vector<Matrix34>& velocities) {
    const std::vector<measure::PlacedFrame> frames = placed(set.frames, poses);
    std::vector<double> out(set.measures.size(), 0);
    for (std::size_t i = 0; i < out.size(); ++i) {
        const measure::Measure& m = set.measures[i];
        const measure::PoseGradients g = pose_gradients(m, vector_function(m, frames), frames);
        for (const auto& [frame, gradient] : {std::pair(m.a, g.a), std::pair(m.b, g.b)}) {
            const int body = set.frames[frame].body;
            if (body == measure::world) continue;
            const auto k = static_cast<std::size_t>(body);
            const Matrix34& velocity = velocities[k];
            out[i] += gradient.force.dot(velocity.col(3)) + (gradient.arm * poses[k].rotation).cwiseProduct(velocity.leftCols<3>()).sum();
        }
    }
    return out;
}

MechanismStep mechanism_step(const model::Model& model, const History& history) {
    MechanismStep step;
    if (model.mechanism.empty()) return step;
    const measure::MeasureSet& set = model.mechanism.set;
    step.angles = history.angles.empty() ? constraint::angles_at(set, history.poses, {}) : history.angles;
    if (looks_back(model.mechanism)) {
        step.measures = measures_at(set, history.poses, step.angles);
        if (model.integrator == scene::Integrator::bdf2 && !history.poses_before.empty()) {
            std::vector<kinematics::Pose> before;
            for (const Matrix34& p : history.poses_before) before.push_back({p.leftCols<3>(), p.col(3)});
            const std::vector<double> earlier = measures_at(set, before, step.angles);
            for (std::size_t i = 0; i < earlier.size(); ++i) step.measures[i] = (4 * step.measures[i] - earlier[i]) / 3;
        }
        if (model.integrator == scene::Integrator::newmark) {
            const std::vector<double> rates = measure_rates(set, history.poses, history.velocities);
            for (std::size_t i = 0; i < rates.size(); ++i) step.measures[i] += 0.5 * model.timestep * rates[i];
        }
    }
    set_end_time(model.mechanism, 0, step);
    return step;
}

void set_end_time(const model::Mechanism& mechanism, double time, MechanismStep& step) {
    step.end_time = time;
    step.row_targets.resize(mechanism.rows.size());
    for (std::size_t i = 0; i < mechanism.rows.size(); ++i) step.row_targets[i] = target_at(mechanism.rows[i], time);
}

}  // namespace fettle::core::energy
