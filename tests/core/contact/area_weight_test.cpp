// SPDX-License-Identifier: MIT
// The area-weighted barrier: a block stands on a plate with the same gap however finely its mesh is cut; without weights it does not.
#include <catch2/catch.hpp>
#include <map>

#include "fettle/core/model/build_model.hpp"
#include "fettle/core/stepper/simulate.hpp"
#include "fettle/tests/support/test_models.hpp"

namespace fettle::core::contact::area_weight_test {

using namespace fettle::tests::support;

namespace {

// Each triangle into four.
geometry::Mesh cut(const geometry::Mesh& mesh) {
    std::vector<Vector3> vertices;
    for (const auto& x : mesh.vertices.colwise()) vertices.push_back(x);
    std::map<std::pair<int, int>, int> middles;
    const auto middle = [&](int a, int b) {
        const auto [at, added] = middles.try_emplace(std::minmax(a, b), static_cast<int>(vertices.size()));
        if (added) vertices.push_back(0.5 * (vertices[static_cast<std::size_t>(a)] + vertices[static_cast<std::size_t>(b)]));
        return at->second;
    };
    std::vector<geometry::Triangle> triangles;
    for (const auto& [a, b, c] : mesh.triangles) {
        const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
        for (const geometry::Triangle& t : {geometry::Triangle{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}}) triangles.push_back(t);
    }
    Matrix3X x(3, static_cast<Eigen::Index>(vertices.size()));
    for (std::size_t i = 0; i < vertices.size(); ++i) x.col(static_cast<Eigen::Index>(i)) = vertices[i];
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

}  // namespace fettle::core::contact::area_weight_test
