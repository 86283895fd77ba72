// SPDX-License-Identifier: MIT
#include "core/clearance/looped_ranges.hpp"

#include <Eigen/Geometry>
#include <Eigen/QR>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <string>

#include "core/base/text.hpp"

namespace fettle::core::clearance {
namespace {

using base::ErrorCode;
using base::Errors;
using certificate::Linkage;
using model::Joint;

constexpr double beyond_reach = 1e3;      // [m], [rad]: limits of what needs none
constexpr double dependent_share = 1e-6;  // of the largest, below which a condition follows from others

bool is_joint(const Joint& joint) { return !joint.is_motor && joint.frame_a >= 0; }

class LoopFinder {
public:
    LoopFinder(const model::Model& model, bool is_pinned) : model_(model), tree_(model), is_pinned_(is_pinned) {}

    bool has_loops() {
        open_loops();
        return !closing_.empty();
    }

    base::Result<LoopedRanges> run() {
        open_loops();
        if (!errors_.empty()) return errors_;
        base::Result<JointRanges> ranges = joint_ranges(tree_);
        if (!ranges) return ranges.errors();
        out_.ranges = *std::move(ranges);
        group();
        for (ClosedLoop& loop : out_.loops) settle(loop);
        if (!errors_.empty()) return errors_;
        hold();
        out_.of = is_pinned_ ? LoopedRanges::Of::start : LoopedRanges::Of::joints;
        return std::move(out_);
    }

private:
    void fail(const std::vector<int>& joints, const std::string& message) {
        std::vector<std::string> names;
        for (const int k : joints) names.push_back("`" + model_.mechanism.joints[k].name + "`");
        errors_.push_back({ErrorCode::unsupported, "joint " + base::joined(names), message});
    }

    int node_of(int body) const {
        const bool is_world = body < 0 || model_.bodies[body].type == scene::BodyType::static_body;
        return is_world ? 0 : body + 1;
    }
    int root_of(int node) {
        while (group_of_[node] != node) node = group_of_[node];
        return node;
    }
    bool is_driven(const Joint& joint) const {
        return std::any_of(model_.mechanism.joints.begin(), model_.mechanism.joints.end(), [&](const Joint& motor) {
            return motor.is_motor && joint.coordinate >= 0 && motor.coordinate == joint.coordinate;
        });
    }

    // What motors drive is in the tree; of the rest, those close a loop that come last.
    void open_loops() {
        group_of_.resize(model_.bodies.size() + 1);
        std::iota(group_of_.begin(), group_of_.end(), 0);
        auto& joints = tree_.mechanism.joints;
        for (const bool driven : {true, false})
            for (int k = 0; k < count_of(joints); ++k) {
                if (!is_joint(model_.mechanism.joints[k]) || is_driven(model_.mechanism.joints[k]) != driven) continue;
                const int a = node_of(joints[k].a), b = node_of(joints[k].b);
                if (a == 0 && b == 0) continue;
                if (root_of(a) != root_of(b)) {
                    group_of_[root_of(a)] = root_of(b);
                    continue;
                }
                if (joints[k].kind != scene::JointKind::revolute)
                    fail({k}, "closes a loop; of the joints of a loop that no motor drives the last in the list has to be a revolute one");
                closing_.push_back(k);
                joints[k].is_motor = true;  // so that it is none of the tree's
            }
        if (!closing_.empty() || is_pinned_) give_limits();
    }

    // To what may follow from others.
    void give_limits() {
        auto& mechanism = tree_.mechanism;
        for (const Joint& joint : model_.mechanism.joints) {
            const bool slides = joint.kind == scene::JointKind::prismatic || joint.kind == scene::JointKind::cylindrical ||
                                joint.kind == scene::JointKind::screw;
            const bool has_limits = std::any_of(mechanism.terms.begin(), mechanism.terms.end(), [&](const model::MeasureTerm& term) {
                return term.kind == model::LawKind::stop && term.measure == joint.coordinate;
            });
            if (!is_joint(joint) || !slides || has_limits || joint.coordinate < 0) continue;
            for (const double sign : {1.0, -1.0}) {
                model::MeasureTerm stop;
                stop.kind = model::LawKind::stop;
                stop.measure = joint.coordinate;
                stop.sign = sign;
                stop.reference = -sign * beyond_reach;
                mechanism.terms.push_back(stop);
            }
        }
    }

    std::vector<int> line_of(int body) const {
        std::vector<int> out;
        for (int at = body; at >= 0; at = out_.ranges.linkage.bodies[at].parent) out.push_back(at);
        return out;
    }
    // Bodies from either end of a closing joint to below what carries both.
    std::array<std::vector<int>, 2> lines_of(const Joint& joint) const {
        std::vector<int> a = line_of(joint.a), b = line_of(joint.b);
        while (!a.empty() && !b.empty() && a.back() == b.back()) {
            a.pop_back();
            b.pop_back();
        }
        return {a, b};
    }
    std::set<int> coordinates_of(const Joint& joint) const {
        std::set<int> out;
        for (const std::vector<int>& line : lines_of(joint))
            for (const int body : line)
                for (const certificate::Screw& screw : out_.ranges.linkage.bodies[body].screws) out.insert(screw.coordinate);
        return out;
    }
    bool is_driver(int coordinate) const {
        for (const certificate::JointCoordinate& joint : out_.ranges.linkage.coordinates[coordinate].joints)
            for (const Joint& each : model_.mechanism.joints)
                if (each.name == joint.joint && is_joint(each) && is_driven(each)) return true;
        return false;
    }

    void group() {
        for (const int k : closing_) {
            ClosedLoop loop;
            loop.closing = {k};
            std::set<int> all = coordinates_of(model_.mechanism.joints[k]);
            const auto shares = [&](const ClosedLoop& other) {
                return std::any_of(other.unknowns.begin(), other.unknowns.end(), [&](int c) { return all.count(c) > 0 && !is_driver(c); });
            };
            for (auto other = out_.loops.begin(); other != out_.loops.end();) {
                if (!shares(*other)) {
                    ++other;
                    continue;
                }
                loop.closing.insert(loop.closing.end(), other->closing.begin(), other->closing.end());
                all.insert(other->unknowns.begin(), other->unknowns.end());
                other = out_.loops.erase(other);
            }
            loop.unknowns.assign(all.begin(), all.end());
            out_.loops.push_back(loop);
        }
    }

    void settle(ClosedLoop& loop) {
        std::vector<int> drivers, limited;
        for (const int c : loop.unknowns) {
            if (is_driver(c)) drivers.push_back(c);
            const certificate::LinkageCoordinate& coordinate = out_.ranges.linkage.coordinates[c];
            if (!coordinate.is_whole_turn && coordinate.high - coordinate.low < beyond_reach) limited.push_back(c);
        }
        if (drivers.empty() && limited.size() == 1) drivers = limited;
        if (drivers.size() != 1) {
            fail(loop.closing, drivers.empty() ? "closes a loop that nothing drives: give one of its joints a motor, or limits to one alone"
                                               : "closes a loop that more than one motor drives: one is expected");
            return;
        }
        loop.driver = drivers.front();
        std::erase(loop.unknowns, loop.driver);
        const MatrixX slopes = conditions_of(loop);
        const Eigen::ColPivHouseholderQR<MatrixX> qr(slopes.transpose());
        const auto n = static_cast<Eigen::Index>(loop.unknowns.size());
        const VectorX pivots = qr.matrixR().diagonal().cwiseAbs();
        if (pivots.size() < n || !(pivots[n - 1] > dependent_share * pivots[0])) {
            fail(loop.closing,
                 "closes a loop whose other joints do not follow from what drives it where it starts: is it at a dead centre, "
                 "or has it more freedom than one coordinate?");
            return;
        }
        for (Eigen::Index i = 0; i < n; ++i) loop.rows.push_back(static_cast<int>(qr.colsPermutation().indices()[i]));
        std::sort(loop.rows.begin(), loop.rows.end());
    }

    // d(conditions)/d(unknowns) at the start; angles count as much as the bodies' size.
    MatrixX conditions_of(const ClosedLoop& loop) const {
        MatrixX out = MatrixX::Zero(6 * count_of(loop.closing), count_of(loop.unknowns));
        std::vector<kinematics::Pose> poses;
        for (const model::Body& body : model_.bodies) poses.push_back(body.pose_start);
        for (int c = 0; c < count_of(loop.closing); ++c) {
            const Joint& joint = model_.mechanism.joints[loop.closing[c]];
            const measure::PlacedFrame frame = placed(model_.mechanism.set.frames[joint.frame_a], poses);
            const auto lines = lines_of(joint);
            for (const std::size_t side : {0U, 1U})
                for (const int body : lines[side])
                    for (const certificate::Screw& screw : out_.ranges.linkage.bodies[body].screws) {
                        const auto at = std::find(loop.unknowns.begin(), loop.unknowns.end(), screw.coordinate);
                        if (at == loop.unknowns.end()) continue;
                        const double sign = side == 0 ? 1 : -1;
                        const auto column = at - loop.unknowns.begin();
                        const Vector3 z = frame.axes.col(2);
                        out.col(column).segment<3>(6 * c) +=
                            sign * (screw.turn * screw.axis.cross(frame.point - screw.point) + screw.slide * screw.axis);
                        out.col(column).segment<3>(6 * c + 3) += sign * model_.diagonal * screw.turn * screw.axis.cross(z).cross(z);
                    }
        }
        return out;
    }

    void hold() {
        auto& coordinates = out_.ranges.linkage.coordinates;
        const auto stand = [](certificate::LinkageCoordinate& c) {
            c.low = c.high = c.start;
            c.is_whole_turn = false;
        };
        for (const ClosedLoop& loop : out_.loops)
            for (const int c : loop.unknowns) stand(coordinates[c]);
        if (!is_pinned_) return;
        std::for_each(coordinates.begin(), coordinates.end(), stand);
        out_.ranges.narrowed.clear();  // limits of ranges that nothing is asked over
        out_.ranges.lost.clear();
    }

    const model::Model& model_;
    model::Model tree_;
    bool is_pinned_;
    std::vector<int> closing_, group_of_;
    LoopedRanges out_;
    Errors errors_;
};

}  // namespace

bool closes_loops(const model::Model& model) { return LoopFinder(model, false).has_loops(); }

base::Result<LoopedRanges> looped_ranges(const model::Model& model, bool is_pinned) { return LoopFinder(model, is_pinned).run(); }

}  // namespace fettle::core::clearance
