// SPDX-License-Identifier: MIT
#include "core/constraint/whole_turns.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fettle::core::constraint {
namespace {

bool is_angle(const measure::MeasureSet& set, int measure) { return set.measures[measure].kind == measure::MeasureKind::angle; }

// Angles that gears join, the first of them with rate 1.
struct Geared {
    std::vector<int> measures;
    std::vector<double> rates;
    bool is_said = false;  // by a row of one angle alone
};

Geared geared_to(int first, const measure::MeasureSet& set, const std::vector<Row>& rows) {
    Geared out{{first}, {1}, false};
    for (std::size_t next = 0; next < out.measures.size(); ++next)
        for (const Row& row : rows) {
            std::vector<RowPart> angles;
            for (const RowPart& part : row.parts)
                if (is_angle(set, part.measure)) angles.push_back(part);
            const int at = out.measures[next];
            const auto of = std::find_if(angles.begin(), angles.end(), [&](const RowPart& part) { return part.measure == at; });
            if (of == angles.end()) continue;
            out.is_said = out.is_said || angles.size() == 1;
            for (const RowPart& part : angles) {
                if (std::count(out.measures.begin(), out.measures.end(), part.measure) > 0) continue;
                out.measures.push_back(part.measure);
                out.rates.push_back(-out.rates[next] * of->factor / part.factor);
            }
        }
    return out;
}

}  // namespace

std::optional<int> turns_to_return(const std::vector<double>& rates) {
    constexpr int most_turns = 1000;
    for (int n = 1; n <= most_turns; ++n) {
        const bool all = std::all_of(rates.begin(), rates.end(), [&](double rate) {
            return std::abs(n * rate - std::round(n * rate)) <= 1e-12 * n * std::max(1.0, std::abs(rate));
        });
        if (all) return n;
    }
    return std::nullopt;
}

std::vector<double> nearest_turns(const measure::MeasureSet& set, const std::vector<Row>& rows, const std::vector<double>& wanted,
                                  std::vector<double> angles) {
    std::vector<bool> is_done(angles.size(), false);
    for (int first = 0; first < count_of(angles); ++first) {
        if (is_done[first] || !is_angle(set, first)) continue;
        const Geared geared = geared_to(first, set, rows);
        for (const int measure : geared.measures) is_done[measure] = true;
        const std::optional<int> turns = geared.is_said ? std::nullopt : turns_to_return(geared.rates);
        if (!turns) continue;
        const double period = 2 * std::numbers::pi * *turns, shift = period * std::round((wanted[first] - angles[first]) / period);
        for (std::size_t k = 0; k < geared.measures.size(); ++k) angles[geared.measures[k]] += shift * geared.rates[k];
    }
    return angles;
}

}  // namespace fettle::core::constraint
