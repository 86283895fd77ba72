// SPDX-License-Identifier: MIT
#include "adjoint/contact/friction_adjoint.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "adjoint/contact/contact_pair_adjoint.hpp"
#include "adjoint/contact/pair_bodies.hpp"
#include "core/contact/friction.hpp"

namespace fettle::adjoint::contact {
namespace {

using core::contact::BarrierParameters;
using core::contact::BodyPairContacts;
using core::contact::ContactPair;
using core::kinematics::pose_matrix;

// The values that friction takes from a contact, and what they follow from.
struct Lagged {
    const ContactPair& pair;
    std::array<int, 4> body;
    Four X;  // vertices in their bodies' frames
    double distance = 0;
    Vector3 normal, point_first, point_second;
    double force = 0;        // lambda
    double by_distance = 0;  // its derivatives
    double by_cross = 0, by_eps = 0, by_dmin = 0;
    Vector3 cross_1 = Vector3::Zero(), cross_2 = Vector3::Zero();  // dc/de1, dc/de2
    std::array<Vector3, 2> r{};                                    // r_a
    Matrix2 l = Matrix2::Identity();                               // K = l l^T
    const std::vector<core::contact::AreaShare>* of_weight = nullptr;
    double by_radius = 0;                                                   // of round surfaces
    std::array<const Matrix3*, 2> rotation{};                               // of the lag's poses
    Vector3 along_first = Vector3::Zero(), along_second = Vector3::Zero();  // the normal in the bodies' frames
};

void find_free_directions(Lagged& g) {
    const core::geometry::ClosestPoints& c = g.pair.closest;
    for (int a = 0; a < c.free_count; ++a) {
        g.r[a].setZero();
        for (int i = 0; i < 4; ++i) g.r[a] += c.free_weight[a][i] * g.pair.x[i];
    }
    if (c.free_count > 0) g.l(0, 0) = g.r[0].norm();
    if (c.free_count < 2) return;
    const Vector3 along = g.r[0] / g.l(0, 0);
    g.l(1, 0) = along.dot(g.r[1]);
    g.l(1, 1) = g.r[1].cross(along).norm();  // accurate for nearly parallel directions
}

// lambda = -2 factor w m b' d.
void find_force(const BarrierParameters& p, Lagged& g) {
    const double d = g.distance, scale = -2 * p.factor * g.pair.weight;
    if (const int side = g.pair.round.side; side != 0) {
        const core::contact::RoundBarrier b = core::contact::round_barrier(g.pair, p);
        const double factor = -side * p.factor * g.pair.weight;
        g.force = factor * b.in_distance.first;
        g.by_distance = factor * b.in_distance.second;
        g.by_radius = factor * b.slope_by_radius;
        g.by_dmin = -side * 2 * g.pair.weight * d * pair_barrier_by_dmin(g.pair, p, barrier_factor_slope(p)).first;
        return;
    }
    const core::contact::ScalarDerivatives b = core::contact::barrier(d * d - p.dmin * p.dmin, p.gap_hat);
    core::contact::ScalarDerivatives m{1, 0, 0};
    if (is_mollified(g.pair)) {
        const Vector3 e1 = g.pair.x[1] - g.pair.x[0], e2 = g.pair.x[3] - g.pair.x[2], cross = e1.cross(e2);
        const double eps = g.pair.mollifier_eps, x = cross.squaredNorm() / eps;
        m = core::contact::edge_mollifier(cross.squaredNorm(), eps);
        g.cross_1 = 2 * e2.cross(cross);
        g.cross_2 = 2 * cross.cross(e1);
        g.by_cross = scale * m.first * b.first * d;
        g.by_eps = scale * (-2 * x * (1 - x) / eps) * b.first * d;
    }
    g.by_dmin = -2 * g.pair.weight * m.value * d * barrier_by_dmin(d * d, p, barrier_factor_slope(p)).first;
    g.force = scale * m.value * b.first * d;
    g.by_distance = scale * m.value * (2 * d * d * b.second + b.first);
}

Lagged lagged(const FrictionAtPose& at, const BodyPairContacts& list, const ContactPair& pair) {
    Lagged g{pair, bodies_of(list, pair), {}, std::sqrt(pair.closest.distance_squared), {}, Vector3::Zero(), Vector3::Zero()};
    g.X = undeformed(at.model, g.body, pair);
    g.normal = contact_normal(pair);
    g.rotation = {&at.lag.poses[list.first].rotation, &at.lag.poses[list.second].rotation};
    g.along_first = g.rotation[0]->transpose() * g.normal;
    g.along_second = g.rotation[1]->transpose() * g.normal;
    for (int i = 0; i < 4; ++i) {
        const bool on_first = i < first_count(pair.type);
        (on_first ? g.point_first : g.point_second) += (on_first ? 1 : -1) * pair.closest.weight[i] * g.X[i];
    }
    g.point_first -= pair.round.reach[0] * g.along_first;
    g.point_second += pair.round.reach[1] * g.along_second;
    find_free_directions(g);
    find_force(at.parameters, g);
    return g;
}

// K^-1 a.
Vector2 solve_free(const Lagged& g, Vector2 a) {
    const int count = g.pair.closest.free_count;
    if (count == 0) return Vector2::Zero();
    if (count == 1) return {a[0] / (g.l(0, 0) * g.l(0, 0)), 0};
    const Vector2 y = g.l.triangularView<Eigen::Lower>().solve(a);
    return g.l.transpose().triangularView<Eigen::Upper>().solve(y);
}

// Derivatives in what friction takes: as numbers that change, or of a result.
struct LagParts {
    double force = 0;
    Vector3 normal = Vector3::Zero(), point_first = Vector3::Zero(), point_second = Vector3::Zero();
};

Vector3 across(const Vector3& n, const Vector3& v) { return v - n * n.dot(v); }

// What moves the lag of a contact.
struct LagChange {
    Four x, X;                          // its vertices in space, and in their bodies
    std::array<double, 2> reach{};      // of round surfaces
    std::array<Matrix3, 2> rotation{};  // of the lag's poses, entry by entry; only of round surfaces
};

LagParts lag_tangent(const Lagged& g, const LagChange& lag_dot) {
    const Four &x_dot = lag_dot.x, &X_dot = lag_dot.X;
    const core::geometry::ClosestPoints& c = g.pair.closest;
    Vector3 moved = Vector3::Zero();
    for (int i = 0; i < 4; ++i) moved += c.weight[i] * x_dot[i];
    Vector2 a = Vector2::Zero();
    for (int k = 0; k < c.free_count; ++k) {
        Vector3 turned = Vector3::Zero();
        for (int i = 0; i < 4; ++i) turned += c.free_weight[k][i] * x_dot[i];
        a[k] = g.r[k].dot(moved) + c.difference.dot(turned);
    }
    const Vector2 beta = -solve_free(g, a);
    LagParts out;
    Vector3 difference = moved;
    for (int k = 0; k < c.free_count; ++k) difference += beta[k] * g.r[k];
    out.normal = across(g.normal, difference) / g.distance;
    out.force =
        g.by_distance * g.normal.dot(moved) + g.by_cross * (g.cross_1.dot(x_dot[1] - x_dot[0]) + g.cross_2.dot(x_dot[3] - x_dot[2]));
    if (g.by_eps != 0) out.force += g.by_eps * dot(mollifier_eps_gradient(g.X[0], g.X[1], g.X[2], g.X[3]), X_dot);
    for (int i = 0; i < 4; ++i) {
        double slide = 0;  // of the weight
        for (int k = 0; k < c.free_count; ++k) slide += beta[k] * c.free_weight[k][i];
        const Vector3 change = c.weight[i] * X_dot[i] + slide * g.X[i];
        if (i < first_count(g.pair.type))
            out.point_first += change;
        else
            out.point_second -= change;
    }
    if (g.pair.round.side == 0) return out;
    // The points are off the centre lines by reach R^T n.
    const std::array<double, 2>& reach = g.pair.round.reach;
    out.force += g.by_radius * (lag_dot.reach[0] + lag_dot.reach[1]);
    out.point_first -= lag_dot.reach[0] * g.along_first +
                       reach[0] * (lag_dot.rotation[0].transpose() * g.normal + g.rotation[0]->transpose() * out.normal);
    out.point_second += lag_dot.reach[1] * g.along_second +
                        reach[1] * (lag_dot.rotation[1].transpose() * g.normal + g.rotation[1]->transpose() * out.normal);
    return out;
}

// The gradient in it.
LagChange lag_adjoint(const Lagged& g, const LagParts& bar) {
    const core::geometry::ClosestPoints& c = g.pair.closest;
    LagChange out;
    Vector3 normal_bar = bar.normal;
    out.rotation.fill(Matrix3::Zero());
    if (g.pair.round.side != 0) {
        const std::array<double, 2>& reach = g.pair.round.reach;
        out.reach = {g.by_radius * bar.force - g.along_first.dot(bar.point_first),
                     g.by_radius * bar.force + g.along_second.dot(bar.point_second)};
        normal_bar += -reach[0] * (*g.rotation[0] * bar.point_first) + reach[1] * (*g.rotation[1] * bar.point_second);
        out.rotation = {-reach[0] * g.normal * bar.point_first.transpose(), reach[1] * g.normal * bar.point_second.transpose()};
    }
    const Vector3 difference_bar = across(g.normal, normal_bar) / g.distance;
    std::array<double, 4> weight_bar;
    for (int i = 0; i < 4; ++i) {
        const Vector3 point_bar = i < first_count(g.pair.type) ? bar.point_first : Vector3(-bar.point_second);
        weight_bar[i] = point_bar.dot(g.X[i]);
        out.X[i] = c.weight[i] * point_bar;
        out.x[i] = c.weight[i] * (difference_bar + bar.force * g.by_distance * g.normal);
    }
    Vector2 beta_bar = Vector2::Zero();
    for (int k = 0; k < c.free_count; ++k) {
        beta_bar[k] = g.r[k].dot(difference_bar);
        for (int i = 0; i < 4; ++i) beta_bar[k] += c.free_weight[k][i] * weight_bar[i];
    }
    const Vector2 a_bar = -solve_free(g, beta_bar);
    for (int k = 0; k < c.free_count; ++k)
        for (int i = 0; i < 4; ++i) out.x[i] += a_bar[k] * (c.weight[i] * g.r[k] + c.free_weight[k][i] * c.difference);
    const double cross_bar = bar.force * g.by_cross, eps_bar = bar.force * g.by_eps;
    out.x[0] -= cross_bar * g.cross_1;
    out.x[1] += cross_bar * g.cross_1;
    out.x[2] -= cross_bar * g.cross_2;
    out.x[3] += cross_bar * g.cross_2;
    if (eps_bar == 0) return out;
    const Four eps_gradient = mollifier_eps_gradient(g.X[0], g.X[1], g.X[2], g.X[3]);
    for (int i = 0; i < 4; ++i) out.X[i] += eps_bar * eps_gradient[i];
    return out;
}

// The contact's slide at the poses where it acts.
struct Sliding {
    double mu = 0, load = 0;  // load = mu lambda
    Matrix34 moved_first, moved_second;
    Vector3 moved, along;        // m, s
    double first_by_y = 0;       // f0'/|s|
    double second_less_first{};  // (f0'' - f0'/|s|) / |s|^2: 0 at rest, where it is bounded and s is not there
    Vector3 force() const { return load * first_by_y * along; }
    // dF along ds, a symmetric matrix.
    Vector3 stiffness_times(const Vector3& ds) const { return load * (first_by_y * ds + second_less_first * along.dot(ds) * along); }
};

Sliding sliding(const FrictionAtPose& at, const BodyPairContacts& list, const Lagged& g, double mu) {
    Sliding s;
    s.mu = mu;
    s.load = mu * g.force;
    s.moved_first = pose_matrix(at.poses[list.first]) - at.slip_reference[list.first];
    s.moved_second = pose_matrix(at.poses[list.second]) - at.slip_reference[list.second];
    const Eigen::Vector4d first = g.point_first.homogeneous(), second = g.point_second.homogeneous();
    s.moved = s.moved_first * first - s.moved_second * second;
    s.along = across(g.normal, s.moved);
    const double y = s.along.norm();
    const core::contact::FrictionMollifier f = core::contact::friction_mollifier(y, at.slip_bound);
    s.first_by_y = f.first_by_y;
    if (y > 0) s.second_less_first = (f.second - f.first_by_y) / (y * y);
    return s;
}

std::pair<int, int> in_order(const BodyPairContacts& list) { return std::minmax(list.first, list.second); }

Matrix34 motion_of(const Vector6& lambda, const Matrix3& rotation) {
    Matrix34 v;
    v << cross_matrix(lambda.tail<3>()) * rotation, lambda.head<3>();
    return v;
}

// Calls visit(list, lagged, sliding) for each contact that has friction.
template <class Visit>
void for_each_contact(const FrictionAtPose& at, const Visit& visit) {
    std::size_t place = 0;  // in the order of all contacts
    for (const BodyPairContacts& list : at.lag.contacts.pairs) {
        const double mu = friction_coefficient(at.model, list.first, list.second);
        for (const ContactPair& pair : list.contacts) {
            const std::size_t here = place++;
            if (!(mu > 0) || !(normal_force(pair, at.parameters) > 0)) continue;
            Lagged g = lagged(at, list, pair);
            if (at.model.area_weighted) g.of_weight = &at.lag.areas.shares[here];
            visit(list, g, sliding(at, list, g, mu));
        }
    }
}

}  // namespace

void subtract_friction_adjoint(const FrictionAtPose& at, const std::vector<std::vector<Vector6>>& lambda, const FrictionAdjoint& bar) {
    for_each_contact(at, [&](const BodyPairContacts& list, const Lagged& g, const Sliding& slide) {
        const Eigen::Vector4d first = g.point_first.homogeneous(), second = g.point_second.homogeneous();
        for (std::size_t s = 0; s < lambda.size(); ++s) {
            const Matrix34 v_first = motion_of(lambda[s][list.first], at.poses[list.first].rotation);
            const Matrix34 v_second = motion_of(lambda[s][list.second], at.poses[list.second].rotation);
            const Vector3 nu = v_first * first - v_second * second;
            const Vector3 k = slide.stiffness_times(nu), moved_bar = across(g.normal, k);
            const double rate = slide.first_by_y * slide.along.dot(nu);
            LagParts lag_bar;
            lag_bar.force = slide.mu * rate;
            lag_bar.normal = -(g.normal.dot(slide.moved) * k + g.normal.dot(k) * slide.moved);
            lag_bar.point_first =
                slide.moved_first.leftCols<3>().transpose() * moved_bar + v_first.leftCols<3>().transpose() * slide.force();
            lag_bar.point_second =
                -(slide.moved_second.leftCols<3>().transpose() * moved_bar + v_second.leftCols<3>().transpose() * slide.force());
            if (g.of_weight != nullptr) add_weight_gradient(*g.of_weight, -lag_bar.force * g.force / g.pair.weight, bar.areas_bar[s]);
            const LagChange change = lag_adjoint(g, lag_bar);
            for (int i = 0; i < 4; ++i) {
                const auto body = static_cast<std::size_t>(g.body[i]);
                bar.lag_poses_bar[s][body] -= change.x[i] * g.X[i].homogeneous().transpose();
                add_vertex_gradient(at.model.bodies[body], g.pair.vertex[i],
                                    -(change.X[i] + at.lag.poses[body].rotation.transpose() * change.x[i]),
                                    bar.model_bar[s].bodies[body].vertices_bar);
            }
            for (std::size_t k = 0; k < 2 && g.pair.round.side != 0; ++k) {
                const auto body = static_cast<std::size_t>(k == 0 ? list.first : list.second);
                bar.lag_poses_bar[s][body].leftCols<3>() -= change.rotation[k];
                add_reach_gradient(at.model.bodies[body], g.pair.round, k, -change.reach[k], bar.model_bar[s].bodies[body].vertices_bar);
            }
            bar.slip_reference_bar[s][list.first] += moved_bar * first.transpose();
            bar.slip_reference_bar[s][list.second] -= moved_bar * second.transpose();
            bar.model_bar[s].friction_bar[in_order(list)] -= g.force * rate;
            bar.model_bar[s].dmin_bar -= lag_bar.force * g.by_dmin;
        }
    });
}

void add_friction_tangent(const FrictionAtPose& at, const FrictionTangent& dot, const ModelTangent& direction, PoseGradientTangent& out) {
    for_each_contact(at, [&](const BodyPairContacts& list, const Lagged& g, const Sliding& slide) {
        LagChange lag_dot;
        for (int i = 0; i < 4; ++i) {
            const auto body = static_cast<std::size_t>(g.body[i]);
            lag_dot.X[i] = vertex_tangent(at.model.bodies[body], g.pair.vertex[i], direction.bodies[body].vertices_dot);
            lag_dot.x[i] = dot.lag_poses_dot[body] * g.X[i].homogeneous() + at.lag.poses[body].rotation * lag_dot.X[i];
        }
        for (std::size_t k = 0; k < 2 && g.pair.round.side != 0; ++k) {
            const auto body = static_cast<std::size_t>(k == 0 ? list.first : list.second);
            lag_dot.rotation[k] = dot.lag_poses_dot[body].leftCols<3>();
            lag_dot.reach[k] = reach_tangent(at.model.bodies[body], g.pair.round, k, direction.bodies[body].vertices_dot);
        }
        LagParts change = lag_tangent(g, lag_dot);
        change.force += direction.dmin_dot * g.by_dmin;
        if (g.of_weight != nullptr) change.force += weight_tangent(*g.of_weight, dot.areas_dot) * g.force / g.pair.weight;
        const Eigen::Vector4d first = g.point_first.homogeneous(), second = g.point_second.homogeneous();
        const Vector3 moved_dot = (dot.poses_dot[list.first] - dot.slip_reference_dot[list.first]) * first -
                                  (dot.poses_dot[list.second] - dot.slip_reference_dot[list.second]) * second +
                                  slide.moved_first.leftCols<3>() * change.point_first -
                                  slide.moved_second.leftCols<3>() * change.point_second;
        const Vector3 along_dot =
            across(g.normal, moved_dot) - change.normal * g.normal.dot(slide.moved) - g.normal * change.normal.dot(slide.moved);
        const auto moved_mu = direction.friction_dot.find(in_order(list));
        const double mu_dot = moved_mu == direction.friction_dot.end() ? 0 : moved_mu->second;
        const double load_dot = mu_dot * g.force + slide.mu * change.force;
        const Vector3 force = slide.force();
        const Vector3 force_dot = slide.stiffness_times(along_dot) + load_dot * slide.first_by_y * slide.along;
        out.value[list.first] += force * first.transpose();
        out.value[list.second] -= force * second.transpose();
        out.dot[list.first] += force_dot * first.transpose();
        out.dot[list.second] -= force_dot * second.transpose();
        out.dot[list.first].leftCols<3>() += force * change.point_first.transpose();
        out.dot[list.second].leftCols<3>() -= force * change.point_second.transpose();
    });
}

}  // namespace fettle::adjoint::contact
