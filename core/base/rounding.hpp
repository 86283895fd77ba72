// SPDX-License-Identifier: MIT
/// What bounds of rounding are made of. One IEEE operation on doubles returns x (1 + e) with |e| <= unit_roundoff (docs/method/README.md).
#pragma once

namespace fettle::core::base {

inline constexpr double unit_roundoff = 0x1p-53;

/// Above the rounding of a formula of a few dozen operations without cancellation: `formula * rounded_up` is no less than its exact value.
inline constexpr double rounded_up = 1 + 64 * unit_roundoff;

}  // namespace fettle::core::base
