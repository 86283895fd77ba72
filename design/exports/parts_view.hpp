// SPDX-License-Identifier: MIT
/// Parts where they are, as shaded pixels with the edges that can be seen, from any side, whole or cut.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <vector>

#include "core/geometry/mesh.hpp"
#include "design/exports/assembly.hpp"
#include "design/exports/depth_buffer.hpp"
#include "design/exports/projection_view.hpp"

namespace fettle::design::exports {

struct PictureLine {
    Vector2 from = Vector2::Zero(), to = Vector2::Zero();  ///< pixels from the upper left corner
};

/// World [m] to pixels of a picture, and depth towards the viewer in pixels.
struct Projection {
    ProjectionView view;
    double scale = 1;  ///< pixels per metre
    Vector2 centre = Vector2::Zero(), middle = Vector2::Zero();

    Vector3 operator()(const Vector3& x) const {
        return {middle.x() + scale * (view.right.dot(x) - centre.x()), middle.y() - scale * (view.up.dot(x) - centre.y()),
                scale * view.towards.dot(x)};
    }
};

/// The visible stretches of the edges of one part.
struct PartEdges {
    Colour colour{};
    std::vector<PictureLine> lines;
};

struct ViewedParts {
    Image surfaces;                ///< shaded, on white, no edges
    std::vector<PartEdges> edges;  ///< of each part
};

class PartsView {
public:
    /// @param crease  faces that meet at a larger angle have an edge between them; across others light changes smoothly [rad].
    /// Contract: one pose per part, which outlive this.
    PartsView(const Assembly& assembly, const std::vector<core::kinematics::Pose>& poses, double crease);

    /// As large as the picture allows.
    Projection fitted(const ProjectionView& view, int width, int height) const;
    /// Diagonal of the box of all parts [m].
    double diagonal() const;
    /// Does a part hide this point [m]? The nearest of all edges to the viewer hides none of itself.
    bool hides(const Vector3& point, const Projection& projection, int width, int height) const;
    /// @param cut  in the picture's pixels.
    ViewedParts seen(const Projection& projection, int width, int height, const std::optional<Cut>& cut = std::nullopt) const;

private:
    struct Part;

    DepthBuffer drawn(const Projection& fine_projection, int width, int height, const std::optional<Cut>& cut) const;
    std::vector<PictureLine> visible_edges(const Part& part, const DepthBuffer& buffer, const Projection& fine_projection) const;

    struct Part {
        const AssemblyPart* part = nullptr;
        Matrix3X vertices;
        std::vector<Vector3> normals;                                // of triangles
        std::vector<std::array<Vector3, 3>> corner_normals;          // of their corners, across faces that meet below the crease
        std::map<core::geometry::Edge, std::vector<int>> triangles;  // at each edge
        bool is_closed = false;
    };
    std::vector<Part> parts_;
    double crease_;
};

}  // namespace fettle::design::exports
