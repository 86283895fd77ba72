// SPDX-License-Identifier: MIT
/// A design or a scene, opened to be worked with.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/base/result.hpp"
#include "design/problem/design_problem.hpp"
#include "design/reading/model_file.hpp"

namespace fettle::design::session {

/// What the files say.
struct Opened {
    /// A scene's: the design that it stands for, with the scene's path.
    reading::DesignFile file;
    bool is_scene = false;
    std::string made_scene;  ///< text of the scene that meshes make; else empty
    std::shared_ptr<const problem::DesignProblem> problem;
    std::vector<std::string> warnings;  ///< of the files, the meshes and the start

    const description::Design& design() const { return problem->design(); }
    /// The parameters as the file has them, SI.
    VectorX values() const { return description::values_of(design().parameters); }
};

struct OpenOptions {
    reading::InputOptions inputs = {};
    // For mesh files (clearance::load_meshes):
    std::string unit = "auto";
    bool split = false;
};

/// Opens a design, or a scene as a design that wants nothing: its variables that are plain numbers are the parameters, from half to twice
/// their values (from -10 to 10 of the usual unit where that is 0). A mesh, a folder of them, a 3MF or a STEP file
/// is the scene that `fettle import --joints` makes of it, as assembled: its bodies, with the joints that their fits propose, without
/// limits; bodies that overlap there pass through each other, which a warning tells. Errors: as reading::open_design and
/// DesignProblem::create have them. Throws core::base::Stopped if `inputs.should_stop` said so.
Result<std::shared_ptr<const Opened>> open(const std::string& path, const OpenOptions& options);

/// Files of which it is asked now and then whether someone has written to them.
class WatchedFiles {
public:
    WatchedFiles() = default;
    /// @param begin  When they began to be read: what was written since counts as changed.
    WatchedFiles(const std::vector<std::string>& paths, std::filesystem::file_time_type begin);

    /// Since they were read, or since it was asked last.
    bool have_changed();

private:
    struct Stamp {
        std::filesystem::file_time_type time{};
        std::uintmax_t size = 0;
        bool operator==(const Stamp&) const = default;
    };
    static Stamp stamp_of(const std::filesystem::path& path);

    std::vector<std::pair<std::filesystem::path, Stamp>> files_;
};

/// The files that it was read from.
std::vector<std::string> paths_of(const Opened& opened);

}  // namespace fettle::design::session
