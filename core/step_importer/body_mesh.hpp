// SPDX-License-Identifier: MIT
/// The mesh of a solid, and how far it is from it (docs/method/step.md): Open CASCADE's triangles, joined along the solid's edges by what
/// belongs to one edge, split where a bound is larger than is wanted.
#pragma once

#include <TopoDS_Solid.hxx>
#include <array>
#include <string>
#include <vector>

#include "core/step_importer/solid_mesh.hpp"

namespace fettle::core::step_importer {

struct MeshWishes {
    double chord = 0;              ///< [mm]: what triangles are split down to; 0: usual_chord() of the solid
    double surface_tolerance = 0;  ///< [mm]: the user's word for faces that no bound is known of; 0: these are refused
};

/// Two ten-thousandths of the diagonal of a box of this size, between 1 um and 0.1 mm [mm].
double usual_chord(double diagonal);

/// In millimetres, in the solid's own frame.
struct BodyMesh {
    std::vector<Vector3d> places;
    std::vector<std::array<int, 3>> triangles;  ///< counter-clockwise seen from outside
    std::vector<int> triangle_face;             ///< index of `face_names`
    std::vector<std::string> face_names;        ///< "cylinder 7": kind and number, from 1 in the order of the file
    /// As geometry::Deviation, as solids. Taken on the user's word: not proven.
    double out = 0, in = 0;
    bool is_proven = true;
    double declared = 0;  ///< share of both that rests on tolerances that the file's edges and vertices have
    /// What the gate allows (gate.hpp).
    double volume_allowance = 0, area_allowance = 0, largest = 0;
};

/// Throws Fault: a face without triangles, folded, or without a bound; a surface that is not closed.
BodyMesh mesh_of(const TopoDS_Solid& solid, const MeshWishes& wishes, const EntityOf& entity);

}  // namespace fettle::core::step_importer
