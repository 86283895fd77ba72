// SPDX-License-Identifier: MIT
/// One body of the source paper's scene files (`rigid_bodies[i]`). The rest of the file: fixture_reader.hpp.
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <tuple>

#include "fettle/core/files/json_document.hpp"
#include "fettle/core/scene/read_options.hpp"

namespace fettle::core::scene {

/// What the density of a mesh is per, and what is odd about its volume.
struct MeshMass {
    MassKind kind = MassKind::volume;
    bool inside_out = false;  ///< its volume is not positive
    bool has_gaps = false;
};

class FixtureBodies {
public:
    /// Both outlive this object.
    FixtureBodies(files::JsonDocument& document, const ReadOptions& options) : document_(document), options_(options) {}

    /// One body, or one per facet-connected component (`split_components`); none if it is switched off (`enabled`) or nothing useful can be
    /// read. Faults go to the document. @param timestep  [s], of the scene.
    std::vector<Body> read(const files::JsonNode& node, double timestep);

private:
    struct Placed {
        Body body;
        std::string file;  ///< of its mesh; empty: the scene's own
        Vector3 factors = Vector3::Ones();
    };

    Placed placed(const files::JsonNode& node);
    std::optional<geometry::Mesh> mesh(const files::JsonNode& node);
    std::optional<geometry::Mesh> mesh_file(const files::JsonNode& node, const std::string& name);
    std::optional<geometry::Mesh> inline_mesh(const files::JsonNode& node);

    files::JsonDocument& document_;
    const ReadOptions& options_;
    MeshMass mass_of(const geometry::Mesh& mesh, const Placed& from, std::size_t part);

    std::map<std::string, geometry::Mesh> files_;  ///< already read: scenes repeat one mesh many times
    /// By file, scale factors and component: what has been looked at.
    std::map<std::tuple<std::string, std::array<double, 3>, std::size_t>, MeshMass> masses_;
};

}  // namespace fettle::core::scene
