// SPDX-License-Identifier: MIT
#include "core/base/printed_text.hpp"

#include <catch2/catch.hpp>

namespace fettle::core::base::printed_text_test {

TEST_CASE("What is printed is no command to a runner of checks", "[base]") {
    CHECK(printed("::error::x") == "\\x3a:error::x");
    CHECK(printed("a\n  \t ::error file=b::x\nb ::c") == "a\n  \t \\x3a:error file=b::x\nb ::c");
    CHECK(printed("\xC2\xA0\xE2\x80\xA8::set-env") == "\xC2\xA0\\u2028::set-env");           // .NET trims the first alone
    CHECK(printed("\xC2\xA0\xE2\x80\x83::set-env") == "\xC2\xA0\xE2\x80\x83\\x3a:set-env");  // blanks that .NET trims
    CHECK(printed("name ##[error]x, # #[2]") == "name \\x23#[error]x, # #[2]");
    CHECK(printed("a\r::b\033") == "a\\x0d::b\\x1b");
    CHECK(printed("pin: 1\n: 2\n:") == "pin: 1\n: 2\n:");
}

}  // namespace fettle::core::base::printed_text_test
