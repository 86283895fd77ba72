// SPDX-License-Identifier: MIT
/// The command line: options of the program and of its commands, each read into a variable. The library that does it stays inside
/// command_line.cpp, whose header costs a file that includes it ten seconds of compilation.
///
///     CommandLine simulate = program.command("simulate", "Runs a scene through time");
///     simulate.option("SCENE", path, "Scene or design").required();
///     const Option steps = simulate.option("--steps", count, "How many steps").at_least(0);
///     simulate.option("--time", seconds, "How long, in seconds").at_least(0).excludes(steps);
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace CLI {  // NOLINT(readability-identifier-naming): the library's own
class App;
class Option;
}  // namespace CLI

namespace fettle::design::cli {

/// One option, to say what is allowed. Valid as long as its command line.
class Option {
public:
    explicit Option(CLI::Option* option) : option_(option) {}

    Option& required();
    Option& at_least(double low);              ///< a number
    Option& above(double low);                 ///< a number
    Option& between(double low, double high);  ///< a number
    Option& one_of(std::vector<std::string> words);
    Option& words_or(const std::vector<std::string_view>& words, const std::string& other);  ///< known words, or what `other` names: "NAME"
    Option& excludes(const Option& other);                                                   ///< not both
    Option& needs(const Option& other);                                                      ///< not without it
    Option& value_if_bare(std::string value);  ///< may be given without a value, and then has this one
    Option& one_value_each();                  ///< of a list: every value takes its own mention of the option

private:
    CLI::Option* option_;
};

/// What help, manual and shell completion say of an option and of a command.
struct OptionFacts {
    std::vector<std::string> names;  ///< "--out"; for a positional argument "FILE"
    bool by_place = false;
    bool required = false;
    std::string value;               ///< "TEXT", "INT", "FLOAT"; empty: a flag
    std::vector<std::string> words;  ///< the known values; empty: any
    bool other_values = false;       ///< values may be others than the known ones
    bool several = false;            ///< takes a list
    std::string description;
};
struct CommandFacts {
    std::string name, description, group, closing_words;
    std::vector<OptionFacts> options;
    std::vector<CommandFacts> commands;
};

/// An option that was given, with one of its values.
struct GivenValue {
    std::string option;  ///< "--out"; for a positional argument "FILE"
    std::string value;
    bool by_place = false;
};

/// The options of the program, or of one of its commands. A copy refers to the same.
class CommandLine {
public:
    explicit CommandLine(CLI::App* app) : app_(app) {}

    CommandLine command(const std::string& name, const std::string& description);
    void also_called(const std::string& name);
    /// Under which heading of the program's help.
    void group(const std::string& name);

    /// @param names  "--out", several with commas, or in capitals for a positional argument. Numbers must be numbers, whole ones whole.
    Option option(const std::string& names, std::string& value, const std::string& description);
    Option option(const std::string& names, int& value, const std::string& description);
    Option option(const std::string& names, double& value, const std::string& description);
    Option option(const std::string& names, std::optional<int>& value, const std::string& description);
    Option option(const std::string& names, std::optional<double>& value, const std::string& description);
    Option option(const std::string& names, std::vector<std::string>& values, const std::string& description);
    Option flag(const std::string& names, bool& value, const std::string& description);

    void version(const std::string& text);
    /// What --help ends with.
    void closing_words(const std::string& text);
    const std::string& name() const;
    /// Facts about this command and those below it, in the order in which they were added.
    CommandFacts facts() const;
    /// After parsing: is it the command that was given?
    bool is_chosen() const;
    /// After parsing: its own options that were given, with all their values.
    std::vector<GivenValue> given() const;

private:
    CLI::App* app_;
};

/// What reading a command line comes to.
struct ParseOutcome {
    bool run = false;             ///< a command was given, and all that it needs
    int exit_code = 0;            ///< if not: 0 where help or the version was asked for
    std::string message;          ///< if not: what is wrong, or the help or version that was asked for
    std::string command;          ///< if not: the one that was given; empty: none
    std::string no_command = {};  ///< then: the word in a command's place; empty: none
};

/// The program's own command line.
class ProgramLine {
public:
    ProgramLine(const std::string& name, const std::string& description);
    ~ProgramLine();
    ProgramLine(const ProgramLine&) = delete;
    ProgramLine& operator=(const ProgramLine&) = delete;

    CommandLine options();
    /// Prints help or the version where they are asked for. A command is required; options of the program may stand after it.
    ParseOutcome parse(int argc, char** argv);

private:
    std::unique_ptr<CLI::App> app_;
};

}  // namespace fettle::design::cli
