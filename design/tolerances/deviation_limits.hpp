// SPDX-License-Identifier: MIT
/// How far a made dimension may lie from its nominal value.
#pragma once

namespace fettle::design::tolerances {

/// What is made lies between nominal + lower and nominal + upper. Either may have any sign: 25 p6 is +22 to +35 um.
struct DeviationLimits {
    double lower = 0, upper = 0;  ///< [m]; of an angle [rad]; lower <= upper
};

}  // namespace fettle::design::tolerances
