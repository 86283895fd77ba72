// SPDX-License-Identifier: MIT
#include "core/clearance/pair_certification.hpp"

#include <algorithm>
#include <limits>
#include <vector>

#include "core/base/limits.hpp"
#include "core/clearance/crossing.hpp"
#include "core/clearance/overlap.hpp"
#include "core/clearance/segment_proof.hpp"
#include "core/clearance/touching.hpp"

namespace fettle::core::clearance {
namespace {

constexpr int most_instants = 32;  // at which solids are looked at

double most_slack(const PairMotion& pair) {
    double slack = 0;
    for (const PairSegment& segment : pair.segments) slack = std::max(slack, segment.slack);
    return slack;
}

// Is the distance something that arithmetic can tell? Else a search would halve for ever: numbers so large that rounding moves bodies by
// more than a thousandth of what is to be distinguished, or a million radians in one segment.
bool is_measurable(const PairMotion& pair) {
    return std::all_of(pair.segments.begin(), pair.segments.end(), [&](const PairSegment& segment) {
        const double apart = (segment.a->poses[0].position - segment.b->poses[0].position).norm();
        return segment.slack <= 1e-3 * (pair.a.radius() + pair.b.radius() + apart) && segment.a->speed <= 1e6 && segment.b->speed <= 1e6;
    });
}

constexpr long path_bounds_a_second = 1'000'000;

StopRule stop_rule(const ClearanceOptions& options, double minimum, bool is_recorded) {
    return {minimum, options.answer_is_enough, is_recorded ? path_bounds_a_second / 50 : path_bounds_a_second / 5, path_bounds_a_second};
}

// A certificate's checker rounds in its own way and bounds curves in its own way: the claim leaves it this much room, of which its proof
// takes half. What keeps the minimum keeps it in the claim.
double checking_room(const PairMotion& pair, const SearchOptions& search, const SearchResult& found, double tolerance) {
    const double least = 8 * most_slack(pair), minimum = search.stop.minimum;
    const double room = search.stop.gap(tolerance, found.upper, found.evaluations) / 8 + least;
    return search.stop.answer_is_enough && minimum < found.lower ? std::max(least, std::min(room, 0.5 * (found.lower - minimum))) : room;
}

// The least at the nodes of the path, as a tool that samples would see it; a good upper bound for a search over the motion, too.
Encounter least_at_nodes(const PairMotion& pair, SearchOptions search) {
    search.sample_nodes = pair.segments.size() > 1;  // the motion is searched as well, which costs little more
    search.nodes_only = !search.sample_nodes;
    if (search.nodes_only) search.tolerance *= 0.01;
    const SearchResult found = search_pair(pair.a, pair.b, pair.segments, search);
    return search.nodes_only ? found.nearest : found.sampled;
}

SearchResult certified_search(const PairMotion& pair, const ClearanceOptions& options, double minimum, SearchOptions search,
                              const std::optional<PairRecord>& record) {
    search.enough = options.enough;
    search.stop = stop_rule(options, minimum, record.has_value());
    if (!record) {
        search.sample_nodes = options.sample_nodes && pair.segments.size() > 1;
        return search_pair(pair.a, pair.b, pair.segments, search);
    }
    search.tolerance *= 0.75;
    SearchResult found = search_pair(pair.a, pair.b, pair.segments, search);
    const double room = checking_room(pair, search, found, options.tolerance);
    found.lower = std::max(0.0, found.lower - room);
    record->certificate.boxes.clear();
    if (found.lower > 0) {
        record->certificate.boxes =
            prove_path(pair, record->a, record->b, record->certificate, found.lower + 0.5 * room, options.should_stop);
        if (record->certificate.boxes.empty()) found.lower = 0, found.complete = false;
    }
    complete_certificate(pair, found, record->certificate);
    return found;
}

class PairCertification {
public:
    PairCertification(const PairMotion& pair, const PairRequest& request, const ClearanceOptions& options,
                      const std::optional<PairRecord>& record)
        : pair_(pair), request_(request), options_(options), record_(record) {
        result_.a = request.a;
        result_.b = request.b;
        result_.minimum = required_gap(request);
        search_.tolerance = options.tolerance;
        search_.max_evaluations = options.max_evaluations;
        search_.should_stop = options.should_stop;
    }

    PairClearance run(double contact_distance) {
        measure();
        look_at_minimum();
        if (found_.lower == 0 && found_.complete) {
            look_closer();
            settle();
            look_for_touch();
            look_at_what_they_share();
        } else {
            decide_solids();
        }
        if (record_) record_->certificate.solids = result_.intersecting ? Solids::unproven : result_.solids;
        tell_bounds();
        if (result_.is_clash()) describe_clash();
        judge(result_, request_, contact_distance, crosses_);
        if (options_.margin_curve) result_.margin = margin_curve(pair_, found_, search_);
        return std::move(result_);
    }

private:
    void measure() {
        const bool apart = options_.sample_nodes && (record_ || pair_.segments.size() == 1);
        if (apart) {
            SearchOptions at_nodes = search_;
            at_nodes.stop = stop_rule(options_, result_.minimum, false);
            search_.seed = least_at_nodes(pair_, at_nodes);
        }
        found_ = certified_search(pair_, options_, result_.minimum, search_, record_);
        result_.sampled = !options_.sample_nodes ? infinity : (apart ? *search_.seed : found_.sampled).pair.distance;
        search_.seed.reset();
    }

    // The tolerance is how well a distance is measured; whether the minimum is kept is asked as finely as it takes, as far as rounding
    // lets.
    void look_at_minimum() {
        constexpr int tries = 8;
        for (int k = 0; k < tries && found_.complete && !found_.intersecting; ++k) {
            if (!(found_.lower < result_.minimum && result_.minimum <= found_.upper)) return;
            const double room = found_.upper - result_.minimum;
            if (!(room > 64 * most_slack(pair_))) return;
            search_to(0.5 * room, search_.max_evaluations / 20);
        }
    }

    // Closer than the tolerance, which need not mean that they touch: a finer one may prove that they do not.
    void look_closer() {
        if (found_.intersecting || !(found_.upper > 64 * most_slack(pair_)) || !(found_.upper <= 10 * options_.tolerance)) return;
        search_to(1e-2 * found_.upper, search_.max_evaluations / 20);
    }

    // The better one of two proofs counts, and beside it whatever was found nearest by any search.
    void search_to(double tolerance, long max_evaluations) {
        ClearanceOptions finer = options_;
        SearchOptions search = search_;
        finer.sample_nodes = finer.answer_is_enough = false;
        finer.tolerance = search.tolerance = tolerance;
        search.max_evaluations = max_evaluations;
        const certificate::PairCertificate before = record_ ? record_->certificate : certificate::PairCertificate{};
        SearchResult closer = certified_search(pair_, finer, result_.minimum, search, record_);
        if (closer.lower > found_.lower) {
            if (found_.upper < closer.upper) {
                closer.upper = found_.upper;
                closer.nearest = found_.nearest;
            }
            closer.sampled = found_.sampled;
            found_ = closer;
            if (record_) complete_certificate(pair_, found_, record_->certificate);
            return;
        }
        if (record_) record_->certificate = before;
        if (!closer.intersecting) return;
        found_.intersecting = true;
        found_.nearest = closer.nearest;
    }

    void settle() {
        if (found_.lower > 0) return decide_solids();
        result_.intersecting = found_.intersecting;
        if (!result_.intersecting) {
            const CrossingResult crossing = find_crossing(pair_, search_);
            if (crossing.crossing) {
                result_.intersecting = true;
                known_ = *crossing.crossing;
            } else if (crossing.lower > 0) {
                if (record_)  // this proof is none that a certificate can tell
                    search_to(0.5 * crossing.lower, search_.max_evaluations);
                else
                    found_.lower = std::min(crossing.lower, found_.upper);
                if (found_.lower > 0) return decide_solids();
            }
        } else {
            known_ = found_.nearest;
        }
        if (!result_.intersecting && shares_a_ball()) result_.intersecting = true;
    }

    certificate::PairStart pair_start() const {
        const PairSegment& first = pair_.segments.front();
        certificate::PairStart start{pair_.trajectory, first.step, first.segment, result_.a, result_.b};
        if (ask_for_path(pair_.solid_a, pair_.solid_b))
            for (const PairSegment& segment : pair_.segments) start.path.push_back({segment.step, segment.segment});
        start.charge = request_.charge;
        return start;
    }

    // Neither apart nor, so far as is known, deep in each other.
    void look_for_touch() {
        if (!options_.measure_overlap || found_.lower > 0) return;
        const double depth = request_.touch_depth > 0 ? request_.touch_depth : default_touch_depth(pair_);
        if (!(found_.upper <= depth)) return;
        auto room = proven_touch(pair_, pair_start(), depth, search_);
        if (!room && !options_.motion) room = measured_touch(depth);
        if (!room) return;
        Touch touch{0, time_of(pair_, found_.nearest.segment, found_.nearest.s), depth, *room};
        for (const Instant& at : instants()) {
            const TouchingArea found = touching_area(pair_, at.segment, at.s, depth);
            touch.is_whole = touch.is_whole && found.is_whole;
            if (!(found.area > touch.area)) continue;
            touch.area = found.area;
            touch.time = time_of(pair_, at.segment, at.s);
        }
        result_.touch = touch;
        crosses_ = result_.intersecting;
        result_.intersecting = false;
        result_.solids = Solids::unproven;
    }

    // The depth itself is known of bodies that stand still, where their solids can be cut. @return as proven_touch
    std::optional<double> measured_touch(double depth) const {
        if (!winds_once(*pair_.a.mesh) || !winds_once(*pair_.b.mesh)) return std::nullopt;
        const auto overlap = overlap_at({found_.nearest.segment, found_.nearest.s}, cell_budget(), measured_overlap);
        if (!overlap || !(overlap->depth_upper <= depth)) return std::nullopt;
        return depth - overlap->depth_upper;
    }

    // Flush or thin parts need have no edge that passes through a face, nor a ball that few cells find: what they share is cut.
    void look_at_what_they_share() {
        if (!options_.measure_overlap || found_.lower > 0 || result_.is_clash() || result_.touch) return;
        const Instant at{found_.nearest.segment, found_.nearest.s};
        const auto overlap = overlap_at(at, cell_budget(), measured_overlap);
        if (!overlap || !(overlap->depth_lower > default_touch_depth(pair_))) return;
        known_ = found_.nearest;
        result_.solids = Solids::overlap;
    }

    // Surfaces that never meet leave one thing to ask, whose answer never changes.
    void decide_solids() {
        result_.solids = certificate::solids_of(pair_.solid_a, pair_.solid_b, pair_start(), found_.lower);
        if (!record_ || result_.solids != Solids::overlap) return;
        record_->certificate.lower = 0;
        record_->certificate.boxes.clear();
    }

    struct Instant {
        int segment = 0;
        double s = 0;
    };

    // Where they are nearest, where a crossing was found, and nodes of the path.
    std::vector<Instant> instants() const {
        std::vector<Instant> list{{found_.nearest.segment, found_.nearest.s}};
        if (known_.segment >= 0) list.push_back({known_.segment, known_.s});
        const auto count = count_of(pair_.segments);
        const int nodes = std::min(count, most_instants - 3);
        for (int i = 0; i < nodes; ++i) list.push_back({static_cast<int>(static_cast<long>(i) * count / nodes), 0});
        list.push_back({count - 1, 1});
        return list;
    }

    int cell_budget() const {
        const double triangles = static_cast<double>(pair_.a.mesh->triangles.size() + pair_.b.mesh->triangles.size());
        return static_cast<int>(std::clamp(1e8 / (triangles + 1), 100.0, 20000.0));
    }

    using Measure = std::optional<Overlap>(const SolidBody&, const SolidBody&, const PairSegment&, double, int);
    std::optional<Overlap> overlap_at(const Instant& at, int cells, Measure measure = clearance::overlap_at) const {
        const PairSegment& segment = pair_.segments[at.segment];
        auto overlap = measure({pair_.a, pair_.solid_a}, {pair_.b, pair_.solid_b}, segment, at.s, cells);
        if (!overlap) return overlap;
        overlap->time = time_of(pair_, at.segment, at.s);
        overlap->center += kinematics::pose_at(segment.b->path, at.s).position;
        return overlap;
    }

    // At the deepest of the instants, roughly: of thin overlaps, where few cells find no ball, where surfaces are known to meet.
    std::optional<Overlap> deepest() const {
        std::vector<std::pair<double, Instant>> found;
        for (const Instant& at : instants())
            if (const auto overlap = overlap_at(at, std::max(cell_budget() / most_instants, 64)))
                found.emplace_back(overlap->depth_lower, at);
        std::stable_sort(found.begin(), found.end(), [](const auto& x, const auto& y) { return x.first > y.first; });
        constexpr std::size_t most_measured = 3;
        for (std::size_t i = 0; i < std::min(found.size(), most_measured); ++i)
            if (auto overlap = overlap_at(found[i].second, cell_budget(), measured_overlap)) return overlap;
        return std::nullopt;
    }

    bool shares_a_ball() {
        for (const Instant& at : instants()) {
            const auto overlap = overlap_at(at, std::max(cell_budget() / most_instants, 64));
            if (!overlap || !(overlap->depth_lower > 0)) continue;
            known_ = found_.nearest;
            known_.segment = at.segment;
            known_.s = at.s;
            result_.solids = Solids::overlap;
            return true;
        }
        return false;
    }

    void tell_bounds() {
        const bool inside = result_.solids == Solids::overlap;
        result_.lower = result_.is_clash() ? 0 : found_.lower;
        result_.upper = inside ? 0 : found_.upper;
        result_.complete = found_.complete;
        result_.witnesses =
            all_witnesses(pair_, found_.nearest, result_.is_clash() ? 0 : options_.witness_tolerance, options_.max_witnesses, search_);
        result_.witness = result_.witnesses.front();
    }

    void describe_clash() {
        result_.clash_not_before = result_.clash_time = time_of(pair_, 0, 0);  // of one inside the other: from the start on
        if (result_.intersecting && known_.segment >= 0 && pair_.segments.front().step >= 0) {
            const FirstContact first = first_contact(pair_, known_, search_);
            result_.clash_not_before = first.not_before;
            result_.witness = result_.witnesses.front() = witness_of(pair_, first.encounter);
            result_.clash_time = result_.witness.time;
        }
        if (!options_.measure_overlap) return;
        result_.overlap = deepest();
    }

    const PairMotion& pair_;
    const PairRequest& request_;
    const ClearanceOptions& options_;
    const std::optional<PairRecord>& record_;
    SearchOptions search_;
    SearchResult found_;
    bool crosses_ = false;  // of bodies that touch: it was found that they are in each other
    Encounter known_;       // in each other at its instant; segment -1: not known
    PairClearance result_;
};

}  // namespace

std::optional<double> proven_apart(const PairMotion& pair, double reach, const ClearanceOptions& options) {
    if (!is_measurable(pair)) return std::nullopt;
    SearchOptions search;
    search.tolerance = options.tolerance;
    search.max_evaluations = options.max_evaluations;
    search.should_stop = options.should_stop;
    search.enough = search.refuted = reach;
    search.exact_witness = false;
    const SearchResult found = search_pair(pair.a, pair.b, pair.segments, search);
    if (!(found.lower >= reach)) return std::nullopt;
    return found.lower;
}

void judge(PairClearance& pair, const PairRequest& request, double contact_distance, bool crosses) {
    const bool told = pair.lower > 0 && certificate::are_apart(pair.solids);
    if (pair.is_clash()) {
        pair.status = PairStatus::violated;
    } else if (pair.touch) {
        pair.status = request.may_touch                      ? PairStatus::contact
                      : crosses || pair.upper < pair.minimum ? PairStatus::violated
                                                             : PairStatus::undecided;
    } else if (pair.minimum > 0) {
        pair.status = told && pair.lower >= pair.minimum ? PairStatus::clear
                      : pair.upper < pair.minimum        ? PairStatus::violated
                                                         : PairStatus::undecided;
    } else if (!told) {
        pair.status = PairStatus::undecided;
    } else if (!(pair.upper >= contact_distance)) {
        pair.status = PairStatus::contact;
    } else {
        pair.status = pair.complete || pair.lower >= contact_distance ? PairStatus::clear : PairStatus::undecided;
    }
    if (pair.status != PairStatus::undecided) return;
    pair.reason = pair.touch       ? "they touch: neither a gap nor a clash"
                  : !pair.complete ? "the search was cut short, by a stop or its budget"
                  : request.may_touch && !(pair.lower > 0)
                      ? "they may touch, but it is not proven that they are nowhere deeper in each other than that"
                  : !(pair.lower > 0)
                      ? "the surfaces come within rounding of each other: neither that they cross nor that they stay apart is proven"
                  : !told ? why_not_apart(pair.solids)
                          : "the minimum lies between the bounds, which rounding or the budget of the search keeps from coming closer";
}

PairClearance unmeasured(const PairRequest& request, const std::string& reason) {
    PairClearance result;
    result.a = request.a;
    result.b = request.b;
    result.minimum = required_gap(request);
    result.upper = result.sampled = infinity;
    result.complete = false;
    result.reason = reason;
    result.witnesses.push_back(result.witness);
    return result;
}

PairClearance certify_pair(const PairMotion& pair, const PairRequest& request, double contact_distance, const ClearanceOptions& options,
                           const std::optional<PairRecord>& record) {
    if (!is_measurable(pair)) return unmeasured(request, "its numbers are so large that rounding hides the distance");
    return PairCertification(pair, request, options, record).run(contact_distance);
}

}  // namespace fettle::core::clearance
