// SPDX-License-Identifier: MIT
/// fettle manual --to FOLDER: manual pages (man 1 fettle, fettle-simulate, ...), made from the program's own help.
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/base/version.hpp"
#include "core/files/atomic_file.hpp"
#include "design/cli/command.hpp"

namespace fettle::design::cli {

namespace {

/// Text that troff takes as it stands.
std::string troff(const std::string& text) {
    std::string out;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if ((c == '.' || c == '\'') && (i == 0 || text[i - 1] == '\n')) out += "\\&";
        if (c == '\\') {
            out += "\\e";
        } else if (c == '-') {
            out += "\\-";
        } else {
            out += c;
        }
    }
    return out;
}

std::string heading(const std::string& page, const std::string& description) {
    std::string upper = page;
    for (char& c : upper) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    return ".TH " + upper + " 1 \"\" \"fettle " + core::base::version() + "\"\n.SH NAME\n" + troff(page) + " \\- " + troff(description) +
           "\n";
}

std::string option_text(const OptionFacts& option) {
    std::string names;
    for (const std::string& name : option.names) names += (names.empty() ? "" : ", ") + name;
    const std::string value = option.value.empty() || option.by_place ? "" : " \\fI" + troff(option.value) + "\\fR";
    return ".TP\n\\fB" + troff(names) + "\\fR" + value + "\n" + troff(option.description) + "\n";
}

std::string options_text(const CommandFacts& command) {
    std::string out;
    for (const OptionFacts& option : command.options) out += option_text(option);
    return out.empty() ? "" : ".SH OPTIONS\n" + out;
}

std::string closing(const CommandFacts& facts) {
    return facts.closing_words.empty() ? "" : ".SH NOTES\n.nf\n" + troff(facts.closing_words) + "\n.fi\n";
}

std::string program_page(const CommandFacts& program) {
    std::string out = heading("fettle", program.description) + ".SH SYNOPSIS\n.B fettle\n\\fICOMMAND\\fR [\\fIOPTIONS\\fR]\n";
    std::string group;
    for (const CommandFacts& command : program.commands) {
        if (command.group != group) out += ".SH " + troff(command.group) + "\n";
        group = command.group;
        out += ".TP\n\\fBfettle\\-" + troff(command.name) + "\\fR(1)\n" + troff(command.description) + "\n";
    }
    return out + options_text(program) + closing(program);
}

std::string command_page(const CommandFacts& command) {
    std::string places;
    for (const OptionFacts& option : command.options)
        if (option.by_place)
            places += option.required ? " \\fI" + troff(option.names.front()) + "\\fR" : " [\\fI" + troff(option.names.front()) + "\\fR]";
    return heading("fettle-" + command.name, command.description) + ".SH SYNOPSIS\n.B fettle " + troff(command.name) + "\n" +
           (places.empty() ? "" : places.substr(1) + " ") + "[\\fIOPTIONS\\fR]\n" + options_text(command) + closing(command) +
           ".SH SEE ALSO\n\\fBfettle\\fR(1)\n";
}

}  // namespace

Command add_manual(CommandLine& program) {
    CommandLine app = program.command("manual", "Writes manual pages: fettle.1, fettle-simulate.1, ...");
    auto folder = std::make_shared<std::string>();
    app.option("--to", *folder, "Folder, such as ~/.local/share/man/man1").required();
    app.closing_words("Example:  fettle manual --to ~/.local/share/man/man1 && man fettle");
    return {app, [folder, program](Console& console) {
                const CommandFacts facts = program.facts();
                std::vector<std::pair<std::string, std::string>> pages{{"fettle.1", program_page(facts)}};
                for (const CommandFacts& command : facts.commands)
                    pages.emplace_back("fettle-" + command.name + ".1", command_page(command));
                std::vector<std::string> written;
                core::files::FilesTogether files;
                Errors errors;
                for (const auto& [name, text] : pages) {
                    const std::filesystem::path path = std::filesystem::path(*folder) / name;
                    if (errors.empty()) errors = files.add(path, text);
                    written.push_back(path.string());
                }
                if (errors.empty()) errors = files.take_names();
                if (!errors.empty()) return console.input_errors(errors);
                console.result({{"status", "ok"}, {"files", written}}, std::to_string(written.size()) + " pages in " + *folder + "\n");
                return static_cast<int>(exit_done);
            }};
}

}  // namespace fettle::design::cli
