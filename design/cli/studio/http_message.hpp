// SPDX-License-Identifier: MIT
/// What the studio's server is asked, answers, and keeps to.
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
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
    /// Not empty: makes the answer, all of it, on a thread beside the server's, one after the other, while others are answered.
    std::function<Answer()> later = {};
};

using AnswerRequest = std::function<Answer(const Request&)>;

/// A listener of this client (`client` in the query of GET /events, empty if there is none) has come, or gone. A client may have several.
using OnListener = std::function<void(const std::string& client, bool connected)>;

struct ServerOptions {
    unsigned short port = 0;                         ///< of 127.0.0.1; 0: any that is free
    std::string token;                               ///< letters and digits; empty: 128 random bits from the system, in hexadecimal
    std::size_t most_connections = 1000;             ///< more: those that have shown no token make room, the oldest first; else answer 503
    std::size_t most_head = std::size_t{16} << 10U;  ///< [bytes]; more: answer 431
    std::size_t most_body = std::size_t{1} << 20U;   ///< [bytes]; more: answer 413
    std::size_t most_waiting = std::size_t{64} << 20U;  ///< [bytes] of events that a listener has not read; more: it is dropped

    // What takes longer is closed.
    std::chrono::milliseconds header_timeout{10'000};   ///< of a head, from the connection's begin or the head's first byte
    std::chrono::milliseconds body_timeout{30'000};     ///< of a whole body
    std::chrono::milliseconds answer_timeout{120'000};  ///< until all of an answer is taken
    std::chrono::milliseconds idle_timeout{300'000};    ///< between requests
    std::chrono::milliseconds linger_timeout{1'000};    ///< after the last answer, until the other side has read it

    std::chrono::milliseconds comment_interval{15'000};  ///< of lines that show to listeners that the connection lives
};

}  // namespace fettle::design::cli::studio
