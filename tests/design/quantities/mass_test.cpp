// SPDX-License-Identifier: MIT
#include "design/quantities/mass.hpp"

#include "tests/design/quantities/quantity_fixture.hpp"

namespace fettle::design::quantities::mass_test {

namespace {

using namespace fettle::tests::design_support;

Mass mass_of(core::scene::MassKind kind) { return Mass(std::vector<Mass::Of>{{0, kind}}); }

}  // namespace

TEST_CASE("mass: a given one is that, whatever the mesh") {
    core::model::Model model = cube_model();
    model.bodies[0].given_mass = 0.7;
    const core::stepper::Trajectory trajectory = moving(1);
    const Mass mass = mass_of(core::scene::MassKind::volume);
    CHECK(mass.value({model, trajectory, 1e-9}).value == 0.7);
    adjoint::Seeds seeds = adjoint::zero_seeds(model, 1);
    mass.add_seeds({model, trajectory, 1e-9}, {}, 2, seeds);
    CHECK(seeds.model_bar.bodies[0].vertices_bar.isZero(0));
    CHECK(seeds.model_bar.bodies[0].density_bar == 0);
    model.bodies[0].mesh.triangles.pop_back();
    CHECK(mass.check(model, 1).empty());
}

TEST_CASE("mass: value and derivative in vertices and density") {
    core::model::Model model = cube_model();
    const core::stepper::Trajectory trajectory = moving(1);
    const Mass mass = mass_of(core::scene::MassKind::volume);
    CHECK(mass.value({model, trajectory, 1e-9}).value == Approx(500 * 0.008));
    adjoint::Seeds seeds = adjoint::zero_seeds(model, 1);
    mass.add_seeds({model, trajectory, 1e-9}, {}, 2, seeds);
    VectorX gradient(25);
    gradient << seeds.model_bar.bodies[0].vertices_bar.reshaped(), seeds.model_bar.bodies[0].density_bar * 1000;
    const auto check = tests::support::check_gradient(
        [&](const VectorX& x) {
            core::model::Model moved = model;
            moved.bodies[0].mesh.vertices += x.head<24>().reshaped(3, 8);
            moved.bodies[0].density += 1000 * x[24];
            return 2 * mass.value({moved, trajectory, 1e-9}).value;
        },
        VectorX::Zero(25), gradient, {1e-3, 0.25, 5});
    CHECK(check.relative_error < 1e-9);
}

TEST_CASE("mass: by what the density of a body is per, with its derivative") {
    using core::scene::MassKind;
    core::model::Model model = cube_model();
    const core::stepper::Trajectory trajectory = moving(1);
    const std::pair<MassKind, double> kinds[] = {{MassKind::volume, 0.008}, {MassKind::area, 0.24}, {MassKind::vertex, 8}};
    for (const auto& [kind, amount] : kinds) {
        const Mass mass = mass_of(kind);
        CHECK(mass.value({model, trajectory, 1e-9}).value == Approx(500 * amount));
        adjoint::Seeds seeds = adjoint::zero_seeds(model, 1);
        mass.add_seeds({model, trajectory, 1e-9}, {}, 2, seeds);
        CHECK(seeds.model_bar.bodies[0].density_bar == Approx(2 * amount));
        const auto check = tests::support::check_gradient(
            [&](const VectorX& x) {
                core::model::Model moved = model;
                moved.bodies[0].mesh.vertices += x.reshaped(3, 8);
                return 2 * mass.value({moved, trajectory, 1e-9}).value;
            },
            VectorX::Zero(24), seeds.model_bar.bodies[0].vertices_bar.reshaped(), {1e-3, 0.25, 5});
        CHECK(check.relative_error < 1e-9);
    }
    // 12 edges of 0.2 m and a diagonal on each of 6 faces
    CHECK(mass_of(MassKind::length).value({model, trajectory, 1e-9}).value == Approx(500 * (12 * 0.2 + 6 * 0.2 * std::sqrt(2.0))));
}

TEST_CASE("mass: a body without any of its kind is named") {
    using core::scene::MassKind;
    core::model::Model model = cube_model();
    model.bodies[0].name = "cube";
    CHECK(mass_of(MassKind::volume).check(model, 1).empty());
    model.bodies[0].mesh.triangles.resize(6);
    core::geometry::build_connectivity(model.bodies[0].mesh);
    CHECK(mass_of(MassKind::area).check(model, 1).empty());
    const Errors errors = mass_of(MassKind::volume).check(model, 1);
    REQUIRE(errors.size() == 1);
    CHECK(errors[0].message.find("\"cube\"") != std::string::npos);
    CHECK(errors[0].message.find("kg/m^3") != std::string::npos);
}

}  // namespace fettle::design::quantities::mass_test
