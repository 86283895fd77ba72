// SPDX-License-Identifier: MIT
#include "core/scene_files/scene_reader.hpp"

#include <utility>

#include "core/base/units.hpp"
#include "core/files/json_keys.hpp"
#include "core/paper_scenes/fixture_reader.hpp"
#include "core/scene_files/mechanism_reader.hpp"
#include "core/scene_files/scene_body.hpp"

namespace fettle::core::scene_files {
namespace {

using base::ErrorCode;

/// Reads one file of our own format. Faults go to the document; values read after a fault are never used.
class SceneReader {
public:
    SceneReader(files::JsonDocument& document, const scene::ReadOptions& options)
        : document_(document), options_(options), formulas_(document, options.inputs) {}

    base::Result<scene::Scene> read() {
        const files::JsonNode root = document_.root();
        root.allow_keys({"$schema", "fettle_scene", "description", "units", "variables", "gravity", "timestep", "end_time", "integrator",
                         "contact", "materials", "friction", "bodies", "joints", "springs", "dampers", "motors", "loads", "ignore"});
        root["$schema"].string();
        root["description"].string();
        files::is_version(root["fettle_scene"], 1);
        const auto unit_name = root.require("units").choice({"um", "mm", "cm", "m", "in", "ft"});
        if (!unit_name) return document_.errors();  // no length means anything
        unit_ = base::metres_per_unit(*unit_name).value();
        scene_.path = document_.path();
        scene_.length_unit = unit_;
        formulas_.set_length_unit(unit_);
        formulas_.read_variables(root["variables"]);
        scene_.gravity = root["gravity"].quantity3(base::Dimension::acceleration, 1).value_or(Vector3::Zero());
        scene_.timestep = root["timestep"].number({1e-12, 1e9}).value_or(0.01);
        scene_.end_time = root["end_time"].number(files::positive);
        read_integrator(root["integrator"]);
        read_contact(root["contact"]);
        read_materials(root["materials"]);
        read_friction(root["friction"]);
        read_bodies(root.require("bodies"));
        scene_.mechanism = read_mechanism(root, unit_, scene_.bodies, formulas_);
        for (const files::JsonNode& entry : root["ignore"].elements()) scene_.ignore.push_back(entry.string().value_or(""));
        if (document_.errors().empty()) formulas_.finish(scene_);
        if (!document_.errors().empty()) return document_.errors();
        scene_.warnings = document_.warnings();
        return std::move(scene_);
    }

private:
    void read_integrator(const files::JsonNode& node) {
        const std::string name = node.choice({"implicit_euler", "bdf2", "newmark", "quasi_static"}).value_or("implicit_euler");
        scene_.integrator = name == "bdf2"           ? scene::Integrator::bdf2
                            : name == "newmark"      ? scene::Integrator::newmark
                            : name == "quasi_static" ? scene::Integrator::quasi_static
                                                     : scene::Integrator::implicit_euler;
    }

    void read_contact(const files::JsonNode& node) {
        if (!node.exists()) return;
        node.allow_keys({"dhat", "dmin", "kappa", "area_weighted", "round", "damping_time", "velocity_tolerance", "max_newton_iterations"});
        scene_.dhat = node["dhat"].length(unit_, files::positive);
        scene_.dmin = node["dmin"].length(unit_, files::not_negative).value_or(0);
        scene_.kappa = node["kappa"].number(files::positive);
        scene_.area_weighted = node["area_weighted"].boolean().value_or(false);
        scene_.round_contact = node["round"].boolean();
        scene_.contact_damping_time = node["damping_time"].number(files::not_negative).value_or(0);
        scene_.velocity_tolerance = node["velocity_tolerance"].length(unit_, files::positive);
        scene_.max_newton_iterations = node["max_newton_iterations"].integer(1).value_or(scene_.max_newton_iterations);
    }

    void read_materials(const files::JsonNode& node) {
        for (const auto& [name, material] : node.members()) {
            material.allow_keys({"density", "mu"});
            if (name.empty()) material.fail(ErrorCode::out_of_range, "a material needs a name");
            if (!material.is_object()) continue;
            const files::JsonNode density = material["density"];
            const auto value = density.quantity(base::Dimension::density, 1, files::positive);
            densities_[name] = value ? std::optional(formulas_.number(density, *value)) : std::nullopt;
            formulas_.use(density);
            if (const auto mu = material["mu"].number(files::not_negative)) scene_.friction.materials[name] = *mu;
        }
    }

    void read_friction(const files::JsonNode& node) {
        if (!node.exists()) return;
        node.allow_keys({"mu", "pairs", "eps_v", "rounds"});
        scene::Friction& friction = scene_.friction;
        friction.mu = node["mu"].number(files::not_negative).value_or(0);
        friction.eps_v = node["eps_v"].length(unit_, files::positive).value_or(friction.eps_v);
        const files::JsonNode rounds = node["rounds"];
        if (rounds.is_string()) {
            if (rounds.choice({"converged"})) friction.rounds = -1;
        } else {
            friction.rounds = rounds.integer(1).value_or(friction.rounds);
        }
        for (const files::JsonNode& pair : node["pairs"].elements()) read_friction_pair(pair);
    }

    void read_friction_pair(const files::JsonNode& node) {
        node.allow_keys({"a", "b", "mu"});
        if (!node.is_object()) return;
        const auto a = read_material_name(node.require("a"), densities_), b = read_material_name(node.require("b"), densities_);
        const auto mu = node.require("mu").number(files::not_negative);
        if (!a || !b || !mu) return;
        if (scene_.friction.pair_of(*a, *b) >= 0) node.fail(ErrorCode::inconsistent, "`" + *a + "` and `" + *b + "` are listed already");
        scene_.friction.pairs.push_back({*a, *b, *mu});
    }

    void read_bodies(const files::JsonNode& node) {
        SceneBodies bodies(document_, options_, unit_, densities_, formulas_);
        for (const files::JsonNode& entry : node.elements()) {
            for (scene::Body& body : bodies.read(entry)) scene_.bodies.push_back(std::move(body));
        }
        if (node.is_array() && scene_.bodies.empty()) node.fail(ErrorCode::out_of_range, "a scene needs a body");
        bodies.number_groups(scene_.bodies);
    }

    files::JsonDocument& document_;
    const scene::ReadOptions& options_;
    scene::Scene scene_;
    double unit_ = 1;
    MaterialDensities densities_;
    SceneFormulas formulas_;
};

}  // namespace

base::Result<scene::Scene> read_scene(files::JsonDocument& document, const scene::ReadOptions& options) {
    base::Errors faults;
    for (const auto& [pointer, value] : options.replacements)
        if (const std::string fault = document.replace(pointer, value); !fault.empty())
            faults.push_back({ErrorCode::out_of_range, value.where(), document.path() + ": " + fault});
    if (!faults.empty()) return faults;
    const files::JsonNode root = document.root();
    if (paper_scenes::is_fixture(root)) return paper_scenes::read_fixture(document, options);
    if (!root.is_object() || !root["fettle_scene"].exists()) {
        return base::Error{ErrorCode::missing_key, root.where(),
                           "not a scene: neither `fettle_scene` (its version, 1) nor `rigid_body_problem` is there" +
                               files::format_remark(root, {"fettle_scene", "fettle_design"})};
    }
    return SceneReader(document, options).read();
}

std::vector<scene::Variable> variables_of(files::JsonDocument& document, const std::vector<scene::FormulaInput>& inputs) {
    const files::JsonNode root = document.root();
    if (!root.is_object() || !root["fettle_scene"].exists() || !root["variables"].is_object()) return {};
    SceneFormulas formulas(document, inputs);
    const auto unit = root["units"].is_string() ? base::metres_per_unit(*root["units"].string()) : base::Result<double>(1.0);
    formulas.set_length_unit(unit ? *unit : 1);
    formulas.read_variables(root["variables"]);
    std::vector<scene::Variable> out = formulas.variables();
    document.forget_errors();
    return out;
}

base::Result<scene::Scene> read_scene(const std::string& path, const scene::ReadOptions& options) {
    auto document = files::JsonDocument::read(path);
    if (!document) return document.errors();
    return read_scene(*document, options);
}

base::Result<scene::Scene> parse_scene(const std::string& text, const std::string& path, const scene::ReadOptions& options) {
    auto document = files::JsonDocument::parse(text, path);
    if (!document) return document.errors();
    return read_scene(*document, options);
}

}  // namespace fettle::core::scene_files
