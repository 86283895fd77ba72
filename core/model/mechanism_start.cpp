// SPDX-License-Identifier: MIT
#include "core/model/mechanism_start.hpp"

#include <algorithm>
#include <optional>
#include <set>
#include <sstream>

#include "core/base/text.hpp"
#include "core/base/units.hpp"
#include "core/constraint/assembly.hpp"
#include "core/constraint/whole_turns.hpp"
#include "core/kinematics/path.hpp"
#include "core/model/branch_of_joint.hpp"

namespace fettle::core::model {
namespace {

using base::ErrorCode;
using base::Errors;
using constraint::Assembly;
using constraint::AssemblyProblem;
using constraint::Row;

// Names of the joints of these rows, each once.
std::string names_of(const Mechanism& mechanism, const std::vector<int>& rows) {
    std::set<std::string> names;
    for (const int row : rows) names.insert(mechanism.joints[mechanism.rows[row].owner].name);
    std::string out;
    for (const std::string& name : names) out += (out.empty() ? "`" : ", `") + name + "`";
    return out;
}

// What is not met: a row that others determine is contradicted by them; all else are loops that do not close.
Errors describe_gaps(const scene::Scene& scene, const Model& model, const AssemblyProblem& problem, const Assembly& found) {
    const double close = constraint::closed_gap(problem.size, found.poses);
    Errors errors;
    const std::string where = scene.path + "#/joints";
    for (const constraint::DependentRow& d : found.dependent) {
        if (!(found.gaps[d.row] > close)) continue;
        std::ostringstream message;
        message << names_of(model.mechanism, {d.row}) << " contradicts " << names_of(model.mechanism, d.on) << ": "
                << base::length_text(found.gaps[d.row], model.length_unit) << " remain between what it asks for and what they leave";
        errors.push_back({ErrorCode::inconsistent, where, message.str()});
        break;
    }
    if (!errors.empty()) return errors;
    std::vector<int> open;
    for (Eigen::Index i = 0; i < found.gaps.size(); ++i)
        if (found.gaps[i] > close) open.push_back(static_cast<int>(i));
    std::ostringstream message;
    message << "the joints cannot be met: at " << names_of(model.mechanism, open) << " "
            << base::length_text(found.gaps.maxCoeff(), model.length_unit)
            << " remain where the bodies come closest to it; are the lengths of a loop too short, or is a motor's curve out of reach?";
    return {{ErrorCode::inconsistent, where, message.str()}};
}

bool is_on_sides(const Mechanism& mechanism, const std::vector<kinematics::Pose>& poses) {
    return std::all_of(mechanism.branches.begin(), mechanism.branches.end(),
                       [&](const constraint::Branch& branch) { return is_on_side(mechanism, branch, poses); });
}

// Each body turned a little about the axis of one of its joints, each differently.
std::vector<kinematics::Pose> turned_apart(const AssemblyProblem& problem, const Mechanism& mechanism, std::vector<kinematics::Pose> poses,
                                           int attempt) {
    const std::vector<measure::PlacedFrame> frames = placed(mechanism.set.frames, poses);
    for (int i = 0; i < count_of(poses); ++i) {
        const auto joint = std::find_if(mechanism.joints.begin(), mechanism.joints.end(),
                                        [&](const Joint& each) { return each.frame_a >= 0 && (each.a == i || each.b == i); });
        if (joint == mechanism.joints.end() || !linear::are_all_free(problem.dofs.index[i])) continue;
        const double angle = 0.05 * ((37 * i + 11 * attempt) % 17 - 8);  // up to 0.4
        const Vector3 axis = frames[joint->frame_a].axes.col(2);
        poses[i].rotation = kinematics::orthonormalised(kinematics::rotation(Vector3(angle * axis)) * poses[i].rotation);
    }
    return poses;
}

// Places to begin the search anew, where the written poses lead to another branch, or to none: the mirror image of what was found first,
// then legs at some angles; and where bodies are in line as written, so that no direction leads nearer to their joints, beside that.
std::vector<std::vector<kinematics::Pose>> other_attempts(const AssemblyProblem& problem, const Mechanism& mechanism,
                                                          const std::vector<kinematics::Pose>& written, const Assembly& found) {
    constexpr int most_turned = 4;
    const std::optional<double> bends[] = {std::nullopt, 0.5, 1.0, 1.4};
    std::vector<std::vector<kinematics::Pose>> out;
    for (const std::vector<kinematics::Pose>& from : {found.poses, written})
        for (const std::optional<double>& bend : bends) {
            if (mechanism.branches.empty()) continue;
            std::vector<kinematics::Pose> attempt = from;
            for (const constraint::Branch& branch : mechanism.branches)
                if (bend || !is_on_side(mechanism, branch, attempt)) turn_over(branch, mechanism.set.frames, problem.dofs, bend, attempt);
            out.push_back(std::move(attempt));
        }
    for (int k = 0; k < most_turned && !found.is_met; ++k) out.push_back(turned_apart(problem, mechanism, written, k));
    return out;
}

Assembly on_branches(const AssemblyProblem& problem, const Mechanism& mechanism, const std::vector<kinematics::Pose>& written,
                     Assembly found) {
    const auto is_there = [&](const Assembly& at) { return at.is_met && is_on_sides(mechanism, at.poses); };
    if (is_there(found)) return found;
    for (const std::vector<kinematics::Pose>& attempt : other_attempts(problem, mechanism, written, found)) {
        Assembly next = assemble(problem, written, attempt);
        if (is_there(next)) return next;
        if (next.is_met && !found.is_met) found = std::move(next);
    }
    return found;
}

// Bodies meet their joints, but not on the side that a joint says.
Errors describe_other_side(const scene::Scene& scene, const Mechanism& mechanism, const Assembly& found) {
    Errors errors;
    for (const constraint::Branch& branch : mechanism.branches) {
        if (is_on_side(mechanism, branch, found.poses)) continue;
        const std::string& name = mechanism.joints[branch.joint].name;
        const auto joint = std::find_if(scene.mechanism.joints.begin(), scene.mechanism.joints.end(),
                                        [&](const scene::Joint& from) { return from.name == name; });
        const std::string where = joint->where.empty() ? "joint `" + name + "`" : joint->where + "/assemble";
        errors.push_back(
            {ErrorCode::inconsistent, where,
             "the bodies cannot be assembled so that " + words_of_side(mechanism, branch, branch.sign) +
                 ": their joints are met only where " + words_of_side(mechanism, branch, -branch.sign) +
                 ". Are the two sides one for these lengths, or are the poses of a loop that no motor drives on the other side?"});
    }
    return errors;
}

void warn_of_dependent(const Assembly& found, Model& model) {
    std::vector<int> rows;
    for (const constraint::DependentRow& d : found.dependent) rows.push_back(d.row);
    if (rows.empty()) return;
    std::vector<int> on;
    for (const constraint::DependentRow& d : found.dependent) on.insert(on.end(), d.on.begin(), d.on.end());
    const std::string by = on.empty() ? "bodies that cannot move" : names_of(model.mechanism, on);
    model.warnings.push_back("joints: " + std::to_string(rows.size()) + " of " + std::to_string(model.mechanism.rows.size()) +
                             " conditions follow from others (of " + names_of(model.mechanism, rows) + ", determined by " + by +
                             "); they carry no force of their own");
}

void set_apart(const std::vector<constraint::DependentRow>& dependent, Mechanism& mechanism) {
    std::vector<Row> kept;
    for (std::size_t i = 0; i < mechanism.rows.size(); ++i) {
        const bool apart = std::any_of(dependent.begin(), dependent.end(), [&](const auto& d) { return d.row == static_cast<int>(i); });
        (apart ? mechanism.dependent : kept).push_back(mechanism.rows[i]);
    }
    mechanism.rows = std::move(kept);
}

void move_bodies(const Assembly& found, Model& model) {
    for (std::size_t i = 0; i < model.bodies.size(); ++i) {
        Body& body = model.bodies[i];
        const kinematics::Pose &from = body.pose_start, &to = found.poses[i];
        const double way = (to.position - from.position).norm();
        const double turn = kinematics::rotation_vector(to.rotation * from.rotation.transpose()).norm();
        if (way + turn * body.radius > 1e-9 * model.diagonal) {
            std::ostringstream message;
            message << "body `" << body.name << "` was moved by " << base::length_text(way, model.length_unit) << " and turned by "
                    << base::format_quantity(turn, "deg", 3) << " to meet its joints";
            model.warnings.push_back(message.str());
        }
        const Vector3 omega = kinematics::angular_velocity(from.rotation, body.velocity_start);
        body.pose_start = to;
        body.velocity_start.leftCols<3>() = cross_matrix(omega) * to.rotation;
    }
}

// What the motors' curves do at once is no start velocity of the bodies: it is the first step's.
void agree_velocities(const AssemblyProblem& problem, const Assembly& found, Model& model) {
    const std::vector<kinematics::Pose> poses = start_poses(model);
    std::vector<Vector6> velocities;
    VectorX rates(problem.targets.size());
    for (std::size_t i = 0; i < problem.rows.size(); ++i) rates[i] = rate_at_start(problem.rows[i].curve, model.timestep);
    for (std::size_t i = 0; i < model.bodies.size(); ++i) {
        const Body& body = model.bodies[i];
        Vector6 v;
        v << body.velocity_start.col(3), kinematics::angular_velocity(body.pose_start.rotation, body.velocity_start);
        for (int k = 0; k < 6; ++k)  // where a coordinate is prescribed, its curve decides
            if (!is_free(body, k))
                v[k] = (motion_value(*body.prescribed[k], 1e-6 * model.timestep) - motion_value(*body.prescribed[k], 0)) /
                       (1e-6 * model.timestep);
        velocities.push_back(v);
    }
    model.mechanism.written.velocities = velocities;
    model.mechanism.written.is_velocity_changed.assign(model.bodies.size(), false);
    const std::vector<Vector6> agreed = compatible_velocities(problem, poses, found.dependent, rates, velocities);
    std::string moved;
    for (std::size_t i = 0; i < model.bodies.size(); ++i) {
        Body& body = model.bodies[i];
        const Vector6 change = agreed[i] - velocities[i];
        const double speed = change.head<3>().norm() + change.tail<3>().norm() * body.radius;
        if (body.type != scene::BodyType::dynamic_body || speed == 0) continue;
        const bool is_written = !body.velocity_start.isZero(0);  // else nobody gave one
        model.mechanism.written.is_velocity_changed[i] = true;
        body.velocity_start << cross_matrix(agreed[i].tail<3>()) * body.pose_start.rotation, agreed[i].head<3>();
        if (is_written && speed > 1e-9 * model.diagonal) moved += (moved.empty() ? "`" : ", `") + body.name + "`";
    }
    if (!moved.empty())
        model.warnings.push_back("start velocities of " + moved +
                                 " were changed, as little as possible by mass, to agree with the joints and motors");
}

}  // namespace

constraint::AssemblyProblem start_problem(const Model& model) {
    AssemblyProblem out{model.mechanism.set, model.mechanism.rows, {}, {}, free_dofs(model), model.diagonal};
    out.targets.resize(out.rows.size());
    for (std::size_t i = 0; i < out.rows.size(); ++i) out.targets[i] = target_at(out.rows[i], 0);
    for (const Body& body : model.bodies) out.moments.push_back(body.moments);
    return out;
}

double rate_at_start(const scene::Curve& curve, double timestep) {
    const double step = 1e-6 * timestep;
    return (curve_value(curve, step) - curve_value(curve, 0)) / step;
}

Errors settle_start(const scene::Scene& scene, Model& model) {
    Mechanism& mechanism = model.mechanism;
    const std::vector<kinematics::Pose> written = start_poses(model);
    mechanism.angles_start = constraint::angles_at(mechanism.set, written, {});
    mechanism.written.poses = written;
    if (mechanism.rows.empty()) return {};
    const AssemblyProblem problem = start_problem(model);
    const Assembly first = assemble(problem, written), found = on_branches(problem, mechanism, written, first);
    if (!found.is_met) return describe_gaps(scene, model, problem, found);
    if (Errors errors = describe_other_side(scene, mechanism, found); !errors.empty()) return errors;
    if (found.has_moved) move_bodies(found, model);
    if (!first.is_met && mechanism.branches.empty())
        model.warnings.push_back(
            "joints: as written the bodies stand where nothing leads nearer to their joints, as in line; beside it they can be met, often "
            "in "
            "more ways than one: say which with `assemble`");
    for (int i = 0; i < count_of(mechanism.rows); ++i) mechanism.rows[i].number = i;
    mechanism.angles_start = constraint::nearest_turns(mechanism.set, mechanism.rows, mechanism.angles_start, found.angles);
    warn_of_dependent(found, model);
    if (model.integrator != scene::Integrator::quasi_static) agree_velocities(problem, found, model);
    set_apart(found.dependent, mechanism);
    return {};
}

}  // namespace fettle::core::model
