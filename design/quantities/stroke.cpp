// SPDX-License-Identifier: MIT
#include "fettle/design/quantities/stroke.hpp"

#include <algorithm>
#include <cmath>

#include "fettle/core/base/contract.hpp"
#include "fettle/design/quantities/own_formula.hpp"

namespace fettle::design::quantities {

using description::Measurement;
using description::Seeds;
using description::Simulated;

Extreme smooth_maximum(const std::vector<double>& y) {
    FETTLE_ASSERT(!y.empty(), "the extreme of nothing");
    const auto i = static_cast<size_t>(std::max_element(y.begin(), y.end()) - y.begin());
    if (i == 0 || i + 1 == y.size()) {
        return {y[i], static_cast<int>(i), {1, 0, 0}};
    }
    const double b = (y[i + 1] - y[i - 1]) / 2, a = (y[i + 1] - 2 * y[i] + y[i - 1]) / 2;
    if (a >= 0) return {y[i], static_cast<int>(i), {1, 0, 0}};  // three equal: flat
    const double s = -b / (2 * a);
    return {y[i] + b * s + a * s * s, static_cast<int>(i) - 1, {s * (s - 1) / 2, 1 - s * s, s * (s + 1) / 2}};
}

std::vector<double> Stroke::coordinates(const Simulated& simulated, double sign) const {
    std::vector<double> y;
    y.reserve(simulated.trajectory.poses.size());
    for (const auto& poses : simulated.trajectory.poses) y.push_back(sign * axis_.dot(poses[body_].position));
    return y;
}

double Stroke::stroke(const Simulated& simulated) const {
    return smooth_maximum(coordinates(simulated, 1)).value + smooth_maximum(coordinates(simulated, -1)).value;
}

double Stroke::deviation(const Simulated& simulated) const { return stroke(simulated) - (target_ ? value_at(*target_, simulated) : 0); }

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
    for (const double sign : {1.0, -1.0}) {
        const Extreme extreme = smooth_maximum(coordinates(simulated, sign));
        for (size_t k = 0; k < 3; ++k) {
            if (extreme.weights[k] == 0) continue;
            seeds.trajectory_bar.pose_bar[static_cast<size_t>(extreme.first) + k][body_].col(3) +=
                scale * extreme.weights[k] * sign * axis_;
        }
    }
    if (target_) add_formula_seed(*target_, simulated, -scale, seeds);
}

std::vector<std::string> Stroke::parameters() const { return target_ ? target_->inputs : std::vector<std::string>(); }

Errors Stroke::check(const core::model::Model& model, int) const {
    Errors errors = description::check_body(model, body_);
    if (!(std::abs(axis_.norm() - 1) < 1e-6)) errors.push_back({ErrorCode::out_of_range, "", "the axis of a stroke is a unit vector"});
    return errors;
}

}  // namespace fettle::design::quantities
