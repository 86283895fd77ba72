// SPDX-License-Identifier: MIT
/// Reader of ground-truth queries of continuous collision detection in their public formats.
///
/// CSV (Continuous-Collision-Detection/Sample-Queries and Sample-Scalable-CCD-Data): pairs on straight lines. No header, 8 rows a query,
/// each row a point `xn,xd,yn,yd,zn,zd[,truth]` of rational coordinates n/d. Rows, vertex-face: v f0 f1 f2 at t0, the same at t1;
/// edge-edge: ea0 ea1 eb0 eb1 at t0, the same at t1. truth, 0 or 1 and the same in all 8 rows: do the motions touch within [0, 1]? It is
/// either column 7 or an array of booleans in query order in STEM_mma_bool.json, beside the file or in ../mma_bool/ (column 7 wins).
/// Which kind of pair a file holds is said by its folder (vertex-face, edge-edge) or by the end of its name (vf, ee).
///
/// JSON (ipc-sim/rigid-ipc): one pair of moving rigid bodies, no truth:
///     {"type": "ee", "edge0": {B, "vertex0", "vertex1"}, "edge1": {B, ...}}
///     {"type": "fv", "face": {B, "vertex0", "vertex1", "vertex2"}, "vertex": {B, "vertex"}}
/// with B = "pose_t0": {"position", "rotation"}, "pose_t1": {...}; position and rotation vector [rad] are interpolated linearly.
/// Lengths count as metres.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "core/ccd/linear_ccd.hpp"
#include "core/kinematics/path.hpp"

namespace fettle::tests::support {

using core::geometry::PairType;
using core::geometry::PairVertices;

struct LinearQuery {
    PairType type = PairType::point_triangle;
    PairVertices t0, t1;
    std::optional<bool> truth;  ///< do the linear motions touch within [0, 1]?
};

struct RigidQuery {
    PairType type = PairType::point_triangle;
    core::kinematics::PathSegment a, b;  ///< base is the identity: the file's rotation vectors are interpolated as they stand; steps are
                                         ///< differences of the file's numbers, rounded
    PairVertices X;                      ///< order of curved_ccd
};

/// What one file holds.
struct CcdQueries {
    std::string path;
    std::vector<LinearQuery> linear;
    std::vector<RigidQuery> rigid;
};

/// One file, `.csv` or `.json`. Coordinates are exact where n, d and n/d are doubles (whatever the size of n and d), else the nearest
/// double but for 2^-11 of its last place.
/// @param type  of the pairs of a CSV file whose name does not say.
/// Errors: file_not_found, file_unreadable, parse, not_finite, inconsistent (rows, truth), wrong_type and missing_key of JSON, unsupported;
///         `where` is FILE:LINE, or file and JSON pointer.
Result<CcdQueries> read_ccd_queries(const std::string& path, const std::optional<PairType>& type = {});

/// Each path that is a folder replaced by the .csv and .json files below it, sorted, but for JSON that is an array (truth, boxes). Files of
/// truth (*_mma_bool.json) are passed over where they are named, too. Errors: file_not_found; a folder without any such file.
Result<std::vector<std::string>> find_ccd_query_files(const std::vector<std::string>& paths);

}  // namespace fettle::tests::support
