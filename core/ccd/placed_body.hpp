// SPDX-License-Identifier: MIT
/// Vertices and elements of a body at both ends of its segment: those that a search for candidates has looked at, each placed once.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "fettle/core/ccd/four_separations.hpp"
#include "fettle/core/ccd/swept_pair.hpp"

namespace fettle::core::ccd {

/// Axis-aligned, of places at both ends; the last of four numbers is on no axis.
struct SweptBox {
    static constexpr double nowhere = -1e300;
    std::array<double, 4> low{nowhere, nowhere, nowhere, nowhere}, minus_high = low;

    [[gnu::always_inline]] bool is_apart(const SweptBox& other, double margin) const {
        base::Four l, h, other_l, other_h;
        base::load(low.data(), l);
        base::load(minus_high.data(), h);
        base::load(other.low.data(), other_l);
        base::load(other.minus_high.data(), other_h);
        const auto is_along = (l + other_h > margin) | (other_l + h > margin);
        return (is_along[0] | is_along[1] | is_along[2] | is_along[3]) != 0;
    }
    SweptBox joined(const SweptBox& other) const {
        SweptBox out;
        for (std::size_t k = 0; k < 4; ++k) {
            out.low[k] = std::min(low[k], other.low[k]);
            out.minus_high[k] = std::min(minus_high[k], other.minus_high[k]);
        }
        return out;
    }
};

struct PlacedVertex {
    SweptVertex x;
    SweptBox box;
};

struct PlacedEdge {
    int edge;                 ///< into the mesh's
    std::array<int, 2> ends;  ///< placed vertices
    SweptBox box;
};

struct PlacedElement {
    int element = 0;             ///< into BodyHierarchy::elements()
    std::array<int, 3> corners;  ///< placed vertices, as in BodyHierarchy::faces(): of edges and points repeated to three
    SweptBox box;
    int details = -1;  ///< among those made; -1: not made
};

/// What is asked of elements whose boxes are near another's.
struct PlacedDetails {
    Vector3 normal;  ///< at the start, of length at most 1: separations along it are no more than they are; zero: it has none
    int edge_count = 0;
    std::array<PlacedEdge, 3> edges;  ///< those of HierarchyElement::owned_edges that are looked at
};

class PlacedBody {
public:
    /// Forgets what was placed, in the time that it took to place it.
    /// @param origin  what positions are relative to, at each end
    /// @param plane   where the body's plane edges are left out (plane_edges.hpp); null: nowhere
    void start(const SweptBody& body, const std::array<Vector3, 2>& origin, const geometry::FlatFeatures* plane);

    /// Number of an element of the hierarchy among those placed, which now it is.
    int place(int element) {
        int& at = element_at_[element];
        return at >= 0 ? at : at = place_element(element);
    }
    const PlacedElement& element(int i) const { return elements_[i]; }
    /// Makes them if they are not there. They stay where they are until the next is made.
    const PlacedDetails& details(int i) {
        const int at = elements_[i].details;
        return details_[at >= 0 ? at : make_details(i)];
    }
    const PlacedVertex& vertex(int i) const { return vertices_[i]; }

private:
    int place_element(int element);
    int place_vertex(int vertex);
    int make_details(int i);

    const SweptBody* body_ = nullptr;
    const geometry::FlatFeatures* plane_ = nullptr;
    std::array<Vector3, 2> origin_;
    std::vector<int> element_at_, vertex_at_;  // by their number in the body: among those placed; -1: not placed
    std::vector<PlacedElement> elements_;
    std::vector<PlacedDetails> details_;
    std::vector<PlacedVertex> vertices_;
    std::vector<int> placed_vertices_;  // their numbers in the body
};

}  // namespace fettle::core::ccd
