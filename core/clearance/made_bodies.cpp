// SPDX-License-Identifier: MIT
#include "core/clearance/made_bodies.hpp"

#include "core/expression/tape.hpp"
#include "core/kinematics/rotation.hpp"

namespace fettle::core::clearance {
namespace {

kinematics::Pose composed_pose(const kinematics::Pose& outer, const kinematics::Pose& inner) {
    return {outer.rotation * inner.rotation, outer.rotation * inner.position + outer.position};
}

}  // namespace

MadeBodies::MadeBodies(const certificate::Toleranced& toleranced, const std::vector<double>& deviations)
    : toleranced_(toleranced), values_(expression::values<double>(toleranced.nodes, deviations)) {}

kinematics::Pose MadeBodies::pose(int body, const std::vector<double>& coordinates) const {
    kinematics::Pose out;
    for (int at = body; at >= 0; at = toleranced_.bodies[at].parent) {
        const certificate::TolerancedBody& from = toleranced_.bodies[at];
        kinematics::Pose start;
        for (std::size_t i = 0; i < 3; ++i) start.rotation.row(static_cast<Eigen::Index>(i)) = point(from.rotation[i]).transpose();
        start.position = point(from.place);
        out = composed_pose(start, out);
        for (auto screw = from.screws.rbegin(); screw != from.screws.rend(); ++screw) {
            double d = coordinates[screw->coordinate] - toleranced_.coordinates[screw->coordinate].start;
            if (screw->driven) d = values_[screw->driven->shift] + values_[screw->driven->scale] * d;
            const Vector3 p = point(screw->point), z = point(screw->axis);
            const Matrix3 turn = kinematics::rotation(Vector3(screw->turn * d * z));
            out = composed_pose({turn, p - turn * p + screw->slide * d * z}, out);
        }
    }
    return out;
}

Vector3 MadeBodies::vertex(int body, const Matrix3X& mesh, int index) const {
    const auto& nodes = toleranced_.bodies[body].vertices;
    return nodes.empty() ? Vector3(mesh.col(index)) : point(nodes[index]);
}

Matrix3X MadeBodies::vertices(int body, const Matrix3X& mesh) const {
    Matrix3X out = mesh;
    for (Eigen::Index i = 0; i < out.cols(); ++i) out.col(i) = vertex(body, mesh, static_cast<int>(i));
    return out;
}

std::vector<double> base_deviations(const certificate::Toleranced& toleranced) {
    std::vector<double> out;
    for (const certificate::Deviation& d : toleranced.deviations) out.push_back(d.base);
    return out;
}

std::vector<double> start_coordinates(const certificate::Toleranced& toleranced) {
    std::vector<double> out;
    for (const certificate::LinkageCoordinate& c : toleranced.coordinates) out.push_back(c.start);
    return out;
}

}  // namespace fettle::core::clearance
