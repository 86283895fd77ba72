// SPDX-License-Identifier: MIT
/// The state that the parts of a search for a clearance share (pair_search.hpp): the queue of what is undecided, the bounds so far, and the
/// upper bounds with their witnesses.
///
/// The most promising entry comes first, and then for a while the most promising of those made last, which are mostly parts of it: an entry
/// below the cutoff has to be looked at anyway, sooner or later, and one that has just been made is still at hand. Where a bound of
/// `enough` is to be proven and nothing nearer has been seen, always one of those made last.
/// A search over a box of variables (box_search.hpp) shares the heap and the pool, and no more: its cells are one kind, its upper bound is
/// nearly the least from the start, and it has its own rules for ending, setting aside and witnesses.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "core/base/limits.hpp"
#include "core/clearance/search_result.hpp"

namespace fettle::core::clearance {

/// What is no number proves nothing: a bound that every comparison takes for the worst.
inline double proven(double lower) { return std::isnan(lower) ? -std::numeric_limits<double>::infinity() : lower; }

enum class EntryKind { segment, spans };  ///< what SegmentSearch and SpanSearch have made

/// Entries that come and go, at places that stay.
template <class Entry>
class EntryPool {
public:
    int add(const Entry& entry) {
        if (free_.empty()) {
            entries_.push_back(entry);
            return count_of(entries_) - 1;
        }
        const int index = free_.back();
        free_.pop_back();
        entries_[index] = entry;
        return index;
    }
    Entry take(int index) {
        free_.push_back(index);
        return entries_[index];
    }

private:
    std::vector<Entry> entries_;
    std::vector<int> free_;
};

/// Entries that wait, the least bound first.
class BestFirst {
public:
    /// What the heap moves about: the entries themselves stay where they are.
    struct Key {
        double lower = 0;
        std::uint32_t order = 0;  ///< of making: breaks ties the same way on every run
        std::uint32_t entry : 31 = 0;
        std::uint32_t is_spans : 1 = 0;
    };
    struct Later {
        bool operator()(const Key& x, const Key& y) const { return x.lower != y.lower ? x.lower > y.lower : x.order > y.order; }
    };

    bool empty() const { return keys_.empty(); }
    double least() const { return keys_.empty() ? infinity : keys_.front().lower; }
    void push(const Key& key) {
        keys_.push_back(key);
        std::push_heap(keys_.begin(), keys_.end(), Later{});
    }
    /// Contract: not empty.
    Key pop() {
        std::pop_heap(keys_.begin(), keys_.end(), Later{});
        const Key key = keys_.back();
        keys_.pop_back();
        return key;
    }

private:
    std::vector<Key> keys_;
};

class SearchFront {
public:
    using Key = BestFirst::Key;

    /// `within` >= 0: everything as near as that is wanted, instead of the least distance.
    SearchFront(const PieceTree& tree_a, const PieceTree& tree_b, const std::vector<PairSegment>& all_segments,
                const SearchOptions& search_options, double within)
        : a(tree_a),
          b(tree_b),
          segments(all_segments),
          options(search_options),
          within_(within),
          strict_(within >= 0 || options.seek_intersection),
          in_order_(strict_ || options.sample_nodes || !(options.enough < infinity)) {
        result.upper = infinity;
        result.sampled.pair.distance = infinity;
    }

    const PieceTree &a, &b;
    const std::vector<PairSegment>& segments;
    const SearchOptions& options;
    SearchResult result;

    bool is_collecting() const { return within_ >= 0; }
    bool is_within(double distance) const { return distance <= within_; }

    /// Entries whose bound is no less need no splitting. (What was set aside at the limit of rounding cannot be raised any more.)
    double cutoff() const {
        if (is_collecting()) return std::nextafter(within_, infinity);
        if (options.seek_intersection) return std::numeric_limits<double>::min();
        return std::min({result.upper - gap(), options.enough, aside_});
    }
    /// The same of bounds that hold at the ends of segments, for the least distance there.
    double sampling_cutoff() const { return options.sample_nodes ? result.sampled.pair.distance - 0.01 * gap() : -infinity; }

    /// How well the distance of the bodies' hulls is to be known at an instant.
    double hull_tolerance() const { return 1e-3 * options.tolerance; }
    /// Bounds of whole bodies were of use: the elements of `nearest` may be others than the nearest ones at its instant, by the tolerance.
    bool are_beside = false;

    /// A bound of what is not split any further.
    void set_aside(double lower) { aside_ = std::min(aside_, proven(lower)); }

    void push(double lower, EntryKind kind, int entry) {
        if (std::isnan(lower)) return set_aside(lower);  // nor would its parts be one
        last_made_.push_back({lower, made_++, static_cast<std::uint32_t>(entry), kind == EntryKind::spans});
        if (strict_) put_in_order();
    }
    Key pop() {
        // The most promising of those made since the last one was given back comes first.
        std::sort(last_made_.begin() + static_cast<std::ptrdiff_t>(sorted_), last_made_.end(), BestFirst::Later{});
        const Key key = next();
        sorted_ = last_made_.size();
        return key;
    }

    bool is_settled() const {
        if ((queue_.empty() && last_made_.empty()) || result.upper < options.refuted) return true;
        if (!in_order_ || !last_made_.empty()) return false;
        const double next = queue_.least();
        if (is_collecting()) return next > within_;
        if (options.seek_intersection) return result.intersecting || next > 0;
        return std::max(next, 0.0) >= std::max(cutoff(), sampling_cutoff()) ||
               options.stop.ends(std::min(next, aside_), result.upper, result.evaluations);
    }

    /// The bound of everything searched, however far the search has come.
    double lower_bound() {
        put_in_order();
        return std::max(0.0, std::min({aside_, queue_.least(), result.upper}));
    }

    void take_upper(const Encounter& encounter) {
        const double slack = segments[encounter.segment].slack, sum = encounter.pair.distance + slack;
        const double upper = std::isnan(sum) ? infinity : sum;
        const bool clash = encounter.pair.intersecting && encounter.pair.depth > 8 * slack;
        if ((encounter.s == 0 || encounter.s == 1) && encounter.pair.distance < result.sampled.pair.distance) result.sampled = encounter;
        const bool better = options.seek_intersection ? clash && !result.intersecting : upper < result.upper;
        if (result.nearest.segment >= 0 && !better) return;
        result.upper = upper;
        result.nearest = encounter;
        result.intersecting = clash;
        if (result.upper - options.tolerance < options.enough) in_order_ = true;
    }

private:
    double gap() const { return options.stop.gap(options.tolerance, result.upper, result.evaluations); }

    Key next() {
        if (last_made_.empty() || (in_order_ && ++taken_ > longest_dive)) {
            put_in_order();
            taken_ = 0;
            return queue_.pop();
        }
        const Key key = last_made_.back();
        last_made_.pop_back();
        return key;
    }

    void put_in_order() {
        for (const Key& key : last_made_) queue_.push(key);
        last_made_.clear();
        sorted_ = 0;
    }

    static constexpr int longest_dive = 64;

    double within_ = -1;
    bool strict_;    // the most promising one always
    bool in_order_;  // else one of the last made always
    BestFirst queue_;
    std::vector<Key> last_made_;  // and not in the queue yet
    std::size_t sorted_ = 0;      // of these
    int taken_ = 0;               // of these since the last one from the queue
    double aside_ = infinity;     // least bound of the entries that are not in the queue any more and were not split
    std::uint32_t made_ = 0;
};

}  // namespace fettle::core::clearance
