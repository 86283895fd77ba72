// SPDX-License-Identifier: MIT
#include "core/scene_files/scene_body.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

#include "core/base/limits.hpp"
#include "core/base/text.hpp"
#include "core/base/units.hpp"
#include "core/files/index_rows.hpp"
#include "core/files/nearest_word.hpp"
#include "core/geometry/mesh_transforms.hpp"
#include "core/mesh_files/find_mesh_file.hpp"
#include "core/mesh_files/mesh_reader.hpp"
#include "core/scene/angles.hpp"
#include "core/scene_files/scene_motion.hpp"
#include "core/solids/mesh_repair.hpp"
#include "core/solids/shells.hpp"

namespace fettle::core::scene_files {
namespace {

using base::ErrorCode;

const std::vector<std::string_view> body_keys{"name",
                                              "mesh",
                                              "mesh_unit",
                                              "mesh_item",
                                              "mesh_solid",
                                              "mesh_facets",
                                              "surface_tolerance",
                                              "shape",
                                              "vertices",
                                              "edges",
                                              "triangles",
                                              "scale",
                                              "density",
                                              "mass_per",
                                              "inertial",
                                              "material",
                                              "mu",
                                              "type",
                                              "position",
                                              "rotation",
                                              "rotation_vector",
                                              "reference_point",
                                              "linear_velocity",
                                              "angular_velocity",
                                              "fixed",
                                              "prescribed",
                                              "script",
                                              "force",
                                              "torque",
                                              "damping",
                                              "group",
                                              "split_components",
                                              "urdf"};

// What to write instead of the key `generator` of version 0.2, whose parts are files now.
std::string in_place_of_generator(const std::string& name) {
    const std::map<std::string, std::string> of_library{{"box", "box"}, {"pin", "cylinder"}, {"plate_with_hole", "plate_with_hole"}};
    const std::map<std::string, std::string> of_examples{
        {"crank", "slider_crank/crank"}, {"rod", "slider_crank/rod"},         {"piston", "slider_crank/piston"},
        {"block", "slider_crank/block"}, {"base_plate", "four_bar/base"},     {"arm", "four_bar/arm"},
        {"coupler", "four_bar/coupler"}, {"eccentric", "follower/eccentric"}, {"follower", "follower/follower"}};
    const std::string begin = "there are no generators any more, parts are files: ";
    if (const auto found = of_library.find(name); found != of_library.end())
        return begin + "write \"part\": \"" + found->second + "\", a part of the library with the same dimensions";
    if (const auto found = of_examples.find(name); found != of_examples.end()) {
        const std::string file = found->second + ".part.json", own = file.substr(file.find('/') + 1);
        return begin + "copy examples/" + file + " to this file's folder and write \"part\": \"" + own + "\"";
    }
    return begin + "write \"part\" and the name of one of the library (fettle shapes lists them) or of a file of your own, NAME.part.json";
}

// A part that a program makes: what runs it.
scene::MeshProgram read_program(const files::JsonNode& node, const std::string& scene, double unit) {
    scene::MeshProgram program;
    const files::JsonNode command = node["program"];
    for (const files::JsonNode& word : command.elements()) program.command.push_back(word.string().value_or(""));
    if (command.is_array() && (program.command.empty() || program.command.front().empty()))
        command.fail(ErrorCode::out_of_range, "a program's command is expected: its name, then its arguments");
    program.directory = std::filesystem::path(scene).parent_path().string();
    program.format = node["format"].choice({"stl", "obj", "off", "ply", "3mf"}).value_or(program.format);
    program.unit = unit;
    program.time_limit = node["time_limit"].number(files::positive).value_or(program.time_limit);
    return program;
}

}  // namespace

std::optional<std::string> read_material_name(const files::JsonNode& node, const MaterialDensities& materials) {
    std::vector<std::string_view> names;
    for (const auto& [name, density] : materials) names.push_back(name);
    if (!node.is_string() || !names.empty()) return node.choice(names);
    node.fail(ErrorCode::inconsistent, "the material " + node.shown() + " is not described: this scene has no `materials`");
    return std::nullopt;
}

std::vector<scene::Body> SceneBodies::read(const files::JsonNode& node) {
    scene::Body body;
    body.where = node.where();
    node.allow_keys(body_keys);
    if (!node.is_object()) return {body};
    read_name(node.require("name"), body);
    node["urdf"].members();  // what nothing here uses: read where a robot description is written
    const MeshSource source = read_geometry(node, body);
    settle_mesh(node, source, body);
    const WrittenPose written = read_pose(node, unit_, {});
    body.pose = written.pose;
    body.orientation = written.orientation;
    body.reference_point = node["reference_point"].length3(unit_);
    const std::string type = node["type"].choice({"dynamic", "static", "kinematic"}).value_or("dynamic");
    body.type = type == "static"      ? scene::BodyType::static_body
                : type == "kinematic" ? scene::BodyType::kinematic_body
                                      : scene::BodyType::dynamic_body;
    read_motion(node, unit_, body);
    read_mass(node, body);
    read_group(node["group"], body);
    return components(node, std::move(body));
}

void SceneBodies::read_name(const files::JsonNode& node, scene::Body& body) {
    body.name = node.string().value_or("");
    if (!node.is_string()) return;
    if (body.name.empty() || body.name.find_first_of(":,") != std::string::npos) {
        node.fail(ErrorCode::out_of_range, "a body's name is not empty and holds no `:` and no `,`; found " + node.shown());
    } else if (!names_.insert(body.name).second) {
        node.fail(ErrorCode::inconsistent, "another body is called " + node.shown() + " already; names are unique");
    }
}

SceneBodies::MeshSource SceneBodies::read_geometry(const files::JsonNode& node, scene::Body& body) {
    MeshSource source;
    const files::JsonNode mesh = node["mesh"], shape = node["shape"], vertices = node["vertices"];
    const int sources = static_cast<int>(mesh.exists()) + static_cast<int>(shape.exists()) + static_cast<int>(vertices.exists());
    if (sources != 1) {
        node.fail(sources > 1 ? ErrorCode::inconsistent : ErrorCode::missing_key,
                  "a body has either a `mesh` (a file), or a `shape`, or `vertices` with their `edges` and `triangles`");
        return source;
    }
    for (const char* key : {"edges", "triangles"}) {
        if (node[key].exists() && !vertices.exists()) node[key].fail(ErrorCode::inconsistent, std::string("`") + key + "` join `vertices`");
    }
    if (node["mesh_unit"].exists() && !mesh.exists())
        node["mesh_unit"].fail(ErrorCode::inconsistent, "only a `mesh` file has a unit of its own");
    for (const char* key : {"handles", "dimensions"})
        if (node[key].exists())
            node[key].fail(ErrorCode::inconsistent, std::string("`") + key +
                                                        "` are of a `shape`: write \"shape\": {\"mesh\": \"base.stl\", \"handles\": "
                                                        "{...}, \"dimensions\": {...}} in place of the `mesh`");
    for (const char* key : {"mesh_item", "mesh_solid", "mesh_facets", "surface_tolerance"})
        if (node[key].exists() && !mesh.exists()) node[key].fail(ErrorCode::inconsistent, std::string("`") + key + "` is of a `mesh` file");
    if (mesh.exists()) source = read_mesh_file(node, body);
    if (shape.exists()) make_shape(shape, body);
    if (vertices.exists()) read_inline(node, body);
    const files::JsonNode scale = node["scale"];
    if (!scale.exists()) return source;
    Vector3 factors = Vector3::Ones();
    if (scale.is_array()) {
        factors = scale.vector3().value_or(factors);
        if (!(factors.minCoeff() > 0)) scale.fail(ErrorCode::out_of_range, "every scale factor must be greater than 0");
    } else {
        factors *= scale.number(files::positive).value_or(1);
    }
    geometry::scale_mesh(body.mesh, factors);
    std::get<2>(source) = {factors[0], factors[1], factors[2]};
    return source;
}

/// Files from elsewhere have small faults: what has one answer is mended, and told.
void SceneBodies::settle_mesh(const files::JsonNode& node, const MeshSource& source, scene::Body& body) {
    if (body.shape || options_.strict_meshes) return;
    body.mesh_policy = scene::MeshPolicy::tolerant;
    if (body.mesh.vertices.cols() == 0 || !body.mesh.vertices.allFinite()) return;
    if (sound_.count(source) != 0) return;
    const std::vector<std::string> repairs = solids::repair_mesh(body.mesh);
    for (const std::string& done : repairs) node.warn("body `" + body.name + "`: " + done);
    if (repairs.empty() && !std::get<0>(source).empty()) sound_.insert(source);
}

SceneBodies::MeshSource SceneBodies::read_mesh_file(const files::JsonNode& node, scene::Body& body) {
    const files::JsonNode mesh = node["mesh"];
    mesh_files::MeshReadOptions options;
    options.unit = unit_;
    options.weld = true;
    options.should_stop = options_.should_stop;
    if (const auto name = node["mesh_unit"].choice({"um", "mm", "cm", "m", "in", "ft"}))
        options.unit = base::metres_per_unit(*name).value();
    const auto name = mesh.string();
    if (!name) return {};
    const auto file = mesh_files::find_mesh_file(*name, document_.path(), options_.mesh_dirs, mesh.where());
    if (!file) {
        report(file.errors(), mesh);
        return {};
    }
    const std::string item = node["mesh_item"].string().value_or("");
    if (node["mesh_item"].is_string() && item.empty())
        node["mesh_item"].fail(ErrorCode::out_of_range, "an item's name is expected; `fettle validate " + *name + "` lists them");
    options.chord = node["mesh_facets"].length(unit_, files::positive).value_or(0);
    options.surface_tolerance = node["surface_tolerance"].length(unit_, files::positive).value_or(0);
    if (!mesh_files::is_step(*file))
        for (const char* key : {"mesh_facets", "surface_tolerance"})
            if (node[key].exists()) node[key].fail(ErrorCode::inconsistent, std::string("`") + key + "` is of STEP files");
    const files::JsonNode solid = node["mesh_solid"];
    const int number = solid.exists() ? solid.integer(1).value_or(1) : 0;
    std::string key = *file;
    if (!item.empty() || number > 0 || options.chord > 0 || options.surface_tolerance > 0)
        key += "\n" + item + "\n" + std::to_string(options.chord) + "\n" + std::to_string(options.surface_tolerance);
    MeshSource source{key, options.unit, {1, 1, 1}};
    auto known = files_.find({key, options.unit});
    if (known == files_.end()) {
        auto found = item.empty() ? mesh_files::read_mesh(*file, options) : item_of_file(*file, item, options);
        if (!found) {
            report(found.errors(), mesh);
            return {};
        }
        known = files_.emplace(std::pair(key, options.unit), std::move(found).value()).first;
    }
    if (number == 0) {
        body.mesh = known->second;
        return source;
    }
    std::get<0>(source) += "\n" + std::to_string(number);
    const std::vector<geometry::Mesh>& solids = solids_of_file({key, options.unit}, known->second);
    if (number > count_of(solids)) {
        const std::string count = base::counted(solids.size(), "solid");
        solid.fail(ErrorCode::out_of_range,
                   "the mesh has " + count + "; they are counted from 1, in the order of their first triangles (--split)");
        return source;
    }
    body.mesh = solids[static_cast<std::size_t>(number - 1)];
    return source;
}

/// Mended as a whole first, as where meshes are split without a scene: numbers are the same.
const std::vector<geometry::Mesh>& SceneBodies::solids_of_file(const std::pair<std::string, double>& key, geometry::Mesh mesh) {
    auto known = solids_.find(key);
    if (known == solids_.end()) {
        if (!options_.strict_meshes) solids::repair_mesh(mesh);
        known = solids_.emplace(key, solids::split_solids(mesh)).first;
    }
    return known->second;
}

/// Bodies of one file are read together: a STEP file takes a while.
base::Result<geometry::Mesh> SceneBodies::item_of_file(const std::string& file, const std::string& item,
                                                       const mesh_files::MeshReadOptions& options) {
    const auto key = std::tuple(file, options.unit, options.chord, options.surface_tolerance);
    auto known = items_.find(key);
    if (known == items_.end()) {
        auto parts = mesh_files::read_mesh_parts(file, options);
        if (!parts) return parts.errors();
        known = items_.emplace(key, std::move(parts).value()).first;
    }
    return mesh_files::item_called(known->second, item, file);
}

// A part that is written into the scene: a part file whose dimensions are the variables that it names, and its counts the whole numbers
// among them that no parameter moves.
void SceneBodies::read_own_part(const files::JsonNode& node, scene::ShapeSpec& spec) {
    const std::vector<std::string_view> keys{"solid", "solids", "profiles", "relations", "variables"};
    std::vector<std::string_view> known{"facets", "counts"};
    known.insert(known.end(), keys.begin(), keys.end());
    node.allow_keys(known);
    spec.chord = node["facets"].length(unit_, files::positive).value_or(0);
    std::string text, dimensions, counts;
    const auto append = [](std::string& list, const std::string& name, const std::string& value) {
        list += (list.empty() ? "\"" : ", \"") + name + "\": " + value;
    };
    for (const std::string_view key : keys)
        if (node[key].exists()) text += ", \"" + std::string(key) + "\": " + node[key].text();
    for (const std::string& name : expression::names_in(text)) {
        const auto named = formulas_.named(name);
        if (!named || spec.dimensions.count(name) != 0 || node["variables"][name].exists()) continue;
        const auto dimension = expression::named_dimension(named->dimension);
        if (dimension != base::Dimension::length && dimension != base::Dimension::angle && !named->dimension.is_number()) continue;
        const double value = named->number.value;
        if (named->dimension.is_number() && value >= 0 && value <= base::most_copies && std::round(value) == value && !named->is_moved) {
            append(counts, name, std::to_string(static_cast<int>(value)));
            continue;
        }
        spec.dimensions[name] = named->number.value;
        if (dimension == base::Dimension::angle) spec.angles.push_back(name);
        if (named->dimension.is_number()) spec.numbers.push_back(name);
        const std::string_view kind = named->dimension.is_number()          ? "number"
                                      : dimension == base::Dimension::angle ? "angle"
                                                                            : "coordinate";
        append(dimensions, name, "{\"value\": 0, \"kind\": \"" + std::string(kind) + "\"}");
        formulas_.bind(node.pointer() + "/dimensions/" + name, named->number);
    }
    std::string unit = "m";
    for (const char* each : {"um", "mm", "cm", "in", "ft"})
        if (base::metres_per_unit(each).value() == unit_) unit = each;
    spec.part =
        "{\"fettle_part\": 1, \"units\": \"" + unit + "\", \"dimensions\": {" + dimensions + "}, \"counts\": {" + counts + "}" + text + "}";
}

// A mesh file, mended as where a body has it without handles.
std::shared_ptr<const geometry::Mesh> SceneBodies::mended_mesh(const files::JsonNode& node, MeshSource& source) {
    scene::Body read;
    source = read_mesh_file(node, read);
    if (read.mesh.vertices.cols() == 0) return nullptr;
    if (!options_.strict_meshes && read.mesh.vertices.allFinite())
        for (const std::string& done : solids::repair_mesh(read.mesh)) node["mesh"].warn("`" + read.mesh.name + "`: " + done);
    return std::make_shared<const geometry::Mesh>(std::move(read.mesh));
}

void SceneBodies::read_handled_mesh(const files::JsonNode& node, scene::ShapeSpec& spec) {
    node.allow_keys({"mesh", "mesh_unit", "mesh_item", "mesh_solid", "mesh_facets", "surface_tolerance", "handles", "dimensions", "wall"});
    scene::HandledMeshSpec handled;
    MeshSource source;
    handled.mesh = mended_mesh(node, source);
    handled.source = std::get<0>(source) + "\n" + std::to_string(std::get<1>(source));
    handled.unit = unit_;
    handled.wall = node["wall"].length(unit_, files::not_negative).value_or(0);
    const files::JsonNode handles = node.require("handles");
    for (const auto& [name, handle] : handles.members()) {
        if (name.starts_with('#') || !handle.is_object() || !handle["morph"].is_string()) continue;
        const std::string file = handle["morph"].string().value();
        const auto found = mesh_files::find_mesh_file(file, document_.path(), options_.mesh_dirs, handle["morph"].where());
        if (!found) {
            report(found.errors(), handle["morph"]);
            continue;
        }
        mesh_files::MeshReadOptions options;
        options.unit = std::get<1>(source);
        options.should_stop = options_.should_stop;
        auto target = mesh_files::read_mesh(*found, options);
        if (!target) {
            report(target.errors(), handle["morph"]);
            continue;
        }
        if (!options_.strict_meshes && target->vertices.allFinite()) solids::repair_mesh(*target);
        handled.source += "\n" + *found;
        handled.targets[name] = std::make_shared<const geometry::Mesh>(*std::move(target));
    }
    if (!handles.is_object()) return;
    handled.handles = handles.text();
    spec.handled = std::move(handled);
}

void SceneBodies::read_dimensions(const files::JsonNode& node, scene::ShapeSpec& spec) {
    std::map<std::string, base::Dimension> quantities;
    if ((!spec.part.empty() || spec.handled) && options_.part_dimensions) {
        const auto found = options_.part_dimensions(spec);
        if (!found) return report(found.errors(), spec.handled ? node : node["part"]);
        quantities = *found;
        for (const auto& [name, quantity] : quantities) {
            if (quantity == base::Dimension::angle) spec.angles.push_back(name);
            if (quantity == base::Dimension::number) spec.numbers.push_back(name);
        }
    }
    for (const auto& [name, value] : node["dimensions"].members()) {
        if (name.starts_with('#')) continue;
        const auto quantity = quantities.find(name);
        if (quantity == quantities.end() || quantity->second == base::Dimension::length) {
            spec.dimensions[name] = value.length(unit_).value_or(0);
        } else if (quantity->second == base::Dimension::angle) {
            spec.dimensions[name] = value.quantity(base::Dimension::angle, to_si(1, *base::find_unit("deg"))).value_or(0);
        } else {
            spec.dimensions[name] = value.number().value_or(0);
        }
    }
}

void SceneBodies::make_shape(const files::JsonNode& node, scene::Body& body) {
    scene::ShapeSpec spec;
    if (node["program"].exists()) {
        node.allow_keys({"program", "format", "time_limit", "dimensions"});
        spec.program = read_program(node, document_.path(), unit_);
        body.mesh_policy = scene::MeshPolicy::tolerant;
    } else if (node["part"].exists()) {
        node.allow_keys({"part", "dimensions", "counts", "facets"});
        spec.part = node["part"].string().value_or("");
        if (spec.part.ends_with(".part.json")) {
            const auto file = mesh_files::find_mesh_file(spec.part, document_.path(), options_.mesh_dirs, node["part"].where());
            if (!file) {
                base::Errors errors = file.errors();  // of a search that knows meshes
                for (base::Error& error : errors)
                    if (error.message.starts_with("mesh file")) error.message.replace(0, 4, "part");
                return report(errors, node["part"]);
            }
            spec.part = *file;
        }
        spec.chord = node["facets"].length(unit_, files::positive).value_or(0);
    } else if (node["mesh"].exists()) {
        read_handled_mesh(node, spec);
        body.mesh_policy = scene::MeshPolicy::tolerant;
    } else if (node["solid"].exists()) {
        read_own_part(node, spec);
    } else if (node["generator"].exists()) {
        return node["generator"].fail(ErrorCode::unknown_key, in_place_of_generator(node["generator"].string().value_or("")));
    } else {
        node.allow_keys({"part", "program", "solid", "mesh", "dimensions", "counts", "facets"});
        node.require("part");
    }
    const std::size_t faults = document_.errors().size();
    for (const auto& [name, value] : node["counts"].members())
        if (!name.starts_with('#')) spec.counts[name] = value.integer(0).value_or(0);
    if (!node["solid"].exists()) read_dimensions(node, spec);
    body.shape = spec;
    if (document_.errors().size() > faults) return;  // of numbers that nobody gave more faults would be told
    if (spec.part.empty() && (!spec.program || spec.program->command.empty()) && (!spec.handled || !spec.handled->mesh)) return;
    if (!options_.shape_maker) {
        const std::string name = spec.handled ? spec.handled->mesh->name : spec.program ? spec.program->command.front() : spec.part;
        node.fail(ErrorCode::unsupported, "shape \"" + name + "\" cannot be made here: this program was given nothing that makes parts");
        return;
    }
    auto made = options_.shape_maker(spec);
    if (!made) return report(made.errors(), node);
    body.mesh = std::move(made).value();
}

void SceneBodies::read_inline(const files::JsonNode& node, scene::Body& body) {
    const std::size_t faults = document_.errors().size();
    geometry::Mesh mesh;
    mesh.name = body.name;
    const auto rows = node["vertices"].elements();
    if (node["vertices"].is_array() && rows.empty()) node["vertices"].fail(ErrorCode::out_of_range, "a body needs a vertex");
    mesh.vertices.resize(3, rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
        mesh.vertices.col(i) = rows[i].length3(unit_).value_or(Vector3::Zero());
    }
    const auto edges = files::index_rows<2>(node["edges"], count_of(rows));
    mesh.triangles = files::index_rows<3>(node["triangles"], count_of(rows));
    for (std::size_t e = 0; e < edges.size() && document_.errors().size() == faults; ++e) {
        if (mesh.vertices.col(edges[e][0]) != mesh.vertices.col(edges[e][1])) continue;
        node["edges"].elements()[e].fail(ErrorCode::out_of_range, "an edge joins two different places");
    }
    if (document_.errors().size() > faults) return;
    geometry::build_connectivity(mesh, edges);
    body.mesh = geometry::weld_exactly(mesh);
}

void SceneBodies::read_mass(const files::JsonNode& node, scene::Body& body) {
    body.mu = node["mu"].number(files::not_negative);
    body.material = read_material_name(node["material"], densities_).value_or("");
    if (node["inertial"].exists()) return read_inertial(node, body);
    const std::string per = node["mass_per"].choice({"volume", "area", "length", "vertex"}).value_or("volume");
    body.mass_kind = per == "area"     ? scene::MassKind::area
                     : per == "length" ? scene::MassKind::length
                     : per == "vertex" ? scene::MassKind::vertex
                                       : scene::MassKind::volume;
    const base::Dimension dimension = body.mass_kind == scene::MassKind::volume ? base::Dimension::density : base::Dimension::number;
    std::optional<double> density = node["density"].quantity(dimension, 1, files::positive);
    const auto known = densities_.find(body.material);
    const bool given = node["density"].exists();
    if (!given && known != densities_.end() && body.mass_kind == scene::MassKind::volume && known->second) {
        density = known->second->value;
        formulas_.bind(node.pointer() + "/density", *known->second);
    }
    if (body.type == scene::BodyType::dynamic_body && !given && !density) node.require("density");
    body.density = density.value_or(body.density);
    body.density_given = density.has_value();
}

// Given mass and inertia, about the centre of mass, along the mesh's axes.
void SceneBodies::read_inertial(const files::JsonNode& node, scene::Body& body) {
    body.density_given = false;
    for (const char* key : {"density", "mass_per", "split_components"})
        if (node[key].exists()) node[key].fail(ErrorCode::inconsistent, "a body with an `inertial` of its own has its mass from there");
    const files::JsonNode own = node["inertial"];
    own.allow_keys({"mass", "centre", "inertia"});
    if (!own.is_object()) return;
    scene::Inertial inertial;
    const std::size_t faults = document_.errors().size();
    inertial.mass = own.require("mass").quantity(base::Dimension::mass, 1, files::positive).value_or(1);
    inertial.centre = own.require("centre").length3(unit_).value_or(inertial.centre);
    const std::vector<files::JsonNode> rows = own.require("inertia").elements();
    if (rows.size() != 3 && own["inertia"].is_array())
        own["inertia"].fail(ErrorCode::wrong_type, "an inertia has three rows of three numbers [kg m^2]");
    for (std::size_t k = 0; k < rows.size() && k < 3; ++k)
        inertial.inertia.row(k) = rows[k].vector3().value_or(Vector3::Zero()).transpose();
    if (document_.errors().size() > faults) return;
    if (const std::string fault = scene::fault_of(inertial); !fault.empty()) own.fail(ErrorCode::out_of_range, fault);
    body.inertial = inertial;
}

void SceneBodies::read_group(const files::JsonNode& node, scene::Body& body) {
    if (!node.is_string()) {
        body.group = node.integer(0).value_or(-1);
        return;
    }
    const std::string name = node.string().value();
    const auto place = std::find(group_names_.begin(), group_names_.end(), name);
    body.group = -2 - static_cast<int>(place - group_names_.begin());
    if (place == group_names_.end()) group_names_.push_back(name);
}

void SceneBodies::number_groups(std::vector<scene::Body>& bodies) const {
    int highest = -1;
    for (const scene::Body& body : bodies) highest = std::max(highest, body.group);
    for (scene::Body& body : bodies) {
        if (body.group < -1) body.group = highest + (-1 - body.group);
    }
}

std::vector<scene::Body> SceneBodies::components(const files::JsonNode& node, scene::Body body) {
    const files::JsonNode key = node["split_components"];
    if (!key.boolean().value_or(false) || body.mesh.vertices.cols() == 0) return {std::move(body)};
    if (body.shape) key.fail(ErrorCode::inconsistent, "a generated `shape` is one part");
    if (body.reference_point)
        key.fail(ErrorCode::inconsistent, "each component has its own centre of mass; a `reference_point` is of one body");
    Eigen::Index kept = 0;
    std::vector<geometry::Mesh> parts = solids::split_solids(body.mesh);
    std::size_t edges = 0;
    for (const auto& part : parts) {
        kept += part.vertices.cols();
        edges += part.edges.size();
    }
    if (body.mesh.triangles.empty() || kept < body.mesh.vertices.cols() || edges < body.mesh.edges.size()) {
        key.fail(ErrorCode::inconsistent, "the mesh has edges or points that belong to no triangle, and so to no solid");
    }
    if (parts.size() == 1) return {std::move(body)};
    std::vector<scene::Body> bodies;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        bodies.push_back(body);
        bodies.back().name += "-" + std::to_string(i);
        bodies.back().mesh = std::move(parts[i]);
        if (names_.insert(bodies.back().name).second) continue;
        key.fail(ErrorCode::inconsistent,
                 "component " + std::to_string(i) + " would be called `" + bodies.back().name + "`, as another body is");
    }
    return bodies;
}

/// Errors of meshes and parts know nothing of the file: say which body asked.
void SceneBodies::report(const base::Errors& errors, const files::JsonNode& node) {
    for (const auto& error : errors) {
        const bool placed = error.where.empty() || error.where == node.where();
        constexpr std::string_view written_here = "shape#";  // of a part's text: its pointer goes on from the node's
        const std::string where = error.where.starts_with(written_here) ? error.where.substr(written_here.size()) : error.where;
        node.fail(error.code, (placed ? "" : where + ": ") + error.message);
    }
}

}  // namespace fettle::core::scene_files
