// SPDX-License-Identifier: MIT
// VTK XML file formats, version 1.0: UnstructuredGrid, appended raw data, vtkZLibDataCompressor, header_type UInt64.
#include "design/exports/vtk_writer.hpp"

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cstdint>

#include "core/base/contract.hpp"
#include "core/base/text.hpp"
#include "core/mesh_files/millimetres.hpp"

namespace fettle::design::exports {

namespace {

using core::geometry::Mesh;

constexpr char triangle_cell = 5, line_cell = 3, vertex_cell = 1;
constexpr std::size_t block_size = 1U << 15;

void append_word64(std::string& out, std::uint64_t word) {
    for (int i = 0; i < 8; ++i, word >>= 8) out += static_cast<char>(word & 255);
}

void append_double(std::string& out, double x) { append_word64(out, std::bit_cast<std::uint64_t>(x)); }

std::string deflated(std::string_view text) {
    uLongf size = compressBound(static_cast<uLong>(text.size()));
    std::string out(size, '\0');
    const int code = compress2(reinterpret_cast<Bytef*>(out.data()), &size, reinterpret_cast<const Bytef*>(text.data()),
                               static_cast<uLong>(text.size()), 6);
    FETTLE_ASSERT(code == Z_OK, "compressBound is enough");
    out.resize(size);
    return out;
}

/// Number of blocks, size of a block, of the last one if it is partial, compressed sizes; then the blocks.
std::string compressed_array(std::string_view data) {
    std::vector<std::string> blocks;
    for (std::size_t at = 0; at < data.size(); at += block_size) blocks.push_back(deflated(data.substr(at, block_size)));
    std::string out;
    append_word64(out, blocks.size());
    append_word64(out, block_size);
    append_word64(out, data.size() % block_size);
    for (const std::string& block : blocks) append_word64(out, block.size());
    for (const std::string& block : blocks) out += block;
    return out;
}

/// What the cells of all parts come to, in the order of the parts.
struct Cells {
    std::string corners, ends, types, parts;  // as bytes
    std::uint64_t corner_count = 0, cell_count = 0;

    template <class Corners>
    void add(char type, const Corners& vertices, std::uint64_t first_vertex, std::int32_t part) {
        for (const int v : vertices) append_word64(corners, first_vertex + static_cast<std::uint64_t>(v));
        corner_count += vertices.size();
        append_word64(ends, corner_count);
        types += type;
        for (int i = 0; i < 4; ++i) parts += static_cast<char>(static_cast<std::uint32_t>(part) >> (8 * i) & 255);
        ++cell_count;
    }
};

void add_cells(const Mesh& mesh, std::uint64_t first_vertex, std::int32_t part, Cells& cells) {
    std::vector<core::geometry::Edge> of_triangles;
    const auto sorted = [](core::geometry::Edge e) { return e[0] < e[1] ? e : core::geometry::Edge{e[1], e[0]}; };
    for (const auto& t : mesh.triangles) {
        cells.add(triangle_cell, t, first_vertex, part);
        for (std::size_t k = 0; k < 3; ++k) of_triangles.push_back(sorted({t[k], t[(k + 1) % 3]}));
    }
    std::sort(of_triangles.begin(), of_triangles.end());
    for (const auto& edge : mesh.edges)
        if (!std::binary_search(of_triangles.begin(), of_triangles.end(), sorted(edge))) cells.add(line_cell, edge, first_vertex, part);
    for (const int point : mesh.codimensional_points) cells.add(vertex_cell, std::vector<int>{point}, first_vertex, part);
}

class VtuWriter {
public:
    std::string array(const char* type, const char* name, int components, std::string_view data, const std::string& more = "") {
        std::string tag = "<DataArray type=\"" + std::string(type) + "\" Name=\"" + name + "\" NumberOfComponents=\"" +
                          std::to_string(components) + "\"" + more + " format=\"appended\" offset=\"" + std::to_string(appended_.size()) +
                          "\"/>\n";
        appended_ += compressed_array(data);
        return tag;
    }
    const std::string& appended() const { return appended_; }

private:
    std::string appended_;
};

}  // namespace

std::string vtu_bytes(const Assembly& assembly, const Keyframe& keyframe) {
    std::string points, displacements, names;
    Cells cells;
    std::uint64_t vertices = 0;
    for (std::size_t i = 0; i < assembly.parts.size(); ++i) {
        const Mesh& mesh = assembly.parts[i].mesh;
        for (const auto& X : mesh.vertices.colwise()) {
            const Vector3 now = core::kinematics::world_position(keyframe.poses[i], X),
                          start = core::kinematics::world_position(assembly.keyframes.front().poses[i], X);
            for (int k = 0; k < 3; ++k) append_double(points, now[k]);
            for (int k = 0; k < 3; ++k) append_double(displacements, now[k] - start[k]);
        }
        add_cells(mesh, vertices, static_cast<std::int32_t>(i), cells);
        vertices += static_cast<std::uint64_t>(mesh.vertices.cols());
        names += (i == 0 ? "" : "\n") + core::base::shown_on_one_line(assembly.parts[i].name);
    }
    VtuWriter writer;
    const std::string field = writer.array("UInt8", "part_names", 1, names, " NumberOfTuples=\"" + std::to_string(names.size()) + "\"");
    const std::string point_data = writer.array("Float64", "displacement", 3, displacements);
    const std::string cell_data = writer.array("Int32", "part", 1, cells.parts);
    const std::string position = writer.array("Float64", "Points", 3, points);
    const std::string connectivity = writer.array("Int64", "connectivity", 1, cells.corners) +
                                     writer.array("Int64", "offsets", 1, cells.ends) + writer.array("UInt8", "types", 1, cells.types);
    return "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" "
           "header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\">\n<UnstructuredGrid>\n<FieldData>\n" +
           field + "</FieldData>\n<Piece NumberOfPoints=\"" + std::to_string(vertices) + "\" NumberOfCells=\"" +
           std::to_string(cells.cell_count) + "\">\n<PointData>\n" + point_data + "</PointData>\n<CellData>\n" + cell_data +
           "</CellData>\n<Points>\n" + position + "</Points>\n<Cells>\n" + connectivity +
           "</Cells>\n</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_" + writer.appended() +
           "\n</AppendedData>\n</VTKFile>\n";
}

std::string pvd_text(const std::vector<std::pair<double, std::string>>& frames) {
    std::string out = "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n<Collection>\n";
    for (const auto& [time, file] : frames)
        out += "<DataSet timestep=\"" + core::mesh_files::decimal(time) + "\" part=\"0\" file=\"" + file + "\"/>\n";
    return out + "</Collection>\n</VTKFile>\n";
}

}  // namespace fettle::design::exports
