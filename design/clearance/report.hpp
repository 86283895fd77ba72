// SPDX-License-Identifier: MIT
/// The one question about clearance, over a path and over ranges of joints alike: which pairs are judged, what becomes of each, and the
/// report: pairs worst first, and against an earlier one. As JSON: report_json.hpp.
///
///     design::clearance::SubjectOptions options;
///     options.path = "arm.scene.json", options.ranges = true;
///     const auto subject = design::clearance::read_subject(options, {});
///     if (!subject) return 3;
///     design::clearance::Question question;
///     question.pairs.minimum = 0.3e-3;
///     const auto report = design::clearance::judge_clearances(*subject, question);
///     if (!report) return 3;
///     for (const auto& pair : report->pairs)
///         std::printf("%s:%s %s, at least %g m\n", pair.spec.a.name.c_str(), pair.spec.b.name.c_str(),
///                     design::clearance::to_string(pair.finding), pair.least.lower);
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "core/certificate/certificate.hpp"
#include "core/clearance/true_bounds.hpp"
#include "design/clearance/baseline.hpp"
#include "design/clearance/joined_pairs.hpp"
#include "design/clearance/pairs.hpp"
#include "design/clearance/subject.hpp"

namespace fettle::design::clearance {

/// What people read, worst first.
enum class Finding {
    clash,      ///< the bodies pass through each other, or one lies inside the other's material
    below,      ///< closer than required
    touching,   ///< faces lie on each other: neither a gap nor a clash
    undecided,  ///< what is required lies between the bounds, or the search was cut short
    contact,    ///< bodies that dynamics lets push each other come close enough to do so; reported, not judged
    clear
};
const char* to_string(Finding finding);

struct ReportedPair {
    PairSpec spec;
    core::clearance::PairClearance least;                 ///< of the two bodies that are closest; bounds and status of the whole pair
    std::vector<core::clearance::PairClearance> members;  ///< one per pair of bodies
    Finding finding = Finding::undecided;
    std::string overlap;    ///< says that one lies inside the other; empty: it does not
    std::string joined_by;  ///< "joint j": of a pair that was looked at as assembled alone (joined_pairs.hpp)
    Change change;          ///< against the baseline
};

/// Bounds for the parts that the meshes were drawn for. Nothing where core::clearance::true_bounds has none, and over tolerances.
std::optional<core::clearance::TrueBounds> true_bounds(const Subject& subject, const ReportedPair& pair);

struct ClearanceReport {
    std::vector<ReportedPair> pairs;                       ///< worst first
    std::vector<std::string> ignored;                      ///< on request
    std::vector<std::string> ignored_by_scene, one_group;  ///< not judged for these reasons
    std::vector<JoinedPair> joined;                        ///< what a joint joins; findings among them are rows, too
    std::vector<std::string> left_out;     ///< not judged; over a path no clash was found either, and nothing else is reported
    std::vector<std::string> uncovered;    ///< pairs of bodies that no row is about
    std::vector<std::string> unexplained;  ///< those of them that are in none of the lists above: nobody named them
    std::vector<std::string> notes;        ///< the subject's, and what of the question counted for nothing
    std::string message;                   ///< why nothing was judged, or not to the end; empty: it was
    std::optional<Baseline> baseline;
    std::optional<core::certificate::Certificate> certificate;  ///< if it was asked for; without pairs: nothing is proven
    double tolerance = 0;                                       ///< [m]
    core::clearance::PairStatus status = core::clearance::PairStatus::clear;
};

struct Question {
    PairOptions pairs;
    std::optional<double> tolerance;  ///< [m]; nothing: core::clearance::usual_options()
    double budget = 1;                ///< how many times as much work as ClearanceOptions has by default may be spent on a pair
    bool margins = false;             ///< certified bounds for each stretch of the path: then every pair is measured
    bool all_witnesses = false;       ///< all that come as close, to within the tolerance
    bool proof = false;               ///< a certificate is wanted
    std::function<void(int done, int of)> on_pair;
    std::function<bool()> should_stop = [] { return false; };
};

/// Judges the pairs. If there are more than 100 pairs of bodies over a path, those that nobody named and that stay twice their minimum
/// apart are proven to, and not measured. Once a stop is asked for, the rest is not known: nothing is reported as violated but what was
/// certified before. Errors: of the pairs' options (select_pairs).
Result<ClearanceReport> judge_clearances(const Subject& subject, const Question& question);

/// Marks findings as new, existing or resolved.
void compare_with(Baseline baseline, ClearanceReport& report);

}  // namespace fettle::design::clearance
