// SPDX-License-Identifier: MIT
#include "core/clearance/relative_spans.hpp"

#include <catch2/catch.hpp>

#include "core/clearance/hull_direction.hpp"
#include "core/clearance/witness_instant.hpp"
#include "tests/core/clearance/clearance_oracle.hpp"

namespace fettle::core::clearance::relative_spans_test {

using namespace fettle::tests::clearance;

namespace {

struct Motion {
    std::vector<core::kinematics::PathSegment> a, b;
};

/// Steps of one path each in charts of their own, accelerating and turning; with `jumps` no segment begins where the last one ended.
Motion random_motion(std::mt19937& random, int steps, double size, double turn, bool jumps) {
    std::uniform_real_distribution<double> u(0, 1);
    Motion motion;
    for (auto* path : {&motion.a, &motion.b}) {
        Matrix3 rotation = core::kinematics::rotation(random_vector(random, 3 * u(random)));
        Vector3 position = random_vector(random, 3 * size), velocity = random_vector(random, 0.1 * size);
        const Vector3 rate = random_vector(random, turn * u(random));
        for (int t = 0; t < steps; ++t) {
            core::kinematics::PathSegment p;
            p.base = rotation;
            if (t % 3 == 1) p.rotation_vector_t0 = random_vector(random, turn);  // not at the origin of its chart
            p.rotation_vector_step = rate + random_vector(random, 0.3 * turn * u(random));
            p.position_t0 = position;
            velocity += random_vector(random, 0.03 * size * u(random));
            p.position_step = velocity;
            path->push_back(p);
            const auto end = core::kinematics::pose_at(p, 1);
            rotation = core::kinematics::orthonormalised(end.rotation);
            position = end.position;
            if (jumps) position += random_vector(random, 0.2 * size);
        }
    }
    return motion;
}

Corners random_triangle(std::mt19937& random, double size) {
    Corners corners;
    const Vector3 center = random_vector(random, 0.5 * size);
    for (int k = 0; k < 3; ++k) corners.x.col(k) = center + random_vector(random, 0.3 * size);
    return corners;
}

Piece piece_of(const Corners& corners) {
    Piece piece;
    const Vector3 low = corners.x.rowwise().minCoeff(), high = corners.x.rowwise().maxCoeff();
    piece.center = 0.5 * (low + high);
    piece.half_extent = (1 + 1e-12) * 0.5 * (high - low);
    piece.radius = std::sqrt(corners.x.colwise().squaredNorm().maxCoeff()) * (1 + 1e-15);
    piece.count = 1;
    return piece;
}

std::array<PieceElement, 1> one(const Corners& corners) {
    std::array<PieceElement, 1> elements;
    elements[0].corners = corners;
    return elements;
}

ElementPairDistance distance_at(const SpanGroup& group, int node, const Corners& a, const Corners& b) {
    const RelativePose pose = group.at(node);
    return placed_distance({0, pose.rotation, Matrix3::Identity(), pose.offset}, a, b);
}

std::vector<int> segments_of(const RelativeSpans& spans, const SpanGroup& group, int span) {
    if (group.level == 0) return {group.first + span};
    const SpanGroup& below = spans.group(group.first + span);
    std::vector<int> all;
    for (int j = 0; j < below.count; ++j)
        for (const int i : segments_of(spans, below, j)) all.push_back(i);
    return all;
}

/// In the directions in which the bodies' hulls are nearest.
NodePlanes hull_planes(const SpanGroup& group, HullDirection& hulls) {
    NodePlanes planes;
    for (int j = 0; j <= most_spans; ++j) {
        const HullDirection::Bound bound = hulls.at(group.at(j), 0);
        planes.n[j] = bound.n;
        planes.f[j] = bound.apart;
    }
    return planes;
}

struct Verdict {
    int spans = 0, wrong = 0, useful = 0, useful_planes = 0;
    std::vector<int> seen;
};

/// Two triangles over every span of every level, against samples in extended precision. @param with_rests  false: as if points stayed on
/// the chords of their segments.
Verdict judge(std::mt19937& random, int steps, double size, double turn, bool jumps, bool with_rests) {
    const Motion motion = random_motion(random, steps, size, turn, jumps);
    const Solid solid_a = make_solid(random_triangle(random, size).x, {{0, 1, 2}}),
                solid_b = make_solid(random_triangle(random, size).x, {{0, 1, 2}});
    const Corners a{solid_a.mesh.vertices, 3}, b{solid_b.mesh.vertices, 3};
    std::vector<PairSegment> segments;
    for (std::size_t i = 0; i < motion.a.size(); ++i)
        segments.push_back(pair_segment(motion.a[i], motion.b[i], solid_a.radius(), solid_b.radius()));
    std::vector<double> least;
    for (std::size_t i = 0; i < segments.size(); ++i)
        least.push_back(static_cast<double>(sampled_minimum({solid_a, solid_b, motion.a[i], motion.b[i]}, 12, 3)));
    const RelativeSpans spans(segments, {}, solid_a.radius(), solid_b.radius());
    const PieceTree tree_a = solid_a.search(), tree_b = solid_b.search();
    HullDirection hulls(tree_a, tree_b);
    Verdict verdict;
    verdict.seen.resize(segments.size());
    std::vector<int> pending{spans.root()};
    while (!pending.empty()) {
        SpanGroup group = spans.group(pending.back());
        pending.pop_back();
        if (!with_rests)
            for (Lanes* lengths : {&group.rest_turn, &group.rest_shift, &group.step_turn, &group.step_shift}) lengths->setZero();
        const int node = static_cast<int>(random() % static_cast<unsigned>(group.count + 1));
        const ElementPairDistance nearest = distance_at(group, node, a, b);
        const double rate = random() % 2 ? 1 / (nearest.distance + size) : 0;
        const TurningPlane n{node, unit_direction(nearest.difference), rate};
        const SpanBounds of_elements = spans.of_elements(group, n, piece_of(a), one(a), one(b)),
                         of_boxes = spans.of_boxes(group, n, piece_of(a), piece_of(b)),
                         of_planes = spans.of_planes(group, hull_planes(group, hulls));
        for (int j = 0; j < group.count; ++j) {
            double sampled = 1e300;
            for (const int i : segments_of(spans, group, j)) {
                sampled = std::min(sampled, least[i]);
                if (group.level == 0) ++verdict.seen[i];
            }
            ++verdict.spans;
            verdict.wrong += of_elements.spans[j] > sampled || of_boxes.spans[j] > sampled || of_planes.spans[j] > sampled;
            verdict.useful += of_elements.spans[j] > 0.8 * sampled;
            verdict.useful_planes += of_planes.spans[j] > 0.8 * sampled;
            CHECK(of_planes.nodes[j] == Approx(distance_at(group, j, a, b).distance).margin(1e-7 * size));
            CHECK(of_boxes.spans[j] <= of_elements.nodes[j] + 1e-9 * size);
            CHECK(of_elements.spans[j] <= std::min(of_elements.nodes[j], of_elements.nodes[j + 1]));
            if (group.level > 0) pending.push_back(group.first + j);
        }
    }
    return verdict;
}

}  // namespace

TEST_CASE("Bounds over many segments at once hold against samples in extended precision", "[clearance]") {
    std::mt19937 random(3);
    int spans = 0, useful = 0, useful_planes = 0;
    for (int trial = 0; trial < 60; ++trial) {
        const int steps = 1 + static_cast<int>(random() % 60);
        const double size = std::pow(10.0, -3 + trial % 4), turn = std::pow(10.0, -3 + trial % 3);
        const Verdict verdict = judge(random, steps, size, turn, trial % 5 == 0, true);
        CAPTURE(trial, steps, size, turn);
        CHECK(verdict.wrong == 0);
        CHECK(std::all_of(verdict.seen.begin(), verdict.seen.end(), [](int times) { return times == 1; }));
        spans += verdict.spans;
        useful += verdict.useful;
        useful_planes += verdict.useful_planes;
    }
    CHECK(useful > spans / 4);
    CHECK(useful_planes > spans / 3);
}

TEST_CASE("Elements together have the least of the bounds that they have pair by pair", "[clearance]") {
    std::mt19937 random(8);
    const Motion motion = random_motion(random, 12, 1, 0.1, false);
    const Solid solid_a = prism(5, 0.4, 0.2), solid_b = tetrahedron(random, 0.5);
    std::vector<PairSegment> segments;
    for (std::size_t i = 0; i < motion.a.size(); ++i)
        segments.push_back(pair_segment(motion.a[i], motion.b[i], solid_a.radius(), solid_b.radius()));
    const RelativeSpans spans(segments, {}, solid_a.radius(), solid_b.radius());
    const SpanGroup& group = spans.group(spans.root());
    const PieceTree a = solid_a.search(), b = solid_b.search();
    for (const double rate : {0.0, 0.3}) {
        const TurningPlane n{4, unit_direction(group.at(4).offset), rate};
        const SpanBounds together = spans.of_elements(group, n, a.pieces[0], a.elements_of(a.pieces[0]), b.elements_of(b.pieces[0]));
        SpanBounds pairs{Lanes::Constant(1e300), Lanes::Constant(1e300)};
        for (const PieceElement& of_a : a.elements)
            for (const PieceElement& of_b : b.elements) {
                const SpanBounds pair = spans.of_elements(group, n, a.pieces[0], one(of_a.corners), one(of_b.corners));
                pairs = {pairs.spans.min(pair.spans), pairs.nodes.min(pair.nodes)};
            }
        for (int j = 0; j <= group.count; ++j) CHECK(together.nodes[j] == pairs.nodes[j]);
        for (int j = 0; j < group.count; ++j) CHECK(together.spans[j] <= pairs.spans[j]);
    }
}

TEST_CASE("A path that jumps between its segments is bounded all the same", "[clearance]") {
    // A bar swings down and begins anew: at every node it points straight ahead, but for the end.
    constexpr double swing = 0.3;
    Corners bar, below;
    bar.x << 1, 0.9, 0.9, 0, 0.01, -0.01, 0, 0, 0;
    below.x << 1, 0.9, 0.9, -2, -2, -2, -0.1, 0.1, 0;
    core::kinematics::PathSegment swinging, still;
    swinging.rotation_vector_step = Vector3(0, 0, -swing);
    const std::vector<PairSegment> segments(4, pair_segment(swinging, still, 1, 3));
    const RelativeSpans spans(segments, {}, 1, 3);
    const SpanGroup& group = spans.group(spans.root());
    REQUIRE(group.count == 4);
    for (const int node : {0, 2}) {
        const TurningPlane n{node, Vector3(0, 1 - 1e-12, 0), 0};
        const SpanBounds of_elements = spans.of_elements(group, n, piece_of(bar), one(bar), one(below));
        const SpanBounds of_boxes = spans.of_boxes(group, n, piece_of(bar), piece_of(below));
        for (int j = 0; j < group.count; ++j) {
            CHECK(of_elements.spans[j] <= 2 - std::sin(swing));
            CHECK(of_boxes.spans[j] <= 2 - std::sin(swing));
            CHECK(of_elements.spans[j] > 1);
        }
    }
}

TEST_CASE("An arc bulges beyond its chord, whichever body turns") {
    // In the frame of b a bar's end goes round an arc; across its middle, outside, something is `gap` away from it.
    constexpr double arm = 2, swing = 0.2, gap = 0.01;
    const auto corners_at = [](double radius, double angle) {
        Corners corners;
        const Vector3 at = radius * Vector3(std::cos(angle), std::sin(angle), 0);
        corners.x << at, at, at;
        return corners;
    };
    core::kinematics::PathSegment turning, still;
    for (const bool a_turns : {true, false}) {
        // a's own turn about b's origin; or b's the other way, a held beside it.
        turning.rotation_vector_step = Vector3(0, 0, a_turns ? swing : -swing);
        still.position_t0 = a_turns ? Vector3::Zero() : Vector3(arm, 0, 0);
        const Corners end = a_turns ? corners_at(arm, 0) : corners_at(0, 0), outside = corners_at(arm + gap, swing / 2);
        const double radius_a = a_turns ? arm : 1e-9, radius_b = arm + gap;
        const PairSegment segment =
            a_turns ? pair_segment(turning, still, radius_a, radius_b) : pair_segment(still, turning, radius_a, radius_b);
        const RelativeSpans spans({segment}, {}, radius_a, radius_b);
        const TurningPlane n{0, unit_direction(-outside.x.col(0)), 0};
        const double bound = spans.of_elements(spans.group(0), n, piece_of(end), one(end), one(outside)).spans[0];
        CAPTURE(a_turns, bound);
        CHECK(bound <= gap);
        CHECK(bound > 0.9 * gap);
    }
}

TEST_CASE("What goes by is nearest between its nodes, whatever the planes there tell") {
    // A point goes by another one at distance 1, one segment from -half to half; the planes at both ends are those of the points there.
    Corners point, other;
    point.x.setZero();
    other.x.setZero();
    const Piece piece = piece_of(point);
    for (const double half : {0.1, 0.5, 1.0, 2.0}) {
        core::kinematics::PathSegment passing, still;
        passing.position_t0 = Vector3(-half, 1, 0);
        passing.position_step = Vector3(2 * half, 0, 0);
        const RelativeSpans spans({pair_segment(passing, still, 1e-9, 1e-9)}, {}, 1e-9, 1e-9);
        const double norm = std::sqrt(1 + half * half);
        const TurningPlane n{0, unit_direction(passing.position_t0), 1 / norm};
        const SpanBounds bounds = spans.of_elements(spans.group(0), n, piece, one(point), one(other));
        CAPTURE(half, bounds.nodes[0], bounds.nodes[1], bounds.spans[0]);
        CHECK(bounds.nodes[0] == Approx(norm));
        CHECK(bounds.nodes[1] == Approx(norm));
        CHECK(bounds.spans[0] <= 1);
        CHECK(bounds.spans[0] > 1 - half * half);
    }
}

TEST_CASE("Bounds over many segments without their rests are found out", "[clearance]") {
    std::mt19937 random(4);
    int wrong = 0, spans = 0;
    for (int trial = 0; trial < 30; ++trial) {
        const Verdict verdict = judge(random, 40, 1, 0.3, false, false);
        wrong += verdict.wrong;
        spans += verdict.spans;
    }
    CHECK(wrong > spans / 50);
}

TEST_CASE("Bodies that move together are at rest for each other", "[clearance]") {
    std::mt19937 random(5);
    Motion motion = random_motion(random, 100, 1, 0.1, false);
    motion.b = motion.a;
    std::vector<PairSegment> segments;
    for (std::size_t i = 0; i < motion.a.size(); ++i) segments.push_back(pair_segment(motion.a[i], motion.b[i], 5, 5));
    const RelativeSpans spans(segments, {}, 5, 5);
    Corners a = random_triangle(random, 1), b = random_triangle(random, 1);
    a.x.row(2).array() += 3;
    const SpanGroup& all = spans.group(spans.root());
    const ElementPairDistance nearest = distance_at(all, 0, a, b);
    const TurningPlane n{0, unit_direction(nearest.difference), 0};
    const SpanBounds bounds = spans.of_elements(all, n, piece_of(a), one(a), one(b));
    // What is left are the segments' own terms of third order and of rounding; nothing grows with the number of segments.
    for (int j = 0; j < all.count; ++j) CHECK(bounds.spans[j] > nearest.distance - 0.01);
    CHECK(bounds.nodes[0] > nearest.distance - 1e-10);
}

}  // namespace fettle::core::clearance::relative_spans_test
