// SPDX-License-Identifier: MIT
#include "fettle/core/clearance/pair_search.hpp"

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
        if (!front_.options.nodes_only && front_.result.upper <= front_.options.enough) segments_.refine_nearest();
        if (front_.options.proof != nullptr) segments_.recorder().write(*front_.options.proof);
        return front_.result;
    }

    std::vector<Encounter> collect(std::size_t most) {
        search(most);
        return segments_.found();
    }

private:
    void search(std::size_t most) {
        if (spans_) {
            spans_->try_root();
        } else {
            segments_.try_roots();
        }
        SearchResult& result = front_.result;
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
