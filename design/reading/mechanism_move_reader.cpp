// SPDX-License-Identifier: MIT
#include "fettle/design/reading/mechanism_move_reader.hpp"

#include <algorithm>

#include "fettle/core/files/nearest_word.hpp"
#include "fettle/design/problem/friction_moves.hpp"
#include "fettle/design/problem/mechanism_moves.hpp"

namespace fettle::design::reading {

namespace {

using core::files::JsonNode;
using core::model::Origin;
using core::scene::JointKind;
using description::Move;
using description::MoveTarget;
using description::Parameter;
using List = Origin::List;

// What a target is measured in; plain numbers are in `unit`.
struct TargetUnit {
    Dimension dimension = Dimension::number;
    double unit = 1;
};

struct Property {
    std::string_view key;
    MoveTarget target;
};

const std::vector<Property>& properties_of(std::string_view subject) {
    static const std::vector<Property> joint{{"point_a", MoveTarget::point_a},
                                             {"point_b", MoveTarget::point_b},
                                             {"axis_a", MoveTarget::axis_a},
                                             {"axis_b", MoveTarget::axis_b},
                                             {"stiffness", MoveTarget::stiffness},
                                             {"rest", MoveTarget::rest},
                                             {"preload", MoveTarget::preload},
                                             {"damping", MoveTarget::damping},
                                             {"friction", MoveTarget::friction},
                                             {"lower_limit", MoveTarget::lower_limit},
                                             {"upper_limit", MoveTarget::upper_limit},
                                             {"pitch", MoveTarget::pitch},
                                             {"ratio", MoveTarget::ratio},
                                             {"radius", MoveTarget::ratio}};
    static const std::vector<Property> spring{
        {"point_a", MoveTarget::point_a},   {"point_b", MoveTarget::point_b},         {"stiffness", MoveTarget::stiffness},
        {"rest", MoveTarget::rest},         {"preload", MoveTarget::preload},         {"damping", MoveTarget::damping},
        {"friction", MoveTarget::friction}, {"lower_limit", MoveTarget::lower_limit}, {"upper_limit", MoveTarget::upper_limit}};
    static const std::vector<Property> damper{
        {"point_a", MoveTarget::point_a}, {"point_b", MoveTarget::point_b}, {"damping", MoveTarget::damping}};
    static const std::vector<Property> motor{{"value", MoveTarget::curve_value}, {"speed", MoveTarget::curve_rate}};
    static const std::vector<Property> load{{"point", MoveTarget::load_point}, {"force", MoveTarget::load_force}};
    static const std::vector<Property> body{{"turn", MoveTarget::turn},
                                            {"velocity", MoveTarget::velocity},
                                            {"angular_velocity", MoveTarget::angular_velocity},
                                            {"force", MoveTarget::force},
                                            {"torque", MoveTarget::torque}};
    if (subject == "joint") return joint;
    if (subject == "spring") return spring;
    if (subject == "damper") return damper;
    if (subject == "motor") return motor;
    return subject == "load" ? load : body;
}

constexpr std::array subjects{"joint", "spring", "damper", "motor", "load", "body"};

bool is_angle(const core::scene::Joint& joint) { return joint.kind == JointKind::revolute || joint.kind == JointKind::screw; }

class MoveReader {
public:
    MoveReader(const JsonNode& node, const ReadContext& context, const Parameter& parameter)
        : node_(node), context_(context), mechanism_(context.scene.mechanism), parameter_(parameter) {}

    std::optional<Move> read() {
        if (node_["mu"].exists()) return read_coefficient();
        if (node_["gravity"].exists()) {
            node_.allow_keys({"gravity", "scale", "offset"});
            move_.target = MoveTarget::gravity;
            read_vector(node_["gravity"], {Dimension::acceleration, 1});
            return move_;
        }
        if (node_["dmin"].exists()) {
            node_.allow_keys({"dmin", "scale", "offset"});
            move_.target = MoveTarget::dmin;
            read_number(node_["dmin"], coordinate(false));
            return move_;
        }
        for (const std::string_view subject : subjects)
            if (node_[subject].exists()) return read_of(subject);
        return std::nullopt;
    }

private:
    std::optional<Move> read_coefficient() {
        node_.allow_keys({"body", "material", "materials", "mu", "scale", "offset"});
        const JsonNode body = node_["body"], material = node_["material"], materials = node_["materials"];
        if (body.exists() + material.exists() + materials.exists() > 1) {
            node_.fail(ErrorCode::inconsistent, "one of `body`, `material` and `materials` says whose `mu` is moved");
            return std::nullopt;
        }
        move_.target = body.exists() ? MoveTarget::body_mu : material.exists() ? MoveTarget::material_mu : MoveTarget::default_mu;
        if (materials.exists()) move_.target = MoveTarget::pair_mu;
        if (body.exists() && !find_subject("body")) return std::nullopt;
        if (material.exists()) move_.materials = {material.string().value_or("")};
        for (const JsonNode& name : materials.elements()) move_.materials.push_back(name.string().value_or(""));
        if (const std::string reason = problem::friction_misfit(context_.scene, move_); !reason.empty()) {
            node_.fail(ErrorCode::inconsistent, reason);
            return std::nullopt;
        }
        read_number(node_["mu"], {});
        return move_;
    }

    std::optional<Move> read_of(std::string_view subject) {
        const std::vector<Property>& properties = properties_of(subject);
        std::vector<std::string_view> keys{subject, "scale", "offset"};
        for (const Property& p : properties) keys.push_back(p.key);
        node_.allow_keys(keys);
        const auto is_there = [&](const Property& p) { return node_[p.key].exists(); };
        const auto found = std::find_if(properties.begin(), properties.end(), is_there);
        if (found == properties.end() || std::count_if(properties.begin(), properties.end(), is_there) != 1) {
            std::string names;
            for (const Property& p : properties) names += (names.empty() ? "`" : ", `") + std::string(p.key) + "`";
            node_.fail(ErrorCode::missing_key, "a move of a " + std::string(subject) + " says one thing that it moves: " + names);
            return std::nullopt;
        }
        move_.target = found->target;
        if (!find_subject(subject)) return std::nullopt;
        if (is_of_mechanism(move_.target)) {
            const std::string reason = read_entry_and_judge(node_[found->key]);
            if (!reason.empty()) {
                node_[found->key].fail(ErrorCode::inconsistent, reason);
                return std::nullopt;
            }
        }
        const TargetUnit unit = unit_of(move_.target);
        if (is_vector(move_.target))
            read_vector(node_[found->key], unit);
        else
            read_number(node_[found->key], unit);
        return move_;
    }

    std::string read_entry_and_judge(const JsonNode& property) {
        if (move_.target == MoveTarget::curve_value) move_.entry = property.integer(0, 1'000'000).value_or(0);
        return problem::misfit(mechanism_, move_);
    }

    template <class Parts>
    int find_name(const Parts& parts, const JsonNode& name, const std::string& what) const {
        std::vector<std::string_view> known;
        for (size_t k = 0; k < parts.size(); ++k) {
            if (parts[k].name == name.string().value_or("")) return static_cast<int>(k);
            known.push_back(parts[k].name);
        }
        if (name.is_string())
            name.fail(ErrorCode::out_of_range, "the scene has no " + what + " " + name.shown() +
                                                   (known.empty() ? "" : "; " + core::files::did_you_mean(*name.string(), known)));
        return -1;
    }

    bool find_subject(std::string_view subject) {
        const JsonNode name = node_[subject];
        const std::string what(subject);
        if (subject == "body") {
            const auto body = context_.body(name);
            move_.body = body.value_or(0);
            return body.has_value();
        }
        if (subject == "joint") move_.part = {List::joint, find_name(mechanism_.joints, name, what)};
        if (subject == "spring" || subject == "damper") move_.part = {List::spring, find_name(mechanism_.springs, name, what)};
        if (subject == "motor") move_.part = {List::motor, find_name(mechanism_.motors, name, what)};
        if (subject == "load") move_.part = {List::load, find_name(mechanism_.loads, name, what)};
        return move_.part.index >= 0;
    }

    // Is the coordinate that the part acts along an angle?
    bool acts_on_angle() const {
        const auto i = static_cast<size_t>(move_.part.index);
        if (move_.part.list == List::joint) return is_angle(mechanism_.joints[i]);
        const std::string& name = move_.part.list == List::spring ? mechanism_.springs[i].joint : mechanism_.motors[i].joint;
        for (const core::scene::Joint& joint : mechanism_.joints)
            if (joint.name == name) return is_angle(joint);
        return false;
    }

    TargetUnit coordinate(bool angle) const {
        if (angle) return {Dimension::angle, to_si(1, *find_unit("deg"))};
        return {Dimension::length, context_.length_unit};
    }

    TargetUnit unit_of_curve(bool angle) const {
        if (mechanism_.motors[static_cast<size_t>(move_.part.index)].kind == core::scene::MotorKind::effort)
            return move_.target == MoveTarget::curve_rate ? TargetUnit{} : TargetUnit{angle ? Dimension::torque : Dimension::force, 1};
        if (move_.target == MoveTarget::curve_value) return coordinate(angle);
        if (angle) return {Dimension::angular_speed, to_si(1, *find_unit("deg/s"))};
        return {Dimension::speed, context_.length_unit};
    }

    TargetUnit unit_of(MoveTarget target) const {
        const bool angle = is_of_mechanism(target) && move_.part.list != List::load && acts_on_angle();
        switch (target) {
            case MoveTarget::turn:
                return coordinate(true);
            case MoveTarget::velocity:
                return {Dimension::speed, context_.length_unit};
            case MoveTarget::angular_velocity:
                return {Dimension::angular_speed, to_si(1, *find_unit("deg/s"))};
            case MoveTarget::force:
            case MoveTarget::load_force:
                return {Dimension::force, 1};
            case MoveTarget::torque:
                return {Dimension::torque, 1};
            case MoveTarget::point_a:
            case MoveTarget::point_b:
            case MoveTarget::load_point:
            case MoveTarget::pitch:
                return coordinate(false);
            case MoveTarget::rest:
            case MoveTarget::lower_limit:
            case MoveTarget::upper_limit:
                return coordinate(angle);
            case MoveTarget::stiffness:
                return angle ? TargetUnit{} : TargetUnit{Dimension::stiffness, 1};
            case MoveTarget::preload:
            case MoveTarget::friction:
                return {angle ? Dimension::torque : Dimension::force, 1};
            case MoveTarget::ratio:
                return mechanism_.joints[static_cast<size_t>(move_.part.index)].kind == JointKind::rack ? coordinate(false) : TargetUnit{};
            case MoveTarget::curve_value:
            case MoveTarget::curve_rate:
                return unit_of_curve(angle);
            default:
                return {};  // components of an axis, damping: no unit has a name
        }
    }

    void read_number(const JsonNode& property, const TargetUnit& unit) {
        const bool is_entry = move_.target == MoveTarget::curve_value;
        if (!is_entry && !property.boolean().value_or(true))
            property.fail(ErrorCode::out_of_range, "it is `true` that names what is moved");
        move_.scale = read_scale(node_, parameter_, unit.dimension, unit.unit);
        move_.offset = node_["offset"].quantity(unit.dimension, unit.unit).value_or(0);
    }

    void read_vector(const JsonNode& property, const TargetUnit& unit) {
        move_.direction = property.vector3().value_or(Vector3::UnitX());
        if (move_.direction.norm() == 0) property.fail(ErrorCode::out_of_range, "all coefficients are 0: this moves nothing");
        move_.scale = read_scale(node_, parameter_, unit.dimension, unit.unit);
        const JsonNode offset = node_["offset"];
        if (!offset.exists()) return;
        const std::vector<JsonNode> components = offset.elements();
        if (offset.is_array() && components.size() != 3) offset.fail(ErrorCode::wrong_type, "an offset of a vector has three components");
        for (size_t i = 0; i < 3 && components.size() == 3; ++i) {
            const auto k = static_cast<Eigen::Index>(i);
            move_.position_offset[k] = components[i].quantity(unit.dimension, unit.unit).value_or(0);
            if (move_.direction[k] == 0 && move_.position_offset[k] != 0)
                offset.fail(ErrorCode::inconsistent, "an offset along an axis whose coefficient is 0; the scene's value holds there");
        }
    }

    const JsonNode& node_;
    const ReadContext& context_;
    const core::scene::Mechanism& mechanism_;
    const Parameter& parameter_;
    Move move_;
};

}  // namespace

bool is_mechanism_move(const JsonNode& node) {
    if (node["gravity"].exists() || node["mu"].exists() || node["dmin"].exists()) return true;
    if (node["motor"].exists()) return !node["rate"].exists();
    for (const char* subject : {"joint", "spring", "damper", "load"})
        if (node[subject].exists()) return true;
    for (const Property& p : properties_of("body"))
        if (node["body"].exists() && node[p.key].exists()) return true;
    return false;
}

std::optional<Move> read_mechanism_move(const JsonNode& node, const ReadContext& context, const Parameter& parameter) {
    return MoveReader(node, context, parameter).read();
}

double read_scale(const JsonNode& node, const Parameter& parameter, Dimension target, double target_unit) {
    const double scale = node["scale"].number().value_or(1);
    if (parameter.unit.dimension == Dimension::number && target != Dimension::number) return scale * target_unit;
    if (parameter.unit.dimension != target) {
        const std::string allowed = target == Dimension::number ? "" : unit_names(target) + ", or ";
        node.fail(ErrorCode::inconsistent, "parameter \"" + parameter.name + "\" is in " + std::string(parameter.unit.name) +
                                               ", which is not a measure of what it moves here; allowed: " + allowed + "1");
    }
    return scale;
}

}  // namespace fettle::design::reading
