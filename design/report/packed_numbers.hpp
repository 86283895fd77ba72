// SPDX-License-Identifier: MIT
/// Numbers as the report's page takes them: base64 of their bytes, lowest first, under a key that names their type.
///   {"f32": "..."}, {"f64": "..."}, {"u32": "..."}
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <vector>

namespace fettle::design::report {

nlohmann::ordered_json packed(const std::vector<float>& numbers);
nlohmann::ordered_json packed(const std::vector<double>& numbers);
nlohmann::ordered_json packed(const std::vector<std::uint32_t>& numbers);

}  // namespace fettle::design::report
