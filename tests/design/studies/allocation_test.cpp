// SPDX-License-Identifier: MIT
// Allocations against Lagrange's closed forms, and of the one-way clutch.
#include "design/studies/allocation.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "design/reading/design_reader.hpp"
#include "design/tolerances/normal_distribution.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fettle::design::studies::allocation_test {

namespace {

constexpr double degree = std::numbers::pi / 180;

const char* const block = R"({"fettle_scene": 1, "units": "mm", "timestep": 0.01, "end_time": 0.01,
    "bodies": [{"name": "block", "density": 1000, "shape": {"part": "box", "dimensions": {"size_x": 10, "size_y": 10, "size_z": 10}}}]})";

// A gap of three lengths: 0.5 mm within 0.2 mm.
const char* const stack = R"json({"fettle_design": 1, "scene": "block.scene.json", "units": "mm",
    "parameters": [{"name": "a", "value": 20, "lower": 5, "upper": 30}, {"name": "b", "value": 5, "lower": 1, "upper": 12},
                   {"name": "c", "value": 29.5, "lower": 5, "upper": 55}],
    "objective": [{"type": "expression", "expression": "(a + b + c) / 1 mm"}],
    "constraints": [{"type": "relation", "name": "gap", "expression": "a + 2 * b - c", "lower": "0.3 mm", "upper": "0.7 mm"}],
    "tolerances": TOLERANCES})json";

// One-way clutch (Gao, Chase and Magleby).
const char* const clutch = R"json({"fettle_design": 1, "scene": "block.scene.json", "units": "mm",
    "parameters": [{"name": "a", "value": 27.645, "lower": 20, "upper": 30}, {"name": "c", "value": 11.43, "lower": 10, "upper": 12},
                   {"name": "e", "value": 50.8, "lower": 45, "upper": 55}],
    "objective": [{"type": "expression", "expression": "(a + c + e) / 1 mm"}],
    "constraints": [{"type": "relation", "name": "angle", "expression": "acos((a + c) / (e - c))", "lower": "6.5 deg", "upper": "7.5 deg"}],
    "tolerances": {"a": "+-0.05 mm", "c": "+-0.01", "e": "+-0.0125"}})json";

struct Folder : tests::support::TemporaryFolder {
    Folder() { write("block.scene.json", block); }
    Result<reading::DesignFile> read(std::string text, const std::string& tolerances = "") {
        if (const std::size_t at = text.find("TOLERANCES"); at != std::string::npos) text.replace(at, 10, tolerances);
        reading::DesignReadOptions options;
        options.as_made = true;
        return reading::parse_design(text, file("x.design.json"), options);
    }
};

AllocationReport allocated(const Result<reading::DesignFile>& file, const AllocationOptions& options = {}) {
    for (const Error& error : file.errors()) UNSCOPED_INFO(error.where << ": " << error.message);
    REQUIRE(file);
    const auto problem = problem::DesignProblem::create(file->design);
    REQUIRE(problem);
    return allocate(*problem, file->tolerances, options);
}

double half(const AllocationReport& report, int j) {
    const tolerances::Distribution& d = report.tolerances[j].deviation;
    return (d.upper - d.lower) / 2;
}

// With a yield of 99.73% in two limits, three standard deviations.
const double three = -tolerances::normal_quantile(0.0027 / 2);

}  // namespace

TEST_CASE("allocation of a linear stack by yield: Lagrange's t ~ (a / g^2)^(1/3)") {
    Folder folder;
    const auto file = folder.read(stack, R"({"a": "+-0.1 mm", "b": {"lower": -0.05, "upper": 0.05, "cost": 4}, "c": "+-0.2"})");
    const AllocationReport report = allocated(file);
    INFO(report.message);
    REQUIRE(report.status == AllocationStatus::held);
    // Costs A / t of A = cost * t as it stands.
    const Vector3 a(0.1e-3, 4 * 0.05e-3, 0.2e-3), g(1, 2, -1);
    Vector3 t;
    for (int j = 0; j < 3; ++j) t[j] = std::cbrt(a[j] / (g[j] * g[j]));
    t *= 0.2e-3 * 3 / three / std::sqrt(t.cwiseProduct(g).squaredNorm());
    for (int j = 0; j < 3; ++j) {
        INFO(j);
        CHECK(half(report, j) == Approx(t[j]).epsilon(1e-6));
    }
    CHECK(report.cost == Approx(a.cwiseQuotient(t).sum()).epsilon(1e-6));
    CHECK(report.cost_before == Approx(6));
    REQUIRE(report.requirements.size() == 1);
    CHECK(report.requirements[0].is_limiting);
    CHECK(report.requirements[0].predicted == Approx(0.9973).epsilon(1e-8));
    CHECK(report.study.responses[1].linear.standard_deviation == Approx(0.2e-3 / three).epsilon(1e-6));
}

TEST_CASE("allocation of a linear stack in the worst case: t ~ (a / |g|)^(1/2)") {
    Folder folder;
    AllocationOptions options;
    options.worst_case = true;
    const AllocationReport report =
        allocated(folder.read(stack, R"({"a": "+-0.1 mm", "b": {"lower": -0.05, "upper": 0.05, "cost": 4}, "c": "+-0.2"})"), options);
    INFO(report.message);
    REQUIRE(report.status == AllocationStatus::held);
    const Vector3 a(0.1e-3, 4 * 0.05e-3, 0.2e-3), g(1, 2, -1);
    Vector3 t;
    for (int j = 0; j < 3; ++j) t[j] = std::sqrt(a[j] / std::abs(g[j]));
    t *= 0.2e-3 / t.cwiseProduct(g.cwiseAbs()).sum();
    for (int j = 0; j < 3; ++j) CHECK(half(report, j) == Approx(t[j]).epsilon(1e-6));
    CHECK(report.study.responses[1].worst.most == Approx(0.7e-3).epsilon(1e-6));
}

TEST_CASE("allocation: a fixed tolerance stays, the others have what it leaves; limits beside the nominal value keep their share") {
    Folder folder;
    const auto file =
        folder.read(stack, R"({"a": {"lower": 0, "upper": 0.1}, "b": {"lower": -0.05, "upper": 0.05, "fixed": true}, "c": "+-0.2"})");
    const AllocationReport report = allocated(file);
    INFO(report.message);
    REQUIRE(report.status == AllocationStatus::held);
    CHECK(half(report, 1) == Approx(0.05e-3).epsilon(1e-12));
    CHECK(report.tolerances[0].deviation.lower == 0);
    // The optimum on a grid: a's mean moves with its width.
    double least = 1e9;
    for (int i = 1; i < 2000; ++i) {
        const double ta = i * 0.1e-6, mean = 0.5e-3 + ta;
        const double allowed = allowed_sigma(mean, {0.3e-3, 0.7e-3}, 0.0027);
        const double left = 9 * allowed * allowed - ta * ta - 4 * 0.05e-3 * 0.05e-3;
        if (left > 0) least = std::min(least, 0.05e-3 / ta + 1 + 0.2e-3 / std::sqrt(left));
    }
    CHECK(report.cost == Approx(least).epsilon(1e-5));
}

TEST_CASE("allocation: what no requirement notices is as wide as is looked at; what cannot be held is told") {
    Folder folder;
    std::string text = stack;
    text.replace(text.find("a + 2 * b - c"), 13, "a + 2 * b - 29.5 mm");
    const AllocationReport report = allocated(folder.read(text, R"({"a": "+-0.1 mm", "c": "+-0.2"})"));
    REQUIRE(report.status == AllocationStatus::held);
    CHECK(report.allocated[1].is_widest);
    CHECK(report.allocated[1].factor == Approx(largest_factor).epsilon(0.01));
    const AllocationReport none =
        allocated(folder.read(stack, R"({"a": {"lower": -0.1, "upper": 0.1, "fixed": true, "shift": 0.3}, "c": "+-0.2"})"));
    CHECK(none.status == AllocationStatus::not_held);
    CHECK(none.message.find("gap: its mean does not lie within its bounds") != std::string::npos);
    const AllocationReport fixed = allocated(folder.read(stack, R"({"a": {"lower": -0.3, "upper": 0.3, "fixed": true}, "c": "+-0.2"})"));
    CHECK(fixed.status == AllocationStatus::not_held);
    CHECK(fixed.message.find("gap: what is fixed") != std::string::npos);
}

TEST_CASE("allocation by a formula and by grades") {
    Folder folder;
    // Cost (0.1 mm / t)^2 of both: t ~ (1 / g^2)^(1/4).
    const AllocationReport formula = allocated(folder.read(
        stack,
        R"({"a": {"lower": -0.1, "upper": 0.1, "cost": "(0.1 mm / t)^2"}, "b": {"lower": -0.1, "upper": 0.1, "cost": "0.01 mm^2 / t^2"}})"));
    INFO(formula.message);
    REQUIRE(formula.status == AllocationStatus::held);
    CHECK(half(formula, 0) / half(formula, 1) == Approx(std::sqrt(2)).epsilon(1e-5));
    // 20 H: IT 8 33 um, 9 52, 10 84, 11 130, 12 210; 5: 18, 30, 48, 75, 120. Every pair is tried here.
    const auto file = folder.read(stack, R"({"a": {"class": "H8", "cost": {"IT8": 8, "IT9": 5, "IT10": 3, "IT11": 2, "IT12": 1.5}},
        "b": {"lower": -0.009, "upper": 0.009, "cost": {"IT12": 1, "IT11": 2, "IT10": 4, "IT9": 7, "IT8": 12}}})");
    const AllocationReport grades = allocated(file);
    INFO(grades.message);
    REQUIRE(grades.status == AllocationStatus::held);
    const double wide[] = {33e-6, 52e-6, 84e-6, 130e-6, 210e-6}, narrow[] = {18e-6, 30e-6, 48e-6, 75e-6, 120e-6};
    const double cost_a[] = {8, 5, 3, 2, 1.5}, cost_b[] = {12, 7, 4, 2, 1};
    double least = 1e9;
    for (int i = 0; i < 5; ++i)
        for (int k = 0; k < 5; ++k)
            if (std::hypot(wide[i] / 6, 2 * narrow[k] / 6) <= allowed_sigma(0.5e-3 + wide[i] / 2, {0.3e-3, 0.7e-3}, 0.0027))
                least = std::min(least, cost_a[i] + cost_b[k]);
    CHECK(grades.cost == Approx(least));
    CHECK(grades.cost_before == Approx(20));
    CHECK(grades.allocated[0].choice.starts_with("H"));
    CHECK(grades.allocated[1].choice.starts_with("IT"));
}

TEST_CASE("allocation of the one-way clutch: its yield by the second order, and by samples") {
    Folder folder;
    AllocationOptions options;
    options.study.samples = 4096;
    const auto file = folder.read(clutch);
    const AllocationReport report = allocated(file, options);
    INFO(report.message);
    REQUIRE(report.status == AllocationStatus::held);
    // Lagrange's ratios of a linear clutch, t ~ (a / g^2)^(1/3), g in deg/mm.
    const Vector3 a(0.05, 0.01, 0.0125), g(-11.910473, -23.731700, 11.821227);
    for (int j = 0; j < 3; ++j) {
        const double lagrange = std::cbrt(a[j] / (g[j] * g[j])) / std::cbrt(a[0] / (g[0] * g[0]));
        CHECK(half(report, j) / half(report, 0) == Approx(lagrange).epsilon(0.01));
    }
    REQUIRE(report.requirements.size() == 1);
    CHECK(report.requirements[0].predicted == Approx(0.9973).margin(1e-4));
    REQUIRE(report.study.responses[1].sampled);
    const auto counted = tolerances::counted_yield(report.study.responses[1].sampled->met, count_of(report.study.samples), 0.95);
    CHECK(counted.least.within < 0.9973);
    CHECK(counted.most.within > 0.9973);
    AllocationOptions worst;
    worst.worst_case = true;
    const AllocationReport corners = allocated(file, worst);
    INFO(corners.message);
    REQUIRE(corners.status == AllocationStatus::held);
    const Response& angle = corners.study.responses[1];
    CHECK(angle.least_found->value / degree >= 6.5 - 0.01);
    CHECK(angle.most_found->value / degree <= 7.5 + 0.01);
    CHECK(std::min(angle.least_found->value / degree - 6.5, 7.5 - angle.most_found->value / degree) < 0.01);
}

TEST_CASE("allocation's model: derivatives of mean and standard deviation are differences'") {
    AllocationModel model;
    model.deviations = {{tolerances::DistributionKind::normal, -0.1, 0.3, 3, 0.02},
                        {tolerances::DistributionKind::uniform, 0.1, 0.2, 3, 0}};
    model.correlation = Eigen::Matrix2d{{1, 0.3}, {0.3, 1}};
    RequirementModel requirement;
    requirement.limits = {-1, 2};
    requirement.nominal = 0.4;
    requirement.gradient = Vector2(1, -2);
    requirement.curvature = Eigen::Matrix2d{{0.7, 1.1}, {1.1, -0.5}};
    requirement.sigma_correction = 1.2;
    const Vector2 f(0.8, 1.7);
    const ModelMoments at = moments_at(model, requirement, f);
    for (int j = 0; j < 2; ++j) {
        constexpr double h = 1e-6;
        const ModelMoments above = moments_at(model, requirement, f + h * Vector2::Unit(j));
        const ModelMoments below = moments_at(model, requirement, f - h * Vector2::Unit(j));
        CHECK(at.mean_slope[j] == Approx((above.mean - below.mean) / (2 * h)).epsilon(1e-7));
        CHECK(at.sigma_slope[j] == Approx((above.sigma - below.sigma) / (2 * h)).epsilon(1e-7));
    }
    const double allowed = allowed_sigma(0.3, {-1, 2}, 0.01);
    CHECK(tolerances::normal_yield(0.3, allowed, {-1, 2}).outside == Approx(0.01).epsilon(1e-9));
    CHECK(allowed_sigma(0.3, {-core::base::infinity, 2}, 0.01) == Approx(1.7 / 2.3263478740408408));
    CHECK(allowed_sigma(2.1, {-1, 2}, 0.01) == 0);
}

TEST_CASE("allocation: faults of costs name the entry and say what is allowed") {
    Folder folder;
    const auto fault = [&](const std::string& cost) {
        const auto file = folder.read(stack, R"({"a": {"lower": -0.1, "upper": 0.1, "cost": )" + cost + "}}");
        REQUIRE_FALSE(file);
        return file.errors().front().where + ": " + file.errors().front().message;
    };
    CHECK(fault("-1").find("#/tolerances/a/cost") != std::string::npos);
    CHECK(fault(R"("t / 0.1 mm")").find("rises") != std::string::npos);
    CHECK(fault(R"("0.1 / t")").find("no plain number") != std::string::npos);
    CHECK(fault(R"("3")").find("does not name `t`") != std::string::npos);
    CHECK(fault(R"({"H7": 3})").find("IT7") != std::string::npos);
    CHECK(fault("{}").find("names no grade") != std::string::npos);
}

}  // namespace fettle::design::studies::allocation_test
