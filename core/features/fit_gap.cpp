// SPDX-License-Identifier: MIT
#include "core/features/fit_gap.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/clearance/clearance.hpp"
#include "core/clearance/faces_alone.hpp"

namespace fettle::core::features {

std::vector<clearance::PairClearance> fit_gaps(const model::Model& model, const std::vector<Features>& parts, const std::vector<Fit>& fits,
                                               const std::function<bool()>& should_stop) {
    std::vector<clearance::PairClearance> out;
    for (const Fit& fit : fits) {
        model::Model two;  // nothing of the rest matters where the bodies start
        two.bodies = {model.bodies[fit.pin.body], model.bodies[fit.hole.body]};
        two.diagonal = model.diagonal;
        two.length_unit = model.length_unit;
        const std::vector<clearance::PairRequest> pairs{{.a = 0, .b = 1}};
        constexpr double fine = 1e-8, share = 1e-4;  // [m]; of the play
        clearance::ClearanceOptions options = clearance::usual_options(pairs, std::max(fine, share * std::abs(fit.play)));
        options.sample_nodes = false;
        options.should_stop = should_stop;
        const auto measured = [&](const std::vector<int>& hole) {
            const clearance::FacesAlone faces(two, {0, parts[fit.pin.body].features[fit.pin.feature].triangles}, {1, hole});
            return faces.in_whole(
                clearance::certify_clearance(faces.model(), clearance::as_assembled(faces.model()), pairs, options).front());
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

}  // namespace fettle::core::features
