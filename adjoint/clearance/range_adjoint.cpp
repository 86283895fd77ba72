// SPDX-License-Identifier: MIT
#include "adjoint/clearance/range_adjoint.hpp"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <set>

#include "adjoint/clearance/clearance_adjoint.hpp"
#include "core/clearance/clearance.hpp"
#include "core/kinematics/rotation.hpp"
#include "core/kinematics/tangent_system.hpp"
#include "core/model/limits.hpp"
#include "core/model/row_choice.hpp"

namespace fettle::adjoint::clearance {
namespace {

using core::certificate::LinkageCoordinate;
using core::certificate::Screw;
using core::clearance::JointRanges;
using core::clearance::PairClearance;
using core::kinematics::Pose;
using core::model::Joint;
using core::model::Model;
using core::stepper::Trajectory;

struct WrenchAbout {
    Vector3 force, torque;  // the torque about `about`
    Vector3 about;
};

// A screw on the way from the world to a body, outermost first.
struct Link {
    Screw screw;
    int body = 0;       // that it hangs
    std::size_t k = 0;  // its coordinate's place among the pair's
    double d = 0;
};

std::vector<Link> links_of(const JointRanges& ranges, const PairClearance& pair, int body) {
    const core::certificate::Linkage& linkage = ranges.linkage;
    const auto parent = [&](int of) { return linkage.bodies[of].parent; };
    std::set<int> of_other;
    for (int k = body == pair.a ? pair.b : pair.a; k >= 0; k = parent(k)) of_other.insert(k);
    std::vector<int> line;
    for (int k = body; k >= 0 && of_other.count(k) == 0; k = parent(k)) line.push_back(k);
    std::vector<Link> links;
    for (auto each = line.rbegin(); each != line.rend(); ++each) {
        for (const Screw& screw : linkage.bodies[*each].screws) {
            const auto place = std::find(pair.coordinates.begin(), pair.coordinates.end(), screw.coordinate);
            if (place == pair.coordinates.end()) continue;
            const auto k = static_cast<std::size_t>(place - pair.coordinates.begin());
            links.push_back({screw, *each, k, pair.at[k] - linkage.coordinates[screw.coordinate].start});
        }
    }
    return links;
}

Matrix3 turn_of(const Link& link) { return core::kinematics::rotation(link.screw.turn * link.d * link.screw.axis); }

// Into the frame of what the screw moves.
WrenchAbout before(const Link& link, const Matrix3& turn, const WrenchAbout& w) {
    const Screw& s = link.screw;
    const Vector3 about = s.point + turn.transpose() * (w.about - s.point - s.slide * link.d * s.axis);
    return {turn.transpose() * w.force, turn.transpose() * w.torque, about};
}

// About the screw's point, of what its turn alone has moved.
Vector3 moment_about(const Link& link, const WrenchAbout& w) {
    const Vector3 arm = w.about - link.screw.point - link.screw.slide * link.d * link.screw.axis;
    return w.torque + arm.cross(w.force);
}

double coordinate_bar(const Link& link, const WrenchAbout& w) {
    return link.screw.turn * link.screw.axis.dot(moment_about(link, w)) + link.screw.slide * link.screw.axis.dot(w.force);
}

// On the two bodies at the witness; both zero where the distance is 0.
std::array<WrenchAbout, 2> wrenches(const Trajectory& posed, const PairClearance& pair, const ClearanceGradient& gradient) {
    std::array<WrenchAbout, 2> out;
    for (int i = 0; i < 2; ++i) {
        const int body = i == 0 ? pair.a : pair.b;
        out[i] = {Vector3::Zero(), Vector3::Zero(), posed.poses[0][body].position};
        for (const auto& part : gradient.poses) {
            if (part.body != body) continue;
            out[i].force += part.bar.head<3>();
            out[i].torque += part.bar.tail<3>();
        }
    }
    return out;
}

// Distance of the witness's primitives where the coordinates are, and its derivative in them; 0: they meet.
struct Evaluated {
    double distance = 0;
    VectorX slope;
    Vector3 point_a, point_b;
};

Evaluated evaluated(const Model& model, const JointRanges& ranges, const PairClearance& pair) {
    const Trajectory posed = at_witness(model, ranges, pair);
    const ClearanceGradient gradient = clearance_gradient(model, posed, pair.a, pair.b, pair.witness);
    Evaluated out{0, VectorX::Zero(static_cast<Eigen::Index>(pair.at.size())), Vector3::Zero(), Vector3::Zero()};
    const auto loads = wrenches(posed, pair, gradient);
    const Vector3 n = loads[0].force;  // the weights of a's vertices add up to 1
    for (const auto& part : gradient.vertices) {
        const Pose& pose = posed.poses[0][part.body];
        const Vector3 x = core::kinematics::world_position(pose, model.bodies[part.body].mesh.vertices.col(part.vertex));
        const double weight = n.dot(pose.rotation * part.bar);
        if (part.body == pair.a)
            out.point_a += weight * x;
        else
            out.point_b -= weight * x;
    }
    out.distance = (out.point_a - out.point_b).norm();
    for (int i = 0; i < 2; ++i) {
        WrenchAbout w = loads[i];
        for (const Link& link : links_of(ranges, pair, i == 0 ? pair.a : pair.b)) {
            out.slope[static_cast<Eigen::Index>(link.k)] += coordinate_bar(link, w);
            w = before(link, turn_of(link), w);
        }
    }
    return out;
}

// The end of its range that a coordinate is at: -1 the lower, 1 the upper one, 0 between.
int end_of(const LinkageCoordinate& coordinate, double at) {
    if (coordinate.is_whole_turn) return 0;
    const double near = 1e-9 * (coordinate.high - coordinate.low);
    return at <= coordinate.low + near ? -1 : at >= coordinate.high - near ? 1 : 0;
}

class RangeAdjoint {
public:
    /// @param held  a coordinate whose value stays what it is; -1: none
    RangeAdjoint(const Model& model, const JointRanges& ranges, const PairClearance& pair, double scale, ModelGradient& bar, int held = -1)
        : model_(model), ranges_(ranges), pair_(pair), scale_(scale), bar_(bar), held_(held) {
        for (const core::model::Body& body : model.bodies) start_.push_back(body.pose_start);
        frames_ = core::measure::placed(model.mechanism.set.frames, start_);
        coordinate_bar_.assign(pair.at.size(), 0.0);
        for (const int k : pair.coordinates) scale_bar_.emplace_back(ranges.linkage.coordinates[k].joints.size(), 0.0);
    }

    std::string run() {
        const Trajectory posed = at_witness(model_, ranges_, pair_);
        const ClearanceGradient gradient = clearance_gradient(model_, posed, pair_.a, pair_.b, pair_.witness);
        if (!gradient.refusal.empty()) return gradient.refusal;
        if (std::string refusal = refusal_of_swings(); !refusal.empty()) return refusal;
        for (const auto& part : gradient.vertices) bar_.bodies[part.body].vertices_bar.col(part.vertex) += scale_ * part.bar;
        const auto loads = wrenches(posed, pair_, gradient);
        for (int i = 0; i < 2; ++i) reverse(i == 0 ? pair_.a : pair_.b, loads[i]);
        for (std::size_t k = 0; k < coordinate_bar_.size(); ++k) {
            reverse_coordinate(k);
            reverse_couplings(k);
        }
        return {};
    }

private:
    // At the end of a swing what the start's own swing is matters, which has no derivative where the axes are one.
    std::string refusal_of_swings() const {
        for (std::size_t k = 0; k < pair_.at.size(); ++k) {
            const int c = pair_.coordinates[k];
            if (ranges_.direction_of[c] < 0 || (c != held_ && end_of(coordinate_at(k), pair_.at[k]) <= 0)) continue;
            return "a clearance at the end of the swing of `" + coordinate_at(k).joints.front().joint + "` has no derivative";
        }
        return {};
    }

    void reverse(int body, WrenchAbout w) {
        w.force *= scale_;
        w.torque *= scale_;
        for (const Link& link : links_of(ranges_, pair_, body)) {
            const Screw& s = link.screw;
            const Matrix3 turn = turn_of(link);
            const Vector3 moment = moment_about(link, w);
            const Matrix3 jacobian = core::kinematics::left_jacobian(s.turn * link.d * s.axis);
            reverse_frame(link, w.force - turn.transpose() * w.force,
                          s.turn * link.d * (jacobian.transpose() * moment) + s.slide * link.d * w.force);
            const std::size_t joint = joint_of(link);
            const double scale = coordinate_at(link.k).joints[joint].scale, d_bar = coordinate_bar(link, w);
            reverse_pitch(link, scale * link.d * s.axis.dot(w.force));
            coordinate_bar_[link.k] += d_bar;
            scale_bar_[link.k][joint] += link.d * d_bar / scale;  // the screw's turn and slide have it as a factor
            w = before(link, turn, w);
        }
        add_to_start(body, w.force, w.torque);
    }

    void add_to_start(int body, const Vector3& force, const Vector3& torque) {
        if (body == core::measure::world) return;
        Matrix34& out = bar_.bodies[body].pose_start_bar;
        out.leftCols<3>() += 0.5 * cross_matrix(torque) * start_[body].rotation;
        out.col(3) += force;
    }

    // Reverses a point and an axis in the world at the start.
    void reverse_frame(const Link& link, const Vector3& point_bar, const Vector3& axis_bar) {
        const Joint& joint = model_.mechanism.joints[ranges_.joint_of[link.body]];
        reverse_point(frames_[joint.frame_a].point == link.screw.point ? joint.frame_a : joint.frame_b, point_bar);
        for (const int frame : {joint.frame_a, joint.frame_b})
            for (const Eigen::Index column : {2, 1, 0})
                if (frames_[frame].axes.col(column) == link.screw.axis) return reverse_axis(frame, column, axis_bar);
        // That of a swing from where the axes stand apart: the direction of a swing is stationary, so that it has no effect.
    }

    Matrix3 rotation_of(int body) const { return body == core::measure::world ? Matrix3(Matrix3::Identity()) : start_[body].rotation; }

    void reverse_point(int frame, const Vector3& point_bar) {
        const int body = model_.mechanism.set.frames[frame].body;
        bar_.mechanism.frames[frame].point += rotation_of(body).transpose() * point_bar;
        add_to_start(body, point_bar, frames_[frame].arm.cross(point_bar));
    }

    void reverse_axis(int frame, Eigen::Index column, const Vector3& axis_bar) {
        const int body = model_.mechanism.set.frames[frame].body;
        bar_.mechanism.frames[frame].axes.col(column) += rotation_of(body).transpose() * axis_bar;
        add_to_start(body, Vector3::Zero(), Vector3(frames_[frame].axes.col(column)).cross(axis_bar));
    }

    const LinkageCoordinate& coordinate_at(std::size_t k) const { return ranges_.linkage.coordinates[pair_.coordinates[k]]; }

    const Joint* joint_called(const std::string& name) const {
        const auto& joints = model_.mechanism.joints;
        const auto found =
            std::find_if(joints.begin(), joints.end(), [&](const Joint& each) { return !each.is_motor && each.name == name; });
        return found == joints.end() ? nullptr : &*found;
    }

    // The place, among those that its coordinate moves, of the joint whose screw it is.
    std::size_t joint_of(const Link& link) const {
        const auto& joints = coordinate_at(link.k).joints;
        const std::string& name = model_.mechanism.joints[ranges_.joint_of[link.body]].name;
        const auto found = std::find_if(joints.begin(), joints.end(), [&](const auto& each) { return each.joint == name; });
        return found == joints.end() ? 0 : static_cast<std::size_t>(found - joints.begin());  // the turn of a cylindrical joint is alone
    }

    // slide = -sense * factor of the row slide + factor angle = constant.
    void reverse_pitch(const Link& link, double slide_bar) {
        const int joint = ranges_.joint_of[link.body];
        if (model_.mechanism.joints[joint].kind != core::scene::JointKind::screw) return;
        const double sense = link.body == model_.mechanism.joints[joint].b ? 1 : -1;
        for (const core::constraint::Row& row : all_rows(model_.mechanism))
            if (row.owner == joint && row.parts.size() == 2) bar_.mechanism.row_factors[row.number][1] -= sense * slide_bar;
    }

    // d = at - start. At an end of the range `at` is that of a joint's limit, d = (limit - start of that joint) / its scale.
    void reverse_coordinate(std::size_t k) {
        const LinkageCoordinate& coordinate = coordinate_at(k);
        const bool is_held = pair_.coordinates[k] == held_;
        const int end = end_of(coordinate, pair_.at[k]);
        const double d_bar = coordinate_bar_[k];
        if ((end == 0 && !is_held) || d_bar == 0) return;  // the distance is stationary there
        for (std::size_t j = 0; j < coordinate.joints.size() && !is_held; ++j)
            if (reverse_limit(k, j, end)) return;
        // The range of what starts at its limit begins where it starts, which is that to within rounding; the turn of a cylindrical joint
        // has no limits.
        if (const Joint* first = joint_called(coordinate.joints.front().joint); first != nullptr && first->coordinate >= 0)
            reverse_value(first->coordinate, -d_bar);
    }

    // @return does that joint's limit end the range?
    bool reverse_limit(std::size_t k, std::size_t j, int end) {
        const LinkageCoordinate& coordinate = coordinate_at(k);
        const auto& [name, is_angle, scale, offset] = coordinate.joints[j];
        const Joint* joint = joint_called(name);
        if (joint == nullptr || joint->coordinate < 0) return false;
        const double u = end < 0 ? coordinate.low : coordinate.high, d_bar = coordinate_bar_[k];
        const auto& terms = model_.mechanism.terms;
        for (std::size_t t = 0; t < terms.size(); ++t) {
            const bool is_it = terms[t].kind == core::model::LawKind::stop && terms[t].measure == joint->coordinate &&
                               terms[t].sign * scale * end < 0 &&
                               std::abs(core::model::room_within(terms[t], scale * u + offset)) <= core::model::at_limit * model_.dhat;
            if (!is_it) continue;
            bar_.mechanism.term_reference[t] += d_bar / scale;
            reverse_value(joint->coordinate, -d_bar / scale);
            scale_bar_[k][j] -= d_bar * (pair_.at[k] - coordinate.start) / scale;
            return true;
        }
        return false;
    }

    // A coupling's row, from the joint whose scale is known before to the other: their places, those of their parts, and their factors.
    struct Coupling {
        int row = 0;
        std::size_t from = 0, to = 0, part_from = 0, part_to = 0;
        double factor_from = 1, factor_to = 1;
    };

    // f_from scale_from + f_to scale_to = 0, from the first joint on, whose scale is 1.
    void reverse_couplings(std::size_t k) {
        const auto& joints = coordinate_at(k).joints;
        const std::vector<Coupling> couplings = couplings_of(k);
        for (auto each = couplings.rbegin(); each != couplings.rend(); ++each) {
            const double bar = scale_bar_[k][each->to] / each->factor_to;
            std::vector<double>& factors_bar = bar_.mechanism.row_factors[each->row];
            factors_bar[each->part_from] -= bar * joints[each->from].scale;
            factors_bar[each->part_to] -= bar * joints[each->to].scale;
            scale_bar_[k][each->from] -= bar * each->factor_from;
        }
    }

    std::vector<Coupling> couplings_of(std::size_t k) const {
        const auto& joints = coordinate_at(k).joints;
        std::vector<int> measures;
        for (const auto& each : joints) {
            const Joint* joint = joint_called(each.joint);
            measures.push_back(joint == nullptr ? -1 : joint->coordinate);
        }
        std::vector<Coupling> out;
        std::vector<bool> known(joints.size(), false);
        if (!known.empty()) known[0] = true;
        const auto place = [&](int measure) {
            return static_cast<std::size_t>(std::find(measures.begin(), measures.end(), measure) - measures.begin());
        };
        const std::vector<core::constraint::Row> rows = all_rows(model_.mechanism);
        for (std::size_t found = 1, before = 0; found > before;) {  // until none is reached any more
            before = found;
            for (const core::constraint::Row& row : rows) {
                if (!couples_joints(model_.mechanism.joints[row.owner].kind) || row.parts.size() != 2) continue;
                const auto& [first, second] = std::pair(row.parts[0], row.parts[1]);
                const std::size_t a = place(first.measure), b = place(second.measure);
                if (a == joints.size() || b == joints.size() || known[a] == known[b]) continue;
                out.push_back(known[a] ? Coupling{row.number, a, b, 0, 1, first.factor, second.factor}
                                       : Coupling{row.number, b, a, 1, 0, second.factor, first.factor});
                known[a] = known[b] = true;
                ++found;
            }
        }
        return out;
    }

    // Reverses a measure's value at the start.
    void reverse_value(int measure, double value_bar) {
        const core::measure::Measure& m = model_.mechanism.set.measures[measure];
        const core::measure::VectorFunction f = core::measure::vector_function(m, frames_);
        std::vector<Matrix3> rotations;
        for (const core::measure::Frame& frame : model_.mechanism.set.frames)
            rotations.push_back(frame.body == core::measure::world ? Matrix3(Matrix3::Identity()) : start_[frame.body].rotation);
        core::measure::add_placement_gradient(f, value_bar, rotations, bar_.mechanism.frames);
        const core::measure::PoseGradients g = core::measure::pose_gradients(m, f, frames_);
        const auto add = [&](int frame, const core::kinematics::PoseGradient& of) {
            const Vector6 tangent = value_bar * core::kinematics::tangent_gradient(of);
            add_to_start(model_.mechanism.set.frames[frame].body, tangent.head<3>(), tangent.tail<3>());
        };
        add(m.a, g.a);
        add(m.b, g.b);
    }

    const Model& model_;
    const JointRanges& ranges_;
    const PairClearance& pair_;
    const double scale_;
    ModelGradient& bar_;
    const int held_;
    std::vector<Pose> start_;
    std::vector<core::measure::PlacedFrame> frames_;
    std::vector<double> coordinate_bar_;
    std::vector<std::vector<double>> scale_bar_;  // of each coordinate's joints
};

constexpr int most_settling_steps = 30;

// A step of Newton's in the coordinates that are not held at an end, by differences of the slope; no longer than a tenth of the ranges.
VectorX settling_step(const Model& model, const JointRanges& ranges, const PairClearance& pair, const Evaluated& here) {
    const auto n = static_cast<Eigen::Index>(pair.at.size());
    std::vector<Eigen::Index> free;
    VectorX widths(n);
    for (Eigen::Index k = 0; k < n; ++k) {
        const LinkageCoordinate& c = ranges.linkage.coordinates[pair.coordinates[k]];
        widths[k] = c.high - c.low;
        const int end = end_of(c, pair.at[k]);
        if (widths[k] > 0 && !(end != 0 && end * here.slope[k] <= 0)) free.push_back(k);
    }
    VectorX step = VectorX::Zero(n);
    if (free.empty()) return step;
    const auto count = static_cast<Eigen::Index>(free.size());
    MatrixX hessian(count, count);
    VectorX slope(count);
    for (Eigen::Index j = 0; j < count; ++j) {
        slope[j] = here.slope[free[j]];
        PairClearance ahead = pair, behind = pair;
        const double h = 1e-5 * widths[free[j]];
        ahead.at[free[j]] += h;
        behind.at[free[j]] -= h;
        const VectorX change = (evaluated(model, ranges, ahead).slope - evaluated(model, ranges, behind).slope) / (2 * h);
        for (Eigen::Index i = 0; i < count; ++i) hessian(i, j) = change[free[i]];
    }
    hessian = 0.5 * (hessian + hessian.transpose()).eval();
    const Eigen::LLT<MatrixX> factor(hessian);
    VectorX move(count);
    if (factor.info() == Eigen::Success) {
        move = -factor.solve(slope);
    } else {  // downhill, towards an end
        for (Eigen::Index i = 0; i < count; ++i) move[i] = slope[i] > 0 ? -0.1 * widths[free[i]] : slope[i] < 0 ? 0.1 * widths[free[i]] : 0;
    }
    for (Eigen::Index i = 0; i < count; ++i) step[free[i]] = std::clamp(move[i], -0.1 * widths[free[i]], 0.1 * widths[free[i]]);
    return step;
}

}  // namespace

Trajectory at_witness(const Model& model, const JointRanges& ranges, const PairClearance& pair) {
    Trajectory out = core::clearance::as_assembled(model);
    for (int body = 0; body < count_of(model.bodies); ++body)
        out.poses.front()[body] = core::clearance::pose_at_witness(model, ranges, pair, body);
    return out;
}

PairClearance settled_witness(const Model& model, const JointRanges& ranges, PairClearance pair) {
    if (pair.is_clash() || !(pair.witness.distance > 0) || pair.at.empty()) return pair;
    const double rounding = pair.upper - pair.witness.distance;
    Evaluated here = evaluated(model, ranges, pair);
    for (int tries = 0; tries < most_settling_steps; ++tries) {
        VectorX step = settling_step(model, ranges, pair, here);
        if (step.isZero(0)) break;
        PairClearance next = pair;
        Evaluated there;
        bool is_nearer = false;
        for (int halvings = 0; halvings < 12 && !is_nearer; ++halvings, step *= 0.5) {
            for (std::size_t k = 0; k < pair.at.size(); ++k) {
                const LinkageCoordinate& c = ranges.linkage.coordinates[pair.coordinates[k]];
                const double to = pair.at[k] + step[static_cast<Eigen::Index>(k)];
                next.at[k] = c.is_whole_turn ? to : std::clamp(to, c.low, c.high);
            }
            there = evaluated(model, ranges, next);
            is_nearer = there.distance > 0 && there.distance < here.distance;
        }
        if (!is_nearer) break;
        pair.at = next.at;
        here = there;
    }
    if (!(here.distance > 0 && here.distance <= pair.witness.distance)) return pair;
    pair.witness.distance = here.distance;
    pair.witness.point_a = here.point_a;
    pair.witness.point_b = here.point_b;
    pair.upper = std::max(pair.lower, here.distance + rounding);
    pair.witnesses = {pair.witness};
    return pair;
}

std::string range_clearance_adjoint(const Model& model, const JointRanges& ranges, const PairClearance& pair, double scale,
                                    ModelGradient& bar) {
    return RangeAdjoint(model, ranges, pair, scale, bar).run();
}

WitnessSlope witness_slope(const Model& model, const JointRanges& ranges, const PairClearance& pair, int coordinate) {
    const Evaluated here = evaluated(model, ranges, pair);
    const auto place = std::find(pair.coordinates.begin(), pair.coordinates.end(), coordinate);
    return {here.distance, place == pair.coordinates.end() ? 0 : here.slope[place - pair.coordinates.begin()]};
}

std::string range_end_adjoint(const Model& model, const JointRanges& ranges, const PairClearance& pair, int coordinate, double scale,
                              ModelGradient& bar) {
    const WitnessSlope here = witness_slope(model, ranges, pair, coordinate);
    if (!(std::abs(here.slope) > 0))
        return "the end of a free range has no derivative: `" + model.bodies[pair.a].name + "` and `" + model.bodies[pair.b].name +
               "` come no nearer as the joint moves on";
    return RangeAdjoint(model, ranges, pair, -scale / here.slope, bar, coordinate).run();
}

}  // namespace fettle::adjoint::clearance
