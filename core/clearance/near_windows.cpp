// SPDX-License-Identifier: MIT
#include "core/clearance/near_windows.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <tuple>
#include <utility>

#include "core/base/contract.hpp"
#include "core/base/limits.hpp"
#include "core/base/parallel.hpp"
#include "core/clearance/swept_boxes.hpp"

namespace fettle::core::clearance {
namespace {

constexpr int most_boxes = 1 << 18;
constexpr int most_time_spans = 4096;

// Spans of time: segments [first(k), first(k + 1)).
struct TimeSpans {
    int segments = 1, count = 1;
    int first(int k) const { return static_cast<int>(static_cast<long>(k) * segments / count); }
};

class NearSearch {
public:
    NearSearch(const model::Model& model, const stepper::Trajectory& trajectory, const std::vector<PathPlace>& places, double reach,
               const PairFilter& wanted)
        : trajectory_(trajectory), places_(places), reach_(reach), wanted_(wanted), bodies_(count_of(model.bodies)) {
        spans_.segments = count_of(places);
        spans_.count = std::clamp(most_boxes / std::max(bodies_, 1), 1, std::min(spans_.segments, most_time_spans));
        boxes_.resize(bodies_);
        usable_ = have_usable_numbers(model, trajectory, places);
        parallel_for(bodies_, 1, [&](int i) { boxes_[i] = box_of(model.bodies[i].mesh); });
        const double telling = telling_spans();
        if (telling < spans_.count) spans_.count = std::max(1, static_cast<int>(std::ceil(telling)));
    }

    NearWindows run() {
        std::vector<geometry::BoxSweep::Pairs> near(spans_.count);
        parallel_for(spans_.count, 1, [&](int k) { near[k] = near_in(k); });
        std::vector<NearSpan> rows;
        for (int k = 0; k < spans_.count; ++k) {
            for (const auto& [a, b] : near[k]) rows.push_back({a, b, k});
        }
        rows = sorted_by_body(sorted_by_body(rows, &NearSpan::b), &NearSpan::a);
        NearWindows result;
        for (const NearSpan& row : rows) take(result.windows, row.a, row.b, row.span);
        add_unmeasurable(result.windows);
        result.everything = covers_everything(result.windows);
        return result;
    }

private:
    // So many spans that each body goes a small share of its size in each, about: more would tell no better what comes near.
    double telling_spans() const {
        constexpr double share = 0.1;
        std::vector<double> way(bodies_, 0);
        parallel_for((bodies_ + bodies_at_once - 1) / bodies_at_once, 1, [&](int block) {
            const int first = block * bodies_at_once, last = std::min(bodies_, first + bodies_at_once);
            measure_ways({trajectory_, places_, first, last}, boxes_, way.data() + first);
        });
        double most = 0;
        for (std::size_t body = 0; body < way.size(); ++body)
            if (way[body] > 0) most = std::max(most, way[body] / (share * boxes_[body].size));
        return most;
    }

    struct NearSpan {
        int a, b, span;
    };

    // Those of the same body stay in their order.
    std::vector<NearSpan> sorted_by_body(const std::vector<NearSpan>& rows, int NearSpan::*body) const {
        std::vector<std::size_t> next(static_cast<std::size_t>(bodies_) + 1, 0);
        for (const NearSpan& row : rows) ++next[static_cast<std::size_t>(row.*body) + 1];
        std::partial_sum(next.begin(), next.end(), next.begin());
        std::vector<NearSpan> sorted(rows.size());
        for (const NearSpan& row : rows) sorted[next[row.*body]++] = row;
        return sorted;
    }

    geometry::BoxSweep::Pairs near_in(int span) const {
        const int first = spans_.first(span), last = spans_.first(span + 1);
        std::vector<geometry::Box> boxes(bodies_);
        sweep({trajectory_, std::span(places_).subspan(first, static_cast<std::size_t>(last - first)), 0, bodies_}, boxes_, boxes.data());
        std::vector<int> usable;
        usable.reserve(boxes.size());
        for (int i = 0; i < bodies_; ++i)
            if (usable_[i] != 0) usable.push_back(i);
        const auto count = count_of(usable);
        geometry::BoxSweep::Pairs pairs;
        geometry::BoxSweep(boxes, std::move(usable)).find(0, count, reach_, pairs);
        pairs.erase(std::remove_if(pairs.begin(), pairs.end(), [&](const auto& pair) { return !wanted_(pair.first, pair.second); }),
                    pairs.end());
        return pairs;
    }

    void take(std::vector<NearWindow>& windows, int a, int b, int span) const {
        const int first = spans_.first(span), last = spans_.first(span + 1);
        if (!windows.empty() && windows.back().a == a && windows.back().b == b && windows.back().last == first) {
            windows.back().last = last;
        } else {
            windows.push_back({a, b, first, last});
        }
    }

    void add_unmeasurable(std::vector<NearWindow>& windows) const {
        const std::size_t measurable = windows.size();
        for (int i = 0; i < bodies_; ++i) {
            if (usable_[i] != 0) continue;
            for (int j = 0; j < bodies_; ++j) {
                const bool told = usable_[j] == 0 && j < i;
                const int a = std::min(i, j), b = std::max(i, j);
                if (!told && i != j && wanted_(a, b)) windows.push_back({a, b, 0, spans_.segments, false});
            }
        }
        if (windows.size() == measurable) return;
        std::sort(windows.begin(), windows.end(),
                  [](const NearWindow& x, const NearWindow& y) { return std::tie(x.a, x.b, x.first) < std::tie(y.a, y.b, y.first); });
    }

    bool covers_everything(const std::vector<NearWindow>& windows) const {
        const auto whole = [&](const NearWindow& w) { return w.first == 0 && w.last == spans_.segments; };
        if (!std::all_of(windows.begin(), windows.end(), whole)) return false;
        std::size_t pairs = 0;
        for (int a = 0; a < bodies_ && pairs <= windows.size(); ++a) {
            for (int b = a + 1; b < bodies_; ++b) pairs += wanted_(a, b) ? 1 : 0;
        }
        return pairs == windows.size();
    }

    const stepper::Trajectory& trajectory_;
    const std::vector<PathPlace>& places_;
    double reach_;
    const PairFilter& wanted_;
    int bodies_;
    TimeSpans spans_;
    std::vector<BodyBox> boxes_;
    std::vector<char> usable_;
};

}  // namespace

NearWindows near_windows(const model::Model& model, const stepper::Trajectory& trajectory, const std::vector<PathPlace>& places,
                         double reach, const PairFilter& wanted) {
    FETTLE_ASSERT(reach >= 0 && !places.empty(), "a reach of at least 0, over some time");
    return NearSearch(model, trajectory, places, reach, wanted).run();
}

NearWindows near_windows(const model::Model& model, const stepper::Trajectory& trajectory, const std::vector<PathPlace>& places,
                         double reach) {
    return near_windows(model, trajectory, places, reach, [&](int a, int b) { return model::may_collide(model, a, b); });
}

PairMotion window_motion(const std::vector<BodyShape>& shapes, const stepper::Trajectory& trajectory, const std::vector<PathPlace>& places,
                         const NearWindow& window) {
    const BodyShape &a = shapes[window.a], &b = shapes[window.b];
    PairMotion pair{*a.tree, *b.tree, trajectory, {}, *a.solid, *b.solid};
    pair.segments.reserve(window.last - window.first);
    for (int i = window.first; i < window.last; ++i) {
        const PathPlace& place = places[i];
        pair.segments.push_back(pair_segment(segment_at(trajectory, place, window.a), segment_at(trajectory, place, window.b),
                                             pair.a.radius(), pair.b.radius()));
        pair.segments.back().step = place.step;
        pair.segments.back().segment = place.segment;
    }
    return pair;
}

}  // namespace fettle::core::clearance
