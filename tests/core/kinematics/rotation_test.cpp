// SPDX-License-Identifier: MIT
// Oracle: the same functions in 50-digit arithmetic, differentiated by central differences there (step 1e-12, error 1e-24).
#include "core/kinematics/rotation.hpp"

#include <algorithm>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <vector>

namespace fettle::core::kinematics::rotation_test {

namespace {

using Real = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<50>, boost::multiprecision::et_off>;
using RealVector = std::array<Real, 3>;
using RealMatrix = std::array<std::array<Real, 3>, 3>;

RealMatrix multiply(const RealMatrix& a, const RealMatrix& b) {
    RealMatrix c{};
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            for (int k = 0; k < 3; ++k) c[i][j] += a[i][k] * b[k][j];
    return c;
}

/// exp([theta]) by scaling and squaring of the Taylor series: no closed form in common with the code under test.
RealMatrix reference_rotation(const RealVector& t) {
    const Real scale = Real(1) / 256;
    const RealMatrix w{
        {{Real(0), -t[2] * scale, t[1] * scale}, {t[2] * scale, Real(0), -t[0] * scale}, {-t[1] * scale, t[0] * scale, Real(0)}}};
    RealMatrix sum{}, power{};
    for (int i = 0; i < 3; ++i) sum[i][i] = power[i][i] = 1;
    for (int n = 1; n < 30; ++n) {
        power = multiply(power, w);
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) {
                power[i][j] /= n;
                sum[i][j] += power[i][j];
            }
    }
    for (int i = 0; i < 8; ++i) sum = multiply(sum, sum);
    return sum;
}

RealVector exact(const Vector3& v) { return {Real(v.x()), Real(v.y()), Real(v.z())}; }

double largest_error(const Matrix3& m, const RealMatrix& r) {
    double e = 0;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) e = std::max(e, static_cast<double>(abs(Real(m(i, j)) - r[i][j])));
    return e;
}

double largest_entry(const RealMatrix& r) {
    Real e = 0;
    for (const auto& row : r)
        for (const Real& x : row) e = std::max<Real>(e, abs(x));
    return static_cast<double>(e);
}

RealMatrix shifted(const Vector3& theta, int a, int sa, int b, int sb) {
    RealVector t = exact(theta);
    const Real step("1e-12");
    t[a] += sa * step;
    t[b] += sb * step;
    return reference_rotation(t);
}

RealMatrix reference_gradient(const Vector3& theta, int a) {
    RealMatrix p = shifted(theta, a, 1, a, 0);
    const RealMatrix m = shifted(theta, a, -1, a, 0);
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) p[i][j] = (p[i][j] - m[i][j]) * Real("5e11");
    return p;
}

RealMatrix reference_hessian(const Vector3& theta, int a, int b) {
    RealMatrix pp = shifted(theta, a, 1, b, 1);
    const RealMatrix pm = shifted(theta, a, 1, b, -1), mp = shifted(theta, a, -1, b, 1), mm = shifted(theta, a, -1, b, -1);
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) pp[i][j] = (pp[i][j] - pm[i][j] - mp[i][j] + mm[i][j]) * Real("2.5e23");
    return pp;
}

/// Magnitudes where something switches, vanishes or cancels, each in random directions.
std::vector<Vector3> sample_vectors(int per_magnitude) {
    std::mt19937_64 random(7);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> uniform(0, 4 * M_PI);
    std::vector<double> magnitudes{0,   1e-300,   1e-160, 1e-12,    1e-8, 1e-4,     1e-3, 0.01,     0.1,
                                   0.5, 0.999999, 1,      1.000001, 1.5,  1.999999, 2,    2.000001, 3};
    for (const double k : {1.0, 2.0, 3.0, 4.0})
        for (const double d : {-0.1, -1e-4, -1e-8, 0.0, 1e-8, 1e-4}) magnitudes.push_back(k * M_PI + d);
    for (int i = 0; i < 20; ++i) magnitudes.push_back(uniform(random));
    std::vector<Vector3> vectors;
    for (const double m : magnitudes) {
        vectors.push_back(m * Vector3::UnitY());
        for (int i = 0; i < per_magnitude; ++i) vectors.push_back(m * Vector3(normal(random), normal(random), normal(random)).normalized());
    }
    return vectors;
}

}  // namespace

TEST_CASE("sinc, g and h agree with 50-digit arithmetic") {
    double worst = 0;
    for (int i = 0; i <= 4000; ++i) {
        const double x = i < 2000 ? 4 * M_PI * i / 2000.0 : 4 * std::pow(10.0, -(i - 2000) / 200.0);
        const Real y = x;
        if (x == 0) {
            CHECK(sinc(x) == 1);
            CHECK(sinc_g(x) == -1.0 / 3);
            CHECK(sinc_h(x) == 1.0 / 15);
            continue;
        }
        const Real s = sin(y), c = cos(y);
        // 50 digits less 5 log10(1/x) of cancellation: enough down to 1e-6; below it the first two terms are exact to 1e-24.
        const bool tiny = x < 1e-5;
        const Real a = tiny ? Real(1 - y * y / 6) : Real(s / y);
        const Real g = tiny ? Real(-Real(1) / 3 + y * y / 30) : Real((y * c - s) / (y * y * y));
        const Real h = tiny ? Real(Real(1) / 15 - y * y / 210) : Real((-y * y * s - 3 * y * c + 3 * s) / (y * y * y * y * y));
        // Scale of each: its value near 0, its envelope beyond (the functions have zeros).
        const double scale = std::max(1.0, x);
        worst = std::max(worst, static_cast<double>(abs(a - sinc(x))) * scale);
        worst = std::max(worst, static_cast<double>(abs(g - sinc_g(x))) * std::pow(scale, 2));
        worst = std::max(worst, static_cast<double>(abs(h - sinc_h(x))) * std::pow(scale, 3));
        if (x < 2) {
            worst = std::max(worst, static_cast<double>(abs(g / Real(sinc_g(x)) - 1)));
            worst = std::max(worst, static_cast<double>(abs(h / Real(sinc_h(x)) - 1)));
        }
    }
    CAPTURE(worst);
    CHECK(worst < 2e-15);
    CHECK(sinc_h(-0.3) == sinc_h(0.3));
}

TEST_CASE("rotation, gradient and Hessian agree with 50-digit arithmetic") {
    double worst_value = 0, worst_gradient = 0, worst_hessian = 0;
    for (const Vector3& theta : sample_vectors(2)) {
        const RotationDerivatives d = rotation_derivatives(theta);
        CHECK((d.value.array() == rotation(theta).array()).all());
        worst_value = std::max(worst_value, largest_error(d.value, reference_rotation(exact(theta))));
        double scale = 0, error = 0;
        for (int a = 0; a < 3; ++a) {
            const RealMatrix r = reference_gradient(theta, a);
            scale = std::max(scale, largest_entry(r));
            error = std::max(error, largest_error(d.gradient[a], r));
        }
        worst_gradient = std::max(worst_gradient, error / scale);
        scale = error = 0;
        for (int a = 0, n = 0; a < 3; ++a)
            for (int b = a; b < 3; ++b, ++n) {
                const RealMatrix r = reference_hessian(theta, a, b);
                scale = std::max(scale, largest_entry(r));
                error = std::max(error, largest_error(d.hessian[n], r));
            }
        worst_hessian = std::max(worst_hessian, error / scale);
    }
    CAPTURE(worst_value, worst_gradient, worst_hessian);
    CHECK(worst_value < 1e-14);
    CHECK(worst_gradient < 1e-14);
    CHECK(worst_hessian < 1e-14);
}

TEST_CASE("rotation_curvature is the Hessian summed against a matrix") {
    Matrix3 s;
    s << 0.3, -1.2, 2.5, 0.7, 0.1, -0.4, 1.9, 0.6, -2.2;
    double worst = 0;
    for (const Vector3& theta : sample_vectors(2)) {
        const RotationDerivatives d = rotation_derivatives(theta);
        const Matrix3 curvature = rotation_curvature(s, theta);
        for (int a = 0, n = 0; a < 3; ++a)
            for (int b = a; b < 3; ++b, ++n) {
                const double expected = s.cwiseProduct(d.hessian[n]).sum();
                worst = std::max({worst, std::abs(curvature(a, b) - expected), std::abs(curvature(b, a) - expected)});
            }
    }
    CAPTURE(worst);
    CHECK(worst < 1e-13);
}

TEST_CASE("small rotations keep the relative accuracy of every entry") {
    const Vector3 theta(1e-9, -3e-12, 2e-15);
    const RealMatrix r = reference_rotation(exact(theta));
    const Matrix3 m = rotation(theta);
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) CHECK(static_cast<double>(abs(r[i][j] - Real(m(i, j))) / abs(r[i][j])) < 4e-16);
}

TEST_CASE("left Jacobian maps increments to angular increments") {
    double worst = 0;
    for (const Vector3& theta : sample_vectors(2)) {
        const RotationDerivatives d = rotation_derivatives(theta);
        const Matrix3 jacobian = left_jacobian(theta);
        for (int a = 0; a < 3; ++a) {
            // dR R^T = [J e_a]
            const Matrix3 expected = d.gradient[a] * d.value.transpose();
            worst = std::max(worst, (cross_matrix(jacobian.col(a)) - expected).cwiseAbs().maxCoeff());
        }
        const double x = theta.norm();
        if (x < 2 * M_PI - 0.05) {
            const Matrix3 inverse = left_jacobian_inverse(theta);
            worst = std::max(worst, (inverse * jacobian - Matrix3::Identity()).cwiseAbs().maxCoeff() / inverse.cwiseAbs().maxCoeff());
        }
    }
    CAPTURE(worst);
    CHECK(worst < 2e-14);
    CHECK((left_jacobian(Vector3::Zero()).array() == Matrix3::Identity().array()).all());
    CHECK_THROWS(left_jacobian_inverse(Vector3(0, 0, 6.3)));
}

TEST_CASE("rotation_vector inverts rotation") {
    for (const Vector3& theta : sample_vectors(4)) {
        if (theta.norm() > M_PI + 1e-9) continue;
        const Vector3 back = rotation_vector(rotation(theta));
        CHECK(back.norm() <= M_PI * (1 + 1e-15));
        // At pi both signs are right.
        const double error = theta.norm() > M_PI - 1e-9 ? std::min((back - theta).norm(), (back + theta).norm()) : (back - theta).norm();
        CAPTURE(theta.transpose(), back.transpose());
        CHECK(error <= (theta.norm() > M_PI - 1e-9 ? 3e-8 : 4e-15 * theta.norm() + 1e-320));
    }
    CHECK(rotation_vector(Matrix3::Identity()).norm() == 0);
    // Half turns about every kind of axis.
    for (const Vector3& axis : {Vector3(1, 0, 0), Vector3(0, -1, 0), Vector3(0, 0, 1), Vector3(1, 1, 1), Vector3(-1, 2, 1e-9)}) {
        const Vector3 n = axis.normalized();
        const Matrix3 half_turn = 2 * n * n.transpose() - Matrix3::Identity();
        CHECK((rotation(rotation_vector(half_turn)) - half_turn).cwiseAbs().maxCoeff() < 1e-15);
        CHECK(rotation_vector(half_turn).norm() == Approx(M_PI).epsilon(1e-15));
    }
    // The nearest rotation of a matrix that is off by 1e-6 is used.
    const Vector3 theta(0.3, -1.2, 2.0);
    Matrix3 off = rotation(theta);
    off *= 1 + 1e-6;
    CHECK((rotation_vector(off) - theta).norm() < 1e-14);
}

TEST_CASE("turn_between takes one direction to the other by the shortest way") {
    const Vector3 a(0.3, -2, 0.7);
    for (const Vector3& b : {Vector3(1, 0, 0), Vector3(0.6, -4, 1.4), Vector3(-5, 1, 1e-3), Vector3(-0.3, 2, -0.7 + 1e-5)}) {
        const Eigen::Quaterniond q = turn_between(a, b);
        CAPTURE(b.transpose());
        const double near_opposite = (a.normalized() + b.normalized()).norm();
        CHECK((q * a.normalized() - b.normalized()).norm() < 1e-15 + 1e-15 / near_opposite);
        const double angle = std::acos(a.normalized().dot(b.normalized()));
        CHECK(2 * std::atan2(q.vec().norm(), q.w()) == Approx(angle).margin(3e-8));
    }
    const Eigen::Quaterniond half = turn_between(a, -2 * a);
    CHECK((half * a + a).norm() < 1e-15);
    CHECK(half.norm() == Approx(1).epsilon(1e-15));
    CHECK(turn_between(a, 3 * a).vec().norm() < 1e-16);
}

TEST_CASE("orthonormalised squares the departure from a rotation") {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> uniform(-1e-5, 1e-5);
    Matrix3 r = rotation(Vector3(2, 1, -0.4));
    for (int i = 0; i < 9; ++i) r(i / 3, i % 3) += uniform(random);
    const Matrix3 once = orthonormalised(r);
    CHECK((once.transpose() * once - Matrix3::Identity()).norm() < 1e-8);
    const Matrix3 twice = orthonormalised(once);
    CHECK((twice.transpose() * twice - Matrix3::Identity()).norm() < 2e-15);
}

}  // namespace fettle::core::kinematics::rotation_test
