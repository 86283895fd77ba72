// SPDX-License-Identifier: MIT
/// One body of the source paper's scene files (`rigid_bodies[i]`). The rest of the file: fixture_reader.hpp.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "fettle/core/files/json_document.hpp"
#include "fettle/core/scene/read_options.hpp"

namespace fettle::core::scene {

class FixtureBodies {
public:
    /// Both outlive this object.
    FixtureBodies(files::JsonDocument& document, const ReadOptions& options) : document_(document), options_(options) {}

    /// One body, or one per facet-connected component (`split_components`); none if it is switched off (`enabled`) or nothing useful can be
    /// read. Faults go to the document. @param timestep  [s], of the scene.
    std::vector<Body> read(const files::JsonNode& node, double timestep);

private:
    Body placed(const files::JsonNode& node);
    std::optional<geometry::Mesh> mesh(const files::JsonNode& node);
    std::optional<geometry::Mesh> mesh_file(const files::JsonNode& node, const std::string& name);
    std::optional<geometry::Mesh> inline_mesh(const files::JsonNode& node);

    files::JsonDocument& document_;
    const ReadOptions& options_;
    std::map<std::string, geometry::Mesh> files_;  ///< already read: scenes repeat one mesh many times
};

}  // namespace fettle::core::scene
