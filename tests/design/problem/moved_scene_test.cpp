// SPDX-License-Identifier: MIT
#include "design/problem/moved_scene.hpp"

#include <catch2/catch.hpp>
#include <random>

#include "core/setup/build_model.hpp"
#include "design/reading/design_reader.hpp"
#include "tests/design/small_design.hpp"
#include "tests/support/derivative_check.hpp"

namespace fettle::design::problem::moved_scene_test {

namespace {

using fettle::design::description::values_of;
using fettle::design::reading::DesignFile;
using fettle::design::reading::read_design;
using namespace fettle::tests::design_support;

constexpr int steps = 4;

core::model::Model built(const core::scene::Scene& scene, const std::vector<Vector3>& reference_points) {
    core::setup::BuildOptions options;
    options.reference_points = reference_points;
    auto model = core::setup::build_model(scene, options);
    REQUIRE(model);
    return std::move(model).value();
}

// A linear functional of all the model data that pull_back chains through, with fixed weights.
double functional(const core::model::Model& model, const adjoint::ModelGradient& weights) {
    double sum = 0;
    for (size_t i = 0; i < model.bodies.size(); ++i) {
        const core::model::Body& body = model.bodies[i];
        const adjoint::BodyGradient& w = weights.bodies[i];
        sum += w.vertices_bar.cwiseProduct(body.mesh.vertices).sum();
        sum += w.pose_start_bar.cwiseProduct(core::kinematics::pose_matrix(body.pose_start)).sum();
        sum += w.density_bar * body.density;
        for (int dof = 0; dof < 6; ++dof) {
            if (!body.prescribed[dof]) continue;
            for (int t = 0; t < steps; ++t) {
                const auto& curve = *body.prescribed[dof];
                const double increment =
                    core::scene::motion_value(curve, (t + 1) * model.timestep) - core::scene::motion_value(curve, t * model.timestep);
                sum += w.increment_bar[t][dof] * increment;
            }
        }
    }
    return sum;
}

adjoint::ModelGradient random_weights(const core::model::Model& model) {
    std::mt19937 generator(7);
    std::uniform_real_distribution<double> uniform(-1, 1);
    const auto fill = [&](auto& m) { m = m.unaryExpr([&](double) { return uniform(generator); }); };
    adjoint::ModelGradient weights = adjoint::zero_model_gradient(model, steps);
    for (adjoint::BodyGradient& body : weights.bodies) {
        fill(body.vertices_bar);
        fill(body.pose_start_bar);
        body.density_bar = 1e-5 * uniform(generator);
        for (Vector6& increment : body.increment_bar) fill(increment);
    }
    return weights;
}

}  // namespace

TEST_CASE("pull_back is the transpose of move_scene's derivative") {
    // The motor stops in the middle of the third step.
    const DesignFolder folder(small_design, replaced(small_scene, "\"rate\": 40", "\"rate\": 40, \"stop_time\": 0.0125"));
    const Result<DesignFile> file = read_design(folder.design());
    REQUIRE(file);
    const auto& design = file->design;
    const VectorX p = values_of(design.parameters);
    const Result<MovedScene> moved = move_scene(design, p);
    REQUIRE(moved);
    const core::model::Model first = built(moved->scene, {});
    std::vector<Vector3> reference_points;
    for (const auto& body : first.bodies) reference_points.push_back(body.reference_point + Vector3(1e-3, 2e-3, -1e-3));
    const core::model::Model model = built(moved->scene, reference_points);
    const adjoint::ModelGradient weights = random_weights(model);
    const VectorX gradient = pull_back(*moved, model, {weights}, 5).transpose();
    const VectorX scale = p.cwiseAbs();
    const auto check = tests::support::check_gradient(
        [&](const VectorX& x) {
            const Result<MovedScene> at = move_scene(design, p + scale.cwiseProduct(x));
            return functional(built(at->scene, reference_points), weights);
        },
        VectorX::Zero(5), gradient.cwiseProduct(scale), {1e-3, 0.25, 6});
    INFO("column " << check.column << ": " << check.analytic << " against " << check.difference);
    CHECK(check.relative_error < 1e-9);
}

TEST_CASE("moves of one target add up, and replace what the scene says") {
    const DesignFolder folder;
    const Result<DesignFile> file = read_design(folder.design());
    REQUIRE(file);
    const auto& design = file->design;
    VectorX p = values_of(design.parameters);
    p[0] = 0.012;
    p[2] = 0.007;
    const Result<MovedScene> moved = move_scene(design, p);
    REQUIRE(moved);
    const core::scene::Body& cube = moved->scene.bodies[1];
    CHECK(cube.pose.position.x() == 0.007);
    CHECK(cube.pose.position.y() == 0.001);  // the scene's
    CHECK(cube.pose.position.z() == Approx(0.00612).epsilon(1e-15));
    CHECK(cube.mesh.vertices.row(2).maxCoeff() == Approx(0.006).epsilon(1e-15));
    CHECK(moved->numbers.size() == 6);
}

TEST_CASE("a part that cannot be made is an error with its body and dimension") {
    const DesignFolder folder;
    const Result<DesignFile> file = read_design(folder.design());
    REQUIRE(file);
    const auto& design = file->design;
    VectorX p = values_of(design.parameters);
    p[0] = -0.001;
    const Result<MovedScene> moved = move_scene(design, p);
    REQUIRE_FALSE(moved);
    CHECK(moved.errors()[0].where.find("cube") != std::string::npos);
    CHECK(moved.errors()[0].where.find("size_z") != std::string::npos);
}

}  // namespace fettle::design::problem::moved_scene_test
