// SPDX-License-Identifier: MIT
#include "core/ccd/candidates.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/parallel.hpp"
#include "core/ccd/pair_motion.hpp"
#include "core/ccd/plane_edges.hpp"
#include "core/ccd/primitive_search.hpp"
#include "core/ccd/swept_pair.hpp"

namespace fettle::core::ccd {
namespace {

using kinematics::PathSegment;
using kinematics::Pose;

constexpr int pairs_a_query = 32;    // pairs of bodies that a thread takes at a time
constexpr double known_share = 0.5;  // of the allowance: as far as a way that was searched is worth going on with

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

bool is_same(const PathSegment& x, const PathSegment& y) {
    return x.rotation_vector_step == y.rotation_vector_step && x.position_step == y.position_step && x.position_t0 == y.position_t0 &&
           x.rotation_vector_t0 == y.rotation_vector_t0 && x.base == y.base;
}

// What the pairs are searched along.
struct Search {
    const model::Model& model;
    const std::vector<PathSegment>& segments;
    const std::vector<SweptBody>& swept;
    double allowance;
    // @param longer  memory for bodies that are searched beyond the segments' ends
    SweptPair of(const BodyPairCandidates& pair, std::array<SweptBody, 2>& longer) const {
        const model::Body &a = model.bodies[pair.a], &b = model.bodies[pair.b];
        const auto on_the_way = [&](int body, std::size_t k) -> const SweptBody& {
            if (is_same(pair.along[k], segments[body])) return swept[body];
            return longer[k] = swept_body(model.bodies[body], pair.along[k]);
        };
        SweptPair out = swept_pair(on_the_way(pair.a, 0), on_the_way(pair.b, 1),
                                   model.dmin + model.dhat + allowance + reach_of(model, a) + reach_of(model, b));
        out.plane_a = plane_features_of(model, a);
        out.plane_b = plane_features_of(model, b);
        return out;
    }
};

void sort_by_distance(geometry::PrimitivePairs& pairs) {
    for (auto* list : {&pairs.vertex_triangle, &pairs.triangle_vertex, &pairs.edge_edge})
        std::sort(list->begin(), list->end(), [](const geometry::PrimitivePair& x, const geometry::PrimitivePair& y) {
            if (x.distance != y.distance) return x.distance < y.distance;
            return x.a != y.a ? x.a < y.a : x.b < y.b;
        });
}

// The segments that a pair is searched along: twice as far as they go where two bodies go on as the last search made expect. Then the next
// step's way is known too.
std::array<PathSegment, 2> search_way(const Search& search, const BodyPairCandidates& pair) {
    constexpr double farther = 2, bent = 0.25;  // times the segments; of the allowance
    const PathSegment &a = search.segments[pair.a], &b = search.segments[pair.b];
    if (!(pair.allowance > 0)) return {a, b};
    const double radius_a = search.model.bodies[pair.a].radius, radius_b = search.model.bodies[pair.b].radius;
    const double arcs =
        0.125 * farther * farther * (a.rotation_vector_step.squaredNorm() * radius_a + b.rotation_vector_step.squaredNorm() * radius_b);
    if (!(arcs <= bent * search.allowance)) return {a, b};
    const auto longer = [](const PathSegment& s) { return sub_segment(s, 0, farther); };
    const std::array<PathSegment, 2> expected{longer(pair.along[0]), longer(pair.along[1])};
    if (!(deviation_in_space(expected, a, b, radius_a, radius_b) <= known_share * search.allowance)) return {a, b};
    return {longer(a), longer(b)};
}

enum class Need { nothing, known_way, search };

// How far a pair's segments are from the way that was searched last.
double off_known_way(const Search& search, const BodyPairCandidates& pair) {
    const PathSegment &a = search.segments[pair.a], &b = search.segments[pair.b];
    const double radius_a = search.model.bodies[pair.a].radius, radius_b = search.model.bodies[pair.b].radius;
    return deviation_in_space(pair.along, a, b, radius_a, radius_b);
}

Need need_of(const Search& search, const BodyPairCandidates& pair) {
    if (pair.fresh) return Need::search;
    const auto& swept = search.swept;
    if (motion_over(search.model, pair, search.segments, swept[pair.a].ends[0], swept[pair.b].ends[0]) <= pair.allowance)
        return Need::nothing;
    return off_known_way(search, pair) <= known_share * pair.allowance ? Need::known_way : Need::search;
}

// The segments are on the way that was searched: all that comes near along them is among the candidates found there. The allowance shrinks
// by how far they are off that way.
void take_known_way(const Search& search, BodyPairCandidates& pair) {
    pair.allowance -= off_known_way(search, pair) * (1 + 1e-12);
    pair.along = {search.segments[pair.a], search.segments[pair.b]};
    if (pair.empty()) return;
    std::array<SweptBody, 2> longer;
    SweptPair swept = search.of(pair, longer);
    swept.margin -= search.allowance - pair.allowance;
    search_again(swept, pair);
    sort_by_distance(pair);
}

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
        std::array<SweptBody, 2> longer;
        for (const NodePair& from : close_nodes(along.of(*searched[k], longer), parts)) tasks.push_back({k, from, {}});
    }
    return tasks;
}

void append(std::vector<geometry::PrimitivePair>& to, const std::vector<geometry::PrimitivePair>& from) {
    to.insert(to.end(), from.begin(), from.end());
}

// Fills the lists of all that are searched.
void search(const Search& along, const std::vector<BodyPairCandidates*>& searched) {
    std::vector<Task> tasks = make_tasks(searched, along);
    base::parallel_for(count_of(tasks), 1, [&](int k) {
        Task& task = tasks[k];
        std::array<SweptBody, 2> longer;
        const SweptPair pair = along.of(*searched[task.pair], longer);  // large, and soon made: not kept
        search_primitives(pair, task.from, task.found);
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

    static thread_local std::vector<Need> need_memory;
    std::vector<Need>& need = need_memory;
    need.resize(candidates.pairs.size());
    const Search along{model, segments, swept, allowance};
    base::parallel_for(count_of(candidates.pairs), pairs_a_query, [&](int k) {
        BodyPairCandidates& pair = candidates.pairs[k];
        need[k] = need_of(along, pair);
        if (need[k] == Need::search) pair.along = search_way(along, pair);
        pair.fresh = need[k] != Need::nothing;
    });
    candidates.fresh.clear();
    std::vector<BodyPairCandidates*> searched, known;
    for (std::size_t k = 0; k < need.size(); ++k) {
        if (need[k] == Need::nothing) continue;
        candidates.fresh.push_back(static_cast<int>(k));
        (need[k] == Need::search ? searched : known).push_back(&candidates.pairs[k]);
    }
    search(along, searched);
    base::parallel_for(count_of(known), 1, [&](int k) { take_known_way(along, *known[k]); });
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
    return std::min(since_at, deviation_in_chart(pair.along, a, b, radius_a, radius_b)) +
           rounding_of(start_a, start_b, radius_a, radius_b) + rounding_of(pair.at[0], pair.at[1], radius_a, radius_b) +
           search_rounding * (a.position_step.norm() + b.position_step.norm());
}

}  // namespace fettle::core::ccd
