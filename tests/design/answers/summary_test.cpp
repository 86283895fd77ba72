// SPDX-License-Identifier: MIT
#include "design/answers/summary.hpp"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "design/description/design.hpp"

namespace fettle::design::answers::summary_test {

using Verdict = SummaryRow::Verdict;

namespace {

SummaryRow row(const std::string& name, Verdict verdict, bool holds = false) {
    SummaryRow out;
    out.name = name;
    out.verdict = verdict;
    out.holds = holds;
    return out;
}

std::string names_of(const std::vector<SummaryRow>& rows) {
    std::string text;
    for (const SummaryRow& each : rows) text += each.name;
    return text;
}

}  // namespace

TEST_CASE("summary: where not all rows are shown, what is violated or in doubt is, then what holds, then what is wanted; in their order") {
    const std::vector<SummaryRow> rows{row("a", Verdict::met),      row("b", Verdict::met, true), row("c", Verdict::in_doubt),
                                       row("d", Verdict::violated), row("e", Verdict::wanted),    row("f", Verdict::met)};
    CHECK(names_of(chosen_rows(rows, 9)) == "abcdef");
    CHECK(names_of(chosen_rows(rows, 5)) == "abcde");
    CHECK(names_of(chosen_rows(rows, 4)) == "bcde");
    CHECK(names_of(chosen_rows(rows, 3)) == "bcd");
    CHECK(names_of(chosen_rows(rows, 2)) == "cd");
    CHECK(names_of(chosen_rows(rows, 1)) == "d");
}

TEST_CASE("summary: a search that has found nothing says so, and why; nothing is met") {
    studies::OptimiseOutcome outcome;
    outcome.report.status = optimisers::OptimiserStatus::infeasible;
    outcome.report.message = "no start";
    outcome.report.evaluations = 3;
    const Summary summary = summary_of({}, outcome, {});
    CHECK(summary.sentence == "No design could be evaluated (3 designs tried).");
    CHECK(summary.why == "no start");
    CHECK_FALSE(summary.is_good);
    CHECK(summary_json(summary)["rows"].empty());
}

TEST_CASE("summary: only what is optimal, without a doubt, is done") {
    studies::OptimiseOutcome outcome;
    outcome.report.status = optimisers::OptimiserStatus::optimal;
    outcome.report.best.usable = outcome.report.feasible = true;
    outcome.report.evaluations = 1;
    CHECK(summary_of({}, outcome, {}).is_good);
    CHECK(summary_of({}, outcome, {}).sentence == "Done: nothing is required (1 design tried). No better design near by.");
    outcome.in_doubt = {0};
    CHECK_FALSE(summary_of({}, outcome, {}).is_good);
    CHECK(summary_of({}, outcome, {}).sentence == "As simulated nothing is required (1 design tried).");
    CHECK(summary_of({}, outcome, {}).why.find("in doubt: ") == 0);
    outcome.in_doubt.clear();
    outcome.report.status = optimisers::OptimiserStatus::feasible;
    CHECK_FALSE(summary_of({}, outcome, {}).is_good);
}

}  // namespace fettle::design::answers::summary_test
