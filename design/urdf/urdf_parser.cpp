// SPDX-License-Identifier: MIT
#include "fettle/design/urdf/urdf_parser.hpp"

#include <algorithm>
#include <cmath>

#include "fettle/core/base/text.hpp"
#include "fettle/core/files/nearest_word.hpp"
#include "fettle/core/files/text_lines.hpp"
#include "fettle/core/mesh_files/xml_reader.hpp"

namespace fettle::design::urdf {

namespace {

using core::mesh_files::XmlReader;

const std::vector<std::string_view> joint_types{"revolute", "continuous", "prismatic", "fixed", "floating", "planar"};

class UrdfParser {
public:
    UrdfParser(std::string_view text, const std::string& where) : xml_(text, where) {}

    Result<Robot> parse() {
        bool seen_robot = false;
        xml_.read([&] {
            if (xml_.depth() == 1 && xml_.name() != "robot") xml_.fail(ErrorCode::parse, "the first element is not a URDF <robot>");
            if (xml_.depth() == 1 && xml_.opens()) {
                seen_robot = true;
                robot_.name = std::string(xml_.attribute("name").value_or("robot"));
            }
            if (xml_.depth() == 2) start_or_end();
            if (xml_.depth() > 2 && xml_.opens() && link_) read_in_link();
            if (xml_.depth() == 3 && xml_.opens() && joint_) read_in_joint();
        });
        if (!seen_robot && xml_.errors().empty()) xml_.fail(ErrorCode::parse, "has no <robot>");
        if (!xml_.errors().empty()) return xml_.errors();
        return std::move(robot_);
    }

private:
    void start_or_end() {
        link_ = joint_ = false;
        if (!xml_.opens()) return;
        const std::string name = std::string(xml_.attribute("name").value_or(""));
        if (xml_.name() != "link" && xml_.name() != "joint") return;
        if (name.empty()) xml_.fail(ErrorCode::missing_key, "a <" + std::string(xml_.name()) + "> needs a `name`");
        if (const std::string fault = core::base::name_fault(name); !fault.empty())
            xml_.fail(ErrorCode::out_of_range,
                      "the name of a <" + std::string(xml_.name()) + "> " + fault + "; a name is text on one line");
        if (xml_.name() == "link") {
            robot_.links.emplace_back();
            robot_.links.back().name = name;
            link_ = true;
            section_ = nullptr;
            return;
        }
        robot_.joints.emplace_back();
        robot_.joints.back().name = name;
        robot_.joints.back().type = std::string(xml_.attribute("type").value_or(""));
        const std::string& type = robot_.joints.back().type;
        if (std::find(joint_types.begin(), joint_types.end(), type) == joint_types.end())
            xml_.fail(ErrorCode::unsupported, "a joint of type \"" + type + "\"; " + core::files::did_you_mean(type, joint_types));
        joint_ = true;
    }

    void read_in_link() {
        Link& link = robot_.links.back();
        const std::string_view name = xml_.name();
        if (xml_.depth() == 3) {
            section_ = name == "collision" ? &link.collision : name == "visual" ? &link.visual : nullptr;
            inertial_ = name == "inertial";
            if (section_) section_->emplace_back();
            return;
        }
        if (inertial_) return read_in_inertial(link);
        if (!section_) return;
        Geometry& geometry = section_->back();
        if (name == "origin" && xml_.depth() == 4) geometry.origin = origin();
        if (xml_.depth() != 5) return;
        if (name == "box") {
            geometry.kind = GeometryKind::box;
            geometry.size = vector("size", Vector3::Zero());
            if (!(geometry.size.minCoeff() > 0)) xml_.fail(ErrorCode::out_of_range, "the `size` of a <box> is three positive numbers");
        } else if (name == "cylinder" || name == "sphere") {
            geometry.kind = name == "sphere" ? GeometryKind::sphere : GeometryKind::cylinder;
            geometry.radius = positive_number("radius");
            if (name == "cylinder") geometry.length = positive_number("length");
        } else if (name == "mesh") {
            geometry.kind = GeometryKind::mesh;
            geometry.file = std::string(xml_.attribute("filename").value_or(""));
            if (geometry.file.empty()) xml_.fail(ErrorCode::missing_key, "a <mesh> needs a `filename`");
            geometry.scale = vector("scale", Vector3::Ones());
        } else {
            xml_.fail(ErrorCode::unsupported,
                      "<" + std::string(name) + "> is not a geometry that is read; known are box, cylinder, sphere, mesh");
        }
    }

    void read_in_inertial(Link& link) {
        const std::string_view name = xml_.name();
        if (name == "mass") link.mass = positive_number("value");
        if (name == "origin") link.centre = origin();
        if (name != "inertia") return;
        const auto entry = [&](const char* key) { return number(key).value_or(0); };
        const double xy = entry("ixy"), xz = entry("ixz"), yz = entry("iyz");
        link.inertia.emplace();
        *link.inertia << entry("ixx"), xy, xz, xy, entry("iyy"), yz, xz, yz, entry("izz");
    }

    void read_in_joint() {
        Joint& joint = robot_.joints.back();
        const std::string_view name = xml_.name();
        if (name == "parent") joint.parent = std::string(xml_.attribute("link").value_or(""));
        if (name == "child") joint.child = std::string(xml_.attribute("link").value_or(""));
        if (name == "origin") joint.origin = origin();
        if (name == "axis") {
            joint.axis = vector("xyz", Vector3::UnitX());
            if (!(joint.axis.norm() > 0)) xml_.fail(ErrorCode::out_of_range, "an <axis> needs a length greater than 0");
        }
        if (name == "limit") {
            joint.lower = number("lower").value_or(0);
            joint.upper = number("upper").value_or(0);
            if (*joint.lower > *joint.upper) xml_.fail(ErrorCode::out_of_range, "the `lower` limit is above the `upper` one");
        }
        if (name == "dynamics") {
            joint.damping = number("damping").value_or(0);
            joint.friction = number("friction").value_or(0);
        }
        if (name == "mimic") {
            joint.mimics = std::string(xml_.attribute("joint").value_or(""));
            joint.multiplier = number("multiplier").value_or(1);
            joint.offset = number("offset").value_or(0);
        }
    }

    core::kinematics::Pose origin() { return {rotation_of_rpy(vector("rpy", Vector3::Zero())), vector("xyz", Vector3::Zero())}; }

    std::optional<double> number(std::string_view key) {
        const auto text = xml_.attribute(key);
        if (!text) return std::nullopt;
        const auto value = core::files::parsed_number(*text);
        if (!value) xml_.fail(ErrorCode::parse, "the attribute `" + std::string(key) + "` is not a number");
        if (value && !(std::abs(*value) <= 1e30))
            xml_.fail(ErrorCode::not_finite, "the attribute `" + std::string(key) + "` is not finite, or beyond 1e30");
        return value;
    }

    double positive_number(std::string_view key) {
        const double value = number(key).value_or(0);
        if (!(value > 0)) xml_.fail(ErrorCode::out_of_range, "the attribute `" + std::string(key) + "` must be greater than 0");
        return value;
    }

    Vector3 vector(std::string_view key, const Vector3& otherwise) {
        const auto text = xml_.attribute(key);
        if (!text) return otherwise;
        std::vector<std::string_view> words;
        core::files::TextLines(*text).next(words);
        Vector3 out = otherwise;
        bool good = words.size() == 3;
        for (std::size_t k = 0; good && k < 3; ++k) {
            const auto value = core::files::parsed_number(words[k]);
            good = value && std::abs(*value) <= 1e30;
            if (good) out[k] = *value;
        }
        if (!good) xml_.fail(ErrorCode::parse, "the attribute `" + std::string(key) + "` is not three numbers");
        return out;
    }

    XmlReader xml_;
    Robot robot_;
    bool link_ = false, joint_ = false, inertial_ = false;  // what encloses the element
    std::vector<Geometry>* section_ = nullptr;
};

constexpr std::size_t most_listed = 20;

Errors check_ends(const Robot& robot, const std::string& where) {
    Errors errors;
    std::vector<std::string_view> names;
    for (const Link& link : robot.links) names.push_back(link.name);
    std::vector<std::string_view> sorted = names, joints;
    std::sort(sorted.begin(), sorted.end());
    for (const Joint& joint : robot.joints) {
        joints.push_back(joint.name);
        if (errors.size() >= most_listed) break;
        for (const auto& [end, name] : {std::pair{"parent", &joint.parent}, {"child", &joint.child}}) {
            if (std::binary_search(sorted.begin(), sorted.end(), *name)) continue;
            errors.push_back({ErrorCode::missing_key, where,
                              "the " + std::string(end) + " of the joint \"" + joint.name + "\" is the link \"" + *name +
                                  "\", which is not there; " + core::files::did_you_mean(*name, names)});
        }
    }
    std::sort(joints.begin(), joints.end());
    for (const auto& [kind, of_kind] : {std::pair{"links", &sorted}, {"joints", &joints}}) {
        const auto twice = std::adjacent_find(of_kind->begin(), of_kind->end());
        if (twice != of_kind->end())
            errors.push_back({ErrorCode::inconsistent, where, "two " + std::string(kind) + " are called \"" + std::string(*twice) + "\""});
    }
    return errors;
}

}  // namespace

Result<Robot> parse_urdf(std::string_view text, const std::string& where) {
    Result<Robot> robot = UrdfParser(text, where).parse();
    if (!robot) return robot;
    Errors errors = check_ends(*robot, where);
    if (!errors.empty()) return errors;
    return robot;
}

}  // namespace fettle::design::urdf
