// SPDX-License-Identifier: MIT
/// Is the mesh of the solid that the file describes? Volume, area, centroid and box of both are compared: the solid's are integrated over
/// its exact faces (Open CASCADE's BRepGProp), and know nothing of triangles.
#pragma once

#include <TopoDS_Solid.hxx>

#include "core/step_importer/body_mesh.hpp"

namespace fettle::core::step_importer {

/// Turns the mesh where the solid itself is inside out. Throws Fault: they differ by more than the mesh's deviation allows.
void check_against_solid(const TopoDS_Solid& solid, BodyMesh& mesh);

}  // namespace fettle::core::step_importer
