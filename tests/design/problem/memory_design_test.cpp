// SPDX-License-Identifier: MIT
/// Designs without a file: shapes and quantities that a program derives, evaluated, differentiated and optimised in memory.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>

#include "design/gradient_audit/difference_check.hpp"
#include "design/problem/buildable.hpp"
#include "design/problem/check_design.hpp"
#include "design/quantities/clearance.hpp"
#include "design/quantities/marker_path.hpp"
#include "design/quantities/mass.hpp"
#include "design/quantities/stroke.hpp"
#include "design/shapes/file_part.hpp"
#include "design/studies/optimise_design.hpp"
#include "tests/design/small_problem.hpp"
#include "tests/support/box_mesh.hpp"

namespace fettle::design::problem::memory_design_test {

namespace {

using namespace fettle::design::description;
using namespace fettle::tests::design_support;
using problem::DesignEvaluation;
using problem::DesignProblem;

// A truncated pyramid about the origin: half widths at the foot and at the top, height.
class Frustum : public Shape {
public:
    Frustum(double foot, double top, double height) : dimensions_{{"foot", foot}, {"top", top}, {"height", height}} {}
    const std::vector<ShapeDimension>& dimensions() const override { return dimensions_; }
    Result<ShapeInstance> at(const std::vector<double>& d) const override {
        if (!(d[0] > 0 && d[1] > 0 && d[2] > 0)) return Error{ErrorCode::out_of_range, "foot", "a frustum's dimensions are above 0"};
        ShapeInstance part;
        part.mesh = tests::support::box_mesh(Vector3::Constant(-1), Vector3::Constant(1));
        part.mesh.name = "frustum";
        part.jacobian.assign(3, Matrix3X::Zero(3, 8));
        for (Eigen::Index i = 0; i < 8; ++i) {
            const Vector3 corner = part.mesh.vertices.col(i);
            const size_t end = corner.z() < 0 ? 0 : 1;
            part.jacobian[end].col(i).head<2>() = corner.head<2>();
            part.jacobian[2](2, i) = corner.z() / 2;
            part.mesh.vertices.col(i) << d[end] * corner.x(), d[end] * corner.y(), d[2] * corner.z() / 2;
        }
        return part;
    }

private:
    std::vector<ShapeDimension> dimensions_;
};

// Mean over the configurations of (height of the reference point + weight times its mesh's first vertex' height in the body).
class MeanHeight : public Quantity {
public:
    explicit MeanHeight(int body) : body_(static_cast<size_t>(body)) {}
    Dimension dimension() const override { return Dimension::length; }
    Measurement value(const Simulated& s) const override {
        double sum = 0;
        for (const auto& poses : s.trajectory.poses) sum += poses[body_].position.z();
        return computed(sum / count(s) + 0.25 * s.model.bodies[body_].mesh.vertices(2, 7));
    }
    void add_seeds(const Simulated& s, const Measurement&, double scale, Seeds& seeds) const override {
        for (auto& bar : seeds.trajectory_bar.pose_bar) bar[body_](2, 3) += scale / count(s);
        seeds.model_bar.bodies[body_].vertices_bar(2, 7) += 0.25 * scale;
    }

private:
    static double count(const Simulated& s) { return static_cast<double>(s.trajectory.poses.size()); }
    size_t body_;
};

// Numbers that need not be any.
class Numbers : public Quantity {
public:
    Numbers(double value, double of_motion, double of_mesh) : value_(value), of_motion_(of_motion), of_mesh_(of_mesh) {}
    Dimension dimension() const override { return Dimension::length; }
    Measurement value(const Simulated&) const override { return computed(value_); }
    void add_seeds(const Simulated&, const Measurement&, double scale, Seeds& seeds) const override {
        seeds.trajectory_bar.pose_bar.back()[1](2, 3) += scale * of_motion_;
        seeds.model_bar.bodies[1].vertices_bar(2, 7) += scale * of_mesh_;
    }

private:
    double value_, of_motion_, of_mesh_;
};

core::scene::Body held(const std::string& name, core::scene::BodyType type) {
    core::scene::Body body;
    body.name = name;
    body.type = type;
    for (auto& coordinate : body.prescribed) coordinate = core::scene::MotionCurve{};
    return body;
}

Parameter parameter(const std::string& name, double value, double lower, double upper, const char* unit = "mm") {
    return {name, value, lower, upper, *find_unit(unit)};
}

std::string dimension(const std::string& name, const std::string& body = "part") { return "/bodies/" + body + "/shape/dimensions/" + name; }

// A frustum falls 0.02 mm onto a plate that a motor tilts.
Design tilted_plate() {
    Design design;
    design.scene.gravity = Vector3(0, 0, -9.81);
    design.scene.timestep = 0.005;
    design.scene.dhat = 1e-4;
    design.steps = 12;
    core::scene::Body plate = held("plate", core::scene::BodyType::kinematic_body);
    plate.mesh = tests::support::box_mesh(Vector3(-0.03, -0.03, -0.01), Vector3(0.03, 0.03, 0));
    plate.prescribed[4]->rate = 0.7;
    design.scene.bodies.push_back(plate);
    core::scene::Body part;
    part.name = "part";
    part.pose.position = Vector3(2e-3, 1e-3, 4.12e-3);
    part.angular_velocity = Vector3(8, 5, 0);
    REQUIRE(add_part(design, part, std::make_shared<Frustum>(8e-3, 5e-3, 8e-3)).value() == 1);
    design.parameters = {parameter("height", 8e-3, 6e-3, 12e-3), parameter("foot", 8e-3, 6e-3, 10e-3), parameter("top", 5e-3, 2e-3, 9e-3),
                         parameter("speed", 0.7, 0.2, 1, "rad/s")};
    REQUIRE(set_number(design, dimension("height"), "height").empty());
    REQUIRE(set_number(design, "/bodies/part/position/2", "height / 2 + 1.2e-4").empty());
    REQUIRE(set_number(design, dimension("foot"), "foot").empty());
    REQUIRE(set_number(design, dimension("top"), "top").empty());
    REQUIRE(set_number(design, "/bodies/0/prescribed/ry/rate", "speed").empty());
    design.objective = {{"height", -1, 1e-3, std::make_shared<MeanHeight>(1)},
                        {"mass", 1, 1e-3, std::make_shared<quantities::Mass>(design.scene, std::vector<int>{1})}};
    Bounds at_least;
    at_least.lower = 3.9e-3;
    at_least.unit = 1e-3;
    design.constraints = {{"height", at_least, std::make_shared<MeanHeight>(1)}};
    design.optimiser = {"mma", 6, 1e-4};
    return design;
}

bool same_bits(const VectorX& a, const VectorX& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), static_cast<size_t>(a.size()) * sizeof(double)) == 0;
}

}  // namespace

TEST_CASE("a body whose mass is given: neither density nor mesh move it, and gradients know") {
    Design design = tilted_plate();
    design.scene.bodies[1].inertial = core::scene::Inertial{2e-3, Vector3::Zero(), 2e-7 * Matrix3::Identity()};
    const auto problem = DesignProblem::create(design);
    REQUIRE(problem);
    problem::EvaluateOptions values;
    values.gradients = false;
    const VectorX p = values_of(design.parameters);
    const DesignEvaluation at = problem->evaluate(p, values);
    CAPTURE(at.reason);
    REQUIRE(at.usable);
    CHECK(at.terms[1].value == 2e-3);
    const DesignEvaluation differentiated = problem->evaluate(p);
    REQUIRE(differentiated.usable);
    for (Eigen::Index k = 0; k < p.size(); ++k) {
        double least = INFINITY;
        for (const double share : {1e-4, 3e-5, 1e-5}) {
            VectorX up = p, down = p;
            const double step = share * std::max(std::abs(p[k]), 1e-3);
            up[k] += step;
            down[k] -= step;
            const double difference = (problem->evaluate(up, values).objective - problem->evaluate(down, values).objective) / (2 * step);
            least = std::min(least, std::abs(difference - differentiated.gradient[k]));
        }
        CAPTURE(k, differentiated.gradient[k], least);
        CHECK(least <= 1e-5 * differentiated.gradient.lpNorm<Eigen::Infinity>());
    }
    design.parameters.push_back(parameter("density", 1000, 500, 2000, "kg/m^3"));
    CHECK(set_number(design, "/bodies/1/density", "density").front().message.find("is given") != std::string::npos);
    design.numbers.push_back(
        {"/bodies/1/density", core::expression::input_formula("density", core::expression::powers_of(Dimension::density))});
    const auto refused = DesignProblem::create(design);
    REQUIRE_FALSE(refused);
    CHECK(refused.errors().front().message.find("is given") != std::string::npos);
}

TEST_CASE("a design with a shape and a quantity of one's own: evaluated, differentiated, optimised in memory") {
    const auto problem = DesignProblem::create(tilted_plate());
    REQUIRE(problem);
    const VectorX p = values_of(problem->design().parameters);
    const DesignEvaluation at = problem->evaluate(p);
    INFO(at.reason);
    REQUIRE(at.usable);
    int contacts = 0;
    for (const auto& step : at.runs.front().simulation.report.steps) contacts += step.contacts;
    CHECK(contacts > 0);
    const gradient_audit::CheckReport report = gradient_audit::check_gradients(*problem, p, at);
    CHECK(report.failures.empty());
    REQUIRE(report.rows.size() == 2 * 4);
    for (const gradient_audit::CheckRow& row : report.rows) {
        INFO(row.quantity << " " << row.parameter << ": " << row.adjoint << " against " << row.difference << " +- "
                          << row.difference_error);
        CHECK(row.relative_error < 1e-6);
        CHECK(row.adjoint != 0);
    }
    const auto outcome = studies::optimise_design(*problem);
    REQUIRE(outcome);
    CHECK(outcome->report.evaluations > 2);
    CHECK(outcome->report.best.objective < at.objective);
    CHECK(outcome->final.usable);
    const auto again = studies::optimise_design(*problem);
    CHECK(same_bits(again->report.point, outcome->report.point));
}

TEST_CASE("what is no number is no evaluation, and its reason names what it is of") {
    const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
    struct Case {
        double value, of_motion, of_mesh;
        std::string reason;
    };
    const Case cases[] = {{nan, 0, 0, ": its value is not a finite number"},
                          {infinity, 0, 0, ": its value is not a finite number"},
                          {0, nan, 0, ": its derivative is not a finite number"},
                          {0, infinity, 0, ": its derivative is not a finite number"},
                          {0, 0, nan, ": its derivative by `height` is not a finite number"}};
    for (const Case& c : cases) {
        const auto wrong = std::make_shared<Numbers>(c.value, c.of_motion, c.of_mesh);
        Design constrained = tilted_plate(), aimed = tilted_plate();
        constrained.constraints.push_back({"wrong", constrained.constraints[0].bounds, wrong});
        aimed.objective.push_back({"wrong", 1, 1e-3, wrong});
        for (const auto& [design, name] : {std::pair(&constrained, std::string("constraint `wrong`")), {&aimed, "objective `wrong`"}}) {
            const auto problem = DesignProblem::create(*design);
            REQUIRE(problem);
            const DesignEvaluation at = problem->evaluate(values_of(design->parameters));
            CHECK_FALSE(at.usable);
            CHECK((std::isnan(at.objective) && std::isnan(at.violation)));  // no number stands in for what is not known
            const bool of_sum = design == &aimed && std::isnan(c.of_mesh);  // of what a model alone moves
            CHECK(at.reason == (of_sum ? "objective" : name) + c.reason);
        }
    }
}

TEST_CASE("a relation of one's own: the optimiser keeps it") {
    Design design = tilted_plate();
    const auto taper = [](const VectorX& p) {  // top / foot
        return RelationValue{p[2] / p[1], (VectorX(4) << 0, -p[2] / (p[1] * p[1]), 1 / p[1], 0).finished()};
    };
    design.objective = {{"mass", 1, 1e-3, std::make_shared<quantities::Mass>(design.scene, std::vector<int>{1})}};
    design.relations = {{.name = "taper", .bounds = {.lower = 0.6, .margin = 1e-5}, .at = taper}};
    design.optimiser = {"sqp", 20, 1e-6};
    design.steps = 1;
    const auto problem = DesignProblem::create(std::move(design));
    REQUIRE(problem);
    const auto outcome = studies::optimise_design(*problem);
    REQUIRE(outcome);
    const VectorX& p = outcome->report.point;
    INFO(outcome->report.message << ": " << p.transpose());
    CHECK(outcome->report.feasible);
    CHECK(p[2] / p[1] >= 0.6);
    CHECK(p[2] / p[1] < 0.6001);  // without it the top would shrink to 2 mm, a third of the foot
    CHECK(p[1] == Approx(6e-3).epsilon(1e-3));
}

TEST_CASE("a design read from a file and one made in memory have the same bits") {
    const DesignFolder folder;
    const Design read = file_of(folder).design;

    Design made;
    made.scene.gravity = Vector3(0, 0, to_si(-9810, *find_unit("mm/s^2")));
    made.scene.timestep = 0.005;
    made.scene.dhat = 1e-4;
    made.steps = 20;
    const auto box = [](double x, double y, double z) {
        return shapes::FilePart::create("box", {{"size_x", x}, {"size_y", y}, {"size_z", z}}).value();
    };
    core::scene::Body table = held("table", core::scene::BodyType::kinematic_body);
    table.pose.position = Vector3(0, 0, -5e-3);
    table.prescribed[4]->rate = to_si(40, *find_unit("deg/s"));
    REQUIRE(add_part(made, table, box(60e-3, 60e-3, 10e-3)));
    core::scene::Body cube;
    cube.name = "cube";
    cube.angular_velocity = read.scene.bodies[1].angular_velocity;
    cube.pose.position = Vector3(3e-3, 1e-3, 5.12e-3);
    REQUIRE(add_part(made, cube, box(20e-3, 12e-3, 10e-3)));
    core::scene::Body wall = held("wall", core::scene::BodyType::static_body);
    wall.pose.position = Vector3(40e-3, 0, 0);
    REQUIRE(add_part(made, wall, box(5e-3, 60e-3, 60e-3)));
    made.scene.gravity = read.scene.gravity;
    made.parameters = {
        parameter("height", 10e-3, 6e-3, 14e-3), parameter("width", 20e-3, 15e-3, 30e-3), parameter("place", 3e-3, -5e-3, 20e-3),
        parameter("density", 1000, 500, 2000, "kg/m^3"),
        parameter("speed", to_si(40, *find_unit("deg/s")), to_si(10, *find_unit("deg/s")), to_si(60, *find_unit("deg/s")), "deg/s")};
    for (const auto& [place, formula] : {std::pair(dimension("size_z", "cube"), "height"),
                                         {dimension("size_x", "cube"), "width"},
                                         {"/bodies/cube/position/2", "height / 2 + 0.12 mm"},
                                         {"/bodies/cube/position/0", "place"},
                                         {"/bodies/cube/density", "density"},
                                         {"/bodies/table/prescribed/ry/rate", "speed"}})
        REQUIRE(set_number(made, place, formula).empty());
    const double mm = 1e-3;
    using Points = std::vector<quantities::OwnPoint>;
    made.objective = {
        {"mass", 1, 1e-3, std::make_shared<quantities::Mass>(made.scene, std::vector<int>{1})},
        {"timed", 0.1, mm * mm,
         std::make_shared<quantities::MarkerPath>(
             1, Vector3(3e-3, 2e-3, 1e-3), Points{Vector3(4e-3, 2e-3, 7e-3), Vector3(8e-3, 3e-3, 6e-3)}, std::vector<double>{0.052, 0.1})},
        {"free", 0.1, mm * mm,
         std::make_shared<quantities::MarkerPath>(1, Vector3(0, 0, 5e-3), Points{Vector3(3e-3, 1e-3, 11e-3)}, std::vector<double>{})},
        {"play", 0.5, mm, std::make_shared<quantities::Clearance>(quantities::ClearanceRange{.a = 1, .b = 2})},
        {"stroke", 1, mm * mm, std::make_shared<quantities::Stroke>(1, Vector3::UnitZ(), 1e-3)}};
    Bounds apart;
    apart.lower = 15e-3;
    made.constraints = {
        {"apart", apart, std::make_shared<quantities::Clearance>(quantities::ClearanceRange{.a = 1, .b = 2, .motion = true})}};

    const auto from_file = DesignProblem::create(read), from_memory = DesignProblem::create(made);
    REQUIRE(from_file);
    REQUIRE(from_memory);
    const DesignEvaluation a = from_file->evaluate(values_of(read.parameters)), b = from_memory->evaluate(values_of(made.parameters));
    REQUIRE(a.usable);
    REQUIRE(b.usable);
    CHECK(a.objective == b.objective);
    CHECK(same_bits(a.gradient, b.gradient));
    CHECK(a.constraints[0].value == b.constraints[0].value);
    CHECK(same_bits(a.jacobian.row(0).transpose(), b.jacobian.row(0).transpose()));
}

TEST_CASE("a trial whose shape is no solid, or has other triangles, cannot be built") {
    class Turned : public Frustum {  // inside out when it is high, with a triangle less when it is low
    public:
        Turned() : Frustum(8e-3, 5e-3, 8e-3) {}
        Result<ShapeInstance> at(const std::vector<double>& d) const override {
            Result<ShapeInstance> part = Frustum::at(d);
            if (d[2] > 10e-3) part->mesh.vertices.row(0) *= -1;
            if (d[2] < 7e-3) part->mesh.triangles.pop_back();
            return part;
        }
    };
    Design design = tilted_plate();
    design.shapes[1] = std::make_shared<Turned>();
    const auto problem = DesignProblem::create(std::move(design));
    REQUIRE(problem);
    VectorX p = values_of(problem->design().parameters);
    CHECK(problem->evaluate(p).usable);
    p[0] = 11e-3;
    const DesignEvaluation high = problem->evaluate(p);
    CHECK_FALSE(high.usable);
    CHECK((std::isnan(high.objective) && std::isnan(high.violation)));
    CHECK(high.reason.find("part") != std::string::npos);
    p[0] = 6.5e-3;
    const DesignEvaluation low = problem->evaluate(p);
    CHECK_FALSE(low.usable);
    CHECK(low.reason.find("other triangles") != std::string::npos);
}

TEST_CASE("of parts that are costly to make the bounds alone and few designs between them are tried") {
    class Costly : public Frustum {
    public:
        Costly() : Frustum(8e-3, 5e-3, 8e-3) {}
        bool is_costly() const override { return true; }
        Result<ShapeInstance> at(const std::vector<double>& d) const override {
            if (d[1] > 8e-3) return Error{ErrorCode::out_of_range, "foot", "too wide"};
            return Frustum::at(d);
        }
    };
    const auto tried = [](std::shared_ptr<const Shape> shape) {
        Design design = tilted_plate();
        design.shapes[1] = std::move(shape);
        return try_bounds(DesignProblem::create(std::move(design)).value());
    };
    CHECK(tried(std::make_shared<Frustum>(8e-3, 5e-3, 8e-3)).samples == 32);
    const BoundsReport report = tried(std::make_shared<Costly>());
    CHECK(report.samples == 8);
    REQUIRE(report.unreachable.size() == 1);  // found, to a thousandth of the way, all the same
    CHECK(report.unreachable[0].parameter == 2);
    CHECK(report.unreachable[0].reach.value == Approx(8e-3).margin(4e-6));
}

TEST_CASE("what is wrong with a design made in memory is told, all of it, by name") {
    Design design = tilted_plate();
    design.numbers[2].place = dimension("fot");
    design.parameters[2].lower = 6e-3;
    design.numbers[4].place = "/bodies/1/prescribed/pz/rate";
    design.objective[0].quantity = nullptr;
    design.objective[1].quantity = std::make_shared<quantities::Mass>(std::vector<quantities::Mass::Of>{{7}});
    design.constraints[0].bounds.upper = 1e-3;
    design.scene.bodies[1].mesh.vertices *= 0.9;
    design.relations = {{.name = "height"},  // the name of a constraint, and no function
                        {.name = "short",
                         .at =
                             [](const VectorX&) {
                                 return RelationValue{1, VectorX::Zero(1)};
                             }},
                        {.name = "infinite",
                         .at =
                             [](const VectorX&) {
                                 return RelationValue{INFINITY, VectorX::Zero(4)};
                             }},
                        {.name = "order", .bounds = {.lower = 2, .upper = 1}, .at = [](const VectorX& p) {
                             return RelationValue{p[0], VectorX::Unit(4, 0)};
                         }}};
    const auto problem = DesignProblem::create(std::move(design));
    REQUIRE_FALSE(problem);
    const Errors& errors = problem.errors();
    const auto told = [&](const std::string& where) {
        return std::count_if(errors.begin(), errors.end(), [&](const Error& e) { return e.where.find(where) != std::string::npos; });
    };
    CHECK(errors.size() == 12);
    CHECK(told("constraint `height`") == 2);
    for (const char* where : {"shape of body `part`", "dimensions/fot", "parameter `top`", "prescribed/pz/rate", "objective `height`",
                              "objective `mass`", "relation `height`", "relation `short`", "relation `infinite`", "relation `order`"}) {
        INFO(where);
        CHECK(told(where) == 1);
    }
}

}  // namespace fettle::design::problem::memory_design_test
