// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>

namespace fettle::design::problem {

/// Runs from its creation on.
class Stopwatch {
public:
    double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count(); }

private:
    std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

}  // namespace fettle::design::problem
