// SPDX-License-Identifier: MIT
#include "core/part_files/profile_reader.hpp"

#include <memory>

#include "core/base/limits.hpp"
#include "core/part_files/curve_reader.hpp"
#include "core/part_files/path_reader.hpp"
#include "core/parts/profile_booleans.hpp"
#include "core/parts/undercut.hpp"

namespace fettle::core::part_files {

using base::Dimension;
using base::ErrorCode;
using files::JsonNode;
using parts::Loop;
using parts::Point2;
using parts::Profile;

namespace {

constexpr std::size_t most_segments = 100'000;
constexpr std::size_t most_holes = 2'000;         // each is looked at with each
constexpr std::size_t most_cut_segments = 5'000;  // of figures that cut each other: each is looked at with each

std::size_t size_of(const Profile& profile) {
    std::size_t out = 0;
    for (const Loop& loop : profile.loops) out += loop.segments.size();
    return out;
}

std::size_t size_of(const std::vector<Profile>& profiles) {
    std::size_t out = 0;
    for (const Profile& profile : profiles) out += size_of(profile);
    return out;
}

Error too_many(const std::string& where, std::size_t found, std::size_t most) {
    return {ErrorCode::out_of_range, where,
            "this figure would have " + std::to_string(found) + " lines and curves; at most " + std::to_string(most) + " are drawn here"};
}

Result<Profile> filled(const Result<Loop>& loop, const std::string& where) {
    return loop ? located(parts::filled(*loop), where) : located(Result<Profile>(loop.errors()), where);
}

std::vector<Loop> loops_of(const std::vector<Profile>& profiles) {
    std::vector<Loop> out;
    for (const Profile& profile : profiles) out.insert(out.end(), profile.loops.begin(), profile.loops.end());
    return out;
}

}  // namespace

Result<Profile> ProfileReader::drawn_once(const std::string& name, const ProfileMaker& maker, Sheet& sheet) {
    const auto known = sheet.profiles.find(name);
    if (known != sheet.profiles.end()) return known->second;
    Result<Profile> made = maker(sheet);
    sheet.profiles.emplace(name, made);
    return made;
}

const std::vector<ProfileReader::Verb>& ProfileReader::verbs() {
    using P = ProfileReader;
    static const std::vector<Verb> all{{"circle", {"centre"}, &P::circle},
                                       {"rectangle", {"centre", "corner"}, &P::rectangle},
                                       {"polygon", {}, &P::polygon},
                                       {"slot", {"radius"}, &P::slot},
                                       {"path", {}, &P::path},
                                       {"law", {}, &P::law},
                                       {"spline", {}, &P::spline},
                                       {"holes", {"in"}, &P::holes},
                                       {"subtract", {"from"}, &P::subtract},
                                       {"union", {}, &P::unite},
                                       {"intersect", {}, &P::intersect},
                                       {"together", {}, &P::together},
                                       {"offset", {"by", "undercut"}, &P::offset},
                                       {"round", {"radius", "corners"}, &P::round},
                                       {"chamfer", {"by", "corners"}, &P::chamfer},
                                       {"move", {"by"}, &P::move},
                                       {"turn", {"by", "about"}, &P::turn},
                                       {"mirror", {"across"}, &P::mirror},
                                       {"repeat", {"count", "about", "every", "step"}, &P::repeat}};
    return all;
}

std::optional<Error> ProfileReader::fault_of(const Profile& profile, const std::string& where) {
    if (size_of(profile) > most_segments) return too_many(where, size_of(profile), most_segments);
    for (const Loop& loop : profile.loops)
        for (const parts::Segment& segment : loop.segments)
            for (const double x : value(parts::end_of(segment.curve)))
                if (!base::is_usable_number(x)) return out_of_reach(segment.feature, where);
    return std::nullopt;
}

std::optional<Error> ProfileReader::fault_of(const std::vector<Profile>& profiles, const std::string& where) {
    return size_of(profiles) > most_segments ? std::optional(too_many(where, size_of(profiles), most_segments)) : std::nullopt;
}

ProfilesMaker ProfileReader::repeated(const JsonNode& node, const std::string& name) {
    node.allow_keys({"repeat", "count", "about", "every", "step", "name"});
    const std::string own = node["name"].string().value_or(name);
    const ProfileMaker what = read(node["repeat"], own);
    const int count = numbers_.count(node.require("count"), 0, base::most_copies).value_or(0);
    const bool is_linear = node["step"].exists();
    if (is_linear && (node["about"].exists() || node["every"].exists()))
        node.fail(ErrorCode::inconsistent, "copies are moved by a `step`, or turned `about` a point, not both");
    const PartPoint step = read_point(node["step"], numbers_), about = read_point(node["about"], numbers_);
    const std::optional<PartNumber> every =
        node["every"].exists() ? std::optional(numbers_.angle(node["every"])) : std::optional<PartNumber>();
    return [=, where = node.where()](Sheet& sheet) -> Result<std::vector<Profile>> {
        if (count == 0) return std::vector<Profile>();
        const Result<Profile> made = what(sheet);
        if (!made) return made.errors();
        const std::size_t size = size_of(*made) * static_cast<std::size_t>(count);
        if (size > most_segments) return too_many(where, size, most_segments);
        std::vector<Profile> out(count);
        for (const Loop& loop : made->loops) {
            const std::vector<Loop> loops = is_linear ? parts::linear_copies(loop, count, step.at(sheet))
                                            : every   ? parts::polar_copies(loop, count, every->at(sheet), about.at(sheet))
                                                      : parts::polar_copies(loop, count, about.at(sheet));
            for (std::size_t k = 0; k < loops.size(); ++k) out[k].loops.push_back(loops[k]);
        }
        return out;
    };
}

ProfileMaker ProfileReader::circle(const JsonNode& node, const std::string& name) {
    const PartNumber radius = numbers_.length(node["circle"]);
    const PartPoint centre = read_point(node["centre"], numbers_);
    return [=, where = node.where()](Sheet& sheet) -> Result<Profile> {
        const Number r = radius.at(sheet);
        if (!(r.value > 0))
            return Error{ErrorCode::out_of_range, where,
                         "the radius of `" + name + "` is " + base::format_length(r.value, "mm") + "; it must be above 0"};
        return parts::filled(parts::circle(centre.at(sheet), r, name));
    };
}

ProfileMaker ProfileReader::rectangle(const JsonNode& node, const std::string& name) {
    const PartPoint size = read_point(node["rectangle"], numbers_);
    if (node["centre"].exists() && node["corner"].exists())
        node.fail(ErrorCode::inconsistent, "a rectangle lies by its `centre` or by its lower left `corner`, not both");
    const bool by_corner = node["corner"].exists();
    const PartPoint at = read_point(by_corner ? node["corner"] : node["centre"], numbers_);
    return [=, where = node.where()](Sheet& sheet) -> Result<Profile> {
        const Point2 whole = size.at(sheet);
        if (!(whole.x.value > 0 && whole.y.value > 0))
            return Error{ErrorCode::out_of_range, where,
                         "the sides of `" + name + "` are " + base::format_length(whole.x.value, "mm") + " and " +
                             base::format_length(whole.y.value, "mm") + "; both must be above 0"};
        const Point2 corner = by_corner ? at.at(sheet) : at.at(sheet) - 0.5 * whole;
        return parts::filled(parts::rectangle(corner, whole.x, whole.y, name));
    };
}

ProfileMaker ProfileReader::polygon(const JsonNode& node, const std::string& name) {
    const auto corners = read_points(node["polygon"], numbers_, 3);
    return [=](Sheet& sheet) { return parts::filled(parts::polygon(points_at(corners, sheet), name)); };
}

ProfileMaker ProfileReader::slot(const JsonNode& node, const std::string& name) {
    const auto ends = read_points(node["slot"], numbers_, 2);
    if (ends.size() != 2) {
        node["slot"].fail(ErrorCode::wrong_type, "expected the two points about which a slot is round, found " + node["slot"].shown());
        return {};
    }
    const PartNumber radius = numbers_.length(node.require("radius"));
    return [=, where = node.where()](Sheet& sheet) -> Result<Profile> {
        const Point2 a = ends[0].at(sheet), b = ends[1].at(sheet);
        const Number r = radius.at(sheet);
        if (!(r.value > 0) || value(a) == value(b))
            return Error{ErrorCode::out_of_range, where, "the slot `" + name + "` needs a radius above 0 and two different points"};
        return parts::filled(parts::slot(a, b, r, name));
    };
}

ProfileMaker ProfileReader::path(const JsonNode& node, const std::string& name) {
    const LoopMaker loop = read_path(node, numbers_, name);
    return [loop, where = node.where()](Sheet& sheet) { return filled(loop(sheet), where); };
}

ProfileMaker ProfileReader::law(const JsonNode& node, const std::string& name) {
    const CurveMaker curve = read_law(node["law"], numbers_);
    return [=, where = node.where()](Sheet& sheet) {
        const parts::LawCurve drawn = curve(sheet);
        return filled(parts::Path(drawn.start, name).along(drawn).closed(), where);
    };
}

ProfileMaker ProfileReader::spline(const JsonNode& node, const std::string& name) {
    const auto points = read_points(node["spline"], numbers_, 3);
    return [=, where = node.where()](Sheet& sheet) -> Result<Profile> {
        const std::vector<Point2> through = points_at(points, sheet);
        for (std::size_t k = 0; k < through.size(); ++k)
            if (value(through[k]) == value(through[(k + 1) % through.size()]))
                return Error{ErrorCode::out_of_range, where, "the spline `" + name + "` goes twice through one point"};
        Loop loop;
        for (const parts::Bezier& bezier : parts::spline_through(through, true)) loop.segments.push_back({bezier, name, std::nullopt});
        return parts::filled(loop);
    };
}

ProfileMaker ProfileReader::holes(const JsonNode& node, const std::string& name) {
    const ProfilesMaker list = read_list(node["holes"], name + " hole");
    const ProfileMaker in = read(node.require("in"), name);
    return [=, where = node.where()](Sheet& sheet) -> Result<Profile> {
        const Result<Profile> figure = in(sheet);
        if (!figure) return figure;
        const Result<std::vector<Profile>> made = list(sheet);
        if (!made) return made.errors();
        const std::vector<Loop> loops = loops_of(*made);
        if (loops.size() > most_holes)
            return Error{ErrorCode::out_of_range, where,
                         "there would be " + std::to_string(loops.size()) + " holes; at most " + std::to_string(most_holes) + " are drawn"};
        return parts::with_holes(*figure, loops);
    };
}

ProfileMaker ProfileReader::subtract(const JsonNode& node, const std::string& name) {
    const ProfilesMaker list = read_list(node["subtract"], name + " cut");
    const ProfileMaker from = read(node.require("from"), name);
    return [=, where = node.where()](Sheet& sheet) -> Result<Profile> {
        const Result<Profile> figure = from(sheet);
        if (!figure) return figure;
        const Result<std::vector<Profile>> made = list(sheet);
        if (!made) return made.errors();
        const std::size_t size = size_of(*figure) + size_of(*made);
        if (size > most_cut_segments) return too_many(where, size, most_cut_segments);
        return parts::difference(*figure, *made);
    };
}

ProfileMaker ProfileReader::unite(const JsonNode& node, const std::string& name) {
    const ProfilesMaker list = read_list(node["union"], name);
    return [=, where = node.where()](Sheet& sheet) -> Result<Profile> {
        const Result<std::vector<Profile>> made = list(sheet);
        if (!made) return made.errors();
        if (size_of(*made) > most_cut_segments) return too_many(where, size_of(*made), most_cut_segments);
        return parts::united(*made);
    };
}

ProfileMaker ProfileReader::intersect(const JsonNode& node, const std::string& name) {
    const ProfilesMaker list = read_list(node["intersect"], name);
    return [=, where = node.where()](Sheet& sheet) -> Result<Profile> {
        const Result<std::vector<Profile>> made = list(sheet);
        if (!made) return made.errors();
        if (size_of(*made) > most_cut_segments) return too_many(where, size_of(*made), most_cut_segments);
        if (made->empty()) return Profile{};
        Result<Profile> out = made->front();
        for (std::size_t k = 1; k < made->size() && out; ++k) out = parts::intersection(*out, (*made)[k]);
        return out;
    };
}

ProfileMaker ProfileReader::together(const JsonNode& node, const std::string& name) {
    const ProfilesMaker list = read_list(node["together"], name);
    return [=](Sheet& sheet) -> Result<Profile> {
        const Result<std::vector<Profile>> made = list(sheet);
        if (!made) return made.errors();
        return parts::together(*made);
    };
}

ProfileMaker ProfileReader::offset(const JsonNode& node, const std::string& name) {
    const ProfileMaker what = read(node["offset"], name);
    const PartNumber by = numbers_.length(node.require("by"));
    const bool is_refused = node["undercut"].choice({"cut", "refused"}).value_or("cut") == "refused";
    return [=, where = node.where()](Sheet& sheet) -> Result<Profile> {
        const Result<Profile> made = what(sheet);
        if (!made) return made;
        if (size_of(*made) > most_cut_segments) return too_many(where, size_of(*made), most_cut_segments);
        const parts::Number distance = by.at(sheet);
        if (is_refused)
            if (Errors faults = parts::undercuts(*made, distance.value); !faults.empty()) return faults;
        return parts::offset(*made, distance);
    };
}

namespace {

using CutCorners = Result<Loop> (*)(const Loop&, const Number&, parts::Corners, std::string);

ProfileMaker with_corners(const ProfileMaker& what, const PartNumber& size, const JsonNode& node, CutCorners cut) {
    const std::string which = node["corners"].choice({"all", "convex", "concave"}).value_or("all");
    const parts::Corners corners = which == "convex"    ? parts::Corners::convex
                                   : which == "concave" ? parts::Corners::concave
                                                        : parts::Corners::all;
    return [=](Sheet& sheet) -> Result<Profile> {
        const Result<Profile> made = what(sheet);
        if (!made) return made;
        Profile out;
        for (const Loop& loop : made->loops) {
            // What is convex of a hole is concave of the material.
            const bool is_hole = made->loops.size() > 1 && parts::area({{loop}}).value < 0;
            const parts::Corners own = !is_hole || corners == parts::Corners::all ? corners
                                       : corners == parts::Corners::convex        ? parts::Corners::concave
                                                                                  : parts::Corners::convex;
            Result<Loop> done = cut(loop, size.at(sheet), own, {});
            if (!done) return done.errors();
            out.loops.push_back(std::move(*done));
        }
        return out;
    };
}

}  // namespace

ProfileMaker ProfileReader::round(const JsonNode& node, const std::string& name) {
    return with_corners(read(node["round"], name), numbers_.length(node.require("radius")), node, &parts::rounded);
}

ProfileMaker ProfileReader::chamfer(const JsonNode& node, const std::string& name) {
    return with_corners(read(node["chamfer"], name), numbers_.length(node.require("by")), node, &parts::chamfered);
}

ProfileMaker ProfileReader::move(const JsonNode& node, const std::string& name) {
    const ProfileMaker what = read(node["move"], name);
    const PartPoint by = read_point(node.require("by"), numbers_);
    return [=](Sheet& sheet) -> Result<Profile> {
        const Result<Profile> made = what(sheet);
        return made ? Result<Profile>(parts::moved(*made, by.at(sheet))) : made;
    };
}

ProfileMaker ProfileReader::turn(const JsonNode& node, const std::string& name) {
    const ProfileMaker what = read(node["turn"], name);
    const PartNumber by = numbers_.angle(node.require("by"));
    const PartPoint about = read_point(node["about"], numbers_);
    return [=](Sheet& sheet) -> Result<Profile> {
        const Result<Profile> made = what(sheet);
        return made ? Result<Profile>(parts::turned(*made, by.at(sheet), about.at(sheet))) : made;
    };
}

ProfileMaker ProfileReader::mirror(const JsonNode& node, const std::string& name) {
    const ProfileMaker what = read(node["mirror"], name);
    const bool across_x = node.require("across").choice({"x", "y"}).value_or("x") == "x";
    return [=](Sheet& sheet) -> Result<Profile> {
        const Result<Profile> made = what(sheet);
        return made ? Result<Profile>(parts::mirrored(*made, {}, across_x ? Point2{1, 0} : Point2{0, 1})) : made;
    };
}

ProfileMaker ProfileReader::repeat(const JsonNode& node, const std::string& name) {
    const ProfilesMaker copies = repeated(node, name);
    return [=, where = node.where()](Sheet& sheet) -> Result<Profile> {
        const Result<std::vector<Profile>> made = copies(sheet);
        if (!made) return made.errors();
        if (size_of(*made) > most_cut_segments) return too_many(where, size_of(*made), most_cut_segments);
        return parts::united(*made);
    };
}

}  // namespace fettle::core::part_files
