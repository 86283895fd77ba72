// SPDX-License-Identifier: MIT
/// Lengths as decimal numbers of millimetres, for files whose readers multiply by 1e-3.
#pragma once

#include <string>

namespace fettle::core::mesh_files {

/// The shortest decimal v with v * 1e-3 == x in double precision, of the doubles next to 1000 x; where none of them does it, of the
/// nearest.
/// @param x  [m], finite.
std::string millimetres(double x);

/// The shortest decimal that reads back as x.
std::string decimal(double x);

}  // namespace fettle::core::mesh_files
