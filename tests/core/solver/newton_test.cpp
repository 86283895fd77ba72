// SPDX-License-Identifier: MIT
// One solve: known answers, the promises of its result, and what it says when it fails. Physics: stepper/*_physics_test.cpp.
#include "core/solver/newton.hpp"

#include <catch2/catch.hpp>
#include <limits>

#include "core/energy/start_history.hpp"
#include "core/setup/build_model.hpp"
#include "core/solver/failure.hpp"
#include "core/solver/newton_direction.hpp"
#include "tests/support/derivative_check.hpp"
#include "tests/support/test_models.hpp"

namespace fettle::core::solver::newton_test {

using namespace fettle::tests::support;
using Catch::Contains;

namespace {

geometry::Mesh cube() { return box_mesh(Vector3::Constant(-0.1), Vector3::Constant(0.1)); }

model::Model world(std::vector<model::Body> bodies) {
    model::Model model;
    model.bodies = std::move(bodies);
    model.gravity = {0, 0, -10};
    model.timestep = 0.01;
    model.velocity_tolerance = 1e-3;
    model.diagonal = 1;
    model.kappa = model::choose_kappa(model);
    return model;
}

// A cube at rest dhat / 2 above the ground.
model::Model resting() { return world({make_body("cube", cube(), make_pose(Vector3::Zero(), {0.03, 0.02, 0.1005})), ground_plate()}); }

// A cube that a kinematic one is to push by `push` against a wall.
model::Model squeezed(double push) {
    model::Body hand = make_body("hand", cube(), make_pose(Vector3::Zero(), {-0.22, 0, 0}), scene::BodyType::kinematic_body);
    prescribe(hand, 0, push / 0.01);
    model::Model model = world({hand, make_body("cube", cube(), make_pose(Vector3::Zero(), Vector3::Zero())),
                                make_body("wall", cube(), make_pose(Vector3::Zero(), {0.22, 0, 0}), scene::BodyType::static_body)});
    model.gravity.setZero();
    return model;
}

std::vector<Vector6> targets_of(const model::Model& model) {
    std::vector<Vector6> targets(model.bodies.size(), Vector6::Zero());
    for (std::size_t i = 0; i < targets.size(); ++i) {
        targets[i].head<3>() = model.bodies[i].pose_start.position;
        for (int k = 0; k < 6; ++k)
            if (const auto& curve = model.bodies[i].prescribed[k]) targets[i][k] += curve->rate * model.timestep;
    }
    return targets;
}

NewtonResult solve(const model::Model& model, NewtonOptions options = {}) {
    if (options.velocity_tolerance == 0) options.velocity_tolerance = model.velocity_tolerance;
    NewtonWorkspace workspace(model);
    energy::StepProblem problem = energy::step_problem(model, energy::start_history(model), model.kappa);
    return minimise(problem, targets_of(model), workspace, options);
}

}  // namespace

TEST_CASE("without contact the solution is P_hat", "[newton]") {
    model::Model model = world({make_body("cube", cube(), make_pose({0.1, 0.2, 0.3}, {0, 0, 5}))});
    set_velocity(model.bodies[0], {1, 2, 3}, Vector3::Zero());
    NewtonOptions options;
    options.to_rounding = true;
    const NewtonResult result = solve(model, options);
    REQUIRE(result.status == NewtonStatus::converged);
    CHECK((result.poses[0].position - Vector3(0.01, 0.02, 5.03 - 1e-3)).norm() < 1e-14);
    CHECK((result.poses[0].rotation - model.bodies[0].pose_start.rotation).norm() < 1e-12);
    CHECK(result.residual < 1e-12);
    CHECK(result.shift == 0);
    CHECK(result.path.size() == static_cast<std::size_t>(result.iterations) + 1);
    CHECK(result.path.front()[0].position == model.bodies[0].pose_start.position);
    CHECK(result.path.back()[0].position == result.poses[0].position);
}

TEST_CASE("a solve to rounding balances the forces", "[newton]") {
    const model::Model model = resting();
    NewtonOptions options;
    options.to_rounding = true;
    const NewtonResult result = solve(model, options);
    REQUIRE(result.status == NewtonStatus::converged);
    CHECK(result.residual <= 1e-8);
    CHECK(result.contacts.count > 0);
    // Its residual is that of the potential's differences.
    const auto problem = energy::step_problem(model, energy::start_history(model), model.kappa);
    const ccd::Candidates candidates = ccd::find_candidates(model, result.poses, model.dhat);
    const auto value = [&](const VectorX& d) {
        auto points = result.path.back();
        points[0].position += d.head<3>();
        points[0].rotation_vector += d.tail<3>();
        const auto poses = poses_of(problem, points);
        return energy::incremental_potential(problem, points, poses, contact::find_contacts(model, candidates, poses));
    };
    const double weight = model.bodies[0].moments(3, 3) * 10 * problem.weight, step = 1e-8;
    for (int k = 0; k < 6; ++k) {
        const VectorX d = step * VectorX::Unit(6, k);
        CHECK(std::abs(value(d) - value(-d)) / (2 * step) < 1e-5 * weight);
    }
}

TEST_CASE("prescribed coordinates are met bit for bit", "[newton]") {
    const model::Model model = squeezed(0.005);
    const NewtonResult result = solve(model);
    INFO(result.message);
    REQUIRE(result.status == NewtonStatus::converged);
    CHECK(result.poses[0].position.x() == targets_of(model)[0][0]);
    CHECK(result.poses[2].position == model.bodies[2].pose_start.position);
}

TEST_CASE("what cannot be followed is told with names and what would do", "[newton]") {
    const model::Model model = squeezed(0.1);  // 6 cm more than there is
    const NewtonResult result = solve(model);
    CHECK(result.status == NewtonStatus::blocked);
    CHECK_THAT(result.message, Contains("body 'hand' cannot follow its script") && Contains("'cube'") && Contains("closest pair") &&
                                   Contains("N/m") && !Contains("N/m^3"));
}

TEST_CASE("a failure tells which contact stiffness would do, in its unit", "[newton]") {
    model::Model model = squeezed(0.1);
    const NewtonResult result = solve(model);
    const std::vector<Vector6> nothing(3, Vector6::Zero());
    const std::string cause = "a reason";
    const auto told = [&] {
        const auto problem = energy::step_problem(model, energy::start_history(model), 7);
        return describe_failure({problem, result.contacts, nothing, {}, 0.5, cause});
    };
    // The cube is as good as at the wall: no more is advised than can be had.
    CHECK_THAT(told(), Contains("a reason") && Contains("try `contact.kappa` at 7e+04 N/m in place of 7 N/m") &&
                           Contains("out of balance by 50% of the forces that act"));
    model.area_weighted = true;
    CHECK_THAT(told(), Contains("at 7e+04 N/m^3 in place of 7 N/m^3"));
}

TEST_CASE("limits and stop signals are obeyed and told", "[newton]") {
    const model::Model model = resting();
    NewtonOptions options;
    options.max_iterations = 0;
    const NewtonResult none = solve(model, options);
    CHECK(none.status == NewtonStatus::not_converged);
    CHECK_THAT(none.message, Contains("not solved within `max_newton_iterations`"));
    CHECK(none.iterations == 0);
    CHECK(none.path.size() == 1);
    options.max_iterations = 100;
    options.should_stop = [] { return true; };
    CHECK(solve(model, options).status == NewtonStatus::interrupted);
}

TEST_CASE("forces that are not finite are told, not followed", "[newton]") {
    for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e308}) {
        model::Model model = resting();
        model.bodies[0].force = {0, 0, bad};
        const NewtonResult result = solve(model);
        INFO(bad);
        CHECK(result.status == NewtonStatus::not_converged);
        CHECK_FALSE(result.message.empty());
        CHECK(result.poses[0].position.allFinite());
    }
}

TEST_CASE("a model without anything to solve for is solved", "[newton]") {
    const model::Model model = world({ground_plate()});
    const NewtonResult result = solve(model);
    CHECK(result.status == NewtonStatus::converged);
    CHECK(result.poses[0].position == model.bodies[0].pose_start.position);
}

TEST_CASE("the direction solves the Newton system and descends", "[newton]") {
    const model::Model model = resting();
    const auto problem = energy::step_problem(model, energy::start_history(model), model.kappa);
    NewtonWorkspace workspace(model);
    Iterate at;
    for (const auto& pose : problem.poses_t0) at.points.push_back({pose.position, Vector3(Vector3::Zero())});
    at.poses = problem.poses_t0;
    at.contacts = contact::find_contacts(model, ccd::find_candidates(model, at.poses, model.dhat), at.poses);
    REQUIRE(at.contacts.count > 0);
    const auto direction = newton_direction(problem, at, targets_of(model), {contact::HessianKind::projected, {}}, 1, workspace);
    REQUIRE(direction);
    const auto d = energy::chart_derivatives(problem, at.points, at.poses, at.contacts, contact::HessianKind::projected);
    CHECK((d.hessian.diagonal[0] * direction->step[0] + d.gradient[0]).norm() < 1e-9 * d.gradient[0].norm());
    CHECK(direction->step[1] == Vector6::Zero());
    CHECK(direction->slope < 0);
    CHECK(direction->slope == Approx(d.gradient[0].dot(direction->step[0])));
    CHECK(direction->residual == residual_at(problem, at, workspace));
}

}  // namespace fettle::core::solver::newton_test
