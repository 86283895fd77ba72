// SPDX-License-Identifier: MIT
#include "design/cli/studio/event_queue.hpp"

#include <algorithm>
#include <utility>

#include "core/base/contract.hpp"

namespace fettle::design::cli::studio {

void EventQueue::push(std::shared_ptr<const Event> event) {
    if (bytes_ > patience_) {
        const auto is_replaced = [&](const std::shared_ptr<const Event>& older) { return older->name == event->name; };
        for (const auto& each : events_)
            if (is_replaced(each)) bytes_ -= each->text.size();
        events_.erase(std::remove_if(events_.begin(), events_.end(), is_replaced), events_.end());
    }
    bytes_ += event->text.size();
    events_.push_back(std::move(event));
}

std::shared_ptr<const Event> EventQueue::pop() {
    FETTLE_ASSERT(!events_.empty(), "nothing waits");
    std::shared_ptr<const Event> event = std::move(events_.front());
    events_.pop_front();
    bytes_ -= event->text.size();
    return event;
}

}  // namespace fettle::design::cli::studio
