// SPDX-License-Identifier: MIT
#include "fettle/design/cli/command_line.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cstdio>

#include "fettle/core/base/limits.hpp"
#include "fettle/core/base/text.hpp"

namespace fettle::design::cli {

namespace {

std::string shown(double number) {
    char text[40];
    std::snprintf(text, sizeof text, "%g", number);
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
    if (number) return text + " is out of range: a number of at most 1e30 in absolute value is wanted";
    return std::string(std::is_integral_v<Number> ? "a whole number is wanted, found \"" : "a number is wanted, found \"") + text + "\"";
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
    if (facts.value.find('|') == std::string::npos) return facts;
    for (std::size_t at = 0; at <= facts.value.size();) {
        const std::size_t bar = std::min(facts.value.find('|', at), facts.value.size());
        facts.words.push_back(facts.value.substr(at, bar - at));
        at = bar + 1;
    }
    return facts;
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
        return "\"" + text + "\" is not one of " + core::base::joined(words);
    };
    option_->type_name(listed);
    option_->check(check);
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
    return Option(app_->add_option(names, value, description));
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
    return Option(app_->add_option(names, values, description));
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

ProgramLine::ProgramLine(const std::string& name, const std::string& description) : app_(std::make_unique<CLI::App>(description, name)) {
    app_->require_subcommand(1);
}

ProgramLine::~ProgramLine() = default;

CommandLine ProgramLine::options() { return CommandLine(app_.get()); }

ParseOutcome ProgramLine::parse(int argc, char** argv) {
    try {
        app_->parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) return {false, app_->exit(error), {}};
        return {false, error.get_exit_code(), error.what()};
    }
    return {true, 0, {}};
}

}  // namespace fettle::design::cli
