// SPDX-License-Identifier: MIT
#include "fettle/design/cli/rounded_lengths.hpp"

#include <charconv>
#include <cmath>
#include <cstdlib>

#include "fettle/core/base/units.hpp"
#include "fettle/design/cli/answers.hpp"

namespace fettle::design::cli {

RoundedLengths::RoundedLengths(const std::string& unit, int decimals)
    : unit_(unit), metres_(core::base::metres_per_unit(unit).value()), exact_(roundl(metres_ * 1e7L) / 1e7L), decimals_(decimals) {}

// `text` shows a number of units; it is asked again for the next one until what it shows is on the right side of x.
template <class Text>
std::string RoundedLengths::bounded(double x, Towards towards, const Text& text) const {
    if (x == 0 || !std::isfinite(x)) return formatted("%g", x);
    const double beyond = towards == Towards::down ? -INFINITY : INFINITY;
    double y = x / metres_;
    for (double step = 0;; step = 2 * step + std::abs(y) * 0x1p-53) {
        const double near = towards == Towards::down ? y - step : y + step;
        const std::string shown = text(step == 0 ? y : std::nextafter(near, beyond));
        const long double length = std::strtold(shown.c_str(), nullptr) * exact_;
        if (static_cast<double>(length) == x) return shown;  // reads back to the bound itself
        if (towards == Towards::down ? length < x : length > x) return shown;
    }
}

std::string RoundedLengths::fixed(double x, Towards towards, int more) const {
    const int decimals = decimals_ + more;
    return bounded(x, towards, [&](double y) {
        const auto round = [&](double z) { return towards == Towards::down ? std::floor(z) : std::ceil(z); };
        const double scale = std::pow(10.0, decimals);
        if (std::abs(y) * scale >= 10) return formatted("%.*f", decimals, round(y * scale) / scale);
        const double digit = std::pow(10.0, std::floor(std::log10(std::abs(y))) - 2);  // of the third digit
        return formatted("%.3g", round(y / digit) * digit);
    });
}

std::string RoundedLengths::shortest(double x, Towards towards) const {
    return bounded(x, towards, [](double y) {
        char buffer[32];
        const auto [end, code] = std::to_chars(buffer, buffer + sizeof buffer, y);
        return std::string(buffer, code == std::errc() ? end : buffer);
    });
}

}  // namespace fettle::design::cli
