// SPDX-License-Identifier: MIT
#include "core/files/warning_groups.hpp"

#include <algorithm>
#include <charconv>
#include <set>

namespace fettle::core::files {
namespace {

struct Group {
    std::string before, after;  // of the pointer, round the last index in it
    std::string message;
    std::set<int> indices;

    bool takes(const Group& other) const { return before == other.before && after == other.after && message == other.message; }
};

Group group_of(const Warning& warning) {
    const std::string& pointer = warning.pointer;
    for (std::size_t end = pointer.size(), slash; end > 0; end = slash) {
        slash = pointer.rfind('/', end - 1);
        if (slash == std::string::npos) break;
        const std::string token = pointer.substr(slash + 1, end - slash - 1);
        int index = 0;
        std::from_chars(token.data(), token.data() + token.size(), index);
        if (token == std::to_string(index)) return {pointer.substr(0, slash + 1), pointer.substr(end), warning.message, {index}};
    }
    return {pointer, "", warning.message, {}};
}

// "3", or "[1-5, 7, 8]".
std::string shown(const std::set<int>& indices) {
    if (indices.size() < 2) return indices.empty() ? "" : std::to_string(*indices.begin());
    std::string text;
    for (auto it = indices.begin(); it != indices.end();) {
        const int first = *it;
        int last = first;
        while (++it != indices.end() && *it == last + 1) last = *it;
        text += (text.empty() ? "[" : ", ") + std::to_string(first);
        if (last > first) text += (last > first + 1 ? "-" : ", ") + std::to_string(last);
    }
    return text + "]";
}

}  // namespace

std::vector<std::string> grouped_warnings(const std::string& path, const std::vector<Warning>& warnings) {
    std::vector<Group> groups;
    for (const Warning& warning : warnings) {
        const Group one = group_of(warning);
        const auto found = std::find_if(groups.begin(), groups.end(), [&](const Group& group) { return group.takes(one); });
        if (found == groups.end()) {
            groups.push_back(one);
        } else {
            found->indices.insert(one.indices.begin(), one.indices.end());
        }
    }
    std::vector<std::string> out;
    out.reserve(groups.size());
    for (const Group& group : groups) out.push_back(path + "#" + group.before + shown(group.indices) + group.after + ": " + group.message);
    return out;
}

}  // namespace fettle::core::files
