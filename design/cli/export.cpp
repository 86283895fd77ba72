// SPDX-License-Identifier: MIT
/// fettle export FILE --to FILE|FOLDER: parts and their motion for other programs. What is in the files: design/exports/export_files.hpp.
#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/files/atomic_file.hpp"
#include "core/files/hash.hpp"
#include "core/files/unique_names.hpp"
#include "core/records/geometry_hash.hpp"
#include "core/records/path_hash.hpp"
#include "core/records/poses_file.hpp"
#include "design/answers/answer_json.hpp"
#include "design/answers/output_folder.hpp"
#include "design/clearance/certificate_files.hpp"
#include "design/cli/answers.hpp"
#include "design/cli/export_mechanism.hpp"
#include "design/cli/inputs.hpp"
#include "design/cli/read_files.hpp"
#include "design/cli/shown_motion.hpp"
#include "design/exports/export_files.hpp"
#include "design/exports/profile_drawing.hpp"
#include "design/reading/design_reader.hpp"
#include "design/reading/scene_shapes.hpp"
#include "design/shapes/file_part.hpp"

namespace fettle::design::cli {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using exports::Format;

constexpr const char* csv = "csv";

struct ExportArguments {
    ShownOptions shown;
    std::string to, formats, arrange = "assembled";
    int every = 1;
    bool in_place = false;

    bool separate() const { return arrange == "parts" || arrange == "separate"; }
};

/// Where the files go, which, and what they are called.
struct Plan {
    fs::path folder;
    std::string stem;
    std::vector<std::string> formats;  ///< of format_names(), and "csv"
    bool one_file = false;             ///< --to names a file
};

std::vector<std::string> all_formats() {
    std::vector<std::string> names = exports::format_names();
    names.push_back(csv);
    return names;
}

Result<std::vector<std::string>> wanted_formats(const std::string& text) {
    const std::vector<std::string> known = all_formats();
    if (text.empty()) return known;
    std::vector<std::string> wanted;
    for (std::size_t at = 0; at <= text.size();) {
        const std::size_t comma = std::min(text.find(',', at), text.size());
        wanted.push_back(text.substr(at, comma - at));
        at = comma + 1;
        if (std::find(known.begin(), known.end(), wanted.back()) != known.end()) continue;
        return Error{ErrorCode::out_of_range, "--format",
                     "`" + wanted.back() + "` is not a format; known are glb, 3mf, stl, obj, vtu, csv; dxf or svg alone"};
    }
    return wanted;
}

Result<Plan> plan_of(const ExportArguments& options, const std::string& stem) {
    Plan plan;
    const fs::path to = options.to;
    std::string extension = to.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(), [](unsigned char c) { return std::tolower(c); });
    const std::vector<std::string> known = all_formats();
    const std::string name = extension == ".pvd" ? "vtu" : extension.substr(extension.empty() ? 0 : 1);
    plan.one_file = std::find(known.begin(), known.end(), name) != known.end() && !fs::is_directory(to);
    if (!plan.one_file && !extension.empty() && !fs::exists(to))
        return Error{
            ErrorCode::unsupported, "--to",
            "`" + extension +
                "` is not a format; known are .glb .3mf .stl .obj .vtu .pvd .csv .urdf .scene.json .dxf .svg (a folder's name ends in /)"};
    if (!plan.one_file) {
        const auto formats = wanted_formats(options.formats);
        if (!formats) return formats.errors();
        return Plan{to, stem, *formats, false};
    }
    if (!options.formats.empty())
        return Error{ErrorCode::inconsistent, "--format", "the name given by --to says the format; --format goes with a folder"};
    if (options.separate() && name != "glb" && name != "vtu" && name != csv)
        return Error{ErrorCode::inconsistent, "--arrange", "a file for each part needs a folder: --to FOLDER --format " + name};
    plan.folder = to.has_parent_path() ? to.parent_path() : ".";
    plan.stem = to.stem().string();
    plan.formats = {name};
    return plan;
}

/// Files of the bodies' meshes, which a certificate can name.
bool has_meshes_alone(const std::string& format) { return format == "3mf" || format == "stl" || format == "obj"; }

/// Errors where parts cannot be arranged: only those of files that hold meshes alone can.
Errors arrange_errors(const ExportArguments& options) {
    if (options.arrange == "assembled") return {};
    const Result<Plan> plan = plan_of(options, "");
    if (!plan) return plan.errors();
    if (std::any_of(plan->formats.begin(), plan->formats.end(), has_meshes_alone)) return {};
    return {{ErrorCode::inconsistent, "--arrange", "is for 3mf, stl and obj: other formats have the parts where they are"}};
}

/// The time series: poses at the ends of the steps, and of a run's folder its tables.
Errors export_series(const ShownMotion& shown, const Plan& plan, const exports::FileSink& sink) {
    const std::string name = plan.one_file ? plan.stem + ".csv" : "poses.csv";
    const fs::path temporary = plan.folder / name;
    core::model::Model model = shown.subject.model;
    core::stepper::Trajectory path = shown.subject.domain.path();
    model.bodies = only(shown.bodies, model.bodies);
    for (auto& poses : path.poses) poses = only(shown.bodies, poses);
    Errors errors = core::records::write_poses(temporary, path, model, answers::unit_name(shown.subject.model.length_unit));
    if (!errors.empty()) return errors;
    const Result<std::string> written = core::files::read_file(temporary);
    if (!written) return written.errors();
    errors = sink(name, *written);
    if (plan.one_file) return errors;
    if (shown.bodies.size() < shown.subject.model.bodies.size()) return errors;  // the tables are about all
    for (const char* table : {"steps.csv", "contacts.csv", "drives.csv", "joints.csv"}) {
        const fs::path from = fs::path(shown.file).parent_path() / table;
        std::error_code code;
        const bool own = shown.subject.source == clearance::SubjectSource::trajectory && fs::exists(from, code);
        if (!errors.empty() || !own || fs::equivalent(from.parent_path(), plan.folder, code)) continue;
        const Result<std::string> text = core::files::read_file(from);
        errors = text ? sink(table, *text) : text.errors();
    }
    return errors;
}

/// Writes into the certificate which files were made of its bodies. Errors: it is about another path or other bodies.
Errors name_in_certificate(const ShownMotion& shown, const std::vector<std::pair<std::string, double>>& files) {
    auto certificate = core::certificate::read_certificate(shown.certificate);
    if (!certificate) return certificate.errors();
    if (certificate->geometry_hash != core::records::geometry_hash(shown.subject.model) ||
        certificate->path_hash != core::records::path_hash(shown.subject.domain.path()))
        return {{ErrorCode::inconsistent, shown.certificate, "is not about the bodies and the path of " + shown.file}};
    for (const auto& [file, rounding] : files) {
        auto named = clearance::named_files({file}, shown.certificate);
        if (!named) return named.errors();
        named->front().rounding = rounding;
        std::erase_if(certificate->exports, [&](const auto& exported) { return exported.file == named->front().file; });
        certificate->exports.push_back(named->front());
    }
    return core::certificate::write_certificate(shown.certificate, *certificate);
}

/// Plane figures of parts that part files describe.
bool is_profile_format(const std::string& format) { return format == "dxf" || format == "svg"; }

std::string profile_format(const ExportArguments& options) {
    const std::string extension = fs::path(options.to).extension().string();
    if (extension == ".dxf" || extension == ".svg") return extension.substr(1);
    return is_profile_format(options.formats) ? options.formats : "";
}

/// A body of a part file, with the values of its dimensions.
struct DrawnBody {
    std::string name;
    std::shared_ptr<const shapes::FilePart> part;
};

Result<std::vector<DrawnBody>> drawn_bodies(const ExportArguments& options, const CommonOptions& common) {
    std::vector<DrawnBody> out;
    const auto take = [&](const std::string& name, const std::shared_ptr<const description::Shape>& shape) {
        if (auto part = std::dynamic_pointer_cast<const shapes::FilePart>(shape)) out.push_back({name, std::move(part)});
    };
    if (file_kind(options.shown.path) == reading::FileKind::design) {
        const auto file = reading::read_design(options.shown.path, {common.mesh_dirs, programs_of(common)});
        if (!file) return file.errors();
        for (std::size_t i = 0; i < file->design.shapes.size(); ++i) take(file->design.scene.bodies[i].name, file->design.shapes[i]);
        return out;
    }
    if (const Errors errors = reading::not_wanted(options.shown.path, file_kind(options.shown.path), "scene"); !errors.empty())
        return errors;
    const auto made = std::make_shared<std::vector<reading::MadePart>>();
    const auto scene =
        reading::read_scene_or_part(options.shown.path, reading::scene_read_options(common.mesh_dirs, programs_of(common), made));
    if (!scene) return scene.errors();
    for (const core::scene::Body& body : scene->bodies)
        for (const reading::MadePart& part : *made)
            if (body.shape && *body.shape == part.spec) take(body.name, part.shape);
    return out;
}

/// A file for each profile of each body; of one profile alone the file that --to names.
int run_export_profiles(const ExportArguments& options, const CommonOptions& common, Console& console) {
    const std::string format = profile_format(options);
    auto bodies = drawn_bodies(options, common);
    if (!bodies) return console.input_errors(bodies.errors());
    std::vector<std::string> body_names;
    for (const DrawnBody& body : *bodies) body_names.push_back(body.name);
    const auto shown = shown_bodies(options.shown.bodies, body_names);
    if (!shown) return console.input_errors(shown.errors());
    *bodies = only(*shown, *bodies);
    std::vector<std::pair<std::string, std::string>> drawings;  // file names, texts
    core::files::UniqueNames names("_", true);
    for (const DrawnBody& body : *bodies) {
        const std::vector<double> values = description::drawn_values(*body.part);
        for (const std::string& profile : body.part->file().profile_names()) {
            const Errors errors = body.part->file().with_profile(profile, values, [&](const core::parts::Profile& figure) {
                const std::string stem = names.unique(core::files::file_stem(body.name + "." + profile));
                drawings.emplace_back(stem + "." + format, format == "dxf" ? exports::profile_dxf(figure) : exports::profile_svg(figure));
            });
            if (!errors.empty()) return console.input_errors(errors);
        }
    }
    if (drawings.empty())
        return console.input_errors(
            {{ErrorCode::unsupported, options.shown.path,
              "no body has profiles: those are of parts that part files describe (`\"part\"` in a body's `shape`)"}});
    const bool one_file = fs::path(options.to).extension() == "." + format;
    if (one_file && drawings.size() > 1) {
        std::string known;
        for (const auto& [name, text] : drawings) known += (known.empty() ? "" : ", ") + name;
        return console.input_errors(
            {{ErrorCode::inconsistent, "--to",
              "there are " + std::to_string(drawings.size()) + " profiles (" + known + "); name a folder, with --format " + format}});
    }
    const fs::path folder =
        one_file ? (fs::path(options.to).has_parent_path() ? fs::path(options.to).parent_path() : fs::path(".")) : fs::path(options.to);
    if (const Errors errors = answers::try_output_folder(folder); !errors.empty()) return console.input_errors(errors);
    std::vector<std::pair<fs::path, std::string>> files;
    for (const auto& [name, bytes] : drawings) files.emplace_back(one_file ? fs::path(options.to) : folder / name, bytes);
    return leave_files(files, format, {}, common, console);
}

int run_export(const ExportArguments& options, const CommonOptions& common, Console& console) {
    if (!profile_format(options).empty()) return run_export_profiles(options, common, console);
    const bool as_robot = options.to.ends_with(".urdf"), as_scene = options.to.ends_with(".scene.json");
    if ((as_robot || as_scene) && !options.shown.bodies.empty())
        return console.input_errors({{ErrorCode::unsupported, "--bodies", "a mechanism is written whole: its joints need their bodies"}});
    if (as_robot) return export_robot(options.shown.path, options.to, common, console);
    if (as_scene) return export_scene(options.shown.path, options.to, common, console);
    if (options.in_place && !options.separate())
        return console.input_errors({{ErrorCode::inconsistent, "--in-place", "needs --arrange separate: a file for each part"}});
    if (const Errors errors = arrange_errors(options); !errors.empty()) return console.input_errors(errors);
    Result<ShownMotion> shown = load_shown(options.shown, common, console);
    if (!shown) return console.input_errors(shown.errors());
    const Result<Plan> plan = plan_of(options, shown->stem);
    if (!plan) return console.input_errors(plan.errors());
    Errors unwritable = answers::try_output_folder(plan->folder);
    for (Error& error : unwritable) error.where = options.to;
    if (!unwritable.empty()) return console.input_errors(unwritable);
    exports::ExportOptions how;
    const auto& arrangements = exports::arrangement_names();
    const std::string arrange = options.separate() ? "parts" : options.arrange;
    how.arrangement =
        static_cast<exports::Arrangement>(std::find(arrangements.begin(), arrangements.end(), arrange) - arrangements.begin());
    how.in_place = options.in_place;
    how.every = options.every;
    Json files = Json::array();
    std::vector<std::pair<std::string, double>> of_meshes;  // and their rounding
    std::string text, format;
    double rounding = 0;
    core::files::FilesTogether together;
    std::vector<NamedFile> written;
    const exports::FileSink sink = [&](const std::string& name, const std::string& bytes) -> Errors {
        const std::string path = (plan->folder / name).string();
        files.push_back({{"file", path}, {"format", format}, {"bytes", bytes.size()}, {"hash", core::files::hash_of(bytes)}});
        text += formatted("%s  %zu bytes\n", path.c_str(), bytes.size());
        written.push_back({"--to", path, true});
        if (has_meshes_alone(format) && !name.ends_with(".mtl")) of_meshes.emplace_back(path, rounding);
        return together.add(plan->folder / name, bytes);
    };
    for (const std::string& each : plan->formats) {
        format = each;
        Errors errors;
        if (each == csv) {
            errors = export_series(*shown, *plan, sink);
        } else {
            const auto& names = exports::format_names();
            const auto kind = static_cast<Format>(std::find(names.begin(), names.end(), each) - names.begin());
            rounding = has_meshes_alone(each) ? exports::export_rounding(shown->assembly, kind) : 0;
            errors = exports::export_files(shown->assembly, kind, how, plan->stem, sink);
        }
        if (!errors.empty()) return console.input_errors(errors);
    }
    if (const Errors errors = replaced_inputs(written, common.given); !errors.empty()) return console.input_errors(errors);
    if (const Errors errors = together.take_names(); !errors.empty()) return console.input_errors(errors);
    if (!shown->certificate.empty() && !of_meshes.empty()) {
        const Errors errors = name_in_certificate(*shown, of_meshes);
        if (!errors.empty()) return console.input_errors(errors);
        text += shown->certificate + " names these files of meshes: fettle validate says when one has changed\n";
    }
    Json json{{"status", "ok"}, {"files", std::move(files)}};
    if (!shown->certificate.empty()) json["certificate"] = shown->certificate;
    console.result(json, text);
    return exit_done;
}

}  // namespace

Command add_export(CommandLine& program, const CommonOptions& common) {
    CommandLine app =
        program.command("export", "Writes parts and their motion for other programs: glb, 3mf, stl, obj, vtu, csv, urdf, scene, dxf, svg");
    auto options = std::make_shared<ExportArguments>();
    add_shown_options(app, options->shown);
    app.option("--to", options->to,
               "File, whose extension says the format (.pvd, .vtu: ParaView; .urdf: a scene or design; .scene.json: a design), or folder")
        .required();
    app.option("--format", options->formats, "For a folder: which formats, with commas (default: glb,3mf,stl,obj,vtu,csv)");
    app.option("--arrange", options->arrange,
               "3mf, stl, obj: assembled (default), plate (side by side for printing), separate or parts (a file each, in its own frame)")
        .one_of({"assembled", "plate", "parts", "separate"});
    app.flag("--in-place", options->in_place, "With --arrange separate: each part where it stands in the assembly");
    app.option("--every", options->every, "vtu: a frame for every so many steps (default 1)").at_least(1);
    app.closing_words(
        "Lengths: millimetres in 3mf, stl and obj, metres and Y up in glb, metres in vtu. An exported certificate then names\n"
        "these files, and fettle validate says \"stale\" when one has changed.\n"
        "Example:  fettle export out --to out/motion.glb                       a run's folder: animated\n"
        "          fettle export fit.certificate.json --to print.3mf --arrange plate --bodies pin,plate\n"
        "          fettle export SCENE --to parts --format stl --arrange separate --in-place   for a check by fettle clearance parts "
        "--unit mm");
    return {app, [options, &common](Console& console) { return run_export(*options, common, console); }};
}

}  // namespace fettle::design::cli
