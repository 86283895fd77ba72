// SPDX-License-Identifier: MIT
#include "fettle/design/report/report_page.hpp"

#include <nlohmann/json.hpp>

#include "fettle/core/base/contract.hpp"

// The page as a file, put in by the assembler between two labels.
asm(".pushsection .rodata\n"
    ".global fettle_report_template_begin\n"
    ".hidden fettle_report_template_begin\n"
    ".global fettle_report_template_end\n"
    ".hidden fettle_report_template_end\n"
    "fettle_report_template_begin:\n"
    ".incbin \"" FETTLE_REPORT_TEMPLATE
    "\"\n"
    "fettle_report_template_end:\n"
    ".popsection\n");

extern "C" {
extern const char fettle_report_template_begin[] __attribute__((visibility("hidden")));
extern const char fettle_report_template_end[] __attribute__((visibility("hidden")));
}

namespace fettle::design::report {

std::string_view page_template() {
    return {fettle_report_template_begin, static_cast<std::size_t>(fettle_report_template_end - fettle_report_template_begin)};
}

std::string page_of(const nlohmann::ordered_json& data) {
    constexpr std::string_view marker = "@FETTLE_REPORT_DATA@";
    const std::string_view page = page_template();
    const std::size_t at = page.find(marker);
    FETTLE_ASSERT(at != std::string_view::npos, "the page has a place for its data");
    const std::string text = data.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
    std::string made(page.substr(0, at));
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
