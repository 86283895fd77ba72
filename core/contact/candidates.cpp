// SPDX-License-Identifier: MIT
#include "fettle/core/contact/candidates.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "fettle/core/contact/body_hierarchy.hpp"
#include "fettle/core/geometry/distance.hpp"

namespace fettle::core::contact {
namespace {

using kinematics::Pose;

// Rounding of the separating-axis sums, relative to the sizes that enter them: some thirty operations of relative error 2^-53.
constexpr double rounding = 1e-14;

// Pose of b's frame in a's frame.
struct RelativePose {
    Matrix3 rotation, absolute;
    Vector3 translation;
};

RelativePose relative_pose(const Pose& a, const Pose& b) {
    RelativePose r;
    r.rotation = a.rotation.transpose() * b.rotation;
    r.absolute = r.rotation.cwiseAbs();
    r.translation = a.rotation.transpose() * (b.position - a.position);
    return r;
}

class PairSearch {
public:
    PairSearch(const model::Model& model, const std::vector<Pose>& poses, const std::vector<MotionAllowance>& allowances, int a, int b)
        : body_a_(model.bodies[a]), body_b_(model.bodies[b]), pose_a_(poses[a]), pose_b_(poses[b]), allow_a_(allowances[a]),
          allow_b_(allowances[b]), activation_(model.dmin + model.dhat), relative_(relative_pose(pose_a_, pose_b_)) {
        out_.a = a;
        out_.b = b;
    }

    BodyPairCandidates run() {
        const auto& nodes_a = body_a_.hierarchy->nodes();
        const auto& nodes_b = body_b_.hierarchy->nodes();
        std::vector<std::array<int, 2>> stack{{0, 0}};
        while (!stack.empty()) {
            const auto [i, j] = stack.back();
            stack.pop_back();
            const HierarchyNode &na = nodes_a[i], &nb = nodes_b[j];
            const double margin = margin_of(na.radius, nb.radius);
            if (separated(na, nb, margin)) continue;
            if (na.is_leaf() && nb.is_leaf()) {
                visit_leaves(na, nb);
            } else if (nb.is_leaf() || (!na.is_leaf() && na.half_extent.sum() >= nb.half_extent.sum())) {
                stack.push_back({na.right, j});
                stack.push_back({na.left, j});
            } else {
                stack.push_back({i, nb.right});
                stack.push_back({i, nb.left});
            }
        }
        for (auto* list : {&out_.vertex_triangle, &out_.triangle_vertex, &out_.edge_edge})
            std::sort(list->begin(), list->end(), [](const PrimitivePair& x, const PrimitivePair& y) {
                return std::tie(x.distance, x.a, x.b) < std::tie(y.distance, y.a, y.b);
            });
        return std::move(out_);
    }

private:
    double margin_of(double radius_a, double radius_b) const {
        return activation_ + allow_a_.translation + allow_a_.rotation * radius_a + allow_b_.translation + allow_b_.rotation * radius_b;
    }

    // Separating axes: the face normals of both boxes. True only if the boxes are farther apart than the margin.
    bool separated(const HierarchyNode& na, const HierarchyNode& nb, double margin) const {
        const Vector3 t = relative_.rotation * nb.center + relative_.translation - na.center;
        const Vector3 extent_b_in_a = relative_.absolute * nb.half_extent;
        const double size = t.cwiseAbs().sum() + na.half_extent.sum() + nb.half_extent.sum() + nb.radius + na.radius +
                            relative_.translation.cwiseAbs().sum();
        const double bound = margin + rounding * size;
        if (((t.cwiseAbs() - na.half_extent - extent_b_in_a).array() > bound).any()) return true;
        const Vector3 t_b = (relative_.rotation.transpose() * t).cwiseAbs();
        const Vector3 extent_a_in_b = relative_.absolute.transpose() * na.half_extent;
        return ((t_b - nb.half_extent - extent_a_in_b).array() > bound).any();
    }

    using Corners = std::array<Vector3, 3>;
    static Corners corners(const model::Body& body, const Pose& pose, const HierarchyElement& e) {
        Corners c;
        for (int k = 0; k < e.vertex_count; ++k) c[k] = world_position(pose, body.mesh.vertices.col(e.vertices[k]));
        return c;
    }
    static Vector3 vertex(const model::Body& body, const Pose& pose, int v) { return world_position(pose, body.mesh.vertices.col(v)); }

    void visit_leaves(const HierarchyNode& na, const HierarchyNode& nb) {
        for (int i = na.first; i < na.first + na.count; ++i) {
            const HierarchyElement& ea = body_a_.hierarchy->elements()[i];
            const Corners ca = corners(body_a_, pose_a_, ea);
            for (int j = nb.first; j < nb.first + nb.count; ++j)
                visit_elements(ea, ca, body_b_.hierarchy->elements()[j], margin_of(na.radius, nb.radius));
        }
    }

    static bool boxes_apart(const Corners& a, int count_a, const Corners& b, int count_b, double margin) {
        Vector3 low_a = a[0], high_a = a[0], low_b = b[0], high_b = b[0];
        for (int k = 1; k < count_a; ++k) {
            low_a = low_a.cwiseMin(a[k]);
            high_a = high_a.cwiseMax(a[k]);
        }
        for (int k = 1; k < count_b; ++k) {
            low_b = low_b.cwiseMin(b[k]);
            high_b = high_b.cwiseMax(b[k]);
        }
        return ((low_a - high_b).array() > margin).any() || ((low_b - high_a).array() > margin).any();
    }

    void visit_elements(const HierarchyElement& ea, const Corners& ca, const HierarchyElement& eb, double margin) {
        const Corners cb = corners(body_b_, pose_b_, eb);
        const double size = pose_a_.position.cwiseAbs().sum() + pose_b_.position.cwiseAbs().sum() + body_a_.radius + body_b_.radius;
        const double bound = margin + rounding * size;
        if (boxes_apart(ca, ea.vertex_count, cb, eb.vertex_count, bound)) return;
        const double bound_squared = bound * bound * (1 + rounding);
        if (eb.triangle >= 0)
            for (int k = 0; k < ea.owned_vertex_count; ++k) {
                const int v = ea.owned_vertices[k];
                const double d = geometry::point_triangle_distance_squared(vertex(body_a_, pose_a_, v), cb[0], cb[1], cb[2]);
                if (d <= bound_squared) out_.vertex_triangle.push_back({v, eb.triangle, std::sqrt(d)});
            }
        if (ea.triangle >= 0)
            for (int k = 0; k < eb.owned_vertex_count; ++k) {
                const int v = eb.owned_vertices[k];
                const double d = geometry::point_triangle_distance_squared(vertex(body_b_, pose_b_, v), ca[0], ca[1], ca[2]);
                if (d <= bound_squared) out_.triangle_vertex.push_back({ea.triangle, v, std::sqrt(d)});
            }
        for (int k = 0; k < ea.owned_edge_count; ++k) {
            const auto& edge_a = body_a_.mesh.edges[ea.owned_edges[k]];
            const Vector3 a0 = vertex(body_a_, pose_a_, edge_a[0]), a1 = vertex(body_a_, pose_a_, edge_a[1]);
            for (int l = 0; l < eb.owned_edge_count; ++l) {
                const auto& edge_b = body_b_.mesh.edges[eb.owned_edges[l]];
                const Vector3 b0 = vertex(body_b_, pose_b_, edge_b[0]), b1 = vertex(body_b_, pose_b_, edge_b[1]);
                const double d = geometry::edge_edge_distance_squared(a0, a1, b0, b1);
                if (d <= bound_squared) out_.edge_edge.push_back({ea.owned_edges[k], eb.owned_edges[l], std::sqrt(d)});
            }
        }
    }

    const model::Body &body_a_, &body_b_;
    const Pose &pose_a_, &pose_b_;
    const MotionAllowance &allow_a_, &allow_b_;
    const double activation_;
    const RelativePose relative_;
    BodyPairCandidates out_;
};

}  // namespace

Candidates find_candidates(const model::Model& model, const std::vector<Pose>& poses, const std::vector<MotionAllowance>& allowances) {
    Candidates candidates{{}, poses, allowances};
    const int n = static_cast<int>(model.bodies.size());
    for (int a = 0; a < n; ++a)
        for (int b = a + 1; b < n; ++b) {
            if (!model::may_collide(model, a, b)) continue;
            BodyPairCandidates pair = PairSearch(model, poses, allowances, a, b).run();
            if (!pair.empty()) candidates.pairs.push_back(std::move(pair));
        }
    return candidates;
}

namespace {

// |R1 - R2|_F / sqrt 2 bounds |(R1 - R2) X| / |X|.
MotionAllowance motion_since(const Candidates& candidates, std::size_t body, const Pose& pose) {
    constexpr double slack = 1 + 1e-12;
    return {slack * (pose.position - candidates.poses[body].position).norm(),
            slack * (pose.rotation - candidates.poses[body].rotation).norm() / std::sqrt(2.0)};
}

MotionAllowance motion_over(const Candidates& candidates, std::size_t body, const kinematics::PathSegment& s) {
    constexpr double slack = 1 + 1e-12;
    const MotionAllowance start = motion_since(candidates, body, pose_at(s, 0));
    return {start.translation + slack * s.position_step.norm(), start.rotation + slack * s.rotation_vector_step.norm()};
}

// Rounding of world positions is charged too: distances were taken at rounded vertices.
double displacement(const model::Body& body, const Pose& found_at, const MotionAllowance& motion) {
    return motion.translation + motion.rotation * body.radius + rounding * (found_at.position.norm() + body.radius);
}

}  // namespace

std::vector<double> displacements(const model::Model& model, const Candidates& candidates, const std::vector<Pose>& poses) {
    std::vector<double> out(poses.size());
    for (std::size_t i = 0; i < poses.size(); ++i)
        out[i] = displacement(model.bodies[i], candidates.poses[i], motion_since(candidates, i, poses[i]));
    return out;
}

std::vector<double> displacements(const model::Model& model, const Candidates& candidates, const std::vector<kinematics::PathSegment>& segments) {
    std::vector<double> out(segments.size());
    for (std::size_t i = 0; i < segments.size(); ++i)
        out[i] = displacement(model.bodies[i], candidates.poses[i], motion_over(candidates, i, segments[i]));
    return out;
}

double covered_fraction(const Candidates& candidates, const std::vector<kinematics::PathSegment>& segments) {
    constexpr double slack = 1 + 1e-12;
    double fraction = 1;
    const auto limit = [&](double spent, double step, double allowed) {
        if (spent + step * slack <= allowed) return;
        fraction = std::min(fraction, spent < allowed ? (allowed - spent) / (step * slack * slack) : 0.0);
    };
    for (std::size_t i = 0; i < segments.size(); ++i) {
        const MotionAllowance spent = motion_since(candidates, i, pose_at(segments[i], 0)), &allowed = candidates.allowances[i];
        limit(spent.translation, segments[i].position_step.norm(), allowed.translation);
        limit(spent.rotation, segments[i].rotation_vector_step.norm(), allowed.rotation);
    }
    return fraction;
}

}  // namespace fettle::core::contact
