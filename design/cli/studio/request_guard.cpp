// SPDX-License-Identifier: MIT
#include "design/cli/studio/request_guard.hpp"

#include <algorithm>
#include <charconv>

#include "core/base/text.hpp"

namespace fettle::design::cli::studio {

namespace {

bool is_one_of(char letter, std::string_view letters) { return letters.find(letter) != std::string_view::npos; }
bool is_letter_or_digit(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9'); }
bool is_control(unsigned char c) { return c < 0x20 || c == 0x7f; }

// pchar and "/" of RFC 3986, without its "%".
bool may_stand_in_path(char c) { return is_letter_or_digit(c) || is_one_of(c, "-._~!$&'()*+,;=:@/"); }

// The number of two hexadecimal digits; -1: they are none.
int byte_of(std::string_view digits) {
    int byte = 0;
    const auto [end, fault] = std::from_chars(digits.data(), digits.data() + digits.size(), byte, 16);
    return fault == std::errc() && digits.size() == 2 && end == digits.data() + 2 && digits[0] != '-' ? byte : -1;
}

std::optional<std::string> decoded(std::string_view text, bool is_query) {
    std::string plain;
    for (std::size_t k = 0; k < text.size(); ++k) {
        if (text[k] == '%') {
            const int byte = byte_of(text.substr(k + 1, 2));
            if (byte < 0) return std::nullopt;
            plain += static_cast<char>(byte);
            k += 2;
        } else if (is_query && text[k] == '+') {
            plain += ' ';
        } else if (may_stand_in_path(text[k]) || (is_query && text[k] == '?')) {
            plain += text[k];
        } else {
            return std::nullopt;
        }
    }
    if (std::any_of(plain.begin(), plain.end(), is_control) || !core::base::is_utf8(plain)) return std::nullopt;
    return plain;
}

// Calls visit(name, value) for each "name=value" between "&", as they stand, until it returns false.
template <class Visit>
bool visit_query(std::string_view query, const Visit& visit) {
    while (!query.empty()) {
        const std::size_t end = std::min(query.find('&'), query.size());
        const std::string_view piece = query.substr(0, end);
        const std::size_t equals = std::min(piece.find('='), piece.size());
        if (!piece.empty() && !visit(piece.substr(0, equals), piece.substr(std::min(equals + 1, piece.size())))) return false;
        query.remove_prefix(std::min(end + 1, query.size()));
    }
    return true;
}

std::string_view query_of(std::string_view target) {
    const std::size_t mark = target.find('?');
    return mark == std::string_view::npos ? std::string_view() : target.substr(mark + 1);
}

// As long for a wrong first letter as for a wrong last one.
bool are_equal(std::string_view told, std::string_view secret) {
    if (told.size() != secret.size()) return false;
    volatile unsigned char difference = 0;
    for (std::size_t k = 0; k < told.size(); ++k) difference = difference | static_cast<unsigned char>(told[k] ^ secret[k]);
    return difference == 0;
}

// Before the target is parsed, and only as browsers send it: nothing of it has to be encoded.
bool has_token(std::string_view target, const std::string& token) {
    std::size_t right = 0, wrong = 0;
    visit_query(query_of(target), [&](std::string_view name, std::string_view value) {
        if (name == "token") (are_equal(value, token) ? right : wrong) += 1;
        return true;
    });
    return right == 1 && wrong == 0;
}

std::vector<std::string_view> values_of(const RequestHead& head, std::string_view name) {
    std::vector<std::string_view> values;
    for (const auto& [field, value] : head.fields)
        if (field == name) values.emplace_back(value);
    return values;
}

// "127.0.0.1:PORT" or "localhost:PORT"; HTTP's own port goes without saying.
bool is_own_authority(std::string_view text, unsigned short port) {
    const std::string ending = ":" + std::to_string(port);
    const bool has_port = text.ends_with(ending);
    if (has_port) text.remove_suffix(ending.size());
    return (has_port || port == 80) && (text == "127.0.0.1" || text == "localhost");
}

bool is_own_origin(std::string_view text, unsigned short port) {
    constexpr std::string_view scheme = "http://";
    return text.starts_with(scheme) && is_own_authority(text.substr(scheme.size()), port);
}

bool comes_from_elsewhere(const RequestHead& head, const RequestTarget& target, unsigned short port) {
    for (const std::string_view origin : values_of(head, "origin"))
        if (!is_own_origin(origin, port)) return true;
    const std::vector<std::string_view> mode = values_of(head, "sec-fetch-mode");
    const bool opens_page = head.method == "GET" && target.path == "/" && mode.size() == 1 && mode.front() == "navigate";
    for (const std::string_view site : values_of(head, "sec-fetch-site"))
        if (site != "same-origin" && site != "none" && !opens_page) return true;
    return false;
}

// Contract: the parser has found numbers there.
bool is_longer(const RequestHead& head, std::size_t most) {
    for (const std::string_view text : values_of(head, "content-length")) {
        std::size_t length = 0;
        if (std::from_chars(text.data(), text.data() + text.size(), length).ec != std::errc() || length > most) return true;
    }
    return false;
}

bool is_json(const RequestHead& head) {
    const std::vector<std::string_view> types = values_of(head, "content-type");
    if (types.size() != 1) return false;
    std::string type(types.front().substr(0, types.front().find(';')));
    while (!type.empty() && is_one_of(type.back(), " \t")) type.pop_back();
    std::transform(type.begin(), type.end(), type.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    return type == "application/json";
}

}  // namespace

std::optional<RequestTarget> parsed_target(std::string_view target) {
    if (!target.starts_with('/')) return std::nullopt;
    const std::optional<std::string> path = decoded(target.substr(0, target.find('?')), false);
    if (!path) return std::nullopt;
    RequestTarget parsed{*path, {}};
    const bool is_good = visit_query(query_of(target), [&](std::string_view name, std::string_view value) {
        const std::optional<std::string> plain_name = decoded(name, true), plain_value = decoded(value, true);
        return plain_name && plain_value && parsed.query.emplace(*plain_name, *plain_value).second;
    });
    if (!is_good) return std::nullopt;
    return parsed;
}

std::optional<Answer> refusal(const RequestHead& head, const GuardRules& rules) {
    if (!has_token(head.target, rules.token)) return refused(403, "the address has to be whole, with its token, as the program printed it");
    const std::vector<std::string_view> hosts = values_of(head, "host");
    if (hosts.size() != 1 || !is_own_authority(hosts.front(), rules.port))
        return refused(403, "this server is 127.0.0.1, and no other name");
    const std::optional<RequestTarget> target = parsed_target(head.target);
    if (!target) return refused(400, "the request's target is none");
    if (comes_from_elsewhere(head, *target, rules.port)) return refused(403, "pages of other origins are not answered");
    if (head.method != "GET" && head.method != "POST") return refused(405, "only GET and POST are answered");
    if (!values_of(head, "transfer-encoding").empty()) return refused(411, "the body has to have a length");
    if (is_longer(head, rules.most_body)) return refused(413, "the body is too long");
    if (head.method == "POST" && !is_json(head)) return refused(415, "the body has to be application/json");
    return std::nullopt;
}

Answer refused(int status, const std::string& sentence) { return {status, "application/json", R"({"error": ")" + sentence + R"("})", {}}; }

}  // namespace fettle::design::cli::studio
