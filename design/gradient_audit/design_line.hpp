// SPDX-License-Identifier: MIT
/// A design's quantities along a line in its parameters: values only, several points at once. What is asked of them stands in
/// roughness.hpp.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/base/types.hpp"
#include "design/problem/design_problem.hpp"

namespace fettle::design::gradient_audit {

/// What a study looks at, in this order everywhere: the objective, then each constraint's value as a search sees it. SI.
VectorX quantities_of(const problem::DesignEvaluation& evaluation);
/// "objective", then the constraints' names.
std::vector<std::string> quantity_names(const description::Design& design);
/// Their gradients, a row per quantity. Contract: evaluated with gradients.
MatrixX quantity_gradients(const problem::DesignEvaluation& evaluation);

/// upper - lower per parameter; where they coincide, the size of the value.
VectorX parameter_ranges(const description::Design& design);

struct LinePoint {
    double t = 0;
    bool usable = false;
    VectorX values;      ///< quantities_of, if usable
    std::string reason;  ///< why not
    bool interrupted = false;
};

/// p(t) = p + t * direction * ranges (component by component), within the parameters' bounds.
class DesignLine {
public:
    /// @param direction  In shares of the parameters' ranges. Contract: a component per parameter, finite, not all zero.
    DesignLine(const problem::DesignProblem& problem, const VectorX& p, const VectorX& direction);

    /// The bounds allow t in [least(), most()], least() <= 0 <= most().
    double least() const { return least_; }
    double most() const { return most_; }

    /// Simulates at each t, in parallel; answers in the order of `ts`, the same bits for any number of threads.
    /// @param on_simulation  Optional; called from one thread at a time.
    std::vector<LinePoint> evaluate(const std::vector<double>& ts, const std::function<bool()>& should_stop,
                                    const std::function<void()>& on_simulation) const;

private:
    const problem::DesignProblem& problem_;
    VectorX p_, step_;
    double least_ = 0, most_ = 0;
};

}  // namespace fettle::design::gradient_audit
