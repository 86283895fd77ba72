// SPDX-License-Identifier: MIT
#include "core/clearance/range_clearance.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "core/base/parallel.hpp"
#include "core/clearance/body_motions.hpp"
#include "core/clearance/box_certification.hpp"
#include "core/clearance/pair_certification.hpp"
#include "core/clearance/range_search.hpp"
#include "core/clearance/shared_ball.hpp"
#include "core/clearance/touching.hpp"
#include "core/clearance/witness_instant.hpp"

namespace fettle::core::clearance {
namespace {

constexpr long range_bounds_a_second = 200'000;

// Rounding hides no more than a thousandth of the bodies' size.
bool has_small_slack(const ScrewedPair& pair) { return pair.slack <= 1e-3 * (pair.a.radius() + pair.b.radius()); }

void take_nearest(const ScrewedPair& pair, const RangeSearchResult& found, PairClearance& out) {
    for (std::size_t k = 0; k < out.at.size(); ++k) out.at[k] = found.nearest.at[k];
    out.witness = witness_between(pair.a, pair.b, found.nearest.element_a, found.nearest.element_b, found.nearest.pair);
    out.witnesses = {out.witness};
}

// Equal boxes, about so many, at least two along each coordinate.
std::vector<CoordinateBox> parts_of(const CoordinateBox& ranges, int coordinates, int about) {
    const int along = std::max(2, static_cast<int>(std::lround(std::pow(about, 1.0 / coordinates))));
    std::vector<CoordinateBox> parts{ranges};
    for (int k = 0; k < coordinates; ++k) {
        const auto i = static_cast<std::size_t>(k);
        const double low = ranges.low[i], width = ranges.high[i] - low;
        if (!(width > 0)) continue;
        std::vector<CoordinateBox> finer;
        for (CoordinateBox part : parts)
            for (int j = 0; j < along; ++j) {
                part.low[i] = low + width * j / along;
                part.high[i] = j + 1 == along ? ranges.high[i] : low + width * (j + 1) / along;
                finer.push_back(part);
            }
        parts = std::move(finer);
    }
    return parts;
}

Coordinates clamped(Coordinates at, const ScrewedPair& pair) {
    for (std::size_t k = 0; k < static_cast<std::size_t>(pair.count); ++k)
        at[k] = std::clamp(at[k], pair.ranges.low[k], pair.ranges.high[k]);
    return at;
}

bool is_in(const Coordinates& at, const ScrewedPair& pair) { return clamped(at, pair) == at; }

class RangeCertification : public BoxCertification {
public:
    RangeCertification(const model::Model& model, const JointRanges& ranges, const std::vector<PairRequest>& pairs,
                       const ClearanceOptions& options, certificate::Certificate* certificate)
        : BoxCertification(model, pairs, options, certificate), ranges_(ranges) {}

private:
    void name_box(certificate::Certificate& certificate) const override { certificate.linkage = ranges_.linkage; }

    PairClearance certified(std::size_t i) const override {
        const PairRequest& asked = request(i);
        PairClearance out = unmeasured({asked.a, asked.b, asked.minimum}, "");
        const certificate::LinkedPair linked = linked_pair(ranges_.linkage, asked.a, asked.b);
        out.coordinates = linked.coordinates;
        for (const int k : linked.coordinates) out.at.push_back(ranges_.linkage.coordinates[k].start);
        out.reason = obstacle(asked, count_of(linked.coordinates));
        if (out.reason.empty() && std::max(linked.a.size(), linked.b.size()) > static_cast<std::size_t>(most_screws))
            out.reason = "more than " + std::to_string(most_screws) + " joints lie between the two";
        if (out.reason.empty()) measure(linked, i, out);
        return out;
    }

    void measure(const certificate::LinkedPair& linked, std::size_t index, PairClearance& out) const {
        const ScrewedPair pair = screwed_pair(*shape(out.a).tree, *shape(out.b).tree, ranges_.linkage, linked, start(out.a), start(out.b));
        const BoxSearchOptions search = search_options(out, pair.count, pair.a.radius() + pair.b.radius(), range_bounds_a_second);
        if (!has_small_slack(pair)) {
            out.reason = "its numbers are so large that rounding hides the distance";
            return;
        }
        RangeSearchResult found = search_ranges(pair, search);
        take_bounds(found, out);
        const SolidBody a{*shape(out.a).tree, *shape(out.a).solid}, b{*shape(out.b).tree, *shape(out.b).solid};
        Coordinates at = found.nearest.at;
        const auto place_of = [&](const Coordinates& u, const auto& use) { use(a, b, held_at(pair, u)); };
        const bool meets = found.lower == 0 && found.nearest.element_a >= 0 && !found.intersecting;
        const double touch = default_touch_depth(*a.tree.mesh, *b.tree.mesh);
        if (meets && find_shared_ball(pair.ranges.low, pair.ranges.high, pair.count, touch, place_of, at)) {
            found.nearest = nearest_at(pair, at, {});
            out.solids = Solids::overlap;
            out.upper = 0;
        }
        if (found.intersecting && options().measure_overlap &&
            find_shared_ball(pair.ranges.low, pair.ranges.high, pair.count, 0, place_of, at)) {
            const RangeEncounter deepest = nearest_at(pair, at, {});  // elsewhere than where the search ended
            if (deepest.element_a >= 0 && deepest.pair.intersecting) found.nearest = deepest;
        }
        if (found.nearest.element_a >= 0) take_nearest(pair, found, out);
        if (out.is_clash() && options().measure_overlap) out.overlap = overlap_in_world(pair, a, b, found.nearest.at);
        if (is_recorded()) write_record(pair, found, search, out, record(index));
        if (is_in(pair.start, pair)) return finish(index, 0, out);
        stepper::Trajectory beside = start();
        const Coordinates nearest = clamped(pair.start, pair);
        beside.poses.front()[out.a] = pose_of(pair.body_a, nearest);
        beside.poses.front()[out.b] = pose_of(pair.body_b, nearest);
        finish(index, 0, out, &beside);
    }

    static std::optional<Overlap> overlap_in_world(const ScrewedPair& pair, const SolidBody& a, const SolidBody& b, const Coordinates& at) {
        constexpr int cells = 8192;
        auto overlap = measured_overlap(a, b, held_at(pair, at), 0, cells);
        if (overlap) overlap->center += pose_of(pair.body_b, at).position;
        return overlap;
    }

    void write_record(const ScrewedPair& pair, const RangeSearchResult& found, const BoxSearchOptions& search, PairClearance& out,
                      certificate::PairCertificate& record) const {
        record.a = out.a;
        record.b = out.b;
        record.at = out.at;
        if (found.nearest.element_a < 0) return;
        const double room = make_claim(pair.slack, out);
        certificate::BoxProof proof;
        if (out.lower > 0) proof = prove_ranges(pair, out.lower + 0.5 * room, search);
        if (proof.splits.empty()) out.lower = 0;
        if (out.lower > 0) record.boxes = {std::move(proof)};
        record.lower = out.lower;
        record.upper = found.upper + 4 * pair.slack;  // for the checker's own rounding
        const auto point = [&](const PieceTree& tree, const ScrewedBody& body, int element, Primitive kind, int corner, const Vector3& x) {
            const kinematics::Pose pose = pose_of(body, found.nearest.at);
            return certified_witness(tree, element, found.nearest.pair.intersecting, {kind, corner},
                                     pose.rotation.transpose() * (x - pose.position));
        };
        const ElementPairDistance& near = found.nearest.pair;
        record.point_a = point(pair.a, pair.body_a, found.nearest.element_a, near.kind_a, near.corner_a, near.point_a);
        record.point_b = point(pair.b, pair.body_b, found.nearest.element_b, near.kind_b, near.corner_b, near.point_b);
    }

    const JointRanges& ranges_;
};

}  // namespace

std::vector<PairClearance> certify(const model::Model& model, const JointRanges& ranges, const std::vector<PairRequest>& pairs,
                                   const ClearanceOptions& options) {
    return RangeCertification(model, ranges, pairs, options, nullptr).run();
}

RangeClearances::RangeClearances(const model::Model& model, JointRanges ranges, std::vector<PairRequest> pairs, ClearanceOptions options)
    : ranges_(std::move(ranges)),
      pairs_(std::move(pairs)),
      options_(std::move(options)),
      certification_(std::make_unique<RangeCertification>(model, ranges_, pairs_, options_, nullptr)) {}

RangeClearances::~RangeClearances() = default;

std::vector<PairClearance> RangeClearances::over(std::vector<PairRequest> pairs) {
    pairs_ = std::move(pairs);
    return certification_->run();
}

ProvenClearances certify_with_proof(const model::Model& model, const JointRanges& ranges, const std::vector<PairRequest>& pairs,
                                    const ClearanceOptions& options) {
    ProvenClearances proven;
    proven.pairs = RangeCertification(model, ranges, pairs, options, &proven.certificate).run();
    return proven;
}

std::vector<PairClearance> nearest_by_part(const model::Model& model, const JointRanges& ranges, const PairRequest& pair, int parts,
                                           double reach, double tolerance) {
    const certificate::LinkedPair linked = linked_pair(ranges.linkage, pair.a, pair.b);
    const std::size_t coordinates = linked.coordinates.size(), screws = std::max(linked.a.size(), linked.b.size());
    if (coordinates == 0 || coordinates > most_coordinates || screws > most_screws) return {};
    const std::vector<BodyShape> shapes = body_shapes(model, {pair.a, pair.b});
    const ScrewedPair whole = screwed_pair(*shapes[pair.a].tree, *shapes[pair.b].tree, ranges.linkage, linked,
                                           model.bodies[pair.a].pose_start, model.bodies[pair.b].pose_start);
    if (!has_small_slack(whole)) return {};
    const std::vector<CoordinateBox> boxes = parts_of(whole.ranges, whole.count, parts);
    std::vector<RangeSearchResult> found(boxes.size());
    base::parallel_for(count_of(boxes), 1, [&](int i) {
        ScrewedPair part = whole;
        part.ranges = boxes[i];
        part.start = middle_of(part.ranges);
        BoxSearchOptions search;
        search.tolerance = tolerance;
        search.enough = reach;
        found[i] = search_ranges(part, search);
    });
    std::vector<PairClearance> nearest;
    for (const RangeSearchResult& part : found) {
        if (part.nearest.element_a < 0 || !(part.upper <= reach)) continue;
        PairClearance out = unmeasured({pair.a, pair.b, pair.minimum}, "");
        out.coordinates = linked.coordinates;
        out.at.resize(coordinates);
        out.upper = part.upper;
        take_nearest(whole, part, out);
        nearest.push_back(std::move(out));
    }
    return nearest;
}

std::vector<kinematics::Pose> poses_at(const model::Model& model, const JointRanges& ranges, const std::vector<double>& at) {
    const certificate::Linkage& linkage = ranges.linkage;
    std::vector<kinematics::Pose> poses;
    for (std::size_t body = 0; body < model.bodies.size(); ++body) {
        kinematics::Pose pose = model.bodies[body].pose_start;
        for (int k = static_cast<int>(body); k >= 0; k = linkage.bodies[k].parent) {
            const std::vector<certificate::Screw>& screws = linkage.bodies[k].screws;
            for (auto screw = screws.rbegin(); screw != screws.rend(); ++screw)
                pose = moved(*screw, at[screw->coordinate] - linkage.coordinates[screw->coordinate].start, pose);
        }
        poses.push_back(pose);
    }
    return poses;
}

kinematics::Pose pose_at_witness(const model::Model& model, const JointRanges& ranges, const PairClearance& pair, int body) {
    const certificate::Linkage& linkage = ranges.linkage;
    const auto parent = [&](int of) { return linkage.bodies[of].parent; };
    // What moves both of the pair stays as at the start, for all bodies.
    std::set<int> of_a, of_both;
    for (int k = pair.a; k >= 0; k = parent(k)) of_a.insert(k);
    for (int k = pair.b; k >= 0; k = parent(k))
        if (of_a.count(k) > 0) of_both.insert(k);
    std::vector<int> line;
    for (int k = body; k >= 0; k = parent(k))
        if (of_both.count(k) == 0) line.push_back(k);
    ScrewedBody moved;
    moved.start = model.bodies[body].pose_start;
    for (auto k = line.rbegin(); k != line.rend(); ++k) {
        for (certificate::Screw screw : linkage.bodies[*k].screws) {
            const auto place = std::find(pair.coordinates.begin(), pair.coordinates.end(), screw.coordinate);
            if (place == pair.coordinates.end()) continue;
            moved.starts.push_back(linkage.coordinates[screw.coordinate].start);
            screw.coordinate = static_cast<int>(place - pair.coordinates.begin());
            moved.screws.push_back(screw);
        }
    }
    Coordinates at{};
    if (pair.at.size() > at.size()) return moved.start;
    std::copy(pair.at.begin(), pair.at.end(), at.begin());
    return pose_of(moved, at);
}

}  // namespace fettle::core::clearance
