// SPDX-License-Identifier: MIT
#include "core/scene/inertial.hpp"

#include <cmath>
#include <sstream>

#include "core/linear/factorisations.hpp"

namespace fettle::core::scene {
namespace {

constexpr double rounding = 1e-6;  // of the trace

// S: positive semi-definite where no principal moment exceeds the sum of the others.
Matrix3 spread_of(const Matrix3& inertia) { return 0.5 * inertia.trace() * Matrix3::Identity() - inertia; }

}  // namespace

std::string fault_of(const Inertial& inertial) {
    const Matrix3& j = inertial.inertia;
    if (!(inertial.mass > 0) || !std::isfinite(inertial.mass)) return "the mass is not a finite number above 0";
    if (!inertial.centre.allFinite() || !j.allFinite()) return "a number of the centre or of the inertia is not finite";
    const double size = j.trace();
    if (!(size > 0) || !((j - j.transpose()).cwiseAbs().maxCoeff() <= rounding * size))
        return "the inertia is not a symmetric matrix with positive moments about its axes";
    const Vector3 moments = linear::symmetric_eigenvalues<3>(j);
    std::ostringstream found;
    found << "; the principal moments are " << moments[0] << ", " << moments[1] << " and " << moments[2] << " kg m^2";
    if (!(moments[0] > 0)) return "the inertia is not positive definite" + found.str();
    if (!(moments[2] <= moments[0] + moments[1] + rounding * size))
        return "a principal moment of inertia is more than the sum of the other two, which no body has" + found.str();
    return {};
}

Matrix4 moments_about(const Inertial& inertial, const Vector3& c) {
    const Matrix3 symmetric = 0.5 * (inertial.inertia + inertial.inertia.transpose());
    Matrix3 spread = spread_of(symmetric);
    const linear::SymmetricEigen<3> eigen = linear::symmetric_eigen<3>(spread);
    if (eigen.values[0] < 0) spread = eigen.vectors * eigen.values.cwiseMax(0).asDiagonal() * eigen.vectors.transpose();
    const Vector3 r = inertial.centre - c;
    Matrix4 moments;
    moments << spread + inertial.mass * r * r.transpose(), inertial.mass * r, inertial.mass * r.transpose(), inertial.mass;
    return moments;
}

Inertial inertial_of(const Matrix4& moments) {
    Inertial out;
    out.mass = moments(3, 3);
    out.centre = moments.topRightCorner<3, 1>() / out.mass;
    const Matrix3 spread = moments.topLeftCorner<3, 3>() - out.mass * out.centre * out.centre.transpose();
    out.inertia = spread.trace() * Matrix3::Identity() - spread;
    return out;
}

}  // namespace fettle::core::scene
