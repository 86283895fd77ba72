// SPDX-License-Identifier: MIT
// The area-weighted barrier: a block stands on a plate with the same gap however finely its mesh is cut; without weights it does not. And
// the shares of contacts' weights add up to the weights, merged contacts and corners that count -1 included.
#include <catch2/catch.hpp>
#include <map>
#include <random>

#include "core/contact/contact_areas.hpp"
#include "core/contact/contact_set.hpp"
#include "core/setup/build_model.hpp"
#include "core/stepper/simulate.hpp"
#include "tests/support/test_models.hpp"

namespace fettle::core::contact::area_weight_test {

using namespace fettle::tests::support;

namespace {

// Each triangle into four.
geometry::Mesh cut(const geometry::Mesh& mesh) {
    std::vector<Vector3> vertices;
    for (const auto& x : mesh.vertices.colwise()) vertices.push_back(x);
    std::map<std::pair<int, int>, int> middles;
    const auto middle = [&](int a, int b) {
        const auto [at, added] = middles.try_emplace(std::minmax(a, b), count_of(vertices));
        if (added) vertices.push_back(0.5 * (vertices[a] + vertices[b]));
        return at->second;
    };
    std::vector<geometry::Triangle> triangles;
    for (const auto& [a, b, c] : mesh.triangles) {
        const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
        for (const geometry::Triangle& t : {geometry::Triangle{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}}) triangles.push_back(t);
    }
    Matrix3X x(3, vertices.size());
    for (std::size_t i = 0; i < vertices.size(); ++i) x.col(i) = vertices[i];
    return geometry::make_mesh("cut", x, triangles);
}

double resting_gap(int cuts, bool area_weighted, double kappa) {
    geometry::Mesh block = box_mesh(Vector3(-0.2, -0.2, 0), Vector3(0.2, 0.2, 0.02));  // flat: its sides hardly count
    for (int k = 0; k < cuts; ++k) block = cut(block);
    model::Model model;
    model.bodies = {ground_plate(), make_body("block", block, make_pose(Vector3::Zero(), Vector3(0.013, 0.021, 0.0008)))};
    model.gravity = Vector3(0, 0, -9.81);
    model.dhat = 1e-3;
    model.diagonal = 4;
    model.velocity_tolerance = 1e-7;
    model.area_weighted = area_weighted;
    model.kappa = kappa;
    stepper::SimulationOptions options;
    options.steps = 150;
    const stepper::Simulation run = simulate(model, options);
    INFO(run.report.message);
    REQUIRE(run.report.status == stepper::SimulationStatus::ok);
    return run.report.steps.back().minimum_distance;
}

}  // namespace

TEST_CASE("with area weights the gap does not depend on the mesh", "[area_weight]") {
    const double weight = 1000 * 0.4 * 0.4 * 0.02 * 9.81, dhat = 1e-3;
    // Chosen so that the gap is about half of dhat: weight = kappa area dhat, and without weights for a few contacts.
    const double area_kappa = weight / (0.16 * dhat), kappa = weight / (8 * dhat);
    const double coarse = resting_gap(1, true, area_kappa), fine = resting_gap(3, true, area_kappa);
    CHECK(coarse > 0.2 * dhat);
    CHECK(std::abs(coarse - fine) < 0.1 * dhat);
    CHECK(std::abs(resting_gap(1, false, kappa) - resting_gap(3, false, kappa)) > 0.2 * dhat);
}

namespace {

// One box on another, and a third beside both; of different sizes.
model::Model boxes(const Vector3& turn, double damping_time) {
    model::Model model;
    model.dhat = 4e-3;
    model.kappa = 1e4;
    model.area_weighted = true;
    model.contact_damping_time = damping_time;
    model.bodies = {
        make_body("lower", box_mesh({-0.05, -0.06, -0.05}, {0.05, 0.05, 0}), {}, scene::BodyType::static_body),
        make_body("upper", box_mesh({-0.03, -0.02, 0.0015}, {0.04, 0.03, 0.05}), make_pose(turn, {0.02, 0.01, 0.001})),
        make_body("side", box_mesh({-0.02, -0.03, -0.02}, {0.02, 0.03, 0.07}), make_pose({0.01, 0, 0}, {0.0725, 0.005, -0.01}))};
    return model;
}

}  // namespace

TEST_CASE("shares of areas add up to the contacts' weights", "[area_weight]") {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> unit(-1, 1);
    int contacts = 0, several = 0, edges = 0, negative = 0;
    for (int trial = 0; trial < 60; ++trial) {
        const model::Model model = boxes(Vector3(0.02 * unit(random), 0.02 * unit(random), unit(random)), trial % 2 == 0 ? 0 : 0.01);
        std::vector<kinematics::Pose> poses;
        for (const model::Body& body : model.bodies) poses.push_back(body.pose_start);
        const ccd::Candidates candidates = ccd::find_candidates(model, poses, 0);
        const ContactSet set = find_contacts(model, candidates, poses);
        const ContactAreas areas = contact_areas(model, candidates, poses);
        REQUIRE(count_of(areas.shares) == set.count);
        std::size_t place = 0;
        for (const BodyPairContacts& list : set.pairs)
            for (const ContactPair& pair : list.contacts) {
                double sum = 0;
                for (const AreaShare& share : areas.shares[place]) {
                    const model::Body& body = model.bodies[share.body];
                    sum += share.factor * (share.is_edge ? body.edge_area : body.vertex_area)[share.element];
                    edges += share.is_edge ? 1 : 0;
                    negative += share.factor < 0 ? 1 : 0;
                }
                CHECK(sum == Approx(pair.weight).epsilon(1e-12));
                several += areas.shares[place].size() > 1 ? 1 : 0;
                ++contacts;
                ++place;
            }
    }
    CHECK(contacts > 100);
    CHECK(several > 10);
    CHECK(edges > 20);
    CHECK(negative > 5);
}

TEST_CASE("edges of the same area are told", "[area_weight]") {
    model::Model model = boxes(Vector3(0, 0, 0.4), 0);
    model.bodies[1].mesh = model.bodies[0].mesh;
    refresh(model.bodies[1]);
    model.bodies[1].pose_start = make_pose({0, 0, 0.4}, {0, 0, 0.052});
    model.bodies.pop_back();
    std::vector<kinematics::Pose> poses{model.bodies[0].pose_start, model.bodies[1].pose_start};
    const ccd::Candidates candidates = ccd::find_candidates(model, poses, 0);
    REQUIRE(find_contacts(model, candidates, poses).count > 0);
    CHECK_FALSE(contact_areas(model, candidates, poses).equal.empty());
}

}  // namespace fettle::core::contact::area_weight_test
