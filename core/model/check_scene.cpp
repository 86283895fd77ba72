// SPDX-License-Identifier: MIT
#include "core/model/check_scene.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string_view>
#include <tuple>
#include <utility>

#include "core/base/limits.hpp"
#include "core/base/text.hpp"
#include "core/base/units.hpp"
#include "core/model/ignored_pairs.hpp"
#include "core/scene/step_count.hpp"
#include "core/solids/mesh_judgement.hpp"
#include "core/solids/mesh_validity.hpp"

namespace fettle::core::model {
namespace {

using base::Error;
using base::ErrorCode;
using base::Errors;
using scene::BodyType;
using scene::MassKind;
using scene::MeshPolicy;

std::string place_of(const scene::Scene& scene, const scene::Body& body) {
    return body.where.empty() ? (scene.path.empty() ? "" : scene.path + ": ") + "body `" + body.name + "`" : body.where;
}

std::string named(const scene::Scene& scene, const scene::Body& body) {
    return place_of(scene, body) + (body.where.empty() ? ": " : ": body `" + body.name + "`: ");
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

bool must_be_closed(const scene::Body& body) {
    return body.type == BodyType::dynamic_body && body.mass_kind == MassKind::volume && !body.inertial;
}

Error at_body(const Error& error, const scene::Body& body, const std::string& where) {
    return {error.code, where, "body `" + body.name + "`: " + (error.where.empty() ? "" : error.where + ": ") + error.message};
}

Errors check_strictly(const scene::Body& body, const std::string& where) {
    solids::MeshRequirements requirements;
    requirements.closed = must_be_closed(body);
    Errors errors = solids::validate_mesh(body.mesh, requirements);
    for (Error& error : errors) error = at_body(error, body, where);
    return errors;
}

/// @param closed  Is the mesh as closed as its policy wants? Asked of a volume.
Errors check_mass(const scene::Body& body, const BodyMeasure& measure, bool closed, const std::string& where) {
    if (body.inertial) {
        const std::string fault = scene::fault_of(*body.inertial);
        if (fault.empty()) return {};
        return {{ErrorCode::out_of_range, where + "/inertial", "body `" + body.name + "`: " + fault}};
    }
    if (body.type != BodyType::dynamic_body) return {};
    const std::string name = "body `" + body.name + "`: ", unit = scene::density_unit(body.mass_kind);
    if (!std::isfinite(body.density)) return {{ErrorCode::not_finite, where + "/density", name + "the density is not finite"}};
    if (!(body.density > 0)) {
        return {{ErrorCode::out_of_range, where + "/density",
                 name + "the density is " + std::to_string(body.density) + " " + unit + ", it must be greater than 0"}};
    }
    if (body.mass_kind == MassKind::volume && !closed) {
        return {
            {ErrorCode::mesh_invalid, where + "/mesh",
             name +
                 "its mesh is not closed, so that a density per volume gives it no mass; close it, make it static, or say with `mass_per` "
                 "what its density is per"}};
    }
    const double amount = measure.amount();
    if (amount > 0 && std::isfinite(amount)) return {};
    if (body.mass_kind == MassKind::volume) {
        return {{ErrorCode::mesh_invalid, where + "/mesh",
                 name + "its mesh encloses a volume of " + base::format_quantity(amount, "mm^3", 4) +
                     "; triangles are counter-clockwise seen from outside"}};
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

/// Does a script have as many poses as times, times that increase from 0, and everything finite?
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

Errors check_numbers(const scene::Scene& scene) {
    Errors errors;
    const auto want = [&](bool good, const char* pointer, const std::string& message) {
        if (!good) errors.push_back({ErrorCode::out_of_range, scene.path + "#" + pointer, message});
    };
    const auto positive = [](const std::optional<double>& x) { return !x || (*x > 0 && std::isfinite(*x)); };
    constexpr double a_day = 86400;  // [s]
    want(positive(scene.timestep) && scene.timestep <= a_day, "/timestep",
         "the time step must be greater than 0 and at most a day (it is in seconds)");
    if (errors.empty() && scene.end_time) {
        const Result<int> steps = scene::step_count(*scene.end_time, scene.timestep);
        if (!steps) want(false, "/end_time", steps.errors().front().message);
    }
    want(positive(scene.dhat), "/contact/dhat", "the activation distance must be greater than 0 and finite");
    want(scene.dmin >= 0 && std::isfinite(scene.dmin), "/contact/dmin", "the minimum separation must be at least 0 and finite");
    want(positive(scene.kappa), "/contact/kappa", "the barrier stiffness must be greater than 0 and finite");
    want(scene.contact_damping_time >= 0 && std::isfinite(scene.contact_damping_time), "/contact/damping_time",
         "the damping time of contacts must be at least 0 and finite");
    want(positive(scene.velocity_tolerance), "/contact/velocity_tolerance", "the tolerance must be greater than 0 and finite");
    want(scene.gravity.allFinite(), "/gravity", "gravity must be finite");
    want(!scene.bodies.empty(), "/bodies", "a scene needs a body");
    return errors;
}

/// A mesh by its policy. Warnings name the body.
Errors check_mesh(const scene::Body& body, const std::string& where, std::vector<std::string>& warnings) {
    if (body.mesh_policy == MeshPolicy::lenient) return {};
    if (body.mesh_policy == MeshPolicy::strict) return check_strictly(body, where);
    solids::MeshFindings found = solids::judge_mesh(body.mesh, must_be_closed(body));
    for (const std::string& warning : found.warnings) warnings.push_back(where + ": body `" + body.name + "`: " + warning);
    for (Error& error : found.errors) error = at_body(error, body, where);
    return found.errors;
}

Errors check_motion(const scene::Body& body, const std::string& where) {
    Errors found;
    const std::string name = "body `" + body.name + "`: ";
    const auto usable = [](const auto& values) {
        return values.array().isFinite().all() && !(values.cwiseAbs().maxCoeff() > base::largest_magnitude);
    };
    if (!usable(body.pose.position) || !body.pose.rotation.allFinite() || !usable(body.linear_velocity) || !usable(body.angular_velocity) ||
        !usable(body.force) || !usable(body.torque)) {
        found.push_back({ErrorCode::not_finite, where, name + "pose, velocity, force or torque is not finite, or beyond 1e30"});
    }
    for (const auto& curve : body.prescribed) {
        if (!curve) continue;
        const auto good = [](double x) { return base::is_usable_number(x); };
        if (good(curve->rate) && good(curve->stop_time.value_or(0)) && std::all_of(curve->times.begin(), curve->times.end(), good) &&
            std::all_of(curve->values.begin(), curve->values.end(), good))
            continue;
        found.push_back({ErrorCode::not_finite, where + "/prescribed", name + "a prescribed motion is not finite, or beyond 1e30"});
    }
    if (!is_usable(body.script)) {
        found.push_back(
            {ErrorCode::out_of_range, where + "/script", name + "a script needs a finite pose for each time, and increasing times > 0"});
    } else if (!body.script.empty() && body.type != BodyType::kinematic_body) {
        found.push_back({ErrorCode::inconsistent, where + "/script", name + "only a kinematic body follows a script"});
    }
    return found;
}

/// Newmark's rule makes a prescribed coordinate's velocity of those before it, so that a jump of its speed goes to and fro for ever, in the
/// forces that drive it and in the energy. (A body that is driven altogether has its velocity from its places.)
Errors check_integrator(const scene::Scene& scene) {
    if (scene.integrator != scene::Integrator::newmark) return {};
    const auto moves = [](const auto& curve) {
        const auto is_zero = [](double x) { return x == 0; };
        return curve && !(curve->rate == 0 && std::all_of(curve->values.begin(), curve->values.end(), is_zero));
    };
    for (const scene::Body& body : scene.bodies) {
        if (body.type != BodyType::dynamic_body) continue;
        const bool driven_altogether = std::all_of(body.prescribed.begin(), body.prescribed.end(), [](const auto& c) { return bool(c); });
        if (driven_altogether || std::none_of(body.prescribed.begin(), body.prescribed.end(), moves)) continue;
        return {{ErrorCode::unsupported, place_of(scene, body) + "/prescribed",
                 "body `" + body.name +
                     "`: `newmark` lets a prescribed coordinate that moves oscillate, and the forces that drive it; `implicit_euler` and "
                     "`bdf2` do "
                     "not"}};
    }
    return {};
}

/// Names stand in messages, tables, drawings and files of other programs.
Errors check_names(const scene::Scene& scene) {
    Errors errors;
    const auto want = [&](const std::string& name, const std::string& where, const char* what) {
        const std::string fault = base::name_fault(name);
        if (fault.empty()) return;
        errors.push_back({ErrorCode::out_of_range, where,
                          std::string("the name of ") + what + ", \"" + base::shown_on_one_line(name) + "\", " + fault +
                              "; a name is text on one line"});
    };
    std::set<std::string_view> names;  // pairs, joints and files find bodies by them
    for (const scene::Body& body : scene.bodies) {
        want(body.name, place_of(scene, body), "a body");
        if (names.insert(body.name).second) continue;
        errors.push_back(
            {ErrorCode::inconsistent, place_of(scene, body), "another body is called `" + body.name + "` already; names are unique"});
    }
    for (const auto& [name, mu] : scene.friction.materials) want(name, scene.path, "a material");
    const scene::Mechanism& mechanism = scene.mechanism;
    for (const scene::Joint& joint : mechanism.joints) want(joint.name, joint.where, "a joint");
    for (const scene::Spring& spring : mechanism.springs) want(spring.name, spring.where, "a spring");
    for (const scene::Motor& motor : mechanism.motors) want(motor.name, motor.where, "a motor");
    for (const scene::PointLoad& load : mechanism.loads) want(load.name, load.where, "a load");
    return errors;
}

/// Copies of a part are looked at and measured once.
class BodyChecks {
public:
    explicit BodyChecks(bool check_meshes) : check_meshes_(check_meshes) {}

    /// @param shape  the first body with the same mesh
    void add(const scene::Body& body, std::size_t shape, const std::string& where, SceneCheck& check) {
        Errors found;
        if (usable_.count(shape) == 0) found = check_usable(body, where);
        if (found.empty()) usable_.insert(shape);
        BodyMeasure measure;
        // A mesh that cannot be indexed has nothing more to tell, and a mesh that is known to be bad has no mass worth judging.
        if (found.empty() && check_meshes_ && sound_.count({shape, must_be_closed(body), body.mesh_policy}) == 0) {
            found = check_mesh(body, where, check.warnings);
            if (found.empty()) sound_.insert({shape, must_be_closed(body), body.mesh_policy});
        }
        if (found.empty()) {
            const auto [entry, fresh] = measures_.try_emplace({shape, body.mass_kind});
            if (fresh) entry->second = measure_body(body.mesh, body.mass_kind);
            measure = entry->second;
            found = check_mass(body, measure, is_closed(body, shape, measure), where);
        }
        for (const Errors& more : {found, check_motion(body, where)}) check.errors.insert(check.errors.end(), more.begin(), more.end());
        check.measures.push_back(measure);
    }

private:
    bool is_closed(const scene::Body& body, std::size_t shape, const BodyMeasure& measure) {
        if (body.mass_kind != MassKind::volume || body.mesh_policy != MeshPolicy::strict) return measure.closed_enough;
        const auto [entry, fresh] = closed_.try_emplace(shape, false);
        if (fresh) entry->second = solids::is_closed(body.mesh);
        return entry->second;
    }

    bool check_meshes_;
    std::set<std::size_t> usable_;
    std::map<std::size_t, bool> closed_;
    std::set<std::tuple<std::size_t, bool, MeshPolicy>> sound_;
    std::map<std::pair<std::size_t, MassKind>, BodyMeasure> measures_;
};

double longest_side(const scene::Body& body) {
    const Matrix3X& x = body.mesh.vertices;
    return geometry::box_sides(x).maxCoeff();
}

std::string in_metres(double length) {
    return length < 1e-3 ? base::format_length(length, "um", 3)
           : length < 1  ? base::format_length(length, "mm", 3)
                         : base::format_length(length, "m", 3);
}

/// How many times as large as the others a body is: as the one in the middle of those that are not fixed. 1 where there is none.
double times_the_others(const std::vector<scene::Body>& bodies, std::size_t body) {
    std::vector<double> others;
    for (std::size_t i = 0; i < bodies.size(); ++i)
        if (i != body && bodies[i].type != BodyType::static_body && bodies[i].mesh.vertices.cols() > 0)
            others.push_back(longest_side(bodies[i]));
    if (others.empty()) return 1;
    const auto middle = others.begin() + static_cast<std::ptrdiff_t>(others.size() / 2);
    std::nth_element(others.begin(), middle, others.end());
    return *middle > 0 ? longest_side(bodies[body]) / *middle : 1;
}

void doubt_gravity(const scene::Scene& scene, SceneCheck& check) {
    constexpr double strongest = 1000;  // [m/s^2]
    if (!(scene.gravity.norm() > strongest)) return;
    check.warnings.push_back(
        (scene.path.empty() ? "scene" : scene.path + "#") + "/gravity: gravity is " +
        base::format_quantity(scene.gravity.norm(), "m/s^2", 4) +
        ", which is hardly meant; is it in mm/s^2? m/s^2 are expected, whatever the unit of lengths (9.81 on the Earth)");
}

/// Contact across a good part of a body. Nothing is said of the default: it goes with the size of what moves.
void doubt_contact_distance(const scene::Scene& scene, SceneCheck& check) {
    constexpr double share = 0.05;
    if (!scene.dhat) return;
    const scene::Body* smallest = nullptr;
    for (const scene::Body& body : scene.bodies) {
        if (body.type != BodyType::dynamic_body || !(longest_side(body) > 0)) continue;
        if (smallest == nullptr || longest_side(body) < longest_side(*smallest)) smallest = &body;
    }
    if (smallest == nullptr || !(*scene.dhat > share * longest_side(*smallest))) return;
    check.warnings.push_back((scene.path.empty() ? "scene" : scene.path + "#") + "/contact/dhat: the contact distance is " +
                             in_metres(*scene.dhat) + ", which is hardly meant beside `" + smallest->name + "`, whose size is " +
                             in_metres(longest_side(*smallest)) +
                             ": parts push each other from there on, and fits of less play are never free; is its unit right? It should be "
                             "well below the play of the fits (if it is not given: " +
                             in_metres(1e-3 * scene::moving_diagonal(scene)) + ")");
}

/// More than a turn in each time step. (Half a turn of a motor is refused: build_mechanism.hpp.)
void doubt_turns(const scene::Scene& scene, SceneCheck& check) {
    const auto doubt = [&](const std::string& of, double rate) {
        const double turns = std::abs(rate) * scene.timestep / (2 * M_PI);
        if (!(turns > 1)) return;
        check.warnings.push_back(of + " makes " +
                                 (turns < 1.5 ? "more than a turn" : std::to_string(std::llround(std::min(turns, 1e15))) + " turns") +
                                 " in each time step of " + base::format_quantity(scene.timestep, "s", 3) +
                                 ", which is hardly meant; is its unit right (in a file: degrees per second)?");
    };
    for (const scene::Body& body : scene.bodies) {
        if (body.mesh_policy == MeshPolicy::lenient) continue;
        const std::string name = named(scene, body) + "its ";
        doubt(name + "angular velocity", body.angular_velocity.norm());
        for (std::size_t k = 3; k < body.prescribed.size(); ++k)
            if (body.prescribed[k]) doubt(name + "prescribed rate about " + "xyz"[k - 3], body.prescribed[k]->rate);
    }
}

/// A size, a density, a gravity, a contact distance or a rate that is possible, but hardly meant: a unit that is another one than was
/// thought makes a factor of 1000. Scenes of the source paper are taken as they are.
void doubt_units(const scene::Scene& scene, SceneCheck& check) {
    const auto lenient = [](const scene::Body& body) { return body.mesh_policy == MeshPolicy::lenient; };
    if (!std::all_of(scene.bodies.begin(), scene.bodies.end(), lenient)) {
        doubt_gravity(scene, check);
        doubt_contact_distance(scene, check);
        doubt_turns(scene, check);
    }
    constexpr double largest = 3, largest_static = 10;                   // [m]; a ground may be large
    const double smallest = scene.length_unit < 10e-6 ? 10e-6 : 0.1e-3;  // [m]; whoever chose micrometres has small parts
    constexpr double mistaken = 250;                    // times as large or small as the others: nearer to 1000 than to them
    constexpr double lightest = 10, heaviest = 30'000;  // [kg/m^3]
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        const scene::Body& body = scene.bodies[i];
        if (lenient(body)) continue;
        const std::string name = named(scene, body);
        const bool moves = body.type == BodyType::dynamic_body, solid = moves && !body.inertial && body.mass_kind == MassKind::volume;
        const double size = longest_side(body), times = times_the_others(scene.bodies, i);
        const bool stranger = times > mistaken ? body.type != BodyType::static_body : times < 1 / mistaken && scene.bodies.size() > 2;
        if (size > (body.type == BodyType::static_body ? largest_static : largest) || size < smallest || stranger) {
            std::string what = "its size is " + in_metres(size);
            if (solid && check.measures[i].amount() > 0)
                what += " and its mass " + base::format_quantity(body.density * check.measures[i].amount(), "kg", 3);
            if (stranger) what += ", where others are about " + in_metres(size / times);
            check.warnings.push_back(name + what +
                                     ", which is hardly meant; is the unit of its lengths right? (`units` of a scene, `mesh_unit` of a "
                                     "body's mesh, --unit of mesh files; a wrong one makes a factor of 1000)");
        }
        if (solid && (body.density < lightest || body.density > heaviest))
            check.warnings.push_back(name + "a density of " + base::format_quantity(body.density, "kg/m^3", 4) +
                                     " is hardly meant (plastics have about 1000, steel 7850); 1.24 g/cm^3 are 1240 kg/m^3");
    }
}

/// A cubic curve goes beyond what its table has: between 0, 90, 90 and 0 by a tenth.
void doubt_curves(const scene::Scene& scene, SceneCheck& check) {
    constexpr double worth_saying = 0.01;  // of the table's range
    constexpr int samples = 16;            // of a stretch
    for (const scene::Motor& motor : scene.mechanism.motors) {
        const scene::Curve& curve = motor.curve;
        if (curve.kind != scene::CurveKind::cubic || curve.times.size() != curve.values.size() || curve.times.size() < 3) continue;
        const auto [least, most] = std::minmax_element(curve.values.begin(), curve.values.end());
        double farthest = worth_saying * (*most - *least), when = -1;
        for (std::size_t k = 0; k + 1 < curve.times.size(); ++k) {
            // A stretch depends on its own two entries and on their neighbours.
            const auto first = static_cast<std::ptrdiff_t>(k == 0 ? 0 : k - 1),
                       last = static_cast<std::ptrdiff_t>(std::min(k + 3, curve.times.size()));
            const scene::Curve near{curve.kind,
                                    0,
                                    {curve.times.begin() + first, curve.times.begin() + last},
                                    {curve.values.begin() + first, curve.values.begin() + last},
                                    std::nullopt};
            for (int i = 1; i < samples; ++i) {
                const double time = curve.times[k] + (curve.times[k + 1] - curve.times[k]) * i / samples, value = curve_value(near, time);
                const double beyond = std::max(value - *most, *least - value);
                if (beyond > farthest) {
                    farthest = beyond;
                    when = time;
                }
            }
        }
        if (when < 0) continue;
        check.warnings.push_back((motor.where.empty() ? "" : motor.where + ": ") + "motor `" + motor.name +
                                 "`: its cubic curve goes beyond its table, by " +
                                 base::formatted("%.2g", 100 * farthest / (*most - *least)) + "% of the table's range at " +
                                 base::format_quantity(when, "s", 3) +
                                 "; `\"profile\": \"linear\"` and \"trapezoid\" stay within, and more entries bring the cubic one nearer");
    }
}

}  // namespace

SceneCheck check_scene(const scene::Scene& scene, bool check_meshes) {
    SceneCheck check;
    check.errors = check_numbers(scene);
    for (const Errors& more : {check_integrator(scene), check_names(scene), check_friction(scene)})
        check.errors.insert(check.errors.end(), more.begin(), more.end());
    if (auto ignored = ignored_pairs(scene))
        check.ignored = *std::move(ignored);
    else
        check.errors.insert(check.errors.end(), ignored.errors().begin(), ignored.errors().end());
    BodyChecks bodies(check_meshes);
    std::vector<const geometry::Mesh*> meshes;
    meshes.reserve(scene.bodies.size());
    for (const scene::Body& body : scene.bodies) meshes.push_back(&body.mesh);
    check.shapes = geometry::first_of_shape(meshes);
    for (std::size_t i = 0; i < meshes.size(); ++i) bodies.add(scene.bodies[i], check.shapes[i], place_of(scene, scene.bodies[i]), check);
    if (!check_meshes || !check.errors.empty()) return check;
    doubt_units(scene, check);
    doubt_curves(scene, check);
    return check;
}

}  // namespace fettle::core::model
