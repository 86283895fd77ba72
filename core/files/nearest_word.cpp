// SPDX-License-Identifier: MIT
#include "core/files/nearest_word.hpp"

#include <algorithm>
#include <cctype>

namespace fettle::core::files {
namespace {

/// Four times the edit distance, where a change of case counts as a quarter.
int quadrupled_edit_distance(std::string_view a, std::string_view b) {
    const auto lower = [](char c) { return std::tolower(static_cast<unsigned char>(c)); };
    std::vector<std::vector<int>> cost(a.size() + 1, std::vector<int>(b.size() + 1));
    for (std::size_t i = 0; i <= a.size(); ++i) {
        for (std::size_t j = 0; j <= b.size(); ++j) {
            if (i == 0 || j == 0) {
                cost[i][j] = static_cast<int>(4 * (i + j));
                continue;
            }
            const int replace = a[i - 1] == b[j - 1] ? 0 : (lower(a[i - 1]) == lower(b[j - 1]) ? 1 : 4);
            cost[i][j] = std::min({cost[i - 1][j] + 4, cost[i][j - 1] + 4, cost[i - 1][j - 1] + replace});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) cost[i][j] = std::min(cost[i][j], cost[i - 2][j - 2] + 4);
        }
    }
    return cost[a.size()][b.size()];
}

}  // namespace

std::optional<std::string> nearest_word(std::string_view word, const std::vector<std::string_view>& known) {
    std::optional<std::string> best;
    int best_cost = 0;
    if (word.size() > 100) return best;
    for (const auto& candidate : known) {
        const int cost = quadrupled_edit_distance(word, candidate);
        const int allowed = std::max(4, static_cast<int>(4 * std::max(word.size(), candidate.size()) / 3));
        if (cost <= allowed && (!best || cost < best_cost)) {
            best = std::string(candidate);
            best_cost = cost;
        }
    }
    return best;
}

std::string did_you_mean(std::string_view word, const std::vector<std::string_view>& known, char quote) {
    if (const auto nearest = nearest_word(word, known)) return std::string("did you mean ") + quote + *nearest + quote + '?';
    std::string list;
    for (const auto& candidate : known) list += (list.empty() ? " " : ", ") + std::string(candidate);
    return "there are" + (list.empty() ? " none" : list);
}

}  // namespace fettle::core::files
