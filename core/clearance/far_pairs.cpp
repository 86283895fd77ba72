// SPDX-License-Identifier: MIT
#include "core/clearance/far_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "core/base/contract.hpp"
#include "core/base/limits.hpp"
#include "core/base/parallel.hpp"
#include "core/clearance/near_windows.hpp"
#include "core/clearance/pair_certification.hpp"

namespace fettle::core::clearance {
namespace {

bool is_asked_for(const PairRequest& request) { return request.far < infinity; }

std::pair<int, int> ordered(const PairRequest& request) { return std::minmax(request.a, request.b); }

class FarSearch {
public:
    FarSearch(const model::Model& model, const stepper::Trajectory& trajectory, const std::vector<PathPlace>& places,
              const std::vector<PairRequest>& pairs, const std::vector<BodyShape>& shapes, const ClearanceOptions& options)
        : trajectory_(trajectory), places_(places), shapes_(shapes), options_(options) {
        std::vector<std::pair<int, int>> wanted;
        for (const PairRequest& request : pairs) {
            if (!is_asked_for(request)) continue;
            FETTLE_ASSERT(request.far > 0 && request.far >= request.minimum, "far is not less than what is required");
            wanted.push_back(ordered(request));
            reach_ = std::max(reach_, request.far);
        }
        if (wanted.empty()) return;
        std::sort(wanted.begin(), wanted.end());
        const auto is_wanted = [&](int a, int b) { return std::binary_search(wanted.begin(), wanted.end(), std::pair(a, b)); };
        windows_ = near_windows(model, trajectory, places, reach_, is_wanted).windows;
    }

    std::optional<PairClearance> answer(const PairRequest& request) const {
        if (!is_asked_for(request)) return std::nullopt;
        const auto before = [](const NearWindow& window, const std::pair<int, int>& pair) { return std::pair(window.a, window.b) < pair; };
        const auto first = std::lower_bound(windows_.begin(), windows_.end(), ordered(request), before);
        const auto is_of_pair = [&](auto window) {
            return window != windows_.end() && std::pair(window->a, window->b) == ordered(request);
        };
        if (!is_of_pair(first)) return far_pair(request, reach_, solids_of_boxes(request));
        double lower = reach_;
        for (auto window = first; is_of_pair(window); ++window) {
            if (!window->measurable) return std::nullopt;
            const PairMotion motion = window_motion(shapes_, trajectory_, places_, *window);
            const std::optional<double> proven = proven_apart(motion, request.far, options_);
            if (!proven) return std::nullopt;
            lower = std::min(lower, *proven);
        }
        const Solids solids = solids_at_start(request, lower);
        if (!certificate::are_apart(solids)) return std::nullopt;
        return far_pair(request, lower, solids);
    }

private:
    // Neither of two bodies that boxes keep apart is inside the other.
    Solids solids_of_boxes(const PairRequest& request) const {
        const auto is_closed = [&](int body) { return shapes_[body].solid->is_closed; };
        return is_closed(request.a) && is_closed(request.b) ? Solids::disjoint : Solids::not_closed;
    }

    Solids solids_at_start(const PairRequest& request, double lower) const {
        const PathPlace& first = places_.front();
        const auto &a = *shapes_[request.a].solid, &b = *shapes_[request.b].solid;
        certificate::PairStart start{trajectory_, first.step, first.segment, request.a, request.b};
        if (ask_for_path(a, b)) start.path = places_;
        start.charge = request.charge;
        return certificate::solids_of(a, b, start, lower);
    }

    const stepper::Trajectory& trajectory_;
    const std::vector<PathPlace>& places_;
    const std::vector<BodyShape>& shapes_;
    const ClearanceOptions& options_;
    double reach_ = 0;  // the farthest that is asked for
    std::vector<NearWindow> windows_;
};

}  // namespace

std::vector<std::optional<PairClearance>> far_pairs(const model::Model& model, const stepper::Trajectory& trajectory,
                                                    const std::vector<PathPlace>& places, const std::vector<PairRequest>& pairs,
                                                    const std::vector<BodyShape>& shapes, const ClearanceOptions& options) {
    std::vector<std::optional<PairClearance>> answers(pairs.size());
    const FarSearch search(model, trajectory, places, pairs, shapes, options);
    parallel_for(count_of(pairs), 64, [&](int i) { answers[i] = search.answer(pairs[i]); });
    return answers;
}

PairClearance far_pair(const PairRequest& request, double lower, Solids solids) {
    PairClearance result;
    result.a = request.a;
    result.b = request.b;
    result.minimum = required_gap(request);
    result.is_far = true;
    result.lower = lower;
    result.upper = result.sampled = infinity;
    result.status = PairStatus::clear;
    result.solids = solids;
    return result;
}

}  // namespace fettle::core::clearance
