// SPDX-License-Identifier: MIT
#include "fettle/core/model/build_model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "fettle/core/contact/body_hierarchy.hpp"
#include "fettle/core/geometry/mass_moments.hpp"
#include "fettle/core/geometry/mesh_validity.hpp"
#include "fettle/core/model/start_check.hpp"

namespace fettle::core::model {
namespace {

using base::Error;
using base::ErrorCode;
using base::Errors;
using scene::BodyType;
using scene::MeshPolicy;

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
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        if (std::none_of(mesh.triangles[t].begin(), mesh.triangles[t].end(), outside)) continue;
        return {{ErrorCode::mesh_invalid, where,
                 "body `" + body.name + "`: triangle " + std::to_string(t) + " names a vertex that is not there"}};
    }
    return {};
}

Errors check_strictly(const scene::Body& body, const std::string& where) {
    geometry::MeshRequirements requirements;
    requirements.closed = body.type == BodyType::dynamic_body;
    Errors errors = geometry::validate_mesh(body.mesh, requirements);
    for (Error& error : errors) {
        error.message = "body `" + body.name + "`: " + (error.where.empty() ? "" : error.where + ": ") + error.message;
        error.where = where;
    }
    return errors;
}

Errors check_mass(const scene::Body& body, const std::string& where) {
    if (body.type != BodyType::dynamic_body) return {};
    const std::string name = "body `" + body.name + "`: ";
    if (!std::isfinite(body.density)) return {{ErrorCode::not_finite, where + "/density", name + "the density is not finite"}};
    if (!(body.density > 0)) {
        return {{ErrorCode::out_of_range, where + "/density",
                 name + "the density is " + std::to_string(body.density) + " kg/m^3, it must be greater than 0"}};
    }
    if (body.mesh.triangles.empty() || !geometry::is_closed(body.mesh)) {
        return {
            {body.mesh_policy == MeshPolicy::strict ? ErrorCode::mesh_invalid : ErrorCode::unsupported, where + "/mesh",
             name +
                 "its mesh is not closed, and a dynamic body without a closed surface is not supported yet; close it or make it static"}};
    }
    const double volume = geometry::solid_moments(body.mesh.vertices, body.mesh.triangles)(3, 3);
    if (!(volume > 0) || !std::isfinite(volume)) {
        return {
            {ErrorCode::mesh_invalid, where + "/mesh",
             name + "its mesh encloses a volume of " + std::to_string(volume) + " m^3; triangles are counter-clockwise seen from outside"}};
    }
    return {};
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
    for (const scene::Body& body : scene.bodies) {
        const std::string where = place_of(scene, body);
        Errors found = check_usable(body, where);
        // A mesh that cannot be indexed has nothing more to tell, and a mesh that is known to be bad has no mass worth judging.
        if (found.empty() && options.check_meshes && body.mesh_policy == MeshPolicy::strict) found = check_strictly(body, where);
        if (found.empty()) found = check_mass(body, where);
        const bool finite = body.pose.position.allFinite() && body.pose.rotation.allFinite() && body.linear_velocity.allFinite() &&
                            body.angular_velocity.allFinite() && body.force.allFinite();
        if (!finite) found.push_back({ErrorCode::not_finite, where, "body `" + body.name + "`: pose, velocity or force is not finite"});
        errors.insert(errors.end(), found.begin(), found.end());
    }
    return errors;
}

Vector3 default_reference_point(const scene::Body& body) {
    if (body.reference_point) return *body.reference_point;
    if (!body.mesh.triangles.empty() && geometry::is_closed(body.mesh)) {
        const Matrix4 moments = geometry::solid_moments(body.mesh.vertices, body.mesh.triangles);
        if (moments(3, 3) > 0) return moments.col(3).head<3>() / moments(3, 3);
    }
    return 0.5 * (body.mesh.vertices.rowwise().minCoeff() + body.mesh.vertices.rowwise().maxCoeff());
}

double rounded_up_radius(const Matrix3X& vertices) {
    const double radius = std::sqrt(vertices.colwise().squaredNorm().maxCoeff());
    return radius * (1 + 8 * std::numeric_limits<double>::epsilon());  // three products, two sums, a root: below 4 units of rounding
}

Body build_body(const scene::Body& from, const Vector3& reference_point) {
    Body body;
    body.name = from.name;
    body.type = from.type;
    body.reference_point = reference_point;
    body.density = from.density;
    body.mesh = from.mesh;
    body.mesh.vertices.colwise() -= reference_point;
    if (body.type == BodyType::dynamic_body) {
        body.moments = body.density * geometry::solid_moments(body.mesh.vertices, body.mesh.triangles);
    }
    body.pose_start.rotation = from.pose.rotation;
    body.pose_start.position = kinematics::world_position(from.pose, reference_point);
    body.velocity_start << cross_matrix(from.angular_velocity) * from.pose.rotation, from.linear_velocity;
    body.prescribed = from.prescribed;
    for (auto& dof : body.prescribed) {
        if (body.type != BodyType::dynamic_body && !dof) dof = scene::MotionCurve{};
    }
    body.force = from.force;
    body.group = from.group;
    complete_geometry(body);
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

}  // namespace

void complete_geometry(Body& body) {
    body.radius = rounded_up_radius(body.mesh.vertices);
    body.edge_length_squared.clear();
    for (const auto& edge : body.mesh.edges) {
        body.edge_length_squared.push_back((body.mesh.vertices.col(edge[1]) - body.mesh.vertices.col(edge[0])).squaredNorm());
    }
    add_areas(body);
    body.hierarchy = std::make_shared<const contact::BodyHierarchy>(body.mesh);
}

double choose_kappa(const Model& model) {
    double kappa = 0;
    for (const Body& body : model.bodies) {
        if (body.type != BodyType::dynamic_body) continue;
        const double mass = body.moments(3, 3);
        const double acceleration = (model.gravity + body.force / mass).norm();
        kappa = std::max({kappa, 0.1 * mass / (model.timestep * model.timestep), 4 * mass * acceleration / model.dhat});
    }
    return kappa > 0 ? kappa : 1;
}

base::Result<Model> build_model(const scene::Scene& scene, const BuildOptions& options) {
    FETTLE_ASSERT(options.reference_points.empty() || options.reference_points.size() == scene.bodies.size(),
                  "one reference point per body is wanted");
    Errors errors = check_scene(scene);
    const Errors body_errors = check_bodies(scene, options);
    errors.insert(errors.end(), body_errors.begin(), body_errors.end());
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
        model.bodies.push_back(build_body(scene.bodies[i], given ? options.reference_points[i] : default_reference_point(scene.bodies[i])));
    }
    model.kappa = options.kappa ? *options.kappa : scene.kappa ? *scene.kappa : choose_kappa(model);
    errors = check_start(model);
    for (Error& error : errors) error.where = (scene.path.empty() ? "" : scene.path + ": ") + error.where;
    if (!errors.empty()) return errors;
    return model;
}

}  // namespace fettle::core::model
