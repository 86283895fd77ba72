// SPDX-License-Identifier: MIT
#include "core/files/json_keys.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <string>

#include "core/files/input_file.hpp"
#include "core/files/json_document.hpp"
#include "core/files/nearest_word.hpp"

namespace fettle::core::files {
namespace {

/// The files of fettle that one may give in place of another.
struct OwnFormat {
    std::string_view key, name, use;
};
constexpr std::array own_formats{
    OwnFormat{"fettle_scene", "a scene", "`fettle simulate` takes, and a design names"},
    OwnFormat{"rigid_body_problem", "a scene", "`fettle simulate` takes, and a design names"},
    OwnFormat{"fettle_design", "a design", "`fettle optimise` takes; the scene is the file that its `scene` names"},
    OwnFormat{"fettle_part", "a part", "a scene names as the shape of a body; `fettle validate` looks at it alone"},
    OwnFormat{"fettle_process", "a process", "--process takes, and a design names"},
    OwnFormat{"fettle_poses", "a table of poses", "--poses takes"},
    OwnFormat{"fettle_trajectory", "a trajectory", "`fettle clearance` takes"},
    OwnFormat{"fettle_certificate", "a certificate", "`fettle validate` checks"},
    OwnFormat{"fettle_range_certificate", "a certificate", "`fettle validate` checks"},
};

bool is_quote_or_bracket(char c) { return c == '"' || c == '{' || c == '}' || c == '[' || c == ']'; }
bool ends_or_escapes(char c) { return c == '"' || c == '\\'; }

// Takes a file's text, piece by piece.
class KeyFinder {
public:
    explicit KeyFinder(std::span<const std::string_view> keys) : keys_(keys) {
        for (const std::string_view key : keys) longest_ = std::max(longest_, key.size());
    }

    /// Empty: none.
    std::string_view found() const { return found_; }
    /// False: there is nothing more to look for.
    bool take(std::string_view text) {
        for (std::size_t i = 0; i < text.size(); ++i) {
            if (depth_ > 1 && !escaped_) {  // little matters below the top
                const auto rest = text.begin() + static_cast<std::ptrdiff_t>(i);
                const auto next =
                    in_string_ ? std::find_if(rest, text.end(), ends_or_escapes) : std::find_if(rest, text.end(), is_quote_or_bracket);
                if (next == text.end()) return true;
                i = static_cast<std::size_t>(next - text.begin());
            }
            if (!take(text[i])) return false;
        }
        return true;
    }

private:
    bool take(char c) {
        if (in_string_) {
            take_in_string(c);
        } else if (c == '"') {
            in_string_ = true;
            text_.clear();
        } else if (c == '{' || c == '[') {
            ++depth_;
        } else if (c == '}' || c == ']') {
            --depth_;
        } else if (c == ':') {
            if (depth_ == 1)
                if (const auto key = std::find(keys_.begin(), keys_.end(), text_); key != keys_.end()) found_ = *key;
        }
        if (depth_ > 0) return found_.empty();
        // Before the object only white space and a byte order mark may stand, after it nothing is of interest.
        return !in_string_ && (c == ' ' || c == '\t' || c == '\n' || c == '\r' || static_cast<unsigned char>(c) >= 0x80);
    }

    void take_in_string(char c) {
        if (!escaped_ && c == '"') {
            in_string_ = false;
            return;
        }
        escaped_ = !escaped_ && c == '\\';
        if (depth_ == 1 && text_.size() <= longest_) text_ += c;
    }

    std::span<const std::string_view> keys_;
    std::size_t longest_ = 0;
    std::string_view found_;
    std::string text_;  // of the last string, if at the top; cut off behind the longest key's length
    long depth_ = 0;
    bool in_string_ = false, escaped_ = false;
};

}  // namespace

std::string_view top_level_key(const std::filesystem::path& path, std::span<const std::string_view> keys) {
    base::Result<InputFile> file = InputFile::open(path);
    if (!file) return {};
    KeyFinder finder(keys);
    for (std::string_view block = file->next(); !block.empty(); block = file->next())
        if (!finder.take(block)) return finder.found();
    return {};
}

bool has_top_level_key(const std::filesystem::path& path, std::string_view key) { return !top_level_key(path, {&key, 1}).empty(); }

std::string format_remark(const JsonNode& object, const std::vector<std::string_view>& formats) {
    if (!object.is_object()) return {};
    for (const OwnFormat& format : own_formats)
        if (object[format.key].exists())
            return "; by its `" + std::string(format.key) + "` it is " + std::string(format.name) + ", which " + std::string(format.use);
    for (const auto& [key, value] : object.members())
        if (const auto meant = nearest_word(key, formats)) return "; did you mean `" + *meant + "`, where `" + key + "` stands?";
    return {};
}

bool is_version(const JsonNode& node, int version) {
    const auto found = node.integer(std::numeric_limits<int>::min(), std::numeric_limits<int>::max());
    if (!found || *found == version) return found.has_value();
    node.fail(ErrorCode::out_of_range, "a file of version " + std::to_string(*found) + " is not read: this program reads version " +
                                           std::to_string(version) + (*found > version ? "; was it written for a newer fettle?" : ""));
    return false;
}

bool is_format(const JsonNode& root, std::string_view key, std::string_view name, int version) {
    if (root.is_object() && root[key].exists()) return is_version(root[key], version);
    root.fail(ErrorCode::missing_key,
              "no " + std::string(name) + ": the key `" + std::string(key) + "` is missing" + format_remark(root, {key}));
    return false;
}

}  // namespace fettle::core::files
