// SPDX-License-Identifier: MIT
#include "fettle/core/contact/candidates.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <tuple>

#include "fettle/core/base/parallel.hpp"
#include "fettle/core/contact/body_hierarchy.hpp"
#include "fettle/core/contact/contact_pair.hpp"
#include "fettle/core/geometry/overlapping_boxes.hpp"

namespace fettle::core::contact {
namespace {

using kinematics::Pose;

// Rounding of the separating-axis sums, relative to the sizes that enter them: some thirty operations of relative error 2^-53.
constexpr double rounding = 1e-14;

// A body at the two ends of its segment, and how far its points may leave their chords in between.
struct SweptBody {
    const model::Body* body;
    Pose start, end;
    double turn;  // |w|
    bool still;   // the two ends are the same
    double deviation(double radius) const { return 0.125 * turn * turn * radius * (1 + 1e-12); }
};

SweptBody swept_body(const model::Body& body, const kinematics::PathSegment& segment) {
    const double turn = segment.rotation_vector_step.norm();
    return {&body, pose_at(segment, 0), pose_at(segment, 1), turn, turn == 0 && segment.position_step.isZero(0)};
}

// World-axis box of a whole body along its segment, with half of what it may be away from another.
geometry::Box swept_box(const SweptBody& s, double half_activation, const MotionAllowance& allowance) {
    const HierarchyNode& root = s.body->hierarchy->nodes()[0];
    const double margin = half_activation + allowance.translation + (allowance.rotation * root.radius) + s.deviation(root.radius) +
                          rounding * (s.start.position.norm() + s.end.position.norm() + root.radius);
    geometry::Box box{Vector3::Constant(std::numeric_limits<double>::infinity()),
                      Vector3::Constant(-std::numeric_limits<double>::infinity())};
    for (const Pose& pose : {s.start, s.end}) {
        const Vector3 center = world_position(pose, root.center), half = pose.rotation.cwiseAbs() * root.half_extent;
        box.low = box.low.cwiseMin(center - half);
        box.high = box.high.cwiseMax(center + half);
    }
    box.low.array() -= margin;
    box.high.array() += margin;
    return box;
}

// An element at both ends: corners (of edges and points repeated to three, as in BodyHierarchy::faces), box, and normal at the start.
struct SweptElement {
    std::array<std::array<Vector3, 2>, 3> corners;
    Vector3 low, high;
    Vector3 normal;  // zero: has none
};

SweptElement swept_element(const SweptBody& s, const HierarchyElement& e) {
    SweptElement out;
    const geometry::Triangle& face = s.body->hierarchy->faces()[e.face];
    for (int k = 0; k < 3; ++k) {
        const auto X = s.body->mesh.vertices.col(face[k]);
        out.corners[k] = {s.start.rotation * X + s.start.position, s.end.rotation * X + s.end.position};
    }
    const auto& c = out.corners;
    out.low = c[0][0].cwiseMin(c[0][1]);
    out.high = c[0][0].cwiseMax(c[0][1]);
    for (int k = 1; k < e.vertex_count; ++k) {
        out.low = out.low.cwiseMin(c[k][0].cwiseMin(c[k][1]));
        out.high = out.high.cwiseMax(c[k][0].cwiseMax(c[k][1]));
    }
    out.normal = (c[1][0] - c[0][0]).cross(c[2][0] - c[0][0]);
    const double length = out.normal.norm();
    // Shortened: a direction of length at most 1 keeps the separations along it true.
    out.normal = length > 0 ? Vector3(out.normal * ((1 - 1e-14) / length)) : Vector3(Vector3::Zero());
    return out;
}

// The elements of a body that some search looks at.
struct SweptElements {
    std::vector<int> first;  // per hierarchy node: where a leaf's elements start, or -1
    std::unique_ptr<SweptElement[]> elements;
    const SweptElement* of_leaf(int node) const { return elements.get() + first[node]; }
};

// One separating direction, in the frames of both bodies at both ends.
struct Axis {
    std::array<Vector3, 2> a, b;  // the direction in the body's frame at the start and at the end
    std::array<Vector3, 2> abs_a, abs_b;
    std::array<double, 2> offset;  // n . (q_b - q_a)
};

// What holds for a pair of bodies along its segments.
struct SweptPair {
    int body_a = 0, body_b = 0;
    const SweptBody *a, *b;
    const MotionAllowance *allow_a, *allow_b;
    double activation = 0;
    std::array<Axis, 6> axes;
    double reach = 0, world_size = 0;

    // Activation distance, allowances and chord deviations.
    double margin(double radius_a, double radius_b) const {
        return activation + allow_a->translation + allow_a->rotation * radius_a + allow_b->translation + allow_b->rotation * radius_b +
               deviation(radius_a, radius_b);
    }
    double deviation(double radius_a, double radius_b) const { return a->deviation(radius_a) + b->deviation(radius_b); }
};

Axis axis(const SweptBody& a, const SweptBody& b, const Vector3& n) {
    Axis x;
    x.a = {a.start.rotation.transpose() * n, a.end.rotation.transpose() * n};
    x.b = {b.start.rotation.transpose() * n, b.end.rotation.transpose() * n};
    for (int e = 0; e < 2; ++e) {
        x.abs_a[e] = x.a[e].cwiseAbs();
        x.abs_b[e] = x.b[e].cwiseAbs();
    }
    x.offset = {n.dot(b.start.position - a.start.position), n.dot(b.end.position - a.end.position)};
    return x;
}

SweptPair swept_pair(int body_a, int body_b, const std::vector<SweptBody>& bodies, const std::vector<MotionAllowance>& allowances,
                     double activation) {
    const SweptBody &a = bodies[body_a], &b = bodies[body_b];
    SweptPair pair{body_a, body_b, &a, &b, &allowances[body_a], &allowances[body_b], activation, {}, 0, 0};
    for (int k = 0; k < 3; ++k) {
        pair.axes[k] = axis(a, b, a.start.rotation.col(k));
        pair.axes[k + 3] = axis(a, b, b.start.rotation.col(k));
    }
    pair.reach = (b.start.position - a.start.position).norm() + (b.end.position - a.end.position).norm();
    pair.world_size =
        a.start.position.norm() + a.end.position.norm() + b.start.position.norm() + b.end.position.norm() + a.body->radius + b.body->radius;
    return pair;
}

using NodePair = std::array<int, 2>;

// True only if the boxes stay farther apart than the margin.
bool separated(const SweptPair& pair, const HierarchyNode& na, const HierarchyNode& nb) {
    const double bound = pair.margin(na.radius, nb.radius) +
                         rounding * (pair.reach + 4 * (na.radius + nb.radius + na.half_extent.sum() + nb.half_extent.sum()));
    for (const Axis& n : pair.axes) {
        const double t0 = n.offset[0] + n.b[0].dot(nb.center) - n.a[0].dot(na.center);
        const double e0 = n.abs_a[0].dot(na.half_extent) + n.abs_b[0].dot(nb.half_extent);
        if (std::abs(t0) - e0 <= bound) continue;
        const double t1 = n.offset[1] + n.b[1].dot(nb.center) - n.a[1].dot(na.center);
        const double e1 = n.abs_a[1].dot(na.half_extent) + n.abs_b[1].dot(nb.half_extent);
        if (std::copysign(1.0, t0) * t1 - e1 > bound) return true;
    }
    return false;
}

// Pairs of leaves below a pair of nodes that may come close. If `most` > 0: stops as soon as that many pairs of nodes are at hand and
// returns them, leaves or not.
std::vector<NodePair> descend(const SweptPair& pair, NodePair from, std::size_t most) {
    const auto& nodes_a = pair.a->body->hierarchy->nodes();
    const auto& nodes_b = pair.b->body->hierarchy->nodes();
    std::vector<NodePair> stack{from}, leaves;
    while (!stack.empty() && (most == 0 || stack.size() + leaves.size() < most)) {
        const auto [i, j] = stack.back();
        stack.pop_back();
        const HierarchyNode &na = nodes_a[i], &nb = nodes_b[j];
        if (separated(pair, na, nb)) continue;
        if (na.is_leaf() && nb.is_leaf()) {
            leaves.push_back({i, j});
        } else if (nb.is_leaf() || (!na.is_leaf() && na.half_extent.sum() >= nb.half_extent.sum())) {
            stack.push_back({na.right, j});
            stack.push_back({na.left, j});
        } else {
            stack.push_back({i, nb.right});
            stack.push_back({i, nb.left});
        }
    }
    leaves.insert(leaves.end(), stack.begin(), stack.end());
    return leaves;
}

// Pairs of primitives of pairs of leaves.
class LeafSearch {
public:
    LeafSearch(const SweptPair& pair, const SweptElements& elements_a, const SweptElements& elements_b)
        : pair_(pair),
          body_a_(*pair.a->body->hierarchy),
          body_b_(*pair.b->body->hierarchy),
          elements_a_(elements_a),
          elements_b_(elements_b) {}

    void visit(const NodePair& leaves) {
        const HierarchyNode &na = body_a_.nodes()[leaves[0]], &nb = body_b_.nodes()[leaves[1]];
        margin_ = pair_.margin(na.radius, nb.radius) + rounding * pair_.world_size;
        lost_ = pair_.deviation(na.radius, nb.radius) + rounding * pair_.world_size;
        const SweptElement *swept_a = elements_a_.of_leaf(leaves[0]), *swept_b = elements_b_.of_leaf(leaves[1]);
        for (int i = na.first; i < na.first + na.count; ++i)
            for (int j = nb.first; j < nb.first + nb.count; ++j) {
                const SweptElement &a = swept_a[i - na.first], &b = swept_b[j - nb.first];
                if (apart(a, b) || apart_along(a.normal, a, b) || apart_along(b.normal, a, b)) continue;
                visit_elements(body_a_.elements()[i], a, body_b_.elements()[j], b);
            }
    }

    BodyPairCandidates take() { return std::move(out_); }

private:
    using Ends = std::array<Vector3, 2>;  // a vertex at both ends

    bool apart(const SweptElement& a, const SweptElement& b) const {
        return ((a.low - b.high).array() > margin_).any() || ((b.low - a.high).array() > margin_).any();
    }

    struct Range {
        double low, high;
    };
    static Range along(const Vector3& n, const SweptElement& e, int end) {
        const double d0 = n.dot(e.corners[0][end]), d1 = n.dot(e.corners[1][end]), d2 = n.dot(e.corners[2][end]);
        return {std::min(d0, std::min(d1, d2)), std::max(d0, std::max(d1, d2))};
    }
    bool apart_along(const Vector3& n, const SweptElement& a, const SweptElement& b) const {
        const Range a0 = along(n, a, 0), b0 = along(n, b, 0);
        if (a0.low - b0.high > margin_) return along(n, a, 1).low - along(n, b, 1).high > margin_;
        return b0.low - a0.high > margin_ && along(n, b, 1).low - along(n, a, 1).high > margin_;
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
        const bool still = pair_.a->still && pair_.b->still;
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

    // A box of one or two vertices at both ends against an element's.
    bool ends_apart(const Ends& p, const Ends& q, const SweptElement& e) const {
        const Vector3 low = p[0].cwiseMin(p[1]).cwiseMin(q[0].cwiseMin(q[1])), high = p[0].cwiseMax(p[1]).cwiseMax(q[0].cwiseMax(q[1]));
        return ((low - e.high).array() > margin_).any() || ((e.low - high).array() > margin_).any();
    }

    // Vertices that `owner` owns against the face of `other`.
    void visit_vertices(const HierarchyElement& owner, const SweptElement& v, const HierarchyElement& other, const SweptElement& t,
                        bool vertex_first) {
        // Loose edges and points are faces for isolated points only: other vertices are ends of edges, whose own pairs cover them. Two
        // points are one pair, not two.
        if (other.triangle < 0 && (owner.vertex_count > 1 || (other.vertex_count == 1 && !vertex_first))) return;
        for (int k = 0; k < owner.owned_vertex_count; ++k) {
            const Ends& p = v.corners[owner.owned_vertex_corner[k]];
            if (ends_apart(p, p, t)) continue;
            const int i = owner.owned_vertices[k];
            const std::array<Ends, 4> x{p, t.corners[0], t.corners[1], t.corners[2]};
            if (vertex_first)
                add(out_.vertex_triangle, i, other.face, PairType::point_triangle, x);
            else
                add(out_.triangle_vertex, other.face, i, PairType::point_triangle, x);
        }
    }

    void visit_elements(const HierarchyElement& ea, const SweptElement& a, const HierarchyElement& eb, const SweptElement& b) {
        visit_vertices(ea, a, eb, b, true);
        visit_vertices(eb, b, ea, a, false);
        for (int k = 0; k < ea.owned_edge_count; ++k) {
            const Ends &a0 = a.corners[ea.owned_edge_corners[k][0]], &a1 = a.corners[ea.owned_edge_corners[k][1]];
            if (ends_apart(a0, a1, b)) continue;
            const Vector3 low = a0[0].cwiseMin(a0[1]).cwiseMin(a1[0].cwiseMin(a1[1]));
            const Vector3 high = a0[0].cwiseMax(a0[1]).cwiseMax(a1[0].cwiseMax(a1[1]));
            for (int l = 0; l < eb.owned_edge_count; ++l) {
                const Ends &b0 = b.corners[eb.owned_edge_corners[l][0]], &b1 = b.corners[eb.owned_edge_corners[l][1]];
                const Vector3 low_b = b0[0].cwiseMin(b0[1]).cwiseMin(b1[0].cwiseMin(b1[1]));
                const Vector3 high_b = b0[0].cwiseMax(b0[1]).cwiseMax(b1[0].cwiseMax(b1[1]));
                if (((low - high_b).array() > margin_).any() || ((low_b - high).array() > margin_).any()) continue;
                add(out_.edge_edge, ea.owned_edges[k], eb.owned_edges[l], PairType::edge_edge, {a0, a1, b0, b1});
            }
        }
    }

    const SweptPair& pair_;
    const BodyHierarchy &body_a_, &body_b_;
    const SweptElements &elements_a_, &elements_b_;
    double margin_ = 0, lost_ = 0;  // of the pair of leaves being visited
    BodyPairCandidates out_;
};

// Pairs of bodies whose swept boxes meet, in order.
std::vector<NodePair> close_bodies(const model::Model& model, const std::vector<SweptBody>& swept,
                                   const std::vector<MotionAllowance>& allowances) {
    constexpr int few = 12;
    const int n = static_cast<int>(swept.size());
    std::vector<geometry::Box> boxes;
    for (int i = 0; i < n; ++i) boxes.push_back(swept_box(swept[i], 0.5 * (model.dmin + model.dhat), allowances[i]));
    std::vector<NodePair> pairs;
    const auto visit = [&](int a, int b) {
        if (model::may_collide(model, a, b)) pairs.push_back({a, b});
        return true;
    };
    if (n <= few) {
        for (int a = 0; a < n; ++a)
            for (int b = a + 1; b < n; ++b)
                if (boxes[a].overlaps(boxes[b])) visit(a, b);
        return pairs;
    }
    geometry::visit_overlapping_pairs(boxes, visit);
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

// A part of a pair's work: what a thread does in one go.
struct Task {
    std::size_t pair = 0;
    NodePair from{0, 0};
    std::vector<NodePair> leaves;
    BodyPairCandidates found;
};

// Enough parts for two threads or more where the meshes are large; one each where they are small.
std::vector<Task> make_tasks(const std::vector<SweptPair>& pairs) {
    constexpr std::size_t large = 512, parts = 16;  // nodes of both bodies
    std::vector<Task> tasks;
    for (std::size_t k = 0; k < pairs.size(); ++k) {
        const std::size_t size = pairs[k].a->body->hierarchy->nodes().size() + pairs[k].b->body->hierarchy->nodes().size();
        if (size < large) {
            tasks.push_back({k, {0, 0}, {}, {}});
            continue;
        }
        for (const NodePair& from : descend(pairs[k], {0, 0}, parts)) tasks.push_back({k, from, {}, {}});
    }
    return tasks;
}

// Fills the leaves that the tasks look at.
std::vector<SweptElements> fill_elements(const std::vector<SweptBody>& swept, const std::vector<SweptPair>& pairs,
                                         const std::vector<Task>& tasks) {
    std::vector<SweptElements> out(swept.size());
    const auto want = [&](int body, int node) {
        SweptElements& e = out[body];
        if (e.first.empty()) e.first.assign(swept[body].body->hierarchy->nodes().size(), -1);
        e.first[node] = 0;
    };
    for (const Task& task : tasks)
        for (const NodePair& leaves : task.leaves) {
            want(pairs[task.pair].body_a, leaves[0]);
            want(pairs[task.pair].body_b, leaves[1]);
        }
    base::parallel_for(static_cast<int>(swept.size()), 4, [&](int body) {
        SweptElements& e = out[body];
        const BodyHierarchy& hierarchy = *swept[body].body->hierarchy;
        int count = 0;
        for (std::size_t node = 0; node < e.first.size(); ++node) {
            if (e.first[node] < 0) continue;
            e.first[node] = count;
            count += hierarchy.nodes()[node].count;
        }
        if (count == 0) return;
        e.elements = std::make_unique_for_overwrite<SweptElement[]>(static_cast<std::size_t>(count));
        for (std::size_t node = 0; node < e.first.size(); ++node) {
            if (e.first[node] < 0) continue;
            const HierarchyNode& leaf = hierarchy.nodes()[node];
            for (int k = 0; k < leaf.count; ++k)
                e.elements[e.first[node] + k] = swept_element(swept[body], hierarchy.elements()[leaf.first + k]);
        }
    });
    return out;
}

void append(BodyPairCandidates& to, const BodyPairCandidates& from) {
    to.vertex_triangle.insert(to.vertex_triangle.end(), from.vertex_triangle.begin(), from.vertex_triangle.end());
    to.triangle_vertex.insert(to.triangle_vertex.end(), from.triangle_vertex.begin(), from.triangle_vertex.end());
    to.edge_edge.insert(to.edge_edge.end(), from.edge_edge.begin(), from.edge_edge.end());
}

void sort_by_distance(BodyPairCandidates& pair) {
    for (auto* list : {&pair.vertex_triangle, &pair.triangle_vertex, &pair.edge_edge})
        std::sort(list->begin(), list->end(), [](const PrimitivePair& x, const PrimitivePair& y) {
            return std::tie(x.distance, x.a, x.b) < std::tie(y.distance, y.a, y.b);
        });
}

}  // namespace

Candidates find_candidates(const model::Model& model, const std::vector<kinematics::PathSegment>& segments,
                           const std::vector<MotionAllowance>& allowances) {
    Candidates candidates{{}, {}, allowances};
    std::vector<SweptBody> swept;
    for (std::size_t i = 0; i < segments.size(); ++i) {
        swept.push_back(swept_body(model.bodies[i], segments[i]));
        candidates.poses.push_back(swept.back().start);
    }
    std::vector<SweptPair> pairs;
    for (const auto& [a, b] : close_bodies(model, swept, allowances))
        pairs.push_back(swept_pair(a, b, swept, allowances, model.dmin + model.dhat));
    std::vector<Task> tasks = make_tasks(pairs);
    const int count = static_cast<int>(tasks.size());
    base::parallel_for(count, 1, [&](int k) { tasks[k].leaves = descend(pairs[tasks[k].pair], tasks[k].from, 0); });
    const std::vector<SweptElements> elements = fill_elements(swept, pairs, tasks);
    base::parallel_for(count, 1, [&](int k) {
        Task& task = tasks[k];
        const SweptPair& pair = pairs[task.pair];
        LeafSearch search(pair, elements[pair.body_a], elements[pair.body_b]);
        for (const NodePair& leaves : task.leaves) search.visit(leaves);
        task.found = search.take();
    });
    // A pair's tasks follow one another.
    std::vector<BodyPairCandidates> joined(pairs.size());
    std::vector<std::size_t> first_task(pairs.size() + 1, tasks.size());
    for (std::size_t k = tasks.size(); k-- > 0;) first_task[tasks[k].pair] = k;
    for (std::size_t p = pairs.size(); p-- > 0;) first_task[p] = std::min(first_task[p], first_task[p + 1]);
    base::parallel_for(static_cast<int>(pairs.size()), 4, [&](int p) {
        joined[p].a = pairs[p].body_a;
        joined[p].b = pairs[p].body_b;
        for (std::size_t k = first_task[p]; k < first_task[p + 1]; ++k) append(joined[p], tasks[k].found);
        sort_by_distance(joined[p]);
    });
    for (BodyPairCandidates& pair : joined)
        if (!pair.empty()) candidates.pairs.push_back(std::move(pair));
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
