// SPDX-License-Identifier: MIT
#include "design/clearance/report.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/base/text.hpp"

namespace fettle::design::clearance {

namespace {

using core::clearance::ClearanceOptions;
using core::clearance::PairClearance;
using core::clearance::PairRequest;
using core::clearance::PairStatus;
using core::clearance::Solids;
using core::clearance::Witness;

// At least 1, and no more than a count can be.
long spent(long usual, double times) { return static_cast<long>(std::clamp(static_cast<double>(usual) * times, 1.0, 1e15)); }

constexpr const char* one_inside_the_other = "material of one lies inside the other";

int severity(PairStatus status) {
    switch (status) {
        case PairStatus::violated:
            return 0;
        case PairStatus::undecided:
            return 1;
        case PairStatus::contact:
            return 2;
        case PairStatus::clear:
            break;
    }
    return 3;
}

bool is_worse(const PairClearance& x, const PairClearance& y) {
    if (x.is_clash() != y.is_clash()) return x.is_clash();
    return x.is_clash() ? x.clash_time < y.clash_time : x.upper < y.upper;
}

Solids worse_of(Solids x, Solids y) {
    for (const Solids each : {Solids::overlap, Solids::unproven, Solids::unverified, Solids::not_closed})
        if (x == each || y == each) return each;
    return Solids::disjoint;
}

std::optional<core::clearance::Touch> both(const std::optional<core::clearance::Touch>& x, const std::optional<core::clearance::Touch>& y) {
    if (!x || !y) return x ? x : y;
    return core::clearance::Touch{x->area + y->area, x->time, std::max(x->depth, y->depth), std::min(x->room, y->room),
                                  x->is_whole && y->is_whole};
}

// The whole pair: the least of its members.
PairClearance least_of(const std::vector<PairClearance>& members) {
    PairClearance least = members.front();
    for (size_t i = 1; i < members.size(); ++i) {
        const PairClearance &member = members[i], before = least;
        if (is_worse(member, before)) least = member;
        least.lower = std::min(before.lower, member.lower);
        least.upper = std::min(before.upper, member.upper);
        least.sampled = std::min(before.sampled, member.sampled);
        least.is_far = before.is_far && member.is_far;
        least.is_bounded = before.is_bounded && member.is_bounded;
        least.complete = before.complete && member.complete;
        least.intersecting = before.intersecting || member.intersecting;
        least.solids = worse_of(before.solids, member.solids);
        least.reason = before.reason.empty() ? member.reason : before.reason;
        least.touch = both(before.touch, member.touch);
        least.status = severity(member.status) < severity(before.status) ? member.status : before.status;
    }
    return least;
}

Finding finding_of(const Subject& subject, const ReportedPair& pair, bool stopped) {
    const PairClearance& least = pair.least;
    const bool pushes =
        std::any_of(pair.members.begin(), pair.members.end(), [&](const PairClearance& m) { return may_push(subject, m.a, m.b); });
    const bool near = !pair.spec.named && pushes && least.upper < subject.model.dhat + subject.model.dmin;
    if (least.is_clash()) return Finding::clash;
    const bool is_worse_apart = std::any_of(pair.members.begin(), pair.members.end(), [](const PairClearance& m) {
        return !m.touch && (m.status == PairStatus::violated || m.status == PairStatus::undecided);
    });
    if (least.touch && !is_worse_apart) return Finding::touching;
    if (least.status == PairStatus::clear) return Finding::clear;
    if (least.lower > 0 && core::certificate::are_apart(least.solids) && (near || least.status == PairStatus::contact))
        return pair.spec.required_by.empty() && !pushes ? Finding::clear : Finding::contact;
    if (near || (stopped && !least.complete)) return Finding::undecided;  // distinguished from a clash neither way
    return least.status == PairStatus::violated ? Finding::below : Finding::undecided;
}

PairStatus status_of(const ReportedPair& pair) {
    switch (pair.finding) {
        case Finding::clash:
        case Finding::below:
            return PairStatus::violated;
        case Finding::touching:
            return pair.least.status;
        case Finding::undecided:
            return PairStatus::undecided;
        case Finding::contact:
            return PairStatus::contact;
        case Finding::clear:
            break;
    }
    return PairStatus::clear;
}

// Less is worse: how much of what is required there is.
double kept_share(const ReportedPair& pair) {
    const double distance = pair.finding == Finding::below ? pair.least.upper : pair.least.lower;
    return pair.least.minimum > 0 && pair.finding != Finding::contact ? distance / pair.least.minimum : distance;
}

// Worst first; rows are large, and there may be many.
void sort(std::vector<ReportedPair>& pairs) {
    std::vector<size_t> order(pairs.size());
    std::iota(order.begin(), order.end(), size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](size_t i, size_t j) {
        const ReportedPair &x = pairs[i], &y = pairs[j];
        return x.finding != y.finding ? x.finding < y.finding : kept_share(x) < kept_share(y);
    });
    std::vector<ReportedPair> sorted;
    sorted.reserve(pairs.size());
    for (const size_t i : order) sorted.push_back(std::move(pairs[i]));
    pairs = std::move(sorted);
}

// Where every two bodies are of one group, ignored, or joined by a joint.
const char* why_none_is_apart(const PairSelection& selection) {
    const bool joined = !selection.joined.empty(), ignored = !selection.ignored_by_scene.empty(), grouped = !selection.one_group.empty();
    if (joined + ignored + grouped > 1) return "the bodies of every pair are of one group, ignored by the scene, or joined by a joint";
    return joined ? "a joint joins the bodies of every pair" : ignored ? "the scene ignores every pair" : "all bodies are of one group";
}

std::string why_none_is_judged(const Subject& subject, const PairSelection& selection) {
    if (subject.model.bodies.size() < 2) return "there are no two bodies";
    if (!selection.ignored.empty()) return "every pair is ignored";
    if (selection.left_out.empty()) return why_none_is_apart(selection);
    return std::string("no pair ") + (subject.domain.is_tree() ? "of bodies may collide" : "may collide in this motion") +
           "; name pairs with --pairs";
}

std::string why_not_judged(const Subject& subject, const PairSelection& selection, bool stopped) {
    std::string message;
    if (stopped) message = "interrupted: pairs that were not examined are undecided";
    if (!subject.incomplete.empty())
        message += (message.empty() ? "" : "; ") + std::string("the motion is known up to there only: ") + subject.incomplete;
    if (subject.domain.is_tree() && !subject.domain.ranges()->lost.empty())
        message +=
            (message.empty() ? "" : "; ") + core::base::joined(subject.domain.ranges()->lost) +
            ": that is hardly a range. Correct their `limits`, or leave them out (fettle import --ignore-mimic-limits does, as ROS does)";
    if (selection.pairs.empty())
        message += (message.empty() ? "" : "; ") + std::string("nothing was judged: ") + why_none_is_judged(subject, selection);
    return message;
}

// Nobody reads each distance of more pairs than this: those that nobody named, and that stay twice their minimum apart, are left at that.
constexpr std::size_t most_measured = 100;

std::vector<PairRequest> requests_of(const PairSelection& selection, bool all_measured) {
    std::vector<PairRequest> requests;
    for (const PairSpec& pair : selection.pairs) {
        for (const auto& [a, b] : pair.body_pairs) {
            requests.push_back({a, b, pair.minimum});
            requests.back().may_touch = pair.may_touch;
            requests.back().touch_depth = pair.touch_depth;
        }
    }
    if (all_measured || requests.size() <= most_measured) return requests;
    auto request = requests.begin();
    for (const PairSpec& pair : selection.pairs) {
        for (std::size_t i = 0; i < pair.body_pairs.size(); ++i, ++request) {
            if (!pair.named && pair.minimum > 0) request->far = 2 * pair.minimum;
        }
    }
    return requests;
}

// Those that are not judged: a clash of theirs is found, and they become rows of the report for it.
std::vector<PairClearance> clashes_of_left_out(const Subject& subject, ClearanceOptions options, PairSelection& selection) {
    options.margin_curve = options.sample_nodes = false;
    options.on_pair = nullptr;
    options.enough = 10 * options.tolerance;
    std::vector<PairRequest> requests;
    for (const PairSpec& pair : selection.left_out) {
        for (const auto& [a, b] : pair.body_pairs) requests.push_back({a, b, 0, options.enough});
    }
    const auto found = certify(subject.model, subject.domain, requests, options);
    std::vector<PairClearance> clashes;
    std::vector<PairSpec> apart;
    auto first = found.begin();
    for (PairSpec& pair : selection.left_out) {
        const auto last = first + static_cast<std::ptrdiff_t>(pair.body_pairs.size());
        if (std::any_of(first, last, [](const auto& each) { return each.is_clash(); })) {
            clashes.insert(clashes.end(), first, last);
            selection.pairs.push_back(std::move(pair));
        } else {
            apart.push_back(std::move(pair));
        }
        first = last;
    }
    selection.left_out = std::move(apart);
    return clashes;
}

// That two touch, which is accepted, is not what a certificate can say: its bounds would call it too close.
void leave_out_touching(const std::vector<PairClearance>& results, core::certificate::Certificate& certificate) {
    std::erase_if(certificate.pairs, [&](const core::certificate::PairCertificate& pair) {
        return std::any_of(results.begin(), results.end(), [&](const PairClearance& each) {
            return each.a == pair.a && each.b == pair.b && each.touch && each.status == PairStatus::contact;
        });
    });
}

// The minima that it is judged by where nobody asks for others: those of the question, which stand before the design's own.
void add_minima(const std::vector<PairMinimum>& required, const PairSelection& selection, core::certificate::Certificate& certificate) {
    const auto add = [&](int a, int b, double minimum) {
        for (core::certificate::PairCertificate& pair : certificate.pairs)
            if (std::minmax(pair.a, pair.b) == std::minmax(a, b)) pair.minimum = minimum;
    };
    for (const PairMinimum& each : required) add(each.a, each.b, each.minimum);
    for (const PairSpec& pair : selection.pairs) {
        if (pair.required_by.empty()) continue;
        for (const auto& [a, b] : pair.body_pairs) add(a, b, pair.minimum);
    }
}

// A row for what is a finding.
void add_joined(const Subject& subject, std::vector<JoinedPair> joined, ClearanceReport& report) {
    for (const JoinedPair& each : joined) {
        if (each.finding != JoinedFinding::clash && each.finding != JoinedFinding::undecided) continue;
        ReportedPair pair;
        const auto unit = [&](int body) { return Unit{subject.model.bodies[body].name, {body}, false}; };
        pair.spec = {unit(each.a), unit(each.b), 0, "", false, 0, false, {{each.a, each.b}}};
        pair.least = each.clearance;
        pair.members = {each.clearance};
        pair.joined_by = joint_text(each);
        pair.finding = each.finding == JoinedFinding::clash ? Finding::clash : Finding::undecided;
        if (each.finding == JoinedFinding::clash && each.clearance.solids == Solids::overlap) pair.overlap = one_inside_the_other;
        pair.least.status = status_of(pair);
        report.pairs.push_back(std::move(pair));
    }
    report.joined = std::move(joined);
}

// `results`: one per pair of bodies, in the order of the selection.
ClearanceReport make_report(const Subject& subject, const PairSelection& selection, const std::vector<PairClearance>& results,
                            std::vector<JoinedPair> joined, bool stopped) {
    ClearanceReport report;
    report.ignored = selection.ignored;
    report.ignored_by_scene = pair_names(subject.model, selection.ignored_by_scene);
    report.one_group = pair_names(subject.model, selection.one_group);
    report.left_out = pair_names(selection.left_out);
    size_t next = 0;
    const auto set_time = [&](Witness& w) { w.time = core::stepper::time_at(subject.domain.path(), w.step, w.segment, w.s); };
    for (const PairSpec& spec : selection.pairs) {
        ReportedPair pair;
        pair.spec = spec;
        for (size_t i = 0; i < spec.body_pairs.size(); ++i) {
            pair.members.push_back(results[next++]);
            if (pair.members.back().is_far || subject.domain.is_tree()) continue;
            set_time(pair.members.back().witness);  // where times are uneven only the trajectory knows them
            for (Witness& witness : pair.members.back().witnesses) set_time(witness);
        }
        pair.least = least_of(pair.members);
        if (pair.least.solids == Solids::overlap) pair.overlap = one_inside_the_other;
        pair.finding = finding_of(subject, pair, stopped);
        pair.least.status = status_of(pair);
        report.pairs.push_back(std::move(pair));
    }
    add_joined(subject, std::move(joined), report);
    for (const ReportedPair& pair : report.pairs) {
        if (pair.least.status == PairStatus::violated) report.status = PairStatus::violated;
        if (pair.least.status == PairStatus::undecided && report.status == PairStatus::clear) report.status = PairStatus::undecided;
    }
    const BodyPairs uncovered = uncovered_pairs(subject.model, selection);
    report.uncovered = pair_names(subject.model, uncovered);
    report.unexplained = pair_names(subject.model, unexplained_pairs(subject.model, uncovered, selection));
    report.message = why_not_judged(subject, selection, stopped);
    if (stopped || (!report.message.empty() && report.status == PairStatus::clear)) report.status = PairStatus::undecided;
    sort(report.pairs);
    return report;
}

}  // namespace

const char* to_string(Finding finding) {
    switch (finding) {
        case Finding::clash:
            return "clash";
        case Finding::below:
            return "below threshold";
        case Finding::touching:
            return "touching";
        case Finding::undecided:
            return "undecided";
        case Finding::contact:
            return "contact";
        case Finding::clear:
            break;
    }
    return "clear";
}

Result<ClearanceReport> judge_clearances(const Subject& subject, const Question& question) {
    Result<PairSelection> selection =
        select_pairs(subject.model, question.pairs, subject.motion() || subject.moves_over_ranges(), subject.wanted);
    if (!selection) return selection.errors();
    const std::vector<PairRequest> requests = requests_of(*selection, question.margins);
    ClearanceOptions options = core::clearance::usual_options(requests, question.tolerance);
    options.max_bounds = spent(options.max_bounds, question.budget);
    options.max_evaluations = spent(options.max_evaluations, question.budget);
    options.motion = subject.motion();
    options.margin_curve = question.margins;
    options.witness_tolerance = question.all_witnesses ? options.tolerance : 0;
    options.on_pair = question.on_pair;
    options.should_stop = question.should_stop;
    core::clearance::ProvenClearances proven;
    if (question.proof) {
        proven = certify_with_proof(subject.model, subject.domain, requests, options);
        leave_out_touching(proven.pairs, proven.certificate);
        add_minima(subject.required, *selection, proven.certificate);
    } else {
        proven.pairs = certify(subject.model, subject.domain, requests, options);
    }
    if (!subject.domain.is_tree()) {
        const auto clashes = clashes_of_left_out(subject, options, *selection);
        proven.pairs.insert(proven.pairs.end(), clashes.begin(), clashes.end());
    }
    std::vector<JoinedPair> joined = look_at_joined(subject, selection->joined, options);
    ClearanceReport report = make_report(subject, *selection, proven.pairs, std::move(joined), question.should_stop());
    report.tolerance = options.tolerance;
    report.notes = subject.notes;
    report.notes.insert(report.notes.end(), selection->notes.begin(), selection->notes.end());
    if (question.pairs.minimum && !question.pairs.process.empty())
        report.notes.push_back("--minimum applies; what --process " + question.pairs.process + " requires was not judged");
    if (question.proof) report.certificate = std::move(proven.certificate);
    return report;
}

void compare_with(Baseline baseline, ClearanceReport& report) {
    for (ReportedPair& pair : report.pairs) pair.change = baseline.compare(pair.spec.a.name, pair.spec.b.name, pair.least.status);
    report.baseline = std::move(baseline);
}

}  // namespace fettle::design::clearance
