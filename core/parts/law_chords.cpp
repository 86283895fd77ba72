// SPDX-License-Identifier: MIT
#include "core/parts/law_chords.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

namespace fettle::core::parts {
namespace {

using geometry::Range;
using geometry::upper;

constexpr double no_bound = std::numeric_limits<double>::infinity();
constexpr std::size_t most_cells = 600;  // until a law is known wherever it is smooth
constexpr int most_cuts = 64;            // for a bound that is near to the truth
constexpr double near_enough = 1.15;     // a bound against what samples find
constexpr double shortest = 0x1p-20;     // of a step: a switch is known no better

using RangePoint = std::array<Jet<Range>, 2>;

// A stretch of the parameter and the law over it.
struct Cell {
    double low, high;
    RangePoint law;
    double bend = 0;  // bound of |c''|

    double length() const { return high - low; }
};

RangePoint over(const Law& law, double low, double high) { return law.ranges(Jet<Range>::parameter(Range(low, high))); }

// Upper bound of the length of a vector whose coordinates are at most so large.
double length_bound(double x, double y) { return upper(upper(std::sqrt(upper(upper(x * x) + upper(y * y))))); }
double diagonal(const Range& x, const Range& y) { return length_bound(x.interval().width(), y.interval().width()); }

Cell cell_of(const Law& law, double low, double high) {
    Cell cell{low, high, over(law, low, high)};
    cell.bend = length_bound(cell.law[0].second.magnitude(), cell.law[1].second.magnitude());
    return cell;
}

bool is_known(const Cell& cell) {
    const auto is_smooth = [](const Range& x) { return x.is_bounded() && !x.switches && !x.has_gaps; };
    for (const Jet<Range>& x : cell.law)
        if (!is_smooth(x.value) || !is_smooth(x.first) || !is_smooth(x.second)) return false;
    return true;
}

// Neighbouring cells on which the law is not known to be smooth: it is looked at as the line between its values at the ends. How far it is
// from that line, and the range of the line's slope.
struct Switch {
    double gap = 0;
    std::array<Range, 2> slope;
};

Switch switch_over(const Law& law, double low, double high, const std::vector<Cell>& cells) {
    Switch out;
    std::array<Range, 2> all{cells.front().law[0].value, cells.front().law[1].value};
    const RangePoint start = over(law, low, low), end = over(law, high, high);
    for (std::size_t k = 0; k < 2; ++k) {
        for (const Cell& cell : cells) all[k] = hull(all[k], cell.law[k].value);
        out.slope[k] = (end[k].value - start[k].value) / (Range(high) - Range(low));
    }
    out.gap = all[0].has_gaps || all[1].has_gaps ? no_bound : diagonal(all[0], all[1]);
    return out;
}

// The cells one after another: visit(cell) those that are known, switches(run of the others) once for each run.
template <class Visit, class Switches>
void in_order(std::vector<Cell>& cells, Visit visit, Switches switches) {
    std::sort(cells.begin(), cells.end(), [](const Cell& a, const Cell& b) { return a.low < b.low; });
    for (std::size_t k = 0; k < cells.size();) {
        if (is_known(cells[k])) {
            visit(cells[k++]);
            continue;
        }
        std::vector<Cell> run;
        while (k < cells.size() && !is_known(cells[k])) run.push_back(cells[k++]);
        switches(run);
    }
}

// Cut into halves until each cell is known, or as short as a switch may be. False: there are too many.
bool cut_until_known(const Law& law, std::vector<Cell>& cells, double least) {
    for (std::size_t k = 0; k < cells.size();) {
        const Cell cell = cells[k];
        const double middle = cell.low + cell.length() / 2;
        if (is_known(cell) || cell.length() <= least || !(middle > cell.low && middle < cell.high)) {
            ++k;
            continue;
        }
        if (cells.size() >= most_cells) return false;
        cells[k] = cell_of(law, cell.low, middle);
        cells.push_back(cell_of(law, middle, cell.high));
    }
    return true;
}

double sampled_bend(const Law& law, const Cell& cell) {
    const auto p = law.bend(Jet<double>::parameter(cell.low + cell.length() / 2));
    const double bend = std::hypot(p[0].second, p[1].second);
    return std::isfinite(bend) ? bend : 0;
}

}  // namespace

ChordDeviation chord_deviation(const Law& law, double low, double high, int count) {
    if (!law.ranges) return {no_bound, 0};
    const double step = (high - low) / count;
    std::vector<Cell> cells{cell_of(law, low, high)};
    if (!cut_until_known(law, cells, shortest * step)) return {no_bound, 0};
    // The largest are cut until they are near to the samples.
    double found = 0, size = 0;
    for (const Cell& cell : cells) {
        found = std::max(found, sampled_bend(law, cell));
        size = std::max(size, length_bound(cell.law[0].value.magnitude(), cell.law[1].value.magnitude()));
    }
    const double negligible = 1e-13 * size / (step * step);
    const auto less = [](const Cell& a, const Cell& b) { return a.bend < b.bend; };
    std::vector<Cell> rest;
    for (const Cell& cell : cells)
        if (!is_known(cell)) rest.push_back(cell);
    cells.erase(std::remove_if(cells.begin(), cells.end(), [](const Cell& cell) { return !is_known(cell); }), cells.end());
    std::make_heap(cells.begin(), cells.end(), less);
    for (int cut = 0; cut < most_cuts && !cells.empty() && cells.front().bend > near_enough * found + negligible; ++cut) {
        std::pop_heap(cells.begin(), cells.end(), less);
        const Cell cell = cells.back();
        cells.pop_back();
        const double middle = cell.low + cell.length() / 2;
        if (!(middle > cell.low && middle < cell.high)) return {no_bound, 0};
        for (const Cell& half : {cell_of(law, cell.low, middle), cell_of(law, middle, cell.high)}) {
            found = std::max(found, sampled_bend(law, half));
            cells.push_back(half);
            std::push_heap(cells.begin(), cells.end(), less);
        }
    }
    cells.insert(cells.end(), rest.begin(), rest.end());
    double bend = 0, jumps = 0, gap = 0, turn = 0;
    bool left = true, right = true;
    in_order(
        cells,
        [&](const Cell& cell) {
            const auto& [x, y] = cell.law;
            bend = std::max(bend, cell.bend);
            turn = std::max(turn, cell.bend / hypot(x.first, y.first).low);
            const Range side = x.first * y.second - y.first * x.second;
            left = left && side.low >= 0;
            right = right && side.high <= 0;
        },
        [&](const std::vector<Cell>& run) {
            const double from = run.front().low, to = run.back().high;
            left = right = false;
            const Switch s = switch_over(law, from, to, run);
            gap = std::max(gap, s.gap);
            for (const double end : {from, to}) {
                if (end == low || end == high) continue;
                const RangePoint p = over(law, end, end);
                jumps += length_bound((s.slope[0] - p[0].first).magnitude(), (s.slope[1] - p[1].first).magnitude());
            }
        });
    const double distance = upper(upper(upper(upper(upper(bend * step) * step) / 8) + upper(jumps * step / 4)) + gap);
    // A step that turns by half a turn or more may be on both sides of its chord.
    const bool is_short = turn * step < 3;
    return {std::isfinite(distance) ? distance : no_bound, !is_short || left == right ? 0 : left ? 1 : -1};
}

}  // namespace fettle::core::parts
