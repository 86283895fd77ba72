// SPDX-License-Identifier: MIT
/// Does a joint explain that the two bodies which it joins have material in common? A pin drawn as wide as its bore, or pressed into it,
/// does not hinder the joint, and is no fault of a drawing that has a joint in their place. A frame that goes through the wheel which it
/// carries is, and so is a pin in a part that has no bore, or one much too narrow.
///
/// A joint explains a shell that is round about its axis, facet by facet: all that bounds it is flat across the axis, or a facet of a
/// surface of revolution about it, in the body that it is from; a bore bounds it inside, it is no thicker than facets and press fits
/// make it (0.15 of its radius), and longer along the axis than thick across it, as a pin in its bore, and not as a shoulder that is sunk
/// into a face. A ball joint explains a shell that is round about its point, no thicker: facets of spheres about it, but for the facets of
/// a mouth or a neck that are round about one axis through the point and have less than half of the area. Fixed and planar joints explain
/// nothing.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/geometry/mesh.hpp"
#include "core/measure/frame.hpp"
#include "core/model/model.hpp"
#include "core/parts/common_part.hpp"

namespace fettle::core::model {

/// @param joint   where the joint is; its axis is z
/// @param common  what a and b have in common; all in one frame
bool explains(scene::JointKind kind, const measure::PlacedFrame& joint, const parts::CommonPart& common, const geometry::Mesh& a,
              const geometry::Mesh& b);

/// Names of the joints between two bodies; none of a model that was read from a trajectory, which has no joints.
std::vector<std::string> joints_between(const Model& model, int a, int b);

/// What two bodies that a joint joins have in common as they are assembled.
struct JoinedOverlap {
    double volume = 0;      ///< [m^3]; 0: nothing, or no more than faces that lie on each other
    bool explained = true;  ///< all of it, by joints between the two
};
/// Exact but for rounding. Errors: those of parts::common_part.
base::Result<JoinedOverlap> joined_overlap(const Model& model, int a, int b);

}  // namespace fettle::core::model
