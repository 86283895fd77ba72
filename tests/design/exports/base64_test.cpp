// SPDX-License-Identifier: MIT
// Base64: the examples of RFC 4648, and bytes beyond ASCII.
#include "design/exports/base64.hpp"

#include <catch2/catch.hpp>

namespace fettle::design::exports {

TEST_CASE("Base64 is as RFC 4648 has it") {
    CHECK(base64("") == "");
    CHECK(base64("f") == "Zg==");
    CHECK(base64("fo") == "Zm8=");
    CHECK(base64("foo") == "Zm9v");
    CHECK(base64("foobar") == "Zm9vYmFy");
    CHECK(base64("\xff\xfe") == "//4=");
}

}  // namespace fettle::design::exports
