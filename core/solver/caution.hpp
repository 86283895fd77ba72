// SPDX-License-Identifier: MIT
/// Levenberg's shift of the Hessian, for solves whose inertia is too small to make it definite (quasi-statics): how much of the inertia is
/// added for the next iteration. It begins at a given value, rises where steps had to be cut, and falls as they keep their promise, so that
/// the way is that of a heavily damped motion, and the last steps are Newton's. docs/method/solver.md#when-a-solve-has-converged.
#pragma once

namespace fettle::core::solver {

/// In units of the inertia, which is in the Hessian whole: a step with this shift misses no more than this share of its length.
inline constexpr double negligible_shift = 1e-2;

class Caution {
public:
    /// @param initial  0: none, ever.
    explicit Caution(double initial) : initial_(initial), shift_(initial) {}

    bool is_on() const { return initial_ > 0; }
    double shift() const { return shift_; }

    /// What an iteration came to.
    struct Outcome {
        double fraction = 0;    ///< of the step that was taken; 0: none decreases the potential
        double shift = 0;       ///< that the Hessian had
        double curvature = 0;   ///< along the step, in units of the inertia: -slope / (step . inertia step)
        double gain_share = 0;  ///< change of the value over the slope; of a quadratic and a whole Newton step 1/2
        bool arrived = true;    ///< nothing that is prescribed remains
    };
    /// Cut below a quarter: the curvature over the fraction, at least fourfold. Whole: 1/100 where the value fell as predicted or by more,
    /// 1/10 or 1/2 where less so; below negligible_shift 0. Until prescribed coordinates have arrived, the initial one: what is pushed must
    /// not be heavy.
    void adapt(const Outcome& outcome);

    /// After a search that found no step: is a larger shift worth another one? At most six in a row.
    bool may_try_again() const;

private:
    double initial_, shift_;
    int failures_ = 0;  // in a row
};

}  // namespace fettle::core::solver
