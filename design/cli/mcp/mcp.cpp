// SPDX-License-Identifier: MIT
/// fettle mcp: tools for agents, by the Model Context Protocol over stdin and stdout.
#include <filesystem>
#include <memory>

#include "design/cli/inputs.hpp"
#include "design/cli/mcp/server.hpp"

namespace fettle::design::cli::mcp {

namespace {

int run_mcp(const std::vector<std::string>& roots, const CommandLine& program, const CommonOptions& common, Console& console) {
    Errors errors;
    for (const std::string& root : roots)
        if (std::error_code ignored; !std::filesystem::is_directory(root, ignored))
            errors.push_back({ErrorCode::file_not_found, "--root", root + ": there is no such folder"});
    if (!errors.empty()) return console.input_errors(errors);
    ServerOptions options;
    options.roots = roots;
    options.program = program.facts();
    if (common.allow_programs) options.passed_on.emplace_back("--allow-programs");
    if (common.threads > 0) options.passed_on.push_back("--threads=" + std::to_string(common.threads));
    for (const std::string& folder : common.mesh_dirs) options.passed_on.push_back("--mesh-dir=" + folder);
    serve(options);
    return exit_done;
}

}  // namespace

Command add_mcp(CommandLine& program, const CommonOptions& common) {
    CommandLine app = program.command("mcp", "Serves tools for agents: the Model Context Protocol over stdin and stdout");
    auto roots = std::make_shared<std::vector<std::string>>();
    app.option("--root", *roots, "Folder that is open to the tools (can be given several times; default: those that the client states)")
        .one_value_each();
    app.closing_words(
        "Example:  fettle mcp --root examples     in a client's settings: command fettle, arguments mcp\n"
        "Files are read and written below the roots alone (a scene's own meshes and parts are read where it names them); programs that a\n"
        "scene names run with --allow-programs only.");
    return {app, [roots, program, &common](Console& console) { return run_mcp(*roots, program, common, console); }};
}

}  // namespace fettle::design::cli::mcp
