// SPDX-License-Identifier: MIT
/// Puts solids together from chains of points and faces between them.
#pragma once

#include <algorithm>
#include <vector>

#include "core/parts/solid.hpp"

namespace fettle::core::parts {

class SolidBuilder {
public:
    int add_vertex(const Point3& p) {
        solid_.vertices.push_back(p);
        return count_of(solid_.vertices) - 1;
    }

    int add_surface(Surface surface) {
        solid_.surfaces.push_back(std::move(surface));
        return count_of(solid_.surfaces) - 1;
    }

    /// Counter-clockwise from outside. Triangles with two equal corners are left out.
    void add_triangle(int a, int b, int c, const Facet& facet) {
        if (a == b || b == c || c == a) return;
        solid_.triangles.push_back({a, b, c});
        solid_.facets.push_back(facet);
    }

    void add_triangle_facing(bool forward, int a, int b, int c, const Facet& facet) {
        if (forward)
            add_triangle(a, b, c, facet);
        else
            add_triangle(a, c, b, facet);
    }

    /// Between two chains of points that run the same way, `low` to the right of `high` as seen from outside when it runs to the right:
    /// points are joined where they are as far along, by their share of the way from first to last.
    void add_strip(const std::vector<int>& low, const std::vector<int>& high, const Facet& facet) {
        const std::vector<double> a = shares(low), b = shares(high);
        std::size_t i = 0, j = 0;
        while (i + 1 < low.size() || j + 1 < high.size()) {
            const bool along_low = j + 1 == high.size() || (i + 1 < low.size() && a[i + 1] <= b[j + 1]);
            if (along_low) {
                add_triangle(low[i], low[i + 1], high[j], facet);
                ++i;
            } else {
                add_triangle(low[i], high[j + 1], high[j], facet);
                ++j;
            }
        }
    }

    /// A bound of curves against their polygons: the whole part's is the largest.
    void add_deviation(double out, double in, bool proven = true) { solid_.deviation.add({out, in, proven, proven}); }

    /// Vertices stand so far from where they are drawn (Solid::rounding).
    void add_rounding(double distance) { solid_.rounding = std::max(solid_.rounding, distance); }

    const Point3& vertex(int k) const { return solid_.vertices[k]; }
    Solid take() { return std::move(solid_); }

private:
    std::vector<double> shares(const std::vector<int>& chain) const {
        std::vector<double> out{0};
        if (chain.size() <= 2) return chain.size() == 1 ? std::vector<double>{0} : std::vector<double>{0, 1};
        const Vector3 start = value(vertex(chain.front())), way = value(vertex(chain.back())) - start;
        for (std::size_t k = 1; k + 1 < chain.size(); ++k)
            out.push_back((value(vertex(chain[k])) - start).dot(way) / std::max(way.squaredNorm(), 1e-300));
        out.push_back(1);
        return out;
    }

    Solid solid_;
};

}  // namespace fettle::core::parts
