// SPDX-License-Identifier: MIT
/// Triangles as pixels, the nearest to the viewer on top; and which stretches of a line nothing hides.
#pragma once

#include <array>
#include <vector>

#include "fettle/design/exports/png_writer.hpp"

namespace fettle::design::exports {

/// Points are (x, y, depth): pixels from the upper left corner, depth growing towards the viewer in the same unit.
class DepthBuffer {
public:
    /// @param background  of pixels that nothing covers.
    DepthBuffer(int width, int height, const core::mesh_files::Colour& background);

    /// Pixels whose centre lies inside. A triangle seen edge-on covers none.
    void add_triangle(const std::array<Vector3, 3>& corners, const core::mesh_files::Colour& colour);

    /// From 0 to 1 along the line: [begin, end] of each stretch that is not hidden by more than `tolerance` pixels of depth. Stretches
    /// below three pixels, where rounding to pixels decides, are left out unless the line itself is that short.
    std::vector<std::array<double, 2>> visible(const Vector3& from, const Vector3& to, double tolerance) const;

    const Image& image() const { return image_; }

private:
    bool is_visible(const Vector3& point, double tolerance) const;

    Image image_;
    std::vector<double> depth_;
};

}  // namespace fettle::design::exports
