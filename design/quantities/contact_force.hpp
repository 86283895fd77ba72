// SPDX-License-Identifier: MIT
/// The resultant force of contact on a body at each step's end, of one other body or of all: barrier, damping and friction
/// (adjoint/stepper/contact_forces.hpp), what a scale between them would read; or its torque about a point of the body. With every
/// integrator.
///
/// Where a least force is asked for, a lower bound above 0 (or an upper one below 0, of a component along an axis that points the other
/// way), and the bodies are apart, a search is given how far apart, in place of 0 and a derivative of 0. With the steps' numbers y_t, the
/// sign of the bound and the gap g_t of the two bodies (of the nearest that it may collide with, for a force of all), as contact measures
/// it (core/clearance/contact_gap.hpp), at the steps without contact
///   z_t = -sign k (g_t - dmin - dhat),   k = |bound| / (10 dhat),   else z_t = y_t,
/// of which the same is taken as of y. At g = dmin + dhat, where contact begins, z is 0 as y is: the constraint is continuous, with a kink.
/// It falls with the gap, and what is missed grows from the bound on by as much for every 10 dhat. The design does not say how large k
/// should be: in contact the force rises by its bound within less than dhat where the bodies are pressed together whatever they meet, and
/// as slowly as the parts behind them are soft where springs do. With 10 dhat a linear model aims at bodies that are pressed 10 dhat into
/// each other. That is sure to make contact, where the force's own derivative takes over, without going far beyond it; and gaps of a
/// mechanism's size outweigh what else is missed only as far as they are many times as large as contact.
#pragma once

#include <optional>

#include "design/quantities/own_formula.hpp"
#include "design/quantities/vector_series.hpp"

namespace fettle::design::quantities {

class ContactForce : public VectorSeries {
public:
    struct Of {
        int body = 0;                     ///< what the force acts on
        std::optional<int> other;         ///< what presses; nullopt: all
        Vector3 axis = Vector3::Zero();   ///< the component along this unit vector, world; 0: the magnitude
        std::optional<OwnPoint> about{};  ///< the torque about this point of the body's file frame [m], in place of the force
    };
    ContactForce(const Of& of, const Reduction& reduction) : VectorSeries(of.axis, reduction), of_(of) {}

    const Of& of() const { return of_; }
    Dimension instant_dimension() const override { return of_.about ? Dimension::torque : Dimension::force; }
    std::vector<std::string> parameters() const override;
    /// Over "least", "end" or `at` a time, of a lower bound; "largest", "end" or `at`, of an upper one. Not of derivatives in time.
    std::optional<description::Continuation> continuation(const description::Simulated& simulated, const description::Measurement& measured,
                                                          const description::Bounds& bounds) const override;
    /// A body that is not there, the same twice, two that never touch.
    Errors check(const core::model::Model& model, int steps) const override;

protected:
    std::vector<Vector3> vectors(const description::Simulated& simulated) const override;
    void add_vector_seeds(const description::Simulated& simulated, const std::vector<Vector3>& weights,
                          description::Seeds& seeds) const override;

private:
    Of of_;
};

}  // namespace fettle::design::quantities
