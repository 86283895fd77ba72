// SPDX-License-Identifier: MIT
#include "fettle/core/clearance/pair_search.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <tuple>

#include "fettle/core/base/contract.hpp"
#include "fettle/core/clearance/witness_instant.hpp"

namespace fettle::core::clearance {
namespace {

using contact::BodyHierarchy;
using contact::HierarchyNode;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr int max_halvings = 48;  // so that every parameter is a double exactly

// A dyadic part of a segment; parts are made when first needed and shared by all pieces.
struct Interval {
    int segment = 0;
    int start = 0, end = 0;  // indices of instants
    int first_half = -1, second_half = -1;
    int halvings = 0;
};

// Pieces are nodes, or (both at once) triangles: elements of the hierarchies.
struct Entry {
    double lower = 0;
    std::int64_t order = 0;  // of making: breaks ties the same way on every run
    int interval = 0;
    int a = 0, b = 0;
    bool triangles = false;
    bool halve = false;                                  // in time, else in space; of triangles: their closest points are known
    Vector3 n0 = Vector3::Zero(), n1 = Vector3::Zero();  // triangles: directions of the closest points at the ends
};

struct Later {
    bool operator()(const Entry& x, const Entry& y) const { return std::tie(x.lower, x.order) > std::tie(y.lower, y.order); }
};

// Direction in which two moved boxes are apart, from b to a, the better of what the axes of a and those of b show; `apart` is that gap.
struct BoxGap {
    Vector3 direction;
    double apart = 0;
};

Vector3 excess(const Vector3& d, const Vector3& extent) {
    const Vector3 gap = (d.cwiseAbs() - extent).cwiseMax(0);
    return gap.cwiseProduct(d.cwiseSign());
}

BoxGap box_gap(const Instant& at, const HierarchyNode& a, const HierarchyNode& b) {
    const Vector3 d_world = at.offset + at.rotation_a * a.center - at.rotation_b * b.center;
    const Vector3 d_a = at.rotation_a.transpose() * d_world, d_b = at.rotation_b.transpose() * d_world;
    const Matrix3 size = at.relative_rotation.cwiseAbs();
    const Vector3 gap_a = excess(d_a, a.half_extent + size * b.half_extent);
    const Vector3 gap_b = excess(d_b, b.half_extent + size.transpose() * a.half_extent);
    const double apart_a = gap_a.norm(), apart_b = gap_b.norm();
    if (apart_a == 0 && apart_b == 0) return {unit_direction(d_world), 0};
    if (apart_a >= apart_b) return {unit_direction(at.rotation_a * gap_a), apart_a};
    return {unit_direction(at.rotation_b * gap_b), apart_b};
}

class PairSearch {
public:
    PairSearch(const SearchBody& a, const SearchBody& b, const std::vector<PairSegment>& segments, const SearchOptions& options)
        : a_(a), b_(b), segments_(segments), options_(options) {}

    SearchResult run() {
        result_.upper = infinity;
        for (int i = 0; i < static_cast<int>(segments_.size()); ++i) {
            const int start = add_instant(segments_[i], 0);
            const int end = is_still(segments_[i]) ? start : add_instant(segments_[i], 1);
            intervals_.push_back({i, start, end, -1, -1, 0});
        }
        take_distance_of_any_pair();
        for (int i = 0; i < static_cast<int>(segments_.size()); ++i) try_nodes(i, 0, 0);
        while (!queue_.empty()) {
            if (is_settled()) break;
            result_.complete = result_.evaluations < options_.max_evaluations && !is_stopped();
            if (!result_.complete) break;
            std::pop_heap(queue_.begin(), queue_.end(), Later{});
            const Entry entry = queue_.back();
            queue_.pop_back();
            split(entry);
        }
        const double lower = std::min({aside_, queue_.empty() ? infinity : queue_.front().lower, result_.upper});
        result_.lower = std::max(lower, 0.0);
        refine_witness();
        name_edges();
        return result_;
    }

private:
    // Also settled when an entry at the limit of rounding is the least: what is in the queue cannot raise the lower bound then.
    bool is_settled() const {
        const double next = queue_.front().lower;
        return aside_ <= next || std::max(next, 0.0) >= result_.upper - options_.tolerance;
    }

    bool is_stopped() { return options_.should_stop && (++rounds_ & 255) == 1 && options_.should_stop(); }

    static bool is_still(const PairSegment& s) {
        return s.a.speed == 0 && s.b.speed == 0 && s.a.path.position_step == s.b.path.position_step;
    }

    int add_instant(const PairSegment& segment, double s) {
        instants_.push_back(instant_at(segment, s));
        return static_cast<int>(instants_.size()) - 1;
    }

    const PairSegment& segment_of(const Interval& interval) const { return segments_[interval.segment]; }
    const HierarchyNode& node_a(int i) const { return a_.hierarchy->nodes()[i]; }
    const HierarchyNode& node_b(int i) const { return b_.hierarchy->nodes()[i]; }
    double length(const Interval& interval) const { return instants_[interval.end].s - instants_[interval.start].s; }
    bool can_halve(const Interval& interval) const { return interval.start != interval.end && interval.halvings < max_halvings; }

    static Matrix3 corners(const SearchBody& body, int element) {
        const contact::HierarchyElement& e = body.hierarchy->elements()[element];
        FETTLE_ASSERT(e.triangle >= 0, "mesh " + body.mesh->name + " has loose edges or points");
        Matrix3 x;
        for (int k = 0; k < 3; ++k) x.col(k) = body.mesh->vertices.col(e.vertices[k]);
        return x;
    }

    // Queues the entry, or sets it aside if it cannot change the result.
    void keep(Entry entry, bool splittable) {
        if (!splittable || entry.lower >= result_.upper - options_.tolerance) {
            aside_ = std::min(aside_, entry.lower);
            return;
        }
        entry.order = made_++;
        queue_.push_back(entry);
        std::push_heap(queue_.begin(), queue_.end(), Later{});
    }

    void try_nodes(int interval_index, int a, int b) {
        ++result_.evaluations;
        const Interval& interval = intervals_[interval_index];
        const PairSegment& segment = segment_of(interval);
        const Instant &start = instants_[interval.start], &end = instants_[interval.end];
        const HierarchyNode &box_a = node_a(a), &box_b = node_b(b);
        BoxGap gap0 = box_gap(start, box_a, box_b);
        BoxGap gap1 = interval.start == interval.end ? gap0 : box_gap(end, box_a, box_b);
        if (gap0.apart > 0 && gap1.apart == 0) gap1.direction = gap0.direction;
        if (gap1.apart > 0 && gap0.apart == 0) gap0.direction = gap1.direction;
        const MovingPlane plane = moving_plane(start, end, gap0.direction, gap1.direction);
        const SegmentBound bound = segment_bound(segment, length(interval), plane, box_coefficients(plane, box_a, box_b),
                                                 box_reach(segment.a, box_a), box_reach(segment.b, box_b), options_.deviation_scale);
        Entry entry;
        entry.lower = bound.lower;
        entry.interval = interval_index;
        entry.a = a;
        entry.b = b;
        if (can_halve(interval)) {
            const double size = box_a.half_extent.norm() + box_b.half_extent.norm();
            const double loss = bound.at_ends - bound.lower;
            const bool apart = gap0.apart > 0 && gap1.apart > 0;
            entry.halve = loss > 0.5 * size || (!apart && motion(segment, interval, box_a, box_b) > 2 * size);
        }
        keep(entry, true);
    }

    // Bound of how far the boxes move relative to each other.
    double motion(const PairSegment& s, const Interval& interval, const HierarchyNode& a, const HierarchyNode& b) const {
        const double drift = (s.a.path.position_step - s.b.path.position_step).norm();
        return length(interval) * (drift + s.a.speed * a.radius + s.b.speed * b.radius);
    }

    // A first bound of two triangles from directions at hand: the gap of their boxes and their own normals. Most pairs need no more,
    // and closest points cost ten times as much.
    void try_triangles_quickly(int interval_index, int a, int b, const Vector3& gap0, const Vector3& gap1) {
        const Interval& interval = intervals_[interval_index];
        const Instant &start = instants_[interval.start], &end = instants_[interval.end];
        const Vector3 normal_a = normal(a_, a), normal_b = normal(b_, b);
        const auto towards_a = [](const Vector3& n, const Vector3& d) { return d.dot(n) < 0 ? Vector3(-n) : n; };
        Entry entry;
        entry.lower = triangles_bound(interval, a, b, gap0, gap1).lower;
        for (const bool of_a : {true, false}) {
            if (entry.lower >= result_.upper - options_.tolerance) break;
            const Vector3 n0 = of_a ? start.rotation_a * normal_a : start.rotation_b * normal_b;
            const Vector3 n1 = of_a ? end.rotation_a * normal_a : end.rotation_b * normal_b;
            const Vector3 d = center_difference(start, a, b);
            entry.lower = std::max(entry.lower, triangles_bound(interval, a, b, unit_direction(towards_a(n0, d)),
                                                                unit_direction(towards_a(n1, center_difference(end, a, b))))
                                                    .lower);
        }
        entry.interval = interval_index;
        entry.a = a;
        entry.b = b;
        entry.triangles = true;
        keep(entry, true);
    }

    static Vector3 normal(const SearchBody& body, int element) {
        const Matrix3 x = corners(body, element);
        return (x.col(1) - x.col(0)).cross(x.col(2) - x.col(0));
    }

    Vector3 center_difference(const Instant& at, int a, int b) const {
        return at.offset + (at.rotation_a * corners(a_, a).rowwise().sum() - at.rotation_b * corners(b_, b).rowwise().sum()) / 3;
    }

    void measure_triangles(const Entry& entry) {
        const Interval interval = intervals_[entry.interval];
        const Vector3 n0 = closest_direction(interval.segment, interval.start, entry.a, entry.b);
        const Vector3 n1 = interval.start == interval.end ? n0 : closest_direction(interval.segment, interval.end, entry.a, entry.b);
        try_triangles(entry.interval, entry.a, entry.b, n0, n1);
    }

    SegmentBound triangles_bound(const Interval& interval, int a, int b, const Vector3& n0, const Vector3& n1) {
        ++result_.evaluations;
        const PairSegment& segment = segment_of(interval);
        const Matrix3 corners_a = corners(a_, a), corners_b = corners(b_, b);
        const MovingPlane plane = moving_plane(instants_[interval.start], instants_[interval.end], n0, n1);
        return segment_bound(segment, length(interval), plane, corner_coefficients(plane, corners_a, corners_b),
                             corners_reach(segment.a, corners_a), corners_reach(segment.b, corners_b), options_.deviation_scale);
    }

    void try_triangles(int interval_index, int a, int b, const Vector3& n0, const Vector3& n1) {
        const Interval& interval = intervals_[interval_index];
        const SegmentBound bound = triangles_bound(interval, a, b, n0, n1);
        Entry entry{bound.lower, 0, interval_index, a, b, true, true, n0, n1};
        // Halving cannot win more than the loss; below the rounding charge it is not worth while.
        const bool worth = bound.at_ends - bound.lower > 4 * segment_of(interval).slack;
        keep(entry, worth && can_halve(interval));
    }

    // Distance of two triangles at an instant: an upper bound, and the direction for the lower ones.
    Vector3 closest_direction(int segment_index, int instant_index, int a, int b) {
        const PairSegment& segment = segments_[segment_index];
        const Instant& at = instants_[instant_index];
        const TrianglePairDistance pair = placed_distance(at, corners(a_, a), corners(b_, b));
        const double upper = pair.distance + segment.slack;
        if (upper < result_.upper) set_witness(segment_index, at, a, b, pair);
        return pair.intersecting ? Vector3::Zero() : unit_direction(pair.difference);
    }

    void set_witness(int segment_index, const Instant& at, int a, int b, const TrianglePairDistance& pair) {
        const PairSegment& segment = segments_[segment_index];
        result_.upper = pair.distance + segment.slack;
        witness_segment_ = segment_index;
        witness_a_ = a;
        witness_b_ = b;
        const contact::HierarchyElement &element_a = a_.hierarchy->elements()[a], &element_b = b_.hierarchy->elements()[b];
        Witness& w = result_.witness;
        w.step = segment.step;
        w.segment = segment.segment;
        w.s = at.s;
        w.distance = pair.distance;
        w.kind_a = pair.edge_edge ? Primitive::edge : pair.vertex_on_a ? Primitive::vertex : Primitive::triangle;
        w.kind_b = pair.edge_edge ? Primitive::edge : pair.vertex_on_a ? Primitive::triangle : Primitive::vertex;
        result_.intersecting = pair.intersecting;
        w.edge_edge = pair.edge_edge;
        w.vertex_on_a = pair.vertex_on_a;
        w.primitive_a = pair.edge_edge ? -1 : pair.vertex_on_a ? element_a.vertices[pair.corner_a] : element_a.triangle;
        w.primitive_b = pair.edge_edge ? -1 : pair.vertex_on_a ? element_b.triangle : element_b.vertices[pair.corner_b];
        if (pair.edge_edge) {
            edge_a_ = {element_a.vertices[pair.corner_a], element_a.vertices[(pair.corner_a + 1) % 3]};
            edge_b_ = {element_b.vertices[pair.corner_b], element_b.vertices[(pair.corner_b + 1) % 3]};
        }
        const Vector3 origin = kinematics::pose_at(segment.b.path, at.s).position;
        w.point_a = origin + pair.point_a;
        w.point_b = origin + pair.point_b;
    }

    // So that there is an upper bound however small the budget: down from the roots at the first instant, to the nearest boxes.
    void take_distance_of_any_pair() {
        int a = 0, b = 0;
        const Instant at = instants_[0];
        while (!node_a(a).is_leaf() || !node_b(b).is_leaf()) {
            const bool first = open_a(a, b);
            const HierarchyNode& node = first ? node_a(a) : node_b(b);
            const auto apart = [&](int child) { return center_distance(at, first ? child : a, first ? b : child); };
            (first ? a : b) = apart(node.left) <= apart(node.right) ? node.left : node.right;
        }
        closest_direction(0, intervals_[0].start, node_a(a).first, node_b(b).first);
    }

    double center_distance(const Instant& at, int a, int b) const {
        return (at.offset + at.rotation_a * node_a(a).center - at.rotation_b * node_b(b).center).norm();
    }

    bool open_a(int a, int b) const {
        if (node_a(a).is_leaf()) return false;
        return node_b(b).is_leaf() || node_a(a).half_extent.squaredNorm() >= node_b(b).half_extent.squaredNorm();
    }

    void split(const Entry& entry) {
        if (entry.halve) {
            halve(entry);
        } else if (entry.triangles) {
            measure_triangles(entry);
        } else if (node_a(entry.a).is_leaf() && node_b(entry.b).is_leaf()) {
            split_leaves(entry);
        } else if (open_a(entry.a, entry.b)) {
            try_nodes(entry.interval, node_a(entry.a).left, entry.b);
            try_nodes(entry.interval, node_a(entry.a).right, entry.b);
        } else {
            try_nodes(entry.interval, entry.a, node_b(entry.b).left);
            try_nodes(entry.interval, entry.a, node_b(entry.b).right);
        }
    }

    void split_leaves(const Entry& entry) {
        const HierarchyNode &leaf_a = node_a(entry.a), &leaf_b = node_b(entry.b);
        const Interval interval = intervals_[entry.interval];
        const Vector3 n0 = box_gap(instants_[interval.start], leaf_a, leaf_b).direction;
        const Vector3 n1 = box_gap(instants_[interval.end], leaf_a, leaf_b).direction;
        for (int i = leaf_a.first; i < leaf_a.first + leaf_a.count; ++i)
            for (int j = leaf_b.first; j < leaf_b.first + leaf_b.count; ++j) try_triangles_quickly(entry.interval, i, j, n0, n1);
    }

    void halve(const Entry& entry) {
        if (intervals_[entry.interval].first_half < 0) make_halves(entry.interval);
        const Interval interval = intervals_[entry.interval];
        if (!entry.triangles) {
            try_nodes(interval.first_half, entry.a, entry.b);
            try_nodes(interval.second_half, entry.a, entry.b);
            return;
        }
        const int middle = intervals_[interval.first_half].end;
        const Vector3 n = closest_direction(interval.segment, middle, entry.a, entry.b);
        try_triangles(interval.first_half, entry.a, entry.b, entry.n0, n);
        try_triangles(interval.second_half, entry.a, entry.b, n, entry.n1);
    }

    void make_halves(int index) {
        Interval interval = intervals_[index];
        const double s = 0.5 * (instants_[interval.start].s + instants_[interval.end].s);
        const int middle = add_instant(segment_of(interval), s);
        interval.first_half = static_cast<int>(intervals_.size());
        interval.second_half = interval.first_half + 1;
        intervals_.push_back({interval.segment, interval.start, middle, -1, -1, interval.halvings + 1});
        intervals_.push_back({interval.segment, middle, interval.end, -1, -1, interval.halvings + 1});
        intervals_[index] = interval;
    }

    // The instants that the search looks at are dyadic: their distance is within the tolerance of the least, but a derivative at fixed time
    // wants the time itself right, whose error is the square root of that.
    void refine_witness() {
        const PairSegment& segment = segments_[witness_segment_];
        const Matrix3 corners_a = corners(a_, witness_a_), corners_b = corners(b_, witness_b_);
        const double s = least_distance_near(segment, corners_a, corners_b, result_.witness.s);
        const Instant at = instant_at(segment, s);
        const TrianglePairDistance pair = placed_distance(at, corners_a, corners_b);
        // A flat minimum: the better instant's distance may differ by rounding only.
        if (pair.distance + segment.slack <= result_.upper * (1 + 4 * std::numeric_limits<double>::epsilon()))
            set_witness(witness_segment_, at, witness_a_, witness_b_, pair);
    }

    // The witness holds edges by their corners until the end: finding an edge's index means looking through the mesh.
    void name_edges() {
        if (!result_.witness.edge_edge) return;
        result_.witness.primitive_a = edge_index(*a_.mesh, edge_a_);
        result_.witness.primitive_b = edge_index(*b_.mesh, edge_b_);
    }

    static int edge_index(const geometry::Mesh& mesh, const geometry::Edge& edge) {
        const auto same = [&](const geometry::Edge& e) {
            return (e[0] == edge[0] && e[1] == edge[1]) || (e[0] == edge[1] && e[1] == edge[0]);
        };
        const auto found = std::find_if(mesh.edges.begin(), mesh.edges.end(), same);
        FETTLE_ASSERT(found != mesh.edges.end(), "mesh " + mesh.name + " does not list an edge of its triangles");
        return static_cast<int>(found - mesh.edges.begin());
    }

    SearchBody a_, b_;
    const std::vector<PairSegment>& segments_;
    SearchOptions options_;
    std::vector<Instant> instants_;
    std::vector<Interval> intervals_;
    std::vector<Entry> queue_;  // a heap
    double aside_ = infinity;   // least bound of the entries that are not in the queue any more and were not split
    std::int64_t made_ = 0;
    std::int64_t rounds_ = 0;
    int witness_segment_ = 0, witness_a_ = 0, witness_b_ = 0;  // elements
    geometry::Edge edge_a_{}, edge_b_{};
    SearchResult result_;
};

}  // namespace

SearchResult search_pair(const SearchBody& a, const SearchBody& b, const std::vector<PairSegment>& segments, const SearchOptions& options) {
    FETTLE_ASSERT(!segments.empty(), "a search over no time");
    return PairSearch(a, b, segments, options).run();
}

}  // namespace fettle::core::clearance
