// SPDX-License-Identifier: MIT
// The eccentric with its follower against closed forms (examples/README.md).
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "design/quantities/marker.hpp"
#include "tests/design/examples/example_files.hpp"

namespace fettle::design::examples::follower_test {

namespace {

using tests::design_support::Example;

using description::Simulated;

constexpr double dhat = 0.08e-3;

// How far a polygon's flats lie inside its circle.
double sag(double radius, int segments) { return radius * (1 - std::cos(std::numbers::pi / segments)); }

double rise(const Example& example, const problem::DesignEvaluation& evaluation) {
    return evaluation.constraints[example.constraint("stroke")].value;
}

TEST_CASE("example follower: as written it can be simulated, and rise and play are not what is required") {
    const Example example = Example::read("follower");
    REQUIRE(example.design.parameters.size() == 6);
    const auto evaluation = example.problem.evaluate(example.start);
    INFO(evaluation.reason);
    REQUIRE(evaluation.usable);
    CHECK(rise(example, evaluation) < 7.98e-3);
    const auto play = evaluation.constraints[example.constraint("clearance follower:guide")];
    CHECK(play.upper < 0.2e-3);
    CHECK(play.value == Approx(5e-3 - 4.9e-3 * std::cos(std::numbers::pi / 24)).epsilon(1e-6));  // flat against flat
    CHECK(evaluation.violation > 0.5e-3);

    // The rise is 2 e, but for facets and contact; so is its derivative.
    const VectorX gradient = evaluation.jacobian.row(example.constraint("stroke"));
    CHECK(gradient[example.parameter("eccentricity")] == Approx(2).margin(0.05));
    for (const char* name : {"guide_height", "head_gap"}) CHECK(std::abs(gradient[example.parameter(name)]) < 1e-3);
}

TEST_CASE("example follower: the rise is twice the eccentricity, and the tip keeps to the disc all the way round") {
    const Example example = Example::read("follower");
    const std::map<std::string, double> round_off = {{"eccentricity", 4.7e-3}, {"disc_radius", 12.5e-3}, {"tip_radius", 7e-3}};
    for (const auto& changes : {std::map<std::string, double>{}, round_off}) {
        const VectorX p = example.values(changes);
        const double e = p[example.parameter("eccentricity")], disc = p[example.parameter("disc_radius")],
                     tip = p[example.parameter("tip_radius")];
        const auto evaluation = example.problem.evaluate(p, {false, {}, {}});
        INFO(evaluation.reason);
        REQUIRE(evaluation.usable);
        CHECK(std::abs(rise(example, evaluation) - 2 * e) < sag(disc, 96) + dhat / 2);

        // Distance of the tip's centre from the disc's axis, less both radii: the gap, but for facets. It falls for three steps.
        const core::stepper::Trajectory& trajectory = evaluation.runs.front().simulation.trajectory;
        const Simulated simulated{*evaluation.runs.front().model, trajectory};
        double least = 1, largest = 0;
        for (int t = 4; t < count_of(trajectory.poses); ++t) {
            const double angle = 2 * std::numbers::pi * core::stepper::time_at(trajectory, t);
            const Vector3 centre = quantities::marker_position(simulated, t, 1, Vector3(0, 0, tip));
            const double gap = std::hypot(centre.y() - e * std::sin(angle), centre.z() + e * std::cos(angle)) - disc - tip;
            least = std::min(least, gap);
            largest = std::max(largest, gap);
        }
        INFO("gap from " << least * 1e6 << " to " << largest * 1e6 << " um");
        CHECK(least > 0);
        CHECK(largest < dhat);
    }
}

TEST_CASE("example follower: the derivative is that of whole simulations, in rise, play and objective", "[slow]") {
    const Example example = Example::read("follower");
    const auto evaluation = example.problem.evaluate(example.start);
    REQUIRE(evaluation.usable);
    for (const char* name : {"eccentricity", "shank_radius"}) {
        const int k = example.parameter(name);
        const double step = 1e-9;
        VectorX above = example.start, below = example.start;
        above[k] += step;
        below[k] -= step;
        const auto upper = example.problem.evaluate(above, {false, {}, {}}), lower = example.problem.evaluate(below, {false, {}, {}});
        REQUIRE(upper.usable);
        REQUIRE(lower.usable);
        INFO(name);
        CHECK((upper.objective - lower.objective) / (2 * step) == Approx(evaluation.gradient[k]).epsilon(1e-4).margin(1e-3));
        for (const char* constraint : {"stroke", "clearance follower:guide"}) {
            const int row = example.constraint(constraint);
            const auto at = static_cast<size_t>(row);
            INFO(constraint);
            CHECK((upper.constraints[at].value - lower.constraints[at].value) / (2 * step) ==
                  Approx(evaluation.jacobian(row, k)).epsilon(1e-4).margin(1e-5));
        }
    }
}

}  // namespace

}  // namespace fettle::design::examples::follower_test
