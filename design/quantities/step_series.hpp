// SPDX-License-Identifier: MIT
/// Quantities that every step of a motion has one number of, y_1 .. y_T: what is made of them, and its derivative in each. Kinds:
/// joint_load.hpp, joint_position.hpp, body_turn.hpp, energy.hpp, contact_force.hpp, marker_speed.hpp.
#pragma once

#include <vector>

#include "fettle/design/description/quantity.hpp"

namespace fettle::design::quantities {

/// What a series comes to. The extremes are those of stroke.hpp: of the parabola through three steps, smooth in the parameters. `peak` is
/// the largest absolute value: the greater of `largest` and -`least`, never negative.
enum class Over { end, sum, mean, largest, least, peak };

class StepSeries : public description::Quantity {
public:
    explicit StepSeries(Over over) : over_(over) {}

    Over over() const { return over_; }
    /// y_1 .. y_T. Contract: at least one step.
    std::vector<double> steps(const description::Simulated& simulated) const { return series(simulated); }
    /// Does the sign tell a direction, as of a torque about an axis? Not of magnitudes, nor of energies, whose zero is a convention.
    virtual bool has_direction() const { return false; }
    description::Measurement value(const description::Simulated& simulated) const override;
    void add_seeds(const description::Simulated& simulated, const description::Measurement& measured, double scale,
                   description::Seeds& seeds) const override;
    /// No step.
    Errors check(const core::model::Model& model, int steps) const override;

protected:
    /// Of steps().
    virtual std::vector<double> series(const description::Simulated& simulated) const = 0;
    /// Adds the seeds of sum_t weights[t] y_t+1.
    virtual void add_series_seeds(const description::Simulated& simulated, const std::vector<double>& weights,
                                  description::Seeds& seeds) const = 0;

private:
    Over over_;
};

/// The matrix whose product, entry by entry, with the change [[phi] R, dq] of a pose is that of a gradient in (q, phi).
inline Matrix34 pose_entries(const Vector6& gradient, const Matrix3& rotation) {
    Matrix34 out;
    out << 0.5 * cross_matrix(gradient.tail<3>()) * rotation, gradient.head<3>();
    return out;
}

}  // namespace fettle::design::quantities
