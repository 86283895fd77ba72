// SPDX-License-Identifier: MIT
#include "core/features/fit_surface.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <array>
#include <cmath>

namespace fettle::core::features {

namespace {

using Matrix3 = Eigen::Matrix3d;

Vector3 mean_of(const std::vector<Vector3>& points) {
    Vector3 sum = Vector3::Zero();
    for (const Vector3& x : points) sum += x;
    return sum / static_cast<double>(std::max<std::size_t>(points.size(), 1));
}

Vector3 least_direction(const Matrix3& covariance) {
    Eigen::SelfAdjointEigenSolver<Matrix3> solver;
    solver.computeDirect(covariance);
    const Vector3 direct = solver.eigenvectors().col(0);
    return std::isfinite(direct.sum()) && direct.norm() > 0.5 ? direct.normalized() : Vector3::UnitZ();
}

// a x^2 + b x: least squares of |x|^2 = 2 c x + k, the circle's and the sphere's.
template <int N>
bool algebraic_ball(const std::vector<Eigen::Matrix<double, N, 1>>& points, Eigen::Matrix<double, N, 1>& centre, double& radius) {
    using Point = Eigen::Matrix<double, N, 1>;
    if (points.size() < N + 1) return false;
    Point mean = Point::Zero();
    for (const Point& x : points) mean += x;
    mean /= static_cast<double>(points.size());
    Eigen::Matrix<double, N, N> matrix = Eigen::Matrix<double, N, N>::Zero();
    Point right = Point::Zero();
    double square = 0;
    for (const Point& x : points) square += (x - mean).squaredNorm();
    square /= static_cast<double>(points.size());
    for (const Point& x : points) {
        const Point d = x - mean;
        matrix += d * d.transpose();
        right += 0.5 * (d.squaredNorm() - square) * d;
    }
    const Eigen::FullPivLU<Eigen::Matrix<double, N, N>> lu(matrix);
    if (lu.rank() < N) return false;
    const Point from = lu.solve(right);
    centre = mean + from;
    radius = std::sqrt(square + from.squaredNorm());
    return std::isfinite(radius) && radius > 0;
}

std::optional<Surface> near_plane(const SurfaceSamples& samples) {
    Surface out;
    out.point = mean_of(samples.points);
    Matrix3 covariance = Matrix3::Zero();
    for (const Vector3& x : samples.points) covariance += (x - out.point) * (x - out.point).transpose();
    out.axis = least_direction(covariance);
    return out;
}

std::optional<Surface> near_sphere(const SurfaceSamples& samples) {
    Surface out;
    out.kind = SurfaceKind::sphere;
    if (!algebraic_ball<3>(samples.points, out.point, out.radius)) return std::nullopt;
    return out;
}

std::optional<Surface> near_cylinder(const SurfaceSamples& samples) {
    Matrix3 covariance = Matrix3::Zero();
    for (std::size_t i = 0; i < samples.normals.size(); ++i)
        covariance += samples.weights[i] * samples.normals[i] * samples.normals[i].transpose();
    Surface out;
    out.kind = SurfaceKind::cylinder;
    out.axis = least_direction(covariance);
    const auto [u, v] = across_of(out.axis);
    std::vector<Vector2> seen;
    for (const Vector3& x : samples.points) seen.emplace_back(x.dot(u), x.dot(v));
    Vector2 centre;
    if (!algebraic_ball<2>(seen, centre, out.radius)) return std::nullopt;
    out.point = centre.x() * u + centre.y() * v;
    out.point += out.axis.dot(mean_of(samples.points)) * out.axis;
    return out;
}

std::optional<Surface> near_cone(const SurfaceSamples& samples) {
    Vector3 mean = Vector3::Zero();
    double weight = 0;
    for (std::size_t i = 0; i < samples.normals.size(); ++i) {
        mean += samples.weights[i] * samples.normals[i];
        weight += samples.weights[i];
    }
    mean /= weight;
    const Vector3 middle = mean_of(samples.points);
    Matrix3 covariance = Matrix3::Zero(), planes = Matrix3::Zero();
    Vector3 right = Vector3::Zero();
    for (std::size_t i = 0; i < samples.normals.size(); ++i) {
        const Vector3 n = samples.normals[i], d = n - mean;
        covariance += samples.weights[i] * d * d.transpose();
        planes += samples.weights[i] * n * n.transpose();
        right += samples.weights[i] * n.dot(samples.centres[i] - middle) * n;
    }
    Surface out;
    out.kind = SurfaceKind::cone;
    out.axis = least_direction(covariance);
    const Eigen::FullPivLU<Matrix3> lu(planes);
    if (!lu.isInvertible()) return std::nullopt;
    const Vector3 apex = middle + lu.solve(right);
    if (out.axis.dot(middle - apex) < 0) out.axis = -out.axis;
    const double z = out.axis.dot(middle - apex);
    double rho = 0, along = 0;
    for (const Vector3& x : samples.points) {
        const double at = out.axis.dot(x - apex);
        along += at;
        rho += (x - apex - at * out.axis).norm();
    }
    if (!(along > 0)) return std::nullopt;
    out.slope = rho / along;
    out.point = apex + z * out.axis;
    out.radius = out.slope * z;
    return out;
}

std::optional<Surface> near_torus(const SurfaceSamples& samples) {
    using Matrix6 = Eigen::Matrix<double, 6, 6>;
    using Vector6 = Eigen::Matrix<double, 6, 1>;
    const Vector3 middle = mean_of(samples.points);
    double scale = 0;
    for (const Vector3& x : samples.points) scale = std::max(scale, (x - middle).norm());
    if (!(scale > 0)) return std::nullopt;
    Matrix6 matrix = Matrix6::Zero();
    for (std::size_t i = 0; i < samples.normals.size(); ++i) {
        Vector6 line;
        line << samples.normals[i], (samples.centres[i] - middle).cross(samples.normals[i]) / scale;
        matrix += samples.weights[i] * line * line.transpose();
    }
    const Eigen::SelfAdjointEigenSolver<Matrix6> solver(matrix);
    const Vector3 moment = solver.eigenvectors().col(0).head<3>();
    Vector3 direction = solver.eigenvectors().col(0).tail<3>();
    if (!(direction.norm() > 1e-6)) return std::nullopt;
    const double length = direction.norm();
    direction /= length;
    Surface out;
    out.kind = SurfaceKind::torus;
    out.axis = direction;
    out.point = middle + scale * direction.cross(moment / length);  // the line's point nearest to `middle`
    std::vector<Vector2> meridian;
    for (const Vector3& x : samples.points) {
        const double z = direction.dot(x - out.point);
        meridian.emplace_back((x - out.point - z * direction).norm(), z);
    }
    Vector2 centre;
    if (!algebraic_ball<2>(meridian, centre, out.slope)) return std::nullopt;
    out.radius = centre.x();
    out.point += centre.y() * direction;
    return out;
}

// The same surface about a place beside the points.
Surface beside(Surface surface, const Vector3& mean) {
    if (surface.kind != SurfaceKind::cylinder && surface.kind != SurfaceKind::cone) return surface;
    const double z = surface.axis.dot(mean - surface.point);
    surface.point += z * surface.axis;
    surface.radius += surface.slope * z;
    return surface;
}

double sum_of_squares(const Surface& surface, const std::vector<Vector3>& points) {
    double sum = 0;
    for (const Vector3& x : points) {
        const double d = signed_distance(surface, x);
        sum += d * d;
    }
    return sum;
}

bool is_sound(const Surface& surface) {
    const double sum = surface.point.sum() + surface.axis.sum() + surface.radius + surface.slope;
    if (!std::isfinite(sum)) return false;
    if (surface.kind == SurfaceKind::torus) return surface.slope > 0 && surface.radius > 0;
    return surface.kind == SurfaceKind::plane || surface.radius > 0;
}

// The normal equations of one Gauss-Newton step: the lower half of the matrix, row by row.
struct NormalEquations {
    std::array<double, 28> matrix{};
    std::array<double, 7> right{};

    void add(const SurfaceStep& row, double distance, int count) {
        int at = 0;
        for (int i = 0; i < count; ++i) {
            right[i] -= distance * row[i];
            for (int j = 0; j <= i; ++j) matrix[at++] += row[i] * row[j];
        }
    }
};

// The damped step, in which all numbers count alike: Cholesky of the matrix with a diagonal of ones, by hand for its size.
std::optional<SurfaceStep> solved(const NormalEquations& equations, double damping, int count) {
    std::array<std::array<double, 7>, 7> lower{};
    std::array<double, 7> scale{}, x{};
    const auto entry = [](int i, int j) { return i * (i + 1) / 2 + j; };
    for (int i = 0; i < count; ++i) scale[i] = equations.matrix[entry(i, i)] > 0 ? 1 / std::sqrt(equations.matrix[entry(i, i)]) : 1;
    for (int i = 0; i < count; ++i)
        for (int j = 0; j <= i; ++j) {
            double sum = equations.matrix[entry(i, j)] * scale[i] * scale[j] + (i == j ? damping : 0);
            for (int k = 0; k < j; ++k) sum -= lower[i][k] * lower[j][k];
            if (i == j && !(sum > 1e-15)) return std::nullopt;
            lower[i][j] = i == j ? std::sqrt(sum) : sum / lower[j][j];
        }
    for (int i = 0; i < count; ++i) {
        x[i] = equations.right[i] * scale[i];
        for (int k = 0; k < i; ++k) x[i] -= lower[i][k] * x[k];
        x[i] /= lower[i][i];
    }
    for (int i = count - 1; i >= 0; --i) {
        for (int k = i + 1; k < count; ++k) x[i] -= lower[k][i] * x[k];
        x[i] /= lower[i][i];
    }
    SurfaceStep out(count);
    for (int i = 0; i < count; ++i) out[i] = x[i] * scale[i];
    return out;
}

}  // namespace

std::optional<Surface> near_surface(SurfaceKind kind, const SurfaceSamples& samples) {
    switch (kind) {
        case SurfaceKind::plane:
            return near_plane(samples);
        case SurfaceKind::cylinder:
            return near_cylinder(samples);
        case SurfaceKind::cone:
            return near_cone(samples);
        case SurfaceKind::sphere:
            return near_sphere(samples);
        case SurfaceKind::torus:
            return near_torus(samples);
        default:
            return std::nullopt;
    }
}

std::optional<Surface> fitted_surface(const Surface& start, const std::vector<Vector3>& points, double hopeless) {
    const int count = parameter_count(start.kind);
    if (count_of(points) < count) return std::nullopt;
    const Vector3 mean = mean_of(points);
    Surface surface = beside(start, mean);
    double sum = sum_of_squares(surface, points), damping = 1e-9;
    constexpr int most_steps = 40;
    constexpr double enough = 1e-9;  // of the sum of squares
    for (int step = 0; step < most_steps && is_sound(surface); ++step) {
        NormalEquations equations;
        for (const Vector3& x : points) equations.add(distance_gradient(surface, x), signed_distance(surface, x), count);
        bool is_better = false;
        const double before = sum;
        for (int attempt = 0; attempt < 6 && !is_better; ++attempt) {
            const std::optional<SurfaceStep> by = solved(equations, damping, count);
            const Surface next = by ? beside(moved(surface, *by), mean) : surface;
            const double next_sum = by && is_sound(next) ? sum_of_squares(next, points) : sum;
            is_better = next_sum < sum;
            if (is_better) {
                surface = next;
                sum = next_sum;
            }
            damping = is_better ? std::max(1e-12, 0.1 * damping) : 100 * damping;
        }
        if (hopeless > 0 && sum > 0.25 * before && sum > hopeless * hopeless * static_cast<double>(points.size())) return std::nullopt;
        if (!is_better || before - sum <= enough * before) break;
    }
    return is_sound(surface) ? std::optional(surface) : std::nullopt;
}

}  // namespace fettle::core::features
