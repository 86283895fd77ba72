// SPDX-License-Identifier: MIT
/// The colours of all that shows a mechanism: `fettle draw`, animations, the report, the documents' pictures.
#pragma once

#include <string>
#include <vector>

#include "fettle/core/mesh_files/mesh_writer.hpp"
#include "fettle/core/model/model.hpp"

namespace fettle::design::exports {

using core::mesh_files::Colour;

/// Paper; lines and text; where two bodies are nearest; where something is wrong: material that two bodies share, a limit. No part has
/// these. The report's page says the last two again (design/report/web/src/style.css).
inline constexpr Colour white{255, 255, 255}, ink{30, 30, 30}, nearest{31, 86, 196}, alarm{194, 24, 47};

/// The colour of moving part number `index`: eight colours that people with any colour vision can distinguish (after Okabe and Ito,
/// lighter, so that they can be shaded), from the ninth on the same in paler tones.
Colour part_colour(int index);

/// One for each body. What is fixed is pale beside what moves; where nothing moves, nothing is.
std::vector<Colour> part_colours(const core::model::Model& model);

/// "#1f56c4".
std::string css_colour(const Colour& colour);

}  // namespace fettle::design::exports
