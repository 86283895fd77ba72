// SPDX-License-Identifier: MIT
/// The report's page: one HTML file that needs nothing else, with the data in it. Its sources: web/; the built page, which the program
/// carries, is template.html:
///     cd design/report/web && npm ci && npm run build
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace fettle::design::report {

/// The built page, without data.
std::string_view page_template();

/// The page with `data` (report_data.hpp) in it. Whatever the data hold, texts of users' files too, is data: no '<' of theirs is one of the
/// page's. Bytes that are no UTF-8 are replaced. A page of the kind "studio" may ask the program that it comes from; no other asks anybody.
std::string page_of(const nlohmann::ordered_json& data);

}  // namespace fettle::design::report
