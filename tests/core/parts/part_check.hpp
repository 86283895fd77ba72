// SPDX-License-Identifier: MIT
/// The test that every part must stand: a valid solid, and a Jacobian that agrees with differences.
#pragma once

#include <catch2/catch.hpp>
#include <functional>
#include <vector>

#include "core/geometry/mass_moments.hpp"
#include "core/parts/drawn_part.hpp"
#include "tests/support/derivative_check.hpp"
#include "tests/support/solid_oracle.hpp"

namespace fettle::core::parts::part_check {

using PartFunction = std::function<Result<Solid>(Drawing&, const std::vector<Number>&)>;

inline Result<DrawnPart> draw(const PartFunction& part, const std::vector<double>& dimensions, const Facets& facets = {},
                              const Structure& kept = {}, const DrawnOptions& options = {}) {
    Drawing drawing(facets, kept);
    std::vector<Number> numbers;
    for (const double d : dimensions) numbers.push_back(drawing.dimension(d));
    const Result<Solid> solid = part(drawing, numbers);
    if (!solid) return solid.errors();
    return drawn(drawing, *solid, "part", options);
}

inline std::string told(const Errors& errors) {
    std::string out;
    for (const Error& error : errors) out += error.where + ": " + error.message + "\n";
    return out;
}

/// Draws it, checks it, and returns it. Differences are over steps of the dimensions' own size.
inline DrawnPart checked(const PartFunction& part, const std::vector<double>& dimensions, const Facets& facets = {},
                         double tolerance = 1e-7) {
    const auto drawn_part = draw(part, dimensions, facets);
    INFO(told(drawn_part.errors()));
    REQUIRE(drawn_part);
    CHECK(tests::support::fault_of_solid(drawn_part->mesh) == "");
    const auto n = static_cast<Eigen::Index>(dimensions.size());
    const Eigen::Index rows = drawn_part->mesh.vertices.size();
    MatrixX jacobian(rows, n);
    for (Eigen::Index k = 0; k < n; ++k) {
        const Matrix3X& column = drawn_part->jacobian[k];
        jacobian.col(k) = Eigen::Map<const VectorX>(column.data(), rows) * dimensions[k];
    }
    const auto vertices = [&](const VectorX& shares) -> VectorX {
        std::vector<double> at = dimensions;
        for (std::size_t k = 0; k < at.size(); ++k) at[k] *= 1 + shares[k];
        const auto other = draw(part, at, facets, drawn_part->structure, {false, false});
        if (!other || other->mesh.vertices.size() != rows) return VectorX::Constant(rows, NAN);
        return Eigen::Map<const VectorX>(other->mesh.vertices.data(), rows);
    };
    if (n > 0) {
        const auto check = tests::support::check_jacobian(vertices, VectorX::Zero(n), jacobian, {1e-3, 0.25, 9});
        INFO("dimension " << check.column << ", coordinate " << check.row << ": " << check.analytic << " against " << check.difference
                          << " at step " << check.step);
        CHECK(check.relative_error < tolerance);
    }
    return *drawn_part;
}

inline double volume(const DrawnPart& part) { return geometry::solid_moments(part.mesh.vertices, part.mesh.triangles)(3, 3); }

}  // namespace fettle::core::parts::part_check
