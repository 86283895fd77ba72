// SPDX-License-Identifier: MIT
// One table: every sort of contact, minimum separation, integrator, friction, sort of mass, load and damping that can be differentiated,
// with every kind of parameter: the two sweeps against each other, central differences and the slope of Taylor's remainder of whole
// simulations.
#include <catch2/catch.hpp>

#include "adjoint/stepper/reverse_sweep.hpp"
#include "adjoint/stepper/tangent_sweep.hpp"
#include "core/model/body_mass.hpp"
#include "core/model/choose_proximal_weight.hpp"
#include "core/stepper/simulate.hpp"
#include "tests/adjoint/stepper/sweep_scenes.hpp"
#include "tests/support/line_check.hpp"
#include "tests/support/test_models.hpp"

namespace fettle::adjoint::stepper::sweep_matrix_test {

using namespace fettle::tests::adjoint;
using core::scene::BodyType;
using core::scene::Integrator;
using tests::support::box_mesh;
using tests::support::make_body;
using tests::support::make_pose;

namespace {

enum class Sort { face, edge_of_triangle, corner_of_triangle, crossing_edges, parallel_edges, wire, point };
constexpr std::array sorts{
    Sort::face, Sort::edge_of_triangle, Sort::corner_of_triangle, Sort::crossing_edges, Sort::parallel_edges, Sort::wire, Sort::point};

const char* to_string(Sort sort) {
    constexpr std::array names{"face", "edge of a triangle", "corner of a triangle", "crossing edges", "parallel edges", "wire", "point"};
    return names[static_cast<std::size_t>(sort)];
}

constexpr double quarter = 0.785398;
const Vector3 on_edge(quarter, 0, 0);                // an edge along x is lowest, or highest
const Vector3 on_corner(0.6154797, 0.4636476, 0.1);  // about: a corner is

// The body that stands still, its highest feature near the origin.
core::model::Body support_body(Sort sort) {
    const core::geometry::Mesh box = box_mesh({-0.06, -0.06, -0.06}, {0.06, 0.06, 0.06});
    Vector3 turn = Vector3::Zero();
    if (sort == Sort::edge_of_triangle || sort == Sort::crossing_edges || sort == Sort::parallel_edges) turn = on_edge;
    if (sort == Sort::corner_of_triangle) turn = on_corner;
    core::geometry::Mesh mesh = box;
    if (sort == Sort::wire) {
        Matrix3X ends(3, 2);
        ends << -0.06, 0.06, 0.01, -0.02, 0, 0;
        mesh = core::geometry::make_mesh("wire", ends, {});
        core::geometry::build_connectivity(mesh, {{0, 1}});
    }
    if (sort == Sort::point) mesh = core::geometry::make_mesh("point", Matrix3X::Zero(3, 1), {});
    core::model::Body body = make_body("support", mesh, make_pose(turn, Vector3::Zero()), BodyType::static_body);
    Eigen::Index highest = 0;
    const Matrix3X world = body.pose_start.rotation * body.mesh.vertices;
    const double top = world.row(2).maxCoeff(&highest);
    if (sort == Sort::corner_of_triangle)
        body.pose_start.position = -world.col(highest);
    else
        body.pose_start.position.z() = -top;
    return body;
}

// The body that falls, its lowest feature above it.
core::model::Body falling_body(Sort sort, double gap) {
    Vector3 turn = on_corner;
    if (sort == Sort::crossing_edges || sort == Sort::wire) turn = Vector3(0.05, quarter, 0.02);  // an edge along y is lowest
    if (sort == Sort::parallel_edges)                                                             // crosses the other edge, level with it
        turn = core::kinematics::rotation_vector(core::kinematics::rotation(Vector3(0, 0, 0.02)) * core::kinematics::rotation(on_edge));
    if (sort == Sort::point) turn = Vector3(0.03, 0.05, 0.1);
    core::model::Body body = make_body("falling", box_mesh({-0.04, -0.05, -0.03}, {0.05, 0.04, 0.04}), make_pose(turn, Vector3::Zero()));
    const Matrix3X world = body.pose_start.rotation * body.mesh.vertices;
    Eigen::Index lowest = 0;
    const double bottom = world.row(2).minCoeff(&lowest);
    const bool by_corner = sort == Sort::face || sort == Sort::edge_of_triangle || sort == Sort::corner_of_triangle;
    if (by_corner) body.pose_start.position.head<2>() = Vector2(0.0007, -0.0004) - world.col(lowest).head<2>();
    if (sort == Sort::parallel_edges) {  // the middle of the lowest edge
        double y = 0;
        for (Eigen::Index k = 0; k < world.cols(); ++k)
            if (world(2, k) < bottom + 1e-6) y += 0.5 * world(1, k);
        body.pose_start.position.y() = -y;
    }
    body.pose_start.position.z() = gap - bottom;
    return body;
}

// Where the height follows from more than the lowest vertex: by bisection on the distance of what is nearest.
double contact_gap(const core::model::Model& model) {
    std::vector<core::kinematics::Pose> poses;
    for (const core::model::Body& body : model.bodies) poses.push_back(body.pose_start);
    const auto contacts = core::contact::find_contacts(model, core::ccd::find_candidates(model, poses, 0), poses);
    double least = INFINITY;
    for (const auto& list : contacts.pairs)
        for (const auto& pair : list.contacts) least = std::min(least, std::sqrt(pair.closest.distance_squared));
    return least;
}

const char* to_string(Integrator integrator) {
    constexpr std::array names{"implicit Euler", "BDF2", "Newmark", "quasi-static"};
    return names[static_cast<std::size_t>(integrator)];
}

void hold_still(SweepScene& scene, bool is_level) {
    scene.model.proximal_weight = core::model::choose_proximal_weight(scene.model);
    core::model::Body& body = scene.model.bodies[1];
    body.velocity_start.setZero();
    for (const int dof : {0, 1, 3, 4, 5}) {  // what moves a level edge across parts the edges' crossing
        const double rate = dof < 3 ? 0.004 : 0.05;
        tests::support::prescribe(body, dof, is_level && dof != 0 ? 0 : rate);
    }
}

// From above, until the first contact acts.
void lower(core::model::Model& model) {
    while (!(contact_gap(model) < 0.8 * model.dhat + model.dmin)) model.bodies[1].pose_start.position.z() -= 0.05 * model.dhat;
}

SweepScene scene_of(Sort sort, Integrator integrator, double dmin) {
    core::model::Model model;
    model.gravity = {0.3, -0.2, -9.81};
    model.timestep = 0.005;
    model.dhat = 2e-3;
    model.dmin = dmin;
    model.kappa = 2e4;
    model.velocity_tolerance = 1e-6;
    model.diagonal = 0.3;
    model.integrator = integrator;
    model.bodies = {support_body(sort), falling_body(sort, 0.02)};
    tests::support::set_velocity(model.bodies[1], {0.05, -0.03, -0.1}, {0.4, -0.3, 0.7});
    SweepScene scene{std::string(to_string(sort)) + ", " + to_string(integrator) + (dmin > 0 ? ", dmin" : ""), std::move(model), 8};
    if (integrator == Integrator::quasi_static) hold_still(scene, sort == Sort::parallel_edges);
    lower(scene.model);
    return scene;
}

// Sliding faster than eps_v, and slower.
struct Rubbing {
    Integrator integrator;
    double dmin, eps_v;
    int rounds;
};
constexpr std::array rubbings{Rubbing{Integrator::implicit_euler, 0, 1e-3, 1}, Rubbing{Integrator::implicit_euler, 5e-4, 0.5, 3},
                              Rubbing{Integrator::bdf2, 0, 0.5, 2}, Rubbing{Integrator::newmark, 5e-4, 0.02, 2},
                              Rubbing{Integrator::quasi_static, 0, 0.02, 1}};

SweepScene scene_of(Sort sort, const Rubbing& rubbing) {
    SweepScene scene = scene_of(sort, rubbing.integrator, rubbing.dmin);
    scene.name += ", friction of " + std::to_string(rubbing.rounds) + " rounds";
    scene.model.friction.mu.setConstant(0.4);
    scene.model.friction.eps_v = rubbing.eps_v;
    scene.model.friction.rounds = rubbing.rounds;
    return scene;
}

std::vector<SweepScene> table(Sort sort) {
    std::vector<SweepScene> out;
    for (const Integrator integrator : {Integrator::implicit_euler, Integrator::bdf2, Integrator::newmark, Integrator::quasi_static})
        for (const double dmin : {0.0, 5e-4}) out.push_back(scene_of(sort, integrator, dmin));
    for (const Rubbing& rubbing : rubbings) out.push_back(scene_of(sort, rubbing));
    return out;
}

void weigh_by_area(SweepScene& scene) {
    scene.name += ", area-weighted";
    scene.model.area_weighted = true;
    scene.model.kappa /= 3e-4;  // of the size of these areas
}

void damp(SweepScene& scene) {
    scene.name += ", damped contact";
    scene.model.contact_damping_time = 2e-3;
}

// Areas of contacts' elements in their weights, with and without damping, and with friction.
std::vector<SweepScene> area_weighted_table() {
    std::vector<SweepScene> out;
    for (const Sort sort : {Sort::face, Sort::corner_of_triangle, Sort::crossing_edges, Sort::parallel_edges})
        for (const Integrator integrator : {Integrator::implicit_euler, Integrator::newmark, Integrator::quasi_static}) {
            out.push_back(scene_of(sort, integrator, 0));
            weigh_by_area(out.back());
            out.push_back(scene_of(sort, Rubbing{integrator, 0, 0.2, 2}));
            weigh_by_area(out.back());
            if (integrator == Integrator::quasi_static) continue;
            out.push_back(out.back());
            damp(out.back());
        }
    return out;
}

// Damping of contacts and bodies, torques, torques on a body that may turn about one axis alone.
std::vector<SweepScene> loads_table() {
    std::vector<SweepScene> out;
    for (const Sort sort : {Sort::face, Sort::parallel_edges})
        for (const Integrator integrator : {Integrator::implicit_euler, Integrator::bdf2, Integrator::newmark}) {
            out.push_back(scene_of(sort, integrator, 0));
            damp(out.back());
            core::model::Body& body = out.back().model.bodies[1];
            body.damping = {4, 7};
            body.torque = {0.02, -0.03, 0.05};
            out.back().name += ", damped body, torque";
            out.push_back(out.back());
            tests::support::prescribe(out.back().model.bodies[1], 4, 0.1);
            out.back().name += ", a turn prescribed";
        }
    // A box that lies flat, its tilts in equilibrium with a torque.
    SweepScene flat = scene_of(Sort::face, Integrator::quasi_static, 0);
    core::model::Body& body = flat.model.bodies[1];
    for (const int dof : {3, 4}) body.prescribed[dof].reset();
    body.pose_start = make_pose({0.002, -0.001, 0.3}, {0.003, -0.002, 0.04});
    body.torque = {0.02, -0.03, 0.05};
    flat.name += ", torque on tilts";
    lower(flat.model);
    out.push_back(flat);
    return out;
}

// With friction, and motions that change within steps: the support is pushed along and turned, what is held stops.
std::vector<SweepScene> changing_table() {
    std::vector<SweepScene> out;
    for (const Sort sort : {Sort::face, Sort::crossing_edges})
        for (const Rubbing& rubbing : rubbings) {
            SweepScene scene = scene_of(sort, rubbing);
            scene.name += ", a motion that changes within steps";
            const double h = scene.model.timestep;
            core::scene::MotionCurve push, turn;
            push.times = {0, 1.4 * h, 5.7 * h};
            push.values = {0, 2e-4, -3e-4};
            turn.rate = 0.2;
            turn.stop_time = 6.3 * h;
            scene.model.bodies[0].prescribed[1] = push;
            scene.model.bodies[0].prescribed[5] = turn;
            if (rubbing.integrator == Integrator::quasi_static) scene.model.bodies[1].prescribed[0]->stop_time = 3.5 * h;
            out.push_back(std::move(scene));
        }
    return out;
}

// What falls is a shell, a wire frame, points, or a box that is not quite closed.
std::vector<SweepScene> masses_table() {
    using core::scene::MassKind;
    std::vector<SweepScene> out;
    for (const MassKind kind : {MassKind::volume, MassKind::area, MassKind::length, MassKind::vertex})
        for (const Integrator integrator : {Integrator::implicit_euler, Integrator::newmark, Integrator::quasi_static}) {
            SweepScene scene = scene_of(Sort::face, integrator, 0);
            core::model::Body& body = scene.model.bodies[1];
            if (kind == MassKind::volume) {
                body.mesh.triangles.pop_back();
                core::geometry::build_connectivity(body.mesh);
            }
            if (kind == MassKind::vertex) body.mesh = core::geometry::make_mesh("points", body.mesh.vertices, {});
            if (kind == MassKind::length) {
                const std::vector<core::geometry::Edge> edges = body.mesh.edges;
                body.mesh = core::geometry::make_mesh("frame", body.mesh.vertices, {});
                core::geometry::build_connectivity(body.mesh, edges);
            }
            tests::support::refresh(body);
            const double mass = 0.7;
            body.density = mass / core::scene::unit_moments(body.mesh, kind)(3, 3);
            body.mass_kind = kind;
            body.moments = core::model::mass_moments(body, scene.model.dhat);
            body.force = {2, 1, -3};
            if (integrator == Integrator::quasi_static) scene.model.proximal_weight = core::model::choose_proximal_weight(scene.model);
            if (kind == MassKind::volume && integrator == Integrator::newmark) {  // as a file gives it
                body.given_mass = mass;
                body.moments *= 1.3;
                scene.name += ", given";
            }
            constexpr std::array names{"nearly closed", "shell", "wires", "points"};
            scene.name += std::string(", ") + names[static_cast<std::size_t>(kind)];
            lower(scene.model);
            out.push_back(std::move(scene));
        }
    return out;
}

core::stepper::Simulation simulation_of(const SweepScene& scene, const core::model::Model& model) {
    core::stepper::SimulationOptions options;
    options.steps = scene.steps;
    options.for_gradient = true;
    return core::stepper::simulate(model, options);
}

void check_reached(Sort sort, const ContactCount& count) {
    const bool by_edges = sort == Sort::crossing_edges || sort == Sort::parallel_edges || sort == Sort::wire;
    CHECK((by_edges ? count.edge_edge + count.mollified : count.vertex_face) > 0);
    if (sort == Sort::parallel_edges) CHECK(count.mollified > 0);
}

void check_forwards(const SweepScene& scene, const core::stepper::Simulation& done) {
    std::mt19937_64 random(5);
    const std::vector<TrajectoryGradient> seeds{random_seed(scene, random), random_seed(scene, random)};
    const auto gradients = reverse_sweep(scene.model, done.trajectory, seeds);
    CAPTURE(gradients ? "" : gradients.errors()[0].message);
    REQUIRE(gradients);
    for (const ParameterKind kind : kinds_of(scene)) {
        const ModelTangent direction = random_direction(scene, kind, random);
        const auto tangents = tangent_sweep(scene.model, done.trajectory, direction);
        REQUIRE(tangents);
        for (std::size_t s = 0; s < seeds.size(); ++s) {
            const double backwards = pairing(scene, (*gradients)[s], direction);
            const double forwards = pairing(seeds[s], done.trajectory, *tangents);
            CAPTURE(tests::adjoint::to_string(kind), backwards, forwards);
            CHECK(std::abs(backwards - forwards) <= 1e-9 * std::abs(forwards) + 1e-14);
        }
    }
}

// A scene, scalars of its motion, and the derivatives of those.
struct Differentiated {
    static constexpr int count = 8;
    const SweepScene& scene;
    core::stepper::Simulation done;
    std::vector<TrajectoryGradient> seeds;
    std::vector<ModelGradient> gradients;

    explicit Differentiated(const SweepScene& s) : scene(s), done(simulation_of(s, s.model)) {
        CAPTURE(scene.name, done.report.message);
        REQUIRE(done.report.status == core::stepper::SimulationStatus::ok);
        std::mt19937_64 random(7);
        for (int k = 0; k < count; ++k) seeds.push_back(random_seed(scene, random));
        const auto found = reverse_sweep(scene.model, done.trajectory, seeds);
        REQUIRE(found);
        gradients = *found;
    }

    const ModelGradient& gradient(int k) const { return gradients[k]; }

    /// Checks the k-th scalar. @param wrong_by  a relative error that is put into the derivative
    tests::support::LineCheck check(int k, const ModelTangent& direction, const tests::support::LineSweep& sweep,
                                    double wrong_by = 0) const {
        const auto change = [&](double s) {
            const core::stepper::Simulation there = simulation_of(scene, moved(scene, direction, s));
            const bool ok = there.report.status == core::stepper::SimulationStatus::ok;
            return ok ? objective_change(seeds[k], done.trajectory, there.trajectory) : std::numeric_limits<double>::quiet_NaN();
        };
        return tests::support::check_line(change, (1 + wrong_by) * pairing(scene, gradient(k), direction), sweep);
    }

    bool is_felt(int k, const ModelTangent& direction) const {
        constexpr double nothing = 1e-15;  // of numbers of size 1: rounding
        return std::abs(pairing(scene, gradient(k), direction)) > nothing;
    }
};

// What is flat counts as flat to 1e-5 of a body: vertices that go each their own way are moved by less.
constexpr tests::support::LineSweep of_loose_vertices{1e-5, 3}, of_all_else{};

// Scalars and directions of one kind, each at random, until a pair tells: whose second derivative is large enough beside the third. All
// that are looked at must have the right derivative. The first directions of vertices may go each their own way, later ones leave plane
// faces plane.
void check_kind(const Differentiated& at, ParameterKind kind, std::mt19937_64& random) {
    constexpr int loose_directions = 2;
    bool tells = false;
    for (int k = 0; k < Differentiated::count && !tells; ++k) {
        const bool is_loose = kind == ParameterKind::vertices && k < loose_directions;
        const ModelTangent direction =
            kind == ParameterKind::vertices && !is_loose ? affine_direction(at.scene, random) : random_direction(at.scene, kind, random);
        if (!at.is_felt(k, direction)) return;
        const tests::support::LineCheck check = at.check(k, direction, is_loose ? of_loose_vertices : of_all_else);
        CAPTURE(at.scene.name, tests::adjoint::to_string(kind), k, check.difference, check.relative_error, check.slope, check.largest);
        CHECK(check.is_right());
        tells = check.tells;
    }
    CAPTURE(at.scene.name, tests::adjoint::to_string(kind));
    CHECK(tells);
}

// The same along the scalars' own gradients; where one tells nothing, along that of changes which leave plane faces plane.
void check_along_gradient(const Differentiated& at) {
    bool tells = false;
    const auto look = [&](int k, const ModelTangent& direction, const tests::support::LineSweep& sweep) {
        const tests::support::LineCheck check = at.check(k, direction, sweep);
        CAPTURE(at.scene.name, k, check.difference, check.relative_error, check.slope, check.largest);
        CHECK(check.is_right());
        tells = check.tells;
    };
    for (int k = 0; k < Differentiated::count && !tells; ++k) {
        look(k, vertex_gradient_direction(at.scene, at.gradient(k)), of_loose_vertices);
        if (!tells) look(k, affine_gradient_direction(at.scene, at.gradient(k)), of_all_else);
    }
    CAPTURE(at.scene.name);
    CHECK(tells);
}

void check_differences(const SweepScene& scene) {
    const Differentiated at(scene);
    std::mt19937_64 random(11);
    for (const ParameterKind kind : kinds_of(scene)) check_kind(at, kind, random);
    check_along_gradient(at);
}

void check_forwards(const std::vector<SweepScene>& scenes) {
    for (const SweepScene& scene : scenes) {
        const core::stepper::Simulation done = simulation_of(scene, scene.model);
        CAPTURE(scene.name, done.report.message);
        REQUIRE(done.report.status == core::stepper::SimulationStatus::ok);
        const ContactCount count = count_contacts(scene.model, done.trajectory);
        CHECK(count.vertex_face + count.edge_edge + count.mollified > 0);
        check_forwards(scene, done);
    }
}

}  // namespace

TEST_CASE("every sort of contact, integrator and minimum separation: backwards and forwards agree", "[adjoint][stepper]") {
    for (const Sort sort : sorts)
        for (const SweepScene& scene : table(sort)) {
            const core::stepper::Simulation done = simulation_of(scene, scene.model);
            CAPTURE(scene.name, done.report.message);
            REQUIRE(done.report.status == core::stepper::SimulationStatus::ok);
            check_reached(sort, count_contacts(scene.model, done.trajectory));
            check_forwards(scene, done);
        }
}

TEST_CASE("area weights: backwards and forwards agree", "[adjoint][stepper]") { check_forwards(area_weighted_table()); }
TEST_CASE("damping and torques: backwards and forwards agree", "[adjoint][stepper]") { check_forwards(loads_table()); }
TEST_CASE("shells, wires, points, capped solids: backwards and forwards agree", "[adjoint][stepper]") { check_forwards(masses_table()); }

TEST_CASE("friction in steps within which a motion changes: backwards and forwards agree", "[adjoint][stepper]") {
    for (const SweepScene& scene : changing_table()) {
        const core::stepper::Trajectory trajectory = simulation_of(scene, scene.model).trajectory;
        REQUIRE(trajectory.steps.size() == static_cast<std::size_t>(scene.steps));
        for (const std::size_t t : {1U, 5U, 6U}) CHECK(trajectory.steps[t].fractions.size() > 2);
    }
    check_forwards(changing_table());
}

TEST_CASE("every sort of contact, integrator and minimum separation: differences and Taylor's remainder", "[adjoint][stepper][slow]") {
    for (const Sort sort : sorts)
        for (const SweepScene& scene : table(sort)) check_differences(scene);
}

TEST_CASE("area weights: differences and Taylor's remainder", "[adjoint][stepper][slow]") {
    for (const SweepScene& scene : area_weighted_table()) check_differences(scene);
}
TEST_CASE("damping and torques: differences and Taylor's remainder", "[adjoint][stepper][slow]") {
    for (const SweepScene& scene : loads_table()) check_differences(scene);
}
TEST_CASE("shells, wires, points, capped solids: differences and Taylor's remainder", "[adjoint][stepper][slow]") {
    for (const SweepScene& scene : masses_table()) check_differences(scene);
}
TEST_CASE("friction in steps within which a motion changes: differences and Taylor's remainder", "[adjoint][stepper][slow]") {
    for (const SweepScene& scene : changing_table()) check_differences(scene);
}

// In two scenes whose remainders' third order shows soon, and in all sorts of contact.
TEST_CASE("the rule that judges derivatives finds out those that are wrong by a millionth", "[adjoint][stepper][slow]") {
    std::vector<SweepScene> scenes{scene_of(Sort::crossing_edges, rubbings[3]),
                                   scene_of(Sort::parallel_edges, Rubbing{Integrator::implicit_euler, 0, 0.2, 2})};
    weigh_by_area(scenes[1]);
    damp(scenes[1]);
    for (const Sort sort : sorts) scenes.push_back(scene_of(sort, Integrator::bdf2, 0));
    int by_slope = 0;
    for (const SweepScene& scene : scenes) {
        const Differentiated at(scene);
        std::mt19937_64 random(3);
        for (const ParameterKind kind : {ParameterKind::increments, ParameterKind::gravity}) {
            const ModelTangent direction = random_direction(scene, kind, random);
            CHECK(at.check(0, direction, of_all_else).is_right());
            for (const double error : {1e-6, -1e-6}) {
                const tests::support::LineCheck wrong = at.check(0, direction, of_all_else, error);
                CAPTURE(scene.name, tests::adjoint::to_string(kind), wrong.relative_error, wrong.slope);
                CHECK_FALSE(wrong.is_right());
                by_slope += wrong.tells && !(wrong.slope > 1.9 && wrong.slope < 2.1) ? 1 : 0;
            }
        }
    }
    CHECK(by_slope >= 18);  // half of them
}

}  // namespace fettle::adjoint::stepper::sweep_matrix_test
