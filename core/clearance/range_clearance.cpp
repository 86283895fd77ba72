// SPDX-License-Identifier: MIT
#include "fettle/core/clearance/range_clearance.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <optional>
#include <set>

#include "fettle/core/base/limits.hpp"
#include "fettle/core/base/parallel.hpp"
#include "fettle/core/clearance/body_motions.hpp"
#include "fettle/core/clearance/certificate_builder.hpp"
#include "fettle/core/clearance/clearance.hpp"
#include "fettle/core/clearance/pair_certification.hpp"
#include "fettle/core/clearance/range_search.hpp"

namespace fettle::core::clearance {
namespace {

// What a claim leaves for a checker that rounds in its own way.
double room_of(const ScrewedPair& pair, double tolerance) { return tolerance / 8 + 8 * pair.slack; }

Witness range_witness(const ScrewedPair& pair, const RangeEncounter& nearest) {
    const ElementPairDistance& found = nearest.pair;
    Witness w;
    w.kind_a = found.kind_a;
    w.kind_b = found.kind_b;
    w.edge_edge = found.kind_a == Primitive::edge && found.kind_b == Primitive::edge;
    w.vertex_on_a = found.kind_a == Primitive::vertex;
    w.primitive_a = primitive_index(pair.a, nearest.element_a, found.kind_a, found.corner_a);
    w.primitive_b = primitive_index(pair.b, nearest.element_b, found.kind_b, found.corner_b);
    w.point_a = found.point_a;
    w.point_b = found.point_b;
    w.distance = found.distance;
    return w;
}

// Rounding hides no more than a thousandth of the bodies' size.
bool has_small_slack(const ScrewedPair& pair) { return pair.slack <= 1e-3 * (pair.a.radius() + pair.b.radius()); }

void take_nearest(const ScrewedPair& pair, const RangeSearchResult& found, PairClearance& out) {
    for (std::size_t k = 0; k < out.at.size(); ++k) out.at[k] = found.nearest.at[k];
    out.witness = range_witness(pair, found.nearest);
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

class RangeCertification {
public:
    RangeCertification(const model::Model& model, const JointRanges& ranges, const std::vector<PairRequest>& pairs,
                       const ClearanceOptions& options, certificate::Certificate* certificate)
        : model_(model),
          ranges_(ranges),
          pairs_(pairs),
          options_(options),
          certificate_(certificate),
          start_(as_assembled(model)),
          usable_(have_usable_numbers(model, start_, {{}})),
          shapes_(body_shapes(model, bodies_of(pairs, count_of(model.bodies)))) {}

    std::vector<PairClearance> run() {
        if (certificate_ != nullptr) start_record();
        std::vector<PairClearance> results(pairs_.size());
        std::mutex report;
        int done = 0;
        const auto count = count_of(pairs_);
        // Each pair is a search of its own: the number of threads cannot change a result.
        base::parallel_for(count, 1, [&](int i) {
            results[i] = certified(static_cast<std::size_t>(i));
            if (!options_.on_pair) return;
            const std::lock_guard<std::mutex> lock(report);
            options_.on_pair(++done, count);
        });
        if (certificate_ != nullptr) drop_unmeasured(*certificate_);
        return results;
    }

private:
    void start_record() {
        std::vector<const PieceTree*> trees;
        for (const BodyShape& shape : shapes_) trees.push_back(shape.tree.get());
        *certificate_ = start_certificate(model_, start_, trees, false, pairs_.size());
        certificate_->linkage = ranges_.linkage;
    }

    PairClearance certified(std::size_t i) const {
        const PairRequest& request = pairs_[i];
        PairClearance out = unmeasured({request.a, request.b, request.minimum}, "");
        const certificate::LinkedPair linked = linked_pair(ranges_.linkage, request.a, request.b);
        out.coordinates = linked.coordinates;
        for (const int k : linked.coordinates) out.at.push_back(ranges_.linkage.coordinates[k].start);
        if (linked.coordinates.size() > static_cast<std::size_t>(most_coordinates)) {
            out.reason = std::to_string(linked.coordinates.size()) + " coordinates move the two against each other; at most " +
                         std::to_string(most_coordinates) + " can be looked at together";
            return out;
        }
        if (std::max(linked.a.size(), linked.b.size()) > static_cast<std::size_t>(most_screws)) {
            out.reason = "more than " + std::to_string(most_screws) + " joints lie between the two";
            return out;
        }
        for (const int body : {request.a, request.b})
            if (!usable_[body]) {
                out.reason = "its numbers are not finite, or larger than 1e30";
                return out;
            }
        measure(linked, i, out);
        return out;
    }

    const kinematics::Pose& start(int body) const { return start_.poses.front()[body]; }

    void measure(const certificate::LinkedPair& linked, std::size_t index, PairClearance& out) const {
        const BodyShape &shape_a = shapes_[out.a], &shape_b = shapes_[out.b];
        const ScrewedPair pair = screwed_pair(*shape_a.tree, *shape_b.tree, ranges_.linkage, linked, start(out.a), start(out.b));
        const double size = pair.a.radius() + pair.b.radius();
        out.tolerance = pair.count > 2 && options_.coarse > 0 ? std::max(options_.tolerance, options_.coarse * size) : options_.tolerance;
        if (!has_small_slack(pair)) {
            out.reason = "its numbers are so large that rounding hides the distance";
            return;
        }
        RangeSearchOptions search;
        search.tolerance = certificate_ != nullptr ? 0.75 * out.tolerance : out.tolerance;
        search.minimum = out.minimum;
        search.max_bounds = options_.max_bounds;
        search.should_stop = options_.should_stop;
        const RangeSearchResult found = search_ranges(pair, search);
        out.lower = found.lower;
        out.upper = found.upper;
        out.complete = found.complete;
        out.intersecting = found.intersecting;
        out.bounds = found.bounds;
        if (found.nearest.element_a >= 0) take_nearest(pair, found, out);
        if (certificate_ != nullptr) record(pair, found, search, out, certificate_->pairs[index]);
        decide_solids(out);
        if (certificate_ != nullptr) certificate_->pairs[index].solids = out.is_clash() ? Solids::unproven : out.solids;
        judge(out, {out.a, out.b, out.minimum}, 0, false);
    }

    void record(const ScrewedPair& pair, const RangeSearchResult& found, const RangeSearchOptions& search, PairClearance& out,
                certificate::PairCertificate& record) const {
        record.a = out.a;
        record.b = out.b;
        record.at = out.at;
        if (found.nearest.element_a < 0) return;
        double room = room_of(pair, std::min(out.tolerance, std::max(0.0, found.upper - found.lower)));
        const double above = found.lower - (out.minimum < found.lower ? out.minimum : 0);  // a claim keeps what was decided, if it can
        room = std::max(8 * pair.slack, std::min(room, 0.5 * above));
        out.lower = found.lower > room ? found.lower - room : 0;
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

    // Surfaces that never meet leave one thing to ask, whose answer is the same everywhere in the box.
    void decide_solids(PairClearance& out) const {
        if (out.intersecting || !(out.lower > 0)) return;
        out.solids = certificate::solids_of(*shapes_[out.a].solid, *shapes_[out.b].solid, {start_, -1, 0, out.a, out.b}, out.lower);
        if (out.solids != Solids::overlap) return;
        out.lower = out.upper = 0;
    }

    const model::Model& model_;
    const JointRanges& ranges_;
    const std::vector<PairRequest>& pairs_;
    const ClearanceOptions& options_;
    certificate::Certificate* certificate_;  // null: none is wanted
    const stepper::Trajectory start_;
    const std::vector<char> usable_;  // [body]
    const std::vector<BodyShape> shapes_;
};

}  // namespace

std::vector<PairClearance> certify_ranges(const model::Model& model, const JointRanges& ranges, const std::vector<PairRequest>& pairs,
                                          const ClearanceOptions& options) {
    return RangeCertification(model, ranges, pairs, options, nullptr).run();
}

ProvenClearances certify_ranges_with_proof(const model::Model& model, const JointRanges& ranges, const std::vector<PairRequest>& pairs,
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
        RangeSearchOptions search;
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
