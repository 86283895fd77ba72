// SPDX-License-Identifier: MIT
#include "fettle/core/parts/drawing.hpp"

#include <utility>

namespace fettle::core::parts {

Drawing::Drawing(const Facets& default_facets, Structure kept) : facets(default_facets), kept_(std::move(kept)) {}

std::vector<int> Drawing::decision(const std::string& what, const std::function<bool(const std::vector<int>&)>& holds,
                                   const std::function<std::vector<int>()>& decide) {
    const std::size_t place = made_.decisions.size();
    const Decision* kept = place < kept_.decisions.size() && kept_.decisions[place].what == what ? &kept_.decisions[place] : nullptr;
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

}  // namespace fettle::core::parts
