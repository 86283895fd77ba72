// SPDX-License-Identifier: MIT
#include "core/base/bound_text.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>

namespace fettle::core::base {

std::string bound_text(double x, double unit, long double exact_unit, Towards towards, const std::function<std::string(double)>& text) {
    if (x == 0 || !std::isfinite(x)) {
        char shown[8];
        std::snprintf(shown, sizeof shown, "%g", x);
        return shown;
    }
    const double beyond = towards == Towards::down ? -INFINITY : INFINITY;
    const double y = x / unit, least = std::numeric_limits<double>::denorm_min();
    for (double step = 0;; step = 2 * step + std::max(std::abs(y) * 0x1p-53, least)) {
        const double near = towards == Towards::down ? y - step : y + step;
        const std::string shown = text(step == 0 ? y : std::nextafter(near, beyond));
        const long double number = std::strtold(shown.c_str(), nullptr) * exact_unit;
        if (static_cast<double>(number) == x) return shown;  // reads back to the bound itself
        if (towards == Towards::down ? number < x : number > x) return shown;
    }
}

}  // namespace fettle::core::base
