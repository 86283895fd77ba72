// SPDX-License-Identifier: MIT
/// What a window has to be told that opens now: the newest of each kind of news that still holds.
#pragma once

#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace fettle::design::cli::studio {

class Board {
public:
    using Entry = std::pair<std::string, std::string>;  ///< name, data

    /// Takes the place of the one of its name before. "asked" takes away what was about former values, "opened" all but faults.
    void put(const std::string& name, std::string data);
    /// In the order in which they came.
    std::vector<Entry> current() const;

private:
    mutable std::mutex mutex_;
    std::vector<Entry> entries_;
};

}  // namespace fettle::design::cli::studio
