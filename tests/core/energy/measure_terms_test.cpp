// SPDX-License-Identifier: MIT
// Laws of measures, and the term that they make, against central differences; a damped oscillation against its exponential.
#include "core/energy/measure_terms.hpp"
#include "core/linear/factorisations.hpp"

#include <catch2/catch.hpp>

#include "core/energy/incremental_potential.hpp"
#include "core/energy/start_history.hpp"
#include "tests/support/derivative_check.hpp"
#include "tests/support/mechanisms.hpp"

namespace fettle::core::energy::measure_terms_test {

using namespace fettle::tests::mechanisms;
using namespace fettle::tests::support;
using core::scene::JointKind;

namespace {

// Two bars that a spring, a damper, a stop, friction and a force act between, and on one of them from the world; no rows.
model::Model loose_bars(scene::Integrator integrator) {
    scene::Scene scene = scene_of({bar("one", 0.3), bar("two", 0.2, Vector3(0.1, 0.3, 0.2), Vector3(0.4, 0.2, -0.3))}, 0.02);
    scene.integrator = integrator;
    scene.dhat = 0.05;
    scene.friction.eps_v = 0.5;
    scene::Spring between, from_world;
    between.name = "between";
    between.a = {"one", Vector3(0.3, 0, 0), Vector3::UnitZ()};
    between.b = {"two", Vector3(0.2, 0, 0), Vector3::UnitZ()};
    between.forces = {70, 0.2, 0, 3, 2, std::array<double, 2>{0.0, 0.315}};  // pressed where derivatives are looked at
    from_world.name = "from world";
    from_world.a = {"", Vector3(0, 0, 0.5), Vector3::UnitZ()};
    from_world.b = {"one", Vector3(0.1, 0, 0), Vector3::UnitZ()};
    from_world.forces = {40, 0.8, 0, 1, 0, std::nullopt};  // pushes: its curvature across is negative
    scene.mechanism.springs = {between, from_world};
    scene.mechanism.loads = {{"load", "", "two", Vector3(0.1, 0.02, 0), Vector3(1, 2, 3)}};
    return built(scene);
}

// What a stop of lengths gives way by at most.
double width(const model::Model& model) { return model::stop_give * model.dhat; }

}  // namespace

TEST_CASE("laws of measures agree with differences", "[measure_terms]") {
    const model::Model model = loose_bars(scene::Integrator::implicit_euler);
    const StepProblem problem = step_problem(model, start_history(model), model.kappa);
    for (std::size_t k = 0; k < model.mechanism.terms.size(); ++k) {
        const model::MeasureTerm& term = model.mechanism.terms[k];
        const double start = problem.mechanism.measures[term.measure];
        std::vector<double> at_values{start + 0.003, start - 0.004, start + 0.08};
        if (term.kind == model::LawKind::stop)
            for (const double share : {-0.5, 0.1, 0.5, 0.8}) at_values.push_back(term.reference - share * term.sign * width(model));
        for (const double m : at_values) {
            CAPTURE(k, static_cast<int>(term.kind), m);
            const auto at = [&](double x) { return measure_law(problem, term, x); };
            const double h = 1e-7;
            const LawValue law = at(m);
            if (!std::isfinite(law.value)) continue;
            const double size = std::abs(law.second) + std::abs(law.first) + 1e-12;
            CHECK(std::abs((at(m + h).value - at(m - h).value) / (2 * h) - law.first) < 1e-6 * size);
            CHECK(std::abs((at(m + h).first - at(m - h).first) / (2 * h) - law.second) < 1e-5 * size);
            CHECK(law.majorant >= law.second - 1e-12 * size);
            CHECK(law.majorant >= 0);
        }
    }
}

TEST_CASE("a stop is nothing within its limit and at it, pushes back beyond it, and gives way by less than its width", "[measure_terms]") {
    const model::Model model = loose_bars(scene::Integrator::implicit_euler);
    const StepProblem problem = step_problem(model, start_history(model), model.kappa);
    for (const model::MeasureTerm& term : model.mechanism.terms) {
        if (term.kind != model::LawKind::stop) continue;
        const double inside = term.sign * width(model);
        for (const double within : {0.0, 0.3, 10.0}) {
            const LawValue law = measure_law(problem, term, term.reference + within * inside);
            CHECK(law.value == 0);
            CHECK(law.first == 0);
        }
        const LawValue pressed = measure_law(problem, term, term.reference - 0.7 * inside);
        CHECK(pressed.value > 0);
        CHECK(term.sign * pressed.first < 0);
        CHECK(std::isinf(measure_law(problem, term, term.reference - 1.001 * inside).value));
        CHECK(std::isinf(measure_law(problem, term, term.reference - 100 * inside).value));
    }
}

TEST_CASE("the term's gradient and Hessian agree with differences, its projected Hessian is positive", "[measure_terms]") {
    for (const scene::Integrator integrator :
         {scene::Integrator::implicit_euler, scene::Integrator::bdf2, scene::Integrator::quasi_static}) {
        const model::Model model = loose_bars(integrator);
        const StepProblem problem = step_problem(model, start_history(model), model.kappa);
        const ccd::Candidates none;
        const auto points_at = [&](const VectorX& y) {
            std::vector<kinematics::ChartPoint> out;
            for (int i = 0; i < 2; ++i) out.push_back({problem.poses_t0[i].position + y.segment<3>(6 * i), y.segment<3>(6 * i + 3)});
            return out;
        };
        const auto value = [&](const VectorX& y) {
            const auto points = points_at(y);
            return incremental_potential(problem, points, poses_of(problem, points), {});
        };
        const auto derivatives = [&](const VectorX& y, contact::HessianKind kind) {
            const auto points = points_at(y);
            return chart_derivatives(problem, points, poses_of(problem, points), {}, kind);
        };
        const auto gradient = [&](const VectorX& y) {
            const ChartDerivatives d = derivatives(y, contact::HessianKind::exact);
            VectorX out(12);
            out << d.gradient[0], d.gradient[1];
            return out;
        };
        const auto whole = [&](const VectorX& y, contact::HessianKind kind) {
            const ChartDerivatives d = derivatives(y, kind);
            MatrixX out(12, 12);
            out << d.hessian.diagonal[0], d.hessian.off_diagonal.at(0).block, d.hessian.off_diagonal.at(0).block.transpose(),
                d.hessian.diagonal[1];
            return out;
        };
        VectorX y(12);
        y << 0.01, -0.02, 0.005, 0.1, -0.05, 0.08, -0.01, 0.01, 0.015, -0.06, 0.02, 0.09;
        CAPTURE(static_cast<int>(integrator));
        REQUIRE(std::isfinite(value(y)));
        CHECK(check_gradient(value, y, gradient(y)).relative_error < 1e-7);
        CHECK(check_jacobian(gradient, y, whole(y, contact::HessianKind::exact)).relative_error < 1e-7);
        const MatrixX projected = whole(y, contact::HessianKind::projected);
        CHECK(linear::symmetric_eigenvalues(projected).minCoeff() > -1e-12 * projected.norm());
    }
}

namespace {

// A mass on a spring and a damper along x, 0.1 m beyond the spring's rest and so fast towards it that nothing pulls at first (Newmark's
// first acceleration knows of no springs); where it is after 1 s.
double place_after(scene::Integrator integrator, double h) {
    scene::Scene scene = scene_of({bar("mass", 0.2, Vector3(1.1, 0, 0))}, h);
    scene.integrator = integrator;
    scene.bodies[0].linear_velocity = Vector3(-2.0 / 3, 0, 0);
    for (const int dof : {1, 2, 3, 4, 5}) scene.bodies[0].prescribed[dof] = scene::MotionCurve{};
    scene::Spring spring;
    spring.name = "spring";
    spring.a = {"", Vector3::Zero(), Vector3::UnitZ()};
    spring.b = {"mass", Vector3::Zero(), Vector3::UnitZ()};
    spring.forces.stiffness = 0.08 * 20;
    spring.forces.damping = 0.08 * 3;
    spring.forces.rest = 1;
    scene.mechanism.springs = {spring};
    const model::Model model = built(scene);
    REQUIRE(model.bodies[0].moments(3, 3) == Approx(0.08));
    const auto motion = run(model, static_cast<int>(std::lround(1 / h)), true);
    const model::Body& body = model.bodies[0];
    return motion.trajectory.poses.back()[0].position.x() - body.pose_start.position.x() + 0.1;
}

}  // namespace

TEST_CASE("a damped oscillation tends to its exponential with each integrator's order", "[measure_terms]") {
    // x'' + 3 x' + 20 x = 0, x(0) = 0.1, x'(0) = -2/3.
    const double w = std::sqrt(20 - 2.25), exact = std::exp(-1.5) * (0.1 * std::cos(w) + (0.15 - 2.0 / 3) / w * std::sin(w));
    for (const scene::Integrator integrator : {scene::Integrator::implicit_euler, scene::Integrator::bdf2, scene::Integrator::newmark}) {
        const double coarse = std::abs(place_after(integrator, 0.01) - exact), fine = std::abs(place_after(integrator, 0.005) - exact);
        const double order = std::log2(coarse / fine);
        CAPTURE(static_cast<int>(integrator), coarse, fine, order);
        CHECK(order > (integrator == scene::Integrator::implicit_euler ? 0.9 : 1.8));
        CHECK(fine < (integrator == scene::Integrator::implicit_euler ? 2e-3 : 1e-4));
    }
}

}  // namespace fettle::core::energy::measure_terms_test
