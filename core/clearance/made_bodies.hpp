// SPDX-License-Identifier: MIT
/// Bodies as made (certificate/toleranced.hpp) with one set of deviations, in doubles: where samples and witnesses are.
#pragma once

#include <vector>

#include "core/certificate/toleranced.hpp"
#include "core/geometry/mesh.hpp"
#include "core/kinematics/path.hpp"

namespace fettle::core::clearance {

class MadeBodies {
public:
    /// @param deviations  One for each of the list [SI]. Contract: `toleranced` is checked, and outlives this.
    MadeBodies(const certificate::Toleranced& toleranced, const std::vector<double>& deviations);

    /// In the world. @param coordinates  One for each of the list.
    kinematics::Pose pose(int body, const std::vector<double>& coordinates) const;
    /// In the body's frame; those of `mesh` where it has no formulas.
    Matrix3X vertices(int body, const Matrix3X& mesh) const;
    Vector3 vertex(int body, const Matrix3X& mesh, int index) const;

private:
    Vector3 point(const certificate::NodePoint& nodes) const { return {values_[nodes[0]], values_[nodes[1]], values_[nodes[2]]}; }

    const certificate::Toleranced& toleranced_;
    std::vector<double> values_;
};

/// Where the meshes at hand are.
std::vector<double> base_deviations(const certificate::Toleranced& toleranced);
std::vector<double> start_coordinates(const certificate::Toleranced& toleranced);

}  // namespace fettle::core::clearance
