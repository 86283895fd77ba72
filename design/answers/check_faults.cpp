// SPDX-License-Identifier: MIT
#include "fettle/design/answers/check_faults.hpp"

#include <algorithm>
#include <cmath>

#include "fettle/core/base/text.hpp"

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

// What the table of differences has against the gradients.
Names faults_of_differences(const CheckReport& report, double limit) {
    Names disagreeing, kinks, hidden, along;
    for (const CheckRow& row : report.rows) {
        if (row.kink != 0) {
            kinks.push_back(name_of(row));
        } else if (disagrees(row, limit)) {
            disagreeing.push_back(name_of(row) + formatted(" by %.2g", row.relative_error));
        } else if (!row.resolved) {
            hidden.push_back(name_of(row));
        }
    }
    for (const LineRow& row : report.along)
        if (disagrees(row, limit)) along.push_back(row.quantity + formatted(" by %.2g", row.relative_error));
    Names faults;
    if (!disagreeing.empty())
        faults.push_back("gradients and differences disagree: " + few(disagreeing) + formatted(" (limit %.3g)", limit));
    if (!along.empty()) faults.push_back("they disagree along the gradient: " + few(along) + formatted(" (limit %.3g)", limit));
    if (!kinks.empty()) faults.push_back("there is a kink, and so no derivative: " + few(kinks));
    if (!hidden.empty()) faults.push_back("noise hides more than the limit: " + few(hidden));
    return faults;
}

}  // namespace

std::vector<std::string> check_faults(const CheckReport& report, double limit) {
    Names faults;
    if (report.interrupted) faults.emplace_back("it was interrupted");
    if (!report.failures.empty()) faults.push_back("not all could be checked: " + few(report.failures));
    const gradient_audit::SweepAgreement& sweeps = report.sweeps;
    if (!sweeps.failure.empty()) {
        faults.push_back("backwards and forwards could not be compared: " + sweeps.failure);
    } else if (!(sweeps.disagreement <= limit)) {
        const std::string by = std::isfinite(sweeps.disagreement) ? formatted("differ by %.2g of the gradient's size", sweeps.disagreement)
                                                                  : "do not both give a number";
        faults.push_back("backwards and forwards " + by + (sweeps.quantity.empty() ? "" : ", of " + sweeps.quantity) +
                         formatted(" (limit %.3g)", limit));
    }
    const Names of_differences = faults_of_differences(report, limit);
    faults.insert(faults.end(), of_differences.begin(), of_differences.end());
    return faults;
}

std::string verdict_text(const CheckReport& report, double limit) {
    const Names faults = check_faults(report, limit);
    if (faults.empty()) return formatted("check passed (limit %.3g)\n", limit);
    std::string text = "check FAILED: ";
    for (std::size_t i = 0; i < faults.size(); ++i) text += (i == 0 ? "" : "; ") + faults[i];
    const bool all_agree =
        !report.interrupted && report.failures.empty() && !report.rows.empty() && faults_of_differences(report, limit).empty();
    return text + (all_agree ? "; all differences agree\n" : "\n");
}

}  // namespace fettle::design::answers
