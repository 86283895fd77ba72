// SPDX-License-Identifier: MIT
#include "design/cli/step_facts.hpp"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "core/base/text.hpp"
#include "core/geometry/mass_moments.hpp"
#include "design/answers/answer_json.hpp"
#include "design/cli/answers.hpp"

namespace fettle::design::cli {

namespace {

using Json = nlohmann::ordered_json;
using core::geometry::Mesh;

Vector3 size_of(const Mesh& mesh) { return 1e3 * core::geometry::box_sides(mesh.vertices); }
double volume_of(const Mesh& mesh) { return 1e9 * core::geometry::capped_solid_moments(mesh.vertices, mesh.triangles)(3, 3); }

// Faces are called after their kind: "cylinder 7".
std::map<std::string, int> kinds_of(const Mesh& mesh) {
    std::map<std::string, int> kinds;
    for (const std::string& name : mesh.face_names) ++kinds[name.substr(0, name.find(' '))];
    return kinds;
}

std::string faces_text(const Mesh& mesh) {
    std::vector<std::pair<std::string, int>> kinds;
    for (const auto& each : kinds_of(mesh)) kinds.push_back(each);
    std::stable_sort(kinds.begin(), kinds.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
    std::string text;
    for (const auto& [kind, count] : kinds) text += (text.empty() ? "" : ", ") + core::base::counted(static_cast<std::size_t>(count), kind);
    return text;
}

std::string colour_text(const std::array<unsigned char, 3>& colour) { return formatted("#%02x%02x%02x", colour[0], colour[1], colour[2]); }

// What of the deviations is no theorem.
std::string assumptions(const std::vector<Mesh>& items) {
    core::geometry::Deviation all;
    for (const Mesh& mesh : items)
        if (mesh.deviation) all.add(*mesh.deviation);
    std::string text = formatted("  the meshes are within %.3g mm (out) and %.3g mm (in) of the exact faces", 1e3 * all.out, 1e3 * all.in) +
                       (all.out_is_proven ? ", proven" : ", in part on your word (--surface-tolerance)");
    return text + formatted("; %.3g mm of it rest on the tolerances that the file declares for its edges\n", 1e3 * all.declared);
}

}  // namespace

Json deviation_json(const core::geometry::Deviation& deviation) {
    return {{"out", deviation.out},
            {"in", deviation.in},
            {"out_is_proven", deviation.out_is_proven},
            {"in_is_proven", deviation.in_is_proven},
            {"declared", deviation.declared}};
}

Json step_items_json(const std::vector<Mesh>& items) {
    Json list = Json::array();
    for (const Mesh& mesh : items) {
        const Vector3 size = size_of(mesh);
        Json item{{"name", mesh.name},         {"size", {size.x(), size.y(), size.z()}},
                  {"volume", volume_of(mesh)}, {"triangles", mesh.triangles.size()},
                  {"faces", kinds_of(mesh)},   {"colour", mesh.colour ? Json(colour_text(*mesh.colour)) : Json()}};
        if (mesh.deviation) item["deviation"] = deviation_json(*mesh.deviation);
        list.push_back(std::move(item));
    }
    return list;
}

std::string step_items_text(const std::vector<Mesh>& items) {
    constexpr std::size_t most_told = 200;
    std::size_t widest = 4;
    for (const Mesh& mesh : items) widest = std::max(widest, std::min<std::size_t>(mesh.name.size(), 32));
    const int width = static_cast<int>(widest);
    std::string text =
        formatted("  %-*s  %-26s  %-14s  %-20s  %s\n", width, "item", "size [mm]", "volume [mm^3]", "facets out, in [mm]", "faces");
    for (std::size_t i = 0; i < std::min(items.size(), most_told); ++i) {
        const Mesh& mesh = items[i];
        const Vector3 size = size_of(mesh);
        const core::geometry::Deviation deviation = mesh.deviation.value_or(core::geometry::Deviation{});
        text += formatted("  %-*s  %-26s  %-14s  %-20s  %s\n", width, mesh.name.c_str(),
                          formatted("%.5g x %.5g x %.5g", size.x(), size.y(), size.z()).c_str(), formatted("%.6g", volume_of(mesh)).c_str(),
                          formatted("%.2g, %.2g", 1e3 * deviation.out, 1e3 * deviation.in).c_str(), faces_text(mesh).c_str());
    }
    if (items.size() > most_told) text += "  and " + std::to_string(items.size() - most_told) + " more (--json lists them)\n";
    return text + assumptions(items);
}

}  // namespace fettle::design::cli
