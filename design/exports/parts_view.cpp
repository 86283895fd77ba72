// SPDX-License-Identifier: MIT
#include "design/exports/parts_view.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/contract.hpp"

namespace fettle::design::exports {

namespace {

using core::geometry::Mesh;

constexpr int fine = 2;                // pixels of the depth buffer per pixel of the picture, each way
constexpr double hatch_pitch = 7;      // of material that is cut [pixels]
constexpr double depth_tolerance = 3;  // of an edge against the faces that it belongs to [fine pixels]
constexpr double margin = 0.08;        // of the picture on each side

// From the viewer's upper left, and less from the right, as the report's page has it (design/report/web/src/materials.js); the inner side
// of what is not closed is lit as well.
double light_of(const Vector3& face, const Vector3& corner, const ProjectionView& view) {
    const double side = face.dot(view.towards) < 0 ? -1 : 1;
    const Vector3 n = side * Vector3(corner.dot(view.right), corner.dot(view.up), corner.dot(view.towards));
    const double key = std::max(0.0, n.dot(Vector3(-0.45, 0.65, 0.75).normalized()));
    const double fill = std::max(0.0, n.dot(Vector3(0.7, -0.2, 0.45).normalized()));
    return 0.66 + 0.09 * n.y() + 0.33 * key + 0.10 * fill;
}

// Across the lines of number `part`: parts side by side have them at different angles.
Vector2 hatch_of(std::size_t part) {
    const double angle = (0.25 + 0.2 * static_cast<double>(part % 4)) * M_PI;
    return Vector2(std::cos(angle), std::sin(angle)) / (fine * hatch_pitch);
}

std::vector<Vector3> normals_of(const Mesh& mesh, const Matrix3X& x) {
    std::vector<Vector3> normals;
    for (const auto& t : mesh.triangles)
        normals.push_back(Vector3(x.col(t[1]) - x.col(t[0])).cross(Vector3(x.col(t[2]) - x.col(t[0]))).stableNormalized());
    return normals;
}

// The mean normals of the faces that meet in a corner below the crease, weighted by their angles there. A corner of very many, a fan's
// middle, is flat.
std::vector<std::array<Vector3, 3>> corner_normals_of(const Mesh& mesh, const Matrix3X& x, const std::vector<Vector3>& normals,
                                                      double crease) {
    constexpr std::size_t most = 64;
    struct Corner {
        std::size_t triangle;
        double angle;
    };
    std::vector<std::vector<Corner>> corners(x.cols());
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const auto& t = mesh.triangles[i];
        for (std::size_t k = 0; k < 3; ++k) {
            const Vector3 u = x.col(t[(k + 1) % 3]) - x.col(t[k]), v = x.col(t[(k + 2) % 3]) - x.col(t[k]);
            corners[t[k]].push_back({i, std::atan2(u.cross(v).norm(), u.dot(v))});
        }
    }
    std::vector<std::array<Vector3, 3>> out;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        out.push_back({normals[i], normals[i], normals[i]});
        for (std::size_t k = 0; k < 3; ++k) {
            const std::vector<Corner>& there = corners[mesh.triangles[i][k]];
            if (there.size() > most) continue;
            Vector3 sum = Vector3::Zero();
            for (const Corner& other : there)
                if (normals[other.triangle].dot(normals[i]) > std::cos(crease)) sum += other.angle * normals[other.triangle];
            if (sum.norm() > 0) out.back()[k] = sum.normalized();
        }
    }
    return out;
}

std::map<core::geometry::Edge, std::vector<int>> triangles_by_edge(const Mesh& mesh) {
    std::map<core::geometry::Edge, std::vector<int>> triangles;
    for (const auto& edge : mesh.edges) triangles[{std::min(edge[0], edge[1]), std::max(edge[0], edge[1])}];
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const auto& t = mesh.triangles[i];
        for (std::size_t k = 0; k < 3; ++k) {
            const int u = t[k], v = t[(k + 1) % 3];
            triangles[{std::min(u, v), std::max(u, v)}].push_back(static_cast<int>(i));
        }
    }
    return triangles;
}

Image averaged(const Image& image) {
    Image out{image.width / fine, image.height / fine, {}};
    out.pixels.resize(static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height));
    for (int y = 0; y < out.height; ++y) {
        for (int x = 0; x < out.width; ++x) {
            for (std::size_t k = 0; k < 3; ++k) {
                int sum = 0;
                for (int j = 0; j < fine * fine; ++j) sum += image.at(fine * x + j % fine, fine * y + j / fine)[k];
                out.at(x, y)[k] = static_cast<unsigned char>((sum + fine * fine / 2) / (fine * fine));
            }
        }
    }
    return out;
}

Projection finer(Projection projection) {
    projection.scale *= fine;
    projection.middle *= fine;
    return projection;
}

std::optional<Cut> finer(std::optional<Cut> cut) {
    if (cut) cut = Cut{fine * cut->centre, fine * cut->radius, fine * cut->depth};
    return cut;
}

}  // namespace

PartsView::PartsView(const Assembly& assembly, const std::vector<core::kinematics::Pose>& poses, double crease) : crease_(crease) {
    FETTLE_ASSERT(poses.size() == assembly.parts.size(), "one pose for each part");
    for (std::size_t i = 0; i < poses.size(); ++i) {
        const Mesh& mesh = assembly.parts[i].mesh;
        Part part{&assembly.parts[i], (poses[i].rotation * mesh.vertices).colwise() + poses[i].position, {}, {}, triangles_by_edge(mesh)};
        part.normals = normals_of(mesh, part.vertices);
        part.corner_normals = corner_normals_of(mesh, part.vertices, part.normals, crease);
        part.is_closed =
            std::all_of(part.triangles.begin(), part.triangles.end(), [](const auto& at) { return at.second.size() % 2 == 0; });
        parts_.push_back(std::move(part));
    }
}

Projection PartsView::fitted(const ProjectionView& view, int width, int height) const {
    Vector2 low = Vector2::Constant(INFINITY), high = Vector2::Constant(-INFINITY);
    for (const Part& part : parts_) {
        for (const auto& x : part.vertices.colwise()) {
            const Vector2 p(view.right.dot(x), view.up.dot(x));
            low = low.cwiseMin(p);
            high = high.cwiseMax(p);
        }
    }
    Projection out{view};
    const Vector2 size(width, height);
    out.middle = size / 2;
    if (!low.allFinite() || !high.allFinite()) return out;
    out.centre = (low + high) / 2;
    const Vector2 extent = (high - low).cwiseMax(1e-9);
    out.scale = (1 - 2 * margin) * (size.array() / extent.array()).minCoeff();
    return out;
}

double PartsView::diagonal() const {
    Vector3 low = Vector3::Constant(INFINITY), high = -low;
    for (const Part& part : parts_) {
        if (part.vertices.cols() == 0) continue;
        low = low.cwiseMin(part.vertices.rowwise().minCoeff());
        high = high.cwiseMax(part.vertices.rowwise().maxCoeff());
    }
    return low.allFinite() && high.allFinite() ? (high - low).norm() : 0;
}

DepthBuffer PartsView::drawn(const Projection& fine_projection, int width, int height, const std::optional<Cut>& cut) const {
    DepthBuffer buffer(fine * width, fine * height, white, cut);
    for (std::size_t i = 0; i < parts_.size(); ++i) {
        const Part& part = parts_[i];
        const Mesh& mesh = part.part->mesh;
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
            const auto corner = [&](std::size_t k) { return fine_projection(part.vertices.col(mesh.triangles[t][k])); };
            const auto light = [&](std::size_t k) { return light_of(part.normals[t], part.corner_normals[t][k], fine_projection.view); };
            buffer.add_triangle({corner(0), corner(1), corner(2)}, {light(0), light(1), light(2)}, part.part->colour);
        }
        if (part.is_closed) {
            buffer.close_solid(part.part->colour, alarm, hatch_of(i));
        } else {
            buffer.close_open();
        }
    }
    buffer.outline_cut();
    return buffer;
}

std::vector<PictureLine> PartsView::visible_edges(const Part& part, const DepthBuffer& buffer, const Projection& fine_projection) const {
    const Vector3& towards = fine_projection.view.towards;
    std::vector<PictureLine> lines;
    for (const auto& [edge, triangles] : part.triangles) {
        if (triangles.size() == 2) {  // of others, loose, at a border or where more meet, all are drawn
            const Vector3 &a = part.normals[triangles[0]], &b = part.normals[triangles[1]];
            const bool is_outline = (a.dot(towards) > 1e-9) != (b.dot(towards) > 1e-9);
            if (!is_outline && !(a.dot(b) < std::cos(crease_))) continue;
        }
        const Vector3 from = fine_projection(part.vertices.col(edge[0])), to = fine_projection(part.vertices.col(edge[1]));
        for (const auto& [begin, end] : buffer.visible(from, to, depth_tolerance)) {
            const Vector3 first = from + begin * (to - from), last = from + end * (to - from);
            lines.push_back({first.head<2>() / fine, last.head<2>() / fine});
        }
    }
    return lines;
}

bool PartsView::hides(const Vector3& point, const Projection& projection, int width, int height) const {
    const Projection fine_projection = finer(projection);
    return !drawn(fine_projection, width, height, std::nullopt).is_visible(fine_projection(point), depth_tolerance);
}

ViewedParts PartsView::seen(const Projection& projection, int width, int height, const std::optional<Cut>& cut) const {
    const Projection fine_projection = finer(projection);
    const DepthBuffer buffer = drawn(fine_projection, width, height, finer(cut));
    ViewedParts out{averaged(buffer.image()), {}};
    for (const Part& part : parts_) out.edges.push_back({lit(part.part->colour, edge_light), visible_edges(part, buffer, fine_projection)});
    return out;
}

}  // namespace fettle::design::exports
