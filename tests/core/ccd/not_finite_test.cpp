// SPDX-License-Identifier: MIT
// What is not a number, or infinite, never means "far enough": each query of the folder, and the contacts found there, answer "hit",
// "kept", "near" or "not finite".
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "core/ccd/curved_ccd.hpp"
#include "core/ccd/swept_pair.hpp"
#include "core/contact/contact_set.hpp"
#include "tests/support/inclusion_ccd.hpp"
#include "tests/support/test_models.hpp"

namespace fettle::core::ccd::not_finite_test {

using namespace fettle::tests::support;
using kinematics::PathSegment;
using kinematics::Pose;

namespace {

const double not_finite[] = {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
                             -std::numeric_limits<double>::infinity()};

// A vertex 1 m over a face; edges 1 m apart.
const geometry::PairVertices apart{Vector3(0.2, 0.3, 1), Vector3(0, 0, 0), Vector3(1, 0, 0), Vector3(0, 1, 0)};

/// Calls visit(vertices) with one coordinate replaced by each such value.
template <class Visit>
void for_each_damage(const Visit& visit) {
    for (const double bad : not_finite)
        for (std::size_t i = 0; i < 4; ++i)
            for (int k = 0; k < 3; ++k) {
                geometry::PairVertices x = apart;
                x[i][k] = bad;
                visit(x);
            }
}

/// Two boxes of edge 1 m whose centres are 10 m apart.
model::Model two_boxes() {
    model::Model model;
    model.dhat = 1e-3;
    for (int i = 0; i < 2; ++i)
        model.bodies.push_back(make_body("box", box_mesh({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}), make_pose({0, 0, 0}, {10.0 * i, 0, 0})));
    return model;
}

std::vector<PathSegment> segments_of(const model::Model& model) {
    std::vector<PathSegment> segments;
    for (const model::Body& body : model.bodies)
        segments.push_back({body.pose_start.rotation, Vector3::Zero(), Vector3(0.1, 0, 0), body.pose_start.position, Vector3(0, 0.1, 0)});
    return segments;
}

/// Every number of a segment in turn.
double& entry(PathSegment& s, int k) {
    if (k < 9) return s.base(k / 3, k % 3);
    Vector3* const vectors[] = {&s.rotation_vector_t0, &s.rotation_vector_step, &s.position_t0, &s.position_step};
    return (*vectors[(k - 9) / 3])[k % 3];
}
constexpr int entries = 21;

// Vertices against triangles either way, and edges: of two boxes.
constexpr int vertex_triangle_pairs = 8 * 12, edge_pairs = 12 * 12;  // without the diagonals of the faces (plane_edges.hpp)
constexpr int border_pairs = 12 * 12;                                // edges that are no diagonals of faces

}  // namespace

TEST_CASE("collision queries hit at once where a vertex is not finite") {
    for_each_damage([](const geometry::PairVertices& bad) {
        for (const geometry::PairType type : {geometry::PairType::point_triangle, geometry::PairType::edge_edge}) {
            CHECK(distance_lower_bound(type, bad) == 0);
            for (const auto& [t0, t1] : {std::pair(bad, apart), std::pair(apart, bad), std::pair(bad, bad)}) {
                const LinearCcdResult advanced = linear_ccd(type, t0, t1, 0), included = tests::support::inclusion_ccd(type, t0, t1, 0);
                CHECK((advanced.hit && advanced.toi == 0));
                CHECK((included.hit && included.toi == 0));
            }
            CHECK(curved_ccd(type, {}, {}, bad, 0).toi == 0);
        }
    });
}

TEST_CASE("curved queries hit at once where a path is not finite") {
    for (const double bad : not_finite)
        for (int k = 0; k < entries; ++k)
            for (const DeviationBound bound : {DeviationBound::closed_form, DeviationBound::interval}) {
                PathSegment path{Matrix3::Identity(), Vector3::Zero(), Vector3(0.1, 0, 0), Vector3::Zero(), Vector3(0, 0, -0.1)};
                entry(path, k) = bad;
                CurvedCcdOptions options;
                options.deviation = bound;
                INFO("value " << bad << " at " << k);
                const CurvedCcdResult first = curved_ccd(geometry::PairType::point_triangle, path, {}, apart, 0, options);
                const CurvedCcdResult second = curved_ccd(geometry::PairType::edge_edge, {}, path, apart, 0, options);
                CHECK((first.hit && first.toi == 0));
                CHECK((second.hit && second.toi == 0));
            }
}

TEST_CASE("a body whose path is not finite is near everything") {
    const model::Model model = two_boxes();
    for (const double bad : not_finite)
        for (int body = 0; body < 2; ++body)
            for (int k = 0; k < entries; ++k) {
                std::vector<PathSegment> segments = segments_of(model);
                Candidates candidates;
                cover(model, segments, model.dhat, candidates);
                REQUIRE(candidates.pairs.empty());
                entry(segments[body], k) = bad;
                cover(model, segments, model.dhat, candidates);
                INFO("value " << bad << " at " << k);
                REQUIRE(candidates.pairs.size() == 1);
                const BodyPairCandidates& pair = candidates.pairs[0];
                CHECK(count_of(pair.vertex_triangle) == vertex_triangle_pairs);
                CHECK(count_of(pair.triangle_vertex) == vertex_triangle_pairs);
                CHECK(count_of(pair.edge_edge) == edge_pairs);
                for (const geometry::PrimitivePair& p : pair.edge_edge) CHECK(p.distance <= 0);
            }
}

TEST_CASE("motion that is not finite is not covered by what was found before") {
    const model::Model model = two_boxes();
    std::vector<PathSegment> near = segments_of(model);
    near[1].position_t0 = Vector3(1.0005, 0, 0);
    Candidates candidates;
    cover(model, near, model.dhat, candidates);
    REQUIRE(candidates.pairs.size() == 1);
    settle({pose_at(near[0], 1), pose_at(near[1], 1)}, candidates);
    for (const double bad : not_finite)
        for (int k = 0; k < entries; ++k) {
            std::vector<PathSegment> segments = near;
            entry(segments[1], k) = bad;
            INFO("value " << bad << " at " << k);
            CHECK(!(motion_over(model, candidates.pairs[0], segments) <= 1e300));
            const Pose pose = pose_at(segments[1], 1);
            CHECK(!(motion_since(model, candidates.pairs[0], {pose_at(near[0], 1), pose}) <= 1e300));
        }
}

TEST_CASE("contacts of a pose that is not finite stay contacts, of infinite potential") {
    const model::Model model = two_boxes();
    for (const double bad : not_finite)
        for (int k = 0; k < 12; ++k) {
            std::vector<Pose> poses{model.bodies[0].pose_start, model.bodies[1].pose_start};
            (k < 9 ? poses[1].rotation(k / 3, k % 3) : poses[1].position[k - 9]) = bad;
            const Candidates candidates = find_candidates(model, poses, model.dhat);
            const contact::ContactSet set = contact::find_contacts(model, candidates, poses);
            INFO("value " << bad << " at " << k);
            CHECK(set.count == 2 * vertex_triangle_pairs + border_pairs);
            CHECK(!(set.minimum_distance > 0 && set.minimum_distance < std::numeric_limits<double>::max()));
            CHECK(contact::barrier_potential(set, contact::barrier_parameters(model.dhat, 0, 1, 1)) ==
                  std::numeric_limits<double>::infinity());
        }
}

}  // namespace fettle::core::ccd::not_finite_test
