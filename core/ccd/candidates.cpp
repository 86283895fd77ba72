// SPDX-License-Identifier: MIT
#include "fettle/core/ccd/candidates.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "fettle/core/base/parallel.hpp"
#include "fettle/core/ccd/leaf_search.hpp"
#include "fettle/core/ccd/plane_edges.hpp"
#include "fettle/core/ccd/swept_pair.hpp"

namespace fettle::core::ccd {
namespace {

using kinematics::PathSegment;
using kinematics::Pose;

constexpr double slack = 1 + 1e-12;  // of sums of a few products
constexpr int pairs_a_query = 32;    // pairs of bodies that a thread takes at a time

// Bound of how far points of two bodies move relative to one another along their segments.
double most_relative_motion(const PathSegment& a, const PathSegment& b, double radius_a, double radius_b) {
    return slack * ((a.position_step - b.position_step).norm() + a.rotation_vector_step.norm() * radius_a +
                    b.rotation_vector_step.norm() * radius_b);
}

// |R1 - R2|_F / sqrt 2 bounds |(R1 - R2) X| / |X|.
double turn(const Matrix3& r1, const Matrix3& r2) { return (r1 - r2).norm() * std::sqrt(0.5); }

// The same between two pairs of poses: distances of points do not change when both bodies move alike, so the least of what is seen from
// the world and from each body holds.
double most_relative_motion(const Pose& a1, const Pose& b1, const Pose& a2, const Pose& b2, double radius_a, double radius_b) {
    const Vector3 offset1 = b1.position - a1.position, offset2 = b2.position - a2.position;
    double least = (offset2 - offset1).norm() + turn(a1.rotation, a2.rotation) * radius_a + turn(b1.rotation, b2.rotation) * radius_b;
    const Matrix3 relative1 = a1.rotation.transpose() * b1.rotation, relative2 = a2.rotation.transpose() * b2.rotation;
    const double turned = turn(relative1, relative2);
    least = std::min(least, (a2.rotation.transpose() * offset2 - a1.rotation.transpose() * offset1).norm() + turned * radius_b);
    least = std::min(least, (b2.rotation.transpose() * offset2 - b1.rotation.transpose() * offset1).norm() + turned * radius_a);
    return slack * least;
}

// Distances are taken at rounded vertices.
double rounding_of(const Pose& a, const Pose& b, double radius_a, double radius_b) {
    return search_rounding * (a.position.norm() + b.position.norm() + radius_a + radius_b);
}

// Where two bodies are to one another, in one chart: differences of two such points are linear along segments, and the sum of the norms of
// such a difference's parts bounds how much nearer their points are.
struct PairPoint {
    Vector3 offset, arc_a, arc_b;  // [m]
    double norm() const { return offset.norm() + arc_a.norm() + arc_b.norm(); }
    double dot(const PairPoint& o) const { return offset.dot(o.offset) + arc_a.dot(o.arc_a) + arc_b.dot(o.arc_b); }
};

PairPoint difference(const PairPoint& x, const PairPoint& y, double share = 1) {
    return {x.offset - share * y.offset, x.arc_a - share * y.arc_a, x.arc_b - share * y.arc_b};
}

PairPoint pair_point(const PathSegment& a, const PathSegment& b, double t, double radius_a, double radius_b) {
    return {a.position_t0 - b.position_t0 + t * (a.position_step - b.position_step),
            radius_a * (a.rotation_vector_t0 + t * a.rotation_vector_step), radius_b * (b.rotation_vector_t0 + t * b.rotation_vector_step)};
}

// How far two bodies on the segments a and b are from where they were somewhere along `from`, in the same chart. Each end is held against
// the point that is about nearest, and the way between against the way between those: their difference is convex, largest at an end.
double deviation(const std::array<PathSegment, 2>& from, const PathSegment& a, const PathSegment& b, double radius_a, double radius_b) {
    if (from[0].base != a.base || from[1].base != b.base) return std::numeric_limits<double>::infinity();
    const PairPoint start = pair_point(from[0], from[1], 0, radius_a, radius_b);
    const PairPoint step = difference(pair_point(from[0], from[1], 1, radius_a, radius_b), start);
    const double square = step.dot(step);
    double largest = 0;
    for (const double t : {0.0, 1.0}) {
        const PairPoint off = difference(pair_point(a, b, t, radius_a, radius_b), start);
        const double nearest = square > 0 ? std::clamp(off.dot(step) / square, 0.0, 1.0) : 0.0;
        const double distance = difference(off, step, nearest).norm();
        if (!(distance <= largest)) largest = distance;
        if (std::isnan(largest)) break;
    }
    return slack * largest;
}

// How far the surface that is in contact may be from the body's mesh.
double reach_of(const model::Model& model, const model::Body& body) {
    return model.round_reach > 0 && body.round ? body.round->largest_height : 0;
}

// World-axis box of a whole body along its segment.
geometry::Box swept_box(const SweptBody& s, double margin) {
    const geometry::HierarchyNode& root = s.body->hierarchy->nodes()[0];
    geometry::Box box{Vector3::Constant(std::numeric_limits<double>::infinity()),
                      Vector3::Constant(-std::numeric_limits<double>::infinity())};
    for (const Pose& pose : s.ends) {
        const Vector3 center = world_position(pose, root.center), half = pose.rotation.cwiseAbs() * root.half_extent;
        box.low = box.low.cwiseMin(center - half);
        box.high = box.high.cwiseMax(center + half);
        margin += search_rounding * (pose.position.norm() + root.radius);
    }
    margin += s.deviation(root.radius);
    constexpr double everywhere = 1e300;
    if (!std::isfinite(margin)) return {Vector3::Constant(-everywhere), Vector3::Constant(everywhere)};
    box.low.array() -= margin;
    box.high.array() += margin;
    return box;
}

// With room for the body to move in.
geometry::Box roomy(const geometry::Box& box, double allowance) {
    constexpr double share = 0.05, most = 64;  // of its diagonal; of the allowance: a wide floor need not be near everything
    const double room = allowance + std::min(share * (box.high - box.low).norm(), most * allowance);
    return {box.low.array() - room, box.high.array() + room};
}

// The lists of NearBodies, from the beginning.
void find_near_bodies(const model::Model& model, const std::vector<geometry::Box>& boxes, double allowance, NearBodies& near) {
    near.boxes.clear();
    for (const geometry::Box& box : boxes) near.boxes.push_back(roomy(box, allowance));
    near.pairs = geometry::overlapping_pairs(near.boxes, [&](int a, int b) { return model::may_collide(model, a, b); });
}

// Pairs of bodies whose swept boxes meet, in order: whatever was known before.
std::vector<std::pair<int, int>> close_bodies(const model::Model& model, const std::vector<geometry::Box>& boxes, double allowance,
                                              NearBodies& near) {
    const auto holds = [](const geometry::Box& room, const geometry::Box& box) {
        return room.contains(box.low) && room.contains(box.high);
    };
    if (!std::equal(near.boxes.begin(), near.boxes.end(), boxes.begin(), boxes.end(), holds))
        find_near_bodies(model, boxes, allowance, near);
    std::vector<std::pair<int, int>> pairs;
    pairs.reserve(near.pairs.size());
    for (const auto& [a, b] : near.pairs)
        if (boxes[a].overlaps(boxes[b])) pairs.emplace_back(a, b);
    return pairs;
}

// Leaves the entries that are still wanted, and new ones, sorted as `wanted`.
void take_over(std::vector<std::pair<int, int>> wanted, Candidates& candidates) {
    if (wanted == candidates.bodies && wanted.size() == candidates.pairs.size()) return;
    std::vector<BodyPairCandidates>&from = candidates.pairs, &out = candidates.spare;
    out.reserve(wanted.size());
    auto old = from.begin();
    for (const auto& [a, b] : wanted) {
        while (old != from.end() && std::pair(old->a, old->b) < std::pair(a, b)) ++old;
        if (old != from.end() && old->a == a && old->b == b) {
            out.push_back(std::move(*old++));
        } else {
            out.emplace_back();
            out.back().a = a;
            out.back().b = b;
            out.back().fresh = true;
        }
    }
    from.swap(out);
    out.clear();
    candidates.bodies = std::move(wanted);
}

// What the pairs are searched along.
struct Search {
    const model::Model& model;
    const std::vector<PathSegment>& segments;
    const std::vector<SweptBody>& swept;
    double allowance;
    SweptPair of(const BodyPairCandidates& pair) const {
        const model::Body &a = model.bodies[pair.a], &b = model.bodies[pair.b];
        SweptPair out =
            swept_pair(swept[pair.a], swept[pair.b], model.dmin + model.dhat + allowance + reach_of(model, a) + reach_of(model, b));
        out.plane_a = plane_features_of(model, a);
        out.plane_b = plane_features_of(model, b);
        return out;
    }
};

// A part of a pair's work: what a thread does in one go.
struct Task {
    int pair = 0;  // among those searched
    NodePair from{0, 0};
    geometry::PrimitivePairs found;
};

// Large meshes in parts where there are few pairs: enough for two threads or more.
std::vector<Task> make_tasks(const std::vector<BodyPairCandidates*>& searched, const Search& along) {
    constexpr std::size_t large = 512, most_parts = 16, wanted = 64;  // `large`: nodes of both bodies
    // What is found is sorted: in how many parts it was changes nothing.
    const std::size_t parts = base::thread_count() > 1 ? std::min(most_parts, wanted / std::max<std::size_t>(searched.size(), 1)) : 1;
    std::vector<Task> tasks;
    tasks.reserve(searched.size());
    const auto size_of = [&](int body) { return along.swept[body].body->hierarchy->nodes().size(); };
    for (int k = 0; k < count_of(searched); ++k) {
        if (parts < 2 || size_of(searched[k]->a) + size_of(searched[k]->b) < large) {
            tasks.push_back({k, {0, 0}, {}});
            continue;
        }
        for (const NodePair& from : close_nodes(along.of(*searched[k]), {0, 0}, parts)) tasks.push_back({k, from, {}});
    }
    return tasks;
}

void append(std::vector<geometry::PrimitivePair>& to, const std::vector<geometry::PrimitivePair>& from) {
    to.insert(to.end(), from.begin(), from.end());
}

void sort_by_distance(geometry::PrimitivePairs& pairs) {
    for (auto* list : {&pairs.vertex_triangle, &pairs.triangle_vertex, &pairs.edge_edge})
        std::sort(list->begin(), list->end(), [](const geometry::PrimitivePair& x, const geometry::PrimitivePair& y) {
            return std::tie(x.distance, x.a, x.b) < std::tie(y.distance, y.a, y.b);
        });
}

// Fills the lists of all that are searched.
void search(const Search& along, const std::vector<BodyPairCandidates*>& searched) {
    std::vector<Task> tasks = make_tasks(searched, along);
    base::parallel_for(count_of(tasks), 1, [&](int k) {
        Task& task = tasks[k];
        const SweptPair pair = along.of(*searched[task.pair]);  // large, and soon made: not kept
        search_leaves(pair, close_nodes(pair, task.from), task.found);
    });
    // A pair's tasks follow one another.
    std::vector<std::size_t> first(searched.size() + 1, tasks.size());
    for (std::size_t k = tasks.size(); k-- > 0;) first[tasks[k].pair] = k;
    for (std::size_t p = searched.size(); p-- > 0;) first[p] = std::min(first[p], first[p + 1]);
    std::size_t found = 0;
    for (const Task& task : tasks) found += task.found.size();
    base::parallel_for(count_of(searched), geometry::pairs_at_once(searched.size(), found), [&](int p) {
        BodyPairCandidates& pair = *searched[p];
        pair.allowance = along.allowance;
        pair.along = {along.segments[pair.a], along.segments[pair.b]};
        geometry::PrimitivePairs& out = pair;
        out = {};
        for (std::size_t k = first[p]; k < first[p + 1]; ++k) {
            if (k == first[p]) {
                out = std::move(tasks[k].found);
                continue;
            }
            append(out.vertex_triangle, tasks[k].found.vertex_triangle);
            append(out.triangle_vertex, tasks[k].found.triangle_vertex);
            append(out.edge_edge, tasks[k].found.edge_edge);
        }
        sort_by_distance(out);
        pair.sides = side_pieces(along.model, pair.a, pair.b, out);
    });
}

}  // namespace

int Candidates::pairs_at_once() const {
    std::size_t primitives = 0;
    for (const BodyPairCandidates& pair : pairs) primitives += pair.size();
    return geometry::pairs_at_once(pairs.size(), primitives);
}

void cover(const model::Model& model, const std::vector<PathSegment>& segments, double allowance, Candidates& candidates) {
    const double half_margin = 0.5 * (model.dmin + model.dhat + allowance);
    static thread_local std::vector<SweptBody> swept_memory;  // stays from call to call
    static thread_local std::vector<geometry::Box> box_memory;
    std::vector<SweptBody>& swept = swept_memory;
    std::vector<geometry::Box>& boxes = box_memory;
    swept.resize(segments.size());
    boxes.resize(segments.size());
    base::parallel_for(count_of(segments), pairs_a_query, [&](int i) {
        swept[i] = swept_body(model.bodies[i], segments[i]);
        boxes[i] = swept_box(swept[i], half_margin + reach_of(model, model.bodies[i]));
    });
    take_over(close_bodies(model, boxes, allowance, candidates.near), candidates);

    static thread_local std::vector<char> fresh_memory;
    std::vector<char>& is_fresh = fresh_memory;
    is_fresh.resize(candidates.pairs.size());
    base::parallel_for(count_of(candidates.pairs), pairs_a_query, [&](int k) {
        BodyPairCandidates& pair = candidates.pairs[k];
        pair.fresh = pair.fresh || !(motion_over(model, pair, segments, swept[pair.a].ends[0], swept[pair.b].ends[0]) <= pair.allowance);
        is_fresh[k] = pair.fresh ? 1 : 0;
    });
    candidates.fresh.clear();
    std::vector<BodyPairCandidates*> searched;
    for (std::size_t k = 0; k < is_fresh.size(); ++k) {
        if (is_fresh[k] == 0) continue;
        candidates.fresh.push_back(static_cast<int>(k));
        searched.push_back(&candidates.pairs[k]);
    }
    search({model, segments, swept, allowance}, searched);
}

void settle(const std::vector<Pose>& poses, Candidates& candidates) {
    for (const int k : candidates.fresh) {
        BodyPairCandidates& pair = candidates.pairs[k];
        pair.fresh = false;
        pair.at = {poses[pair.a], poses[pair.b]};
    }
    candidates.fresh.clear();
}

Candidates find_candidates(const model::Model& model, const std::vector<Pose>& poses, double allowance) {
    std::vector<PathSegment> segments(poses.size());
    for (std::size_t i = 0; i < poses.size(); ++i)
        segments[i] = {poses[i].rotation, Vector3::Zero(), Vector3::Zero(), poses[i].position, Vector3::Zero()};
    Candidates candidates;
    cover(model, segments, allowance, candidates);
    settle(poses, candidates);
    return candidates;
}

double motion_since(const model::Model& model, const BodyPairCandidates& pair, const std::vector<Pose>& poses) {
    if (pair.fresh) return 0;
    const Pose &a = poses[pair.a], &b = poses[pair.b];
    const double radius_a = model.bodies[pair.a].radius, radius_b = model.bodies[pair.b].radius;
    return most_relative_motion(pair.at[0], pair.at[1], a, b, radius_a, radius_b) + rounding_of(a, b, radius_a, radius_b) +
           rounding_of(pair.at[0], pair.at[1], radius_a, radius_b);
}

double motion_over(const model::Model& model, const BodyPairCandidates& pair, const std::vector<PathSegment>& segments) {
    return motion_over(model, pair, segments, pose_at(segments[pair.a], 0), pose_at(segments[pair.b], 0));
}

double motion_over(const model::Model& model, const BodyPairCandidates& pair, const std::vector<PathSegment>& segments, const Pose& start_a,
                   const Pose& start_b) {
    if (pair.fresh) return 0;
    const PathSegment &a = segments[pair.a], &b = segments[pair.b];
    const double radius_a = model.bodies[pair.a].radius, radius_b = model.bodies[pair.b].radius;
    const double since_at =
        most_relative_motion(pair.at[0], pair.at[1], start_a, start_b, radius_a, radius_b) + most_relative_motion(a, b, radius_a, radius_b);
    return std::min(since_at, deviation(pair.along, a, b, radius_a, radius_b)) + rounding_of(start_a, start_b, radius_a, radius_b) +
           rounding_of(pair.at[0], pair.at[1], radius_a, radius_b) + search_rounding * (a.position_step.norm() + b.position_step.norm());
}

}  // namespace fettle::core::ccd
