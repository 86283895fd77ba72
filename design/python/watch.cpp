// SPDX-License-Identifier: MIT
#include "design/python/watch.hpp"

#include <chrono>

namespace fettle::design::python {

namespace py = pybind11;

namespace {

// Asking Python takes its lock: not more often than people notice.
constexpr std::int64_t look_every = 50'000'000;

std::int64_t nanoseconds() {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

void Watch::keep(std::exception_ptr thrown) {
    const std::lock_guard lock(mutex_);
    if (!thrown_) thrown_ = std::move(thrown);
    stop_ = true;
}

bool Watch::stopped() {
    if (stop_) return true;
    const std::int64_t now = nanoseconds();
    if (now < next_look_) return false;
    next_look_ = now + look_every;
    const py::gil_scoped_acquire locked;
    if (PyErr_CheckSignals() == 0) return false;
    keep(std::make_exception_ptr(py::error_already_set()));
    return true;
}

template <class... Arguments>
void Watch::call(const Arguments&... arguments) {
    if (stop_) return;
    const py::gil_scoped_acquire locked;
    try {
        callback_(arguments...);
    } catch (py::error_already_set&) {
        keep(std::current_exception());
    }
}

std::function<bool()> Watch::should_stop() {
    return [this] { return stopped(); };
}

std::function<void(const core::stepper::Progress&)> Watch::on_step() {
    if (callback_.is_none()) return {};
    return [this](const core::stepper::Progress& progress) { call(progress.step, progress.steps); };
}

std::function<void(const std::string&)> Watch::on_line() {
    if (callback_.is_none()) return {};
    return [this](const std::string& line) { call(line); };
}

std::function<void(int, int, const std::string&)> Watch::on_result() {
    if (callback_.is_none()) return [](int, int, const std::string&) {};
    return [this](int done, int of, const std::string& line) { call(done, of, line); };
}

std::function<void(int, int)> Watch::on_count() {
    if (callback_.is_none()) return {};
    return [this](int done, int of) { call(done, of); };
}

void Watch::end() const {
    if (thrown_) std::rethrow_exception(thrown_);
}

}  // namespace fettle::design::python
