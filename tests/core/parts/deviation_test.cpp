// SPDX-License-Identifier: MIT
// How far the true part is from its mesh, against dense samples of the true surface, in long double.
#include <cmath>
#include <numbers>
#include <random>

#include "core/geometry/distance.hpp"
#include "core/parts/extrude.hpp"
#include "core/parts/helix.hpp"
#include "core/parts/revolve.hpp"
#include "core/solids/point_in_solid.hpp"
#include "tests/core/parts/part_check.hpp"

namespace fettle::core::parts::deviation_test {

using part_check::draw;
using part_check::PartFunction;
using std::numbers::pi;

namespace {

using Long3 = std::array<long double, 3>;
using Parameters = std::array<long double, 2>;

struct RoundPart {
    const char* name;
    PartFunction part;
    std::vector<double> dimensions;
    std::function<Long3(const Parameters&)> surface;   ///< of two numbers in [0, 1]
    std::function<long double(const Long3&)> outside;  ///< distance of a point from the true solid, 0 within it
};

// Within (r, z), of the distance from the axis and the height.
std::function<long double(const Long3&)> revolved_distance(const std::function<long double(long double, long double)>& in_plane) {
    return [in_plane](const Long3& p) { return in_plane(std::hypot(p[0], p[1]), p[2]); };
}

long double box_distance(long double r, long double z, long double low_r, long double high_r, long double low_z, long double high_z) {
    return std::hypot(std::max({low_r - r, r - high_r, 0.0L}), std::max({low_z - z, z - high_z, 0.0L}));
}

const long double turn = 2 * std::numbers::pi_v<long double>;

std::vector<RoundPart> round_parts() {
    std::vector<RoundPart> out;
    out.push_back({"ball",
                   [](Drawing& drawing, const std::vector<Number>& d) { return sphere(drawing, d[0], "ball"); },
                   {5e-3},
                   [](const Parameters& s) {
                       const long double r = 5e-3, u = turn * s[0], v = turn / 2 * (s[1] - 0.5L);
                       return Long3{r * std::cos(v) * std::cos(u), r * std::cos(v) * std::sin(u), r * std::sin(v)};
                   },
                   revolved_distance([](long double r, long double z) { return std::max(0.0L, std::hypot(r, z) - 5e-3L); })});
    out.push_back({"ring",
                   [](Drawing& drawing, const std::vector<Number>& d) { return torus(drawing, d[0], d[1], "ring"); },
                   {8e-3, 2e-3},
                   [](const Parameters& s) {
                       const long double u = turn * s[0], v = turn * s[1], r = 8e-3L + 2e-3L * std::cos(v);
                       return Long3{r * std::cos(u), r * std::sin(u), 2e-3L * std::sin(v)};
                   },
                   revolved_distance([](long double r, long double z) { return std::max(0.0L, std::hypot(r - 8e-3L, z) - 2e-3L); })});
    out.push_back({"pin",
                   [](Drawing& drawing, const std::vector<Number>& d) -> Result<Solid> {
                       return extruded(drawing, *filled(circle({}, d[0], "pin")), 0, d[1]);
                   },
                   {3e-3, 10e-3},
                   [](const Parameters& s) {
                       return Long3{3e-3L * std::cos(turn * s[0]), 3e-3L * std::sin(turn * s[0]), 10e-3L * s[1]};
                   },
                   revolved_distance([](long double r, long double z) { return box_distance(r, z, 0, 3e-3L, 0, 10e-3L); })});
    out.push_back({"bush",
                   [](Drawing& drawing, const std::vector<Number>& d) -> Result<Solid> {
                       return extruded(drawing, *with_hole(*filled(circle({}, d[0], "rim")), circle({}, d[1], "bore")), 0, d[2]);
                   },
                   {4e-3, 3e-3, 10e-3},
                   [](const Parameters& s) {
                       const long double r = s[0] < 0.5L ? 3e-3L : 4e-3L, u = 2 * turn * s[0];
                       return Long3{r * std::cos(u), r * std::sin(u), 10e-3L * s[1]};
                   },
                   revolved_distance([](long double r, long double z) { return box_distance(r, z, 3e-3L, 4e-3L, 0, 10e-3L); })});
    out.push_back({"groove",
                   [](Drawing& drawing, const std::vector<Number>& d) -> Result<Solid> {
                       // A half round groove in a rim.
                       const auto loop = Path({0, 0}, "disc")
                                             .line_to({d[0], 0})
                                             .line_to({d[0], d[1]})
                                             .arc_about({d[0], 2.0 * d[1]}, {d[0], 3.0 * d[1]}, false)
                                             .line_to({d[0], 4.0 * d[1]})
                                             .line_to({0, 4.0 * d[1]})
                                             .closed();
                       if (!loop) return loop.errors();
                       return revolved(drawing, *filled(*loop));
                   },
                   {10e-3, 1e-3},
                   [](const Parameters& s) {
                       const long double v = turn / 2 * s[1], r = 10e-3L - 1e-3L * std::sin(v), u = turn * s[0];
                       return Long3{r * std::cos(u), r * std::sin(u), 2e-3L - 1e-3L * std::cos(v)};
                   },
                   revolved_distance([](long double r, long double z) {
                       const long double box = box_distance(r, z, 0, 10e-3L, 0, 4e-3L),
                                         in_groove = 1e-3L - std::hypot(r - 10e-3L, z - 2e-3L);
                       return std::max({box, in_groove, 0.0L});  // at least
                   })});
    out.push_back({"chamfer",
                   [](Drawing& drawing, const std::vector<Number>& d) -> Result<Solid> {
                       return extruded(drawing, *filled(circle({}, d[0], "pin")), 0, d[1], {d[2], d[2]});
                   },
                   {3e-3, 10e-3, 1e-3},
                   [](const Parameters& s) {
                       const long double z = 1e-3L * s[1], r = 2e-3L + z;
                       return Long3{r * std::cos(turn * s[0]), r * std::sin(turn * s[0]), z};
                   },
                   revolved_distance([](long double r, long double z) {
                       return std::max({box_distance(r, z, 0, 3e-3L, 0, 10e-3L), (r - z - 2e-3L) / std::sqrt(2.0L), 0.0L});
                   })});
    return out;
}

double distance_to_mesh(const Vector3& p, const geometry::Mesh& mesh) {
    double least = INFINITY;
    for (const auto& t : mesh.triangles)
        least = std::min(
            least, geometry::point_triangle_distance_squared(p, mesh.vertices.col(t[0]), mesh.vertices.col(t[1]), mesh.vertices.col(t[2])));
    return std::sqrt(least);
}

}  // namespace

TEST_CASE("the part is never farther outside of its mesh, nor the mesh outside of the part, than is said") {
    std::mt19937 random(5);
    const auto uniform = [&] { return static_cast<long double>(random()) / 4294967296.0L; };
    for (const RoundPart& round : round_parts()) {
        for (const Lean lean : {Lean::cover, Lean::within, Lean::through}) {
            const auto part = draw(round.part, round.dimensions, {0, 20, lean});
            REQUIRE(part);
            INFO(round.name << " " << static_cast<int>(lean));
            CHECK((part->deviation.out_is_proven && part->deviation.in_is_proven));
            double out = 0;
            for (int k = 0; k < 1500; ++k) {
                const Long3 p = round.surface({uniform(), uniform()});
                const Vector3 rounded(static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2]));
                if (!solids::point_in_solid(rounded, part->mesh.vertices, part->mesh.triangles))
                    out = std::max(out, distance_to_mesh(rounded, part->mesh));
            }
            long double in = 0;
            for (const auto& t : part->mesh.triangles) {
                for (int k = 0; k < 20; ++k) {
                    long double a = uniform(), b = uniform();
                    if (k < 3) {  // corners
                        a = k == 1;
                        b = k == 2;
                    }
                    if (a + b > 1) {
                        a = 1 - a;
                        b = 1 - b;
                    }
                    Long3 p;
                    for (std::size_t i = 0; i < 3; ++i) {
                        const auto row = static_cast<Eigen::Index>(i);
                        p[i] = (1 - a - b) * part->mesh.vertices(row, t[0]) + a * part->mesh.vertices(row, t[1]) +
                               b * part->mesh.vertices(row, t[2]);
                    }
                    in = std::max(in, round.outside(p));
                }
            }
            CHECK(out <= part->deviation.out);
            CHECK(static_cast<double>(in) <= part->deviation.in);
            if (lean == Lean::cover && std::string(round.name) != "ring" && std::string(round.name) != "groove")
                CHECK(part->deviation.out < 1e-15);
            // And there is much of it; of the ring two sums of unlike signs are added up.
            if (std::string(round.name) == "ring") continue;
            if (part->deviation.out > 1e-12) CHECK(out > 0.3 * part->deviation.out);
            if (part->deviation.in > 1e-12) CHECK(static_cast<double>(in) > 0.3 * part->deviation.in);
        }
    }
}

TEST_CASE("a twisted bar is within its bound") {
    const double a = 6e-3, b = 3e-3, height = 10e-3, twist = 1.1;
    const auto bar = [](Drawing& drawing, const std::vector<Number>& d) -> Result<Solid> {
        return twisted(drawing, *filled(rectangle({-0.5 * d[0], -0.5 * d[1]}, d[0], d[1], "bar")), 0, d[2], d[3]);
    };
    const auto part = draw(bar, {a, b, height, twist});
    REQUIRE(part);
    std::mt19937 random(5);
    double farthest = 0;
    for (int k = 0; k < 3000; ++k) {
        const double s = static_cast<double>(random()) / 4294967296.0 - 0.5, t = static_cast<double>(random()) / 4294967296.0;
        const double x = k % 2 == 0 ? a / 2 : a * s, y = k % 2 == 0 ? b * s : b / 2, c = std::cos(twist * t), d = std::sin(twist * t);
        farthest = std::max(farthest, distance_to_mesh({c * x - d * y, d * x + c * y, height * t}, part->mesh));
    }
    CHECK(farthest <= part->deviation.out);
    CHECK(farthest > 0.2 * part->deviation.out);
}

}  // namespace fettle::core::parts::deviation_test
