// SPDX-License-Identifier: MIT
/// A formula of the design's parameters inside of a quantity, such as a target that moves with them: its value, and its part of the
/// gradient.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/expression/formula.hpp"
#include "design/description/quantity.hpp"

namespace fettle::design::quantities {

/// The value at the simulated design's parameters. Contract: its inputs are among them (problem/check_design.hpp looks).
double value_at(const core::expression::Formula& formula, const description::Simulated& simulated);

/// Adds scale * d(parameter of that name) to the seeds.
void add_parameter_seed(const std::string& parameter, const description::Simulated& simulated, double scale, description::Seeds& seeds);

/// Adds scale * d(value_at) to the seeds.
void add_formula_seed(const core::expression::Formula& formula, const description::Simulated& simulated, double scale,
                      description::Seeds& seeds);

/// A point whose coordinates may follow from parameters: those have a formula [m].
struct OwnPoint {
    Vector3 at = Vector3::Zero();  ///< where the parameters are as the design has them
    std::array<std::optional<core::expression::Formula>, 3> formulas{};

    OwnPoint() = default;
    template <class Derived>
    OwnPoint(const Eigen::MatrixBase<Derived>& point) : at(point) {}  // NOLINT: a point that stays is a point

    bool follows() const { return formulas[0] || formulas[1] || formulas[2]; }
    /// At the simulated design's parameters.
    Vector3 value(const description::Simulated& simulated) const;
    /// Adds gradient . d(value) to the seeds.
    void add_seed(const description::Simulated& simulated, const Vector3& gradient, description::Seeds& seeds) const;
    /// Adds the names of the parameters that it follows from.
    void add_parameters(std::vector<std::string>& names) const;
};

}  // namespace fettle::design::quantities
