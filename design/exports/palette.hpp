// SPDX-License-Identifier: MIT
/// The colours of all that shows a mechanism: `fettle draw`, animations, the report, the documents' pictures.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "core/mesh_files/mesh_writer.hpp"
#include "core/model/model.hpp"

namespace fettle::design::exports {

using core::mesh_files::Colour;

/// Paper; lines and text; where two bodies are nearest; where something is wrong: material that two bodies share, a limit. No part has
/// these. The report's page and the documents' pictures have the last three too (design/report/web/src/style.css, docs/pictures/draw.py).
inline constexpr Colour white{255, 255, 255}, ink{29, 32, 36}, nearest{31, 86, 196}, alarm{194, 24, 47};

/// The colour of moving part number `index`: eight colours that people with any colour vision can distinguish (after Okabe and Ito,
/// lighter, so that they can be shaded), from the ninth on the same in paler tones.
Colour part_colour(int index);

/// A colour for each body. Fixed bodies are pale beside those that move; where nothing moves, none is.
std::vector<Colour> part_colours(const core::model::Model& model);

/// A part's colour under so much light: 1 as it is. The page's materials (design/report/web/src/materials.js) do the same.
inline Colour lit(const Colour& colour, double light) {
    Colour out{};
    for (std::size_t k = 0; k < 3; ++k) out[k] = static_cast<unsigned char>(std::min(255.0, colour[k] * light + 0.5));
    return out;
}

/// Light of a part's edges, and of the lines that hatch its material in a cut.
inline constexpr double edge_light = 0.42, hatch_light = 0.66;

/// "#1f56c4".
std::string css_colour(const Colour& colour);

}  // namespace fettle::design::exports
