// SPDX-License-Identifier: MIT
/// The default of the barrier's stiffness.
#pragma once

#include "fettle/core/model/model.hpp"

namespace fettle::core::model {

/// Barrier stiffness [N/m] that needs no tuning: over the dynamic bodies, the largest of
///   0.1 m / h^2           inertia: a contact that stops the body within a step or so stays well conditioned beside m / h^2, and
///   4 m |g + f/m| / dhat  load: one contact at half the activation distance pushes with about 1.08 kappa dhat, so that the load is carried
///                         with room to spare. (Energy of a contact: kappa b(D) / (4 (dmin + dhat)^2), b = -(D - Dhat)^2 ln(D / Dhat).)
/// A quasi-static model with loads goes by these alone: h says nothing of its stiffness.
/// Area-weighted: per area, a fortieth of each body's surface [N/m^3].
/// 1 if there is no dynamic body: then nothing touches. A pure function of masses, forces, h, gravity and dhat.
double choose_kappa(const Model& model);

/// How many times stiffer than that contact becomes where it may adapt (docs/method/contact.md#stiffness-kappa), and is advised to be made:
/// against a motor, whose force nothing limits, no stiffness is enough.
inline constexpr double largest_kappa_rise = 1e4;

}  // namespace fettle::core::model
