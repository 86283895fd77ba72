// SPDX-License-Identifier: MIT
/// Reads the scene files of the source paper (key `rigid_body_problem`), and its saved simulations, which go on from their last state. What
/// a Scene cannot hold (2D) is an `unsupported` error that names the key. What is done differently from that format's own program, and
/// why: README.md beside this file.
#pragma once

#include "core/files/json_document.hpp"
#include "core/scene/read_options.hpp"

namespace fettle::core::paper_scenes {

/// Is this the root of such a file (or of a saved simulation, which holds its scene under `args`)?
bool is_fixture(const files::JsonNode& root);

/// `document` stays the owner of faults and warnings. @return the scene, or every fault.
base::Result<scene::Scene> read_fixture(files::JsonDocument& document, const scene::ReadOptions& options);

}  // namespace fettle::core::paper_scenes
