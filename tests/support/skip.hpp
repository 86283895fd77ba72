// SPDX-License-Identifier: MIT
/// A test case that cannot be run here says so and is left; if nothing else fails, the program that ran it ends with code 77, which CTest
/// tells as skipped, never as passed (runner.cpp):
///     if (thread_count() == 1) FETTLE_SKIP("there is one thread alone");
#pragma once

namespace fettle::tests::support {

/// Has a case been left?
inline bool& has_skipped() {
    static bool skipped = false;
    return skipped;
}

}  // namespace fettle::tests::support

/// Leaves the test case (catch2/catch.hpp included). @param reason  as for WARN
#define FETTLE_SKIP(reason)                             \
    do {                                                \
        ::fettle::tests::support::has_skipped() = true; \
        WARN("skipped: " << reason);                    \
        return;                                         \
    } while (false)
