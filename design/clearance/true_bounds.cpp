// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>

#include "fettle/design/clearance/report.hpp"

namespace fettle::design::clearance {

namespace {

using core::clearance::PairClearance;
using core::geometry::Deviation;

// In the body's own frame, which is shifted from that of the drawing.
Deviation deviation_of(const core::model::Body& body) {
    Deviation out = body.mesh.deviation.value_or(Deviation{});
    const double shift = 0x1p-50 * (body.radius + body.reference_point.norm());
    out.out += shift;
    out.in += shift;
    return out;
}

}  // namespace

std::optional<TrueBounds> true_bounds(const Subject& subject, const ReportedPair& pair) {
    const bool is_apart = pair.finding != Finding::clash && pair.finding != Finding::touching && !pair.least.is_far;
    const std::vector<PairClearance> members = pair.members.empty() ? std::vector{pair.least} : pair.members;
    constexpr double infinity = std::numeric_limits<double>::infinity(), up = 1 + 0x1p-51;
    TrueBounds out{infinity, infinity, true, true};
    bool is_drawn = false;
    for (const PairClearance& member : members) {
        const core::model::Body &a = subject.model.bodies[member.a], &b = subject.model.bodies[member.b];
        is_drawn = is_drawn || a.mesh.deviation || b.mesh.deviation;
        if (!is_apart || !member.is_bounded) return std::nullopt;
        const Deviation da = deviation_of(a), db = deviation_of(b);
        out.lower = std::min(out.lower, std::max(0.0, std::nextafter(member.lower - up * (da.out + db.out), 0.0)));
        out.upper = std::min(out.upper, up * (member.upper + up * (da.in + db.in)));
        out.lower_is_proven = out.lower_is_proven && da.out_is_proven && db.out_is_proven;
        out.upper_is_proven = out.upper_is_proven && da.in_is_proven && db.in_is_proven;
    }
    if (!is_drawn) return std::nullopt;
    return out;
}

}  // namespace fettle::design::clearance
