// SPDX-License-Identifier: MIT
#include "design/quantities/stroke.hpp"

#include <cmath>

#include "core/base/text.hpp"
#include "design/quantities/extreme.hpp"
#include "design/quantities/own_formula.hpp"
#include "design/quantities/reduction.hpp"

namespace fettle::design::quantities {

using description::Measurement;
using description::Seeds;
using description::Simulated;

std::pair<int, int> Stroke::configurations(double timestep, int steps) const {
    Reduction window;
    window.from = window_.from;
    window.to = window_.to;
    return window_of(window, {timestep, 0}, steps + 1);
}

std::vector<double> Stroke::coordinates(const Simulated& simulated, double sign) const {
    const auto [first, last] = configurations(simulated.trajectory.timestep, count_of(simulated.trajectory.steps));
    std::vector<double> y;
    for (int t = first; t < last; ++t) y.push_back(sign * axis_.dot(simulated.trajectory.poses[t][body_].position));
    return y;
}

double Stroke::stroke(const Simulated& simulated) const {
    return smooth_maximum(coordinates(simulated, 1)).value + smooth_maximum(coordinates(simulated, -1)).value;
}

double Stroke::deviation(const Simulated& simulated) const { return stroke(simulated) - (target_ ? value_at(*target_, simulated) : 0); }

std::vector<double> Stroke::curve(const Simulated& simulated) const {
    const auto& poses = simulated.trajectory.poses;
    std::vector<double> out;
    for (std::size_t t = 1; t < poses.size(); ++t) out.push_back(axis_.dot(poses[t][body_].position - poses.front()[body_].position));
    return out;
}

Measurement Stroke::value(const Simulated& simulated) const {
    const double s = deviation(simulated);
    return description::computed(target_ ? s * s : s);
}

void Stroke::add_seeds(const Simulated& simulated, const Measurement&, double scale, Seeds& seeds) const {
    add_deviation_seeds(simulated, 0, scale * (target_ ? 2 * deviation(simulated) : 1), seeds);
}

VectorX Stroke::deviations(const Simulated& simulated) const {
    return target_ ? VectorX(VectorX::Constant(1, deviation(simulated))) : VectorX();
}

void Stroke::add_deviation_seeds(const Simulated& simulated, int, double scale, Seeds& seeds) const {
    const int begin = configurations(simulated.trajectory.timestep, count_of(simulated.trajectory.steps)).first;
    for (const double sign : {1.0, -1.0}) {
        const Extreme extreme = smooth_maximum(coordinates(simulated, sign));
        for (int k = 0; k < count_of(extreme.weights); ++k) {
            if (extreme.weights[k] == 0) continue;
            seeds.trajectory_bar.pose_bar[begin + extreme.first + k][body_].col(3) += scale * extreme.weights[k] * sign * axis_;
        }
    }
    if (target_) add_formula_seed(*target_, simulated, -scale, seeds);
}

std::vector<std::string> Stroke::parameters() const { return target_ ? target_->inputs : std::vector<std::string>(); }

Errors Stroke::check(const core::model::Model& model, int steps) const {
    Errors errors = description::check_body(model, body_);
    if (!(std::abs(axis_.norm() - 1) < 1e-6)) errors.push_back({ErrorCode::out_of_range, "", "the axis of a stroke is a unit vector"});
    const auto [first, last] = configurations(model.timestep, steps);
    if (window_.from.value_or(0) < 0 || !(first < last))
        errors.push_back({ErrorCode::out_of_range, "",
                          "no configuration of the motion is within `from` and `to`; it ends at " +
                              core::base::formatted("%.6g s", steps * model.timestep)});
    return errors;
}

}  // namespace fettle::design::quantities
