// SPDX-License-Identifier: MIT
/// What `export` and `draw` show: parts and their motion, from any file or folder of this program, or meshes.
#pragma once

#include <string>
#include <vector>

#include "fettle/core/base/result.hpp"
#include "fettle/design/clearance/read_subject.hpp"
#include "fettle/design/cli/session.hpp"
#include "fettle/design/exports/assembly.hpp"

namespace fettle::design::cli {

struct ShownMotion {
    clearance::Subject subject;
    exports::Assembly assembly;  ///< of the subject
    std::string file;            ///< the one that was read: of a folder its trajectory
    std::string stem;            ///< a name for files made from it: "slider_crank"
    std::string certificate;     ///< the certificate whose path this is; empty: none
};

struct ShownOptions {
    std::string path;  ///< scene or design (as assembled), trajectory, certificate (its path), mesh, or a folder: trajectory.json of a run,
                       ///< of a killed one trajectory.running.json, else the meshes in it
    std::string unit;  ///< of meshes that state none
    std::string trajectory;  ///< of a certificate: its path; empty: beside it
    std::string up;          ///< "x", "-y", ...; empty: against gravity, Z where it is not known
};
/// Adds FILE, --unit, --trajectory and --up.
void add_shown_options(CommandLine& app, ShownOptions& options);

/// Errors: of the files; file_not_found (a folder with neither).
Result<ShownMotion> load_shown(const ShownOptions& options, const CommonOptions& common, Console& console);

}  // namespace fettle::design::cli
