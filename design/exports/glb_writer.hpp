// SPDX-License-Identifier: MIT
/// An assembly and its motion as binary glTF 2.0 (.glb), which browsers, Blender and slicers show.
#pragma once

#include <string>

#include "design/exports/assembly.hpp"

namespace fettle::design::exports {

/// One file: metres, Y up. Nodes: a root "fettle", whose rotation takes the scene's up to Y; below it one node for each part, with its
/// name, its mesh (relative to its reference point; triangles, loose edges as lines, loose points as points) and a material of its colour.
/// With more than one keyframe one animation, "motion": for each part that moves a translation and a rotation sampler, LINEAR, one key for
/// each keyframe, times from 0. Numbers are float32 by definition: 6e-8 of a coordinate. No normals, so that viewers show flat faces.
/// Copies of a part share their vertices.
std::string glb_bytes(const Assembly& assembly);

}  // namespace fettle::design::exports
