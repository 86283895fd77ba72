// SPDX-License-Identifier: MIT
// glTF 2.0, Khronos Group 2021: section 3 (JSON), 4.4 (GLB). Numbers of accessors, views and so on are indices into their lists.
#include "design/exports/glb_writer.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/base/version.hpp"
#include "core/files/json_dump.hpp"
#include "core/kinematics/rotation.hpp"

namespace fettle::design::exports {

namespace {

using Json = nlohmann::ordered_json;
using core::geometry::Mesh;
using core::kinematics::Pose;
using Quaternion = Eigen::Quaterniond;

constexpr int float_type = 5126, unsigned_type = 5125;                 // componentType
constexpr int points_mode = 0, lines_mode = 1, triangles_mode = 4;     // primitive mode
constexpr int vertex_target = 34962, index_target = 34963, none = -1;  // bufferView target

void append_word(std::string& out, std::uint32_t word) {
    for (int i = 0; i < 4; ++i, word >>= 8) out += static_cast<char>(word & 255);
}

void append_float(std::string& out, double x) { append_word(out, std::bit_cast<std::uint32_t>(static_cast<float>(x))); }

/// Viewers read sRGB colours as linear ones.
double linear_colour(unsigned char c) {
    const double x = c / 255.0;
    return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
}

Json rotation_json(const Quaternion& q) { return {q.x(), q.y(), q.z(), q.w()}; }

class GlbWriter {
public:
    explicit GlbWriter(const Assembly& assembly) : assembly_(assembly) {}

    std::string bytes() {
        json_["asset"] = {{"version", "2.0"}, {"generator", std::string("fettle ") + core::base::version()}};
        json_["scene"] = 0;
        json_["scenes"] = Json::array({{{"name", "fettle"}, {"nodes", Json::array({0})}}});
        json_["nodes"] = Json::array({root()});
        std::vector<const Mesh*> meshes;
        for (const AssemblyPart& part : assembly_.parts) meshes.push_back(&part.mesh);
        const std::vector<std::size_t> shapes = core::geometry::first_of_shape(meshes);
        for (std::size_t i = 0; i < shapes.size(); ++i) add_part(assembly_.parts[i], shapes[i]);
        if (assembly_.keyframes.size() > 1) add_motion();
        if (!json_.contains("accessors")) return with_header();
        json_["buffers"] = Json::array({{{"byteLength", binary_.size()}}});
        return with_header();
    }

private:
    Json root() const {
        Json node{{"name", "fettle"}};
        const Quaternion turn = core::kinematics::turn_between(assembly_.up, Vector3::UnitY());
        node["rotation"] = rotation_json(turn);
        node["children"] = Json::array();
        for (std::size_t i = 0; i < assembly_.parts.size(); ++i) node["children"].push_back(i + 1);
        if (assembly_.parts.empty()) node.erase("children");
        return node;
    }

    int add_view(std::size_t begin, int target) {
        Json view{{"buffer", 0}, {"byteOffset", begin}, {"byteLength", binary_.size() - begin}};
        if (target != none) view["target"] = target;
        json_["bufferViews"].push_back(std::move(view));
        return static_cast<int>(json_["bufferViews"].size()) - 1;
    }

    int add_accessor(int view, int component, const char* type, std::size_t count) {
        json_["accessors"].push_back({{"bufferView", view}, {"componentType", component}, {"count", count}, {"type", type}});
        return static_cast<int>(json_["accessors"].size()) - 1;
    }

    int add_positions(const Mesh& mesh) {
        const std::size_t begin = binary_.size();
        for (const double x : mesh.vertices.reshaped()) append_float(binary_, x);
        const int accessor =
            add_accessor(add_view(begin, vertex_target), float_type, "VEC3", static_cast<std::size_t>(mesh.vertices.cols()));
        // As stored: a bound in double precision may lie inside.
        const auto bound = [](const Vector3& x) {
            return Json{static_cast<float>(x[0]), static_cast<float>(x[1]), static_cast<float>(x[2])};
        };
        json_["accessors"][accessor]["min"] = bound(mesh.vertices.rowwise().minCoeff());
        json_["accessors"][accessor]["max"] = bound(mesh.vertices.rowwise().maxCoeff());
        return accessor;
    }

    int add_indices(const std::vector<int>& indices) {
        const std::size_t begin = binary_.size();
        for (const int index : indices) append_word(binary_, static_cast<std::uint32_t>(index));
        return add_accessor(add_view(begin, index_target), unsigned_type, "SCALAR", indices.size());
    }

    /// Edges of no triangle stand after the others in the mesh's list.
    static std::vector<int> loose_edges(const Mesh& mesh) {
        Mesh bare;
        bare.vertices = mesh.vertices;
        bare.triangles = mesh.triangles;
        core::geometry::build_connectivity(bare);
        std::vector<int> ends;
        for (std::size_t e = bare.edges.size(); e < mesh.edges.size(); ++e)
            ends.insert(ends.end(), mesh.edges[e].begin(), mesh.edges[e].end());
        return ends;
    }

    /// Vertices and indices; materials are the part's own.
    Json primitives_of(const Mesh& mesh) {
        const int positions = add_positions(mesh);
        std::vector<int> corners;
        for (const auto& t : mesh.triangles) corners.insert(corners.end(), t.begin(), t.end());
        Json list = Json::array();
        for (const auto& [mode, indices] : {std::pair<int, std::vector<int>>{triangles_mode, corners},
                                            {lines_mode, loose_edges(mesh)},
                                            {points_mode, mesh.codimensional_points}}) {
            if (indices.empty()) continue;
            list.push_back({{"attributes", {{"POSITION", positions}}}, {"indices", add_indices(indices)}, {"mode", mode}});
        }
        return list;
    }

    int add_material(const AssemblyPart& part) {
        const Json colour{linear_colour(part.colour[0]), linear_colour(part.colour[1]), linear_colour(part.colour[2]), 1.0};
        json_["materials"].push_back(
            {{"name", part.name},
             {"pbrMetallicRoughness", {{"baseColorFactor", colour}, {"metallicFactor", 0.0}, {"roughnessFactor", 0.7}}}});
        return static_cast<int>(json_["materials"].size()) - 1;
    }

    /// @param shape  the first part of the same
    void add_part(const AssemblyPart& part, std::size_t shape) {
        primitives_.emplace_back();
        if (shape + 1 == primitives_.size() && part.mesh.vertices.cols() > 0) primitives_.back() = primitives_of(part.mesh);
        Json primitives = primitives_[shape];
        const Pose& pose = assembly_.keyframes.front().poses[json_["nodes"].size() - 1];
        Json node{{"name", part.name},
                  {"translation", {pose.position[0], pose.position[1], pose.position[2]}},
                  {"rotation", rotation_json(Quaternion(pose.rotation).normalized())}};
        if (!primitives.empty()) {
            const int material = add_material(part);
            for (Json& primitive : primitives) primitive["material"] = material;
            json_["meshes"].push_back({{"name", part.name}, {"primitives", std::move(primitives)}});
            node["mesh"] = json_["meshes"].size() - 1;
        }
        json_["nodes"].push_back(std::move(node));
    }

    /// Times from 0, as float32, strictly increasing as the format wants them.
    int add_times() {
        const std::size_t begin = binary_.size();
        float last = -1;
        for (const Keyframe& key : assembly_.keyframes) {
            const auto time = static_cast<float>(key.time - assembly_.keyframes.front().time);
            last = time > last ? time : std::nextafter(last, std::numeric_limits<float>::infinity());
            append_word(binary_, std::bit_cast<std::uint32_t>(last));
        }
        const int accessor = add_accessor(add_view(begin, none), float_type, "SCALAR", assembly_.keyframes.size());
        json_["accessors"][accessor]["min"] = Json::array({0.0F});
        json_["accessors"][accessor]["max"] = Json::array({last});
        return accessor;
    }

    int add_translations(std::size_t part) {
        const std::size_t begin = binary_.size();
        for (const Keyframe& key : assembly_.keyframes)
            for (const double x : key.poses[part].position) append_float(binary_, x);
        return add_accessor(add_view(begin, none), float_type, "VEC3", assembly_.keyframes.size());
    }

    /// Each on the side of the one before it, so that the way between them is the shorter one.
    int add_rotations(std::size_t part) {
        const std::size_t begin = binary_.size();
        Quaternion last = Quaternion::Identity();
        for (const Keyframe& key : assembly_.keyframes) {
            Quaternion q = Quaternion(key.poses[part].rotation).normalized();
            if (q.dot(last) < 0) q.coeffs() *= -1;
            for (const double x : {q.x(), q.y(), q.z(), q.w()}) append_float(binary_, x);
            last = q;
        }
        return add_accessor(add_view(begin, none), float_type, "VEC4", assembly_.keyframes.size());
    }

    void add_motion() {
        const int times = add_times();
        Json samplers = Json::array(), channels = Json::array();
        const auto add = [&](std::size_t part, int values, const char* path) {
            channels.push_back({{"sampler", samplers.size()}, {"target", {{"node", part + 1}, {"path", path}}}});
            samplers.push_back({{"input", times}, {"output", values}, {"interpolation", "LINEAR"}});
        };
        for (std::size_t i = 0; i < assembly_.parts.size(); ++i) {
            if (!assembly_.parts[i].moves) continue;
            add(i, add_translations(i), "translation");
            add(i, add_rotations(i), "rotation");
        }
        if (channels.empty()) return;
        json_["animations"] = Json::array({{{"name", "motion"}, {"samplers", std::move(samplers)}, {"channels", std::move(channels)}}});
    }

    std::string with_header() {
        std::string text = core::files::dumped(json_);
        text.resize((text.size() + 3) / 4 * 4, ' ');
        binary_.resize((binary_.size() + 3) / 4 * 4, '\0');
        const std::size_t total = 12 + 8 + text.size() + (binary_.empty() ? 0 : 8 + binary_.size());
        std::string out;
        out.reserve(total);
        out += "glTF";
        append_word(out, 2);
        append_word(out, static_cast<std::uint32_t>(total));
        append_word(out, static_cast<std::uint32_t>(text.size()));
        out += "JSON" + text;
        if (binary_.empty()) return out;
        append_word(out, static_cast<std::uint32_t>(binary_.size()));
        return out.append("BIN\0", 4).append(binary_);
    }

    const Assembly& assembly_;
    Json json_;
    std::string binary_;
    std::vector<Json> primitives_;  // per part; filled of the first of its shape
};

}  // namespace

std::string glb_bytes(const Assembly& assembly) { return GlbWriter(assembly).bytes(); }

}  // namespace fettle::design::exports
