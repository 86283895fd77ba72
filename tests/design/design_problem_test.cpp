// SPDX-License-Identifier: MIT
#include "fettle/design/design_problem.hpp"

#include <catch2/catch.hpp>
#include <cstring>
#include <fstream>
#include <sstream>

#include "fettle/design/design_file.hpp"
#include "fettle/design/difference_check.hpp"
#include "fettle/design/optimise_design.hpp"
#include "fettle/tests/design/small_design.hpp"

namespace {

using namespace fettle;
using namespace fettle::design;
using namespace fettle::tests::design_support;

DesignProblem problem_of(const DesignFolder& folder) {
    Result<Design> design = read_design(folder.design());
    REQUIRE(design);
    Result<DesignProblem> problem = DesignProblem::create(std::move(design).value());
    REQUIRE(problem);
    return std::move(problem).value();
}

std::string contents(const std::filesystem::path& path) {
    std::ifstream in(path, std::ios::binary);
    std::stringstream text;
    text << in.rdbuf();
    return text.str();
}

}  // namespace

TEST_CASE("ridders: exact on the polynomials that it extrapolates, and it keeps away from noise") {
    std::vector<double> differences;
    for (double s = 0.1; s > 1e-4; s /= 4) differences.push_back(2 + 3 * s * s - 5 * s * s * s * s);
    CHECK(ridders_estimate(differences, 4).value == Approx(2).epsilon(1e-13));
    std::vector<double> noisy;
    for (double s = 1e-1; s > 1e-9; s /= 4) noisy.push_back((std::exp(1 + s) - std::exp(1 - s)) / (2 * s));
    const DifferenceEstimate estimate = ridders_estimate(noisy, 4);
    CHECK(std::abs(estimate.value - std::exp(1.0)) < 1e-11);
    CHECK(std::abs(estimate.value - std::exp(1.0)) < 10 * estimate.error + 1e-14);
    CHECK(std::isinf(ridders_estimate({1.0}, 4).error));
}

TEST_CASE("gradients of a simulated design with contact agree with differences", "[slow]") {
    const DesignFolder folder;
    const DesignProblem problem = problem_of(folder);
    const VectorX p = values_of(problem.design().parameters);
    const DesignEvaluation at = problem.evaluate(p);
    INFO(at.reason);
    REQUIRE(at.usable);
    int contacts = 0;
    for (const auto& step : at.simulation.report.steps) contacts += step.contacts;
    CHECK(contacts > 0);
    const CheckReport report = check_gradients(problem, p, at);
    CHECK(report.failures.empty());
    REQUIRE(report.rows.size() == 6 * 5);
    int not_zero = 0;
    for (const CheckRow& row : report.rows) {
        INFO(row.quantity << " " << row.parameter << ": " << row.adjoint << " against " << row.difference << " +- "
                          << row.difference_error);
        CHECK(row.relative_error < 1e-6);
        not_zero += row.adjoint != 0;
    }
    CHECK(not_zero > 20);
}

TEST_CASE("a wrong gradient is noticed by the check", "[slow]") {
    const DesignFolder folder;
    const DesignProblem problem = problem_of(folder);
    const VectorX p = values_of(problem.design().parameters);
    DesignEvaluation at = problem.evaluate(p);
    REQUIRE(at.usable);
    at.gradient[2] *= 1.001;
    CheckOptions quick;
    quick.sizes = 3;
    CHECK(check_gradients(problem, p, at, quick).largest_relative_error > 5e-4);
}

TEST_CASE("a trial that cannot be built or simulated says why") {
    const DesignFolder folder;
    const DesignProblem problem = problem_of(folder);
    VectorX p = values_of(problem.design().parameters);
    p[2] = 0.035;  // inside the wall
    const DesignEvaluation inside = problem.evaluate(p);
    CHECK_FALSE(inside.usable);
    CHECK(inside.reason.find("wall") != std::string::npos);
    p[2] = 0.003;
    EvaluateOptions stop;
    stop.should_stop = [] { return true; };
    const DesignEvaluation stopped = problem.evaluate(p, stop);
    CHECK(stopped.interrupted);
    CHECK_THROWS_AS(problem.history_entry(p, stopped), optimisers::Interrupted);
}

TEST_CASE("an evaluation has the same bits each time, gradients asked for or not") {
    const DesignFolder folder;
    const DesignProblem problem = problem_of(folder);
    const VectorX p = values_of(problem.design().parameters);
    EvaluateOptions without;
    without.gradients = false;
    const DesignEvaluation a = problem.evaluate(p), b = problem.evaluate(p, without);
    REQUIRE(a.usable);
    REQUIRE(b.usable);
    CHECK(a.objective == b.objective);
    for (size_t i = 0; i < a.constraints.size(); ++i) CHECK(a.constraints[i].value == b.constraints[i].value);
    // the whole motion's least distance is that of the nearer window
    CHECK(a.constraints[0].value == Approx(std::min(a.constraints[1].value, a.constraints[2].value)).margin(2e-9));
}

TEST_CASE("a simulated design, killed and resumed, ends the same, bit for bit", "[slow]") {
    const DesignFolder folder;
    const DesignProblem problem = problem_of(folder);
    OptimiseOptions options;
    options.directory = (folder.path / "whole").string();
    const Result<OptimiseOutcome> whole = optimise_design(problem, options);
    REQUIRE(whole);
    REQUIRE(whole->report.evaluations > 4);

    options.directory = (folder.path / "killed").string();
    std::filesystem::create_directories(options.directory);
    const std::string history = contents(folder.path / "whole" / "history.jsonl");
    size_t cut = 0;
    for (int line = 0; line < 4; ++line) cut = history.find('\n', cut) + 1;
    std::ofstream(std::filesystem::path(options.directory) / "history.jsonl", std::ios::binary) << history.substr(0, cut + 57);
    options.resume = true;
    const Result<OptimiseOutcome> resumed = optimise_design(problem, options);
    REQUIRE(resumed);
    CHECK(resumed->replayed == 3);
    CHECK(resumed->report.evaluations == whole->report.evaluations);
    CHECK(std::memcmp(resumed->report.point.data(), whole->report.point.data(), 5 * sizeof(double)) == 0);
    CHECK(contents(folder.path / "killed" / "design.final.json") == contents(folder.path / "whole" / "design.final.json"));
    CHECK(contents(folder.path / "killed" / "trajectory.json") == contents(folder.path / "whole" / "trajectory.json"));

    // What is written is what was found: read again, it has the same numbers.
    Result<Design> final = read_design((folder.path / "whole" / "design.final.json").string());
    REQUIRE(final);
    const VectorX values = values_of(final->parameters);
    const DesignEvaluation again = DesignProblem::create(std::move(final).value())->evaluate(values);
    CHECK(again.objective == whole->report.best.objective);
}
