// SPDX-License-Identifier: MIT
#include "design/cli/optimise_answer.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/base/text.hpp"
#include "design/cli/answers.hpp"
#include "design/cli/resolution_text.hpp"
#include "design/description/requirement_text.hpp"

namespace fettle::design::cli {

namespace {

using description::Design;
using optimisers::OptimiserStatus;
using studies::OptimiseOutcome;

// Where the two tell different things, by more than a ten thousandth.
std::string by_models_text(const Design& design, const OptimiseOutcome& outcome, const Console& console) {
    if (!outcome.play_taken_up.usable) return {};
    std::string text;
    for (size_t i = 0; i < outcome.final.constraints.size(); ++i) {
        const auto& [name, bounds, quantity] = design.constraints[i];
        if (quantity->is_at_rest()) continue;
        const double own = outcome.final.constraints[i].value, other = outcome.play_taken_up.constraints[i].value;
        if (std::abs(own - other) <= 1e-4 * std::abs(own)) continue;
        const std::string unit = description::unit_name(design.constraints[i]);
        const bool doubtful = std::count(outcome.in_doubt.begin(), outcome.in_doubt.end(), i) > 0;
        text += formatted("  %-40s %s, as written %s", name.c_str(), description::amount_text(other, bounds.unit, unit).c_str(),
                          description::amount_text(own, bounds.unit, unit).c_str());
        if (doubtful) text += ", required " + description::required_text(bounds, unit) + ": " + console.coloured("NOT MET", false);
        text += "\n";
    }
    if (text.empty()) return {};
    return "with the play of the fits taken up (" + outcome.play_taken_up_by + ": parts stay in the middle of their fits):\n" + text;
}

// A tuned mechanism whose requirements depend on how its parts lie in their fits.
std::string play_advice(const OptimiseOutcome& outcome) {
    if (outcome.in_doubt.empty()) return {};
    return "a real mechanism may do either, depending on where its parts lie in their fits. What to do: put into the scene what decides\n"
           "that (gravity, friction, a spring or load that presses the parts to one side) and tune again; or make the fits tighter; or\n"
           "allow for both numbers in what is required\n";
}

// Clearances that the meshes have and the round surfaces, for which facets stand, are not proven to have.
std::string round_surfaces_text(const Design& design, const problem::DesignEvaluation& final) {
    std::string text;
    for (size_t i = 0; i < final.constraints.size(); ++i) {
        const auto& [name, bounds, quantity] = design.constraints[i];
        const description::Measurement& measured = final.constraints[i];
        const auto round = answers::less_when_round(design.constraints[i], measured, final);
        if (!round) continue;
        const std::string unit = description::unit_name(design.constraints[i]);
        const auto at_least = [&, per = bounds.unit](double lower) {
            return description::bound_text(lower, description::Towards::down, per, unit);
        };
        text += "note: " + name + ": proven at least " + at_least(measured.lower) + " for the meshes, but at least " +
                at_least(round->lower) + (round->lower_is_proven ? "" : ", which is not proven,") +
                " for the round surfaces that their facets stand for; required " + description::required_text(bounds, unit) + "\n";
    }
    if (text.empty()) return {};
    return text +
           "(a body's largest deviation from its round surfaces counts, wherever it is)\n"
           "what to do: require more by the difference of the two, or ask for finer facets (`facets` of a shape); fettle clearance\n"
           "with the design shows both numbers (--explain)\n";
}

std::string share_text(double gain, double objective) {
    return objective == 0 ? "" : formatted(" (%.2g%% of it)", 100 * gain / std::abs(objective));
}

// By so little may a requirement that holds ask for less.
std::string eased_text(const answers::Cost& cost) {
    const bool lower_bound = cost.per_unit > 0;
    const std::string amount = description::amount_text(0.01, 1, cost.unit);
    if (cost.bounds.lower == cost.bounds.upper) return "with " + amount + (lower_bound ? " less" : " more") + " required";
    return (lower_bound ? "with a lower limit that is " : "with an upper limit that is ") + amount + (lower_bound ? " lower" : " higher");
}

// The cost of each requirement that holds, the dearest first; what could still move.
std::string verdict_text(const Design& design, const optimisers::Optimality& o, const std::string& minimised, double objective) {
    std::string text;
    const std::vector<answers::Cost> costs = answers::costs_of(design, o);
    if (!costs.empty()) text += "what the requirements cost:\n";
    for (const answers::Cost& cost : costs) {
        const double worth = 0.01 * std::abs(cost.per_unit);
        text += formatted("  %s: %s, %s could be lower by %.3g%s\n", cost.requirement.c_str(), eased_text(cost).c_str(), minimised.c_str(),
                          worth, share_text(worth, objective).c_str());
    }
    for (const int k : o.improvable) {
        const description::Parameter& p = design.parameters[k];
        text += formatted("could still move: %s by %.4g %s\n", p.name.c_str(), description::from_si(o.step[k], p.unit),
                          std::string(p.unit.name).c_str());
    }
    return text;
}

// What the objective is made of.
std::string terms_text(const Design& design, const OptimiseOutcome& outcome) {
    std::string text;
    for (size_t k = 0; k < outcome.final.terms.size(); ++k) {
        const description::ObjectiveTerm& term = design.objective[k];
        const double value = outcome.final.terms[k].value;
        const std::string unit = core::base::unit_name(term.quantity->dimension(), term.unit);
        const std::string reserve = problem::reserve_text(outcome.final, true, k, {term.unit, unit});
        text += formatted("  %-40s %s%s, counts %.6g in the objective%s\n", term.name.c_str(),
                          description::amount_text(value, term.unit, unit).c_str(),
                          term.over_tolerances ? (" " + words(*term.over_tolerances)).c_str() : "", term.weight * value / term.unit,
                          reserve.empty() ? "" : (": " + reserve).c_str());
    }
    return text;
}

const char* held_text(optimisers::Held held) {
    switch (held) {
        case optimisers::Held::stationary:
            return "the objective, which is least here";
        case optimisers::Held::lower_bound:
            return "its lower bound";
        case optimisers::Held::upper_bound:
            return "its upper bound";
        case optimisers::Held::constraints:
            return "requirements";
        case optimisers::Held::free:
            return "nothing";
    }
    return "unknown";
}

// The changes of --repair.
std::string changes_text(const Design& design, const optimisers::OptimiserReport& report) {
    std::string text =
        formatted("smallest change found that meets every requirement: %.4g of the ranges\n", std::sqrt(report.best.objective));
    for (size_t k = 0; k < design.parameters.size(); ++k) {
        const description::Parameter& p = design.parameters[k];
        const double change = description::from_si(report.point[k] - p.value, p.unit);
        if (change != 0) text += formatted("  %-24s %+.5g %s\n", p.name.c_str(), change, std::string(p.unit.name).c_str());
    }
    return text;
}

}  // namespace

std::string answer_text(const answers::Summary& summary, const Console& console, std::size_t most_rows) {
    using Row = answers::SummaryRow;
    constexpr std::size_t widest = 48;
    std::string text = console.coloured(summary.sentence, summary.is_good) + "\n";
    if (!summary.why.empty()) text += summary.why + "\n";
    const std::vector<Row> rows = answers::chosen_rows(summary.rows, most_rows);
    if (rows.empty()) return text;
    const bool has_before = std::any_of(summary.rows.begin(), summary.rows.end(), [](const Row& row) { return !row.before.empty(); });
    std::size_t name = 0, before = has_before ? 6 : 0, now = 3, asked = 9;
    for (const Row& row : rows) {
        name = std::max(name, std::min(widest, row.name.size()));
        before = std::max(before, row.before.size());
        now = std::max(now, row.now.size());
        asked = std::max(asked, (row.asked + ", " + row.unit).size());
    }
    const auto line = [&](const std::string& what, const std::string& b, const std::string& n, const std::string& a, const std::string& v) {
        std::string out = formatted("  %-*s  ", static_cast<int>(name), what.c_str());
        if (has_before) out += formatted("%*s  ", static_cast<int>(before), b.c_str());
        out += formatted("%*s  %-*s  ", static_cast<int>(now), n.c_str(), static_cast<int>(asked), a.c_str()) + v;
        out.erase(out.find_last_not_of(' ') + 1);
        return out + "\n";
    };
    text += line("", "before", has_before ? "now" : "is", "asked for", "");
    for (const Row& row : rows) {
        const bool wanted = row.verdict == Row::Verdict::wanted;
        const std::string asked_for = wanted && !row.unit.empty() ? row.asked + ", " + row.unit : row.asked;
        std::string verdict = wanted ? "" : answers::words(row.known);
        if (row.verdict == Row::Verdict::violated) verdict += ", " + console.coloured("NOT MET", false);
        if (row.verdict == Row::Verdict::in_doubt) verdict += ", " + console.coloured("in doubt", false);
        text += line(row.name, row.before.empty() ? "-" : row.before, row.now, asked_for, verdict);
    }
    if (const std::size_t more = summary.rows.size() - rows.size(); more > 0)
        text += "  and " + std::to_string(more) + " more, none of them violated or in doubt (--details)\n";
    return text;
}

std::string outcome_text(const Design& design, const OptimiseOutcome& outcome, const Console& console, const answers::RunFacts& run) {
    const optimisers::OptimiserReport& report = outcome.report;
    const bool good = report.status == OptimiserStatus::optimal;
    std::string text = console.coloured(optimisers::to_string(report.status), good) + ": " + report.message + "\n";
    if (!report.best.usable) return text;
    if (!outcome.in_doubt.empty())
        text += console.coloured("in doubt", false) + ": this holds for the motion as simulated; with the play of the fits taken up " +
                core::base::counted(outcome.in_doubt.size(), "requirement") + (outcome.in_doubt.size() == 1 ? " is" : " are") +
                " not met (below)\n";
    const double objective = answers::objective_json(outcome, run).get<double>();
    const std::string unit = run.repair ? std::string() : description::objective_unit(design);
    text += "objective " + description::amount_text(objective, 1, unit, 8) + ", " +
            (outcome.objective_start ? "from " + description::amount_text(*outcome.objective_start, 1, unit, 8) + " at the start; "
                                     : "the start could not be evaluated; ");
    text += core::base::counted(static_cast<size_t>(report.evaluations), "evaluation") + formatted(" (%d failed), ", report.failures) +
            core::base::counted(static_cast<size_t>(report.iterations), "iteration") + "\n" + terms_text(design, outcome);
    if (run.repair && report.feasible) text += changes_text(design, report);
    for (const core::model::JointSide& side : outcome.sides)
        text += formatted("  assembled %s at joint %s\n", core::model::to_string(side.assemble.side), side.joint.c_str());
    for (size_t k = 0; k < design.parameters.size(); ++k) {
        const description::Parameter& p = design.parameters[k];
        const bool told = k < report.optimality.held.size();
        text += formatted("  %-24s %12.7g -> %12.7g %s%s%s\n", p.name.c_str(), description::from_si(outcome.start[k], p.unit),
                          description::from_si(report.point[k], p.unit), std::string(p.unit.name).c_str(), told ? ", held by " : "",
                          told ? held_text(report.optimality.held[k]) : "");
    }
    for (size_t i = 0; i < outcome.final.constraints.size(); ++i) {
        const auto& [name, bounds, quantity] = design.constraints[i];
        const description::Measurement& measured = outcome.final.constraints[i];
        const std::string unit = description::unit_name(design.constraints[i]);
        const bool met = description::violation(bounds, measured) <= 0;
        std::string remark = problem::remark(outcome.final, i);
        if (const std::string reserve = problem::reserve_text(outcome.final, false, i, {bounds.unit, unit}); !reserve.empty())
            remark += (remark.empty() ? "" : "; ") + reserve;
        text += formatted("  %-40s %s, required %s: ", name.c_str(), description::known_text(measured, bounds, unit).c_str(),
                          description::required_text(bounds, unit).c_str()) +
                console.coloured(met ? "met" : "VIOLATED", met) + (remark.empty() ? "" : ": " + remark) + "\n";
    }
    text += relations_text(design, outcome.final.relations, console);
    if (const std::string reserves = problem::reserves_text(design); !reserves.empty())
        text += "  what counts over the tolerances does so " + reserves + "; fettle tolerance with the tuned design simulates made ones\n";
    text += round_surfaces_text(design, outcome.final);
    text += by_models_text(design, outcome, console) + play_advice(outcome);
    text += resolution_text(design, outcome, console, run);
    text += run.repair ? verdict_text(design, report.optimality, "the squared change", report.best.objective)
                       : verdict_text(design, report.optimality, "the objective", objective);
    if (const std::string why = answers::why_not_optimal(design, outcome, run); !why.empty())
        text += "not shown to be optimal: " + why + "\n";
    for (const std::string& limit : outcome.limits) text += "limited by: " + limit + "\n";
    return text;
}

std::string written_text(const answers::RunFacts& run) {
    return "written to " + run.out + ": design.final.json, trajectory.json, motion.glb, history.jsonl, result.json\n";
}

std::string next_text(const std::string& report, const std::string& folder) {
    const std::string look = report.empty() ? folder : report;
    return "Look: " + look + "   Print: fettle export " + folder + " --to print.3mf --arrange plate\n";
}

std::vector<Check> requirement_checks(const Design& design, const studies::JudgedDesign& judged, const std::string& file) {
    std::vector<Check> checks;
    for (size_t i = 0; i < judged.final.constraints.size(); ++i) {
        const auto& [name, bounds, quantity] = design.constraints[i];
        const description::Measurement& measured = judged.final.constraints[i];
        const std::string unit = description::unit_name(design.constraints[i]);
        const bool met = description::violation(bounds, measured) <= 0;
        const bool doubtful = met && std::count(judged.in_doubt.begin(), judged.in_doubt.end(), i) > 0;
        Check check{name, met ? CheckOutcome::passed : CheckOutcome::failed, met ? "met" : "violated", "", file};
        check.message = description::known_text(measured, bounds, unit) + ", required " + description::required_text(bounds, unit);
        if (const std::string remark = problem::remark(judged.final, i); !remark.empty()) check.message += "; " + remark;
        if (const std::string reserve = problem::reserve_text(judged.final, false, i, {bounds.unit, unit}); !reserve.empty())
            check.message += "; " + reserve + ", " + problem::reserves_text(design);
        if (doubtful) {
            check.outcome = CheckOutcome::remarked;
            check.rule = "in doubt";
            check.message += "; with the play of the fits taken up it is " +
                             description::amount_text(judged.play_taken_up.constraints[i].value, bounds.unit, unit) + ", which is not";
        }
        checks.push_back(std::move(check));
    }
    for (Eigen::Index i = 0; i < judged.final.relations.values.size(); ++i) {
        const description::Relation& relation = design.relations[i];
        const bool met = description::violation(relation, judged.final.relations.values[i]) <= 0;
        const std::string unit = description::unit_name(relation);
        checks.push_back({relation.name, met ? CheckOutcome::passed : CheckOutcome::failed, met ? "met" : "violated",
                          "is " + description::amount_text(judged.final.relations.values[i], relation.bounds.unit, unit) + ", required " +
                              description::required_text(relation.bounds, unit),
                          file});
    }
    return checks;
}

std::vector<Check> outcome_checks(const Design& design, const OptimiseOutcome& outcome, const std::string& file) {
    std::vector<Check> checks = requirement_checks(design, outcome, file);
    const OptimiserStatus status = outcome.report.status;
    if (status == OptimiserStatus::infeasible) return checks;  // the requirements have failed
    checks.push_back({"no better design is near", status == OptimiserStatus::optimal ? CheckOutcome::passed : CheckOutcome::undecided,
                      optimisers::to_string(status), outcome.report.message, file});
    return checks;
}

int exit_code(OptimiserStatus status) {
    switch (status) {
        case OptimiserStatus::optimal:
            return exit_done;
        case OptimiserStatus::infeasible:
            return exit_violated;
        default:
            return exit_undecided;
    }
}

}  // namespace fettle::design::cli
