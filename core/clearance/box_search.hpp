// SPDX-License-Identifier: MIT
/// Branch and bound for the least distance of two bodies over a box of variables: cells (box, piece of a, piece of b), the most promising
/// first, halved along a variable where the box loosens the bound by more than half the pieces' size, else the larger piece is split. The
/// least bound of the queue bounds the distance from below at any moment. Before that, samples of the box and a search downhill from the
/// best give an upper bound that is nearly the least: most cells are never looked at.
///
/// The choice of variables is the business of `Cells`: joint coordinates (range_search.hpp), or these and deviations of dimensions
/// (toleranced_search.hpp). It has
///   Box, Encounter             a box of variables (low, high), and two elements at a point of it (element_a, element_b, pair)
///   trees                      BoxTrees: the bodies' pieces, how many variables there are, and the rounding of a distance
///   result                     BoxSearchResult<Encounter>; take_upper keeps its upper bound
///   root_box()                 all of it
///   descend()                  looks for a good upper bound
///   evaluate(cell, wanted, tolerance)                  sets a cell's bound, and how to split it; a bound of `wanted` is enough
///   evaluate_parts(whole, by, parts, tolerance)        the same of a cell's two parts, for a bound of result.upper
///   proves(proof, distance)                            does this proof hold for so much, in a checker's arithmetic?
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

#include "core/certificate/certificate.hpp"
#include "core/clearance/element_pair.hpp"
#include "core/clearance/piece_tree.hpp"
#include "core/clearance/search_front.hpp"
#include "core/clearance/stop_rule.hpp"

namespace fettle::core::clearance {

struct BoxSearchOptions {
    double tolerance = 1e-6;  ///< [m]
    StopRule stop;            ///< of a minimum the search goes on below the tolerance until it does not lie between the bounds
    long max_bounds = 4'000'000;
    std::function<bool()> should_stop;
    double enough = std::numeric_limits<double>::infinity();  ///< stops where they are proven so far apart, whatever the least distance [m]
};

template <class Encounter>
struct BoxSearchResult {
    double lower = 0, upper = std::numeric_limits<double>::infinity();  ///< [m]
    Encounter nearest;                                                  ///< attains `upper`, up to slack
    long bounds = 0;
    bool complete = true;       ///< false: out of budget, or stopped, before the tolerance was reached
    bool intersecting = false;  ///< `nearest` is an edge through a triangle, deeper than rounding
};

struct BoxTrees {
    const PieceTree &a, &b;
    int variables = 0;
    double slack = 0;  ///< [m]
};

template <class Box>
struct BoxCell {
    Box box;
    int a = 0, b = 0;     ///< pieces
    double lower = 0;     ///< bound of the distance
    double loosened = 0;  ///< what the box costs of it
    int widest = 0;       ///< the variable that costs most
};

/// What a bound is proven with: one vector that stays, or several, of which it is made up over the box.
struct CellProof {
    double lower = 0;
    std::vector<Vector3> normals;
    bool is_round = false;  ///< the one vector is that of a leaf o
};

/// At the limit of rounding there is no split.
inline constexpr char no_split = '.';

/// certificate::split_along of a variable, 'a', 'b', or no_split.
template <class Box>
char choice_of_split(const BoxCell<Box>& cell, const BoxTrees& of) {
    const Piece &a = of.a.pieces[cell.a], &b = of.b.pieces[cell.b];
    const double size_a = a.is_element() ? -1 : a.size, size_b = b.is_element() ? -1 : b.size, size = std::max(size_a, size_b);
    if (size < 0 || cell.loosened > 0.5 * size)
        for (int i = 0; i < of.variables; ++i) {
            const int k = (cell.widest + i) % of.variables;
            const double low = cell.box.low[static_cast<std::size_t>(k)], high = cell.box.high[static_cast<std::size_t>(k)];
            const double middle = 0.5 * (low + high);
            if (low < middle && middle < high) return certificate::split_along(k);
        }
    if (size < 0) return no_split;
    return size_a >= size_b ? 'a' : 'b';
}

/// Contract: a choice but no_split.
template <class Box>
std::array<BoxCell<Box>, 2> parts_of_cell(const BoxCell<Box>& cell, char by, const BoxTrees& of) {
    std::array<BoxCell<Box>, 2> out{cell, cell};
    const Piece &a = of.a.pieces[cell.a], &b = of.b.pieces[cell.b];
    if (by == 'a') {
        out[0].a = a.left;
        out[1].a = a.right;
    } else if (by == 'b') {
        out[0].b = b.left;
        out[1].b = b.right;
    } else {
        const auto k = static_cast<std::size_t>(certificate::variable_of_split(by));
        out[0].box.high[k] = out[1].box.low[k] = 0.5 * (cell.box.low[k] + cell.box.high[k]);
    }
    return out;
}

/// Takes two elements for an upper bound, if they are nearer than what was found, or meet.
template <class Encounter>
void take_upper(BoxSearchResult<Encounter>& result, const Encounter& encounter, double slack) {
    const double sum = encounter.pair.distance + slack, upper = std::isnan(sum) ? infinity : sum;
    const bool clash = encounter.pair.intersecting && encounter.pair.depth > 8 * slack;
    const bool better = clash != result.intersecting ? clash : upper < result.upper;  // touching is not yet a clash
    if (result.nearest.element_a >= 0 && !better) return;
    result.upper = upper;
    result.nearest = encounter;
    result.intersecting = clash;
}

template <class Cells>
class BoxSearch {
public:
    using Cell = BoxCell<typename Cells::Box>;
    using Result = BoxSearchResult<typename Cells::Encounter>;

    BoxSearch(Cells cells, const BoxSearchOptions& options) : cells_(std::move(cells)), options_(options) {}

    Result run() {
        cells_.descend();
        Cell root{cells_.root_box()};
        cells_.evaluate(root, infinity, options_.tolerance);
        push(root);
        while (!is_settled()) {
            if (cells_.result.bounds >= options_.max_bounds ||
                (options_.should_stop && cells_.result.bounds % 256 < 2 && options_.should_stop())) {
                cells_.result.complete = false;
                break;
            }
            expand(pool_.take(static_cast<int>(queue_.pop().entry)));
        }
        cells_.result.lower = std::max(0.0, lower_bound());
        if (cells_.result.intersecting) cells_.result.lower = 0;
        return std::move(cells_.result);
    }

private:
    void push(const Cell& cell) {
        if (cell.lower >= cells_.result.upper) return;
        queue_.push({cell.lower, made_++, static_cast<std::uint32_t>(pool_.add(cell))});
    }

    double lower_bound() const { return std::min({aside_, queue_.least(), cells_.result.upper - 2 * cells_.trees().slack}); }

    bool is_settled() const {
        const double lower = lower_bound(), upper = cells_.result.upper, slack = cells_.trees().slack;
        if (cells_.result.intersecting || queue_.empty() || queue_.least() >= aside_ || lower >= options_.enough) return true;
        const StopRule& stop = options_.stop;
        const long bounds = cells_.result.bounds;
        if (!(upper - lower <= stop.gap(options_.tolerance, upper, bounds))) return stop.ends(lower, upper, bounds);
        if (upper - lower <= 4 * slack) return true;
        const double finest = 1e-3 * options_.tolerance;  // where the minimum lies between, or 0 does
        if (!(lower > 0) && upper > 64 * slack) return upper - lower <= std::min(finest, 1e-2 * upper);
        return !(stop.minimum > lower && stop.minimum <= upper) || upper - lower <= finest;
    }

    void expand(const Cell& cell) {
        const char by = choice_of_split(cell, cells_.trees());
        if (by == no_split) {
            aside_ = std::min(aside_, cell.lower);
            return;
        }
        std::array<Cell, 2> parts = parts_of_cell(cell, by, cells_.trees());
        cells_.evaluate_parts(cell, by, parts, options_.tolerance);
        for (const Cell& part : parts) push(part);
    }

    Cells cells_;
    const BoxSearchOptions& options_;
    EntryPool<Cell> pool_;
    BestFirst queue_;
    double aside_ = infinity;  // least bound of what cannot be split
    std::uint32_t made_ = 0;
};

/// The tree of cells that proves `distance` > 0 (certificate.hpp), by the same bounds. Contract: at most what a search has proven.
/// Empty where a stop or the budget ended it.
template <class Cells>
certificate::BoxProof prove_box(Cells cells, double distance, const BoxSearchOptions& options) {
    using Cell = BoxCell<typename Cells::Box>;
    certificate::BoxProof proof;
    std::vector<Cell> pending{{cells.root_box()}};
    while (!pending.empty()) {
        Cell cell = pending.back();
        pending.pop_back();
        const CellProof found = cells.evaluate(cell, distance, options.tolerance);
        if (cells.proves(found, distance)) {
            proof.splits += found.is_round              ? certificate::round_leaf
                            : found.normals.size() == 1 ? certificate::still_leaf
                                                        : certificate::turning_leaf;
            proof.normals.insert(proof.normals.end(), found.normals.begin(), found.normals.end());
            continue;
        }
        const char by = choice_of_split(cell, cells.trees());
        const bool stopped = options.should_stop && cells.result.bounds % 256 == 0 && options.should_stop();
        if (by == no_split || cells.result.bounds > 2 * options.max_bounds || stopped) return {};
        proof.splits += by;
        const std::array<Cell, 2> parts = parts_of_cell(cell, by, cells.trees());
        pending.push_back(parts[1]);
        pending.push_back(parts[0]);
    }
    return proof;
}

}  // namespace fettle::core::clearance
