// SPDX-License-Identifier: MIT
#include "core/contact/contact_damping.hpp"

#include <catch2/catch.hpp>

#include "core/base/parallel.hpp"
#include "core/energy/incremental_potential.hpp"
#include "core/energy/start_history.hpp"
#include "core/linear/factorisations.hpp"
#include "tests/support/derivative_check.hpp"
#include "tests/support/test_models.hpp"

namespace fettle::core::contact::contact_damping_test {

using namespace fettle::tests::support;
using scene::Integrator;

namespace {

struct Setup {
    model::Model model;
    energy::StepProblem problem;
    VectorX y;  // (q, theta) of both bodies at the step's end, away from its start
};

// Two boxes corner against face, off-centre; @param parallel  instead, edge along edge, so that pairs are mollified.
Setup setup(Integrator integrator, bool parallel) {
    Setup s;
    const Vector3 turn = parallel ? Vector3(0.012, 0.008, 0.015) : Vector3(0.6, 0.5, 0.2);
    s.model.bodies = {
        make_body("a", box_mesh(Vector3(-0.2, -0.1, -0.1), Vector3(0.3, 0.2, 0.1)),
                  make_pose(turn, Vector3(0, 0.02, parallel ? 0.48 : 0.33))),
        make_body("b", box_mesh(Vector3(-0.3, -0.3, -0.1), Vector3(0.2, 0.3, 0.15)), make_pose(Vector3(0, 0, 0.1), Vector3(0.02, 0, 0)))};
    if (parallel) s.model.bodies[1].pose_start = make_pose(Vector3(0, 0, 0.01), Vector3(0.02, 0.02, 0.1));
    s.model.timestep = 0.02;
    s.model.dhat = 0.2;
    s.model.kappa = 2e4;
    s.model.integrator = integrator;
    s.model.contact_damping_time = 0.03;
    set_velocity(s.model.bodies[0], Vector3(0.3, 0.2, -1), Vector3(0.5, -2, 1));
    set_velocity(s.model.bodies[1], Vector3(-0.1, 0.2, 0.3), Vector3(0.2, 1, -1));
    s.problem = energy::step_problem(s.model, energy::start_history(s.model), s.model.kappa);
    s.y.resize(12);
    const double tilt = parallel ? 0.02 : 1;
    s.y << s.problem.poses_t0[0].position + Vector3(0.01, 0, 0.01), tilt * Vector3(0.2, -0.1, 0.3),
        s.problem.poses_t0[1].position - Vector3(0, 0.02, 0), tilt * Vector3(-0.1, 0.2, 0.4);
    return s;
}

std::vector<kinematics::Pose> poses_at(const Setup& s, const VectorX& y) {
    return poses_of(s.problem, {{y.head<3>(), y.segment<3>(3)}, {y.segment<3>(6), y.tail<3>()}});
}

ContactSet contacts_at(const Setup& s, const std::vector<kinematics::Pose>& poses) {
    return find_contacts(s.model, ccd::find_candidates(s.model, poses, 0.3), poses);
}

double value(const Setup& s, const VectorX& y) {
    return contact_damping_potential({s.model, contacts_at(s, poses_at(s, y)), s.problem.contact_damping});
}

// In the chart, the curvature of the rotations included.
struct Derivatives {
    VectorX gradient;
    MatrixX hessian;
};
Derivatives derivatives(const Setup& s, const VectorX& y, HessianKind kind = HessianKind::exact) {
    const std::vector<kinematics::Pose> poses = poses_at(s, y);
    std::vector<kinematics::PoseGradient> gradients(2);
    kinematics::BlockHessian blocks;
    blocks.diagonal.assign(2, Matrix6::Zero());
    add_contact_damping_derivatives({s.model, contacts_at(s, poses), s.problem.contact_damping}, poses, kind, gradients, blocks);
    Derivatives out{VectorX(12), MatrixX(12, 12)};
    out.hessian << blocks.diagonal[0], blocks.off_diagonal.at(0).block, blocks.off_diagonal.at(0).block.transpose(), blocks.diagonal[1];
    MatrixX to_tangent = MatrixX::Identity(12, 12);
    for (int i = 0; i < 2; ++i) to_tangent.block<3, 3>(6 * i + 3, 6 * i + 3) = kinematics::left_jacobian(y.segment<3>(6 * i + 3));
    out.gradient << tangent_gradient(gradients[0]), tangent_gradient(gradients[1]);
    out.gradient = to_tangent.transpose() * out.gradient;
    out.hessian = to_tangent.transpose() * out.hessian * to_tangent;
    for (int i = 0; i < 2 && kind == HessianKind::exact; ++i)
        out.hessian.block<3, 3>(6 * i + 3, 6 * i + 3) += kinematics::chart_curvature(gradients[i].arm, y.segment<3>(6 * i + 3));
    return out;
}

int mollified(const ContactSet& contacts) {
    int count = 0;
    for (const BodyPairContacts& list : contacts.pairs)
        for (const ContactPair& pair : list.contacts)
            count += pair.type == geometry::PairType::edge_edge && edge_cross_squared(pair.x) < pair.mollifier_eps;
    return count;
}

// A box flat over the middle of a triangle, kappa and dhat 1; it was `before` away and is `now`.
Setup dropping(double now, double before) {
    Setup s;
    s.model.bodies = {make_body("tip", box_mesh(Vector3(0, 0, 0), Vector3(1, 1, 1)), make_pose(Vector3::Zero(), Vector3(6, 0, before))),
                      make_body("plate", box_mesh(Vector3(-9, -9, -1), Vector3(9, 9, 0)), {}, scene::BodyType::static_body)};
    s.model.dhat = 1;
    s.model.kappa = 1;
    s.model.timestep = 0.5;
    s.model.contact_damping_time = 0.25;
    s.problem = energy::step_problem(s.model, energy::start_history(s.model), 1);
    s.y = VectorX::Zero(12);
    s.y.head<3>() = Vector3(6, 0, now);
    return s;
}

}  // namespace

TEST_CASE("contact damping's derivatives agree with differences, for every integrator", "[contact_damping]") {
    for (const Integrator integrator : {Integrator::implicit_euler, Integrator::bdf2, Integrator::newmark})
        for (const bool parallel : {false, true}) {
            const Setup s = setup(integrator, parallel);
            CAPTURE(static_cast<int>(integrator), parallel);
            const ContactSet contacts = contacts_at(s, poses_at(s, s.y));
            REQUIRE(contacts.count > 10);
            REQUIRE((mollified(contacts) > 0) == parallel);
            const Derivatives d = derivatives(s, s.y);
            REQUIRE(d.gradient.norm() > 0);
            const StepSweep sweep{1e-4, 0.25, 10};
            CHECK(check_gradient([&](const VectorX& y) { return value(s, y); }, s.y, d.gradient, sweep).relative_error < 1e-7);
            const auto gradient = [&](const VectorX& y) { return derivatives(s, y).gradient; };
            CHECK(check_jacobian(gradient, s.y, d.hessian, sweep).relative_error < 1e-6);
            const VectorX projected = linear::symmetric_eigenvalues<Eigen::Dynamic>(derivatives(s, s.y, HessianKind::projected).hessian);
            CHECK(projected.minCoeff() >= -1e-12 * projected.maxCoeff());
        }
}

TEST_CASE("contact damping is projected when it opens, and then the true one is not definite", "[contact_damping]") {
    Setup s = setup(Integrator::implicit_euler, false);
    const Vector3 apart(0, 0, 0.03);
    s.y.head<3>() += apart;
    const auto least = [&](HessianKind kind) {
        return linear::symmetric_eigenvalues<Eigen::Dynamic>(derivatives(s, s.y, kind).hessian).minCoeff();
    };
    const double size = derivatives(s, s.y).hessian.norm();
    CHECK(least(HessianKind::exact) < -1e-3 * size);
    CHECK(least(HessianKind::projected) >= -1e-12 * size);
}

TEST_CASE("contact damping is as strong as its header says", "[contact_damping]") {
    const double h = 1e-5, T = 0.25;
    // All contacts of a box that lies flat have the same gap: their number n cancels against the barrier's.
    const auto barrier_force = [](const Setup& s) {
        double sum = 0;
        for (const BodyPairContacts& list : contacts_at(s, poses_at(s, s.y)).pairs)
            for (const ContactPair& pair : list.contacts) sum += normal_force(pair, s.problem.barrier);
        return sum;
    };
    const auto stiffness = [&](double d) { return (barrier_force(dropping(d - h, d)) - barrier_force(dropping(d + h, d))) / (2 * h); };
    // Per speed: (x - x_t0)/h of it, times the weight.
    const auto damping = [&](double d) {
        return -derivatives(dropping(d - h, d), dropping(d - h, d).y).gradient[2] / h * dropping(d, d).model.timestep;
    };
    CHECK(damping(0.5) / stiffness(0.5) == Approx(1.24 * T).epsilon(3e-3));
    CHECK(damping(0.01) / stiffness(0.01) == Approx(2 * T).epsilon(2e-2));
    CHECK(damping(0.99) / stiffness(0.99) < 1e-3 * T);
    // Critical: c = 2 sqrt(k m), for m = 1 against n contacts.
    const Setup s = dropping(0.5, 0.5);
    const int n = contacts_at(s, poses_at(s, s.y)).count;
    REQUIRE(n > 0);
    const double per_contact = stiffness(0.5) / n / s.problem.weight, c = damping(0.5) / n / s.problem.weight;
    CHECK(per_contact == Approx(3.78).epsilon(2e-3));
    CHECK(c == Approx(4.69 * T).epsilon(2e-3));
    CHECK(c * (0.83 * std::sqrt(1.0)) / T == Approx(2 * std::sqrt(per_contact)).epsilon(5e-3));
}

TEST_CASE("contact damping: nothing beyond dhat, C2 there, and 0 where nothing has moved", "[contact_damping]") {
    for (const double before : {0.4, 1.2}) {
        const Setup beyond = dropping(1.001, before);
        CHECK(value(beyond, beyond.y) == 0);
        const double scale = beyond.problem.contact_damping.factor;
        const double e = 1e-3;
        const Setup near = dropping(1 - e, before);
        const Derivatives d = derivatives(near, near.y);
        CHECK(std::abs(value(near, near.y)) < 100 * scale * e * e * e);
        CHECK(std::abs(d.gradient[2]) < 200 * scale * e * e);
        CHECK(std::abs(d.hessian(2, 2)) < 400 * scale * e);
    }
    const Setup still = dropping(0.4, 0.4);
    CHECK(derivatives(still, still.y).gradient.norm() < 1e-14 * still.problem.contact_damping.factor);
    const Setup touching = dropping(0, 0.4);
    CHECK(std::isinf(value(touching, touching.y)));
}

TEST_CASE("contact damping follows kappa, the damping time and the areas in proportion", "[contact_damping]") {
    Setup s = setup(Integrator::implicit_euler, false);
    const double once = value(s, s.y);
    energy::set_kappa(s.problem, 3 * s.model.kappa);
    CHECK(value(s, s.y) == Approx(3 * once).epsilon(1e-13));
    s.model.contact_damping_time *= 2;
    energy::set_kappa(s.problem, s.model.kappa);
    CHECK(value(s, s.y) == Approx(2 * once).epsilon(1e-13));
    Setup weighted = setup(Integrator::implicit_euler, false);
    weighted.model.area_weighted = true;
    const double areas = value(weighted, weighted.y);
    for (model::Body& body : weighted.model.bodies) {
        for (double& area : body.vertex_area) area *= 5;
        for (double& area : body.edge_area) area *= 5;
    }
    CHECK(value(weighted, weighted.y) == Approx(5 * areas).epsilon(1e-13));
    const VectorX gradient = derivatives(weighted, weighted.y).gradient;
    CHECK(check_gradient([&](const VectorX& y) { return value(weighted, y); }, weighted.y, gradient, {1e-4, 0.25, 10}).relative_error <
          1e-7);
}

TEST_CASE("a quasi-static step has no contact damping, and threads change no bit of it", "[contact_damping]") {
    Setup s = setup(Integrator::implicit_euler, false);
    s.model.integrator = Integrator::quasi_static;
    s.model.proximal_weight = 0.3;
    CHECK(energy::step_problem(s.model, energy::start_history(s.model), s.model.kappa).contact_damping.factor == 0);
    const Setup dynamic = setup(Integrator::implicit_euler, false);
    const double here = value(dynamic, dynamic.y);
    const VectorX gradient = derivatives(dynamic, dynamic.y).gradient;
    const base::ThreadLimit one(1);
    CHECK(value(dynamic, dynamic.y) == here);
    CHECK(derivatives(dynamic, dynamic.y).gradient == gradient);
}

}  // namespace fettle::core::contact::contact_damping_test
