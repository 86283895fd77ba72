// SPDX-License-Identifier: MIT
/// What extrusions are made of: a profile between two heights.
#pragma once

#include <string>

#include "core/parts/profile.hpp"

namespace fettle::core::parts {

/// How a layer ends. Over the last `height` of it the outline draws in by `inset` (holes widen; < 0: the reverse), along straight slopes.
/// inset = height: a chamfer of 45 degrees. height = the whole layer: draft.
struct End {
    Number inset, height;
};

/// From z = from to z = to > from.
struct Layer {
    Profile profile;
    Number from, to;
    End lower, upper;
    std::string feature;  ///< of its end faces
};

}  // namespace fettle::core::parts
