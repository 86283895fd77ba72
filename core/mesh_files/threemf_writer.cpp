// SPDX-License-Identifier: MIT
// 3MF core specification 1.3, sections 2 (package) and 3 to 5 (model, objects, base materials).
#include <algorithm>
#include <cstdio>

#include "core/base/text.hpp"
#include "core/mesh_files/mesh_writer.hpp"
#include "core/mesh_files/millimetres.hpp"
#include "core/mesh_files/zip_archive.hpp"

namespace fettle::core::mesh_files {
namespace {

constexpr const char* content_types =
    "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
    "<Types xmlns=\"http://schemas.openxmlformats.org/package/2006/content-types\">"
    "<Default Extension=\"rels\" ContentType=\"application/vnd.openxmlformats-package.relationships+xml\"/>"
    "<Default Extension=\"model\" ContentType=\"application/vnd.ms-package.3dmanufacturing-3dmodel+xml\"/></Types>\n";
constexpr const char* relationships =
    "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
    "<Relationships xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\">"
    "<Relationship Target=\"/3D/3dmodel.model\" Id=\"rel0\" "
    "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>\n";

std::string hex_colour(const Colour& colour) {
    char text[16];
    std::snprintf(text, sizeof text, "#%02X%02X%02X", colour[0], colour[1], colour[2]);
    return text;
}

/// Has every directed edge its opposite, and each once? Then the triangles bound a solid.
bool is_closed(const geometry::Mesh& mesh) {
    std::vector<geometry::Edge> edges;
    for (const geometry::Triangle& t : mesh.triangles)
        for (std::size_t k = 0; k < 3; ++k) edges.push_back({t[k], t[(k + 1) % 3]});
    std::sort(edges.begin(), edges.end());
    if (std::adjacent_find(edges.begin(), edges.end()) != edges.end()) return false;
    return std::all_of(edges.begin(), edges.end(), [&](const geometry::Edge& e) {
        return std::binary_search(edges.begin(), edges.end(), geometry::Edge{e[1], e[0]});
    });
}

std::string object_text(const MeshPart& part, std::size_t id, std::size_t colour) {
    const geometry::Mesh& mesh = *part.mesh;
    std::string out = "<object id=\"" + std::to_string(id) + "\" type=\"" + (is_closed(mesh) ? "model" : "surface") + "\" name=\"" +
                      base::xml_text(part.name) + "\" pid=\"1\" pindex=\"" + std::to_string(colour) + "\"><mesh>\n<vertices>\n";
    for (int i = 0; i < mesh.vertices.cols(); ++i)
        out += "<vertex x=\"" + millimetres(mesh.vertices(0, i)) + "\" y=\"" + millimetres(mesh.vertices(1, i)) + "\" z=\"" +
               millimetres(mesh.vertices(2, i)) + "\"/>\n";
    out += "</vertices>\n<triangles>\n";
    for (const geometry::Triangle& t : mesh.triangles)
        out += "<triangle v1=\"" + std::to_string(t[0]) + "\" v2=\"" + std::to_string(t[1]) + "\" v3=\"" + std::to_string(t[2]) + "\"/>\n";
    return out + "</triangles>\n</mesh></object>\n";
}

/// The file multiplies rows: x' = x m00 + y m10 + z m20 + m30.
std::string item_text(const MeshPart& part, std::size_t id) {
    std::string out = "<item objectid=\"" + std::to_string(id) + "\"";
    if (part.rotation != Matrix3::Identity() || part.position != Vector3::Zero()) {
        out += " transform=\"";
        for (int j = 0; j < 3; ++j)
            for (int i = 0; i < 3; ++i) out += decimal(part.rotation(i, j)) + " ";
        out += millimetres(part.position[0]) + " " + millimetres(part.position[1]) + " " + millimetres(part.position[2]) + "\"";
    }
    return out + "/>\n";
}

}  // namespace

Result<std::string> threemf_bytes(const std::vector<MeshPart>& parts) {
    std::string materials, objects, items;
    std::size_t count = 0;
    for (const MeshPart& part : parts) {
        if (part.mesh->triangles.empty()) continue;
        materials += "<base name=\"" + base::xml_text(part.name) + "\" displaycolor=\"" + hex_colour(part.colour) + "\"/>";
        objects += object_text(part, count + 2, count);
        items += item_text(part, count + 2);
        ++count;
    }
    if (count == 0) return Error{ErrorCode::mesh_invalid, "3MF", "no part has a triangle, so there is nothing that a 3MF file could hold"};
    const std::string model =
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model unit=\"millimeter\" xml:lang=\"en-US\" "
        "xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\">\n<metadata name=\"Application\">fettle</metadata>\n"
        "<resources>\n<basematerials id=\"1\">" +
        materials + "</basematerials>\n" + objects + "</resources>\n<build>\n" + items + "</build>\n</model>\n";
    return zipped({{"[Content_Types].xml", content_types}, {"_rels/.rels", relationships}, {"3D/3dmodel.model", model}});
}

}  // namespace fettle::core::mesh_files
