// SPDX-License-Identifier: MIT
// The verdict on an audit of gradients names every cause.
#include "design/answers/check_faults.hpp"

#include <catch2/catch.hpp>
#include <limits>

namespace fettle::design::answers::check_faults_test {

namespace {

using gradient_audit::CheckReport;
using gradient_audit::CheckRow;
using gradient_audit::LineRow;

CheckRow row(const char* parameter, double error) {
    CheckRow out;
    out.quantity = "objective";
    out.parameter = parameter;
    out.relative_error = error;
    return out;
}

CheckReport good_report() {
    CheckReport report;
    report.rows = {row("length", 1e-8), row("width", 2e-8)};
    return report;
}

}  // namespace

TEST_CASE("verdict on a check: passed") {
    CHECK(check_faults(good_report(), 1e-5).empty());
    CHECK(verdict_text(good_report(), 1e-5) == "check passed (limit 1e-05)\n");
}

TEST_CASE("verdict on a check: sweeps that differ where all differences agree") {
    CheckReport report = good_report();
    report.sweeps = {0.0018, "play", ""};
    CHECK(verdict_text(report, 1e-5) ==
          "check FAILED: backwards and forwards differ by 0.0018 of the gradient's size, of play (limit 1e-05); all differences agree\n");
    report.sweeps = {0, "", "no memory"};
    CHECK(check_faults(report, 1e-5) == std::vector<std::string>{"backwards and forwards could not be compared: no memory"});
    CHECK(check_verdict(report, 1e-5) == CheckVerdict::undecided);
}

TEST_CASE("verdict on a check: differences, kinks, noise, the line, what was not checked") {
    CheckReport report = good_report();
    report.rows.push_back(row("wrong", 0.02));
    report.rows.push_back(row("kinked", 0.5));
    report.rows.back().kink = 1;
    report.rows.push_back(row("noisy", 0.01));
    report.rows.back().resolved = false;
    report.rows.back().difference_error = 0.02;
    LineRow line;
    line.quantity = "objective";
    line.relative_error = 0.003;
    report.along = {line};
    report.failures = {"angle: jams"};
    CHECK(check_faults(report, 1e-5) ==
          std::vector<std::string>{"gradients and differences disagree: objective per wrong by 0.02 (limit 1e-05)",
                                   "they disagree along the gradient: objective by 0.003 (limit 1e-05)",
                                   "at a kink, the gradient lies outside the slopes of both sides: objective per kinked",
                                   "not all could be checked: angle: jams", "noise hides more than the limit: objective per noisy"});
    CHECK(check_verdict(report, 1e-5) == CheckVerdict::failed);
    report.interrupted = true;
    CHECK(verdict_text(report, 1e-5).find("check FAILED: gradients and differences disagree") == 0);
    CHECK(verdict_text(report, 1e-5).find("it was interrupted; not all could be checked") != std::string::npos);
    CHECK(verdict_text(report, 1e-5).find("all differences agree") == std::string::npos);
}

TEST_CASE("verdict on a check: a kink that the gradient lies within passes, and is named") {
    CheckReport report = good_report();
    report.rows.push_back(row("kinked", 0.5));
    report.rows.back().kink = 1;
    report.rows.back().lies_between = true;
    report.rows.back().resolved = false;
    LineRow line;
    line.quantity = "stroke";
    line.relative_error = 0.2;
    line.kink = -1;
    line.lies_between = true;
    report.along = {line};
    CHECK(check_faults(report, 1e-5).empty());
    CHECK(verdict_text(report, 1e-5) ==
          "check passed (limit 1e-05); at a kink, where the slopes of both sides differ and the gradient lies between them: objective per "
          "kinked, stroke along the gradient\n");
    report.along[0].lies_between = false;
    CHECK(check_verdict(report, 1e-5) == CheckVerdict::failed);
}

TEST_CASE("verdict on a check: a simulation beside it that fails leaves it undecided, with what was measured") {
    CheckReport report = good_report();
    report.largest_relative_error = 3e-9;
    report.failures = {"servo: step 28: no move brings the forces nearer to balance"};
    CHECK(check_verdict(report, 1e-5) == CheckVerdict::undecided);
    CHECK(verdict_text(report, 1e-5) ==
          "check undecided: not all could be checked: servo: step 28: no move brings the forces nearer to balance; all differences that "
          "were measured agree, to 3e-09\n");
    report.rows.clear();
    CHECK(verdict_text(report, 1e-5).ends_with("; no difference was measured\n"));
    report = good_report();
    report.rows[0].resolved = false;
    CHECK(check_verdict(report, 1e-5) == CheckVerdict::undecided);
    report.rows[1].relative_error = 1;  // what is wrong stays wrong
    CHECK(check_verdict(report, 1e-5) == CheckVerdict::failed);
}

TEST_CASE("verdict on a check: what is no number does not pass") {
    CheckReport report = good_report();
    report.rows[0].relative_error = std::numeric_limits<double>::quiet_NaN();
    CHECK(check_faults(report, 1e-5).size() == 1);
    report = good_report();
    report.sweeps.disagreement = std::numeric_limits<double>::infinity();
    CHECK(check_faults(report, 1e-5) == std::vector<std::string>{"backwards and forwards do not both give a number (limit 1e-05)"});
}

}  // namespace fettle::design::answers::check_faults_test
