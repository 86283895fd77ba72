// SPDX-License-Identifier: MIT
#include "core/part_files/path_reader.hpp"

#include <numbers>
#include <optional>

#include "core/base/limits.hpp"
#include "core/files/nearest_word.hpp"
#include "core/part_files/curve_reader.hpp"

namespace fettle::core::part_files {
namespace {

using base::ErrorCode;
using files::JsonNode;
using parts::Path;
using parts::Point2;

constexpr std::size_t most_steps = 100'000;

// Where steps are drawn: turned about the origin, then moved. Those of a repeat stand in another place each time.
struct Placement {
    Number angle = 0;
    Point2 turn{1, 0}, shift{0, 0};  // `turn`: (cos, sin) of the angle
    bool is_identity = true;

    Point2 operator()(const Point2& point) const { return is_identity ? point : parts::turned(point, turn) + shift; }
    std::vector<parts::Segment> operator()(const parts::LawCurve& curve, const std::string& feature) const {
        const parts::Loop loop{{{curve, feature, std::nullopt}}};
        return is_identity ? loop.segments : parts::moved(parts::turned(loop, angle), shift).segments;
    }
    /// This one after `inner`.
    Placement after(const Placement& inner) const {
        return is_identity ? inner : Placement{angle + inner.angle, parts::turned(inner.turn, turn), (*this)(inner.shift), false};
    }
};

using Step = std::function<void(Path& path, Sheet& sheet, const Placement& placed)>;

struct Verb {
    std::string_view name;
    std::vector<std::string_view> keys;
    Step (*read)(const JsonNode& node, PartNumbers& numbers, const std::string& name);
};

std::vector<Point2> placed_points(const std::vector<PartPoint>& points, const Sheet& sheet, const Placement& placed) {
    std::vector<Point2> out = points_at(points, sheet);
    for (Point2& point : out) point = placed(point);
    return out;
}

Step line_step(const PartPoint& to) {
    return [to](Path& path, Sheet& sheet, const Placement& placed) { path.line_to(placed(to.at(sheet))); };
}

Step read_line(const JsonNode& node, PartNumbers& numbers, const std::string&) { return line_step(read_point(node["to"], numbers)); }

Step read_arc_to(const JsonNode& node, PartNumbers& numbers, const std::string&) {
    const PartPoint to = read_point(node["arc_to"], numbers);
    const int ways =
        static_cast<int>(node["centre"].exists()) + static_cast<int>(node["through"].exists()) + static_cast<int>(node["bulge"].exists());
    if (ways > 1)
        node.fail(ErrorCode::inconsistent, "an arc has one of `centre`, `through` and `bulge`, or none: then it goes on tangentially");
    if (node["clockwise"].exists() && !node["centre"].exists())
        node["clockwise"].fail(ErrorCode::inconsistent, "only an arc with a `centre` may run either way");
    if (node["centre"].exists()) {
        const PartPoint centre = read_point(node["centre"], numbers);
        const bool clockwise = node["clockwise"].boolean().value_or(false);
        return [=](Path& path, Sheet& sheet, const Placement& placed) {
            path.arc_about(placed(centre.at(sheet)), placed(to.at(sheet)), !clockwise);
        };
    }
    if (node["through"].exists()) {
        const PartPoint middle = read_point(node["through"], numbers);
        return [=](Path& path, Sheet& sheet, const Placement& placed) { path.arc_through(placed(middle.at(sheet)), placed(to.at(sheet))); };
    }
    if (node["bulge"].exists()) {
        const PartNumber bulge = numbers.number(node["bulge"], base::Dimension::number);
        return [=](Path& path, Sheet& sheet, const Placement& placed) { path.bulge_to(placed(to.at(sheet)), bulge.at(sheet)); };
    }
    return [=](Path& path, Sheet& sheet, const Placement& placed) { path.tangent_arc_to(placed(to.at(sheet))); };
}

Step read_arc_by(const JsonNode& node, PartNumbers& numbers, const std::string&) {
    const PartNumber angle = numbers.angle(node["arc_by"]);
    const PartPoint centre = read_point(node.require("centre"), numbers);
    return [=](Path& path, Sheet& sheet, const Placement& placed) { path.arc_by(placed(centre.at(sheet)), angle.at(sheet)); };
}

Step read_spline(const JsonNode& node, PartNumbers& numbers, const std::string&) {
    const auto points = read_points(node["spline"], numbers, 1);
    return [=](Path& path, Sheet& sheet, const Placement& placed) { path.spline_through(placed_points(points, sheet, placed)); };
}

Step read_b_spline(const JsonNode& node, PartNumbers& numbers, const std::string&) {
    const auto points = read_points(node["b_spline"], numbers, 1);
    return [=](Path& path, Sheet& sheet, const Placement& placed) { path.spline_by(placed_points(points, sheet, placed)); };
}

Step curve_step(const CurveMaker& curve, const std::string& name) {
    return [=](Path& path, Sheet& sheet, const Placement& placed) { path.along(placed(curve(sheet), name)); };
}

Step read_involute_step(const JsonNode& node, PartNumbers& numbers, const std::string& name) {
    return curve_step(read_involute(node, numbers), name);
}

Step read_law_step(const JsonNode& node, PartNumbers& numbers, const std::string& name) {
    return curve_step(read_law(node["law"], numbers), name);
}

Step read_repeat(const JsonNode& node, PartNumbers& numbers, const std::string& name);

const std::vector<Verb>& verbs() {
    static const std::vector<Verb> all{{"to", {}, read_line},
                                       {"arc_to", {"centre", "clockwise", "through", "bulge"}, read_arc_to},
                                       {"arc_by", {"centre"}, read_arc_by},
                                       {"spline", {}, read_spline},
                                       {"b_spline", {}, read_b_spline},
                                       {"involute", {"from", "to", "turn", "mirrored"}, read_involute_step},
                                       {"law", {}, read_law_step},
                                       {"repeat", {"count", "about", "every", "step"}, read_repeat}};
    return all;
}

// `to` is a key of involutes too: it is looked for last.
const Verb* verb_of(const JsonNode& node) {
    const Verb* found = nullptr;
    for (const Verb& verb : verbs())
        if (node[verb.name].exists() && (found == nullptr || found->name == "to")) found = &verb;
    return found;
}

// What is to become of the corner at the end of a step.
Step read_corner(const JsonNode& node, PartNumbers& numbers) {
    if (node["round"].exists() && node["chamfer"].exists())
        node.fail(ErrorCode::inconsistent, "a corner is rounded or chamfered, not both");
    if (node["round"].exists()) {
        const PartNumber radius = numbers.length(node["round"]);
        return [=](Path& path, Sheet& sheet, const Placement&) { path.round(radius.at(sheet)); };
    }
    if (node["chamfer"].exists()) {
        const PartNumber distance = numbers.length(node["chamfer"]);
        return [=](Path& path, Sheet& sheet, const Placement&) { path.chamfer(distance.at(sheet)); };
    }
    return {};
}

void add_step(const JsonNode& node, PartNumbers& numbers, const std::string& path_name, std::vector<Step>& steps) {
    if (is_point(node)) {
        steps.push_back(line_step(read_point(node, numbers)));
        return;
    }
    const Verb* verb = node.is_object() ? verb_of(node) : nullptr;
    if (verb == nullptr) {
        std::vector<std::string_view> known{"polar"};
        for (const Verb& each : verbs()) known.push_back(each.name);
        std::string message = "a step of a path is a point, or an object with one of the keys ";
        for (const std::string_view each : known) message += (each == known.front() ? "`" : ", `") + std::string(each) + "`";
        for (const auto& [key, value] : node.is_object() ? node.members() : std::vector<std::pair<std::string, JsonNode>>())
            if (const auto nearest = files::nearest_word(key, known))
                message += "; did you mean `" + *nearest + "`, where `" + key + "` stands?";
        node.fail(node.is_object() ? ErrorCode::unknown_key : ErrorCode::wrong_type,
                  message + (node.is_object() ? "" : "; found " + node.shown()));
        return;
    }
    std::vector<std::string_view> keys{verb->name, "round", "chamfer", "name"};
    keys.insert(keys.end(), verb->keys.begin(), verb->keys.end());
    node.allow_keys(keys);
    const std::string name = node["name"].string().value_or(path_name);
    const Step draw = verb->read(node, numbers, name);
    steps.push_back([=](Path& path, Sheet& sheet, const Placement& placed) {
        path.feature(name);
        draw(path, sheet, placed);
        path.feature(path_name);
    });
    if (const Step corner = read_corner(node, numbers)) steps.push_back(corner);
}

// The steps again and again, each time turned on about a point, or moved on.
Step read_repeat(const JsonNode& node, PartNumbers& numbers, const std::string& name) {
    std::vector<Step> steps;
    for (const JsonNode& element : node["repeat"].elements()) add_step(element, numbers, name, steps);
    const int count = numbers.count(node.require("count"), 0, base::most_copies).value_or(0);
    const bool is_linear = node["step"].exists();
    if (is_linear && (node["about"].exists() || node["every"].exists()))
        node.fail(ErrorCode::inconsistent, "repeats are moved by a `step`, or turned `about` a point, not both");
    const PartPoint about = read_point(is_linear ? node["step"] : node["about"], numbers);
    const std::optional<PartNumber> every = node["every"].exists() ? std::optional(numbers.angle(node["every"])) : std::nullopt;
    return [=](Path& path, Sheet& sheet, const Placement& placed) {
        const Point2 point = about.at(sheet);
        for (int k = 0; k < count && path.segments().size() < most_steps; ++k) {
            Placement own{0, {1, 0}, static_cast<double>(k) * point, k == 0};
            if (!is_linear && k > 0) {
                own.angle = every ? k * every->at(sheet) : Number(2 * std::numbers::pi * k / count);
                own.turn = every ? parts::direction(own.angle) : parts::direction(k, count);
                own.shift = point - parts::turned(point, own.turn);
            }
            const Placement both = placed.after(own);
            for (const Step& step : steps) step(path, sheet, both);
        }
    };
}

}  // namespace

std::vector<PartPoint> read_points(const JsonNode& node, const PartNumbers& numbers, std::size_t fewest) {
    std::vector<PartPoint> out;
    for (const JsonNode& element : node.elements()) out.push_back(read_point(element, numbers));
    if (node.is_array() && out.size() < fewest)
        node.fail(ErrorCode::out_of_range, "expected at least " + std::to_string(fewest) + " points, found " + node.shown());
    return out;
}

std::vector<Point2> points_at(const std::vector<PartPoint>& points, const Sheet& sheet) {
    std::vector<Point2> out;
    for (const PartPoint& point : points) out.push_back(point.at(sheet));
    return out;
}

LoopMaker read_path(const JsonNode& node, PartNumbers& numbers, const std::string& name) {
    const std::vector<JsonNode> elements = node["path"].elements();
    if (elements.size() < 2) {
        node["path"].fail(ErrorCode::out_of_range,
                          "a path is a list of a point to begin at and at least one step; found " + node["path"].shown());
        return {};
    }
    const JsonNode& first = elements.front();
    PartPoint start;
    std::vector<Step> steps;
    if (is_point(first)) {
        start = read_point(first, numbers);
    } else if (first.is_object() && first["to"].exists()) {
        first.allow_keys({"to", "round", "chamfer"});
        start = read_point(first["to"], numbers);
        if (const Step corner = read_corner(first, numbers)) steps.push_back(corner);
    } else {
        first.fail(ErrorCode::wrong_type, "a path begins with a point, found " + first.shown());
    }
    for (std::size_t k = 1; k < elements.size(); ++k) add_step(elements[k], numbers, name, steps);
    return [=, where = node.where()](Sheet& sheet) -> Result<parts::Loop> {
        Path path(start.at(sheet), name);
        for (const Step& step : steps) step(path, sheet, {});
        if (path.segments().size() >= most_steps)
            return Error{ErrorCode::out_of_range, where, "this path has more than " + std::to_string(most_steps) + " lines and curves"};
        return located(path.closed(), where);
    };
}

}  // namespace fettle::core::part_files
