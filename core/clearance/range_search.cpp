// SPDX-License-Identifier: MIT
#include "fettle/core/clearance/range_search.hpp"

#include <algorithm>
#include <cmath>

#include "fettle/core/clearance/pair_search.hpp"
#include "fettle/core/clearance/piece_bound.hpp"
#include "fettle/core/clearance/search_front.hpp"

namespace fettle::core::clearance {
namespace {

struct RangeCell {
    CoordinateBox box;
    int a = 0, b = 0;
    double lower = 0;
    double loosened = 0;
    int widest = 0;
};

constexpr char no_split = '.';

// What a bound is proven with.
struct CellProof {
    double lower = 0;
    std::vector<Vector3> normals;
};

// Evaluates and splits cells; remembers the nearest pair of elements that it has met.
class CellBounds {
public:
    explicit CellBounds(const ScrewedPair& pair) : pair_(pair) {}

    RangeSearchResult result;

    RangeCell root() const { return {pair_.ranges, 0, 0, 0, 0, 0}; }

    /// Sets the cell's bound and what to split it by. `wanted`: a bound of this much is enough.
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
        proof.lower = proven(best.lower);
        cell.lower = std::max(cell.lower, proof.lower);
        cell.loosened = best.loosened;
        cell.widest = best.widest;
        return proof;
    }

    /// '0' + k, 'a', 'b', or no_split: at the limit of rounding.
    char choice(const RangeCell& cell) const {
        const Piece &a = pair_.a.pieces[cell.a], &b = pair_.b.pieces[cell.b];
        const double size_a = a.is_element() ? -1 : a.size, size_b = b.is_element() ? -1 : b.size, size = std::max(size_a, size_b);
        if (size < 0 || cell.loosened > 0.5 * size)
            for (int i = 0; i < pair_.count; ++i) {
                const auto k = static_cast<std::size_t>((cell.widest + i) % pair_.count);
                const double middle = 0.5 * (cell.box.low[k] + cell.box.high[k]);
                if (cell.box.low[k] < middle && middle < cell.box.high[k]) return static_cast<char>('0' + static_cast<int>(k));
            }
        if (size < 0) return no_split;
        return size_a >= size_b ? 'a' : 'b';
    }

    /// Contract: a choice but no_split.
    std::array<RangeCell, 2> split(const RangeCell& cell, char by) const {
        std::array<RangeCell, 2> out{cell, cell};
        const Piece &a = pair_.a.pieces[cell.a], &b = pair_.b.pieces[cell.b];
        if (by == 'a') {
            out[0].a = a.left;
            out[1].a = a.right;
        } else if (by == 'b') {
            out[0].b = b.left;
            out[1].b = b.right;
        } else {
            const auto k = static_cast<std::size_t>(by - '0');
            out[0].box.high[k] = out[1].box.low[k] = 0.5 * (cell.box.low[k] + cell.box.high[k]);
        }
        return out;
    }

    void take(const RangeEncounter& encounter) {
        const double sum = encounter.pair.distance + pair_.slack, upper = std::isnan(sum) ? infinity : sum;
        const bool clash = encounter.pair.intersecting && encounter.pair.depth > 8 * pair_.slack;
        const bool better = clash != result.intersecting ? clash : upper < result.upper;  // touching is not yet a clash
        if (result.nearest.element_a >= 0 && !better) return;
        result.upper = upper;
        result.nearest = encounter;
        result.intersecting = clash;
    }

private:
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
};

// Samples, and downhill from the best: along each coordinate to and fro, with steps that shrink.
class Descent {
public:
    Descent(const ScrewedPair& pair, CellBounds& cells) : pair_(pair), cells_(cells) {}

    void run() {
        const Coordinates middle = middle_of(pair_.ranges);
        Coordinates best = pair_.start;
        double least = distance(pair_.start);
        const auto look = [&](const Coordinates& at) {
            const double d = distance(at);
            if (!(d < least)) return false;
            least = d;
            best = at;
            return true;
        };
        if (pair_.count == 0) return;
        look(middle);
        const std::array<double, most_coordinates> steps{0.8567, 0.7339, 0.6287, 0.5386};  // Kronecker sequence of four dimensions
        for (int i = 1; i <= 8 + 8 * pair_.count; ++i) {
            Coordinates at = middle;
            for (std::size_t k = 0; k < static_cast<std::size_t>(pair_.count); ++k) at[k] = between(k, std::fmod(0.5 + i * steps[k], 1.0));
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
        const kinematics::Pose a = pose_of(pair_.body_a, at), b = pose_of(pair_.body_b, at);
        kinematics::PathSegment held_a, held_b;
        held_a.base = a.rotation;
        held_a.position_t0 = a.position;
        held_b.base = b.rotation;
        held_b.position_t0 = b.position;
        SearchOptions search;
        search.max_evaluations = 200'000;
        const double known = cells_.result.upper;
        search.tolerance = std::isfinite(known) ? 1e-6 * known + pair_.slack : 1e-6 * (pair_.a.radius() + pair_.b.radius());
        search.enough = known;
        search.seek_intersection = !(known > 64 * pair_.slack);
        const SearchResult found =
            search_pair(pair_.a, pair_.b, {pair_segment(held_a, held_b, pair_.a.radius(), pair_.b.radius())}, search);
        if (found.nearest.segment < 0) return infinity;
        const BoxBound point(pair_, {at, at});
        const ElementPairDistance pair =
            point.distance(pair_.a.elements[found.nearest.element_a].corners, pair_.b.elements[found.nearest.element_b].corners, -1);
        cells_.take({at, found.nearest.element_a, found.nearest.element_b, pair});
        return pair.distance;
    }

    const ScrewedPair& pair_;
    CellBounds& cells_;
};

class RangeSearch {
public:
    RangeSearch(const ScrewedPair& pair, const RangeSearchOptions& options) : pair_(pair), options_(options), cells_(pair) {}

    RangeSearchResult run() {
        Descent(pair_, cells_).run();
        RangeCell root = cells_.root();
        cells_.evaluate(BoxBound(pair_, root.box), root, infinity);
        push(root);
        while (!is_settled()) {
            if (cells_.result.bounds >= options_.max_bounds ||
                (options_.should_stop && cells_.result.bounds % 256 < 2 && options_.should_stop())) {
                cells_.result.complete = false;
                break;
            }
            expand(pop());
        }
        cells_.result.lower = std::max(0.0, lower_bound());
        if (cells_.result.intersecting) cells_.result.lower = 0;
        return std::move(cells_.result);
    }

private:
    void push(const RangeCell& cell) {
        if (cell.lower >= cells_.result.upper) return;
        queue_.push({cell.lower, made_++, static_cast<std::uint32_t>(pool_.add(cell))});
    }
    RangeCell pop() { return pool_.take(static_cast<int>(queue_.pop().entry)); }

    double lower_bound() const { return std::min({aside_, queue_.least(), cells_.result.upper - 2 * pair_.slack}); }

    bool is_settled() const {
        const double lower = lower_bound(), upper = cells_.result.upper;
        if (cells_.result.intersecting || queue_.empty() || queue_.least() >= aside_ || lower >= options_.enough) return true;
        if (!(upper - lower <= options_.tolerance)) return false;
        if (upper - lower <= 4 * pair_.slack) return true;
        const double finest = 1e-3 * options_.tolerance;  // where the minimum lies between, or 0 does
        if (!(lower > 0) && upper > 64 * pair_.slack) return upper - lower <= std::min(finest, 1e-2 * upper);
        return !(options_.minimum > lower && options_.minimum <= upper) || upper - lower <= finest;
    }

    void expand(const RangeCell& cell) {
        const char by = cells_.choice(cell);
        if (by == no_split) {
            aside_ = std::min(aside_, cell.lower);
            return;
        }
        std::array<RangeCell, 2> parts = cells_.split(cell, by);
        if (by == 'a' || by == 'b') {
            const BoxBound box(pair_, cell.box);
            for (RangeCell& part : parts) cells_.evaluate(box, part, cells_.result.upper);
        } else {
            for (RangeCell& part : parts) cells_.evaluate(BoxBound(pair_, part.box), part, cells_.result.upper);
        }
        for (const RangeCell& part : parts) push(part);
    }

    const ScrewedPair& pair_;
    const RangeSearchOptions& options_;
    CellBounds cells_;
    EntryPool<RangeCell> pool_;
    BestFirst queue_;
    double aside_ = infinity;  // least bound of what cannot be split
    std::uint32_t made_ = 0;
};

}  // namespace

RangeSearchResult search_ranges(const ScrewedPair& pair, const RangeSearchOptions& options) { return RangeSearch(pair, options).run(); }

certificate::BoxProof prove_ranges(const ScrewedPair& pair, double distance, const RangeSearchOptions& options) {
    CellBounds cells(pair);
    certificate::BoxProof proof;
    std::vector<RangeCell> pending{cells.root()};
    while (!pending.empty()) {
        RangeCell cell = pending.back();
        pending.pop_back();
        const CellProof found = cells.evaluate(BoxBound(pair, cell.box), cell, distance);
        if (found.lower >= distance) {
            proof.splits += found.normals.size() == 1 ? '.' : ':';
            proof.normals.insert(proof.normals.end(), found.normals.begin(), found.normals.end());
            continue;
        }
        const char by = cells.choice(cell);
        const bool stopped = options.should_stop && cells.result.bounds % 256 == 0 && options.should_stop();
        if (by == no_split || cells.result.bounds > 2 * options.max_bounds || stopped) return {};
        proof.splits += by;
        const std::array<RangeCell, 2> parts = cells.split(cell, by);
        pending.push_back(parts[1]);
        pending.push_back(parts[0]);
    }
    return proof;
}

}  // namespace fettle::core::clearance
