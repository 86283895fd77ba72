// SPDX-License-Identifier: MIT
/// fettle resize FILE --diameter B1=4.4mm --to FILE, fettle stretch FILE --along x --from 15mm --upto 19mm --by 4mm --to FILE: one change
/// of a mesh that has no dimensions, by handles (core/features/handled_mesh.hpp).
#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "core/base/text.hpp"
#include "core/base/units.hpp"
#include "core/features/handled_mesh.hpp"
#include "core/features/wall.hpp"
#include "core/files/atomic_file.hpp"
#include "core/files/nearest_word.hpp"
#include "core/geometry/mass_moments.hpp"
#include "core/mesh_files/mesh_writer.hpp"
#include "core/model/body_geometry.hpp"
#include "design/clearance/mesh_parts.hpp"
#include "design/cli/inputs.hpp"
#include "design/cli/read_files.hpp"
#include "design/cli/step_options.hpp"

namespace fettle::design::cli {

namespace {

namespace fs = std::filesystem;
using core::base::formatted;
using core::features::Handle;
using core::features::HandledMesh;
using core::features::HandleKind;
using core::geometry::Mesh;
using Json = nlohmann::ordered_json;

/// What both commands take.
struct ChangeArguments {
    std::string path, unit, body, wall, to;
    bool split = false;
    reading::StepWishes step;
};

/// A handle and the value that is asked for; of what is 0 as drawn, the change.
struct Wish {
    Handle handle;
    double value = 0;
};

// "B1,B2=2.2mm"
Result<Wish> wish_from(const std::string& text, const std::string& option, HandleKind kind) {
    const std::size_t equals = text.find('=');
    Wish wish;
    wish.handle.kind = kind;
    wish.handle.name = text.substr(0, equals);
    for (std::size_t at = 0; at <= wish.handle.name.size();) {
        const std::size_t comma = std::min(wish.handle.name.find(',', at), wish.handle.name.size());
        const std::string name = wish.handle.name.substr(at, comma - at);
        if (name.empty() || equals == std::string::npos)
            return Error{ErrorCode::parse, option, "`" + text + "`: features and a length are expected, such as B1,B2=2.2mm"};
        if (std::count(wish.handle.features.begin(), wish.handle.features.end(), name) > 0)
            return Error{ErrorCode::inconsistent, option, "`" + text + "` names " + name + " twice"};
        wish.handle.features.push_back(name);
        at = comma + 1;
    }
    const Result<double> value = core::base::parse_length(text.substr(equals + 1), option);
    if (!value) return value.errors();
    wish.value = *value;
    return wish;
}

Result<core::model::Body> body_of(const ChangeArguments& arguments, const CommonOptions& common, Console& console) {
    Result<clearance::MeshParts> parts =
        clearance::load_meshes({arguments.path}, arguments.unit, input_options(common, false), arguments.split, arguments.step);
    if (!parts) return parts.errors();
    tell_warnings(console, parts->warnings);
    std::vector<core::model::Body>& bodies = parts->model.bodies;
    std::vector<std::string> names;
    for (const core::model::Body& body : bodies) names.push_back(body.name);
    if (arguments.body.empty() && bodies.size() == 1) return std::move(bodies.front());
    if (arguments.body.empty())
        return Error{ErrorCode::missing_key, "--body",
                     arguments.path + " has several bodies: say which is meant, of " + core::base::joined(names)};
    const auto found = std::find(names.begin(), names.end(), arguments.body);
    if (found == names.end())
        return Error{
            ErrorCode::out_of_range, "--body",
            "there is no body '" + arguments.body + "'; " + core::files::did_you_mean(arguments.body, {names.begin(), names.end()})};
    return std::move(bodies[static_cast<std::size_t>(found - names.begin())]);
}

Result<double> wall_of(const ChangeArguments& arguments) {
    if (arguments.wall.empty()) return 0.0;
    const Result<double> wall = core::base::parse_length(arguments.wall, "--wall");
    if (wall && !(*wall > 0)) return Error{ErrorCode::out_of_range, "--wall", "this is greater than 0"};
    return wall;
}

Errors write_part(const std::string& name, const Mesh& mesh, const ChangeArguments& arguments, const CommonOptions& common) {
    const std::string extension = fs::path(arguments.to).extension().string();
    const std::vector<core::mesh_files::MeshPart> part{{name, &mesh}};
    Result<std::string> bytes = std::string();
    if (extension == ".stl")
        bytes = core::mesh_files::stl_bytes(part);
    else if (extension == ".3mf")
        bytes = core::mesh_files::threemf_bytes(part);
    else if (extension == ".obj")
        bytes = core::mesh_files::obj_text(part);
    else
        return {{ErrorCode::unsupported, "--to", "`" + arguments.to + "`: a file .stl, .3mf or .obj is expected"}};
    if (!bytes) return bytes.errors();
    if (Errors errors = replaced_inputs({{"--to", arguments.to, true}}, common.given); !errors.empty()) return errors;
    core::files::FilesTogether together;
    if (Errors errors = together.add(arguments.to, *bytes); !errors.empty()) return errors;
    return together.take_names();
}

double enclosed_by(const Mesh& mesh) { return core::geometry::solid_moments(mesh.vertices, mesh.triangles)(3, 3); }

std::string size_text(const Mesh& mesh) {
    const Vector3 size = 1e3 * core::geometry::box_sides(mesh.vertices);
    return formatted("%.6g x %.6g x %.6g mm, %.6g mm^3", size.x(), size.y(), size.z(), 1e9 * enclosed_by(mesh));
}

Json size_json(const Mesh& mesh) {
    const Vector3 size = core::geometry::box_sides(mesh.vertices);
    return {{"size", {size.x(), size.y(), size.z()}}, {"volume", enclosed_by(mesh)}};
}

int change(const ChangeArguments& arguments, const Result<std::vector<Wish>>& wishes, const CommonOptions& common, Console& console) {
    if (!wishes) return console.input_errors(wishes.errors());
    const Result<double> wall = wall_of(arguments);
    if (!wall) return console.input_errors(wall.errors());
    const Result<core::model::Body> body = body_of(arguments, common, console);
    if (!body) return console.input_errors(body.errors());
    const auto with_file = [&](Errors errors) {
        for (Error& error : errors) error.where = arguments.path + ": " + error.where;
        return errors;
    };
    std::vector<Handle> handles;
    for (const Wish& wish : *wishes) handles.push_back(wish.handle);
    const Mesh drawn = core::model::mesh_at_start(*body);
    const Result<HandledMesh> part = HandledMesh::create(drawn, handles, *wall);
    if (!part) return console.input_errors(with_file(part.errors()));
    std::vector<double> values;
    for (const Wish& wish : *wishes) values.push_back(wish.value);
    const Result<Mesh> made = part->at(values);
    if (!made) return console.input_errors(with_file(made.errors()));
    if (const Errors errors = write_part(body->name, *made, arguments, common); !errors.empty()) return console.input_errors(errors);

    Json changes = Json::array();
    std::string text;
    for (std::size_t k = 0; k < handles.size(); ++k) {
        const double before = part->drawn_value(k);
        Json row{{"handle", handles[k].name}, {"before", before}, {"after", values[k]}, {"walls", Json::array()}};
        text += formatted("%s: %s %.6g -> %.6g mm\n", body->name.c_str(), handles[k].name.c_str(), 1e3 * before, 1e3 * values[k]);
        for (const std::string& name : handles[k].features) {
            const auto& feature = part->features().features[static_cast<std::size_t>(part->features().find(name))];
            const auto left = core::features::wall_behind(*made, feature);
            if (!left) continue;
            row["walls"].push_back({{"feature", name}, {"thickness", left->thickness}});
            text += formatted("  %.4g mm of wall behind %s, measured\n", 1e3 * left->thickness, name.c_str());
        }
        changes.push_back(std::move(row));
    }
    text += size_text(drawn) + " -> " + size_text(*made) + "\n" + arguments.to + "\n";
    console.result({{"status", "ok"},
                    {"file", arguments.to},
                    {"body", body->name},
                    {"changes", changes},
                    {"before", size_json(drawn)},
                    {"after", size_json(*made)}},
                   text);
    return exit_done;
}

void add_change_options(CommandLine& app, ChangeArguments& arguments) {
    app.option("FILE", arguments.path, "A mesh or a STEP file").required();
    app.option("--to", arguments.to, "File for the changed part, in mm: .stl, .3mf or .obj").required();
    app.option("--body", arguments.body, "Which body of a file that has several is changed");
    app.option("--wall", arguments.wall, "Material that must be left behind changed features, with its unit (default: some)");
    app.option("--unit", arguments.unit, "Unit of a mesh that states none: mm, um, cm, m, in, ft, or auto: as its size suggests");
    app.flag("--split", arguments.split, "Each solid of a mesh is a body of its own, with its cavities: box#1, box#2");
    add_step_options(app, arguments.step);
}

struct ResizeArguments : ChangeArguments {
    std::vector<std::string> radii, diameters, offsets;
};

Result<std::vector<Wish>> wishes_of(const ResizeArguments& arguments) {
    std::vector<Wish> wishes;
    Errors errors;
    const auto add = [&](const std::vector<std::string>& texts, const std::string& option, HandleKind kind) {
        for (const std::string& text : texts) {
            Result<Wish> wish = wish_from(text, option, kind);
            if (wish)
                wishes.push_back(*std::move(wish));
            else
                errors.insert(errors.end(), wish.errors().begin(), wish.errors().end());
        }
    };
    add(arguments.radii, "--radius", HandleKind::radius);
    add(arguments.diameters, "--diameter", HandleKind::diameter);
    add(arguments.offsets, "--offset", HandleKind::offset);
    if (wishes.empty() && errors.empty())
        errors.push_back({ErrorCode::missing_key, "--diameter", "say what is changed: --diameter B1=4.4mm, --radius or --offset F3=1mm"});
    if (!errors.empty()) return errors;
    return wishes;
}

struct StretchArguments : ChangeArguments {
    std::string along, from, upto, by;
};

Result<std::vector<Wish>> wishes_of(const StretchArguments& arguments) {
    Wish wish;
    wish.handle.kind = HandleKind::stretch;
    wish.handle.name = "stretch along " + arguments.along;
    wish.handle.axis = arguments.along == "x" ? Vector3::UnitX() : arguments.along == "y" ? Vector3::UnitY() : Vector3::UnitZ();
    Errors errors;
    const auto take = [&](const std::string& text, const std::string& option, double& value) {
        const Result<double> length = core::base::parse_length(text, option);
        if (length)
            value = *length;
        else
            errors.insert(errors.end(), length.errors().begin(), length.errors().end());
    };
    take(arguments.from, "--from", wish.handle.from);
    take(arguments.upto, "--upto", wish.handle.to);
    take(arguments.by, "--by", wish.value);
    if (errors.empty() && !(wish.handle.from < wish.handle.to))
        errors.push_back({ErrorCode::out_of_range, "--upto", "more than --from is expected"});
    if (!errors.empty()) return errors;
    return std::vector<Wish>{wish};
}

}  // namespace

Command add_resize(CommandLine& program, const CommonOptions& common) {
    CommandLine app = program.command("resize", "Changes bores, pins and flat faces of a mesh, by the names that `fettle features` tells");
    auto options = std::make_shared<ResizeArguments>();
    add_change_options(app, *options);
    app.option("--diameter", options->diameters, "B1,B2=4.4mm: the diameter of these, which are of one size");
    app.option("--radius", options->radii, "B1=2.2mm: the same by the radius");
    app.option("--offset", options->offsets, "F3=1mm: moves these flat faces outwards");
    app.closing_words(
        "Example:  fettle resize base.stl --unit mm --diameter B1,B2=4.4mm --wall 1.2mm --to wider.stl\n"
        "Everything else stays bit for bit, but for the digits of the file. What would bend a face beside, turn a triangle over, cut "
        "through\n"
        "a wall or leave less than --wall is refused with its place. In a scene the same are handles, which a design can tune.");
    return {app, [options, &common](Console& console) { return change(*options, wishes_of(*options), common, console); }};
}

Command add_stretch(CommandLine& program, const CommonOptions& common) {
    CommandLine app = program.command("stretch", "Makes a mesh longer or shorter between two heights");
    auto options = std::make_shared<StretchArguments>();
    add_change_options(app, *options);
    app.option("--along", options->along, "Direction").one_of({"x", "y", "z"}).required();
    app.option("--from", options->from, "What lies before this height stays, with its unit: 15mm").required();
    app.option("--upto", options->upto, "What lies beyond this height moves along").required();
    app.option("--by", options->by, "How much longer; less than 0: shorter").required();
    app.closing_words(
        "Example:  fettle stretch base.stl --unit mm --along x --from 15mm --upto 19mm --by 4mm --to longer.stl\n"
        "A bore or a rounded edge that lies across the stretch would bend, and is refused by name.");
    return {app, [options, &common](Console& console) { return change(*options, wishes_of(*options), common, console); }};
}

}  // namespace fettle::design::cli
