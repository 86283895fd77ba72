// SPDX-License-Identifier: MIT
/// The gap between a pin's facets and a hole's, as assembled, proven: core/clearance's certificate of these faces alone.
#pragma once

#include <functional>
#include <vector>

#include "core/clearance/pair_clearance.hpp"
#include "core/features/fits.hpp"
#include "core/model/model.hpp"

namespace fettle::core::features {

/// Per fit the bounds of the distance of its two features' facets where the bodies start. `parts`: of the model's bodies, in their order,
/// with triangles of their meshes. A hole whose facets are closed, such as a ball's socket, is taken with all of its part, which bounds the
/// gap from below alone (not is_bounded, upper infinite).
std::vector<clearance::PairClearance> fit_gaps(const model::Model& model, const std::vector<Features>& parts, const std::vector<Fit>& fits,
                                               const std::function<bool()>& should_stop = {});

/// Lower bounds of the same distances over a whole turn of the pin's part about the pin's axis, proven: clearance::certify. Fits of
/// balls have 0.
std::vector<double> gaps_over_a_turn(const model::Model& model, const std::vector<Features>& parts, const std::vector<Fit>& fits,
                                     const std::function<bool()>& should_stop = {});

}  // namespace fettle::core::features
