// SPDX-License-Identifier: MIT
/// A long call seen from Python: the interpreter's lock is released while it runs, Ctrl-C ends it, and a callback receives its progress.
#pragma once

#include <pybind11/pybind11.h>

#include <atomic>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <string>

#include "core/stepper/simulation.hpp"

namespace fettle::design::python {

/// Its functions are called without the lock, on any thread. What the callback raises, and KeyboardInterrupt, stop the work; end() throws
/// them on.
class Watch {
public:
    /// @param callback  A callable or None; outlives this.
    explicit Watch(pybind11::handle callback) : callback_(callback) {}

    std::function<bool()> should_stop();
    /// callback(steps done, of how many).
    std::function<void(const core::stepper::Progress&)> on_step();
    /// callback(line of text).
    std::function<void(const std::string&)> on_line();
    /// callback(done, of how many, line of text).
    std::function<void(int, int, const std::string&)> on_result();
    /// callback(done, of how many).
    std::function<void(int, int)> on_count();
    /// To be called once the work has ended.
    void end() const;

private:
    bool stopped();
    template <class... Arguments>
    void call(const Arguments&... arguments);
    void keep(std::exception_ptr thrown);

    pybind11::handle callback_;
    std::atomic<bool> stop_ = false;
    std::atomic<std::int64_t> next_look_ = 0;  // nanoseconds of the steady clock
    std::mutex mutex_;
    std::exception_ptr thrown_;
};

}  // namespace fettle::design::python
