// SPDX-License-Identifier: MIT
/// Scenes, their own parts and designs to start from: those of examples/ and of design/cli/starters/, put into the program when it is
/// built.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace fettle::design::cli {

struct Starter {
    std::string name;                                        ///< "hinge"
    std::string description;                                 ///< the scene's own
    std::vector<std::pair<std::string, std::string>> files;  ///< name and text: "hinge.scene.json", part files, its design if there is one
};
/// Sorted by name.
const std::vector<Starter>& starters();

}  // namespace fettle::design::cli
