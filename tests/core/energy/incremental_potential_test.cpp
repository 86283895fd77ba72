// SPDX-License-Identifier: MIT
// Gradient and Hessian of a whole step's potential in chart coordinates, away from the chart's origin, against central differences.
#include "core/energy/incremental_potential.hpp"
#include "core/linear/factorisations.hpp"

#include <catch2/catch.hpp>

#include "tests/support/test_models.hpp"

namespace fettle::core::energy::incremental_potential_test {

using namespace fettle::tests::support;

namespace {

struct Setup {
    model::Model model;
    StepProblem problem;
    std::vector<kinematics::ChartPoint> points;
};

// Two boxes corner against face, off-centre so that first moments do not vanish.
Setup setup() {
    Setup s;
    s.model.bodies = {
        make_body("a", box_mesh(Vector3(-0.2, -0.1, -0.1), Vector3(0.3, 0.2, 0.1)),
                  make_pose(Vector3(0.6, 0.5, 0.2), Vector3(0, 0.02, 0.33))),
        make_body("b", box_mesh(Vector3(-0.3, -0.3, -0.1), Vector3(0.2, 0.3, 0.15)), make_pose(Vector3(0, 0, 0.1), Vector3(0.02, 0, 0)))};
    s.model.gravity = Vector3(0.3, 0, -9.81);
    s.model.timestep = 0.02;
    s.model.dhat = 0.2;
    s.model.kappa = 2e4;
    s.model.bodies[0].force = Vector3(3, -2, 5);
    s.model.bodies[1].torque = Vector3(1, 4, -2);
    std::vector<Matrix34> velocities;
    std::vector<kinematics::Pose> poses;
    for (model::Body& body : s.model.bodies) {
        set_velocity(body, Vector3(0.3, 0.2, -1), Vector3(0.5, -2, 1));
        velocities.push_back(body.velocity_start);
        poses.push_back(body.pose_start);
    }
    s.problem = implicit_euler_problem(s.model, poses, velocities);
    s.points = {{poses[0].position + Vector3(0.01, 0, 0.01), Vector3(0.2, -0.1, 0.3)},
                {poses[1].position - Vector3(0, 0.02, 0), Vector3(-0.1, 0.2, 0.4)}};
    return s;
}

ccd::Candidates all_candidates(const Setup& s, const std::vector<kinematics::Pose>& poses) {
    return ccd::find_candidates(s.model, poses, 0.3);
}

std::vector<kinematics::ChartPoint> moved(std::vector<kinematics::ChartPoint> points, int dof, double h) {
    kinematics::ChartPoint& p = points[dof / 6];
    if (dof % 6 < 3)
        p.position[dof % 6] += h;
    else
        p.rotation_vector[dof % 6 - 3] += h;
    return points;
}

}  // namespace

TEST_CASE("gradient and Hessian of the incremental potential agree with differences", "[incremental_potential]") {
    const Setup s = setup();
    const auto poses = poses_of(s.problem, s.points);
    const ccd::Candidates candidates = all_candidates(s, poses);
    const auto derivatives_at = [&](const std::vector<kinematics::ChartPoint>& points, contact::HessianKind kind) {
        const auto at = poses_of(s.problem, points);
        return chart_derivatives(s.problem, points, at, contact::find_contacts(s.model, candidates, at), kind);
    };
    const auto value_at = [&](const std::vector<kinematics::ChartPoint>& points) {
        const auto at = poses_of(s.problem, points);
        return incremental_potential(s.problem, points, at, contact::find_contacts(s.model, candidates, at));
    };
    const contact::ContactSet contacts = contact::find_contacts(s.model, candidates, poses);
    REQUIRE(contacts.count > 5);
    const ChartDerivatives d = derivatives_at(s.points, contact::HessianKind::exact);
    Eigen::Matrix<double, 12, 12> hessian, difference_hessian;
    hessian << d.hessian.diagonal[0], d.hessian.off_diagonal.at(0).block, d.hessian.off_diagonal.at(0).block.transpose(),
        d.hessian.diagonal[1];
    Vector12 gradient, difference;
    gradient << d.gradient[0], d.gradient[1];
    const double h = 1e-6;
    for (int k = 0; k < 12; ++k) {
        const auto plus = moved(s.points, k, h), minus = moved(s.points, k, -h);
        difference[k] = (value_at(plus) - value_at(minus)) / (2 * h);
        const auto gp = derivatives_at(plus, contact::HessianKind::exact).gradient,
                   gm = derivatives_at(minus, contact::HessianKind::exact).gradient;
        difference_hessian.col(k) << (gp[0] - gm[0]) / (2 * h), (gp[1] - gm[1]) / (2 * h);
    }
    CHECK((gradient - difference).norm() < 1e-8 * gradient.norm());
    CHECK((hessian - difference_hessian).norm() < 1e-7 * hessian.norm());

    const ChartDerivatives projected = derivatives_at(s.points, contact::HessianKind::projected);
    Eigen::Matrix<double, 12, 12> p;
    p << projected.hessian.diagonal[0], projected.hessian.off_diagonal.at(0).block, projected.hessian.off_diagonal.at(0).block.transpose(),
        projected.hessian.diagonal[1];
    CHECK(linear::symmetric_eigenvalues(p).minCoeff() >= -1e-12 * p.norm());
}

TEST_CASE("the potential does not depend on where the candidates were found", "[incremental_potential]") {
    const Setup s = setup();
    const auto poses = poses_of(s.problem, s.points);
    const auto potential = [&](const ccd::Candidates& candidates) {
        return incremental_potential(s.problem, s.points, poses, contact::find_contacts(s.model, candidates, poses));
    };
    CHECK(potential(all_candidates(s, poses)) ==
          potential(ccd::find_candidates(s.model, s.problem.poses_t0, 3)));  // to the last bit: sums are ordered by primitives
}

}  // namespace fettle::core::energy::incremental_potential_test
