// SPDX-License-Identifier: MIT
/// Reader of the public ground-truth queries of continuous collision detection (../shared/ccd/README.md): for tests and benchmarks.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "fettle/core/contact/curved_ccd.hpp"

namespace fettle::tests {

struct LinearQuery {
    core::contact::PairType type = core::contact::PairType::point_triangle;
    core::contact::PairVertices t0, t1;
    std::optional<bool> truth;  ///< do the linear motions touch within [0, 1]?
};

/// A CSV file; the type is taken from its name (vf, ee) or its folder's (vertex-face, edge-edge); truth from column 7 or from the file
/// ../mma_bool/STEM_mma_bool.json beside it. Throws std::runtime_error on anything malformed.
std::vector<LinearQuery> read_linear_queries(const std::filesystem::path& file);

struct RigidQuery {
    core::contact::PairType type = core::contact::PairType::point_triangle;
    core::kinematics::PathSegment a, b;  ///< base is the identity: the files' rotation vectors are interpolated as they stand
    core::contact::PairVertices X;       ///< order of curved_ccd
};

/// One JSON file of a moving rigid pair.
RigidQuery read_rigid_query(const std::filesystem::path& file);

/// All files below `folder` that end in `extension`, sorted.
std::vector<std::filesystem::path> files_below(const std::filesystem::path& folder, const std::string& extension);

}  // namespace fettle::tests
