// SPDX-License-Identifier: MIT
/// Which files an assembly becomes in each format, and what is in them. Writing them is the caller's: a sink takes one after the other, so
/// that only one is in memory.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "design/exports/assembly.hpp"

namespace fettle::design::exports {

enum class Format { glb, threemf, stl, obj, vtu };

/// "glb", "3mf", "stl", "obj", "vtu".
const std::vector<std::string>& format_names();

enum class Arrangement {
    assembled,  ///< one file, every part where it is at the start
    plate,      ///< one file, parts side by side on z = 0, 5 mm apart, turned as in their own files: for a printer's bed
    parts       ///< a file for each part, in its own file's frame (ExportOptions::in_place: where it is at the start)
};
const std::vector<std::string>& arrangement_names();  ///< in the order of Arrangement

struct ExportOptions {
    Arrangement arrangement = Arrangement::assembled;  ///< of 3MF, STL, OBJ
    bool in_place = false;                             ///< of `parts`
    int every = 1;                                     ///< of VTU: a frame for every so many steps, and the last
};

/// Takes a file's name, relative to where the export goes, and its bytes.
using FileSink = std::function<Errors(const std::string& name, const std::string& bytes)>;

/// glb: STEM.glb. 3mf, stl: STEM.3mf, STEM.stl. obj: STEM.obj and STEM.mtl. vtu: STEM.pvd and STEM.vtu, or with a motion STEM_0000.vtu and
/// so on, one for each step's end. As `parts`: NAME.3mf and so on, of each part's name with what file names cannot hold as `_`.
/// Errors: of the sink; mesh_invalid (nothing that the format could hold), out_of_range (more than it can).
/// Contract: options.every > 0.
Errors export_files(const Assembly& assembly, Format format, const ExportOptions& options, const std::string& stem, const FileSink& sink);

/// Bound on how far a vertex of a 3MF, STL or OBJ file as `assembled` or `parts` lies from where the model has it [m]: decimal or float32
/// numbers, millimetres, frames that are shifted.
double export_rounding(const Assembly& assembly, Format format);

}  // namespace fettle::design::exports
