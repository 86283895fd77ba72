// SPDX-License-Identifier: MIT
/// A tree of JSON as text. Names, paths and words of other programs may hold bytes that are no UTF-8, which JSON cannot have: U+FFFD stands
/// for each, where the library would throw.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace fettle::core::files {

/// @param indent  spaces a level; negative: all on one line
template <class Json>
std::string dumped(const Json& json, int indent = -1) {
    return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace fettle::core::files
