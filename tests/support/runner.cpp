// SPDX-License-Identifier: MIT
// Catch2's runner, and the exit code of what was skipped.
#define CATCH_CONFIG_RUNNER
#include <catch2/catch.hpp>

#include "tests/support/skip.hpp"

int main(int argc, char** argv) {
    constexpr int skipped = 77;
    const int failed = Catch::Session().run(argc, argv);
    return failed == 0 && fettle::tests::support::has_skipped() ? skipped : failed;
}
