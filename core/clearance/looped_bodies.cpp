// SPDX-License-Identifier: MIT
#include "core/clearance/looped_bodies.hpp"

namespace fettle::core::clearance {
namespace {

using certificate::NodePoint;
using certificate::Toleranced;
using kinematics::Pose;

class LoopedRecord {
public:
    LoopedRecord(const model::Model& model, const LoopedRanges& looped) : model_(model), looped_(looped) {}

    Toleranced run() {
        out_.coordinates = looped_.ranges.linkage.coordinates;
        for (int i = 0; i < count_of(model_.bodies); ++i) add_body(i);
        for (const ClosedLoop& loop : looped_.loops) add_loop(loop);
        return std::move(out_);
    }

private:
    NodePoint constant(const Vector3& x) {
        NodePoint out{};
        for (std::size_t k = 0; k < 3; ++k) {
            out[k] = count_of(out_.nodes);
            out_.nodes.push_back({expression::Operation::constant, {0, 0, 0}, x[static_cast<Eigen::Index>(k)]});
        }
        return out;
    }

    Pose start(int body) const { return body < 0 ? Pose{} : model_.bodies[body].pose_start; }

    void add_body(int i) {
        const certificate::LinkedBody& link = looped_.ranges.linkage.bodies[i];
        const Pose parent = start(link.parent), own = start(i);
        const Matrix3 to_parent = parent.rotation.transpose();
        certificate::TolerancedBody body;
        body.parent = link.parent;
        const Matrix3 rotation = to_parent * own.rotation;
        for (std::size_t k = 0; k < 3; ++k) body.rotation[k] = constant(rotation.row(static_cast<Eigen::Index>(k)).transpose());
        body.place = constant(to_parent * (own.position - parent.position));
        for (const certificate::Screw& screw : link.screws)
            body.screws.push_back({screw.coordinate, constant(to_parent * (screw.point - parent.position)),
                                   constant(to_parent * screw.axis), screw.turn, screw.slide});
        out_.bodies.push_back(std::move(body));
    }

    void add_loop(const ClosedLoop& from) {
        certificate::TolerancedLoop loop;
        loop.unknowns = from.unknowns;
        loop.rows = from.rows;
        loop.size = model_.diagonal;
        for (const int k : from.closing) {
            const model::Joint& joint = model_.mechanism.joints[k];
            const measure::Frame &a = model_.mechanism.set.frames[joint.frame_a], &b = model_.mechanism.set.frames[joint.frame_b];
            loop.closures.push_back(
                {joint.a, joint.b, constant(a.point), constant(a.axes.col(2)), constant(b.point), constant(b.axes.col(2))});
        }
        out_.loops.push_back(std::move(loop));
    }

    const model::Model& model_;
    const LoopedRanges& looped_;
    Toleranced out_;
};

}  // namespace

Toleranced looped_bodies(const model::Model& model, const LoopedRanges& looped) { return LoopedRecord(model, looped).run(); }

}  // namespace fettle::core::clearance
