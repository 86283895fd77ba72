// SPDX-License-Identifier: MIT
/// The least of 100,000 samples of the distance of two moving bodies, in extended precision (64-bit mantissa), without any hierarchy and
/// without code of core/clearance. How so many samples are affordable, and still samples of the distance of the whole pair:
/// - the time is cut into blocks. Each element (triangle, loose edge, loose point) has a sphere at the block's middle and a bound of how
///   far its points move within the block; an element pair whose spheres are farther apart than both motions and the best sample so
///   far (all in double, with a margin of 1e-6 of the size) cannot be the nearest at any instant of the block where the distance is less
///   than the best sample, and is left out there;
/// - at a sample where an element pair is farther apart than the best by more than its points can move until the next sample, or the one
///   after, and so on, it cannot be the best there, and is measured again only where it can;
/// - blocks in which all pairs are left out hold no better sample. The samples go to the others, in equal steps within each, so that
///   they lie closer than 100,000 equal steps would wherever the minimum can be.
#pragma once

#include <vector>

#include "tests/core/clearance/clearance_oracle.hpp"

namespace fettle::tests::clearance {

/// Two bodies, any number of path segments.
struct MovingBodies {
    Solid a, b;
    std::vector<core::kinematics::PathSegment> path_a, path_b;
};

class DenseSampling {
public:
    explicit DenseSampling(const MovingBodies& bodies)
        : bodies_(bodies), elements_a_(elements_of(bodies.a.mesh)), elements_b_(elements_of(bodies.b.mesh)) {}

    /// @param samples  at least so many of them, apart from the first look
    Real least(int samples) {
        const int segments = count_of(bodies_.path_a), blocks = std::max(1, 600 / segments);
        for (int i = 0; i < segments; ++i)
            for (int k = 0; k < 4; ++k) look_at_middle(i, (k + 0.5) / 4);
        struct Block {
            int segment, index;
            Pairs pairs;
        };
        std::vector<Block> alive;
        for (int i = 0; i < segments; ++i) {
            std::vector<double> safe(elements_a_.size() * elements_b_.size(), -1);
            for (int k = 0; k < blocks; ++k) {
                Pairs pairs = near_pairs(i, static_cast<double>(k) / blocks, 1.0 / blocks, &safe);
                if (!pairs.empty()) alive.push_back({i, k, std::move(pairs)});
            }
        }
        if (alive.empty()) return best_;
        const int each = samples / count_of(alive) + 1;
        for (const Block& block : alive) {
            sample_block(block.segment, Real(block.index) / blocks, Real(1) / blocks / each, each, block.pairs);
            taken_ += each + 1;
        }
        return best_;
    }
    long taken() const { return taken_; }
    /// Distance of two elements at an instant.
    Real distance(int segment, Real s, const std::array<int, 3>& a, const std::array<int, 3>& b) const {
        return element_distance(corners(place(bodies_.path_a[segment], s), bodies_.a.mesh, a),
                                corners(place(bodies_.path_b[segment], s), bodies_.b.mesh, b));
    }

private:
    struct Element {
        std::array<int, 3> vertices;  ///< repeated where there are fewer than three
        Vector3 center;
        double radius = 0, reach = 0;  ///< of its points from the center, from the body's reference point
    };
    using Pairs = std::vector<std::pair<int, int>>;
    using Corners3 = std::array<Real3, 3>;
    struct Place {
        Real33 rotation;
        Real3 position;
    };

    static std::vector<Element> elements_of(const core::geometry::Mesh& mesh) {
        std::vector<Element> elements;
        std::vector<bool> used(mesh.vertices.cols(), false);
        const auto add = [&](std::array<int, 3> v) {
            Element e{v, (mesh.vertices.col(v[0]) + mesh.vertices.col(v[1]) + mesh.vertices.col(v[2])) / 3};
            for (const int k : v) {
                e.radius = std::max(e.radius, (mesh.vertices.col(k) - e.center).norm());
                e.reach = std::max(e.reach, mesh.vertices.col(k).norm());
                used[k] = true;
            }
            elements.push_back(e);
        };
        for (const auto& t : mesh.triangles) add(t);
        for (const auto& e : mesh.edges)
            if (!used[e[0]] || !used[e[1]] || mesh.triangles.empty()) add({e[0], e[1], e[1]});
        for (int v = 0; v < count_of(used); ++v)
            if (!used[v]) add({v, v, v});
        return elements;
    }

    static Place place(const core::kinematics::PathSegment& p, Real s) {
        const Real3 t = p.rotation_vector_t0.cast<Real>() + s * p.rotation_vector_step.cast<Real>();
        return {oracle_rotation(t) * p.base.cast<Real>(), p.position_t0.cast<Real>() + s * p.position_step.cast<Real>()};
    }

    static Corners3 corners(const Place& at, const core::geometry::Mesh& mesh, const std::array<int, 3>& v) {
        Corners3 x;
        for (std::size_t k = 0; k < 3; ++k) x[k] = at.rotation * mesh.vertices.col(v[k]).cast<Real>() + at.position;
        return x;
    }

    // The distance of elements that do not intersect. Repeated corners make degenerate triangles, whose edges and corners are all that
    // counts.
    static Real element_distance(const Corners3& a, const Corners3& b) {
        Real least = std::numeric_limits<Real>::infinity();
        const auto is_triangle = [](const Corners3& t) { return t[1] != t[2]; };
        for (std::size_t i = 0; i < 3; ++i) {
            if (is_triangle(b)) least = std::min(least, (a[i] - oracle_closest_on_triangle(a[i], b[0], b[1], b[2])).norm());
            if (is_triangle(a)) least = std::min(least, (b[i] - oracle_closest_on_triangle(b[i], a[0], a[1], a[2])).norm());
        }
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t j = 0; j < 3; ++j) {
                const std::size_t k = (i + 1) % 3, l = (j + 1) % 3;
                const bool edge_a = a[i] != a[k], edge_b = b[j] != b[l];
                if (edge_a && edge_b)
                    least = std::min(least, oracle_edge_distance(a[i], a[k], b[j], b[l]));
                else if (edge_a)
                    least = std::min(least, point_edge(b[j], a[i], a[k]));
                else if (edge_b)
                    least = std::min(least, point_edge(a[i], b[j], b[l]));
                else
                    least = std::min(least, (a[i] - b[j]).norm());
            }
        return least;
    }

    static Real point_edge(const Real3& p, const Real3& e0, const Real3& e1) {
        const Real3 d = e1 - e0;
        const Real t = std::min<Real>(std::max<Real>(d.dot(p - e0) / d.dot(d), 0), 1);
        return (p - e0 - t * d).norm();
    }

    // How much nearer two elements can come per unit of s.
    double rate(int segment, const Element& a, const Element& b) const {
        const auto &pa = bodies_.path_a[segment], &pb = bodies_.path_b[segment];
        return (pa.position_step - pb.position_step).norm() + pa.rotation_vector_step.norm() * a.reach +
               pb.rotation_vector_step.norm() * b.reach;
    }
    double margin() const { return 1e-6 * (bodies_.a.radius() + bodies_.b.radius()); }

    // All pairs that can be nearer than the best sample during [start, start + length] of the segment. `safe`: per pair, the parameter
    // up to which it cannot, as far as is known.
    Pairs near_pairs(int segment, double start, double length, std::vector<double>* safe) const {
        const double middle = start + 0.5 * length, best = static_cast<double>(best_) + margin();
        const Place at_a = place(bodies_.path_a[segment], middle), at_b = place(bodies_.path_b[segment], middle);
        std::vector<Vector3> centers;
        for (const Element& e : elements_b_)
            centers.push_back((at_b.rotation * e.center.cast<Real>() + at_b.position - at_a.position).cast<double>());
        Pairs pairs;
        for (int i = 0; i < count_of(elements_a_); ++i) {
            const Element& a = elements_a_[i];
            const Vector3 center = (at_a.rotation * a.center.cast<Real>()).cast<double>();
            for (int j = 0; j < count_of(elements_b_); ++j) {
                const Element& b = elements_b_[j];
                double* until =
                    safe != nullptr ? &(*safe)[static_cast<std::size_t>(i) * elements_b_.size() + static_cast<std::size_t>(j)] : nullptr;
                if (until != nullptr && *until >= start + length) continue;
                const double speed = rate(segment, a, b) * (1 + 1e-6) + 1e-30;
                double room = (center - centers[j]).norm() - a.radius - b.radius - best;
                if (room <= 0.5 * length * speed && best < 1e29)
                    room = static_cast<double>(
                               element_distance(corners(at_a, bodies_.a.mesh, a.vertices), corners(at_b, bodies_.b.mesh, b.vertices))) -
                           best;
                if (room <= 0.5 * length * speed)
                    pairs.push_back({i, j});
                else if (until != nullptr)
                    *until = middle + room / speed;
            }
        }
        return pairs;
    }

    void sample_block(int segment, Real start, Real step, int count, const Pairs& pairs) {
        std::vector<Place> at_a, at_b;
        for (int k = 0; k <= count; ++k) {
            at_a.push_back(place(bodies_.path_a[segment], start + k * step));
            at_b.push_back(place(bodies_.path_b[segment], start + k * step));
        }
        for (const auto& [i, j] : pairs) {
            const Element &a = elements_a_[i], &b = elements_b_[j];
            const double per_step = rate(segment, a, b) * static_cast<double>(step) * (1 + 1e-6) + 1e-30;
            for (int k = 0; k <= count;) {
                const Real d = element_distance(corners(at_a[k], bodies_.a.mesh, a.vertices), corners(at_b[k], bodies_.b.mesh, b.vertices));
                best_ = std::min(best_, d);
                k += 1 + static_cast<int>(std::clamp((static_cast<double>(d - best_) - margin()) / per_step - 1, 0.0, 1e8));
            }
        }
    }

    void look_at_middle(int segment, double s) { take(segment, s, near_pairs(segment, s, 0, nullptr)); }

    void take(int segment, Real s, const Pairs& pairs) {
        const Place at_a = place(bodies_.path_a[segment], s), at_b = place(bodies_.path_b[segment], s);
        int placed = -1;
        Corners3 x;
        for (const auto& [i, j] : pairs) {
            const Element &a = elements_a_[i], &b = elements_b_[j];
            if (placed != i) x = corners(at_a, bodies_.a.mesh, a.vertices);
            placed = i;
            best_ = std::min(best_, element_distance(x, corners(at_b, bodies_.b.mesh, b.vertices)));
        }
    }

    const MovingBodies& bodies_;
    std::vector<Element> elements_a_, elements_b_;
    Real best_ = 1e30L;
    long taken_ = 0;
};

}  // namespace fettle::tests::clearance
