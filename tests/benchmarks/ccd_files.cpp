// SPDX-License-Identifier: MIT
#include "tests/benchmarks/ccd_files.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdarg>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "core/base/units.hpp"
#include "core/ccd/curved_ccd.hpp"
#include "tests/support/ccd_queries.hpp"
#include "tests/support/inclusion_ccd.hpp"

namespace fettle::tests::benchmarks {

namespace {

using Json = nlohmann::ordered_json;
using core::ccd::CurvedCcdOptions;
using core::ccd::DeviationBound;
using core::geometry::PairType;
using support::CcdQueries;
using support::LinearQuery;
using support::RigidQuery;

constexpr int exit_done = 0, exit_missed = 1, exit_bad_input = 3;

struct CcdArguments {
    std::vector<std::string> paths;
    std::string method = "default", minimum_separation = "0", tolerance, deviation = "closed-form", type;
    bool json = false;
};

struct Settings {
    double dmin = 0;
    bool by_inclusion = false;  // of linear queries
    CurvedCcdOptions ccd;
    std::optional<PairType> type;
};

struct Miss {
    std::string file;
    std::size_t query = 0;
};

/// Counts over queries; those of truth over the queries that have one.
struct Tally {
    long queries = 0, with_truth = 0, truth_hits = 0, hits = 0, false_negatives = 0, false_positives = 0;
    std::vector<double> microseconds;  // one per query

    void add(bool hit, const std::optional<bool>& truth, double time) {
        ++queries;
        hits += hit;
        microseconds.push_back(time);
        if (!truth) return;
        ++with_truth;
        truth_hits += *truth;
        false_negatives += *truth && !hit;
        false_positives += !*truth && hit;
    }
    void add(const Tally& other) {
        queries += other.queries;
        with_truth += other.with_truth;
        truth_hits += other.truth_hits;
        hits += other.hits;
        false_negatives += other.false_negatives;
        false_positives += other.false_positives;
        microseconds.insert(microseconds.end(), other.microseconds.begin(), other.microseconds.end());
    }
    double mean() const {
        double sum = 0;
        for (const double t : microseconds) sum += t;
        return sum / static_cast<double>(microseconds.size());
    }
    double median() const {
        std::vector<double> sorted = microseconds;
        const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
        std::nth_element(sorted.begin(), middle, sorted.end());
        return *middle;
    }
    double worst() const { return *std::max_element(microseconds.begin(), microseconds.end()); }
};

/// [us]
template <class Query>
double wall_time(Query&& query) {
    const auto start = std::chrono::steady_clock::now();
    query();
    return std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start).count();
}

/// What reading the clock takes of each measurement: the least of many [us].
double clock_time() {
    double least = wall_time([] {});
    for (int i = 0; i < 1000; ++i) least = std::min(least, wall_time([] {}));
    return least;
}

/// The time of one query, by the wall clock (the processor's own costs more to read than a query). Another process can take the processor
/// away in between: a time that stands out is taken again, and the least counts.
template <class Query>
double query_time(Query&& query, double clock) {
    constexpr double stands_out = 20;  // [us]
    double least = wall_time(query);
    for (int i = 0; i < 2 && least > stands_out; ++i) least = std::min(least, wall_time(query));
    return std::max(0.0, least - clock);
}

Tally run_file(const CcdQueries& queries, const Settings& settings, double clock, std::vector<Miss>& misses) {
    Tally tally;
    const auto ccd = settings.by_inclusion ? &support::inclusion_ccd : &core::ccd::linear_ccd;
    for (std::size_t i = 0; i < queries.linear.size(); ++i) {
        const LinearQuery& q = queries.linear[i];
        core::ccd::LinearCcdResult r;
        const double time = query_time([&] { r = ccd(q.type, q.t0, q.t1, settings.dmin, settings.ccd.linear); }, clock);
        tally.add(r.hit, q.truth, time);
        if (q.truth.value_or(false) && !r.hit) misses.push_back({queries.path, i});
    }
    for (const RigidQuery& q : queries.rigid) {
        core::ccd::CurvedCcdResult r;
        const double time = query_time([&] { r = core::ccd::curved_ccd(q.type, q.a, q.b, q.X, settings.dmin, settings.ccd); }, clock);
        tally.add(r.hit, std::nullopt, time);
    }
    return tally;
}

Json tally_json(const Tally& tally) {
    const auto if_known = [&](long count) { return tally.with_truth > 0 ? Json(count) : Json(); };
    Json json;
    json["queries"] = tally.queries;
    json["queries_with_truth"] = tally.with_truth;
    json["truth_hits"] = if_known(tally.truth_hits);
    json["hits"] = tally.hits;
    json["false_negatives"] = if_known(tally.false_negatives);
    json["false_positives"] = if_known(tally.false_positives);
    json["mean_microseconds"] = tally.mean();
    json["median_microseconds"] = tally.median();
    json["worst_microseconds"] = tally.worst();
    return json;
}

[[gnu::format(printf, 1, 2)]] std::string formatted(const char* format, ...) {
    char text[512];
    va_list arguments;
    va_start(arguments, format);
    std::vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    return text;
}

std::string tally_text(const std::string& name, const Tally& tally) {
    const auto if_known = [&](long count) { return tally.with_truth > 0 ? std::to_string(count) : std::string("-"); };
    return formatted("%8ld %8s %8ld %8s %8s %10.3f %10.3f %10.3f   ", tally.queries, if_known(tally.truth_hits).c_str(), tally.hits,
                     if_known(tally.false_negatives).c_str(), if_known(tally.false_positives).c_str(), tally.mean(), tally.median(),
                     tally.worst()) +
           name + "\n";
}

/// A length with its unit, or a plain number of metres: the files know no unit.
Result<double> length_or_number(const std::string& text, const std::string& where) {
    const bool plain = !text.empty() && text.find_first_not_of("0123456789.+-eE") == std::string::npos;
    return core::base::parse_length(plain ? text + "m" : text, where);
}

Result<Settings> settings_of(const CcdArguments& options) {
    Settings settings;
    Errors errors;
    const Result<double> dmin = length_or_number(options.minimum_separation, "--minimum-separation");
    errors.insert(errors.end(), dmin.errors().begin(), dmin.errors().end());
    if (dmin && *dmin < 0) errors.push_back({ErrorCode::out_of_range, "--minimum-separation", "a separation is not negative"});
    if (dmin) settings.dmin = *dmin;
    if (!options.tolerance.empty()) {
        const Result<double> tolerance = length_or_number(options.tolerance, "--tolerance");
        errors.insert(errors.end(), tolerance.errors().begin(), tolerance.errors().end());
        if (tolerance && !(*tolerance > 0)) errors.push_back({ErrorCode::out_of_range, "--tolerance", "a tolerance is greater than 0"});
        if (tolerance) settings.ccd.linear.tolerance = *tolerance;
    }
    settings.by_inclusion = options.method == "inclusion";
    if (options.deviation == "interval") settings.ccd.deviation = DeviationBound::interval;
    if (!options.type.empty()) settings.type = options.type == "vertex-face" ? PairType::point_triangle : PairType::edge_edge;
    if (!errors.empty()) return errors;
    return settings;
}

Json misses_json(const std::vector<Miss>& misses) {
    constexpr std::size_t most = 100;
    Json json = Json::array();
    for (std::size_t i = 0; i < std::min(most, misses.size()); ++i) json.push_back({{"file", misses[i].file}, {"query", misses[i].query}});
    return json;
}

int input_errors(const Errors& errors, bool as_json) {
    Json json{{"status", "error"}, {"errors", Json::array()}};
    for (const Error& error : errors) {
        json["errors"].push_back({{"where", error.where}, {"message", error.message}});
        std::fprintf(stderr, "error: %s: %s\n", error.where.c_str(), error.message.c_str());
    }
    if (as_json) std::printf("%s\n", json.dump().c_str());
    return exit_bad_input;
}

int run_ccd(const CcdArguments& options) {
    const Result<Settings> settings = settings_of(options);
    if (!settings) return input_errors(settings.errors(), options.json);
    const Result<std::vector<std::string>> files = support::find_ccd_query_files(options.paths);
    if (!files) return input_errors(files.errors(), options.json);
    Tally all;
    std::vector<Miss> misses;
    Json rows = Json::array();
    std::string text = formatted("%8s %8s %8s %8s %8s %10s %10s %10s   %s\n", "queries", "truth", "hits", "missed", "false", "mean us",
                                 "median us", "worst us", "file");
    const double clock = clock_time();
    for (const std::string& path : *files) {
        const Result<CcdQueries> queries = support::read_ccd_queries(path, settings->type);
        if (!queries) return input_errors(queries.errors(), options.json);
        const Tally tally = run_file(*queries, *settings, clock, misses);
        rows.push_back({{"file", path}, {"kind", queries->rigid.empty() ? "linear" : "rigid"}});
        rows.back().update(tally_json(tally));
        text += tally_text(path, tally);
        all.add(tally);
    }
    Json json;
    json["status"] = misses.empty() ? "ok" : "missed";
    json.update(tally_json(all));
    json["method"] = settings->by_inclusion ? "inclusion" : "conservative";
    json["deviation"] = options.deviation;
    json["minimum_separation"] = settings->dmin;
    json["tolerance"] = settings->ccd.linear.tolerance;
    json["missed"] = misses_json(misses);
    json["files"] = rows;
    text += tally_text("in all", all);
    for (const Miss& miss : misses) text += "missed: " + miss.file + ", query " + std::to_string(miss.query) + " (from 0)\n";
    std::printf("%s\n", options.json ? json.dump().c_str() : text.c_str());
    return misses.empty() ? exit_done : exit_missed;
}

}  // namespace

int run_ccd_files(int count, char** words) {
    CLI::App app("Ground-truth collision queries: hits, misses, false alarms, time");
    CcdArguments options;
    app.add_option("QUERIES", options.paths, "Files .csv (linear motion) and .json (rigid motion), or folders of them")->required();
    app.add_flag("--json", options.json, "One JSON object");
    app.add_option("--method", options.method, "Of linear queries: conservative (advancement; the default), inclusion (bisection)")
        ->check(CLI::IsMember({"default", "conservative", "inclusion"}));
    app.add_option("--minimum-separation", options.minimum_separation,
                   "Hit where the distance is at most this: 0.1mm, or a number in the files' own unit (default 0)");
    app.add_option("--tolerance", options.tolerance, "How far above it a hit may be reported (default 1e-6)");
    app.add_option("--deviation", options.deviation, "Of curve from chord in rigid queries: closed-form (default) or interval")
        ->check(CLI::IsMember({"closed-form", "interval"}));
    app.add_option("--type", options.type, "Pairs of .csv files whose folder or name (vf, ee) does not say: vertex-face or edge-edge")
        ->check(CLI::IsMember({"vertex-face", "edge-edge"}));
    app.footer(
        "Example:  ccd_benchmark sample-queries --method inclusion --json\n"
        "CSV: 8 rows a query, xn,xd,yn,yd,zn,zd[,truth], vertices at t0 and at t1; truth also from STEM_mma_bool.json beside the file or\n"
        "in ../mma_bool. JSON: one pair of moving rigid bodies. The truth is that of contact, whatever --minimum-separation; counts of\n"
        "misses and false alarms are null (-) where a file has none. One thread. Exit code 1 if a contact was missed, 0 otherwise.");
    try {
        app.parse(count, words);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? exit_done : exit_bad_input;
    }
    return run_ccd(options);
}

}  // namespace fettle::tests::benchmarks
