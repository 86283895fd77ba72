// SPDX-License-Identifier: MIT
#include "design/cli/optimise_starts.hpp"

#include <cmath>
#include <filesystem>

#include "core/base/text.hpp"
#include "design/tolerances/yield.hpp"

namespace fettle::design::cli {

using Json = nlohmann::ordered_json;
using core::base::formatted;

std::vector<StartResult> run_starts(const std::string& design, const std::string& out, const std::vector<std::uint64_t>& seeds,
                                    const RunSettings& settings, const CommonOptions& common, Console& console) {
    std::vector<RunRequest> requests;
    for (const std::uint64_t seed : seeds) {
        const std::string number = std::to_string(seed);
        requests.push_back({"seed " + number, design, (std::filesystem::path(out) / ("start-" + number)).string(), {"--seed", number}});
    }
    std::vector<StartResult> starts;
    for (RunResult& run : run_together(requests, settings, common, console)) starts.push_back({std::move(run), seeds[starts.size()]});
    return starts;
}

std::optional<BestReached> best_reached(const std::vector<StartResult>& starts) {
    constexpr double within = 1e-3, confidence = 0.95;
    const std::optional<std::size_t> best = best_run(starts);
    const auto least = best ? rank_of(starts[*best].result) : std::nullopt;
    if (!least || least->first > 0) return std::nullopt;
    BestReached out;
    for (const StartResult& start : starts) {
        if (start.seed == 0 || start.status == "not run" || start.status == "interrupted") continue;
        ++out.of;
        const auto rank = rank_of(start.result);
        out.starts += rank && rank->first <= 0 && rank->second - least->second <= within * std::abs(least->second);
    }
    if (out.of == 0) return std::nullopt;
    const tolerances::CountedYield share = tolerances::counted_yield(out.starts, out.of, confidence);
    out.least = share.least.within;
    out.most = share.most.within;
    return out;
}

Json best_reached_json(const std::vector<StartResult>& starts) {
    const std::optional<BestReached> reached = best_reached(starts);
    if (!reached) return {};
    return {{"starts", reached->starts}, {"of", reached->of}, {"share_least", reached->least}, {"share_most", reached->most}};
}

Json starts_json(const std::vector<StartResult>& starts) {
    Json list = Json::array();
    for (const StartResult& start : starts) {
        Json row{{"seed", start.seed}};
        add_run(row, start);
        list.push_back(std::move(row));
    }
    return list;
}

std::string starts_text(const std::vector<StartResult>& starts) {
    std::string text;
    for (const StartResult& start : starts) text += "  " + line_of(start) + "\n";
    if (const std::optional<BestReached> reached = best_reached(starts))
        text += formatted("%d of %d random starts reach the best within 0.1%% (of all random starts %.0f to %.0f%%, at 95%% confidence)\n",
                          reached->starts, reached->of, 100 * reached->least, 100 * reached->most);
    return text;
}

}  // namespace fettle::design::cli
