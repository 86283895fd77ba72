// SPDX-License-Identifier: MIT
/// fettle completion SHELL: what a shell needs to complete commands and options, made from the program's own options.
#include <nlohmann/json.hpp>

#include "design/cli/command.hpp"

namespace fettle::design::cli {

namespace {

std::string option_words(const CommandFacts& command) {
    std::string words;
    for (const OptionFacts& option : command.options) {
        if (option.by_place) continue;
        for (const std::string& name : option.names)
            if (name != "-h" && name != "--help") words += " " + name;
    }
    return words;
}

std::string command_words(const CommandFacts& program) {
    std::string words;
    for (const CommandFacts& command : program.commands) words += " " + command.name;
    return words;
}

/// Lines of `case "$command $previous"` that offer the known values of an option; where none fits, the shell offers files.
std::string value_cases(const CommandFacts& program) {
    std::string cases;
    for (const CommandFacts& command : program.commands) {
        for (const OptionFacts& option : command.options) {
            if (option.words.empty() || option.by_place) continue;
            std::string words;
            for (const std::string& word : option.words) words += (words.empty() ? "" : " ") + word;
            for (const std::string& name : option.names)
                cases +=
                    "    \"" + command.name + " " + name + "\") COMPREPLY=($(compgen -W \"" + words + "\" -- \"$current\")); return ;;\n";
        }
    }
    return cases;
}

std::string bash_script(const CommandFacts& program) {
    std::string out =
        "# fettle: completion for bash. source <(fettle completion bash)\n_fettle() {\n"
        "  local current=\"${COMP_WORDS[COMP_CWORD]}\" previous=\"${COMP_WORDS[COMP_CWORD-1]}\" command=\"\" word\n"
        "  COMPREPLY=()\n"
        "  for word in \"${COMP_WORDS[@]:1:COMP_CWORD-1}\"; do\n    case \"$word\" in -*) ;; *) command=\"$word\"; break ;; esac\n  done\n"
        "  case \"$command $previous\" in\n" +
        value_cases(program) + "  esac\n  case \"$command\" in\n";
    const std::string common = " --help" + option_words(program);
    for (const CommandFacts& command : program.commands)
        out += "    " + command.name + ") [[ \"$current\" == -* ]] && COMPREPLY=($(compgen -W \"" +
               (option_words(command) + common).substr(1) + "\" -- \"$current\")); return ;;\n";
    return out + "    *) COMPREPLY=($(compgen -W \"" + (command_words(program) + common).substr(1) +
           "\" -- \"$current\")) ;;\n  esac\n}\ncomplete -o default -F _fettle fettle\n";
}

std::string fish_quoted(const std::string& text) {
    std::string out = "'";
    for (const char c : text) out += c == '\'' || c == '\\' ? std::string("\\") + c : std::string(1, c);
    return out + "'";
}

std::string fish_option(const OptionFacts& option, const std::string& condition) {
    std::string out = "complete -c fettle" + condition;
    for (const std::string& name : option.names) out += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
    if (!option.value.empty()) out += " -r";
    std::string words;
    for (const std::string& word : option.words) words += (words.empty() ? "" : " ") + word;
    if (!words.empty()) out += (option.other_values ? " -a " : " -f -a ") + fish_quoted(words);
    return out + " -d " + fish_quoted(option.description) + "\n";
}

std::string fish_script(const CommandFacts& program) {
    std::string out = "# fettle: completion for fish. fettle completion fish | source\n";
    for (const OptionFacts& option : program.options)
        if (!option.by_place) out += fish_option(option, "");
    for (const CommandFacts& command : program.commands) {
        out += "complete -c fettle -n __fish_use_subcommand -f -a " + command.name + " -d " + fish_quoted(command.description) + "\n";
        for (const OptionFacts& option : command.options)
            if (!option.by_place) out += fish_option(option, " -n '__fish_seen_subcommand_from " + command.name + "'");
    }
    return out;
}

}  // namespace

Command add_completion(CommandLine& program) {
    CommandLine app = program.command("completion", "Prints a script that completes commands and options in a shell");
    auto shell = std::make_shared<std::string>();
    app.option("SHELL", *shell, "bash, zsh or fish").required().one_of({"bash", "zsh", "fish"});
    app.closing_words("Example:  source <(fettle completion bash)");
    return {app, [shell, program](Console& console) {
                const CommandFacts facts = program.facts();
                const std::string zsh = "autoload -U +X compinit && compinit\nautoload -U +X bashcompinit && bashcompinit\n";
                const std::string script = *shell == "fish" ? fish_script(facts) : (*shell == "zsh" ? zsh : "") + bash_script(facts);
                console.result({{"status", "ok"}, {"shell", *shell}, {"script", script}}, script);
                return static_cast<int>(exit_done);
            }};
}

}  // namespace fettle::design::cli
