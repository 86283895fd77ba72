// SPDX-License-Identifier: MIT
#include "fettle/design/exports/picture.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <utility>

#include "fettle/core/base/contract.hpp"
#include "fettle/design/exports/depth_buffer.hpp"
#include "fettle/design/exports/small_letters.hpp"

namespace fettle::design::exports {

namespace {

using core::geometry::Mesh;
using core::kinematics::Pose;

constexpr int fine = 2;                 // pixels of the depth buffer per pixel of the picture, each way
constexpr double depth_tolerance = 3;   // of an edge against the faces that it belongs to [fine pixels]
constexpr double margin = 0.08;         // of the picture on each side
constexpr std::size_t most_named = 24;  // in the legend
constexpr Colour white{255, 255, 255}, ink{30, 30, 30}, alarm{200, 0, 40};

/// World to fine pixels.
struct Projection {
    ProjectionView view;
    double scale = 1;  // fine pixels per metre
    Vector2 centre = Vector2::Zero(), middle = Vector2::Zero();

    Vector3 operator()(const Vector3& x) const {
        return {middle.x() + scale * (view.right.dot(x) - centre.x()), middle.y() - scale * (view.up.dot(x) - centre.y()),
                scale * view.towards.dot(x)};
    }
};

std::vector<Matrix3X> placed_vertices(const Assembly& assembly, const std::vector<Pose>& poses) {
    std::vector<Matrix3X> out;
    for (std::size_t i = 0; i < assembly.parts.size(); ++i)
        out.push_back((poses[i].rotation * assembly.parts[i].mesh.vertices).colwise() + poses[i].position);
    return out;
}

Projection fitted(const std::vector<Matrix3X>& vertices, const PictureOptions& options) {
    Vector2 low = Vector2::Constant(INFINITY), high = Vector2::Constant(-INFINITY);
    for (const Matrix3X& part : vertices) {
        for (const auto& x : part.colwise()) {
            const Vector2 p(options.view.right.dot(x), options.view.up.dot(x));
            low = low.cwiseMin(p);
            high = high.cwiseMax(p);
        }
    }
    Projection out{options.view};
    const Vector2 size(fine * options.width, fine * options.height);
    out.middle = size / 2;
    if (!low.allFinite() || !high.allFinite()) return out;
    out.centre = (low + high) / 2;
    const Vector2 extent = (high - low).cwiseMax(1e-9);
    out.scale = (1 - 2 * margin) * (size.array() / extent.array()).minCoeff();
    return out;
}

/// A light at the viewer's shoulder; the inner side of what is not closed is lit as well.
Colour shaded(const Colour& colour, const Vector3& normal, const ProjectionView& view) {
    const Vector3 light = (view.towards + 0.35 * view.up - 0.25 * view.right).normalized();
    const double brightness = 0.45 + 0.55 * std::abs(normal.dot(light));
    Colour out{};
    for (std::size_t k = 0; k < 3; ++k)
        out[k] = static_cast<unsigned char>(std::lround(std::min(255.0, 40 + 0.84 * colour[k]) * brightness));
    return out;
}

/// Triangles at an edge of a mesh.
struct EdgeFaces {
    std::vector<int> triangles;
};

bool is_drawn(const EdgeFaces& faces, const std::vector<Vector3>& normals, const PictureOptions& options) {
    if (faces.triangles.size() != 2) return true;  // loose, border, or where more than two meet
    const Vector3 &a = normals[static_cast<std::size_t>(faces.triangles[0])], &b = normals[static_cast<std::size_t>(faces.triangles[1])];
    const bool outline = (a.dot(options.view.towards) > 1e-9) != (b.dot(options.view.towards) > 1e-9);
    return outline || a.dot(b) < std::cos(options.crease);
}

std::vector<Vector3> normals_of(const Mesh& mesh, const Matrix3X& x) {
    std::vector<Vector3> normals;
    for (const auto& t : mesh.triangles)
        normals.push_back(Vector3(x.col(t[1]) - x.col(t[0])).cross(Vector3(x.col(t[2]) - x.col(t[0]))).stableNormalized());
    return normals;
}

std::map<core::geometry::Edge, EdgeFaces> faces_by_edge(const Mesh& mesh) {
    std::map<core::geometry::Edge, EdgeFaces> faces;
    for (const auto& edge : mesh.edges) faces[{std::min(edge[0], edge[1]), std::max(edge[0], edge[1])}];
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const auto& t = mesh.triangles[i];
        for (std::size_t k = 0; k < 3; ++k) {
            const int u = t[k], v = t[(k + 1) % 3];
            faces[{std::min(u, v), std::max(u, v)}].triangles.push_back(static_cast<int>(i));
        }
    }
    return faces;
}

/// Visible stretches of the edges of one part, in pixels of the picture.
std::vector<PictureLine> visible_edges(const Mesh& mesh, const Matrix3X& x, const DepthBuffer& buffer, const Projection& project,
                                       const PictureOptions& options) {
    std::vector<PictureLine> lines;
    const std::vector<Vector3> normals = normals_of(mesh, x);
    for (const auto& [edge, faces] : faces_by_edge(mesh)) {
        if (!is_drawn(faces, normals, options)) continue;
        const Vector3 from = project(x.col(edge[0])), to = project(x.col(edge[1]));
        for (const auto& [begin, end] : buffer.visible(from, to, depth_tolerance)) {
            const Vector3 first = from + begin * (to - from), last = from + end * (to - from);
            lines.push_back({first.head<2>() / fine, last.head<2>() / fine});
        }
    }
    return lines;
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

/// A bar of 1, 2 or 5 times a power of ten of millimetres, up to a sixth of the width.
void choose_scale(double pixels_per_metre, int width, Picture& out) {
    const double most = 1000.0 * width / 6 / pixels_per_metre;  // [mm]
    const double power = std::pow(10, std::floor(std::log10(most)));
    const double millimetres = most >= 5 * power ? 5 * power : most >= 2 * power ? 2 * power : power;
    char text[40];
    if (millimetres >= 1000) {
        std::snprintf(text, sizeof text, "%g m", millimetres / 1000);
    } else {
        std::snprintf(text, sizeof text, "%g mm", millimetres);
    }
    out.scale_pixels = millimetres / 1000 * pixels_per_metre;
    out.scale_text = text;
}

/// A line one pixel wide, with its share of the pixels on both sides.
void draw_line(Image& image, const PictureLine& line, const Colour& colour, double width) {
    const Vector2 along = line.to - line.from;
    const double length = along.norm(), reach = width / 2 + 0.5;
    const auto clamped = [](double x, int count) { return static_cast<int>(std::clamp(x, 0.0, count - 1.0)); };
    const bool steep = std::abs(along.y()) > std::abs(along.x());
    const int axis = steep ? 1 : 0, across = 1 - axis;
    const int count[] = {image.width, image.height};
    const double low = std::min(line.from[axis], line.to[axis]), high = std::max(line.from[axis], line.to[axis]);
    for (int u = clamped(low - reach, count[axis]); u <= clamped(high + reach, count[axis]); ++u) {
        const double t = length > 0 ? std::clamp((u + 0.5 - line.from[axis]) / (along[axis] == 0 ? 1 : along[axis]), 0.0, 1.0) : 0;
        const double middle = line.from[across] + t * along[across];
        for (int v = clamped(middle - 2 * reach, count[across]); v <= clamped(middle + 2 * reach, count[across]); ++v) {
            const Vector2 p = steep ? Vector2(v + 0.5, u + 0.5) : Vector2(u + 0.5, v + 0.5);
            const double s = length > 0 ? std::clamp((p - line.from).dot(along) / (length * length), 0.0, 1.0) : 0;
            const double cover = std::clamp(reach - (p - line.from - s * along).norm(), 0.0, 1.0);
            Colour& pixel = steep ? image.at(v, u) : image.at(u, v);
            for (std::size_t k = 0; k < 3; ++k)
                pixel[k] = static_cast<unsigned char>(std::lround(pixel[k] + cover * (colour[k] - pixel[k])));
        }
    }
}

void draw_dot(Image& image, const Vector2& centre, const Colour& colour) { draw_line(image, {centre, centre}, colour, 7); }

struct Rectangle {
    int x, y, width, height;
};
void fill(Image& image, const Rectangle& r, const Colour& colour) {
    for (int v = std::max(0, r.y); v < std::min(r.y + r.height, image.height); ++v)
        for (int u = std::max(0, r.x); u < std::min(r.x + r.width, image.width); ++u) image.at(u, v) = colour;
}

void ink_texts(const Picture& picture, Image& image) {
    int y = 12;
    if (!picture.title.empty()) write_text(image, 12, std::exchange(y, y + 26), picture.title, ink, 2);
    for (const LegendEntry& entry : picture.legend) {
        fill(image, {12, y, 14, 12}, entry.colour);
        write_text(image, 34, y, entry.name, ink, 2);
        y += 20;
    }
    const double base = image.height - 14;
    draw_line(image, {{12, base}, {12 + picture.scale_pixels, base}}, ink, 2);
    for (const double x : {12.0, 12 + picture.scale_pixels}) draw_line(image, {{x, base - 5}, {x, base + 5}}, ink, 2);
    write_text(image, static_cast<int>(20 + picture.scale_pixels), image.height - 21, picture.scale_text, ink, 2);
}

}  // namespace

Picture draw_picture(const Assembly& assembly, const std::vector<Pose>& poses, const PictureOptions& options) {
    FETTLE_ASSERT(poses.size() == assembly.parts.size(), "one pose for each part");
    FETTLE_ASSERT(std::min(options.width, options.height) >= 16 && std::max(options.width, options.height) <= 16384, "a picture's size");
    const std::vector<Matrix3X> vertices = placed_vertices(assembly, poses);
    const Projection project = fitted(vertices, options);
    DepthBuffer buffer(fine * options.width, fine * options.height, white);
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const Mesh& mesh = assembly.parts[i].mesh;
        const std::vector<Vector3> normals = normals_of(mesh, vertices[i]);
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
            const auto corner = [&](std::size_t k) { return project(vertices[i].col(mesh.triangles[t][k])); };
            buffer.add_triangle({corner(0), corner(1), corner(2)}, shaded(assembly.parts[i].colour, normals[t], options.view));
        }
    }
    Picture out;
    out.surfaces = averaged(buffer.image());
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const auto lines = visible_edges(assembly.parts[i].mesh, vertices[i], buffer, project, options);
        out.edges.insert(out.edges.end(), lines.begin(), lines.end());
        if (i < most_named) out.legend.push_back({assembly.parts[i].name, assembly.parts[i].colour});
    }
    if (vertices.size() > most_named) out.legend.push_back({"and " + std::to_string(vertices.size() - most_named) + " more", white});
    if (options.marker) {
        out.marker = PictureLine{project(options.marker->a).head<2>() / fine, project(options.marker->b).head<2>() / fine};
        out.marker_text = options.marker->text;
    }
    out.title = options.title;
    choose_scale(project.scale / fine, options.width, out);
    return out;
}

Image inked(const Picture& picture) {
    Image image = picture.surfaces;
    for (const PictureLine& line : picture.edges) draw_line(image, line, ink, 1);
    if (picture.marker) {
        draw_line(image, *picture.marker, alarm, 2);
        draw_dot(image, picture.marker->from, alarm);
        draw_dot(image, picture.marker->to, alarm);
        const Vector2 at = picture.marker->to;
        const int width = text_width(picture.marker_text, 2);
        const int x = std::clamp(static_cast<int>(at.x()) + 12, 4, std::max(4, image.width - width - 4));
        const int y = std::clamp(static_cast<int>(at.y()) - 24, 4, std::max(4, image.height - 24));
        fill(image, {x - 3, y - 3, width + 4, 21}, white);
        write_text(image, x, y, picture.marker_text, alarm, 2);
    }
    ink_texts(picture, image);
    return image;
}

}  // namespace fettle::design::exports
