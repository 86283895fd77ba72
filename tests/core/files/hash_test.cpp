// SPDX-License-Identifier: MIT
#include "core/files/hash.hpp"

#include <catch2/catch.hpp>

namespace fettle::core::files::hash_test {

TEST_CASE("the published test vectors of FNV-1a") {
    CHECK(hash_of("") == "cbf29ce484222325");
    CHECK(hash_of("foobar") == "85944171f73967e8");
}

}  // namespace fettle::core::files::hash_test
