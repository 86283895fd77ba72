// SPDX-License-Identifier: MIT
#include "fettle/core/contact/safe_step.hpp"

#include <algorithm>
#include <cmath>

#include "fettle/core/contact/body_hierarchy.hpp"
#include "fettle/core/contact/conservative_advancement.hpp"
#include "fettle/core/contact/contact_pair.hpp"

namespace fettle::core::contact {
namespace {

using kinematics::PathSegment;
using kinematics::Pose;

struct Limits {
    double kept_fraction;  // of the distance above dmin that a pair keeps
    double kept_most;      // and never has to keep more than this [m]
};

class StepSearch {
public:
    StepSearch(const model::Model& model, const std::vector<PathSegment>& segments, Limits limits)
        : model_(model), segments_(segments), limits_(limits) {
        for (const PathSegment& s : segments_) starts_.push_back(pose_at(s, 0));
    }

    void visit(const BodyPairCandidates& list) {
        if (list.empty()) return;
        const double reach = model_.dmin + limits_.kept_most + motion_over(model_, list, segments_);
        const model::Body &a = model_.bodies[list.a], &b = model_.bodies[list.b];
        const auto& va = a.mesh.vertices;
        const auto& vb = b.mesh.vertices;
        for (const auto& [v, t, distance] : list.vertex_triangle) {
            if (distance > reach) break;
            const geometry::Triangle& c = b.hierarchy->faces()[t];
            check(PairType::point_triangle, list.a, list.b, {va.col(v), vb.col(c[0]), vb.col(c[1]), vb.col(c[2])});
        }
        for (const auto& [t, v, distance] : list.triangle_vertex) {
            if (distance > reach) break;
            const geometry::Triangle& c = a.hierarchy->faces()[t];
            check(PairType::point_triangle, list.b, list.a, {vb.col(v), va.col(c[0]), va.col(c[1]), va.col(c[2])});
        }
        for (const auto& [i, j, distance] : list.edge_edge) {
            if (distance > reach) break;
            const geometry::Edge &ea = a.mesh.edges[i], &eb = b.mesh.edges[j];
            check(PairType::edge_edge, list.a, list.b, {va.col(ea[0]), va.col(ea[1]), vb.col(eb[0]), vb.col(eb[1])});
        }
    }

    const SafeStep& result() const { return result_; }

private:
    void check(PairType type, int first, int second, const PairVertices& X) {
        if (result_.fraction == 0) return;
        const PathSegment &sa = segments_[first], &sb = segments_[second];
        PairVertices x;
        double radius_a = 0, radius_b = 0;
        const int n = first_count(type);
        for (int i = 0; i < 4; ++i) {
            x[i] = world_position(starts_[i < n ? first : second], X[i]);
            double& radius = i < n ? radius_a : radius_b;
            radius = std::max(radius, X[i].squaredNorm());
        }
        // A proven lower bound of the distance at the start, and of what the pair can lose: most pairs need no more.
        const double distance = distance_lower_bound(type, x) - rounding_ * (x[0].norm() + x[3].norm());
        const double kept = model_.dmin + std::min(limits_.kept_fraction * std::max(0.0, distance - model_.dmin), limits_.kept_most);
        const double travel = (sa.position_step - sb.position_step).norm() + sa.rotation_vector_step.norm() * std::sqrt(radius_a) +
                              sb.rotation_vector_step.norm() * std::sqrt(radius_b);
        if (distance > kept + result_.fraction * travel * (1 + 1e-12)) return;
        // Always the whole segment: a part of it would be another path, by rounding.
        const CurvedCcdResult ccd = curved_ccd(type, sa, sb, X, kept);
        if (ccd.hit && ccd.toi < result_.fraction) result_ = {ccd.toi, first, second};
    }

    static constexpr double rounding_ = 1e-14;  // of world positions, relative to their size
    const model::Model& model_;
    const std::vector<PathSegment>& segments_;
    const Limits limits_;
    std::vector<Pose> starts_;
    SafeStep result_;
};

}  // namespace

SafeStep longest_safe_step(const model::Model& model, const Candidates& candidates, const std::vector<PathSegment>& segments) {
    StepSearch search(model, segments, {0.1, 0.25 * model.dhat});
    for (const BodyPairCandidates& list : candidates.pairs) search.visit(list);
    return search.result();
}

bool is_path_clear(const model::Model& model, const Candidates& candidates, const std::vector<PathSegment>& segments) {
    StepSearch search(model, segments, {0.01, 0.01 * model.dhat});
    for (const BodyPairCandidates& list : candidates.pairs) {
        search.visit(list);
        if (search.result().fraction < 1) return false;
    }
    return true;
}

}  // namespace fettle::core::contact
