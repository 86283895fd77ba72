// SPDX-License-Identifier: MIT
/// Whom the studio's server answers: who knows the token, from a page of its own. It reads the head of a request alone, and knows nothing
/// of sockets.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "design/cli/studio/http_message.hpp"

namespace fettle::design::cli::studio {

/// Everything of a request but its body.
struct RequestHead {
    std::string method;
    std::string target;                                       ///< as sent: "/events?token=..."
    std::vector<std::pair<std::string, std::string>> fields;  ///< names in lower case
};

struct RequestTarget {
    std::string path;
    std::map<std::string, std::string> query;
};

/// The path and the query of a target in origin form (RFC 9112, 3.2.1), decoded: "%20", and "+" in the query, are spaces. Nothing: it has
/// another form, a character that has to be encoded (RFC 3986), a wrong %, a control character, what is no UTF-8, or a name twice.
std::optional<RequestTarget> parsed_target(std::string_view target);

struct GuardRules {
    std::string token;  ///< letters and digits
    unsigned short port = 0;
    std::size_t most_body = 0;  ///< [bytes]
};

/// Why a request is not answered. The first of these that holds:
///   403  the query has not the token; the time that takes tells nothing of it
///   403  Host is not this server: a name that someone else has led to 127.0.0.1 (DNS rebinding)
///   400  the target cannot be parsed
///   403  Origin, or Sec-Fetch-Site, is of another page. Sec-Fetch-Site may be of another page where the browser opens "/" itself, from a
///   link
///        or in a frame, as VS Code does: the page that leads there has to know the token, and reads nothing of what comes
///   405  neither GET nor POST
///   411  a body in chunks;  413  a body larger than most_body
///   415  a POST of something else than application/json, which pages of other origins cannot send unasked
/// Nothing: it may be answered.
std::optional<Answer> refusal(const RequestHead& head, const GuardRules& rules);

/// {"error": sentence}. Contract: the sentence has no quotes, backslashes and control characters.
Answer refused(int status, const std::string& sentence);

}  // namespace fettle::design::cli::studio
