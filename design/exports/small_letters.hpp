// SPDX-License-Identifier: MIT
/// Letters for pictures made of pixels: ASCII, 5 x 7 and one row for what hangs below, 1 between them, as on character displays.
#pragma once

#include <string_view>

#include "fettle/design/exports/png_writer.hpp"

namespace fettle::design::exports {

/// Width of a text [pixels].
int text_width(std::string_view text, int scale);

/// Its upper left corner is at (x, y); what lies outside is left out. What is not ASCII shows as one `?` a character.
void write_text(Image& image, int x, int y, std::string_view text, const core::mesh_files::Colour& colour, int scale);

}  // namespace fettle::design::exports
