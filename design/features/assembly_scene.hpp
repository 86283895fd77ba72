// SPDX-License-Identifier: MIT
/// Parts in place as a scene, with the joints that their fits propose and the limits that their shapes set: `fettle import --joints`.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/features/joint_proposals.hpp"
#include "design/clearance/mesh_parts.hpp"
#include "design/clearance/ranges_report.hpp"
#include "design/features/features_report.hpp"

namespace fettle::design::features {

struct AssemblyQuestion {
    std::string to;              ///< where the scene will stand: paths of meshes are as seen from there
    reading::StepWishes step{};  ///< are written into the bodies
    bool joints = false;         ///< false: bodies alone, all static
    bool limits = true;          ///< of the joints; false: they have none, which takes seconds where looking for them can take minutes
    std::string ground{};        ///< name of the body that stands; empty: the largest
    double density = 1240;       ///< of bodies that move [kg/m^3]
    std::vector<std::string> mesh_dirs{};
    std::function<void(const char* what, int done, int of)> on_progress = [](const char*, int, int) {};
    std::function<bool()> should_stop = [] { return false; };
};

struct AssemblyJoint {
    core::features::ProposedJoint proposed;
    std::string name;                          ///< "base-pin"
    std::string reason;                        ///< "pin.P1 in base.B1, base.B2; ..."
    std::optional<std::string> range{};        ///< clearance::range_sentence
    std::vector<std::string> limits{};         ///< "-3.2 deg", "112.41 deg"; empty: it has none, or they are not known
    std::optional<std::string> no_range = {};  ///< why the range is not known
};

struct AssemblyScene {
    std::string text;  ///< of the scene; empty where it was interrupted before the fits were known
    std::vector<std::string> grounds, unjoined;
    std::vector<AssemblyJoint> joints;
    bool interrupted = false;  ///< limits that were not known by then are missing
};

/// Errors: no body is called as the ground.
Result<AssemblyScene> assembly_scene(const clearance::MeshParts& parts, const AssemblyQuestion& question);

/// Keys: docs/interface.md.
nlohmann::ordered_json assembly_json(const AssemblyScene& scene, const core::model::Model& model);
std::string assembly_text(const AssemblyScene& scene, const core::model::Model& model);

}  // namespace fettle::design::features
