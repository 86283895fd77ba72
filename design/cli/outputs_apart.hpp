// SPDX-License-Identifier: MIT
/// A file that is read is not written, and no file is written twice: told before the first is.
#pragma once

#include <string>
#include <vector>

#include "fettle/core/base/result.hpp"
#include "fettle/design/cli/session.hpp"

namespace fettle::design::cli {

/// The files that the options name, and what these read in turn: the scene of a design, meshes of a scene or a folder, a certificate's
/// path. Files are compared by what they are on the disk, under whatever names. Pipes and devices can take all that is written.
/// Errors: inconsistent, with both options.
[[nodiscard]] Errors check_outputs_apart(const Command& command, const std::vector<GivenValue>& given, const CommonOptions& common);

}  // namespace fettle::design::cli
