// SPDX-License-Identifier: MIT
/// Quantities that every instant of a motion has one number of, the steps' ends and, of where something is, the start: what is made of them
/// (reduction.hpp), and its derivative in each.
/// Kinds: joint_load.hpp, joint_position.hpp, body_turn.hpp, energy.hpp, law.hpp, those of vector_series.hpp, and formulas of these,
/// step_expression.hpp.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "design/description/quantity.hpp"
#include "design/quantities/reduction.hpp"

namespace fettle::design::quantities {

class StepSeries : public description::Quantity {
public:
    explicit StepSeries(const Reduction& reduction) : reduction_(reduction) {}

    const Reduction& reduction() const { return reduction_; }
    Over over() const { return reduction_.over; }
    /// Has the start a number? Where something is has one; how it moves and what acts on it is a step's.
    virtual bool has_start() const { return false; }
    int first_instant() const { return has_start() ? 0 : 1; }
    /// The numbers of all instants, after the derivative in time: what the reduction is taken of. Contract: check() finds nothing.
    std::vector<double> numbers(const description::Simulated& simulated) const;
    /// Adds the seeds of sum_k weights[k] numbers()[k].
    void add_number_seeds(const description::Simulated& simulated, const std::vector<double>& weights, description::Seeds& seeds) const;
    /// The window's part of numbers(), and the instant that it begins with: 0 the start, t the end of step t.
    struct Window {
        std::vector<double> numbers;
        int first = 0;
    };
    Window window(const description::Simulated& simulated) const;

    /// The dimension of y_k.
    virtual Dimension instant_dimension() const = 0;
    /// The dimension of numbers(). Contract of both: there is a unit of it, which check() sees to (until then: number).
    Dimension numbers_dimension() const;
    Dimension dimension() const final;
    description::QuantityFacts facts() const override;
    /// The numbers() of the steps' ends.
    std::vector<double> curve(const description::Simulated& simulated) const override;
    /// Does the sign tell a direction, as of a torque about an axis? Not of magnitudes, nor of energies, whose zero is a convention.
    virtual bool has_direction() const { return false; }
    description::Measurement value(const description::Simulated& simulated) const override;
    void add_seeds(const description::Simulated& simulated, const description::Measurement& measured, double scale,
                   description::Seeds& seeds) const override;
    /// An extreme has one for each place where the numbers have an extreme that is behind by a quarter of their range at most: the first
    /// few, the largest first.
    static constexpr int most_branches = 6;
    std::vector<description::Branch> branches(const description::Simulated& simulated, const description::Measurement& measured,
                                              double limit) const override;
    bool is_greatest_branch() const override { return over() == Over::largest || over() == Over::peak; }
    /// Faults of a reduction that cannot be taken; the derivative of a magnitude, which is not that of its vector.
    Errors check(const core::model::Model& model, int steps) const override;

protected:
    /// y_k, of the instant first_instant() and those after it.
    virtual std::vector<double> series(const description::Simulated& simulated) const = 0;
    /// Adds the seeds of sum_k weights[k] y_k.
    virtual void add_series_seeds(const description::Simulated& simulated, const std::vector<double>& weights,
                                  description::Seeds& seeds) const = 0;
    /// The derivative in time of the series, and its seeds; a magnitude's is the magnitude of the vector's derivative.
    virtual std::vector<double> series_derivative(const description::Simulated& simulated, int order) const;
    virtual void add_series_derivative_seeds(const description::Simulated& simulated, int order, const std::vector<double>& weights,
                                             description::Seeds& seeds) const;
    /// Are its numbers magnitudes whose vectors series_derivative() does not know?
    virtual bool is_magnitude() const { return false; }

    Instants instants(double timestep) const { return {timestep, first_instant()}; }

private:
    Reduction reduction_;
};

/// The same quantity, as the series that it is; null: it is none. The only place that asks a quantity for its class.
const StepSeries* series_of(const description::Quantity& quantity);
std::shared_ptr<const StepSeries> series_of(const std::shared_ptr<const description::Quantity>& quantity);

/// "the start", "step 3".
std::string instant_words(int instant);

/// The matrix whose product, entry by entry, with the change [[phi] R, dq] of a pose is that of a gradient in (q, phi).
inline Matrix34 pose_entries(const Vector6& gradient, const Matrix3& rotation) {
    Matrix34 out;
    out << 0.5 * cross_matrix(gradient.tail<3>()) * rotation, gradient.head<3>();
    return out;
}

}  // namespace fettle::design::quantities
