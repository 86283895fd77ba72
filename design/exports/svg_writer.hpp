// SPDX-License-Identifier: MIT
/// A picture as SVG: surfaces as pixels inside it; edges, marker, legend and scale as vectors. Written by hand, not by cairo, whose letters
/// are outlines and whose shapes have no order that a reader knows: here words can be searched, copied, read aloud and edited, and a diff
/// of two pictures shows what differs.
#pragma once

#include <string>

#include "design/exports/picture.hpp"

namespace fettle::design::exports {

/// One file that needs no other. Throws core::base::MissingLibrary where cairo, which packs the pixels, is not there.
std::string svg_text(const Picture& picture);

}  // namespace fettle::design::exports
