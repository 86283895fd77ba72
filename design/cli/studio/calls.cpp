// SPDX-License-Identifier: MIT
#include "design/cli/studio/calls.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>

#include "design/answers/answer_json.hpp"
#include "design/exports/base64.hpp"
#include "design/exports/export_files.hpp"
#include "design/session/news_json.hpp"

namespace fettle::design::cli::studio {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using session::Session;

constexpr int bad_request = 400, conflict = 409;

CallAnswer refusal(const Errors& errors, int status = bad_request) {
    std::string text;
    for (const Error& error : errors) text += (text.empty() ? "" : "; ") + (error.where.empty() ? "" : error.where + ": ") + error.message;
    return {status, {{"error", text}}};
}
CallAnswer refusal(const std::string& sentence) { return {bad_request, {{"error", sentence}}}; }

CallAnswer done(Json json = Json::object()) {
    Json answer{{"done", true}};
    answer.update(json);
    return {200, answer};
}

CallAnswer revision(const Result<std::uint64_t>& found) { return found ? done({{"revision", *found}}) : refusal(found.errors(), conflict); }

// A member of the call; nothing: it is not there, or null.
std::optional<Json> given(const Json& call, const char* name) {
    if (!call.contains(name) || call[name].is_null()) return std::nullopt;
    return call[name];
}

CallAnswer set(Session& session, const Json& call) {
    const auto values = given(call, "values");
    if (!values) return refusal("values: an object of numbers by parameter is expected");
    const Result<Session::Values> si = session::values_from(*values, *session.opened());
    if (!si) return refusal(si.errors());
    const Result<std::uint64_t> set = session.set(*si);
    return set ? done({{"revision", *set}}) : refusal(set.errors());
}

CallAnswer pull(Session& session, const Json& call) {
    const auto name = given(call, "requirement"), value = given(call, "value");
    if (!name || !name->is_string()) return refusal("requirement: a name is expected");
    if (!value || !value->is_number()) return refusal("value: a number is expected");
    const description::Design& design = session.opened()->design();
    const double unit = session::shown_unit_of(design, name->get<std::string>());
    const Result<Session::Pulled> pulled = session.pull(name->get<std::string>(), value->get<double>() * unit);
    if (!pulled) return refusal(pulled.errors(), conflict);
    return done({{"revision", pulled->revision},
                 {"values", answers::parameters_json(design, pulled->values)},
                 {"predicted", pulled->predicted / unit},
                 {"reached", pulled->reaches}});
}

CallAnswer tune(Session& session, const Json& call) {
    std::optional<int> most;
    if (const auto asked = given(call, "max_evaluations")) {
        if (!asked->is_number_integer() || asked->get<std::int64_t>() < 1 || asked->get<std::int64_t>() > 100'000)
            return refusal("max_evaluations: a whole number from 1 to 100000 is expected");
        most = asked->get<int>();
    }
    if (const Errors errors = session.tune(most); !errors.empty()) return refusal(errors, conflict);
    return done({{"command", "fettle optimise " + answers::shell_word(session.opened()->file.path)}});
}

// The file that is saved into: of meshes the scene that they make.
fs::path file_of(const session::Opened& opened) { return opened.is_scene ? opened.file.scene_path : opened.file.path; }
const char* ending_of(const session::Opened& opened) { return opened.is_scene ? ".scene.json" : ".design.json"; }

// A name in the folder of the session's file; nothing: it is none.
std::optional<fs::path> saved_file(const session::Opened& opened, const Json& as) {
    const fs::path own = file_of(opened);
    if (as.is_null()) return own;
    if (!as.is_string()) return std::nullopt;
    const std::string name = as.get<std::string>();
    const bool is_plain = !name.empty() && name.size() < 200 && name.front() != '.' && name.find_first_of("/\\") == std::string::npos &&
                          std::none_of(name.begin(), name.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; });
    if (!is_plain || !name.ends_with(ending_of(opened))) return std::nullopt;
    return own.parent_path() / name;
}

CallAnswer save(Session& session, const Json& call) {
    const std::shared_ptr<const session::Opened> opened = session.opened();
    const std::optional<fs::path> file = saved_file(*opened, given(call, "as").value_or(Json()));
    if (!file) return refusal(std::string("as: a file's name that ends in ") + ending_of(*opened) + " is expected, without a folder");
    const Result<Session::Saved> saved = session.save(file->string(), given(call, "replace").value_or(false) == true);
    if (!saved) return refusal(saved.errors());
    if (saved->is_there) return {conflict, {{"error", file->filename().string() + " is there already"}, {"exists", true}}};
    return done(
        {{"file", saved->file}, {"command", (opened->is_scene ? "fettle simulate " : "fettle check ") + answers::shell_word(saved->file)}});
}

CallAnswer export_parts(Session& session, const Json& call, const std::shared_ptr<const problem::DesignEvaluation>& evaluation) {
    const auto what = given(call, "what");
    if (!what || !what->is_string()) return refusal("what: \"3mf\", \"stl\", \"glb\" or \"design\" is expected");
    const std::string format = what->get<std::string>();
    const fs::path own = session.opened()->file.path;
    const std::string stem = own.filename().string().substr(0, own.filename().string().find('.'));
    const std::string command = "fettle export " + answers::shell_word(own.string()) + " --to " + answers::shell_word(stem + "." + format);
    if (format == "design") {
        const Result<std::string> text = session.text(own.parent_path().string());
        if (!text) return refusal(text.errors());
        return done({{"name", own.filename().string()}, {"base64", exports::base64(*text)}});
    }
    constexpr std::array formats{exports::Format::threemf, exports::Format::stl, exports::Format::glb};
    constexpr std::array<const char*, formats.size()> names{"3mf", "stl", "glb"};
    const auto found = std::find(names.begin(), names.end(), format);
    if (found == names.end()) return refusal("what: \"3mf\", \"stl\", \"glb\" or \"design\" is expected");
    if (evaluation == nullptr || evaluation->runs.empty() || evaluation->runs.front().model == nullptr)
        return {conflict, {{"error", "nothing has been simulated yet"}}};
    const problem::Run& run = evaluation->runs.front();
    exports::Assembly assembly = exports::assembly_of(*run.model, run.simulation.trajectory);
    const bool prints = format != "glb";
    Json answer;
    const auto sink = [&](const std::string& name, const std::string& bytes) {
        answer = {{"name", name}, {"base64", exports::base64(bytes)}, {"command", prints ? command + " --arrange plate" : command}};
        return Errors{};
    };
    exports::ExportOptions options;
    if (prints) options.arrangement = exports::Arrangement::plate;
    const Errors errors = exports::export_files(assembly, formats[static_cast<std::size_t>(found - names.begin())], options, stem, sink);
    return errors.empty() ? done(answer) : refusal(errors);
}

CallAnswer pose(const Json& call, const std::shared_ptr<const problem::DesignEvaluation>& evaluation) {
    if (evaluation == nullptr || evaluation->runs.empty() || evaluation->runs.front().model == nullptr)
        return {conflict, {{"error", "nothing has been simulated yet"}}};
    const auto joints = given(call, "joints");
    if (!joints || !joints->is_object()) return refusal("joints: an object of numbers by joint is expected");
    const Result<session::Posing> posing = session::Posing::of(evaluation->runs.front().model);
    if (!posing) return refusal(posing.errors(), conflict);
    std::map<std::string, double> at;
    for (const auto& [name, value] : joints->items()) {
        if (!value.is_number()) return refusal(name + ": a number is expected");
        at[name] = value.get<double>();
        for (const session::JointHandle& handle : posing->handles())
            if (handle.name == name) at[name] *= session::unit_of(handle);
    }
    const Result<session::Posed> posed = posing->at(at, given(call, "depth").value_or(true) != false);
    if (!posed) return refusal(posed.errors());
    return done(session::posed_json(*posed, *evaluation->runs.front().model));
}

}  // namespace

CallAnswer answer_call(Session& session, const Json& call, const std::shared_ptr<const problem::DesignEvaluation>& evaluation) {
    const auto asked = call.is_object() ? given(call, "do") : std::nullopt;
    const std::string what = asked && asked->is_string() ? asked->get<std::string>() : "";
    if (what == "set") return set(session, call);
    if (what == "undo") return revision(session.undo());
    if (what == "redo") return revision(session.redo());
    if (what == "reset") return revision(session.reset());
    if (what == "pull") return pull(session, call);
    if (what == "tune") return tune(session, call);
    if (what == "save") return save(session, call);
    if (what == "pose") return pose(call, evaluation);
    if (what == "export") return export_parts(session, call, evaluation);
    if (what == "stop") {
        session.stop();
        return done();
    }
    return refusal("do: set, undo, redo, reset, pull, tune, stop, save, export or pose is expected");
}

}  // namespace fettle::design::cli::studio
