// SPDX-License-Identifier: MIT
#include "fettle/core/scene/scene_reader.hpp"

#include <algorithm>
#include <array>
#include <set>

#include "fettle/core/base/units.hpp"
#include "fettle/core/scene/fixture_reader.hpp"
#include "fettle/core/scene/mesh_reader.hpp"
#include "fettle/core/scene/placement.hpp"

namespace fettle::core::scene {
namespace {

using base::ErrorCode;

const std::vector<std::string_view> dof_names{"px", "py", "pz", "rx", "ry", "rz"};

int dof_index(const std::string& name) { return static_cast<int>(std::find(dof_names.begin(), dof_names.end(), name) - dof_names.begin()); }

/// Reads one file of our own format. Faults go to the document; values read after a fault are never used.
class SceneReader {
public:
    SceneReader(JsonDocument& document, const ReadOptions& options) : document_(document), options_(options) {}

    base::Result<Scene> read() {
        const JsonNode root = document_.root();
        root.allow_keys({"$schema", "fettle_scene", "description", "units", "gravity", "timestep", "end_time", "contact", "bodies"});
        root["$schema"].string();
        root["description"].string();
        root["fettle_scene"].integer(1, 1);
        read_units(root.require("units"));
        scene_.path = document_.path();
        scene_.length_unit = unit_;
        scene_.gravity = root["gravity"].vector3().value_or(Vector3::Zero());
        scene_.timestep = root["timestep"].number(positive).value_or(0.01);
        scene_.end_time = root["end_time"].number(positive);
        read_contact(root["contact"]);
        for (const JsonNode& body : root.require("bodies").elements()) scene_.bodies.push_back(read_body(body));
        if (root["bodies"].is_array() && scene_.bodies.empty()) root["bodies"].fail(ErrorCode::out_of_range, "a scene needs a body");
        if (!document_.errors().empty()) return document_.errors();
        scene_.warnings = document_.warnings();
        return std::move(scene_);
    }

private:
    void read_units(const JsonNode& node) {
        const auto name = node.choice({"um", "mm", "cm", "m", "in", "ft"});
        if (name) unit_ = base::metres_per_unit(*name).value();
    }

    void read_contact(const JsonNode& node) {
        if (!node.exists()) return;
        node.allow_keys({"dhat", "dmin", "kappa", "velocity_tolerance", "max_newton_iterations"});
        scene_.dhat = node["dhat"].length(unit_, positive);
        scene_.dmin = node["dmin"].length(unit_, not_negative).value_or(0);
        scene_.kappa = node["kappa"].number(positive);
        scene_.velocity_tolerance = node["velocity_tolerance"].length(unit_, positive);
        scene_.max_newton_iterations = node["max_newton_iterations"].integer(1).value_or(scene_.max_newton_iterations);
    }

    Body read_body(const JsonNode& node) {
        Body body;
        body.where = node.where();
        node.allow_keys({"name", "mesh", "mesh_unit", "shape", "scale", "density", "type", "position", "rotation", "rotation_vector",
                         "reference_point", "linear_velocity", "angular_velocity", "fixed", "prescribed", "force", "group"});
        if (!node.is_object()) return body;
        read_name(node.require("name"), body);
        read_geometry(node, body);
        read_pose(node, body);
        const std::string type = node["type"].choice({"dynamic", "static", "kinematic"}).value_or("dynamic");
        body.type = type == "static" ? BodyType::static_body : type == "kinematic" ? BodyType::kinematic_body : BodyType::dynamic_body;
        read_motion(node, body);
        if (body.type == BodyType::dynamic_body && !node["density"].exists()) node.require("density");
        body.density = node["density"].number(positive).value_or(body.density);
        body.group = node["group"].integer(0).value_or(-1);
        return body;
    }

    void read_name(const JsonNode& node, Body& body) {
        body.name = node.string().value_or("");
        if (!node.is_string()) return;
        if (body.name.empty() || body.name.find_first_of(":,") != std::string::npos) {
            node.fail(ErrorCode::out_of_range, "a body's name is not empty and holds no `:` and no `,`; found " + node.shown());
        } else if (!names_.insert(body.name).second) {
            node.fail(ErrorCode::inconsistent, "another body is called " + node.shown() + " already; names are unique");
        }
    }

    void read_geometry(const JsonNode& node, Body& body) {
        const JsonNode mesh = node["mesh"], shape = node["shape"];
        if (mesh.exists() == shape.exists()) {
            node.fail(mesh.exists() ? ErrorCode::inconsistent : ErrorCode::missing_key, "a body has either a `mesh` (a file) or a `shape`");
            return;
        }
        if (mesh.exists()) {
            read_mesh_file(node, body);
        } else {
            make_shape(shape, body);
        }
        const JsonNode scale = node["scale"];
        if (!scale.exists()) return;
        Vector3 factors = Vector3::Ones();
        if (scale.is_array()) {
            factors = scale.vector3().value_or(factors);
            if (!(factors.minCoeff() > 0)) scale.fail(ErrorCode::out_of_range, "every scale factor must be greater than 0");
        } else {
            factors *= scale.number(positive).value_or(1);
        }
        scale_mesh(body.mesh, factors);
    }

    void read_mesh_file(const JsonNode& node, Body& body) {
        const JsonNode mesh = node["mesh"];
        double unit = unit_;
        if (const auto name = node["mesh_unit"].choice({"um", "mm", "cm", "m", "in", "ft"})) unit = base::metres_per_unit(*name).value();
        const auto name = mesh.string();
        if (!name) return;
        const auto file = find_mesh_file(*name, document_.path(), options_.mesh_dirs, mesh.where());
        if (!file) return report(file.errors(), mesh);
        MeshReadOptions options;
        options.unit = unit;
        options.weld = true;
        const auto found = read_mesh(*file, options);
        if (!found) return report(found.errors(), mesh);
        body.mesh = *found;
    }

    void make_shape(const JsonNode& node, Body& body) {
        node.allow_keys({"generator", "dimensions", "counts"});
        ShapeSpec spec;
        spec.generator = node.require("generator").string().value_or("");
        for (const auto& [name, value] : node["dimensions"].members()) spec.dimensions[name] = value.length(unit_).value_or(0);
        for (const auto& [name, value] : node["counts"].members()) spec.counts[name] = value.integer(0).value_or(0);
        body.shape = spec;
        if (spec.generator.empty()) return;
        if (!options_.shape_generator) {
            node.fail(ErrorCode::unsupported, "shape \"" + spec.generator + "\" cannot be made here: this program was given no generators");
            return;
        }
        auto made = options_.shape_generator(spec);
        if (!made) return report(made.errors(), node);
        body.mesh = std::move(made).value();
    }

    void read_pose(const JsonNode& node, Body& body) {
        body.pose.position = node["position"].length3(unit_).value_or(Vector3::Zero());
        body.reference_point = node["reference_point"].length3(unit_);
        const JsonNode angles = node["rotation"], vector = node["rotation_vector"];
        if (angles.exists() && vector.exists()) node.fail(ErrorCode::inconsistent, "either `rotation` or `rotation_vector`, not both");
        if (const auto found = angles.vector3()) body.pose.rotation = rotation_from_degrees(*found);
        if (const auto found = vector.vector3()) body.pose.rotation = kinematics::rotation(radians(1) * *found);
    }

    void read_motion(const JsonNode& node, Body& body) {
        const bool dynamic = body.type == BodyType::dynamic_body;
        for (const char* key : {"linear_velocity", "angular_velocity", "force", "fixed"}) {
            if (dynamic || !node[key].exists()) continue;
            node[key].fail(ErrorCode::inconsistent,
                           std::string("only a dynamic body has `") + key + "`" +
                               (body.type == BodyType::kinematic_body ? "; a kinematic one moves as its `prescribed` says" : ""));
        }
        body.linear_velocity = node["linear_velocity"].length3(unit_).value_or(Vector3::Zero());
        body.angular_velocity = radians(1) * node["angular_velocity"].vector3().value_or(Vector3::Zero());
        body.force = node["force"].vector3().value_or(Vector3::Zero());
        for (const JsonNode& entry : node["fixed"].elements()) {
            if (const auto name = entry.choice(dof_names)) body.prescribed[dof_index(*name)] = MotionCurve{};
        }
        const JsonNode prescribed = node["prescribed"];
        if (prescribed.exists() && body.type == BodyType::static_body) {
            prescribed.fail(ErrorCode::inconsistent, "a static body does not move; make it kinematic");
            return;
        }
        if (prescribed.exists()) prescribed.allow_keys(dof_names);
        for (const auto& [name, curve] : prescribed.members()) {
            const int dof = dof_index(name);
            if (dof == 6) continue;
            if (body.prescribed[dof]) curve.fail(ErrorCode::inconsistent, "`" + name + "` is both `fixed` and `prescribed`");
            body.prescribed[dof] = read_curve(curve, dof >= 3);
        }
        for (auto& dof : body.prescribed) {
            if (!dynamic && !dof) dof = MotionCurve{};
        }
    }

    MotionCurve read_curve(const JsonNode& node, bool angle) {
        MotionCurve curve;
        const auto amount = [&](const JsonNode& n) { return angle ? radians(n.number().value_or(0)) : n.length(unit_).value_or(0); };
        node.allow_keys({"rate", "times", "values", "stop_time"});
        if (!node.is_object()) return curve;
        curve.rate = amount(node["rate"]);
        curve.stop_time = node["stop_time"].number(not_negative);
        curve.times = node["times"].numbers().value_or(std::vector<double>{});
        for (const JsonNode& value : node["values"].elements()) curve.values.push_back(amount(value));
        if (curve.times.size() != curve.values.size()) {
            node.fail(ErrorCode::inconsistent, std::to_string(curve.times.size()) + " `times` for " + std::to_string(curve.values.size()) +
                                                   " `values`; one value for each time is wanted");
            return MotionCurve{};
        }
        for (std::size_t i = 1; i < curve.times.size(); ++i) {
            if (curve.times[i] > curve.times[i - 1]) continue;
            node["times"].elements()[i].fail(ErrorCode::out_of_range, "times must increase from entry to entry");
        }
        if (motion_value(curve, 0) != 0) {
            node["values"].fail(ErrorCode::inconsistent, "values are measured from the start pose, so the value at time 0 must be 0");
        }
        return curve;
    }

    /// Errors of meshes and generators know nothing of the file: say which body asked.
    void report(const base::Errors& errors, const JsonNode& node) {
        for (const auto& error : errors) {
            const bool placed = error.where.empty() || error.where == node.where();
            node.fail(error.code, (placed ? "" : error.where + ": ") + error.message);
        }
    }

    JsonDocument& document_;
    const ReadOptions& options_;
    Scene scene_;
    double unit_ = 1;
    std::set<std::string> names_;
};

base::Result<Scene> read_document(JsonDocument& document, const ReadOptions& options) {
    const JsonNode root = document.root();
    if (is_fixture(root)) return read_fixture(document, options);
    if (!root.is_object() || !root["fettle_scene"].exists()) {
        const bool design = root.is_object() && root["fettle_design"].exists();
        return base::Error{design ? ErrorCode::inconsistent : ErrorCode::missing_key, root.where(),
                           design ? "this is a design, not a scene; the scene is the file that its `scene` names"
                                  : "not a scene: neither `fettle_scene` (its version, 1) nor `rigid_body_problem` is there"};
    }
    return SceneReader(document, options).read();
}

}  // namespace

base::Result<Scene> read_scene(const std::string& path, const ReadOptions& options) {
    auto document = JsonDocument::read(path);
    if (!document) return document.errors();
    return read_document(*document, options);
}

base::Result<Scene> parse_scene(const std::string& text, const std::string& path, const ReadOptions& options) {
    auto document = JsonDocument::parse(text, path);
    if (!document) return document.errors();
    return read_document(*document, options);
}

}  // namespace fettle::core::scene
