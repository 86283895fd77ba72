// SPDX-License-Identifier: MIT
/// The data of an exploration's report, as the page takes it: one JSON object, beside the keys of report_data.hpp: format, program,
/// made_by_other, kind ("explore"), name, folder, description, up, meshes, views, notices, files:
///   columns   list of {name, group: "parameter", "objective", "term", "constraint", "violation", unit, better: -1 (less is), 1 (more is)
///   or
///             0, lower, upper: of a parameter its bounds, of a constraint what is required, null where there is none, values f64: of each
///             design, NaN where it has none}
///   designs   list of {status, kind: "evaluate", "optimise", seed, met: does it meet every requirement?, reason: null or text,
///             view: index of the one that shows its parts at the start, or null}
///   design    path of the design's file; null: not known
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "design/description/design.hpp"

namespace fettle::design::report {

/// The parts of so many designs, the best ones, are put into a page.
inline constexpr std::size_t most_shown_designs = 60;

struct ExplorationSource {
    std::string name, folder, description;
    nlohmann::ordered_json header;                ///< the file's first line
    std::vector<nlohmann::ordered_json> results;  ///< its others (docs/interface.md)
    std::optional<description::Design> design;    ///< that was explored; without it numbers are SI, and no parts are shown
    std::string design_path;
    std::vector<std::string> notices;
};

/// @param should_stop  asked while parts are made; true leaves the rest out.
nlohmann::ordered_json exploration_data(const ExplorationSource& source, const std::function<bool()>& should_stop);

}  // namespace fettle::design::report
