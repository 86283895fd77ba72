// SPDX-License-Identifier: MIT
#include "design/description/over_tolerances.hpp"

#include "core/base/text.hpp"

namespace fettle::design::description {

std::string words(const OverTolerances& over) {
    if (over.kind == OverTolerances::Kind::worst_case) return "in the worst case of the tolerances";
    if (over.kind == OverTolerances::Kind::proven) return "for all parts within the tolerances, proven";
    return core::base::formatted("at %.4g sigma of the tolerances", over.sigmas);
}

}  // namespace fettle::design::description
