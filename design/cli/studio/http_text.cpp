// SPDX-License-Identifier: MIT
#include "design/cli/studio/http_text.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "core/base/contract.hpp"

namespace fettle::design::cli::studio {

namespace {

constexpr std::array<std::pair<int, std::string_view>, 16> reasons{{{200, "OK"},
                                                                    {400, "Bad Request"},
                                                                    {403, "Forbidden"},
                                                                    {404, "Not Found"},
                                                                    {405, "Method Not Allowed"},
                                                                    {408, "Request Timeout"},
                                                                    {409, "Conflict"},
                                                                    {411, "Length Required"},
                                                                    {413, "Content Too Large"},
                                                                    {415, "Unsupported Media Type"},
                                                                    {422, "Unprocessable Content"},
                                                                    {429, "Too Many Requests"},
                                                                    {431, "Request Header Fields Too Large"},
                                                                    {500, "Internal Server Error"},
                                                                    {503, "Service Unavailable"},
                                                                    {505, "HTTP Version Not Supported"}}};

std::string status_line(int status) {
    const auto* const found = std::find_if(reasons.begin(), reasons.end(), [&](const auto& each) { return each.first == status; });
    std::string line = "HTTP/1.1 " + std::to_string(status) + " ";
    if (found != reasons.end()) line += found->second;  // there need not be any
    return line + "\r\n";
}

// Pages may be shown in frames (no X-Frame-Options, no frame-ancestors): VS Code shows them so, from vscode-webview: in vscode-file:, or
// from origins of its own on the web, and Chromium does not match such schemes reliably. Whoever frames the page has to know the token.
constexpr std::string_view common_fields =
    "Cache-Control: no-store\r\n"
    "X-Content-Type-Options: nosniff\r\n"
    "Referrer-Policy: no-referrer\r\n"
    "Cross-Origin-Opener-Policy: same-origin\r\n"
    "Cross-Origin-Resource-Policy: same-origin\r\n";

}  // namespace

std::string head_text(const Answer& answer, bool keeps_alive) {
    std::string text = status_line(answer.status);
    if (!answer.type.empty()) text += "Content-Type: " + answer.type + "\r\n";
    text += "Content-Length: " + std::to_string(answer.body.size()) + "\r\n";
    if (answer.status == 405) text += "Allow: " + (answer.allow.empty() ? std::string("GET, POST") : answer.allow) + "\r\n";
    text += common_fields;
    return text + (keeps_alive ? "Connection: keep-alive\r\n\r\n" : "Connection: close\r\n\r\n");
}

std::string event_stream_head() {
    std::string text = status_line(200) + "Content-Type: text/event-stream\r\n";
    text += common_fields;
    return text + "Connection: close\r\n\r\nretry: 500\n\n";
}

std::string event_text(std::string_view name, std::string_view data) {
    FETTLE_ASSERT(name.find_first_of("\r\n") == std::string_view::npos, "names of events are one line");
    std::string text = "event: ";
    text.append(name) += "\n";
    for (std::size_t end = 0; end != std::string_view::npos;) {
        end = data.find_first_of("\r\n");
        text.append("data: ").append(data.substr(0, end)) += "\n";
        if (end != std::string_view::npos) data.remove_prefix(end + (data.substr(end, 2) == "\r\n" ? 2 : 1));
    }
    return text += "\n";
}

std::string event_comment() { return ": open\n\n"; }

}  // namespace fettle::design::cli::studio
