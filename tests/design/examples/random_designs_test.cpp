// SPDX-License-Identifier: MIT
// Gradients are finite everywhere: random designs of the slider-crank over the first steps of its motion, some of them audited.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "design/gradient_audit/difference_check.hpp"
#include "design/reading/design_reader.hpp"
#include "design/studies/random_start.hpp"

namespace fettle::design::examples::random_designs_test {

namespace {

using problem::DesignEvaluation;
using problem::DesignProblem;

DesignProblem short_slider_crank() {
    auto read = reading::read_design("examples/slider_crank/slider_crank.design.json");
    REQUIRE(read);
    description::Design design = read->design;
    design.steps = 20;
    auto problem = DesignProblem::create(design);
    REQUIRE(problem);
    return std::move(problem).value();
}

// Directional derivative of the objective along `way`, by differences of whole simulations; infinite error where one fails.
gradient_audit::DifferenceEstimate difference_along(const DesignProblem& problem, const VectorX& p, const VectorX& way) {
    std::vector<double> differences;
    for (double s = 1e-4; s > 1e-6; s /= 4) {
        const DesignEvaluation ahead = problem.evaluate(p + s * way, {false, {}, {}}),
                               behind = problem.evaluate(p - s * way, {false, {}, {}});
        if (!ahead.usable || !behind.usable) return {0, INFINITY, 0};
        differences.push_back((ahead.objective - behind.objective) / (2 * s));
    }
    return gradient_audit::ridders_estimate(differences, 4);
}

}  // namespace

TEST_CASE("gradients are finite at random designs, and agree with differences along themselves", "[slow]") {
    const DesignProblem problem = short_slider_crank();
    const auto& parameters = problem.design().parameters;
    VectorX ranges(problem.parameter_count());
    for (Eigen::Index i = 0; i < ranges.size(); ++i) {
        const auto& parameter = parameters[i];
        ranges[i] = parameter.upper - parameter.lower;
    }
    constexpr int wanted = 1000, audits = 30;
    int designs = 0, refused = 0, without_reason = 0, not_finite = 0, audited = 0, resolved = 0, wrong = 0;
    for (std::uint64_t seed = 1; designs < wanted; ++seed) {
        const VectorX p = studies::sample_of_seed(problem.design(), seed);
        if (!problem.obstacles(p).empty()) continue;  // parts that intersect as assembled are no design
        ++designs;
        const DesignEvaluation at = problem.evaluate(p);
        if (!at.usable) {
            WARN("seed " << seed << ": " << at.reason);
            ++refused;
            without_reason += at.reason.empty();
            continue;
        }
        const bool finite = at.gradient.size() == ranges.size() && at.gradient.allFinite() && at.jacobian.allFinite();
        not_finite += !finite;
        if (!finite || audited == audits) continue;
        ++audited;
        const VectorX slope = at.gradient.cwiseProduct(ranges);
        const VectorX way = ranges.cwiseProduct(slope) / slope.norm();
        const double exact = at.gradient.dot(way);
        const auto estimate = difference_along(problem, p, way);
        if (!(estimate.error <= 1e-5 * std::abs(exact))) continue;  // the differences do not tell to that accuracy
        ++resolved;
        wrong += std::abs(estimate.value - exact) > 1e-4 * std::abs(exact);
    }
    CAPTURE(refused, resolved);
    CHECK(without_reason == 0);
    CHECK(refused <= wanted / 100);
    CHECK(not_finite == 0);
    CHECK(audited == audits);
    CHECK(resolved >= audits / 2);
    CHECK(wrong == 0);
}

}  // namespace fettle::design::examples::random_designs_test
