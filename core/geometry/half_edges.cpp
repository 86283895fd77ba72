// SPDX-License-Identifier: MIT
#include "fettle/core/geometry/half_edges.hpp"

#include <algorithm>
#include <tuple>

namespace fettle::core::geometry {

std::vector<HalfEdge> sorted_half_edges(const Mesh& mesh) {
    std::vector<HalfEdge> halves;
    halves.reserve(3 * mesh.triangles.size());
    for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
        for (std::size_t k = 0; k < 3; ++k) {
            const int a = mesh.triangles[static_cast<std::size_t>(t)][k], b = mesh.triangles[static_cast<std::size_t>(t)][(k + 1) % 3];
            halves.push_back({std::min(a, b), std::max(a, b), a < b, t});
        }
    }
    std::sort(halves.begin(), halves.end(), [](const HalfEdge& a, const HalfEdge& b) {
        return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
    });
    return halves;
}

}  // namespace fettle::core::geometry
