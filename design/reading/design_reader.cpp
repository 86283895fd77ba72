// SPDX-License-Identifier: MIT
#include "design/reading/design_reader.hpp"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <system_error>

#include "core/base/text.hpp"
#include "core/base/units.hpp"
#include "core/files/atomic_file.hpp"
#include "core/files/json_keys.hpp"
#include "core/mesh_files/mesh_reader.hpp"
#include "core/scene/place.hpp"
#include "core/scene/step_count.hpp"
#include "core/scene_files/scene_reader.hpp"
#include "design/description/made_design.hpp"
#include "design/optimisers/optimisation.hpp"
#include "design/quantities/worst.hpp"
#include "design/reading/choice_reader.hpp"
#include "design/reading/constraint_reader.hpp"
#include "design/reading/design_formulas.hpp"
#include "design/reading/over_tolerances_reader.hpp"
#include "design/reading/parameter_reader.hpp"
#include "design/reading/process_file.hpp"
#include "design/reading/quantity_reader.hpp"
#include "design/reading/relation_reader.hpp"
#include "design/reading/same_parts.hpp"
#include "design/reading/scenario_choice.hpp"

namespace fettle::design::reading {

namespace {

namespace fs = std::filesystem;
using core::files::JsonDocument;
using core::files::JsonNode;

std::vector<std::string_view> views(const std::vector<std::string>& names) { return {names.begin(), names.end()}; }

/// Reads one file. Faults go to the document; values read after a fault are never used.
class DesignReader {
public:
    /// @param fixed  Variables that "*" of the tolerances gives no deviation, each with its reason.
    DesignReader(JsonDocument& document, const DesignReadOptions& options, const std::map<std::string, std::string>& fixed)
        : document_(document), options_(options), fixed_(fixed) {}

    Result<DesignFile> read() {
        const JsonNode root = document_.root();
        root.allow_keys({"$schema", "fettle_design", "description", "scene", "units", "parameters", "choices", "variables", "set",
                         "scenarios", "simulation", "quantities", "objective", "constraints", "tolerances", "process", "over_tolerances",
                         "optimiser", "output"});
        root["$schema"].string();
        root["description"].string();
        core::files::is_version(root.require("fettle_design"), 1);
        file_.path = document_.path();
        const auto unit = root.require("units").choice({"um", "mm", "cm", "m", "in", "ft"});
        if (!unit) return all_errors();  // no length means anything
        file_.length_unit = *find_unit(*unit);
        std::optional<JsonDocument> scene = open_scene_file(root.require("scene"));
        if (!scene) return all_errors();
        choices_.emplace(root["choices"], *scene);
        choices_->apply(*scene);
        file_.choices = choices_->choices();
        DesignFormulas formulas(document_, to_si(1, file_.length_unit), core::scene_files::variables_of(*scene));
        design_.parameters = read_parameters(root.require("parameters"), formulas.scene_variables(), file_.length_unit);
        refuse_choices_among(design_.parameters, root["choices"]);
        std::vector<description::Parameter> as_made = design_.parameters;
        const ToleranceUnits units{file_.length_unit, read_processes(root["process"])};
        if (units.processes.is_missing) return all_errors();  // each feature would ask for it
        std::vector<ToleranceEntry> entries = find_tolerances(root["tolerances"], variable_names(root, formulas), as_made);
        file_.untoleranced = add_default_tolerances(root["tolerances"], formulas.scene_variables(), units, why_fixed(), as_made, entries);
        formulas.add_parameters(root["parameters"], design_.parameters);
        if (options_.as_made) {
            for (const ToleranceEntry& entry : entries)
                if (entry.is_default && entry.kind == ToleranceEntry::Kind::variable)
                    default_variables_[as_made[entry.tolerance.parameter].name] = entry.tolerance.of;
            formulas.add_deviations(deviations_of(entries, as_made), *scene);
        }
        formulas.read_variables(root["variables"]);
        if (!has_parameters()) return all_errors();
        const std::optional<Setting> setting = read_setting(*scene, {root["set"]}, formulas);
        if (!setting) return all_errors();
        design_.scene = setting->scene;
        design_.shapes = setting->shapes;
        design_.numbers = setting->numbers;
        formulas.take_scene(design_.scene.variables, root["variables"]);
        read_simulation(root["simulation"]);
        const ScenarioNames scenarios = read_scenarios(root["scenarios"], root["set"], formulas);
        if (!scene_errors_.empty()) return all_errors();  // of one of them
        for (const description::Scenario& scenario : design_.scenarios) formulas.take_scenario(scenario.name, scenario.scene.variables);
        take_tolerances(entries, scene->root(), units, formulas, as_made);
        std::vector<quantities::NamedQuantity> named;
        const ReadContext context{design_.scene,
                                  to_si(1, file_.length_unit),
                                  design_.steps * design_.scene.timestep,
                                  formulas,
                                  named,
                                  scenarios,
                                  read_over_tolerances(root["over_tolerances"])};
        named = read_named_quantities(root["quantities"], context);
        read_objective(root["objective"], context);
        const double margin = read_optimiser(root["optimiser"]);
        design_.constraints = read_constraints(root["constraints"], context, margin);
        const std::optional<core::expression::Scope> by_choices = choice_scope();
        design_.relations = read_relations(root["constraints"], context, design_.parameters, design_.constraints,
                                           by_choices ? &*by_choices : nullptr, !options_.as_made && !entries.empty());
        for (const description::Relation& relation : design_.relations)
            if (relation.by_choices) file_.conditions.push_back({relation.name, relation.bounds, *relation.by_choices});
        take_over_tolerances(root, entries.empty());
        check_use(root["parameters"]);
        file_.quantities = named;
        file_.output = read_output(root["output"]);
        if (!document_.errors().empty() || !scene_errors_.empty()) return all_errors();
        refine(design_.scene, design_.steps);
        for (description::Scenario& scenario : design_.scenarios) refine(scenario.scene, scenario.steps);
        file_.warnings = document_.warnings();
        file_.warnings.insert(file_.warnings.end(), design_.scene.warnings.begin(), design_.scene.warnings.end());
        add_remarks();
        return std::move(file_);
    }

    /// Variables that "*" has given a tolerance, by their deviations' names; those of them that nothing of the design follows from.
    const std::map<std::string, std::string>& default_variables() const { return default_variables_; }
    const std::vector<std::string>& unused_variables() const { return unused_variables_; }

private:
    // Can the scene be read with them? Values that are out of their bounds can be set, faults of the form cannot.
    bool has_parameters() const {
        const Errors& errors = document_.errors();
        return std::all_of(errors.begin(), errors.end(), [](const Error& error) {
            return error.code == ErrorCode::inconsistent || error.code == ErrorCode::out_of_range || error.code == ErrorCode::unsupported;
        });
    }

    // A number cannot be both.
    void refuse_choices_among(const std::vector<description::Parameter>& parameters, const JsonNode& node) const {
        for (const description::Choice& choice : file_.choices)
            for (const description::Parameter& parameter : parameters)
                if (choice.variables.count(parameter.name) > 0)
                    node[choice.name].fail(ErrorCode::inconsistent, "`" + parameter.name + "` is a parameter already");
    }

    // Nothing: there are no choices, or a document cannot be read a second time.
    std::optional<core::expression::Scope> choice_scope() const {
        if (file_.choices.empty()) return std::nullopt;
        Result<JsonDocument> design = JsonDocument::parse(document_.root().text(), file_.path);
        Result<JsonDocument> scene = JsonDocument::read(file_.scene_path);
        if (!design || !scene) return std::nullopt;
        return choices_->scope(*design, *scene, to_si(1, file_.length_unit), design_.parameters);
    }

    // The process that makes the parts, unless the caller names it.
    ProcessChoice read_processes(const JsonNode& of_design) {
        const JsonNode& node = choices_->process() ? *choices_->process() : of_design;
        ProcessChoice choice;
        choice.folder = fs::path(file_.path).parent_path().string();
        const auto name = node.string();
        if (name && options_.process.empty()) take_process(find_process(*name, choice.folder, node.where()), &node, choice);
        if (!options_.process.empty()) take_process(find_process(options_.process, "", "--process"), nullptr, choice);
        return choice;
    }

    // @param node  Which names it; null: the caller.
    void take_process(const Result<tolerances::Process>& process, const JsonNode* node, ProcessChoice& choice) {
        for (const Error& error : process.errors()) {
            if (node != nullptr)
                node->fail(error.code, (error.where == node->where() ? "" : error.where + ": ") + error.message);
            else
                process_errors_.push_back(error);
        }
        choice.is_missing = !process;
        if (!process) return;
        choice.usual = *process;
        file_.process = process->name;
    }

    std::function<std::string(const std::string&)> why_fixed() const {
        return [this](const std::string& variable) {
            const auto known = fixed_.find(variable);
            return known == fixed_.end() ? std::string() : known->second;
        };
    }

    static VariableNames variable_names(const JsonNode& root, const DesignFormulas& formulas) {
        VariableNames out;
        for (const core::scene::Variable& variable : formulas.scene_variables()) out.scene.push_back(variable.name);
        for (const auto& [name, value] : root["variables"].members())
            if (!name.starts_with('#')) out.design.push_back(name);
        return out;
    }

    // The tolerances of a design as drawn are checked, and left. @param parameters  As made, but for those of places.
    void take_tolerances(std::vector<ToleranceEntry>& entries, const JsonNode& scene, const ToleranceUnits& units,
                         const DesignFormulas& formulas, const std::vector<description::Parameter>& parameters) {
        if (entries.empty()) return;
        if (!options_.as_made) {
            description::Design checked = design_;
            checked.parameters = parameters;
            read_tolerances(entries, scene, formulas, units, checked, file_.untoleranced);
            return;
        }
        design_.parameters = parameters;
        read_tolerances(entries, scene, formulas, units, design_, file_.untoleranced);
        for (ToleranceEntry& entry : entries) file_.tolerances.push_back(std::move(entry.tolerance));
    }

    // The requests over tolerances of a design as made are checked, and left: it has to meet the requirements without a reserve.
    void take_over_tolerances(const JsonNode& root, bool has_none) {
        if (description::asks_over_tolerances(design_) && has_none)
            root.fail(ErrorCode::missing_key,
                      "something is asked for `over_tolerances`, and there are no `tolerances`: say, for instance, \"tolerances\": "
                      "{\"pin_radius\": \"+-0.05 mm\"}");
        if (!options_.as_made) return;
        for (description::ObjectiveTerm& term : design_.objective) term.over_tolerances.reset();
        for (description::Constraint& constraint : design_.constraints) constraint.bounds.over_tolerances.reset();
        for (description::Relation& relation : design_.relations) relation.bounds.over_tolerances.reset();
    }

    std::optional<JsonDocument> open_scene_file(const JsonNode& node) {
        const auto name = node.string();
        if (!name) return std::nullopt;
        const std::string wanted = "; `scene` is the path of a scene file from the design's folder";
        if (name->empty()) {
            node.fail(ErrorCode::out_of_range, "it is empty" + wanted);
            return std::nullopt;
        }
        file_.scene_path = (fs::path(file_.path).parent_path() / *name).string();
        std::error_code ignored;
        if (core::mesh_files::has_mesh_extension(*name) || fs::is_directory(file_.scene_path, ignored)) {
            const char* found = core::mesh_files::has_mesh_extension(*name) ? " is a mesh, which a scene names" : " is a folder";
            node.fail(ErrorCode::unsupported, file_.scene_path + found + wanted);
            return std::nullopt;
        }
        Result<JsonDocument> scene = JsonDocument::read(file_.scene_path);
        if (scene) return std::move(scene).value();
        scene_errors_ = scene.errors();
        if (scene_errors_.front().code == ErrorCode::file_not_found) {
            scene_errors_.clear();
            node.fail(ErrorCode::file_not_found,
                      "there is no scene file " + file_.scene_path + "; `scene` is its path from the design's folder");
        }
        return std::nullopt;
    }

    /// What is to be said of parts whose derivative is not exact.
    struct Remark {
        std::string text;
        std::vector<std::string> bodies;
    };

    /// A scene and what of it a design can move.
    struct Setting {
        core::scene::Scene scene;
        std::vector<std::shared_ptr<const description::Shape>> shapes;
        std::vector<core::scene::BoundNumber> numbers;
    };

    // With the parameters for its variables, and with what the design, or one of its scenarios, sets. Names of bodies mean nothing without
    // the scene: its faults end the reading, together with those found so far.
    std::optional<Setting> read_setting(JsonDocument& document, const std::vector<JsonNode>& sets, const DesignFormulas& formulas) {
        core::scene::ReadOptions options = scene_read_options(options_.mesh_dirs, options_.programs, parts_, options_.resolution.facets);
        options.inputs = formulas.inputs_of_scene();
        for (const JsonNode& set : sets)
            for (const auto& [pointer, value] : set.members()) options.replacements.push_back({pointer, value});
        Result<core::scene::Scene> scene = core::scene_files::read_scene(document, options);
        if (!scene) {
            scene_errors_ = scene.errors();
            const bool elsewhere = description::references_of(design_.parameters) != description::values_of(design_.parameters);
            if (elsewhere) scene_errors_ = description::at_reference(std::move(scene_errors_));
            return std::nullopt;
        }
        Setting out{std::move(scene).value(), {}, {}};
        take_shapes(out);
        take_numbers(out);
        take_remarks(out);
        return out;
    }

    ScenarioNames read_scenarios(const JsonNode& node, const JsonNode& set, const DesignFormulas& formulas) {
        ScenarioNames names;
        if (node.exists() && node.is_array() && node.elements().empty())
            node.fail(ErrorCode::out_of_range, "a design with `scenarios` has one");
        for (const JsonNode& entry : node.elements()) {
            entry.allow_keys({"name", "description", "set", "steps", "play", "along", "press"});
            entry["description"].string();
            const std::string name = entry.require("name").string().value_or("");
            const std::string fault = core::base::name_fault(name);
            if (name.empty() && entry["name"].exists()) entry["name"].fail(ErrorCode::out_of_range, "a scenario has a name");
            if (!fault.empty()) entry["name"].fail(ErrorCode::out_of_range, "a scenario's name " + fault);
            const std::optional<Vector3> press = read_play(entry);
            if (!press) {
                if (!add_scenario(entry, name, Vector3::Zero(), set, formulas, names)) return names;
                continue;
            }
            if (!add_scenario(entry, name + " forwards", *press, set, formulas, names)) return names;
            if (!add_scenario(entry, name + " backwards", -*press, set, formulas, names)) return names;
        }
        return names;
    }

    // What presses all bodies to one side of their play [m/s^2]; nothing: the entry is one scenario, as it stands.
    std::optional<Vector3> read_play(const JsonNode& entry) const {
        const bool is_both = entry["play"].choice({"both"}).has_value();
        for (const std::string_view key : {"along", "press"})
            if (entry[key].exists() && !entry["play"].exists())
                entry[key].fail(ErrorCode::inconsistent, "`" + std::string(key) + "` goes with \"play\": \"both\"");
        if (!is_both) return std::nullopt;
        const auto along = entry.require("along").vector3();
        const double press = entry["press"].quantity(Dimension::acceleration, 1, core::files::positive).value_or(9.81);
        if (!along) return std::nullopt;
        if (along->norm() > 0) return press * along->normalized();
        entry["along"].fail(ErrorCode::out_of_range, "a direction is not of length 0");
        return std::nullopt;
    }

    // The scene read again, with its own settings in place of the design's. False: a fault that ends the reading.
    bool add_scenario(const JsonNode& entry, const std::string& name, const Vector3& press, const JsonNode& set,
                      const DesignFormulas& formulas, ScenarioNames& names) {
        const bool taken = std::find(names.names.begin(), names.names.end(), name) != names.names.end();
        if (taken || is_scenario_word(name))
            entry["name"].fail(ErrorCode::inconsistent,
                               taken ? "another scenario has this name" : "\"" + name + "\" means several scenarios");
        Result<JsonDocument> scene = JsonDocument::read(file_.scene_path);
        if (!scene) {
            scene_errors_ = scene.errors();
            return false;
        }
        choices_->apply(*scene);
        std::optional<Setting> setting = read_setting(*scene, {set, entry["set"]}, formulas);
        if (!setting) return false;
        check_same_things(setting->scene, entry);
        const auto is_gravity = [](const core::scene::BoundNumber& number) { return number.place.starts_with("/gravity"); };
        if (press != Vector3::Zero() && std::any_of(setting->numbers.begin(), setting->numbers.end(), is_gravity))
            entry["play"].fail(ErrorCode::unsupported, "the scene's gravity follows from parameters, so nothing can be added to it");
        setting->scene.gravity += press;
        const auto& end_time = setting->scene.end_time;
        const int steps =
            entry["steps"].integer(1).value_or(end_time == design_.scene.end_time && setting->scene.timestep == design_.scene.timestep
                                                   ? design_.steps
                                                   : core::scene::step_count(setting->scene));
        names.parts_differ = names.parts_differ || changes_parts(entry["set"], setting->scene);
        names.names.push_back(name);
        design_.scenarios.push_back({name, std::move(setting->scene), std::move(setting->shapes), std::move(setting->numbers), steps});
        return true;
    }

    bool changes_parts(const JsonNode& set, const core::scene::Scene& scene) const {
        bool sets_variables = false;
        for (const auto& [pointer, value] : set.members()) {
            const bool is_variable = pointer.starts_with("/variables/");
            sets_variables = sets_variables || is_variable;
            if (!is_variable && !leaves_parts(pointer)) return true;
        }
        return sets_variables && !have_same_parts(design_.scene, scene);
    }

    void refine(core::scene::Scene& scene, int& steps) const {
        scene.timestep /= options_.resolution.steps;
        steps *= options_.resolution.steps;
    }

    void check_same_things(const core::scene::Scene& scene, const JsonNode& entry) const {
        const auto names = [](const auto& list) {
            std::vector<std::string> out;
            for (const auto& each : list) out.push_back(each.name);
            return out;
        };
        const core::scene::Mechanism &own = scene.mechanism, &common = design_.scene.mechanism;
        if (names(scene.bodies) != names(design_.scene.bodies) || names(own.joints) != names(common.joints) ||
            names(own.motors) != names(common.motors) || names(own.springs) != names(common.springs) ||
            names(own.loads) != names(common.loads))
            entry["set"].fail(ErrorCode::inconsistent,
                              "a scenario has the scene's bodies, joints, springs, motors and loads; it sets their numbers");
    }

    // What follows from the parameters; the scene's other variables are constant here.
    void take_numbers(Setting& setting) {
        std::map<std::string, core::expression::Formula> constants;
        for (const core::scene::Variable& variable : setting.scene.variables)
            if (variable.formula.is_constant())
                constants[variable.name] = core::expression::constant_formula(variable.value, variable.formula.dimension);
        for (core::scene::BoundNumber& number : setting.scene.numbers) {
            number.formula = core::expression::substituted(number.formula, constants);
            if (!number.formula.is_constant()) setting.numbers.push_back(number);
        }
        check_scaled_parts(setting);
    }

    // A parameter that nothing follows from is a mistake: no number of the scene, and nothing that is wanted or required.
    void check_use(const JsonNode& parameters) {
        if (!document_.errors().empty()) return;  // what could not be read may name it
        std::set<std::string> used;
        for (int s = 0; s < description::scenario_count(design_); ++s)
            for (const core::scene::BoundNumber& number : design_.scenarios.empty() ? design_.numbers : design_.scenarios[s].numbers)
                used.insert(number.formula.inputs.begin(), number.formula.inputs.end());
        const auto look_at = [&](const description::Quantity& quantity) {
            const std::vector<std::string> names = quantity.parameters();
            used.insert(names.begin(), names.end());
        };
        for (const description::ObjectiveTerm& term : design_.objective) look_at(*term.quantity);
        for (const description::Constraint& constraint : design_.constraints) look_at(*constraint.quantity);
        for (const description::Relation& relation : design_.relations)
            used.insert(relation.formula->inputs.begin(), relation.formula->inputs.end());
        const std::vector<JsonNode> nodes = parameters.elements();
        for (std::size_t k = 0; k < design_.parameters.size(); ++k) {
            const std::string& name = design_.parameters[k].name;
            if (used.count(name) > 0) continue;
            if (const auto variable = default_variables_.find(name); variable != default_variables_.end())
                unused_variables_.push_back(variable->second);
            else if (k >= nodes.size())
                document_.root()["tolerances"].fail(ErrorCode::inconsistent,
                                                    "nothing of the design follows from the " + name + ": leave its tolerance out");
            else
                nodes[k].fail(ErrorCode::inconsistent,
                              "no number of the scene follows from parameter \"" + name +
                                  "\": use it in a formula there, or in the design's `set`, such as \"/bodies/" +
                                  (design_.scene.bodies.empty() ? std::string("0") : design_.scene.bodies.front().name) +
                                  "/position/0\": \"= " + core::expression::quoted_if_needed(name) + "\"");
        }
    }

    void check_scaled_parts(const Setting& setting) {
        for (const core::scene::BoundNumber& number : setting.numbers) {
            const std::size_t at = number.place.find("/shape/dimensions/");
            if (at == std::string::npos) continue;
            const core::scene::Place place = core::scene::find_place(setting.scene, number.place).value();
            if (setting.shapes[place.item]) continue;
            scene_errors_.push_back({ErrorCode::unsupported, setting.scene.bodies[place.item].where,
                                     "it has a `scale`; a part that parameters move has none: give its dimensions their full size"});
        }
    }

    // A part that the scene has scaled is none that a parameter can move.
    void take_shapes(Setting& setting) {
        for (core::scene::Body& body : setting.scene.bodies) {
            setting.shapes.emplace_back();
            const auto is_its_own = [&](const MadePart& part) {
                return body.shape == part.spec && part.mesh.vertices == body.mesh.vertices;
            };
            const auto found = std::find_if(parts_->begin(), parts_->end(), is_its_own);
            if (found == parts_->end() || found->shape->dimensions().empty()) continue;
            const description::Shape& shape = *found->shape;
            setting.shapes.back() = found->shape;
            description::describe(shape, body);
        }
    }

    // Remarks on the derivatives that the design takes.
    void take_remarks(const Setting& setting) {
        for (size_t i = 0; i < setting.shapes.size(); ++i) {
            if (!setting.shapes[i]) continue;
            const description::Shape& shape = *setting.shapes[i];
            const std::vector<bool> moved = description::moved_dimensions(setting.scene, setting.numbers, static_cast<int>(i), shape);
            for (const std::string& remark : shape.remarks(description::drawn_values(shape), moved)) {
                auto known = std::find_if(remarks_.begin(), remarks_.end(), [&](const Remark& other) { return other.text == remark; });
                if (known == remarks_.end()) known = remarks_.insert(remarks_.end(), {remark, {}});
                const std::string& body = setting.scene.bodies[i].name;
                if (std::find(known->bodies.begin(), known->bodies.end(), body) == known->bodies.end()) known->bodies.push_back(body);
            }
        }
    }

    // One for all bodies that are alike.
    void add_remarks() {
        for (const Remark& remark : remarks_)
            file_.warnings.push_back((remark.bodies.size() == 1 ? "body " : "bodies ") + core::base::joined(remark.bodies) + ": " +
                                     remark.text);
    }

    void read_simulation(const JsonNode& node) {
        design_.steps = core::scene::step_count(design_.scene);
        if (!node.exists()) return;
        node.allow_keys({"steps", "clearance_tolerance"});
        design_.steps = node["steps"].integer(1).value_or(design_.steps);
        design_.clearance_tolerance =
            node["clearance_tolerance"].length(to_si(1, file_.length_unit), core::files::positive).value_or(design_.clearance_tolerance);
    }

    void read_objective(const JsonNode& node, const ReadContext& context) {
        std::set<std::string> names;
        for (const JsonNode& entry : node.elements()) {
            const auto type_name = entry.require("type").choice(quantity_names());
            if (!type_name) continue;
            const QuantityType& type = *find_quantity_type(*type_name);
            std::vector<std::string_view> keys{"type", "name", "weight", "scenario", "over_tolerances"};
            keys.insert(keys.end(), type.keys.begin(), type.keys.end());
            entry.allow_keys(keys);
            description::ObjectiveTerm term;
            term.quantity = read_quantity(type, entry, context);
            term.weight = entry["weight"].number().value_or(1);
            term.over_tolerances = read_over_tolerances(entry["over_tolerances"]);
            const std::string name = entry["name"].string().value_or(type.default_name(entry));
            if (!term.quantity) continue;
            term.unit = context.unit(term.quantity->dimension());
            const std::vector<ScenarioQuantity> each = in_scenarios(entry, term.quantity, context.scenarios);
            const auto add = [&](std::shared_ptr<const description::Quantity> quantity, const std::string& suffix) {
                term.quantity = std::move(quantity);
                term.name = unique_name(name + suffix, names);
                design_.objective.push_back(term);
            };
            if (each.size() > 1 && entry["scenario"].string() == worst_scenario) {
                std::vector<std::shared_ptr<const description::Quantity>> parts;
                for (const ScenarioQuantity& one : each) parts.push_back(one.quantity);
                add(std::make_shared<quantities::Worst>(std::move(parts), term.weight >= 0), " [worst]");
                continue;
            }
            term.weight /= static_cast<double>(each.size());  // their mean
            for (const ScenarioQuantity& one : each) add(one.quantity, one.suffix);
        }
    }

    /// @return clearance_margin [m]
    double read_optimiser(const JsonNode& node) {
        constexpr double default_margin = 2e-6;
        if (!node.exists()) return default_margin;
        node.allow_keys({"name", "max_evaluations", "tolerance", "clearance_margin", "keep_sides"});
        description::OptimiserSettings& settings = design_.optimiser;
        settings.name = node["name"].choice(views(optimisers::optimiser_names())).value_or(settings.name);
        settings.max_evaluations = node["max_evaluations"].integer(1).value_or(settings.max_evaluations);
        settings.tolerance = node["tolerance"].number({0, 1, true}).value_or(settings.tolerance);
        settings.keep_sides = node["keep_sides"].boolean().value_or(settings.keep_sides);
        return node["clearance_margin"].length(to_si(1, file_.length_unit), core::files::not_negative).value_or(default_margin);
    }

    // A design may come from anybody: it does not choose where else its results are written.
    std::string read_output(const JsonNode& node) const {
        const std::string name = node.string().value_or("");
        if (name.empty()) return {};
        if (const std::string fault = core::base::name_fault(name); !fault.empty())
            node.fail(ErrorCode::out_of_range, "the folder's name " + fault);
        std::error_code ignored;
        const fs::path folder = fs::path(file_.path).parent_path(), output = folder / name;
        const auto whole = [&](const fs::path& path) { return fs::weakly_canonical(fs::current_path(ignored) / path, ignored); };
        const fs::path below = whole(output).lexically_relative(whole(folder));
        if (below.empty() || *below.begin() == "..")
            node.fail(ErrorCode::out_of_range,
                      "found " + node.shown() +
                          ", which leads out of the design's own folder; `output` is a folder in it, and --out of the "
                          "command line any other");
        return output.string();
    }

    Errors all_errors() const {
        Errors errors = document_.errors();
        errors.insert(errors.end(), process_errors_.begin(), process_errors_.end());
        errors.insert(errors.end(), scene_errors_.begin(), scene_errors_.end());
        return errors;
    }

    JsonDocument& document_;
    const DesignReadOptions& options_;
    const std::map<std::string, std::string>& fixed_;
    std::map<std::string, std::string> default_variables_;
    std::vector<std::string> unused_variables_;
    std::optional<ChoiceReader> choices_;
    DesignFile file_;
    description::Design& design_ = file_.design;
    Errors scene_errors_;
    Errors process_errors_;  // of the caller's
    std::shared_ptr<std::vector<MadePart>> parts_ = options_.made ? options_.made : std::make_shared<std::vector<MadePart>>();
    std::vector<Remark> remarks_;
};

/// Reads a design as made, of whose scene's variables "*" of the tolerances gives those a deviation that can have one: some are used where
/// no parameter may be (a time step, a number of facets), or nowhere.
class DefaultVariables {
public:
    DefaultVariables(const std::string& text, const std::string& path, const DesignReadOptions& options)
        : text_(text), path_(path), options_(options) {
        if (!options_.made) options_.made = std::make_shared<std::vector<MadePart>>();  // for each reading
    }

    Result<DesignFile> read() {
        Result<DesignFile> file = read_once();
        if (!file && !variables_.empty()) {
            const std::vector<std::string> all = variables_;
            fix(all, "not tried yet");
            Result<DesignFile> without = read_once();
            if (!without) return without;
            for (const std::string& one : all) {
                fixed_.erase(one);
                if (!read_once()) fix({one}, "something follows from it that no deviation can change");
            }
            file = read_once();
        }
        if (file && !unused_.empty()) {
            fix(unused_, "nothing of the scene follows from it");
            file = read_once();
        }
        return file;
    }

private:
    void fix(const std::vector<std::string>& names, const std::string& why) {
        for (const std::string& name : names) fixed_[name] = why;
    }

    Result<DesignFile> read_once() {
        Result<JsonDocument> document = JsonDocument::parse(text_, path_);
        if (!document) return document.errors();
        DesignReader reader(*document, options_, fixed_);
        Result<DesignFile> file = reader.read();
        variables_.clear();
        for (const auto& [deviation, variable] : reader.default_variables()) variables_.push_back(variable);
        unused_ = reader.unused_variables();
        return file;
    }

    const std::string& text_;
    const std::string& path_;
    DesignReadOptions options_;
    std::map<std::string, std::string> fixed_;
    std::vector<std::string> variables_, unused_;
};

}  // namespace

Result<DesignFile> parse_design(const std::string& text, const std::string& path, const DesignReadOptions& options) {
    Result<JsonDocument> document = JsonDocument::parse(text, path);
    if (!document) return document.errors();
    if (!is_design(*document)) {
        const JsonNode root = document->root();
        const bool scene = root.is_object() && (root["fettle_scene"].exists() || root["rigid_body_problem"].exists());
        return Error{scene ? ErrorCode::inconsistent : ErrorCode::missing_key, root.where(),
                     scene
                         ? "this is a scene, not a design: a design names it as its `scene`, and says what may change and what is wanted; "
                           "`fettle new` writes one to start from"
                         : "not a design: `fettle_design` (its version, 1) is not there" +
                               core::files::format_remark(root, {"fettle_scene", "fettle_design"})};
    }
    const core::base::ReadRecord record;
    DesignReadOptions drawn = options;
    if (!drawn.made) drawn.made = std::make_shared<std::vector<MadePart>>();
    Result<DesignFile> file = DefaultVariables(text, path, drawn).read();
    if (!file) return file;
    if (!drawn.as_made && description::asks_over_tolerances(file->design)) {
        DesignReadOptions again = drawn;
        again.as_made = true;
        Result<DesignFile> made = DefaultVariables(text, path, again).read();
        if (!made) return made.errors();
        file->design = description::over_tolerances(std::move(file->design), std::move(made->design), std::move(made->tolerances));
    }
    file->text = text;
    file->files = record.files();
    file->read_as = core::base::formatted("facets %d, steps %d, %s, process %s", options.resolution.facets, options.resolution.steps,
                                          options.as_made ? "as made" : "as drawn", options.process.c_str());
    return file;
}

Result<DesignFile> read_design(const std::string& path, const DesignReadOptions& options) {
    const Result<std::string> text = core::files::read_file(path);
    if (!text) return text.errors();
    return parse_design(*text, path, options);
}

bool is_design(JsonDocument& document) {
    const JsonNode root = document.root();
    return root.is_object() && root["fettle_design"].exists();
}

bool is_design_file(const std::string& path) {
    Result<JsonDocument> document = JsonDocument::read(path);
    return document && is_design(*document);
}

}  // namespace fettle::design::reading
