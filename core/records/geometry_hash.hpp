// SPDX-License-Identifier: MIT
/// Are these bodies the ones that a file was written with?
#pragma once

#include <cstdint>

#include "core/model/model.hpp"

namespace fettle::core::records {

/// FNV-1a over names, vertices (their bits, relative to the reference point), triangles and edges of all bodies, and
/// what their mass is per where that is not their volume.
std::uint64_t geometry_hash(const model::Model& model);

}  // namespace fettle::core::records
