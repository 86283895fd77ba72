// SPDX-License-Identifier: MIT
/// Parts from anything that makes meshes: velocities against the exact ones of files, rounding, another cut of triangles, refusals.
#include "design/shapes/rebuilt_shape.hpp"

#include <array>
#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <cmath>
#include <thread>

#include "design/problem/design_problem.hpp"
#include "design/quantities/clearance.hpp"
#include "design/quantities/mass.hpp"
#include "design/shapes/file_part.hpp"
#include "design/shapes/mesh_rounding.hpp"
#include "design/shapes/mesh_velocity.hpp"
#include "tests/design/shapes/example_parts.hpp"
#include "tests/support/box_mesh.hpp"

namespace fettle::design::shapes::rebuilt_shape_test {

namespace {

using core::geometry::Mesh;
using Values = std::vector<double>;

// As a program writes it: so many significant digits of millimetres.
Mesh printed(Mesh mesh, int digits) {
    for (double& x : mesh.vertices.reshaped()) {
        char text[40];
        std::snprintf(text, sizeof text, "%.*g", digits, 1000 * x);
        x = std::strtod(text, nullptr) * 1e-3;
    }
    return mesh;
}

std::shared_ptr<const FilePart> crank() { return FilePart::create(tests::design_support::example_part("crank")).value(); }

RebuiltShape rebuilt(const std::shared_ptr<const FilePart>& part, int digits) {
    return RebuiltShape(part->dimensions(),
                        [part, digits](const Values& values) -> Result<Mesh> { return printed(part->mesh(values).value(), digits); },
                        {.unit = 1e-3});
}

// A box of these edges whose triangles' diagonals depend on the dimensions: another cut for almost every value.
Mesh restless_box(double x, double y, double z) {
    Mesh mesh = tests::support::box_mesh(Vector3(-x, -y, -z) / 2, Vector3(x, y, z) / 2);
    const int turns = static_cast<int>(std::llround(1e9 * (x + y + z))) % 2;
    if (turns == 0) return mesh;
    // The first two triangles share a diagonal: turn it.
    auto& t = mesh.triangles;
    for (size_t j = 1; j < t.size(); ++j) {
        for (int i = 0; i < 3; ++i) {
            const int a = t[0][i], b = t[0][(i + 1) % 3], c = t[0][(i + 2) % 3];
            for (int k = 0; k < 3; ++k) {
                const auto at = [&](int n) { return t[j][(k + n) % 3]; };
                if (at(0) != b || at(1) != a) continue;
                const Vector3 first = (mesh.vertices.col(b) - mesh.vertices.col(a)).cross(mesh.vertices.col(c) - mesh.vertices.col(a));
                const Vector3 second = (mesh.vertices.col(a) - mesh.vertices.col(b)).cross(mesh.vertices.col(at(2)) - mesh.vertices.col(b));
                if (first.normalized().dot(second.normalized()) < 0.99) continue;
                const int d = at(2);
                t[0] = {c, a, d};
                t[j] = {d, b, c};
                return core::geometry::make_mesh(mesh.name, mesh.vertices, t);
            }
        }
    }
    return mesh;
}

}  // namespace

TEST_CASE("the velocity of a rebuilt part is the exact one, to what its digits allow") {
    const auto part = crank();
    const description::ShapeInstance exact = description::as_drawn(*part).value();
    for (const int digits : {6, 9, 17}) {
        const RebuiltShape shape = rebuilt(part, digits);
        const Result<description::ShapeInstance> found = description::as_drawn(shape);
        REQUIRE(found);
        REQUIRE(found->jacobian.size() == exact.jacobian.size());
        const double limit = digits == 6 ? 2e-3 : digits == 9 ? 2e-5 : 1e-7;
        for (size_t k = 0; k < exact.jacobian.size(); ++k) {
            INFO(digits << " digits, d/d " << part->dimensions()[k].name);
            CHECK((found->jacobian[k] - exact.jacobian[k]).cwiseAbs().maxCoeff() < limit);
        }
        const auto remarks = shape.remarks(description::drawn_values(shape), description::all_dimensions(shape));
        REQUIRE(remarks.size() == exact.jacobian.size());
        CHECK(remarks[0].find("vertex by vertex") != std::string::npos);
    }
}

TEST_CASE("the rounding of coordinates is told by their digits") {
    const Mesh mesh = crank()->mesh(description::drawn_values(*crank())).value();
    const double largest = mesh.vertices.cwiseAbs().maxCoeff();
    const double unit = std::pow(10, std::floor(std::log10(1000 * largest)));
    CHECK(coordinate_rounding(printed(mesh, 6).vertices, 1e-3) == Approx(0.5e-5 * unit * 1e-3).epsilon(0.1));
    CHECK(coordinate_rounding(printed(mesh, 7).vertices, 1e-3) == Approx(0.5e-6 * unit * 1e-3).epsilon(0.2));
    Matrix3X floats = mesh.vertices * 1000;
    floats = floats.cast<float>().cast<double>() / 1000;
    CHECK(coordinate_rounding(floats, 1e-3) == Approx(0x1p-24 * largest).epsilon(0.01));
    CHECK(coordinate_rounding(mesh.vertices, 1e-3) < 1e-15 * 10 * largest);
    CHECK(coordinate_rounding(Matrix3X(3, 0), 1e-3) == 0);
}

TEST_CASE("vertices and triangles in another order are matched") {
    const auto part = crank();
    const Values drawn = description::drawn_values(*part);
    Values moved = drawn;
    moved[0] += 1e-5;
    const Mesh at = part->mesh(drawn).value(), plus = part->mesh(moved).value();
    moved[0] -= 2e-5;
    Mesh minus = part->mesh(moved).value();
    // Reversed order of vertices and of triangles, each triangle begun elsewhere.
    const int last = static_cast<int>(minus.vertices.cols()) - 1;
    minus.vertices = minus.vertices.rowwise().reverse().eval();
    std::reverse(minus.triangles.begin(), minus.triangles.end());
    for (auto& t : minus.triangles) t = {last - t[1], last - t[2], last - t[0]};
    minus = core::geometry::make_mesh("turned", minus.vertices, minus.triangles);
    const Result<MeshVelocity> found = mesh_velocity(at, plus, minus, 2e-5);
    REQUIRE(found);
    CHECK_FALSE(found->by_normals);
    CHECK((found->velocity - part->at(drawn)->jacobian[0]).cwiseAbs().maxCoeff() < 1e-9);
}

TEST_CASE("another cut of triangles: the normal velocity, and what it does to mass and clearance") {
    const RebuiltShape shape({{"x", 0.02}, {"y", 0.012}, {"z", 0.01}},
                             [](const Values& v) -> Result<Mesh> { return restless_box(v[0], v[1], v[2]); });
    const Values at{0.0200000005, 0.012, 0.01};
    bool differs = false;
    for (const double h : {1e-4, 3e-4, 7e-4, 1e-3 + 1e-9})
        differs = differs || restless_box(at[0] + h, at[1], at[2]).triangles != restless_box(at[0], at[1], at[2]).triangles;
    REQUIRE(differs);
    const MeshVelocity forced = mesh_velocity(restless_box(0.02, 0.012, 0.01), restless_box(0.020100001, 0.012, 0.01),
                                              restless_box(0.0199, 0.012, 0.01), 2.00001e-4)
                                    .value();
    CHECK(forced.by_normals);
    const Mesh box = restless_box(0.02, 0.012, 0.01);
    for (Eigen::Index i = 0; i < box.vertices.cols(); ++i) {
        const Vector3 expected(box.vertices(0, i) > 0 ? 0.5 : -0.5, 0, 0);
        CHECK((forced.velocity.col(i) - expected).norm() < 1e-4);
    }
    CHECK(forced.misfit < 1e-4);
}

TEST_CASE("another topology beside is refused with its reason, and so is what the maker refuses") {
    const auto box = [](double low, double high) {
        return tests::support::box_mesh(Vector3(low, -0.01, -0.01), Vector3(high, 0.01, 0.01));
    };
    const RebuiltShape splitting({{"gap", 0.002}}, [&](const Values& v) -> Result<Mesh> {
        if (v[0] <= 0.002) return box(-0.01, 0.01);
        const Mesh a = box(-0.02, -v[0]), b = box(v[0], 0.02);
        Matrix3X vertices(3, 16);
        vertices << a.vertices, b.vertices;
        auto triangles = a.triangles;
        for (auto t : b.triangles) triangles.push_back({t[0] + 8, t[1] + 8, t[2] + 8});
        return core::geometry::make_mesh("two", vertices, triangles);
    });
    const auto found = description::as_drawn(splitting);
    REQUIRE_FALSE(found);
    CHECK(found.errors()[0].where == "gap");
    CHECK(found.errors()[0].message.find("topology") != std::string::npos);
    CHECK(splitting.mesh({0.003}));

    const RebuiltShape bounded({{"side", 0.01}}, [&](const Values& v) -> Result<Mesh> {
        if (v[0] > 0.01) return Error{ErrorCode::out_of_range, "side", "too wide"};
        return box(-v[0], v[0]);
    });
    const auto refused = description::as_drawn(bounded);
    REQUIRE_FALSE(refused);
    CHECK(refused.errors()[0].message.find("too wide") != std::string::npos);
    CHECK(refused.errors()[0].message.find("beside") != std::string::npos);
}

TEST_CASE("nothing is built twice") {
    std::atomic<int> built = 0;
    const RebuiltShape shape({{"a", 0.01}, {"b", 0.02}}, [&](const Values& v) -> Result<Mesh> {
        ++built;
        return tests::support::box_mesh(Vector3(-v[0], -v[1], -0.01), Vector3(v[0], v[1], 0.01));
    });
    REQUIRE(description::as_drawn(shape));
    CHECK(built == 1 + 4 * 2);
    REQUIRE(description::as_drawn(shape));
    REQUIRE(description::drawn_mesh(shape));
    CHECK(shape.remarks(description::drawn_values(shape), {true, true}).size() == 2);
    CHECK(built == 1 + 4 * 2);
}

TEST_CASE("derivatives that are not wanted are not built, and are those of all together where they are") {
    std::atomic<int> built = 0;
    const Values edges{0.01, 0.02, 0.03};
    const auto box = [&](const Values& v) -> Result<Mesh> {
        ++built;
        return tests::support::box_mesh(Vector3(-v[0], -v[1], -v[2]), Vector3(v[0], v[1], v[2]));
    };
    const std::vector<description::ShapeDimension> dimensions{{"a", 0.01}, {"b", 0.02}, {"c", 0.03}};
    const RebuiltShape shape(dimensions, box);
    const auto part = shape.differentiated(edges, {false, true, false});
    REQUIRE(part);
    CHECK(built == 1 + 4);
    REQUIRE(part->jacobian.size() == 3);
    CHECK(part->jacobian[0].cols() == 0);
    CHECK(part->jacobian[2].cols() == 0);
    CHECK(shape.remarks(edges, {false, true, false}).size() == 1);
    CHECK(shape.remarks(edges, {false, false, false}).empty());
    CHECK(built == 1 + 4);
    const auto all = shape.at(edges);
    REQUIRE(all);
    CHECK(built == 1 + 4 * 3);  // what was known of b is taken
    CHECK(all->jacobian[1] == part->jacobian[1]);
    CHECK(shape.remarks(edges, {true, true, true}).size() == 3);

    // One that cannot be differentiated in what is not wanted.
    const RebuiltShape bounded(dimensions, [&](const Values& v) -> Result<Mesh> {
        if (v[2] > 0.03) return Error{ErrorCode::out_of_range, "c", "too wide"};
        return box(v);
    });
    CHECK(bounded.differentiated(edges, {true, true, false}));
    CHECK_FALSE(bounded.differentiated(edges, {true, true, true}));
    CHECK(bounded.remarks(edges, {true, true, false}).size() == 2);
}

TEST_CASE("what several threads ask for at the same time is built once") {
    std::atomic<int> built = 0;
    const RebuiltShape shape({{"a", 0.01}}, [&](const Values& v) -> Result<Mesh> {
        ++built;
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        return tests::support::box_mesh(Vector3(-v[0], -0.01, -0.01), Vector3(v[0], 0.01, 0.01));
    });
    std::array<Matrix3X, 3> found;
    std::vector<std::thread> threads;
    for (Matrix3X& jacobian : found) threads.emplace_back([&] { jacobian = description::as_drawn(shape).value().jacobian[0]; });
    for (std::thread& thread : threads) thread.join();
    CHECK(built == 1 + 4);
    CHECK(found[0] == found[1]);
    CHECK(found[0] == found[2]);
}

TEST_CASE("an evaluation builds a part for the dimensions that its design moves") {
    std::atomic<int> built = 0;
    const auto part = std::make_shared<RebuiltShape>(
        std::vector<description::ShapeDimension>{{"a", 0.01}, {"b", 0.02}, {"c", 0.03}}, [&](const Values& v) -> Result<Mesh> {
            ++built;
            return tests::support::box_mesh(Vector3(-v[0], -v[1], -v[2]), Vector3(v[0], v[1], v[2]));
        });
    description::Design design;
    core::scene::Body block;
    block.name = "block";
    REQUIRE(add_part(design, block, part));
    CHECK(built == 1);
    design.steps = 1;
    design.parameters = {{"width", 0.02, 0.01, 0.03, *find_unit("mm")}};
    REQUIRE(set_number(design, "/bodies/block/shape/dimensions/b", "width").empty());
    design.objective = {{"mass", 1, 1e-3, std::make_shared<quantities::Mass>(design.scene, std::vector<int>{0})}};
    const auto problem = problem::DesignProblem::create(std::move(design));
    REQUIRE(problem);
    CHECK(problem->evaluate(VectorX::Constant(1, 0.02)).usable);
    CHECK(built == 1 + 4);
    CHECK(problem->evaluate(VectorX::Constant(1, 0.025)).usable);
    CHECK(built == 2 * (1 + 4));
    problem::EvaluateOptions values;
    values.gradients = false;
    CHECK(problem->evaluate(VectorX::Constant(1, 0.015), values).usable);
    CHECK(built == 2 * (1 + 4) + 1);
}

TEST_CASE("a design of a rebuilt part has the gradient of the exact one's") {
    const auto design_of = [](const std::shared_ptr<const description::Shape>& shape) {
        description::Design design;
        core::scene::Body peg, wall;
        peg.name = "peg", wall.name = "wall";
        wall.type = core::scene::BodyType::static_body;
        wall.prescribed.fill(core::scene::MotionCurve{});
        wall.pose.position = Vector3(0.03, 0, 0);
        REQUIRE(add_part(design, peg, shape));
        REQUIRE(add_part(design, wall, FilePart::create("box", {{"size_x", 0.01}, {"size_y", 0.05}, {"size_z", 0.05}}).value()));
        design.steps = 1;
        design.parameters = {{"radius", 0.006, 0.004, 0.01, *find_unit("mm")}};
        REQUIRE(set_number(design, "/bodies/0/shape/dimensions/radius", "radius").empty());
        design.objective = {{"mass", 1, 1e-3, std::make_shared<quantities::Mass>(design.scene, std::vector<int>{0})}};
        design.constraints = {
            {"apart", {.lower = 1e-3}, std::make_shared<quantities::Clearance>(quantities::ClearanceRange{.a = 0, .b = 1})}};
        return problem::DesignProblem::create(std::move(design)).value();
    };
    const auto part = FilePart::create("cylinder", {{"radius", 0.006}, {"length", 0.02}}).value();
    const auto made = std::make_shared<RebuiltShape>(
        part->dimensions(), [part](const Values& values) -> Result<Mesh> { return printed(part->mesh(values).value(), 9); },
        RebuiltOptions{.unit = 1e-3});
    const auto exact = design_of(part).evaluate(VectorX::Constant(1, 0.006)), found = design_of(made).evaluate(VectorX::Constant(1, 0.006));
    REQUIRE(exact.usable);
    INFO(found.reason);
    REQUIRE(found.usable);
    CHECK(found.gradient[0] == Approx(exact.gradient[0]).epsilon(1e-5));
    CHECK(found.jacobian(0, 0) == Approx(exact.jacobian(0, 0)).epsilon(1e-5));
}

}  // namespace fettle::design::shapes::rebuilt_shape_test
