// SPDX-License-Identifier: MIT
/// How STEP files are read that a command names itself: `--facets` and `--surface-tolerance`. Those of scenes have keys of their own.
#pragma once

#include <string>

#include "core/base/result.hpp"
#include "core/mesh_files/mesh_reader.hpp"

namespace fettle::design::reading {

struct StepWishes {
    std::string facets, surface_tolerance;  ///< lengths with their units; empty: not given
};

/// Sets chord and surface_tolerance. Errors: no length, or not above 0.
Errors take_step_wishes(const StepWishes& wishes, core::mesh_files::MeshReadOptions& options);

}  // namespace fettle::design::reading
