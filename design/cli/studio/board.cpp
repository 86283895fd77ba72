// SPDX-License-Identifier: MIT
#include "design/cli/studio/board.hpp"

#include <algorithm>

namespace fettle::design::cli::studio {

void Board::put(const std::string& name, std::string data) {
    const std::lock_guard lock(mutex_);
    const auto is_over = [&](const Entry& entry) {
        if (entry.first == name) return true;
        if (name == "opened") return entry.first != "fault";
        return name == "asked" && entry.first != "opened" && entry.first != "fault" && entry.first != "tune";
    };
    entries_.erase(std::remove_if(entries_.begin(), entries_.end(), is_over), entries_.end());
    entries_.emplace_back(name, std::move(data));
}

std::vector<Board::Entry> Board::current() const {
    const std::lock_guard lock(mutex_);
    return entries_;
}

}  // namespace fettle::design::cli::studio
