// SPDX-License-Identifier: MIT
#include "design/exports/export_files.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/base/contract.hpp"
#include "core/files/unique_names.hpp"
#include "design/exports/glb_writer.hpp"
#include "design/exports/vtk_writer.hpp"

namespace fettle::design::exports {

namespace {

using core::geometry::Mesh;
using core::mesh_files::MeshPart;

constexpr double plate_gap = 0.005;  // [m]

std::vector<Mesh> file_meshes(const Assembly& assembly) {
    std::vector<Mesh> meshes;
    for (const AssemblyPart& part : assembly.parts) meshes.push_back(file_mesh(part));
    return meshes;
}

/// In their own frames.
std::vector<MeshPart> own_parts(const Assembly& assembly, const std::vector<Mesh>& meshes) {
    std::vector<MeshPart> parts;
    for (std::size_t i = 0; i < meshes.size(); ++i)
        parts.push_back({assembly.parts[i].name, &meshes[i], assembly.parts[i].colour, Matrix3::Identity(), Vector3::Zero()});
    return parts;
}

void assemble(const Assembly& assembly, std::vector<MeshPart>& parts) {
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const core::kinematics::Pose pose = file_pose(assembly.parts[i], assembly.keyframes.front().poses[i]);
        parts[i].rotation = pose.rotation;
        parts[i].position = pose.position;
    }
}

/// Shelves along x, the deepest parts first; about as wide as deep.
void lay_out(std::vector<MeshPart>& parts) {
    std::vector<Vector3> low(parts.size()), size(parts.size());
    double area = 0, widest = 0;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        if (parts[i].mesh->vertices.cols() == 0) continue;
        low[i] = parts[i].mesh->vertices.rowwise().minCoeff();
        size[i] = parts[i].mesh->vertices.rowwise().maxCoeff() - low[i];
        area += (size[i].x() + plate_gap) * (size[i].y() + plate_gap);
        widest = std::max(widest, size[i].x());
    }
    std::vector<std::size_t> order(parts.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return size[a].y() > size[b].y(); });
    const double width = std::max(widest, 1.2 * std::sqrt(area));
    double x = 0, y = 0, depth = 0;
    for (const std::size_t i : order) {
        if (x > 0 && x + size[i].x() > width) {
            y += depth + plate_gap;
            x = depth = 0;
        }
        parts[i].position = Vector3(x, y, 0) - low[i];
        x += size[i].x() + plate_gap;
        depth = std::max(depth, size[i].y());
    }
}

Errors write_meshes(const std::vector<MeshPart>& parts, Format format, const std::string& stem, const FileSink& sink) {
    if (format == Format::stl) {
        const bool empty = std::all_of(parts.begin(), parts.end(), [](const MeshPart& part) { return part.mesh->triangles.empty(); });
        if (empty) return {{ErrorCode::mesh_invalid, stem, "no part has a triangle, so there is nothing that an STL file could hold"}};
        return sink(stem + ".stl", core::mesh_files::stl_bytes(parts));
    }
    if (format == Format::obj) {
        Errors errors = sink(stem + ".obj", core::mesh_files::obj_text(parts, stem + ".mtl"));
        return errors.empty() ? sink(stem + ".mtl", core::mesh_files::mtl_text(parts)) : errors;
    }
    const Result<std::string> bytes = core::mesh_files::threemf_bytes(parts);
    return bytes ? sink(stem + ".3mf", *bytes) : bytes.errors();
}

Errors export_meshes(const Assembly& assembly, Format format, const ExportOptions& options, const std::string& stem, const FileSink& sink) {
    const std::vector<Mesh> meshes = file_meshes(assembly);
    std::vector<MeshPart> parts = own_parts(assembly, meshes);
    if (options.arrangement == Arrangement::assembled || options.in_place) assemble(assembly, parts);
    if (options.arrangement == Arrangement::plate) lay_out(parts);
    if (options.arrangement != Arrangement::parts) return write_meshes(parts, format, stem, sink);
    core::files::UniqueNames stems("_", true);
    for (const MeshPart& part : parts) {
        const std::string own_stem = stems.unique(core::files::file_stem(part.name));
        if (part.mesh->triangles.empty() && format != Format::obj) continue;
        Errors errors = write_meshes({part}, format, own_stem, sink);
        if (!errors.empty()) return errors;
    }
    return {};
}

Errors export_frames(const Assembly& assembly, const ExportOptions& options, const std::string& stem, const FileSink& sink) {
    std::vector<std::size_t> chosen;
    int step = 0;
    for (std::size_t k = 0; k < assembly.keyframes.size(); ++k) {
        if (!assembly.keyframes[k].ends_step) continue;
        const bool last = k + 1 == assembly.keyframes.size();
        if (step++ % options.every == 0 || last) chosen.push_back(k);
    }
    std::vector<std::pair<double, std::string>> frames;
    for (std::size_t i = 0; i < chosen.size(); ++i) {
        std::string number = std::to_string(i);
        number.insert(0, number.size() < 4 ? 4 - number.size() : 0, '0');
        const Keyframe& key = assembly.keyframes[chosen[i]];
        const std::string name = stem + (chosen.size() > 1 ? "_" + number : "") + ".vtu";
        frames.emplace_back(key.time, name);
        Errors errors = sink(name, vtu_bytes(assembly, key));
        if (!errors.empty()) return errors;
    }
    return sink(stem + ".pvd", pvd_text(frames));
}

}  // namespace

const std::vector<std::string>& format_names() {
    static const std::vector<std::string> names{"glb", "3mf", "stl", "obj", "vtu"};
    return names;
}

const std::vector<std::string>& arrangement_names() {
    static const std::vector<std::string> names{"assembled", "plate", "parts"};
    return names;
}

Errors export_files(const Assembly& assembly, Format format, const ExportOptions& options, const std::string& stem, const FileSink& sink) {
    FETTLE_ASSERT(options.every > 0, "a frame for every 0 steps");
    if (format == Format::glb) return sink(stem + ".glb", glb_bytes(assembly));
    if (format == Format::vtu) return export_frames(assembly, options, stem, sink);
    return export_meshes(assembly, format, options, stem, sink);
}

double export_rounding(const Assembly& assembly, Format format) {
    // Shifted by c and back, to millimetres and back, turned, shifted: fewer than 16 roundings of numbers no larger than these.
    constexpr double unit_roundoff = 0x1p-53;
    double largest = 0;
    for (std::size_t i = 0; i < assembly.parts.size(); ++i) {
        const AssemblyPart& part = assembly.parts[i];
        const double radius = part.mesh.vertices.cols() == 0 ? 0 : part.mesh.vertices.colwise().norm().maxCoeff();
        largest = std::max(largest, radius + 2 * part.reference_point.norm() + assembly.keyframes.front().poses[i].position.norm());
    }
    const double rounding = 16 * unit_roundoff * 3 * largest;
    if (format != Format::stl) return rounding;
    const std::vector<Mesh> meshes = file_meshes(assembly);
    std::vector<MeshPart> parts = own_parts(assembly, meshes);
    const double own = core::mesh_files::stl_rounding(parts);
    assemble(assembly, parts);
    return rounding + std::max(own, core::mesh_files::stl_rounding(parts));
}

}  // namespace fettle::design::exports
