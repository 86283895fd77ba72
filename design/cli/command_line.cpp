// SPDX-License-Identifier: MIT
#include "design/cli/command_line.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <limits>
#include <sstream>

#include "core/base/limits.hpp"
#include "core/base/text.hpp"
#include "core/files/nearest_word.hpp"

namespace fettle::design::cli {

namespace {

std::string shown(double number) {
    char text[40];
    const bool whole = std::abs(number) < 1e15 && std::floor(number) == number;
    std::snprintf(text, sizeof text, whole ? "%.0f" : "%g", number);
    return text;
}

/// The number that the whole text says; nothing otherwise. Independent of the locale.
template <class Number>
std::optional<Number> parsed(const std::string& text) {
    Number number{};
    const char* begin = text.data() + (text.starts_with('+') ? 1 : 0);
    const auto [end, code] = std::from_chars(begin, text.data() + text.size(), number);
    if (code != std::errc() || end != text.data() + text.size() || text.empty()) return std::nullopt;
    return number;
}

template <class Number>
std::string number_fault(const std::string& text) {
    const auto number = parsed<Number>(text);
    if (number && core::base::is_usable_number(static_cast<double>(*number))) return {};
    if (number) return text + " is out of range: a number of at most 1e30 in absolute value is expected";
    const bool digits = text.find_first_not_of("+-0123456789") == std::string::npos;
    if (std::is_integral_v<Number> && digits && parsed<double>(text))
        return text + " is out of range: a whole number of at most " + std::to_string(std::numeric_limits<int>::max()) + " is expected";
    return std::string(std::is_integral_v<Number> ? "a whole number is expected, found \"" : "a number is expected, found \"") + text +
           "\"";
}

/// @param allowed  what the message says is allowed
template <class Fits>
void check_number(CLI::Option* option, const std::string& allowed, const Fits& fits) {
    option->check([allowed, fits](const std::string& text) -> std::string {
        const auto number = parsed<double>(text);
        if (!number || fits(*number)) return {};  // what is no number has its own message
        return text + " is not allowed: " + allowed + " is";
    });
}

template <class Number, class Value>
CLI::Option* number_option(CLI::App& app, const std::string& names, Value& value, const std::string& description) {
    CLI::Option* option = app.add_option_function<std::string>(
        names,
        [&value, names](const std::string& text) {
            const std::string fault = number_fault<Number>(text);
            if (!fault.empty()) throw CLI::ValidationError(names, fault);
            value = *parsed<Number>(text);
        },
        description);
    option->type_name(std::is_integral_v<Number> ? "INT" : "FLOAT");
    return option;
}

OptionFacts facts_of(const CLI::Option& option) {
    OptionFacts facts;
    facts.by_place = option.get_positional();
    facts.required = option.get_required();
    facts.description = option.get_description();
    if (facts.by_place) {
        facts.names = {option.get_name(true)};
    } else {
        for (const std::string& name : option.get_snames()) facts.names.push_back("-" + name);
        for (const std::string& name : option.get_lnames()) facts.names.push_back("--" + name);
    }
    if (option.get_items_expected_max() > 0) facts.value = option.get_type_name();
    facts.several = option.get_items_expected_max() > 1;
    if (facts.value.find('|') == std::string::npos) return facts;
    for (std::size_t at = 0; at <= facts.value.size();) {
        const std::size_t bar = std::min(facts.value.find('|', at), facts.value.size());
        const std::string word = facts.value.substr(at, bar - at);
        const bool is_name = std::all_of(word.begin(), word.end(), [](unsigned char c) { return std::isupper(c) != 0; });
        if (is_name)
            facts.other_values = true;
        else
            facts.words.push_back(word);
        at = bar + 1;
    }
    return facts;
}

// A variable of a script that is not set must not pass for an option that was not given.
CLI::Option* never_empty(CLI::Option* option) {
    return option->check([](const std::string& text) { return text.empty() ? "a value is expected, found an empty text" : std::string(); });
}

std::string joined_names(const std::vector<const CLI::Option*>& options) {
    std::string names;
    for (const CLI::Option* option : options) names += (names.empty() ? "" : " ") + option->get_name(true);
    return names;
}

// The typed words that no option and no place takes: the first option of them, with what was probably meant; else the first word.
std::string unexpected(const CLI::App& program, const CLI::App* command) {
    std::vector<std::string> words = program.remaining(true);
    if (words.empty()) return {};
    std::vector<std::string> names;
    std::vector<const CLI::Option*> places;
    for (const CLI::App* app : {&program, command}) {
        if (app == nullptr) continue;
        for (const CLI::Option* option : app->get_options()) {
            if (option->get_positional()) places.push_back(option);
            for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
        }
    }
    const auto option = std::find_if(words.begin(), words.end(), [](const std::string& word) { return word.starts_with("-"); });
    if (option == words.end()) {
        if (command == nullptr) return "\"" + words.front() + "\" is not a command";
        const std::string taken = places.empty() ? "no file" : joined_names(places);
        return "\"" + words.front() + "\" is one word too many: `" + command->get_name() + "` takes " + taken + " and options";
    }
    const std::string typed = option->substr(0, option->find('='));
    const auto meant = core::files::nearest_word(typed, {names.begin(), names.end()});
    return "there is no option " + typed + (meant ? "; did you mean " + *meant + "?" : "");
}

const CLI::Option* find_option(const CLI::App& app, const std::string& name) {
    for (const CLI::Option* option : app.get_options())
        if (option->get_name(true) == name || option->check_name(name)) return option;
    return nullptr;
}

std::string missing(const CLI::App& program, const CLI::App* command, const std::string& told) {
    const std::string name = told.substr(0, told.find(' '));
    if (command == nullptr) return "no command was given";
    const CLI::Option* option = find_option(*command, name);
    if (option == nullptr) option = find_option(program, name);
    return option == nullptr ? told : name + " is missing: " + option->get_description();
}

std::string value_missing(const std::string& told) {
    const std::string name = told.substr(0, told.find(':'));
    const char* wanted = told.find("INT") != std::string::npos     ? "a whole number"
                         : told.find("FLOAT") != std::string::npos ? "a number"
                                                                   : "a value";
    return name + ": " + wanted + " is expected after it";
}

// The two options of "A excludes B" and "A requires B".
std::string two_options(const std::string& told, const std::string& verb, const std::string& between, const std::string& end) {
    const std::size_t at = told.find(verb);
    return at == std::string::npos ? told : told.substr(0, at) + between + told.substr(at + verb.size()) + end;
}

std::string fault_of(const CLI::ParseError& error, const CLI::App& program, const CLI::App* command) {
    const std::string told = error.what();
    if (const std::string word = unexpected(program, command); !word.empty()) return word;
    if (dynamic_cast<const CLI::RequiredError*>(&error) != nullptr) return missing(program, command, told);
    if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr) return value_missing(told);
    if (dynamic_cast<const CLI::ExcludesError*>(&error) != nullptr)
        return two_options(told, " excludes ", " and ", " do not go together: give one of them");
    if (dynamic_cast<const CLI::RequiresError*>(&error) != nullptr) return two_options(told, " requires ", " is given together with ", "");
    return told;
}

}  // namespace

Option& Option::required() {
    option_->required();
    return *this;
}

Option& Option::at_least(double low) {
    check_number(option_, shown(low) + " or more", [low](double x) { return x >= low; });
    return *this;
}

Option& Option::above(double low) {
    check_number(option_, "more than " + shown(low), [low](double x) { return x > low; });
    return *this;
}

Option& Option::between(double low, double high) {
    check_number(option_, shown(low) + " to " + shown(high), [low, high](double x) { return low <= x && x <= high; });
    return *this;
}

Option& Option::one_of(std::vector<std::string> words) {
    std::string listed;
    for (const std::string& word : words) listed += (listed.empty() ? "" : "|") + word;
    const auto check = [words = std::move(words)](const std::string& text) -> std::string {
        if (std::find(words.begin(), words.end(), text) != words.end()) return {};
        const auto meant = core::files::nearest_word(text, {words.begin(), words.end()});
        return "\"" + text + "\" is not one of " + core::base::joined(words) + (meant ? "; did you mean \"" + *meant + "\"?" : "");
    };
    option_->type_name(listed);
    option_->check(check);
    return *this;
}

Option& Option::words_or(const std::vector<std::string_view>& words, const std::string& other) {
    std::string listed;
    for (const std::string_view word : words) listed += std::string(word) + "|";
    option_->type_name(listed + other);
    return *this;
}

Option& Option::excludes(const Option& other) {
    option_->excludes(other.option_);
    return *this;
}

Option& Option::needs(const Option& other) {
    option_->needs(other.option_);
    return *this;
}

Option& Option::value_if_bare(std::string value) {
    option_->expected(0, 1)->default_str(std::move(value));
    return *this;
}

Option& Option::one_value_each() {
    option_->allow_extra_args(false);
    return *this;
}

CommandLine CommandLine::command(const std::string& name, const std::string& description) {
    CLI::App* command = app_->add_subcommand(name, description);
    command->fallthrough();
    return CommandLine(command);
}

void CommandLine::also_called(const std::string& name) { app_->alias(name); }

Option CommandLine::option(const std::string& names, std::string& value, const std::string& description) {
    return Option(never_empty(app_->add_option(names, value, description)));
}

Option CommandLine::option(const std::string& names, int& value, const std::string& description) {
    return Option(number_option<int>(*app_, names, value, description));
}

Option CommandLine::option(const std::string& names, double& value, const std::string& description) {
    return Option(number_option<double>(*app_, names, value, description));
}

Option CommandLine::option(const std::string& names, std::optional<int>& value, const std::string& description) {
    return Option(number_option<int>(*app_, names, value, description));
}

Option CommandLine::option(const std::string& names, std::optional<double>& value, const std::string& description) {
    return Option(number_option<double>(*app_, names, value, description));
}

Option CommandLine::option(const std::string& names, std::vector<std::string>& values, const std::string& description) {
    return Option(never_empty(app_->add_option(names, values, description)));
}

Option CommandLine::flag(const std::string& names, bool& value, const std::string& description) {
    return Option(app_->add_flag(names, value, description));
}

void CommandLine::version(const std::string& text) { app_->set_version_flag("--version", text); }

void CommandLine::closing_words(const std::string& text) { app_->footer(text); }

void CommandLine::group(const std::string& name) { app_->group(name); }

CommandFacts CommandLine::facts() const {
    CommandFacts facts{app_->get_name(), app_->get_description(), app_->get_group(), app_->get_footer(), {}, {}};
    for (const CLI::Option* option : static_cast<const CLI::App*>(app_)->get_options()) facts.options.push_back(facts_of(*option));
    for (CLI::App* command : app_->get_subcommands({})) facts.commands.push_back(CommandLine(command).facts());
    return facts;
}

const std::string& CommandLine::name() const { return app_->get_name(); }

bool CommandLine::is_chosen() const { return app_->parsed(); }

std::vector<GivenValue> CommandLine::given() const {
    std::vector<GivenValue> given;
    for (const CLI::Option* option : static_cast<const CLI::App*>(app_)->get_options())
        for (const std::string& value : option->results())
            given.push_back({option->get_positional() ? option->get_name(true) : option->get_name(), value, option->get_positional()});
    return given;
}

ProgramLine::ProgramLine(const std::string& name, const std::string& description) : app_(std::make_unique<CLI::App>(description, name)) {
    app_->require_subcommand(1);
}

ProgramLine::~ProgramLine() = default;

CommandLine ProgramLine::options() { return CommandLine(app_.get()); }

ParseOutcome ProgramLine::parse(int argc, char** argv) {
    try {
        app_->parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) {  // --help, --version
            std::ostringstream text, none;
            app_->exit(error, text, none);
            return {false, 0, text.str(), {}};
        }
        const std::vector<CLI::App*> chosen = app_->get_subcommands();
        const CLI::App* command = chosen.empty() ? nullptr : chosen.front();
        ParseOutcome fault{false, error.get_exit_code(), fault_of(error, *app_, command), command == nullptr ? "" : command->get_name()};
        const std::vector<std::string> words = app_->remaining(true);
        const auto word = std::find_if(words.begin(), words.end(), [](const std::string& each) { return !each.starts_with("-"); });
        if (command == nullptr && word != words.end()) fault.no_command = *word;
        return fault;
    }
    return {true, 0, {}, {}};
}

}  // namespace fettle::design::cli
