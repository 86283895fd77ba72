// SPDX-License-Identifier: MIT
/// A design problem from the texts of its two files, and the check of its constraints' derivatives.
#pragma once

#include <catch2/catch.hpp>
#include <string>

#include "design/problem/design_problem.hpp"
#include "design/reading/design_reader.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fettle::tests::design_support {

/// @param design  Its scene is "small.scene.json".
inline design::problem::DesignProblem problem_of(const std::string& scene, const std::string& design) {
    const support::TemporaryFolder folder;
    folder.write("small.scene.json", scene);
    auto file = design::reading::parse_design(design, folder.file("small.design.json"));
    for (const Error& error : file.errors()) UNSCOPED_INFO(error.where << ": " << error.message);
    REQUIRE(file);
    auto problem = design::problem::DesignProblem::create(std::move(file->design));
    for (const Error& error : problem.errors()) UNSCOPED_INFO(error.where << ": " << error.message);
    REQUIRE(problem);
    return std::move(problem).value();
}

/// Checks the derivatives of all constraints in all parameters, at the design as written, against central differences of whole simulations.
/// A number that is about 1 on the way (a turn) is known to some 1e-15, by which differences of what stays 0 are off.
inline void check_gradient(const design::problem::DesignProblem& problem, double limit) {
    const VectorX p = design::description::values_of(problem.design().parameters);
    const design::problem::DesignEvaluation at = problem.evaluate(p);
    INFO(at.reason);
    REQUIRE(at.usable);
    for (Eigen::Index k = 0; k < p.size(); ++k) {
        const auto& parameter = problem.design().parameters[k];
        const double h = 1e-5 * (parameter.upper - parameter.lower);
        VectorX above = p, below = p;
        above[k] += h;
        below[k] -= h;
        const design::problem::DesignEvaluation one = problem.evaluate(above, {false, {}, {}}),
                                                other = problem.evaluate(below, {false, {}, {}});
        for (std::size_t i = 0; i < at.constraints.size(); ++i) {
            INFO(problem.design().constraints[i].name << " by " << parameter.name);
            const double difference = (one.constraints[i].value - other.constraints[i].value) / (2 * h);
            const double size = std::abs(at.constraints[i].value) / (parameter.upper - parameter.lower);
            CHECK(at.jacobian(static_cast<Eigen::Index>(i), k) == Approx(difference).epsilon(limit).margin(limit * size + 1e-15 / h));
        }
    }
}

}  // namespace fettle::tests::design_support
