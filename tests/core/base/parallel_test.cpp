// SPDX-License-Identifier: MIT
#include "core/base/parallel.hpp"
#include "tests/support/skip.hpp"

#include <array>
#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <numeric>
#include <set>
#include <stdexcept>
#include <thread>

namespace fettle::core::base::parallel_test {

namespace {

double sum_of_sines(int count, int grain) {
    return ordered_reduce(
        count, grain, 0.0,
        [](int begin, int end) {
            double sum = 0;
            for (int i = begin; i < end; ++i) sum += std::sin(i) * 1e3 / (1 + i % 7);
            return sum;
        },
        [](double so_far, double piece) { return so_far + piece; });
}

std::uint64_t bits(double x) {
    std::uint64_t b = 0;
    std::memcpy(&b, &x, sizeof b);
    return b;
}

}  // namespace

TEST_CASE("every index is visited once", "[base]") {
    for (const int count : {0, 1, 7, 1000}) {
        for (const int grain : {1, 3, 1000, 5000}) {
            std::vector<std::atomic<int>> visits(count);
            parallel_for(count, grain, [&](int i) { ++visits[i]; });
            CHECK(std::all_of(visits.begin(), visits.end(), [](const auto& v) { return v == 1; }));
        }
    }
}

TEST_CASE("every index is visited once where threads help each other, loop after loop", "[base]") {
    for (const int threads : {2, 3, 16}) {
        const ThreadLimit limit(threads);
        for (int run = 0; run < 300; ++run) {
            const int count = 1 + run % 97, slow = run % 5;  // the first pieces, the last, or one in five
            std::vector<std::atomic<int>> visits(count);
            std::vector<double> seen(count);
            parallel_for(count, 1, [&](int i) {
                double sum = i;
                for (int k = 0; (i + 4 * i / count) % 5 == slow && k < 2000; ++k) sum = std::sin(sum);
                seen[i] = sum;
                ++visits[i];
            });
            REQUIRE(std::all_of(visits.begin(), visits.end(), [](const auto& v) { return v == 1; }));
        }
    }
}

TEST_CASE("every index is visited once in loops that several threads run at a time, nested, and after pauses", "[base]") {
    constexpr int callers = 4, runs = 200;
    std::array<int, callers> wrong{};
    const auto call = [&](int caller) {
        for (int run = 0; run < runs; ++run) {
            const int count = 1 + (run * 7 + caller) % 61, inner = run % 3 == 0 ? 5 : 1;
            std::vector<std::atomic<int>> visits(count * inner);
            parallel_for(count, 1, [&](int i) { parallel_for(inner, 1, [&](int k) { ++visits[i * inner + k]; }); });
            wrong[caller] += !std::all_of(visits.begin(), visits.end(), [](const auto& v) { return v == 1; });
            if (run % 50 == caller) std::this_thread::sleep_for(std::chrono::milliseconds(3));  // threads that wait for loops give up
        }
    };
    for (const int threads : {2, 5}) {
        const ThreadLimit limit(threads);
        std::vector<std::thread> others;
        for (int caller = 1; caller < callers; ++caller) others.emplace_back(call, caller);
        call(0);
        for (std::thread& other : others) other.join();
    }
    CHECK(wrong == std::array<int, callers>{});
}

TEST_CASE("a sum has the same bits for any number of threads", "[base]") {
    const std::uint64_t expected = [] {
        const ThreadLimit one(1);
        return bits(sum_of_sines(100'000, 64));
    }();
    std::set<std::uint64_t> seen;
    for (const int threads : {1, 2, 3, 8}) {
        const ThreadLimit limit(threads);
        for (int run = 0; run < 20; ++run) seen.insert(bits(sum_of_sines(100'000, 64)));
    }
    CHECK(seen == std::set<std::uint64_t>{expected});
}

TEST_CASE("pieces are combined in order", "[base]") {
    const auto indices = ordered_reduce(
        1000, 7, std::vector<int>{},
        [](int begin, int end) {
            std::vector<int> piece(end - begin);
            std::iota(piece.begin(), piece.end(), begin);
            return piece;
        },
        [](std::vector<int>&& so_far, std::vector<int>&& piece) {
            so_far.insert(so_far.end(), piece.begin(), piece.end());
            return std::move(so_far);
        });
    REQUIRE(indices.size() == 1000);
    CHECK(std::is_sorted(indices.begin(), indices.end()));
}

TEST_CASE("the exception of the lowest piece arrives, whatever the timing", "[base]") {
    for (int run = 0; run < 50; ++run) {
        std::string message;
        try {
            parallel_for(200, 1, [](int i) {
                if (i % 50 == 37) throw std::runtime_error(std::to_string(i));
            });
        } catch (const std::runtime_error& error) {
            message = error.what();
        }
        CHECK(message == "37");
    }
}

TEST_CASE("what is to be done meanwhile is done once, on another thread, if there is one", "[base]") {
    std::atomic<int> done = 0;
    std::atomic<std::thread::id> by;
    const auto job = [&] {
        by = std::this_thread::get_id();
        ++done;
    };
    {
        const ThreadLimit one(1);
        wake_threads(job);
        CHECK(done == 0);
    }
    if (thread_count() == 1) FETTLE_SKIP("one thread alone");
    wake_threads(job);
    const auto begin = std::chrono::steady_clock::now();
    while (done == 0 && std::chrono::steady_clock::now() - begin < std::chrono::seconds(60)) std::this_thread::yield();
    REQUIRE(done == 1);
    CHECK(by.load() != std::this_thread::get_id());
    std::atomic<int> visits = 0;  // loops go on as before
    for (int k = 0; k < 100; ++k) parallel_for(40, 1, [&](int) { ++visits; });
    CHECK(visits == 4000);
    CHECK(done == 1);
}

TEST_CASE("loops can be nested, and limits too", "[base]") {
    std::atomic<int> visits = 0;
    parallel_for(10, 1, [&](int) { parallel_for(10, 1, [&](int) { ++visits; }); });
    CHECK(visits == 100);
    const int before = thread_count();
    {
        const ThreadLimit one(1);
        CHECK(thread_count() == 1);
        const ThreadLimit two(2);
        CHECK(thread_count() == 1);
    }
    CHECK(thread_count() == before);
    CHECK_THROWS_AS(ThreadLimit(0), ContractError);
    CHECK_THROWS_AS(parallel_for(-1, 1, [](int) {}), ContractError);
}

}  // namespace fettle::core::base::parallel_test
