// SPDX-License-Identifier: MIT
/// Is a mesh a solid's? Judged by CGAL, which shares nothing with core/solids.
#pragma once

#include <string>

#include "core/geometry/mesh.hpp"

namespace fettle::tests::support {

/// What is wrong with it: no surface, open, inside out, crosses itself. Empty: nothing.
std::string fault_of_solid(const core::geometry::Mesh& mesh);

}  // namespace fettle::tests::support
