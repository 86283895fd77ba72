// SPDX-License-Identifier: MIT
#include "design/reading/former_moves.hpp"

#include <vector>

#include "core/expression/parse_formula.hpp"
#include "core/scene/place.hpp"

namespace fettle::design::reading {
namespace {

using core::files::JsonNode;

constexpr std::pair<std::string_view, std::string_view> subjects[] = {
    {"body", "/bodies/"},  {"joint", "/joints/"}, {"spring", "/springs/"}, {"damper", "/dampers/"},
    {"motor", "/motors/"}, {"load", "/loads/"},   {"gravity", "/gravity"}, {"dmin", "/contact/dmin"}};

std::string word(const JsonNode& node) { return core::scene::escaped(node.is_string() ? *node.string() : node.shown()); }

// Where the number is, or the vector.
std::string place_of(const JsonNode& move, std::string& vector_key) {
    for (const auto& [key, place] : subjects) {
        if (!move[key].exists()) continue;
        if (place.back() != '/') {
            vector_key = key;
            return std::string(place);
        }
        std::string out = std::string(place) + word(move[key]);
        for (const auto& [property, value] : move.members()) {
            if (property == key || property == "scale" || property == "offset") continue;
            vector_key = property;
            if (property == "dimension") return out + "/shape/dimensions/" + word(value);
            if (property == "velocity") return out + "/linear_velocity";
            if (property == "lower_limit") return out + "/limits/0";
            if (property == "upper_limit") return out + "/limits/1";
            if (property == "value") return out + "/curve/values/" + word(value);
            if (property == "rate") return "/bodies/" + word(move[key]) + "/prescribed/" + word(value) + "/rate";
            return out + "/" + property;
        }
        return out;
    }
    return move["material"].exists() ? "/materials/" + word(move["material"]) + "/mu" : "/friction/mu";
}

// The product; a factor of 1 is left out.
std::string multiple(const std::string& name, const std::string& scale) {
    return scale == "1" || scale.empty() ? name : scale == "-1" ? "-" + name : scale + " * " + name;
}

}  // namespace

std::string instead_of_moves(const JsonNode& moves, const std::string& parameter) {
    const std::string name = core::expression::quoted_if_needed(parameter);
    std::string lines;
    if (!moves.is_array()) return "formulas replace `moves`";
    for (const JsonNode& move : moves.elements()) {
        if (!move.is_object()) continue;
        std::string key;
        const std::string place = place_of(move, key);
        const std::string scale = move["scale"].exists() ? move["scale"].shown() : "";
        const JsonNode vector = move[key];
        const auto line = [&](const std::string& at, const std::string& formula) {
            lines += (lines.empty() ? "" : ", ") + std::string("\"") + at + "\": \"= " + formula + "\"";
        };
        if (!vector.is_array()) {
            line(place, multiple(name, scale));
            continue;
        }
        const std::vector<JsonNode> components = vector.elements();
        for (std::size_t k = 0; k < components.size(); ++k)
            if (components[k].shown() != "0") line(place + "/" + std::to_string(k), multiple(multiple(name, components[k].shown()), scale));
    }
    return "formulas replace `moves`. Write them in the scene, or in the design's `set`: " + lines +
           "; add the terms of other parameters there, and the offsets (docs/convert_moves.py rewrites a file)";
}

}  // namespace fettle::design::reading
