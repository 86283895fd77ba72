// SPDX-License-Identifier: MIT
/// Profiles of a part's file: plane figures. An object with one verb, and the keys that go with it; or the name of one of `profiles`.
///     {"circle": 5, "centre": [x, y]}                      radius
///     {"rectangle": [20, 10], "centre" or "corner": [x, y]}
///     {"polygon": [[0, 0], [20, 0], [0, 10]]}
///     {"slot": [[0, 0], [20, 0]], "radius": 3}             round ends about the two points
///     {"path": [...]}                                      path_reader.hpp
///     {"law": {...}}                                       closed, curve_reader.hpp
///     {"spline": [points]}                                 closed, through the points
///     {"holes": [a, b], "in": c}                           which lie in the material and leave a wall everywhere
///     {"subtract": [a, b], "from": c}                      which may break through the outline
///     {"union": [a, b]}   {"intersect": [a, b]}   {"together": [a, b]}     the last of figures that do not touch
///     {"offset": a, "by": 0.2}                             grows it; shrinks it where negative
///     {"round": a, "radius": 1, "corners": "convex"}   {"chamfer": a, "by": 1, "corners": "concave"}
///     {"move": a, "by": [x, y]}   {"turn": a, "by": "30deg", "about": [x, y]}   {"mirror": a, "across": "x"}
///     {"repeat": a, "count": 6, "about": [x, y], "every": "60deg"}         or "step": [x, y]
/// In lists a repeat counts as its copies; one of no copies is nothing.
/// "name" says what messages call an outline; else it is called as the profile that it is drawn for. Part of part_file.hpp.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fettle/core/part_files/part_numbers.hpp"
#include "fettle/core/parts/path.hpp"

namespace fettle::core::part_files {

using ProfileMaker = std::function<Result<parts::Profile>(Sheet&)>;
using ProfilesMaker = std::function<Result<std::vector<parts::Profile>>(Sheet&)>;

/// Shapes within one another, names looked through, that are drawn; more are a fault.
inline constexpr int deepest_shape = 200;
inline constexpr int most_copies = 10'000;

class ProfileReader {
public:
    /// Both outlive this object. @param named  `profiles` of the file.
    ProfileReader(PartNumbers& numbers, const files::JsonNode& named);

    /// Reads all that have a name. Then read() may be called.
    void read_named();
    ProfileMaker read(const files::JsonNode& node, const std::string& name);
    /// What has been read must not outlive this.
    std::shared_ptr<const std::map<std::string, ProfileMaker>> named_makers() const { return makers_; }

private:
    struct Verb;
    using ReadProfile = ProfileMaker (ProfileReader::*)(const files::JsonNode&, const std::string&);

    static const std::vector<Verb>& verbs();
    ProfileMaker read_object(const files::JsonNode& node, const std::string& name);
    ProfilesMaker read_copies(const files::JsonNode& node, const std::string& name);
    ProfilesMaker read_list(const files::JsonNode& node, const std::string& name);
    ProfileMaker reference(const files::JsonNode& node);

    ProfileMaker circle(const files::JsonNode& node, const std::string& name);
    ProfileMaker rectangle(const files::JsonNode& node, const std::string& name);
    ProfileMaker polygon(const files::JsonNode& node, const std::string& name);
    ProfileMaker slot(const files::JsonNode& node, const std::string& name);
    ProfileMaker path(const files::JsonNode& node, const std::string& name);
    ProfileMaker law(const files::JsonNode& node, const std::string& name);
    ProfileMaker spline(const files::JsonNode& node, const std::string& name);
    ProfileMaker holes(const files::JsonNode& node, const std::string& name);
    ProfileMaker subtract(const files::JsonNode& node, const std::string& name);
    ProfileMaker unite(const files::JsonNode& node, const std::string& name);
    ProfileMaker intersect(const files::JsonNode& node, const std::string& name);
    ProfileMaker together(const files::JsonNode& node, const std::string& name);
    ProfileMaker offset(const files::JsonNode& node, const std::string& name);
    ProfileMaker round(const files::JsonNode& node, const std::string& name);
    ProfileMaker chamfer(const files::JsonNode& node, const std::string& name);
    ProfileMaker move(const files::JsonNode& node, const std::string& name);
    ProfileMaker turn(const files::JsonNode& node, const std::string& name);
    ProfileMaker mirror(const files::JsonNode& node, const std::string& name);
    ProfileMaker repeat(const files::JsonNode& node, const std::string& name);

    PartNumbers& numbers_;
    files::JsonNode named_;
    std::shared_ptr<std::map<std::string, ProfileMaker>> makers_;
};

/// The verb of a shape: which of `known` its object has as a key. Fault, and nothing: none, with what was probably meant; several.
std::optional<std::string> verb_of(const files::JsonNode& node, const std::vector<std::string_view>& known, std::string_view what);

/// The profile of that name, drawn once on a sheet.
Result<parts::Profile> profile_of(const std::string& name, const ProfileMaker& maker, Sheet& sheet);

}  // namespace fettle::core::part_files
