// SPDX-License-Identifier: MIT
#include "core/clearance/segment_proof.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <map>
#include <optional>

#include "core/base/parallel.hpp"
#include "core/certificate/interval_motion.hpp"
#include "core/clearance/hull_direction.hpp"
#include "core/clearance/piece_bound.hpp"
#include "core/clearance/witness_instant.hpp"

namespace fettle::core::clearance {
namespace {

using certificate::BoxProof;
using certificate::LeafPlane;

constexpr int most_halvings = 48;         // so that every parameter is a double exactly
constexpr long most_cells = 2'000'000;    // of a segment
constexpr char leaf = '.', unproven = 0;  // what becomes of a cell, besides a split

class SegmentProof {
public:
    SegmentProof(const PairMotion& pair, const PairSegment& segment, const certificate::CertifiedBody& a,
                 const certificate::CertifiedBody& b, const certificate::PathProver& prover, double distance)
        : tree_a_(pair.a), tree_b_(pair.b), segment_(segment), a_(a), b_(b), prover_(prover), distance_(distance) {
        const BodySegment &of_a = *segment.a, &of_b = *segment.b;
        is_still_ = of_a.speed == 0 && of_b.speed == 0 && of_a.path.position_step == of_b.path.position_step;
    }

    /// Empty: not found.
    BoxProof run(const std::function<bool()>& should_stop) {
        std::vector<Cell> pending{Cell{}};
        for (long looked = 1; !pending.empty(); ++looked) {
            if (looked > most_cells || (looked % 64 == 0 && should_stop && should_stop())) return {};
            Cell cell = pending.back();
            pending.pop_back();
            const char by = settle(cell);
            if (by == unproven) return {};
            if (by == leaf) continue;
            proof_.splits += by;
            const std::array<Cell, 2> parts = parts_of(cell, by);
            pending.push_back(parts[1]);
            pending.push_back(parts[0]);
        }
        return std::move(proof_);
    }

private:
    struct Cell {
        double start = 0, end = 1;
        int halvings = 0, a = 0, b = 0;   // pieces
        Vector3 guess = Vector3::Zero();  // from b to a, in b's frame; zero: none
        double middle() const { return 0.5 * (start + end); }
    };
    struct Placed {
        Instant instant;
        RelativePose pose;
    };
    // From b to a, in b's frame, and how far apart two pieces are along it; not apart: at most the distance that is to be proven.
    using Direction = HullDirection::Bound;

    const Placed& at(double s) {
        const auto known = placed_.find(s);
        if (known != placed_.end()) return known->second;
        if (placed_.size() > 4096) placed_.clear();
        const Instant instant = instant_at(segment_, s);
        const Matrix3 back = instant.rotation_b.transpose();
        return placed_.emplace(s, Placed{instant, {back * instant.rotation_a, back * instant.offset}}).first->second;
    }

    // '0', 'a' or 'b' to split it by, or `leaf`, which is then in the proof.
    char settle(Cell& cell) {
        const Piece &a = tree_a_.pieces[cell.a], &b = tree_b_.pieces[cell.b];
        const bool elements = a.is_element() && b.is_element();
        const Placed middle = at(cell.middle());
        if (!elements) {
            const Separation boxes = separation_of_boxes(middle.pose, a, b);
            if (boxes.apart > distance_ && prove(cell, both(middle, boxes.direction), false)) return leaf;
            if (cell.guess.isZero(0)) cell.guess = boxes.direction;
        }
        HullDirection hulls(tree_a_, tree_b_, cell.a, cell.b);
        const auto direction_at = [&](const Placed& place, const Vector3& guess) {
            return elements ? direction_of_elements(place.instant, a, b) : hulls.beyond(place.pose, guess, distance_);
        };
        const Direction found = direction_at(middle, cell.guess);
        if (!(found.apart > distance_)) return split_in_space(a, b);
        cell.guess = found.n;
        if (prove(cell, both(middle, found.n), elements)) return leaf;
        if (is_still_) return split_in_space(a, b);
        const Placed start = at(cell.start), end = at(cell.end);
        const Direction first = direction_at(start, found.n), last = direction_at(end, found.n);
        const bool apart = first.apart > distance_ && last.apart > distance_;
        if (apart && prove(cell, {start.instant.rotation_b * first.n, end.instant.rotation_b * last.n}, elements)) return leaf;
        const double way = ((end.pose.rotation - start.pose.rotation) * a.center + end.pose.offset - start.pose.offset).norm();
        const bool by_time = elements || way > 0.5 * (a.size + b.size);
        return by_time ? (cell.halvings < most_halvings ? '0' : unproven) : split_in_space(a, b);
    }

    static LeafPlane both(const Placed& place, const Vector3& direction) {
        const Vector3 n = place.instant.rotation_b * direction;
        return {n, n};
    }

    // From b to a, in b's frame.
    static Separation separation_of_boxes(const RelativePose& pose, const Piece& a, const Piece& b) {
        return box_separation(pose.rotation * a.center + pose.offset - b.center, pose.rotation * a.axes, a.half_extent, b.axes,
                              b.half_extent);
    }

    Direction direction_of_elements(const Instant& instant, const Piece& a, const Piece& b) const {
        const ElementPairDistance found = placed_distance(instant, tree_a_.elements[a.first].corners, tree_b_.elements[b.first].corners);
        if (found.intersecting) return {};
        return {instant.rotation_b.transpose() * unit_direction(found.difference), found.distance};
    }

    static char split_in_space(const Piece& a, const Piece& b) {
        if (a.is_element() && b.is_element()) return unproven;
        return b.is_element() || (!a.is_element() && a.size >= b.size) ? 'a' : 'b';
    }

    std::array<Cell, 2> parts_of(const Cell& cell, char by) const {
        std::array<Cell, 2> out{cell, cell};
        const Piece &a = tree_a_.pieces[cell.a], &b = tree_b_.pieces[cell.b];
        if (by == 'a') {
            out[0].a = a.left;
            out[1].a = a.right;
        } else if (by == 'b') {
            out[0].b = b.left;
            out[1].b = b.right;
        } else {
            out[0].end = out[1].start = cell.middle();
            ++out[0].halvings;
            ++out[1].halvings;
        }
        if (by != '0')  // the direction of the whole is that of one of the two at best
            for (Cell& part : out) part.guess.setZero();
        return out;
    }

    // Few decimals make a small file; of elements all of them are tried.
    bool prove(const Cell& cell, const LeafPlane& plane, bool elements) {
        const auto shorter = [](const Vector3& n) -> Vector3 { return (n * 1e4).array().round() / 1e4; };
        if (add_proven(cell, {shorter(plane.n0), shorter(plane.n1)})) return true;
        return elements && add_proven(cell, plane);
    }
    bool add_proven(const Cell& cell, const LeafPlane& plane) {
        const std::array<Vector3, 2> normals{plane.n0, plane.n1};
        const certificate::CoordinateBox part{{cell.start}, {cell.end}};
        if (prover_.prove(a_.parts()[cell.a].region, b_.parts()[cell.b].region, part, normals, distance_, 0) == 0) return false;
        certificate::add_leaf(proof_, plane);
        return true;
    }

    const PieceTree &tree_a_, &tree_b_;
    const PairSegment& segment_;
    const certificate::CertifiedBody &a_, &b_;
    certificate::PathProver prover_;
    double distance_;
    bool is_still_ = false;
    std::map<double, Placed> placed_;
    BoxProof proof_;
};

}  // namespace

std::vector<BoxProof> prove_path(const PairMotion& pair, const certificate::CertifiedBody& a, const certificate::CertifiedBody& b,
                                 const certificate::PairCertificate& of, double distance, const std::function<bool()>& should_stop) {
    std::vector<BoxProof> proofs(pair.segments.size());
    std::atomic<bool> failed = false;
    base::parallel_for(count_of(proofs), 1, [&](int i) {
        if (failed) return;
        const PairSegment& segment = pair.segments[i];
        const auto path = [&](int body) { return certificate::body_path(pair.trajectory, segment.step, segment.segment, body); };
        proofs[i] = SegmentProof(pair, segment, a, b, {path(of.a), path(of.b)}, distance).run(should_stop);
        if (proofs[i].splits.empty()) failed = true;
    });
    if (failed) proofs.clear();
    return proofs;
}

}  // namespace fettle::core::clearance
