// SPDX-License-Identifier: MIT
/// Which kind of JSON file is this? By a key of its outermost object, in whatever order its keys stand, without reading it as a document:
/// trajectories and certificates may be large. The key's value is the version of its format.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace fettle::core::files {

class JsonNode;

/// Which of these keys the file's outermost object has first; empty: none. Reads up to where it stands. A file that cannot be read or is no
/// object has none; for a file that is not JSON the answer may be either, for its reader to say what is wrong. Contract: keys without
/// characters that JSON escapes.
std::string_view top_level_key(const std::filesystem::path& path, std::span<const std::string_view> keys);

/// Is there this one?
bool has_top_level_key(const std::filesystem::path& path, std::string_view key);

/// A remark on an object that has none of the keys that say a format: "; did you mean `fettle_scene`, where `fetle_scene` stands?". Empty:
/// none of its keys is near to one.
std::string misspelt_key(const JsonNode& object, const std::vector<std::string_view>& formats);

/// Is the value of such a key the version that is read here? Otherwise the node fails, with what is.
bool is_version(const JsonNode& node, int version);

}  // namespace fettle::core::files
