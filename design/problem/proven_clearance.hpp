// SPDX-License-Identifier: MIT
/// The least clearance of two bodies over all parts within the tolerances of a robust design, certified
/// (core/clearance/toleranced_clearance.hpp):
///   lower <= min over deviations d within their limits, and the joints' positions u, of dist(p + d, u) <= upper
/// Its derivative in the parameters p is that of the clearance of the worst parts, p + d* (envelope theorem): d* is a corner of the limits,
/// or the distance does not change with it there.
#pragma once

#include "core/base/result.hpp"
#include "core/model/model.hpp"
#include "design/description/made_design.hpp"
#include "design/quantities/clearance.hpp"

namespace fettle::design::problem {

struct ProvenClearance {
    double lower = 0, upper = 0;  ///< [m]
    VectorX deviations;           ///< d*, per tolerance; of those without influence where they are at the base
    std::string fault;            ///< the bodies meet for some parts, or nothing says that their solids are apart
};

/// Where the model is that proven_clearance wants: at base_of the tolerances (toleranced_bodies.hpp).
VectorX base_point(const description::MadeDesign& made, const VectorX& here);

/// @param here   Parameters as made, without a deviation. @param model  At base_point.
/// @param range  As assembled, or over the ranges, of whole bodies. @param tolerance  upper - lower wanted [m]
/// Errors: all that toleranced_bodies refuses; joints without ranges; what is undecided, with the reason.
Result<ProvenClearance> proven_clearance(const description::MadeDesign& made, const VectorX& here, const core::model::Model& model,
                                         const quantities::ClearanceRange& range, double tolerance);

}  // namespace fettle::design::problem
