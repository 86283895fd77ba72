// SPDX-License-Identifier: MIT
/// Lists of vertex indices, as both scene formats write triangles and edges.
#pragma once

#include <array>
#include <vector>

#include "core/files/json_document.hpp"

namespace fettle::core::files {

/// Rows of `columns` vertex indices from 0 and below `limit`. Faults go to the document; a row of the wrong length is left out.
template <std::size_t columns>
std::vector<std::array<int, columns>> index_rows(const JsonNode& node, int limit) {
    std::vector<std::array<int, columns>> rows;
    for (const JsonNode& row : node.elements()) {
        const auto entries = row.elements();
        if (entries.size() != columns) {
            row.fail(base::ErrorCode::wrong_type,
                     "a list of " + std::to_string(columns) + " vertex indices is expected, found " + row.shown());
            continue;
        }
        std::array<int, columns> indices{};
        for (std::size_t i = 0; i < columns; ++i) indices[i] = entries[i].integer(0, limit - 1).value_or(0);
        rows.push_back(indices);
    }
    return rows;
}

}  // namespace fettle::core::files
