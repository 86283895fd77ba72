// SPDX-License-Identifier: MIT
/// Which deviations a clearance within tolerances can be asked over: one walk over the places of the scene that deviations move. Each kind
/// of place (core/scene/place.hpp) is recorded by toleranced_bodies.hpp, has nothing to do with where bodies are without dynamics, or is
/// refused by name; it depends on the question:
///                                   as assembled                    over ranges              over a prescribed motion
///   dimensions, positions, points   recorded                        recorded                 recorded
///   rotations                       recorded, of bodies without joints; else refused
///   axes, pitches                   refused
///   ratios                          refused where loops close       refused                  refused
///   limits of joints, springs       nothing                         refused                  nothing
///   curves of motors                refused where they decide the   nothing                  recorded of what moves as designed (one by
///                                   start                                                    one, or several at even speed); else refused
///   rates of scripted bodies        nothing                         refused with joints      recorded likewise
///   masses, loads, springs,
///   friction, velocities            nothing
/// Beside that, bodies that neither joints' ranges nor motors hold stand where the assembly puts them, least by mass: where deviations move
/// the joints away from the bodies as written, the deviations that do so are refused.
#pragma once

#include <optional>
#include <vector>

#include "core/base/result.hpp"
#include "core/clearance/looped_ranges.hpp"
#include "core/model/model.hpp"
#include "design/problem/deviating_numbers.hpp"

namespace fettle::design::problem {

/// What is refused. @param model  At the base of the numbers. @param ranges  The model's; nothing: a tree as assembled.
Errors refused_places(const DeviatingNumbers& numbers, const core::model::Model& model,
                      const std::optional<core::clearance::LoopedRanges>& ranges);

/// How far b's point is from a's along the ways that the joint slides, as the scene has the bodies, beyond what it is at the base; in a's
/// frame. Contract: no deviation turns the two.
Number3 written_slide(const DeviatingNumbers& numbers, const core::model::Model& model, const core::model::Joint& joint);

/// Do loops decide where the joint has this body?
bool is_unknown_of_loop(const core::clearance::LoopedRanges& ranges, int body);

}  // namespace fettle::design::problem
