// SPDX-License-Identifier: MIT
#include "core/certificate/loop_slices.hpp"

#include <algorithm>
#include <cmath>

namespace fettle::core::certificate {
namespace {

constexpr double finest_slice = 1e-6;  // of what drives a loop

// The enclosure where variable k is at t.
LoopEnclosure fixed_at(LoopEnclosure found, std::size_t k, double t) {
    for (TaylorModel& x : found.linear) {
        x.center += t * x.slopes[k];
        x.slopes[k] = 0;
    }
    return found;
}

std::vector<double> middles_of(const LoopEnclosure& found) {
    std::vector<double> out;
    for (const TaylorModel& x : found.linear) out.push_back(x.center);
    return out;
}

}  // namespace

LoopSlices::LoopSlices(const PairFormulas& formulas, const ModelledPair& whole, const VariableBox& box, const VariableBox& base)
    : formulas_(formulas), whole_(whole), box_(box), slices_(formulas.loops().size()) {
    for (std::size_t loop = 0; loop < slices_.size(); ++loop)
        if (!slice(loop, base)) return;
}

std::optional<LoopEnclosure> LoopSlices::over(std::size_t loop, double low, double high, const std::vector<double>& guess) const {
    VariableBox box = box_;
    const auto driver = static_cast<std::size_t>(formulas_.loops()[loop].driver);
    box.low[driver] = low;
    box.high[driver] = high;
    return enclosed_loop(whole_.loops[loop], formulas_.positions_over(box), guess);
}

bool LoopSlices::slice(std::size_t loop, const VariableBox& base) {
    const PairFormulas::Loop& from = formulas_.loops()[loop];
    if (from.driver < 0 || from.driver >= formulas_.coordinates()) {
        fault_ = "a loop is driven by another loop, which is not dealt with";
        return false;
    }
    const auto driver = static_cast<std::size_t>(from.driver);
    const double low = box_.low[driver], high = box_.high[driver], start = from.driver_start;
    std::vector<Slice>& slices = slices_[loop];
    for (double half = (high - low) / 128; slices.empty() && half >= finest_slice * (high - low); half /= 2) {
        const double first = std::max(low, start - half), last = std::min(high, start + half);
        const auto found = over(loop, first, last, from.starts);
        if (!found) {
            if (!(half > 0)) break;
            continue;
        }
        // Where the loop is at the base is the solution that is meant.
        std::array<double, most_variables> t{};
        for (std::size_t k = 0; k < t.size(); ++k) {
            const double at_low = k == driver ? first : box_.low[k], at_high = k == driver ? last : box_.high[k];
            const TaylorModel variable = TaylorModel::variable(static_cast<int>(k), at_low, at_high);
            t[k] = variable.slopes[k] > 0 ? (base.low[k] - variable.center) / variable.slopes[k] : 0;
        }
        bool is_there = true;
        for (std::size_t i = 0; i < from.starts.size(); ++i)
            is_there = is_there && std::abs(linear_value(found->linear[i], t) - from.starts[i]) + 1e-9 < found->only[i];
        if (is_there) slices.push_back({first, last, *found});
        if (!(half > 0)) break;
    }
    if (!slices.empty() && extend(loop, true) && extend(loop, false)) return true;
    fault_ =
        "where the joints of its loop are cannot be enclosed for all of their range and all tolerances: does it come near a dead "
        "centre, or do the lengths not close it everywhere?";
    return false;
}

bool LoopSlices::extend(std::size_t loop, bool upwards) {
    std::vector<Slice>& slices = slices_[loop];
    const auto driver = static_cast<std::size_t>(formulas_.loops()[loop].driver);
    const double low = box_.low[driver], high = box_.high[driver];
    double width = slices.back().high - slices.back().low;
    while (upwards ? slices.back().high < high : slices.front().low > low) {
        const Slice& before = upwards ? slices.back() : slices.front();
        if (!(width > finest_slice * (high - low))) return false;
        const double from = upwards ? before.high : std::max(low, before.low - width),
                     to = upwards ? std::min(high, before.high + width) : before.low;
        const double half = 0.5 * (before.high - before.low), middle = 0.5 * (before.high + before.low);
        const LoopEnclosure ahead = fixed_at(before.found, driver, half > 0 ? (0.5 * (from + to) - middle) / half : 0);
        const auto found = over(loop, from, to, middles_of(ahead));
        const double side = upwards ? 1 : -1;
        if (!found || !is_same_branch(fixed_at(before.found, driver, side), fixed_at(*found, driver, -side))) {
            width /= 2;
            continue;
        }
        width *= 1.5;
        slices.insert(upwards ? slices.end() : slices.begin(), Slice{from, to, *found});
    }
    return true;
}

bool LoopSlices::enclose(const VariableBox& part, const ModelledPair& models, std::vector<TaylorModel>& positions) const {
    for (std::size_t loop = 0; loop < formulas_.loops().size(); ++loop) {
        const auto driver = static_cast<std::size_t>(formulas_.loops()[loop].driver);
        const double at = 0.5 * (part.low[driver] + part.high[driver]);
        const auto slice =
            std::find_if(slices_[loop].begin(), slices_[loop].end(), [&](const Slice& each) { return each.low <= at && at <= each.high; });
        if (slice == slices_[loop].end()) return false;
        // The slice's solution over the box's deviations, in the middle of what drives the loop.
        LoopEnclosure known = slice->found;
        for (std::size_t k = 0; k < most_variables; ++k) {
            const double low = k == driver ? slice->low : box_.low[k], high = k == driver ? slice->high : box_.high[k];
            const TaylorModel outer = TaylorModel::variable(static_cast<int>(k), low, high),
                              inner = TaylorModel::variable(static_cast<int>(k), part.low[k], part.high[k]);
            if (!(outer.slopes[k] > 0)) continue;
            const double middle = k == driver ? at : inner.center;
            for (TaylorModel& x : known.linear) {
                x.center += x.slopes[k] * ((middle - outer.center) / outer.slopes[k]);
                x.slopes[k] *= k == driver ? 0 : inner.slopes[k] / outer.slopes[k];
            }
        }
        const auto found = enclosed_loop(models.loops[loop], positions, middles_of(known));
        if (!found || !is_same_branch(known, fixed_at(*found, driver, 0))) return false;
        const std::vector<TaylorModel> solved = found->positions();
        for (std::size_t i = 0; i < solved.size(); ++i)
            positions[static_cast<std::size_t>(formulas_.loops()[loop].unknowns[i])] = solved[i];
    }
    return true;
}

}  // namespace fettle::core::certificate
