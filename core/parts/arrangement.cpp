// SPDX-License-Identifier: MIT
#include "core/parts/arrangement.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "core/base/units.hpp"
#include "core/parts/curve_meetings.hpp"
#include "core/parts/fault_words.hpp"
#include "core/parts/sampled_loops.hpp"

namespace fettle::core::parts {
namespace {

// Points by cells of a grid.
class NodeIndex {
public:
    NodeIndex(std::vector<Point2>& nodes, double tolerance) : nodes_(nodes), tolerance_(tolerance), cell_(8 * tolerance) {}

    int find_or_add(const Point2& p) {
        const Vector2 v = value(p);
        const auto [known, is_new] = exactly_.emplace(std::pair(v.x(), v.y()), -1);  // the same point, always the same node
        if (is_new) known->second = found_near(p, v);
        return known->second;
    }

private:
    int found_near(const Point2& p, const Vector2& v) {
        const double x = std::floor(v.x() / cell_), y = std::floor(v.y() / cell_);  // too many for integers, far from the origin
        int best = -1;
        double least = tolerance_;
        for (const double i : {x - 1, x, x + 1}) {
            for (const double j : {y - 1, y, y + 1}) {
                const auto found = cells_.find({i, j});
                if (found == cells_.end()) continue;
                for (const int node : found->second) {
                    const double distance = (value(nodes_[node]) - v).norm();
                    if (distance > least) continue;
                    least = distance;
                    best = node;
                }
            }
        }
        if (best >= 0) return best;
        nodes_.push_back(p);
        cells_[{x, y}].push_back(count_of(nodes_) - 1);
        return count_of(nodes_) - 1;
    }

    std::vector<Point2>& nodes_;
    double tolerance_, cell_;
    std::map<std::pair<double, double>, int> exactly_;
    std::map<std::pair<double, double>, std::vector<int>> cells_;
};

struct NodeCut {
    Cut cut;
    int node;
};

Vector2 leaving(const Curve& curve) {
    const Vector2 d = at(curve, 1.0 / 64).position - value(start_of(curve));
    return d.norm() > 0 ? Vector2(d.normalized()) : at(curve, 0.01).velocity;
}

Vector2 arriving(const Curve& curve) {
    const Vector2 d = value(end_of(curve)) - at(curve, 63.0 / 64).position;
    return d.norm() > 0 ? Vector2(d.normalized()) : at(curve, 0.99).velocity;
}

bool is_closed(const Curve& curve) { return value(start_of(curve)) == value(end_of(curve)); }

}  // namespace

Curve Arrangement::curve_of(const Piece& piece) const {
    const Curve along = between(curves[piece.source].segment.curve, piece.begin, piece.end);
    return piece.backwards ? reversed(along) : along;
}

Vector2 Arrangement::middle_of(const Piece& piece) const {
    return at(curves[piece.source].segment.curve, (piece.begin.u + piece.end.u) / 2).position;
}

int Arrangement::coincide(const Piece& a, const Piece& b) const {
    const bool same = a.from == b.from && a.to == b.to, opposite = a.from == b.to && a.to == b.from;
    if (!same && !opposite) return 0;
    const Vector2 p = middle_of(a);
    const Curve& curve = curves[b.source].segment.curve;
    double u = nearest_parameter(curve, p);
    if (u < b.begin.u - 1e-6 || u > b.end.u + 1e-6) return 0;
    const CurvePoint other = at(curve, u);
    if ((other.position - p).norm() > 16 * tolerance) return 0;
    const double along = at(curves[a.source].segment.curve, (a.begin.u + a.end.u) / 2).velocity.dot(other.velocity);
    return (along > 0) == (a.backwards == b.backwards) ? 1 : -1;
}

Arrangement arranged(std::vector<ArrangedCurve> curves, double tolerance, bool within_groups) {
    Arrangement out;
    out.curves = std::move(curves);
    out.tolerance = tolerance;
    const std::size_t n = out.curves.size();
    NodeIndex index(out.nodes, 4 * tolerance);
    std::vector<std::vector<NodeCut>> cuts(n);
    for (std::size_t k = 0; k < n; ++k) {
        const Curve& curve = out.curves[k].segment.curve;
        for (const double u : {0.0, 1.0}) {
            const Point2& p = u == 0 ? start_of(curve) : end_of(curve);
            cuts[k].push_back({{u, u, p}, index.find_or_add(p)});
        }
        out.starts.push_back(cuts[k].front().node);
    }
    std::vector<Box2> boxes;
    for (const ArrangedCurve& curve : out.curves) {
        Box2 box = box_of(curve.segment.curve);
        box.low.array() -= 2 * tolerance;
        box.high.array() += 2 * tolerance;
        boxes.push_back(box);
    }
    std::vector<std::size_t> order(n);
    for (std::size_t k = 0; k < n; ++k) order[k] = k;
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return boxes[a].low.x() < boxes[b].low.x(); });
    std::vector<std::pair<std::size_t, std::size_t>> pairs;
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = i + 1; j < n && boxes[order[j]].low.x() <= boxes[order[i]].high.x(); ++j) {
            const auto [a, b] = std::minmax(order[i], order[j]);
            if (!within_groups && out.curves[a].group == out.curves[b].group) continue;
            if (boxes[a].meets(boxes[b])) pairs.push_back({a, b});
        }
    }
    std::sort(pairs.begin(), pairs.end());
    for (const auto& [a, b] : pairs) {
        for (const Meeting& m : meetings(out.curves[a].segment.curve, out.curves[b].segment.curve, tolerance)) {
            const int node = index.find_or_add(m.on_a.point);
            cuts[a].push_back({m.on_a, node});
            cuts[b].push_back({m.on_b, node});
        }
    }
    for (std::size_t k = 0; k < n; ++k) {
        const Curve& curve = out.curves[k].segment.curve;
        const double length = sampled_length(curve);
        std::stable_sort(cuts[k].begin(), cuts[k].end(), [](const NodeCut& x, const NodeCut& y) { return x.cut.u < y.cut.u; });
        std::vector<NodeCut> kept;
        for (NodeCut cut : cuts[k]) {
            cut.cut.point = out.nodes[cut.node];
            const bool again = !kept.empty() && kept.back().node == cut.node && (cut.cut.u - kept.back().cut.u) * length <= 32 * tolerance;
            if (!again)
                kept.push_back(cut);
            else if (cut.cut.u == 1)
                kept.back().cut.u = 1;  // nothing is left between a cut and the end
        }
        for (std::size_t i = 0; i + 1 < kept.size(); ++i)
            out.pieces.push_back({k, kept[i].cut, kept[i + 1].cut, kept[i].node, kept[i + 1].node, false});
    }
    return out;
}

Piece turned_round(Piece piece) {
    std::swap(piece.from, piece.to);
    piece.backwards = !piece.backwards;
    return piece;
}

Coincidence::Coincidence(const Arrangement& arrangement) : arrangement_(arrangement) {
    for (std::size_t k = 0; k < arrangement.pieces.size(); ++k)
        by_nodes_[std::minmax(arrangement.pieces[k].from, arrangement.pieces[k].to)].push_back(k);
}

int Coincidence::find(std::size_t piece, bool of_other_group, std::size_t& other) const {
    const Piece& a = arrangement_.pieces[piece];
    const int group = arrangement_.curves[a.source].group;
    for (const std::size_t k : by_nodes_.at(std::minmax(a.from, a.to))) {
        const Piece& b = arrangement_.pieces[k];
        if (k == piece || (of_other_group && group == arrangement_.curves[b.source].group)) continue;
        other = k;
        if (const int way = arrangement_.coincide(a, b); way != 0) return way;
    }
    return 0;
}

std::vector<Piece> bounding(const Arrangement& arrangement, const std::vector<Loop>& a, const std::vector<Loop>& b,
                            Combination combination) {
    const SampledLoops in_a(a), in_b(b);
    const Coincidence coincidence(arrangement);
    std::vector<Piece> kept;
    for (std::size_t k = 0; k < arrangement.pieces.size(); ++k) {
        const Piece& piece = arrangement.pieces[k];
        const bool of_a = arrangement.curves[piece.source].group == 0;
        std::size_t other = 0;
        if (const int way = coincidence.find(k, true, other); way != 0) {
            // Once, and only where the material of both is on the same side (for a difference: on opposite ones).
            if (of_a && (way > 0) == (combination != Combination::subtract)) kept.push_back(piece);
            continue;
        }
        const bool inside = (of_a ? in_b : in_a).contains(arrangement.middle_of(piece));
        if (combination == Combination::subtract && !of_a) {
            if (inside) kept.push_back(turned_round(piece));
        } else if (inside == (combination == Combination::intersect)) {
            kept.push_back(piece);
        }
    }
    return kept;
}

Result<std::vector<std::vector<std::size_t>>> chains_from(const Arrangement& arrangement, const std::vector<Piece>& pieces) {
    std::vector<Curve> curves;
    std::map<int, std::vector<std::size_t>> leaving_node;
    for (std::size_t k = 0; k < pieces.size(); ++k) {
        curves.push_back(arrangement.curve_of(pieces[k]));
        leaving_node[pieces[k].from].push_back(k);
    }
    std::vector<char> used(pieces.size(), 0);
    std::vector<std::vector<std::size_t>> chains;
    for (std::size_t first = 0; first < pieces.size(); ++first) {
        if (used[first]) continue;
        std::vector<std::size_t> chain{first};
        used[first] = 1;
        for (;;) {
            const std::size_t last = chain.back();
            const auto found = leaving_node.find(pieces[last].to);
            std::size_t next = pieces.size();
            double sharpest = -10;
            if (found != leaving_node.end()) {
                const Vector2 in = arriving(curves[last]);
                for (const std::size_t k : found->second) {
                    if (used[k] && k != first) continue;
                    const Vector2 d = leaving(curves[k]);
                    const double turn = std::atan2(in.x() * d.y() - in.y() * d.x(), in.dot(d));
                    if (turn <= sharpest) continue;
                    sharpest = turn;
                    next = k;
                }
            }
            if (next == pieces.size()) {
                const ArrangedCurve& curve = arrangement.curves[pieces[last].source];
                return Error{ErrorCode::inconsistent, curve.segment.feature,
                             "curves touch `" + curve.segment.feature + "` near " + place(value(end_of(curves[last]))) +
                                 " without crossing, so that rounding decides what is cut: move one of them by a little"};
            }
            if (next == first) break;
            used[next] = 1;
            chain.push_back(next);
        }
        chains.push_back(std::move(chain));
    }
    return chains;
}

Result<std::vector<Loop>> loops_from(const Arrangement& arrangement, const std::vector<Piece>& pieces) {
    const auto chains = chains_from(arrangement, pieces);
    if (!chains) return chains.errors();
    std::vector<Loop> loops;
    for (const auto& chain : *chains) {
        // Neighbours of one curve become one piece again.
        std::vector<Piece> merged;
        const auto continues = [&](const Piece& a, const Piece& b) {
            if (a.source != b.source || a.backwards != b.backwards || a.to != b.from) return false;
            const Piece &low = a.backwards ? b : a, &high = a.backwards ? a : b;
            return low.end.u == high.begin.u;
        };
        const auto joined = [&](Piece a, const Piece& b) {
            (a.backwards ? a.begin : a.end) = a.backwards ? b.begin : b.end;
            a.to = b.to;
            return a;
        };
        for (const std::size_t k : chain) {
            if (!merged.empty() && continues(merged.back(), pieces[k]))
                merged.back() = joined(merged.back(), pieces[k]);
            else
                merged.push_back(pieces[k]);
        }
        if (merged.size() > 1 && continues(merged.back(), merged.front())) {
            merged.front() = joined(merged.back(), merged.front());
            merged.pop_back();
        }
        Loop loop;
        for (std::size_t k = 0; k < merged.size(); ++k) {
            const Piece& piece = merged[k];
            const ArrangedCurve& source = arrangement.curves[piece.source];
            Curve curve = arrangement.curve_of(piece);
            // Over the start of a whole circle it goes on.
            const Piece& next = merged[(k + 1) % merged.size()];
            const bool around = merged.size() > 1 && std::holds_alternative<Arc>(curve) && is_closed(source.segment.curve) &&
                                next.source == piece.source && next.backwards == piece.backwards && piece.to == next.from &&
                                std::abs((piece.backwards ? piece.begin : piece.end).u - (piece.backwards ? 0 : 1)) < 1e-12;
            if (around) {
                auto arc = std::get<Arc>(curve);
                arc.end = end_of(arrangement.curve_of(next));
                curve = arc;
                if (k + 1 < merged.size())
                    merged.erase(merged.begin() + static_cast<std::ptrdiff_t>(k) + 1);
                else {
                    loop.segments.erase(loop.segments.begin());
                    merged.erase(merged.begin());
                }
            }
            loop.segments.push_back({curve, source.segment.feature, source.segment.facets});
            if (around && k >= merged.size()) break;
        }
        loops.push_back(std::move(loop));
    }
    return loops;
}

}  // namespace fettle::core::parts
