// SPDX-License-Identifier: MIT
/// Bounds as text: a bound that is printed in a unit is still a bound. The decimal that is written is compared with it in extended
/// precision: it reads back to the bound itself, or lies on its safe side.
#pragma once

#include <string>

namespace fettle::design::cli {

enum class Towards { down, up };

class RoundedLengths {
public:
    /// @param unit      "mm" (base/units.hpp)
    /// @param decimals  of a table
    explicit RoundedLengths(const std::string& unit, int decimals = 6);

    /// With the table's decimals, and `more`; three digits of what is smaller than ten of the last one. [m] in.
    std::string fixed(double x, Towards towards, int more = 0) const;
    /// As few digits as read back to the same double.
    std::string shortest(double x, Towards towards) const;

    const std::string& unit() const { return unit_; }
    double metres() const { return metres_; }

private:
    template <class Text>
    std::string bounded(double x, Towards towards, const Text& text) const;
    std::string unit_;
    double metres_;
    long double exact_;  // metres per unit, closer
    int decimals_;
};

}  // namespace fettle::design::cli
