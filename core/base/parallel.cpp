// SPDX-License-Identifier: MIT
#include "fettle/core/base/parallel.hpp"

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <exception>
#include <limits>
#include <mutex>
#include <span>
#include <thread>

#ifdef __linux__
#include <sched.h>
#endif

#ifndef FETTLE_THREAD_SANITIZER
#include <tbb/global_control.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>
#endif

#include "fettle/core/base/stop.hpp"

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

namespace {

// This thread is in a loop, or lingers for one.
class Inside {
public:
    Inside() { is_inside() = true; }
    ~Inside() { is_inside() = was_; }
    Inside(const Inside&) = delete;
    Inside& operator=(const Inside&) = delete;

    static bool& is_inside() {
        static thread_local bool inside = false;
        return inside;
    }

private:
    bool was_ = is_inside();
};

}  // namespace

#ifdef FETTLE_THREAD_SANITIZER

namespace {

std::mutex limits_mutex;
std::vector<int>& limits() {  // what tbb::global_control keeps for the other backend
    static std::vector<int> values;
    return values;
}

void start_thread(const std::function<void()>& run) { std::thread(run).detach(); }

// On threads of their own.
void run_apart(int threads, const std::function<void(int thread)>& work) {
    std::vector<std::thread> helpers;
    for (int i = 1; i < threads; ++i)
        helpers.emplace_back([&work, i] {
            const Inside inside;
            work(i);
        });
    const Inside inside;
    work(0);
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

void start_thread(const std::function<void()>& run) { tbb::this_task_arena::enqueue(run); }

// Isolated: a thread that waits for an inner loop must not pick up a piece of an outer one, whose scratch memory it is using.
void run_apart(int threads, const std::function<void(int thread)>& work) {
    const auto as_thread = [&] {
        const Inside inside;
        work(std::max(0, tbb::this_task_arena::current_thread_index()) % threads);
    };
    tbb::this_task_arena::isolate([&] {
        tbb::task_group helpers;
        for (int i = 1; i < threads; ++i) helpers.run(as_thread);
        as_thread();
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
class Loop {
public:
    Loop(int pieces, int threads, const std::function<void(int)>& run)
        : run_(run),
          on_heap_(threads > few ? static_cast<std::size_t>(threads) : 0),
          blocks_(threads > few ? on_heap_.data() : on_stack_.data(), static_cast<std::size_t>(threads)) {
        const auto begin_of = [&](int block) { return static_cast<std::uint32_t>(std::int64_t{block} * pieces / threads); };
        for (int i = 0; i < threads; ++i) blocks_[static_cast<std::size_t>(i)].set(begin_of(i), begin_of(i + 1));
    }
    Loop(const Loop&) = delete;
    Loop& operator=(const Loop&) = delete;

    int threads() const { return static_cast<int>(blocks_.size()); }

    void work(int thread) {
        const auto own = static_cast<std::size_t>(thread);
        for (int piece; (piece = blocks_[own].take_first()) >= 0;) run_(piece);
        for (std::size_t i = 1; i < blocks_.size(); ++i) {
            Block& other = blocks_[(own + i) % blocks_.size()];
            for (int piece; (piece = other.take_last()) >= 0;) run_(piece);
        }
    }

private:
    static constexpr int few = 8;

    const std::function<void(int)>& run_;
    std::array<Block, few> on_stack_;
    std::vector<Block> on_heap_;
    std::span<Block> blocks_;
};

// A thread that has just been made, or woken, may share its maker's processor until the system balances its load: for milliseconds.
#ifdef __linux__
int processor() { return sched_getcpu(); }
void leave_processor(int shared) {
    cpu_set_t all;
    if (sched_getcpu() != shared || sched_getaffinity(0, sizeof all, &all) != 0 || CPU_COUNT(&all) < 2) return;
    cpu_set_t others = all;
    CPU_CLR(shared, &others);
    if (sched_setaffinity(0, sizeof others, &others) == 0) sched_setaffinity(0, sizeof all, &all);
}
#else
int processor() { return 0; }
void leave_processor(int) {}
#endif

// Waits for what comes soon without sleep, and without giving up the processor, for a moment, where each thread has one of its own.
class Patience {
public:
    explicit Patience(int threads) : crowded_(threads > machine_threads()) {}

    /// Waits a little. @return whether it is worth waiting on: a thread that sleeps takes up to a millisecond to wake in a virtual machine
    bool lasts() {
        constexpr std::chrono::microseconds moment{60}, long_time{2000};
        const auto waited = std::chrono::steady_clock::now() - begun_;
        if (crowded_ || waited > moment) std::this_thread::yield();
        for (int i = 0; i < 4; ++i) pause();
        return waited < long_time;
    }

private:
    static int machine_threads() {
        static const auto count = static_cast<int>(std::thread::hardware_concurrency());
        return count;
    }
    static void pause() {
#if defined(__x86_64__) || defined(__i386__)
        __builtin_ia32_pause();
#endif
    }

    bool crowded_;
    std::chrono::steady_clock::time_point begun_ = std::chrono::steady_clock::now();
};

// Threads that have helped with a loop linger for the next one: in a step of many small loops it comes before a thread could go to sleep
// and wake. One loop at a time has them, an outermost one; how many there are, and whether they come in time, changes no result.
class Lingerers {
public:
    /// An inner loop wants threads, while this lives: those that linger go, and are free for it.
    class Wanted {
    public:
        Wanted() { instance().wanted_.fetch_add(1, std::memory_order_relaxed); }
        ~Wanted() { instance().wanted_.fetch_sub(1, std::memory_order_relaxed); }
        Wanted(const Wanted&) = delete;
        Wanted& operator=(const Wanted&) = delete;
    };

    /// @return false: another loop has them
    bool run(Loop& loop) {
        if (Inside::is_inside() || has_loop_.exchange(true, std::memory_order_acquire)) return false;
        const int helpers = loop.threads() - 1;
        for (int i = present_.load(std::memory_order_relaxed); i < helpers; ++i) start();
        loop_ = &loop;
        const std::uint64_t none_busy = state_.load(std::memory_order_relaxed) & ~(number - 1);
        state_.store(none_busy + number + static_cast<std::uint64_t>(helpers) * seat, std::memory_order_release);
        {
            const Inside inside;
            loop.work(0);
        }
        state_.fetch_and(~(busy - seat), std::memory_order_relaxed);  // nobody else may sit down
        for (Patience patience(loop.threads()); (state_.load(std::memory_order_acquire) & (number - busy)) != 0;) patience.lasts();
        has_loop_.store(false, std::memory_order_release);
        return true;
    }

    void start(const std::function<void()>& first = {}) {
        present_.fetch_add(1, std::memory_order_relaxed);
        maker_processor_.store(processor(), std::memory_order_relaxed);
        start_thread([first] { instance().linger(first); });
        std::this_thread::yield();  // it may share this processor
    }

    static Lingerers& instance() {
        static Lingerers team;
        return team;
    }

private:
    // Of state_: the loop's number, how many threads are busy with it, how many more may be.
    static constexpr std::uint64_t seat = 1, busy = 1 << 16, number = std::uint64_t{1} << 32;

    void linger(const std::function<void()>& first) {
        const bool is_free = !Inside::is_inside();  // else this thread waits for an inner loop
        if (is_free) leave_processor(maker_processor_.load(std::memory_order_relaxed));
        if (first) first();
        if (is_free) {
            const Inside inside;
            std::uint64_t last = 0;  // loop
            do last = helped_after(last);
            while (last != 0);
        }
        present_.fetch_sub(1, std::memory_order_relaxed);
    }

    // Waits for a loop after `last`, and helps with it. @return its number; 0: none has come
    std::uint64_t helped_after(std::uint64_t last) {
        Patience patience(present_.load(std::memory_order_relaxed) + 1);
        do {
            std::uint64_t now = state_.load(std::memory_order_acquire);
            const std::uint64_t seats = now & (busy - seat);
            if (now / number == last || seats == 0) continue;
            if (!state_.compare_exchange_strong(now, now - seat + busy, std::memory_order_acq_rel)) continue;
            loop_->work(loop_->threads() - static_cast<int>(seats));
            state_.fetch_sub(busy, std::memory_order_release);
            return now / number;
        } while (wanted_.load(std::memory_order_relaxed) == 0 && patience.lasts());
        return 0;
    }

    alignas(64) std::atomic<std::uint64_t> state_ = 0;
    alignas(64) std::atomic<bool> has_loop_ = false;
    std::atomic<int> present_ = 0, wanted_ = 0;
    std::atomic<int> maker_processor_ = 0;  // where start() was called last
    Loop* loop_ = nullptr;
};

void run_pieces(int pieces, const std::function<void(int)>& run) {
    const int threads = std::min(thread_count(), pieces);
    Loop loop(pieces, threads, run);
    if (threads == 1) return loop.work(0);
    if (Lingerers::instance().run(loop)) return;
    const Lingerers::Wanted wanted;
    run_apart(threads, [&](int thread) { loop.work(thread); });
}

}  // namespace

void wake_threads(const std::function<void()>& meanwhile) {
    for (int i = 1; i < thread_count(); ++i) Lingerers::instance().start(i == 1 ? meanwhile : std::function<void()>());
}

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
    const std::function<bool()>* const should_stop = StopScope::asked();
    const auto run = [&](int piece) {
        if (failure.is_below(piece)) return;
        const std::function<bool()>* const own = std::exchange(StopScope::asked(), should_stop);
        try {
            stop_if_asked();
            const int begin = piece * grain;
            body(begin, begin + std::min(grain, count - begin));
        } catch (...) {
            failure.record(piece);
        }
        StopScope::asked() = own;
    };
    if (pieces == 1) {
        run(0);
    } else if (pieces > 1) {
        run_pieces(pieces, run);
    }
    failure.rethrow();
}

}  // namespace fettle::core::base
