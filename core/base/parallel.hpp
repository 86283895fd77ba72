// SPDX-License-Identifier: MIT
/// Loops over an index range on several threads whose results have the same bits for any number of threads: the range is cut
/// into pieces by `grain` alone, and partial results are combined in the order of the indices.
/// Backend: oneTBB; std::thread when built for the thread sanitizer, which reports false races in TBB.
#pragma once

#include <algorithm>
#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/contract.hpp"

namespace fettle::core::base {

/// Caps the number of threads of all loops of the process while it lives (--threads). Nested caps: the lowest holds.
class ThreadLimit {
public:
    /// Contract: threads >= 1.
    explicit ThreadLimit(int threads);
    ~ThreadLimit();
    ThreadLimit(ThreadLimit&&) noexcept;
    ThreadLimit& operator=(ThreadLimit&&) = delete;

private:
    struct Handle;
    std::unique_ptr<Handle> handle_;
};

/// Threads that a loop may use now: the machine's, or the limit.
int thread_count();

/// Has the threads made, while the caller goes on: otherwise the first loop waits for them.
/// @param meanwhile  what one of them does first, if there is another thread than the caller's; throws nothing
void wake_threads(const std::function<void()>& meanwhile = {});

/// Calls body(begin, end) for the pieces [0, grain), [grain, 2 grain), ... of [0, count), in any order, on any thread, each once.
/// If pieces throw, the exception of the lowest is thrown on, after all that were running have ended; higher ones may not have run.
/// A StopScope of the caller (stop.hpp) holds in all pieces, and is asked before each.
/// Contract: count >= 0, grain >= 1.
void parallel_pieces(int count, int grain, const std::function<void(int begin, int end)>& body);

/// body(i) for each i in [0, count). Choose `grain` so that a piece takes 10 us or more.
template <class Body>
void parallel_for(int count, int grain, Body&& body) {
    parallel_pieces(count, grain, [&](int begin, int end) {
        for (int i = begin; i < end; ++i) body(i);
    });
}

/// combine(... combine(combine(initial, map(0, grain)), map(grain, 2 grain)) ...), the maps in parallel, the combinations in order.
/// @param map      (int begin, int end) -> T, the partial result of a piece
/// @param combine  (T&& so_far, T&& piece) -> T
template <class T, class Map, class Combine>
T ordered_reduce(int count, int grain, T initial, Map&& map, Combine&& combine) {
    FETTLE_ASSERT(count >= 0 && grain >= 1, "an empty grain");
    std::vector<std::optional<T>> parts(count / grain + (count % grain != 0));
    parallel_pieces(count, grain, [&](int begin, int end) { parts[begin / grain].emplace(map(begin, end)); });
    T result = std::move(initial);
    for (std::optional<T>& part : parts) result = combine(std::move(result), std::move(*part));
    return result;
}

}  // namespace fettle::core::base
