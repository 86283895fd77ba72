// SPDX-License-Identifier: MIT
// 3MF core specification 1.3: objects (meshes, or components that place other objects), and the build, which places objects; p:path of the
// production extension, which puts objects into further model parts. In double precision; appearance is passed over.
#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <set>

#include "core/files/atomic_file.hpp"
#include "core/files/text_lines.hpp"
#include "core/mesh_files/most_placed.hpp"
#include "core/mesh_files/raw_mesh.hpp"
#include "core/mesh_files/xml_reader.hpp"
#include "core/mesh_files/zip_archive.hpp"

namespace fettle::core::mesh_files {
namespace {

// What real files stay far below: components can place components a hundred times each, and packed text can be a thousand times as long.
constexpr std::size_t most_items = 10'000;
constexpr int most_levels = 32;
constexpr std::uint64_t unpacked_always = std::uint64_t{64} << 20, unpacked_at_most = std::uint64_t{1} << 30, unpacked_per_byte = 100;

/// world = linear * x + shift.
struct Placement {
    Matrix3 linear = Matrix3::Identity();
    Vector3 shift = Vector3::Zero();
    bool identity = true;  ///< then positions keep their bits

    Placement of(const Placement& inner) const {
        if (inner.identity) return *this;
        if (identity) return inner;
        return {linear * inner.linear, linear * inner.shift + shift, false};
    }
};

using ObjectKey = std::pair<std::string, std::string>;  ///< model part, id

struct Component {
    ObjectKey object;
    Placement placement;
    std::string where;
};

struct Object {
    std::string name;
    bool support = false;
    std::vector<Vector3> vertices;
    std::vector<geometry::Triangle> triangles;
    std::string where;  ///< for messages
    std::vector<Component> components;
};

class ThreemfParser {
public:
    /// @param size  of the whole file.
    ThreemfParser(const ZipArchive& archive, std::uint64_t size, const std::string& where)
        : archive_(archive), where_(where), text_left_(std::min(unpacked_at_most, unpacked_always + unpacked_per_byte * size)) {}

    Result<RawMesh> parse() {
        const auto root = root_part();
        if (!root) return root.errors();
        parts_to_read_.push_back(*root);
        while (!parts_to_read_.empty() && errors_.empty()) {
            const std::string part = parts_to_read_.back();
            parts_to_read_.pop_back();
            if (parts_.insert(part).second) read_part(part, part == *root);
        }
        for (const Component& item : build_) {
            const auto object = objects_.find(item.object);
            mesh_.items.push_back({object == objects_.end() ? "" : object->second.name, mesh_.vertices.size(), mesh_.polygon_ends.size()});
            place(item, Placement{}, 0);
            if (mesh_.items.back().first_vertex == mesh_.vertices.size()) mesh_.items.pop_back();  // support, or nothing
        }
        if (!errors_.empty()) return errors_;
        return std::move(mesh_);
    }

private:
    /// What _rels/.rels calls the 3D model; "3D/3dmodel.model", as every program writes it, where that says nothing.
    Result<std::string> root_part() {
        std::string found = "3D/3dmodel.model";
        if (archive_.has("_rels/.rels")) {
            const auto text = unpacked("_rels/.rels");
            if (!text) return text.errors();
            XmlReader xml(*text, where_ + "/_rels/.rels");
            xml.read([&] {
                if (!xml.opens() || xml.name() != "Relationship") return;
                if (xml.attribute("Type").value_or("").ends_with("/3dmodel")) found = part_name(xml.attribute("Target").value_or(""));
            });
            if (!xml.errors().empty()) return xml.errors();
        }
        if (!archive_.has(found)) return Error{ErrorCode::parse, where_, "is not a 3MF file (it has no model part)"};
        return found;
    }

    /// All parts together have a limit, by the size of the file.
    Result<std::string> unpacked(const std::string& part) {
        auto text = archive_.unpacked(part, text_left_);
        if (text) text_left_ -= text->size();
        return text;
    }

    static std::string part_name(std::string_view path) { return std::string(path.substr(path.starts_with('/') ? 1 : 0)); }

    void read_part(const std::string& part, bool is_root) {
        const auto text = unpacked(part);
        if (!text) {
            errors_.insert(errors_.end(), text.errors().begin(), text.errors().end());
            return;
        }
        XmlReader xml(*text, where_ + "/" + part);
        Object* object = nullptr;
        bool seen_model = false;
        xml.read([&] {
            if (!errors_.empty()) return xml.stop();
            if (!xml.opens()) return;
            const std::string_view name = xml.name();
            if (!seen_model && name != "model") xml.fail(ErrorCode::parse, "the first element is not a 3MF <model>");
            if (name == "model" && !std::exchange(seen_model, true)) read_model(xml);
            if (name == "object") object = start_object(xml, part);
            if (name == "vertex" && object != nullptr) object->vertices.push_back(vertex(xml));
            if (name == "triangle" && object != nullptr) object->triangles.push_back(triangle(xml));
            if (name == "component" && object != nullptr) object->components.push_back(component(xml, part));
            if (name != "item" || !is_root) return;
            build_.push_back(component(xml, part));
            if (build_.size() > most_items) xml.fail(ErrorCode::out_of_range, "the build has more than 10,000 items; export in parts");
        });
        if (!seen_model && xml.errors().empty()) xml.fail(ErrorCode::parse, "has no <model>");
        errors_.insert(errors_.end(), xml.errors().begin(), xml.errors().end());
    }

    void read_model(XmlReader& xml) {
        constexpr std::array<std::pair<std::string_view, double>, 6> units = {
            {{"micron", 1e-6}, {"millimeter", 1e-3}, {"centimeter", 1e-2}, {"inch", 0.0254}, {"foot", 0.3048}, {"meter", 1}}};
        const std::string_view unit = xml.attribute("unit").value_or("millimeter");
        const auto known = std::find_if(units.begin(), units.end(), [&](const auto& entry) { return entry.first == unit; });
        if (known == units.end()) {
            errors_.push_back({ErrorCode::out_of_range, where_,
                               "unit `" + std::string(unit) + "` must be micron, millimeter, centimeter, inch, foot or meter"});
        } else if (mesh_.metres_per_unit > 0 && mesh_.metres_per_unit != known->second) {
            errors_.push_back({ErrorCode::unsupported, where_, "its parts have different units; export with one"});
        } else {
            mesh_.metres_per_unit = known->second;
        }
        check_required_extensions(xml);
    }

    /// A file says which extensions are needed to understand it: of those that change the shape only p:path is read.
    void check_required_extensions(XmlReader& xml) {
        const std::string_view required = xml.attribute("requiredextensions").value_or("");
        std::vector<std::string_view> prefixes;
        files::TextLines lines(required);
        if (!lines.next(prefixes)) return;
        for (const std::string_view prefix : prefixes) {
            const std::string_view space = xml.attribute("xmlns:" + std::string(prefix)).value_or(prefix);
            const bool known = space.find("/production/") != std::string::npos || space.find("/material/") != std::string::npos;
            if (!known)
                xml.fail(ErrorCode::unsupported,
                         "the extension " + std::string(space) + " of 3MF is needed to read this file; export without it");
        }
    }

    Object* start_object(XmlReader& xml, const std::string& part) {
        const bool has_id = xml.attribute("id").has_value();
        const std::string id(xml.attribute("id").value_or(""));
        if (!has_id) xml.fail(ErrorCode::parse, "an <object> needs an `id`");
        Object& object = objects_[{part, id}];
        if (!object.where.empty()) xml.fail(ErrorCode::inconsistent, "the object id " + id + " stands twice");
        object.where = xml.where();
        object.name = xml.attribute("name").value_or("");
        if (object.name.empty()) object.name = "Object_" + id;
        object.support = xml.attribute("type").value_or("model").ends_with("support");
        return &object;
    }

    static std::optional<double> number(XmlReader& xml, std::string_view key) {
        const auto text = xml.attribute(key);
        const auto value = text ? files::parsed_number(*text) : std::nullopt;
        if (!value)
            xml.fail(ErrorCode::parse, "the attribute `" + std::string(key) + "` of a <" + std::string(xml.name()) + "> is not a number");
        return value;
    }

    static Vector3 vertex(XmlReader& xml) {
        Vector3 x;
        for (int k = 0; k < 3; ++k) x[k] = number(xml, std::string_view("xyz").substr(static_cast<std::size_t>(k), 1)).value_or(0);
        return x;
    }

    static geometry::Triangle triangle(XmlReader& xml) {
        geometry::Triangle t{};
        constexpr std::array<std::string_view, 3> keys{"v1", "v2", "v3"};
        for (std::size_t k = 0; k < 3; ++k) {
            const int index = files::parsed_integer(xml.attribute(keys[k]).value_or("")).value_or(-1);
            if (index < 0) xml.fail(ErrorCode::parse, "the attribute `" + std::string(keys[k]) + "` of a <triangle> is not a vertex index");
            t[k] = std::max(index, 0);
        }
        return t;
    }

    /// Reads from a <component> or an <item> which object it places, and where.
    Component component(XmlReader& xml, const std::string& part) {
        Component out;
        out.where = xml.where();
        out.object = {part, std::string(xml.attribute("objectid").value_or(""))};
        for (const std::string_view key : xml.attribute_names()) {
            if (!key.ends_with(":path")) continue;
            out.object.first = part_name(xml.attribute(key).value_or(""));
            parts_to_read_.push_back(out.object.first);
        }
        const auto text = xml.attribute("transform");
        if (!text) return out;
        std::vector<std::string_view> words;
        files::TextLines(*text).next(words);
        std::array<double, 12> m{};
        bool good = words.size() == m.size();
        for (std::size_t i = 0; good && i < m.size(); ++i) {
            const auto value = files::parsed_number(words[i]);
            good = value.has_value();
            m[i] = value.value_or(0);
        }
        if (!good) xml.fail(ErrorCode::parse, "a `transform` is twelve numbers");
        for (int i = 0; i < 3; ++i) {  // the file multiplies rows: x' = x m00 + y m10 + z m20 + m30
            for (int j = 0; j < 3; ++j) out.placement.linear(j, i) = m[3 * i + j];
            out.placement.shift[i] = m[9 + i];
        }
        out.placement.identity = out.placement.linear == Matrix3::Identity() && out.placement.shift == Vector3::Zero();
        return out;
    }

    void place(const Component& component, const Placement& around, int level) {
        if (!errors_.empty()) return;
        const auto fail = [&](ErrorCode code, const std::string& message) { errors_.push_back({code, component.where, message}); };
        const auto found = objects_.find(component.object);
        if (found == objects_.end()) return fail(ErrorCode::inconsistent, "there is no object of id \"" + component.object.second + "\"");
        if (level > most_levels) return fail(ErrorCode::inconsistent, "components hold one another, or are nested deeper than 32");
        const Object& object = found->second;
        placed_ += of_a_placing;
        if (!object.support) placed_ += object.triangles.size() + object.vertices.size();
        if (placed_ > most_placed)
            return fail(ErrorCode::out_of_range,
                        "with this, its build places more than 10 million vertices and triangles, or a million objects");
        if (object.support) return;
        const Placement placement = around.of(component.placement);
        for (const Component& inner : object.components) place(inner, placement, level + 1);
        if (!object.triangles.empty() || !object.vertices.empty()) append(object, placement);
    }

    void append(const Object& object, const Placement& placement) {
        const int first = count_of(mesh_.vertices), count = count_of(object.vertices);
        for (const Vector3& x : object.vertices)
            mesh_.vertices.push_back(placement.identity ? x : Vector3(placement.linear * x + placement.shift));
        const bool mirrored = placement.linear.determinant() < 0;  // then it stays a solid with its triangles turned
        const int group = count_of(mesh_.groups);
        mesh_.groups.push_back(object.name);
        for (std::size_t i = 0; i < object.triangles.size(); ++i) {
            geometry::Triangle t = object.triangles[i];
            if (std::max({t[0], t[1], t[2]}) >= count) {
                errors_.push_back({ErrorCode::out_of_range, object.where,
                                   "triangle " + std::to_string(i) + " (counted from 0) of this object names a vertex beyond its " +
                                       std::to_string(count)});
                return;
            }
            if (mirrored) std::swap(t[1], t[2]);
            for (const int v : t) mesh_.corners.push_back(first + v);
            mesh_.polygon_ends.push_back(count_of(mesh_.corners));
            mesh_.polygon_group.push_back(group);
        }
    }

    const ZipArchive& archive_;
    std::string where_;
    std::map<ObjectKey, Object> objects_;
    std::vector<Component> build_;
    std::set<std::string> parts_;
    std::vector<std::string> parts_to_read_;
    std::size_t placed_ = 0;
    std::uint64_t text_left_;  ///< that may still be unpacked [bytes]
    RawMesh mesh_;
    Errors errors_;
};

}  // namespace

Result<RawMesh> parse_3mf(std::string_view bytes, const std::string& where) {
    const auto archive = ZipArchive::open(bytes, where);
    if (!archive) return Error{archive.errors().front().code, where, archive.errors().front().message + ", so not a 3MF file"};
    return ThreemfParser(*archive, bytes.size(), where).parse();
}

}  // namespace fettle::core::mesh_files
