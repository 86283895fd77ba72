// SPDX-License-Identifier: MIT
/// fettle clearance SCENE --ranges: certified distances over all positions of the joints within their limits
/// (clearance/range_clearance.hpp), told as those over a motion are, with the worst combination in place of the worst instant.
#pragma once

#include <optional>
#include <string>

#include "fettle/design/cli/clearance_baseline.hpp"
#include "fettle/design/cli/clearance_folder.hpp"
#include "fettle/design/cli/clearance_pairs.hpp"
#include "fettle/design/cli/session.hpp"

namespace fettle::design::cli {

struct RangeQuestion {
    std::string path;  ///< scene, or design at its values
    PairOptions pairs;
    std::optional<double> tolerance;  ///< [m]; default 10 um or 1% of the least minimum, and 1% of the size with more than two coordinates
    int explain = 0;
    std::string certificate;  ///< file; empty: none
    std::optional<Baseline> baseline;
    std::string csv;         ///< file for ranges_csv's table; empty: none
    ClearanceFolder folder;  ///< with the bodies as assembled
};

/// Answers and returns the exit code.
int clearance_over_ranges(RangeQuestion question, const CommonOptions& common, Console& console);

}  // namespace fettle::design::cli
