// SPDX-License-Identifier: MIT
#include "design/cli/console.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <random>
#include <system_error>
#include <utility>

#include "core/base/parallel.hpp"
#include "core/base/printed_text.hpp"
#include "core/base/text.hpp"
#include "core/files/json_dump.hpp"

namespace fettle::design::cli {

namespace {

using Json = nlohmann::ordered_json;

constexpr int indent = 2;

// Text from files can hold bytes that are no UTF-8: they must not break the one JSON object. `depth`: of what it stands in.
std::string dumped_within(const Json& json, int depth) {
    const std::string text = core::files::dumped(json, indent);
    if (depth == 0) return text;
    std::string out;
    out.reserve(text.size() + text.size() / 2);
    for (const char c : text) {  // a line's end in a string is escaped
        out += c;
        if (c == '\n') out.append(static_cast<std::size_t>(depth * indent), ' ');
    }
    return out;
}

// A long list, on all threads.
std::string dumped_list(const Json& list, int depth) {
    constexpr int elements_at_once = 32;
    const std::string line = "\n" + std::string(static_cast<std::size_t>((depth + 1) * indent), ' ');
    std::string out = core::base::ordered_reduce(
        count_of(list), elements_at_once, std::string("["),
        [&](int begin, int end) {
            std::string part;
            for (int i = begin; i < end; ++i) part += (i > 0 ? "," : "") + line + dumped_within(list[i], depth + 1);
            return part;
        },
        [](std::string&& so_far, std::string&& part) { return std::move(so_far) + part; });
    return out.append(line, 0, line.size() - indent) + "]";
}

// As Json::dump() does it.
std::string dumped(const Json& json) {
    constexpr std::size_t long_list = 100;
    const auto is_long = [](const Json& member) { return member.is_array() && member.size() >= long_list; };
    if (!json.is_object() || std::none_of(json.begin(), json.end(), is_long)) return dumped_within(json, 0);
    std::string out = "{";
    for (const auto& [key, member] : json.items()) {
        out += (out.size() > 1 ? ",\n  " : "\n  ") + dumped_within(key, 0) + ": ";
        out += is_long(member) ? dumped_list(member, 1) : dumped_within(member, 1);
    }
    return out + "\n}";
}

constexpr const char* green = "\033[32m";
constexpr const char* red = "\033[31m";
constexpr const char* plain = "\033[0m";

// Text from files may hold any characters. What stands for a colour until the text is printed is drawn anew for each run, so that no file
// can have it.
std::string drawn_mark() {
    std::random_device random;
    return core::base::formatted("\033%08x%08x", random(), random());
}

// The one way to stderr. Names and paths may come from anybody.
void say(const std::string& line) { std::fprintf(stderr, "%s\n", core::base::printed(line).c_str()); }

Json errors_json(const Errors& errors) {
    Json list = Json::array();
    for (const Error& error : errors) list.push_back({{"code", to_string(error.code)}, {"where", error.where}, {"message", error.message}});
    return list;
}

void tell(const Error& error) {
    say("error: " + error.where + (error.where.empty() ? "" : ": ") + error.message + " [" + to_string(error.code) + "]");
}

bool is_file(const std::string& name) {
    std::error_code ignored;
    return std::filesystem::is_regular_file(name, ignored);
}

// "a.json" of "a.json#/bodies/0", "a.json:3:7" and "a.json: /bodies/0"; empty where it is about no file: "command line", "--minimum".
std::string file_of_place(const std::string& where) {
    for (std::size_t end = where.size(); end > 0; --end) {
        if (end < where.size() && where[end] != '#' && where[end] != ':') continue;
        if (std::string name = where.substr(0, end); is_file(name)) return name;
    }
    return {};
}

bool no_color() {
    const char* value = std::getenv("NO_COLOR");
    return value != nullptr && *value != '\0';
}

}  // namespace

struct Console::Answer {
    Json json;
    std::string text;
};

Console::Console(const ConsoleOptions& options) : options_(options) {
    terminal_ = ::isatty(STDERR_FILENO) != 0;
    colours_ = ::isatty(STDOUT_FILENO) != 0 && !no_color();
    if (colours_) mark_ = drawn_mark();
    if (options.log.empty()) return;
    if (std::FILE* file = std::fopen(options.log.c_str(), "w")) {
        log_ = {file, std::fclose};
    } else {
        log_failed();
    }
}

// Told once; there is no log from here on.
void Console::log_failed() {
    const int code = errno;
    log_.reset();
    unwritten({{ErrorCode::file_unwritable, options_.log, "the log cannot be written: " + std::generic_category().message(code)}});
}

void Console::log(const std::string& line) {
    if (!log_) return;
    const double seconds = std::chrono::duration<double>(Clock::now() - begun_).count();
    const bool written = std::fprintf(log_.get(), "%8.1f s  %s\n", seconds, core::base::printed(line).c_str()) >= 0;
    if (!written || std::fflush(log_.get()) != 0) log_failed();
}

void Console::narrate(const std::string& line) {
    doing_ = line;
    log(line);
    if (options_.quiet) return;
    end_progress();
    say(line);
}

std::string Console::pace(int done, int of) const {
    const double seconds = std::chrono::duration<double>(Clock::now() - progress_begun_).count();
    constexpr int enough = 3;  // done; of fewer the first, which is longer than the others, would be taken for all
    if (seconds < 1 || done < first_done_ + enough) return "";
    const double rate = (done - first_done_) / seconds, left = (of - done) / rate;
    char text[80];
    if (left < 100) {
        std::snprintf(text, sizeof text, ", %.3g/s, %.0f s left", rate, left);
    } else {
        std::snprintf(text, sizeof text, ", %.3g/s, %.0f min left", rate, left / 60);
    }
    return text;
}

void Console::progress(const std::string& what, int done, int of) {
    if (of <= 0) return;
    doing_ = what + " " + std::to_string(done) + "/" + std::to_string(of);
    const Clock::time_point now = Clock::now();
    if (what != progress_of_ || done < first_done_) {
        progress_of_ = what;
        progress_begun_ = line_written_ = now;
        first_done_ = done;
    }
    constexpr std::chrono::seconds between_lines{10};
    const bool line_due = now - line_written_ >= between_lines;
    if (line_due) {
        const std::string line = doing_ + pace(done, of);
        line_written_ = now;
        log(line);
        if (!options_.quiet && !terminal_) say(line);
    }
    if (options_.quiet || !terminal_) return;
    const int permille = static_cast<int>(1000.0 * done / of);
    if (permille == bar_permille_ && done < of) return;
    bar_permille_ = permille;
    constexpr int width = 30;
    const int filled = static_cast<int>(static_cast<long>(width) * done / of);
    std::fprintf(stderr, "\r%s [%s%s] %d/%d%s \033[K", core::base::shown_on_one_line(what).c_str(),
                 std::string(static_cast<size_t>(filled), '#').c_str(), std::string(static_cast<size_t>(width - filled), '.').c_str(), done,
                 of, pace(done, of).c_str());
    std::fflush(stderr);
    bar_shown_ = true;
    if (done >= of) end_progress();
}

void Console::end_progress() {
    if (bar_shown_) std::fprintf(stderr, "\r\033[K");
    bar_shown_ = false;
    bar_permille_ = -1;
}

void Console::put(const std::string& text) {
    if (std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0) return;
    const int code = errno;
    unwritten({{ErrorCode::file_unwritable, "standard output", "the answer cannot be written: " + std::generic_category().message(code)}});
}

void Console::print(const std::string& text) {
    std::string out;
    std::size_t begin = 0;
    for (std::size_t at = text.find(mark_); colours_ && at != std::string::npos; at = text.find(mark_, begin)) {
        out += core::base::printed(std::string_view(text).substr(begin, at - begin));
        begin = at + mark_.size() + 1;
        const char colour = text[begin - 1];
        out += colour == 'g' ? green : colour == 'r' ? red : plain;
    }
    put(out + core::base::printed(std::string_view(text).substr(begin)));
}

void Console::result(const Json& json, const std::string& text) {
    end_progress();
    if (!options_.holds_answer) return tell_answer(json, text);
    held_ = std::make_shared<const Answer>(options_.json ? Answer{json, {}} : Answer{{}, text});
}

void Console::give_answer() {
    if (const auto answer = std::exchange(held_, nullptr)) tell_answer(answer->json, answer->text);
}

void Console::tell_answer(const Json& json, const std::string& text) {
    if (!options_.json) return print(text);
    if (unwritten_.empty()) return put(dumped(json) + "\n");
    Json with_faults = json;
    with_faults["unwritten"] = errors_json(unwritten_);
    put(dumped(with_faults) + "\n");
}

void Console::unwritten(const Errors& errors) {
    if (!errors.empty()) end_progress();
    for (const Error& error : errors) tell(error);
    found_faults(errors);
    unwritten_.insert(unwritten_.end(), errors.begin(), errors.end());
}

void Console::found(Check check) {
    if (!is_file(check.file)) check.file.clear();
    checks_.push_back(std::move(check));
}

void Console::found_faults(const Errors& errors) {
    for (const Error& error : errors)
        found({error.where, CheckOutcome::fault, to_string(error.code), error.message, file_of_place(error.where)});
}

int Console::input_errors(const Errors& errors) {
    end_progress();
    found_faults(errors);
    if (options_.json) {
        result({{"status", "error"}, {"errors", errors_json(errors)}}, "");
    } else {
        for (const Error& error : errors) tell(error);
    }
    return exit_bad_input;
}

int Console::internal_error(const std::string& message) {
    end_progress();
    found({"fettle", CheckOutcome::fault, "internal", message, ""});
    if (options_.json) {
        result({{"status", "error"}, {"errors", Json::array({{{"code", "internal"}, {"where", ""}, {"message", message}}})}}, "");
    } else {
        say("fettle: internal error, please report it: " + message);
    }
    return exit_internal;
}

int Console::out_of_memory() {
    const std::string doing = doing_.empty() ? "while reading the input" : "last reported: " + doing_;
    return input_errors({{ErrorCode::out_of_memory, "memory",
                          "the request needs more memory than there is (" + doing +
                              "); ask for less at a time (fewer steps, pairs or samples, coarser meshes), or give the program more"}});
}

int Console::stopped() {
    result({{"status", "interrupted"}},
           "interrupted: " + (doing_.empty() ? std::string("stopped on request") : "last reported: " + doing_) + "\n");
    return exit_undecided;
}

std::string Console::coloured(const std::string& text, bool good) const {
    if (!colours_) return text;
    return mark_ + (good ? "g" : "r") + text + mark_ + "-";
}

void expect_failed_writes() {
    std::signal(SIGXFSZ, SIG_IGN);
    // Opened the wrong way round: who writes to it is told.
    for (const auto& [stream, way] : {std::pair{STDIN_FILENO, O_WRONLY}, {STDOUT_FILENO, O_RDONLY}, {STDERR_FILENO, O_RDONLY}})
        if (::fcntl(stream, F_GETFD) < 0) static_cast<void>(::open("/dev/null", way));  // the lowest number that is free: this one
}

const char* to_string(ErrorCode code) {
    switch (code) {
        case ErrorCode::file_not_found:
            return "file_not_found";
        case ErrorCode::file_unreadable:
            return "file_unreadable";
        case ErrorCode::file_unwritable:
            return "file_unwritable";
        case ErrorCode::out_of_memory:
            return "out_of_memory";
        case ErrorCode::parse:
            return "parse";
        case ErrorCode::unknown_key:
            return "unknown_key";
        case ErrorCode::missing_key:
            return "missing_key";
        case ErrorCode::wrong_type:
            return "wrong_type";
        case ErrorCode::out_of_range:
            return "out_of_range";
        case ErrorCode::not_finite:
            return "not_finite";
        case ErrorCode::mesh_invalid:
            return "mesh_invalid";
        case ErrorCode::bodies_intersect:
            return "bodies_intersect";
        case ErrorCode::inconsistent:
            return "inconsistent";
        case ErrorCode::unsupported:
            return "unsupported";
    }
    return "unknown";
}

}  // namespace fettle::design::cli
