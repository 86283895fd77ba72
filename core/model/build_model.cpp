// SPDX-License-Identifier: MIT
#include "fettle/core/model/build_model.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>

#include "fettle/core/geometry/body_hierarchy.hpp"
#include "fettle/core/geometry/mass_moments.hpp"
#include "fettle/core/geometry/mesh_validity.hpp"
#include "fettle/core/model/start_check.hpp"
#include "fettle/core/scene/mass_kind.hpp"

namespace fettle::core::model {
namespace {

using base::Error;
using base::ErrorCode;
using base::Errors;
using scene::BodyType;
using scene::MassKind;
using scene::MeshPolicy;

constexpr double least_inertia = 1e-8;  ///< of a wire or points, about any axis, in mass times radius squared

std::string place_of(const scene::Scene& scene, const scene::Body& body) {
    return body.where.empty() ? (scene.path.empty() ? "" : scene.path + ": ") + "body `" + body.name + "`" : body.where;
}

/// What every mesh must have, whatever the policy: the rest of the program indexes and divides by it.
Errors check_usable(const scene::Body& body, const std::string& where) {
    const geometry::Mesh& mesh = body.mesh;
    const auto count = static_cast<int>(mesh.vertices.cols());
    if (count == 0) return {{ErrorCode::mesh_invalid, where, "body `" + body.name + "`: the mesh has no vertices"}};
    for (int i = 0; i < count; ++i) {
        if (mesh.vertices.col(i).allFinite()) continue;
        return {{ErrorCode::not_finite, where, "body `" + body.name + "`: vertex " + std::to_string(i) + " of its mesh is not finite"}};
    }
    const auto outside = [&](int v) { return v < 0 || v >= count; };
    for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
        if (std::none_of(mesh.edges[e].begin(), mesh.edges[e].end(), outside)) continue;
        return {
            {ErrorCode::mesh_invalid, where, "body `" + body.name + "`: edge " + std::to_string(e) + " names a vertex that is not there"}};
    }
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        if (std::none_of(mesh.triangles[t].begin(), mesh.triangles[t].end(), outside)) continue;
        return {{ErrorCode::mesh_invalid, where,
                 "body `" + body.name + "`: triangle " + std::to_string(t) + " names a vertex that is not there"}};
    }
    return {};
}

bool must_be_closed(const scene::Body& body) { return body.type == BodyType::dynamic_body && body.mass_kind == MassKind::volume; }

Errors check_strictly(const scene::Body& body, const std::string& where) {
    geometry::MeshRequirements requirements;
    requirements.closed = must_be_closed(body);
    Errors errors = geometry::validate_mesh(body.mesh, requirements);
    for (Error& error : errors) {
        error.message = "body `" + body.name + "`: " + (error.where.empty() ? "" : error.where + ": ") + error.message;
        error.where = where;
    }
    return errors;
}

Errors check_mass(const scene::Body& body, const std::string& where) {
    if (body.type != BodyType::dynamic_body) return {};
    const std::string name = "body `" + body.name + "`: ", unit = scene::density_unit(body.mass_kind);
    if (!std::isfinite(body.density)) return {{ErrorCode::not_finite, where + "/density", name + "the density is not finite"}};
    if (!(body.density > 0)) {
        return {{ErrorCode::out_of_range, where + "/density",
                 name + "the density is " + std::to_string(body.density) + " " + unit + ", it must be greater than 0"}};
    }
    const geometry::Mesh& mesh = body.mesh;
    const bool strict = body.mesh_policy == MeshPolicy::strict;
    if (body.mass_kind == MassKind::volume &&
        !(strict ? geometry::is_closed(mesh) : geometry::is_nearly_closed(mesh.vertices, mesh.triangles))) {
        return {
            {ErrorCode::mesh_invalid, where + "/mesh",
             name +
                 "its mesh is not closed, so that a density per volume gives it no mass; close it, make it static, or say with `mass_per` "
                 "what its density is per"}};
    }
    const double amount = scene::unit_moments(mesh, body.mass_kind)(3, 3);
    if (amount > 0 && std::isfinite(amount)) return {};
    if (body.mass_kind == MassKind::volume) {
        return {
            {ErrorCode::mesh_invalid, where + "/mesh",
             name + "its mesh encloses a volume of " + std::to_string(amount) + " m^3; triangles are counter-clockwise seen from outside"}};
    }
    return {{ErrorCode::mesh_invalid, where + "/mesh",
             name + "its mesh has nothing for a density in " + unit + ": no " +
                 (body.mass_kind == MassKind::area ? "triangle of any area" : "edge of any length")}};
}

Errors check_friction(const scene::Scene& scene) {
    Errors errors;
    const auto want = [&](double mu, const std::string& pointer, const std::string& of) {
        if (!(mu >= 0) || !std::isfinite(mu))
            errors.push_back({ErrorCode::out_of_range, pointer, "the friction coefficient" + of + " must be at least 0 and finite"});
    };
    const std::string top = scene.path + "#";
    want(scene.friction.mu, top + "/friction/mu", "");
    for (const auto& [name, mu] : scene.friction.materials) want(mu, top + "/materials/" + name, " of `" + name + "`");
    for (const auto& pair : scene.friction.pairs)
        want(pair.mu, top + "/friction/pairs", " of `" + pair.material_a + "` and `" + pair.material_b + "`");
    for (const scene::Body& body : scene.bodies) {
        if (body.mu) want(*body.mu, place_of(scene, body) + "/mu", " of body `" + body.name + "`");
    }
    if (!(scene.friction.eps_v > 0) || !std::isfinite(scene.friction.eps_v))
        errors.push_back({ErrorCode::out_of_range, top + "/friction/eps_v", "the static speed bound must be greater than 0 and finite"});
    return errors;
}

/// Of a script: as many poses as times, times that increase from 0, everything finite.
bool is_usable(const scene::PoseScript& script) {
    if (script.times.size() != script.poses.size()) return false;
    double before = 0;
    for (std::size_t k = 0; k < script.times.size(); ++k) {
        if (!(script.times[k] > before) || !std::isfinite(script.times[k])) return false;
        if (!script.poses[k].position.allFinite() || !script.poses[k].rotation.allFinite()) return false;
        before = script.times[k];
    }
    return true;
}

Errors check_scene(const scene::Scene& scene) {
    Errors errors;
    const auto want = [&](bool good, const char* pointer, const std::string& message) {
        if (!good) errors.push_back({ErrorCode::out_of_range, scene.path + "#" + pointer, message});
    };
    const auto positive = [](const std::optional<double>& x) { return !x || (*x > 0 && std::isfinite(*x)); };
    want(positive(scene.timestep), "/timestep", "the time step must be greater than 0 and finite");
    want(positive(scene.dhat), "/contact/dhat", "the activation distance must be greater than 0 and finite");
    want(scene.dmin >= 0 && std::isfinite(scene.dmin), "/contact/dmin", "the minimum separation must be at least 0 and finite");
    want(positive(scene.kappa), "/contact/kappa", "the barrier stiffness must be greater than 0 and finite");
    want(positive(scene.velocity_tolerance), "/contact/velocity_tolerance", "the tolerance must be greater than 0 and finite");
    want(scene.gravity.allFinite(), "/gravity", "gravity must be finite");
    want(!scene.bodies.empty(), "/bodies", "a scene needs a body");
    return errors;
}

Errors check_bodies(const scene::Scene& scene, const BuildOptions& options) {
    Errors errors;
    geometry::ShapeIndex shapes;
    std::set<std::pair<std::size_t, bool>> sound;  // copies of a part need no second look
    for (const scene::Body& body : scene.bodies) {
        const std::string where = place_of(scene, body);
        Errors found = check_usable(body, where);
        const std::pair shape(shapes.add(body.mesh), must_be_closed(body));
        // A mesh that cannot be indexed has nothing more to tell, and a mesh that is known to be bad has no mass worth judging.
        if (found.empty() && options.check_meshes && body.mesh_policy == MeshPolicy::strict && sound.count(shape) == 0) {
            found = check_strictly(body, where);
            if (found.empty()) sound.insert(shape);
        }
        if (found.empty()) found = check_mass(body, where);
        const bool finite = body.pose.position.allFinite() && body.pose.rotation.allFinite() && body.linear_velocity.allFinite() &&
                            body.angular_velocity.allFinite() && body.force.allFinite() && body.torque.allFinite();
        if (!finite)
            found.push_back({ErrorCode::not_finite, where, "body `" + body.name + "`: pose, velocity, force or torque is not finite"});
        const std::string name = "body `" + body.name + "`: ";
        if (!is_usable(body.script)) {
            found.push_back({ErrorCode::out_of_range, where + "/script",
                             name + "a script needs a finite pose for each time, and increasing times > 0"});
        } else if (!body.script.empty() && body.type != BodyType::kinematic_body) {
            found.push_back({ErrorCode::inconsistent, where + "/script", name + "only a kinematic body follows a script"});
        }
        errors.insert(errors.end(), found.begin(), found.end());
    }
    return errors;
}

Vector3 default_reference_point(const scene::Body& body) {
    if (body.reference_point) return *body.reference_point;
    if (const auto centre = scene::centre_of_mass(body.mesh, body.mass_kind)) return *centre;
    return 0.5 * (body.mesh.vertices.rowwise().minCoeff() + body.mesh.vertices.rowwise().maxCoeff());
}

double rounded_up_radius(const Matrix3X& vertices) {
    const double radius = std::sqrt(vertices.colwise().squaredNorm().maxCoeff());
    return radius * (1 + 8 * std::numeric_limits<double>::epsilon());  // three products, two sums, a root: below 4 units of rounding
}

/// Mass of a body whose mesh is relative to the reference point. A straight wire does not resist being turned about itself, nor a point
/// about anything, so that the Newton matrix would be singular: see build_model.hpp.
Matrix4 mass_moments(const Body& body, MassKind kind, double dhat) {
    Matrix4 moments = body.density * scene::unit_moments(body.mesh, kind);
    if (kind != MassKind::length && kind != MassKind::vertex) return moments;
    const double mass = moments(3, 3);
    const Vector3 first = moments.col(3).head<3>();
    const Matrix3 central = moments.topLeftCorner<3, 3>() - first * first.transpose() / mass;
    const Vector3 second = Eigen::SelfAdjointEigenSolver<Matrix3>(central, Eigen::EigenvaluesOnly).eigenvalues();
    const double radius = std::max(body.radius, dhat);
    const double lacking = least_inertia * mass * radius * radius - (second[0] + second[1]);
    if (lacking > 0) moments.topLeftCorner<3, 3>().diagonal().array() += 0.5 * lacking;
    return moments;
}

/// The file's frame about another point.
kinematics::Pose pose_about(const kinematics::Pose& pose, const Vector3& reference_point) {
    return {pose.rotation, kinematics::world_position(pose, reference_point)};
}

/// All but what follows from its mesh.
Body build_body(const scene::Body& from, const Vector3& reference_point) {
    Body body;
    body.name = from.name;
    body.type = from.type;
    body.reference_point = reference_point;
    body.density = from.density;
    body.mesh = from.mesh;
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
    body.group = from.group;
    return body;
}

void add_areas(Body& body) {
    const geometry::Mesh& mesh = body.mesh;
    body.vertex_area.assign(static_cast<std::size_t>(mesh.vertices.cols()), 0);
    body.edge_area.assign(mesh.edges.size(), 0);
    std::map<std::pair<int, int>, std::size_t> edge_index;
    for (std::size_t e = 0; e < mesh.edges.size(); ++e) edge_index[std::minmax(mesh.edges[e][0], mesh.edges[e][1])] = e;
    for (const geometry::Triangle& t : mesh.triangles) {
        const Vector3 u = mesh.vertices.col(t[1]) - mesh.vertices.col(t[0]), v = mesh.vertices.col(t[2]) - mesh.vertices.col(t[0]);
        const double third = u.cross(v).norm() / 6;
        for (int k = 0; k < 3; ++k) {
            body.vertex_area[t[k]] += third;
            if (const auto e = edge_index.find(std::minmax(t[k], t[(k + 1) % 3])); e != edge_index.end())
                body.edge_area[e->second] += third;
        }
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
        bodies[i].material = rows.try_emplace({body.material, own}, static_cast<int>(rows.size())).first->second;
    }
    Friction friction;
    friction.eps_v = from.eps_v;
    friction.rounds = from.rounds == 0 ? 1 : from.rounds;
    const auto count = static_cast<Eigen::Index>(rows.size());
    friction.mu = MatrixX::Zero(count, count);
    if (from.rounds == 0) return friction;
    const auto coefficient = [&](const std::pair<std::string, double>& a, const std::pair<std::string, double>& b) {
        for (const auto& pair : from.pairs) {
            const bool listed =
                (pair.material_a == a.first && pair.material_b == b.first) || (pair.material_a == b.first && pair.material_b == a.first);
            if (listed && !a.first.empty() && !b.first.empty()) return pair.mu;
        }
        return a.second == b.second ? a.second : std::sqrt(a.second) * std::sqrt(b.second);
    };
    for (const auto& [a, row] : rows) {
        for (const auto& [b, column] : rows) friction.mu(row, column) = coefficient(a, b);
    }
    return friction;
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

}  // namespace

void complete_geometry(Body& body) {
    body.radius = rounded_up_radius(body.mesh.vertices);
    body.edge_length_squared.clear();
    for (const auto& edge : body.mesh.edges) {
        body.edge_length_squared.push_back((body.mesh.vertices.col(edge[1]) - body.mesh.vertices.col(edge[0])).squaredNorm());
    }
    add_areas(body);
    body.hierarchy = std::make_shared<const geometry::BodyHierarchy>(body.mesh);
}

void complete_geometry(std::vector<Body>& bodies) {
    geometry::ShapeIndex shapes;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        Body& body = bodies[i];
        const std::size_t first = shapes.add(body.mesh);
        if (first == i) {
            complete_geometry(body);
            continue;
        }
        const Body& twin = bodies[first];
        body.radius = twin.radius;
        body.edge_length_squared = twin.edge_length_squared;
        body.vertex_area = twin.vertex_area;
        body.edge_area = twin.edge_area;
        body.hierarchy = twin.hierarchy;
    }
}

double choose_kappa(const Model& model) {
    double kappa = 0;
    for (const Body& body : model.bodies) {
        if (body.type != BodyType::dynamic_body) continue;
        const double mass = body.moments(3, 3);
        const double acceleration = (model.gravity + body.force / mass).norm();
        const double wanted = std::max(0.1 * mass / (model.timestep * model.timestep), 4 * mass * acceleration / model.dhat);
        // Half of a twentieth of its surface is what a body may rest on.
        const double area = std::accumulate(body.vertex_area.begin(), body.vertex_area.end(), 0.0) / 40;
        kappa = std::max(kappa, model.area_weighted && area > 0 ? wanted / area : wanted);
    }
    return kappa > 0 ? kappa : 1;
}

base::Result<Model> build_model(const scene::Scene& scene, const BuildOptions& options) {
    FETTLE_ASSERT(options.reference_points.empty() || options.reference_points.size() == scene.bodies.size(),
                  "one reference point per body is wanted");
    Errors errors = check_scene(scene);
    for (const Errors& more : {check_friction(scene), check_bodies(scene, options)}) errors.insert(errors.end(), more.begin(), more.end());
    if (!errors.empty()) return errors;

    Model model;
    model.gravity = scene.gravity;
    model.timestep = scene.timestep;
    model.end_time = scene.end_time.value_or(-1);
    model.length_unit = scene.length_unit;
    model.max_newton_iterations = scene.max_newton_iterations;
    const double diagonal = scene::bounding_diagonal(scene);
    model.diagonal = diagonal > 0 ? diagonal : 1;
    model.dhat = scene.dhat.value_or(1e-3 * model.diagonal);
    model.dmin = scene.dmin;
    model.velocity_tolerance = scene.velocity_tolerance.value_or(1e-2 * model.diagonal);
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        const bool given = !options.reference_points.empty();
        const Vector3 point = given ? options.reference_points[i] : default_reference_point(scene.bodies[i]);
        model.bodies.push_back(build_body(scene.bodies[i], point));
    }
    complete_geometry(model.bodies);
    for (std::size_t i = 0; i < model.bodies.size(); ++i) {
        if (scene.bodies[i].type == BodyType::dynamic_body)
            model.bodies[i].moments = mass_moments(model.bodies[i], scene.bodies[i].mass_kind, model.dhat);
    }
    model.friction = build_friction(scene, model.bodies);
    model.integrator = scene.integrator;
    model.area_weighted = scene.area_weighted;
    model.adaptive_kappa = !options.kappa && !scene.kappa;
    if (errors = check_areas(model); !errors.empty()) return errors;
    model.kappa = options.kappa ? *options.kappa : scene.kappa ? *scene.kappa : choose_kappa(model);
    if (options.check_start) errors = check_start(model);
    for (Error& error : errors) error.where = (scene.path.empty() ? "" : scene.path + ": ") + error.where;
    if (!errors.empty()) return errors;
    return model;
}

}  // namespace fettle::core::model
