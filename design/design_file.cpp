// SPDX-License-Identifier: MIT
#include "fettle/design/design_file.hpp"

#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "fettle/core/base/units.hpp"
#include "fettle/core/base/version.hpp"
#include "fettle/core/files/atomic_file.hpp"
#include "fettle/core/files/hash.hpp"
#include "fettle/core/scene/scene_reader.hpp"
#include "fettle/core/stepper/step_count.hpp"
#include "fettle/design/constraint_reader.hpp"
#include "fettle/design/history.hpp"
#include "fettle/design/objectives/objective_table.hpp"
#include "fettle/design/optimisers/optimisation.hpp"
#include "fettle/design/parameter_reader.hpp"
#include "fettle/design/scene_shapes.hpp"

namespace fettle::design {

namespace {

namespace fs = std::filesystem;
using core::files::JsonDocument;
using core::files::JsonNode;

std::vector<std::string_view> views(const std::vector<std::string>& names) { return {names.begin(), names.end()}; }

/// Reads one file. Faults go to the document; values read after a fault are never used.
class DesignReader {
public:
    DesignReader(JsonDocument& document, const DesignReadOptions& options) : document_(document), options_(options) {}

    Result<Design> read() {
        const JsonNode root = document_.root();
        root.allow_keys({"$schema", "fettle_design", "description", "scene", "units", "simulation", "parameters", "objective",
                         "constraints", "optimiser", "output"});
        root["$schema"].string();
        root["description"].string();
        root.require("fettle_design").integer(1, 1);
        design_.path = document_.path();
        read_units(root.require("units"));
        if (!read_scene_file(root.require("scene"))) return all_errors();
        read_simulation(root["simulation"]);
        const objectives::ReadContext context{design_.scene, design_.length_unit, design_.steps * design_.scene.timestep};
        design_.parameters = read_parameters(root.require("parameters"), context, design_.length_unit_name);
        read_objective(root["objective"], context);
        const double margin = read_optimiser(root["optimiser"]);
        design_.constraints = read_constraints(root["constraints"], context, margin);
        design_.output = root["output"].string().value_or("");
        if (!design_.output.empty()) design_.output = (fs::path(design_.path).parent_path() / design_.output).string();
        if (!document_.errors().empty()) return all_errors();
        design_.warnings = document_.warnings();
        design_.warnings.insert(design_.warnings.end(), design_.scene.warnings.begin(), design_.scene.warnings.end());
        return std::move(design_);
    }

private:
    void read_units(const JsonNode& node) {
        const auto name = node.choice({"um", "mm", "cm", "m", "in", "ft"});
        if (!name) return;
        design_.length_unit_name = *name;
        design_.length_unit = core::base::metres_per_unit(*name).value();
    }

    // Names of bodies mean nothing without the scene: its faults end the reading, together with those found so far.
    bool read_scene_file(const JsonNode& node) {
        const auto name = node.string();
        if (!name) return false;
        design_.scene_path = (fs::path(design_.path).parent_path() / *name).string();
        Result<core::scene::Scene> scene = core::scene::read_scene(design_.scene_path, scene_read_options(options_.mesh_dirs));
        if (!scene) {
            scene_errors_ = scene.errors();
            return false;
        }
        design_.scene = std::move(scene).value();
        return true;
    }

    void read_simulation(const JsonNode& node) {
        const auto& end_time = design_.scene.end_time;
        design_.steps = end_time ? core::stepper::step_count(*end_time, design_.scene.timestep) : core::stepper::default_step_count;
        if (!node.exists()) return;
        node.allow_keys({"steps", "clearance_tolerance"});
        design_.steps = node["steps"].integer(1).value_or(design_.steps);
        design_.clearance_tolerance = node["clearance_tolerance"].length(design_.length_unit, core::files::positive).value_or(1e-9);
    }

    void read_objective(const JsonNode& node, const objectives::ReadContext& context) {
        std::set<std::string> names;
        std::vector<std::string_view> types;
        for (const auto& type : objectives::objective_table()) types.push_back(type.name);
        for (const JsonNode& entry : node.elements()) {
            const auto type_name = entry.require("type").choice(types);
            if (!type_name) continue;
            const objectives::ObjectiveType& type = *objectives::find_objective_type(*type_name);
            std::vector<std::string_view> keys{"type", "name", "weight"};
            keys.insert(keys.end(), type.keys.begin(), type.keys.end());
            entry.allow_keys(keys);
            ObjectiveTerm term;
            term.objective = type.read(entry, context);
            term.weight = entry["weight"].number().value_or(1);
            term.name = unique_name(entry["name"].string().value_or(type.default_name(entry)), names);
            if (!term.objective) continue;
            term.unit = term.objective->unit(design_.length_unit);
            design_.objective.push_back(std::move(term));
        }
    }

    /// @return clearance_margin [m]
    double read_optimiser(const JsonNode& node) {
        constexpr double default_margin = 2e-6;
        if (!node.exists()) return default_margin;
        node.allow_keys({"name", "max_evaluations", "tolerance", "clearance_margin"});
        OptimiserSettings& settings = design_.optimiser;
        settings.name = node["name"].choice(views(optimisers::optimiser_names())).value_or(settings.name);
        settings.max_evaluations = node["max_evaluations"].integer(1).value_or(settings.max_evaluations);
        settings.tolerance = node["tolerance"].number({0, 1, true}).value_or(settings.tolerance);
        return node["clearance_margin"].length(design_.length_unit, core::files::not_negative).value_or(default_margin);
    }

    Errors all_errors() const {
        Errors errors = document_.errors();
        errors.insert(errors.end(), scene_errors_.begin(), scene_errors_.end());
        return errors;
    }

    JsonDocument& document_;
    const DesignReadOptions& options_;
    Design design_;
    Errors scene_errors_;
};

// 10 and 10.0 are the same number, however they are written.
void make_numbers_equal(nlohmann::json& json) {
    if (json.is_number()) json = json.get<double>();
    if (!json.is_structured()) return;
    for (auto& child : json) make_numbers_equal(child);
}

// Everything of a scene that is not in its own text: meshes, which come from files or generators.
void append_bytes(std::string& text, const void* data, size_t size) { text.append(static_cast<const char*>(data), size); }

}  // namespace

Result<Design> read_design(const std::string& path, const DesignReadOptions& options) {
    Result<JsonDocument> document = JsonDocument::read(path);
    if (!document) return document.errors();
    const JsonNode root = document->root();
    if (!root.is_object() || !root["fettle_design"].exists()) {
        return Error{ErrorCode::missing_key, root.where(), "not a design: `fettle_design` (its version, 1) is not there"};
    }
    Result<Design> design = DesignReader(*document, options).read();
    if (!design) return design.errors();
    const Result<std::string> text = core::files::read_file(path);
    if (!text) return text.errors();
    design->text = *text;
    return design;
}

bool is_design_file(const std::string& path) {
    Result<JsonDocument> document = JsonDocument::read(path);
    if (!document) return false;
    const JsonNode root = document->root();
    return root.is_object() && root["fettle_design"].exists();
}

std::string design_text(const Design& design, const VectorX& values, const std::string& directory) {
    auto json = nlohmann::ordered_json::parse(design.text);
    for (size_t k = 0; k < design.parameters.size(); ++k) {
        const Parameter& parameter = design.parameters[k];
        auto& entry = json["parameters"][k];
        const double value = values[static_cast<Eigen::Index>(k)];
        // A value at a bound is written as the bound is: a neighbour with the same SI value could lie outside.
        entry["value"] = value == parameter.lower   ? entry["lower"].get<double>()
                         : value == parameter.upper ? entry["upper"].get<double>()
                                                    : from_si(value, parameter.unit);
    }
    std::error_code failure;
    const fs::path scene = fs::relative(fs::absolute(design.scene_path), fs::absolute(directory), failure);
    json["scene"] = failure || scene.empty() ? fs::absolute(design.scene_path).string() : scene.generic_string();
    json.erase("output");  // it was relative to the first file's folder
    return json.dump(2) + "\n";
}

std::string design_hash(const Design& design) {
    auto json = nlohmann::json::parse(design.text);
    for (const char* key : {"$schema", "description", "optimiser", "output", "scene"}) json.erase(key);
    make_numbers_equal(json);
    std::string all = std::string(core::base::version()) + "\n" + json.dump() + "\n";
    if (const Result<std::string> scene = core::files::read_file(design.scene_path)) all += *scene;
    for (const core::scene::Body& body : design.scene.bodies) {
        append_bytes(all, body.mesh.vertices.data(), static_cast<size_t>(body.mesh.vertices.size()) * sizeof(double));
        append_bytes(all, body.mesh.triangles.data(), body.mesh.triangles.size() * sizeof(core::geometry::Triangle));
    }
    return core::files::hash_of(all);
}

}  // namespace fettle::design
