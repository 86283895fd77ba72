// SPDX-License-Identifier: MIT
#include "core/clearance/true_bounds.hpp"

#include "design/clearance/report.hpp"

namespace fettle::design::clearance {

std::optional<core::clearance::TrueBounds> true_bounds(const Subject& subject, const ReportedPair& pair) {
    if (subject.domain.made()) return std::nullopt;  // facets are known for the base alone
    if (pair.finding == Finding::clash || pair.finding == Finding::touching || pair.least.is_far) return std::nullopt;
    return core::clearance::true_bounds(subject.model, pair.members.empty() ? std::span(&pair.least, 1) : std::span(pair.members));
}

}  // namespace fettle::design::clearance
