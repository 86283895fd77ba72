// SPDX-License-Identifier: MIT
#include "adjoint/energy/incremental_potential_adjoint.hpp"

#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "core/energy/incremental_potential.hpp"

namespace fettle::adjoint::energy::incremental_potential_adjoint_test {

TEST_CASE("each term has its adjoint, in the same order", "[adjoint][energy]") {
    std::vector<std::string> forward, backward;
    for (const core::energy::BodyTerm* term : core::energy::body_terms()) forward.emplace_back(term->name);
    for (const core::energy::CouplingTerm* term : core::energy::coupling_terms()) forward.emplace_back(term->name);
    for (const TermAdjoint* term : term_adjoints()) backward.emplace_back(term->name);
    CHECK(forward == backward);
}

}  // namespace fettle::adjoint::energy::incremental_potential_adjoint_test
