// SPDX-License-Identifier: MIT
/// The fits of a mechanism: pairs of bodies that contact keeps from both sides in some motion that joints and motors leave free, so that
/// they have play. A pin in a bore is one, a tongue in a groove, the teeth of two gears. A follower on a cam is none, since nothing
/// keeps it from behind, and neither are bodies whose joint leaves nothing that contact could stop.
///
/// With u_k the gradients of the gaps between two bodies, in the motions that are free: the contacts hold from both sides where forces
/// f_k >= 0 exist, not all 0, with sum f_k u_k = 0. The play is then sum f_k gap_k / sum f_k: half the way between two opposite sides,
/// wherever the bodies lie between them.
#pragma once

#include <optional>
#include <vector>

#include "core/model/model.hpp"
#include "core/stepper/trajectory.hpp"

namespace fettle::design::problem {

struct Fit {
    int a = 0, b = 0;  ///< bodies, a < b
    double play = 0;   ///< [m]
};

struct Fits {
    std::vector<Fit> fits;     ///< sorted by (a, b)
    double nearest_other = 0;  ///< least gap beyond dhat, within reach, of what is near and holds no fit; infinity if there is none [m]
    /// The median; 0 if there are none.
    double play() const;
};

/// Those of the bodies as assembled that are closer than fit_reach activation distances.
inline constexpr double fit_reach = 10;
Fits fits_of(const core::model::Model& model);

/// Two bodies that touch in the motion, closer than dhat where a motion that is free would change that, and are none of the fits: their
/// contact carries a load from one side. Nothing: there are none.
struct Touching {
    int a = 0, b = 0;
    int step = 0;  ///< at whose end
};
std::optional<Touching> touching_without_fit(const core::model::Model& model, const core::stepper::Trajectory& motion, const Fits& fits);

}  // namespace fettle::design::problem
