// SPDX-License-Identifier: MIT
/// Ending work that has no answer to give before it is done (a search for contacts, collision detection, a check of a start): whoever can
/// do without it asks for its end, however deep it is, and catches Stopped.
///
///     const StopScope scope(should_stop);                       // of this thread, and of those that help with its loops
///     try { model = build_model(scene); } catch (const Stopped&) { ... }
#pragma once

#include <exception>
#include <functional>
#include <utility>

namespace fettle::core::base {

/// Thrown by stop_if_asked().
class Stopped : public std::exception {
public:
    const char* what() const noexcept override { return "stopped on request"; }
};

/// While it lives its thread's work ends by Stopped once should_stop says so. Within another the inner one alone holds.
class StopScope {
public:
    /// @param should_stop  asked often, on any thread; empty: work is not stopped
    explicit StopScope(std::function<bool()> should_stop) : should_stop_(std::move(should_stop)), outer_(asked()) {
        asked() = should_stop_ ? &should_stop_ : nullptr;
    }
    ~StopScope() { asked() = outer_; }
    StopScope(const StopScope&) = delete;
    StopScope& operator=(const StopScope&) = delete;

    /// This thread's; null: there is none. Loops hand it to the threads that help (parallel.cpp).
    static const std::function<bool()>*& asked() {
        static thread_local const std::function<bool()>* function = nullptr;
        return function;
    }

private:
    std::function<bool()> should_stop_;
    const std::function<bool()>* outer_;
};

/// Costs next to nothing where nobody asks; elsewhere a call: once per microsecond of work, not more often.
inline void stop_if_asked() {
    const std::function<bool()>* const should_stop = StopScope::asked();
    if (should_stop != nullptr && (*should_stop)()) throw Stopped();
}

}  // namespace fettle::core::base
