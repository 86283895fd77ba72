// SPDX-License-Identifier: MIT
#include "design/gradient_audit/roughness.hpp"

#include <atomic>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "core/base/parallel.hpp"
#include "tests/design/gradient_audit/density_design.hpp"
#include "tests/design/small_problem.hpp"

namespace fettle::design::gradient_audit::roughness_test {

namespace {

using namespace fettle::tests::design_support;
using fettle::design::description::values_of;
using fettle::design::optimisers::NoiseStatus;
using fettle::design::problem::DesignEvaluation;
using fettle::design::problem::DesignProblem;

using OfOne = std::function<double(double)>;

// A function of the first parameter alone.
std::shared_ptr<OfDensities> function(const OfOne& f, const OfOne& slope) {
    return std::make_shared<OfDensities>([f](const VectorX& u) { return f(u[0]); },
                                         [slope](const VectorX& u) { return VectorX::Unit(u.size(), 0) * slope(u[0]); });
}

std::shared_ptr<OfDensities> falling() {
    return function([](double u) { return 3 - u; }, [](double) { return -1; });
}

RoughnessReport roughness_of(const DesignProblem& problem, const VectorX& p, const RoughnessOptions& options = {}) {
    const DesignEvaluation at = problem.evaluate(p);
    INFO(at.reason);
    REQUIRE(at.usable);
    return measure_roughness(problem, p, at, options);
}

RoughnessReport roughness_of(const DesignProblem& problem, const RoughnessOptions& options = {}) {
    return roughness_of(problem, values_of(problem.design().parameters), options);
}

bool same(const RoughnessReport& a, const RoughnessReport& b) {
    bool equal = a.simulations == b.simulations && a.quantities.size() == b.quantities.size();
    for (size_t q = 0; equal && q < a.quantities.size(); ++q) {
        equal = a.quantities[q].noise.noise == b.quantities[q].noise.noise && a.quantities[q].holds == b.quantities[q].holds &&
                a.quantities[q].breaks == b.quantities[q].breaks && a.quantities[q].size == b.quantities[q].size;
    }
    return equal;
}

}  // namespace

TEST_CASE("roughness: noise as it was put in, lengths as geometry has them, within ten simulations") {
    const double sigma = 1e-5, curvature = 10, kink = 2e-5;
    const DesignProblem problem =
        density_problem(1, {falling(), function([=](double u) { return u + sigma * scatter(u); }, [](double) { return 1; }),
                            function([=](double u) { return u + curvature * u * u; }, [=](double u) { return 1 + 2 * curvature * u; }),
                            function([=](double u) { return u < kink ? u : kink - 0.5 * (u - kink); }, [](double) { return 1; }),
                            function([](double) { return 0.7; }, [](double) { return 0; })});
    const RoughnessReport report = roughness_of(problem);
    REQUIRE(report.measured);
    CHECK(report.simulations <= 10);
    CHECK(report.failures.empty());
    REQUIRE(report.quantities.size() == 5);
    CHECK(report.direction[0] == 1);  // the objective falls
    const auto& [objective, noisy, curved, kinked, constant] =
        std::tie(report.quantities[0], report.quantities[1], report.quantities[2], report.quantities[3], report.quantities[4]);

    // The objective is a line: rounding and no more, and its gradient holds as far as was looked.
    CHECK(objective.noise.noise < 1e-15);
    CHECK(std::isinf(objective.breaks));
    CHECK(objective.slope == Approx(-1));
    CHECK_FALSE(objective.rough);

    CHECK(noisy.noise.status == NoiseStatus::detected);
    CHECK((noisy.noise.noise > sigma / 4 && noisy.noise.noise < 4 * sigma));
    CHECK(noisy.tolerance == Approx(1e-7));
    CHECK(noisy.rough);

    // c t^2 <= t / 10 up to t = 1 / (10 c).
    CHECK_FALSE(curved.rough);
    CHECK((curved.holds > 0 && curved.holds <= 0.1 / curvature && curved.breaks > 0.1 / curvature));

    // 1.5 (t - kink) <= max(t / 10, tolerance).
    const double length = 1.5 * kink / 1.4;
    CHECK((kinked.holds > 0 && kinked.holds <= length && kinked.breaks > length));
    CHECK(kinked.rough);

    CHECK(constant.noise.noise == 0);
    CHECK(std::isinf(constant.breaks));
    CHECK_FALSE(constant.rough);
}

TEST_CASE("roughness: more distances bracket the length more closely") {
    const DesignProblem problem =
        density_problem(1, {function([](double u) { return -u + 10 * u * u; }, [](double u) { return -1 + 20 * u; })});
    RoughnessOptions options;
    options.distances = 12;
    const RoughnessReport report = roughness_of(problem, options);
    REQUIRE(report.measured);
    const QuantityRoughness& q = report.quantities[0];
    CHECK((q.holds <= 0.01 && q.breaks > 0.01));
    CHECK(q.breaks < 3 * q.holds);
    CHECK(report.simulations <= 18);
}

TEST_CASE("roughness: rounding is told apart from scatter at larger moves") {
    // Constant pieces of width 1e-4 with scattered heights, on a slope: smooth when looked at closely.
    const DesignProblem problem = density_problem(
        1, {falling(), function([](double u) { return u + 1e-3 * scatter(std::floor(u / 1e-4 + 0.5)); }, [](double) { return 1; })});
    RoughnessOptions options;
    options.fine_spacing = 1e-6;
    options.distances = 6;
    const RoughnessReport report = roughness_of(problem, options);
    REQUIRE(report.measured);
    const QuantityRoughness& q = report.quantities[1];
    CHECK((q.noise.noise > 1e-3 / 4 && q.noise.noise < 4e-3));
    CHECK(q.rounding < 1e-15);
    CHECK(q.rounding > 0);
    CHECK((q.holds < 5e-5 && q.breaks > 5e-5));
    CHECK(q.breaks < 1.1e-3);
    CHECK(report.simulations <= 18);
}

TEST_CASE("roughness: within the bounds, also from a corner of them, and the same bits on one thread") {
    std::atomic<bool> outside{false};
    const auto watched = [&](const VectorX& u) {
        if (u.cwiseAbs().maxCoeff() > 0.5 + 1e-12) outside = true;
        return u[0] + 2 * u[1] + 1e-6 * scatter(u[0] + u[1]);
    };
    const DesignProblem problem =
        density_problem(2, {std::make_shared<OfDensities>(watched, [](const VectorX&) { return Vector2(1, 2); })});
    for (const double x : {500.0, 500.1, 1000.0, 1500.0}) {
        for (const double y : {500.0, 1499.99, 1500.0}) {
            const VectorX p = Vector2(x, y);
            INFO(p.transpose());
            const RoughnessReport report = roughness_of(problem, p);
            REQUIRE(report.measured);
            CHECK_FALSE(outside);
            CHECK(report.quantities[0].noise.status == NoiseStatus::detected);
            CHECK((report.quantities[0].noise.noise > 2.5e-7 && report.quantities[0].noise.noise < 4e-6));
            const core::base::ThreadLimit one(1);
            CHECK(same(report, roughness_of(problem, p)));
        }
    }
}

TEST_CASE("roughness: where trials fail, nearer ones are taken; where all do, nothing is told") {
    const auto until = [](double limit) {
        return function([=](double u) { return std::abs(u) > limit ? std::nan("") : -u + 1e-6 * scatter(u); }, [](double) { return -1; });
    };
    const RoughnessReport near = roughness_of(density_problem(1, {until(1e-3)}));
    REQUIRE(near.measured);
    CHECK(near.spacing == Approx(1e-4));
    CHECK(near.failures.size() >= 4);
    CHECK(near.quantities[0].noise.status == NoiseStatus::detected);
    CHECK((near.quantities[0].noise.noise > 2.5e-7 && near.quantities[0].noise.noise < 4e-6));
    const RoughnessReport never = roughness_of(density_problem(1, {until(1e-9)}));
    CHECK_FALSE(never.measured);
    CHECK(never.quantities.empty());
    CHECK_FALSE(never.failures.empty());
    int asked = 0;
    RoughnessOptions options;
    options.should_stop = [&] { return ++asked > 0; };
    const core::base::ThreadLimit one(1);
    const RoughnessReport stopped = roughness_of(density_problem(1, {falling()}), options);
    CHECK(stopped.interrupted);
    CHECK_FALSE(stopped.measured);
}

TEST_CASE("roughness: downhill within the bounds; remedies only where something is rough") {
    const DesignProblem problem =
        density_problem(2, {std::make_shared<OfDensities>([](const VectorX& u) { return u[0] - 4 * u[1] + 1e-2 * scatter(u[0]); },
                                                          [](const VectorX&) { return Vector2(1, -4); })});
    const VectorX gradient = Vector2(1e-3, -4e-3);
    CHECK(downhill_direction(problem.design(), Vector2(1000, 1000), gradient).isApprox(Vector2(-0.25, 1)));
    CHECK(downhill_direction(problem.design(), Vector2(1000, 1500), gradient).isApprox(Vector2(-1, 0)));
    CHECK(downhill_direction(problem.design(), Vector2(500, 1500), gradient).isApprox(Vector2(1, -1)));  // away from the nearer bounds
    const RoughnessReport rough = roughness_of(problem);
    REQUIRE(rough.measured);
    CHECK(rough.quantities[0].rough);
    std::string told;
    for (const std::string& remedy : roughness_remedies(problem.design(), rough)) told += remedy + "\n";
    for (const char* word :
         {"contact.dhat", "0.1 mm", "quasi_static", "contact.damping_time", "damping of the bodies", "timestep", "0.01 s"})
        CHECK(told.find(word) != std::string::npos);
    const RoughnessReport smooth = roughness_of(density_problem(1, {falling()}));
    CHECK(roughness_remedies(problem.design(), smooth).empty());
}

TEST_CASE("roughness: what does not depend on the simulation is smooth at rounding level", "[slow]") {
    const DesignFolder folder;
    const DesignProblem problem = problem_of(folder);
    const RoughnessReport report = roughness_of(problem);
    REQUIRE(report.measured);
    CHECK(report.simulations <= 10);
    bool mass = false;
    for (const QuantityRoughness& quantity : report.quantities) {
        INFO(quantity.name << ": noise " << quantity.noise.noise << " of " << quantity.size);
        if (quantity.name.find("mass") == std::string::npos) continue;
        mass = true;
        CHECK(quantity.noise.noise < 1e-14 * quantity.size);
        CHECK_FALSE(quantity.rough);
        CHECK(quantity.holds > 0);
    }
    CHECK(mass);
}

}  // namespace fettle::design::gradient_audit::roughness_test
