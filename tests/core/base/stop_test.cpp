// SPDX-License-Identifier: MIT
#include "core/base/stop.hpp"

#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <functional>
#include <optional>
#include <stdexcept>
#include <thread>

#include "core/base/parallel.hpp"
#include "tests/support/skip.hpp"

namespace fettle::core::base::stop_test {

namespace {

bool never() { return false; }
bool always() { return true; }

bool is_stopped() {
    try {
        stop_if_asked();
    } catch (const Stopped&) {
        return true;
    }
    return false;
}

}  // namespace

TEST_CASE("Work goes on where nobody asks for its end, and ends where somebody does", "[base]") {
    CHECK_FALSE(is_stopped());
    {
        const StopScope scope(never);
        CHECK_FALSE(is_stopped());
    }
    {
        const StopScope scope(always);
        CHECK(is_stopped());
        bool elsewhere = true;  // a thread that does not help has not been asked
        std::thread([&] { elsewhere = is_stopped(); }).join();
        CHECK_FALSE(elsewhere);
    }
    CHECK_FALSE(is_stopped());
}

TEST_CASE("Of scopes within each other the inner one alone holds, and the outer one again after it", "[base]") {
    const StopScope outer(always);
    {
        const StopScope inner(never);
        CHECK_FALSE(is_stopped());
        {
            const StopScope none{std::function<bool()>()};
            CHECK_FALSE(is_stopped());
        }
        {
            const StopScope innermost(always);
            CHECK(is_stopped());
        }
        CHECK_FALSE(is_stopped());
    }
    CHECK(is_stopped());
    try {
        const StopScope inner(never);
        throw std::runtime_error("left by an exception");
    } catch (const std::runtime_error&) {
        CHECK(is_stopped());
    }
}

TEST_CASE("A stop holds in all pieces of a loop, on the threads that help with it too, and in loops within it", "[base]") {
    const ThreadLimit limit(2);
    const auto begin = std::chrono::steady_clock::now();
    const auto in_time = [&] { return std::chrono::steady_clock::now() - begin < std::chrono::seconds(60); };
    const std::thread::id own = std::this_thread::get_id();
    bool helped = false;
    while (!helped && in_time()) {  // until a helping thread has had a piece
        std::atomic<bool> asked = false;
        std::atomic<int> stopped_helping = 0, ended = 0;
        const StopScope scope([&] { return asked.load(); });
        std::optional<bool> was_stopped;
        try {
            parallel_pieces(2, 1, [&](int, int) {
                const bool helps = std::this_thread::get_id() != own;
                if (!helps) std::this_thread::sleep_for(std::chrono::milliseconds(2));  // the other thread may come
                asked = true;
                try {
                    parallel_for(2, 1, [](int) { stop_if_asked(); });
                    ++ended;
                } catch (const Stopped&) {
                    if (helps) ++stopped_helping;
                    throw;
                }
            });
            was_stopped = false;
        } catch (const Stopped&) {
            was_stopped = true;
        }
        REQUIRE(was_stopped == true);
        REQUIRE(ended == 0);
        helped = stopped_helping > 0;
    }
    if (!helped) FETTLE_SKIP("no other thread has helped");
}

TEST_CASE("A loop asks before each piece, and pieces after a stop are not begun", "[base]") {
    const ThreadLimit one(1);
    int pieces = 0;
    const StopScope scope([&] { return pieces == 3; });
    CHECK_THROWS_AS(parallel_pieces(100, 1, [&](int, int) { ++pieces; }), Stopped);
    CHECK(pieces == 3);
}

TEST_CASE("A thread that has helped with a loop is not asked to stop afterwards by what the loop was asked by", "[base]") {
    const ThreadLimit limit(2);
    std::atomic<int> stopped = 0;
    for (int run = 0; run < 200; ++run) {
        {
            const StopScope scope(always);
            CHECK_THROWS_AS(parallel_for(8, 1, [](int) {}), Stopped);
        }
        parallel_for(8, 1, [&](int) { stopped += is_stopped(); });
    }
    CHECK(stopped == 0);
    CHECK(StopScope::asked() == nullptr);
}

}  // namespace fettle::core::base::stop_test
