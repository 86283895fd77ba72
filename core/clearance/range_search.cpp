// SPDX-License-Identifier: MIT
#include "core/clearance/range_search.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "core/base/kronecker.hpp"
#include "core/clearance/pair_search.hpp"
#include "core/clearance/piece_bound.hpp"
#include "core/clearance/revolved_bound.hpp"
#include "core/clearance/search_front.hpp"

namespace fettle::core::clearance {
namespace {

using RangeCell = BoxCell<CoordinateBox>;

// Evaluates cells; remembers the nearest pair of elements that it has met.
class CellBounds {
public:
    using Box = CoordinateBox;
    using Encounter = RangeEncounter;

    explicit CellBounds(const ScrewedPair& pair) : pair_(pair) {}

    RangeSearchResult result;

    BoxTrees trees() const { return {pair_.a, pair_.b, pair_.count, pair_.slack}; }
    CoordinateBox root_box() const { return pair_.ranges; }
    void descend();

    CellProof evaluate(RangeCell& cell, double wanted, double /*tolerance*/) { return evaluate(BoxBound(pair_, cell.box), cell, wanted); }
    void evaluate_parts(const RangeCell& whole, char by, std::array<RangeCell, 2>& parts, double /*tolerance*/) {
        if (by == 'a' || by == 'b') {
            const BoxBound box(pair_, whole.box);
            for (RangeCell& part : parts) evaluate(box, part, result.upper);
        } else {
            for (RangeCell& part : parts) evaluate(BoxBound(pair_, part.box), part, result.upper);
        }
    }
    static bool proves(const CellProof& found, double distance) { return found.lower >= distance; }

    void take(const RangeEncounter& encounter) { take_upper(result, encounter, pair_.slack); }

private:
    CellProof evaluate(const BoxBound& box, RangeCell& cell, double wanted) {
        ++result.bounds;
        const Piece &a = pair_.a.pieces[cell.a], &b = pair_.b.pieces[cell.b];
        const Corners *element_a = element(pair_.a, a), *element_b = element(pair_.b, b);
        const bool elements = element_a != nullptr && element_b != nullptr;
        Vector3 n;
        if (elements) {
            const ElementPairDistance at_middle = box.distance(*element_a, *element_b, -1);
            take({middle_of(cell.box), a.first, b.first, at_middle});
            n = unit_direction(at_middle.difference);
        } else {
            const kinematics::Pose &pa = box.middle_a(), &pb = box.middle_b();
            n = box_separation(kinematics::world_position(pa, a.center) - kinematics::world_position(pb, b.center), pa.rotation * a.axes,
                               a.half_extent, pb.rotation * b.axes, b.half_extent)
                    .direction;
        }
        CellProof proof{0, {n}};
        RangeBound best = box.along(n, a, b, element_a, element_b);
        if (elements && pair_.count > 0 && !(best.lower >= wanted)) {
            std::vector<Vector3> normals = corner_normals(box, cell, *element_a, *element_b);
            const RangeBound other = box.along(normals, *element_a, *element_b);
            if (other.lower > best.lower) {
                best = other;
                proof.normals = std::move(normals);
            }
        }
        if (pair_.revolution && !(best.lower >= wanted)) take_revolved(cell, best, proof);
        proof.lower = proven(best.lower);
        cell.lower = std::max(cell.lower, proof.lower);
        cell.loosened = best.loosened;
        cell.widest = best.widest;
        return proof;
    }

    // Where the turns do not matter, halving them is of no use.
    void take_revolved(const RangeCell& cell, RangeBound& best, CellProof& proof) {
        if (!revolved_) revolved_ = std::make_shared<const RevolvedBound>(pair_);
        const RevolvedBound::Found found = revolved_->bound(cell.a, cell.b, cell.box);
        if (!(found.lower > best.lower)) return;
        best.loosened -= found.lower - best.lower;
        best.lower = found.lower;
        proof.normals = {found.vector};
        proof.is_round = true;
    }

    static const Corners* element(const PieceTree& tree, const Piece& piece) {
        return piece.is_element() ? &tree.elements[piece.first].corners : nullptr;
    }

    std::vector<Vector3> corner_normals(const BoxBound& box, const RangeCell& cell, const Corners& a, const Corners& b) {
        std::vector<Vector3> normals;
        for (int c = 0; c < box.corners(); ++c) {
            const ElementPairDistance found = box.distance(a, b, c);
            Coordinates at{};
            for (int k = 0; k < pair_.count; ++k) {
                const auto i = static_cast<std::size_t>(k);
                at[i] = (c >> k & 1) != 0 ? cell.box.high[i] : cell.box.low[i];
            }
            take({at, pair_.a.pieces[cell.a].first, pair_.b.pieces[cell.b].first, found});
            normals.push_back(unit_direction(found.difference));
        }
        return normals;
    }

    const ScrewedPair& pair_;
    std::shared_ptr<const RevolvedBound> revolved_;  // once it is needed
};

// Samples, and downhill from the best: along each coordinate to and fro, with steps that shrink.
class Descent {
public:
    Descent(const ScrewedPair& pair, CellBounds& cells) : pair_(pair), cells_(cells) {}

    void run() {
        const Coordinates middle = middle_of(pair_.ranges);
        Coordinates best = pair_.start;  // or, where the box has no part in it, the nearest that it has
        for (std::size_t k = 0; k < static_cast<std::size_t>(pair_.count); ++k)
            best[k] = std::clamp(best[k], pair_.ranges.low[k], pair_.ranges.high[k]);
        double least = distance(best);
        const auto look = [&](const Coordinates& at) {
            const double d = distance(at);
            if (!(d < least)) return false;
            least = d;
            best = at;
            return true;
        };
        if (pair_.count == 0) return;
        look(middle);
        static const base::Kronecker spread(most_coordinates);
        for (int i = 1; i <= 8 + 8 * pair_.count; ++i) {
            Coordinates at = middle;
            for (std::size_t k = 0; k < static_cast<std::size_t>(pair_.count); ++k) at[k] = between(k, spread.at(i, k));
            look(at);
        }
        for (double step = 0.125; step > 1e-9 && least > 0; step *= 0.5) {
            bool again = true;
            for (int sweep = 0; again && sweep < 8; ++sweep) {
                again = false;
                for (std::size_t k = 0; k < static_cast<std::size_t>(pair_.count); ++k)
                    for (const double sign : {-1.0, 1.0}) {
                        Coordinates at = best;
                        at[k] = std::clamp(best[k] + sign * step * (pair_.ranges.high[k] - pair_.ranges.low[k]), pair_.ranges.low[k],
                                           pair_.ranges.high[k]);
                        again = look(at) || again;
                    }
            }
        }
    }

private:
    double between(std::size_t k, double share) const {
        return std::clamp(pair_.ranges.low[k] + share * (pair_.ranges.high[k] - pair_.ranges.low[k]), pair_.ranges.low[k],
                          pair_.ranges.high[k]);
    }

    // The two elements that are nearest there, taken as an upper bound.
    double distance(const Coordinates& at) {
        SearchOptions search;
        search.max_evaluations = 200'000;
        const double known = cells_.result.upper;
        search.tolerance = std::isfinite(known) ? 1e-6 * known + pair_.slack : 1e-6 * (pair_.a.radius() + pair_.b.radius());
        search.enough = known;
        search.seek_intersection = !(known > 64 * pair_.slack);
        const RangeEncounter found = nearest_at(pair_, at, search);
        if (found.element_a < 0) return infinity;
        cells_.take(found);
        return found.pair.distance;
    }

    const ScrewedPair& pair_;
    CellBounds& cells_;
};

void CellBounds::descend() { Descent(pair_, *this).run(); }

}  // namespace

PairSegment held_at(const ScrewedPair& pair, const Coordinates& at) {
    return pair_held(pose_of(pair.body_a, at), pose_of(pair.body_b, at), pair.a.radius(), pair.b.radius());
}

RangeEncounter nearest_at(const ScrewedPair& pair, const Coordinates& at, const SearchOptions& search) {
    const Encounter found = search_pair(pair.a, pair.b, {held_at(pair, at)}, search).nearest;
    if (found.segment < 0) return {at, -1, -1, {}};
    const BoxBound point(pair, {at, at});
    return {at, found.element_a, found.element_b,
            point.distance(pair.a.elements[found.element_a].corners, pair.b.elements[found.element_b].corners, -1)};
}

RangeSearchResult search_ranges(const ScrewedPair& pair, const BoxSearchOptions& options) {
    return BoxSearch(CellBounds(pair), options).run();
}

certificate::BoxProof prove_ranges(const ScrewedPair& pair, double distance, const BoxSearchOptions& options) {
    return prove_box(CellBounds(pair), distance, options);
}

}  // namespace fettle::core::clearance
