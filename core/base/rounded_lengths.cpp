// SPDX-License-Identifier: MIT
#include "core/base/rounded_lengths.hpp"

#include <charconv>
#include <cmath>

#include "core/base/text.hpp"
#include "core/base/units.hpp"

namespace fettle::core::base {

RoundedLengths::RoundedLengths(const std::string& unit, int decimals)
    : unit_(unit), metres_(metres_per_unit(unit).value()), exact_(roundl(metres_ * 1e7L) / 1e7L), decimals_(decimals) {}

std::string RoundedLengths::fixed(double x, Towards towards, int more) const {
    const int decimals = decimals_ + more;
    return bound_text(x, metres_, exact_, towards, [&](double y) {
        const auto round = [&](double z) { return towards == Towards::down ? std::floor(z) : std::ceil(z); };
        const double scale = std::pow(10.0, decimals);
        if (std::abs(y) * scale >= 10) return formatted("%.*f", decimals, round(y * scale) / scale);
        const double digit = std::pow(10.0, std::floor(std::log10(std::abs(y))) - 2);  // of the third digit
        return formatted("%.3g", round(y / digit) * digit);
    });
}

std::string RoundedLengths::shortest(double x, Towards towards) const {
    return bound_text(x, metres_, exact_, towards, [](double y) {
        char buffer[32];
        const auto [end, code] = std::to_chars(buffer, buffer + sizeof buffer, y);
        return std::string(buffer, code == std::errc() ? end : buffer);
    });
}

}  // namespace fettle::core::base
