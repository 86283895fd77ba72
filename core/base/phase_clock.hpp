// SPDX-License-Identifier: MIT
/// Adds up where the time of a computation goes, by phase. Wall clock.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>

namespace fettle::core::base {

/// Seconds per phase of an enum whose last enumerator is `count`.
template <class Phase>
class PhaseClock {
public:
    using Seconds = std::array<double, static_cast<std::size_t>(Phase::count)>;

    /// Charges the time from its making to its end to a phase.
    class Span {
    public:
        Span(PhaseClock& clock, Phase phase) : clock_(clock), phase_(phase), begin_(std::chrono::steady_clock::now()) {}
        ~Span() {
            clock_.seconds_[static_cast<std::size_t>(phase_)] +=
                std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
        }
        Span(const Span&) = delete;
        Span& operator=(const Span&) = delete;

    private:
        PhaseClock& clock_;
        Phase phase_;
        std::chrono::steady_clock::time_point begin_;
    };

    Span charge(Phase phase) { return Span(*this, phase); }
    const Seconds& seconds() const { return seconds_; }

private:
    Seconds seconds_{};
};

}  // namespace fettle::core::base
