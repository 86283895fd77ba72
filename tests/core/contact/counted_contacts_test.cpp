// SPDX-License-Identifier: MIT
// A plane face is one contact however it is cut: against the distance to the polygon, differences, and other ways to cut it.
#include "core/contact/counted_contacts.hpp"
#include "core/linear/factorisations.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "core/contact/contact_set.hpp"
#include "core/model/choose_kappa.hpp"
#include "core/stepper/simulate.hpp"
#include "tests/support/test_models.hpp"

namespace fettle::core::contact::counted_contacts_test {

using kinematics::Pose;
using namespace fettle::tests::support;

namespace {

using Corners = std::vector<std::array<double, 2>>;

geometry::Mesh sheet(const Corners& corners, const std::vector<geometry::Triangle>& triangles) {
    Matrix3X x = Matrix3X::Zero(3, corners.size());
    for (std::size_t k = 0; k < corners.size(); ++k) x.col(k).head<2>() << corners[k][0], corners[k][1];
    return geometry::make_mesh("sheet", x, triangles);
}

// The unit square in n x n cells, every other diagonal the other way.
geometry::Mesh square(int n) {
    Corners corners;
    for (int i = 0; i <= n; ++i)
        for (int j = 0; j <= n; ++j) corners.push_back({double(i) / n, double(j) / n});
    std::vector<geometry::Triangle> triangles;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            const int a = i * (n + 1) + j, b = a + n + 1;
            if ((i + j) % 2 == 0) {
                triangles.push_back({a, b, b + 1});
                triangles.push_back({a, b + 1, a + 1});
            } else {
                triangles.push_back({a, b, a + 1});
                triangles.push_back({b, b + 1, a + 1});
            }
        }
    return sheet(corners, triangles);
}

geometry::Mesh fan() { return sheet({{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0.3, 0.6}}, {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}}); }

// A square with a notch of a quarter, cut so that three triangles meet in the inner corner.
geometry::Mesh notched() {
    return sheet({{0, 0}, {1, 0}, {1, 0.5}, {0.5, 0.5}, {0.5, 1}, {0, 1}}, {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}});
}

geometry::Mesh point() {
    geometry::Mesh mesh;
    mesh.name = "point";
    mesh.vertices = Matrix3X::Zero(3, 1);
    geometry::build_connectivity(mesh);
    return mesh;
}

model::Model over(const geometry::Mesh& mesh) {
    model::Model model;
    model.dhat = 0.2;
    model.bodies = {make_body("sheet", mesh, make_pose(Vector3(0.3, -0.2, 0.5), Vector3(2, -1, 3)), scene::BodyType::static_body),
                    make_body("point", point(), {})};
    return model;
}

struct Measured {
    double potential = 0;
    Vector3 force = Vector3::Zero();  // dE/dx of the point
    int count = 0;
};

// @param x  of the point, in the sheet's frame
Measured measure(const model::Model& model, const Vector3& x) {
    const Pose& sheet = model.bodies[0].pose_start;
    const std::vector<Pose> poses{sheet, {Matrix3::Identity(), world_position(sheet, x)}};
    const BarrierParameters barrier = barrier_parameters(model.dhat, 0, 3, 1);
    const ContactSet set = find_contacts(model, ccd::find_candidates(model, poses, 0), poses);
    Measured out;
    out.potential = barrier_potential(set, barrier);
    out.count = set.count;
    for (const BodyPairContacts& list : set.pairs)
        for (const ContactPair& pair : list.contacts)
            for (int i = 0; i < 4; ++i)
                if ((i < geometry::first_count(pair.type) ? list.first : list.second) == 1)
                    out.force += sheet.rotation.transpose() * pair_forces(pair, barrier)[i];
    return out;
}

Vector3 random_point(std::mt19937& random) {
    std::uniform_real_distribution<double> along(-0.15, 1.15), height(0.01, 0.19);
    const double u = along(random), v = along(random), h = height(random);
    return {u, v, h};
}

}  // namespace

TEST_CASE("a square face counts once, however it is cut", "[counted_contacts]") {
    const std::vector<model::Model> cuts{over(square(1)), over(square(2)), over(square(7)), over(fan())};
    std::mt19937 random(5);
    for (int k = 0; k < 2000; ++k) {
        Vector3 x = random_point(random);
        if (k % 5 == 0) x.y() = x.x();  // over the diagonal
        if (k % 7 == 0) x.x() = 0.5;    // over an edge, or a vertex
        const Vector3 nearest(std::clamp(x.x(), 0.0, 1.0), std::clamp(x.y(), 0.0, 1.0), 0);
        const double distance = (x - nearest).norm();
        const ScalarDerivatives b = barrier(std::min(distance * distance, 0.04), 0.04);
        const double factor = 3 / (4 * 0.04);
        for (const model::Model& model : cuts) {
            const Measured m = measure(model, x);
            CAPTURE(k, x.transpose(), model.bodies[0].mesh.triangles.size());
            CHECK(m.potential == Approx(factor * b.value).epsilon(1e-10).margin(1e-18));
            CHECK((m.force - 2 * factor * b.first * (x - nearest)).norm() <= 1e-10 * factor * std::abs(b.first) * distance + 1e-18);
            if (x.x() > 0.2 && x.x() < 0.8 && x.y() > 0.2 && x.y() < 0.8) CHECK(m.count == 1);
        }
    }
}

TEST_CASE("round a notch the potential is smooth, and never less than that of the nearest place", "[counted_contacts]") {
    const model::Model model = over(notched());
    std::mt19937 random(6);
    int negative = 0;
    for (int k = 0; k < 3000; ++k) {
        const Vector3 x = random_point(random);
        const Measured m = measure(model, x);
        Vector3 difference;
        const double h = 1e-6;
        for (int i = 0; i < 3; ++i)
            difference[i] =
                (measure(model, x + h * Vector3::Unit(i)).potential - measure(model, x - h * Vector3::Unit(i)).potential) / (2 * h);
        CAPTURE(k, x.transpose());
        CHECK((difference - m.force).norm() <= 1e-6 * (m.force.norm() + 1e-3));
        if (m.count == 3) ++negative;  // both sides of the notch, less its corner
        const bool inside = x.x() >= 0 && x.y() >= 0 && x.x() <= 1 && x.y() <= 1 && !(x.x() > 0.5 && x.y() > 0.5);
        const double above = 3 / (4 * 0.04) * barrier(std::min(x.z() * x.z(), 0.04), 0.04).value;
        if (inside) CHECK(m.potential >= above * (1 - 1e-10));
    }
    CHECK(negative > 20);
}

TEST_CASE("the projected Hessian stays semi-definite where a corner counts against", "[counted_contacts]") {
    const model::Model model = over(notched());
    const Pose& sheet = model.bodies[0].pose_start;
    const BarrierParameters parameters = barrier_parameters(model.dhat, 0, 3, 1);
    const std::vector<Pose> poses{sheet, {Matrix3::Identity(), world_position(sheet, Vector3(0.56, 0.57, 0.05))}};
    const ContactSet set = find_contacts(model, ccd::find_candidates(model, poses, 0), poses);
    int against = 0;
    for (const BodyPairContacts& list : set.pairs)
        for (const ContactPair& pair : list.contacts) {
            BodyPairSum projected, exact;
            add_pair_derivatives(pair, parameters, HessianKind::projected, poses[list.first].position, poses[list.second].position,
                                 projected);
            add_pair_derivatives(pair, parameters, HessianKind::exact, poses[list.first].position, poses[list.second].position, exact);
            const Matrix12 above = in_both_bodies(projected.hessian), gap = above - in_both_bodies(exact.hessian);
            const double size = above.norm();
            CHECK(linear::symmetric_eigenvalues<12>(above)[0] >= -1e-12 * size);
            CHECK(linear::symmetric_eigenvalues<12>(gap)[0] >= -1e-10 * size);
            against += pair.weight < 0;
        }
    CHECK(against == 1);
}

TEST_CASE("contacts with the same closest features are one, of the same potential and derivatives", "[counted_contacts]") {
    const geometry::Mesh box = box_mesh(Vector3::Constant(-0.5), Vector3::Constant(0.5));
    model::Model merged;
    merged.dhat = 0.05;
    merged.bodies = {make_body("low", box, {}), make_body("high", box, {})};
    model::Model apart = merged;
    apart.contact_damping_time = 1;  // each primitive by itself
    const BarrierParameters parameters = barrier_parameters(merged.dhat, 0, 1, 1);
    const auto derivatives = [&](const ContactSet& set, const std::vector<Pose>& poses, HessianKind kind) {
        std::vector<kinematics::PoseGradient> gradients(2);
        kinematics::BlockHessian hessian{std::vector<Matrix6>(2, Matrix6::Zero()), {}};
        add_barrier_derivatives(set, poses, parameters, kind, gradients, hessian);
        Matrix12 all = Matrix12::Zero();
        for (int i = 0; i < 2; ++i) all.block<6, 6>(6 * i, 6 * i) = hessian.diagonal[i];
        all.topRightCorner<6, 6>() = hessian.off_diagonal.at(0).block;
        Eigen::Matrix<double, 12, 1> gradient;
        gradient << tangent_gradient(gradients[0]), tangent_gradient(gradients[1]);
        return std::pair(gradient, all);
    };
    std::mt19937 random(8);
    std::uniform_real_distribution<double> unit(-1, 1);
    int fewer = 0;
    for (int k = 0; k < 400; ++k) {
        // On top of each other, corner over corner, edge over edge; turned a little about some axes, or much about the vertical one.
        Vector3 shift(k % 3 == 0 ? 0.0 : unit(random), k % 2 == 0 ? 0.0 : unit(random), 1.01);
        Vector3 turn = 0.02 * Vector3(unit(random), unit(random), unit(random));
        if (k % 5 == 0) turn.setZero();
        if (k % 7 == 0) turn.z() = unit(random);
        const std::vector<Pose> poses{{}, make_pose(turn, shift)};
        const ccd::Candidates candidates = ccd::find_candidates(merged, poses, 0);
        const ContactSet few = find_contacts(merged, candidates, poses), many = find_contacts(apart, candidates, poses);
        if (many.count == 0 || !(many.minimum_distance > 0)) continue;
        CAPTURE(k, shift.transpose(), turn.transpose(), few.count, many.count);
        CHECK(barrier_potential(few, parameters) == Approx(barrier_potential(many, parameters)).epsilon(1e-9).margin(1e-20));
        CHECK(few.minimum_distance == many.minimum_distance);
        const auto [g_few, h_few] = derivatives(few, poses, HessianKind::exact);
        const auto [g_many, h_many] = derivatives(many, poses, HessianKind::exact);
        CHECK((g_few - g_many).norm() <= 1e-9 * g_many.norm() + 1e-20);
        CHECK((h_few - h_many).norm() <= 1e-8 * h_many.norm() + 1e-20);
        const Matrix12 projected = derivatives(few, poses, HessianKind::projected).second;
        const double least = linear::symmetric_eigenvalues<12>(projected.transpose())[0];
        CHECK(least >= -1e-12 * projected.norm());
        fewer += 2 * few.count < many.count;
    }
    CHECK(fewer > 100);
}

// Two boxes that stand on one another, cut into cells so that faces have flat edges and vertices, and wander.
TEST_CASE("what is counted as planned has the bits of what is counted anew", "[counted_contacts]") {
    model::Model model;
    model.dhat = 0.1;
    geometry::Mesh plate = square(3);
    model.bodies = {make_body("plate", plate, {}, scene::BodyType::static_body),
                    make_body("low", box_mesh(Vector3(0.1, 0.1, 0.05), Vector3(0.7, 0.8, 0.5)), {}),
                    make_body("high", box_mesh(Vector3(0.1, 0.1, 0.55), Vector3(0.7, 0.8, 1)), {})};
    std::mt19937 random(11);
    std::uniform_real_distribution<double> unit(-1, 1);
    ContactPlans plans;
    int repeated = 0, anew = 0;
    std::vector<Pose> poses(3);
    for (int k = 0; k < 600; ++k) {
        const double size = k % 10 == 0 ? 0.03 : 1e-7;  // now and then elsewhere, else about at rest
        for (std::size_t b = 1; b < 3; ++b) {
            const Vector3 shift(unit(random), unit(random), 0.5 * unit(random)), turn(unit(random), unit(random), unit(random));
            const Pose base = k % 10 == 0 ? Pose{} : poses[b];
            poses[b] = {make_pose(0.1 * size * turn, {}).rotation * base.rotation, base.position + size * shift};
        }
        if (k % 30 == 0) poses[1] = poses[2] = {};  // corners over corners, exactly
        const ccd::Candidates candidates = ccd::find_candidates(model, poses, 0.01);
        std::vector<std::vector<int>> keys;
        for (const auto& of : plans.pairs) keys.push_back(of.plan.is_usable ? of.plan.key : std::vector<int>{-1});
        const ContactSet with = find_contacts(model, candidates, poses, &plans), without = find_contacts(model, candidates, poses);
        REQUIRE(with.count == without.count);
        REQUIRE(with.pairs.size() == without.pairs.size());
        for (std::size_t i = 0; i < plans.pairs.size() && i < keys.size(); ++i)
            ++(plans.pairs[i].plan.is_usable && plans.pairs[i].plan.key == keys[i] ? repeated : anew);
        for (std::size_t i = 0; i < with.pairs.size(); ++i) {
            REQUIRE(with.pairs[i].contacts.size() == without.pairs[i].contacts.size());
            for (std::size_t j = 0; j < with.pairs[i].contacts.size(); ++j) {
                const ContactPair &p = with.pairs[i].contacts[j], &q = without.pairs[i].contacts[j];
                CAPTURE(k, i, j);
                CHECK((p.type == q.type && p.vertex == q.vertex && p.face == q.face && p.x == q.x));
                CHECK((p.weight == q.weight && p.mollifier_eps == q.mollifier_eps));
                CHECK((p.closest.weight == q.closest.weight && p.closest.difference == q.closest.difference));
                CHECK((p.closest.free_count == q.closest.free_count && p.closest.free_weight == q.closest.free_weight));
            }
        }
    }
    CHECK(repeated > 200);
    CHECK(anew > 50);
}

TEST_CASE("two boxes face to face: their diagonals do not matter", "[counted_contacts]") {
    const auto potential = [](bool other_cut) {
        geometry::Mesh box = box_mesh(Vector3::Constant(-0.5), Vector3::Constant(0.5));
        if (other_cut) {
            // The other diagonal of each face: its two triangles are neighbours in the list.
            for (std::size_t t = 0; t < box.triangles.size(); t += 2) {
                std::vector<int> ring;
                const geometry::Triangle p = box.triangles[t], q = box.triangles[t + 1];
                for (int k = 0; k < 3; ++k) {
                    ring.push_back(p[k]);
                    const int a = p[k], b = p[(k + 1) % 3];
                    const bool shared = std::find(q.begin(), q.end(), a) != q.end() && std::find(q.begin(), q.end(), b) != q.end();
                    for (const int v : q)
                        if (shared && v != a && v != b) ring.push_back(v);
                }
                REQUIRE(ring.size() == 4);
                const bool first = ring[0] == p[0];
                REQUIRE(first);
                const bool has_0_2 = std::find(q.begin(), q.end(), ring[0]) != q.end() && std::find(q.begin(), q.end(), ring[2]) != q.end();
                box.triangles[t] = has_0_2 ? geometry::Triangle{ring[0], ring[1], ring[3]} : geometry::Triangle{ring[0], ring[1], ring[2]};
                box.triangles[t + 1] =
                    has_0_2 ? geometry::Triangle{ring[1], ring[2], ring[3]} : geometry::Triangle{ring[0], ring[2], ring[3]};
            }
            box = geometry::make_mesh("other", box.vertices, box.triangles);
        }
        model::Model model;
        model.dhat = 0.05;
        const std::vector<Pose> poses{{}, make_pose(Vector3(0.01, -0.02, 0.3), Vector3(0.2, 0.1, 1.03))};
        model.bodies = {make_body("low", box, poses[0]), make_body("high", box, poses[1])};
        const ContactSet set = find_contacts(model, ccd::find_candidates(model, poses, 0), poses);
        CHECK(set.count > 4);
        return barrier_potential(set, barrier_parameters(model.dhat, 0, 1, 1));
    };
    CHECK(potential(true) == Approx(potential(false)).epsilon(1e-12));
}

TEST_CASE("a block falls, tips and slides alike on a floor however that is cut", "[counted_contacts][physics]") {
    const auto end_on = [](geometry::Mesh floor) {
        floor.vertices *= 2.0;
        floor.vertices.topRows<2>().array() -= 1.0;
        model::Model model;
        model.bodies = {make_body("floor", floor, {}, scene::BodyType::static_body),
                        make_body("block", box_mesh(Vector3(-0.05, -0.04, -0.03), Vector3(0.05, 0.04, 0.03)),
                                  make_pose(Vector3(0.3, -0.2, 0.4), Vector3(-0.11, 0.07, 0.08)))};
        set_velocity(model.bodies[1], Vector3(0.8, -0.5, 0), Vector3(1, 2, -1));
        model.gravity = Vector3(0, 0, -9.81);
        model.dhat = 1e-3;
        model.diagonal = 0.2;
        model.velocity_tolerance = 1e-8;
        model.friction.mu.setConstant(0.2);
        model.kappa = model::choose_kappa(model);
        stepper::SimulationOptions options;
        options.steps = 60;
        const stepper::Simulation run = simulate(model, options);
        REQUIRE(run.report.status == stepper::SimulationStatus::ok);
        REQUIRE(run.report.steps.back().contacts > 0);
        return run.trajectory.poses.back()[1];
    };
    const Pose coarse = end_on(square(1));
    CHECK(coarse.position.head<2>().norm() < 0.5);
    for (const Pose& other : {end_on(square(7)), end_on(fan())}) {
        CHECK((other.position - coarse.position).norm() < 1e-8);
        CHECK((other.rotation - coarse.rotation).norm() < 1e-7);
    }
}

}  // namespace fettle::core::contact::counted_contacts_test
