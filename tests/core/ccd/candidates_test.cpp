// SPDX-License-Identifier: MIT
// The broad phase against all pairs of primitives: nothing that comes within the activation distance is missing, and stored distances are
// bounds.
#include "core/ccd/candidates.hpp"

#include <catch2/catch.hpp>
#include <map>
#include <random>
#include <set>
#include <tuple>

#include "core/contact/contact_set.hpp"
#include "core/geometry/body_hierarchy.hpp"
#include "core/geometry/predicates.hpp"
#include "tests/support/test_models.hpp"

namespace fettle::core::ccd::candidates_test {

using fettle::tests::support::box_mesh;
using fettle::tests::support::make_body;

namespace {

using Key = std::tuple<int, int, int>;  // kind, primitive of a, primitive of b

geometry::Mesh random_blob(std::mt19937& random, int vertices, double size) {
    std::uniform_real_distribution<double> u(-1, 1);
    std::uniform_int_distribution<int> index(0, vertices - 1);
    Matrix3X x(3, vertices);
    for (int i = 0; i < vertices; ++i) x.col(i) = size * Vector3(u(random), u(random), u(random));
    std::vector<geometry::Triangle> triangles;
    for (int i = 0; i + 2 < vertices; ++i) triangles.push_back({i, i + 1, i + 2});
    return geometry::make_mesh("blob", x, triangles);
}

model::Model two_bodies(std::mt19937& random, double dhat) {
    model::Model model;
    model.dhat = dhat;
    for (const char* name : {"a", "b"}) {
        model::Body body;
        body.name = name;
        body.mesh = random_blob(random, 14, 0.3);
        for (int i = 0; i < body.mesh.vertices.cols(); ++i) body.radius = std::max(body.radius, body.mesh.vertices.col(i).norm());
        body.hierarchy = std::make_shared<geometry::BodyHierarchy>(body.mesh);
        model.bodies.push_back(body);
    }
    return model;
}

// Distance of every pair of primitives at two poses.
std::map<Key, double> all_distances(const model::Model& m, const std::vector<kinematics::Pose>& poses) {
    std::map<Key, double> out;
    const auto &a = m.bodies[0].mesh, &b = m.bodies[1].mesh;
    const auto at_a = [&](int v) { return world_position(poses[0], a.vertices.col(v)); };
    const auto at_b = [&](int v) { return world_position(poses[1], b.vertices.col(v)); };
    for (int t = 0; t < count_of(b.triangles); ++t)
        for (int v = 0; v < a.vertices.cols(); ++v)
            out[{0, v, t}] = std::sqrt(geometry::point_triangle_distance_squared(at_a(v), at_b(b.triangles[t][0]), at_b(b.triangles[t][1]),
                                                                                 at_b(b.triangles[t][2])));
    for (int t = 0; t < count_of(a.triangles); ++t)
        for (int v = 0; v < b.vertices.cols(); ++v)
            out[{1, t, v}] = std::sqrt(geometry::point_triangle_distance_squared(at_b(v), at_a(a.triangles[t][0]), at_a(a.triangles[t][1]),
                                                                                 at_a(a.triangles[t][2])));
    for (int i = 0; i < count_of(a.edges); ++i)
        for (int j = 0; j < count_of(b.edges); ++j)
            out[{2, i, j}] = std::sqrt(
                geometry::edge_edge_distance_squared(at_a(a.edges[i][0]), at_a(a.edges[i][1]), at_b(b.edges[j][0]), at_b(b.edges[j][1])));
    return out;
}

std::map<Key, double> listed(const Candidates& candidates) {
    std::map<Key, double> out;
    for (const BodyPairCandidates& pair : candidates.pairs) {
        const std::vector<geometry::PrimitivePair>* lists[] = {&pair.vertex_triangle, &pair.triangle_vertex, &pair.edge_edge};
        for (int kind = 0; kind < 3; ++kind)
            for (const geometry::PrimitivePair& p : *lists[kind]) {
                CHECK(out.count({kind, p.a, p.b}) == 0);
                out[{kind, p.a, p.b}] = p.distance;
            }
    }
    return out;
}

Candidates candidates_along(const model::Model& model, const std::vector<kinematics::PathSegment>& segments, double allowance) {
    Candidates candidates;
    cover(model, segments, allowance, candidates);
    return candidates;
}

std::vector<kinematics::Pose> poses_at(const std::vector<kinematics::PathSegment>& segments, double s) {
    std::vector<kinematics::Pose> poses;
    for (const kinematics::PathSegment& segment : segments) poses.push_back(pose_at(segment, s));
    return poses;
}

kinematics::PathSegment random_segment(std::mt19937& random, double apart, double travel, double turn) {
    std::normal_distribution<double> n;
    const auto v = [&] { return Vector3(n(random), n(random), n(random)); };
    return {kinematics::rotation(v()), 0.2 * v(), turn * v(), apart * v().normalized(), travel * v()};
}

}  // namespace

TEST_CASE("no pair that comes close along the segments is missing", "[candidates]") {
    std::mt19937 random(11);
    int close = 0, dropped = 0;
    for (int trial = 0; trial < 60; ++trial) {
        const model::Model model = two_bodies(random, 0.05);
        const double turn = trial % 3 == 0 ? 0 : 0.3 * (trial % 5);
        const std::vector<kinematics::PathSegment> segments{random_segment(random, 0.3, 0.2, turn), random_segment(random, 0.4, 0.2, turn)};
        const std::map<Key, double> found = listed(candidates_along(model, segments, 0.03));
        for (int k = 0; k <= 40; ++k) {
            const double s = k / 40.0;
            const auto distances = all_distances(model, {pose_at(segments[0], s), pose_at(segments[1], s)});
            for (const auto& [key, d] : distances) {
                const auto at = found.find(key);
                if (d <= model.dhat + 0.03) {
                    ++close;
                    REQUIRE(at != found.end());
                }
                if (at != found.end()) REQUIRE(at->second <= d);
                dropped += at == found.end();
            }
        }
    }
    CHECK(close > 1000);
    CHECK(dropped > 1000);  // the search does prune
}

namespace {

// A prism along z: long facets round it, plane ends whose triangles' inner edges are plane.
geometry::Mesh prism(int sides, double radius, double length) {
    Matrix3X x(3, 2 * sides);
    std::vector<geometry::Triangle> triangles;
    for (int k = 0; k < sides; ++k) {
        const double angle = 2 * 3.14159265358979323846 * k / sides;
        const int next = (k + 1) % sides;
        x.col(k) = Vector3(radius * std::cos(angle), radius * std::sin(angle), 0);
        x.col(sides + k) = x.col(k) + Vector3(0, 0, length);
        triangles.push_back({k, next, sides + next});
        triangles.push_back({k, sides + next, sides + k});
        if (k > 1) triangles.push_back({0, k, k - 1});
        if (k > 1) triangles.push_back({sides, sides + k - 1, sides + k});
    }
    return geometry::make_mesh("prism", x, triangles);
}

}  // namespace

TEST_CASE("no pair of two prisms that turn along one another is missing", "[candidates]") {
    std::mt19937 random(17);
    std::normal_distribution<double> n;
    const auto v = [&] { return Vector3(n(random), n(random), n(random)); };
    model::Model model;
    model.dhat = 0.02;
    model.bodies.push_back(make_body("a", prism(24, 0.2, 1), {}));
    model.bodies.push_back(make_body("b", prism(17, 0.3, 0.4), {}));
    int close = 0, dropped = 0, plane = 0;
    for (int trial = 0; trial < 24; ++trial) {
        // Side by side or end to end, at a place far away at times, both turning, alike at times; axes that are not quite orthonormal.
        const double turn = std::array{0.0, 0.02, 0.3, 1.0}[trial % 4], apart = 0.5 + 0.03 * n(random);
        const Vector3 away = trial % 3 == 0 ? Vector3(400 * v()) : Vector3(Vector3::Zero());
        const kinematics::PathSegment a{kinematics::rotation(v()), 0.1 * v(), turn * v(), away, 0.1 * turn * v()};
        kinematics::PathSegment b{a.base * kinematics::rotation(0.05 * v()), a.rotation_vector_t0, turn * v(), away, 0.1 * turn * v()};
        if (trial % 5 == 0) b.rotation_vector_step = a.rotation_vector_step;
        const Matrix3 turned = kinematics::rotation(a.rotation_vector_t0) * a.base;
        b.position_t0 += turned * (trial % 2 == 0 ? Vector3(apart, 0.1 * n(random), 0.3) : Vector3(0.1 * n(random), 0, 0.505 + apart));
        std::vector<kinematics::PathSegment> segments{a, b};
        if (trial % 2 == 0)
            for (kinematics::PathSegment& s : segments) s.base += 3e-7 * Matrix3::Random();
        const std::map<Key, double> found = listed(candidates_along(model, segments, 0.01));
        for (const double s : {0.0, 0.13, 0.5, 0.72, 1.0}) {
            for (const auto& [key, d] : all_distances(model, poses_at(segments, s))) {
                const auto at = found.find(key);
                if (at != found.end()) {
                    CHECK(at->second <= d);
                    continue;
                }
                ++dropped;
                const auto is_plane = [&](int body, int edge) { return model.bodies[body].flat->is_plane_edge(edge); };
                if (std::get<0>(key) == 2 && (is_plane(0, std::get<1>(key)) || is_plane(1, std::get<2>(key))))
                    ++plane;
                else
                    REQUIRE(d > model.dhat + 0.01);
            }
        }
        close += count_of(found);
    }
    CHECK(close > 3000);
    CHECK(dropped > 100000);
    CHECK(plane > 1000);
}

TEST_CASE("candidates at a configuration hold the true distances", "[candidates]") {
    std::mt19937 random(5);
    const model::Model model = two_bodies(random, 0.2);
    const std::vector<kinematics::Pose> poses{pose_at(random_segment(random, 0.3, 0, 0), 0), pose_at(random_segment(random, 0.3, 0, 0), 0)};
    const Candidates candidates = find_candidates(model, poses, 0);
    const auto found = listed(candidates);
    int expected = 0;
    for (const auto& [key, d] : all_distances(model, poses)) {
        if (d > model.dhat) continue;
        ++expected;
        REQUIRE(found.count(key) == 1);
        CHECK(found.at(key) == Approx(d).margin(1e-12));
    }
    CHECK(expected == count_of(found));
}

TEST_CASE("a pair of bodies is searched anew only when it leaves its allowance", "[candidates]") {
    std::mt19937 random(3);
    const model::Model model = two_bodies(random, 0.2);
    const double radius = model.bodies[0].radius;
    const std::vector<kinematics::PathSegment> here{random_segment(random, 0.2, 0, 0), random_segment(random, 0.2, 0, 0)};
    Candidates candidates;
    const auto is_kept = [&](const std::vector<kinematics::PathSegment>& segments) {
        cover(model, here, 0.1, candidates);
        settle(poses_at(here, 0), candidates);
        cover(model, segments, 0.1, candidates);
        REQUIRE(candidates.pairs.size() == 1);
        const bool kept = !candidates.pairs[0].fresh;
        candidates.pairs.clear();
        return kept;
    };
    const auto moved = [&](const Vector3& travel, const Vector3& turn) {
        std::vector<kinematics::PathSegment> segments = here;
        segments[0].position_step = travel;
        segments[0].rotation_vector_step = turn;
        return segments;
    };
    CHECK(is_kept(here));
    CHECK(is_kept(moved(Vector3(0.099, 0, 0), Vector3::Zero())));
    CHECK_FALSE(is_kept(moved(Vector3(0.101, 0, 0), Vector3::Zero())));
    CHECK(is_kept(moved(Vector3::Zero(), Vector3(0, 0.099 / radius, 0))));
    CHECK_FALSE(is_kept(moved(Vector3::Zero(), Vector3(0, 0.101 / radius, 0))));
    CHECK_FALSE(is_kept(moved(Vector3(0.06, 0, 0), Vector3(0, 0.06 / radius, 0))));
    // Both go together, along the way and from one search to the next.
    std::vector<kinematics::PathSegment> together = moved(Vector3(5, 0, 0), Vector3::Zero());
    together[1].position_step = together[0].position_step;
    CHECK(is_kept(together));
    std::vector<kinematics::PathSegment> carried = here;
    const Matrix3 turn = kinematics::rotation(Vector3(1, 2, 0.5));
    for (kinematics::PathSegment& s : carried) {
        s.base = turn * pose_at(s, 0).rotation;
        s.rotation_vector_t0.setZero();
        s.position_t0 = turn * s.position_t0 + Vector3(1, 0, 0);
    }
    CHECK(is_kept(carried));
    // The first reaches into the second's way where it had been searched already: from the same start to a little off the end.
    const std::vector<kinematics::PathSegment> far = moved(Vector3(1, 0, 0), Vector3(0, 0.5, 0));
    std::vector<kinematics::PathSegment> near_far = far;
    near_far[0].position_step += Vector3(0, 0.05, 0);
    cover(model, far, 0.1, candidates);
    settle(poses_at(far, 0.3), candidates);
    cover(model, near_far, 0.1, candidates);
    REQUIRE(candidates.pairs.size() == 1);
    CHECK_FALSE(candidates.pairs[0].fresh);
}

TEST_CASE("candidates that are kept miss nothing within their allowance", "[candidates]") {
    std::mt19937 random(23);
    int kept = 0, close = 0;
    for (int trial = 0; trial < 300; ++trial) {
        const model::Model model = two_bodies(random, 0.05);
        const double turn = trial % 3 == 0 ? 0 : 0.2 * (trial % 5);
        std::vector<kinematics::PathSegment> first{random_segment(random, 0.3, 0.2, turn), random_segment(random, 0.4, 0.2, turn)};
        Candidates candidates;
        cover(model, first, 0.04, candidates);
        // They went a part of the way; then on, or the same way again a little otherwise, or both were carried elsewhere.
        for (kinematics::PathSegment& s : first) s = sub_segment(s, 0, 0.6);
        settle(poses_at(first, 1), candidates);
        std::vector<kinematics::PathSegment> second = first;
        for (kinematics::PathSegment& s : second) {
            const kinematics::PathSegment change = random_segment(random, 0, 0.005, 0.01);
            if (trial % 4 == 0) s = sub_segment(s, 1, 1);
            if (trial % 4 == 1) s = sub_segment(s, 1, 1.5);
            s.position_step += change.position_step;
            s.rotation_vector_step += change.rotation_vector_step;
        }
        if (trial % 8 == 0) {
            const Matrix3 carried = kinematics::rotation(random_segment(random, 0, 0, 1).rotation_vector_step);
            for (kinematics::PathSegment& s : second) {
                s.base = carried * pose_at(s, 0).rotation;
                s.rotation_vector_step = carried * s.rotation_vector_step;
                s.rotation_vector_t0.setZero();
                s.position_t0 = carried * s.position_t0;
                s.position_step = carried * s.position_step;
            }
        }
        cover(model, second, 0.04, candidates);
        if (!candidates.pairs.empty() && candidates.pairs[0].fresh) continue;
        ++kept;
        const std::map<Key, double> found = listed(candidates);
        const double over = candidates.pairs.empty() ? 0 : motion_over(model, candidates.pairs[0], second);
        for (int k = 0; k <= 20; ++k) {
            const std::vector<kinematics::Pose> poses{pose_at(second[0], k / 20.0), pose_at(second[1], k / 20.0)};
            const double since = candidates.pairs.empty() ? 0 : motion_since(model, candidates.pairs[0], poses);
            for (const auto& [key, d] : all_distances(model, poses)) {
                const auto at = found.find(key);
                if (d <= model.dhat) {
                    ++close;
                    REQUIRE(at != found.end());
                }
                if (at == found.end()) continue;
                REQUIRE(at->second <= d + over);
                REQUIRE(at->second <= d + since);
            }
        }
    }
    CHECK(kept > 150);
    CHECK(close > 1000);
}

TEST_CASE("steady motion is searched every other step and misses nothing", "[candidates]") {
    std::mt19937 random(29);
    std::normal_distribution<double> n;
    const auto v = [&] { return Vector3(n(random), n(random), n(random)); };
    constexpr double allowance = 0.04;
    int steps = 0, searches = 0, close = 0;
    for (int trial = 0; trial < 20; ++trial) {
        const model::Model model = two_bodies(random, 0.05);
        std::array<Vector3, 2> turn, travel;
        std::vector<kinematics::PathSegment> segments{random_segment(random, 0.2, 0, 0), random_segment(random, 0.3, 0, 0)};
        for (std::size_t i = 0; i < 2; ++i) {
            turn[i] = 0.1 * v().normalized();
            travel[i] = 0.02 * v();
        }
        Candidates candidates;
        for (int step = 0; step < 12; ++step) {
            // Each step has a chart of its own. Near enough to what was expected, but for a jolt at times.
            const bool jolt = trial % 4 == 0 && step == 6;
            for (std::size_t i = 0; i < 2; ++i) {
                const kinematics::Pose pose = pose_at(segments[i], 1);
                if (jolt) travel[i] = 0.05 * v();
                segments[i] = {pose.rotation, Vector3::Zero(), turn[i] + 0.003 * v(), pose.position, travel[i] + 0.001 * v()};
            }
            cover(model, segments, allowance, candidates);
            ++steps;  // what is taken from an earlier search has not all of the allowance
            searches += !candidates.pairs.empty() && candidates.pairs[0].fresh && candidates.pairs[0].allowance == allowance;
            const std::map<Key, double> found = listed(candidates);
            const double over = candidates.pairs.empty() ? 0 : motion_over(model, candidates.pairs[0], segments);
            CHECK(over <= allowance);
            for (int k = 0; k <= 8; ++k) {
                const std::vector<kinematics::Pose> poses = poses_at(segments, k / 8.0);
                const double since = candidates.pairs.empty() ? 0 : motion_since(model, candidates.pairs[0], poses);
                for (const auto& [key, d] : all_distances(model, poses)) {
                    const auto at = found.find(key);
                    if (d <= model.dhat) {
                        ++close;
                        REQUIRE(at != found.end());
                    }
                    if (at == found.end()) continue;
                    REQUIRE(at->second <= d + over);
                    REQUIRE(at->second <= d + since);
                }
            }
            settle(poses_at(segments, 1), candidates);
        }
    }
    INFO(searches << " of " << steps << ", " << close << " close");
    CHECK(searches < 0.7 * steps);
    CHECK(searches > 0.3 * steps);
    CHECK(close > 1000);
}

namespace {

geometry::Mesh loose_mesh(const Matrix3X& vertices, const std::vector<geometry::Edge>& edges) {
    geometry::Mesh mesh;
    mesh.name = "loose";
    mesh.vertices = vertices;
    geometry::build_connectivity(mesh, edges);
    return mesh;
}

// A body's primitives as segments and triangles with repeated corners: what the distance of two bodies is the least of.
std::vector<geometry::Triangle> primitives(const geometry::Mesh& mesh) {
    std::vector<geometry::Triangle> out = mesh.triangles;
    for (const auto& e : mesh.edges) out.push_back({e[0], e[1], e[1]});
    for (int p : mesh.codimensional_points) out.push_back({p, p, p});
    return out;
}

double least_distance(const model::Body& a, const kinematics::Pose& pa, const model::Body& b, const kinematics::Pose& pb) {
    double least = std::numeric_limits<double>::infinity();
    const auto at = [](const model::Body& body, const kinematics::Pose& pose, int v) {
        return world_position(pose, body.mesh.vertices.col(v));
    };
    for (const auto& s : primitives(a.mesh))
        for (const auto& t : primitives(b.mesh)) {
            std::array<Vector3, 3> x, y;
            for (int k = 0; k < 3; ++k) {
                x[k] = at(a, pa, s[k]);
                y[k] = at(b, pb, t[k]);
            }
            for (int k = 0; k < 3; ++k) {
                least = std::min(least, geometry::point_triangle_distance_squared(x[k], y[0], y[1], y[2]));
                least = std::min(least, geometry::point_triangle_distance_squared(y[k], x[0], x[1], x[2]));
                for (int l = 0; l < 3; ++l)
                    least = std::min(least, geometry::edge_edge_distance_squared(x[k], x[(k + 1) % 3], y[l], y[(l + 1) % 3]));
            }
        }
    return std::sqrt(least);
}

// Does an edge of one go through a face of the other?
bool crosses(const model::Body& a, const kinematics::Pose& pa, const model::Body& b, const kinematics::Pose& pb) {
    const auto through = [](const model::Body& of, const kinematics::Pose& at, const model::Body& faces, const kinematics::Pose& there) {
        for (const geometry::Edge& e : of.mesh.edges)
            for (const geometry::Triangle& t : faces.mesh.triangles) {
                std::array<Vector3, 3> x;
                for (int k = 0; k < 3; ++k) x[k] = world_position(there, faces.mesh.vertices.col(t[k]));
                const Vector3 start = world_position(at, of.mesh.vertices.col(e[0])), end = world_position(at, of.mesh.vertices.col(e[1]));
                if (geometry::segment_intersects_triangle(start, end, x)) return true;
            }
        return false;
    };
    return through(a, pa, b, pb) || through(b, pb, a, pa);
}

}  // namespace

TEST_CASE("contacts of points, wires and solids have the bodies' least distance, each once", "[candidates]") {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> uniform(-0.5, 0.5);
    const auto vertices = [&](int n) {
        Matrix3X x(3, n);
        for (double& value : x.reshaped()) value = uniform(random);
        return x;
    };
    int close = 0;
    for (int trial = 0; trial < 200; ++trial) {
        model::Model model;
        model.dhat = 0.3;
        std::vector<kinematics::Pose> poses;
        const auto add = [&](geometry::Mesh mesh) {
            poses.push_back(pose_at(random_segment(random, 0.9, 0, 0), 0));
            model.bodies.push_back(make_body("b" + std::to_string(poses.size()), std::move(mesh), poses.back()));
        };
        add(loose_mesh(vertices(3), {}));
        add(loose_mesh(vertices(2), {}));
        add(loose_mesh(vertices(4), {{0, 1}, {1, 2}, {2, 3}}));
        add(loose_mesh(vertices(3), {{0, 1}}));  // a wire and a point
        add(box_mesh(Vector3::Constant(-0.2), Vector3::Constant(0.2)));
        const int n = count_of(poses);
        const Candidates candidates = find_candidates(model, poses, 0);
        const contact::ContactSet contacts = contact::find_contacts(model, candidates, poses);
        for (int a = 0; a < n; ++a)
            for (int b = a + 1; b < n; ++b) {
                double found = std::numeric_limits<double>::infinity();
                std::set<std::pair<geometry::PairType, std::array<int, 5>>> seen;
                for (const contact::BodyPairContacts& list : contacts.pairs) {
                    if (std::minmax(list.first, list.second) != std::minmax(a, b)) continue;
                    for (const contact::ContactPair& pair : list.contacts) {
                        found = std::min(found, std::sqrt(pair.closest.distance_squared));
                        REQUIRE(
                            seen.insert({pair.type, {list.first, pair.vertex[0], pair.vertex[1], pair.vertex[2], pair.vertex[3]}}).second);
                    }
                }
                if (crosses(model.bodies[a], poses[a], model.bodies[b], poses[b])) continue;
                const double expected = least_distance(model.bodies[a], poses[a], model.bodies[b], poses[b]);
                if (expected >= model.dhat) {
                    REQUIRE(found == std::numeric_limits<double>::infinity());
                    continue;
                }
                ++close;
                REQUIRE(found == Approx(expected).margin(1e-12));
            }
    }
    CHECK(close > 200);
}

TEST_CASE("two clouds of points meet in each pair of points once", "[candidates]") {
    model::Model model;
    model.dhat = 10;
    std::vector<kinematics::Pose> poses(2);
    poses[1].position = Vector3(0, 0, 3);
    Matrix3X x(3, 3);
    x << 0, 1, 2, 0, 0, 0, 0, 0, 0;
    for (const kinematics::Pose& pose : poses) model.bodies.push_back(make_body("cloud", loose_mesh(x, {}), pose));
    CHECK(contact::find_contacts(model, find_candidates(model, poses, 0), poses).count == 9);
}

TEST_CASE("many bodies are searched as few are", "[candidates]") {
    std::mt19937 random(2);
    std::uniform_real_distribution<double> uniform(-2, 2);
    model::Model model;
    model.dhat = 0.1;
    std::vector<kinematics::PathSegment> segments;
    for (int i = 0; i < 40; ++i) {
        kinematics::PathSegment s = random_segment(random, 0.1, 0.2, 0.3);
        s.position_t0 = Vector3(uniform(random), uniform(random), uniform(random));
        segments.push_back(s);
        model.bodies.push_back(make_body("box", box_mesh(Vector3::Constant(-0.2), Vector3::Constant(0.2)), pose_at(s, 0)));
    }
    const Candidates all = candidates_along(model, segments, 0);
    std::size_t pairs = 0;
    for (int a = 0; a < 40; ++a)
        for (int b = a + 1; b < 40; ++b) {
            model::Model two = model;
            two.bodies = {model.bodies[a], model.bodies[b]};
            const Candidates found = candidates_along(two, {segments[a], segments[b]}, 0);
            if (found.pairs.empty()) continue;
            REQUIRE(pairs < all.pairs.size());
            CHECK(all.pairs[pairs].a == a);
            CHECK(all.pairs[pairs].b == b);
            CHECK(all.pairs[pairs].edge_edge.size() == found.pairs[0].edge_edge.size());
            CHECK(all.pairs[pairs].vertex_triangle.size() == found.pairs[0].vertex_triangle.size());
            ++pairs;
        }
    CHECK(pairs == all.pairs.size());
    CHECK(pairs > 10);
}

}  // namespace fettle::core::ccd::candidates_test
