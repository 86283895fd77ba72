// SPDX-License-Identifier: MIT
/// Triangles as pixels, the nearest to the viewer on top; which stretches of a line nothing hides; and a cut, which takes away what stands
/// before it and shows the material that it goes through.
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <vector>

#include "fettle/design/exports/png_writer.hpp"

namespace fettle::design::exports {

/// What is nearer to the viewer than `depth` within a circle is taken away. Pixels.
struct Cut {
    Vector2 centre = Vector2::Zero();
    double radius = std::numeric_limits<double>::infinity();
    double depth = 0;
};

/// Points are (x, y, depth): pixels from the upper left corner, depth growing towards the viewer in the same unit.
class DepthBuffer {
public:
    /// @param background  of pixels that nothing covers.
    DepthBuffer(int width, int height, const core::mesh_files::Colour& background, std::optional<Cut> cut = std::nullopt);

    /// Pixels whose centre lies inside. A triangle seen edge-on covers none.
    void add_triangle(const std::array<Vector3, 3>& corners, const core::mesh_files::Colour& colour);

    /// After the triangles of a closed solid, turned outwards: where the cut goes through its material, it is hatched in `colour`; where
    /// it goes through that of a solid before as well, it is `shared`. A point of the cut lies inside if behind it more triangles turn away
    /// from the viewer than towards him.
    void close_solid(const core::mesh_files::Colour& colour, const core::mesh_files::Colour& shared);
    /// After those of what is not closed: it has no material.
    void close_open();

    /// Is it not hidden by more than `tolerance` pixels of depth, nor cut away?
    bool is_visible(const Vector3& point, double tolerance) const;

    /// From 0 to 1 along the line: [begin, end] of each stretch that is visible. Stretches below three pixels, where rounding to pixels
    /// decides, are left out unless the line itself is that short.
    std::vector<std::array<double, 2>> visible(const Vector3& from, const Vector3& to, double tolerance) const;

    const Image& image() const { return image_; }

private:
    bool is_in_cut(int x, int y) const;

    Image image_;
    std::vector<double> depth_;
    std::optional<Cut> cut_;
    std::vector<short> turns_;    // of the solid at hand, behind the cut: triangles turned away less those turned to the viewer
    std::vector<char> in_solid_;  // where the cut goes through a solid's material
};

}  // namespace fettle::design::exports
