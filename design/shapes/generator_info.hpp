// SPDX-License-Identifier: MIT
/// What a generator of shapes says of itself: its name, its dimensions.
#pragma once

#include <string>
#include <vector>

namespace fettle::design::shapes {

enum class DimensionKind {
    length,     ///< positive
    coordinate  ///< any sign
};

struct DimensionInfo {
    std::string name;
    double default_value = 0;  ///< [m]
    std::string meaning;
    DimensionKind kind = DimensionKind::length;
};

/// "dimension must be below limit", both at given dimensions [m].
struct DimensionLimit {
    std::string dimension;
    double value = 0, limit = 0;
    std::string reason;  ///< "or the pin leaves the disc"
};

struct GeneratorInfo {
    std::string name;
    std::string description;
    std::vector<DimensionInfo> dimensions;
};

}  // namespace fettle::design::shapes
