// SPDX-License-Identifier: MIT
/// The answer of an optimisation as one reads it first: a sentence, and what was asked for as a table. The terminal, result.json and the
/// page show the same.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/clearance/true_bounds.hpp"
#include "design/answers/verdict.hpp"

namespace fettle::design::answers {

/// One thing that was asked for: a requirement, a relation, or a term of the objective.
struct SummaryRow {
    std::string name;
    std::string before;  ///< at the start, in `unit`; empty: not known
    std::string now;     ///< of the final design: the value that it is judged by, rounded so that it stays on its side of what is required
    std::string unit;    ///< of both; empty: plain numbers
    std::string asked;   ///< "at least 0.3 mm", "as little as possible"
    /// of_facets: proven of the meshes, not of the round surfaces for which their facets stand.
    enum class Known { computed, proven, of_facets } known = Known::computed;
    enum class Verdict { met, violated, in_doubt, wanted } verdict = Verdict::met;  ///< wanted: of the objective
    bool holds = false;                                                             ///< a requirement that the design has run into
    bool was_missed = false;                                                        ///< at the start
};

struct Summary {
    std::string sentence;  ///< what came of it, with how many designs were tried
    std::string why;       ///< what keeps it from being a plain "done"; empty: nothing does
    bool is_good = false;  ///< every requirement is met, none is in doubt, and no better design is near by
    std::vector<SummaryRow> rows;
};

Summary summary_of(const description::Design& design, const studies::OptimiseOutcome& outcome, const RunFacts& run);

/// The same of a design as it is, which no search found: `before` is empty in all rows. What could not be evaluated has rows for its
/// relations alone.
Summary summary_of(const description::Design& design, const studies::JudgedDesign& judged);

/// The proven bounds of a clearance of the round surfaces that facets stand for, where these do not prove what the meshes do; nothing: they
/// do, or it is no clearance.
std::optional<core::clearance::TrueBounds> less_when_round(const description::Constraint& constraint,
                                                           const description::Measurement& measured,
                                                           const problem::DesignEvaluation& final);

/// What it is known by, in words: "proven", "computed", "proven for the facets".
const char* words(SummaryRow::Known known);

/// Chooses the rows that are shown where not all are: those violated or in doubt, those that hold the design or were missed before, those
/// wanted, the rest; in their order.
std::vector<SummaryRow> chosen_rows(const std::vector<SummaryRow>& rows, std::size_t most);

nlohmann::ordered_json summary_json(const Summary& summary);

}  // namespace fettle::design::answers
