// SPDX-License-Identifier: MIT
#include "design/reading/quantity_reader.hpp"

#include <algorithm>
#include <functional>
#include <map>
#include <set>

#include "core/expression/parse_formula.hpp"
#include "core/files/nearest_word.hpp"
#include "core/geometry/named_faces.hpp"
#include "core/scene/mass_kind.hpp"
#include "design/quantities/body_turn.hpp"
#include "design/quantities/contact_force.hpp"
#include "design/quantities/energy.hpp"
#include "design/quantities/expression.hpp"
#include "design/quantities/free_range_end.hpp"
#include "design/quantities/gap.hpp"
#include "design/quantities/joint_load.hpp"
#include "design/quantities/joint_position.hpp"
#include "design/quantities/law.hpp"
#include "design/quantities/marker_path.hpp"
#include "design/quantities/marker_position.hpp"
#include "design/quantities/marker_speed.hpp"
#include "design/quantities/mass.hpp"
#include "design/quantities/own_formula.hpp"
#include "design/quantities/step_expression.hpp"
#include "design/quantities/stroke.hpp"
#include "design/reading/event_reader.hpp"
#include "design/reading/named_formula.hpp"

namespace fettle::design::reading {

namespace {

using core::files::JsonNode;
using description::Quantity;

// For default names only: a wrong type is reported by the reading proper. Lists: "wheel+axle".
std::string text(const JsonNode& node) {
    if (!node.is_array()) return node.is_string() ? *node.string() : std::string("?");
    std::string entries;
    for (const JsonNode& entry : node.elements()) entries += (entries.empty() ? "" : "+") + text(entry);
    return entries;
}

// "stroke piston": the type, and what these keys say.
template <class... Keys>
std::function<std::string(const JsonNode&)> named_by(Keys... keys) {
    return [keys...](const JsonNode& node) { return (text(node["type"]) + ... + (" " + text(node[keys]))); };
}

std::shared_ptr<const Quantity> read_stroke(const JsonNode& node, const ReadContext& context) {
    const auto body = context.body(node.require("body"));
    const auto axis = context.axis(node.require("axis"));
    const auto time = [&](std::string_view key) { return node[key].quantity(Dimension::time, 1, core::files::not_negative); };
    const quantities::StrokeWindow window{time("from"), time("to")};
    if (auto target = context.formulas.followed(node["target"], Dimension::length, context.length_unit)) {
        if (!body || !axis) return nullptr;
        return std::make_shared<quantities::Stroke>(*body, *axis, std::move(*target), window);
    }
    const auto target = node["target"].length(context.length_unit, core::files::not_negative);
    if (!body || !axis) return nullptr;
    return std::make_shared<quantities::Stroke>(*body, *axis, target, window);
}

// A point whose coordinates may follow from parameters.
std::optional<quantities::OwnPoint> read_point(const JsonNode& node, const ReadContext& context) {
    const std::vector<JsonNode> numbers = node.is_array() ? node.elements() : std::vector<JsonNode>();
    quantities::OwnPoint out;
    for (size_t k = 0; numbers.size() == 3 && k < 3; ++k)
        out.formulas[k] = context.formulas.followed(numbers[k], Dimension::length, context.length_unit);
    if (!out.follows()) {
        const auto point = node.length3(context.length_unit);
        return point ? std::optional<quantities::OwnPoint>(*point) : std::nullopt;
    }
    for (size_t k = 0; k < 3; ++k) {
        const auto number =
            out.formulas[k] ? std::optional(context.formulas.value_of(*out.formulas[k])) : numbers[k].length(context.length_unit);
        if (!number) return std::nullopt;
        out.at[static_cast<Eigen::Index>(k)] = *number;
    }
    return out;
}

std::vector<quantities::OwnPoint> read_points(const JsonNode& node, const ReadContext& context) {
    std::vector<quantities::OwnPoint> points;
    for (const JsonNode& entry : node.elements()) {
        if (const auto point = read_point(entry, context)) points.push_back(*point);
    }
    if (node.is_array() && points.empty()) node.fail(ErrorCode::out_of_range, "a path needs a point");
    return points;
}

std::vector<double> read_times(const JsonNode& node, size_t points, double end_time) {
    std::vector<double> times;
    for (const JsonNode& entry : node.elements()) {
        if (const auto time = entry.number({0, end_time, false})) times.push_back(*time);
    }
    if (node.is_array() && node.elements().size() != points) {
        node.fail(ErrorCode::inconsistent,
                  "a path has one time for each of its " + std::to_string(points) + " points, or no `times` (free timing)");
    }
    return times;
}

std::shared_ptr<const Quantity> read_marker_path(const JsonNode& node, const ReadContext& context) {
    const auto body = context.body(node.require("body"));
    const auto point = read_point(node.require("point"), context);
    const std::vector<quantities::OwnPoint> targets = read_points(node.require("points"), context);
    const std::vector<double> times = read_times(node["times"], targets.size(), context.end_time);
    if (!body || !point || targets.empty() || (!times.empty() && times.size() != targets.size())) return nullptr;
    return std::make_shared<quantities::MarkerPath>(*body, *point, targets, times);
}

std::vector<std::string> read_faces(const JsonNode& node, int body, const ReadContext& context) {
    std::vector<std::string> names;
    const core::geometry::Mesh& mesh = context.scene.bodies[body].mesh;
    const std::vector<std::string> known = core::geometry::names_of_faces(mesh);
    for (const JsonNode& entry : node.elements()) {
        const auto name = entry.string();
        if (!name) continue;
        names.push_back(*name);
        if (!core::geometry::triangles_of_face(mesh, *name).empty()) continue;
        const std::string what = "body \"" + context.scene.bodies[body].name + "\" has no face " + entry.shown();
        entry.fail(ErrorCode::unknown_key, known.empty() ? what + ": its mesh names none; faces have the names of a part's file"
                                                         : what + "; " + core::files::did_you_mean(*name, {known.begin(), known.end()}));
    }
    if (node.is_array() && names.empty()) node.fail(ErrorCode::out_of_range, "name a face, or leave this out for the whole body");
    return names;
}

std::shared_ptr<const Quantity> read_clearance(const JsonNode& node, const ReadContext& context) {
    const auto range = read_clearance_range(node, context);
    if (!range) return nullptr;
    return std::make_shared<quantities::Clearance>(*range);
}

std::shared_ptr<const Quantity> read_mass(const JsonNode& node, const ReadContext& context) {
    std::vector<int> bodies;
    const JsonNode list = node.require("bodies");
    for (const JsonNode& entry : list.elements()) {
        const auto index = context.body(entry);
        if (!index) continue;
        bodies.push_back(*index);
        const core::scene::Body& body = context.scene.bodies[*index];
        if (body.inertial) continue;
        if (!body.density_given) {
            entry.fail(ErrorCode::missing_key,
                       "body " + entry.shown() + " has no density in its scene, so it has no mass; give it a `density`");
        }
        if (core::scene::centre_of_mass(body.mesh, body.mass_kind)) continue;
        entry.fail(ErrorCode::mesh_invalid, "the mesh of body " + entry.shown() + " has nothing for a density in " +
                                                core::scene::density_unit(body.mass_kind) + " (of an open mesh there is no volume)");
    }
    if (list.is_array() && bodies.empty()) list.fail(ErrorCode::out_of_range, "the mass of no body; name at least one");
    return std::make_shared<quantities::Mass>(context.scene, bodies);
}

constexpr std::string_view reduction_keys[] = {"over", "from", "to", "at", "derivative"};

// What every quantity that each instant has a number of may say of it, beside keys of its own.
std::vector<std::string_view> with_reduction(std::vector<std::string_view> keys) {
    keys.insert(keys.end(), std::begin(reduction_keys), std::end(reduction_keys));
    return keys;
}

bool has_reduction(const JsonNode& node) {
    return std::any_of(std::begin(reduction_keys), std::end(reduction_keys), [&](std::string_view key) { return node[key].exists(); });
}

// @param of_instants  What an instant's number is. Quantity::check tells of what depends on the motion.
quantities::Reduction read_reduction(const JsonNode& node, Dimension of_instants) {
    static const std::vector<std::string_view> names{"end", "sum", "mean", "largest", "least", "peak", "rms", "integral"};
    const std::string name = node["over"].choice(names).value_or("end");
    quantities::Reduction out(static_cast<quantities::Over>(std::find(names.begin(), names.end(), name) - names.begin()));
    out.derivative = node["derivative"].integer(0, 2).value_or(0);
    const auto time = [&](std::string_view key) { return node[key].quantity(Dimension::time, 1, core::files::not_negative); };
    out.from = time("from");
    out.to = time("to");
    out.at = time("at");
    for (const std::string_view key : {"over", "from", "to"})
        if (node["at"].exists() && node[key].exists())
            node[key].fail(ErrorCode::inconsistent, "either `at` a time, or `" + std::string(key) + "`, which is about several steps");
    if (!dimension_of(out, of_instants))
        node.fail(
            ErrorCode::wrong_type,
            "there is no unit for this derivative or integral; divide by an amount in an expression over the steps, such as `force / 1 N`");
    return out;
}

std::shared_ptr<const Quantity> read_marker_speed(const JsonNode& node, const ReadContext& context) {
    const auto body = context.body(node.require("body"));
    const auto point = read_point(node.require("point"), context);
    const std::optional<Vector3> axis = node["axis"].exists() ? context.axis(node["axis"]) : Vector3(Vector3::Zero());
    const quantities::Reduction reduction = read_reduction(node, Dimension::speed);
    if (!body || !point || !axis) return nullptr;
    return std::make_shared<quantities::MarkerSpeed>(quantities::MarkerSpeed::Of{*body, *point, *axis}, reduction);
}

std::shared_ptr<const Quantity> read_marker_position(const JsonNode& node, const ReadContext& context) {
    const auto body = context.body(node.require("body"));
    const auto point = read_point(node.require("point"), context);
    const std::optional<Vector3> axis = node["axis"].exists() ? context.axis(node["axis"]) : Vector3(Vector3::Zero());
    const auto origin = node["origin"].exists() ? read_point(node["origin"], context) : quantities::OwnPoint();
    const quantities::Reduction reduction = read_reduction(node, Dimension::length);
    if (!body || !point || !axis || !origin) return nullptr;
    return std::make_shared<quantities::MarkerPosition>(quantities::MarkerPosition::Of{*body, *point, *axis, *origin}, reduction);
}

// The name of a joint or motor of the scene.
template <class Parts>
const typename Parts::value_type* read_part(const JsonNode& node, const Parts& parts, const std::string& what) {
    const auto name = node.string();
    if (!name) return nullptr;
    std::vector<std::string_view> known;
    for (const auto& part : parts) {
        if (part.name == *name) return &part;
        known.push_back(part.name);
    }
    node.fail(ErrorCode::out_of_range,
              "the scene has no " + what + " " + node.shown() + (known.empty() ? "" : "; " + core::files::did_you_mean(*name, known)));
    return nullptr;
}

// The force, or the torque.
std::shared_ptr<const Quantity> read_joint_load(const JsonNode& node, const ReadContext& context) {
    const core::scene::Joint* joint = read_part(node.require("joint"), context.scene.mechanism.joints, "joint");
    const std::optional<Vector3> axis = node["axis"].exists() ? context.axis(node["axis"]) : Vector3(Vector3::Zero());
    const bool is_force = text(node["type"]) == "joint_force";
    const auto kind = is_force ? quantities::JointLoadKind::force : quantities::JointLoadKind::torque;
    const quantities::Reduction reduction = read_reduction(node, is_force ? Dimension::force : Dimension::torque);
    if (joint == nullptr || !axis) return nullptr;
    return std::make_shared<quantities::JointLoad>(quantities::JointLoad::Of{kind, joint->name, *axis}, reduction);
}

bool turns(const core::scene::Joint& joint) {
    return joint.kind == core::scene::JointKind::revolute || joint.kind == core::scene::JointKind::screw;
}

std::shared_ptr<const Quantity> read_joint_position(const JsonNode& node, const ReadContext& context) {
    const core::scene::Joint* joint = read_part(node.require("joint"), context.scene.mechanism.joints, "joint");
    if (joint == nullptr) return nullptr;
    const Dimension dimension = turns(*joint) ? Dimension::angle : Dimension::length;
    return std::make_shared<quantities::JointPosition>(quantities::JointPosition::Of{joint->name, dimension},
                                                       read_reduction(node, dimension));
}

std::shared_ptr<const Quantity> read_free_range(const JsonNode& node, const ReadContext& context) {
    const core::scene::Joint* joint = read_part(node.require("joint"), context.scene.mechanism.joints, "joint");
    const auto end = node.require("end").choice({"above", "below"});
    quantities::FreeRangeEnd::Of of;
    if (const auto kept = node["clearance"].quantity(Dimension::length, context.length_unit, core::files::positive)) of.clearance = *kept;
    if (const auto reach = node["reach"].quantity(Dimension::length, context.length_unit, core::files::positive)) of.reach = *reach;
    of.others_anywhere = node["anywhere"].boolean().value_or(false);
    if (joint == nullptr || !end) return nullptr;
    of.joint = joint->name;
    of.dimension = turns(*joint) ? Dimension::angle : Dimension::length;
    of.is_above = *end == "above";
    return std::make_shared<quantities::FreeRangeEnd>(of);
}

std::shared_ptr<const Quantity> read_turn(const JsonNode& node, const ReadContext& context) {
    const auto body = context.body(node.require("body"));
    const auto axis = context.axis(node.require("axis"));
    const quantities::Reduction reduction = read_reduction(node, Dimension::angle);
    if (!body || !axis) return nullptr;
    return std::make_shared<quantities::BodyTurn>(*body, *axis, reduction);
}

std::shared_ptr<const Quantity> read_motor_effort(const JsonNode& node, const ReadContext& context) {
    const core::scene::Mechanism& mechanism = context.scene.mechanism;
    const core::scene::Motor* motor = read_part(node.require("motor"), mechanism.motors, "motor");
    if (motor == nullptr) return nullptr;
    quantities::JointLoad::Of of{quantities::JointLoadKind::effort, motor->name};
    of.effort_dimension = Dimension::force;
    for (const core::scene::Joint& joint : mechanism.joints)
        if (joint.name == motor->joint && turns(joint)) of.effort_dimension = Dimension::torque;
    return std::make_shared<quantities::JointLoad>(of, read_reduction(node, of.effort_dimension));
}

// Reads the force, or its torque about a point.
std::shared_ptr<const Quantity> read_contact_load(const JsonNode& node, const ReadContext& context,
                                                  const std::optional<quantities::OwnPoint>& about) {
    const auto body = context.body(node.require("body"));
    const auto other = node["of"].exists() ? context.body(node["of"]) : std::nullopt;
    const std::optional<Vector3> axis = node["axis"].exists() ? context.axis(node["axis"]) : Vector3(Vector3::Zero());
    const quantities::Reduction reduction = read_reduction(node, about ? Dimension::torque : Dimension::force);
    if (!body || !axis || (node["of"].exists() && !other)) return nullptr;
    if (other == body) {
        node.fail(ErrorCode::inconsistent, "a force of contact is between two bodies; `body` and `of` are the same");
        return nullptr;
    }
    return std::make_shared<quantities::ContactForce>(quantities::ContactForce::Of{*body, other, *axis, about}, reduction);
}

std::shared_ptr<const Quantity> read_contact_force(const JsonNode& node, const ReadContext& context) {
    return read_contact_load(node, context, std::nullopt);
}

std::shared_ptr<const Quantity> read_contact_torque(const JsonNode& node, const ReadContext& context) {
    const auto point = read_point(node.require("point"), context);
    const std::shared_ptr<const Quantity> load = read_contact_load(node, context, point.value_or(quantities::OwnPoint()));
    return point ? load : nullptr;
}

std::shared_ptr<const Quantity> read_energy(const JsonNode& node, const ReadContext&) {
    static const std::vector<std::string_view> names{"kinetic", "potential", "spring", "total"};
    const auto name = node.require("of").choice(names);
    const quantities::Reduction reduction = read_reduction(node, Dimension::energy);
    if (!name) return nullptr;
    return std::make_shared<quantities::Energy>(
        static_cast<quantities::EnergyKind>(std::find(names.begin(), names.end(), *name) - names.begin()), reduction);
}

// What its table is over: `times`, or `positions` of the quantity that it is along.
bool read_law_places(const JsonNode& node, const ReadContext& context, quantities::Law::Of& of) {
    if (!node["along"].exists()) {
        if (node["positions"].exists())
            node["positions"].fail(ErrorCode::inconsistent,
                                   "`positions` are of a law that is `along` a quantity; over the time it has `times`");
        of.curve.times = node.require("times").numbers().value_or(std::vector<double>{});
        return true;
    }
    if (node["times"].exists()) node["times"].fail(ErrorCode::inconsistent, "a law along a quantity has `positions` in place of `times`");
    const auto name = node["along"].string();
    if (!name) return false;
    std::vector<std::string_view> known;
    for (const quantities::NamedQuantity& each : context.quantities) {
        known.push_back(each.name);
        if (each.name == *name) of.along = quantities::series_of(quantities::over_steps(each.quantity));
    }
    if (!of.along) {
        const bool is_there = std::find(known.begin(), known.end(), *name) != known.end();
        node["along"].fail(ErrorCode::out_of_range, is_there ? node["along"].shown() + " is no quantity that each instant has a number of"
                                                             : "there is no quantity " + node["along"].shown() + " in `quantities`" +
                                                                   (known.empty() ? "" : "; " + core::files::did_you_mean(*name, known)));
        return false;
    }
    const Dimension dimension = of.along->numbers_dimension();
    const double unit = context.unit(dimension);
    for (const JsonNode& position : node.require("positions").elements())
        of.curve.times.push_back(position.quantity(dimension, unit).value_or(0));
    return true;
}

std::shared_ptr<const Quantity> read_law(const JsonNode& node, const ReadContext& context) {
    static const std::vector<std::string_view> profiles{"linear", "cubic", "trapezoid", "control_points"};
    static const std::vector<std::pair<std::string_view, Dimension>> dimensions{{"length", Dimension::length},
                                                                                {"angle", Dimension::angle},
                                                                                {"speed", Dimension::speed},
                                                                                {"angular_speed", Dimension::angular_speed},
                                                                                {"force", Dimension::force},
                                                                                {"torque", Dimension::torque},
                                                                                {"acceleration", Dimension::acceleration},
                                                                                {"number", Dimension::number}};
    std::vector<std::string_view> names;
    for (const auto& [name, dimension] : dimensions) names.push_back(name);
    const auto name = node.require("of").choice(names);
    if (!name) return nullptr;
    quantities::Law::Of of;
    of.dimension = std::find_if(dimensions.begin(), dimensions.end(), [&](const auto& each) { return each.first == *name; })->second;
    const std::string profile = node["profile"].choice(profiles).value_or("linear");
    of.curve.kind = static_cast<core::scene::CurveKind>(std::find(profiles.begin(), profiles.end(), profile) - profiles.begin());
    if (!read_law_places(node, context, of)) return nullptr;
    const double unit = context.unit(of.dimension);
    for (const JsonNode& value : node.require("values").elements()) {
        auto formula = context.formulas.followed(value, of.dimension, unit);
        const auto number = formula ? std::optional(context.formulas.value_of(*formula)) : value.quantity(of.dimension, unit);
        if (formula) of.moved.push_back({count_of(of.curve.values), std::move(*formula)});
        of.curve.values.push_back(number.value_or(0));
    }
    const quantities::Reduction reduction = read_reduction(node, of.dimension);
    return std::make_shared<quantities::Law>(std::move(of), reduction);
}

// With a word of a reduction it is over the steps.
std::shared_ptr<const Quantity> read_expression(const JsonNode& node, const ReadContext& context) {
    const JsonNode text = node.require("expression");
    if (!has_reduction(node)) return read_formula(text, context);
    return read_step_formula(text, context, [&](Dimension of_instants) { return read_reduction(node, of_instants); });
}

std::shared_ptr<const Quantity> read_gap(const JsonNode& node, const ReadContext& context) {
    const auto a = context.body(node.require("a")), b = context.body(node.require("b"));
    const quantities::Reduction reduction = read_reduction(node, Dimension::length);
    if (!a || !b) return nullptr;
    if (*a == *b) {
        node.fail(ErrorCode::inconsistent, "a gap is between two bodies; `a` and `b` are the same");
        return nullptr;
    }
    return std::make_shared<quantities::Gap>(quantities::Gap::Of{*a, *b}, reduction);
}

// "wheel", or "wheel slot+arc" of faces.
std::string place_of_clearance(const JsonNode& node, std::string_view body, std::string_view faces) {
    return text(node[body]) + (node[faces].is_array() ? " " + text(node[faces]) : "");
}
std::string clearance_name(const JsonNode& node) {
    const auto says = [&](std::string_view key) { return node[key].is_bool() && *node[key].boolean(); };
    return text(node["type"]) + " " + place_of_clearance(node, "a", "faces_a") + ":" + place_of_clearance(node, "b", "faces_b") +
           (says("motion")   ? " over the motion"
            : says("ranges") ? " over the ranges"
                             : "");
}
std::string contact_name(const JsonNode& node) {
    return text(node["type"]) + " " + text(node["body"]) + (node["of"].is_string() ? ":" + text(node["of"]) : "");
}
std::string expression_name(const JsonNode& node) { return text(node["expression"]); }

}  // namespace

std::shared_ptr<const Quantity> read_quantity(const QuantityType& type, const JsonNode& node, const ReadContext& context) {
    const DesignFormulas::Measuring measuring(context.formulas);
    return type.read(node, context);
}

std::optional<quantities::ClearanceRange> read_clearance_range(const JsonNode& node, const ReadContext& context) {
    const DesignFormulas::Measuring measuring(context.formulas);
    const auto a = context.body(node.require("a")), b = context.body(node.require("b"));
    quantities::ClearanceRange range;
    range.motion = node["motion"].boolean().value_or(false);
    range.ranges = node["ranges"].boolean().value_or(false);
    if (range.motion && range.ranges)
        node["ranges"].fail(ErrorCode::inconsistent, "either over the motion, or over the ranges of the joints, whatever the motion");
    const auto time = [&](std::string_view key) { return node[key].quantity(Dimension::time, 1, core::files::not_negative); };
    range.from = time("from");
    range.to = time("to");
    for (const std::string_view key : {"from", "to"})
        if (node[key].exists() && !range.motion)
            node[key].fail(ErrorCode::inconsistent, "`" + std::string(key) + "` is about a part of the motion; set `motion` to true");
    if (!a || !b) return std::nullopt;
    if (*a == *b) {
        node.fail(ErrorCode::inconsistent, "a clearance is between two bodies; `a` and `b` are the same");
        return std::nullopt;
    }
    range.a = *a;
    range.b = *b;
    range.faces_a = read_faces(node["faces_a"], *a, context);
    range.faces_b = read_faces(node["faces_b"], *b, context);
    return range;
}

const std::vector<QuantityType>& quantity_table() {
    static const std::vector<QuantityType> table{
        {"stroke",
         read_stroke,
         {"body", "axis", "target", "from", "to"},
         named_by("body"),
         "m",
         "how far a body travels along an axis over the motion; with `target`, in an objective, the square of what is missing"},
        {"marker_path",
         read_marker_path,
         {"body", "point", "points", "times"},
         named_by("body"),
         "m^2",
         "how far a point of a body stays from points that it should go through, at given `times` or in free timing"},
        {"marker_position", read_marker_position, with_reduction({"body", "point", "axis", "origin"}), named_by("body"), "m",
         "where a point of a body is at the start and the steps' ends: along an `axis`, else its distance, from an `origin`"},
        {"marker_speed", read_marker_speed, with_reduction({"body", "point", "axis"}), named_by("body"), "m/s",
         "velocity of a point of a body at the steps' ends: along an `axis`, else its magnitude"},
        {"play",
         read_clearance,
         {"a", "b", "faces_a", "faces_b"},
         clearance_name,
         "m",
         "certified least distance of two bodies, or of faces of theirs, as assembled, wanted small"},
        {"clearance",
         read_clearance,
         {"a", "b", "faces_a", "faces_b", "motion", "from", "to", "ranges"},
         clearance_name,
         "m",
         "certified least distance of two bodies, or of faces of theirs: as assembled, over the motion or the ranges of the joints"},
        {"mass", read_mass, {"bodies"}, named_by("bodies"), "kg", "mass of bodies"},
        {"joint_force", read_joint_load, with_reduction({"joint", "axis"}), named_by("joint"), "N",
         "force that a joint carries at the steps' ends: along an `axis`, else its magnitude"},
        {"joint_torque", read_joint_load, with_reduction({"joint", "axis"}), named_by("joint"), "N m",
         "torque that a joint carries about its point: along an `axis`, else its magnitude"},
        {"joint_position", read_joint_position, with_reduction({"joint"}), named_by("joint"), "rad or m",
         "angle of a joint that turns, travel of one that slides, at the start and the steps' ends; angles count turns"},
        {"free_range",
         read_free_range,
         {"joint", "end", "clearance", "reach", "anywhere"},
         named_by("joint", "end"),
         "rad or m",
         "how far a joint is proven free from its start on, `above` or `below`, before bodies come closer than a clearance"},
        {"turn", read_turn, with_reduction({"body", "axis"}), named_by("body"), "rad",
         "how far a body has turned about an axis since the start, at the steps' ends: of a part that a real pin holds"},
        {"motor_effort", read_motor_effort, with_reduction({"motor"}), named_by("motor"), "N m or N",
         "torque, or force, of a motor of angle, travel or speed"},
        {"contact_force", read_contact_force, with_reduction({"body", "of", "axis"}), contact_name, "N",
         "resultant force of contact on a body, `of` another or of all, at the steps' ends: along an `axis`, else its magnitude"},
        {"contact_torque", read_contact_torque, with_reduction({"body", "of", "point", "axis"}), contact_name, "N m",
         "its torque about a point of the body (what a motor that holds a massless one there has to give, with the other sign)"},
        {"gap", read_gap, with_reduction({"a", "b"}), named_by("a", "b"), "m",
         "gap between two bodies as contact measures it, at the start and the steps' ends: computed, for events"},
        {"energy", read_energy, with_reduction({"of"}), named_by("of"), "J",
         "kinetic, potential, spring or total energy at the steps' ends"},
        {"law",
         read_law,
         with_reduction({"of", "times", "along", "positions", "values", "profile"}),
         named_by(),
         "by its dimension",
         "a table over the time, or along another quantity, for expressions over the steps: what a motion is to follow",
         {"along"}},
        {"event_time",
         read_event_time,
         {"of", "derivative", "threshold", "direction", "occurrence", "from", "to"},
         named_by("of"),
         "s",
         "when a named quantity crosses a threshold, the first time or the k-th; with `derivative` 1, when it turns round",
         {"of"}},
        {"value_at",
         read_value_at,
         {"of", "derivative", "time"},
         named_by("of", "time"),
         "by its dimension",
         "what a named quantity is at the time of an event",
         {"of", "time"}},
        {"time_share",
         read_time_share,
         {"of", "derivative", "above", "below", "along", "from", "to"},
         named_by("of"),
         "1",
         "share of the time, or `along` a drive of its travel, during which a named quantity is `above` or `below` a threshold",
         {"of", "along"}},
        {"largest",
         read_largest,
         {"of"},
         named_by("of"),
         "by its dimension",
         "the largest of several named quantities, of which a search sees each",
         {"of"}},
        {"least", read_least, {"of"}, named_by("of"), "by its dimension", "the least of several named quantities, likewise", {"of"}},
        {"expression",
         read_expression,
         with_reduction({"expression"}),
         expression_name,
         "by its dimension",
         "a formula of the design's named `quantities` and parameters, such as `max_force / mass`; with `over`, of what they are at each "
         "step",
         {"expression"}}};
    return table;
}

std::vector<std::string_view> quantity_names() {
    std::vector<std::string_view> names;
    for (const QuantityType& type : quantity_table()) names.push_back(type.name);
    return names;
}

const QuantityType* find_quantity_type(std::string_view name) {
    for (const QuantityType& type : quantity_table()) {
        if (type.name == name) return &type;
    }
    return nullptr;
}

namespace {

/// Reads the entries of `quantities`, each after those that it names, in whichever order the file has them; first those that name none, so
/// that a word which is no quantity's is told with all of these.
class NamedReader {
public:
    NamedReader(const JsonNode& node, const ReadContext& context)
        : so_far_{context.scene, context.length_unit, context.end_time, context.formulas, out_, context.scenarios} {
        for (const auto& [name, entry] : node.members())
            if (!name.starts_with('#')) waiting_.push_back({name, entry, {}});
        for (Entry& entry : waiting_) entry.needs = named_in(entry.node);
        std::stable_partition(waiting_.begin(), waiting_.end(), [](const Entry& entry) { return entry.needs.empty(); });
    }

    std::vector<quantities::NamedQuantity> read() {
        while (!waiting_.empty()) {
            auto next = std::find_if(waiting_.begin(), waiting_.end(), [this](const Entry& entry) { return first_needed(entry).empty(); });
            if (next == waiting_.end()) {
                tell_circle();
                break;
            }
            const Entry entry = *next;
            waiting_.erase(next);
            if (!read_entry(entry)) failed_.insert(entry.name);
        }
        return std::move(out_);
    }

private:
    struct Entry {
        std::string name;
        JsonNode node;
        std::set<std::string> needs;
    };

    // Names that its texts may mean: all of them, of which those of quantities are looked for.
    static std::set<std::string> named_in(const JsonNode& entry) {
        std::set<std::string> out;
        const QuantityType* type = entry["type"].is_string() ? find_quantity_type(*entry["type"].string()) : nullptr;
        if (type == nullptr) return out;
        const auto add = [&](const JsonNode& text) {
            if (!text.is_string()) return;
            out.insert(*text.string());
            for (std::string& name : core::expression::names_in(*text.string())) out.insert(std::move(name));
        };
        for (const std::string_view key : type->names_in) {
            add(entry[key]);
            if (entry[key].is_array())
                for (const JsonNode& text : entry[key].elements()) add(text);
        }
        return out;
    }

    // A quantity that it names and that is still to be read.
    std::string first_needed(const Entry& entry) const {
        for (const Entry& other : waiting_)
            if (entry.needs.count(other.name) > 0) return other.name;
        return {};
    }

    void tell_circle() const {
        std::vector<std::string> way{waiting_.front().name};
        while (std::count(way.begin(), way.end(), way.back()) < 2) {
            const auto at = std::find_if(waiting_.begin(), waiting_.end(), [&](const Entry& entry) { return entry.name == way.back(); });
            way.push_back(first_needed(*at));
        }
        way.erase(way.begin(), std::find(way.begin(), way.end(), way.back()));
        const auto at = std::find_if(waiting_.begin(), waiting_.end(), [&](const Entry& entry) { return entry.name == way.front(); });
        std::string circle = "`" + way.front() + "`";
        for (std::size_t k = 1; k < way.size(); ++k) circle += " follows from `" + way[k] + "`" + (k + 1 < way.size() ? ", which" : "");
        at->node.fail(ErrorCode::inconsistent, circle + ": a quantity cannot follow from itself");
    }

    bool read_entry(const Entry& entry) {
        const JsonNode& node = entry.node;
        if (!core::expression::is_possible_name(entry.name))
            node.fail(ErrorCode::out_of_range, "a quantity's name must not be empty or contain a single quote");
        if (so_far_.formulas.scope().find(entry.name) != nullptr)
            node.fail(ErrorCode::inconsistent, "a parameter or variable is called `" + entry.name + "` already");
        const auto type_name = node.require("type").choice(quantity_names());
        if (!type_name) return false;
        const QuantityType& type = *find_quantity_type(*type_name);
        std::vector<std::string_view> keys{"type", "scenario"};
        keys.insert(keys.end(), type.keys.begin(), type.keys.end());
        node.allow_keys(keys);
        if (std::any_of(entry.needs.begin(), entry.needs.end(), [this](const std::string& name) { return failed_.count(name) > 0; }))
            return false;  // what is wrong is told of that one
        if (!counts_as_measured(entry)) return false;
        const auto quantity = read_quantity(type, node, so_far_);
        if (quantity) out_.push_back({entry.name, in_named_scenario(node, quantity, so_far_.scenarios)});
        return quantity != nullptr;
    }

    // Each that names others measures them anew: one that names two, of which each names two, and so on, would never come to an end.
    bool counts_as_measured(const Entry& entry) {
        constexpr int most = 10000;
        int count = 1;
        for (const std::string& name : entry.needs)
            if (const auto found = measured_.find(name); found != measured_.end()) count += found->second;
        if (count > most)
            entry.node.fail(ErrorCode::out_of_range, "it names others that name others, in all " + std::to_string(count) +
                                                         " times over; at most " + std::to_string(most) + " are measured");
        measured_[entry.name] = std::min(count, most);
        return count <= most;
    }

    std::vector<quantities::NamedQuantity> out_;
    std::map<std::string, int> measured_;  // how many quantities are measured for each
    ReadContext so_far_;
    std::vector<Entry> waiting_;
    std::set<std::string> failed_;
};

}  // namespace

std::vector<quantities::NamedQuantity> read_named_quantities(const JsonNode& node, const ReadContext& context) {
    return NamedReader(node, context).read();
}

}  // namespace fettle::design::reading
