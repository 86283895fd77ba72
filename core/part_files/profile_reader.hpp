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

#include <optional>
#include <string>
#include <vector>

#include "core/part_files/shape_reader.hpp"
#include "core/parts/path.hpp"

namespace fettle::core::part_files {

class ProfileReader;
using ProfileMaker = ShapeReader<ProfileReader, parts::Profile>::Maker;
using ProfilesMaker = ShapeReader<ProfileReader, parts::Profile>::ListMaker;

class ProfileReader : public ShapeReader<ProfileReader, parts::Profile> {
public:
    /// Both outlive this object. @param named  `profiles` of the file.
    ProfileReader(PartNumbers& numbers, const files::JsonNode& named) : ShapeReader(numbers, named, "profile") {}

    /// The profile of that name, drawn once on a sheet.
    static Result<parts::Profile> drawn_once(const std::string& name, const ProfileMaker& maker, Sheet& sheet);

private:
    friend ShapeReader;

    static const std::vector<Verb>& verbs();
    static std::optional<Error> fault_of(const parts::Profile& profile, const std::string& where);
    static std::optional<Error> fault_of(const std::vector<parts::Profile>& profiles, const std::string& where);
    ProfilesMaker repeated(const files::JsonNode& node, const std::string& name);

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
};

}  // namespace fettle::core::part_files
