// SPDX-License-Identifier: MIT
/// Random parts of the part kernel, which knows the surface behind each facet, made into meshes as files have them: in float32, shuffled,
/// turned, with noise.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>
#include <random>
#include <string>

#include "core/parts/drawn_part.hpp"
#include "core/parts/extrude.hpp"
#include "core/parts/revolve.hpp"
#include "core/parts/solid_booleans.hpp"

namespace fettle::core::features::known_parts {

using namespace parts;  // NOLINT(google-build-using-namespace): what parts are drawn with

class Chance {
public:
    explicit Chance(unsigned seed) : random_(seed) {}
    double between(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
    int among(int count) { return std::uniform_int_distribution<int>(0, count - 1)(random_); }
    std::mt19937& engine() { return random_; }

private:
    std::mt19937 random_;
};

constexpr double mm = 1e-3;

/// What is drawn of a part, with corners on its curves unless said otherwise.
inline geometry::Mesh drawn_mesh(const std::function<Result<Solid>(Drawing&)>& part, Lean lean = Lean::through,
                                 const std::string& name = "part") {
    Facets facets;
    facets.lean = lean;
    Drawing drawing(facets);
    return drawn(drawing, part(drawing).value(), name, {.jacobian = false}).value().mesh;
}

/// A plate of two layers, with bores, counterbores and blind bores, and pins on it.
inline Result<Solid> plate(Drawing& drawing, Chance& chance) {
    const int nx = 1 + chance.among(3), ny = 1 + chance.among(2);
    const double pitch = chance.between(12, 20) * mm, low = chance.between(2, 8) * mm, high = low + chance.between(2, 8) * mm,
                 top = high + chance.between(3, 15) * mm;
    std::vector<Loop> lower, upper;
    std::vector<Profile> pins;
    for (int i = 0; i < nx; ++i)
        for (int j = 0; j < ny; ++j) {
            const Point2 at{(i + 0.5) * pitch, (j + 0.5) * pitch};
            const double r = chance.between(0.8, 4.5) * mm;
            const int kind = chance.among(5);
            if (kind == 0 || kind == 1) lower.push_back(circle(at, r, "bore"));
            if (kind == 0) upper.push_back(circle(at, r, "bore"));
            if (kind == 1) upper.push_back(circle(at, r + chance.between(0.3, 1) * mm, "counterbore"));
            if (kind == 2) upper.push_back(circle(at, r, "blind"));
            if (kind == 3) pins.push_back(*filled(circle(at, r, "pin")));
            if (kind == 4) {
                lower.push_back(slot(at - Point2{1.5 * mm, 0}, at + Point2{1.5 * mm, 0}, std::min(r, 2.5 * mm), "slot"));
                upper.push_back(lower.back());
            }
        }
    const Loop outline = *rounded(rectangle({}, nx * pitch, ny * pitch, "rim"), chance.between(1, 3) * mm);
    const Profile below = *with_holes(*filled(outline), lower), above = *with_holes(*filled(outline), upper);
    std::vector<Layer> layers{{below, 0, low, {}, {}, "below"}, {above, low, high, {}, {}, "above"}};
    if (!pins.empty()) {
        Profile all = pins.front();
        for (std::size_t k = 1; k < pins.size(); ++k) all.loops.push_back(pins[k].loops.front());
        layers.push_back({all, high, top, {}, {}, "pins"});
    }
    return stacked(drawing, layers);
}

/// Turned: steps, tapers, a groove, fillets, a round end; hollow or not.
inline Result<Solid> turned_part(Drawing& drawing, Chance& chance) {
    const bool hollow = chance.among(2) == 0;
    const double inner = hollow ? chance.between(2, 5) * mm : 0;
    double r = inner + chance.between(4, 8) * mm, z = 0;
    const double start = r;
    Path path({inner, 0.0}, "bore");
    path.line_to({r, 0.0});
    const int steps = 2 + chance.among(3);
    for (int k = 0; k < steps; ++k) {
        const double length = chance.between(3, 9) * mm;
        path.feature("side " + std::to_string(k));
        switch (chance.among(4)) {
            case 0: {  // taper
                const double to = std::max(inner + 2 * mm, r - chance.between(0.2, 1.5) * mm);
                path.line_to({to, z + length});
                r = to;
                break;
            }
            case 1:  // groove of half a torus
                path.line_to({r, z + length})
                    .arc_about({r, z + length + 1 * mm}, {r, z + length + 2 * mm}, false)
                    .line_to({r, z + 2 * length + 2 * mm});
                z += length + 2 * mm;
                break;
            default:
                path.line_to({r, z + length});
        }
        z += length;
        if (k + 1 == steps) break;
        const double less = r - chance.between(1, 2) * mm;
        if (less < inner + 1.5 * mm) continue;
        if (chance.among(2) == 0) {  // a fillet at the foot of the step
            const double f = 0.5 * (r - less);
            path.line_to({less + f, z}).arc_about({less + f, z + f}, {less, z + f}, false);
            z += f;
        } else {
            path.line_to({less, z});
        }
        r = less;
    }
    if (!hollow && chance.among(2) == 0) {
        path.feature("ball").arc_about({0.0, z}, {0.0, z + r}, true);
    } else {
        path.line_to({inner, z});
    }
    static_cast<void>(start);
    const Result<Loop> loop = path.closed();
    if (!loop) return loop.errors();
    const Result<Profile> profile = filled(*loop);
    if (!profile) return profile.errors();
    return revolved(drawing, *profile);
}

/// A block with a bore, across which a slot is cut, or another bore; or a dimple, a ring groove, a countersink.
inline Result<Solid> cut_block(Drawing& drawing, Chance& chance) {
    const double a = chance.between(20, 40) * mm, h = chance.between(10, 25) * mm, r = chance.between(2, 6) * mm;
    const Solid block =
        *extruded(drawing, *with_hole(*filled(rectangle({-0.5 * a, -0.5 * a}, a, a, "block")), circle({}, r, "bore")), 0, h);
    const Facets facets = drawing.facets;
    drawing.facets.lean = opposite(facets.lean);
    const auto cut = [&]() -> Result<Solid> {
        switch (chance.among(5)) {
            case 0: {  // a slot across, from outside to outside
                const double w = chance.between(1, 3) * mm, from = chance.between(0.3, 0.5) * h;
                return moved(*extruded(drawing, *filled(rectangle({-a, -a}, 2 * a, 2 * a, "slot")), 0, w), {1.3 * a, 0.01 * mm, from});
            }
            case 1: {  // along the axis: two halves
                const double w = chance.between(0.3, 0.8) * r;
                return moved(*extruded(drawing, *filled(rectangle({-a, -0.5 * w}, 2 * a, w, "slot")), 0, 0.6 * h), {0, 0, 0.5 * h});
            }
            case 2:
                return moved(*sphere(drawing, chance.between(2, 4) * mm, "dimple"), {0.3 * a, 0.3 * a, h + 0.4 * mm});
            case 3:
                return moved(*torus(drawing, r + 3.3 * mm, 1 * mm, "ring"), {0, 0, h + 0.1 * mm});
            default:
                return moved(*cone(drawing, 0.7 * r, 1.6 * r, 0.9 * r, "sink"), {0, 0, h - 0.6 * r});
        }
    }();
    drawing.facets = facets;
    if (!cut) return cut.errors();
    return difference(drawing, block, *cut);
}

/// A file's digits, its order, its place.
struct Roughness {
    bool turned = false, float32 = false, shuffled = false;
    double noise = 0;  ///< of each coordinate, at most, as a share of the diagonal
};

/// `part.facets` stays with the triangles.
inline void roughen(DrawnPart& part, const Roughness& rough, Chance& chance) {
    Matrix3X& x = part.mesh.vertices;
    const double diagonal = (x.rowwise().maxCoeff() - x.rowwise().minCoeff()).norm();
    if (rough.turned) {
        const Vector3 axis = Vector3(chance.between(-1, 1), chance.between(-1, 1), chance.between(0.1, 1)).normalized();
        const Eigen::AngleAxisd by(chance.between(0, 3), axis);
        const Vector3 to(chance.between(-50, 50) * mm, chance.between(-50, 50) * mm, chance.between(-50, 50) * mm);
        for (Eigen::Index k = 0; k < x.cols(); ++k) x.col(k) = by * Vector3(x.col(k)) + to;
    }
    for (Eigen::Index k = 0; k < x.size(); ++k) {
        x.data()[k] += rough.noise * diagonal * chance.between(-1, 1);
        if (rough.float32) x.data()[k] = mm * static_cast<double>(static_cast<float>(x.data()[k] / mm));
    }
    if (!rough.shuffled) return;
    std::vector<int> vertices(x.cols()), triangles(part.mesh.triangles.size());
    std::iota(vertices.begin(), vertices.end(), 0);
    std::iota(triangles.begin(), triangles.end(), 0);
    std::shuffle(vertices.begin(), vertices.end(), chance.engine());
    std::shuffle(triangles.begin(), triangles.end(), chance.engine());
    Matrix3X moved = x;
    for (Eigen::Index k = 0; k < x.cols(); ++k) moved.col(vertices[k]) = x.col(k);
    std::vector<geometry::Triangle> order;
    std::vector<Facet> facets;
    for (const int t : triangles) {
        geometry::Triangle triangle = part.mesh.triangles[t];
        for (int& v : triangle) v = vertices[v];
        std::rotate(triangle.begin(), triangle.begin() + chance.among(3), triangle.end());
        order.push_back(triangle);
        facets.push_back(part.facets[t]);
    }
    part.mesh = geometry::make_mesh(part.mesh.name, moved, order);
    part.facets = facets;
}

/// @param lean  That of plates. Balls, fillets and grooves whose facets lean are no exact balls and tori, so that those parts have their
/// corners
///              on the surfaces.
inline Result<DrawnPart> random_part(Chance& chance, Lean lean) {
    Facets facets;
    facets.segments = 12 + chance.among(117);
    const int kind = chance.among(has_solid_booleans() ? 3 : 2);
    facets.lean = kind == 0 ? lean : Lean::through;
    Drawing drawing(facets);
    const Result<Solid> solid = kind == 0 ? plate(drawing, chance) : kind == 1 ? turned_part(drawing, chance) : cut_block(drawing, chance);
    if (!solid) return solid.errors();
    return drawn(drawing, *solid, "part", {false});
}

}  // namespace fettle::core::features::known_parts
