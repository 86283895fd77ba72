// SPDX-License-Identifier: MIT
/// fettle optimise of a design with choices: each combination is tuned by a run of its own in the folder OUT/NAME=OPTION,..., from the best
/// values that the rounds before have found (studies/choice_search.hpp): it is `fettle optimise OUT/.../start.design.json --keep-choices`.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "design/cli/optimise_runs.hpp"
#include "design/reading/design_reader.hpp"
#include "design/studies/choice_search.hpp"

namespace fettle::design::cli {

struct ChoiceResult : RunResult {
    description::Combination combination;
    std::string design;  ///< the file that the run began with
};

struct ChoicesTried {
    std::vector<ChoiceResult> runs;   ///< in the order in which they were asked for
    std::optional<std::size_t> best;  ///< none: no design could be evaluated
    bool was_stopped = false;
    bool are_all = false;        ///< has every combination that meets the conditions been tried?
    bool is_local = false;       ///< have all neighbours of the best?
    std::size_t allowed = 0;     ///< combinations that meet the conditions
    long long combinations = 0;  ///< all there are
};

struct ChoicesRequest {
    std::string out;                       ///< as on the command line
    int most = 64;                         ///< combinations
    std::vector<std::string> words = {};   ///< of each run's command line
    reading::DesignReadOptions read = {};  ///< as the design was read
};

/// Errors: more combinations than can be listed, none that meets the conditions.
Result<ChoicesTried> try_choices(const reading::DesignFile& file, const ChoicesRequest& request, const RunSettings& settings,
                                 const CommonOptions& common, Console& console);

/// "best of the 34 combinations tried, slots 6; none of its neighbours is better"
std::string choices_heading(const reading::DesignFile& file, const ChoicesTried& tried);
/// The table, best first, for people, and as JSON (`choices`: docs/interface.md).
std::string choices_text(const ChoicesTried& tried);
nlohmann::ordered_json choices_json(const reading::DesignFile& file, const ChoicesTried& tried);

}  // namespace fettle::design::cli
