// SPDX-License-Identifier: MIT
#include "fettle/design/cli/clearance_folder.hpp"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "fettle/core/records/trajectory_io.hpp"
#include "fettle/design/answers/output_folder.hpp"
#include "fettle/design/answers/run_folder.hpp"
#include "fettle/design/cli/report_made.hpp"

namespace fettle::design::cli {

bool is_finite(const core::stepper::Trajectory& trajectory) {
    const auto finite = [](const auto& list, const auto& first, const auto& second) {
        return std::all_of(list.begin(), list.end(), [&](const auto& x) { return (x.*first).allFinite() && (x.*second).allFinite(); });
    };
    using core::kinematics::ChartPoint;
    using core::kinematics::Pose;
    for (const auto& poses : trajectory.poses)
        if (!finite(poses, &Pose::rotation, &Pose::position)) return false;
    for (const auto& step : trajectory.steps)
        for (const auto& node : step.nodes)
            if (!finite(node, &ChartPoint::position, &ChartPoint::rotation_vector)) return false;
    return true;
}

Errors write_folder(const ClearanceFolder& folder, report::Motion motion, const CommonOptions& common, Console& console,
                    nlohmann::ordered_json& answer, std::string& told) {
    if (folder.out.empty()) return {};
    if (!is_finite(motion.trajectory))
        return {{ErrorCode::not_finite, folder.out, "the path has numbers that are not finite: nothing is written"}};
    const std::filesystem::path file = std::filesystem::path(folder.out) / "trajectory.json";
    core::files::FilesTogether files;
    std::error_code ignored;
    if (std::filesystem::equivalent(folder.judged, file, ignored)) {
        answers::replace_answer(files, folder.out);
    } else {
        const std::string kept = answers::name_for_longer_run(file, motion.trajectory.steps.size());
        if (!kept.empty()) {
            console.narrate("warning: a longer run was there, which is kept as " + kept);
            files.keep_as(file, kept);
        }
        answers::replace_motion(files, folder.out);
        Errors errors = core::records::add_trajectory(files, file, motion.trajectory, motion.model, motion.scene_path);
        if (!errors.empty()) return errors;
    }
    answer["out"] = folder.out;
    Errors errors = answers::add_result(files, folder.out, answer, common.command);
    if (errors.empty()) errors = files.take_names();
    if (!errors.empty()) return errors;
    if (!folder.no_report) leave_report(folder.out, common, console, answer, told, {.motion = std::move(motion)});
    return {};
}

}  // namespace fettle::design::cli
