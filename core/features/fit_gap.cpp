// SPDX-License-Identifier: MIT
#include "core/features/fit_gap.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/clearance/clearance.hpp"
#include "core/clearance/faces_alone.hpp"
#include "core/clearance/range_clearance.hpp"

namespace fettle::core::features {

namespace {

// Nothing of the rest matters: the pin's body and the hole's.
model::Model two_bodies(const model::Model& model, const Fit& fit) {
    model::Model two;
    two.bodies = {model.bodies[fit.pin.body], model.bodies[fit.hole.body]};
    two.diagonal = model.diagonal;
    two.length_unit = model.length_unit;
    return two;
}

double tolerance_of(const Fit& fit) {
    constexpr double fine = 1e-8, share = 1e-4;  // [m]; of the play
    return std::max(fine, share * std::abs(fit.play));
}

}  // namespace

std::vector<clearance::PairClearance> fit_gaps(const model::Model& model, const std::vector<Features>& parts, const std::vector<Fit>& fits,
                                               const std::function<bool()>& should_stop) {
    std::vector<clearance::PairClearance> out;
    for (const Fit& fit : fits) {
        const model::Model two = two_bodies(model, fit);
        const std::vector<clearance::PairRequest> pairs{{.a = 0, .b = 1}};
        clearance::ClearanceOptions options = clearance::usual_options(pairs, tolerance_of(fit));
        options.sample_nodes = false;
        options.should_stop = should_stop;
        const auto measured = [&](const std::vector<int>& hole) {
            const clearance::FacesAlone faces(two, {0, parts[fit.pin.body].features[fit.pin.feature].triangles}, {1, hole});
            return faces.in_whole(clearance::certify(faces.model(), clearance::as_assembled(faces.model()), pairs, options).front());
        };
        clearance::PairClearance gap = measured(parts[fit.hole.body].features[fit.hole.feature].triangles);
        if (gap.is_clash() &&
            !gap.intersecting) {  // a socket's facets are closed, and the ball is within them: then beside all of its part
            gap = measured({});
            gap.is_bounded = false;
            gap.upper = std::numeric_limits<double>::infinity();
        }
        gap.a = fit.pin.body;
        gap.b = fit.hole.body;
        out.push_back(std::move(gap));
    }
    return out;
}

std::vector<double> gaps_over_a_turn(const model::Model& model, const std::vector<Features>& parts, const std::vector<Fit>& fits,
                                     const std::function<bool()>& should_stop) {
    std::vector<double> out;
    for (const Fit& fit : fits) {
        out.push_back(0);
        const Feature &pin = parts[fit.pin.body].features[fit.pin.feature], &hole = parts[fit.hole.body].features[fit.hole.feature];
        if (pin.surface.kind != SurfaceKind::cylinder) continue;
        const clearance::FacesAlone faces(two_bodies(model, fit), {0, pin.triangles}, {1, hole.triangles});
        clearance::JointRanges ranges;
        constexpr double turn = 2 * std::numbers::pi;
        ranges.linkage.coordinates = {{.low = 0, .high = turn, .is_whole_turn = true, .joints = {{.joint = "turn", .is_angle = true}}}};
        ranges.linkage.bodies.resize(2);
        ranges.linkage.bodies[0].screws = {{.coordinate = 0, .point = pin.surface.point, .axis = pin.surface.axis, .turn = 1}};
        ranges.has_limits = {false};
        ranges.direction_of = {-1};
        ranges.joint_of = {0, -1};
        const std::vector<clearance::PairRequest> pairs{{.a = 0, .b = 1}};
        clearance::ClearanceOptions options = clearance::usual_options(pairs, tolerance_of(fit));
        options.should_stop = should_stop;
        const clearance::PairClearance found = clearance::certify(faces.model(), ranges, pairs, options).front();
        if (!found.is_clash() && found.is_bounded) out.back() = found.lower;
    }
    return out;
}

}  // namespace fettle::core::features
