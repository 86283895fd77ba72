// SPDX-License-Identifier: MIT
#include "design/shapes/handled_part.hpp"

#include <algorithm>
#include <string_view>

#include "core/files/json_document.hpp"
#include "core/files/nearest_word.hpp"

namespace fettle::design::shapes {

namespace {

using core::features::Handle;
using core::features::HandledMesh;
using core::features::HandleKind;
using core::features::HandleRegion;
using core::files::JsonDocument;
using core::files::JsonNode;
using core::scene::HandledMeshSpec;

/// A kind of handle: the key that stands for it, and the keys that may stand beside.
struct HandleForm {
    std::string_view key;
    HandleKind kind;
    std::vector<std::string_view> others;
};

const std::vector<HandleForm>& handle_forms() {
    static const std::vector<HandleForm> forms{{"bores", HandleKind::radius, {}},
                                               {"pins", HandleKind::radius, {}},
                                               {"radius", HandleKind::radius, {}},
                                               {"diameter", HandleKind::diameter, {}},
                                               {"offset", HandleKind::offset, {}},
                                               {"move", HandleKind::move, {"features", "inside", "falloff"}},
                                               {"turn", HandleKind::turn, {"about", "features", "inside", "falloff"}},
                                               {"stretch", HandleKind::stretch, {"from", "to"}},
                                               {"lattice", HandleKind::lattice, {"inside", "points", "along"}},
                                               {"morph", HandleKind::morph, {}}};
    return forms;
}

class HandleReader {
public:
    explicit HandleReader(const HandledMeshSpec& spec) : spec_(spec) {}

    Handle read(const std::string& name, const JsonNode& node) {
        Handle handle;
        handle.name = name;
        const HandleForm* form = form_of(node);
        if (form == nullptr) return handle;
        std::vector<std::string_view> keys{form->key};
        keys.insert(keys.end(), form->others.begin(), form->others.end());
        node.allow_keys(keys);
        handle.kind = form->kind;
        const JsonNode own = node[form->key];
        switch (form->kind) {
            case HandleKind::radius:
            case HandleKind::diameter:
            case HandleKind::offset:
                handle.features = names(own);
                if (form->key == "bores") handle.holes = true;
                if (form->key == "pins") handle.holes = false;
                break;
            case HandleKind::move:
                handle.axis = direction(own);
                read_hold(node, handle);
                break;
            case HandleKind::turn:
                handle.axis = direction(own);
                handle.point = node.require("about").length3(spec_.unit).value_or(handle.point);
                read_hold(node, handle);
                break;
            case HandleKind::stretch:
                handle.axis = direction(own);
                handle.from = node.require("from").length(spec_.unit).value_or(0);
                handle.to = node.require("to").length(spec_.unit).value_or(1);
                if (!(handle.from < handle.to)) node["to"].fail(ErrorCode::out_of_range, "more than `from` is expected");
                break;
            case HandleKind::lattice:
                read_lattice(node, own, handle);
                break;
            case HandleKind::morph:
                own.string();
                if (const auto target = spec_.targets.find(name); target != spec_.targets.end()) handle.target = target->second->vertices;
                break;
        }
        return handle;
    }

private:
    static const HandleForm* form_of(const JsonNode& node) {
        const HandleForm* found = nullptr;
        std::string known;
        for (const HandleForm& form : handle_forms()) {
            known += (known.empty() ? "`" : ", `") + std::string(form.key) + "`";
            if (!node[form.key].exists()) continue;
            if (found != nullptr) {
                node.fail(ErrorCode::inconsistent,
                          "a handle is one of `" + std::string(found->key) + "` and `" + std::string(form.key) + "`");
                return nullptr;
            }
            found = &form;
        }
        if (found == nullptr && node.is_object()) node.fail(ErrorCode::missing_key, "what the handle moves is missing: one of " + known);
        return found;
    }

    static std::vector<std::string> names(const JsonNode& node) {
        std::vector<std::string> out;
        const std::vector<JsonNode> elements = node.elements();
        for (const JsonNode& each : elements) {
            const std::string name = each.string().value_or("");
            if (std::count(out.begin(), out.end(), name) > 0) each.fail(ErrorCode::inconsistent, each.shown() + " stands here twice");
            out.push_back(name);
        }
        if (node.is_array() && elements.empty())
            node.fail(ErrorCode::out_of_range, "names of features are expected, such as [\"B1\"]: `fettle features` lists them");
        return out;
    }

    static Vector3 direction(const JsonNode& node) {
        if (node.is_string()) {
            const std::string axis = node.choice({"x", "y", "z"}).value_or("x");
            return axis == "x" ? Vector3::UnitX() : axis == "y" ? Vector3::UnitY() : Vector3::UnitZ();
        }
        const Vector3 given = node.vector3().value_or(Vector3::UnitX());
        if (!(given.norm() > 0)) {
            node.fail(ErrorCode::out_of_range, "a direction that is not 0 is expected: [x, y, z], \"x\", \"y\" or \"z\"");
            return Vector3::UnitX();
        }
        return given / given.stableNorm();
    }

    HandleRegion region(const JsonNode& node) const {
        HandleRegion out;
        node.allow_keys({"box", "sphere"});
        if (node["box"].exists() == node["sphere"].exists()) {
            node.fail(ErrorCode::inconsistent, "one of `box`, two corners, and `sphere`, its `centre` and `radius`, is expected");
            return out;
        }
        if (node["box"].exists()) {
            const std::vector<JsonNode> corners = node["box"].elements();
            if (corners.size() != 2) {
                node["box"].fail(ErrorCode::out_of_range, "two corners are expected: [[x, y, z], [x, y, z]]");
                return out;
            }
            const Vector3 a = corners[0].length3(spec_.unit).value_or(Vector3::Zero()),
                          b = corners[1].length3(spec_.unit).value_or(Vector3::Ones());
            out.low = a.cwiseMin(b);
            out.high = a.cwiseMax(b);
            return out;
        }
        out.kind = HandleRegion::Kind::sphere;
        const JsonNode sphere = node["sphere"];
        sphere.allow_keys({"centre", "radius"});
        out.centre = sphere.require("centre").length3(spec_.unit).value_or(out.centre);
        out.radius = sphere.require("radius").length(spec_.unit, core::files::positive).value_or(1);
        return out;
    }

    void read_hold(const JsonNode& node, Handle& handle) const {
        if (node["features"].exists() == node["inside"].exists())
            return node.fail(ErrorCode::inconsistent, "what it takes hold of is expected: `features`, or what is `inside` a box or sphere");
        if (node["features"].exists()) {
            if (node["falloff"].exists()) node["falloff"].fail(ErrorCode::inconsistent, "`falloff` is of what is `inside`");
            handle.features = names(node["features"]);
            return;
        }
        handle.region = region(node["inside"]);
        handle.region.falloff = node["falloff"].length(spec_.unit, core::files::not_negative).value_or(0);
    }

    void read_lattice(const JsonNode& node, const JsonNode& own, Handle& handle) const {
        handle.axis = direction(node.require("along"));
        handle.region = region(node.require("inside"));
        if (handle.region.kind != HandleRegion::Kind::box || !((handle.region.high - handle.region.low).minCoeff() > 0))
            node["inside"].fail(ErrorCode::out_of_range, "a lattice is of a `box` that has a length, a width and a height");
        constexpr int most_points = 16;
        handle.lattice = triple(own, 2, {most_points, most_points, most_points});
        std::array<int, 3> last = handle.lattice;
        for (int& k : last) --k;
        for (const JsonNode& each : node.require("points").elements()) handle.controls.push_back(triple(each, 0, last));
    }

    static std::array<int, 3> triple(const JsonNode& node, int low, const std::array<int, 3>& high) {
        std::array<int, 3> out{low, low, low};
        const std::vector<JsonNode> numbers = node.elements();
        if (node.is_array() && numbers.size() != 3)
            node.fail(ErrorCode::out_of_range, "three whole numbers are expected, along x, y and z");
        for (std::size_t k = 0; k < numbers.size() && k < 3; ++k) out[k] = numbers[k].integer(low, high[k]).value_or(low);
        return out;
    }

    const HandledMeshSpec& spec_;
};

}  // namespace

Result<std::vector<Handle>> read_handles(const HandledMeshSpec& spec) {
    Result<JsonDocument> document = JsonDocument::parse("{\"handles\": " + spec.handles + "}", "shape");
    if (!document) return document.errors();
    std::vector<Handle> out;
    HandleReader reader(spec);
    const JsonNode node = document->root()["handles"];
    for (const auto& [name, handle] : node.members())
        if (!name.starts_with('#')) out.push_back(reader.read(name, handle));
    if (out.empty() && node.is_object())
        node.fail(ErrorCode::out_of_range, "a handle is expected, such as \"bore\": {\"bores\": [\"B1\"]}");
    if (!document->errors().empty()) return document->errors();
    return out;
}

Result<std::map<std::string, core::base::Dimension>> dimensions_of_handles(const HandledMeshSpec& spec) {
    const Result<std::vector<Handle>> handles = read_handles(spec);
    if (!handles) return handles.errors();
    std::map<std::string, core::base::Dimension> out;
    for (const Handle& handle : *handles)
        out[handle.name] = is_angle(handle.kind)    ? core::base::Dimension::angle
                           : is_number(handle.kind) ? core::base::Dimension::number
                                                    : core::base::Dimension::length;
    return out;
}

Result<std::shared_ptr<const HandledPart>> HandledPart::create(const HandledMeshSpec& spec,
                                                               const std::map<std::string, double>& dimensions) {
    const Result<std::vector<Handle>> handles = read_handles(spec);
    if (!handles) return handles.errors();
    Errors errors;
    std::vector<std::string_view> names;
    for (const Handle& handle : *handles) names.emplace_back(handle.name);
    for (const auto& [name, value] : dimensions)
        if (std::find(names.begin(), names.end(), name) == names.end())
            errors.push_back(
                {ErrorCode::unknown_key, name, "there is no handle '" + name + "'; " + core::files::did_you_mean(name, names)});
    if (!errors.empty()) return errors;
    Result<HandledMesh> mesh = HandledMesh::create(*spec.mesh, *handles, spec.wall);
    if (!mesh) return mesh.errors();
    const std::shared_ptr<HandledPart> part(new HandledPart(*std::move(mesh)));
    for (std::size_t k = 0; k < handles->size(); ++k) {
        const auto given = dimensions.find((*handles)[k].name);
        part->dimensions_.push_back({(*handles)[k].name, given == dimensions.end() ? part->mesh_.drawn_value(k) : given->second});
    }
    return std::shared_ptr<const HandledPart>(part);
}

Result<core::geometry::Mesh> HandledPart::mesh(const std::vector<double>& values) const { return mesh_.at(values); }

Result<description::ShapeInstance> HandledPart::at(const std::vector<double>& values) const {
    Result<core::geometry::Mesh> mesh = mesh_.at(values);
    if (!mesh) return mesh.errors();
    return description::ShapeInstance{*std::move(mesh), mesh_.jacobian(values)};
}

Result<description::RecordedShape> HandledPart::recorded(const std::vector<double>& values) const {
    HandledMesh::Recorded recorded = mesh_.recorded(values);
    return description::RecordedShape{std::move(recorded.nodes), std::move(recorded.vertices)};
}

}  // namespace fettle::design::shapes
