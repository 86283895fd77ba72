// SPDX-License-Identifier: MIT
#include "design/reading/read_context.hpp"

#include "core/expression/parse_formula.hpp"
#include "core/files/nearest_word.hpp"

namespace fettle::design::reading {

using core::files::JsonNode;

std::optional<int> ReadContext::body(const JsonNode& node) const {
    const auto name = node.string();
    if (!name) return std::nullopt;
    std::vector<std::string_view> known;
    for (size_t k = 0; k < scene.bodies.size(); ++k) {
        if (scene.bodies[k].name == *name) return static_cast<int>(k);
        known.push_back(scene.bodies[k].name);
    }
    node.fail(ErrorCode::out_of_range, "the scene has no body " + node.shown() + "; " + core::files::did_you_mean(*name, known));
    return std::nullopt;
}

std::optional<Vector3> ReadContext::axis(const JsonNode& node) const {
    const auto vector = node.vector3();
    if (!vector) return std::nullopt;
    if (vector->norm() == 0) {
        node.fail(ErrorCode::out_of_range, "an axis is not the zero vector");
        return std::nullopt;
    }
    return vector->normalized();
}

double ReadContext::unit(Dimension dimension) const { return core::expression::plain_units(length_unit, grams)(dimension); }

double ReadContext::unit_of(std::initializer_list<JsonNode> bounds, Dimension dimension) const {
    const core::base::Unit* written = nullptr;
    for (const JsonNode& bound : bounds) {
        if (written != nullptr || !bound.is_string()) continue;
        const std::string text = *bound.string();
        if (text.find('=') != std::string::npos) continue;  // a formula
        for (const core::base::Unit& unit : core::base::units()) {
            const bool longer = written == nullptr || unit.name.size() > written->name.size();
            if (unit.dimension == dimension && longer && text.ends_with(unit.name)) written = &unit;
        }
    }
    return written != nullptr ? core::base::to_si(1, *written) : unit(dimension);
}

std::string unique_name(const std::string& wanted, std::set<std::string>& taken) {
    std::string name = wanted;
    for (int k = 2; !taken.insert(name).second; ++k) name = wanted + " " + std::to_string(k);
    return name;
}

}  // namespace fettle::design::reading
