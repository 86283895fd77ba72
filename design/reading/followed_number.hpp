// SPDX-License-Identifier: MIT
/// Numbers of a scene file from which others follow as it is read: a joint's `point` stands in the world, so where the joint is on a body
/// follows from the body's position. A deviation of such a number alone would leave behind what follows from it.
/// Part of tolerance_reader.hpp.
#pragma once

#include <string>

#include "core/files/json_document.hpp"
#include "core/scene/place.hpp"

namespace fettle::design::reading {

/// Names the number that follows from the one at `place` as the file is read, and what to do instead; empty: nothing follows.
/// @param file  The scene's file, whose `joints`, `springs` and `dampers` say how their ends are given.
std::string what_follows(const core::files::JsonNode& file, const core::scene::Scene& scene, const core::scene::Place& place);

}  // namespace fettle::design::reading
