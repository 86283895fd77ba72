// SPDX-License-Identifier: MIT
#include "fettle/core/contact/linear_ccd.hpp"

#include "fettle/core/base/contract.hpp"
#include "fettle/core/contact/conservative_advancement.hpp"
#include "fettle/core/contact/inclusion_ccd.hpp"

namespace fettle::core::contact {

LinearCcdResult linear_ccd(PairType type, const PairVertices& t0, const PairVertices& t1, double dmin, const LinearCcdOptions& options) {
    FETTLE_ASSERT(dmin >= 0, "a minimum separation is not negative");
    if (options.method == LinearCcdMethod::inclusion) return inclusion_ccd(type, t0, t1, dmin, options);
    return conservative_advancement(type, t0, t1, dmin, options);
}

}  // namespace fettle::core::contact
