// SPDX-License-Identifier: MIT
#include "core/stepper/jointed_motion.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <sstream>

#include "core/base/limits.hpp"
#include "core/base/text.hpp"
#include "core/constraint/assembly.hpp"
#include "core/geometry/overlapping_boxes.hpp"
#include "core/model/limits.hpp"
#include "core/model/row_choice.hpp"
#include "core/stepper/joint_outputs.hpp"
#include "core/stepper/prescribed_path.hpp"
#include "core/stepper/scripted_motion.hpp"
#include "core/stepper/simulate.hpp"
#include "core/stepper/step.hpp"

namespace fettle::core::stepper {
namespace {

using base::ErrorCode;
using kinematics::ChartPoint;
using kinematics::Pose;

constexpr int most_parts = 256;
constexpr double followed_gap = 1e-9;  // of the scene's size, by rows that follow from others where the bodies are
constexpr double default_gap = 1e-5;   // of the smallest mechanism's size
constexpr double widest_turn = 0.5;    // of a body between two nodes, so that angles can be counted with room [rad]

// Does anything that no script moves turn far?
bool turns_far(const model::Model& model, const TrajectoryStep& step) {
    for (std::size_t k = 1; k < step.nodes.size(); ++k)
        for (std::size_t i = 0; i < step.nodes[k].size(); ++i) {
            const Vector3 turn = step.nodes[k][i].rotation_vector - step.nodes[k - 1][i].rotation_vector;
            if (turn.norm() > widest_turn && !is_scripted(model.bodies[i])) return true;
        }
    return false;
}

bool is_steady(const scene::Curve& curve) {
    return curve.rate == 0 && std::all_of(curve.values.begin(), curve.values.end(), [&](double v) { return v == curve.values.front(); });
}

std::vector<int> bodies_of_row(const model::Model& model, const constraint::Row& row) {
    std::vector<int> out;
    for (const constraint::RowPart& part : row.parts) {
        const measure::Measure& m = model.mechanism.set.measures[part.measure];
        for (const int frame : {m.a, m.b}) {
            const int body = model.mechanism.set.frames[frame].body;
            if (body != measure::world) out.push_back(body);
        }
    }
    return out;
}

// Bodies that rows connect through bodies which can move.
class Groups {
public:
    explicit Groups(const model::Model& model) : model_(model), parent_(model.bodies.size()) {
        std::iota(parent_.begin(), parent_.end(), 0);
        for (const constraint::Row& row : model.mechanism.rows) {
            int first = -1;
            for (const int body : bodies_of_row(model, row)) {
                if (is_scripted(model.bodies[body])) continue;
                if (first >= 0) parent_[root(body)] = root(first);
                first = body;
            }
        }
        for (int i = 0; i < count_of(model.bodies); ++i)
            for (int k = 0; k < 6; ++k) {
                const model::Body& body = model.bodies[i];
                if (is_free(body, k)) ++counts_[root(i)].free;
                if (!is_free(body, k) && !is_still(*body.prescribed[k])) counts_[root(i)].is_driven = true;
            }
        for (const constraint::Row& row : model.mechanism.rows) count(row);
        for (const constraint::Row& row : model.mechanism.dependent) count_drive(row);
    }

    std::set<std::string> held, open;

    /// The size of the smallest group that constraints connect [m]; infinity if there is none.
    double least_size() const {
        std::map<int, geometry::Box> boxes;
        for (const auto& [root_body, count] : counts_) {
            if (count.rows > 0) boxes[root_body] = {Vector3::Constant(base::infinity), Vector3::Constant(-base::infinity)};
        }
        for (int i = 0; i < count_of(model_.bodies); ++i) {
            const model::Body& body = model_.bodies[i];
            const auto box = boxes.find(root(i));
            if (box == boxes.end() || is_scripted(body)) continue;
            const Matrix3X x = (body.pose_start.rotation * body.mesh.vertices).colwise() + body.pose_start.position;
            box->second.low = box->second.low.cwiseMin(x.rowwise().minCoeff());
            box->second.high = box->second.high.cwiseMax(x.rowwise().maxCoeff());
        }
        double size = base::infinity;
        for (const auto& [root_body, box] : boxes) size = std::min(size, (box.high - box.low).norm());
        return size;
    }

    void judge() {
        for (int i = 0; i < count_of(model_.bodies); ++i) {
            const model::Body& body = model_.bodies[i];
            if (is_scripted(body)) continue;
            const Count& c = counts_[root(i)];
            if (c.free == c.rows && c.is_driven) continue;
            (c.is_driven ? open : held).insert(body.name);
        }
    }

private:
    struct Count {
        int free = 0, rows = 0;
        bool is_driven = false;
    };

    static bool is_still(const scene::MotionCurve& curve) {
        return curve.rate == 0 && std::all_of(curve.values.begin(), curve.values.end(), [](double v) { return v == 0; });
    }

    int root(int i) const {
        while (parent_[i] != i) i = parent_[i];
        return i;
    }

    // A motor that determines nothing at the start, as at a dead centre, drives all the same.
    void count_drive(const constraint::Row& row) {
        if (is_steady(row.curve)) return;
        for (const int body : bodies_of_row(model_, row))
            if (!is_scripted(model_.bodies[body])) counts_[root(body)].is_driven = true;
    }

    void count(const constraint::Row& row) {
        for (const int body : bodies_of_row(model_, row)) {
            const model::Body& b = model_.bodies[body];
            if (is_scripted(b)) continue;
            Count& c = counts_[root(body)];
            ++c.rows;
            if (!is_steady(row.curve)) c.is_driven = true;
            break;
        }
        // What is attached to a body that a script moves is driven by it.
        for (const int body : bodies_of_row(model_, row)) {
            const model::Body& b = model_.bodies[body];
            if (!is_scripted(b) || b.type == scene::BodyType::static_body) continue;
            for (const int other : bodies_of_row(model_, row))
                if (!is_scripted(model_.bodies[other])) counts_[root(other)].is_driven = true;
        }
    }

    const model::Model& model_;
    std::vector<int> parent_;
    std::map<int, Count> counts_;
};

class Follower {
public:
    Follower(const model::Model& model, const std::set<std::string>& held)
        : model_(model), problem_{model.mechanism.set, rows_, {}, {}, {}, model.diagonal} {
        std::set<int> out_of_it;
        for (std::size_t i = 0; i < model.bodies.size(); ++i) {
            const model::Body& body = model.bodies[i];
            problem_.moments.push_back(body.moments);
            const bool stays = held.count(body.name) > 0;
            problem_.dofs.add_body([&](int k) { return is_free(body, k) && !stays; });
            if (stays) out_of_it.insert(static_cast<int>(i));
        }
        for (const constraint::Row& row : all_rows(model.mechanism)) {
            const std::vector<int> bodies = bodies_of_row(model, row);
            if (std::none_of(bodies.begin(), bodies.end(), [&](int body) { return out_of_it.count(body) > 0; })) rows_.push_back(row);
        }
        problem_.targets.resize(rows_.size());
        angles_ = model.mechanism.angles_start;
    }

    /// Appends a step that ends `h` later; what is wrong, if the joints cannot be met.
    std::optional<std::string> advance(double time, double h, Trajectory& out) {
        const std::vector<Pose> poses = out.poses.back();
        TrajectoryStep step;
        step.nodes.emplace_back();
        for (const Pose& pose : poses) step.nodes.back().push_back({pose.position, Vector3::Zero()});
        step.fractions.push_back(0);
        std::vector<Pose> at = poses;
        for (const PrescribedNode& node : prescribed_path(model_, poses, time)) {
            const double share = node.fraction - step.fractions.back();
            const auto found = assembled(guess(poses, at, node, share), time + node.fraction * h);
            if (!found) return unmet(poses, time + node.fraction * h);
            step.nodes.push_back(points(poses, *found, node, step.nodes.back()));
            step.fractions.push_back(node.fraction);
            remember(at, *found, share);
            at = *found;
        }
        if (step.nodes.size() == 2) step.fractions.clear();
        out.steps.push_back(std::move(step));
        out.poses.emplace_back();
        for (std::size_t i = 0; i < poses.size(); ++i) {
            const ChartPoint& end = out.steps.back().nodes.back()[i];
            out.poses.back().push_back(
                {kinematics::orthonormalised(kinematics::rotation(end.rotation_vector) * poses[i].rotation), end.position});
        }
        return std::nullopt;
    }

private:
    struct Speed {
        Vector3 way = Vector3::Zero(), turn = Vector3::Zero();  // of a whole step
    };

    // Scripted coordinates where they are to be, the others on as they went.
    std::vector<Pose> guess(const std::vector<Pose>& poses, const std::vector<Pose>& at, const PrescribedNode& node, double share) const {
        std::vector<Pose> out = at;
        for (std::size_t i = 0; i < out.size(); ++i) {
            const model::Body& body = model_.bodies[i];
            if (!speeds_.empty() && linear::are_all_free(problem_.dofs.index[i])) {
                out[i].position += share * speeds_[i].way;
                out[i].rotation = kinematics::orthonormalised(kinematics::rotation(Vector3(share * speeds_[i].turn)) * out[i].rotation);
                continue;
            }
            Vector3 turn = kinematics::rotation_vector(at[i].rotation * poses[i].rotation.transpose());
            bool turned = false;
            for (int k = 0; k < 6; ++k) {
                if (is_free(body, k)) continue;
                (k < 3 ? out[i].position[k] : turn[k - 3]) = node.targets[i][k];
                turned = turned || k >= 3;
            }
            if (turned) out[i].rotation = kinematics::orthonormalised(kinematics::rotation(turn) * poses[i].rotation);
        }
        return out;
    }

    void remember(const std::vector<Pose>& from, const std::vector<Pose>& to, double share) {
        speeds_.resize(from.size());
        for (std::size_t i = 0; i < from.size() && share > 0; ++i)
            speeds_[i] = {(to[i].position - from[i].position) / share,
                          kinematics::rotation_vector(to[i].rotation * from[i].rotation.transpose()) / share};
    }

    // The assembly counts no turns: targets are taken down to where its angles begin.
    std::optional<std::vector<Pose>> assembled(const std::vector<Pose>& from, double time) {
        const std::vector<double> counted = constraint::angles_at(model_.mechanism.set, from, angles_),
                                  plain = constraint::angles_at(model_.mechanism.set, from, {});
        for (std::size_t i = 0; i < rows_.size(); ++i) {
            double target = target_at(rows_[i], time);
            for (const constraint::RowPart& part : rows_[i].parts) {
                const auto m = static_cast<std::size_t>(part.measure);
                target -= part.factor * (counted[m] - plain[m]);
            }
            problem_.targets[i] = target;
        }
        const constraint::Assembly found = assemble(problem_, from);
        gaps_ = found.gaps;
        for (const constraint::DependentRow& d : found.dependent)
            if (gaps_[d.row] <= followed_gap * model_.diagonal) gaps_[d.row] = 0;
        if (gaps_.size() > 0 && !(gaps_.maxCoeff() <= constraint::closed_gap(model_.diagonal, from))) return std::nullopt;
        angles_ = constraint::angles_at(model_.mechanism.set, found.poses, counted);
        return found.poses;
    }

    std::vector<ChartPoint> points(const std::vector<Pose>& poses, const std::vector<Pose>& to, const PrescribedNode& node,
                                   const std::vector<ChartPoint>& before) const {
        std::vector<ChartPoint> out;
        for (std::size_t i = 0; i < poses.size(); ++i) {
            ChartPoint point{to[i].position, kinematics::rotation_vector(to[i].rotation * poses[i].rotation.transpose())};
            if (linear::is_none_free(problem_.dofs.index[i])) {  // nothing moves but by scripts
                point = {poses[i].position, before[i].rotation_vector};
                for (int k = 0; k < 6; ++k)
                    if (!is_free(model_.bodies[i], k)) (k < 3 ? point.position[k] : point.rotation_vector[k - 3]) = node.targets[i][k];
            }
            out.push_back(point);
        }
        return out;
    }

    std::string unmet(const std::vector<Pose>& poses, double time) const {
        std::set<std::string> names;
        const double worst = gaps_.size() > 0 ? gaps_.maxCoeff() : 0;
        const double closed = constraint::closed_gap(model_.diagonal, poses);
        for (std::size_t i = 0; i < rows_.size(); ++i)
            if (gaps_[i] > closed) names.insert("`" + model_.mechanism.joints[rows_[i].owner].name + "`");
        std::ostringstream message;
        message << "at " << time << " s the joints cannot be met: " << base::joined(names) << ", by "
                << base::length_text(worst, model_.length_unit) << "; is a motor's curve out of reach, or the loop at a dead centre?";
        return message.str();
    }

    const model::Model& model_;
    std::vector<constraint::Row> rows_;
    constraint::AssemblyProblem problem_;
    std::vector<double> angles_;
    std::vector<Speed> speeds_;
    VectorX gaps_;
};

}  // namespace

double default_joint_gap(const model::Model& model) {
    const double size = Groups(model).least_size();
    return default_gap * (std::isfinite(size) && size > 0 ? size : model.diagonal);
}

std::vector<std::string> undriven_bodies(const model::Model& model) {
    Groups groups(model);
    groups.judge();
    return {groups.held.begin(), groups.held.end()};
}

namespace {

// Limits say where a joint can be; a motion without dynamics that leads beyond them is none of the mechanism's.
std::optional<std::string> beyond_limits_on(const model::Model& model, const Trajectory& trajectory) {
    std::vector<double> angles = model.mechanism.angles_start;
    for (std::size_t t = 0; t < trajectory.poses.size(); ++t) {
        angles = constraint::angles_at(model.mechanism.set, trajectory.poses[t], angles);
        const std::vector<std::string> beyond = model::beyond_limits(model, trajectory.poses[t], angles);
        if (beyond.empty()) continue;
        std::ostringstream message;
        message << "at " << static_cast<double>(t) * trajectory.timestep << " s " << beyond.front()
                << ": a motor leads it there, or a loop; let it end before, or widen `limits`";
        return message.str();
    }
    return std::nullopt;
}

}  // namespace

base::Result<JointedMotion> follow_joints(const model::Model& model, int steps, double allowed_gap) {
    Groups groups(model);
    groups.judge();
    const std::string where = "joints";
    if (!groups.open.empty())
        return base::Error{
            ErrorCode::unsupported, where,
            "joints and motors leave " + base::joined(groups.open) +
                " some freedom, which dynamics would have to decide: --motion simulates it, --ranges looks at all positions"};
    SimulationOptions options;
    options.steps = steps;
    const int count = step_count(model, options);
    JointedMotion out;
    out.held.assign(groups.held.begin(), groups.held.end());
    for (out.parts = 1;; out.parts *= 2) {
        model::Model finer = model;
        finer.timestep = model.timestep / out.parts;
        Follower follower(finer, groups.held);
        Trajectory trajectory;
        trajectory.timestep = finer.timestep;
        for (const model::Body& body : model.bodies) trajectory.body_names.push_back(body.name);
        trajectory.poses.push_back(start_state(model).history.poses);
        out.joint_gap = 0;
        bool is_coarse = false;
        std::optional<std::string> fault;
        for (int t = 0; !fault && t < count * out.parts && !is_coarse; ++t) {
            fault = follower.advance(t * finer.timestep, finer.timestep, trajectory);
            if (fault) break;
            const TrajectoryStep& step = trajectory.steps.back();
            out.joint_gap = std::max(out.joint_gap, path_gap_bound(model, trajectory.poses[trajectory.poses.size() - 2], step));
            is_coarse = out.parts < most_parts && (out.joint_gap > allowed_gap || turns_far(model, step));
        }
        if (fault && out.parts >= most_parts) return base::Error{ErrorCode::inconsistent, where, *fault};
        if (fault || is_coarse) continue;
        if (const auto beyond = beyond_limits_on(model, trajectory)) return base::Error{ErrorCode::out_of_range, where, *beyond};
        out.trajectory = std::move(trajectory);
        return out;
    }
}

}  // namespace fettle::core::stepper
