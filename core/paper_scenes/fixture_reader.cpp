// SPDX-License-Identifier: MIT
#include "core/paper_scenes/fixture_reader.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "core/paper_scenes/fixture_body.hpp"
#include "core/paper_scenes/fixture_state.hpp"

namespace fettle::core::paper_scenes {
namespace {

using base::ErrorCode;

/// Keys that change nothing of what we compute: choices of algorithm, a viewer's settings, old solvers.
const std::vector<std::string_view> top_keys{"scene_type",
                                             "solver",
                                             "timestep",
                                             "max_time",
                                             "max_iterations",
                                             "rigid_body_problem",
                                             "distance_barrier_constraint",
                                             "ipc_solver",
                                             "ncp_solver",
                                             "homotopy_solver",
                                             "args",
                                             "volume_constraint",
                                             "newton_solver",
                                             "friction_constraints",
                                             "viewport_bbox",
                                             "animation",
                                             "stats"};
const std::vector<std::string_view> problem_keys{"rigid_bodies",  "gravity",      "coefficient_friction", "coefficient_restitution",
                                                 "collision_eps", "time_stepper", "do_intersection_check"};
const std::vector<std::string_view> barrier_keys{"initial_barrier_activation_distance", "minimum_separation_distance", "detection_method",
                                                 "trajectory_type", "barrier_type"};
const std::vector<std::string_view> friction_keys{"static_friction_speed_bound", "iterations"};
const std::vector<std::string_view> solver_keys{
    "max_iterations",  "convergence_criteria",    "velocity_conv_tol", "is_velocity_conv_tol_abs",
    "energy_conv_tol", "line_search_lower_bound", "dhat_epsilon",      "min_barrier_stiffness_scale",
    "linear_solver"};

class FixtureReader {
public:
    FixtureReader(files::JsonDocument& document, const scene::ReadOptions& options) : document_(document), bodies_(document, options) {}

    base::Result<scene::Scene> read() {
        const files::JsonNode root = scene_root();
        root.warn_of_other_keys(top_keys);
        scene_.path = document_.path();
        scene_.round_contact = false;  // the paper's contact is that of triangles
        read_scene_type(root["scene_type"].unless_null());
        read_time(root);
        const files::JsonNode problem = root["rigid_body_problem"].unless_null();
        problem.warn_of_other_keys(problem_keys);
        scene_.gravity = fixture_vector(problem["gravity"].unless_null()).value_or(Vector3::Zero());
        read_stepper(problem["time_stepper"].unless_null());
        read_friction(problem["coefficient_friction"].unless_null(), root["friction_constraints"].unless_null());
        read_barrier(root["distance_barrier_constraint"].unless_null());
        std::vector<MeshSource> meshes;  // of the bodies
        std::vector<std::vector<FixtureBody>> read = bodies_.read(problem["rigid_bodies"].unless_null(), scene_.timestep);
        std::size_t count = 0;
        for (const std::vector<FixtureBody>& bodies : read) count += bodies.size();
        scene_.bodies.reserve(count);
        for (std::vector<FixtureBody>& bodies : read) {
            for (FixtureBody& body : bodies) {
                scene_.bodies.push_back(std::move(body.body));
                meshes.push_back(body.source);
            }
        }
        FixtureBodies::fill(scene_.bodies, meshes);
        merge_groups();
        make_names_unique();
        read_solver(root["ipc_solver"].unless_null());  // its tolerance is relative to the size at the very start
        const bool saved = !document_.root()["rigid_body_problem"].exists();
        if (saved && document_.errors().empty()) continue_from_last_state(document_.root()["animation"].unless_null(), scene_);
        if (!document_.errors().empty()) return document_.errors();
        if (scene_.bodies.empty()) return base::Error{ErrorCode::out_of_range, problem["rigid_bodies"].where(), "a scene needs a body"};
        scene_.warnings = document_.warnings();
        return std::move(scene_);
    }

private:
    /// A saved simulation holds its scene under `args`.
    files::JsonNode scene_root() {
        const files::JsonNode root = document_.root();
        return root["rigid_body_problem"].exists() ? root : root["args"];
    }

    void read_scene_type(const files::JsonNode& node) {
        const auto type = node.choice({"distance_barrier_rb_problem", "split_distance_barrier_rb_problem"});
        if (type == "split_distance_barrier_rb_problem") {
            node.fail(ErrorCode::unsupported, "`scene_type` split_distance_barrier_rb_problem (2D, restitution) is not supported");
        }
    }

    void read_time(const files::JsonNode& root) {
        scene_.timestep = root["timestep"].unless_null().number(files::positive).value_or(0.01);
        const double max_time = root["max_time"].unless_null().number().value_or(-1);
        const int max_iterations = root["max_iterations"].unless_null().integer(-1).value_or(-1);
        if (max_time >= 0) {
            scene_.end_time = max_time;
        } else if (max_iterations >= 0) {
            scene_.end_time = max_iterations * scene_.timestep;
        }
    }

    void read_stepper(const files::JsonNode& node) {
        const std::string stepper = node.string().value_or("default");
        if (stepper == "implicit_newmark" || stepper == "stabilized_newmark") {
            scene_.integrator = scene::Integrator::newmark;
        } else if (stepper != "default" && stepper != "implicit_euler") {
            node.warn("unknown `time_stepper` " + node.shown() + "; implicit_euler is used");
        }
    }

    void read_friction(const files::JsonNode& coefficient, const files::JsonNode& constraints) {
        constraints.warn_of_other_keys(friction_keys);
        scene::Friction& friction = scene_.friction;
        friction.mu = coefficient.number(files::not_negative).value_or(0);
        friction.eps_v = constraints["static_friction_speed_bound"].unless_null().number(files::positive).value_or(friction.eps_v);
        friction.rounds = std::max(-1, constraints["iterations"].unless_null().integer(std::numeric_limits<int>::min() + 1).value_or(1));
    }

    void read_barrier(const files::JsonNode& node) {
        node.warn_of_other_keys(barrier_keys);
        scene_.dhat = node["initial_barrier_activation_distance"].unless_null().number(files::positive).value_or(1e-3);
        scene_.dmin = node["minimum_separation_distance"].unless_null().number(files::not_negative).value_or(0);
    }

    void read_solver(const files::JsonNode& node) {
        node.warn_of_other_keys(solver_keys);
        scene_.max_newton_iterations = node["max_iterations"].unless_null().integer(1).value_or(scene_.max_newton_iterations);
        const files::JsonNode criterion = node["convergence_criteria"].unless_null();
        if (criterion.string().value_or("velocity") != "velocity") criterion.warn("only the `velocity` criterion is used");
        const bool absolute = node["is_velocity_conv_tol_abs"].unless_null().boolean().value_or(false);
        const double tolerance = node["velocity_conv_tol"].unless_null().number(files::positive).value_or(1e-2);
        const double diagonal = scene::bounding_diagonal(scene_);
        if (absolute || diagonal > 0) scene_.velocity_tolerance = absolute ? tolerance : tolerance * diagonal;
    }

    /// All bodies that are not dynamic are one group, which a dynamic body joins when it carries the explicit id of one of them. Where none
    /// does they need no number: contact never acts between them anyway, and a start check may mention them.
    void merge_groups() {
        std::set<int> fixed_ids;
        int highest = -1;
        for (const scene::Body& body : scene_.bodies) {
            if (body.type != scene::BodyType::dynamic_body) fixed_ids.insert(body.group);
            highest = std::max(highest, body.group);
        }
        fixed_ids.erase(-1);
        const bool joined = std::any_of(scene_.bodies.begin(), scene_.bodies.end(), [&](const scene::Body& body) {
            return body.type == scene::BodyType::dynamic_body && fixed_ids.contains(body.group);
        });
        for (scene::Body& body : scene_.bodies) {
            if (body.type != scene::BodyType::dynamic_body || fixed_ids.contains(body.group)) body.group = joined ? highest + 1 : -1;
        }
    }

    /// "cube" for the only cube, "cube-0", "cube-1", ... for several.
    void make_names_unique() {
        std::map<std::string, int> count, next;
        std::set<std::string> taken;
        for (const scene::Body& body : scene_.bodies) {
            if (++count[body.name] == 1) taken.insert(body.name);
        }
        for (scene::Body& body : scene_.bodies) {
            const std::string stem = body.name;
            if (count[stem] == 1) continue;
            do body.name = stem + "-" + std::to_string(next[stem]++);
            while (!taken.insert(body.name).second);
        }
    }

    files::JsonDocument& document_;
    FixtureBodies bodies_;
    scene::Scene scene_;
};

}  // namespace

bool is_fixture(const files::JsonNode& root) {
    if (!root.is_object()) return false;
    if (root["rigid_body_problem"].exists()) return true;
    const files::JsonNode args = root["args"];
    return args.is_object() && args["rigid_body_problem"].exists();
}

base::Result<scene::Scene> read_fixture(files::JsonDocument& document, const scene::ReadOptions& options) {
    return FixtureReader(document, options).read();
}

}  // namespace fettle::core::paper_scenes
