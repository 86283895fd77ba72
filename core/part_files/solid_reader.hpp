// SPDX-License-Identifier: MIT
/// Solids of a part's file. An object with one verb, and the keys that go with it; or the name of one of `solids`. Profiles in it are
/// objects or names (profile_reader.hpp).
///     {"extrude": profile, "from": 0, "to": 5, "chamfer": 0.3}      along z; or "chamfer_below", "chamfer_above"; < 0: a flare
///     {"stack": [{"layer": profile, "height": 2}, ...], "from": 0}  layers upon each other, each may have chamfers;
///                                                                   {"repeat": [layers], "count": n} among them
///     {"revolve": profile, "angle": "90deg", "from": 0}             about z: the profile's x is the distance from it, its y is z
///     {"twist": profile, "from": 0, "to": 10, "by": "30deg"}        turned as it rises: helical gears, threads
///     {"helix": profile, "pitch": 2, "turns": 5}                    carried round z as it rises: springs
///     {"sphere": 5}   {"cone": [4, 0], "height": 8}   {"torus": [10, 2]}        radii
///     {"subtract": [a, b], "from": c}   {"union": [a, b]}   {"intersect": [a, b]}
///     {"move": a, "by": [x, y, z]}   {"turn": a, "by": "90deg", "axis": [0, 0, 1], "about": [x, y, z]}   {"mirror": a, "across": "xy"}
///     {"repeat": a, "count": 6, "axis": [0, 0, 1], "about": [x, y, z], "every": "60deg"}        or "step": [x, y, z]
/// Part of part_file.hpp.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/part_files/profile_reader.hpp"
#include "core/parts/extrude.hpp"

namespace fettle::core::part_files {

/// Where something at `where` would have more facets than are drawn. @param how  "at least ", "up to ", or nothing
std::optional<Error> too_many_facets(double count, const char* how, const std::string& where);

class SolidReader;
using SolidMaker = ShapeReader<SolidReader, parts::Solid>::Maker;
using SolidsMaker = ShapeReader<SolidReader, parts::Solid>::ListMaker;

class SolidReader : public ShapeReader<SolidReader, parts::Solid> {
public:
    /// All outlive this object. @param named  `solids` of the file.
    SolidReader(PartNumbers& numbers, ProfileReader& profiles, const files::JsonNode& named)
        : ShapeReader(numbers, named, "solid"), profiles_(profiles) {}

    /// The verbs, and the keys that go with each.
    static std::vector<std::pair<std::string_view, std::vector<std::string_view>>> keys();

private:
    friend ShapeReader;
    struct Ends;

    static const std::vector<Verb>& verbs();
    static Result<parts::Solid> drawn_once(const std::string& name, const SolidMaker& maker, Sheet& sheet);
    static std::optional<Error> fault_of(const parts::Solid& solid, const std::string& where);
    static std::optional<Error> fault_of(const std::vector<parts::Solid>& solids, const std::string& where);
    SolidsMaker repeated(const files::JsonNode& node, const std::string& name);
    Ends read_ends(const files::JsonNode& node);

    SolidMaker extrude(const files::JsonNode& node, const std::string& name);
    SolidMaker stack(const files::JsonNode& node, const std::string& name);
    SolidMaker revolve(const files::JsonNode& node, const std::string& name);
    SolidMaker twist(const files::JsonNode& node, const std::string& name);
    SolidMaker helix(const files::JsonNode& node, const std::string& name);
    SolidMaker sphere(const files::JsonNode& node, const std::string& name);
    SolidMaker cone(const files::JsonNode& node, const std::string& name);
    SolidMaker torus(const files::JsonNode& node, const std::string& name);
    SolidMaker subtract(const files::JsonNode& node, const std::string& name);
    SolidMaker unite(const files::JsonNode& node, const std::string& name);
    SolidMaker intersect(const files::JsonNode& node, const std::string& name);
    SolidMaker move(const files::JsonNode& node, const std::string& name);
    SolidMaker turn(const files::JsonNode& node, const std::string& name);
    SolidMaker mirror(const files::JsonNode& node, const std::string& name);
    SolidMaker repeat(const files::JsonNode& node, const std::string& name);

    ProfileReader& profiles_;
};

}  // namespace fettle::core::part_files
