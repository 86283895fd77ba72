// SPDX-License-Identifier: MIT
#include "fettle/adjoint/energy/incremental_potential_adjoint.hpp"

#include <catch2/catch.hpp>
#include <string>

#include "fettle/core/energy/incremental_potential.hpp"

namespace fettle::adjoint::energy::incremental_potential_adjoint_test {

TEST_CASE("each term has its adjoint, in the same order", "[adjoint][energy]") {
    const auto forward = fettle::core::energy::terms();
    const auto backward = fettle::adjoint::energy::term_adjoints();
    REQUIRE(forward.size() == backward.size());
    for (std::size_t k = 0; k < forward.size(); ++k) CHECK(std::string(forward[k]->name) == backward[k]->name);
}

}  // namespace fettle::adjoint::energy::incremental_potential_adjoint_test
