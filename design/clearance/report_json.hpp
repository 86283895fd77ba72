// SPDX-License-Identifier: MIT
/// The answer of `fettle clearance --json`.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "fettle/design/clearance/report.hpp"

namespace fettle::design::clearance {

/// Keys: docs/interface.md. SI.
nlohmann::ordered_json report_json(const ClearanceReport& report, const Subject& subject);

}  // namespace fettle::design::clearance
