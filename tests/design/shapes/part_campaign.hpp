// SPDX-License-Identifier: MIT
/// What a part of the library must stand at random dimensions. Each check returns what is wrong with the part, empty if nothing.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "core/geometry/distance.hpp"
#include "core/part_files/part_file.hpp"
#include "core/solids/point_in_solid.hpp"

namespace fettle::design::shapes::part_campaign {

using core::part_files::PartFile;
using core::parts::DrawnPart;
using Values = std::vector<double>;

inline Values defaults(const PartFile& file) {
    Values out;
    for (const auto& dimension : file.dimensions()) out.push_back(dimension.value);
    return out;
}

/// Dimensions about the defaults, from 0.6 to 1.4 times of each, that the relations allow; of 0 from -0.4 to 0.4 (of a length: mm).
/// Empty: 100 tries found none.
inline Values random_values(const PartFile& file, std::mt19937& random) {
    std::uniform_real_distribution<double> factor(0.6, 1.4);
    for (int trial = 0; trial < 100; ++trial) {
        Values values = defaults(file);
        for (std::size_t k = 0; k < values.size(); ++k) {
            const bool length = file.dimensions()[k].kind == core::part_files::PartDimensionKind::coordinate;
            values[k] = values[k] == 0 ? (factor(random) - 1) * (length ? 1e-3 : 1) : values[k] * factor(random);
        }
        if (file.faults(values).empty()) return values;
    }
    return {};
}

/// Compares the Jacobian with central differences, where the triangles are the same on either side: with the best of three steps, for
/// differences of short ones show the rounding of the vertices, and those of long ones curvature. @param compared  Counts columns that were
/// compared.
inline std::string jacobian_fault(const PartFile& file, const Values& values, const DrawnPart& part, int& compared) {
    for (std::size_t k = 0; k < values.size(); ++k) {
        const std::string& name = file.dimensions()[k].name;
        double least = std::numeric_limits<double>::infinity();
        bool same = true;
        for (const double share : {1e-5, 1e-4, 1e-3}) {
            const double step = std::max(1e-8, share * std::abs(values[k]));
            Values low = values, high = values;
            low[k] -= step;
            high[k] += step;
            const auto below = file.drawn(low, {}, part.structure, {.jacobian = false, .check = false}),
                       above = file.drawn(high, {}, part.structure, {.jacobian = false, .check = false});
            same = below && above && below->changes.empty() && above->changes.empty();
            if (!same) break;
            if (below->mesh.vertices.cols() != part.mesh.vertices.cols() || above->mesh.vertices.cols() != part.mesh.vertices.cols())
                return name + ": other vertices, and no change is reported";
            const Matrix3X difference = (above->mesh.vertices - below->mesh.vertices) / (2 * step);
            least = std::min(least, (difference - part.jacobian[k]).cwiseAbs().maxCoeff());
            if (least < 1e-7 * (1 + part.jacobian[k].cwiseAbs().maxCoeff())) break;
        }
        if (least < 1e-7 * (1 + part.jacobian[k].cwiseAbs().maxCoeff())) {
            ++compared;
            continue;
        }
        if (same) return name + ": the Jacobian is off by " + std::to_string(least * 1e6) + "e-6";
    }
    return {};
}

/// Distances from one mesh: triangles whose sphere is farther than the nearest yet are left out.
class MeshDistance {
public:
    explicit MeshDistance(const core::geometry::Mesh& mesh) : mesh_(mesh) {
        for (const auto& t : mesh.triangles) {
            const Vector3 a = mesh.vertices.col(t[0]), b = mesh.vertices.col(t[1]), c = mesh.vertices.col(t[2]), middle = (a + b + c) / 3;
            middles_.push_back(middle);
            radii_.push_back(std::sqrt(std::max({(a - middle).squaredNorm(), (b - middle).squaredNorm(), (c - middle).squaredNorm()})));
        }
    }
    double operator()(const Vector3& p) const {
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < middles_.size(); ++i) {
            const double reach = least + radii_[i];
            if ((p - middles_[i]).squaredNorm() > reach * reach) continue;
            const auto& t = mesh_.triangles[i];
            least = std::min(least, std::sqrt(core::geometry::point_triangle_distance_squared(
                                        p, mesh_.vertices.col(t[0]), mesh_.vertices.col(t[1]), mesh_.vertices.col(t[2]))));
        }
        return least;
    }

private:
    const core::geometry::Mesh& mesh_;
    std::vector<Vector3> middles_;
    std::vector<double> radii_;
};

/// Compares the deviations with samples. The true part is drawn again, five times as finely if that can be, with its vertices on the true
/// surfaces: that drawing is off by its own deviation at most. @param samples  How many of either kind: vertices of the fine mesh, points
/// of the part's triangles.
inline std::string deviation_fault(const PartFile& file, const Values& values, const DrawnPart& part, int samples, std::mt19937& random) {
    core::parts::Facets facets;
    facets.lean = core::parts::Lean::through;
    const int segments = facets.segments;
    Result<DrawnPart> fine = Error{};
    for (const int times : {5, 2, 1}) {  // long threads would have too many facets
        facets.segments = times * segments;
        fine = file.drawn(values, facets, {}, {.jacobian = false, .check = false});
        if (fine) break;
    }
    if (!fine) return "cannot be drawn finely: " + fine.errors().front().message;
    const auto farthest = [](const Vector3& p, const core::geometry::Mesh& mesh, const MeshDistance& distance, double allowed) {
        const double d = distance(p);
        return d > allowed && !core::solids::point_in_solid(p, mesh.vertices, mesh.triangles) ? d : 0;
    };
    const double rounding = 1e-12;
    const auto said = [](const char* what, double found, double allowed) {
        return std::string(what) + " by " + std::to_string(found * 1e6) + " um, more than " + std::to_string(allowed * 1e6);
    };
    const MeshDistance to_part(part.mesh), to_fine(fine->mesh);
    std::uniform_real_distribution<double> uniform;
    for (int k = 0; k < samples; ++k) {
        const Eigen::Index v = std::uniform_int_distribution<Eigen::Index>(0, fine->mesh.vertices.cols() - 1)(random);
        const double allowed = part.deviation.out + fine->deviation.in + rounding;
        const double out = farthest(fine->mesh.vertices.col(v), part.mesh, to_part, allowed);
        if (out > allowed) return said("the part is outside of its mesh", out, allowed);
    }
    for (int k = 0; k < samples; ++k) {
        const auto& t = part.mesh.triangles[std::uniform_int_distribution<std::size_t>(0, part.mesh.triangles.size() - 1)(random)];
        double a = uniform(random), b = uniform(random);
        if (a + b > 1) {
            a = 1 - a;
            b = 1 - b;
        }
        if (k % 4 == 0) a = b = 0;  // a corner: the farthest, where the mesh covers the part
        const Vector3 p = part.mesh.vertices.col(t[0]) * (1 - a - b) + part.mesh.vertices.col(t[1]) * a + part.mesh.vertices.col(t[2]) * b;
        const double allowed = part.deviation.in + fine->deviation.out + rounding;
        const double in = farthest(p, fine->mesh, to_fine, allowed);
        if (in > allowed) return said("the mesh is outside of the part", in, allowed);
    }
    return {};
}

}  // namespace fettle::design::shapes::part_campaign
