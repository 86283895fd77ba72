// SPDX-License-Identifier: MIT
#include "design/cli/optimise_choices.hpp"

#include <algorithm>
#include <filesystem>
#include <limits>

#include "core/base/text.hpp"
#include "core/files/atomic_file.hpp"
#include "design/reading/design_text.hpp"
#include "design/studies/random_start.hpp"

namespace fettle::design::cli {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using core::base::formatted;
using description::Choice;
using description::Combination;

// "slots=6,material=PLA", or by the options' numbers where that is no good name.
std::string folder_of(const std::vector<Choice>& choices, const Combination& combination) {
    constexpr std::size_t longest = 120;
    std::string name, numbers = "choice";
    for (std::size_t k = 0; k < choices.size(); ++k) {
        name += (k == 0 ? "" : ",") + choices[k].name + "=" + choices[k].options[static_cast<std::size_t>(combination[k])];
        numbers += "-" + std::to_string(combination[k] + 1);
    }
    const bool is_plain = std::all_of(name.begin(), name.end(), [](char c) {
        return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || std::string_view("_-.,=").find(c) < 5;
    });
    return is_plain && name.size() <= longest ? name : numbers;
}

// The values that a run has ended with, as far as this design takes them; else its own.
VectorX values_from(const ChoiceResult* best, const reading::DesignFile& file, const reading::DesignReadOptions& options) {
    VectorX values = description::values_of(file.design.parameters);
    if (best == nullptr) return values;
    const Result<reading::DesignFile> tuned = reading::read_design((fs::path(best->out) / "design.final.json").string(), options);
    if (!tuned || tuned->design.parameters.size() != file.design.parameters.size()) return values;
    for (std::size_t k = 0; k < file.design.parameters.size(); ++k) {
        const description::Parameter& parameter = file.design.parameters[k];
        values[static_cast<Eigen::Index>(k)] = std::clamp(tuned->design.parameters[k].value, parameter.lower, parameter.upper);
    }
    return values;
}

// The design with these options; where it cannot be made as it stands, from the first values among those of the best run and of some
// samples where it can be.
Result<reading::DesignFile> with_options(const reading::DesignFile& file, const Combination& combination, const ChoiceResult* best,
                                         const reading::DesignReadOptions& options) {
    constexpr std::uint64_t most_samples = 16;
    const auto read = [&](const VectorX& values) {
        return reading::parse_design(reading::text_with_choices(file, combination, values), file.path, options);
    };
    Result<reading::DesignFile> as_written = read({});
    if (as_written) return as_written;
    if (Result<reading::DesignFile> found = read(values_from(best, file, options)); found) return found;
    for (std::uint64_t seed = 1; seed <= most_samples; ++seed)
        if (Result<reading::DesignFile> found = read(studies::sample_of_seed(file.design, seed)); found) return found;
    return as_written;
}

// Writes what the run of a combination begins with. @return why it cannot be
Errors write_start(const reading::DesignFile& file, const Combination& combination, const ChoiceResult* best, const fs::path& folder,
                   const reading::DesignReadOptions& options) {
    const Result<reading::DesignFile> chosen = with_options(file, combination, best, options);
    if (!chosen) return chosen.errors();
    VectorX values = values_from(best, *chosen, options);
    if (!reading::parse_design(reading::text_with_choices(*chosen, combination, values), file.path, options))
        values = description::values_of(chosen->design.parameters);
    std::error_code fault;
    fs::create_directories(folder, fault);
    if (fault) return {{ErrorCode::file_unwritable, folder.string(), fault.message()}};
    return core::files::write_file_atomically(folder / "start.design.json", reading::design_text(*chosen, values, folder.string()));
}

studies::ChoiceOutcome outcome_of(const RunResult& run) {
    const auto rank = rank_of(run.result);
    return rank ? studies::ChoiceOutcome{true, rank->first, rank->second} : studies::ChoiceOutcome{};
}

// The best first, those without a design last, in the order in which they were asked for.
std::vector<std::size_t> ranking(const ChoicesTried& tried) {
    std::vector<std::size_t> order(tried.runs.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::stable_sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) {
        return studies::is_better(outcome_of(tried.runs[i]), outcome_of(tried.runs[j]));
    });
    return order;
}

// Why a part cannot be made takes lines.
std::string shortened(std::string line) {
    constexpr std::size_t longest = 160;
    if (line.size() <= longest) return line;
    std::size_t end = longest;
    while (end > 0 && (static_cast<unsigned char>(line[end]) & 0xC0U) == 0x80U) --end;  // within a character
    return line.substr(0, end) + " ...";
}

}  // namespace

Result<ChoicesTried> try_choices(const reading::DesignFile& file, const ChoicesRequest& request, const RunSettings& settings,
                                 const CommonOptions& common, Console& console) {
    Result<studies::ChoiceSearch> search = studies::ChoiceSearch::create(file.choices, file.conditions, request.most);
    if (!search) return search.errors();
    ChoicesTried tried;
    tried.allowed = search->allowed();
    tried.combinations = search->combinations();
    for (std::vector<Combination> round = search->next(); !round.empty() && !interrupted(); round = search->next()) {
        const ChoiceResult* best = search->best() ? &tried.runs[*search->best()] : nullptr;
        std::vector<RunRequest> requests;
        std::vector<ChoiceResult> results;
        std::vector<std::size_t> of_request;
        for (const Combination& combination : round) {
            const fs::path folder = fs::path(request.out) / folder_of(file.choices, combination);
            const std::string design = (folder / "start.design.json").string();
            RunRequest run{description::text_of(file.choices, combination), design, folder.string(), request.words};
            run.words.emplace_back("--keep-choices");
            ChoiceResult result{{run.name, run.out, "not run", "", Json(), 0}, combination, design};
            if (const Errors errors = write_start(file, combination, best, folder, request.read); errors.empty()) {
                of_request.push_back(results.size());
                requests.push_back(std::move(run));
            } else {
                static_cast<RunResult&>(result) = failed_run(run, errors.front().where + ": " + errors.front().message);
                console.narrate(line_of(result));
            }
            results.push_back(std::move(result));
        }
        std::vector<RunResult> ended = run_together(requests, settings, common, console);
        for (std::size_t i = 0; i < ended.size(); ++i) static_cast<RunResult&>(results[of_request[i]]) = std::move(ended[i]);
        tried.runs.insert(tried.runs.end(), results.begin(), results.end());
        if (interrupted()) break;
        std::vector<studies::ChoiceOutcome> outcomes;
        for (const ChoiceResult& result : results) outcomes.push_back(outcome_of(result));
        search->tell(outcomes);
    }
    tried.was_stopped = interrupted();
    tried.best = best_run(tried.runs);
    tried.are_all = !tried.was_stopped && tried.runs.size() == tried.allowed;
    tried.is_local = !tried.was_stopped && search->is_local_optimum();
    return tried;
}

std::string choices_heading(const reading::DesignFile& file, const ChoicesTried& tried) {
    const auto ended = std::count_if(tried.runs.begin(), tried.runs.end(), [](const ChoiceResult& run) { return run.status != "not run"; });
    const std::string count = core::base::counted(static_cast<std::size_t>(ended), "combination");
    if (!tried.best) return "none of the " + count + " tried gave a design";
    std::string text = (tried.was_stopped ? "the best so far, of " : "best of the ") + count + " tried, " +
                       description::text_of(file.choices, tried.runs[*tried.best].combination);
    if (tried.was_stopped) return text;
    if (tried.are_all) {
        text += tried.combinations == static_cast<long long>(tried.allowed)
                    ? ": there are no others"
                    : formatted(": the others of %lld break a relation", tried.combinations);
    } else {
        text += tried.is_local ? "; none of its neighbours is better" : "; not all its neighbours were tried (--combinations)";
    }
    return text;
}

std::string choices_text(const ChoicesTried& tried) {
    constexpr std::size_t most = 12;
    const std::vector<std::size_t> order = ranking(tried);
    std::string text;
    for (std::size_t i = 0; i < std::min(most, order.size()); ++i) text += "  " + shortened(line_of(tried.runs[order[i]])) + "\n";
    if (order.size() > most) text += formatted("  and %zu more (--json has all)\n", order.size() - most);
    return text;
}

Json choices_json(const reading::DesignFile& file, const ChoicesTried& tried) {
    const auto options = [&](const Combination& combination) {
        Json out = Json::object();
        for (std::size_t k = 0; k < file.choices.size(); ++k) {
            const Choice& choice = file.choices[k];
            const std::string& option = choice.options[static_cast<std::size_t>(combination[k])];
            out[choice.name] = choice.is_ordered ? Json::parse(option) : Json(option);
        }
        return out;
    };
    Json rows = Json::array();
    for (const std::size_t i : ranking(tried)) {
        Json row{{"options", options(tried.runs[i].combination)}};
        add_run(row, tried.runs[i]);
        rows.push_back(std::move(row));
    }
    return {{"best", tried.best ? options(tried.runs[*tried.best].combination) : Json()},
            {"combinations", tried.combinations},
            {"allowed", tried.allowed},
            {"are_all_tried", tried.are_all},
            {"no_neighbour_is_better", tried.are_all || tried.is_local},
            {"tried", std::move(rows)}};
}

}  // namespace fettle::design::cli
