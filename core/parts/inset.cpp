// SPDX-License-Identifier: MIT
#include "core/parts/inset.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/units.hpp"
#include "core/parts/curve_geometry.hpp"
#include "core/parts/curve_meetings.hpp"
#include "core/parts/fault_words.hpp"

namespace fettle::core::parts {
namespace {

Error too_large(const Segment& segment, const Number& distance) {
    return {ErrorCode::out_of_range, segment.feature,
            "a chamfer or draft of " + millimetres(distance.value) + " is larger than " + quoted_curve(segment.feature) +
                ", which it is cut from: take a smaller one"};
}

bool is_smooth(const Curve& before, const Curve& after) {
    const Vector2 in = at(before, 1).velocity, out = at(after, 0).velocity;
    return std::abs(in.x() * out.y() - in.y() * out.x()) <= 1e-7 * in.norm() * out.norm() && in.dot(out) > 0;
}

}  // namespace

Result<Profile> inset(const Profile& profile, const Number& distance) {
    Profile out;
    for (const Loop& loop : profile.loops) {
        const std::size_t n = loop.segments.size();
        std::vector<Curve> moved;
        for (const Segment& segment : loop.segments) {
            auto curve = beside(segment.curve, distance);
            if (!curve) return too_large(segment, distance);
            moved.push_back(std::move(*curve));
        }
        if (n == 1) {
            out.loops.push_back({{{moved[0], loop.segments[0].feature, loop.segments[0].facets}}});
            continue;
        }
        std::vector<Cut> starts(n), ends(n);
        for (std::size_t k = 0; k < n; ++k) {
            const std::size_t next = (k + 1) % n;
            const Segment &a = loop.segments[k], &b = loop.segments[next];
            if (is_smooth(a.curve, b.curve)) {
                ends[k] = {1, 1, end_of(moved[k])};
                starts[next] = {0, 0, end_of(moved[k])};
                continue;
            }
            const double size = std::max(sampled_length(a.curve), sampled_length(b.curve));
            const Vector2 corner = value(end_of(a.curve));
            const Meeting* best = nullptr;
            const auto found = extended_meetings(moved[k], moved[next], 1e-9 * size);
            for (const Meeting& m : found)
                if (best == nullptr || (value(m.on_a.point) - corner).norm() < (value(best->on_a.point) - corner).norm()) best = &m;
            if (best == nullptr) return too_large(a, distance);
            ends[k] = best->on_a;
            starts[next] = best->on_b;
        }
        Loop around;
        for (std::size_t k = 0; k < n; ++k) {
            const Segment& segment = loop.segments[k];
            // A line's direction and an arc's turn must be what they were.
            const Curve curve = between(moved[k], starts[k], ends[k]);
            const Vector2 was = value(end_of(segment.curve)) - value(start_of(segment.curve)),
                          is = value(end_of(curve)) - value(start_of(curve));
            if (std::holds_alternative<Line>(curve) && !(was.dot(is) > 0)) return too_large(segment, distance);
            if (const auto* arc = std::get_if<Arc>(&segment.curve)) {
                const double before = std::abs(sweep_of(*arc).value), after = std::abs(sweep_of(std::get<Arc>(curve)).value);
                if (!(after > 0) || after > before + 3.2 || after > 6.28) return too_large(segment, distance);
            }
            around.segments.push_back({curve, segment.feature, segment.facets});
        }
        out.loops.push_back(std::move(around));
    }
    return out;
}

}  // namespace fettle::core::parts
