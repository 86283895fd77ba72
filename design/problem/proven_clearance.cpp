// SPDX-License-Identifier: MIT
#include "design/problem/proven_clearance.hpp"

#include <cmath>
#include <optional>

#include "core/clearance/clearance.hpp"
#include "core/clearance/looped_ranges.hpp"
#include "core/clearance/toleranced_clearance.hpp"
#include "design/problem/toleranced_bodies.hpp"

namespace fettle::design::problem {

using core::clearance::LoopedRanges;
using core::clearance::PairClearance;

VectorX base_point(const description::MadeDesign& made, const VectorX& here) { return here + made.moved_by(base_of(made.tolerances)); }

Result<ProvenClearance> proven_clearance(const description::MadeDesign& made, const VectorX& here, const core::model::Model& model,
                                         const quantities::ClearanceRange& range, double tolerance) {
    description::Design design = made.design;
    for (int k = 0; k < count_of(design.parameters); ++k) design.parameters[k].value = here[k];
    std::optional<LoopedRanges> ranges;
    if (range.ranges || core::clearance::closes_loops(model)) {
        Result<LoopedRanges> found = core::clearance::looped_ranges(model, !range.ranges);
        if (!found) return found.errors();
        ranges = *std::move(found);
    }
    const auto bodies = toleranced_bodies(design, made.tolerances, model, ranges);
    if (!bodies) return bodies.errors();
    core::clearance::ClearanceOptions options;
    options.tolerance = tolerance;
    const PairClearance pair = core::clearance::certify(model, *bodies, {{range.a, range.b}}, options).front();
    const std::string names = "`" + model.bodies[range.a].name + "` and `" + model.bodies[range.b].name + "`";
    if (!std::isfinite(pair.upper)) return Error{ErrorCode::unsupported, names, "within the tolerances: " + pair.reason};
    ProvenClearance out{pair.lower, pair.upper, base_of(made.tolerances), {}};
    for (std::size_t k = 0; k < pair.deviations.size(); ++k) out.deviations[pair.deviations[k]] = pair.deviations_at[k];
    if (pair.intersecting)
        out.fault = names + " meet, made of some parts within the tolerances";
    else if (!core::certificate::are_apart(pair.solids))
        out.fault = "of " + names + ", within the tolerances: " + core::clearance::why_not_apart(pair.solids);
    return out;
}

}  // namespace fettle::design::problem
