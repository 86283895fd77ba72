// SPDX-License-Identifier: MIT
#include "design/cli/clearance_text.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <numbers>
#include <span>

#include "core/base/rounded_lengths.hpp"
#include "core/base/text.hpp"
#include "core/base/units.hpp"
#include "design/answers/answer_json.hpp"
#include "design/cli/answers.hpp"
#include "design/description/parameter.hpp"

namespace fettle::design::cli {

namespace {

using clearance::ClearanceReport;
using clearance::Finding;
using clearance::ReportedPair;
using clearance::Subject;
using core::base::joined;
using core::base::RoundedLengths;
using core::base::Towards;
using core::clearance::PairClearance;
using core::clearance::Witness;

constexpr double degrees = 180 / std::numbers::pi;

// Numbers of a table in one unit: enough decimals to show the tolerance; three digits of what is smaller than that.
class Lengths {
public:
    Lengths(const std::string& unit, double tolerance) : unit_(unit), metres_(core::base::metres_per_unit(unit).value()) {
        decimals_ = std::clamp(static_cast<int>(std::ceil(-std::log10(tolerance / metres_) - 1e-9)), 0, 9);
    }
    // A bound that is printed is still a bound. `more` decimals than the table has.
    std::string down(double x, int more = 0) const { return RoundedLengths(unit_, decimals_).fixed(x, Towards::down, more); }
    std::string up(double x, int more = 0) const { return RoundedLengths(unit_, decimals_).fixed(x, Towards::up, more); }
    // The bounds of a pair beside what is required of it: with as many decimals as show which is the larger.
    std::string lower(const PairClearance& pair) const {
        return beside(
            pair, [&](int more) { return down(pair.lower, more); }, pair.lower >= pair.minimum ? 1 : 0);
    }
    std::string upper(const PairClearance& pair) const {
        return beside(
            pair, [&](int more) { return up(pair.upper, more); }, pair.upper < pair.minimum ? -1 : 0);
    }
    std::string plain(double x) const { return formatted("%.6g", x / metres_); }
    std::string rough(double x) const { return formatted("%.2g", x / metres_); }
    std::string point(const Vector3& x) const {
        const auto told = [&](double coordinate) { return std::abs(coordinate) < 1e-14 ? 0 : coordinate / metres_; };  // rounding of 0
        return formatted("(%.6g, %.6g, %.6g) %s", told(x.x()), told(x.y()), told(x.z()), unit_.c_str());
    }
    const std::string& unit() const { return unit_; }
    double metres() const { return metres_; }

private:
    // `side`: 1, the text may not be less than that of the minimum; -1, it must be; 0, neither.
    template <class Bound>
    std::string beside(const PairClearance& pair, const Bound& bound, int side) const {
        const double required = std::strtod(plain(pair.minimum).c_str(), nullptr);
        for (int more = 0; side != 0 && more <= 6; ++more) {
            const std::string text = bound(more);
            const double told = std::strtod(text.c_str(), nullptr);
            if (side > 0 ? told >= required : told < required) return text;
        }
        return bound(0);
    }

    std::string unit_;
    double metres_;
    int decimals_ = 0;
};

std::string pair_name(const ReportedPair& pair) { return pair.spec.a.name + ":" + pair.spec.b.name; }

// "pin_radius +0.05 mm".
std::string deviation_text(const clearance::WorstDeviation& d) {
    const auto unit = core::base::find_unit(d.unit);
    return d.of + formatted(" %+.4g", unit ? description::from_si(d.value, *unit) : d.value) + (d.unit.empty() ? "" : " " + d.unit);
}

// "left_shoulder -90 deg, lift 3 mm": the joints' positions where a pair is worst.
std::string position_text(const Subject& subject, const PairClearance& pair, const Lengths& lengths) {
    std::vector<std::string> parts;
    clearance::for_joints(*subject.domain.ranges(), pair, [&](const auto& joint, double value, const auto&) {
        parts.push_back(joint.joint +
                        (joint.is_angle ? formatted(" %.6g deg", value * degrees) : " " + lengths.plain(value) + " " + lengths.unit()));
    });
    if (pair.as_assembled) return "as assembled";
    if (subject.domain.has_deviations())
        for (const clearance::WorstDeviation& d : worst_deviations(subject, pair)) parts.push_back(deviation_text(d));
    return parts.empty() ? subject.domain.has_deviations() ? "no tolerance matters" : "nothing moves one against the other" : joined(parts);
}

// Within tolerances: what does not matter for which pair.
std::string without_influence(const ClearanceReport& report, const Subject& subject) {
    std::string text;
    for (const ReportedPair& pair : report.pairs) {
        if (pair.least.as_assembled) continue;
        const std::vector<std::string> names = deviations_without_influence(subject, pair.least);
        if (!names.empty()) text += "no influence on " + pair_name(pair) + " (proven): " + joined(names) + "\n";
    }
    return text;
}

// "over 240 mm^2, accepted".
std::string touched(const ReportedPair& pair, const Lengths& lengths) {
    const core::clearance::Touch& touch = *pair.least.touch;
    const double area = touch.area / (lengths.metres() * lengths.metres());
    const char* const over = touch.is_whole ? "over " : "over at least ";
    return (area > 0 || !touch.is_whole ? over + formatted("%.4g ", area) + lengths.unit() + "^2" : std::string("in edges and points")) +
           (pair.spec.may_touch ? ", accepted" : "");
}

// "2.31 mm^3", one figure where the bounds agree to a hundredth; else "116 to 161 mm^3", rounded outwards.
std::string bounds_text(double lower, double upper, const std::string& unit) {
    if (upper <= 1.01 * lower) return formatted("%.3g ", 0.5 * (lower + upper)) + unit;
    return (lower > 0 ? formatted("%.3g to ", 0.995 * lower) : std::string("at most ")) + formatted("%.3g ", 1.005 * upper) + unit;
}

// "0.246 mm deep, 2.31 mm^3 shared"; where it takes a longer move to part them than what they share is thick: "at least 3.98 mm deep".
std::string overlapped(const core::clearance::Overlap& o, const Lengths& lengths) {
    const double unit = lengths.metres(), cubed = unit * unit * unit;
    const bool is_known = o.depth_upper <= 1.01 * o.depth_lower;
    return (is_known || !(o.depth_lower > 0) ? bounds_text(o.depth_lower / unit, o.depth_upper / unit, lengths.unit())
                                             : formatted("at least %.3g ", 0.995 * o.depth_lower / unit) + lengths.unit()) +
           " deep, " + bounds_text(o.volume_lower / cubed, o.volume_upper / cubed, lengths.unit() + "^3") + " shared";
}

std::string overlapped(const ReportedPair& pair, const Lengths& lengths) {
    if (!pair.least.overlap) return pair.overlap.empty() ? "the surfaces pass through each other" : pair.overlap;
    return overlapped(*pair.least.overlap, lengths);
}

// A remark on a clash that round parts need not have.
std::string by_facets(const ReportedPair& pair, const Subject& subject, const Lengths& lengths) {
    const auto reach = pair.finding == Finding::clash ? core::clearance::clash_of_facets(subject.model, pair.least) : std::nullopt;
    if (!reach) return {};
    return "facets reach up to " + lengths.rough(*reach) + " " + lengths.unit() +
           " beyond the round surfaces that they stand for: whether the round parts share material, finer facets tell (\"facets\")";
}

// A distance says nothing of parts that share material, or touch.
bool has_distance(const ReportedPair& pair) { return pair.finding != Finding::clash && pair.finding != Finding::touching; }

std::string table(const ClearanceReport& report, const Subject& subject, const Lengths& lengths, const Console& console) {
    const auto bound = [&](const ReportedPair& pair, bool is_lower) {
        if (!has_distance(pair)) return std::string("-");
        if (!pair.least.is_bounded) return std::string("not proven");
        if (subject.domain.is_tree() && !is_lower && !std::isfinite(pair.least.upper)) return std::string("-");
        return is_lower ? lengths.lower(pair.least) : lengths.upper(pair.least);
    };
    size_t width = 4;
    for (const ReportedPair& pair : report.pairs)
        if (!pair.least.is_far) width = std::max(width, pair_name(pair).size());
    const int w = static_cast<int>(width);
    std::string text =
        formatted("%-*s %12s %14s %14s  %-16s%s   (lengths in %s%s)\n", w, "pair", "required", "at least", "at most", "status",
                  subject.domain.is_tree() ? "  worst at"
                  : subject.motion()       ? "  when"
                                           : "",
                  lengths.unit().c_str(), subject.domain.is_tree() ? "" : ", times in s");
    for (const ReportedPair& pair : report.pairs) {
        const PairClearance& least = pair.least;
        if (least.is_far) continue;
        const std::string status = formatted("%-16s", to_string(pair.finding));
        const bool good = pair.finding == Finding::clear || pair.least.status == core::clearance::PairStatus::contact;
        text += formatted("%-*s %12s %14s %14s  %s", w, pair_name(pair).c_str(),
                          pair.spec.required_by.empty() ? "-" : lengths.plain(least.minimum).c_str(), bound(pair, true).c_str(),
                          bound(pair, false).c_str(), console.coloured(status, good).c_str());
        if (subject.motion()) text += formatted("  %.6g", least.is_clash() ? least.clash_time : least.witness.time);
        if (subject.domain.is_tree()) text += "  " + position_text(subject, least, lengths);
        if (pair.finding == Finding::clash && (!subject.domain.is_tree() || least.overlap)) text += "  " + overlapped(pair, lengths);
        if (!pair.joined_by.empty()) text += "  joined by " + pair.joined_by;
        if (least.touch) text += (pair.finding == Finding::touching ? "  " : "  touching ") + touched(pair, lengths);
        if (least.solids == core::clearance::Solids::not_closed) text += std::string("  ") + core::clearance::words(least.solids);
        text += (pair.change.word.empty() ? "" : "  " + pair.change.word) + "\n";
    }
    return text;
}

// The proven text: of the distance, or of the material that the parts share, or the area that they touch over.
std::string found_of(const ReportedPair& pair, const Subject& subject, const Lengths& lengths) {
    const PairClearance& least = pair.least;
    if (pair.finding == Finding::clash) {
        const std::string facets = by_facets(pair, subject, lengths);
        return "the parts share material: " + overlapped(pair, lengths) + (facets.empty() ? "" : "; " + facets);
    }
    if (pair.finding == Finding::touching) return "the parts touch " + touched(pair, lengths);
    if (least.is_far) return "at least twice as far apart as is required";
    if (!least.is_bounded) return "no bound is proven" + (least.reason.empty() ? "" : ": " + least.reason);
    return "at least " + lengths.lower(least) + " " + lengths.unit() + " apart, at most " + lengths.upper(least) + " " + lengths.unit();
}

// How to accept a pair that touches.
std::string how_to_accept(const ReportedPair& pair) { return "--allow-touch " + pair_name(pair) + " accepts it"; }

std::string pose_line(const std::string& name, const core::kinematics::Pose& pose, const Lengths& lengths) {
    const Vector3 theta = core::kinematics::rotation_vector(pose.rotation);
    const double angle = theta.norm();
    std::string text = "   " + name + " at " + lengths.point(pose.position);
    if (angle > 0) {
        const Vector3 axis = theta / angle;
        text += formatted(", turned by %.6g degrees about (%.4g, %.4g, %.4g)", angle * 180 / M_PI, axis.x(), axis.y(), axis.z());
    }
    return text + "\n";
}

std::string feature(core::clearance::Primitive kind, int index) {
    const char* words[] = {"vertex", "edge", "triangle"};
    return formatted("%s %d", words[static_cast<int>(kind)], index);
}

std::string clash(const ReportedPair& pair, const Subject& subject, const Lengths& lengths) {
    const PairClearance& least = pair.least;
    std::string text = "   " + (pair.overlap.empty() ? std::string("the surfaces pass through each other") : pair.overlap);
    if (subject.motion())
        text += formatted(" from %.9g s on; until %.9g s there is proven to be no clash", least.clash_time, least.clash_not_before);
    text += "\n";
    if (!least.overlap) return text;
    const core::clearance::Overlap& o = *least.overlap;
    const double cubed = lengths.metres() * lengths.metres() * lengths.metres();
    text += "   to part them takes a move of at least " + lengths.down(o.depth_lower, 3) + ", " + lengths.up(o.depth_upper, 3) + " " +
            lengths.unit() + " is enough; they share " + bounds_text(o.volume_lower / cubed, o.volume_upper / cubed, lengths.unit() + "^3");
    if (subject.motion()) text += formatted(", at %.6g s", o.time);
    const std::string facets = by_facets(pair, subject, lengths);
    return text + "\n" + (facets.empty() ? "" : "   " + facets + "\n");
}

// The bounds of the round surfaces that facets stand for.
std::string round_surfaces(const ReportedPair& pair, const Subject& subject, const Lengths& lengths) {
    const auto parts = clearance::true_bounds(subject, pair);
    if (!parts) return {};
    const auto bound = [](const std::string& number, bool is_proven) { return number + (is_proven ? "" : " (not proven)"); };
    std::string text =
        "   of the round surfaces that the facets stand for: at least " + bound(lengths.down(parts->lower, 3), parts->lower_is_proven);
    if (std::isfinite(parts->upper)) text += ", at most " + bound(lengths.up(parts->upper, 3), parts->upper_is_proven);
    text += " " + lengths.unit();
    double declared = 0;
    for (const int body : {pair.least.a, pair.least.b})
        if (const auto& deviation = subject.model.bodies[body].mesh.deviation) declared += deviation->declared;
    if (declared > 0) text += " (assumed: the edges of the STEP files are as exact as these declare, " + lengths.rough(declared) + ")";
    return text + "\n";
}

// Where the two share most is not searched for: known is the worst of the places that were looked at.
std::string worst_at(const Subject& subject, const ReportedPair& pair, const Lengths& lengths) {
    const bool is_clash = pair.finding == Finding::clash;
    return (is_clash ? "; of the places looked at, worst at " : "; worst at ") + position_text(subject, pair.least, lengths);
}

std::string explained(const ReportedPair& pair, const Subject& subject, const Lengths& lengths) {
    const PairClearance& least = pair.least;
    const Witness& w = least.witness;
    const std::string& a = subject.model.bodies[least.a].name;
    const std::string& b = subject.model.bodies[least.b].name;
    std::string text = pair_name(pair) + ": " + to_string(pair.finding) + "\n";
    text += (!has_distance(pair) ? std::string("   the parts ") + (pair.finding == Finding::clash ? "share material" : "touch")
             : !std::isfinite(least.upper) && least.is_bounded ? std::string("   nothing is measured")
             : least.is_bounded ? "   at least " + lengths.down(least.lower, 3) + ", at most " + lengths.up(least.upper, 3) + " " +
                                      lengths.unit() + (subject.domain.is_tree() ? " over every combination" : "") + " (the bounds are " +
                                      lengths.rough(least.upper - least.lower) + " apart)"
                                : std::string("   no bound is proven; below is the path between whose nodes the joints part")) +
            (subject.domain.is_tree() ? worst_at(subject, pair, lengths) : "") +
            (pair.spec.required_by.empty() ? "\n"
                                           : "; required " + lengths.plain(least.minimum) + " per side (" + pair.spec.required_by + ")\n");
    text += round_surfaces(pair, subject, lengths);
    if (const double charge = joint_charge(subject, least.a, least.b); charge > 0)
        text += "   each wider by " + lengths.rough(charge) + " " + lengths.unit() + ": what joints part by between the path's nodes\n";
    if (least.status == core::clearance::PairStatus::undecided && !least.reason.empty()) text += "   undecided: " + least.reason + "\n";
    if (pair.finding == Finding::clash) text += clash(pair, subject, lengths);
    if (least.touch)
        text += "   they touch " + touched(pair, lengths) + ", and are nowhere deeper in each other than " +
                lengths.up(least.touch->depth, 3) + " " + lengths.unit() + "\n";
    if ((least.solids == core::clearance::Solids::overlap && !least.intersecting) || !std::isfinite(least.upper)) return text;
    if (w.step >= 0) {
        text += formatted("   %s at %.9g s, in step %d", least.is_clash() ? "first" : "closest", w.time, w.step + 1);
        const int segments = core::stepper::segment_count(subject.domain.path(), w.step);
        if (segments > 1) text += formatted(", part %d of %d of its path", w.segment + 1, segments);
        text += formatted(", %.3g%% of the way\n", 100 * w.s);
    }
    text += "   " + feature(w.kind_a, w.primitive_a) + " of " + a + ", at " + lengths.point(w.point_a) + "\n";
    text += "   " + feature(w.kind_b, w.primitive_b) + " of " + b + ", at " + lengths.point(w.point_b) + "\n";
    text += pose_line(a, pose_where_nearest(subject, least, least.a), lengths) +
            pose_line(b, pose_where_nearest(subject, least, least.b), lengths);
    if (subject.motion())
        text += "   least distance at the ends of the steps, which is what sampling sees: " + lengths.plain(least.sampled) + " " +
                lengths.unit() + "\n";
    if (least.witnesses.size() > 1) {
        text += formatted("   as close, to within the tolerance, at %zu more places", least.witnesses.size() - 1);
        if (subject.motion()) {
            text += ":";
            for (size_t i = 1; i < std::min<size_t>(least.witnesses.size(), 4); ++i)
                text += formatted("%s %.6g s", i > 1 ? "," : "", least.witnesses[i].time);
            if (least.witnesses.size() > 4) text += ", ...";
        }
        text += "\n";
    }
    return text;
}

std::string summary(const ClearanceReport& report, const Subject& subject) {
    std::map<Finding, int> counts;
    for (const ReportedPair& pair : report.pairs) ++counts[pair.finding];
    std::string text = formatted("%zu pair%s %s", report.pairs.size(), report.pairs.size() == 1 ? "" : "s", source_text(subject).c_str());
    if (subject.motion()) {
        const auto steps = count_of(subject.domain.path().steps);
        text += formatted(" (%s, %.6g s)", core::base::counted(static_cast<size_t>(steps), "step").c_str(),
                          core::stepper::time_at(subject.domain.path(), steps) - core::stepper::time_at(subject.domain.path(), 0));
    }
    const char* before = ": ";
    for (const auto& [finding, count] : counts) {
        text += formatted("%s%d %s", before, count, to_string(finding));
        before = ", ";
    }
    return text + "\n";
}

// The file of that name if meshes are judged; else `otherwise`, what was judged.
std::string file_of_part(const Subject& subject, const std::string& part, const std::string& otherwise) {
    for (const std::string& file : subject.files)
        if (std::filesystem::path(file).stem() == part) return file;
    return otherwise;
}

std::string shortest(double x) {
    char buffer[32];
    const auto [end, code] = std::to_chars(buffer, buffer + sizeof buffer, x);
    return {buffer, code == std::errc() ? end : buffer};
}

std::string margins_csv(const ClearanceReport& report, const Subject& subject, const RoundedLengths& lengths) {
    const std::string& unit = lengths.unit();
    std::string text = "a,b,step,segment,time_start[s],time_end[s],lower[" + unit + "],upper[" + unit + "]\n";
    for (const ReportedPair& pair : report.pairs) {
        for (const PairClearance& member : pair.members) {
            const std::string names = core::base::csv_cell(subject.model.bodies[member.a].name) + "," +
                                      core::base::csv_cell(subject.model.bodies[member.b].name) + ",";
            for (const core::clearance::MarginInterval& m : member.margin) {
                const double end = core::stepper::time_at(subject.domain.path(), m.step, m.segment, 1);
                text += names + std::to_string(m.step) + "," + std::to_string(m.segment) + "," +
                        shortest(core::stepper::time_at(subject.domain.path(), m.step, m.segment, 0)) + "," + shortest(end) + "," +
                        lengths.shortest(m.lower, Towards::down) + "," + lengths.shortest(m.upper, Towards::up) + "\n";
            }
        }
    }
    return text;
}

// Empty where a deviation has no influence.
std::string deviations_csv(const Subject& subject, const PairClearance& pair) {
    std::map<std::string, std::string> values;
    for (const clearance::WorstDeviation& d : worst_deviations(subject, pair)) {
        const auto unit = core::base::find_unit(d.unit);
        values[d.of] = formatted("%.9g", unit ? description::from_si(d.value, *unit) : d.value);
    }
    std::string text;
    for (const core::certificate::Deviation& d : subject.domain.made()->deviations) text += "," + values[d.of];
    return text;
}

std::string positions_csv(const ClearanceReport& report, const Subject& subject, const RoundedLengths& lengths) {
    const core::clearance::JointRanges& ranges = *subject.domain.ranges();
    const std::string& unit = lengths.unit();
    std::vector<std::string> joints;
    std::string text = "a,b,required[" + unit + "],lower[" + unit + "],upper[" + unit + "],finding";
    for (const auto& coordinate : ranges.linkage.coordinates) {
        for (const auto& joint : coordinate.joints) {
            joints.push_back(joint.joint);
            text += "," + core::base::csv_cell(joint.joint + (joint.is_angle ? "[deg]" : "[" + unit + "]"));
        }
    }
    if (subject.domain.made())
        for (const core::certificate::Deviation& d : subject.domain.made()->deviations)
            text += "," + core::base::csv_cell("deviation of " + d.of + (d.unit.empty() ? "" : "[" + d.unit + "]"));
    text += "\n";
    for (const ReportedPair& pair : report.pairs) {
        const PairClearance& least = pair.least;
        text += core::base::csv_cell(pair.spec.a.name) + "," + core::base::csv_cell(pair.spec.b.name) + "," +
                (pair.spec.required_by.empty() ? "" : formatted("%.9g", least.minimum / lengths.metres())) + "," +
                lengths.shortest(least.lower, Towards::down) + "," +
                (std::isfinite(least.upper) ? lengths.shortest(least.upper, Towards::up) : "") + "," + to_string(pair.finding);
        std::map<std::string, std::string> places;
        clearance::for_joints(ranges, least, [&](const auto& joint, double value, const auto&) {
            places[joint.joint] = formatted("%.9g", joint.is_angle ? value * degrees : value / lengths.metres());
        });
        for (const std::string& joint : joints) text += "," + places[joint];
        if (subject.domain.made()) text += deviations_csv(subject, least);
        text += "\n";
    }
    return text;
}

// "not examined: 7 pairs of bodies: a:b, ..."; empty of none.
std::string pair_list(const std::string& what, const std::vector<std::string>& pairs) {
    constexpr size_t most = 6;
    if (pairs.empty()) return {};
    return what + ": " + core::base::counted(pairs.size(), "pair") +
           " of bodies: " + joined(std::span(pairs).first(std::min(pairs.size(), most))) + (pairs.size() > most ? ", ...\n" : "\n");
}

// What was found of bodies that a joint joins, but for findings, which are rows.
std::string joined_text(const ClearanceReport& report, const Lengths& lengths, const Subject& subject) {
    using clearance::JoinedFinding;
    std::vector<std::string> apart, others;
    for (const clearance::JoinedPair& pair : report.joined) {
        const std::string name = subject.model.bodies[pair.a].name + ":" + subject.model.bodies[pair.b].name;
        if (pair.finding == JoinedFinding::apart) apart.push_back(name);
        if (pair.finding == JoinedFinding::touching) others.push_back(name + " touch");
        if (pair.finding != JoinedFinding::explained) continue;
        const auto& overlap = pair.clearance.overlap;
        others.push_back(name + " share material as a pin and its bore, which " + joint_text(pair) + " explains" +
                         (overlap ? " (" + overlapped(*overlap, lengths) + ")" : ""));
    }
    std::string text;
    if (!apart.empty()) text += pair_list("joined, so looked at as assembled alone, and apart there", apart);
    if (!others.empty()) text += "joined, so looked at as assembled alone: " + joined(others) + "\n";
    return text;
}

}  // namespace

std::string report_text(const ClearanceReport& report, const Subject& subject, int explain, const Console& console) {
    const Lengths lengths(answers::unit_name(subject.model.length_unit), report.tolerance);
    std::string text = table(report, subject, lengths, console);
    int told = 0;
    for (const ReportedPair& pair : report.pairs) {
        if (told == explain) break;
        if (!pair.least.is_far) text += "\n" + formatted("%d. ", ++told) + explained(pair, subject, lengths);
    }
    if (told > 0 && subject.source == clearance::SubjectSource::trajectory)
        text +=
            "\nno line is about round surfaces: a trajectory holds the meshes alone; give the scene or design (with --motion), only they "
            "know the surfaces that facets stand for\n";
    if (subject.domain.has_deviations()) text += without_influence(report, subject);
    text += "\n" + summary(report, subject);
    const auto far = std::count_if(report.pairs.begin(), report.pairs.end(), [](const ReportedPair& p) { return p.least.is_far; });
    if (far > 0)
        text += formatted(
            "%d of them are not listed: they stay at least twice as far apart as is required, and were not measured; name a pair with "
            "--pairs to measure it\n",
            static_cast<int>(far));
    std::map<std::string, int> reasons;
    for (const ReportedPair& pair : report.pairs)
        if (pair.least.status == core::clearance::PairStatus::undecided && !pair.least.reason.empty()) ++reasons[pair.least.reason];
    const auto touch = std::find_if(report.pairs.begin(), report.pairs.end(),
                                    [](const ReportedPair& p) { return p.finding == Finding::touching && !p.spec.may_touch; });
    if (touch != report.pairs.end()) text += "touching: faces lie on each other; if they are meant to, " + how_to_accept(*touch) + "\n";
    for (const ReportedPair& pair : report.pairs)
        if (const std::string facets = by_facets(pair, subject, lengths); !facets.empty()) text += pair_name(pair) + ": " + facets + "\n";
    std::vector<std::string> unexplained;
    for (const ReportedPair& pair : report.pairs)
        if (pair.finding == Finding::clash && !pair.joined_by.empty()) unexplained.push_back("\"" + pair_name(pair) + "\"");
    if (!unexplained.empty())
        text +=
            "joined, and what they share is no pin in its bore, which the joint would explain; if they are drawn so on purpose, add to "
            "the scene: \"ignore\": [" +
            joined(unexplained) + "]\n";
    for (const auto& [reason, count] : reasons) text += formatted("undecided (%d): ", count) + reason + "\n";
    if (std::any_of(report.pairs.begin(), report.pairs.end(), [](const ReportedPair& p) { return p.finding == Finding::contact; }))
        text += "contact: these push each other, so they are not judged; name a pair with --pairs to judge it\n";
    if (!report.left_out.empty())
        text += (subject.domain.is_tree() ? "not judged, as these may not collide: "
                                          : "not judged, because the simulation lets them pass through each other (no clash was found): ") +
                joined(report.left_out) + "; name them with --pairs\n";
    if (!report.ignored.empty()) text += "ignored: " + joined(report.ignored) + "\n";
    text += pair_list("ignored by the scene", report.ignored_by_scene) + pair_list("not judged, as of one group", report.one_group) +
            joined_text(report, lengths, subject) + pair_list("not examined", report.unexplained);
    for (const std::string& note : report.notes) text += "note: " + note + "\n";
    if (report.baseline) text += report.baseline->text();
    if (!report.message.empty()) text += report.message + "\n";
    return text + "overall: " + core::clearance::to_string(report.status) + "\n";
}

std::vector<Check> report_checks(const ClearanceReport& report, const Subject& subject, const std::string& file) {
    const std::string unit = answers::unit_name(subject.model.length_unit);
    const Lengths lengths(unit, report.tolerance);
    std::vector<Check> checks;
    for (const ReportedPair& pair : report.pairs) {
        const PairClearance& least = pair.least;
        Check check{pair_name(pair), to_check(least.status), to_string(pair.finding), found_of(pair, subject, lengths),
                    file_of_part(subject, pair.spec.a.name, file)};
        if (!pair.spec.required_by.empty()) check.message += "; required " + lengths.plain(least.minimum) + " " + unit + " per side";
        if (pair.finding == Finding::contact) check.message += "; they push each other, so the distance is not judged";
        if (pair.finding == Finding::undecided && least.is_bounded && !least.reason.empty())
            check.message += "; undecided: " + least.reason;
        if (subject.domain.is_tree()) check.message += worst_at(subject, pair, lengths);
        if (subject.motion() && !least.is_far && least.is_bounded)
            check.message +=
                least.is_clash() ? formatted(", from %.6g s on", least.clash_time) : formatted(", at %.6g s", least.witness.time);
        if (least.touch && has_distance(pair)) check.message += "; parts of the two touch " + touched(pair, lengths);
        if (pair.finding == Finding::touching && !pair.spec.may_touch) check.message += "; if they are meant to, " + how_to_accept(pair);
        if (!pair.change.word.empty()) check.message += " (" + pair.change.word + ")";
        checks.push_back(std::move(check));
    }
    if (!report.message.empty()) checks.push_back(not_judged(report.message, file));
    return checks;
}

std::string report_csv(const ClearanceReport& report, const Subject& subject) {
    const RoundedLengths lengths(answers::unit_name(subject.model.length_unit));
    return subject.domain.is_tree() ? positions_csv(report, subject, lengths) : margins_csv(report, subject, lengths);
}

}  // namespace fettle::design::cli
