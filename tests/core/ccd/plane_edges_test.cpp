// SPDX-License-Identifier: MIT
// Edges within plane faces have nothing to say that other pairs do not say too: against the distances of all pairs.
#include "core/ccd/plane_edges.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>

#include "core/ccd/safe_step.hpp"
#include "core/geometry/distance.hpp"
#include "tests/support/test_models.hpp"

namespace fettle::core::ccd::plane_edges_test {

using namespace fettle::tests::support;
using kinematics::PathSegment;
using kinematics::Pose;

namespace {

// A plate with a wall along its middle: cells of two triangles, cut either way, places of inner vertices at random.
geometry::Mesh folded_plate(std::mt19937& random, int n, double wall) {
    std::uniform_real_distribution<double> u(-0.3, 0.3);
    Matrix3X x(3, (n + 1) * (n + 1));
    for (int i = 0; i <= n; ++i)
        for (int j = 0; j <= n; ++j) {
            const bool inner = i > 0 && i < n && j > 0 && j < n && 2 * i != n;
            x.col(i * (n + 1) + j) =
                Vector3(i + (inner ? u(random) : 0), j + (inner ? u(random) : 0), 2 * i > n ? wall * (i - 0.5 * n) : 0.0) / n;
        }
    std::vector<geometry::Triangle> triangles;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            const int a = i * (n + 1) + j, b = a + n + 1;
            if (random() % 2 == 0) {
                triangles.push_back({a, b, b + 1});
                triangles.push_back({a, b + 1, a + 1});
            } else {
                triangles.push_back({a, b, a + 1});
                triangles.push_back({b, b + 1, a + 1});
            }
        }
    return geometry::make_mesh("plate", x, triangles);
}

struct Distances {
    double all = std::numeric_limits<double>::infinity(), without = all;
};

// The distances of all pairs of primitives, and without those of plane edges.
Distances distances(const model::Model& model, const std::vector<Pose>& poses) {
    const model::Body &a = model.bodies[0], &b = model.bodies[1];
    const auto at = [&](int body, int v) { return world_position(poses[body], model.bodies[body].mesh.vertices.col(v)); };
    Distances out;
    const auto take = [&](double squared, bool is_plane) {
        out.all = std::min(out.all, std::sqrt(squared));
        if (!is_plane) out.without = std::min(out.without, std::sqrt(squared));
    };
    for (int body = 0; body < 2; ++body)
        for (const geometry::Triangle& t : model.bodies[1 - body].mesh.triangles)
            for (int v = 0; v < model.bodies[body].mesh.vertices.cols(); ++v)
                take(geometry::point_triangle_distance_squared(at(body, v), at(1 - body, t[0]), at(1 - body, t[1]), at(1 - body, t[2])),
                     false);
    for (int i = 0; i < count_of(a.mesh.edges); ++i)
        for (int j = 0; j < count_of(b.mesh.edges); ++j)
            take(geometry::edge_edge_distance_squared(at(0, a.mesh.edges[i][0]), at(0, a.mesh.edges[i][1]), at(1, b.mesh.edges[j][0]),
                                                      at(1, b.mesh.edges[j][1])),
                 a.flat->is_plane_edge(i) || b.flat->is_plane_edge(j));
    return out;
}

// The same meshes without anything flat.
model::Model with_all_edges(model::Model model) {
    for (model::Body& body : model.bodies) body.flat = nullptr;
    return model;
}

// b above a's plate, its lowest vertex so far above it, and turned; where a has a wall, b stands before it.
model::Model plates(std::mt19937& random, double gap, double tilt, std::vector<Pose>& poses) {
    std::uniform_real_distribution<double> u(-1, 1);
    model::Model model;
    model.dhat = 0.2;
    model.bodies = {make_body("a", folded_plate(random, 4, -0.3), {}), make_body("b", folded_plate(random, 4, -0.2), {})};
    poses = {Pose{}, make_pose(Vector3(std::acos(-1.0) + tilt * u(random), tilt * u(random), 3 * u(random)),
                               Vector3(0.5 + 0.3 * u(random), 0.5 + 0.3 * u(random), 0))};
    double lowest = std::numeric_limits<double>::infinity();
    for (int v = 0; v < model.bodies[1].mesh.vertices.cols(); ++v)
        lowest = std::min(lowest, world_position(poses[1], model.bodies[1].mesh.vertices.col(v)).z());
    poses[1].position.z() += gap - lowest;
    return model;
}

}  // namespace

TEST_CASE("no pair of a plane edge is nearer than all other pairs", "[plane_edges]") {
    std::mt19937 random(1);
    for (int trial = 0; trial < 150; ++trial) {
        std::vector<Pose> poses;
        const model::Model model = plates(random, trial % 2 == 0 ? 0.05 : 1e-5, trial % 3 == 0 ? 0 : 0.3, poses);
        REQUIRE(plane_features_of(model, model.bodies[0]) != nullptr);
        REQUIRE(std::count(model.bodies[0].flat->plane_edge.begin(), model.bodies[0].flat->plane_edge.end(), 1) > 10);
        const Distances d = distances(model, poses);
        CHECK(d.all >= d.without - lost_by_plane_edges(model, model.bodies[0], model.bodies[1]) - 1e-14);
    }
}

TEST_CASE("candidates without plane edges hold all other pairs, and steps are as long", "[plane_edges]") {
    std::mt19937 random(2);
    std::uniform_real_distribution<double> u(-1, 1);
    int stopped = 0;
    for (int trial = 0; trial < 60; ++trial) {
        std::vector<Pose> poses;
        const model::Model model = plates(random, 0.05, trial % 3 == 0 ? 0 : 0.2, poses), all = with_all_edges(model);
        const std::vector<PathSegment> segments{{poses[0].rotation, Vector3::Zero(), Vector3::Zero(), poses[0].position, Vector3::Zero()},
                                                {poses[1].rotation, Vector3::Zero(), 0.2 * Vector3(u(random), u(random), u(random)),
                                                 poses[1].position, Vector3(0.1, 0.1, -0.2 * (1 + u(random)))}};
        Candidates few, many;
        cover(model, segments, model.dhat, few);
        cover(all, segments, all.dhat, many);
        REQUIRE(few.pairs.size() == many.pairs.size());
        for (std::size_t k = 0; k < few.pairs.size(); ++k) {
            CHECK(few.pairs[k].vertex_triangle.size() == many.pairs[k].vertex_triangle.size());
            CHECK(few.pairs[k].triangle_vertex.size() == many.pairs[k].triangle_vertex.size());
            const auto is_plane = [&](const geometry::PrimitivePair& p) {
                return model.bodies[0].flat->is_plane_edge(p.a) || model.bodies[1].flat->is_plane_edge(p.b);
            };
            CHECK(std::none_of(few.pairs[k].edge_edge.begin(), few.pairs[k].edge_edge.end(), is_plane));
            CHECK(few.pairs[k].edge_edge.size() + std::count_if(many.pairs[k].edge_edge.begin(), many.pairs[k].edge_edge.end(), is_plane) ==
                  many.pairs[k].edge_edge.size());
        }
        const double fraction = longest_safe_step(model, few, segments).fraction, of_all = longest_safe_step(all, many, segments).fraction;
        CHECK(fraction >= of_all);
        CHECK(fraction <= of_all + 0.02);
        stopped += of_all < 1;
        for (int k = 0; k <= 20; ++k) CHECK(distances(model, {pose_at(segments[0], 0), pose_at(segments[1], fraction * k / 20)}).all > 0);
    }
    CHECK(stopped > 20);
}

TEST_CASE("a gap within what plane edges may be off stops every step", "[plane_edges]") {
    model::Model model;
    model.dhat = 0.1;
    model.bodies = {make_body("a", box_mesh(Vector3(0, 0, 0), Vector3(1, 1, 1)), {}),
                    make_body("b", box_mesh(Vector3(0, 0, 0), Vector3(1, 1, 1)), make_pose(Vector3::Zero(), Vector3(0.1, 0.2, 1 + 1e-9)))};
    std::vector<PathSegment> segments;
    for (const model::Body& body : model.bodies)
        segments.push_back({body.pose_start.rotation, Vector3::Zero(), Vector3::Zero(), body.pose_start.position, Vector3::Zero()});
    segments[1].position_step = Vector3(0.1, 0, 0);
    const auto fraction = [&] {
        Candidates candidates;
        cover(model, segments, model.dhat, candidates);
        return longest_safe_step(model, candidates, segments).fraction;
    };
    CHECK(fraction() > 0.5);
    for (model::Body& body : model.bodies) {
        auto flat = *body.flat;
        flat.plane_height = 1e-10;
        body.flat = std::make_shared<const geometry::FlatFeatures>(flat);
    }
    CHECK(fraction() == 0);
    for (model::Body& body : model.bodies) {
        auto flat = *body.flat;
        flat.plane_height = 1e-8;  // too much beside dhat: then they are looked at
        body.flat = std::make_shared<const geometry::FlatFeatures>(flat);
    }
    CHECK(fraction() > 0.5);
}

}  // namespace fettle::core::ccd::plane_edges_test
