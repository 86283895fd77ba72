// SPDX-License-Identifier: MIT
/// Events that one listener has not been sent yet.
#pragma once

#include <cstddef>
#include <deque>
#include <memory>
#include <string>

namespace fettle::design::cli::studio {

/// Shared by all listeners.
struct Event {
    std::string name;  ///< its kind; empty: a comment
    std::string text;  ///< as sent
};

/// In the order in which they came. A listener that has fallen behind, with more waiting than `patience`, keeps the newest of each kind
/// only: a newer event takes all older ones of its kind away.
class EventQueue {
public:
    explicit EventQueue(std::size_t patience) : patience_(patience) {}

    void push(std::shared_ptr<const Event> event);
    /// The oldest. Contract: there is one.
    std::shared_ptr<const Event> pop();

    bool empty() const { return events_.empty(); }
    std::size_t bytes() const { return bytes_; }

private:
    std::size_t patience_;  // [bytes]
    std::size_t bytes_ = 0;
    std::deque<std::shared_ptr<const Event>> events_;
};

}  // namespace fettle::design::cli::studio
