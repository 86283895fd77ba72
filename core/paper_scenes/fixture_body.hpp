// SPDX-License-Identifier: MIT
/// One body of the source paper's scene files (`rigid_bodies[i]`). The rest of the file: fixture_reader.hpp.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <tuple>
#include <vector>

#include "core/files/json_document.hpp"
#include "core/scene/read_options.hpp"

namespace fettle::core::paper_scenes {

/// The unit that the density of a mesh is per, and whether its volume is odd.
struct MeshMass {
    scene::MassKind kind = scene::MassKind::volume;
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
    scene::Body body;
    MeshSource source;
};

class FixtureBodies {
public:
    /// Both outlive this object.
    FixtureBodies(files::JsonDocument& document, const scene::ReadOptions& options) : document_(document), options_(options) {}

    /// [element of `list`] One body, or one per solid of its mesh (`split_components`; solids/shells.hpp); none if it is switched off
    /// (`enabled`) or nothing useful can be read. Faults go to the document. Call fill() before this object goes.
    /// @param timestep  [s], of the scene.
    std::vector<std::vector<FixtureBody>> read(const files::JsonNode& list, double timestep);

    /// Gives bodies[i] the mesh of sources[i]: copies of many large meshes take longer than all the rest, and all threads.
    static void fill(std::vector<scene::Body>& bodies, const std::vector<MeshSource>& sources);

private:
    /// Scenes repeat one mesh many times: it is read once.
    struct MeshFile {
        geometry::Mesh mesh;
        base::Errors errors;                ///< it has none
        std::vector<std::string> warnings;  ///< of the mesh, reported where it is named first
        std::string where;                  ///< that place
    };
    struct Placed {
        scene::Body body;                           ///< without a mesh
        const geometry::Mesh* mesh = nullptr;       ///< as in the file; nullptr: none that is of use
        std::shared_ptr<const geometry::Mesh> own;  ///< that mesh, if it is the scene's own
        std::string file;                           ///< of its mesh; empty: the scene's own
        Vector3 factors = Vector3::Ones();
    };

    void read_mesh_files(const std::vector<files::JsonNode>& nodes);
    MeshFile read_mesh_file(const std::string& name, const std::string& where) const;

    // The rest runs on several threads at a time.
    std::vector<FixtureBody> read_body(const files::JsonNode& node, double timestep);
    Placed placed(const files::JsonNode& node) const;
    const geometry::Mesh* mesh_file(const files::JsonNode& node, const std::string& name) const;
    std::shared_ptr<const geometry::Mesh> inline_mesh(const files::JsonNode& node) const;
    MeshMass mass_of(const Placed& from, std::size_t part, const std::function<geometry::Mesh()>& mesh);

    files::JsonDocument& document_;
    const scene::ReadOptions& options_;
    std::map<std::string, MeshFile> files_;
    std::mutex masses_mutex_;
    /// By file, scale factors and component: what has been looked at.
    std::map<std::tuple<std::string, std::array<double, 3>, std::size_t>, MeshMass> masses_;
};

}  // namespace fettle::core::paper_scenes
