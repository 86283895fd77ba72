// SPDX-License-Identifier: MIT
#include "design/report/report_page.hpp"

#include <nlohmann/json.hpp>

#include "core/base/contract.hpp"
#include "core/files/embedded_file.hpp"
#include "core/files/json_dump.hpp"

FETTLE_EMBEDDED_FILE(fettle_report_template, FETTLE_REPORT_TEMPLATE)

namespace fettle::design::report {

std::string_view page_template() { return fettle_report_template(); }

namespace {

// The page of a program that answers asks that program, and nobody else; all others ask nobody.
void allow_connection(std::string& page) {
    constexpr std::string_view nothing = "default-src 'none'";
    const std::size_t at = page.find(nothing);
    FETTLE_ASSERT(at != std::string::npos, "the page has a policy");
    page.insert(at + nothing.size(), "; connect-src 'self'");
}

}  // namespace

std::string page_of(const nlohmann::ordered_json& data) {
    constexpr std::string_view marker = "@FETTLE_REPORT_DATA@";
    const std::string_view page = page_template();
    const std::size_t at = page.find(marker);
    FETTLE_ASSERT(at != std::string_view::npos, "the page has a place for its data");
    const std::string text = core::files::dumped(data);
    std::string made(page.substr(0, at));
    if (data.value("kind", "") == "studio") allow_connection(made);
    made.reserve(page.size() + text.size() + text.size() / 64);
    for (const char c : text) {
        if (c == '<') {
            made += "\\u003c";  // so that nothing in it ends the element
        } else {
            made += c;
        }
    }
    return made.append(page.substr(at + marker.size()));
}

}  // namespace fettle::design::report
