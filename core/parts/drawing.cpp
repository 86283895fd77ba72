// SPDX-License-Identifier: MIT
#include "core/parts/drawing.hpp"

#include <string>
#include <utility>

namespace fettle::core::parts {

Drawing::Drawing(const Facets& default_facets, Structure kept, bool compares_counts)
    : facets(default_facets), kept_(std::move(kept)), compares_counts_(compares_counts) {}

// The one whose turn it is; null: none, or it is of something else.
const Decision* Drawing::kept_decision(const std::string& what) const {
    const std::size_t place = made_.decisions.size();
    return place < kept_.decisions.size() && kept_.decisions[place].what == what ? &kept_.decisions[place] : nullptr;
}

std::vector<int> Drawing::decision(const std::string& what, const std::function<bool(const std::vector<int>&)>& holds,
                                   const std::function<std::vector<int>()>& decide) {
    const Decision* kept = kept_decision(what);
    if (kept != nullptr && holds(kept->numbers)) {
        made_.decisions.push_back(*kept);
    } else {
        made_.decisions.push_back({what, decide()});
        if (kept != nullptr && kept->numbers != made_.decisions.back().numbers)
            changes_.push_back("the " + what + " could not be kept");
        else if (kept == nullptr && !kept_.decisions.empty())
            changes_.push_back("the " + what + " was not there before");
    }
    return made_.decisions.back().numbers;
}

int Drawing::count(const std::string& what, const std::function<int()>& choose) {
    const auto is_count = [](const std::vector<int>& numbers) { return numbers.size() == 1 && numbers[0] >= 1; };
    const Decision* kept = compares_counts_ ? kept_decision(what) : nullptr;
    if (kept != nullptr && is_count(kept->numbers))
        if (const int other = choose(); other != kept->numbers[0])
            other_counts_.push_back(what + ": " + std::to_string(other) + ", not " + std::to_string(kept->numbers[0]));
    return decision(what, is_count, [&] { return std::vector<int>{choose()}; })[0];
}

}  // namespace fettle::core::parts
