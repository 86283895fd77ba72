// SPDX-License-Identifier: MIT
#include "core/energy/term.hpp"

#include <algorithm>
#include <utility>

namespace fettle::core::energy {

ContactForce& force_between(TermReport& report, int first, int second) {
    const std::pair<int, int> key = std::minmax(first, second);
    const auto at = std::lower_bound(report.contacts.begin(), report.contacts.end(), key,
                                     [](const ContactForce& f, const std::pair<int, int>& wanted) { return std::pair(f.a, f.b) < wanted; });
    if (at != report.contacts.end() && at->a == key.first && at->b == key.second) return *at;
    ContactForce force;
    force.a = key.first;
    force.b = key.second;
    return *report.contacts.insert(at, force);
}

}  // namespace fettle::core::energy
