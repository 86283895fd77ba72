// SPDX-License-Identifier: MIT
/// What `export` and `draw` show: parts and their motion, from any file or folder of this program, or meshes.
#pragma once

#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "design/clearance/read_subject.hpp"
#include "design/cli/command.hpp"
#include "design/exports/assembly.hpp"
#include "design/reading/step_wishes.hpp"

namespace fettle::design::cli {

struct ShownMotion {
    clearance::Subject subject;
    exports::Assembly assembly;  ///< of the subject, of the bodies that are shown
    std::vector<int> bodies;     ///< those of the subject that are shown, in its order
    std::string file;            ///< the one that was read: of a folder its trajectory
    std::string stem;            ///< a name for files made from it: "slider_crank"
    std::string certificate;     ///< the certificate whose path this is; empty: none
};

struct ShownOptions {
    std::string path;  ///< scene or design (as assembled), trajectory, certificate (its path), mesh, or a folder: trajectory.json of a run,
                       ///< of a killed one trajectory.running.json, else the meshes in it
    std::string unit;  ///< of meshes that state none
    bool split = false;  ///< of meshes: each solid is a body of its own
    reading::StepWishes step;
    std::string trajectory;  ///< of a certificate: its path; empty: beside it
    std::string bodies;      ///< names with commas: only these are shown; empty: all
    std::string up;          ///< "x", "-y", ...; empty: against gravity, Z where it is not known
};
/// Adds FILE, --bodies, --unit, --split, --facets, --surface-tolerance, --trajectory and --up.
void add_shown_options(CommandLine& app, ShownOptions& options);

/// Those of `bodies`' names that `wanted` ("crank,rod") lists, by their indices; all if it is empty. Errors: names that are not there, with
/// the nearest that is.
Result<std::vector<int>> shown_bodies(const std::string& wanted, const std::vector<std::string>& bodies);

/// The entries of these bodies in a list for all bodies.
template <class Each>
std::vector<Each> only(const std::vector<int>& bodies, const std::vector<Each>& of_all) {
    std::vector<Each> chosen;
    for (const int body : bodies) chosen.push_back(of_all[body]);
    return chosen;
}

/// Errors: of the files and the names of bodies; file_not_found (a folder with neither).
Result<ShownMotion> load_shown(const ShownOptions& options, const CommonOptions& common, Console& console);

}  // namespace fettle::design::cli
