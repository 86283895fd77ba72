// SPDX-License-Identifier: MIT
/// Runs the fettle program, or another, from outside, as a user does: what it prints and its exit code. The build says where fettle is
/// (definition FETTLE_PROGRAM of the tests' target); the environment variable FETTLE_PROGRAM names another.
#pragma once

#include <sys/wait.h>

#include <catch2/catch.hpp>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>

namespace fettle::tests::support {

struct Answer {
    int code = -1;
    std::string out;

    /// The answer of --json. Members that may be missing: `.at()` on what is const, for operator[] is undefined there.
    nlohmann::json json() const { return nlohmann::json::parse(out, nullptr, false); }
    /// The pair of two names in a clearance report, in either order; null if it is not there.
    nlohmann::json pair(const std::string& a, const std::string& b) const {
        const nlohmann::json report = json();
        for (const nlohmann::json& p : report.at("pairs"))
            if ((p.at("a") == a && p.at("b") == b) || (p.at("a") == b && p.at("b") == a)) return p;
        return nullptr;
    }
    bool says(const std::string& text) const { return out.find(text) != std::string::npos; }
};

/// @param arguments    as a shell takes them.
/// @param with_errors  stderr too, in `out`; dropped otherwise.
/// @param before       what the shell does first: "ulimit -f 8;".
inline Answer run_program(const std::string& program, const std::string& arguments, bool with_errors = false,
                          const std::string& before = {}) {
    const std::string command = before + "'" + program + "' " + arguments + (with_errors ? " 2>&1" : " 2>/dev/null") + " </dev/null";
    Answer answer;
    FILE* pipe = ::popen(command.c_str(), "r");
    REQUIRE(pipe != nullptr);
    char buffer[4096];
    for (std::size_t n; (n = std::fread(buffer, 1, sizeof buffer, pipe)) > 0;) answer.out.append(buffer, n);
    const int status = ::pclose(pipe);
    answer.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    return answer;
}

inline Answer run(const std::string& arguments, bool with_errors = false, const std::string& before = {}) {
    const char* elsewhere = std::getenv("FETTLE_PROGRAM");
    return run_program(elsewhere != nullptr ? elsewhere : FETTLE_PROGRAM, arguments, with_errors, before);
}

}  // namespace fettle::tests::support
