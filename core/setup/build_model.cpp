// SPDX-License-Identifier: MIT
#include "core/setup/build_model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "core/base/parallel.hpp"
#include "core/model/body_geometry.hpp"
#include "core/model/body_mass.hpp"
#include "core/model/check_scene.hpp"
#include "core/model/start_check.hpp"
#include "core/setup/round_contact.hpp"

namespace fettle::core::setup {
namespace {

using base::Error;
using base::ErrorCode;
using base::Errors;
using model::Body;
using model::Friction;
using model::Model;
using scene::BodyType;

/// The file's frame about another point.
kinematics::Pose pose_about(const kinematics::Pose& pose, const Vector3& reference_point) {
    return {pose.rotation, kinematics::world_position(pose, reference_point)};
}

/// All but what follows from its mesh. @param mesh  in the file's frame
Body build_body(const scene::Body& from, geometry::Mesh mesh, const Vector3& reference_point) {
    Body body;
    body.name = from.name;
    body.type = from.type;
    body.reference_point = reference_point;
    body.density = from.density;
    body.mass_kind = from.mass_kind;
    body.mass_kind_given = from.mass_kind_given;
    if (from.inertial) body.given_mass = from.inertial->mass;
    body.mesh = std::move(mesh);
    body.mesh.vertices.colwise() -= reference_point;
    body.pose_start = pose_about(from.pose, reference_point);
    body.velocity_start << cross_matrix(from.angular_velocity) * from.pose.rotation, from.linear_velocity;
    body.prescribed = from.prescribed;
    for (auto& dof : body.prescribed) {
        if (body.type != BodyType::dynamic_body && !dof) dof = scene::MotionCurve{};
    }
    body.script = from.script;
    for (kinematics::Pose& pose : body.script.poses) pose = pose_about(pose, reference_point);
    body.force = from.force;
    body.torque = from.torque;
    body.damping = from.damping;
    body.group = from.group;
    return body;
}

/// Bodies that share a hierarchy have one mesh, which is integrated once.
void add_masses(const scene::Scene& scene, Model& model) {
    std::map<std::pair<const geometry::BodyHierarchy*, scene::MassKind>, Matrix4> unit_moments;
    for (std::size_t i = 0; i < model.bodies.size(); ++i) {
        if (scene.bodies[i].type != BodyType::dynamic_body) continue;
        Body& body = model.bodies[i];
        if (scene.bodies[i].inertial) {
            body.moments = scene::moments_about(*scene.bodies[i].inertial, body.reference_point);
            continue;
        }
        const auto [entry, fresh] = unit_moments.try_emplace({body.hierarchy.get(), body.mass_kind});
        if (fresh) entry->second = scene::unit_moments(body.mesh, body.mass_kind);
        body.moments = mass_moments(body, model.dhat, entry->second);
    }
}

/// Rows of the friction matrix: bodies with one material and one coefficient of their own share a row.
Friction build_friction(const scene::Scene& scene, std::vector<Body>& bodies) {
    const scene::Friction& from = scene.friction;
    std::map<std::pair<std::string, double>, int> rows;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        const scene::Body& body = scene.bodies[i];
        const auto listed = from.materials.find(body.material);
        const double own = body.mu ? *body.mu : listed != from.materials.end() ? listed->second : from.mu;
        bodies[i].material = rows.try_emplace({body.material, own}, count_of(rows)).first->second;
    }
    Friction friction;
    friction.eps_v = from.eps_v;
    friction.rounds = from.rounds == 0 ? 1 : from.rounds;
    const auto count = static_cast<Eigen::Index>(rows.size());
    friction.mu = MatrixX::Zero(count, count);
    if (from.rounds == 0) return friction;
    const auto coefficient = [&](const std::pair<std::string, double>& a, const std::pair<std::string, double>& b) {
        if (const int listed = from.pair_of(a.first, b.first); listed >= 0) return from.pairs[listed].mu;
        return a.second == b.second ? a.second : std::sqrt(a.second) * std::sqrt(b.second);
    };
    for (const auto& [a, row] : rows) {
        for (const auto& [b, column] : rows) friction.mu(row, column) = coefficient(a, b);
    }
    return friction;
}

// The share of the forces that a solve may leave, well below the integrator's own error of a step: a half for implicit Euler, a twelfth
// times the angle or phase of the step for those of second order. The remainder adds up over the steps, and of a linkage it is a share of
// what its joints carry, beside which the torque that turns it may be small: with 1e-6, Andrews' squeezer turned 8e-6 rad too far however
// short the step (tests/scenes/andrews_squeezer_test.cpp). Newmark has no joints.
double default_accuracy(scene::Integrator integrator) {
    switch (integrator) {
        case scene::Integrator::implicit_euler:
            return 1e-3;
        case scene::Integrator::bdf2:
            return 1e-8;
        case scene::Integrator::newmark:
            return 1e-6;
        case scene::Integrator::quasi_static:  // solved to rounding
            break;
    }
    return 0;
}

// Without area a vertex or edge would have no barrier.
Errors check_areas(const Model& model) {
    Errors errors;
    if (!model.area_weighted) return errors;
    for (const Body& body : model.bodies) {
        const auto none = [](double area) { return !(area > 0); };
        if (std::none_of(body.vertex_area.begin(), body.vertex_area.end(), none) &&
            std::none_of(body.edge_area.begin(), body.edge_area.end(), none))
            continue;
        errors.push_back(
            {ErrorCode::inconsistent, "body `" + body.name + "`",
             "an area-weighted barrier needs surfaces: this body has points or edges without area; set `area_weighted` to false, "
             "or give the body triangles"});
    }
    return errors;
}

// A file that is dynamic otherwise may have them; nothing of it is made up, but the user should know.
void warn_of_unused_rates(Model& model) {
    if (model.contact_damping_time > 0)
        model.warnings.push_back("contact.damping_time has no effect in a quasi-static simulation, which has no velocities");
    for (const Body& body : model.bodies) {
        const bool moving = !body.velocity_start.isZero(0), damped = body.damping.linear > 0 || body.damping.angular > 0;
        if (!moving && !damped) continue;
        model.warnings.push_back("body `" + body.name + "`: its " +
                                 (moving && damped ? "start velocity and damping have"
                                  : moving         ? "start velocity has"
                                                   : "damping has") +
                                 " no effect in a quasi-static simulation, which has no velocities");
    }
}

// Copies of a mesh that are told from the same reference point are copies in their bodies' frames, too.
std::vector<std::size_t> first_in_frame(const std::vector<Body>& bodies, const std::vector<std::size_t>& first_of_mesh) {
    std::vector<std::size_t> first;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        const std::size_t twin = first_of_mesh[i];
        first.push_back(bodies[twin].reference_point == bodies[i].reference_point ? twin : i);
    }
    return first;
}

}  // namespace

namespace {

/// @param mesh_of  (int body) -> geometry::Mesh; each is asked for once, on any thread
template <class MeshOf>
base::Result<Model> build(const scene::Scene& scene, const BuildOptions& options, const MeshOf& mesh_of) {
    FETTLE_ASSERT(options.reference_points.empty() || options.reference_points.size() == scene.bodies.size(),
                  "one reference point per body is expected");
    model::SceneCheck check = model::check_scene(scene, options.check_meshes);
    Errors errors = std::move(check.errors);
    if (!errors.empty()) return errors;

    Model model;
    model.gravity = scene.gravity;
    model.timestep = scene.timestep;
    model.end_time = scene.end_time.value_or(-1);
    model.length_unit = scene.length_unit;
    model.max_newton_iterations = scene.max_newton_iterations;
    const double diagonal = scene::bounding_diagonal(scene);
    model.diagonal = diagonal > 0 ? diagonal : 1;
    // Only what moves counts: a ground plane must not decide how close things come to one another.
    const double moving = scene::moving_diagonal(scene);
    const double size = moving > 0 ? moving : model.diagonal;
    model.dhat = scene.dhat.value_or(1e-3 * size);
    model.dmin = scene.dmin;
    model.velocity_tolerance = scene.velocity_tolerance.value_or(1e-2 * size);
    if (!scene.velocity_tolerance) model.solve_accuracy = default_accuracy(scene.integrator);
    model.bodies.resize(scene.bodies.size());
    base::parallel_for(count_of(scene.bodies), 1, [&](int i) {
        const bool given = !options.reference_points.empty();
        const Vector3 point = given ? options.reference_points[i] : default_reference_point(scene.bodies[i], check.measures[i]);
        model.bodies[i] = build_body(scene.bodies[i], mesh_of(i), point);
    });
    model::complete_geometry(model.bodies, first_in_frame(model.bodies, check.shapes));
    add_masses(scene, model);
    model.friction = build_friction(scene, model.bodies);
    model.integrator = scene.integrator;
    model.area_weighted = scene.area_weighted;
    model.contact_damping_time = scene.contact_damping_time;
    model.adaptive_kappa = !options.kappa && !scene.kappa;
    if (errors = check_areas(model); !errors.empty()) return errors;
    model.ignored = std::move(check.ignored);
    model.warnings = std::move(check.warnings);
    add_round_contact(scene.round_contact, options.facet_sides, model);
    if (model.integrator == scene::Integrator::quasi_static) {
        model.proximal_weight = options.proximal_weight ? *options.proximal_weight : choose_proximal_weight(model);
        warn_of_unused_rates(model);
    }
    if (errors = build_mechanism(scene, model, options.term_scales); !errors.empty()) return errors;
    model.kappa = options.kappa ? *options.kappa : scene.kappa ? *scene.kappa : choose_kappa(model);
    stiffen_stops(model, options.term_scales);
    if (options.check_start) {
        model::StartReport start = model::report_start(model);
        errors = std::move(start.errors);
        model.warnings.insert(model.warnings.end(), start.warnings.begin(), start.warnings.end());
    }
    for (Error& error : errors) error.where = (scene.path.empty() ? "" : scene.path + ": ") + error.where;
    if (!errors.empty()) return errors;
    return model;
}

}  // namespace

base::Result<Model> build_model(const scene::Scene& scene, const BuildOptions& options) {
    return build(scene, options, [&](int i) { return scene.bodies[i].mesh; });
}

base::Result<Model> build_model(scene::Scene&& scene, const BuildOptions& options) {
    return build(scene, options, [&](int i) { return std::move(scene.bodies[i].mesh); });
}

}  // namespace fettle::core::setup
