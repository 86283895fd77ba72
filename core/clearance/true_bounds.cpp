// SPDX-License-Identifier: MIT
#include "core/clearance/true_bounds.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fettle::core::clearance {

namespace {

using geometry::Deviation;

// In the body's own frame, which is shifted from that of the drawing.
Deviation deviation_of(const model::Body& body) {
    Deviation out = body.mesh.deviation.value_or(Deviation{});
    const double shift = 0x1p-50 * (body.radius + body.reference_point.norm());
    out.out += shift;
    out.in += shift;
    return out;
}

}  // namespace

std::optional<TrueBounds> true_bounds(const model::Model& model, std::span<const PairClearance> members) {
    constexpr double infinity = std::numeric_limits<double>::infinity(), up = 1 + 0x1p-51;
    TrueBounds out{infinity, infinity, true, true};
    bool is_drawn = false;
    for (const PairClearance& member : members) {
        const model::Body &a = model.bodies[member.a], &b = model.bodies[member.b];
        is_drawn = is_drawn || a.mesh.deviation || b.mesh.deviation;
        if (!member.is_bounded) return std::nullopt;
        const Deviation da = deviation_of(a), db = deviation_of(b);
        out.lower = std::min(out.lower, std::max(0.0, std::nextafter(member.lower - up * (da.out + db.out), 0.0)));
        out.upper = std::min(out.upper, up * (member.upper + up * (da.in + db.in)));
        out.lower_is_proven = out.lower_is_proven && da.out_is_proven && db.out_is_proven;
        out.upper_is_proven = out.upper_is_proven && da.in_is_proven && db.in_is_proven;
    }
    if (!is_drawn) return std::nullopt;
    return out;
}

std::optional<TrueBounds> true_bounds(const model::Model& model, const PairClearance& pair) {
    if (pair.is_clash() || pair.touch || pair.is_far) return std::nullopt;
    return true_bounds(model, std::span(&pair, 1));
}

std::optional<double> clash_of_facets(const model::Model& model, const PairClearance& pair) {
    if (!pair.is_clash() || !pair.overlap) return std::nullopt;
    double reach = 0;
    for (const int body : {pair.a, pair.b})
        if (const auto& deviation = model.bodies[body].mesh.deviation) reach += deviation->in;
    if (!(reach > 0) || pair.overlap->depth_lower > reach) return std::nullopt;
    return reach;
}

}  // namespace fettle::core::clearance
