// SPDX-License-Identifier: MIT
/// Triangles as pixels, the nearest to the viewer on top; which stretches of a line nothing hides; and a cut, which takes away what stands
/// before it and shows the material that it goes through.
/// By hand: cairo draws in the plane and knows no depth; OpenGL takes a driver, whose pixels differ from machine to machine.
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <vector>

#include "design/exports/image.hpp"
#include "design/exports/palette.hpp"

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
    DepthBuffer(int width, int height, const Colour& background, std::optional<Cut> cut = std::nullopt);

    /// Pixels whose centre lies inside. A triangle seen edge-on covers none; of two that lie in each other the one before stays.
    /// @param light  of the corners, and between them linearly.
    void add_triangle(const std::array<Vector3, 3>& corners, const std::array<double, 3>& light, const Colour& colour);

    /// After the triangles of a closed solid, turned outwards: where the cut goes through its material, it is hatched in `colour`; where
    /// it goes through that of a solid before as well, it is `shared`. A point of the cut lies inside if behind it more triangles turn away
    /// from the viewer than towards him.
    /// @param hatch  across its lines, one over their distance long [1/pixels].
    void close_solid(const Colour& colour, const Colour& shared, const Vector2& hatch);
    /// After the triangles of a mesh that is not closed: it has no material.
    void close_open();

    /// After all: material in the cut has a line round it, a pixel on each side.
    void outline_cut();

    /// Is it not hidden by more than `tolerance` pixels of depth, nor cut away?
    bool is_visible(const Vector3& point, double tolerance) const;

    /// From 0 to 1 along the line: [begin, end] of each stretch that is visible. Stretches below three pixels, where rounding to pixels
    /// decides, are left out unless the line itself is that short.
    std::vector<std::array<double, 2>> visible(const Vector3& from, const Vector3& to, double tolerance) const;

    const Image& image() const { return image_; }

private:
    bool is_in_cut(int x, int y) const;
    bool is_in_material(int x, int y) const;
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(image_.width) + static_cast<std::size_t>(x);
    }

    Image image_;
    std::vector<double> depth_;
    std::optional<Cut> cut_;
    std::vector<short> turns_;  // of the solid at hand, behind the cut: triangles turned away less those turned to the viewer
    std::vector<int> solid_;    // whose material the cut goes through: its number from 1 on, 0: nobody's
    int solids_ = 0;
};

}  // namespace fettle::design::exports
