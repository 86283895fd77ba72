// SPDX-License-Identifier: MIT
/// A number that a simulated design has: what an objective sums and what a constraint bounds. Value and derivative are two functions, so
/// that their times can be told apart; the derivative starts from what the value found (witness, extremal nodes), so nothing is searched
/// twice. Add one: derive from Objective, one file beside the others, one line in objective_table.cpp.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fettle/adjoint/model_gradient.hpp"
#include "fettle/core/clearance/clearance.hpp"
#include "fettle/core/model/model.hpp"
#include "fettle/core/stepper/trajectory.hpp"

namespace fettle::design::objectives {

/// A design, simulated. The trajectory was computed from the model.
struct Simulated {
    const core::model::Model& model;
    const core::stepper::Trajectory& trajectory;
    double clearance_tolerance = 1e-9;  ///< upper - lower wanted of certified distances [m]
};

/// lower <= true value <= upper; `value`, in [lower, upper], is what the optimiser sees and what is differentiated.
struct Quantity {
    double value = 0, lower = 0, upper = 0;                   ///< SI
    std::optional<core::clearance::PairClearance> clearance;  ///< where the value comes from, if it is a certified distance
};
inline Quantity exact(double value) { return {value, value, value, std::nullopt}; }

/// dJ/d(configurations) and the explicit dependence on the model, to be swept backwards together.
struct Seeds {
    adjoint::TrajectoryGradient trajectory_bar;
    adjoint::ModelGradient model_bar;
};
Seeds zero_seeds(const Simulated& simulated);

class Objective {
public:
    virtual ~Objective() = default;

    virtual Quantity value(const Simulated& simulated) const = 0;

    /// Adds scale * d(value) to the seeds. `quantity` is what value() returned for the same `simulated`.
    virtual void add_seeds(const Simulated& simulated, const Quantity& quantity, double scale, Seeds& seeds) const = 0;

    /// SI value of one unit in which weights and reports count it, for a file whose lengths are in units of `length_unit` [m]: lengths in
    /// the file's unit, masses in grams.
    virtual double unit(double length_unit) const = 0;
};

/// Point X of the body's file frame, relative to its reference point, in the configuration t.
Vector3 marker_position(const Simulated& simulated, int t, int body, const Vector3& point_in_file_frame);

/// Adds the seed of  gradient . (marker position at configuration t):  pose_bar[t] += gradient [X; 1]^T, X = point - c.
void add_marker_seed(const Simulated& simulated, int t, int body, const Vector3& point_in_file_frame, const Vector3& gradient,
                     Seeds& seeds);

}  // namespace fettle::design::objectives
