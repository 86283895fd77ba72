// SPDX-License-Identifier: MIT
// All that a parameter can move, the whole table of places: from parameters to the model as built and back, against differences of models.
#include <catch2/catch.hpp>
#include <random>
#include <set>

#include "core/model/row_choice.hpp"
#include "design/problem/check_design.hpp"
#include "design/problem/design_problem.hpp"
#include "design/problem/moved_scene.hpp"
#include "design/quantities/energy.hpp"
#include "design/quantities/expression.hpp"
#include "design/quantities/joint_load.hpp"
#include "design/quantities/marker_speed.hpp"
#include "design/quantities/mass.hpp"
#include "design/quantities/stroke.hpp"
#include "design/shapes/file_part.hpp"
#include "tests/design/linear_numbers.hpp"
#include "tests/support/mechanisms.hpp"

namespace fettle::design::problem::moved_places_test {

using namespace fettle::tests::mechanisms;
using core::model::Model;
using core::scene::JointKind;
using core::scene::Place;
using description::Design;
using description::Parameter;

namespace {

using fettle::tests::design_support::follow;

// No two of their components tie: the axes across one would jump, which moves nothing but is no derivative of theirs.
const Vector3 x_axis(1, 0.03, 0.07), y_axis(0.04, 1, -0.02), z_axis(0.02, 0.05, 1);
constexpr int steps = 3;

core::scene::Curve curve(core::scene::CurveKind kind, std::vector<double> times, std::vector<double> values, double rate = 0) {
    core::scene::Curve out;
    out.kind = kind;
    out.times = std::move(times);
    out.values = std::move(values);
    out.rate = rate;
    return out;
}

// Does not fit as written; start velocities disagree with the motor.
core::scene::Scene loop() {
    core::scene::Scene scene =
        scene_of({bar("crank", 0.1), bar("coupler", 0.35, Vector3(0.1, 0.01, 0), Vector3(0.05, -0.1, 0.6)),
                  bar("rocker", 0.25, Vector3(0.35, -0.05, 0.06), Vector3(0, 0.02, 1.5)), bar("base", 0.1, Vector3(0.35, -0.05, 0.05))},
                 0.01);
    scene.bodies[3].type = core::scene::BodyType::kinematic_body;
    for (auto& dof : scene.bodies[3].prescribed) dof = core::scene::MotionCurve{};
    scene.bodies[3].prescribed[0]->rate = 0.3;
    scene.bodies[1].angular_velocity = Vector3(1, 2, 3);
    scene.bodies[2].linear_velocity = Vector3(0.1, -0.2, 0.3);
    scene.mechanism.joints = {
        joint("O", JointKind::revolute, {"", Vector3::Zero(), z_axis}, {"crank", Vector3::Zero(), z_axis}),
        joint("A", JointKind::ball, {"crank", Vector3(0.1, 0, 0), z_axis}, {"coupler", Vector3::Zero(), z_axis}),
        joint("B", JointKind::ball, {"coupler", Vector3(0.33, 0, 0), z_axis}, {"rocker", Vector3(0.25, 0, 0), z_axis}),
        joint("C", JointKind::revolute, {"base", Vector3(0, 0, 0), Vector3(0.1, 0.03, 1)},
              {"rocker", Vector3::Zero(), Vector3(0.1, 0.03, 2)})};
    scene.mechanism.motors = {motor("drive", "O", curve(core::scene::CurveKind::linear, {0, 0.3}, {0.2, 0.9}, 1.5))};
    return scene;
}

// Everything that acts along a coordinate.
core::scene::Scene arm() {
    core::scene::Scene scene = scene_of({bar("upper", 0.3), bar("lower", 0.25, Vector3(0.3, 0, 0), Vector3(0, 0.3, 0.4))}, 0.01);
    scene.gravity = Vector3(0, 0.4, -9.81);
    core::scene::Joint hinge = joint("hinge", JointKind::revolute, {"", Vector3::Zero(), y_axis}, {"upper", Vector3::Zero(), y_axis});
    hinge.forces = {3, 0.2, 0, 0.05, 0.03, std::array<double, 2>{-1.0, 0.5}};
    scene.mechanism.joints = {hinge,
                              joint("ball", JointKind::ball, {"upper", Vector3(0.3, 0, 0), z_axis}, {"lower", Vector3::Zero(), z_axis})};
    scene.mechanism.joints[1].swing = 1.5;
    core::scene::Spring across;
    across.name = "across";
    across.a = {"", Vector3(0.1, 0.2, 0.4), z_axis};
    across.b = {"lower", Vector3(0.2, 0, 0), z_axis};
    across.forces.stiffness = 40;
    across.forces.preload = 2;
    across.forces.damping = 0.6;
    core::scene::Spring about;
    about.name = "about";
    about.joint = "hinge";
    about.forces.stiffness = 2;
    about.forces.preload = 0.3;
    scene.mechanism.springs = {across, about};
    scene.mechanism.loads = {{"load", "", "lower", Vector3(0.25, 0, 0), Vector3(1, -2, 0.5)}};
    core::scene::Motor torque =
        motor("torque", "hinge", curve(core::scene::CurveKind::control_points, {0, 0.2}, {0.1, -0.4, 0.7, 0.2, -0.3}, 0.4));
    torque.kind = core::scene::MotorKind::effort;
    scene.mechanism.motors = {torque};
    return scene;
}

// Screw, gear, rack, prismatic, planar, cylindrical and fixed joints; some axes do not stand as they should.
core::scene::Scene wheels() {
    core::scene::Scene scene = scene_of(
        {bar("first", 0.1, Vector3(0.05, 0, 0.05)), bar("second", 0.1, Vector3(0.3, 0, 0.05)), bar("rack", 0.1, Vector3(0, 0.2, 0)),
         bar("nut", 0.1, Vector3(0, 0, 0.3)), bar("puck", 0.1, Vector3(0.1, 0.1, 0.3)), bar("rider", 0.1, Vector3(0.1, 0.1, 0.4))},
        0.01);
    scene.bodies[3].angular_velocity = Vector3(4, 0, 0);
    scene.bodies[5].linear_velocity = Vector3(0, 0.1, 0.2);
    scene.mechanism.joints = {
        joint("one", JointKind::revolute, {"", Vector3(0.05, 0, 0.05), z_axis}, {"first", Vector3::Zero(), Vector3(0.01, 0.05, 1)}),
        joint("two", JointKind::revolute, {"", Vector3(0.3, 0, 0.05), z_axis}, {"second", Vector3::Zero(), z_axis}),
        joint("slide", JointKind::prismatic, {"", Vector3(0, 0.2, 0), x_axis}, {"rack", Vector3(0, 0.001, 0), x_axis}),
        joint("thread", JointKind::screw, {"", Vector3(0, 0, 0.3), x_axis}, {"nut", Vector3(0.01, 0, 0), x_axis}),
        joint("table", JointKind::planar, {"nut", Vector3(0, 0, 0), z_axis}, {"puck", Vector3(-0.1, -0.1, 0), z_axis}),
        joint("post", JointKind::cylindrical, {"puck", Vector3(0.02, 0, 0), Vector3(0.1, 0.13, 1)},
              {"rider", Vector3(0.02, 0, 0), z_axis})};
    scene.mechanism.joints[3].pitch = 0.05;
    for (const auto& [name, kind, first, second, ratio] :
         {std::tuple("gear", JointKind::gear, "one", "two", -0.6), std::tuple("pinion", JointKind::rack, "one", "slide", 0.03)}) {
        core::scene::Joint coupling = joint(name, kind, {}, {});
        coupling.of = {first, second};
        coupling.ratio = ratio;
        scene.mechanism.joints.push_back(coupling);
    }
    scene.mechanism.motors = {motor("drive", "one", curve(core::scene::CurveKind::linear, {0, 0.3}, {0.3, 0.9}, 0.5))};
    return scene;
}

// What the others have nothing of: dimensions, prescribed coordinates, friction, and springs of other kinds.
Design shop() {
    core::scene::Body slab = bar("slab", 0.2, Vector3(0, -1, 0)), oiled = bar("oiled", 0.1, Vector3(0.5, 0, 0)),
                      rider = bar("rider", 0.1, Vector3(0, 1, 0));
    slab.type = core::scene::BodyType::kinematic_body;
    for (std::size_t dof = 0; dof < 6; ++dof) {
        slab.prescribed[dof] = core::scene::MotionCurve{};
        slab.prescribed[dof]->rate = 0.1 + 0.02 * static_cast<double>(dof);
    }
    slab.orientation.numbers = Vector3(0.2, -0.3, 0.5);
    oiled.orientation = {core::scene::Orientation::Kind::vector, Vector3(0.1, 0.4, -0.2)};
    for (core::scene::Body* body : {&slab, &oiled}) settle_rotation(*body);
    slab.prescribed[2]->stop_time = 0.025;
    slab.material = "steel";
    oiled.mu = 0.3;
    rider.material = "wood";
    Design design;
    design.scene = scene_of({slab, oiled, rider}, 0.01);
    core::scene::Body box;
    box.name = "box/1";
    box.group = 0;
    box.pose.position = Vector3(0, 2, 0);
    box.material = "brass";
    const auto shape = shapes::FilePart::create("box", {{"size_x", 0.3}, {"size_y", 0.02}, {"size_z", 0.04}});
    REQUIRE(shape);
    REQUIRE(description::add_part(design, box, *shape));
    design.scene.friction.mu = 0.2;
    design.scene.friction.materials = {{"steel", 0.5}, {"brass", 0.4}};
    design.scene.friction.pairs = {{"wood", "steel", 0.7}};
    core::scene::Joint slide = joint("slide", JointKind::prismatic, {"", Vector3(0, 1, 0), x_axis}, {"rider", Vector3::Zero(), x_axis});
    slide.forces.stiffness = 20;
    slide.forces.preload = 0.5;
    design.scene.mechanism.joints = {slide};
    core::scene::Spring stay, dash;
    stay.name = "stay";
    stay.a = {"oiled", Vector3(0.1, 0, 0), z_axis};
    stay.b = {"rider", Vector3(0, 0, 0.1), z_axis};
    stay.forces = {7, 0.4, 0, 0.1, 0.2, std::array<double, 2>{0.1, 2.0}};
    dash.name = "dash";
    dash.joint = "slide";
    dash.forces.damping = 0.3;
    design.scene.mechanism.springs = {stay, dash};
    core::scene::Motor push = motor("push", "slide", curve(core::scene::CurveKind::linear, {0, 0.2}, {0.3, 0.1}, 0.2));
    push.kind = core::scene::MotorKind::effort;
    design.scene.mechanism.motors = {push};
    return design;
}

Design of_scene(core::scene::Scene scene) {
    Design design;
    design.scene = std::move(scene);
    return design;
}

std::vector<Design> designs() {
    std::vector<Design> out{of_scene(loop()), of_scene(arm()), of_scene(wheels()), shop()};
    for (Design& design : out) {
        design.steps = steps;
        design.scene.dhat = 1e-3;
        design.scene.dmin = 0.1;
    }
    return out;
}

// A parameter of value 0 for each number that can be moved, such that all at 0 is the scene. Not of what the scene leaves to its defaults.
void add_parameters(Design& design) {
    const core::scene::Scene scene = description::described_scene(design);
    for (const Place& place : core::scene::places_of(scene)) {
        const double value = core::scene::value_at(scene, place);
        if (std::isnan(value) || !core::scene::faults_at(scene, place).empty()) continue;
        Parameter p;
        p.name = pointer_to(scene, place);
        p.lower = -1;
        p.upper = 1;
        const bool is_place = p.name.find("position") != std::string::npos || p.name.find("point") != std::string::npos;
        follow(design, p.name, p.name, is_place ? 0.01 : 0.3 * std::max(0.1, std::abs(value)), value);
        design.parameters.push_back(std::move(p));
    }
}

// Every number of a model that a gradient has an entry for.
struct Visitor {
    std::vector<double> values;
    void operator()(double value) { values.push_back(value); }
    template <class Derived>
    void operator()(const Eigen::MatrixBase<Derived>& m) {
        for (Eigen::Index k = 0; k < m.cols(); ++k)
            for (Eigen::Index i = 0; i < m.rows(); ++i) values.push_back(m(i, k));
    }
};

std::vector<double> numbers_of(const Model& model) {
    Visitor v;
    for (const core::model::Body& body : model.bodies) {
        v(body.mesh.vertices);
        v(core::kinematics::pose_matrix(body.pose_start));
        if (body.type == core::scene::BodyType::dynamic_body) v(body.velocity_start);
        v(body.density);
        v(body.force);
        v(body.torque);
        for (int t = 0; t < steps; ++t)
            for (const auto& curve : body.prescribed)
                v(curve
                      ? core::scene::motion_value(*curve, (t + 1) * model.timestep) - core::scene::motion_value(*curve, t * model.timestep)
                      : 0);
    }
    v(model.gravity);
    v(model.dmin);
    for (int a = 0; a < count_of(model.bodies); ++a)
        for (int b = 0; b < a; ++b) v(friction_coefficient(model, b, a));
    for (const core::measure::Frame& f : model.mechanism.set.frames) {
        v(f.point);
        v(f.axes);
    }
    for (const core::model::MeasureTerm& term : model.mechanism.terms) {
        v(term.coefficient);
        v(term.kind == core::model::LawKind::spring || term.kind == core::model::LawKind::stop ? term.reference : 0);
        for (const double value : term.curve.values) v(value);
        v(term.curve.rate);
    }
    for (const core::constraint::Row& row : all_rows(model.mechanism)) {
        v(row.constant);
        for (const core::constraint::RowPart& part : row.parts) v(part.factor);
        for (const double value : row.curve.values) v(value);
        v(row.curve.rate);
    }
    return v.values;
}

// The gradient whose product with a model's numbers, in the order above, is sum weights . numbers.
adjoint::ModelGradient gradient_of(const Model& model, const std::vector<double>& weights) {
    adjoint::ModelGradient g = adjoint::zero_model_gradient(model, steps);
    std::size_t at = 0;
    const auto fill = [&](auto& m) {
        for (Eigen::Index k = 0; k < m.cols(); ++k)
            for (Eigen::Index i = 0; i < m.rows(); ++i) m(i, k) = weights[at++];
    };
    for (std::size_t i = 0; i < model.bodies.size(); ++i) {
        adjoint::BodyGradient& bar = g.bodies[i];
        fill(bar.vertices_bar);
        fill(bar.pose_start_bar);
        if (model.bodies[i].type == core::scene::BodyType::dynamic_body) fill(bar.velocity_start_bar);
        bar.density_bar = weights[at++];
        fill(bar.force_bar);
        fill(bar.torque_bar);
        for (int t = 0; t < steps; ++t) fill(bar.increment_bar[t]);
    }
    fill(g.gravity_bar);
    g.dmin_bar = weights[at++];
    for (int a = 0; a < count_of(model.bodies); ++a)
        for (int b = 0; b < a; ++b) {
            const double weight = weights[at++];
            if (friction_coefficient(model, b, a) > 0) g.friction_bar[{b, a}] = weight;
        }
    adjoint::MechanismGradient& m = g.mechanism;
    for (auto& f : m.frames) {
        fill(f.point);
        fill(f.axes);
    }
    for (std::size_t k = 0; k < m.term_coefficient.size(); ++k) {
        m.term_coefficient[k] = weights[at++];
        m.term_reference[k] = weights[at++];
        for (double& value : m.term_values[k]) value = weights[at++];
        m.term_rate[k] = weights[at++];
    }
    for (std::size_t i = 0; i < m.row_constant.size(); ++i) {
        m.row_constant[i] = weights[at++];
        for (double& factor : m.row_factors[i]) factor = weights[at++];
        for (double& value : m.row_values[i]) value = weights[at++];
        m.row_rate[i] = weights[at++];
    }
    REQUIRE(at == weights.size());
    return g;
}

// A text of a, b and c, numbers between 0.3 and 0.8: something of every operation that is smooth there.
std::string random_text(std::mt19937_64& random, int depth) {
    const auto pick = [&](int count) { return std::uniform_int_distribution<int>(0, count - 1)(random); };
    if (depth == 0) return std::array<std::string, 4>{"a", "b", "c", "0.7"}[pick(4)];
    const std::string x = random_text(random, depth - 1), y = random_text(random, depth - 1);
    switch (pick(12)) {
        case 0:
            return "(" + x + " + " + y + ")";
        case 1:
            return "(" + x + " - 0.5 * " + y + ")";
        case 2:
            return x + " * " + y;
        case 3:
            return x + " / (2 + " + y + "^2)";
        case 4:
            return "sin(" + x + ") * cos(" + y + ")";
        case 5:
            return "sqrt(1 + (" + x + ")^2)";
        case 6:
            return "hypot(" + x + ", 1 + " + y + ")";
        case 7:
            return "exp(-(" + x + ")^2)";
        case 8:
            return "log(2 + sin(" + x + "))";
        case 9:
            return "(atan2(" + x + ", 2 + " + y + ") / 1 rad)";
        case 10:
            return "max(" + x + ", -50)";
        default:
            return "if(" + x + " < 1000, " + y + ", 0) * tan(0.1 * sin(" + x + "))";
    }
}

core::expression::Formula random_formula(std::mt19937_64& random, const Design& design) {
    const std::string text = random_text(random, 3);
    INFO(text);
    const auto formula = core::expression::parse_formula(text, description::scope_of(design.parameters));
    for (const Error& error : formula.errors()) UNSCOPED_INFO(error.message);
    REQUIRE(formula);
    return *formula;
}

// Three parameters, and eight numbers of the scene that follow from them. @return the places
std::set<Place> follow_random_formulas(Design& design, std::mt19937_64& random) {
    for (const char* name : {"a", "b", "c"}) {
        Parameter p;
        p.name = name;
        p.value = std::uniform_real_distribution<double>(0.3, 0.8)(random);
        p.lower = 0;
        p.upper = 1;
        design.parameters.push_back(p);
    }
    const VectorX start = values_of(design.parameters);
    const core::scene::Scene scene = description::described_scene(design);
    const std::vector<Place> places = core::scene::places_of(scene);
    std::set<Place> taken;
    while (taken.size() < 8) {
        const Place place = places[std::uniform_int_distribution<std::size_t>(0, places.size() - 1)(random)];
        const double value = core::scene::value_at(scene, place);
        if (std::isnan(value) || !core::scene::faults_at(scene, place).empty() || !taken.insert(place).second) continue;
        core::expression::Formula shape = random_formula(random, design);
        std::vector<double> inputs;
        for (const int k : positions_of(shape, names_of(design.parameters))) inputs.push_back(start[k]);
        const double at_start = core::expression::value_of<double>(shape, inputs);
        const std::string pointer = pointer_to(scene, place);
        const bool is_place = pointer.find("position") != std::string::npos || pointer.find("point") != std::string::npos;
        const double scale = (is_place ? 0.01 : 0.3 * std::max(0.1, std::abs(value))) / std::max(1.0, std::abs(at_start));
        // value + scale (shape - shape at the start), in the dimension of the place
        core::expression::Scope scope;
        scope.names = {{"shape", {}, shape}};
        char text[200];
        std::snprintf(text, sizeof text, "%.17g + %.17g * (shape - %.17g)", value, scale, at_start);
        core::expression::Formula formula = *core::expression::parse_formula(text, scope);
        formula.dimension = core::expression::powers_of(core::scene::dimension_at(scene, place));
        design.numbers.push_back({pointer, formula});
    }
    return taken;
}

Model model_at(const Design& design, const VectorX& p, const std::vector<Vector3>& reference_points) {
    const Result<MovedScene> moved = move_scene(design, p);
    REQUIRE(moved);
    core::setup::BuildOptions options;
    options.kappa = 1;
    options.reference_points = reference_points;
    auto model = core::setup::build_model(moved->scene, options);
    if (!model) UNSCOPED_INFO(model.errors()[0].message);
    REQUIRE(model);
    return std::move(model).value();
}

}  // namespace

TEST_CASE("whatever a parameter moves, its derivative goes back through the start's assembly", "[joints]") {
    std::set<int> rows;
    for (Design& design : designs()) {
        add_parameters(design);
        const auto n = static_cast<Eigen::Index>(design.parameters.size());
        const VectorX start = VectorX::Zero(n);
        std::vector<Vector3> reference_points;
        for (const core::model::Body& body : model_at(design, start, {}).bodies)
            reference_points.push_back(body.reference_point + Vector3(1e-2, 2e-3, -1e-3));
        const Model model = model_at(design, start, reference_points);
        CHECK(check_design(design, {model}).empty());
        std::mt19937_64 random(3);
        std::uniform_real_distribution<double> unit(-1, 1);
        std::vector<double> weights(numbers_of(model).size());
        for (double& w : weights) w = unit(random);
        Result<MovedScene> moved = move_scene(design, start);
        REQUIRE(moved);
        const VectorX gradient = pull_back(*moved, model, {gradient_of(model, weights)}, static_cast<int>(n)).transpose();
        for (MovedNumber& number : moved->numbers) {
            rows.insert(number.place.row);
            number.slope *= 1.001;
        }
        const VectorX wrong = pull_back(*moved, model, {gradient_of(model, weights)}, static_cast<int>(n)).transpose();
        const auto functional = [&](Eigen::Index k, double s) {
            VectorX p = start;
            p[k] = s;
            const std::vector<double> numbers = numbers_of(model_at(design, p, reference_points));
            const std::vector<double> before = numbers_of(model);
            REQUIRE(numbers.size() == weights.size());
            double sum = 0;
            for (std::size_t i = 0; i < numbers.size(); ++i) sum += weights[i] * (numbers[i] - before[i]);
            return sum;
        };
        int not_zero = 0;
        for (Eigen::Index k = 0; k < n; ++k) {
            double error = INFINITY, error_of_wrong = INFINITY;
            for (const double s : {3e-2, 1e-2, 1e-3}) {
                const double difference = (functional(k, s) - functional(k, -s)) / (2 * s);
                const double finer = (functional(k, s / 2) - functional(k, -s / 2)) / s, best = (4 * finer - difference) / 3;
                error = std::min(error, std::abs(best - gradient[k]));
                error_of_wrong = std::min(error_of_wrong, std::abs(best - wrong[k]));
            }
            const double tolerance = 1e-7 * std::max(1.0, std::abs(gradient[k]));
            CAPTURE(design.parameters[k].name, gradient[k], error);
            CHECK(error < tolerance);
            if (std::abs(gradient[k]) > 1e-3) CHECK(error_of_wrong > tolerance);
            not_zero += gradient[k] != 0;
        }
        CHECK(not_zero > 0.7 * static_cast<double>(n));
    }
    CHECK(rows.size() == static_cast<std::size_t>(core::scene::row_count()));
}

namespace {

void check_random_formulas(unsigned seed, int runs) {
    std::mt19937_64 random(seed);
    int checked = 0;
    const std::vector<Design> bases = designs();
    for (int run = 0; run < runs; ++run) {
        Design design = bases[static_cast<std::size_t>(run) % bases.size()];
        follow_random_formulas(design, random);
        const VectorX start = values_of(design.parameters);
        std::vector<Vector3> reference_points;
        for (const core::model::Body& body : model_at(design, start, {}).bodies) reference_points.push_back(body.reference_point);
        const Model model = model_at(design, start, reference_points);
        REQUIRE(check_design(design, {model}).empty());
        std::uniform_real_distribution<double> unit(-1, 1);
        std::vector<double> weights(numbers_of(model).size());
        for (double& w : weights) w = unit(random);
        const Result<MovedScene> moved = move_scene(design, start);
        REQUIRE(moved);
        const VectorX gradient = pull_back(*moved, model, {gradient_of(model, weights)}, 3).transpose();
        for (Eigen::Index k = 0; k < 3; ++k) {
            const auto functional = [&](double s) {
                const std::vector<double> numbers = numbers_of(model_at(design, start + s * VectorX::Unit(3, k), reference_points));
                const std::vector<double> before = numbers_of(model);
                double sum = 0;
                for (std::size_t i = 0; i < numbers.size(); ++i) sum += weights[i] * (numbers[i] - before[i]);
                return sum;
            };
            double error = INFINITY;
            for (const double s : {3e-2, 1e-2, 1e-3, 1e-4}) {  // the assembly is good to about 1e-9: short steps may drown in it
                const double wide = (functional(s) - functional(-s)) / (2 * s), fine = (functional(s / 2) - functional(-s / 2)) / s;
                error = std::min(error, std::abs((4 * fine - wide) / 3 - gradient[k]));
            }
            CAPTURE(run, k, gradient[k], error);
            CHECK(error < 1e-6 * std::max(1.0, std::abs(gradient[k])));
            checked += gradient[k] != 0;
        }
    }
    CHECK(checked > 2 * runs);
}

}  // namespace

TEST_CASE("random formulas at random places: the derivative goes back through both", "[joints]") { check_random_formulas(34, 80); }

TEST_CASE("many random formulas at random places: the derivative goes back through both", "[joints][slow]") {
    check_random_formulas(35, 2000);
}

TEST_CASE("a trial whose spring, damper or coefficient of friction is 0 is refused by name: it would have no derivative", "[joints]") {
    int refused = 0;
    for (Design& design : designs()) {
        add_parameters(design);
        for (std::size_t k = 0; k < design.parameters.size(); ++k) {
            const core::scene::BoundNumber& number = design.numbers[k];
            const std::string key = number.place.substr(number.place.rfind('/') + 1);
            if (key != "stiffness" && key != "damping" && key != "friction" && key != "mu") continue;
            VectorX p = VectorX::Zero(design.parameters.size());
            const double scale = number.formula.nodes[1].number, offset = number.formula.nodes[3].number;
            p[k] = -offset / scale;
            const Result<MovedScene> moved = move_scene(design, p);
            REQUIRE_FALSE(moved);
            CHECK(moved.errors()[0].message.find("must be greater than 0") != std::string::npos);
            ++refused;
        }
    }
    CHECK(refused > 12);
}

// A random formula of what is measured of a mechanism, and of the parameters.
std::shared_ptr<const description::Quantity> random_expression(std::mt19937_64& random, const Design& design) {
    using quantities::NamedQuantity, quantities::Over;
    const core::scene::Mechanism& mechanism = design.scene.mechanism;
    const auto one_of = [&](std::size_t count) { return std::uniform_int_distribution<std::size_t>(0, count - 1)(random); };
    const auto over = [&] { return std::array{Over::end, Over::sum, Over::mean}[one_of(3)]; };
    const int body = static_cast<int>(one_of(design.scene.bodies.size()));
    const std::vector<NamedQuantity> parts{
        {"travel", std::make_shared<quantities::Stroke>(body, Vector3(1, 2, 2) / 3, std::nullopt)},
        {"speed",
         std::make_shared<quantities::MarkerSpeed>(quantities::MarkerSpeed::Of{body, Vector3(0.1, 0, 0.05), Vector3::UnitY()}, over())},
        {"work", std::make_shared<quantities::Energy>(quantities::EnergyKind::spring, over())},
        {"load",
         std::make_shared<quantities::JointLoad>(
             quantities::JointLoad::Of{quantities::JointLoadKind::force,
                                       mechanism.joints[one_of(std::min<std::size_t>(2, mechanism.joints.size()))].name, Vector3::UnitZ()},
             over())},
        {"matter", std::make_shared<quantities::Mass>(design.scene, std::vector<int>{body})}};
    const std::vector<std::string> plain{
        "travel / 1 m", "speed / 1 m * 1 s", "work / 1 N / 1 m", "load / 1 N", "matter / 1 kg", "a", "b", "c"};
    const auto operand = [&] { return "(" + plain[one_of(plain.size())] + ")"; };
    const std::string x = operand(), y = operand(), z = operand();
    const std::vector<std::string> texts{x + " * " + y + " + " + z,
                                         x + " - 2 * " + y + " * " + z,
                                         x + " / (2 + " + y + "^2) + " + z,
                                         "sin(" + x + ") * hypot(1 + " + y + ", " + z + ")",
                                         "log(2 + " + x + "^2) - atan(" + y + ") / 1 rad * " + z,
                                         "max(" + x + ", " + x + " - 1) * " + y + " + exp(-" + z + "^2)"};
    const std::string text = texts[one_of(texts.size())];
    INFO(text);
    const auto made = quantities::Expression::parse(text, parts, design.parameters);
    for (const Error& error : made.errors()) UNSCOPED_INFO(error.message);
    REQUIRE(made);
    return *made;
}

TEST_CASE("random designs of random expressions: the adjoint of whole simulations against differences", "[joints][slow]") {
    std::mt19937_64 random(341);
    const std::vector<Design> bases = designs();
    std::set<int> rows;
    int runs = 0, resolved = 0, wrong = 0, found = 0, not_usable = 0;
    double worst = 0;
    for (; runs < 300; ++runs) {
        Design design = bases[static_cast<std::size_t>(runs) % bases.size()];
        design.scene.velocity_tolerance = 1e-10;
        for (const Place& place : follow_random_formulas(design, random)) rows.insert(place.row);
        description::ObjectiveTerm term;
        term.name = "objective";
        term.quantity = random_expression(random, design);
        design.objective = {term};
        const auto problem = DesignProblem::create(design);
        for (const Error& error : problem.errors()) UNSCOPED_INFO(error.where + ": " + error.message);
        REQUIRE(problem);
        const VectorX start = values_of(design.parameters);
        const DesignEvaluation at = problem->evaluate(start);
        if (!at.usable) {
            WARN("run " << runs << ": " << at.reason);
            ++not_usable;
            continue;
        }
        for (Eigen::Index k = 0; k < 3; ++k) {
            const auto objective = [&](double s) { return problem->evaluate(start + s * VectorX::Unit(3, k), {false, {}, {}}).objective; };
            std::vector<double> estimates;
            for (const double s : {1e-2, 3e-3, 1e-3, 3e-4}) {
                const double wide = (objective(s) - objective(-s)) / (2 * s), fine = (objective(s / 2) - objective(-s / 2)) / s;
                estimates.push_back((4 * fine - wide) / 3);
            }
            // How far the differences themselves are known: two neighbours that agree.
            double noise = INFINITY, best = NAN;
            for (std::size_t i = 1; i < estimates.size(); ++i) {
                const double apart = std::abs(estimates[i] - estimates[i - 1]);
                if (!(apart < noise)) continue;
                noise = apart;
                best = estimates[i];
            }
            const double scale = std::max({std::abs(at.gradient[k]), 1e-3 * at.gradient.cwiseAbs().maxCoeff(), 1e-6});
            if (!(noise < 3e-7 * scale)) continue;
            ++resolved;
            const double error = std::abs(best - at.gradient[k]) / scale;
            worst = std::max(worst, error);
            CAPTURE(runs, k, at.gradient[k], best, noise);
            CHECK(error < 1e-6);
            if (std::abs(at.gradient[k]) < scale) continue;
            ++wrong;
            found += std::abs(best - 1.00001 * at.gradient[k]) / scale > 1e-6;
        }
    }
    WARN("runs " << runs << ", derivatives resolved " << resolved << " of " << 3 * runs << ", worst error " << worst);
    CHECK(not_usable < 15);
    CHECK(resolved > 600);
    CHECK(wrong > 400);
    CHECK(found == wrong);                                                     // a derivative that is off by a hundred thousandth
    CHECK(rows.size() == static_cast<std::size_t>(core::scene::row_count()));  // every place
}

}  // namespace fettle::design::problem::moved_places_test
