// SPDX-License-Identifier: MIT
#include "design/studies/history.hpp"

#include <sys/resource.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "design/optimisers/optimisation.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/text.hpp"

namespace fettle::design::studies::history_test {

namespace {

namespace optimisers = fettle::design::optimisers;
using fettle::tests::support::contents;

struct Folder : tests::support::TemporaryFolder {
    std::string file() const { return TemporaryFolder::file("history.jsonl"); }
};

void overwrite(const std::string& path, const std::string& text) { std::ofstream(path, std::ios::binary) << text; }

bool same_bits(const VectorX& a, const VectorX& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), static_cast<size_t>(a.size()) * sizeof(double)) == 0;
}

HistoryHeader rosenbrock_header() { return {"0123456789abcdef", {"x", "y"}, {"disc"}}; }

// Rosenbrock's valley inside a disc that cuts off its minimum; nothing here is a round number.
HistoryEntry rosenbrock(const VectorX& p) {
    HistoryEntry entry;
    entry.point = p;
    optimisers::Evaluation& e = entry.evaluation;
    if (p[0] + p[1] > 1.55) {
        e.reason = "too \"far\"\nout";
        return entry;
    }
    const double a = p[1] - p[0] * p[0], b = 1 - p[0];
    e.usable = true;
    e.objective = 10 * a * a + b * b + 1e-3 * std::sin(7 * p[0]);
    e.gradient = Vector2(-40 * a * p[0] - 2 * b + 7e-3 * std::cos(7 * p[0]), 20 * a);
    e.constraints = VectorX::Constant(1, p.squaredNorm());
    e.jacobian = 2 * p.transpose();
    e.violation = std::max(0.0, p.squaredNorm() - 1.0);
    entry.terms = {{"valley", 10 * a * a}};
    entry.certified = {{"disc", p.squaredNorm()}};
    entry.forward_seconds = 0.1;
    return entry;
}

struct Run {
    optimisers::OptimiserReport report;
    int computed = 0;
};

struct Killed : std::exception {};

// A run that dies in the middle of its `kill_at`-th computation (never, if negative).
Result<Run> run(const Folder& folder, const std::string& name, LineFileMode mode, int kill_at = -1) {
    Result<History> history = History::open(folder.path.string(), rosenbrock_header(), mode);
    if (!history) return history.errors();
    Run result;
    optimisers::Problem problem;
    problem.start = Vector2(-0.6, 0.3);
    problem.lower = Vector2(-1.3, -1.1);
    problem.upper = Vector2(1.7, 1.9);
    problem.constraint_lower = VectorX::Constant(1, -INFINITY);
    problem.constraint_upper = VectorX::Constant(1, 1 - 1e-6);
    problem.evaluate = recorded(*history, [&](const VectorX& p) {
        if (++result.computed == kill_at) throw Killed();
        return rosenbrock(p);
    });
    optimisers::OptimiserOptions options;
    options.tolerance = 1e-6;
    auto optimiser = optimisers::make_optimiser(name);
    result.report = optimisers::optimise(problem, **optimiser, options);
    return result;
}

}  // namespace

TEST_CASE("a run killed anywhere and resumed ends with the same design, bit for bit") {
    for (const std::string& name : optimisers::optimiser_names()) {
        INFO(name);
        const Folder whole;
        const Result<Run> reference = run(whole, name, LineFileMode::fresh);
        REQUIRE(reference);
        REQUIRE(reference->computed > 6);
        CHECK(reference->report.feasible);
        for (const int kill_at : {1, 2, 5, reference->computed}) {
            const Folder folder;
            CHECK_THROWS_AS(run(folder, name, LineFileMode::fresh, kill_at), Killed);
            overwrite(folder.file(), contents(folder.file()) + "{\"evaluation\": 99, \"usab");  // killed while writing
            const Result<Run> resumed = run(folder, name, LineFileMode::resume);
            REQUIRE(resumed);
            CHECK(resumed->computed == reference->computed - (kill_at - 1));
            CHECK(resumed->report.evaluations == reference->report.evaluations);
            CHECK(same_bits(resumed->report.point, reference->report.point));
            CHECK(resumed->report.status == reference->report.status);
            CHECK(contents(folder.file()) == contents(whole.file()));
        }
    }
}

TEST_CASE("a history reads back bit for bit") {
    const Folder folder;
    HistoryEntry entry = rosenbrock(Vector2(0.1, -0.7));
    entry.point = Vector2(5e-324, -0.0);
    entry.evaluation.objective = 1.7976931348623157e308;
    entry.evaluation.gradient = Vector2(0.1 + 0.2, std::nextafter(1.0, 2.0));
    entry.evaluation.jacobian << 1.0 / 3, -2.2250738585072014e-308;
    entry.evaluation.constraint_branches = {{0, 0}, Vector2(1.0 / 7, 1e-300), MatrixX{{0.1, -0.0}, {2.0 / 3, 1e300}}};
    entry.evaluation.objective_branches = {{3}, VectorX::Constant(1, 0.3 - 0.1), MatrixX{{1.0 / 11, -5e-324}}};
    {
        Result<History> history = History::open(folder.path.string(), rosenbrock_header(), LineFileMode::fresh);
        REQUIRE(history);
        history->append(entry);
        history->append(rosenbrock(Vector2(2, 2)));
    }
    const Result<History> again = History::open(folder.path.string(), rosenbrock_header(), LineFileMode::resume);
    REQUIRE(again);
    REQUIRE(again->replayed().size() == 2);
    const HistoryEntry& read = again->replayed()[0];
    CHECK(same_bits(read.point, entry.point));
    CHECK(read.evaluation.objective == entry.evaluation.objective);
    CHECK(same_bits(read.evaluation.gradient, entry.evaluation.gradient));
    CHECK(same_bits(read.evaluation.jacobian.transpose(), entry.evaluation.jacobian.transpose()));
    for (const auto branches : {&optimisers::Evaluation::constraint_branches, &optimisers::Evaluation::objective_branches}) {
        const optimisers::Branches &back = read.evaluation.*branches, &written = entry.evaluation.*branches;
        CHECK(back.of == written.of);
        CHECK(same_bits(back.values, written.values));
        CHECK(same_bits(back.jacobian.reshaped(), written.jacobian.reshaped()));
        CHECK((again->replayed()[1].evaluation.*branches).of.empty());
    }
    CHECK(read.terms == entry.terms);
    CHECK_FALSE(again->replayed()[1].evaluation.usable);
    CHECK(again->replayed()[1].evaluation.reason == "too \"far\"\nout");
}

TEST_CASE("a history of another design is refused, damage is named, nothing is lost") {
    const Folder folder;
    { REQUIRE(run(folder, "mma", LineFileMode::fresh)); }
    const std::string first = contents(folder.file());

    HistoryHeader other = rosenbrock_header();
    other.design_hash = "fedcba9876543210";
    const Result<History> refused = History::open(folder.path.string(), other, LineFileMode::resume);
    REQUIRE_FALSE(refused);
    CHECK(refused.errors()[0].code == ErrorCode::inconsistent);
    CHECK(contents(folder.file()) == first);

    const std::filesystem::path link = folder.path / "history.1.jsonl";
    std::filesystem::create_symlink("nowhere", link);  // somebody's: not replaced
    {
        const Result<History> fresh = History::open(folder.path.string(), other, LineFileMode::fresh);
        REQUIRE(fresh);
        CHECK(contents(fresh->kept_as()) == first);
        CHECK(std::filesystem::is_symlink(link));
        const Result<History> second = History::open(folder.path.string(), other, LineFileMode::resume);
        REQUIRE_FALSE(second);  // locked
        CHECK(second.errors()[0].message.find("another process") != std::string::npos);
    }

    std::string damaged = first;
    damaged[damaged.find("\"usable\"") + 1] = 'X';
    overwrite(folder.file(), damaged);
    const Result<History> broken = History::open(folder.path.string(), rosenbrock_header(), LineFileMode::resume);
    REQUIRE_FALSE(broken);
    CHECK(broken.errors()[0].where.find("line 2") != std::string::npos);
    // Headers that are JSON, but not one of ours.
    const std::string rest = first.substr(first.find('\n'));
    for (const char* header : {"null", "[]", "7", "{\"fettle_history\": null}", "{\"fettle_history\": \"1\"}", "{\"fettle_history\": 1}",
                               "{\"fettle_history\": 1, \"design\": null}", "{\"fettle_history\": 1, \"design\": 5, \"parameters\": {}}"}) {
        overwrite(folder.file(), header + rest);
        CAPTURE(header);
        CHECK_FALSE(History::open(folder.path.string(), rosenbrock_header(), LineFileMode::resume));
    }
}

TEST_CASE("a history that cannot be written keeps what it has, and is whole once it can") {
    const Folder folder;
    Result<History> history = History::open(folder.path.string(), rosenbrock_header(), LineFileMode::fresh);
    REQUIRE(history);
    struct rlimit limit {};
    REQUIRE(::getrlimit(RLIMIT_FSIZE, &limit) == 0);
    const auto handler = std::signal(SIGXFSZ, SIG_IGN);
    struct rlimit full = limit;
    full.rlim_cur = std::filesystem::file_size(folder.file()) + 10;  // a part of the line fits
    REQUIRE(::setrlimit(RLIMIT_FSIZE, &full) == 0);
    history->append(rosenbrock(Vector2(0.1, 0.2)));
    const Errors fault = history->unwritten();
    history->append(rosenbrock(Vector2(0.3, 0.2)));
    REQUIRE(::setrlimit(RLIMIT_FSIZE, &limit) == 0);
    std::signal(SIGXFSZ, handler);
    REQUIRE(fault.size() == 1);
    CHECK(fault[0].code == ErrorCode::file_unwritable);
    CHECK(fault[0].where == folder.file());
    history->append(rosenbrock(Vector2(2, 2)));
    CHECK(history->unwritten().empty());
    *history = *History::open((folder.path / "elsewhere").string(), rosenbrock_header(), LineFileMode::fresh);  // lets go of the file
    const Result<History> again = History::open(folder.path.string(), rosenbrock_header(), LineFileMode::resume);
    REQUIRE(again);
    CHECK(again->replayed().size() == 3);
}

}  // namespace fettle::design::studies::history_test
