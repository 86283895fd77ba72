// SPDX-License-Identifier: MIT
#include "design/tolerances/iso2768.hpp"

#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>

#include "core/base/units.hpp"
#include "design/tolerances/size_steps.hpp"

namespace fettle::design::tolerances {

namespace {

constexpr std::string_view classes = "fmcv";
constexpr double unlimited = std::numeric_limits<double>::infinity();
constexpr double smallest = 0.5e-3;  // [m], of lengths

/// Permissible deviations, +-, by class in the order of `classes`; 0: the standard gives none.
struct Step {
    double up_to;  // [mm]
    std::array<double, 4> deviation;
};

constexpr Step linear_steps[] = {  // [mm]
    {3, {0.05, 0.1, 0.2, 0}},    {6, {0.05, 0.1, 0.3, 0.5}}, {30, {0.1, 0.2, 0.5, 1}}, {120, {0.15, 0.3, 0.8, 1.5}},
    {400, {0.2, 0.5, 1.2, 2.5}}, {1000, {0.3, 0.8, 2, 4}},   {2000, {0.5, 1.2, 3, 6}}, {4000, {0, 2, 4, 8}}};
constexpr Step edge_steps[] = {  // [mm]
    {3, {0.2, 0.2, 0.4, 0.4}},
    {6, {0.5, 0.5, 1, 1}},
    {unlimited, {1, 1, 2, 2}}};
constexpr Step angle_steps[] = {  // [minutes of arc]
    {10, {60, 60, 90, 180}},
    {50, {30, 30, 60, 120}},
    {120, {20, 20, 30, 60}},
    {400, {10, 10, 15, 30}},
    {unlimited, {5, 5, 10, 20}}};

std::string in_mm(double metres) { return core::base::format_length(metres, "mm"); }

Result<std::size_t> read_class(std::string_view general_class, double size, const std::string& where) {
    const std::size_t column = general_class.size() == 1 ? classes.find(general_class[0]) : std::string_view::npos;
    if (column == std::string_view::npos) {
        return Error{ErrorCode::out_of_range, where,
                     "there is no class \"" + std::string(general_class) +
                         "\" of ISO 2768-1; there are f (fine), m (medium), c (coarse) and v (very coarse)"};
    }
    if (!std::isfinite(size)) return Error{ErrorCode::not_finite, where, "a size is a number"};
    return column;
}

Error too_small(double nominal, const std::string& where) {
    return {ErrorCode::out_of_range, where,
            in_mm(nominal) + ": ISO 2768-1 has no general tolerance below 0.5 mm; give this dimension a tolerance of its own"};
}

DeviationLimits symmetric(double deviation) { return {-deviation, deviation}; }

}  // namespace

Result<DeviationLimits> iso2768_linear(std::string_view general_class, double nominal, const std::string& where) {
    const Result<std::size_t> column = read_class(general_class, nominal, where);
    if (!column) return column.errors();
    if (nominal < smallest - size_rounding) return too_small(nominal, where);
    const auto step = step_of(linear_steps, nominal);
    const double deviation = step == std::end(linear_steps) ? 0 : step->deviation[*column];
    if (deviation == 0) {
        const std::string range = general_class == "f" ? "up to 2000 mm" : general_class == "v" ? "over 3 up to 4000 mm" : "up to 4000 mm";
        return Error{ErrorCode::out_of_range, where,
                     in_mm(nominal) + ": ISO 2768-1 gives class " + std::string(general_class) + " for sizes " + range +
                         "; give this dimension a tolerance of its own" +
                         (step == std::end(linear_steps) ? "" : " or choose another class")};
    }
    return symmetric(deviation / 1e3);
}

Result<DeviationLimits> iso2768_edge(std::string_view general_class, double nominal, const std::string& where) {
    const Result<std::size_t> column = read_class(general_class, nominal, where);
    if (!column) return column.errors();
    if (nominal < smallest - size_rounding) return too_small(nominal, where);
    return symmetric(step_of(edge_steps, nominal)->deviation[*column] / 1e3);
}

Result<DeviationLimits> iso2768_angle(std::string_view general_class, double shorter_leg, const std::string& where) {
    const Result<std::size_t> column = read_class(general_class, shorter_leg, where);
    if (!column) return column.errors();
    if (shorter_leg <= 0) {
        return Error{ErrorCode::out_of_range, where, in_mm(shorter_leg) + ": the shorter leg of an angle is longer than 0"};
    }
    return symmetric(step_of(angle_steps, shorter_leg)->deviation[*column] * std::numbers::pi / (60 * 180));
}

}  // namespace fettle::design::tolerances
