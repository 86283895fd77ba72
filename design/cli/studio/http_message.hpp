// SPDX-License-Identifier: MIT
/// What the studio's server is asked and answers.
#pragma once

#include <map>
#include <string>

namespace fettle::design::cli::studio {

/// A request that has passed every check (request_guard.hpp).
struct Request {
    std::string method;                        ///< GET or POST
    std::string path;                          ///< decoded; begins with "/"
    std::map<std::string, std::string> query;  ///< decoded
    std::string body;
};

struct Answer {
    int status = 200;        ///< of HTTP
    std::string type;        ///< of the body: "text/html; charset=utf-8"
    std::string body;        ///< bytes
    std::string allow = {};  ///< with status 405: the methods that are allowed there; empty: GET, POST
};

}  // namespace fettle::design::cli::studio
