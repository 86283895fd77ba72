// SPDX-License-Identifier: MIT
#include "design/cli/inputs.hpp"

#include <algorithm>
#include <filesystem>

#include "core/base/parallel.hpp"
#include "design/cli/program_memory.hpp"

namespace fettle::design::cli {

reading::Programs programs_of(const CommonOptions& common) {
    return common.allow_programs ? reading::Programs::allowed : reading::Programs::refused;
}

reading::InputOptions input_options(const CommonOptions& common, bool check_start) {
    return {common.mesh_dirs, programs_of(common), common.strict, check_start, interrupted, common.scenario};
}

// While the file is read other threads are made, and memory for what it becomes.
void begin_to_read(const std::string& path) {
    constexpr std::uintmax_t growth = 64;                      // of a body's text to the body and a motion of some fifty steps
    constexpr std::uintmax_t least = 1 << 20, most = 8 << 20;  // bytes: the least that pays, and the most that is cleared before it is
                                                               // wanted
    std::error_code unreadable;
    const std::uintmax_t size = std::filesystem::file_size(path, unreadable);
    const std::uintmax_t bytes = unreadable ? 0 : std::min(most / growth, size) * growth;
    core::base::wake_threads(bytes >= least && core::base::thread_count() > 1 ? memory_ahead(bytes) : std::function<void()>());
}

Result<LoadedModel> load_model(const std::string& path, const CommonOptions& common, bool check_start) {
    begin_to_read(path);
    return reading::load_model(path, input_options(common, check_start));
}

Result<reading::DesignFile> open_design(const std::string& path, const CommonOptions& common) {
    return reading::open_design(path, input_options(common));
}

void tell_warnings(Console& console, const std::vector<std::string>& warnings, const std::string& file) {
    for (const std::string& warning : warnings) {
        console.narrate("warning: " + warning);
        console.found({file.empty() ? "the input" : file, CheckOutcome::remarked, "warning", warning, file});
    }
}

}  // namespace fettle::design::cli
