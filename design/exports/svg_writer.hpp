// SPDX-License-Identifier: MIT
/// A picture as SVG: surfaces as pixels inside it, edges, marker, legend and scale as vectors and text.
#pragma once

#include <string>

#include "fettle/design/exports/picture.hpp"

namespace fettle::design::exports {

/// One file that needs no other.
std::string svg_text(const Picture& picture);

}  // namespace fettle::design::exports
