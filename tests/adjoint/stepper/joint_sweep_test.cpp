// SPDX-License-Identifier: MIT
// Joints, springs, motors backwards and forwards: the two sweeps against each other, and against central differences of simulations.
#include <catch2/catch.hpp>

#include "adjoint/stepper/reverse_sweep.hpp"
#include "adjoint/stepper/row_multipliers.hpp"
#include "adjoint/stepper/tangent_sweep.hpp"
#include "tests/adjoint/stepper/sweep_scenes.hpp"
#include "tests/support/line_check.hpp"
#include "tests/support/mechanisms.hpp"

namespace fettle::adjoint::stepper::joint_sweep_test {

using namespace fettle::tests::adjoint;
using namespace fettle::tests::mechanisms;
using core::scene::Integrator;
using core::scene::JointKind;

namespace {

const Vector3 x_axis = Vector3::UnitX(), y_axis = Vector3::UnitY(), z_axis = Vector3::UnitZ();

core::scene::Curve values(core::scene::CurveKind kind, std::vector<double> times, std::vector<double> at) {
    core::scene::Curve curve;
    curve.kind = kind;
    curve.times = std::move(times);
    curve.values = std::move(at);
    return curve;
}

SweepScene sweep(const std::string& name, const core::scene::Scene& scene, int steps) { return {name, built(scene), steps}; }

// Two links, a hinge with everything that acts on one, a ball joint, a spring across, a load, a torque.
SweepScene arm(Integrator integrator = Integrator::implicit_euler) {
    core::scene::Scene scene = scene_of({bar("upper", 0.3), bar("lower", 0.25, Vector3(0.3, 0, 0), Vector3(0, 0.3, 0.4))}, 0.01);
    scene.gravity = Vector3(0, 0.4, -9.81);
    scene.integrator = integrator;
    scene.bodies[1].angular_velocity = Vector3(1, 2, 3);
    core::scene::Joint hinge = joint("hinge", JointKind::revolute, {"", Vector3::Zero(), y_axis}, {"upper", Vector3::Zero(), y_axis});
    hinge.forces = {3, 0.2, 0, 0.05, 0.03, std::array<double, 2>{-1.0, 0.004}};  // the stop acts from the start
    scene.dhat = 2e-3;
    scene.mechanism.joints = {hinge,
                              joint("ball", JointKind::ball, {"upper", Vector3(0.3, 0, 0), z_axis}, {"lower", Vector3::Zero(), z_axis})};
    core::scene::Spring across;
    across.name = "across";
    across.a = {"", Vector3(0.1, 0.2, 0.4), z_axis};
    across.b = {"lower", Vector3(0.2, 0, 0), z_axis};
    across.forces.stiffness = 40;
    across.forces.rest = 0.2;
    across.forces.damping = 0.6;
    scene.mechanism.springs = {across};
    scene.mechanism.loads = {{"load", "", "lower", Vector3(0.25, 0, 0), Vector3(1, -2, 0.5)}};
    core::scene::Motor torque =
        motor("torque", "hinge", values(core::scene::CurveKind::control_points, {0, 0.2}, {0.1, -0.4, 0.7, 0.2, -0.3}));
    torque.kind = core::scene::MotorKind::effort;
    scene.mechanism.motors = {torque};
    return sweep(integrator == Integrator::bdf2 ? "arm, BDF2" : "arm", scene, 12);
}

SweepScene loose_bars(Integrator integrator) {
    core::scene::Scene scene = loose_bars_scene();
    scene.integrator = integrator;
    return sweep(integrator == Integrator::bdf2 ? "loose bars, BDF2" : "loose bars, Newmark", scene, 12);
}

// A spatial four-bar: hinge, two balls, hinge; its crank driven by a curve.
SweepScene spatial_four_bar(Integrator integrator = Integrator::implicit_euler) {
    const Vector3 a(0.1, 0, 0), b(0.35, 0.2, 0.05), o(0.35, -0.05, 0.05);
    core::scene::Scene scene =
        scene_of({bar("crank", 0.1), bar("coupler", 0.33, a, Vector3(0, -0.15, 0.68)), bar("rocker", 0.25, o, Vector3(0, 0, 1.57))}, 0.01);
    scene.gravity = Vector3(0.3, -9.81, 0.2);
    scene.integrator = integrator;
    const double coupler = (b - a).norm();
    scene.mechanism.joints = {
        joint("O", JointKind::revolute, {"", Vector3::Zero(), z_axis}, {"crank", Vector3::Zero(), z_axis}),
        joint("A", JointKind::ball, {"crank", Vector3(0.1, 0, 0), z_axis}, {"coupler", Vector3::Zero(), z_axis}),
        joint("B", JointKind::ball, {"coupler", Vector3(coupler, 0, 0), z_axis}, {"rocker", Vector3(0.25, 0, 0), z_axis}),
        joint("C", JointKind::revolute, {"", o, Vector3(0.1, 0, 1)}, {"rocker", Vector3::Zero(), Vector3(0.1, 0, 1)})};
    scene.mechanism.motors = {motor("drive", "O", values(core::scene::CurveKind::cubic, {0, 0.1, 0.2}, {0, 0.9, 2.2}))};
    return sweep(integrator == Integrator::bdf2 ? "spatial four-bar, BDF2" : "spatial four-bar", scene, 15);
}

// Crank, rod between balls, slider; quasi-static, with a load and a spring.
SweepScene slider_crank() {
    core::scene::Scene scene = slider_crank_scene();
    scene.integrator = Integrator::quasi_static;
    scene.gravity = Vector3(0, -9.81, 0);
    core::scene::Spring back;
    back.name = "back";
    back.joint = "guide";
    back.forces.stiffness = 500;
    back.forces.rest = 0.03;
    back.forces.friction = 0.4;
    scene.mechanism.springs = {back};
    scene.mechanism.motors = {motor("drive", "main", values(core::scene::CurveKind::trapezoid, {0, 0.2}, {0, 1.9}))};
    scene.mechanism.motors[0].curve.rate = 0.7;
    return sweep("slider-crank", scene, 9);
}

// Gears, rack, screw, prismatic and planar joints; one of the wheels is on a body that is driven about the world.
SweepScene wheels(Integrator integrator = Integrator::implicit_euler) {
    core::scene::Scene scene =
        scene_of({bar("carrier", 0.4), bar("first", 0.1, Vector3(0.05, 0, 0.05)), bar("second", 0.1, Vector3(0.3, 0, 0.05)),
                  bar("rack", 0.1, Vector3(0, 0.2, 0)), bar("nut", 0.1, Vector3(0, 0, 0.3)), bar("puck", 0.1, Vector3(0.1, 0.1, 0.3)),
                  bar("jaw", 0.1, Vector3(0, 0.4, 0))},
                 0.01);
    scene.bodies[0].type = core::scene::BodyType::kinematic_body;
    for (auto& dof : scene.bodies[0].prescribed) dof = core::scene::MotionCurve{};
    scene.bodies[0].prescribed[5]->rate = 3;
    scene.bodies[0].prescribed[0]->rate = 0.2;
    scene.gravity = Vector3(1, 0, -9.81);
    scene.integrator = integrator;
    scene.mechanism.joints = {
        joint("one", JointKind::revolute, {"carrier", Vector3(0.05, 0, 0.05), z_axis}, {"first", Vector3::Zero(), z_axis}),
        joint("two", JointKind::revolute, {"carrier", Vector3(0.3, 0, 0.05), z_axis}, {"second", Vector3::Zero(), z_axis}),
        joint("slide", JointKind::prismatic, {"", Vector3(0, 0.2, 0), x_axis}, {"rack", Vector3::Zero(), x_axis}),
        joint("thread", JointKind::screw, {"", Vector3(0, 0, 0.3), x_axis}, {"nut", Vector3::Zero(), x_axis}),
        joint("table", JointKind::planar, {"nut", Vector3(0, 0, 0), z_axis}, {"puck", Vector3(-0.1, -0.1, 0), z_axis}),
        joint("other slide", JointKind::prismatic, {"", Vector3(0, 0.4, 0), z_axis}, {"jaw", Vector3::Zero(), z_axis})};
    scene.mechanism.joints[3].pitch = 0.05;
    for (const auto& [name, kind, first, second, ratio] :
         {std::tuple("gear", JointKind::gear, "one", "two", -0.6), std::tuple("pinion", JointKind::rack, "one", "slide", 0.03),
          std::tuple("jaws", JointKind::gear, "slide", "other slide", -0.5)}) {
        core::scene::Joint coupling = joint(name, kind, {}, {});
        coupling.of = {first, second};
        coupling.ratio = ratio;
        scene.mechanism.joints.push_back(coupling);
    }
    scene.mechanism.joints[1].forces.damping = 0.01;
    return sweep(integrator == Integrator::bdf2 ? "wheels, BDF2" : "wheels", scene, 10);
}

// A bar fixed to one that is hinged, under a load at its tip.
SweepScene welded() {
    core::scene::Scene scene = scene_of({bar("arm", 0.3), bar("tip", 0.2, Vector3(0.3, 0, 0), Vector3(0.2, 0.4, 0.1))}, 0.01);
    scene.gravity = Vector3(0.2, 0.4, -9.81);
    scene.mechanism.joints = {
        joint("hinge", JointKind::revolute, {"", Vector3::Zero(), Vector3(0.1, 1, 0)}, {"arm", Vector3::Zero(), Vector3(0.1, 1, 0)}),
        joint("weld", JointKind::fixed, {"arm", Vector3(0.3, 0, 0), z_axis}, {"tip", Vector3::Zero(), z_axis})};
    scene.mechanism.loads = {{"load", "", "tip", Vector3(0.2, 0.01, 0), Vector3(1, -2, 0.5)}};
    return sweep("welded", scene, 12);
}

// A hinged bar falls on a block that lies on the plate.
SweepScene hinged_contact() {
    core::scene::Scene scene =
        scene_of({bar("bar", 0.3, Vector3(0, 0, 0.08)), bar("block", 0.08, Vector3(0.2, 0.02, 0.036), Vector3(0, 0, 0.6)),
                  bar("floor", 1, Vector3(-0.5, 0, -0.5), Vector3::Zero(), 0.5)},
                 0.005);
    for (core::scene::Body& body : scene.bodies) body.group = -1;
    scene.bodies[1].mesh = fettle::tests::support::box_mesh(Vector3(-0.04, -0.04, -0.03), Vector3(0.04, 0.04, 0.03));
    scene.bodies[2].type = core::scene::BodyType::static_body;
    scene.gravity = Vector3(0, 0.1, -9.81);
    scene.dhat = 0.01;
    scene.mechanism.joints = {joint("hinge", JointKind::revolute, {"", Vector3(0, 0, 0.08), y_axis}, {"bar", Vector3::Zero(), y_axis})};
    return sweep("hinged contact", scene, 20);
}

// A slide whose spring presses it squarely onto a wall, with nothing else that pushes: all forces on it cancel to rounding.
SweepScene plunger() {
    core::scene::Scene scene = scene_of({bar("plunger", 0.05), bar("wall", 0.1, Vector3(-0.101, 0, 0), Vector3::Zero(), 0.03)}, 0.01);
    for (core::scene::Body& body : scene.bodies) body.group = -1;
    scene.bodies[1].type = core::scene::BodyType::static_body;
    scene.integrator = Integrator::quasi_static;
    scene.dhat = 2e-3;
    scene.kappa = 5000;
    scene.mechanism.joints = {joint("slide", JointKind::prismatic, {"", Vector3::Zero(), x_axis}, {"plunger", Vector3::Zero(), x_axis})};
    scene.mechanism.joints[0].forces.stiffness = 500;
    scene.mechanism.joints[0].forces.preload = 1;
    return sweep("plunger", scene, 3);
}

std::vector<SweepScene> joint_scenes() {
    return {arm(),
            arm(Integrator::bdf2),
            loose_bars(Integrator::bdf2),
            loose_bars(Integrator::newmark),
            spatial_four_bar(),
            spatial_four_bar(Integrator::bdf2),
            slider_crank(),
            wheels(),
            wheels(Integrator::bdf2),
            welded(),
            hinged_contact(),
            rubbed(hinged_contact())};
}

core::stepper::Trajectory trajectory_of(const SweepScene& scene) { return run(scene.model, scene.steps, true).trajectory; }

// A random direction in everything that the mechanism has.
ModelTangent mechanism_direction(const SweepScene& scene, std::mt19937_64& random) {
    std::uniform_real_distribution<double> unit(-1, 1);
    ModelTangent d = fettle::adjoint::zero_model_tangent(scene.model, scene.steps);
    MechanismTangent& m = d.mechanism;
    for (auto& frame : m.frames) {
        for (int k = 0; k < 3; ++k) frame.point[k] = 0.02 * unit(random);
        for (int k = 0; k < 9; ++k) frame.axes.reshaped()[k] = 0.05 * unit(random);
    }
    for (std::size_t k = 0; k < m.term_coefficient.size(); ++k) {
        const core::model::MeasureTerm& term = scene.model.mechanism.terms[k];
        m.term_coefficient[k] = 0.3 * term.coefficient * unit(random);
        if (term.kind == core::model::LawKind::spring) m.term_reference[k] = 0.05 * unit(random);
        if (term.kind == core::model::LawKind::stop) m.term_reference[k] = 1e-3 * unit(random);
        for (double& v : m.term_values[k]) v = 0.3 * unit(random);
        if (term.kind == core::model::LawKind::force) m.term_rate[k] = 0.3 * unit(random);
    }
    for (std::size_t i = 0; i < m.row_constant.size(); ++i) {
        m.row_constant[i] = 0.01 * unit(random);
        for (double& v : m.row_values[i]) v = 0.1 * unit(random);
        m.row_rate[i] = 0.02 * unit(random);
        if (m.row_factors[i].size() > 1)
            for (double& v : m.row_factors[i]) v = 0.01 * unit(random);
    }
    return d;
}

core::model::Model with_mechanism(core::model::Model model, const MechanismTangent& d, double s) {
    core::model::Mechanism& m = model.mechanism;
    for (std::size_t i = 0; i < m.set.frames.size(); ++i) {
        m.set.frames[i].point += s * d.frames[i].point;
        m.set.frames[i].axes += s * d.frames[i].axes;
    }
    for (std::size_t k = 0; k < m.terms.size(); ++k) {
        m.terms[k].coefficient += s * d.term_coefficient[k];
        m.terms[k].reference += s * d.term_reference[k];
        m.terms[k].curve.rate += s * d.term_rate[k];
        for (std::size_t i = 0; i < m.terms[k].curve.values.size(); ++i) m.terms[k].curve.values[i] += s * d.term_values[k][i];
    }
    for (auto* rows : {&m.rows, &m.dependent})
        for (core::constraint::Row& row : *rows) {
            row.constant += s * d.row_constant[row.number];
            row.curve.rate += s * d.row_rate[row.number];
            for (std::size_t k = 0; k < row.parts.size(); ++k) row.parts[k].factor += s * d.row_factors[row.number][k];
            for (std::size_t k = 0; k < row.curve.values.size(); ++k) row.curve.values[k] += s * d.row_values[row.number][k];
        }
    return model;
}

double mechanism_pairing(const MechanismGradient& bar, const MechanismTangent& dot) {
    double sum = 0;
    for (std::size_t i = 0; i < dot.frames.size(); ++i)
        sum += bar.frames[i].point.dot(dot.frames[i].point) + bar.frames[i].axes.cwiseProduct(dot.frames[i].axes).sum();
    for (std::size_t k = 0; k < dot.term_coefficient.size(); ++k) {
        sum += bar.term_coefficient[k] * dot.term_coefficient[k] + bar.term_reference[k] * dot.term_reference[k];
        sum += bar.term_rate[k] * dot.term_rate[k];
        for (std::size_t i = 0; i < dot.term_values[k].size(); ++i) sum += bar.term_values[k][i] * dot.term_values[k][i];
    }
    for (std::size_t i = 0; i < dot.row_constant.size(); ++i) {
        sum += bar.row_constant[i] * dot.row_constant[i] + bar.row_rate[i] * dot.row_rate[i];
        for (std::size_t k = 0; k < dot.row_factors[i].size(); ++k) sum += bar.row_factors[i][k] * dot.row_factors[i][k];
        for (std::size_t k = 0; k < dot.row_values[i].size(); ++k) sum += bar.row_values[i][k] * dot.row_values[i][k];
    }
    return sum;
}

// The least relative error over steps of differences.
template <class At>
double difference_error(const At& at, double derivative) {
    double least = INFINITY;
    for (const double s : {1e-3, 3e-4, 1e-4, 3e-5, 1e-5, 3e-6}) {  // below 1e-5 what is flat counts as flat still
        const double difference = (at(s) - at(-s)) / (2 * s), finer = (at(s / 2) - at(-s / 2)) / s;
        const double extrapolated = (4 * finer - difference) / 3;
        least = std::min(least, std::abs(extrapolated - derivative) / std::abs(derivative));
    }
    return least;
}

// Multipliers of all rows and steps, weighted; large where forces are: of the size of what they carry.
std::vector<VectorX> multiplier_weights(const std::vector<VectorX>& multipliers, std::mt19937_64& random) {
    std::uniform_real_distribution<double> unit(-1, 1);
    double size = 0;
    for (const VectorX& m : multipliers) size = std::max(size, m.lpNorm<Eigen::Infinity>());
    std::vector<VectorX> out;
    for (const VectorX& m : multipliers) {
        out.push_back(VectorX(m.size()));
        for (double& w : out.back()) w = unit(random) / size;
    }
    return out;
}

double weighted(const std::vector<VectorX>& weights, const std::vector<VectorX>& multipliers) {
    double sum = 0;
    for (std::size_t t = 0; t < weights.size(); ++t) sum += weights[t].dot(multipliers[t]);
    return sum;
}

}  // namespace

TEST_CASE("joints, springs and motors, and what they carry: backwards, forwards and differences agree", "[adjoint][joints]") {
    for (const SweepScene& scene : joint_scenes()) {
        const core::stepper::Trajectory trajectory = trajectory_of(scene);
        std::mt19937_64 random(31);
        TrajectoryGradient seed = random_seed(scene, random);
        if (!scene.model.mechanism.rows.empty()) seed.multiplier_bar = multiplier_weights(row_multipliers(scene.model, trajectory), random);
        const auto gradients = reverse_sweep(scene.model, trajectory, {seed});
        REQUIRE(gradients);
        const auto check = [&](const ModelTangent& direction, const auto& at_model, const std::string& what) {
            StepTangents within;
            const auto tangents = tangent_sweep(scene.model, trajectory, direction, &within);
            REQUIRE(tangents);
            const double backwards =
                pairing(scene, (*gradients)[0], direction) + mechanism_pairing((*gradients)[0].mechanism, direction.mechanism);
            const double forwards = pairing(seed, trajectory, *tangents) + weighted(seed.multiplier_bar, within.multipliers);
            const auto at = [&](double s) {
                const core::model::Model model = at_model(s);
                const core::stepper::Trajectory there = run(model, scene.steps, true).trajectory;
                return objective(seed, there) + weighted(seed.multiplier_bar, row_multipliers(model, there));
            };
            const double error = difference_error(at, forwards);
            CAPTURE(scene.name, what, backwards, forwards, error);
            CHECK(std::abs(backwards - forwards) <= 1e-9 * std::abs(forwards));
            CHECK(error < 1e-6);
        };
        const ModelTangent mechanism = mechanism_direction(scene, random);
        check(
            mechanism, [&](double s) { return with_mechanism(scene.model, mechanism.mechanism, s); }, "mechanism");
        for (const ParameterKind kind :
             {ParameterKind::vertices, ParameterKind::pose_start, ParameterKind::gravity, ParameterKind::density}) {
            const ModelTangent direction = random_direction(scene, kind, random);
            check(
                direction, [&](double s) { return moved(scene, direction, s); }, to_string(kind));
        }
    }
}

TEST_CASE("joints, springs and motors: backwards and forwards agree", "[adjoint][joints]") {
    for (const SweepScene& scene : joint_scenes()) {
        const core::stepper::Trajectory trajectory = trajectory_of(scene);
        REQUIRE(scene.model.mechanism.dependent.empty());
        std::mt19937_64 random(23);
        const std::vector<TrajectoryGradient> seeds{random_seed(scene, random), random_seed(scene, random)};
        const auto gradients = reverse_sweep(scene.model, trajectory, seeds);
        REQUIRE(gradients);
        constexpr double nothing = 1e-12;  // of what a driven linkage does not hang on: objectives are of size 1
        const auto compare = [&](const ModelTangent& direction, const std::string& what) {
            const auto tangents = tangent_sweep(scene.model, trajectory, direction);
            REQUIRE(tangents);
            for (int s = 0; s < 2; ++s) {
                const double backwards =
                    pairing(scene, (*gradients)[s], direction) + mechanism_pairing((*gradients)[s].mechanism, direction.mechanism);
                const double forwards = pairing(seeds[s], trajectory, *tangents);
                CAPTURE(scene.name, what, backwards, forwards);
                CHECK(std::abs(backwards - forwards) <= 1e-9 * std::abs(forwards) + nothing);
            }
        };
        for (const ParameterKind kind : kinds_of(scene)) compare(random_direction(scene, kind, random), to_string(kind));
        for (int trial = 0; trial < 3; ++trial) compare(mechanism_direction(scene, random), "mechanism");
    }
}

TEST_CASE("forces that cancel squarely are no imbalance", "[adjoint][joints]") {
    const SweepScene scene = plunger();
    const core::stepper::Trajectory trajectory = trajectory_of(scene);
    std::mt19937_64 random(43);
    const TrajectoryGradient seed = random_seed(scene, random);
    const auto gradients = reverse_sweep(scene.model, trajectory, {seed});
    if (!gradients) UNSCOPED_INFO(gradients.errors()[0].message);
    REQUIRE(gradients);
    for (const bool is_stiffness : {true, false}) {
        ModelTangent direction = fettle::adjoint::zero_model_tangent(scene.model, scene.steps);
        (is_stiffness ? direction.mechanism.term_coefficient[0] : direction.mechanism.term_reference[0]) = is_stiffness ? 100 : 1e-3;
        const double derivative = mechanism_pairing((*gradients)[0].mechanism, direction.mechanism);
        const auto at = [&](double s) {
            return objective(seed, run(with_mechanism(scene.model, direction.mechanism, s), scene.steps, true).trajectory);
        };
        const double error = difference_error(at, derivative);
        CAPTURE(is_stiffness, derivative);
        CHECK(std::abs(derivative) > 1e-6);
        CHECK(error < 1e-6);
    }
}

// As in sweep_matrix_test: scalars and directions at random until one tells, and all that are looked at right.
TEST_CASE("joints, springs and motors: Taylor's remainder", "[adjoint][joints][slow]") {
    constexpr int most = 6;
    for (const SweepScene& scene : joint_scenes()) {
        const core::stepper::Trajectory trajectory = trajectory_of(scene);
        std::mt19937_64 random(37);
        std::vector<TrajectoryGradient> seeds;
        for (int k = 0; k < most; ++k) seeds.push_back(random_seed(scene, random));
        const auto gradients = reverse_sweep(scene.model, trajectory, seeds);
        REQUIRE(gradients);
        // @param look  k -> the check of the k-th scalar along a direction of its own
        const auto check = [&](const std::string& what, const auto& look) {
            bool tells = false;
            for (int k = 0; k < most && !tells; ++k) {
                const tests::support::LineCheck line = look(static_cast<std::size_t>(k));
                CAPTURE(scene.name, what, k, line.difference, line.relative_error, line.slope);
                CHECK(line.is_right());
                tells = line.tells;
            }
            CAPTURE(scene.name, what);
            CHECK(tells);
        };
        const auto change = [&](std::size_t k, const core::model::Model& model) {
            const core::stepper::Simulation there = run(model, scene.steps, true);
            const bool ok = there.report.status == core::stepper::SimulationStatus::ok;
            return ok ? objective_change(seeds[k], trajectory, there.trajectory) : std::numeric_limits<double>::quiet_NaN();
        };
        check("mechanism", [&](std::size_t k) {
            const ModelTangent direction = mechanism_direction(scene, random);
            return tests::support::check_line([&](double s) { return change(k, with_mechanism(scene.model, direction.mechanism, s)); },
                                              mechanism_pairing((*gradients)[k].mechanism, direction.mechanism), {1e-2, 6});
        });
        for (const ParameterKind kind : {ParameterKind::gravity, ParameterKind::density}) {
            if (std::abs(pairing(scene, (*gradients)[0], random_direction(scene, kind, random))) < 1e-9) continue;
            check(to_string(kind), [&](std::size_t k) {
                const ModelTangent direction = random_direction(scene, kind, random);
                return tests::support::check_line([&](double s) { return change(k, moved(scene, direction, s)); },
                                                  pairing(scene, (*gradients)[k], direction));
            });
        }
    }
}

TEST_CASE("a step that does not meet its joints has no derivative", "[adjoint][joints]") {
    const SweepScene scene = arm();
    core::stepper::Trajectory trajectory = trajectory_of(scene);
    std::mt19937_64 random(41);
    const std::vector<TrajectoryGradient> seeds{random_seed(scene, random)};
    REQUIRE(reverse_sweep(scene.model, trajectory, seeds));
    trajectory.poses[6][1].position.z() += 1e-9;
    trajectory.steps[5].nodes.back()[1].position.z() += 1e-9;
    const auto result = reverse_sweep(scene.model, trajectory, seeds);
    REQUIRE_FALSE(result);
    CAPTURE(result.errors()[0].message);
    CHECK(result.errors()[0].where == "step 5");
    CHECK(result.errors()[0].message.find("joints or motors are 1e-09 m from being met") != std::string::npos);
}

}  // namespace fettle::adjoint::stepper::joint_sweep_test
