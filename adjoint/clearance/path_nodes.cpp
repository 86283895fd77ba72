// SPDX-License-Identifier: MIT
#include "adjoint/clearance/path_nodes.hpp"

#include <algorithm>

#include "core/stepper/prescribed_path.hpp"

namespace fettle::adjoint::clearance {
namespace {

using core::model::Body;
using core::model::Model;
using core::stepper::Trajectory;
using core::stepper::TrajectoryStep;

constexpr double same_place = 1e-12;  // of the numbers' size: what counts as lying on a straight path

bool follows_curves(const Body& body) {
    for (int dof = 0; dof < 6; ++dof)
        if (is_free(body, dof)) return false;
    return body.script.empty();
}

Vector6 coordinates(const TrajectoryStep& step, std::size_t k, int body) {
    const core::kinematics::ChartPoint& point = step.nodes[k][body];
    Vector6 out;
    out << point.position, point.rotation_vector;
    return out;
}

// The part of the running time of each curve that a body follows which has passed at this fraction of the step.
NodeShare running_share(const Body& body, double begin, double end, double fraction) {
    NodeShare out = NodeShare::Zero();
    for (int dof = 0; dof < 6; ++dof) {
        const core::scene::MotionCurve& curve = *body.prescribed[dof];
        const double stop = curve.stop_time.value_or(end);
        const double whole = std::min(end, stop) - std::min(begin, stop);
        if (whole > 0) out[dof] = (std::min(begin + fraction * (end - begin), stop) - std::min(begin, stop)) / whole;
    }
    return out;
}

// Two nodes whose shares are known, and a node between them.
struct Stretch {
    std::size_t from = 0, to = 0, at = 0;
    NodeShare share_from = NodeShare::Zero(), share_to = NodeShare::Ones();
};

Vector6 chord_of(const TrajectoryStep& step, const Stretch& stretch, int body) {
    return coordinates(step, stretch.to, body) - coordinates(step, stretch.from, body);
}

bool is_on_the_way(const TrajectoryStep& step, const Stretch& stretch, int body, double share) {
    const Vector6 start = coordinates(step, stretch.from, body), end = coordinates(step, stretch.to, body);
    const Vector6 off = coordinates(step, stretch.at, body) - (start + share * (end - start));
    const double size = start.cwiseAbs().maxCoeff() + end.cwiseAbs().maxCoeff();
    return off.cwiseAbs().maxCoeff() <= same_place * size;
}

// Both at one share of the stretch, that of the nearest point on the longer way; nothing if they are not.
std::optional<double> common_share(const TrajectoryStep& step, const Stretch& stretch, int a, int b) {
    if (stretch.at == stretch.to) return 1;
    const int longer = chord_of(step, stretch, a).squaredNorm() >= chord_of(step, stretch, b).squaredNorm() ? a : b;
    const Vector6 chord = chord_of(step, stretch, longer);
    const Vector6 way = coordinates(step, stretch.at, longer) - coordinates(step, stretch.from, longer);
    const double share = chord.squaredNorm() > 0 ? chord.dot(way) / chord.squaredNorm() : 0;
    if (!is_on_the_way(step, stretch, a, share) || !is_on_the_way(step, stretch, b, share)) return std::nullopt;
    return share;
}

// A node that a change of a prescribed motion put there.
struct Change {
    double fraction = 0;
    std::size_t node = 0;
};

std::vector<Change> changes(const Model& model, const Trajectory& trajectory, int t) {
    const TrajectoryStep& step = trajectory.steps[t];
    const std::size_t last = step.nodes.size() - 1;
    std::vector<Change> out{{0, 0}};
    if (!step.fractions.empty()) {
        for (const auto& node : core::stepper::prescribed_path(model, trajectory.poses[t], time_at(trajectory, t))) {
            const auto found = std::find(step.fractions.begin() + 1, step.fractions.end() - 1, node.fraction);
            if (found != step.fractions.end() - 1) out.push_back({node.fraction, static_cast<std::size_t>(found - step.fractions.begin())});
        }
    }
    out.push_back({1, last});
    return out;
}

}  // namespace

std::optional<std::array<NodeShare, 2>> node_shares(const Model& model, const Trajectory& trajectory, int t, int k, int a, int b) {
    const TrajectoryStep& step = trajectory.steps[t];
    const auto node = static_cast<std::size_t>(k);
    if (node == 0) return std::array<NodeShare, 2>{NodeShare::Zero(), NodeShare::Zero()};
    if (node + 1 == step.nodes.size()) return std::array<NodeShare, 2>{NodeShare::Ones(), NodeShare::Ones()};
    const std::vector<Change> known = changes(model, trajectory, t);
    const bool is_cut = known.size() > 2;
    if (is_cut && !(follows_curves(model.bodies[a]) && follows_curves(model.bodies[b]))) return std::nullopt;
    const auto after = std::find_if(known.begin(), known.end(), [&](const Change& change) { return change.node >= node; });
    const Change& before = *(after - 1);
    const Stretch stretch{before.node, after->node, node};
    const auto share = common_share(step, stretch, a, b);
    if (!share) return std::nullopt;
    std::array<NodeShare, 2> out;
    const double begin = time_at(trajectory, t), end = time_at(trajectory, t + 1);
    for (std::size_t i = 0; i < 2; ++i) {
        const Body& body = model.bodies[i == 0 ? a : b];
        const NodeShare from = is_cut ? running_share(body, begin, end, before.fraction) : NodeShare(NodeShare::Zero());
        const NodeShare to = is_cut ? running_share(body, begin, end, after->fraction) : NodeShare(NodeShare::Ones());
        out[i] = from + *share * (to - from);
    }
    return out;
}

std::string no_derivative_at(const Model& model, const Trajectory& trajectory, int a, int b, const core::clearance::Witness& witness) {
    if (witness.step < 0) return {};
    for (int i = 0; i < 2; ++i) {
        if (witness.s == 1 - i) continue;  // the other node alone
        if (node_shares(model, trajectory, witness.step, witness.segment + i, a, b)) continue;
        const auto& bodies = model.bodies;
        return "step " + std::to_string(witness.step + 1) + ": '" + bodies[a].name + "' and '" + bodies[b].name +
               "' are nearest beside a node inside the step, which the solver's way to the step's end left there: where that is has no "
               "derivative; shorter steps, or ones that end where tables change, have fewer such nodes";
    }
    return {};
}

}  // namespace fettle::adjoint::clearance
