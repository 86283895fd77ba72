// SPDX-License-Identifier: MIT
/// Rows of the scenes benchmark as JSON, and their comparison with stored ones.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tests/benchmarks/scene_run.hpp"

namespace fettle::tests::benchmarks {

/// One line, without its end. Infinite numbers are null. `extra`: members to add, as JSON text without braces.
std::string to_json(const SceneRow& row, const std::string& extra = {});
std::optional<SceneRow> row_from_json(const std::string& text);

/// A baseline file: {"scenes_baseline": 1, "rows": [row, ...]}.
std::optional<std::vector<SceneRow>> read_baseline(const std::string& path);
bool write_baseline(const std::string& path, const std::vector<SceneRow>& rows);

const SceneRow* find_row(const std::vector<SceneRow>& rows, const std::string& scene);

}  // namespace fettle::tests::benchmarks
