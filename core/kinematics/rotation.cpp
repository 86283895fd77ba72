// SPDX-License-Identifier: MIT
#include "core/kinematics/rotation.hpp"

#include <cmath>
#include <cstddef>

#include "core/base/contract.hpp"

namespace fettle::core::kinematics {

namespace {

constexpr int term_count = 14;
/// Below |theta|^2 = 1 the value's series is as accurate as trigonometric functions and cheaper.
constexpr double value_series_limit = 1.0;
/// The closed forms of the derivatives' coefficients cancel: at |theta| = 2 they still lose less than a factor of 4.
constexpr double derivative_series_limit = 4.0;

using Series = std::array<double, term_count>;

constexpr double factorial(int n) {
    double f = 1;
    for (int i = 2; i <= n; ++i) f *= i;
    return f;
}

/// Coefficients in z = x^2 of the `derivatives`-th application of f -> f'(x)/x to sum_k (-1)^k x^(2k) / (2k + offset)!.
/// offset 1: sinc, g, h.  offset 2: (1 - cos x)/x^2 and its own.  offset 3: (x - sin x)/x^3.
constexpr Series make_series(int offset, int derivatives) {
    Series series{};
    for (int i = 0; i < term_count; ++i) {
        const int k = i + derivatives;
        double factor = k % 2 == 0 ? 1 : -1;
        for (int d = 0; d < derivatives; ++d) factor *= 2 * (k - d);
        series[i] = factor / factorial(2 * k + offset);
    }
    return series;
}

constexpr Series sinc_series = make_series(1, 0);
constexpr Series g_series = make_series(1, 1);
constexpr Series h_series = make_series(1, 2);
constexpr Series b_series = make_series(2, 0);
constexpr Series b_g_series = make_series(2, 1);
constexpr Series b_h_series = make_series(2, 2);
constexpr Series c_series = make_series(3, 0);

/// Most turns of a step are small: up to here six terms leave less than 1e-20 of the first.
constexpr double few_terms_limit = 1.0 / 64;
constexpr int few_terms = 6;

template <int terms>
double sum_of(const Series& series, double z) {
    double sum = series[terms - 1];
    for (int i = terms - 2; i >= 0; --i) sum = series[i] + z * sum;
    return sum;
}

template <int terms>
double evaluate(const Series& series, double z) {
    return z <= few_terms_limit ? sum_of<few_terms>(series, z) : sum_of<terms>(series, z);
}

/// R = cosine I + a [theta] + b theta theta^T, and what differentiation makes of a and b: f_g = f'/x, f_h = f_g'/x.
struct Coefficients {
    double cosine, a, b, a_g, a_h, b_g, b_h;
};

struct ValueCoefficients {
    double cosine, a, b;
};

ValueCoefficients value_coefficients(double z) {
    if (z <= value_series_limit) {
        const double b = evaluate<9>(b_series, z);
        return {1 - z * b, evaluate<9>(sinc_series, z), b};
    }
    // Half angles: 1 - cos x does not cancel near 2 pi k.
    const double x = std::sqrt(z);
    const double s = std::sin(0.5 * x);
    const double c = std::cos(0.5 * x);
    return {(c - s) * (c + s), 2 * s * c / x, 2 * s * s / z};
}

Coefficients coefficients(double z) {
    const auto [cosine, a, b] = value_coefficients(z);
    if (z == 0) return {1, 1, 0.5, g_series[0], h_series[0], b_g_series[0], b_h_series[0]};
    if (z <= derivative_series_limit) {
        return {cosine,
                a,
                b,
                evaluate<term_count>(g_series, z),
                evaluate<term_count>(h_series, z),
                evaluate<term_count>(b_g_series, z),
                evaluate<term_count>(b_h_series, z)};
    }
    const double a_g = (cosine - a) / z;
    const double a_h = -(a + 3 * a_g) / z;
    const double b_g = (a - 2 * b) / z;
    const double b_h = (a_g - 4 * b_g) / z;
    return {cosine, a, b, a_g, a_h, b_g, b_h};
}

Matrix3 combine(double cosine, double a, double b, const Vector3& t) {
    const double ax = a * t.x(), ay = a * t.y(), az = a * t.z();
    const double bx = b * t.x(), by = b * t.y(), bz = b * t.z();
    const double xy = bx * t.y(), xz = bx * t.z(), yz = by * t.z();
    Matrix3 r;
    r(0, 0) = cosine + bx * t.x();
    r(1, 1) = cosine + by * t.y();
    r(2, 2) = cosine + bz * t.z();
    r(1, 0) = xy + az;
    r(0, 1) = xy - az;
    r(0, 2) = xz + ay;
    r(2, 0) = xz - ay;
    r(2, 1) = yz + ax;
    r(1, 2) = yz - ax;
    return r;
}

/// e_i u^T + u e_i^T, added with a factor.
void add_symmetric(Matrix3& m, int i, const Vector3& u, double factor) {
    m.row(i) += factor * u.transpose();
    m.col(i) += factor * u;
}

}  // namespace

double sinc(double x) { return x == 0 ? 1 : std::sin(x) / x; }

double sinc_g(double x) {
    const double z = x * x;
    if (z <= derivative_series_limit) return evaluate<term_count>(g_series, z);
    return (std::cos(x) - std::sin(x) / x) / z;
}

double sinc_h(double x) {
    const double z = x * x;
    if (z <= derivative_series_limit) return evaluate<term_count>(h_series, z);
    const double a = std::sin(x) / x;
    return -(a + 3 * (std::cos(x) - a) / z) / z;
}

Matrix3 rotation(const Vector3& theta) {
    const auto [cosine, a, b] = value_coefficients(theta.squaredNorm());
    return combine(cosine, a, b, theta);
}

RotationDerivatives rotation_derivatives(const Vector3& theta) {
    const Coefficients k = coefficients(theta.squaredNorm());
    const Matrix3 cross = cross_matrix(theta);
    const Matrix3 outer = theta * theta.transpose();
    const std::array<Matrix3, 3> generators{cross_matrix(Vector3::UnitX()), cross_matrix(Vector3::UnitY()), cross_matrix(Vector3::UnitZ())};
    RotationDerivatives d;
    d.value = combine(k.cosine, k.a, k.b, theta);
    // Common parts of the gradient: d cosine = -a theta, d a = a_g theta, d b = b_g theta.
    const Matrix3 radial = -k.a * Matrix3::Identity() + k.a_g * cross + k.b_g * outer;
    const Matrix3 radial_twice = -k.a_g * Matrix3::Identity() + k.a_h * cross + k.b_h * outer;
    std::size_t n = 0;
    for (int i = 0; i < 3; ++i) {
        const auto ui = static_cast<std::size_t>(i);
        Matrix3& gradient = d.gradient[ui];
        gradient = theta[i] * radial + k.a * generators[ui];
        add_symmetric(gradient, i, theta, k.b);
        for (int j = i; j < 3; ++j, ++n) {
            const auto uj = static_cast<std::size_t>(j);
            Matrix3& hessian = d.hessian[n];
            hessian = (theta[i] * theta[j]) * radial_twice + k.a_g * (theta[i] * generators[uj] + theta[j] * generators[ui]);
            if (i == j) hessian += radial;
            add_symmetric(hessian, j, theta, k.b_g * theta[i]);
            add_symmetric(hessian, i, theta, k.b_g * theta[j]);
            hessian(i, j) += k.b;
            hessian(j, i) += k.b;
        }
    }
    return d;
}

// <s, [v]> = turn.v, <s, e_i u^T + u e_i^T> = (both u)_i.
Matrix3 rotation_curvature(const Matrix3& s, const Vector3& theta) {
    const Coefficients k = coefficients(theta.squaredNorm());
    const Matrix3 both = s + s.transpose();
    const Vector3 turn(s(2, 1) - s(1, 2), s(0, 2) - s(2, 0), s(1, 0) - s(0, 1)), along = both * theta;
    const double trace = s.trace(), turned = turn.dot(theta), stretched = 0.5 * theta.dot(along);
    const double radial = -k.a * trace + k.a_g * turned + k.b_g * stretched;
    const double radial_twice = -k.a_g * trace + k.a_h * turned + k.b_h * stretched;
    const Vector3 mixed = 0.5 * radial_twice * theta + k.a_g * turn + k.b_g * along;
    Matrix3 c = k.b * both + theta * mixed.transpose() + mixed * theta.transpose();
    c.diagonal().array() += radial;
    return c;
}

Matrix3 left_jacobian(const Vector3& theta) {
    const double z = theta.squaredNorm();
    const auto [cosine, a, b] = value_coefficients(z);
    const double c = z <= derivative_series_limit ? evaluate<term_count>(c_series, z) : (1 - a) / z;
    // I + b [theta] + c [theta]^2 with [theta]^2 = theta theta^T - z I and 1 - c z = a.
    return combine(a, b, c, theta);
}

Matrix3 left_jacobian_inverse(const Vector3& theta) {
    const double z = theta.squaredNorm();
    FETTLE_ASSERT(z < 4 * M_PI * M_PI, "the left Jacobian is singular at |theta| = 2 pi");
    const Coefficients k = coefficients(z);
    // I - [theta]/2 + e [theta]^2 with e = (1 - x/2 cot(x/2))/x^2 = -b_g/(2 b), and 1 - e z = a/(2 b): no cancellation.
    return combine(k.a / (2 * k.b), -0.5, -k.b_g / (2 * k.b), theta);
}

Vector3 rotation_vector(const Matrix3& rotation) {
    const Matrix3 r = orthonormalised(orthonormalised(rotation));
    // Unit quaternion by its largest component (Shepperd), so that nothing is divided by a small number.
    const std::array<double, 4> squares{1 + r(0, 0) + r(1, 1) + r(2, 2), 1 + r(0, 0) - r(1, 1) - r(2, 2), 1 - r(0, 0) + r(1, 1) - r(2, 2),
                                        1 - r(0, 0) - r(1, 1) + r(2, 2)};
    const Vector3 axial(r(2, 1) - r(1, 2), r(0, 2) - r(2, 0), r(1, 0) - r(0, 1));
    int largest = 0;
    for (int i = 1; i < 4; ++i) {
        if (squares[i] > squares[largest]) largest = i;
    }
    // Only the direction of (w, v) matters, so its length is left at 4 times the largest component.
    double w = squares[0];
    Vector3 v = axial;
    if (largest > 0) {
        const int i = largest - 1, j = (i + 1) % 3, k = (i + 2) % 3;
        w = axial[i];
        v[i] = squares[largest];
        v[j] = r(i, j) + r(j, i);
        v[k] = r(i, k) + r(k, i);
        if (w < 0) {
            w = -w;
            v = -v;
        }
    }
    const double sine = v.stableNorm();
    if (sine == 0) return Vector3::Zero();
    return (2 * std::atan2(sine, w) / sine) * v;
}

Eigen::Quaterniond turn_between(const Vector3& from, const Vector3& to) {
    constexpr double opposite = 1e-8;
    const Vector3 a = from.normalized(), b = to.normalized();
    const double sum_squared = (a + b).squaredNorm();  // 2 (1 + cos), without its cancellation
    if (sum_squared < opposite * opposite) {
        const Vector3 axis = a.unitOrthogonal();
        return {0, axis.x(), axis.y(), axis.z()};
    }
    const Vector3 axis = a.cross(b);
    return Eigen::Quaterniond(0.5 * sum_squared, axis.x(), axis.y(), axis.z()).normalized();
}

Matrix3 orthonormalised(const Matrix3& nearly_a_rotation) {
    // Written as R - R (R^T R - I)/2, which keeps small off-diagonal entries to full relative accuracy.
    const Matrix3 excess = nearly_a_rotation.transpose() * nearly_a_rotation - Matrix3::Identity();
    return nearly_a_rotation - 0.5 * (nearly_a_rotation * excess);
}

}  // namespace fettle::core::kinematics
