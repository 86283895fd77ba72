// SPDX-License-Identifier: MIT
#include "core/records/continuation.hpp"

#include <algorithm>

#include "core/energy/start_history.hpp"
#include "core/records/geometry_hash.hpp"

namespace fettle::core::records {
namespace {

// Names of the parts of the scene that are not what the checkpoint was written with.
std::string parts_that_differ(const std::vector<ScenePart>& stored, const model::Model& model) {
    std::string names;
    for (const ScenePart& part : scene_parts(model)) {
        const bool same =
            std::any_of(stored.begin(), stored.end(), [&](const ScenePart& was) { return was.name == part.name && was.hash == part.hash; });
        if (!same) names += (names.empty() ? "" : ", ") + part.name;
    }
    return names;
}

}  // namespace

base::Result<stepper::Simulation> resumable(const StoredTrajectory& stored, const model::Model& model) {
    const auto refuse = [&](const std::string& why) {
        return base::Error{base::ErrorCode::inconsistent, stored.path, "cannot be continued: " + why};
    };
    if (!stored.checkpoint) return refuse("it holds no checkpoint; trajectories that `fettle simulate` writes do");
    if (geometry_hash(stored.model) != geometry_hash(model)) return refuse("its bodies or meshes are not those of the scene");
    const std::string other = parts_that_differ(stored.checkpoint_scene, model);
    if (!other.empty()) return refuse("it is a run of another scene, which differs in: " + other);
    const energy::History wanted = energy::start_history(model), &found = stored.checkpoint->state.history;
    const std::size_t before = model.integrator == scene::Integrator::bdf2 && stored.checkpoint->step > 0 ? model.bodies.size() : 0;
    if (found.accelerations.size() != wanted.accelerations.size() || found.poses_before.size() != before ||
        found.velocities_before.size() != before)
        return refuse("its checkpoint is not one of the scene's integrator");
    stepper::Simulation out;
    out.trajectory = stored.trajectory;
    out.checkpoint = *stored.checkpoint;
    return out;
}

}  // namespace fettle::core::records
