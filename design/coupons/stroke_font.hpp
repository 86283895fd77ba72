// SPDX-License-Identifier: MIT
/// Labels as plane figures, of upright and level bars, as a printer's nozzle draws them well: digits, the point, and the letters H P S W G.
#pragma once

#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "core/parts/profile.hpp"

namespace fettle::design::coupons {

struct StrokeFont {
    double width = 2e-3, height = 3e-3;  ///< of a letter [m]
    double stroke = 0.6e-3;              ///< width of a bar [m]
    double space = 0.8e-3;               ///< between letters [m]
};

/// A bar of a label: lower left corner and size [m].
struct Bar {
    double x = 0, y = 0, width = 0, height = 0;
};

/// From its lower left corner at the origin. Bars of one letter overlap. Contract: letters that there are.
std::vector<Bar> bars_of(const std::string& text, const StrokeFont& font);
/// [m]
double width_of(const std::string& text, const StrokeFont& font);

/// The label as one figure, its lower left corner at (x, y). Errors: none that are known; of profile_booleans.hpp.
Result<core::parts::Profile> label_profile(const std::string& text, const StrokeFont& font, double x, double y);

}  // namespace fettle::design::coupons
