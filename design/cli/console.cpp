// SPDX-License-Identifier: MIT
#include "fettle/design/cli/console.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <utility>

#include "fettle/core/base/parallel.hpp"

namespace fettle::design::cli {

namespace {

using Json = nlohmann::ordered_json;

constexpr int indent = 2;

// Text from files can hold bytes that are no UTF-8: they must not break the one JSON object. `depth`: of what it stands in.
std::string dumped_within(const Json& json, int depth) {
    const std::string text = json.dump(indent, ' ', false, Json::error_handler_t::replace);
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
        static_cast<int>(list.size()), elements_at_once, std::string("["),
        [&](int begin, int end) {
            std::string part;
            for (int i = begin; i < end; ++i)
                part += (i > 0 ? "," : "") + line + dumped_within(list[static_cast<std::size_t>(i)], depth + 1);
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

bool no_color() {
    const char* value = std::getenv("NO_COLOR");
    return value != nullptr && *value != '\0';
}

}  // namespace

Console::Console(const ConsoleOptions& options) : options_(options) {
    terminal_ = ::isatty(STDERR_FILENO) != 0;
    colours_ = ::isatty(STDOUT_FILENO) != 0 && !no_color();
    if (options.log.empty()) return;
    if (std::FILE* file = std::fopen(options.log.c_str(), "w")) log_ = {file, std::fclose};
}

void Console::log(const std::string& line) {
    if (!log_) return;
    std::fprintf(log_.get(), "%8.1f s  %s\n", std::chrono::duration<double>(Clock::now() - begun_).count(), line.c_str());
    std::fflush(log_.get());
}

void Console::narrate(const std::string& line) {
    log(line);
    if (options_.quiet) return;
    end_progress();
    std::fprintf(stderr, "%s\n", line.c_str());
}

std::string Console::pace(int done, int of) const {
    const double seconds = std::chrono::duration<double>(Clock::now() - progress_begun_).count();
    if (seconds < 1 || done <= first_done_) return "";
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
    const Clock::time_point now = Clock::now();
    if (what != progress_of_ || done < first_done_) {
        progress_of_ = what;
        progress_begun_ = line_written_ = now;
        first_done_ = done;
    }
    constexpr std::chrono::seconds between_lines{10};
    const bool line_due = now - line_written_ >= between_lines;
    if (line_due) {
        const std::string line = what + " " + std::to_string(done) + "/" + std::to_string(of) + pace(done, of);
        line_written_ = now;
        log(line);
        if (!options_.quiet && !terminal_) std::fprintf(stderr, "%s\n", line.c_str());
    }
    if (options_.quiet || !terminal_) return;
    const int permille = static_cast<int>(1000.0 * done / of);
    if (permille == bar_permille_ && done < of) return;
    bar_permille_ = permille;
    constexpr int width = 30;
    const int filled = static_cast<int>(static_cast<long>(width) * done / of);
    std::fprintf(stderr, "\r%s [%s%s] %d/%d%s \033[K", what.c_str(), std::string(static_cast<size_t>(filled), '#').c_str(),
                 std::string(static_cast<size_t>(width - filled), '.').c_str(), done, of, pace(done, of).c_str());
    std::fflush(stderr);
    bar_shown_ = true;
    if (done >= of) end_progress();
}

void Console::end_progress() {
    if (bar_shown_) std::fprintf(stderr, "\r\033[K");
    bar_shown_ = false;
    bar_permille_ = -1;
}

void Console::result(const Json& json, const std::string& text) {
    end_progress();
    const std::string out = options_.json ? dumped(json) + "\n" : text;
    std::fwrite(out.data(), 1, out.size(), stdout);
    std::fflush(stdout);
}

int Console::input_errors(const Errors& errors) {
    end_progress();
    if (options_.json) {
        Json json;
        json["status"] = "error";
        json["errors"] = Json::array();
        for (const Error& error : errors) {
            json["errors"].push_back({{"code", to_string(error.code)}, {"where", error.where}, {"message", error.message}});
        }
        result(json, "");
    } else {
        for (const Error& error : errors) {
            std::fprintf(stderr, "error: %s%s%s [%s]\n", error.where.c_str(), error.where.empty() ? "" : ": ", error.message.c_str(),
                         to_string(error.code));
        }
    }
    return exit_bad_input;
}

int Console::internal_error(const std::string& message) {
    end_progress();
    if (options_.json) {
        Json json;
        json["status"] = "error";
        json["errors"] = Json::array({{{"code", "internal"}, {"where", ""}, {"message", message}}});
        result(json, "");
    } else {
        std::fprintf(stderr, "fettle: internal error, please report it: %s\n", message.c_str());
    }
    return exit_internal;
}

std::string Console::coloured(const std::string& text, bool good) const {
    if (!colours_) return text;
    return std::string(good ? "\033[32m" : "\033[31m") + text + "\033[0m";
}

const char* to_string(ErrorCode code) {
    switch (code) {
        case ErrorCode::file_not_found:
            return "file_not_found";
        case ErrorCode::file_unreadable:
            return "file_unreadable";
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
