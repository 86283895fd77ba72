// SPDX-License-Identifier: MIT
// Sound meshes, damaged in the ways in which real files are, mended, judged and weighed.
#include "core/solids/mesh_judgement.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "core/geometry/mass_moments.hpp"
#include "core/solids/mesh_repair.hpp"
#include "core/solids/mesh_validity.hpp"
#include "core/solids/overlap_bound.hpp"
#include "tests/core/geometry/sample_meshes.hpp"

namespace fettle::core::solids::mesh_judgement_test {

namespace {

double volume(const geometry::Mesh& mesh) { return geometry::capped_solid_moments(mesh.vertices, mesh.triangles)(3, 3); }

bool mentions(const std::vector<std::string>& texts, const std::string& part) {
    return std::any_of(texts.begin(), texts.end(), [&](const std::string& text) { return text.find(part) != std::string::npos; });
}

bool mentions(const Errors& errors, const std::string& part) {
    return std::any_of(errors.begin(), errors.end(), [&](const Error& error) { return error.message.find(part) != std::string::npos; });
}

geometry::Mesh rebuilt(geometry::Mesh mesh) {
    mesh.shell_names.clear();
    geometry::build_connectivity(mesh);
    return mesh;
}

/// Pushes one vertex through the surface on the other side of the solid.
geometry::Mesh with_spike(geometry::Mesh mesh, int vertex, const Vector3& to) {
    mesh.vertices.col(vertex) = to;
    return mesh;
}

}  // namespace

TEST_CASE("a sound mesh keeps its bits and has nothing to tell") {
    for (const geometry::Mesh& sound :
         {tests::box_mesh({0, 0, 0}, {1, 2, 3}), tests::torus_mesh(1, 0.3, 12), tests::ellipsoid_mesh({1, 2, 3}, 6)}) {
        geometry::Mesh mesh = sound;
        CHECK(repair_mesh(mesh).empty());
        CHECK(geometry::have_same_shape(mesh, sound));
        const MeshFindings found = judge_mesh(mesh, true);
        CHECK(found.errors.empty());
        CHECK(found.warnings.empty());
    }
}

TEST_CASE("copies of triangles are left out") {
    const geometry::Mesh sound = tests::torus_mesh(1, 0.3, 12);
    geometry::Mesh mesh = sound;
    for (int k = 0; k < 5; ++k) {
        geometry::Triangle copy = sound.triangles[7 * k];
        std::rotate(copy.begin(), copy.begin() + k % 3, copy.end());
        mesh.triangles.push_back(copy);
    }
    mesh = rebuilt(mesh);
    CHECK_FALSE(is_closed(mesh));
    const auto done = repair_mesh(mesh);
    CHECK(mentions(done, "5 copies of triangles are left out"));
    CHECK(mesh.triangles == sound.triangles);
    CHECK(is_closed(mesh));
    CHECK(judge_mesh(mesh, true).errors.empty());
}

TEST_CASE("triangles that are turned over are turned back, whole solids too") {
    std::mt19937 random(11);
    for (const geometry::Mesh& sound : {tests::torus_mesh(1, 0.3, 12), tests::ellipsoid_mesh({1, 2, 3}, 6)}) {
        for (const double share : {0.02, 0.3, 0.7, 1.0}) {
            geometry::Mesh mesh = sound;
            for (geometry::Triangle& t : mesh.triangles) {
                if (std::uniform_real_distribution<double>(0, 1)(random) < share) std::swap(t[0], t[1]);
            }
            mesh = rebuilt(mesh);
            const auto done = repair_mesh(mesh);
            CAPTURE(share, done);
            CHECK(mentions(done, "turned"));
            CHECK(validate_mesh(mesh, {}).empty());
            CHECK(volume(mesh) == Approx(volume(sound)).epsilon(1e-12));
        }
    }
    // A block with a cavity: each is turned as it must be, whichever way the file had them.
    const geometry::Mesh outer = tests::box_mesh({0, 0, 0}, {5, 5, 5}), cavity = tests::inside_out(tests::box_mesh({1, 1, 1}, {4, 4, 4}));
    geometry::Mesh hollow = tests::joined(tests::inside_out(outer), cavity);
    CHECK(mentions(repair_mesh(hollow), "the solid was inside out: 12 triangles are turned"));
    CHECK(volume(hollow) == Approx(125 - 27));
}

TEST_CASE("a hollow solid that is inside out is turned as a whole") {
    const auto block = [](double low, double high) { return tests::box_mesh({low, low, low}, {high, high, high}); };
    const geometry::Mesh hollow = tests::joined(block(0, 10), tests::inside_out(block(2, 8)));
    geometry::Mesh turned = tests::inside_out(hollow);
    CHECK(mentions(repair_mesh(turned), "the solid was inside out: 24 triangles are turned"));
    CHECK(volume(turned) == Approx(784));
    CHECK(validate_mesh(turned, {}).empty());
    CHECK_FALSE(point_in_solid({5, 5, 5}, turned.vertices, turned.triangles));

    // Two cavities, one of them with a core that is hollow itself; beside it a sound block with a solid in it, which may be meant.
    const geometry::Mesh core = tests::joined(block(11, 14), tests::inside_out(block(12, 13)));
    const geometry::Mesh several =
        tests::joined(tests::joined(tests::joined(block(0, 20), tests::inside_out(block(10, 15))), core), tests::inside_out(block(2, 4)));
    geometry::Mesh nested = tests::joined(tests::inside_out(several), tests::joined(block(30, 40), block(32, 34)));
    CHECK(mentions(repair_mesh(nested), "60 triangles are turned"));
    CHECK(volume(nested) == Approx(8000 - 125 + 27 - 1 - 8 + 1000 + 8));
    CHECK(judge_mesh(nested, true).warnings.size() == 1);

    geometry::Mesh core_alone = tests::joined(hollow, tests::inside_out(block(4, 6)));  // sound but for what is in the cavity
    CHECK(mentions(repair_mesh(core_alone), "12 triangles are turned"));
    CHECK(volume(core_alone) == Approx(784 + 8));
}

TEST_CASE("where which side is turned over cannot be told, it is an error") {
    // A Moebius strip, closed by nothing.
    geometry::Mesh strip;
    strip.name = "strip";
    constexpr int n = 12;
    strip.vertices.resize(3, 2 * n);
    for (int i = 0; i < n; ++i) {
        const double angle = 2 * M_PI * i / n, twist = angle / 2;
        for (int side = 0; side < 2; ++side) {
            const double r = 1 + (side == 0 ? -0.3 : 0.3) * std::cos(twist);
            strip.vertices.col(2 * i + side) << r * std::cos(angle), r * std::sin(angle), (side == 0 ? -0.3 : 0.3) * std::sin(twist);
        }
        const bool last = i == n - 1;
        const int a = 2 * i, b = 2 * i + 1, c = last ? 1 : 2 * i + 2, d = last ? 0 : 2 * i + 3;
        strip.triangles.push_back({a, c, b});
        strip.triangles.push_back({b, c, d});
    }
    strip = rebuilt(strip);
    CHECK(repair_mesh(strip).empty());
    CHECK(mentions(judge_mesh(strip, true).errors, "run the same way round"));

    geometry::Mesh open = tests::torus_mesh(1, 0.3, 12);
    open.triangles.erase(open.triangles.begin());
    std::swap(open.triangles[40][0], open.triangles[40][1]);
    open = rebuilt(open);
    CHECK(repair_mesh(open).empty());
    CHECK(mentions(judge_mesh(open, true).errors, "one is turned over"));
}

TEST_CASE("small openings are capped with a bound, large ones are an error") {
    const geometry::Mesh sound = tests::ellipsoid_mesh({1, 2, 3}, 10);
    geometry::Mesh mesh = sound;
    mesh.triangles.erase(mesh.triangles.begin() + 30, mesh.triangles.begin() + 32);
    mesh = rebuilt(mesh);
    CHECK(repair_mesh(mesh).empty());
    const MeshFindings found = judge_mesh(mesh, true);
    CHECK(found.errors.empty());
    REQUIRE(found.warnings.size() == 1);
    CHECK(mentions(found.warnings, "capped for the mass, which changes its mass by at most"));
    const double bound = std::stod(found.warnings[0].substr(found.warnings[0].find("at most ") + 8)) / 100;
    CHECK(std::abs(volume(mesh) - volume(sound)) <= 1.1 * bound * volume(mesh));
    CHECK(bound < 0.05);

    geometry::Mesh box = tests::box_mesh({0, 0, 0}, {1, 1, 1});
    box.triangles.resize(10);
    box = rebuilt(box);
    CHECK(mentions(judge_mesh(box, true).errors, "the surface is open"));
    CHECK(judge_mesh(box, false).errors.empty());  // a static body may be a sheet
}

TEST_CASE("self-intersections are told with a bound of what they do to the mass") {
    // Parts that overlap: two boxes in one file. The union has 1.875, the signed volume is 2.
    const geometry::Mesh boxes = tests::joined(tests::box_mesh({0, 0, 0}, {1, 1, 1}), tests::box_mesh({0.5, 0.5, 0.5}, {1.5, 1.5, 1.5}));
    const MeshFindings overlapping = judge_mesh(boxes, true);
    CHECK(overlapping.errors.empty());
    CHECK(mentions(overlapping.warnings, "triangles intersect"));
    const auto pairs = self_intersections(boxes, 1000);
    REQUIRE(overlap_volume_bound(boxes, pairs));
    CHECK(*overlap_volume_bound(boxes, pairs) >= 0.125);
    CHECK(*overlap_volume_bound(boxes, pairs) <= 1);

    // A vertex of a fine sphere that sticks out of its neighbours' far side: a local fault, a small bound.
    const geometry::Mesh sphere = tests::ellipsoid_mesh({1, 1, 1}, 24);
    int tested = 0;
    for (const int vertex : {100, 200, 300}) {
        const Vector3 x = sphere.vertices.col(vertex);
        const Vector3 beside = x.cross(Vector3(0.3, 0.5, 0.8)).normalized();
        const geometry::Mesh damaged = with_spike(sphere, vertex, (x + 0.4 * beside).normalized() * 1.03);
        const auto crossing = self_intersections(damaged, 10000);
        if (crossing.empty()) continue;
        ++tested;
        const auto bound = overlap_volume_bound(damaged, crossing);
        REQUIRE(bound);
        CHECK(*bound < 40 * volume(sphere));  // a flap that covers many triangles is counted as often as there are
        // The union, by sampling: a place counts once.
        std::mt19937_64 random(vertex);
        std::uniform_real_distribution<double> uniform(-0.6, 0.6);
        double excess = 0;
        constexpr int samples = 4000;
        for (int i = 0; i < samples; ++i) {
            const Vector3 p = x + Vector3(uniform(random), uniform(random), uniform(random));
            const int winding = winding_number(p, damaged.vertices, damaged.triangles).value_or(0);
            excess += (winding - (winding != 0 ? 1 : 0)) * std::pow(1.2, 3) / samples;
        }
        CHECK(std::abs(excess) <= *bound);
        CHECK(judge_mesh(damaged, true).errors.empty());
    }
    CHECK(tested > 0);
    CHECK(judge_mesh(boxes, false).warnings.size() == 1);
}

TEST_CASE("triangles without area, shared edges and nested solids are told") {
    geometry::Mesh flat = tests::box_mesh({0, 0, 0}, {1, 1, 1});
    flat.vertices.conservativeResize(3, 9);
    flat.vertices.col(8) = 0.5 * (flat.vertices.col(flat.triangles[0][0]) + flat.vertices.col(flat.triangles[0][1]));
    flat.triangles.push_back({flat.triangles[0][0], 8, flat.triangles[0][1]});
    flat = rebuilt(flat);
    CHECK(mentions(judge_mesh(flat, true).warnings, "1 triangle has no area"));

    // Two boxes that touch in an edge: closed in the sense that matters, and inside is inside.
    const geometry::Mesh touching =
        geometry::weld_exactly(tests::joined(tests::box_mesh({0, 0, 0}, {1, 1, 1}), tests::box_mesh({1, 1, 0}, {2, 2, 1})));
    const MeshFindings shared = judge_mesh(touching, true);
    CHECK(shared.errors.empty());
    CHECK(mentions(shared.warnings, "1 edge belongs to more than two triangles"));
    CHECK(bounds_a_solid(touching));
    CHECK(point_in_solid({0.5, 0.5, 0.5}, touching.vertices, touching.triangles));
    CHECK(point_in_solid({1.5, 1.5, 0.5}, touching.vertices, touching.triangles));
    CHECK_FALSE(point_in_solid({1.5, 0.5, 0.5}, touching.vertices, touching.triangles));

    const geometry::Mesh nested = tests::joined(tests::box_mesh({0, 0, 0}, {5, 5, 5}), tests::box_mesh({1, 1, 1}, {4, 4, 4}));
    geometry::Mesh mesh = nested;
    CHECK(repair_mesh(mesh).empty());
    const std::vector<std::string> warnings = judge_mesh(mesh, true).warnings;
    CHECK(mentions(warnings, "a solid within a solid, so that its volume counts twice"));
    CHECK(mentions(warnings, "which changes its mass by at most 55% of the smaller of the two"));  // 125 + 27 for 125 - 27
    const std::vector<std::string> unweighed = judge_mesh(mesh, false).warnings;                   // a static body's
    CHECK(unweighed.size() == 1);
    CHECK(mentions(unweighed, "a solid within a solid, and no cavity"));
    CHECK_FALSE(mentions(unweighed, "mass"));
    CHECK(point_in_solid({2, 2, 2}, mesh.vertices, mesh.triangles));  // its parity would say outside
    CHECK(winding_number({2, 2, 2}, mesh.vertices, mesh.triangles) == 2);
}

}  // namespace fettle::core::solids::mesh_judgement_test
