// SPDX-License-Identifier: MIT
#include "design/answers/growing_trajectory.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <string_view>
#include <system_error>
#include <utility>

#include "core/files/atomic_file.hpp"
#include "design/answers/output_folder.hpp"

namespace fettle::design::answers {

namespace fs = std::filesystem;

std::string run_to_continue(const std::string& path) {
    std::error_code code;
    if (!fs::is_directory(path, code)) return path;
    const fs::path running = fs::path(path) / running_file;
    return (fs::exists(running, code) ? running : fs::path(path) / "trajectory.json").string();
}

GrowingTrajectory::GrowingTrajectory(const fs::path& folder, const core::model::Model& model, std::string scene_path,
                                     const fs::path& continued)
    : file_(folder / running_file), model_(model), scene_path_(std::move(scene_path)) {
    std::error_code code;
    replaces_ = !continued.empty() && fs::equivalent(file_, continued, code);
}

GrowingTrajectory::~GrowingTrajectory() {
    if (handle_ >= 0) ::close(handle_);
}

// What was there stays until all of it, as far as it is gone on with, is in the new file.
Errors GrowingTrajectory::begin(const std::string& text) {
    core::files::FilesTogether files;
    if (const std::string kept = replaces_ ? "" : name_for_longer_run(file_, 0); !kept.empty()) files.keep_as(file_, kept);
    Errors errors = files.add(file_, lines_->header(scene_path_) + text);
    if (errors.empty()) errors = files.take_names();
    if (!errors.empty()) return errors;
    handle_ = ::open(file_.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC | O_NOFOLLOW);
    if (handle_ < 0) return {{ErrorCode::file_unwritable, file_.string(), std::generic_category().message(errno)}};
    return {};
}

std::string GrowingTrajectory::write(const core::stepper::Simulation& so_far) {
    if (failed_) return {};
    const bool first = !lines_;
    if (first) lines_ = std::make_unique<core::records::TrajectoryLines>(so_far.trajectory, model_);
    std::string text;
    for (std::size_t step = steps_; step < so_far.trajectory.steps.size(); ++step) text += lines_->next_step();
    const bool passed = so_far.checkpoint.step != checkpoint_;
    if (passed) text += lines_->checkpoint(so_far.checkpoint);
    checkpoint_ = so_far.checkpoint.step;
    std::string fault;
    if (first) {
        const Errors errors = begin(text);
        if (!errors.empty()) fault = errors.front().message;
    } else {
        std::string_view left = text;
        const int code = core::files::write_all(handle_, left);
        if (code != 0) fault = std::generic_category().message(code);
        if (code == 0 && passed) ::fdatasync(handle_);
    }
    steps_ = so_far.trajectory.steps.size();
    failed_ = !fault.empty();
    return failed_ ? file_.string() + ": " + fault : "";
}

void GrowingTrajectory::remove() {
    std::error_code ignored;
    if (lines_) fs::remove(file_, ignored);
}

}  // namespace fettle::design::answers
