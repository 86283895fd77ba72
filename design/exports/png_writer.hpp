// SPDX-License-Identifier: MIT
/// Pixels as PNG, and bytes as base64 for data URLs.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "fettle/core/mesh_files/mesh_writer.hpp"

namespace fettle::design::exports {

struct Image {
    int width = 0, height = 0;
    std::vector<core::mesh_files::Colour> pixels;  ///< row by row from the top

    core::mesh_files::Colour& at(int x, int y) {
        return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
    }
    const core::mesh_files::Colour& at(int x, int y) const {
        return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
    }
};

/// 8 bits a channel, no alpha.
std::string png_bytes(const Image& image);

std::string base64(std::string_view bytes);

}  // namespace fettle::design::exports
