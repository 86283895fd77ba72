// SPDX-License-Identifier: MIT
// The derivatives of contacts between round surfaces in shapes, poses and dmin against differences: of the barrier, of friction, and of
// whole simulations.
#include <catch2/catch.hpp>
#include <limits>
#include <random>

#include "adjoint/contact/contact_set_adjoint.hpp"
#include "adjoint/contact/friction_adjoint.hpp"
#include "adjoint/stepper/reverse_sweep.hpp"
#include "adjoint/stepper/tangent_sweep.hpp"
#include "core/contact/friction.hpp"
#include "core/model/choose_proximal_weight.hpp"
#include "core/stepper/simulate.hpp"
#include "tests/adjoint/stepper/sweep_scenes.hpp"
#include "tests/support/derivative_check.hpp"
#include "tests/support/prisms.hpp"
#include "tests/support/test_models.hpp"

namespace fettle::adjoint::contact::round_contacts_adjoint_test {

using namespace fettle::tests;
using namespace fettle::tests::adjoint;

namespace {

using core::contact::ContactSet;
using core::kinematics::Pose;
using core::model::Model;
using support::make_pose;

struct Scene {
    Model model;
    std::array<bool, 2> is_circle{};  // stays one: only moved, turned and scaled
    std::vector<Pose> lag_poses, poses;
    std::vector<Matrix34> slip_reference;
    double slip_time = 0.01;
    core::contact::BarrierParameters parameters() const {
        return core::contact::barrier_parameters(model.dhat, model.dmin, 1e4, slip_time * slip_time);
    }
};

ContactSet contacts_of(const Model& model, const std::vector<Pose>& poses) {
    return core::contact::find_contacts(model, core::ccd::find_candidates(model, poses, 0), poses);
}

int round_count(const ContactSet& set) {
    int count = 0;
    for (const auto& list : set.pairs)
        for (const auto& pair : list.contacts) count += pair.round.side != 0;
    return count;
}

// Both turned together, so that no axis is special; the first has slid since the slip references, which are no rotations.
Scene scene_of(const core::geometry::Mesh& first, const core::geometry::Mesh& second, std::array<bool, 2> is_circle, const Pose& pose,
               double dhat) {
    Scene scene;
    Model& model = scene.model;
    model.dhat = dhat;
    model.dmin = 1e-5;
    model.friction.mu.setConstant(0.6);
    model.friction.eps_v = 0.1;
    model.bodies = {support::make_body("first", first, {}), support::make_body("second", second, {})};
    support::set_round(model);
    scene.is_circle = is_circle;
    const Pose frame = make_pose({0.1, 0.2, -0.1}, {0.01, 0, 0});
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> uniform(-1, 1);
    for (const Pose& at : {pose, Pose{}}) {
        scene.lag_poses.push_back({frame.rotation * at.rotation, world_position(frame, at.position)});
        scene.slip_reference.push_back(pose_matrix(scene.lag_poses.back()) + 1e-4 * Matrix34::NullaryExpr([&] { return uniform(random); }));
    }
    scene.poses = scene.lag_poses;
    scene.poses[0].position += 2e-4 * Vector3(0.7, -0.5, 0.3);
    scene.poses[0].rotation = core::kinematics::rotation(Vector3(0.002, 0.001, -0.003)) * scene.poses[0].rotation;
    return scene;
}

double cam_radius(double angle) { return 0.02 + 2.5e-3 * std::cos(3 * angle + 0.3) + 1e-3 * std::sin(2 * angle) + 2e-4 * std::cos(angle); }

core::geometry::Mesh cam(double low, double high) { return support::prism(support::polar_outline(80, cam_radius), low, high); }
core::geometry::Mesh roller(double half) { return support::prism(support::circle_outline(24, 5e-3, 0.05), -half, half); }

// The first body pushed along a direction until the gap is so small.
Scene near(const core::geometry::Mesh& first, const core::geometry::Mesh& second, std::array<bool, 2> is_circle, const Vector3& turn,
           const Vector3& from, const Vector3& along, double target) {
    for (double way = 0;; way += 2e-5) {
        Scene scene = scene_of(first, second, is_circle, make_pose(turn, from + way * along), 1e-4);
        double least = std::numeric_limits<double>::infinity();
        for (const auto& list : contacts_of(scene.model, scene.lag_poses).pairs)
            for (const auto& pair : list.contacts) least = std::min(least, gap_of(pair));
        if (least < target || !(way < 1e-2)) return scene;
    }
}

std::vector<std::pair<std::string, Scene>> scenes() {
    const core::geometry::Mesh bored = support::plate_with_hole(support::circle_outline(32, 5.2e-3, 0.02), 4e-3, -4e-3, 4e-3);
    const core::geometry::Mesh slotted = support::plate_with_hole(support::slot_outline(12, 5.2e-3, 1e-2), 4e-3, -4e-3, 4e-3);
    const Vector3 tilt(0.004, -0.003, 0.2), in(-1, 0, 0);
    const core::geometry::Mesh box = support::box_mesh({-5e-3, -4e-3, -5e-3}, {5e-3, 4e-3, 5e-3});
    return {
        {"pin in bore", scene_of(roller(6e-3), bored, {true, true}, make_pose(tilt, {1e-4, 3e-5, 1e-3}), 1e-4)},
        {"pin in bore, far side too", scene_of(roller(6e-3), bored, {true, true}, make_pose(tilt, {2e-5, 3e-5, 1e-3}), 5e-4)},
        {"pin in bore, upside down",
         scene_of(roller(3e-3), bored, {true, true}, make_pose({std::numbers::pi - 0.003, 0.002, 0}, {1e-4, 3e-5, 1e-3}), 1e-4)},
        {"roller on circle", near(roller(4e-3), support::prism(support::circle_outline(40, 2e-2), -3e-3, 5e-3), {true, true}, tilt,
                                  {2.52e-2, 0, 1e-4}, in, 4e-5)},
        {"roller on cam", near(roller(4e-3), cam(-3e-3, 5e-3), {true, false}, tilt, {2.9e-2, 2e-3, 1e-4}, in, 4e-5)},
        {"pin in slot, longer", scene_of(roller(6e-3), slotted, {true, false}, make_pose(tilt, {2e-3, 1e-4, 1e-3}), 1e-4)},
        {"pin in slot, shorter", scene_of(roller(3e-3), slotted, {true, false}, make_pose(tilt, {2e-3, 1e-4, 5e-4}), 1e-4)},
        {"edge on roller", near(box, roller(4e-3), {false, true}, {0.004, -0.003, 0.6}, {1.14e-2, 0, 0}, in, 4e-5)},
    };
}

// Coordinates: how the columns of each body's vertices move (a circle: along x and y, turn, growth), poses as tangents, the slip
// references, dmin, mu.
struct Coordinates {
    std::array<Eigen::Index, 2> shape{}, shape_size{};
    Eigen::Index poses = 0, slip = 0, dmin = 0, mu = 0, size = 0;
    std::array<Eigen::Index, 2> columns{};

    explicit Coordinates(const Scene& scene) {
        for (std::size_t k = 0; k < 2; ++k) {
            columns[k] = columns_of(scene.model.bodies[k]).maxCoeff() + 1;
            shape[k] = size;
            shape_size[k] = scene.is_circle[k] ? 4 : 2 * columns[k];
            size += shape_size[k];
        }
        poses = size, slip = poses + 12, dmin = slip + 24, mu = dmin + 1, size = mu + 1;
    }

    // [vertex]: which line along z it is on.
    static Eigen::VectorXi columns_of(const core::model::Body& body) {
        const Matrix3X& x = body.mesh.vertices;
        Eigen::VectorXi out(x.cols());
        int count = 0;
        for (Eigen::Index v = 0; v < x.cols(); ++v) {
            out[v] = -1;
            for (Eigen::Index w = 0; w < v && out[v] < 0; ++w)
                if (x.col(v).head<2>() == x.col(w).head<2>()) out[v] = out[w];
            if (out[v] < 0) out[v] = count++;
        }
        return out;
    }

    Matrix3X vertices_dot(const Scene& scene, std::size_t k, const VectorX& d) const {
        const Matrix3X& x = scene.model.bodies[k].mesh.vertices;
        Matrix3X out = Matrix3X::Zero(3, x.cols());
        const Eigen::VectorXi column = columns_of(scene.model.bodies[k]);
        for (Eigen::Index v = 0; v < x.cols(); ++v) {
            const auto c = d.segment(shape[k], shape_size[k]);
            if (scene.is_circle[k])
                out.col(v).head<2>() << c[0] - c[2] * x(1, v) + c[3] * x(0, v), c[1] + c[2] * x(0, v) + c[3] * x(1, v);
            else
                out.col(v).head<2>() = c.segment<2>(2 * column[v]);
        }
        return out;
    }
};

Scene moved(const Scene& scene, const VectorX& d) {
    const Coordinates at(scene);
    Scene out = scene;
    for (std::size_t k = 0; k < 2; ++k) {
        out.model.bodies[k].mesh.vertices += at.vertices_dot(scene, k, d);
        support::refresh(out.model.bodies[k]);
        const auto i = static_cast<Eigen::Index>(k);
        out.lag_poses[k].position += d.segment<3>(at.poses + 6 * i);
        out.lag_poses[k].rotation = core::kinematics::rotation(d.segment<3>(at.poses + 6 * i + 3)) * out.lag_poses[k].rotation;
        out.slip_reference[k] += d.segment<12>(at.slip + 12 * i).reshaped(3, 4);
    }
    support::set_round(out.model);
    out.model.dmin += d[at.dmin];
    out.model.friction.mu.array() += d[at.mu];
    return out;
}

Matrix34 matrix_of(const Vector6& tangent, const Matrix3& rotation) {
    Matrix34 p;
    p << cross_matrix(tangent.tail<3>()) * rotation, tangent.head<3>();
    return p;
}

Vector6 tangent_of(const Matrix34& bar, const Matrix3& rotation) {
    const Matrix3 s = bar.leftCols<3>() * rotation.transpose();
    Vector6 out;
    out << bar.col(3), s(2, 1) - s(1, 2), s(0, 2) - s(2, 0), s(1, 0) - s(0, 1);
    return out;
}

// dE/dP along fixed changes of P, by core.
double along(const std::vector<core::kinematics::PoseGradient>& gradients, const std::vector<Pose>& poses,
             const std::vector<Matrix34>& motion) {
    double sum = 0;
    for (std::size_t k = 0; k < 2; ++k) {
        Matrix34 by_pose;
        by_pose << gradients[k].arm * poses[k].rotation, gradients[k].force;
        sum += by_pose.cwiseProduct(motion[k]).sum();
    }
    return sum;
}

double barrier_along(const Scene& scene, const std::vector<Matrix34>& motion) {
    std::vector<core::kinematics::PoseGradient> gradients(2);
    core::kinematics::BlockHessian hessian;
    add_barrier_derivatives(contacts_of(scene.model, scene.lag_poses), scene.lag_poses, scene.parameters(),
                            core::contact::HessianKind::none, gradients, hessian);
    return along(gradients, scene.lag_poses, motion);
}

double friction_along(const Scene& scene, const std::vector<Matrix34>& motion) {
    const auto set = lag_friction(scene.model, contacts_of(scene.model, scene.lag_poses), scene.lag_poses, scene.parameters(),
                                  scene.slip_reference, scene.slip_time);
    std::vector<core::kinematics::PoseGradient> gradients(2);
    core::kinematics::BlockHessian hessian;
    add_friction_derivatives(set, scene.poses, core::contact::HessianKind::none, gradients, hessian);
    return along(gradients, scene.poses, motion);
}

ModelTangent tangent_of(const Scene& scene, const Coordinates& at, const VectorX& d) {
    ModelTangent out = zero_model_tangent(scene.model, 0);
    for (std::size_t k = 0; k < 2; ++k) out.bodies[k].vertices_dot = at.vertices_dot(scene, k, d);
    out.dmin_dot = d[at.dmin];
    out.friction_dot[{0, 1}] = d[at.mu];
    return out;
}

double pairing_of(const Scene& scene, const Coordinates& at, const ModelGradient& bar, const VectorX& d) {
    double sum = bar.dmin_bar * d[at.dmin];
    if (const auto mu = bar.friction_bar.find({0, 1}); mu != bar.friction_bar.end()) sum += mu->second * d[at.mu];
    for (std::size_t k = 0; k < 2; ++k) sum += bar.bodies[k].vertices_bar.cwiseProduct(at.vertices_dot(scene, k, d)).sum();
    return sum;
}

// A direction in which one group of coordinates moves, each part in units of its size.
VectorX direction(const Coordinates& at, Eigen::Index first, Eigen::Index count, std::mt19937_64& random) {
    std::uniform_real_distribution<double> uniform(-1, 1);
    VectorX d = VectorX::Zero(at.size);
    d.segment(first, count) = VectorX::NullaryExpr(count, [&] { return uniform(random); });
    if (first == at.dmin) d *= 1e-2;
    for (std::size_t k = 0; k < 2; ++k) {
        if (first == at.shape[k] && count == 4) d.segment(first, 2) *= 1e-2;
        if (first == at.shape[k] && count != 4) d *= 1e-2;
    }
    if (first == at.poses)
        for (int k = 0; k < 2; ++k) d.segment(first + 6 * k, 3) *= 1e-2;
    return d;
}

std::vector<Matrix34> random_motion(const std::vector<Pose>& poses, std::mt19937_64& random, std::vector<Vector6>& lambda) {
    std::uniform_real_distribution<double> uniform(-1, 1);
    const auto number = [&] { return uniform(random); };
    std::vector<Matrix34> out;
    lambda.clear();
    for (const Pose& pose : poses) {
        Vector6 motion;
        motion << 0.05 * Vector3::NullaryExpr(number), Vector3::NullaryExpr(number);
        lambda.push_back(motion);
        out.push_back(matrix_of(motion, pose.rotation));
    }
    return out;
}

constexpr support::StepSweep fine{1e-4, 0.2, 9};

}  // namespace

TEST_CASE("forces of round contacts follow shapes, poses and dmin", "[adjoint][contact][round]") {
    std::mt19937_64 random(11);
    for (const auto& named : scenes()) {
        const std::string& name = named.first;
        const Scene& scene = named.second;
        const Coordinates at(scene);
        const ContactSet contacts = contacts_of(scene.model, scene.lag_poses);
        CAPTURE(name, contacts.count);
        REQUIRE(round_count(contacts) > 0);
        const core::contact::BarrierParameters parameters = scene.parameters();
        const ContactsAtPose at_pose{scene.model, contacts, scene.lag_poses, parameters};
        for (const auto& [first, count] :
             {std::pair{at.shape[0], at.shape_size[0]}, {at.shape[1], at.shape_size[1]}, {at.poses, 12L}, {at.dmin, 1L}}) {
            const VectorX d = direction(at, first, count, random), zero = VectorX::Zero(at.size);
            std::vector<Vector6> lambda;
            const std::vector<Matrix34> motion = random_motion(scene.lag_poses, random, lambda);
            std::vector<Matrix34> poses_dot;
            for (std::size_t k = 0; k < 2; ++k)
                poses_dot.push_back(matrix_of(d.segment<6>(at.poses + 6 * static_cast<Eigen::Index>(k)), scene.lag_poses[k].rotation));
            PoseGradientTangent out{{2, Matrix34::Zero()}, {2, Matrix34::Zero()}};
            add_contact_gradient_tangent(at_pose, poses_dot, tangent_of(scene, at, d), {}, out);
            double forward = 0;
            for (std::size_t k = 0; k < 2; ++k) forward += out.dot[k].cwiseProduct(motion[k]).sum();
            CAPTURE(first, forward);
            REQUIRE(forward != 0);
            const auto value = [&](const VectorX& x) { return VectorX::Constant(1, barrier_along(moved(scene, x), motion)); };
            CHECK(support::check_directional(value, zero, d, VectorX::Constant(1, forward), fine).relative_error < 1e-6);
            if (first == at.poses) continue;  // the solver's Hessian is what goes backwards there
            std::vector<ModelGradient> bar{zero_model_gradient(scene.model, 0)};
            std::vector<std::vector<AreaChange>> no_areas(1);
            subtract_contact_vertices_adjoint(at_pose, {lambda}, bar, no_areas);
            CHECK(-pairing_of(scene, at, bar[0], d) == Approx(forward).epsilon(1e-9));
        }
    }
}

TEST_CASE("friction of round contacts follows what it was taken from", "[adjoint][contact][round]") {
    std::mt19937_64 random(12);
    for (const auto& named : scenes()) {
        const std::string& name = named.first;
        const Scene& scene = named.second;
        const Coordinates at(scene);
        const LaggedContacts lag{scene.lag_poses, contacts_of(scene.model, scene.lag_poses), {}};
        CAPTURE(name, lag.contacts.count);
        const core::contact::BarrierParameters parameters = scene.parameters();
        const FrictionAtPose at_pose{scene.model,          lag,        scene.poses,
                                     scene.slip_reference, parameters, scene.model.friction.eps_v * scene.slip_time};
        for (const auto& [first, count] : {std::pair{at.shape[0], at.shape_size[0]},
                                           {at.shape[1], at.shape_size[1]},
                                           {at.poses, 12L},
                                           {at.slip, 24L},
                                           {at.dmin, 1L},
                                           {at.mu, 1L}}) {
            const VectorX d = direction(at, first, count, random), zero = VectorX::Zero(at.size);
            std::vector<Vector6> lambda;
            const std::vector<Matrix34> motion = random_motion(scene.poses, random, lambda);
            std::vector<Matrix34> lag_dot, slip_dot;
            for (std::size_t k = 0; k < 2; ++k) {
                const auto i = static_cast<Eigen::Index>(k);
                lag_dot.push_back(matrix_of(d.segment<6>(at.poses + 6 * i), scene.lag_poses[k].rotation));
                slip_dot.emplace_back(d.segment<12>(at.slip + 12 * i).reshaped(3, 4));
            }
            PoseGradientTangent out{{2, Matrix34::Zero()}, {2, Matrix34::Zero()}};
            add_friction_tangent(at_pose, {{2, Matrix34::Zero()}, slip_dot, lag_dot, {}}, tangent_of(scene, at, d), out);
            double forward = 0;
            for (std::size_t k = 0; k < 2; ++k) forward += out.dot[k].cwiseProduct(motion[k]).sum();
            std::vector<std::vector<Matrix34>> slip_bar{{2, Matrix34::Zero()}}, lag_bar{{2, Matrix34::Zero()}};
            std::vector<std::vector<AreaChange>> areas_bar;
            std::vector<ModelGradient> bar{zero_model_gradient(scene.model, 0)};
            subtract_friction_adjoint(at_pose, {lambda}, {slip_bar, lag_bar, areas_bar, bar});
            double backward = -pairing_of(scene, at, bar[0], d);
            for (std::size_t k = 0; k < 2; ++k) {
                const auto i = static_cast<Eigen::Index>(k);
                backward -= tangent_of(lag_bar[0][k], scene.lag_poses[k].rotation).dot(d.segment<6>(at.poses + 6 * i));
                backward -= slip_bar[0][k].cwiseProduct(slip_dot[k]).sum();
            }
            CAPTURE(first, forward, backward);
            REQUIRE(forward != 0);
            CHECK(backward == Approx(forward).epsilon(1e-9));
            const auto value = [&](const VectorX& x) { return VectorX::Constant(1, friction_along(moved(scene, x), motion)); };
            CHECK(support::check_directional(value, zero, d, VectorX::Constant(1, forward), fine).relative_error < 1e-6);
        }
    }
}

namespace {

// A roller lies on a cam that turns under it: it rises and falls, and is dragged round.
SweepScene dragged_roller(core::scene::Integrator integrator) {
    SweepScene scene{"dragged roller", {}, 12};
    Model& model = scene.model;
    model.gravity = {0.2, -9.81, 0};
    model.timestep = 0.005;
    model.dhat = 1e-4;
    model.dmin = 1e-5;
    model.kappa = 2e4;
    model.velocity_tolerance = 1e-8;
    model.diagonal = 0.05;
    model.integrator = integrator;
    model.friction.mu.setConstant(0.3);
    model.friction.eps_v = 0.01;
    model.friction.rounds = 2;
    const double top = 0.0215;
    model.bodies = {support::make_body("cam", cam(-3e-3, 5e-3), {}, core::scene::BodyType::kinematic_body),
                    support::make_body("roller", roller(4e-3), {})};
    support::prescribe(model.bodies[0], 5, 3.0);
    for (const int dof : {0, 2, 3, 4}) support::prescribe(model.bodies[1], dof);
    support::set_round(model);
    std::vector<Pose> poses{{}, make_pose({0.001, -0.002, 0.1}, {1e-3, top + 8e-3, 2e-4})};
    while (!(contacts_of(model, poses).minimum_distance < model.dmin + 0.5 * model.dhat)) poses[1].position.y() -= 0.1 * model.dhat;
    model.bodies[1].pose_start = poses[1];
    if (integrator == core::scene::Integrator::quasi_static) model.proximal_weight = core::model::choose_proximal_weight(model);
    return scene;
}

core::stepper::Simulation simulation_of(const SweepScene& scene, const Model& model) {
    core::stepper::SimulationOptions options;
    options.steps = scene.steps;
    options.for_gradient = true;
    return core::stepper::simulate(model, options);
}

// The cam's columns each for itself, the roller moved and scaled.
ModelTangent prismatic_direction(const SweepScene& scene, std::mt19937_64& random) {
    Scene two;
    two.model = scene.model;
    two.is_circle = {false, true};
    const Coordinates at(two);
    VectorX d = direction(at, at.shape[0], at.shape_size[0], random);
    d.segment(at.shape[1], 4) = direction(at, at.shape[1], 4, random).segment(at.shape[1], 4);
    ModelTangent out = zero_model_tangent(scene.model, scene.steps);
    for (std::size_t k = 0; k < 2; ++k) out.bodies[k].vertices_dot = at.vertices_dot(two, k, d);
    return out;
}

void check_sweeps(const SweepScene& scene) {
    const core::stepper::Simulation simulation = simulation_of(scene, scene.model);
    INFO(simulation.report.message);
    REQUIRE(simulation.report.status == core::stepper::SimulationStatus::ok);
    const core::stepper::Trajectory& trajectory = simulation.trajectory;
    for (const auto& poses : trajectory.poses) CHECK(round_count(contacts_of(scene.model, poses)) == contacts_of(scene.model, poses).count);
    CHECK(round_count(contacts_of(scene.model, trajectory.poses.back())) == 2);
    std::mt19937_64 random(31);
    const TrajectoryGradient seed = random_seed(scene, random);
    for (const ParameterKind kind : kinds_of(scene)) {
        const ModelTangent direction =
            kind == ParameterKind::vertices ? prismatic_direction(scene, random) : random_direction(scene, kind, random);
        CAPTURE(to_string(kind));
        const auto gradients = fettle::adjoint::stepper::reverse_sweep(scene.model, trajectory, {seed});
        const auto tangents = fettle::adjoint::stepper::tangent_sweep(scene.model, trajectory, direction);
        REQUIRE(gradients);
        REQUIRE(tangents);
        const double backward = pairing(scene, (*gradients)[0], direction), forward = pairing(seed, trajectory, *tangents);
        CHECK(backward == Approx(forward).epsilon(1e-7).margin(1e-12));
        if (std::abs(forward) < 1e-3) continue;  // rounding of J and what Newton leaves, over the step, is more than 1e-8
        const auto change = [&](const VectorX& s) {
            Model model = tests::adjoint::moved(scene, direction, s[0]);
            support::set_round(model);
            const core::stepper::Simulation trial = simulation_of(scene, model);
            if (trial.report.status != core::stepper::SimulationStatus::ok) return VectorX(VectorX::Constant(1, NAN));
            return VectorX(VectorX::Constant(1, objective_change(seed, trajectory, trial.trajectory)));
        };
        const auto check =
            support::check_directional(change, VectorX::Zero(1), VectorX::Ones(1), VectorX::Constant(1, forward), {1e-4, 0.2, 7});
        CAPTURE(forward, check.step, check.difference);
        CHECK(check.relative_error < 1e-5);
    }
}

}  // namespace

TEST_CASE("a roller dragged on a cam: backwards, forwards and differences", "[adjoint][contact][round]") {
    check_sweeps(dragged_roller(core::scene::Integrator::implicit_euler));
}
TEST_CASE("a roller dragged on a cam without inertia: backwards, forwards and differences", "[adjoint][contact][round]") {
    check_sweeps(dragged_roller(core::scene::Integrator::quasi_static));
}

}  // namespace fettle::adjoint::contact::round_contacts_adjoint_test
