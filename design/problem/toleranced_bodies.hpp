// SPDX-License-Identifier: MIT
/// The bodies of a design as made, for clearances within tolerances (core/certificate/toleranced.hpp): its parts, poses, joints and
/// motions, as far as they follow from the numbers with a tolerance, are recorded as formulas of their deviations. deviating_places.hpp
/// says of every number of a scene whether it is.
///   as assembled   bodies are where the scene has them, or where motors and loops hold their joints at the start
///   over ranges    the joints' coordinates in their ranges as designed (core/clearance/looped_ranges.hpp); in closed loops those that
///                  others determine follow
///   over a motion  the joints' coordinates, and scripted bodies, where curves have them as made (core/clearance/driven_ranges.hpp)
/// Triangles, and everything that is decided while a part is drawn, are those of the base: the parts as designed, or, of limits that do not
/// contain 0, with deviations in the middle. At the ends of all tolerances the parts are drawn anew and compared.
#pragma once

#include <optional>
#include <vector>

#include "core/base/result.hpp"
#include "core/certificate/toleranced.hpp"
#include "core/clearance/looped_ranges.hpp"
#include "core/model/model.hpp"
#include "design/description/design.hpp"
#include "design/description/tolerance.hpp"

namespace fettle::design::problem {

/// Where the base is: 0 for each tolerance, or the middle of limits that do not contain it [SI].
VectorX base_of(const std::vector<description::Tolerance>& tolerances);

/// @param design  As made, of one scenario (description::design_of_scenario), without faults. @param model  At its base.
/// @param ranges  The ranges of the model; nothing: as assembled.
/// Errors, by name: all that deviating_places.hpp refuses (unsupported); parts whose vertices are no formulas (unsupported), that cannot be
/// made, or are made with other facets, at the ends of their tolerances; scripts that turn a body about its centre of mass, which deviates.
Result<core::certificate::Toleranced> toleranced_bodies(const description::Design& design,
                                                        const std::vector<description::Tolerance>& tolerances,
                                                        const core::model::Model& model,
                                                        const std::optional<core::clearance::LoopedRanges>& ranges);

}  // namespace fettle::design::problem
