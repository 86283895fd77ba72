// SPDX-License-Identifier: MIT
#include "fettle/core/contact/candidates.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "fettle/core/contact/body_hierarchy.hpp"
#include "fettle/core/contact/contact_pair.hpp"

namespace fettle::core::contact {
namespace {

using kinematics::Pose;

// Rounding of the separating-axis sums, relative to the sizes that enter them: some thirty operations of relative error 2^-53.
constexpr double rounding = 1e-14;

// A body at the two ends of its segment, and how far its points may leave their chords in between.
struct SweptBody {
    const model::Body* body;
    Pose start, end;
    double turn;                         // |w|
    std::array<Matrix3X, 2> vertices{};  // world positions at both ends; filled when some pair of boxes is close
    void place_vertices() {
        if (vertices[0].cols() > 0) return;
        vertices[0] = (start.rotation * body->mesh.vertices).colwise() + start.position;
        vertices[1] = (end.rotation * body->mesh.vertices).colwise() + end.position;
    }
    double deviation(double radius) const { return 0.125 * turn * turn * radius * (1 + 1e-12); }
};

SweptBody swept_body(const model::Body& body, const kinematics::PathSegment& segment) {
    return {&body, pose_at(segment, 0), pose_at(segment, 1), segment.rotation_vector_step.norm(), {}};
}

// One separating direction, in the frames of both bodies at both ends.
struct Axis {
    std::array<Vector3, 2> a, b;  // the direction in the body's frame at the start and at the end
    std::array<Vector3, 2> abs_a, abs_b;
    std::array<double, 2> offset;  // n . (q_b - q_a)
};

class PairSearch {
public:
    PairSearch(SweptBody& a, SweptBody& b, double activation, const MotionAllowance& allow_a, const MotionAllowance& allow_b)
        : a_(a), b_(b), allow_a_(allow_a), allow_b_(allow_b), activation_(activation) {
        for (int k = 0; k < 3; ++k) {
            axes_[k] = axis(a_.start.rotation.col(k));
            axes_[k + 3] = axis(b_.start.rotation.col(k));
        }
        reach_ = (b_.start.position - a_.start.position).norm() + (b_.end.position - a_.end.position).norm();
        world_size_ = a_.start.position.norm() + a_.end.position.norm() + b_.start.position.norm() + b_.end.position.norm() +
                      a_.body->radius + b_.body->radius;
    }

    BodyPairCandidates run() {
        const auto& nodes_a = a_.body->hierarchy->nodes();
        const auto& nodes_b = b_.body->hierarchy->nodes();
        std::vector<std::array<int, 2>> stack{{0, 0}};
        while (!stack.empty()) {
            const auto [i, j] = stack.back();
            stack.pop_back();
            const HierarchyNode &na = nodes_a[i], &nb = nodes_b[j];
            if (separated(na, nb, margin_of(na.radius, nb.radius))) continue;
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
    Axis axis(const Vector3& n) const {
        Axis x;
        x.a = {a_.start.rotation.transpose() * n, a_.end.rotation.transpose() * n};
        x.b = {b_.start.rotation.transpose() * n, b_.end.rotation.transpose() * n};
        for (int e = 0; e < 2; ++e) {
            x.abs_a[e] = x.a[e].cwiseAbs();
            x.abs_b[e] = x.b[e].cwiseAbs();
        }
        x.offset = {n.dot(b_.start.position - a_.start.position), n.dot(b_.end.position - a_.end.position)};
        return x;
    }

    // Activation distance, allowances and chord deviations.
    double margin_of(double radius_a, double radius_b) const {
        return activation_ + allow_a_.translation + allow_a_.rotation * radius_a + allow_b_.translation + allow_b_.rotation * radius_b +
               a_.deviation(radius_a) + b_.deviation(radius_b);
    }

    // True only if the boxes stay farther apart than the margin.
    bool separated(const HierarchyNode& na, const HierarchyNode& nb, double margin) const {
        const double bound = margin + rounding * (reach_ + 4 * (na.radius + nb.radius + na.half_extent.sum() + nb.half_extent.sum()));
        for (const Axis& n : axes_) {
            const double t0 = n.offset[0] + n.b[0].dot(nb.center) - n.a[0].dot(na.center);
            const double e0 = n.abs_a[0].dot(na.half_extent) + n.abs_b[0].dot(nb.half_extent);
            if (std::abs(t0) - e0 <= bound) continue;
            const double t1 = n.offset[1] + n.b[1].dot(nb.center) - n.a[1].dot(na.center);
            const double e1 = n.abs_a[1].dot(na.half_extent) + n.abs_b[1].dot(nb.half_extent);
            if (std::copysign(1.0, t0) * t1 - e1 > bound) return true;
        }
        return false;
    }

    // A vertex at both ends.
    using Ends = std::array<Vector3, 2>;
    static Ends ends(const SweptBody& s, int v) { return {s.vertices[0].col(v), s.vertices[1].col(v)}; }

    // Box of some vertices at both ends.
    struct Box {
        Vector3 low, high;
        bool apart_from(const Box& other, double margin) const {
            return ((low - other.high).array() > margin).any() || ((other.low - high).array() > margin).any();
        }
    };
    static Box box(const SweptBody& s, const int* v, int count) {
        Box out{s.vertices[0].col(v[0]), s.vertices[0].col(v[0])};
        for (const Matrix3X& x : s.vertices)
            for (int k = 0; k < count; ++k) {
                out.low = out.low.cwiseMin(x.col(v[k]));
                out.high = out.high.cwiseMax(x.col(v[k]));
            }
        return out;
    }

    void visit_leaves(const HierarchyNode& na, const HierarchyNode& nb) {
        a_.place_vertices();
        b_.place_vertices();
        margin_ = margin_of(na.radius, nb.radius) + rounding * world_size_;
        lost_ = a_.deviation(na.radius) + b_.deviation(nb.radius) + rounding * world_size_;
        for (int i = na.first; i < na.first + na.count; ++i) {
            const HierarchyElement& ea = a_.body->hierarchy->elements()[i];
            const Box box_a = box(a_, ea.vertices.data(), ea.vertex_count);
            for (int j = nb.first; j < nb.first + nb.count; ++j) {
                const HierarchyElement& eb = b_.body->hierarchy->elements()[j];
                const Box box_b = box(b_, eb.vertices.data(), eb.vertex_count);
                if (!box_a.apart_from(box_b, margin_)) visit_elements(ea, box_a, eb, box_b);
            }
        }
    }

    // Least separation, at the other end, along the direction of the closest points at this one.
    static double separation(const Vector3& n, const std::array<Ends, 4>& x, int first_count, int end) {
        double low = n.dot(x[0][end]), high = n.dot(x[3][end]);
        for (int i = 1; i < first_count; ++i) low = std::min(low, n.dot(x[i][end]));
        for (int i = first_count; i < 3; ++i) high = std::max(high, n.dot(x[i][end]));
        return low - high;
    }

    // Lower bound of the distance over the segments, deviations included.
    double least_distance(PairType type, const std::array<Ends, 4>& x) const {
        double best = 0;
        const int n = first_count(type);
        const bool still = a_.turn == 0 && b_.turn == 0 && x[0][0] == x[0][1] && x[3][0] == x[3][1];
        for (int end = 0; end < (still ? 1 : 2); ++end) {
            const geometry::ClosestPoints c = closest_points(type, {x[0][end], x[1][end], x[2][end], x[3][end]});
            const double d = std::sqrt(c.distance_squared);
            if (still || d == 0) return d - lost_;
            best = std::max(best, std::min(d, separation(c.difference / d, x, n, 1 - end)));
            if (best - lost_ > margin_) break;
        }
        return best - lost_;
    }

    void add(std::vector<PrimitivePair>& list, int i, int j, PairType type, const std::array<Ends, 4>& x) const {
        const double d = least_distance(type, x);
        if (d + lost_ <= margin_) list.push_back({i, j, d});
    }

    // Vertices that `owner` owns (on `v`) against the face of `other` (on `t`).
    void visit_vertices(const SweptBody& v, const HierarchyElement& owner, const SweptBody& t, const HierarchyElement& other,
                        const Box& box_t, bool vertex_first) {
        // Loose edges and points are faces for isolated points only: other vertices are ends of edges, whose own pairs cover them. Two
        // points are one pair, not two.
        if (other.triangle < 0 && (owner.vertex_count > 1 || (other.vertex_count == 1 && !vertex_first))) return;
        const geometry::Triangle& face = t.body->hierarchy->faces()[other.face];
        for (int k = 0; k < owner.owned_vertex_count; ++k) {
            const int i = owner.owned_vertices[k];
            if (box(v, &i, 1).apart_from(box_t, margin_)) continue;
            const std::array<Ends, 4> x{ends(v, i), ends(t, face[0]), ends(t, face[1]), ends(t, face[2])};
            if (vertex_first)
                add(out_.vertex_triangle, i, other.face, PairType::point_triangle, x);
            else
                add(out_.triangle_vertex, other.face, i, PairType::point_triangle, x);
        }
    }

    void visit_elements(const HierarchyElement& ea, const Box& box_a, const HierarchyElement& eb, const Box& box_b) {
        visit_vertices(a_, ea, b_, eb, box_b, true);
        visit_vertices(b_, eb, a_, ea, box_a, false);
        for (int k = 0; k < ea.owned_edge_count; ++k) {
            const geometry::Edge& edge_a = a_.body->mesh.edges[ea.owned_edges[k]];
            const Box edge_box = box(a_, edge_a.data(), 2);
            if (edge_box.apart_from(box_b, margin_)) continue;
            for (int l = 0; l < eb.owned_edge_count; ++l) {
                const geometry::Edge& edge_b = b_.body->mesh.edges[eb.owned_edges[l]];
                if (edge_box.apart_from(box(b_, edge_b.data(), 2), margin_)) continue;
                add(out_.edge_edge, ea.owned_edges[k], eb.owned_edges[l], PairType::edge_edge,
                    {ends(a_, edge_a[0]), ends(a_, edge_a[1]), ends(b_, edge_b[0]), ends(b_, edge_b[1])});
            }
        }
    }

    SweptBody &a_, &b_;
    const MotionAllowance &allow_a_, &allow_b_;
    const double activation_;
    std::array<Axis, 6> axes_;
    double reach_ = 0, world_size_ = 0;
    double margin_ = 0, lost_ = 0;  // of the pair of leaves being visited
    BodyPairCandidates out_;
};

}  // namespace

Candidates find_candidates(const model::Model& model, const std::vector<kinematics::PathSegment>& segments,
                           const std::vector<MotionAllowance>& allowances) {
    Candidates candidates{{}, {}, allowances};
    std::vector<SweptBody> swept;
    for (std::size_t i = 0; i < segments.size(); ++i) {
        swept.push_back(swept_body(model.bodies[i], segments[i]));
        candidates.poses.push_back(swept.back().start);
    }
    const int n = static_cast<int>(model.bodies.size());
    for (int a = 0; a < n; ++a)
        for (int b = a + 1; b < n; ++b) {
            if (!model::may_collide(model, a, b)) continue;
            BodyPairCandidates pair = PairSearch(swept[a], swept[b], model.dmin + model.dhat, allowances[a], allowances[b]).run();
            if (pair.empty()) continue;
            pair.a = a;
            pair.b = b;
            candidates.pairs.push_back(std::move(pair));
        }
    return candidates;
}

Candidates find_candidates(const model::Model& model, const std::vector<Pose>& poses, const std::vector<MotionAllowance>& allowances) {
    std::vector<kinematics::PathSegment> segments(poses.size());
    for (std::size_t i = 0; i < poses.size(); ++i)
        segments[i] = {poses[i].rotation, Vector3::Zero(), Vector3::Zero(), poses[i].position, Vector3::Zero()};
    return find_candidates(model, segments, allowances);
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

std::vector<double> displacements(const model::Model& model, const Candidates& candidates,
                                  const std::vector<kinematics::PathSegment>& segments) {
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
