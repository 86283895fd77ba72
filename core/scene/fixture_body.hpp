// SPDX-License-Identifier: MIT
/// One body of the source paper's scene files (`rigid_bodies[i]`). The rest of the file: fixture_reader.hpp.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "fettle/core/scene/scene_reader.hpp"

namespace fettle::core::scene {

/// Three numbers; two of them are a 2D scene, which is `unsupported`; more than three are cut.
std::optional<Vector3> fixture_vector(const JsonNode& node);

class FixtureBodies {
public:
    /// Both outlive this object.
    FixtureBodies(JsonDocument& document, const ReadOptions& options) : document_(document), options_(options) {}

    /// One body, or one per facet-connected component (`split_components`); none if it is switched off (`enabled`) or nothing useful can be
    /// read. Faults go to the document. @param timestep  [s], of the scene.
    std::vector<Body> read(const JsonNode& node, double timestep);

private:
    Body placed(const JsonNode& node);
    std::optional<geometry::Mesh> mesh(const JsonNode& node);
    std::optional<geometry::Mesh> mesh_file(const JsonNode& node, const std::string& name);
    std::optional<geometry::Mesh> inline_mesh(const JsonNode& node);

    JsonDocument& document_;
    const ReadOptions& options_;
    std::map<std::string, geometry::Mesh> files_;  ///< already read: scenes repeat one mesh many times
};

}  // namespace fettle::core::scene
