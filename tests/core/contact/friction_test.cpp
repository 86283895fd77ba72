// SPDX-License-Identifier: MIT
// Friction: the mollifier against its formula and its limits, the potential's derivatives against differences, and the force against
// Coulomb's law for a contact that slides and for one that sticks.
#include "core/contact/friction.hpp"
#include "core/linear/factorisations.hpp"

#include <catch2/catch.hpp>

#include "core/energy/incremental_potential.hpp"
#include "tests/support/derivative_check.hpp"
#include "tests/support/test_models.hpp"

namespace fettle::core::contact::friction_test {

using namespace fettle::tests::support;
using kinematics::Pose;

namespace {

// A tilted box, corner and edges near a plate's face, both displaced against the slip reference.
struct Scene {
    model::Model model;
    std::vector<Pose> lagged_at, poses;
    FrictionSet friction;
};

Scene make_scene(double slid) {
    Scene s;
    s.model.bodies = {make_body("box", box_mesh(Vector3(-0.2, -0.1, -0.1), Vector3(0.3, 0.2, 0.1)),
                                make_pose(Vector3(0.6, 0.5, 0.2), Vector3(0, 0.02, 0.33))),
                      make_body("plate", box_mesh(Vector3(-0.3, -0.3, -0.1), Vector3(0.2, 0.3, 0.15)),
                                make_pose(Vector3(0, 0, 0.1), Vector3(0.02, 0, 0)))};
    s.model.dhat = 0.2;
    s.model.friction.mu = MatrixX::Constant(1, 1, 0.4);
    s.model.friction.eps_v = 0.01;
    for (const model::Body& body : s.model.bodies) s.lagged_at.push_back(body.pose_start);
    const ccd::Candidates candidates = ccd::find_candidates(s.model, s.lagged_at, 0.3);
    const ContactSet contacts = find_contacts(s.model, candidates, s.lagged_at);
    REQUIRE(contacts.count > 10);
    std::vector<Matrix34> reference;
    for (const Pose& pose : s.lagged_at) reference.push_back(pose_matrix(pose));
    s.friction = lag_friction(s.model, contacts, s.lagged_at, barrier_parameters(0.2, 0, 2e4, 4e-4), reference, 0.02);
    s.poses = s.lagged_at;
    s.poses[0].position += slid * Vector3(1, 0.7, 0.2);
    s.poses[0].rotation = kinematics::rotation(slid * Vector3(0.5, -1, 2)) * s.poses[0].rotation;
    s.poses[1].position -= slid * Vector3(0.2, -0.3, 0.1);
    return s;
}

std::vector<Pose> moved(std::vector<Pose> poses, const VectorX& d) {
    for (int i = 0; i < 2; ++i) {
        poses[i].position += d.segment<3>(6 * i);
        poses[i].rotation = kinematics::rotation(d.segment<3>(6 * i + 3)) * poses[i].rotation;
    }
    return poses;
}

struct Derivatives {
    VectorX gradient = VectorX(12);
    MatrixX gauss_newton = MatrixX(12, 12), hessian;
};

Derivatives derivatives_at(const Scene& s, const std::vector<Pose>& poses, HessianKind kind = HessianKind::exact) {
    std::vector<kinematics::PoseGradient> gradients(2);
    kinematics::BlockHessian blocks;
    blocks.diagonal.assign(2, Matrix6::Zero());
    add_friction_derivatives(s.friction, poses, kind, gradients, blocks);
    Derivatives d;
    d.gradient << tangent_gradient(gradients[0]), tangent_gradient(gradients[1]);
    REQUIRE(blocks.off_diagonal.size() == 1);
    d.gauss_newton << blocks.diagonal[0], blocks.off_diagonal[0].block, blocks.off_diagonal[0].block.transpose(), blocks.diagonal[1];
    d.hessian = d.gauss_newton;
    for (int i = 0; i < 2; ++i) d.hessian.block<3, 3>(6 * i + 3, 6 * i + 3) += kinematics::tangent_curvature(gradients[i].arm);
    return d;
}

}  // namespace

TEST_CASE("the friction mollifier is f0 and its derivatives", "[friction]") {
    const double e = 0.3;
    for (const double y : {0.01, 0.1, 0.299, 0.301, 2.0}) {
        const FrictionMollifier f = friction_mollifier(y, e);
        const double expected = y < e ? -y * y * y / (3 * e * e) + y * y / e + e / 3 : y;
        CHECK(f.value == Approx(expected).epsilon(1e-14));
        const double h = 1e-5 * y;
        const double first = (friction_mollifier(y + h, e).value - friction_mollifier(y - h, e).value) / (2 * h);
        const auto slope = [&](double x) { return x * friction_mollifier(x, e).first_by_y; };
        CHECK(y * f.first_by_y == Approx(first).epsilon(1e-5).margin(1e-9));
        CHECK(f.second == Approx((slope(y + h) - slope(y - h)) / (2 * h)).epsilon(1e-6).margin(1e-9));
    }
    CHECK(friction_mollifier(0, e).first_by_y == Approx(2 / e));
    CHECK(friction_mollifier(e, e).value == Approx(e));  // C1 at the bound
    CHECK(e * friction_mollifier(e * (1 - 1e-12), e).first_by_y == Approx(1));
}

TEST_CASE("friction's gradient and Hessian agree with differences", "[friction]") {
    for (const double slid : {0.0, 5e-5, 3e-2}) {  // at rest, sticking (e = 2e-4), sliding
        INFO("slid " << slid);
        const Scene s = make_scene(slid);
        const Derivatives d = derivatives_at(s, s.poses);
        const VectorX zero = VectorX::Zero(12);
        const StepSweep sweep{1e-5, 0.25, 8};
        const auto potential = [&](const VectorX& x) { return friction_potential(s.friction, moved(s.poses, x)); };
        if (slid > 0) CHECK(check_gradient(potential, zero, d.gradient, sweep).relative_error < 1e-6);
        double load = 0;
        for (const BodyPairFriction& pair : s.friction.pairs)
            for (const FrictionContact& c : pair.contacts) load += c.load;
        if (slid == 0) CHECK(d.gradient.norm() < 1e-11 * load);
        if (slid > 0) CHECK(d.gradient.norm() > 1e-2 * load);
        // The symmetric part: the gradient in tangent coordinates is not a gradient field on the rotations.
        const double h = slid > 1e-3 ? 1e-5 : 1e-8;
        MatrixX difference(12, 12);
        for (int k = 0; k < 12; ++k)
            for (int l = 0; l < 12; ++l) {
                const VectorX ek = h * VectorX::Unit(12, k), el = h * VectorX::Unit(12, l);
                const auto along = [&](const VectorX& x) { return derivatives_at(s, moved(s.poses, x)).gradient[k]; };
                difference(k, l) = (along(el) - along(-el)) / (2 * h);
            }
        const MatrixX symmetric = 0.5 * (difference + difference.transpose());
        CHECK((symmetric - d.hessian).norm() < 2e-4 * d.hessian.norm());
        const MatrixX majoriser = derivatives_at(s, s.poses, HessianKind::projected).gauss_newton - d.gauss_newton;
        CHECK(linear::symmetric_eigenvalues(majoriser).minCoeff() >= -1e-12 * d.gauss_newton.norm());
        CHECK((slid > 0) == (majoriser.norm() > 1e-6 * d.gauss_newton.norm()));  // stiffer only where something slides
        const double least = linear::symmetric_eigenvalues(d.gauss_newton).minCoeff();
        CHECK(least >= -1e-12 * d.gauss_newton.norm());
    }
}

TEST_CASE("friction's force is mu times the normal force against the sliding, less when sticking", "[friction]") {
    for (const double slid : {1e-6, 3e-2}) {
        const Scene s = make_scene(slid);
        for (const BodyPairFriction& pair : s.friction.pairs)
            for (const FrictionContact& c : pair.contacts) {
                const Vector3 force = friction_force(s.friction, pair, c, s.poses);
                const auto at = [&](int body, const Vector3& X) { return world_position(s.poses[body], X); };
                const Vector3 slide = at(pair.first, c.point_first) - at(pair.second, c.point_second) - c.separation_reference;
                const Vector3 normal = c.tangent_1.cross(c.tangent_2);
                CHECK(std::abs(force.dot(normal)) <= 1e-12 * force.norm());
                CHECK(force.dot(slide) < 0);
                if (slid > 1e-3) CHECK(force.norm() == Approx(c.load).epsilon(1e-12));
                if (slid < 1e-3) CHECK(force.norm() < 0.1 * c.load);
            }
    }
}

TEST_CASE("the share of the load that slides is that of the contacts beyond the slip bound", "[friction]") {
    CHECK(sliding_share(FrictionSet{}, {}) == 0);
    CHECK(sliding_share(make_scene(1e-6).friction, make_scene(1e-6).poses) == 0);
    CHECK(sliding_share(make_scene(3e-2).friction, make_scene(3e-2).poses) == 1);
    Scene s = make_scene(3e-2);  // one contact goes with what it touches
    FrictionContact& sticks = s.friction.pairs.front().contacts.front();
    sticks.separation_reference = world_position(s.poses[s.friction.pairs.front().first], sticks.point_first) -
                                  world_position(s.poses[s.friction.pairs.front().second], sticks.point_second);
    double all = 0;
    for (const BodyPairFriction& pair : s.friction.pairs)
        for (const FrictionContact& c : pair.contacts) all += c.load;
    CHECK(sliding_share(s.friction, s.poses) == Approx(1 - sticks.load / all).epsilon(1e-12));
}

TEST_CASE("pairs without friction are left out", "[friction]") {
    Scene s = make_scene(0);
    s.model.friction.mu(0, 0) = 0;
    const ccd::Candidates candidates = ccd::find_candidates(s.model, s.lagged_at, 0.3);
    const ContactSet contacts = find_contacts(s.model, candidates, s.lagged_at);
    std::vector<Matrix34> reference(2, Matrix34::Zero());
    CHECK(lag_friction(s.model, contacts, s.lagged_at, barrier_parameters(0.2, 0, 2e4, 4e-4), reference, 0.02).pairs.empty());
}

}  // namespace fettle::core::contact::friction_test
