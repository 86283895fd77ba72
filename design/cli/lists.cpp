// SPDX-License-Identifier: MIT
/// fettle shapes, quantities, joints, optimisers: what there is, from the tables that the readers themselves use.
#include <algorithm>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>

#include "core/base/text.hpp"
#include "core/clearance/clearance.hpp"
#include "core/files/atomic_file.hpp"
#include "core/files/nearest_word.hpp"
#include "core/geometry/named_faces.hpp"
#include "core/scene/joint_kind.hpp"
#include "core/setup/build_model.hpp"
#include "design/cli/answers.hpp"
#include "design/cli/command.hpp"
#include "design/exports/picture.hpp"
#include "design/exports/png_writer.hpp"
#include "design/exports/svg_writer.hpp"
#include "design/optimisers/optimisation.hpp"
#include "design/reading/quantity_reader.hpp"
#include "design/shapes/file_part.hpp"
#include "design/shapes/part_library.hpp"

namespace fettle::design::cli {

namespace {

using Json = nlohmann::ordered_json;

/// One entry of a list: `facts` has all of it, `line` is for people; `details` is shown where its name was asked for.
struct Entry {
    std::string name, line, details;
    Json facts;
};

int answer(const std::string& what, const std::vector<Entry>& entries, const std::string& name, Console& console) {
    Json list = Json::array();
    std::string text;
    std::size_t width = 0;
    std::vector<std::string_view> names;
    for (const Entry& entry : entries) {
        width = std::max(width, entry.name.size());
        names.push_back(entry.name);
    }
    for (const Entry& entry : entries) {
        if (!name.empty() && entry.name != name) continue;
        list.push_back(entry.facts);
        text += entry.name + std::string(width - entry.name.size() + 2, ' ') + entry.line + "\n" + (name.empty() ? "" : entry.details);
    }
    if (list.empty())
        return console.input_errors({{ErrorCode::unknown_key, name,
                                      "there is none of this name among the " + what + "; " + core::files::did_you_mean(name, names)}});
    console.result({{"status", "ok"}, {what, std::move(list)}}, text);
    return exit_done;
}

// The names in a formula or comparison.
std::set<std::string> names_in(const std::string& formula) {
    static const std::regex name("[A-Za-z_][A-Za-z_0-9]*");
    return {std::sregex_token_iterator(formula.begin(), formula.end(), name), std::sregex_token_iterator()};
}

struct PartVariable {
    std::string name, formula, about;
};

// The file's variables that the relations are made of, also by way of others, in its order.
// @param text  of the file. Contract: it has been read as a part.
std::vector<PartVariable> relation_variables(const std::string& text, const core::part_files::PartFile& part) {
    const Json file = Json::parse(text, nullptr, false, true);
    if (!file.is_object() || !file.contains("variables")) return {};
    const Json& variables = file.at("variables");
    std::set<std::string> used;
    std::vector<std::string> open;
    for (const core::part_files::PartRelation& relation : part.relations()) open.push_back(relation.check);
    while (!open.empty()) {
        const std::set<std::string> names = names_in(open.back());
        open.pop_back();
        for (const std::string& name : names)
            if (variables.contains(name) && variables.at(name).is_string() && used.insert(name).second)
                open.push_back(variables.at(name).get<std::string>());
    }
    std::vector<PartVariable> list;
    for (const auto& [name, formula] : variables.items()) {
        if (used.count(name) == 0) continue;
        const Json about = variables.value("# " + name, Json(""));
        list.push_back({name, formula.get<std::string>(), about.is_string() ? about.get<std::string>() : ""});
    }
    return list;
}

// @param text  of its file
Entry part_entry(const core::part_files::PartFile& part, const std::string& text) {
    using core::part_files::PartDimensionKind;
    Entry entry{part.name(), part.about(), "", {{"name", part.name()}, {"description", part.about()}}};
    entry.facts["dimensions"] = Json::array();
    for (const core::part_files::PartDimension& d : part.dimensions()) {
        const std::string kind = core::part_files::name_of(d.kind);
        entry.facts["dimensions"].push_back({{"name", d.name}, {"default", d.value}, {"kind", kind}, {"meaning", d.about}});
        const auto quantity = core::expression::powers_of(core::part_files::dimension_of(d.kind));
        entry.details += formatted("  %-26s %12s  %s%s\n", d.name.c_str(), core::part_files::shown(d.value, quantity).c_str(),
                                   d.about.c_str(), d.kind == PartDimensionKind::coordinate ? " (any sign)" : "");
    }
    entry.facts["counts"] = Json::array();
    for (const core::part_files::PartCount& c : part.counts()) {
        entry.facts["counts"].push_back(
            {{"name", c.name}, {"default", c.value}, {"least", c.least}, {"most", c.most}, {"meaning", c.about}});
        entry.details += formatted("  %-26s %12d  %s (%d to %d)\n", c.name.c_str(), c.value, c.about.c_str(), c.least, c.most);
    }
    entry.facts["relations"] = Json::array();
    for (const core::part_files::PartRelation& relation : part.relations()) {
        entry.facts["relations"].push_back({{"check", relation.check}, {"or", relation.otherwise}});
        entry.details += "  " + relation.check + (relation.otherwise.empty() ? "" : ", or " + relation.otherwise) + "\n";
    }
    entry.facts["variables"] = Json::array();
    for (const PartVariable& variable : relation_variables(text, part)) {
        if (entry.facts["variables"].empty()) entry.details += "  where\n";
        entry.facts["variables"].push_back({{"name", variable.name}, {"formula", variable.formula}, {"meaning", variable.about}});
        entry.details +=
            "    " + variable.name + " " + variable.formula + (variable.about.empty() ? "" : "  (" + variable.about + ")") + "\n";
    }
    return entry;
}

/// What its faces are called, as clearances between faces name them.
void add_faces(const std::string& name, Entry& entry) {
    const auto part = shapes::FilePart::create(name);
    const auto mesh = part ? description::drawn_mesh(**part) : Result<core::geometry::Mesh>(part.errors());
    if (!mesh) return;  // at its defaults it cannot be drawn; --draw says why
    const std::vector<std::string> names = core::geometry::names_of_faces(*mesh);
    entry.facts["faces"] = names;
    if (!names.empty()) entry.details += "  faces: " + core::base::joined(names) + "\n";
}

/// At its defaults, seen obliquely.
Errors draw_shape(const std::string& name, const std::string& file) {
    const auto part = shapes::FilePart::create(name);
    if (!part) return part.errors();
    const auto mesh = description::drawn_mesh(**part);
    if (!mesh) return mesh.errors();
    const bool png = file.ends_with(".png");
    if (!png && !file.ends_with(".svg")) return {{ErrorCode::unsupported, "--draw", "a picture is .png or .svg, found " + file}};
    exports::Assembly assembly;
    assembly.parts.push_back({name, exports::part_colour(0), *mesh, Vector3::Zero(), false});
    assembly.keyframes.push_back({0, true, {core::kinematics::Pose{}}});
    exports::PictureOptions options;
    options.view = exports::projection_view("iso", Vector3::UnitZ(), "").value();
    options.width = 900;
    options.height = 700;
    options.title = name + ", default dimensions";
    const exports::Picture picture = exports::draw_picture(assembly, assembly.keyframes.front().poses, options);
    return core::files::write_file_atomically(file, png ? exports::png_bytes(picture) : exports::svg_text(picture));
}

struct ShapesArguments {
    std::string name, draw;
};

int run_shapes(const ShapesArguments& options, Console& console) {
    std::vector<Entry> entries;
    for (const shapes::LibraryPart& each : shapes::part_library())
        entries.push_back(part_entry(shapes::find_part(std::string(each.name)).value(), std::string(each.text)));
    if (options.name.ends_with(core::part_files::part_file_ending)) {
        const auto part = shapes::find_part(options.name);
        if (!part) return console.input_errors(part.errors());
        const Result<std::string> text = core::files::read_file(options.name);
        if (!text) return console.input_errors(text.errors());
        entries = {part_entry(*part, *text)};
        entries.front().name = options.name;
    }
    bool known = false;
    for (Entry& entry : entries) {
        if (entry.name != options.name) continue;
        known = true;
        add_faces(options.name, entry);
    }
    if (!options.draw.empty() && options.name.empty())
        return console.input_errors({{ErrorCode::missing_key, "--draw", "which shape? fettle shapes NAME --draw " + options.draw}});
    if (!options.draw.empty() && known) {
        const Errors errors = draw_shape(options.name, options.draw);
        if (!errors.empty()) return console.input_errors(errors);
    }
    return answer("shapes", entries, options.name, console);
}

int run_quantities(const std::string& name, Console& console) {
    std::vector<Entry> entries;
    for (const reading::QuantityType& type : reading::quantity_table()) {
        const std::vector<std::string> keys(type.keys.begin(), type.keys.end());
        const std::string meaning(type.meaning), unit(type.unit), own(type.name);
        entries.push_back({own,
                           meaning + " [" + unit + "]",
                           "  keys: " + core::base::joined(keys) + "\n",
                           {{"name", own}, {"keys", keys}, {"unit", unit}, {"meaning", meaning}}});
    }
    return answer("quantities", entries, name, console);
}

int run_joints(const std::string& name, Console& console) {
    std::vector<Entry> entries;
    for (const core::scene::JointKindInfo& info : core::scene::joint_kinds()) {
        const std::vector<std::string> keys(info.keys.begin(), info.keys.end());
        const std::string meaning(info.meaning), own(info.name), coordinate(info.coordinate);
        std::string details = "  keys: " + core::base::joined(keys) + "\n";
        if (!coordinate.empty())
            details += "  its " + coordinate + " takes stiffness, rest, preload, damping, friction, limits, and motors\n";
        entries.push_back({own,
                           meaning,
                           details,
                           {{"name", own},
                            {"meaning", meaning},
                            {"freedoms", info.freedoms},
                            {"coordinate", coordinate.empty() ? Json() : Json(coordinate)},
                            {"keys", keys}}});
    }
    return answer("joints", entries, name, console);
}

int run_optimisers(const std::string& name, Console& console) {
    std::vector<Entry> entries;
    for (const optimisers::OptimiserInfo& info : optimisers::optimiser_table())
        entries.push_back({info.name, info.description, "", {{"name", info.name}, {"description", info.description}}});
    return answer("optimisers", entries, name, console);
}

Command add_list(CommandLine& program, const std::string& command, const std::string& description, const std::string& example,
                 int (*run)(const std::string&, Console&)) {
    CommandLine app = program.command(command, description);
    auto name = std::make_shared<std::string>();
    app.option("NAME", *name, "One of them, in full (default: all)");
    app.closing_words("Example:  fettle " + command + " " + example);
    return {app, [name, run](Console& console) { return run(*name, console); }};
}

}  // namespace

Command add_shapes(CommandLine& program) {
    CommandLine app = program.command("shapes", "Parts of the library: dimensions, defaults, relations, a drawing");
    auto options = std::make_shared<ShapesArguments>();
    app.option("NAME", options->name, "One of them, or a file of your own (NAME.part.json), with all its dimensions (default: all)");
    app.option("--draw", options->draw, "Draw it at its defaults: .png or .svg");
    app.closing_words("Example:  fettle shapes geneva_wheel --draw wheel.svg");
    return {app, [options](Console& console) { return run_shapes(*options, console); }};
}

Command add_quantities(CommandLine& program) {
    return add_list(program, "quantities", "Lists what an objective can sum and a constraint can bound", "stroke", run_quantities);
}

Command add_joints(CommandLine& program) {
    return add_list(program, "joints", "Lists the kinds of joint that a scene can have", "revolute", run_joints);
}

Command add_optimisers(CommandLine& program) {
    return add_list(program, "optimisers", "Lists the optimisers that a design can name", "sqp", run_optimisers);
}

}  // namespace fettle::design::cli
