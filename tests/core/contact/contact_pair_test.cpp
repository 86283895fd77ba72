// SPDX-License-Identifier: MIT
// Derivatives of one pair's potential against central differences, for every kind of closest feature, with and without mollifier.
#include "core/contact/contact_pair.hpp"
#include "core/linear/factorisations.hpp"

#include <catch2/catch.hpp>
#include <random>

#include "core/kinematics/rotation.hpp"

namespace fettle::core::contact::contact_pair_test {

using fettle::core::kinematics::rotation;

namespace {

struct Case {
    std::string name;
    ContactPair pair;
    int free_count;
    bool mollified;
};

ContactPair make_pair(geometry::PairType type, const geometry::PairVertices& x, double rest_scale) {
    ContactPair pair;
    pair.type = type;
    pair.x = x;
    pair.closest = closest_points(type, x);
    if (type == geometry::PairType::edge_edge)
        pair.mollifier_eps = mollifier_scale * rest_scale * (x[1] - x[0]).squaredNorm() * (x[3] - x[2]).squaredNorm();
    return pair;
}

std::vector<Case> cases() {
    const auto pt = geometry::PairType::point_triangle;
    const auto ee = geometry::PairType::edge_edge;
    const Vector3 t0(0, 0, 0), t1(1, 0.1, 0), t2(0.2, 0.9, 0.05);
    std::vector<Case> out{
        {"face", make_pair(pt, {Vector3(0.4, 0.3, 0.07), t0, t1, t2}, 1), 2, false},
        {"triangle edge", make_pair(pt, {Vector3(0.5, -0.01, 0.06), t0, t1, t2}, 1), 1, false},
        {"triangle corner", make_pair(pt, {Vector3(-0.05, -0.03, 0.04), t0, t1, t2}, 1), 0, false},
        {"crossing edges",
         make_pair(ee, {Vector3(-0.5, 0.1, 0.08), Vector3(0.6, 0, 0.07), Vector3(0, -0.4, 0), Vector3(0.1, 0.5, 0.01)}, 1), 2, false},
        {"edge end", make_pair(ee, {Vector3(0.06, 0.1, 0.05), Vector3(0.8, 0, 0.2), Vector3(0, -0.4, 0), Vector3(0.01, 0.5, 0.01)}, 1), 1,
         false},
        {"two ends", make_pair(ee, {Vector3(0.06, 0.54, 0.05), Vector3(0.8, 0.9, 0.2), Vector3(0, -0.4, 0), Vector3(0.01, 0.5, 0.01)}, 1),
         0, false},
        {"nearly parallel, inside",
         make_pair(ee, {Vector3(-0.5, 0.005, 0.07), Vector3(0.5, -0.004, 0.0699), Vector3(-0.4, -0.004, 0), Vector3(0.6, 0.006, 0)}, 1), 2,
         true},
        {"nearly parallel, end",
         make_pair(ee, {Vector3(-0.5, 0.03, 0.05), Vector3(0.5, 0.035, 0.04), Vector3(-0.4, -0.004, 0), Vector3(0.6, 0.006, 0)}, 1), 1,
         true},
    };
    return out;
}

const BarrierParameters parameters = barrier_parameters(0.15, 0.01, 3.0, 0.7);
const Vector3 first_position(0.3, -0.2, 0.5), second_position(-0.6, 0.4, -0.3);

ContactPair moved(const ContactPair& pair, const Vector12& motion) {
    ContactPair out = pair;
    const int n = geometry::first_count(pair.type);
    for (int i = 0; i < 4; ++i) {
        const Vector3& q = i < n ? first_position : second_position;
        const Vector6 m = i < n ? motion.head<6>() : motion.tail<6>();
        out.x[i] = q + m.head<3>() + rotation(m.tail<3>()) * (pair.x[i] - q);
    }
    out.closest = closest_points(out.type, out.x);
    return out;
}

double potential_at(const ContactPair& pair, const Vector12& motion) { return pair_potential(moved(pair, motion), parameters); }

Vector12 gradient_of(const BodyPairSum& sum) {
    Vector12 g;
    g << tangent_gradient(sum.first), tangent_gradient(sum.second);
    return g;
}

Matrix12 full_hessian(const BodyPairSum& sum) {
    Matrix12 h = in_both_bodies(sum.hessian);
    h.block<3, 3>(3, 3) += core::kinematics::tangent_curvature(sum.first.arm);
    h.block<3, 3>(9, 9) += core::kinematics::tangent_curvature(sum.second.arm);
    return h;
}

BodyPairSum derivatives(const ContactPair& pair, HessianKind kind) {
    BodyPairSum sum;
    add_pair_derivatives(pair, parameters, kind, first_position, second_position, sum);
    return sum;
}

}  // namespace

TEST_CASE("the cases are what they say", "[contact_pair]") {
    for (const Case& c : cases()) {
        INFO(c.name);
        CHECK(c.pair.closest.free_count == c.free_count);
        CHECK(c.pair.closest.distance_squared < parameters.activation * parameters.activation);
        CHECK(c.pair.closest.distance_squared > parameters.dmin * parameters.dmin);
        if (c.pair.type == geometry::PairType::edge_edge) CHECK((edge_cross_squared(c.pair.x) < c.pair.mollifier_eps) == c.mollified);
    }
}

TEST_CASE("gradient and exact Hessian of a pair agree with differences", "[contact_pair]") {
    for (const Case& c : cases()) {
        INFO(c.name);
        const BodyPairSum sum = derivatives(c.pair, HessianKind::exact);
        const Vector12 gradient = gradient_of(sum);
        const Matrix12 hessian = full_hessian(sum);
        Vector12 difference;
        Matrix12 second;
        const double h = 1e-6, h2 = 4e-5;
        for (int i = 0; i < 12; ++i) {
            const Vector12 e = Vector12::Unit(i);
            difference[i] = (potential_at(c.pair, h * e) - potential_at(c.pair, -h * e)) / (2 * h);
            for (int j = 0; j < 12; ++j) {
                const Vector12 f = Vector12::Unit(j);
                // In tangent coordinates the second difference is along the exponential of the sum.
                second(i, j) = (potential_at(c.pair, h2 * (e + f)) - potential_at(c.pair, h2 * (e - f)) -
                                potential_at(c.pair, h2 * (f - e)) + potential_at(c.pair, -h2 * (e + f))) /
                               (4 * h2 * h2);
            }
        }
        CHECK((gradient - difference).norm() <= 1e-7 * gradient.norm());
        CHECK((hessian - second).norm() <= 2e-5 * hessian.norm());
    }
}

TEST_CASE("vertex forces and Hessian products agree with differences", "[contact_pair]") {
    std::mt19937 random(7);
    std::normal_distribution<double> normal;
    for (const Case& c : cases()) {
        INFO(c.name);
        std::array<Vector3, 4> v;
        for (Vector3& vi : v) vi = Vector3(normal(random), normal(random), normal(random));
        const auto shifted = [&](double h) {
            ContactPair p = c.pair;
            for (int i = 0; i < 4; ++i) p.x[i] += h * v[i];
            p.closest = closest_points(p.type, p.x);
            return p;
        };
        const double h = 1e-6;
        const auto f = pair_forces(c.pair, parameters);
        double along = 0;
        for (int i = 0; i < 4; ++i) along += f[i].dot(v[i]);
        CHECK(along == Approx((pair_potential(shifted(h), parameters) - pair_potential(shifted(-h), parameters)) / (2 * h)).epsilon(1e-6));
        const auto product = pair_hessian_product(c.pair, parameters, v);
        const auto plus = pair_forces(shifted(h), parameters), minus = pair_forces(shifted(-h), parameters);
        double error = 0, size = 0;
        for (int i = 0; i < 4; ++i) {
            error += (product[i] - (plus[i] - minus[i]) / (2 * h)).squaredNorm();
            size += product[i].squaredNorm();
        }
        CHECK(std::sqrt(error) <= 1e-6 * std::sqrt(size));
    }
}

TEST_CASE("the projected Hessian is positive semi-definite and close to the exact one along the normal", "[contact_pair]") {
    for (const Case& c : cases()) {
        INFO(c.name);
        const Matrix12 projected = in_both_bodies(derivatives(c.pair, HessianKind::projected).hessian);
        const Vector12 eigenvalues = linear::symmetric_eigenvalues<12>(projected);
        CHECK(eigenvalues[0] >= -1e-12 * eigenvalues[11]);
        // At least the exact one everywhere: exact <= projected.
        const Matrix12 exact = in_both_bodies(derivatives(c.pair, HessianKind::exact).hessian);
        CHECK(linear::symmetric_eigenvalues<12>(projected - exact)[0] >= -1e-10 * eigenvalues[11]);
    }
}

TEST_CASE("a pair's derivatives are linear in kappa and independent of a common translation", "[contact_pair]") {
    for (const Case& c : cases()) {
        INFO(c.name);
        ContactPair far = c.pair;
        const Vector3 shift(16, -32, 8);  // exact in binary
        for (Vector3& x : far.x) x += shift;
        far.closest = closest_points(far.type, far.x);
        CHECK(pair_potential(far, parameters) == Approx(pair_potential(c.pair, parameters)).epsilon(1e-10));
        BarrierParameters doubled = parameters;
        doubled.factor *= 2;
        CHECK(pair_potential(c.pair, doubled) == 2 * pair_potential(c.pair, parameters));
    }
}

}  // namespace fettle::core::contact::contact_pair_test
