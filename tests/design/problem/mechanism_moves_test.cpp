// SPDX-License-Identifier: MIT
// Parameters of joints, springs, motors and loads: from them to the model as built and back, against differences of models.
#include "fettle/design/problem/mechanism_moves.hpp"

#include <catch2/catch.hpp>
#include <random>

#include "fettle/design/problem/check_design.hpp"
#include "fettle/design/problem/moved_scene.hpp"
#include "fettle/tests/core/stepper/mechanism_models.hpp"

namespace fettle::design::problem::mechanism_moves_test {

using namespace fettle::tests::mechanisms;
using core::model::Model;
using core::model::Origin;
using core::scene::JointKind;
using description::Design;
using description::Move;
using description::MoveTarget;
using description::Parameter;

namespace {

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

double number_in(const Move& move, const core::scene::Mechanism& m) {
    const auto i = static_cast<std::size_t>(move.part.index);
    const auto& f = move.part.list == Origin::List::joint ? m.joints[i].forces : m.springs[i].forces;
    switch (move.target) {
        case MoveTarget::stiffness:
            return f.stiffness;
        case MoveTarget::rest:
            return *f.rest;
        case MoveTarget::preload:
            return f.preload;
        case MoveTarget::damping:
            return f.damping;
        case MoveTarget::friction:
            return f.friction;
        case MoveTarget::lower_limit:
            return (*f.limits)[0];
        case MoveTarget::upper_limit:
            return (*f.limits)[1];
        case MoveTarget::pitch:
            return m.joints[i].pitch;
        case MoveTarget::ratio:
            return m.joints[i].ratio;
        case MoveTarget::curve_value:
            return m.motors[i].curve.values[static_cast<std::size_t>(move.entry)];
        default:
            return m.motors[i].curve.rate;
    }
}

constexpr std::array number_targets{MoveTarget::stiffness,   MoveTarget::rest,        MoveTarget::preload,   MoveTarget::damping,
                                    MoveTarget::friction,    MoveTarget::lower_limit, MoveTarget::pitch,     MoveTarget::ratio,
                                    MoveTarget::upper_limit, MoveTarget::curve_value, MoveTarget::curve_rate};
constexpr std::array part_vectors{MoveTarget::point_a, MoveTarget::point_b,    MoveTarget::axis_a,
                                  MoveTarget::axis_b,  MoveTarget::load_point, MoveTarget::load_force};

// A design with a parameter of value 0 for everything that can be moved, such that all at 0 is the scene.
class DesignOfAll {
public:
    explicit DesignOfAll(core::scene::Scene scene) {
        design_.scene = std::move(scene);
        design_.steps = steps;
        const core::scene::Mechanism& m = design_.scene.mechanism;
        add_parts(Origin::List::joint, m.joints.size());
        add_parts(Origin::List::spring, m.springs.size());
        add_parts(Origin::List::motor, m.motors.size());
        add_parts(Origin::List::load, m.loads.size());
        for (std::size_t i = 0; i < design_.scene.bodies.size(); ++i) add_body(static_cast<int>(i));
        add_vector({.target = MoveTarget::gravity}, 1, design_.scene.gravity);
        add({.target = MoveTarget::dmin, .offset = design_.scene.dmin});
    }
    Design take() { return std::move(design_); }

private:
    void add(Move move) {
        Parameter p;
        p.name = "p" + std::to_string(design_.parameters.size());
        p.lower = -1;
        p.upper = 1;
        p.moves = {std::move(move)};
        design_.parameters.push_back(std::move(p));
    }

    void add_vector(Move move, double scale, const Vector3& at) {
        for (int k = 0; k < 3; ++k) {
            move.direction = Vector3::Unit(k);
            move.scale = scale;
            move.position_offset = at;
            add(move);
        }
    }

    void add_parts(Origin::List list, std::size_t count) {
        core::scene::Mechanism& m = design_.scene.mechanism;
        for (std::size_t i = 0; i < count; ++i) {
            Move move;
            move.part = {list, static_cast<int>(i)};
            for (const MoveTarget target : number_targets) {
                move.target = target;
                const bool is_curve = target == MoveTarget::curve_value && list == Origin::List::motor;
                const int entries = is_curve ? static_cast<int>(m.motors[i].curve.values.size()) : 1;
                for (move.entry = 0; move.entry < entries; ++move.entry) {
                    if (!misfit(m, move).empty() || (target == MoveTarget::rest && !has_rest(m, move))) continue;
                    Move number = move;
                    number.offset = number_in(number, m);
                    number.scale = 0.3 * std::max(0.1, std::abs(number.offset));
                    add(number);
                }
            }
            move.entry = 0;
            for (const MoveTarget target : part_vectors) {
                move.target = target;
                if (!misfit(m, move).empty()) continue;
                const bool is_point = target == MoveTarget::point_a || target == MoveTarget::point_b;
                add_vector(move, is_point ? 0.01 : 0.3, vector_of(move, m));
            }
        }
    }

    static bool has_rest(const core::scene::Mechanism& m, const Move& move) {
        const auto i = static_cast<std::size_t>(move.part.index);
        return (move.part.list == Origin::List::joint ? m.joints[i].forces : m.springs[i].forces).rest.has_value();
    }

    void add_body(int i) {
        const core::scene::Body& body = design_.scene.bodies[static_cast<std::size_t>(i)];
        add_vector({.target = MoveTarget::position, .body = i}, 0.01, body.pose.position);
        add_vector({.target = MoveTarget::turn, .body = i}, 0.05, Vector3::Zero());
        if (body.type != core::scene::BodyType::dynamic_body) {
            add({.target = MoveTarget::motor_rate, .body = i, .dof = 0, .scale = 0.1, .offset = body.prescribed[0]->rate});
            return;
        }
        add_vector({.target = MoveTarget::velocity, .body = i}, 0.3, body.linear_velocity);
        add_vector({.target = MoveTarget::angular_velocity, .body = i}, 1, body.angular_velocity);
        add_vector({.target = MoveTarget::force, .body = i}, 1, body.force);
        add_vector({.target = MoveTarget::torque, .body = i}, 0.1, body.torque);
        add({.target = MoveTarget::density, .body = i, .scale = 300, .offset = body.density});
    }

    Design design_;
};

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
        v(core::kinematics::pose_matrix(body.pose_start));
        if (body.type == core::scene::BodyType::dynamic_body) v(body.velocity_start);
        v(body.density);
        v(body.force);
        v(body.torque);
        for (int t = 0; t < steps; ++t)
            v(body.prescribed[0] ? core::scene::motion_value(*body.prescribed[0], (t + 1) * model.timestep) -
                                       core::scene::motion_value(*body.prescribed[0], t * model.timestep)
                                 : 0);
    }
    v(model.gravity);
    v(model.dmin);
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
    for (const core::constraint::Row& row : model.mechanism.rows) {
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
        fill(bar.pose_start_bar);
        if (model.bodies[i].type == core::scene::BodyType::dynamic_body) fill(bar.velocity_start_bar);
        bar.density_bar = weights[at++];
        fill(bar.force_bar);
        fill(bar.torque_bar);
        for (int t = 0; t < steps; ++t) bar.increment_bar[static_cast<std::size_t>(t)][0] = weights[at++];
    }
    fill(g.gravity_bar);
    g.dmin_bar = weights[at++];
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

Model model_at(const Design& design, const VectorX& p, const std::vector<Vector3>& reference_points) {
    const Result<MovedScene> moved = move_scene(design, p);
    REQUIRE(moved);
    core::model::BuildOptions options;
    options.kappa = 1;
    options.reference_points = reference_points;
    auto model = core::model::build_model(moved->scene, options);
    if (!model) UNSCOPED_INFO(model.errors()[0].message);
    REQUIRE(model);
    return std::move(model).value();
}

}  // namespace

TEST_CASE("whatever a parameter moves of a mechanism, its derivative goes back through the start's assembly", "[joints]") {
    for (core::scene::Scene& scene : std::vector<core::scene::Scene>{loop(), arm(), wheels()}) {
        scene.dhat = 1e-3;
        scene.dmin = 0.1;
        const Design design = DesignOfAll(scene).take();
        const auto n = static_cast<Eigen::Index>(design.parameters.size());
        const VectorX start = VectorX::Zero(n);
        std::vector<Vector3> reference_points;
        for (const core::model::Body& body : model_at(design, start, {}).bodies)
            reference_points.push_back(body.reference_point + Vector3(1e-2, 2e-3, -1e-3));
        const Model model = model_at(design, start, reference_points);
        CHECK(check_design(design, model).empty());
        std::mt19937_64 random(3);
        std::uniform_real_distribution<double> unit(-1, 1);
        std::vector<double> weights(numbers_of(model).size());
        for (double& w : weights) w = unit(random);
        const Result<MovedScene> moved = move_scene(design, start);
        REQUIRE(moved);
        const VectorX gradient = pull_back(*moved, model, gradient_of(model, weights), static_cast<int>(n));
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
            double error = INFINITY;
            for (const double s : {3e-2, 1e-2, 1e-3}) {
                const double difference = (functional(k, s) - functional(k, -s)) / (2 * s);
                const double finer = (functional(k, s / 2) - functional(k, -s / 2)) / s;
                error = std::min(error, std::abs((4 * finer - difference) / 3 - gradient[k]));
            }
            const Move& move = design.parameters[static_cast<std::size_t>(k)].moves[0];
            CAPTURE(scene.mechanism.joints[0].name, k, static_cast<int>(move.target), move.body, static_cast<int>(move.part.list),
                    move.part.index, move.entry, move.direction.transpose(), gradient[k], error);
            CHECK(error < 1e-7 * std::max(1.0, std::abs(gradient[k])));
            not_zero += gradient[k] != 0;
        }
        CHECK(not_zero > 0.7 * static_cast<double>(n));
    }
}

TEST_CASE("moves that fit nothing are told with the name of the part", "[joints]") {
    const core::scene::Mechanism m = arm().mechanism;
    const auto reason = [&](MoveTarget target, Origin::List list, int index, int entry = 0) {
        Move move;
        move.target = target;
        move.part = {list, index};
        move.entry = entry;
        return misfit(m, move);
    };
    using List = Origin::List;
    CHECK(reason(MoveTarget::stiffness, List::joint, 0).empty());
    CHECK(reason(MoveTarget::curve_value, List::motor, 0, 4).empty());
    for (const auto& [text, part] : {std::pair(reason(MoveTarget::stiffness, List::joint, 1), "`ball` has no coordinate"),
                                     std::pair(reason(MoveTarget::axis_b, List::joint, 1), "`ball` has no axis"),
                                     std::pair(reason(MoveTarget::point_a, List::spring, 1), "`about` has no point"),
                                     std::pair(reason(MoveTarget::preload, List::joint, 0), "`hinge` has a `rest`"),
                                     std::pair(reason(MoveTarget::rest, List::spring, 0), "`across` has a `preload`"),
                                     std::pair(reason(MoveTarget::damping, List::spring, 1), "`about` has no `damping`"),
                                     std::pair(reason(MoveTarget::upper_limit, List::spring, 0), "`across` has no `limits`"),
                                     std::pair(reason(MoveTarget::pitch, List::joint, 0), "`hinge` is no screw"),
                                     std::pair(reason(MoveTarget::curve_value, List::motor, 0, 5), "no such value"),
                                     std::pair(reason(MoveTarget::load_force, List::load, 1), "there is no joint")}) {
        CAPTURE(text);
        CHECK(text.find(part) != std::string::npos);
    }
}

TEST_CASE("a trial whose spring, damper or load is 0 is refused by name: it would have no derivative", "[joints]") {
    Design design = DesignOfAll(arm()).take();
    for (std::size_t k = 0; k < design.parameters.size(); ++k) {
        const Move& move = design.parameters[k].moves[0];
        if (move.target != MoveTarget::stiffness && move.target != MoveTarget::damping && move.target != MoveTarget::friction) continue;
        VectorX p = VectorX::Zero(static_cast<Eigen::Index>(design.parameters.size()));
        p[static_cast<Eigen::Index>(k)] = -move.offset / move.scale;
        const Result<MovedScene> moved = move_scene(design, p);
        REQUIRE_FALSE(moved);
        CHECK(moved.errors()[0].message.find("must be greater than 0") != std::string::npos);
    }
}

}  // namespace fettle::design::problem::mechanism_moves_test
