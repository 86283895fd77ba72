// SPDX-License-Identifier: MIT
// Each kind of pair that has broken a collision query somewhere, by name, by both methods, from 1e-6 to 1e6 and far from the origin.
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "core/ccd/linear_ccd.hpp"
#include "tests/support/exact_ccd.hpp"
#include "tests/support/inclusion_ccd.hpp"

namespace fettle::core::ccd::linear_ccd_degenerate_test {

namespace {

struct Case {
    std::string name;
    geometry::PairType type;
    geometry::PairVertices t0, t1;
    bool hit;
};

geometry::PairVertices moved(geometry::PairVertices x, std::size_t from, std::size_t to, const Vector3& by) {
    for (std::size_t i = from; i < to; ++i) x[i] += by;
    return x;
}

/// Sizes around 1, coordinates in 2^-40: scaled by powers of two and shifted by whole numbers they stay exact.
std::vector<Case> cases() {
    constexpr geometry::PairType face = geometry::PairType::point_triangle, edges = geometry::PairType::edge_edge;
    const geometry::PairVertices above{Vector3(0.25, 0.25, 1), Vector3(0, 0, 0), Vector3(1, 0, 0), Vector3(0, 1, 0)};
    const geometry::PairVertices in_plane{Vector3(-2, 0.25, 0), Vector3(0, 0, 0), Vector3(1, 0, 0), Vector3(0, 1, 0)};
    const geometry::PairVertices sliver{Vector3(0.5, 0, 1), Vector3(0, 0, 0), Vector3(1, 0, 0), Vector3(0.5, 0x1p-40, 0)};
    const geometry::PairVertices line{Vector3(0.5, 0, 1), Vector3(0, 0, 0), Vector3(1, 0, 0), Vector3(0.25, 0, 0)};
    const geometry::PairVertices point{Vector3(0.25, 0.25, 1), Vector3(0.25, 0.25, 0), Vector3(0.25, 0.25, 0), Vector3(0.25, 0.25, 0)};
    const geometry::PairVertices crossed{Vector3(-1, 0, 1), Vector3(1, 0, 1), Vector3(0, -1, 0), Vector3(0, 1, 0)};
    const geometry::PairVertices parallel{Vector3(-1, 0, 1), Vector3(1, 0, 1), Vector3(0, 0, 0), Vector3(2, 0, 0)};
    const geometry::PairVertices beside{Vector3(-1, 0, 1), Vector3(1, 0, 1), Vector3(2, 0, 0), Vector3(3, 0, 0)};
    const geometry::PairVertices nearly{Vector3(-1, -0x1p-40, 1), Vector3(1, 0x1p-40, 1), Vector3(-0.5, 0, 0), Vector3(2, 0, 0)};
    const geometry::PairVertices collinear{Vector3(-3, 0, 0), Vector3(-2, 0, 0), Vector3(0, 0, 0), Vector3(2, 0, 0)};
    const geometry::PairVertices flat{Vector3(-2, -2, 0), Vector3(-1, -1, 0), Vector3(0, 1, 0), Vector3(1, 0, 0)};
    const geometry::PairVertices shrunk{Vector3(0.5, 0, 1), Vector3(0.5, 0, 1), Vector3(0, 0, 0), Vector3(2, 0, 0)};
    const Vector3 down(0, 0, -2), along(4, 0, 0), up(0, 0, 1), far(1e8, 0, -2e8), corner(3, 3, 0);
    const double half = 0.5;
    geometry::PairVertices touching = above, through_edge = above;
    touching[0].z() = 0;
    through_edge[0] = Vector3(half, half, 1);
    std::vector<Case> all{
        {"point through a triangle", face, above, moved(above, 0, 1, down), true},
        {"point through an edge of a triangle", face, through_edge, moved(through_edge, 0, 1, down), true},
        {"point through a corner of a triangle", face, moved(above, 1, 4, {0.25, 0.25, 0}),
         moved(moved(above, 1, 4, {0.25, 0.25, 0}), 0, 1, down), true},
        {"point beside a triangle", face, moved(above, 1, 4, {2, 0, 0}), moved(moved(above, 1, 4, {2, 0, 0}), 0, 1, down), false},
        {"coplanar, the point slides in", face, in_plane, moved(in_plane, 0, 1, along), true},
        {"coplanar, the point slides past", face, moved(in_plane, 0, 1, {0, 2, 0}), moved(in_plane, 0, 1, {4, 2, 0}), false},
        {"no motion, touching", face, touching, touching, true},
        {"no motion, apart", face, above, above, false},
        {"common motion, apart", face, above, moved(above, 0, 4, {5, -7, 3}), false},
        {"touching at the start, moving away", face, touching, moved(touching, 0, 1, up), true},
        {"touching at the end", face, above, touching, true},
        {"through a sliver", face, sliver, moved(sliver, 0, 1, down), true},
        {"beside a sliver", face, moved(sliver, 0, 1, {0, 0.5, 0}), moved(moved(sliver, 0, 1, {0, 0.5, 0}), 0, 1, down), false},
        {"through a triangle that is a line", face, line, moved(line, 0, 1, down), true},
        {"beside a triangle that is a line", face, moved(line, 0, 1, {0, 0.5, 0}), moved(moved(line, 0, 1, {0, 0.5, 0}), 0, 1, down),
         false},
        {"through a triangle that is a point", face, point, moved(point, 0, 1, down), true},
        {"beside a triangle that is a point", face, moved(point, 0, 1, {0.5, 0, 0}), moved(moved(point, 0, 1, {0.5, 0, 0}), 0, 1, down),
         false},
        {"crossed edges", edges, crossed, moved(crossed, 0, 2, down), true},
        {"crossed edges, beside", edges, moved(crossed, 0, 2, corner), moved(moved(crossed, 0, 2, corner), 0, 2, down), false},
        {"parallel edges meet", edges, parallel, moved(parallel, 0, 2, down), true},
        {"parallel edges pass", edges, moved(parallel, 0, 2, {0, 0.5, 0}), moved(moved(parallel, 0, 2, {0, 0.5, 0}), 0, 2, down), false},
        {"parallel edges that do not overlap", edges, beside, moved(beside, 0, 2, down), false},
        {"nearly parallel edges meet", edges, nearly, moved(nearly, 0, 2, down), true},
        {"collinear edges meet end to end", edges, collinear, moved(collinear, 0, 2, along), true},
        {"collinear edges stay apart", edges, collinear, moved(collinear, 0, 2, {1, 0, 0}), false},
        {"coplanar edges cross", edges, flat, moved(flat, 0, 2, corner), true},
        {"coplanar edges pass", edges, flat, moved(flat, 0, 2, {4, -4, 0}), false},
        {"an edge without length meets an edge", edges, shrunk, moved(shrunk, 0, 2, down), true},
        {"an edge without length passes an edge", edges, moved(shrunk, 0, 2, {0, 0.5, 0}),
         moved(moved(shrunk, 0, 2, {0, 0.5, 0}), 0, 2, down), false},
        {"1e8 times the size, through an edge", face, moved(above, 0, 1, -far), moved(above, 0, 1, far), true},
        {"1e8 times the size, through at the middle", face, moved(touching, 0, 1, -far), moved(touching, 0, 1, far), true},
        {"1e8 times the size, edges at the middle", edges, moved(moved(crossed, 0, 2, {0, 0, -1}), 0, 2, -far),
         moved(moved(crossed, 0, 2, {0, 0, -1}), 0, 2, far), true},
    };
    return all;
}

}  // namespace

TEST_CASE("linear CCD decides each kind of degenerate pair, at every size and place, by both methods") {
    for (const Case& c : cases()) {
        CAPTURE(c.name);
        CHECK(tests::exact_linear_contact(c.type, c.t0, c.t1) == c.hit);
        for (const double scale : {0x1p-20, 1.0, 0x1p20}) {
            for (const Vector3& offset : {Vector3(0, 0, 0), Vector3(1000, -2000, 500)}) {
                geometry::PairVertices t0 = c.t0, t1 = c.t1;
                for (geometry::PairVertices* x : {&t0, &t1})
                    for (Vector3& v : *x) v = scale * (v + offset);
                for (const auto ccd : {&linear_ccd, &tests::support::inclusion_ccd}) {
                    CAPTURE(scale, offset.x(), ccd == &linear_ccd);
                    const LinearCcdResult r = ccd(c.type, t0, t1, 0, {1e-4 * scale, 100'000});
                    CHECK(r.hit == c.hit);
                    if (r.hit && !tests::exact_distance_at_most(c.type, t0, t1, 0, 0)) CHECK(r.toi > 0);
                    CHECK((r.toi == 0 || !tests::exact_distance_at_most(c.type, t0, t1, r.toi * (1 - 0x1p-50), 0)));
                }
            }
        }
    }
}

TEST_CASE("linear CCD keeps a minimum separation on each kind of degenerate pair, by both methods") {
    for (const Case& c : cases()) {
        CAPTURE(c.name);
        for (const double dmin : {0x1p-30, 0x1p-10, 0.125}) {
            for (const auto ccd : {&linear_ccd, &tests::support::inclusion_ccd}) {
                CAPTURE(dmin, ccd == &linear_ccd);
                const LinearCcdResult r = ccd(c.type, c.t0, c.t1, dmin, {1e-4, 100'000});
                CHECK((r.hit || !c.hit));
                // Nothing nearer than dmin before what is proven to be clear.
                for (const double share : {0.0, 0.5, 1 - 0x1p-50}) {
                    if (r.toi > 0 && (share > 0 || !r.hit)) {
                        CHECK_FALSE(tests::exact_distance_at_most(c.type, c.t0, c.t1, share * r.toi, dmin));
                    }
                }
            }
        }
    }
}

}  // namespace fettle::core::ccd::linear_ccd_degenerate_test
