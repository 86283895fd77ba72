// SPDX-License-Identifier: MIT
/// Pictures as PNG, drawn by cairo: lines, circles and letters are anti-aliased. Letters are those of DejaVu Sans (Debian's
/// fonts-dejavu-core); where that is not, cairo's own, which are ASCII. No other font of a machine, nor its settings of fonts, changes a
/// picture, and nothing but the letters differs between the two.
#pragma once

#include <string>

#include "design/exports/image.hpp"
#include "design/exports/picture.hpp"

namespace fettle::design::exports {

/// 8 bits a channel, no alpha. Throws core::base::MissingLibrary where cairo is not there.
std::string png_bytes(const Image& image);

/// Where Debian has DejaVu Sans.
inline constexpr const char* font_folder = "/usr/share/fonts/truetype/dejavu";

/// All of a picture, likewise.
/// @param fonts  has DejaVuSans.ttf and DejaVuSans-Bold.ttf, or not.
std::string png_bytes(const Picture& picture, const std::string& fonts = font_folder);

}  // namespace fettle::design::exports
