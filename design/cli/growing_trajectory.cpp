// SPDX-License-Identifier: MIT
#include "fettle/design/cli/growing_trajectory.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "fettle/design/cli/output_folder.hpp"

namespace fettle::design::cli {

namespace fs = std::filesystem;

std::string run_to_continue(const std::string& path) {
    std::error_code code;
    if (!fs::is_directory(path, code)) return path;
    const fs::path running = fs::path(path) / running_file;
    return (fs::exists(running, code) ? running : fs::path(path) / "trajectory.json").string();
}

GrowingTrajectory::GrowingTrajectory(const fs::path& folder, const core::model::Model& model, std::string scene_path)
    : file_(folder / running_file), model_(model), scene_path_(std::move(scene_path)) {
    std::error_code code;
    if (fs::exists(file_, code)) {
        const Result<std::string> kept = keep_longer_run(file_, 0);
        if (kept) kept_ = *kept;
    }
}

GrowingTrajectory::~GrowingTrajectory() {
    if (handle_ >= 0) ::close(handle_);
}

bool GrowingTrajectory::put(const std::string& text) {
    for (std::string_view left = text; !left.empty();) {
        const ssize_t written = ::write(handle_, left.data(), left.size());
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) return false;
        left.remove_prefix(static_cast<std::size_t>(written));
    }
    return true;
}

void GrowingTrajectory::write(const core::stepper::Simulation& so_far, Console& console) {
    if (failed_) return;
    std::string text;
    if (!lines_) {
        handle_ = ::open(file_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
        lines_ = std::make_unique<core::records::TrajectoryLines>(so_far.trajectory, model_);
        text = lines_->header(scene_path_);
    }
    for (; steps_ < so_far.trajectory.steps.size(); ++steps_) text += lines_->next_step();
    const bool passed = so_far.checkpoint.step != checkpoint_;
    if (passed) text += lines_->checkpoint(so_far.checkpoint);
    checkpoint_ = so_far.checkpoint.step;
    failed_ = handle_ < 0 || !put(text);
    if (!failed_ && passed) ::fdatasync(handle_);
    if (failed_)
        console.narrate("warning: " + file_.string() + " cannot be written (" + std::generic_category().message(errno) +
                        "): a run that is killed from here on leaves less");
}

void GrowingTrajectory::remove() {
    std::error_code ignored;
    fs::remove(file_, ignored);
    if (!kept_.empty()) fs::remove(kept_, ignored);
}

}  // namespace fettle::design::cli
