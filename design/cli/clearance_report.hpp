// SPDX-License-Identifier: MIT
/// The report of `fettle clearance`: pairs worst first, as JSON, as text and as CSV, and against an earlier one.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "fettle/core/clearance/clearance.hpp"
#include "fettle/design/cli/check_files.hpp"
#include "fettle/design/cli/clearance_baseline.hpp"
#include "fettle/design/cli/clearance_pairs.hpp"
#include "fettle/design/cli/clearance_subject.hpp"

namespace fettle::design::cli {

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
    std::string overlap;  ///< says that one lies inside the other; empty: it does not
    Change change;        ///< against the baseline
};

struct ClearanceReport {
    std::vector<ReportedPair> pairs;  ///< worst first
    std::vector<std::string> ignored;
    std::vector<std::string> left_out;   ///< not judged: no clash was found, nothing else is told
    std::vector<std::string> uncovered;  ///< pairs of bodies that no row speaks of
    std::string message;                 ///< why nothing was judged, or not to the end; empty: it was
    std::optional<Baseline> baseline;
    double tolerance = 0;  ///< [m]
    core::clearance::PairStatus status = core::clearance::PairStatus::clear;
};

/// `results`: one per pair of bodies, in the order of the selection. `stopped`: someone asked for an end: what the rest would have shown is
/// not known, so that nothing is told as violated but what was certified before.
ClearanceReport make_report(const Subject& subject, const PairSelection& selection,
                            const std::vector<core::clearance::PairClearance>& results, double tolerance, bool stopped);

/// A body's pose at a witness's instant: that of its file's frame.
core::kinematics::Pose file_pose(const Subject& subject, const core::clearance::Witness& witness, int body);

/// Marks findings as new, existing or resolved.
void compare_with(Baseline baseline, ClearanceReport& report);

/// Keys: docs/interface.md, and gap, sampled, finding, pose_a, pose_b, required_by ... SI.
nlohmann::ordered_json report_json(const ClearanceReport& report, const Subject& subject);

/// Lengths in `unit`, lower bounds rounded down and upper ones up. Explains the `explain` worst pairs.
std::string report_text(const ClearanceReport& report, const Subject& subject, const std::string& unit, int explain,
                        const Console& console);

/// Each pair as a check (check_files.hpp), and that all was judged.
std::vector<Check> report_checks(const ClearanceReport& report, const Subject& subject, const std::string& unit, const std::string& file);

/// One row per pair of bodies and path segment: a,b,step,segment,time_start[s],time_end[s],lower[unit],upper[unit].
std::string margins_csv(const ClearanceReport& report, const Subject& subject, const std::string& unit);

}  // namespace fettle::design::cli
