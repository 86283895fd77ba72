// SPDX-License-Identifier: MIT
/// Charts of how a number spreads over its tolerances, as SVG in a page: a tornado of what moves it, a histogram of samples, a scatter of
/// samples over one tolerance. Words are text that can be selected and read aloud; colours are the page's (tolerance_report.cpp has the
/// style), and nothing is told by colour alone. Numbers are in the units that they are shown in; text is anyone's, and is escaped here.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace fettle::design::report {

/// What one contributor does to a number.
struct TornadoBar {
    std::string of;                     ///< the tolerance, or what a group shares
    std::string limits;                 ///< "-0.1 to +0.1 mm", for its tooltip
    double at_lower = 0, at_upper = 0;  ///< the number's change with it alone at its lower and upper limit
    double share = 0;                   ///< of the number's variance
};

/// One row for each bar: its name, its share, and its two changes to the left and right of zero.
std::string tornado_svg(const std::string& title, const std::vector<TornadoBar>& bars, const std::string& unit);

/// A line across a chart's values: the design as drawn, a mean, a limit.
struct ChartMark {
    std::string text;  ///< "as drawn"
    std::string kind;  ///< class of the line: "drawn", "mean", "limit"
    double value = 0;
};

/// @param values     samples. Contract: at least one, all finite.
/// @param predicted  the same number by the prediction, of other samples: drawn as a line; empty: none.
/// Marks that are farther off than the samples spread are told at the edge and not drawn to scale.
std::string histogram_svg(const std::string& title, const std::vector<double>& values, const std::vector<double>& predicted,
                          const std::vector<ChartMark>& marks, const std::string& unit);

/// A made mechanism.
struct ScatterPoint {
    double x = 0;
    std::optional<double> y;  ///< nothing: it could not be made or simulated, and is marked on the lower edge
    bool is_met = true;
};

/// @param limits  of y. Contract: at least one point.
std::string scatter_svg(const std::string& title, const std::vector<ScatterPoint>& points, const std::vector<ChartMark>& limits,
                        const std::string& x_label, const std::string& y_label);

/// Round numbers within [least, most], about `count` of them. Contract: least <= most, both finite.
std::vector<double> round_numbers(double least, double most, int count);

}  // namespace fettle::design::report
