// SPDX-License-Identifier: MIT
/// What a query of linear continuous collision detection is asked and answers: linear_ccd.hpp and the two methods below it.
#pragma once

namespace fettle::core::contact {

enum class LinearCcdMethod { conservative_advancement, inclusion };

struct LinearCcdOptions {
    LinearCcdMethod method = LinearCcdMethod::conservative_advancement;
    double tolerance = 1e-6;  ///< [m] advancement: a hit is reported where distance - dmin <= min(tolerance, a tenth of the first gap);
                              ///< inclusion: size of a box's image, so hits are within sqrt(3) (tolerance + dmin)
    /// Directions (never more than 5000; 78 on the public queries) or boxes; past it the answer is a conservative hit.
    int max_iterations = 1'000'000;
};

struct LinearCcdResult {
    bool hit = false;  ///< may come within `dmin` in [0, 1]; false is a proof that it does not
    double toi = 1;    ///< proven: distance > dmin for all times in [0, toi); by advancement at toi > 0 itself too. 1 if no hit.
};

}  // namespace fettle::core::contact
