// SPDX-License-Identifier: MIT
/// One body of our own scene files (`bodies[i]`). The rest of the file: scene_reader.hpp. Keys: scene.schema.json.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "core/files/json_document.hpp"
#include "core/mesh_files/mesh_reader.hpp"
#include "core/scene/read_options.hpp"
#include "core/scene_files/scene_formulas.hpp"

namespace fettle::core::scene_files {

using MaterialDensities = std::map<std::string, std::optional<expression::Number>>;  ///< of all materials, where stated [kg/m^3]

/// The name of a material that is listed; out_of_range with the nearest one otherwise.
std::optional<std::string> read_material_name(const files::JsonNode& node, const MaterialDensities& materials);

class SceneBodies {
public:
    /// All outlive this object. @param unit  of lengths [m].
    SceneBodies(files::JsonDocument& document, const scene::ReadOptions& options, double unit, const MaterialDensities& densities,
                SceneFormulas& formulas)
        : document_(document), options_(options), unit_(unit), densities_(densities), formulas_(formulas) {}

    /// One body, or one per solid of its mesh (`split_components`; solids/shells.hpp). Faults go to the document; values read after one are
    /// never used.
    std::vector<scene::Body> read(const files::JsonNode& node);

    /// Gives numbers to the groups that have names; after all bodies have been read.
    void number_groups(std::vector<scene::Body>& bodies) const;

private:
    void read_name(const files::JsonNode& node, scene::Body& body);
    /// File, metres of its unit, scale factors: what is the same in all is the same mesh.
    using MeshSource = std::tuple<std::string, double, std::array<double, 3>>;

    MeshSource read_geometry(const files::JsonNode& node, scene::Body& body);
    void settle_mesh(const files::JsonNode& node, const MeshSource& source, scene::Body& body);
    MeshSource read_mesh_file(const files::JsonNode& node, scene::Body& body);
    base::Result<geometry::Mesh> item_of_file(const std::string& file, const std::string& item, const mesh_files::MeshReadOptions& options);
    const std::vector<geometry::Mesh>& solids_of_file(const std::pair<std::string, double>& key, geometry::Mesh mesh);
    void make_shape(const files::JsonNode& node, scene::Body& body);
    void read_handled_mesh(const files::JsonNode& node, scene::ShapeSpec& spec);
    std::shared_ptr<const geometry::Mesh> mended_mesh(const files::JsonNode& node, MeshSource& source);
    void read_own_part(const files::JsonNode& node, scene::ShapeSpec& spec);
    void read_dimensions(const files::JsonNode& node, scene::ShapeSpec& spec);
    void read_inline(const files::JsonNode& node, scene::Body& body);
    void read_mass(const files::JsonNode& node, scene::Body& body);
    void read_inertial(const files::JsonNode& node, scene::Body& body);
    void read_group(const files::JsonNode& node, scene::Body& body);
    std::vector<scene::Body> components(const files::JsonNode& node, scene::Body body);
    void report(const base::Errors& errors, const files::JsonNode& node);

    files::JsonDocument& document_;
    const scene::ReadOptions& options_;
    double unit_;
    const MaterialDensities& densities_;
    SceneFormulas& formulas_;
    std::map<std::pair<std::string, double>, geometry::Mesh> files_;  ///< already read, by file and unit
    /// The same for files of which bodies take single items; with the chord and the tolerance that STEP is read with.
    std::map<std::tuple<std::string, double, double, double>, std::vector<geometry::Mesh>> items_;
    std::map<std::pair<std::string, double>, std::vector<geometry::Mesh>> solids_;  ///< of files_ of which bodies take single solids
    std::set<MeshSource> sound_;                                                    ///< nothing of them had to be mended
    std::set<std::string> names_;
    std::vector<std::string> group_names_;  ///< of group -2, -3, ... until number_groups
};

}  // namespace fettle::core::scene_files
