// SPDX-License-Identifier: MIT
#include "design/studies/exploration.hpp"

#include <atomic>
#include <charconv>
#include <chrono>
#include <cmath>
#include <mutex>
#include <new>
#include <optional>
#include <string_view>
#include <unordered_set>
#include <utility>

#include "core/base/parallel.hpp"
#include "core/base/stop.hpp"
#include "core/base/text.hpp"
#include "core/files/hash.hpp"
#include "core/files/nearest_word.hpp"
#include "design/studies/optimise_design.hpp"
#include "design/studies/random_start.hpp"
#include "design/studies/starting_sides.hpp"

namespace fettle::design::studies {

namespace {

using Json = nlohmann::ordered_json;
using core::base::formatted;
using JobKind = ExplorationJob::Kind;

// --- what to explore

constexpr const char* sweep_forms = "NAME=COUNT or NAME=LOW:HIGH:COUNT is expected; ";

template <class Number>
std::optional<Number> number_from(std::string_view text) {
    Number value{};
    const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
    return fault == std::errc() && end == text.data() + text.size() ? std::optional(value) : std::nullopt;
}

std::optional<Eigen::Index> index_of(const std::string& name, const std::vector<description::Parameter>& parameters) {
    for (std::size_t k = 0; k < parameters.size(); ++k)
        if (parameters[k].name == name) return static_cast<Eigen::Index>(k);
    return std::nullopt;
}

Error unknown_parameter(const std::string& name, const std::string& where, const std::vector<description::Parameter>& parameters) {
    std::vector<std::string_view> names;
    for (const description::Parameter& p : parameters) names.push_back(p.name);
    return {ErrorCode::unknown_key, where, "there is no parameter '" + name + "'; " + core::files::did_you_mean(name, names, '\'')};
}

VectorX evenly(double low, double high, int count) {
    return count == 1 ? VectorX(VectorX::Constant(1, low)) : VectorX(VectorX::LinSpaced(count, low, high));
}

VectorX values_of_sweep(const SweptParameter& swept, const description::Parameter& parameter) {
    return swept.values.size() > 0 ? swept.values : evenly(parameter.lower, parameter.upper, swept.count);
}

Error too_many(const std::string& where, double designs) {
    return {ErrorCode::out_of_range, where, formatted("%.0f designs are not allowed: up to %d are", designs, most_designs)};
}

Errors sweep_faults(const std::vector<SweptParameter>& sweep, const std::vector<description::Parameter>& parameters) {
    Errors errors;
    double designs = 1;
    for (std::size_t i = 0; i < sweep.size(); ++i) {
        const SweptParameter& swept = sweep[i];
        const double count = swept.values.size() > 0 ? static_cast<double>(swept.values.size()) : swept.count;
        designs *= count;
        if (!index_of(swept.name, parameters)) {
            errors.push_back(unknown_parameter(swept.name, swept.where, parameters));
        } else if (count < 1) {
            errors.push_back({ErrorCode::out_of_range, swept.where, formatted("%.0f values are not allowed: 1 or more are", count)});
        } else if (!swept.values.allFinite()) {
            errors.push_back({ErrorCode::not_finite, swept.where, "the values are finite numbers"});
        }
        for (std::size_t j = 0; j < i; ++j)
            if (sweep[j].name == swept.name)
                errors.push_back({ErrorCode::inconsistent, swept.where, "this parameter is swept twice; give it once"});
    }
    if (errors.empty() && designs > most_designs) errors.push_back(too_many(sweep.back().where, designs));
    return errors;
}

// Every combination, the last parameter's values running fastest.
Errors add_sweep(const problem::DesignProblem& problem, const std::vector<SweptParameter>& sweep, std::vector<ExplorationJob>& jobs) {
    const std::vector<description::Parameter>& parameters = problem.design().parameters;
    std::vector<Eigen::Index> places;
    std::vector<VectorX> values;
    for (const SweptParameter& swept : sweep) {
        places.push_back(*index_of(swept.name, parameters));
        values.push_back(values_of_sweep(swept, parameters[static_cast<std::size_t>(places.back())]));
    }
    std::vector<Eigen::Index> at(sweep.size(), 0);
    for (bool more = !sweep.empty(); more;) {
        VectorX point = description::values_of(parameters);
        for (std::size_t i = 0; i < sweep.size(); ++i) point[places[i]] = values[i][at[i]];
        if (Errors errors = description::check_values(parameters, point); !errors.empty()) return errors;
        jobs.push_back({JobKind::evaluate, std::move(point)});
        more = false;
        for (std::size_t i = sweep.size(); i-- > 0 && !more;) {
            more = ++at[i] < values[i].size();
            if (!more) at[i] = 0;
        }
    }
    return {};
}

// --- what comes of a job

Json finite_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(); }

template <class Named>
Json values_json(const std::vector<Named>& named, const std::vector<description::Measurement>& measured) {
    Json json = Json::object();
    for (std::size_t i = 0; i < named.size(); ++i) json[named[i].name] = finite_or_null(measured[i].value);
    return json;
}

void add_measured(Json& json, const description::Design& design, const problem::DesignEvaluation& at) {
    json["objective"] = finite_or_null(at.objective);
    json["violation"] = finite_or_null(at.violation);
    json["terms"] = values_json(design.objective, at.terms);
    json["constraints"] = values_json(design.constraints, at.constraints);
    json["certified"] = Json::object();
    for (std::size_t i = 0; i < design.constraints.size(); ++i)
        if (at.constraints[i].is_proven) json["certified"][design.constraints[i].name] = finite_or_null(at.constraints[i].lower);
}

Json parameters_json(const description::Design& design, const VectorX& point) {
    Json json = Json::object();
    for (std::size_t k = 0; k < design.parameters.size(); ++k) json[design.parameters[k].name] = point[static_cast<Eigen::Index>(k)];
    return json;
}

void add_evaluation(Json& json, const problem::DesignProblem& problem, const ExplorationJob& job,
                    const std::function<bool()>& should_stop) {
    json["parameters"] = parameters_json(problem.design(), job.point);
    problem::EvaluateOptions options;
    options.gradients = false;
    options.should_stop = should_stop;
    const problem::DesignEvaluation at = problem.evaluate(job.point, options);
    if (at.interrupted) throw core::base::Stopped();
    if (!at.usable) {
        json["status"] = "unusable";
        json["reason"] = at.reason;
        return;
    }
    json["status"] = at.violation <= 0 ? "feasible" : "infeasible";
    add_measured(json, problem.design(), at);
}

void add_optimum(Json& json, const problem::DesignProblem& problem, const ExplorationJob& job, const std::function<bool()>& should_stop) {
    const Result<problem::DesignProblem> begun = problem_of_seed(problem, job.seed);
    OptimiseOptions options;
    options.seed = job.seed;
    options.should_stop = should_stop;
    const Result<OptimiseOutcome> outcome = begun ? optimise_design(*begun, options) : Result<OptimiseOutcome>(begun.errors());
    if (!outcome) {
        json["status"] = "failed";
        json["reason"] = outcome.errors().front().message;
        return;
    }
    if (outcome->report.status == optimisers::OptimiserStatus::interrupted) throw core::base::Stopped();
    json["parameters"] = parameters_json(problem.design(), outcome->report.point);
    json["status"] = optimisers::to_string(outcome->report.status);
    json["reason"] = outcome->report.message;
    json["evaluations"] = outcome->report.evaluations;
    for (const core::model::JointSide& side : outcome->sides) json["sides"][side.joint] = core::model::to_string(side.assemble.side);
    if (outcome->final.usable) add_measured(json, problem.design(), outcome->final);
}

Json begun_result(const ExplorationJob& job) { return {{"key", job.key()}, {"kind", to_string(job.kind)}, {"seed", job.seed}}; }

}  // namespace

const char* to_string(ExplorationJob::Kind kind) { return kind == JobKind::evaluate ? "evaluate" : "optimise"; }

std::string ExplorationJob::key() const {
    std::string text = std::string(to_string(kind)) + " " + std::to_string(seed);
    for (const double x : point) text += formatted(" %a", x);
    return core::files::hash_of(text);
}

Result<SweptParameter> parse_sweep(const std::string& text, const std::vector<description::Parameter>& parameters) {
    SweptParameter swept;
    swept.where = "--sweep " + text;
    const auto refuse = [&](ErrorCode code, const std::string& message) { return Error{code, swept.where, message}; };
    const std::size_t equals = text.rfind('=');
    std::vector<std::string_view> words;
    if (equals != std::string::npos && equals > 0) {
        swept.name = text.substr(0, equals);
        std::string_view rest = std::string_view(text).substr(equals + 1);
        for (std::size_t colon; (colon = rest.find(':')) != std::string_view::npos; rest.remove_prefix(colon + 1))
            words.push_back(rest.substr(0, colon));
        words.push_back(rest);
    }
    if (words.size() != 1 && words.size() != 3)
        return refuse(ErrorCode::parse, std::string(sweep_forms).substr(0, std::string(sweep_forms).size() - 2));
    const std::optional<long long> count = number_from<long long>(words.back());
    if (!count)
        return refuse(ErrorCode::parse, sweep_forms + std::string("COUNT is a whole number, found '") + std::string(words.back()) + "'");
    if (*count < 1) return refuse(ErrorCode::out_of_range, std::to_string(*count) + " values are not allowed: 1 or more are");
    if (*count > most_designs) return Errors{too_many(swept.where, static_cast<double>(*count))};
    swept.count = static_cast<int>(*count);
    const std::optional<Eigen::Index> place = index_of(swept.name, parameters);
    if (!place) return Errors{unknown_parameter(swept.name, swept.where, parameters)};
    if (words.size() == 1) return swept;
    const description::Parameter& parameter = parameters[static_cast<std::size_t>(*place)];
    VectorX ends(2);
    for (int i = 0; i < 2; ++i) {
        const std::optional<double> end = number_from<double>(words[static_cast<std::size_t>(i)]);
        if (!end)
            return refuse(ErrorCode::parse, sweep_forms + std::string(i == 0 ? "LOW" : "HIGH") +
                                                " is a number, in the parameter's own unit and without it, found '" +
                                                std::string(words[static_cast<std::size_t>(i)]) + "'");
        if (!std::isfinite(*end)) return refuse(ErrorCode::not_finite, "both ends are finite numbers");
        ends[i] = core::base::to_si(*end, parameter.unit);
    }
    const int looked_at = swept.count == 1 ? 1 : 2;  // a single value is the lower end
    for (int i = 0; i < looked_at; ++i) {
        if (description::check_values({parameter}, VectorX::Constant(1, ends[i])).empty()) continue;
        const std::string unit = parameter.unit.name.empty() ? "" : " " + std::string(parameter.unit.name);
        const double lower = description::from_si(parameter.lower, parameter.unit),
                     upper = description::from_si(parameter.upper, parameter.unit);
        return refuse(
            ErrorCode::out_of_range,
            formatted("%g%s is far outside the bounds, %g%s to %g%s: farther than they are apart. If it is meant, widen the bounds",
                      description::from_si(ends[i], parameter.unit), unit.c_str(), lower, unit.c_str(), upper, unit.c_str()));
    }
    swept.values = evenly(ends[0], ends[1], swept.count);
    return swept;
}

Result<std::vector<ExplorationJob>> jobs_of(const problem::DesignProblem& problem, const ExplorationRequest& request) {
    Errors errors;
    for (const auto& [name, count] : {std::pair("samples", request.samples), std::pair("starts", request.starts)}) {
        if (count < 0)
            errors.push_back({ErrorCode::out_of_range, name, std::to_string(count) + " is not allowed: 0 or more is"});
        else if (count > most_designs)
            errors.push_back(too_many(name, count));
    }
    const Errors of_sweep = sweep_faults(request.sweep, problem.design().parameters);
    errors.insert(errors.end(), of_sweep.begin(), of_sweep.end());
    if (!errors.empty()) return errors;
    if (request.sweep.empty() && request.samples == 0 && request.starts == 0)
        return Error{ErrorCode::missing_key, "command line", "nothing to explore: give --sweep, --samples or --starts"};
    std::vector<ExplorationJob> all;
    if (Errors faults = add_sweep(problem, request.sweep, all); !faults.empty()) return faults;
    const std::vector<std::uint64_t> seeds = seeds_of_list(request.seed, 1 + std::max(request.samples, request.starts));
    for (int k = 1; k <= request.samples; ++k)
        all.push_back({JobKind::evaluate, sample_of_seed(problem.design(), seeds[static_cast<std::size_t>(k)])});
    for (int k = 0; k < request.starts; ++k) all.push_back({JobKind::optimise, {}, seeds[static_cast<std::size_t>(k)]});
    std::unordered_set<std::string> keys;
    std::vector<ExplorationJob> jobs;
    for (ExplorationJob& job : all)
        if (keys.insert(job.key()).second) jobs.push_back(std::move(job));
    return jobs;
}

Json result_of(const problem::DesignProblem& problem, const ExplorationJob& job, const std::function<bool()>& should_stop) {
    const auto begin = std::chrono::steady_clock::now();
    Json json = begun_result(job);
    try {
        if (job.kind == JobKind::evaluate)
            add_evaluation(json, problem, job, should_stop);
        else
            add_optimum(json, problem, job, should_stop);
    } catch (const core::base::Stopped&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& fault) {
        json = begun_result(job);
        json["status"] = "failed";
        json["reason"] = fault.what();
    }
    json["seconds"] = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return json;
}

Json lost_result(const ExplorationJob& job, const std::string& reason) {
    Json json = begun_result(job);
    json["status"] = "lost";
    json["reason"] = reason;
    return json;
}

std::string progress_text(int done, int of, const Json& result) {
    std::string text = formatted("design %d of %d is ", done, of) + result.at("status").get<std::string>();
    if (result.contains("objective") && result["objective"].is_number())
        return text + formatted(", objective %.6g", result["objective"].get<double>());
    return result.contains("reason") ? text + ": " + result["reason"].get<std::string>() : text;
}

Explored explore(const problem::DesignProblem& problem, const std::vector<ExplorationJob>& jobs, ExplorationFile& file,
                 const ExploreOptions& options) {
    Explored out;
    std::vector<const ExplorationJob*> wanted;
    for (const ExplorationJob& job : jobs)
        if (!file.has(job.key())) wanted.push_back(&job);
    std::mutex one_at_a_time;
    std::atomic<bool> stop = false;
    const auto should_stop = [&] {
        if (stop) return true;
        const std::lock_guard lock(one_at_a_time);
        if (options.should_stop && options.should_stop()) stop = out.interrupted = true;
        return stop.load();
    };
    int done = count_of(jobs) - count_of(wanted);
    core::base::parallel_for(count_of(wanted), 1, [&](int i) {
        if (should_stop()) return;
        Json result;
        try {
            result = result_of(problem, *wanted[static_cast<std::size_t>(i)], should_stop);
        } catch (const core::base::Stopped&) {
            return;
        }
        const std::lock_guard lock(one_at_a_time);
        if (!out.unwritten.empty()) return;
        file.append(result);
        ++done;
        out.unwritten = file.unwritten();
        if (!out.unwritten.empty())
            stop = true;
        else if (options.on_result)
            options.on_result(done, count_of(jobs), result);
    });
    return out;
}

}  // namespace fettle::design::studies
