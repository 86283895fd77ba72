// SPDX-License-Identifier: MIT
/// A STEP file as solids in their places, by Open CASCADE's XCAF: assemblies, instances, mirrored places, units, names, colours.
#pragma once

#include <TopoDS_Solid.hxx>
#include <cstdint>
#include <functional>
#include <gp_Trsf.hxx>
#include <string>
#include <vector>

#include "core/step_importer/solid_mesh.hpp"

namespace fettle::core::step_importer {

/// A solid where one instance of its part has it.
struct PlacedSolid {
    std::string name;          ///< of its product; not unique
    int shape = 0;             ///< of StepContents::shapes
    gp_Trsf place;             ///< [mm]
    std::uint32_t colour = 0;  ///< 0x1RRGGBB; 0: none
};

struct StepContents {
    std::vector<TopoDS_Solid> shapes;  ///< each once, in its own frame
    std::vector<PlacedSolid> solids;   ///< in the order of the assembly
};

/// What becomes of each shape while the file is open, whose entities are named by the function.
using Visit = std::function<void(const StepContents&, const EntityOf&)>;

/// Throws Fault: what cannot be read, is no solid, or contains itself.
void read_step(const char* path, const Visit& visit);

}  // namespace fettle::core::step_importer
