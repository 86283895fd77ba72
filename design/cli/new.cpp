// SPDX-License-Identifier: MIT
/// fettle new NAME: a scene, and a design where there is one, to start from.
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/files/atomic_file.hpp"
#include "core/files/nearest_word.hpp"
#include "design/cli/command.hpp"
#include "design/cli/starters.hpp"

namespace fettle::design::cli {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct NewArguments {
    std::string name, folder = ".";
};

/// Up to the first sentence's end.
std::string first_sentence(const std::string& text) { return text.substr(0, std::min(text.find(". "), text.size() - 1) + 1); }

int list_starters(Console& console) {
    Json list = Json::array();
    std::string text;
    for (const Starter& starter : starters()) {
        list.push_back({{"name", starter.name}, {"description", starter.description}});
        text += starter.name + std::string(starter.name.size() < 14 ? 14 - starter.name.size() : 1, ' ') +
                first_sentence(starter.description) + "\n";
    }
    console.result({{"status", "ok"}, {"starters", std::move(list)}}, text);
    return exit_done;
}

std::string next_commands(const std::vector<std::string>& written) {
    const std::string& last = written.back();
    const std::string command = last.ends_with(".design.json") ? "fettle optimise " : "fettle simulate ";
    return "next: fettle validate " + last + "\n      fettle draw " + written.front() + " --out " + fs::path(last).stem().stem().string() +
           ".png\n      " + command + last + " --out out\n";
}

int run_new(const NewArguments& options, Console& console) {
    if (options.name.empty()) return list_starters(console);
    std::vector<std::string_view> names;
    const Starter* found = nullptr;
    for (const Starter& starter : starters()) {
        names.push_back(starter.name);
        if (starter.name == options.name) found = &starter;
    }
    if (found == nullptr)
        return console.input_errors({{ErrorCode::unknown_key, options.name,
                                      "there is nothing of this name to start from; " + core::files::did_you_mean(options.name, names)}});
    Errors errors;
    for (const auto& [name, text] : found->files) {
        const fs::path path = fs::path(options.folder) / name;
        std::error_code code;
        if (fs::exists(path, code))
            errors.push_back(
                {ErrorCode::inconsistent, path.string(), "is there already, and is left as it is; choose another folder: --in FOLDER"});
    }
    if (!errors.empty()) return console.input_errors(errors);
    std::vector<std::string> written;
    core::files::FilesTogether files;
    for (const auto& [name, text] : found->files) {
        const fs::path path = (fs::path(options.folder) / name).lexically_normal();
        if (errors.empty()) errors = files.add(path, text);
        written.push_back(path.string());
    }
    if (errors.empty()) errors = files.take_names();
    if (!errors.empty()) return console.input_errors(errors);
    std::string text;
    for (const std::string& path : written) text += path + "\n";
    console.result({{"status", "ok"}, {"files", written}}, text + next_commands(written));
    return exit_done;
}

}  // namespace

Command add_new(CommandLine& program) {
    CommandLine app = program.command("new", "Writes a commented scene and design to start from");
    auto options = std::make_shared<NewArguments>();
    app.option("NAME", options->name, "Which one (default: list them)");
    app.option("--in", options->folder, "Folder to write into (default: this one)");
    app.closing_words("Example:  fettle new hinge");
    return {app, [options](Console& console) { return run_new(*options, console); }};
}

}  // namespace fettle::design::cli
