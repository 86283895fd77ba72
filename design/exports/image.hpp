// SPDX-License-Identifier: MIT
/// Pixels in memory.
#pragma once

#include <cstddef>
#include <vector>

#include "core/mesh_files/mesh_writer.hpp"

namespace fettle::design::exports {

struct Image {
    int width = 0, height = 0;
    std::vector<core::mesh_files::Colour> pixels;  ///< row by row from the top

    core::mesh_files::Colour& at(int x, int y) { return pixels[index(x, y)]; }
    const core::mesh_files::Colour& at(int x, int y) const { return pixels[index(x, y)]; }

private:
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
    }
};

}  // namespace fettle::design::exports
