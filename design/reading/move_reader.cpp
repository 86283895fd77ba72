// SPDX-License-Identifier: MIT
#include "fettle/design/reading/move_reader.hpp"

#include <algorithm>

#include "fettle/core/files/nearest_word.hpp"
#include "fettle/core/scene/mass_kind.hpp"
#include "fettle/core/scene/place.hpp"

namespace fettle::design::reading {

namespace {

using core::files::JsonNode;
using description::Move;
using description::Parameter;
using Moves = std::vector<Move>;

// What a move of a subject says that it moves, and where that is below the subject; * stands for the components of a vector.
struct Property {
    std::string_view key, place;
};

struct Subject {
    std::string_view key, list;
    std::vector<Property> properties;
};

const std::vector<Subject>& subjects() {
    static const std::vector<Property> forces{{"point_a", "point_a/*"}, {"point_b", "point_b/*"},    {"stiffness", "stiffness"},
                                              {"rest", "rest"},         {"preload", "preload"},      {"damping", "damping"},
                                              {"friction", "friction"}, {"lower_limit", "limits/0"}, {"upper_limit", "limits/1"}};
    static const auto with = [](std::vector<Property> more) {
        more.insert(more.begin(), forces.begin(), forces.end());
        return more;
    };
    static const std::vector<Subject> all{
        {"joint", "/joints/",
         with({{"axis_a", "axis_a/*"}, {"axis_b", "axis_b/*"}, {"pitch", "pitch"}, {"ratio", "ratio"}, {"radius", "ratio"}})},
        {"spring", "/springs/", forces},
        {"damper", "/springs/", {{"point_a", "point_a/*"}, {"point_b", "point_b/*"}, {"damping", "damping"}}},
        {"motor", "/motors/", {{"value", "curve/values/"}, {"speed", "curve/rate"}}},
        {"load", "/loads/", {{"point", "point/*"}, {"force", "force/*"}}},
        {"body",
         "/bodies/",
         {{"dimension", "shape/dimensions/"},
          {"position", "position/*"},
          {"turn", "turn/*"},
          {"velocity", "linear_velocity/*"},
          {"angular_velocity", "angular_velocity/*"},
          {"force", "force/*"},
          {"torque", "torque/*"},
          {"density", "density"}}}};
    return all;
}

class MoveReader {
public:
    MoveReader(const JsonNode& node, const ReadContext& context, const Shapes& shapes, const Parameter& parameter)
        : node_(node), context_(context), mechanism_(context.scene.mechanism), shapes_(shapes), parameter_(parameter) {}

    Moves read() {
        if (node_["mu"].exists()) return read_coefficient();
        if (node_["gravity"].exists()) return read_of_scene("gravity", "/gravity/*");
        if (node_["dmin"].exists()) return read_of_scene("dmin", "/contact/dmin");
        if (node_["motor"].exists() && node_["rate"].exists()) return read_rate();
        for (const Subject& subject : subjects())
            if (node_[subject.key].exists()) return read_of(subject);
        std::vector<std::string_view> keys{"scale", "offset", "rate", "gravity", "dmin", "mu", "material", "materials"};
        for (const Subject& subject : subjects()) {
            keys.push_back(subject.key);
            if (subject.key == "body")
                for (const Property& property : subject.properties) keys.push_back(property.key);
        }
        node_.allow_keys(keys);
        node_.fail(ErrorCode::missing_key,
                   "a move says what it moves: `body` with `dimension`, `position`, `turn`, `velocity`, `angular_velocity`, `force`, "
                   "`torque` or `density`, `motor` with `rate`, `speed` or `value`, `joint`, `spring`, `damper` or `load` with what of it, "
                   "`gravity`, `dmin`, or a coefficient of friction: `mu`, of a `body`, a `material`, two `materials`, or of all others");
        return {};
    }

private:
    Moves read_of_scene(std::string_view key, const std::string& place) {
        node_.allow_keys({key, "scale", "offset"});
        return read_at(place, node_[key]);
    }

    Moves read_rate() {
        node_.allow_keys({"motor", "rate", "scale", "offset"});
        const auto body = context_.body(node_["motor"]);
        const auto dof = node_["rate"].choice({"px", "py", "pz", "rx", "ry", "rz"});
        if (!body || !dof) return {};
        return read_at("/bodies/" + std::to_string(*body) + "/prescribed/" + *dof + "/rate", node_["rate"], false);
    }

    Moves read_coefficient() {
        node_.allow_keys({"body", "material", "materials", "mu", "scale", "offset"});
        const JsonNode body = node_["body"], material = node_["material"], materials = node_["materials"];
        if (body.exists() + material.exists() + materials.exists() > 1)
            return fail(node_, "one of `body`, `material` and `materials` says whose `mu` is moved");
        if (body.exists()) {
            const auto index = context_.body(body);
            return index ? read_at("/bodies/" + std::to_string(*index) + "/mu", node_["mu"]) : Moves();
        }
        if (material.exists()) return read_at("/materials/" + core::scene::escaped(material.string().value_or("")) + "/mu", node_["mu"]);
        if (!materials.exists()) return read_at("/friction/mu", node_["mu"]);
        std::vector<std::string> names;
        for (const JsonNode& name : materials.elements()) names.push_back(name.string().value_or(""));
        if (names.size() != 2) return fail(node_, "two materials are expected");
        const int pair = context_.scene.friction.pair_of(names[0], names[1]);
        if (pair < 0) return fail(node_, "material `" + names[0] + "`, `" + names[1] + "` are no pair in the scene's `friction`");
        return read_at("/friction/pairs/" + std::to_string(pair) + "/mu", node_["mu"]);
    }

    Moves read_of(const Subject& subject) {
        std::vector<std::string_view> keys{subject.key, "scale", "offset"};
        for (const Property& p : subject.properties) keys.push_back(p.key);
        node_.allow_keys(keys);
        const auto is_there = [&](const Property& p) { return node_[p.key].exists(); };
        const auto found = std::find_if(subject.properties.begin(), subject.properties.end(), is_there);
        if (found == subject.properties.end() || std::count_if(found, subject.properties.end(), is_there) != 1) {
            std::string names;
            for (const Property& p : subject.properties) names += (names.empty() ? "`" : ", `") + std::string(p.key) + "`";
            node_.fail(ErrorCode::missing_key, "a move of a " + std::string(subject.key) + " says one thing that it moves: " + names);
            return {};
        }
        const auto index = find_subject(subject.key);
        if (!index) return {};
        const JsonNode property = node_[found->key];
        std::string place = std::string(subject.list) + std::to_string(*index) + "/" + std::string(found->place);
        if (found->key == "dimension") {
            if (!check_dimension(property, *index)) return {};
            place += core::scene::escaped(property.string().value_or(""));
        }
        if (found->key == "density" && !check_density(*index)) return {};
        if (found->key == "value") place += std::to_string(property.integer(0, 1'000'000).value_or(0));
        if (found->place == "ratio" && mechanism_.joints[static_cast<size_t>(*index)].kind == core::scene::JointKind::rack)
            place.replace(place.size() - found->place.size(), found->place.size(), "radius");
        return read_at(place, property, found->key != "dimension" && found->key != "value");
    }

    std::optional<int> find_subject(std::string_view subject) const {
        const JsonNode name = node_[subject];
        if (subject == "body") return context_.body(name);
        const std::string what(subject);
        if (subject == "joint") return find_name(mechanism_.joints, name, what);
        if (subject == "motor") return find_name(mechanism_.motors, name, what);
        if (subject == "load") return find_name(mechanism_.loads, name, what);
        return find_name(mechanism_.springs, name, what);
    }

    template <class Parts>
    std::optional<int> find_name(const Parts& parts, const JsonNode& name, const std::string& what) const {
        std::vector<std::string_view> known;
        for (size_t k = 0; k < parts.size(); ++k) {
            if (parts[k].name == name.string().value_or("")) return static_cast<int>(k);
            known.push_back(parts[k].name);
        }
        if (name.is_string())
            name.fail(ErrorCode::out_of_range, "the scene has no " + what + " " + name.shown() +
                                                   (known.empty() ? "" : "; " + core::files::did_you_mean(*name.string(), known)));
        return std::nullopt;
    }

    // With what a designer may do about it.
    bool check_dimension(const JsonNode& node, int index) const {
        const core::scene::Body& body = context_.scene.bodies[static_cast<size_t>(index)];
        const auto name = node.string();
        if (!name) return false;
        if (!body.shape) {
            node_.fail(ErrorCode::inconsistent,
                       "body \"" + body.name + "\" is a mesh from a file and has no dimensions; make it a `shape`");
            return false;
        }
        const auto& shape = shapes_[static_cast<size_t>(index)];
        if (!shape) {
            node.fail(ErrorCode::unsupported,
                      "body \"" + body.name +
                          "\" has a `scale` in the scene; a part that parameters move has none: give its dimensions their full size there");
            return false;
        }
        std::vector<std::string_view> known;
        for (const description::ShapeDimension& dimension : shape->dimensions()) known.push_back(dimension.name);
        if (std::find(known.begin(), known.end(), *name) != known.end()) return true;
        node.fail(ErrorCode::out_of_range,
                  (body.shape->program ? "the program of body \"" + body.name : "generator \"" + body.shape->generator) +
                      "\" has no dimension " + node.shown() + "; " + core::files::did_you_mean(*name, known));
        return false;
    }

    bool check_density(int index) const {
        const core::scene::Body& body = context_.scene.bodies[static_cast<size_t>(index)];
        if (body.mass_kind == core::scene::MassKind::volume || parameter_.unit.dimension != Dimension::density) return true;
        node_.fail(ErrorCode::inconsistent, "the density of body \"" + body.name + "\" is in " + core::scene::density_unit(body.mass_kind) +
                                                " (its `mass_per`); give parameter \"" + parameter_.name + "\" the unit 1");
        return false;
    }

    static Moves fail(const JsonNode& node, const std::string& message) {
        node.fail(ErrorCode::inconsistent, message);
        return {};
    }

    // @param place     A pointer to a number, or, with * for its components, to a vector.
    // @param property  What says so: `true` for a number that needs no more words, coefficients for a vector.
    Moves read_at(std::string place, const JsonNode& property, bool is_said_by_true = true) {
        const bool is_vector = place.ends_with("/*");
        if (is_vector) place.back() = '0';
        const auto found = core::scene::find_place(context_.scene, place);
        if (!found) return fail(property, found.errors().front().message);
        place = pointer_to(context_.scene, *found);
        const Dimension dimension = dimension_at(context_.scene, *found);
        if (is_vector) return read_vector(place.substr(0, place.size() - 2), property, dimension);
        if (is_said_by_true && !property.boolean().value_or(true))
            property.fail(ErrorCode::out_of_range, "it is `true` that names what is moved");
        const double scale = read_scale(dimension), offset = read_offset(node_["offset"], dimension);
        return {{place, scale, offset}};
    }

    Moves read_vector(const std::string& place, const JsonNode& property, Dimension dimension) {
        const Vector3 direction = property.vector3().value_or(Vector3::UnitX());
        if (direction.norm() == 0) property.fail(ErrorCode::out_of_range, "all coefficients are 0: this moves nothing");
        const JsonNode offset = node_["offset"];
        const std::vector<JsonNode> components = offset.elements();
        if (offset.is_array() && components.size() != 3) offset.fail(ErrorCode::wrong_type, "an offset of a vector has three components");
        Vector3 offsets = Vector3::Zero();
        for (size_t i = 0; i < 3 && components.size() == 3; ++i) {
            const auto k = static_cast<Eigen::Index>(i);
            offsets[k] = read_offset(components[i], dimension);
            if (direction[k] == 0 && offsets[k] != 0)
                offset.fail(ErrorCode::inconsistent, "an offset along an axis whose coefficient is 0; the scene's value holds there");
        }
        return description::vector_moves(place, direction, read_scale(dimension), offsets);
    }

    // That plain numbers are in.
    double plain_unit(Dimension dimension) const {
        if (dimension == Dimension::length || dimension == Dimension::speed) return context_.length_unit;
        if (dimension == Dimension::angle) return to_si(1, *find_unit("deg"));
        return dimension == Dimension::angular_speed ? to_si(1, *find_unit("deg/s")) : 1;
    }

    double read_offset(const JsonNode& node, Dimension dimension) const {
        return node.quantity(dimension, plain_unit(dimension)).value_or(0);
    }

    double read_scale(Dimension moved) const {
        const double scale = node_["scale"].number().value_or(1);
        const Dimension own = parameter_.unit.dimension;
        if (own == Dimension::number && moved != Dimension::number) return scale * plain_unit(moved);
        if (own != moved) {
            const std::string allowed = moved == Dimension::number ? "" : unit_names(moved) + ", or ";
            node_.fail(ErrorCode::inconsistent, "parameter \"" + parameter_.name + "\" is in " + std::string(parameter_.unit.name) +
                                                    ", which is not a measure of what it moves here; allowed: " + allowed + "1");
        }
        return scale;
    }

    const JsonNode& node_;
    const ReadContext& context_;
    const core::scene::Mechanism& mechanism_;
    const Shapes& shapes_;
    const Parameter& parameter_;
};

}  // namespace

Moves read_moves(const JsonNode& node, const ReadContext& context, const Shapes& shapes, const Parameter& parameter) {
    if (node.is_object()) return MoveReader(node, context, shapes, parameter).read();
    node.allow_keys({});
    return {};
}

}  // namespace fettle::design::reading
