// SPDX-License-Identifier: MIT
#include "core/part_files/solid_reader.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/limits.hpp"
#include "core/base/text.hpp"
#include "core/parts/curve_geometry.hpp"
#include "core/parts/helix.hpp"
#include "core/parts/revolve.hpp"
#include "core/parts/solid_booleans.hpp"

namespace fettle::core::part_files {

using base::Dimension;
using base::ErrorCode;
using files::JsonNode;
using parts::Profile;
using parts::Solid;

struct SolidReader::Ends {
    PartNumber below, above;

    static parts::End end(const PartNumber& chamfer, const Sheet& sheet) {
        const Number size = chamfer.at(sheet);
        return size.value == 0 ? parts::End{} : parts::End{size, abs(size)};
    }
    parts::End lower(const Sheet& sheet) const { return end(below, sheet); }
    parts::End upper(const Sheet& sheet) const { return end(above, sheet); }
};

namespace {

constexpr double most_turns = 1000;

// Vertices that a profile becomes, at most: one more for each arc, whose flats may lie around it.
double vertex_count(const Profile& profile, const parts::Facets& of_drawing) {
    double out = 0;
    for (const parts::Loop& loop : profile.loops) {
        for (const parts::Segment& segment : loop.segments) {
            const parts::Facets& facets = segment.facets ? *segment.facets : of_drawing;
            if (const auto* arc = std::get_if<parts::Arc>(&segment.curve))
                out += 1 + parts::segments_wanted(facets, arc->radius.value, parts::sweep_value(*arc));
            else if (const int count = parts::facet_count(segment.curve, facets); count < parts::most_segments)
                out += count;  // else it is refused by name as it is drawn
        }
    }
    return out;
}

std::optional<Error> too_fine(double facets, const std::string& where) { return too_many_facets(facets, "up to ", where); }

std::optional<Error> too_fine(const Profile& profile, double layers, const Sheet& sheet, const std::string& where) {
    return too_fine(vertex_count(profile, sheet.drawing.facets) * layers, where);
}

double circle_segments(const Sheet& sheet, const Number& radius) {
    return parts::segments_wanted(sheet.drawing.facets, radius.value, 2 * std::numbers::pi);
}

Result<parts::Point3> direction_of(const PartPoint3& axis, const Sheet& sheet, const std::string& where) {
    const parts::Point3 out = axis.at(sheet);
    const double length = value(out).norm();
    if (length > 1e-100 && length < 1e100) return out;
    return Error{
        ErrorCode::out_of_range, where,
        "an axis has a direction, of any length that is not nearly 0 or infinite; found a length of " + base::formatted("%.3g", length)};
}

double whole_turn_segments(const Sheet& sheet, const Profile& profile) {
    double largest = 0;
    for (const parts::Loop& loop : profile.loops)
        for (const parts::Segment& segment : loop.segments) largest = std::max(largest, value(parts::end_of(segment.curve)).norm());
    return largest > 0 ? parts::segments_wanted(sheet.drawing.facets, largest, 2 * std::numbers::pi) : 1;
}

// Layers in order, those in a `repeat` as often as it says.
std::vector<JsonNode> repeated_layers(const JsonNode& stack, const PartNumbers& numbers) {
    constexpr int most = 1000;
    std::vector<JsonNode> out;
    for (const JsonNode& element : stack.objects()) {
        if (!element["repeat"].exists()) {
            out.push_back(element);
            continue;
        }
        element.allow_keys({"repeat", "count"});
        const std::vector<JsonNode> layers = element["repeat"].objects();
        const int count = numbers.count(element.require("count"), 0, most).value_or(0);
        for (int k = 0; k < count && out.size() < most; ++k) out.insert(out.end(), layers.begin(), layers.end());
    }
    if (out.size() >= most) stack.fail(ErrorCode::out_of_range, "a stack of at most 1000 layers is drawn");
    return out;
}

}  // namespace

std::optional<Error> too_many_facets(double count, const char* how, const std::string& where) {
    constexpr double most = 500'000;
    if (count <= most) return std::nullopt;
    return Error{ErrorCode::out_of_range, where,
                 "this would have " + std::string(how) + base::formatted(count < 1e9 ? "%.0f" : "%.3g", count) +
                     " facets; at most 500000 are drawn: take fewer copies, or coarser `facets` (a larger chord, fewer segments)"};
}

std::vector<std::pair<std::string_view, std::vector<std::string_view>>> SolidReader::keys() {
    std::vector<std::pair<std::string_view, std::vector<std::string_view>>> out;
    for (const Verb& verb : verbs()) out.emplace_back(verb.name, verb.keys);
    return out;
}

const std::vector<SolidReader::Verb>& SolidReader::verbs() {
    using S = SolidReader;
    static const std::vector<Verb> all{{"extrude", {"from", "to", "chamfer", "chamfer_below", "chamfer_above"}, &S::extrude},
                                       {"stack", {"from"}, &S::stack},
                                       {"revolve", {"from", "angle"}, &S::revolve},
                                       {"twist", {"from", "to", "by"}, &S::twist},
                                       {"helix", {"pitch", "turns"}, &S::helix},
                                       {"sphere", {}, &S::sphere},
                                       {"cone", {"height"}, &S::cone},
                                       {"torus", {}, &S::torus},
                                       {"subtract", {"from"}, &S::subtract},
                                       {"union", {}, &S::unite},
                                       {"intersect", {}, &S::intersect},
                                       {"move", {"by"}, &S::move},
                                       {"turn", {"by", "axis", "about"}, &S::turn},
                                       {"mirror", {"across"}, &S::mirror},
                                       {"repeat", {"count", "axis", "about", "every", "step"}, &S::repeat}};
    return all;
}

std::optional<Error> SolidReader::fault_of(const Solid& solid, const std::string& where) {
    for (const parts::Point3& p : solid.vertices)
        for (const double x : value(p))
            if (!base::is_usable_number(x)) return out_of_reach({}, where);
    return std::nullopt;
}

std::optional<Error> SolidReader::fault_of(const std::vector<Solid>& solids, const std::string& where) {
    double facets = 0;
    for (const Solid& solid : solids) facets += static_cast<double>(solid.triangles.size());
    return too_many_facets(facets, "", where);
}

Result<Solid> SolidReader::drawn_once(const std::string& name, const SolidMaker& maker, Sheet& sheet) {
    const std::pair key(name, sheet.drawing.facets.lean);
    const auto known = sheet.solids.find(key);
    if (known != sheet.solids.end()) return known->second;
    Result<Solid> made = maker(sheet);
    sheet.solids.emplace(key, made);
    return made;
}

SolidReader::Ends SolidReader::read_ends(const JsonNode& node) {
    const JsonNode both = node["chamfer"], below = node["chamfer_below"], above = node["chamfer_above"];
    if (both.exists() && (below.exists() || above.exists()))
        both.fail(ErrorCode::inconsistent, "`chamfer` is that of both ends; give `chamfer_below` and `chamfer_above` alone");
    return {numbers_.length(both.exists() ? both : below), numbers_.length(both.exists() ? both : above)};
}

SolidMaker SolidReader::extrude(const JsonNode& node, const std::string& name) {
    const ProfileMaker profile = profiles_.read(node["extrude"], name);
    const PartNumber from = numbers_.length(node["from"]), to = numbers_.length(node.require("to"));
    const Ends ends = read_ends(node);
    const std::string own = node["extrude"].is_string() ? *node["extrude"].string() : "";
    return [=, where = node.where()](Sheet& sheet) -> Result<Solid> {
        const Result<Profile> made = profile(sheet);
        if (!made) return made.errors();
        if (const auto error = too_fine(*made, 4, sheet, where)) return *error;
        return parts::stacked(sheet.drawing, {{*made, from.at(sheet), to.at(sheet), ends.lower(sheet), ends.upper(sheet), own}});
    };
}

SolidMaker SolidReader::stack(const JsonNode& node, const std::string& name) {
    struct Layer {
        ProfileMaker profile;
        PartNumber height;
        Ends ends;
        std::string name;
        std::string where;
    };
    std::vector<Layer> layers;
    for (const JsonNode& layer : repeated_layers(node["stack"], numbers_)) {
        layer.allow_keys({"layer", "height", "chamfer", "chamfer_below", "chamfer_above", "name"});
        const JsonNode profile = layer.require("layer");
        const std::string own = layer["name"].string().value_or(profile.is_string() ? *profile.string() : name);
        layers.push_back({profiles_.read(profile, own), numbers_.length(layer.require("height")), read_ends(layer), own, layer.where()});
    }
    if (layers.empty() && node["stack"].is_array()) node["stack"].fail(ErrorCode::out_of_range, "a stack has at least one layer");
    const PartNumber from = numbers_.length(node["from"]);
    return [=](Sheet& sheet) -> Result<Solid> {
        std::vector<parts::Layer> drawn;
        Number z = from.at(sheet);
        for (const Layer& layer : layers) {
            const Result<Profile> made = layer.profile(sheet);
            if (!made) return made.errors();
            if (const auto error = too_fine(*made, 4.0 * static_cast<double>(layers.size()), sheet, layer.where)) return *error;
            const Number top = z + layer.height.at(sheet);
            drawn.push_back({*made, z, top, layer.ends.lower(sheet), layer.ends.upper(sheet), layer.name});
            z = top;
        }
        return parts::stacked(sheet.drawing, drawn);
    };
}

SolidMaker SolidReader::revolve(const JsonNode& node, const std::string& name) {
    const ProfileMaker profile = profiles_.read(node["revolve"], name);
    if (node["from"].exists() && !node["angle"].exists())
        node["from"].fail(ErrorCode::inconsistent, "a whole revolution begins nowhere: `from` goes with an `angle`");
    const bool is_part = node["angle"].exists();
    const PartNumber from = numbers_.angle(node["from"]), angle = numbers_.angle(node["angle"]);
    return [=, where = node.where()](Sheet& sheet) -> Result<Solid> {
        const Result<Profile> made = profile(sheet);
        if (!made) return made.errors();
        if (const auto error = too_fine(*made, whole_turn_segments(sheet, *made), sheet, where)) return *error;
        return is_part ? parts::revolved(sheet.drawing, *made, from.at(sheet), angle.at(sheet)) : parts::revolved(sheet.drawing, *made);
    };
}

SolidMaker SolidReader::twist(const JsonNode& node, const std::string& name) {
    const ProfileMaker profile = profiles_.read(node["twist"], name);
    const PartNumber from = numbers_.length(node["from"]), to = numbers_.length(node.require("to")),
                     by = numbers_.angle(node.require("by"));
    return [=, where = node.where()](Sheet& sheet) -> Result<Solid> {
        const Result<Profile> made = profile(sheet);
        if (!made) return made.errors();
        const Number whole = by.at(sheet);
        const double turns = std::abs(whole.value) / (2 * std::numbers::pi);
        const auto error = too_fine(*made, 1 + turns * whole_turn_segments(sheet, *made), sheet, where);
        if (error || !(turns <= most_turns)) return error.value_or(Error{ErrorCode::out_of_range, where, "at most 1000 turns are drawn"});
        return parts::twisted(sheet.drawing, *made, from.at(sheet), to.at(sheet), whole);
    };
}

SolidMaker SolidReader::helix(const JsonNode& node, const std::string& name) {
    const ProfileMaker profile = profiles_.read(node["helix"], name);
    const PartNumber pitch = numbers_.length(node.require("pitch")), turns = numbers_.number(node.require("turns"), Dimension::number);
    return [=, where = node.where()](Sheet& sheet) -> Result<Solid> {
        const Result<Profile> made = profile(sheet);
        if (!made) return made.errors();
        const double count = turns.at(sheet).value;
        const auto error = too_fine(*made, 1 + count * whole_turn_segments(sheet, *made), sheet, where);
        if (error || !(count <= most_turns)) return error.value_or(Error{ErrorCode::out_of_range, where, "at most 1000 turns are drawn"});
        return parts::along_helix(sheet.drawing, *made, pitch.at(sheet), turns.at(sheet));
    };
}

SolidMaker SolidReader::sphere(const JsonNode& node, const std::string& name) {
    const PartNumber radius = numbers_.length(node["sphere"]);
    return [=, where = node.where()](Sheet& sheet) -> Result<Solid> {
        const Number r = radius.at(sheet);
        const double segments = circle_segments(sheet, r);
        if (const auto error = too_fine(segments * segments, where)) return *error;
        return parts::sphere(sheet.drawing, r, name);
    };
}

SolidMaker SolidReader::cone(const JsonNode& node, const std::string& name) {
    const PartPoint radii = read_point(node["cone"], numbers_);
    const PartNumber height = numbers_.length(node.require("height"));
    return [=, where = node.where()](Sheet& sheet) -> Result<Solid> {
        const parts::Point2 r = radii.at(sheet);
        if (const auto error = too_fine(4.0 * circle_segments(sheet, r.x.value > r.y.value ? r.x : r.y), where)) return *error;
        return parts::cone(sheet.drawing, r.x, r.y, height.at(sheet), name);
    };
}

SolidMaker SolidReader::torus(const JsonNode& node, const std::string& name) {
    const PartPoint radii = read_point(node["torus"], numbers_);
    return [=, where = node.where()](Sheet& sheet) -> Result<Solid> {
        const parts::Point2 r = radii.at(sheet);
        if (const auto error = too_fine(2 * circle_segments(sheet, r.x + r.y) * circle_segments(sheet, r.y), where)) return *error;
        return parts::torus(sheet.drawing, r.x, r.y, name);
    };
}

SolidsMaker SolidReader::repeated(const JsonNode& node, const std::string& name) {
    node.allow_keys({"repeat", "count", "axis", "about", "every", "step", "name"});
    const SolidMaker what = read(node["repeat"], node["name"].string().value_or(name));
    const int count = numbers_.count(node.require("count"), 0, base::most_copies).value_or(0);
    const bool is_linear = node["step"].exists();
    if (is_linear && (node["about"].exists() || node["every"].exists() || node["axis"].exists()))
        node.fail(ErrorCode::inconsistent, "copies are moved by a `step`, or turned about an `axis`, not both");
    const PartPoint3 step = read_point3(node["step"], numbers_), about = read_point3(node["about"], numbers_);
    PartPoint3 axis = read_point3(node["axis"], numbers_, Dimension::number);
    if (!node["axis"].exists()) axis.z.formula = expression::constant_formula(1);
    const std::optional<PartNumber> every =
        node["every"].exists() ? std::optional(numbers_.angle(node["every"])) : std::optional<PartNumber>();
    return [=, where = node.where()](Sheet& sheet) -> Result<std::vector<Solid>> {
        if (count == 0) return std::vector<Solid>();
        const Result<Solid> made = what(sheet);
        if (!made) return made.errors();
        if (const auto error = too_many_facets(static_cast<double>(made->triangles.size()) * count, "", where)) return *error;
        if (is_linear) return parts::linear_copies(*made, count, step.at(sheet));
        const auto direction = direction_of(axis, sheet, where);
        if (!direction) return direction.errors();
        if (every) return parts::polar_copies(*made, count, every->at(sheet), *direction, about.at(sheet));
        return parts::polar_copies(*made, count, *direction, about.at(sheet));
    };
}

SolidMaker SolidReader::subtract(const JsonNode& node, const std::string& name) {
    const SolidsMaker list = read_list(node["subtract"], name + " cut");
    const SolidMaker from = read(node.require("from"), name);
    return [=](Sheet& sheet) -> Result<Solid> {
        const Result<Solid> whole = from(sheet);
        if (!whole) return whole;
        const parts::Lean lean = sheet.drawing.facets.lean;
        sheet.drawing.facets.lean = parts::opposite(lean);
        const Result<std::vector<Solid>> made = list(sheet);
        sheet.drawing.facets.lean = lean;
        if (!made) return made.errors();
        return parts::difference(sheet.drawing, *whole, *made);
    };
}

SolidMaker SolidReader::unite(const JsonNode& node, const std::string& name) {
    const SolidsMaker list = read_list(node["union"], name);
    return [=, where = node.where()](Sheet& sheet) -> Result<Solid> {
        const Result<std::vector<Solid>> made = list(sheet);
        if (!made) return made.errors();
        if (made->empty()) return Error{ErrorCode::inconsistent, where, "there is nothing here to unite"};
        return parts::united(sheet.drawing, *made);
    };
}

SolidMaker SolidReader::intersect(const JsonNode& node, const std::string& name) {
    const SolidsMaker list = read_list(node["intersect"], name);
    return [=, where = node.where()](Sheet& sheet) -> Result<Solid> {
        const Result<std::vector<Solid>> made = list(sheet);
        if (!made) return made.errors();
        if (made->empty()) return Error{ErrorCode::inconsistent, where, "there is nothing here to intersect"};
        return parts::intersection(sheet.drawing, *made);
    };
}

SolidMaker SolidReader::move(const JsonNode& node, const std::string& name) {
    const SolidMaker what = read(node["move"], name);
    const PartPoint3 by = read_point3(node.require("by"), numbers_);
    return [=](Sheet& sheet) -> Result<Solid> {
        const Result<Solid> made = what(sheet);
        return made ? Result<Solid>(parts::moved(*made, by.at(sheet))) : made;
    };
}

SolidMaker SolidReader::turn(const JsonNode& node, const std::string& name) {
    const SolidMaker what = read(node["turn"], name);
    const PartNumber by = numbers_.angle(node.require("by"));
    PartPoint3 axis = read_point3(node["axis"], numbers_, Dimension::number);
    if (!node["axis"].exists()) axis.z.formula = expression::constant_formula(1);
    const PartPoint3 about = read_point3(node["about"], numbers_);
    return [=, where = node.where()](Sheet& sheet) -> Result<Solid> {
        const Result<Solid> made = what(sheet);
        if (!made) return made;
        const auto direction = direction_of(axis, sheet, where);
        return direction ? parts::turned(*made, *direction, by.at(sheet), about.at(sheet)) : Result<Solid>(direction.errors());
    };
}

SolidMaker SolidReader::mirror(const JsonNode& node, const std::string& name) {
    const SolidMaker what = read(node["mirror"], name);
    const std::string plane = node.require("across").choice({"xy", "yz", "xz"}).value_or("xy");
    const parts::Point3 normal = plane == "xy" ? parts::Point3{0, 0, 1} : plane == "yz" ? parts::Point3{1, 0, 0} : parts::Point3{0, 1, 0};
    return [=](Sheet& sheet) -> Result<Solid> {
        const Result<Solid> made = what(sheet);
        return made ? Result<Solid>(parts::mirrored(*made, normal)) : made;
    };
}

SolidMaker SolidReader::repeat(const JsonNode& node, const std::string& name) {
    const SolidsMaker copies = repeated(node, name);
    return [=, where = node.where()](Sheet& sheet) -> Result<Solid> {
        const Result<std::vector<Solid>> made = copies(sheet);
        if (!made) return made.errors();
        if (made->empty()) return Error{ErrorCode::inconsistent, where, "a part of no copies is nothing"};
        return parts::united(sheet.drawing, *made);
    };
}

}  // namespace fettle::core::part_files
