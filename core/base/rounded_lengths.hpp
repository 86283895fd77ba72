// SPDX-License-Identifier: MIT
/// Bounds of lengths as text, on their safe side (core/base/bound_text.hpp).
#pragma once

#include <string>

#include "core/base/bound_text.hpp"

namespace fettle::core::base {

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
    std::string unit_;
    double metres_;
    long double exact_;  // metres per unit, closer
    int decimals_;
};

}  // namespace fettle::core::base
