// SPDX-License-Identifier: MIT
/// The default of the barrier's stiffness.
#pragma once

#include "core/model/model.hpp"

namespace fettle::core::model {

/// Barrier stiffness [N/m] that needs no tuning: over the dynamic bodies, the largest of
///   0.1 m / h^2           inertia: a contact that stops the body within a step or so stays well conditioned beside m / h^2, and
///   4 F / dhat            load: one contact at half the activation distance pushes with about 1.08 kappa dhat, so that the load is carried
///                         with room to spare. (Energy of a contact: kappa b(D) / (4 (dmin + dhat)^2), b = -(D - Dhat)^2 ln(D / Dhat).)
/// F is the sum of m |g + f/m|, point loads, the largest efforts of motors that are given by effort, and springs: the most that one has at
/// the start, at the stops of its coordinate, or strained by a quarter of its larger body's radius (angles: by a quarter of a radian).
/// Torques count as forces at the bodies' radii.
/// A quasi-static model with loads goes by these alone: h says nothing of its stiffness.
/// Area-weighted: per area, a fortieth of each body's surface [N/m^3].
/// 1 if there is no dynamic body: then nothing touches. A pure function of masses, loads, springs, h, gravity and dhat.
double choose_kappa(const Model& model);

/// The stiffness of the stops of joints and springs [N/m]: kappa; of an area-weighted barrier what kappa would be without areas.
/// Contract: kappa of the model is set.
double choose_stop_stiffness(const Model& model);

/// How many times stiffer than that contact becomes where it may adapt (docs/method/contact.md#stiffness-kappa), and is advised to be made:
/// against a motor, whose force nothing limits, no stiffness is enough.
inline constexpr double largest_kappa_rise = 1e4;

}  // namespace fettle::core::model
