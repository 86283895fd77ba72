// SPDX-License-Identifier: MIT
/// Which pin sits in which bore, which ball in which socket, as assembled: from the features' numbers alone; and the gap of the facets,
/// proven (fit_gap in core/features/fit_gap.hpp).
#pragma once

#include <vector>

#include "core/features/feature.hpp"

namespace fettle::core::features {

struct FeatureOf {
    int body = 0, feature = 0;
};

struct Fit {
    FeatureOf pin, hole;
    double play = 0;          ///< per side, by the surfaces: radius of the hole - radius of the pin [m]; negative: an interference fit
    double facets_play = 0;   ///< per side, by the facets: the hole's least distance from its axis - the pin's largest from its own [m]
    double off_centre = 0;    ///< the largest distance of the axes from each other over the length that both have, or of the centres [m]
    double lean = 0;          ///< between the axes [rad]
    double overlap = 0;       ///< length that both have; of a ball the pin's diameter [m]
    bool is_centred = false;  ///< off_centre is within what the features are known to
    bool is_held = false;     ///< the hole goes more than half round the pin: the round end of a slot, a groove do not; true of balls
};

struct FitLimits {
    double loosest = 0.25;   ///< play, as a share of the hole's radius: a pin in a box is no fit
    double tightest = 0.05;  ///< interference, as a share of it
};

/// Fits between features of different parts, all in one frame: bosses in holes about nearly the same axis, over a length that both have;
/// the pin's axis within the play, or the tolerance, of the hole's. Rounded edges make none. In the order of the pins, then of the holes.
std::vector<Fit> find_fits(const std::vector<Features>& parts, const FitLimits& limits = {});

}  // namespace fettle::core::features
