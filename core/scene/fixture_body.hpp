// SPDX-License-Identifier: MIT
/// One body of the source paper's scene files (`rigid_bodies[i]`). The rest of the file: fixture_reader.hpp.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "fettle/core/files/json_document.hpp"
#include "fettle/core/scene/read_options.hpp"

namespace fettle::core::scene {

/// What the density of a mesh is per, and what is odd about its volume.
struct MeshMass {
    MassKind kind = MassKind::volume;
    bool inside_out = false;  ///< its volume is not positive
    bool has_gaps = false;
};

/// A mesh that is still to be made.
struct MeshSource {
    const geometry::Mesh* mesh = nullptr;  ///< nullptr: the body has its mesh
    Vector3 factors = Vector3::Ones();     ///< to scale it by
    bool turned = false;                   ///< with its triangles turned
};

struct FixtureBody {
    Body body;
    MeshSource source;
};

class FixtureBodies {
public:
    /// Both outlive this object.
    FixtureBodies(files::JsonDocument& document, const ReadOptions& options) : document_(document), options_(options) {}

    /// One body, or one per facet-connected component (`split_components`); none if it is switched off (`enabled`) or nothing useful can be
    /// read. Faults go to the document. Call fill() before this object goes. @param timestep  [s], of the scene.
    std::vector<FixtureBody> read(const files::JsonNode& node, double timestep);

    /// Gives bodies[i] the mesh of sources[i]: copies of many large meshes take longer than all the rest, and all threads.
    static void fill(std::vector<Body>& bodies, const std::vector<MeshSource>& sources);

private:
    struct Placed {
        Body body;                             ///< without a mesh
        const geometry::Mesh* mesh = nullptr;  ///< as in the file; nullptr: none that is of use
        std::string file;                      ///< of its mesh; empty: the scene's own
        Vector3 factors = Vector3::Ones();
    };

    Placed placed(const files::JsonNode& node);
    const geometry::Mesh* mesh(const files::JsonNode& node);
    const geometry::Mesh* mesh_file(const files::JsonNode& node, const std::string& name);
    const geometry::Mesh* inline_mesh(const files::JsonNode& node);

    files::JsonDocument& document_;
    const ReadOptions& options_;
    MeshMass mass_of(const Placed& from, std::size_t part, const std::function<geometry::Mesh()>& mesh);

    std::map<std::string, geometry::Mesh> files_;  ///< already read: scenes repeat one mesh many times
    geometry::Mesh inline_;                        ///< of the body at hand
    /// By file, scale factors and component: what has been looked at.
    std::map<std::tuple<std::string, std::array<double, 3>, std::size_t>, MeshMass> masses_;
};

}  // namespace fettle::core::scene
