// SPDX-License-Identifier: MIT
#include "fettle/core/clearance/pair_search.hpp"

#include <algorithm>
#include <optional>

#include "fettle/core/base/contract.hpp"
#include "fettle/core/clearance/segment_search.hpp"
#include "fettle/core/clearance/span_search.hpp"

namespace fettle::core::clearance {
namespace {

class PairSearch {
public:
    PairSearch(const PieceTree& a, const PieceTree& b, const std::vector<PairSegment>& segments, const SearchOptions& options,
               double within = -1)
        : front_(a, b, segments, options, within), segments_(front_) {
        if (options.proof == nullptr && !options.nodes_only && segments.size() > 1) spans_.emplace(front_, segments_);
    }

    SearchResult run() {
        if (front_.options.seed) {
            front_.take_upper(*front_.options.seed);
        } else {
            segments_.take_distance_of_any_pair();
        }
        search(0);
        front_.result.lower = front_.lower_bound();
        if (!front_.options.nodes_only && front_.result.upper <= front_.options.enough) refine_nearest();
        if (front_.options.proof != nullptr) segments_.recorder().write(*front_.options.proof);
        return front_.result;
    }

    std::vector<Encounter> collect(std::size_t most) {
        search(most);
        return segments_.found();
    }

private:
    // Whole bodies' bounds leave open which elements are nearest: the nearest ones at an instant, then the instant where these are.
    void refine_nearest() {
        const SearchOptions& options = front_.options;
        if (!front_.are_beside || !front_.result.complete || !options.exact_witness || options.seek_intersection)
            return segments_.refine_nearest();
        constexpr int most_rounds = 4;
        for (int round = 0; round < most_rounds; ++round) {
            take_nearest_at_instant();
            const double s = front_.result.nearest.s;
            segments_.refine_nearest();
            if (front_.result.nearest.s == s) return;
        }
        take_nearest_at_instant();
    }

    void take_nearest_at_instant() {
        constexpr long most_evaluations = 2000;  // of faces that slide along each other many are as near
        const Encounter known = front_.result.nearest;
        const PairSegment& segment = front_.segments[static_cast<std::size_t>(known.segment)];
        const std::vector<PairSegment> held{held_at(segment, known.s, front_.a.radius(), front_.b.radius())};
        SearchOptions options;
        options.tolerance = 3 * held.front().slack;  // what bounds are told less by, and distances more
        options.max_evaluations = std::min(most_evaluations, front_.options.max_evaluations - front_.result.evaluations);
        options.should_stop = front_.options.should_stop;
        PairSearch at_instant(front_.a, front_.b, held, options);
        Encounter nearest = known;
        nearest.segment = 0;
        at_instant.front_.take_upper(nearest);
        at_instant.search(0);
        nearest = at_instant.front_.result.nearest;
        front_.result.evaluations += at_instant.front_.result.evaluations;
        nearest.segment = known.segment;
        nearest.s = known.s;
        front_.take_upper(nearest);
    }

    void search(std::size_t most) {
        SearchResult& result = front_.result;
        if (!spans_) {
            segments_.try_roots();
        } else if (front_.options.should_stop && front_.options.should_stop()) {  // the root may well be all there is to do
            result.complete = false;
            front_.set_aside(0);
            return;
        } else {
            spans_->try_root();
        }
        while (!front_.is_settled() && (most == 0 || segments_.found().size() < most)) {
            result.complete = result.evaluations < front_.options.max_evaluations && !is_stopped();
            if (!result.complete) break;
            const SearchFront::Key key = front_.pop();
            if (key.is_spans != 0) {
                spans_->split(static_cast<int>(key.entry));
            } else {
                segments_.split(static_cast<int>(key.entry), key.lower);
            }
        }
    }

    bool is_stopped() { return front_.options.should_stop && (++rounds_ & 255) == 1 && front_.options.should_stop(); }

    SearchFront front_;
    SegmentSearch segments_;
    std::optional<SpanSearch> spans_;
    std::int64_t rounds_ = 0;
};

}  // namespace

SearchResult search_pair(const PieceTree& a, const PieceTree& b, const std::vector<PairSegment>& segments, const SearchOptions& options) {
    FETTLE_ASSERT(!segments.empty(), "a search over no time");
    return PairSearch(a, b, segments, options).run();
}

std::vector<Encounter> encounters_within(const PieceTree& a, const PieceTree& b, const std::vector<PairSegment>& segments, double distance,
                                         std::size_t most, const SearchOptions& options) {
    FETTLE_ASSERT(!segments.empty() && distance >= 0, "a search over no time or for no distance");
    return PairSearch(a, b, segments, options, distance).collect(most);
}

}  // namespace fettle::core::clearance
