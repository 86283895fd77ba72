// SPDX-License-Identifier: MIT
#include "fettle/core/base/parallel.hpp"

#include <array>
#include <atomic>
#include <cstdint>
#include <exception>
#include <limits>
#include <mutex>
#include <span>
#include <thread>

#ifndef FETTLE_THREAD_SANITIZER
#include <tbb/global_control.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>
#endif

namespace fettle::core::base {
namespace {

/// Remembers the exception of the lowest piece, so that which error is reported does not depend on timing.
class FirstFailure {
public:
    bool is_below(int piece) const { return lowest_.load(std::memory_order_relaxed) < piece; }
    void record(int piece) {
        const std::lock_guard lock(mutex_);
        if (piece >= lowest_) return;
        lowest_ = piece;
        exception_ = std::current_exception();
    }
    void rethrow() const {
        if (exception_) std::rethrow_exception(exception_);
    }

private:
    std::atomic<int> lowest_ = std::numeric_limits<int>::max();
    std::mutex mutex_;
    std::exception_ptr exception_;
};

}  // namespace

#ifdef FETTLE_THREAD_SANITIZER

namespace {

std::mutex limits_mutex;
std::vector<int>& limits() {  // what tbb::global_control keeps for the other backend
    static std::vector<int> values;
    return values;
}

void run_pieces(int pieces, const std::function<void(int)>& run) {
    std::atomic<int> next = 0;
    const auto work = [&] {
        for (int piece = next++; piece < pieces; piece = next++) run(piece);
    };
    std::vector<std::thread> helpers;
    for (int i = 1; i < std::min(thread_count(), pieces); ++i) helpers.emplace_back(work);
    work();
    for (std::thread& helper : helpers) helper.join();
}

}  // namespace

struct ThreadLimit::Handle {
    int threads;
    explicit Handle(int count) : threads(count) {
        const std::lock_guard lock(limits_mutex);
        limits().push_back(threads);
    }
    ~Handle() {
        const std::lock_guard lock(limits_mutex);
        limits().erase(std::find(limits().begin(), limits().end(), threads));
    }
};

int thread_count() {
    const std::lock_guard lock(limits_mutex);
    const int machine = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    return limits().empty() ? machine : *std::min_element(limits().begin(), limits().end());
}

#else

namespace {

// Pieces that are left of a block, taken from both ends.
class alignas(64) Block {
public:
    void set(std::uint32_t first, std::uint32_t last) { range_.store(packed(first, last), std::memory_order_relaxed); }
    /// @return the piece; -1: none is left
    int take_first() {
        return take([](std::uint32_t first, std::uint32_t last) { return std::pair(first, packed(first + 1, last)); });
    }
    int take_last() {
        return take([](std::uint32_t first, std::uint32_t last) { return std::pair(last - 1, packed(first, last - 1)); });
    }

private:
    static std::uint64_t packed(std::uint32_t first, std::uint32_t last) { return std::uint64_t{last} << 32 | first; }

    template <class Taken>
    int take(const Taken& taken) {
        std::uint64_t range = range_.load(std::memory_order_relaxed);
        for (;;) {
            const auto first = static_cast<std::uint32_t>(range), last = static_cast<std::uint32_t>(range >> 32);
            if (first >= last) return -1;
            const auto [piece, rest] = taken(first, last);
            if (range_.compare_exchange_weak(range, rest, std::memory_order_relaxed)) return static_cast<int>(piece);
        }
    }

    std::atomic<std::uint64_t> range_ = 0;
};

// Each thread has a block of neighbouring pieces, the same one in loop after loop: what it has written there is in its caches. Those that
// have done with theirs help the others, from the far end.
void run_pieces(int pieces, const std::function<void(int)>& run) {
    constexpr int few = 8;
    const int threads = std::min(thread_count(), pieces);
    std::array<Block, few> on_stack;
    std::vector<Block> on_heap(threads > few ? static_cast<std::size_t>(threads) : 0);
    const std::span<Block> blocks(threads > few ? on_heap.data() : on_stack.data(), static_cast<std::size_t>(threads));
    for (int i = 0; i < threads; ++i) {
        const auto begin_of = [&](int block) { return static_cast<std::uint32_t>(std::int64_t{block} * pieces / threads); };
        blocks[static_cast<std::size_t>(i)].set(begin_of(i), begin_of(i + 1));
    }
    const auto work = [&] {
        const int own = std::max(0, tbb::this_task_arena::current_thread_index()) % threads;
        for (int piece; (piece = blocks[static_cast<std::size_t>(own)].take_first()) >= 0;) run(piece);
        for (int i = 1; i < threads; ++i) {
            Block& other = blocks[static_cast<std::size_t>((own + i) % threads)];
            for (int piece; (piece = other.take_last()) >= 0;) run(piece);
        }
    };
    if (threads == 1) return work();
    // Isolated: a thread that waits for an inner loop must not pick up a piece of an outer one, whose scratch memory it is using.
    tbb::this_task_arena::isolate([&] {
        tbb::task_group helpers;
        for (int i = 1; i < threads; ++i) helpers.run(work);
        work();
        helpers.wait();
    });
}

}  // namespace

struct ThreadLimit::Handle {
    tbb::global_control control;
    explicit Handle(int threads) : control(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads)) {}
};

int thread_count() {
    return std::min(static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism)),
                    tbb::this_task_arena::max_concurrency());
}

#endif

ThreadLimit::ThreadLimit(int threads) {
    FETTLE_ASSERT(threads >= 1, "a limit of no threads");
    handle_ = std::make_unique<Handle>(threads);
}
ThreadLimit::~ThreadLimit() = default;
ThreadLimit::ThreadLimit(ThreadLimit&&) noexcept = default;

void parallel_pieces(int count, int grain, const std::function<void(int begin, int end)>& body) {
    FETTLE_ASSERT(count >= 0 && grain >= 1, "a negative count or an empty grain");
    const int pieces = count / grain + (count % grain != 0);
    FirstFailure failure;
    const auto run = [&](int piece) {
        if (failure.is_below(piece)) return;
        try {
            const int begin = piece * grain;
            body(begin, begin + std::min(grain, count - begin));
        } catch (...) {
            failure.record(piece);
        }
    };
    if (pieces == 1) {
        run(0);
    } else if (pieces > 1) {
        run_pieces(pieces, run);
    }
    failure.rethrow();
}

}  // namespace fettle::core::base
