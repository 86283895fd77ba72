// SPDX-License-Identifier: MIT
#include "core/ccd/safe_step.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "core/base/parallel.hpp"
#include "core/base/rounding.hpp"
#include "core/base/stop.hpp"
#include "core/ccd/linear_ccd.hpp"
#include "core/ccd/plane_edges.hpp"
#include "core/geometry/body_hierarchy.hpp"

namespace fettle::core::ccd {
namespace {

using kinematics::PathSegment;
using kinematics::Pose;

struct Limits {
    double kept_fraction;  // of the distance above dmin that a pair keeps
    double kept_most;      // and never has to keep more than this [m]
};

constexpr int bodies_at_once = 64;  // that a thread takes

// Charged to world positions at least, relative to their size: more than their rounding, but where a body's position and its points'
// cancel near the world's origin.
constexpr double usual_rounding = 1e-14;

// The rounding of a body's points at the start: per metre from its reference point, and of its position.
struct PlaceRounding {
    double rate, constant;
    double of(double radius) const { return (rate * radius + constant) * (1 + 1e-12); }
};

// As rotated_rounding (chord_deviation.hpp), where the rotation vector is exact. For one of at most 1 the cosine is off by 3u, sinc(x) and
// (1 - cos x)/x^2 by 4u of their values at most 1 and 1/2, so R by u (4 + 15 |theta| + 10 |theta|^2); 12u for the products with base and X.
PlaceRounding place_rounding(const PathSegment& s) {
    const double theta = s.rotation_vector_t0.norm();
    return {theta <= 1 ? unit_roundoff * (17 + 32 * theta) : rotated_rounding(theta, 0, 0, 1) + unit_roundoff,
            2 * unit_roundoff * s.position_t0.norm()};
}

// What is common to all pairs of bodies. Each pair of primitives has a fraction of its own, proven free, and the least of all is wanted;
// which pairs are looked at closely depends on how far the search has come, on all threads, but none of those passed over has the least.
class StepSearch {
public:
    StepSearch(const model::Model& model, const std::vector<PathSegment>& segments, Limits limits,
               const std::vector<BodyDistance>* start = nullptr)
        : model_(model), segments_(segments), limits_(limits), start_(start), starts_(segments.size()), start_roundings_(segments.size()) {
        base::parallel_for(count_of(segments), bodies_at_once, [&](int i) {
            starts_[i] = pose_at(segments[i], 0);
            start_roundings_[i] = place_rounding(segments[i]);
        });
    }

    SafeStep longest(const Candidates& candidates) {
        return base::ordered_reduce(
            count_of(candidates.pairs), candidates.pairs_at_once(), SafeStep{},
            [&](int begin, int end) {
                SafeStep shortest;
                for (int k = begin; k < end; ++k) visit(candidates.pairs[k], shortest);
                return shortest;
            },
            [](SafeStep&& so_far, SafeStep&& piece) { return piece.fraction < so_far.fraction ? piece : so_far; });
    }

    // Is the least fraction 1?
    bool is_free(const Candidates& candidates) {
        base::parallel_for(count_of(candidates.pairs), candidates.pairs_at_once(), [&](int k) {
            SafeStep shortest;
            if (least_ == 1) visit(candidates.pairs[k], shortest);
        });
        return least_ == 1;
    }

private:
    void visit(const BodyPairCandidates& list, SafeStep& shortest) {
        if (list.empty()) return;
        const double least_kept = model_.dmin + lost_by_plane_edges(model_, model_.bodies[list.a], model_.bodies[list.b]);
        if (are_surely_free(list, least_kept)) return;
        const double reach = model_.dmin + limits_.kept_most + motion_over(model_, list, segments_, starts_[list.a], starts_[list.b]);
        const model::Body &a = model_.bodies[list.a], &b = model_.bodies[list.b];
        const auto& va = a.mesh.vertices;
        const auto& vb = b.mesh.vertices;
        const auto check = [&](geometry::PairType type, int first, int second, const geometry::PairVertices& X) {
            const double fraction = free_fraction(type, first, second, X, least_kept);
            if (fraction < shortest.fraction) shortest = {fraction, first, second};
        };
        for (const auto& [v, t, distance] : list.vertex_triangle) {
            if (distance > reach) break;
            const geometry::Triangle& c = b.hierarchy->faces()[t];
            check(geometry::PairType::point_triangle, list.a, list.b, {va.col(v), vb.col(c[0]), vb.col(c[1]), vb.col(c[2])});
        }
        for (const auto& [t, v, distance] : list.triangle_vertex) {
            if (distance > reach) break;
            const geometry::Triangle& c = a.hierarchy->faces()[t];
            check(geometry::PairType::point_triangle, list.b, list.a, {vb.col(v), va.col(c[0]), va.col(c[1]), va.col(c[2])});
        }
        for (const auto& [i, j, distance] : list.edge_edge) {
            if (distance > reach) break;
            const geometry::Edge &ea = a.mesh.edges[i], &eb = b.mesh.edges[j];
            check(geometry::PairType::edge_edge, list.a, list.b, {va.col(ea[0]), va.col(ea[1]), vb.col(eb[0]), vb.col(eb[1])});
        }
    }

    // The distance that a pair keeps.
    double kept_of(double distance) const {
        return model_.dmin + std::min(limits_.kept_fraction * std::max(0.0, distance - model_.dmin), limits_.kept_most);
    }

    // Told from the bodies' least distance at the start, where it is known: primitives that are farther apart keep no more beside it. Off
    // by the rounding of distances (64 u of their vertices' distances, geometry/distance.hpp) and of places, here and there, and by what
    // flat edges are nearer.
    bool are_surely_free(const BodyPairCandidates& list, double least_kept) const {
        if (start_ == nullptr) return false;
        const auto before = [](const BodyDistance& x, const std::pair<int, int>& key) { return std::pair(x.a, x.b) < key; };
        const std::pair key(list.a, list.b);
        const auto known = std::lower_bound(start_->begin(), start_->end(), key, before);
        if (known == start_->end() || std::pair(known->a, known->b) != key) return false;
        const model::Body &a = model_.bodies[list.a], &b = model_.bodies[list.b];
        const PathSegment &sa = segments_[list.a], &sb = segments_[list.b];
        const double size = 2 * (a.radius + b.radius), place = sa.position_t0.norm() + sb.position_t0.norm() + size;
        const double heights = (a.flat ? a.flat->height : 0) + (b.flat ? b.flat->height : 0);
        const double lost = heights + 256 * unit_roundoff * (size + known->distance) + 4 * usual_rounding * place +
                            start_roundings_[list.a].of(a.radius) + start_roundings_[list.b].of(b.radius);
        const double distance = std::min(known->distance, model_.dmin + model_.dhat) - lost;
        return kept_of(distance) >= least_kept && distance > kept_of(distance) + travel_of(sa, sb, a.radius, b.radius);
    }

    // Bound of how far points of two bodies, so far from their reference points, move relative to one another.
    static double travel_of(const PathSegment& a, const PathSegment& b, double radius_a, double radius_b) {
        return (1 + 1e-12) * ((a.position_step - b.position_step).norm() + a.rotation_vector_step.norm() * radius_a +
                              b.rotation_vector_step.norm() * radius_b);
    }

    // The pair's fraction, or some larger one than the least of all. @param least_kept  what speaks for the plane edges too
    // (plane_edges.hpp)
    double free_fraction(geometry::PairType type, int first, int second, const geometry::PairVertices& X, double least_kept) {
        const PathSegment &sa = segments_[first], &sb = segments_[second];
        geometry::PairVertices x;
        double radius_a = 0, radius_b = 0;
        const int n = geometry::first_count(type);
        for (int i = 0; i < 4; ++i) {
            x[i] = world_position(starts_[i < n ? first : second], X[i]);
            double& radius = i < n ? radius_a : radius_b;
            radius = std::max(radius, X[i].squaredNorm());
        }
        // A proven lower bound of the distance at the start, and of what the pair can lose: most pairs need no more.
        radius_a = std::sqrt(radius_a);
        radius_b = std::sqrt(radius_b);
        const double seen = distance_lower_bound(type, x);
        const double needed = 8 * unit_roundoff * seen + start_roundings_[first].of(radius_a) + start_roundings_[second].of(radius_b);
        const double distance = seen - std::max(usual_rounding * (x[0].norm() + x[3].norm()), needed);
        const double kept = kept_of(distance), travel = travel_of(sa, sb, radius_a, radius_b);
        if (!(kept >= least_kept)) {
            least_ = 0;
            return 0;
        }
        if (distance > kept + travel) return 1;
        const double surely_free = distance > kept ? (1 - 1e-12) * (distance - kept) / travel : 0;
        if (surely_free > least_) return 1;
        base::stop_if_asked();
        // Always the whole segment: a part of it would be another path, by rounding.
        const CurvedCcdResult ccd = curved_ccd(type, sa, sb, X, kept);
        const double fraction = ccd.hit ? std::max(ccd.toi, surely_free) : 1;  // in this order: what is not a number loses
        for (double least = least_; fraction < least && !least_.compare_exchange_weak(least, fraction);) {
        }
        return fraction;
    }

    const model::Model& model_;
    const std::vector<PathSegment>& segments_;
    const Limits limits_;
    const std::vector<BodyDistance>* start_;
    std::vector<Pose> starts_;
    std::vector<PlaceRounding> start_roundings_;
    std::atomic<double> least_ = 1;  // so far, on all threads
};

}  // namespace

SafeStep longest_safe_step(const model::Model& model, const Candidates& candidates, const std::vector<PathSegment>& segments,
                           const std::vector<BodyDistance>* start) {
    return StepSearch(model, segments, {0.1, 0.25 * model.dhat}, start).longest(candidates);
}

bool is_path_clear(const model::Model& model, const Candidates& candidates, const std::vector<PathSegment>& segments) {
    return StepSearch(model, segments, {0.01, 0.01 * model.dhat}).is_free(candidates);
}

}  // namespace fettle::core::ccd
