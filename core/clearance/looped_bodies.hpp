// SPDX-License-Identifier: MIT
/// Bodies whose joints close loops, over the ranges of what drives these, as the record that bounds within tolerances are of
/// (certificate/toleranced.hpp): with no deviation at all. Its search and its checker close the loops over each box by Krawczyk's operator.
///
///     const auto looped = core::clearance::looped_ranges(model);
///     if (!looped) return 3;
///     const auto bodies = core::clearance::looped_bodies(model, *looped);
///     for (const auto& pair : core::clearance::certify(model, bodies, pairs, core::clearance::usual_options(pairs)))
///         std::printf("%s: from %g to %g m\n", core::clearance::to_string(pair.status), pair.lower, pair.upper);
#pragma once

#include "core/certificate/toleranced.hpp"
#include "core/clearance/looped_ranges.hpp"
#include "core/model/model.hpp"

namespace fettle::core::clearance {

/// @param looped  The model's own.
certificate::Toleranced looped_bodies(const model::Model& model, const LoopedRanges& looped);

}  // namespace fettle::core::clearance
