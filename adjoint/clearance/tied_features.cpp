// SPDX-License-Identifier: MIT
#include "adjoint/clearance/tied_features.hpp"

#include <tuple>
#include <utility>

#include "core/geometry/distance.hpp"
#include "core/geometry/overlapping_boxes.hpp"

namespace fettle::adjoint::clearance {
namespace {

using core::clearance::Primitive;
using core::clearance::Witness;
using core::geometry::Box;
using core::geometry::ClosestPoints;
using core::geometry::Mesh;
using core::kinematics::Pose;

struct Feature {
    bool on_a;
    Primitive kind;
    int index;
};

struct Placed {
    const Mesh& mesh;
    Matrix3X x;  // relative to b's reference point
    std::vector<int> corners(const Feature& f) const {
        if (f.kind == Primitive::vertex) return {f.index};
        if (f.kind == Primitive::edge) return {mesh.edges[f.index][0], mesh.edges[f.index][1]};
        return {mesh.triangles[f.index].begin(), mesh.triangles[f.index].end()};
    }
    Box box(const Feature& f, double room) const {
        const auto c = corners(f);
        Box out{x.col(c[0]), x.col(c[0])};
        for (const int v : c) {
            out.low = out.low.cwiseMin(x.col(v));
            out.high = out.high.cwiseMax(x.col(v));
        }
        out.low.array() -= room;
        out.high.array() += room;
        return out;
    }
    Box whole(double room) const {
        return {Vector3(x.rowwise().minCoeff()).array() - room, Vector3(x.rowwise().maxCoeff()).array() + room};
    }
};

// The features of one body that reach the other's box.
void add_features(const Placed& body, bool on_a, const Box& other, double room, std::vector<Feature>& features, std::vector<Box>& boxes) {
    const auto add = [&](Primitive kind, std::size_t count) {
        for (std::size_t i = 0; i < count; ++i) {
            const Feature feature{on_a, kind, static_cast<int>(i)};
            const Box box = body.box(feature, room);
            if (!box.overlaps(other)) continue;
            features.push_back(feature);
            boxes.push_back(box);
        }
    };
    add(Primitive::vertex, static_cast<std::size_t>(body.x.cols()));
    add(Primitive::edge, body.mesh.edges.size());
    add(Primitive::triangle, body.mesh.triangles.size());
}

ClosestPoints closest(const Placed& a, const Feature& fa, const Placed& b, const Feature& fb) {
    const auto ca = a.corners(fa), cb = b.corners(fb);
    if (fa.kind == Primitive::edge)
        return core::geometry::edge_edge_closest(a.x.col(ca[0]), a.x.col(ca[1]), b.x.col(cb[0]), b.x.col(cb[1]));
    if (fa.kind == Primitive::vertex)
        return core::geometry::point_triangle_closest(a.x.col(ca[0]), b.x.col(cb[0]), b.x.col(cb[1]), b.x.col(cb[2]));
    return core::geometry::point_triangle_closest(b.x.col(cb[0]), a.x.col(ca[0]), a.x.col(ca[1]), a.x.col(ca[2]));
}

// The nearest points of a and of b, relative to b's reference point.
std::pair<Vector3, Vector3> points(const Placed& a, const Feature& fa, const Placed& b, const Feature& fb, const ClosestPoints& pair) {
    if (fa.kind == Primitive::triangle) {  // then b's is the vertex, and the difference points to it
        const Vector3 vertex = b.x.col(fb.index);
        return {vertex - pair.difference, vertex};
    }
    const std::vector<int> corners = a.corners(fa);
    Vector3 point = Vector3::Zero();
    for (std::size_t i = 0; i < corners.size(); ++i) point += pair.weight[i] * a.x.col(corners[i]);
    return {point, point - pair.difference};
}

bool is_pair(const Feature& a, const Feature& b) {
    if (a.kind == Primitive::edge) return b.kind == Primitive::edge;
    return (a.kind == Primitive::vertex && b.kind == Primitive::triangle) || (a.kind == Primitive::triangle && b.kind == Primitive::vertex);
}

}  // namespace

std::vector<Witness> tied_features(const core::model::Model& model, const core::stepper::Trajectory& trajectory, int a, int b,
                                   const Witness& witness, double tolerance) {
    const Pose pose_a = pose_at(trajectory, witness.step, witness.segment, witness.s, a);
    const Pose pose_b = pose_at(trajectory, witness.step, witness.segment, witness.s, b);
    const Mesh &mesh_a = model.bodies[a].mesh, &mesh_b = model.bodies[b].mesh;
    const Placed on_a{mesh_a, (pose_a.rotation * mesh_a.vertices).colwise() + (pose_a.position - pose_b.position)};
    const Placed on_b{mesh_b, pose_b.rotation * mesh_b.vertices};
    const double reach = (witness.point_a - witness.point_b).norm() + tolerance;
    const double room = 0.5 * reach * (1 + 1e-9);
    std::vector<Feature> features;
    std::vector<Box> boxes;
    add_features(on_a, true, on_b.whole(room), room, features, boxes);
    add_features(on_b, false, on_a.whole(room), room, features, boxes);
    std::vector<Witness> out{witness};
    core::geometry::visit_overlapping_pairs(boxes, [&](int i, int j) {
        const Feature &fa = features[i], &fb = features[j];  // a's features come first
        if (fa.on_a == fb.on_a || !is_pair(fa, fb)) return true;
        const ClosestPoints pair = closest(on_a, fa, on_b, fb);
        const double distance = pair.difference.norm();
        if (distance > reach) return true;
        Witness tied = witness;
        tied.edge_edge = fa.kind == Primitive::edge;
        tied.vertex_on_a = fa.kind == Primitive::vertex;
        tied.kind_a = fa.kind;
        tied.kind_b = fb.kind;
        tied.primitive_a = fa.index;
        tied.primitive_b = fb.index;
        tied.distance = distance;
        std::tie(tied.point_a, tied.point_b) = points(on_a, fa, on_b, fb, pair);
        tied.point_a += pose_b.position;
        tied.point_b += pose_b.position;
        out.push_back(tied);
        return true;
    });
    return out;
}

}  // namespace fettle::adjoint::clearance
