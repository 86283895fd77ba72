// SPDX-License-Identifier: MIT
/// Along which vector two elements are best kept apart over a box of tolerances (toleranced_search.hpp).
#pragma once

#include <span>

#include "core/certificate/toleranced_prover.hpp"
#include "core/clearance/element_pair.hpp"

namespace fettle::core::clearance {

/// All differences x_a(t) - x_b(t) of the vertices of two elements, as far as they are linear in t, in b's frame.
class DifferenceHull {
public:
    DifferenceHull(const certificate::PlacedPair& at, std::span<const int> a, std::span<const int> b, int variables);

    /// The vector along which they are furthest from the origin, of length 1; zero if their hull is found to hold it.
    /// @param first  where to begin. @param tolerance  how well the hull's distance is to be known [m]
    Vector3 direction(const Vector3& first, double tolerance);
    /// The corner of the box of t, entries -1 and 1, that supports them along the last direction.
    const certificate::VariableBox::Values& corner() const { return corner_; }

private:
    struct Difference {
        Vector3 center;
        std::array<Vector3, certificate::most_variables> slopes;
    };
    Vector3 support(const Vector3& n);

    std::vector<Difference> differences_;
    std::size_t variables_;
    certificate::VariableBox::Values corner_{};
};

}  // namespace fettle::core::clearance
