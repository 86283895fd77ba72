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

/// A remark on an object that has none of the keys that say a format: "; by its `fettle_process` it is a process, which --process takes"
/// for another of fettle's own files, "; did you mean `fettle_scene`, where `fetle_scene` stands?" for a misspelt one. Empty: it is
/// neither.
std::string format_remark(const JsonNode& object, const std::vector<std::string_view>& formats);

/// Is the value of such a key the version that is read here? Otherwise the node fails, with what is.
bool is_version(const JsonNode& node, int version);

/// Is the file of this format, in the version that is read here? Otherwise the root fails: "no process: the key `fettle_process` is
/// missing", with the remark. @param name  What such a file is: "process".
bool is_format(const JsonNode& root, std::string_view key, std::string_view name, int version);

}  // namespace fettle::core::files
