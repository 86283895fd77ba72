// SPDX-License-Identifier: MIT
#include "design/answers/check_faults.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/text.hpp"

namespace fettle::design::answers {

namespace {

using core::base::formatted;
using gradient_audit::CheckReport;
using gradient_audit::CheckRow;
using gradient_audit::LineRow;
using Names = std::vector<std::string>;

// Beyond what can be the noise of its difference. No number is beyond.
template <class Row>
bool disagrees(const Row& row, double limit) {
    const double error = row.resolved ? row.relative_error : std::max(0.0, row.relative_error - row.difference_error);
    return !(error <= limit);
}

// "objective per length"
std::string name_of(const CheckRow& row) { return row.quantity + " per " + row.parameter; }

std::string few(const Names& names) {
    constexpr std::size_t most = 4;
    if (names.size() <= most) return core::base::joined(names);
    return core::base::joined(Names(names.begin(), names.begin() + most)) + formatted(" and %zu more", names.size() - most);
}

/// The causes that speak against a gradient, and those that only leave it open.
struct Causes {
    Names faults, open;
};

// At a kink the differences are of no use; the slopes of both sides are.
template <class Row>
bool is_right_at_kink(const Row& row) {
    return row.kink != 0 && row.lies_between;
}

// The causes that the table of differences shows.
Causes causes_of_differences(const CheckReport& report, double limit) {
    Names disagreeing, beside, hidden, along;
    for (const CheckRow& row : report.rows) {
        if (is_right_at_kink(row)) continue;
        if (row.kink != 0) {
            beside.push_back(name_of(row));
        } else if (disagrees(row, limit)) {
            disagreeing.push_back(name_of(row) + formatted(" by %.2g", row.relative_error));
        } else if (!row.resolved) {
            hidden.push_back(name_of(row));
        }
    }
    for (const LineRow& row : report.along)
        if (!is_right_at_kink(row) && disagrees(row, limit)) along.push_back(row.quantity + formatted(" by %.2g", row.relative_error));
    Causes causes;
    if (!disagreeing.empty())
        causes.faults.push_back("gradients and differences disagree: " + few(disagreeing) + formatted(" (limit %.3g)", limit));
    if (!along.empty()) causes.faults.push_back("they disagree along the gradient: " + few(along) + formatted(" (limit %.3g)", limit));
    if (!beside.empty()) causes.faults.push_back("at a kink, the gradient lies outside the slopes of both sides: " + few(beside));
    if (!hidden.empty()) causes.open.push_back("noise hides more than the limit: " + few(hidden));
    return causes;
}

Causes causes_of(const CheckReport& report, double limit) {
    Causes causes;
    if (report.interrupted) causes.open.emplace_back("it was interrupted");
    if (!report.failures.empty()) causes.open.push_back("not all could be checked: " + few(report.failures));
    const gradient_audit::SweepAgreement& sweeps = report.sweeps;
    if (!sweeps.failure.empty()) {
        causes.open.push_back("backwards and forwards could not be compared: " + sweeps.failure);
    } else if (!(sweeps.disagreement <= limit)) {
        const std::string by = std::isfinite(sweeps.disagreement) ? formatted("differ by %.2g of the gradient's size", sweeps.disagreement)
                                                                  : "do not both give a number";
        causes.faults.push_back("backwards and forwards " + by + (sweeps.quantity.empty() ? "" : ", of " + sweeps.quantity) +
                                formatted(" (limit %.3g)", limit));
    }
    const Causes of_differences = causes_of_differences(report, limit);
    causes.faults.insert(causes.faults.end(), of_differences.faults.begin(), of_differences.faults.end());
    causes.open.insert(causes.open.end(), of_differences.open.begin(), of_differences.open.end());
    return causes;
}

// What the check met that is no fault: "; there is a kink, ...".
std::string kinks_text(const CheckReport& report) {
    Names kinks;
    for (const CheckRow& row : report.rows)
        if (is_right_at_kink(row)) kinks.push_back(name_of(row));
    for (const LineRow& row : report.along)
        if (is_right_at_kink(row)) kinks.push_back(row.quantity + " along the gradient");
    if (kinks.empty()) return "";
    return "; at a kink, where the slopes of both sides differ and the gradient lies between them: " + few(kinks);
}

// The text about a check in which nothing disagrees.
std::string measured_text(const CheckReport& report) {
    if (report.rows.empty() && report.along.empty()) return "; no difference was measured";
    return formatted("; all differences that were measured agree, to %.2g", report.largest_relative_error);
}

}  // namespace

CheckVerdict check_verdict(const CheckReport& report, double limit) {
    const Causes causes = causes_of(report, limit);
    if (!causes.faults.empty()) return CheckVerdict::failed;
    return causes.open.empty() ? CheckVerdict::passed : CheckVerdict::undecided;
}

std::vector<std::string> check_faults(const CheckReport& report, double limit) {
    Causes causes = causes_of(report, limit);
    causes.faults.insert(causes.faults.end(), causes.open.begin(), causes.open.end());
    return causes.faults;
}

std::string verdict_text(const CheckReport& report, double limit) {
    const CheckVerdict verdict = check_verdict(report, limit);
    if (verdict == CheckVerdict::passed) return formatted("check passed (limit %.3g)", limit) + kinks_text(report) + "\n";
    std::string text = verdict == CheckVerdict::failed ? "check FAILED: " : "check undecided: ";
    const Names faults = check_faults(report, limit);
    for (std::size_t i = 0; i < faults.size(); ++i) text += (i == 0 ? "" : "; ") + faults[i];
    if (verdict == CheckVerdict::undecided) return text + measured_text(report) + kinks_text(report) + "\n";
    const Causes of_differences = causes_of_differences(report, limit);
    const bool all_agree = !report.interrupted && report.failures.empty() && !report.rows.empty() && of_differences.faults.empty() &&
                           of_differences.open.empty();
    return text + (all_agree ? "; all differences agree" : "") + kinks_text(report) + "\n";
}

}  // namespace fettle::design::answers
