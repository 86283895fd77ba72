// SPDX-License-Identifier: MIT
#include "core/base/parallel.hpp"

#include <atomic>
#include <exception>
#include <limits>
#include <mutex>
#include <thread>

#ifndef FETTLE_THREAD_SANITIZER
#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#endif

#include "core/base/read_record.hpp"
#include "core/base/stop.hpp"

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

// On threads of their own.
void run_pieces(int pieces, const std::function<void(int)>& run) {
    std::atomic<int> next = 0;
    const auto work = [&] {
        for (int piece; (piece = next++) < pieces;) run(piece);
    };
    std::vector<std::thread> helpers;
    for (int i = std::min(thread_count(), pieces); i > 1; --i) helpers.emplace_back(work);
    work();
    for (std::thread& helper : helpers) helper.join();
}

void start_thread(const std::function<void()>& run) { std::thread(run).detach(); }

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

// Isolated: a thread that waits for an inner loop must not pick up a piece of an outer one, whose scratch memory it is using.
void run_pieces(int pieces, const std::function<void(int)>& run) {
    tbb::this_task_arena::isolate([&] {
        tbb::parallel_for(tbb::blocked_range<int>(0, pieces), [&](const tbb::blocked_range<int>& range) {
            for (int piece = range.begin(); piece < range.end(); ++piece) run(piece);
        });
    });
}

void start_thread(const std::function<void()>& run) { tbb::this_task_arena::enqueue(run); }

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

void wake_threads(const std::function<void()>& meanwhile) {
    for (int i = 1; i < thread_count(); ++i) start_thread(i == 1 && meanwhile ? meanwhile : std::function<void()>([] {}));
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
    ReadRecord* const record = ReadRecord::innermost();
    const auto run = [&](int piece) {
        if (failure.is_below(piece)) return;
        const std::function<bool()>* const own = std::exchange(StopScope::asked(), should_stop);
        ReadRecord* const own_record = std::exchange(ReadRecord::innermost(), record);
        try {
            stop_if_asked();
            const int begin = piece * grain;
            body(begin, begin + std::min(grain, count - begin));
        } catch (...) {
            failure.record(piece);
        }
        StopScope::asked() = own;
        ReadRecord::innermost() = own_record;
    };
    if (pieces > 1 && thread_count() > 1)
        run_pieces(pieces, run);
    else
        for (int piece = 0; piece < pieces; ++piece) run(piece);
    failure.rethrow();
}

}  // namespace fettle::core::base
