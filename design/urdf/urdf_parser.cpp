// SPDX-License-Identifier: MIT
#include "design/urdf/urdf_parser.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/base/text.hpp"
#include "core/files/nearest_word.hpp"
#include "core/files/text_lines.hpp"
#include "core/mesh_files/xml_reader.hpp"
#include "design/urdf/urdf_words.hpp"

namespace fettle::design::urdf {

namespace {

using core::mesh_files::XmlReader;

const std::vector<std::string_view> joint_types{"revolute", "continuous", "prismatic", "fixed", "floating", "planar"};
constexpr double largest_number = 1e30;

/// Words that were passed over: each once, with how often it stood.
class PassedOver {
public:
    void add(const std::string& word, std::string_view why, const std::string& where) {
        const auto [entry, fresh] = index_.try_emplace(word, words_.size());
        if (fresh) words_.push_back({word, std::string(why), where, 0});
        ++words_[entry->second].count;
    }
    std::vector<std::string> warnings() const {
        std::vector<std::string> out;
        for (std::size_t i = 0; i < std::min(words_.size(), most_told); ++i) {
            const Word& word = words_[i];
            out.push_back(word.first + ": " + word.word + " is passed over" +
                          (word.count > 1 ? " (" + std::to_string(word.count) + " of them in all)" : "") + ": " + word.why);
        }
        if (words_.size() > most_told) out.push_back("and " + std::to_string(words_.size() - most_told) + " more words are passed over");
        return out;
    }

private:
    static constexpr std::size_t most_told = 50;
    struct Word {
        std::string word, why, first;
        int count = 0;
    };
    std::map<std::string, std::size_t> index_;
    std::vector<Word> words_;
};

std::string_view trimmed(std::string_view text) {
    constexpr std::string_view blanks = " \t\r\n";
    const std::size_t first = text.find_first_not_of(blanks);
    return first == std::string_view::npos ? std::string_view() : text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

class UrdfParser {
public:
    UrdfParser(std::string_view text, const std::string& where) : xml_(text, where) {}

    Result<Robot> parse() {
        xml_.read([&] { xml_.opens() ? open() : close(); });
        if (!seen_robot_ && xml_.errors().empty()) xml_.fail(ErrorCode::parse, "has no <robot>");
        if (!xml_.errors().empty()) return xml_.errors();
        take_colours();
        robot_.warnings = passed_over_.warnings();
        return std::move(robot_);
    }

private:
    using Read = void (UrdfParser::*)();

    /// The reader of an element that has more to tell than that it is there.
    static Read reader_of(std::string_view path) {
        static const std::map<std::string_view, Read> readers{{"robot", &UrdfParser::read_robot},
                                                              {"robot/material", &UrdfParser::read_material},
                                                              {"robot/material/color", &UrdfParser::read_colour},
                                                              {"robot/link", &UrdfParser::read_link},
                                                              {"robot/link/inertial/origin", &UrdfParser::read_centre},
                                                              {"robot/link/inertial/mass", &UrdfParser::read_mass},
                                                              {"robot/link/inertial/inertia", &UrdfParser::read_inertia},
                                                              {"robot/link/visual", &UrdfParser::read_visual},
                                                              {"robot/link/visual/material", &UrdfParser::read_material_of_link},
                                                              {"robot/link/visual/material/color", &UrdfParser::read_colour},
                                                              {"robot/link/collision", &UrdfParser::read_collision},
                                                              {"robot/joint", &UrdfParser::read_joint},
                                                              {"robot/joint/origin", &UrdfParser::read_joint_origin},
                                                              {"robot/joint/parent", &UrdfParser::read_parent},
                                                              {"robot/joint/child", &UrdfParser::read_child},
                                                              {"robot/joint/axis", &UrdfParser::read_axis},
                                                              {"robot/joint/dynamics", &UrdfParser::read_dynamics},
                                                              {"robot/joint/limit", &UrdfParser::read_limit},
                                                              {"robot/joint/mimic", &UrdfParser::read_mimic}};
        static const std::map<std::string_view, Read> of_shapes{{"origin", &UrdfParser::read_shape_origin},
                                                                {"geometry/box", &UrdfParser::read_box},
                                                                {"geometry/cylinder", &UrdfParser::read_cylinder},
                                                                {"geometry/sphere", &UrdfParser::read_sphere},
                                                                {"geometry/mesh", &UrdfParser::read_mesh}};
        for (const std::string_view shape : {"robot/link/visual/", "robot/link/collision/"}) {
            const auto found = path.starts_with(shape) ? of_shapes.find(path.substr(shape.size())) : of_shapes.end();
            if (found != of_shapes.end()) return found->second;
        }
        const auto found = readers.find(path);
        return found == readers.end() ? nullptr : found->second;
    }

    void open() {
        if (passed_over_depth_ > 0) return;
        if (xml_.depth() == 1 && xml_.name() != "robot") return xml_.fail(ErrorCode::parse, "the first element is not a URDF <robot>");
        const bool in_geometry = path_.ends_with("/geometry");
        path_ += (path_.empty() ? "" : "/") + std::string(xml_.name());
        const UrdfElement* element = find_urdf_element(path_);
        if (element && element->passed_over.empty()) {
            look_at_attributes(*element);
            if (const Read read = reader_of(path_)) (this->*read)();
            return;
        }
        if (in_geometry) {  // which is refused where it is needed
            shape().kind = GeometryKind::other;
            shape().file = std::string(xml_.name());
        }
        passed_over_.add(word(), element ? element->passed_over : "it is no word of URDF that is known here", xml_.where());
        passed_over_depth_ = xml_.depth();
    }

    void close() {
        if (passed_over_depth_ > 0 && xml_.depth() != passed_over_depth_) return;
        passed_over_depth_ = 0;
        if (path_ == "robot/joint") check_joint();
        const std::size_t last = path_.find_last_of('/');
        path_.resize(last == std::string::npos ? 0 : last);
    }

    /// "<limit> of <joint>".
    std::string word() const {
        const std::size_t last = path_.find_last_of('/');
        const std::string own = "<" + path_.substr(last == std::string::npos ? 0 : last + 1) + ">";
        if (last == std::string::npos || last == std::string_view("robot").size()) return own;
        const std::size_t before = path_.find_last_of('/', last - 1);
        return own + " of <" + path_.substr(before + 1, last - before - 1) + ">";
    }

    void look_at_attributes(const UrdfElement& element) {
        for (const std::string_view name : xml_.attribute_names()) {
            const auto known = std::find_if(element.attributes.begin(), element.attributes.end(),
                                            [&](const UrdfAttribute& attribute) { return attribute.name == name; });
            const bool is_known = known != element.attributes.end();
            if ((is_known && known->passed_over.empty()) || name.starts_with("xmlns")) continue;
            passed_over_.add("`" + core::base::shown_on_one_line(name) + "` of " + word(),
                             is_known ? known->passed_over : "it is no word of URDF that is known here", xml_.where());
        }
    }

    Link& link() { return robot_.links.back(); }
    Joint& joint() { return robot_.joints.back(); }
    Geometry& shape() { return shapes_->back(); }

    void read_robot() {
        seen_robot_ = true;
        robot_.name = std::string(xml_.attribute("name").value_or("robot"));
    }

    void read_material() { material_ = text("name"); }

    void read_material_of_link() {
        material_ = text("name");
        if (link().material.empty()) link().material = material_;
    }

    /// A material with a name is the same wherever it stands; one without is of its link alone.
    void read_colour() {
        const std::vector<double> numbers = list("rgba", 4);
        if (numbers.empty()) return;
        Rgba colour{};
        for (std::size_t k = 0; k < 4; ++k) colour[k] = std::clamp(numbers[k], 0.0, 1.0);
        if (!material_.empty()) {
            colours_[material_] = colour;
        } else if (path_.starts_with("robot/link/") && !link().colour) {
            link().colour = colour;
        }
    }

    void take_colours() {
        for (Link& each : robot_.links) {
            if (each.colour || each.material.empty()) continue;
            const auto found = colours_.find(each.material);
            if (found != colours_.end()) {
                each.colour = found->second;
            } else {
                passed_over_.add("the material \"" + each.material + "\"", "it has no colour anywhere", "link \"" + each.name + "\"");
            }
        }
    }

    std::string checked_name() {
        const std::string name = text("name"), element(xml_.name());
        if (name.empty()) xml_.fail(ErrorCode::missing_key, "a <" + element + "> needs a `name`");
        if (const std::string fault = core::base::name_fault(name); !fault.empty())
            xml_.fail(ErrorCode::out_of_range, "the name of a <" + element + "> " + fault + "; a name is text on one line");
        return name;
    }

    void read_link() {
        robot_.links.emplace_back();
        link().name = checked_name();
    }

    void read_visual() { (shapes_ = &link().visual)->emplace_back(); }
    void read_collision() { (shapes_ = &link().collision)->emplace_back(); }
    void read_shape_origin() { shape().origin = origin(); }

    void read_box() {
        shape().kind = GeometryKind::box;
        shape().size = vector("size", Vector3::Zero());
        if (!(shape().size.minCoeff() > 0)) xml_.fail(ErrorCode::out_of_range, "the `size` of a <box> is three positive numbers");
    }
    void read_cylinder() {
        shape().kind = GeometryKind::cylinder;
        shape().radius = positive_number("radius");
        shape().length = positive_number("length");
    }
    void read_sphere() {
        shape().kind = GeometryKind::sphere;
        shape().radius = positive_number("radius");
    }
    void read_mesh() {
        shape().kind = GeometryKind::mesh;
        shape().file = text("filename");
        if (shape().file.empty()) xml_.fail(ErrorCode::missing_key, "a <mesh> needs a `filename`");
        shape().scale = vector("scale", Vector3::Ones());
        if (shape().scale.prod() == 0) xml_.fail(ErrorCode::out_of_range, "the `scale` of a <mesh> is three numbers that are not 0");
    }

    void read_centre() { link().centre = origin(); }
    void read_mass() {
        link().mass = number("value").value_or(0);
        if (!(*link().mass >= 0)) xml_.fail(ErrorCode::out_of_range, "the attribute `value` of a <mass> must be 0 or more");
    }
    void read_inertia() {
        const auto entry = [&](const char* key) { return number(key).value_or(0); };
        const double xy = entry("ixy"), xz = entry("ixz"), yz = entry("iyz");
        link().inertia.emplace();
        *link().inertia << entry("ixx"), xy, xz, xy, entry("iyy"), yz, xz, yz, entry("izz");
    }

    void read_joint() {
        robot_.joints.emplace_back();
        joint().name = checked_name();
        joint().type = text("type");
        if (std::find(joint_types.begin(), joint_types.end(), joint().type) == joint_types.end())
            xml_.fail(ErrorCode::unsupported,
                      "a joint of type \"" + joint().type + "\"; " + core::files::did_you_mean(joint().type, joint_types));
    }
    void read_joint_origin() { joint().origin = origin(); }
    void read_parent() { joint().parent = text("link"); }
    void read_child() { joint().child = text("link"); }
    void read_axis() { joint().axis = vector("xyz", Vector3::UnitX()); }
    void read_dynamics() {
        joint().damping = number("damping").value_or(0);
        joint().friction = number("friction").value_or(0);
    }
    void read_limit() {
        joint().lower = number("lower").value_or(0);
        joint().upper = number("upper").value_or(0);
        if (*joint().lower > *joint().upper) xml_.fail(ErrorCode::out_of_range, "the `lower` limit is above the `upper` one");
        joint().effort = number("effort", true);
        joint().velocity = number("velocity", true);
    }
    void read_mimic() {
        joint().mimics = text("joint");
        joint().multiplier = number("multiplier").value_or(1);
        joint().offset = number("offset").value_or(0);
    }

    /// At its end, where all is known of it.
    void check_joint() {
        if (joint().has_axis() && !(joint().axis.norm() > 0))
            xml_.fail(ErrorCode::out_of_range, "the <axis> of a joint of type \"" + joint().type + "\" needs a length greater than 0");
        const auto means_nothing = [&](const char* what) {
            passed_over_.add(std::string(what) + " of a joint of type \"" + joint().type + "\"", "it means nothing there", xml_.where());
        };
        const bool may_have_limits = joint().type == "revolute" || joint().slides();
        if (!may_have_limits && joint().lower && *joint().lower < *joint().upper) means_nothing("`lower` and `upper`");
        if (!joint().has_coordinate() && (joint().damping != 0 || joint().friction != 0)) means_nothing("<dynamics>");
        if (may_have_limits && !joint().is_limited())
            passed_over_.add("<limit> of a joint of type \"" + joint().type + "\" (\"" + joint().name + "\")",
                             "`lower` is not below `upper`, so that the joint is taken without limits", xml_.where());
    }

    core::kinematics::Pose origin() { return {rotation_of_rpy(vector("rpy", Vector3::Zero())), vector("xyz", Vector3::Zero())}; }

    std::string text(std::string_view key) const { return std::string(xml_.attribute(key).value_or("")); }

    /// @param or_none  A number beyond all is as if there were none.
    std::optional<double> number(std::string_view key, bool or_none = false) {
        const auto written = xml_.attribute(key);
        if (!written) return std::nullopt;
        const auto value = core::files::parsed_number(trimmed(*written));
        if (!value) {
            xml_.fail(ErrorCode::parse, "the attribute `" + std::string(key) + "` is not a number");
            return std::nullopt;
        }
        if (std::abs(*value) <= largest_number) return value;
        if (!or_none || !(*value > 0))
            xml_.fail(ErrorCode::not_finite, "the attribute `" + std::string(key) + "` is not finite, or beyond 1e30");
        return std::nullopt;
    }

    double positive_number(std::string_view key) {
        const double value = number(key).value_or(0);
        if (!(value > 0)) xml_.fail(ErrorCode::out_of_range, "the attribute `" + std::string(key) + "` must be greater than 0");
        return value;
    }

    /// Empty: absent, or a fault.
    std::vector<double> list(std::string_view key, std::size_t count) {
        const auto written = xml_.attribute(key);
        if (!written) return {};
        core::files::TextWords words(*written);
        std::vector<double> out;
        std::string_view word = words.next();
        for (; !word.empty() && out.size() < count; word = words.next()) {
            const auto value = core::files::parsed_number(word);
            if (!value || !(std::abs(*value) <= largest_number)) break;
            out.push_back(*value);
        }
        if (out.size() == count && word.empty()) return out;
        xml_.fail(ErrorCode::parse, "the attribute `" + std::string(key) + "` is not " + (count == 3 ? "three" : "four") + " numbers");
        return {};
    }

    Vector3 vector(std::string_view key, const Vector3& otherwise) {
        const std::vector<double> numbers = list(key, 3);
        return numbers.empty() ? otherwise : Vector3(numbers[0], numbers[1], numbers[2]);
    }

    XmlReader xml_;
    Robot robot_;
    bool seen_robot_ = false;
    std::string path_;                         // of the element that is open
    int passed_over_depth_ = 0;                // of the element that is passed over with all that is in it; 0: none
    std::vector<Geometry>* shapes_ = nullptr;  // of the <visual> or <collision> that is open
    std::string material_;                     // that is open
    std::map<std::string, Rgba> colours_;      // of materials
    PassedOver passed_over_;
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
