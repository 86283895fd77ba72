// SPDX-License-Identifier: MIT
// The loads and energies of joints, motors and springs as quantities of a design: values against what the simulation reports, derivatives
// against differences of designs.
#include "design/quantities/step_series.hpp"

#include <catch2/catch.hpp>

#include "design/problem/design_problem.hpp"
#include "design/quantities/contact_force.hpp"
#include "design/quantities/energy.hpp"
#include "design/quantities/joint_load.hpp"
#include "design/quantities/marker_speed.hpp"
#include "design/shapes/file_part.hpp"
#include "tests/design/linear_numbers.hpp"
#include "tests/support/mechanisms.hpp"

namespace fettle::design::quantities::step_series_test {

namespace {

using fettle::tests::design_support::follow;
using fettle::tests::design_support::follow_vector;

using namespace fettle::tests::mechanisms;
using core::scene::Integrator;
using core::scene::JointKind;
using description::Design;
using problem::DesignProblem;

const Vector3 x_axis = Vector3::UnitX(), y_axis = Vector3::UnitY(), z_axis = Vector3::UnitZ();

// A slider-crank with a spring that has stops, in space: the rod between balls.
Design slider_crank(Integrator integrator) {
    core::scene::Scene scene = slider_crank_scene();
    scene.integrator = integrator;
    scene.gravity = Vector3(0.2, -9.81, 0.4);
    core::scene::Spring back;
    back.name = "back";
    back.joint = "guide";
    back.forces.stiffness = 500;
    back.forces.rest = 0.03;
    back.forces.damping = 3;
    back.forces.limits = {-0.3, 2e-4};  // within dhat of the start, and farther than any difference moves it
    scene.mechanism.springs = {back};
    core::scene::Curve curve;
    curve.kind = core::scene::CurveKind::control_points;
    curve.times = {0, 0.2};
    curve.values = {0, 0.2, 0.7, 1.4, 1.9};
    curve.rate = 0.7;
    scene.mechanism.motors = {motor("drive", "main", curve)};
    scene.dhat = 1e-3;
    Design design;
    design.scene = scene;
    design.steps = 9;
    return design;
}

std::string new_parameter(Design& design) {
    description::Parameter p;
    p.name = "p" + std::to_string(design.parameters.size());
    p.lower = -1;
    p.upper = 1;
    design.parameters.push_back(p);
    return p.name;
}

void add_parameter(Design& design, const std::string& place, double scale, double offset) {
    follow(design, new_parameter(design), place, scale, offset);
}

void add_vector(Design& design, const std::string& place, const Vector3& direction, double scale = 1,
                const Vector3& offset = Vector3::Zero()) {
    follow_vector(design, new_parameter(design), place, direction, scale, offset);
}

// At 0 the design as it is.
void add_parameters(Design& design) {
    add_vector(design, "/joints/1/point_a", x_axis, 0.01, Vector3(0.1, 0, 0));  // the crank's radius
    add_vector(design, "/joints/3/point_b", y_axis, 0.01, Vector3::Zero());
    add_vector(design, "/joints/3/axis_a", Vector3(0, 1, 0.5), 0.1, Vector3::Zero());
    add_parameter(design, "/springs/0/stiffness", 100, 500);
    add_parameter(design, "/springs/0/rest", 0.01, 0.03);
    add_parameter(design, "/springs/0/limits/1", 1e-4, 2e-4);
    add_parameter(design, "/springs/0/damping", 1, 3);
    add_vector(design, "/loads/0/force", Vector3(1, 1, 0), 3, Vector3(-12, 1, 0));
    add_vector(design, "/loads/0/point", y_axis, 0.01, Vector3(0, 0.01, 0));
    add_parameter(design, "/motors/0/curve/values/3", 0.1, 1.4);
    add_parameter(design, "/motors/0/speed", 0.1, 0.7);
    add_parameter(design, "/bodies/1/density", 300, 1000);
    add_vector(design, "/gravity", y_axis, 1, Vector3(0, -9.81, 0));
    add_vector(design, "/bodies/1/force", Vector3(1, 0, 1));
}

// Two bars that a spring with a damper acts between, another from the world, and a load: what Newmark can have.
Design sprung_bars() {
    core::scene::Scene scene = scene_of({bar("one", 0.3), bar("two", 0.2, Vector3(0.1, 0.3, 0.2), Vector3(0.4, 0.2, -0.3))}, 0.02);
    scene.integrator = Integrator::newmark;
    scene.gravity = Vector3(0.2, 0.1, -0.5);
    scene.bodies[0].angular_velocity = Vector3(2, -1, 3);
    scene.bodies[1].linear_velocity = Vector3(0.2, 0.3, -0.1);
    scene.bodies[1].torque = Vector3(0.001, 0.002, 0);
    core::scene::Spring between, from_world;
    between.name = "between";
    between.a = {"one", Vector3(0.3, 0, 0), z_axis};
    between.b = {"two", Vector3(0.2, 0, 0), z_axis};
    between.forces = {7, 0.2, 0, 0.3, 0, std::nullopt};
    from_world.name = "from world";
    from_world.a = {"", Vector3(0, 0, 0.5), z_axis};
    from_world.b = {"one", Vector3(0.1, 0, 0), z_axis};
    from_world.forces.stiffness = 4;
    from_world.forces.rest = 0.8;
    scene.mechanism.springs = {between, from_world};
    scene.mechanism.loads = {{"load", "", "two", Vector3(0.1, 0.02, 0), Vector3(0.1, 0.2, 0.3)}};
    scene.dhat = 1e-3;
    Design design;
    design.scene = scene;
    design.steps = 9;
    return design;
}

using Named = std::vector<std::pair<std::string, std::shared_ptr<const description::Quantity>>>;

// @param body  whose marker's velocity it is too
Named energies(bool is_static, int body, Over over) {
    Named out;
    for (const EnergyKind kind : {EnergyKind::kinetic, EnergyKind::potential, EnergyKind::spring, EnergyKind::total})
        if (!is_static || kind != EnergyKind::kinetic)
            out.emplace_back("energy " + std::to_string(static_cast<int>(kind)), std::make_shared<Energy>(kind, over));
    if (is_static) return out;
    for (const Vector3& axis : {Vector3(Vector3::Zero()), Vector3(0.6, 0, 0.8)})
        out.emplace_back("speed", std::make_shared<MarkerSpeed>(MarkerSpeed::Of{body, Vector3(0.12, 0.01, 0.02), axis}, over));
    return out;
}

Named quantities_of(bool is_static) {
    Named out = energies(is_static, 1, Over::mean);
    const auto load = [&](JointLoadKind kind, const std::string& name, const Vector3& axis, Over over) {
        out.emplace_back(name + " load " + std::to_string(static_cast<int>(kind)),
                         std::make_shared<JointLoad>(JointLoad::Of{kind, name, axis}, over));
    };
    load(JointLoadKind::effort, "drive", Vector3::Zero(), Over::mean);
    load(JointLoadKind::effort, "drive", Vector3::Zero(), Over::largest);
    load(JointLoadKind::effort, "drive", Vector3::Zero(), Over::peak);
    load(JointLoadKind::force, "main", Vector3(0.6, 0.8, 0), Over::peak);
    load(JointLoadKind::force, "wrist", Vector3::Zero(), Over::end);
    load(JointLoadKind::force, "main", Vector3(0.6, 0.8, 0), Over::sum);
    load(JointLoadKind::torque, "guide", Vector3::Zero(), Over::mean);
    load(JointLoadKind::torque, "main", Vector3(0, 0.6, 0.8), Over::end);
    load(JointLoadKind::force, "pin", Vector3::Zero(), Over::least);
    return out;
}

void add_constraints(const Named& quantities, Design& design) {
    for (const auto& [name, quantity] : quantities)
        design.constraints.push_back({name + std::to_string(design.constraints.size()), {}, quantity});
}

DesignProblem problem_of(Design design) {
    auto problem = DesignProblem::create(std::move(design));
    if (!problem) UNSCOPED_INFO(problem.errors()[0].where << ": " << problem.errors()[0].message);
    REQUIRE(problem);
    return std::move(problem).value();
}

}  // namespace

namespace {

// The momentum of the bodies' centres at the end, component by component.
Vector3 momentum_of(const description::Simulated& s) {
    Vector3 sum = Vector3::Zero();
    for (size_t i = 0; i < s.model.bodies.size(); ++i)
        for (const Vector3& axis : {x_axis, y_axis, z_axis}) {
            const MarkerSpeed speed({static_cast<int>(i), s.model.bodies[i].reference_point, axis}, Over::end);
            sum += s.model.bodies[i].moments(3, 3) * speed.value(s).value * axis;
        }
    return sum;
}

}  // namespace

TEST_CASE("joint loads, efforts and energies are those that the simulation reports", "[joints]") {
    for (const Integrator integrator : {Integrator::implicit_euler, Integrator::quasi_static, Integrator::bdf2}) {
        const bool is_static = integrator == Integrator::quasi_static;
        const core::model::Model model = built(slider_crank(integrator).scene);
        const core::stepper::Simulation done = run(model, 9, true);
        const description::Simulated simulated{model, done.trajectory};
        const auto ends = [&](std::shared_ptr<const description::Quantity> quantity) { return quantity->value(simulated).value; };
        const core::stepper::StepOutputs& last = done.outputs.back();
        const auto reported = [&](const std::string& name) {
            for (const core::stepper::JointForce& force : last.joints)
                if (model.mechanism.joints[force.joint].name == name) return force;
            FAIL(name);
            return core::stepper::JointForce{};
        };
        const auto load = [&](JointLoadKind kind, const std::string& name, const Vector3& axis) {
            return ends(std::make_shared<JointLoad>(JointLoad::Of{kind, name, axis}, Over::end));
        };
        CAPTURE(static_cast<int>(integrator));
        for (const std::string name : {"main", "pin", "wrist", "guide"}) {
            const core::stepper::JointForce force = reported(name);
            CHECK(load(JointLoadKind::force, name, Vector3::Zero()) == Approx(force.force.norm()).epsilon(1e-8));
            CHECK(load(JointLoadKind::torque, name, Vector3::Zero()) == Approx(force.torque.norm()).epsilon(1e-7).margin(1e-9));
            CHECK(load(JointLoadKind::force, name, y_axis) == Approx(force.force.y()).epsilon(1e-8).margin(1e-9));
        }
        CHECK(load(JointLoadKind::effort, "drive", Vector3::Zero()) == Approx(reported("drive").effort).epsilon(1e-8));
        CHECK(std::abs(reported("drive").effort) > 1e-3);
        const auto energy = [&](EnergyKind kind) { return ends(std::make_shared<Energy>(kind, Over::end)); };
        CHECK(energy(EnergyKind::potential) == Approx(last.potential_energy).epsilon(1e-12));
        CHECK(energy(EnergyKind::spring) == Approx(last.spring_energy).epsilon(1e-9));
        if (!is_static) CHECK(energy(EnergyKind::kinetic) == Approx(last.kinetic_energy).epsilon(1e-12));
        if (!is_static) CHECK((momentum_of(simulated) - last.linear_momentum).norm() < 1e-12 * (1 + last.linear_momentum.norm()));
        const double kinetic = is_static ? 0 : last.kinetic_energy;
        CHECK(energy(EnergyKind::total) == Approx(kinetic + last.potential_energy + last.spring_energy).epsilon(1e-9));
    }
}

TEST_CASE("the peak is the largest absolute value, of whichever sign") {
    const core::model::Model model = built(slider_crank(Integrator::implicit_euler).scene);
    const core::stepper::Simulation done = run(model, 9, true);
    const description::Simulated simulated{model, done.trajectory};
    int of_the_least = 0;
    for (const Vector3& axis : {x_axis, Vector3(-x_axis), y_axis, Vector3(-y_axis), Vector3(0.6, 0.8, 0)}) {
        const auto load = [&](Over over) { return JointLoad({JointLoadKind::force, "main", axis}, over).value(simulated).value; };
        CHECK(load(Over::peak) == std::max(load(Over::largest), -load(Over::least)));
        CHECK(load(Over::peak) > 0);
        of_the_least += load(Over::peak) == -load(Over::least) ? 1 : 0;
    }
    CHECK(of_the_least >= 2);  // of x and -x, and of y and -y, one each
    const JointLoad with_axis({JointLoadKind::force, "main", x_axis}, Over::peak), magnitude({JointLoadKind::force, "main"}, Over::peak);
    CHECK(with_axis.has_direction());
    CHECK_FALSE(magnitude.has_direction());
    CHECK(JointLoad({JointLoadKind::effort, "drive"}, Over::peak).has_direction());
}

TEST_CASE("energies of Newmark's steps are those that the simulation reports", "[joints]") {
    const core::model::Model model = built(sprung_bars().scene);
    const core::stepper::Simulation done = run(model, 9, true);
    const description::Simulated simulated{model, done.trajectory};
    const auto energy = [&](EnergyKind kind, Over over) { return Energy(kind, over).value(simulated).value; };
    const core::stepper::StepOutputs& last = done.outputs.back();
    CHECK(energy(EnergyKind::kinetic, Over::end) == Approx(last.kinetic_energy).epsilon(1e-12));
    CHECK(energy(EnergyKind::spring, Over::end) == Approx(last.spring_energy).epsilon(1e-9));
    double sum = 0;
    for (const core::stepper::StepOutputs& o : done.outputs) sum += o.kinetic_energy;
    CHECK(energy(EnergyKind::kinetic, Over::sum) == Approx(sum).epsilon(1e-12));
    CHECK((momentum_of(simulated) - last.linear_momentum).norm() < 1e-12);
}

namespace {

// Checks the derivatives of all constraints in all parameters, by differences of designs at the start.
void check_derivatives(const DesignProblem& problem, double tolerance) {
    const VectorX start = VectorX::Zero(problem.parameter_count());
    const problem::DesignEvaluation at = problem.evaluate(start);
    INFO(at.reason);
    REQUIRE(at.usable);
    const auto values = [&](const VectorX& p) {
        const problem::DesignEvaluation there = problem.evaluate(p, {false, {}, {}});
        INFO(there.reason);
        REQUIRE(there.usable);
        VectorX out(there.constraints.size());
        for (Eigen::Index i = 0; i < out.size(); ++i) out[i] = there.constraints[i].value;
        return out;
    };
    for (Eigen::Index k = 0; k < start.size(); ++k) {
        VectorX least = VectorX::Constant(at.jacobian.rows(), INFINITY);
        for (const double s : {1e-2, 3e-3, 1e-3, 3e-4}) {
            VectorX step = VectorX::Zero(start.size());
            step[k] = s;
            const VectorX coarse = (values(step) - values(-step)) / (2 * s), fine = (values(0.5 * step) - values(-0.5 * step)) / s;
            least = least.cwiseMin(((4 * fine - coarse) / 3 - at.jacobian.col(k)).cwiseAbs());
        }
        for (Eigen::Index i = 0; i < least.size(); ++i) {
            const double size = std::max(std::abs(at.jacobian(i, k)), 1e-3 * at.jacobian.row(i).lpNorm<Eigen::Infinity>());
            CAPTURE(problem.design().constraints[i].name, k, at.jacobian(i, k), least[i]);
            CHECK(least[i] <= tolerance * size);
        }
    }
}

}  // namespace

TEST_CASE("joint loads, efforts and energies have the derivatives of their differences", "[joints]") {
    for (const Integrator integrator : {Integrator::implicit_euler, Integrator::quasi_static, Integrator::bdf2}) {
        CAPTURE(static_cast<int>(integrator));
        Design design = slider_crank(integrator);
        add_parameters(design);
        add_constraints(quantities_of(integrator == Integrator::quasi_static), design);
        check_derivatives(problem_of(std::move(design)), 1e-6);
    }
}

TEST_CASE("energies of Newmark's steps have the derivatives of their differences", "[joints]") {
    Design design = sprung_bars();
    const core::scene::Body &one = design.scene.bodies[0], &two = design.scene.bodies[1];
    add_parameter(design, "/springs/0/stiffness", 3, 7);
    add_parameter(design, "/springs/1/rest", 0.1, 0.8);
    add_parameter(design, "/springs/0/damping", 0.1, 0.3);
    add_vector(design, "/springs/0/point_b", y_axis, 0.02, Vector3::Zero());
    add_vector(design, "/loads/0/force", y_axis, 0.1, Vector3(0, 0.2, 0));
    add_parameter(design, "/bodies/1/density", 300, 1000);
    add_vector(design, "/gravity", z_axis, 1, Vector3(0, 0, -0.5));
    add_vector(design, "/bodies/1/turn", Vector3(1, 2, 0), 0.1);
    add_vector(design, "/bodies/0/position", y_axis, 0.01);
    add_vector(design, "/bodies/1/linear_velocity", x_axis, 0.1, two.linear_velocity);
    add_vector(design, "/bodies/0/angular_velocity", Vector3(1, 0, 1), 1, one.angular_velocity);
    add_vector(design, "/bodies/1/torque", z_axis, 0.003);
    add_constraints(energies(false, 1, Over::mean), design);
    add_constraints(energies(false, 0, Over::end), design);
    check_derivatives(problem_of(std::move(design)), 1e-6);
}

namespace {

// A lever that hangs on an axle with a spring, friction and a stop that it lies against, and whose length is a parameter.
Design turning_lever(bool area_weighted) {
    const auto shape = shapes::FilePart::create("box", {{"size_x", 0.3}, {"size_y", 0.02}, {"size_z", 0.02}});
    REQUIRE(shape);
    Design design;
    design.scene = scene_of({}, 0.01);
    design.scene.gravity = Vector3(0, 0.4, -9.81);
    design.scene.dhat = 2e-3;
    design.scene.area_weighted = area_weighted;
    design.steps = 4;  // still on its way to rest
    core::scene::Body lever;
    lever.name = "lever";
    lever.group = 0;
    lever.pose.position = Vector3(0.15, 0, 0);
    REQUIRE(description::add_part(design, lever, *shape));
    core::scene::Joint axle = joint("axle", JointKind::revolute, {"", Vector3::Zero(), y_axis}, {"lever", Vector3(-0.15, 0, 0), y_axis});
    axle.forces = {3, 0.2, 0, 0.05, 0.03, std::array<double, 2>{-1.0, 0.004}};
    design.scene.mechanism.joints = {axle};
    add_parameter(design, "/bodies/0/shape/dimensions/size_x", 0.03, 0.3);
    add_parameter(design, "/bodies/0/density", 300, 1000);
    add_parameter(design, "/joints/0/limits/1", 1e-3, 0.004);
    return design;
}

}  // namespace

// A lever's spring, stops and friction turn on an axle, while the lever's own length is a parameter: what they are measured by is held.
TEST_CASE("a body that stops and friction of angles are measured by can change its size", "[joints]") {
    for (const bool area_weighted : {false, true}) {
        CAPTURE(area_weighted);
        Design design = turning_lever(area_weighted);
        add_constraints(energies(false, 0, Over::end), design);
        check_derivatives(problem_of(std::move(design)), 1e-6);
    }
}

// A block falls onto a plate and another block onto it, damped; with the three integrators that count rates.
Design falling_blocks(Integrator integrator, double mu = 0) {
    core::scene::Body plate = bar("plate", 1), lower = bar("lower", 1), upper = bar("upper", 1);
    plate.mesh = tests::support::box_mesh({-0.2, -0.2, -0.1}, {0.2, 0.2, 0});
    plate.type = core::scene::BodyType::static_body;
    for (auto& dof : plate.prescribed) dof = core::scene::MotionCurve{};
    lower.mesh = tests::support::box_mesh({-0.05, -0.04, 0}, {0.05, 0.04, 0.06});
    lower.pose = {core::kinematics::rotation({0.01, 0.02, 0.3}), {0, 0, 0.002}};
    upper.mesh = tests::support::box_mesh({-0.03, -0.03, 0}, {0.04, 0.03, 0.05});
    upper.pose = {core::kinematics::rotation({-0.02, 0.01, 0.9}), {0.005, 0, 0.0645}};
    Design design;
    design.scene = scene_of({plate, lower, upper}, 0.005);
    for (core::scene::Body& body : design.scene.bodies) body.group = -1;
    design.scene.integrator = integrator;
    design.scene.gravity = Vector3(0.3, 0, -9.81);
    design.scene.dhat = 2e-3;
    design.scene.kappa = 2e4;
    design.scene.contact_damping_time = 2e-3;
    design.scene.dmin = 3e-4;
    design.scene.friction.mu = mu;
    design.scene.friction.eps_v = 0.02;
    design.scene.friction.rounds = 3;
    design.steps = 8;
    if (mu > 0) add_parameter(design, "/friction/mu", 0.1, mu);
    add_vector(design, "/gravity", z_axis, 1, Vector3(0.3, 0, -9.81));
    add_parameter(design, "/bodies/2/density", 300, 1000);
    add_vector(design, "/bodies/1/position", z_axis, 1e-4, lower.pose.position);
    add_vector(design, "/bodies/2/turn", x_axis, 1e-2);
    add_vector(design, "/bodies/1/linear_velocity", Vector3(0, 0.6, 0.8), 0.01);
    add_parameter(design, "/contact/dmin", 1e-4, 3e-4);
    using Of = ContactForce::Of;
    const std::vector<std::pair<Of, Over>> asked{{Of{1, 0, z_axis}, Over::mean},
                                                 {Of{2, std::nullopt, Vector3::Zero()}, Over::sum},
                                                 {Of{0, 1, Vector3::Zero()}, Over::largest},
                                                 {Of{1, std::nullopt, Vector3(0, 0.6, 0.8)}, Over::mean},
                                                 {Of{1, std::nullopt, Vector3::Zero(), Vector3(0.02, 0, 0)}, Over::mean},
                                                 {Of{2, 1, y_axis, Vector3(0, 0.01, 0.03)}, Over::sum}};
    for (const auto& [of, over] : asked)
        design.constraints.push_back({"force " + std::to_string(design.constraints.size()), {}, std::make_shared<ContactForce>(of, over)});
    return design;
}

TEST_CASE("forces of contact have the derivatives of their differences", "[contact]") {
    for (const Integrator integrator : {Integrator::implicit_euler, Integrator::bdf2, Integrator::newmark})
        for (const double mu : {0.0, 0.3}) {
            CAPTURE(static_cast<int>(integrator), mu);
            const DesignProblem problem = problem_of(falling_blocks(integrator, mu));
            const problem::DesignEvaluation at = problem.evaluate(VectorX::Zero(problem.parameter_count()), {false, {}, {}});
            REQUIRE(at.usable);
            for (const description::Measurement& force : at.constraints) CHECK(std::abs(force.value) > 1e-3);
            check_derivatives(problem, 1e-5);
        }
}

TEST_CASE("forces of contact that cannot be are refused by name", "[contact]") {
    core::scene::Scene scene = falling_blocks(Integrator::implicit_euler).scene;
    const auto message = [&](const ContactForce::Of& of) {
        const Errors errors = ContactForce(of, Over::end).check(built(scene), 3);
        return errors.empty() ? std::string() : errors[0].message;
    };
    CHECK(message({1, 2, Vector3::Zero()}).empty());
    CHECK_FALSE(message({3, 1, Vector3::Zero()}).empty());
    scene.bodies[1].group = scene.bodies[2].group = 4;
    CHECK(message({1, 2, Vector3::Zero()}).find("never collide") != std::string::npos);
    scene.friction.mu = 0.3;
    CHECK(message({1, std::nullopt, Vector3::Zero()}).empty());
}

TEST_CASE("quantities of steps that cannot be are refused by name", "[joints]") {
    const core::model::Model model = built(slider_crank(Integrator::quasi_static).scene);
    const auto message = [&](const description::Quantity& quantity, int steps) {
        const Errors errors = quantity.check(model, steps);
        return errors.empty() ? std::string() : errors[0].message;
    };
    CHECK(message(Energy(EnergyKind::kinetic, Over::end), 3).find("no kinetic energy") != std::string::npos);
    CHECK(message(MarkerSpeed({1, x_axis, x_axis}, Over::end), 3).find("has no velocities") != std::string::npos);
    CHECK(message(MarkerSpeed({7, x_axis, x_axis}, Over::end), 3).find("7") != std::string::npos);
    CHECK(message(Energy(EnergyKind::total, Over::end), 0).find("needs a step") != std::string::npos);
    CHECK(message(JointLoad({JointLoadKind::force, "nothing"}, Over::end), 3).find("no joint `nothing`") != std::string::npos);
    CHECK(message(JointLoad({JointLoadKind::effort, "main"}, Over::end), 3).find("no motor `main`") != std::string::npos);
    CHECK(message(JointLoad({JointLoadKind::effort, "drive"}, Over::end), 3).empty());
}

}  // namespace fettle::design::quantities::step_series_test
