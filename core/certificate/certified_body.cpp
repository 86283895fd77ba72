// SPDX-License-Identifier: MIT
#include "core/certificate/certified_body.hpp"

#include <algorithm>
#include <set>
#include <string>
#include <utility>

namespace fettle::core::certificate {
namespace {

using base::ErrorCode;

// Numbers of the elements that a list has to have: triangles, edges of none of them, vertices of no edge and no triangle.
std::vector<int> wanted_elements(const geometry::Mesh& mesh) {
    std::vector<int> wanted;
    std::set<std::pair<int, int>> of_triangles;
    std::vector<bool> used(mesh.vertices.cols(), false);
    const auto triangles = count_of(mesh.triangles), edges = count_of(mesh.edges);
    for (int i = 0; i < triangles; ++i) {
        wanted.push_back(i);
        const auto& t = mesh.triangles[i];
        for (int k = 0; k < 3; ++k) of_triangles.insert(std::minmax(t[k], t[(k + 1) % 3]));
        for (const int v : t) used[v] = true;
    }
    for (int i = 0; i < edges; ++i) {
        const auto& e = mesh.edges[i];
        if (of_triangles.count(std::minmax(e[0], e[1])) == 0) wanted.push_back(triangles + i);
        for (const int v : e) used[v] = true;
    }
    for (int v = 0; v < count_of(used); ++v)
        if (!used[v]) wanted.push_back(triangles + edges + v);
    return wanted;
}

base::Errors missing_or_unknown(const BodyPieces& pieces, const geometry::Mesh& mesh) {
    const std::set<int> listed(pieces.elements.begin(), pieces.elements.end());
    for (const int number : wanted_elements(mesh))
        if (listed.count(number) == 0) return {{ErrorCode::inconsistent, "/elements", "element " + std::to_string(number) + " is missing"}};
    for (const int number : pieces.elements)
        if (element_vertices(mesh, number).empty())
            return {{ErrorCode::inconsistent, "/elements", "there is no element " + std::to_string(number)}};
    return {};
}

base::Errors split_parts(const BodyPieces& pieces, const std::vector<Vector3>& corners, const std::vector<int>& vertices,
                         std::vector<Part>& parts) {
    struct Range {
        std::size_t first, count;
        int parent;
        bool second;
    };
    const auto wrong = [](const std::string& message) { return base::Errors{{ErrorCode::inconsistent, "/cuts", message}}; };
    std::vector<Range> pending{{0, pieces.elements.size(), -1, false}};
    std::size_t next_cut = 0;
    while (!pending.empty()) {
        const Range range = pending.back();
        pending.pop_back();
        const int part = count_of(parts);
        parts.emplace_back();
        parts[part].region.points = std::span<const Vector3>(corners).subspan(3 * range.first, 3 * range.count);
        parts[part].region.vertices = std::span<const int>(vertices).subspan(3 * range.first, 3 * range.count);
        if (range.parent >= 0) (range.second ? parts[range.parent].right : parts[range.parent].left) = part;
        if (range.count <= 1) continue;
        const int cut = next_cut < pieces.cuts.size() ? pieces.cuts[next_cut] : 0;
        ++next_cut;
        if (cut < 1 || static_cast<std::size_t>(cut) >= range.count)
            return wrong("cut " + std::to_string(next_cut - 1) + " is missing or leaves nothing to one side");
        const auto first = static_cast<std::size_t>(cut);
        pending.push_back({range.first + first, range.count - first, part, true});
        pending.push_back({range.first, first, part, false});
    }
    return next_cut == pieces.cuts.size() ? base::Errors{} : wrong("there are more cuts than pieces to cut");
}

// From the children, or from the points of an element.
void measure(const std::vector<Part>& parts, Part& part) {
    Region& region = part.region;
    if (part.left >= 0) {
        const Region &first = parts[part.left].region, &second = parts[part.right].region;
        region.low = first.low.cwiseMin(second.low);
        region.high = first.high.cwiseMax(second.high);
        region.radius = std::max(first.radius, second.radius);
        return;
    }
    region.low = region.high = region.points.empty() ? Vector3(Vector3::Zero()) : region.points[0];
    for (const Vector3& x : region.points) {
        region.low = region.low.cwiseMin(x);
        region.high = region.high.cwiseMax(x);
        region.radius = std::max(region.radius, norm_bound(Interval3{x.x(), x.y(), x.z()}));
    }
}

}  // namespace

std::vector<int> element_vertices(const geometry::Mesh& mesh, int number) {
    const auto triangles = count_of(mesh.triangles), edges = count_of(mesh.edges);
    if (number < 0) return {};
    if (number < triangles) return {mesh.triangles[number].begin(), mesh.triangles[number].end()};
    if (number < triangles + edges) return {mesh.edges[number - triangles].begin(), mesh.edges[number - triangles].end()};
    if (number - triangles - edges < mesh.vertices.cols()) return {number - triangles - edges};
    return {};
}

base::Result<CertifiedBody> certified_body(const BodyPieces& pieces, const geometry::Mesh& mesh) {
    CertifiedBody body;
    if (base::Errors errors = missing_or_unknown(pieces, mesh); !errors.empty()) return errors;
    for (const int number : pieces.elements) {
        const std::vector<int> vertices = element_vertices(mesh, number);
        for (std::size_t k = 0; k < 3; ++k) {
            body.vertices_.push_back(vertices[std::min(k, vertices.size() - 1)]);
            body.corners_.emplace_back(mesh.vertices.col(body.vertices_.back()));
        }
    }
    if (base::Errors errors = split_parts(pieces, body.corners_, body.vertices_, body.parts_); !errors.empty()) return errors;
    for (auto part = body.parts_.rbegin(); part != body.parts_.rend(); ++part) measure(body.parts_, *part);  // children first
    return body;
}

bool point_of(const geometry::Mesh& mesh, const CertifiedPoint& point, Interval3& X) {
    const auto exact = [&](int v) { return Interval3{mesh.vertices(0, v), mesh.vertices(1, v), mesh.vertices(2, v)}; };
    return point_of(mesh, point, exact, X);
}

bool point_of(const geometry::Mesh& mesh, const CertifiedPoint& point, const std::function<Interval3(int vertex)>& vertices, Interval3& X) {
    const auto triangles = count_of(mesh.triangles), edges = count_of(mesh.edges);
    const int count = point.kind == Primitive::triangle ? triangles
                      : point.kind == Primitive::edge   ? edges
                                                        : static_cast<int>(mesh.vertices.cols());
    if (point.index < 0 || point.index >= count) return false;
    const int offset = point.kind == Primitive::triangle ? 0 : point.kind == Primitive::edge ? triangles : triangles + edges;
    const std::vector<int> corners = element_vertices(mesh, offset + point.index);
    for (std::size_t i = corners.size(); i < point.weight.size(); ++i)
        if (point.weight[i] != 0) return false;
    Interval total = 0;
    X = {Interval(0), Interval(0), Interval(0)};
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const double weight = point.weight[i];
        if (!(weight >= 0 && weight <= 2)) return false;
        total = total + Interval(weight);
        const Interval3 corner = vertices(corners[i]);
        for (std::size_t k = 0; k < 3; ++k) X[k] = X[k] + Interval(weight) * corner[k];
    }
    if (!(total.low > 0.5)) return false;
    for (Interval& x : X) x = x / total;
    return true;
}

}  // namespace fettle::core::certificate
