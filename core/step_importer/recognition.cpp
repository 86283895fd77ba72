// SPDX-License-Identifier: MIT
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "core/step_importer/surface_bound.hpp"

namespace fettle::core::step_importer {
namespace {

using Kind = SurfaceShape::Kind;

double binomial(int n, int k) {
    double out = 1;
    for (int i = 1; i <= k; ++i) out *= static_cast<double>(n - k + i) / i;
    return out;
}

/// Weights of products of Bernstein polynomials of one degree: of i and j in i + j.
double product_weight(int degree, int i, int j) { return binomial(degree, i) * binomial(degree, j) / binomial(2 * degree, i + j); }

/// The largest Bernstein coefficient, in absolute value, of the quadratic form f . f - r^2 w^2 over a piece.
/// @param f  what a pole's place, relative to the candidate, is measured by: (w f, w)
template <class Form>
double largest_coefficient(const BezierPatch& piece, double radius, const Form& form) {
    const int p = piece.u_degree, q = piece.v_degree;
    std::vector<Pole> poles;
    for (const Pole& pole : piece.poles) poles.push_back(form(pole));
    std::vector<double> sums(static_cast<std::size_t>((2 * p + 1) * (2 * q + 1)), 0);
    for (int i = 0; i <= p; ++i)
        for (int j = 0; j <= q; ++j)
            for (int k = 0; k <= p; ++k)
                for (int l = 0; l <= q; ++l) {
                    const Pole &a = poles[i * (q + 1) + j], &b = poles[k * (q + 1) + l];
                    sums[(i + k) * (2 * q + 1) + j + l] +=
                        product_weight(p, i, k) * product_weight(q, j, l) * (a.head<3>().dot(b.head<3>()) - radius * radius * a[3] * b[3]);
                }
    double most = 0;
    for (const double sum : sums) most = std::max(most, std::abs(sum));
    return most;
}

double least_weight(const BezierPatch& piece) {
    double least = piece.poles[0][3];
    for (const Pole& pole : piece.poles) least = std::min(least, pole[3]);
    return least;
}

/// | |f| - r | <= |f^2 - r^2| / r over the grid.
template <class Form>
double off_radius(const PatchGrid& grid, double radius, const Form& form) {
    double most = 0;
    for (const BezierPatch& piece : grid.pieces)
        most = std::max(most, largest_coefficient(piece, radius, form) / (least_weight(piece) * least_weight(piece) * radius));
    return most;
}

double off_plane(const PatchGrid& grid, const Vector3d& point, const Vector3d& normal) {
    double most = 0;
    for (const BezierPatch& piece : grid.pieces)
        for (const Pole& pole : piece.poles) most = std::max(most, std::abs((pole.head<3>() / pole[3] - point).dot(normal)));
    return most;
}

}  // namespace

void recognise(SurfaceShape& surface, const std::vector<Vector3d>& places, const std::vector<Vector3d>& normals, double tolerance) {
    if (surface.kind != Kind::spline || places.size() < 4) return;
    const auto take = [&](Kind kind, const Vector3d& point, const Vector3d& axis, double radius, double within) {
        if (!(within <= tolerance)) return false;
        surface.kind = kind, surface.point = point, surface.axis = axis, surface.radius = radius;
        surface.is_recognised = true;
        surface.recognised_within = within;
        return true;
    };
    Vector3d axis = Vector3d::Zero();
    for (const Vector3d& normal : normals)
        if (const Vector3d cross = normals[0].cross(normal); cross.norm() > axis.norm()) axis = cross;
    if (axis.norm() < 1e-6) {
        take(Kind::plane, places[0], normals[0], 0, off_plane(surface.grid, places[0], normals[0]));
        return;
    }
    axis.normalize();
    // Places less their normals times r are the axis' or the centre: least squares in it and r.
    const auto fitted = [&](const Eigen::Matrix3d& across) {
        const auto rows = static_cast<Eigen::Index>(3 * places.size());
        Eigen::MatrixXd a(rows, 4);
        Eigen::VectorXd b(rows);
        for (std::size_t i = 0; i < places.size(); ++i) {
            const auto at = static_cast<Eigen::Index>(3 * i);
            a.block<3, 3>(at, 0) = across;
            a.block<3, 1>(at, 3) = across * normals[i];
            b.segment<3>(at) = across * (places[i] - places[0]);
        }
        return Eigen::Vector4d(a.completeOrthogonalDecomposition().solve(b));
    };
    const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - axis * axis.transpose();
    for (const bool is_sphere : {false, true}) {
        const Eigen::Matrix3d kept = is_sphere ? Eigen::Matrix3d::Identity() : across;
        const Eigen::Vector4d fit = fitted(kept);
        const Vector3d point = places[0] + fit.head<3>();
        const double radius = std::abs(fit[3]);
        if (!(radius > 0) || !(radius < 1e7)) continue;
        const auto form = [&](const Pole& pole) {
            Pole out;
            out << kept * (pole.head<3>() - pole[3] * point), pole[3];
            return out;
        };
        if (take(is_sphere ? Kind::sphere : Kind::cylinder, point, axis, radius, off_radius(surface.grid, radius, form))) return;
    }
}

}  // namespace fettle::core::step_importer
