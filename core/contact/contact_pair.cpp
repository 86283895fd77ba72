// SPDX-License-Identifier: MIT
#include "core/contact/contact_pair.hpp"

#include <algorithm>

#include "core/base/four.hpp"
#include "core/linear/positive_part.hpp"

namespace fettle::core::contact {
namespace {

using geometry::ClosestPoints;

// m and its derivatives for a pair (1 unless nearly parallel edges).
ScalarDerivatives mollifier_of(const ContactPair& pair) {
    if (pair.type == geometry::PairType::point_triangle || pair.round.side != 0) return {1, 0, 0};
    return edge_mollifier(edge_cross_squared(pair.x), pair.mollifier_eps);
}

// b in the gap s itself.
ScalarDerivatives barrier_of_gap(double s, const BarrierParameters& p) {
    const ScalarDerivatives b = barrier(s * s - p.dmin * p.dmin, p.gap_hat);
    return {b.value, 2 * s * b.first, 4 * s * s * b.second + 2 * b.first};
}

// In D of what is f in d.
ScalarDerivatives in_square(const ScalarDerivatives& f, double d) {
    const double first = f.first / (2 * d);
    return {f.value, first, (f.second - 2 * first) / (4 * d * d)};
}

ScalarDerivatives barrier_of_round(const ContactPair& pair, const BarrierParameters& p) {
    constexpr double rounding = 1e-12, concentric = 1e-6;  // of R
    const double d = std::sqrt(pair.closest.distance_squared), radius = pair.round.radius();
    const ScalarDerivatives b = round_barrier(pair, p).in_distance;
    if (pair.round.has_far && d < concentric * radius) return {b.value, 0.5 * b.second, 0};
    return in_square(b, std::max(d, rounding * radius));
}

// Interior parameters' directions r_a, made orthonormal in one go: K = L L^T, columns of the result times L^T give r_a.
struct FreeDirections {
    std::array<Vector3, 2> r;  // r_a = sum_i w'_a,i x_i
    Matrix2 l;                 // Cholesky factor of K (free_count 1: only (0,0))
};

FreeDirections free_directions(const ClosestPoints& c, const geometry::PairVertices& x) {
    FreeDirections d;
    for (int a = 0; a < c.free_count; ++a) {
        d.r[a].setZero();
        for (int i = 0; i < 4; ++i) d.r[a] += c.free_weight[a][i] * x[i];
    }
    d.l.setZero();
    if (c.free_count == 0) return d;
    d.l(0, 0) = d.r[0].norm();
    if (c.free_count == 1) return d;
    const Vector3 t0 = d.r[0] / d.l(0, 0);
    d.l(1, 0) = t0.dot(d.r[1]);
    // |r1 x t0| rather than sqrt(|r1|^2 - l10^2): accurate for nearly parallel directions.
    d.l(1, 1) = d.r[1].cross(t0).norm();
    return d;
}

// Solves L y = (a0, a1) for vector-valued right-hand sides, in place.
template <class V>
void forward_solve(const Matrix2& l, int count, std::array<V, 2>& a) {
    if (count > 0) a[0] = a[0] / l(0, 0);
    if (count > 1) a[1] = (a[1] - l(1, 0) * a[0]) / l(1, 1);
}

// Column by column, four rows at a time but for the last; of rows above the diagonal only what comes along.
[[gnu::always_inline]] inline void add_columns(double factor, const PairVector& v, PairMatrix& h) {
    const auto add = [](double scale, const double* from, double* to) __attribute__((always_inline)) {
        base::Four x, y;
        base::load(from, x);
        base::load(to, y);
        base::store(y + scale * x, to);
    };
    for (int j = 0; j < 9; ++j) {
        double* column = h.data() + 9 * j;
        const double scale = factor * v[j];
        if (j < 4) add(scale, v.data(), column);
        if (j < 8) add(scale, v.data() + 4, column + 4);
        column[8] += scale * v[8];
    }
}

FETTLE_WIDE void add_columns_wide(double factor, const PairVector& v, PairMatrix& h) { add_columns(factor, v, h); }

// Pull-back of the pattern w (x) m (m at the closest point of the first body, -m at that of the second).
PairVector pull_back(const Vector3& m, const Vector3& arm_first, const Vector3& arm_second) {
    PairVector v;
    v.segment<3>(0) = m;
    v.segment<3>(3) = arm_first.cross(m);
    v.segment<3>(6) = m.cross(arm_second);
    return v;
}

struct Arms {
    Vector3 first, second;  // closest points relative to the bodies' positions
};

Arms arms_of(const ContactPair& pair, const Vector3& first_position, const Vector3& second_position) {
    const auto& w = pair.closest.weight;
    Arms a{Vector3::Zero(), Vector3::Zero()};
    const int n = geometry::first_count(pair.type);
    for (int i = 0; i < n; ++i) a.first += w[i] * (pair.x[i] - first_position);
    for (int i = n; i < 4; ++i) a.second -= w[i] * (pair.x[i] - second_position);
    return a;
}

// Does interior parameter a belong to the first body?
bool on_first(const ContactPair& pair, int a) {
    return pair.closest.free_weight[a][0] != 0 || (pair.type == geometry::PairType::edge_edge && pair.closest.free_weight[a][1] != 0);
}

// How the interior parameters follow: the slide patterns (w (x) r_a) and the turn patterns (w'_a (x) n), both times L^-1.
struct Following {
    int count = 0;
    std::array<PairVector, 2> slide, turn;
    std::array<double, 2> spread{};  // crude sizes of the turn patterns' weights
};

Following following_of(const ContactPair& pair, const Arms& arms, const Vector3& n) {
    const ClosestPoints& c = pair.closest;
    const FreeDirections free = free_directions(c, pair.x);
    Following f;
    f.count = c.free_count;
    std::array<Vector2, 2> spread{};
    for (int a = 0; a < c.free_count; ++a) {
        f.slide[a] = pull_back(free.r[a], arms.first, arms.second);
        f.turn[a].setZero();
        f.turn[a].segment<3>(on_first(pair, a) ? 3 : 6) = free.r[a].cross(n);
        spread[a] = Vector2::Unit(a);
    }
    forward_solve(free.l, c.free_count, f.slide);
    forward_solve(free.l, c.free_count, f.turn);
    forward_solve(free.l, c.free_count, spread);
    for (int a = 0; a < c.free_count; ++a) f.spread[a] = spread[a].norm();
    return f;
}

// Adds the true second derivative of factor * b(D) to h, without the curvature of the rotations.
void add_exact_distance_hessian(const ContactPair& pair, const Arms& arms, const ScalarDerivatives& b, PairMatrix& h) {
    const double d = std::sqrt(pair.closest.distance_squared);
    const Vector3 n = contact_normal(pair);
    add_outer_product(h, 4 * b.second * pair.closest.distance_squared + 2 * b.first, pull_back(n, arms.first, arms.second));
    const double tension = -2 * b.first;  // >= 0
    const Following f = following_of(pair, arms, n);
    for (int j = 0; j < f.count; ++j) add_outer_product(h, tension, f.slide[j] + d * f.turn[j]);
    // - tension * (projector on the tangent plane) pattern: two orthonormal tangents of n.
    const Vector3 t1 = n.unitOrthogonal();
    add_outer_product(h, -tension, pull_back(t1, arms.first, arms.second));
    add_outer_product(h, -tension, pull_back(n.cross(t1), arms.first, arms.second));
}

// Its positive part but for what lies along n.
void add_positive_sliding(const ContactPair& pair, const Arms& arms, double tension, double d, const Vector3& n, PairMatrix& h) {
    const Following f = following_of(pair, arms, n);
    double weight_squared = 0;
    for (double w : pair.closest.weight) weight_squared += w * w;
    for (int j = 0; j < f.count; ++j) {
        // (p + d s)(p + d s)^T - p p^T = d (p s^T + s p^T) + d^2 s s^T: its positive eigenvector in the basis (p, s), scaled to unit
        // patterns.
        const double rho_p = std::sqrt(weight_squared), rho_s = std::sqrt(2.0) * f.spread[j];
        const double off = d * rho_p * rho_s, corner = d * d * rho_s * rho_s;
        const double eigenvalue = 0.5 * (corner + std::sqrt(corner * corner + 4 * off * off));
        const double norm_squared = off * off + eigenvalue * eigenvalue;
        if (!(norm_squared > 0)) continue;
        add_outer_product(h, tension * eigenvalue / norm_squared, (off / rho_p) * f.slide[j] + (eigenvalue / rho_s) * f.turn[j]);
    }
}

// Adds the positive part of  nn v v^T + vw (v w^T + w v^T) + ww w w^T,  v and w taken as right-angled.
void add_positive_pair(double nn, double vw, double ww, const PairVector& v, const PairVector& w, PairMatrix& h) {
    const double size_v = v.norm(), size_w = w.norm();
    const double a = nn * size_v * size_v, b = vw * size_v * size_w, c = ww * size_w * size_w;
    const double middle = 0.5 * (a + c), radius = std::hypot(0.5 * (a - c), b);
    if (b == 0) {
        if (a > 0) add_outer_product(h, nn, v);
        if (c > 0) add_outer_product(h, ww, w);
        return;
    }
    if (middle >= radius) {  // positive as it is
        add_outer_product(h, nn - vw * vw / ww, v);
        add_outer_product(h, ww, w + (vw / ww) * v);
        return;
    }
    const double eigenvalue = middle + radius;
    if (!(eigenvalue > 0)) return;
    // (b, eigenvalue - a) is the eigenvector; the other form where that cancels.
    const double x = a <= c ? b : eigenvalue - c, y = a <= c ? eigenvalue - a : b;
    add_outer_product(h, eigenvalue / (x * x + y * y), (x / size_v) * v + (y / size_w) * w);
}

// Gauss-Newton Hessian of factor * b(D), added to h.
void add_distance_hessian(const ContactPair& pair, const Arms& arms, const ScalarDerivatives& b, HessianKind kind, PairMatrix& h) {
    if (kind == HessianKind::exact) return add_exact_distance_hessian(pair, arms, b, h);
    const double d = std::sqrt(pair.closest.distance_squared);
    const Vector3 n = contact_normal(pair);
    if (pair.weight < 0) {  // only what the exact one takes off is left
        const Vector3 t1 = n.unitOrthogonal();
        for (const Vector3& t : {t1, Vector3(n.cross(t1))}) add_outer_product(h, 2 * b.first, pull_back(t, arms.first, arms.second));
        return;
    }
    const double normal = 4 * b.second * pair.closest.distance_squared + 2 * b.first;
    if (normal > 0) add_outer_product(h, normal, pull_back(n, arms.first, arms.second));
    if (b.first > 0) {  // round surfaces, one inside the other: it draws across the centre line, too
        const Following f = following_of(pair, arms, n);
        const Vector3 t = f.count > 0 ? Vector3(free_directions(pair.closest, pair.x).r[0].cross(n).normalized()) : n.unitOrthogonal();
        add_outer_product(h, 2 * b.first, pull_back(t, arms.first, arms.second));
        return;
    }
    add_positive_sliding(pair, arms, -2 * b.first, d, n, h);
}

// Derivatives of c = |e1 x e2|^2.
struct EdgeCross {
    Vector3 e1, e2, c1, c2;  // edges, dc/de1, dc/de2
    Matrix3 c11, c12, c22;   // second derivatives
};

EdgeCross edge_cross(const geometry::PairVertices& x) {
    EdgeCross k;
    k.e1 = x[1] - x[0];
    k.e2 = x[3] - x[2];
    const Vector3 n = k.e1.cross(k.e2);
    // dc = 2 n . (de1 x e2 + e1 x de2): no cancellation when nearly parallel.
    k.c1 = 2 * k.e2.cross(n);
    k.c2 = 2 * n.cross(k.e1);
    const double a = k.e1.squaredNorm(), b = k.e2.squaredNorm(), ab = k.e1.dot(k.e2);
    k.c11 = 2 * (b * Matrix3::Identity() - k.e2 * k.e2.transpose());
    k.c22 = 2 * (a * Matrix3::Identity() - k.e1 * k.e1.transpose());
    k.c12 = 4 * k.e1 * k.e2.transpose() - 2 * k.e2 * k.e1.transpose() - 2 * ab * Matrix3::Identity();
    return k;
}

// Where two edges are nearly parallel: f m(c) b(D) with m < 1.
struct Mollified {
    ScalarDerivatives m, b;
    EdgeCross k;
    double f;  // factor and weight
};

// The product rule, term by term.
void add_exact_mollified_hessian(const ContactPair& pair, const Arms& arms, const Mollified& q, PairMatrix& h) {
    const ScalarDerivatives &m = q.m, &b = q.b;
    const EdgeCross& k = q.k;
    const double f = q.f;
    if (m.value > 0) add_exact_distance_hessian(pair, arms, {0, f * m.value * b.first, f * m.value * b.second}, h);
    const PairVector dD = 2 * pull_back(pair.closest.difference, arms.first, arms.second);
    PairVector dc = PairVector::Zero();
    dc.segment<3>(3) = k.e1.cross(k.c1);
    dc.segment<3>(6) = k.e2.cross(k.c2);
    // b' m' (dD dc^T + dc dD^T) + b m'' dc dc^T.
    const PairVector across = f * b.first * m.first * dD + 0.5 * f * b.value * m.second * dc;
    h += across * dc.transpose() + dc * across.transpose();
    const Matrix3 j1 = -cross_matrix(k.e1), j2 = -cross_matrix(k.e2);
    const double g = f * b.value * m.first;
    h.block<3, 3>(3, 3) += g * j1.transpose() * k.c11 * j1;
    h.block<3, 3>(6, 6) += g * j2.transpose() * k.c22 * j2;
    h.block<3, 3>(6, 3) += (g * j1.transpose() * k.c12 * j2).transpose();
}

// A positive semi-definite bound of it from above. With N = e1 x e2, d2c = 2 dN^T dN + 4 N . (de1 x de2): the first part as it is, but for
// what m b along n and c along N have in common through b' m'; the second, small as N is, by |de1| and |de2|; the rest each for itself.
void add_positive_mollified_hessian(const ContactPair& pair, const Arms& arms, const Mollified& q, PairMatrix& h) {
    const ScalarDerivatives &m = q.m, &b = q.b;
    const EdgeCross& k = q.k;
    const double d = std::sqrt(pair.closest.distance_squared);
    const Vector3 n = pair.closest.difference / d;
    const Vector3 cross = k.e1.cross(k.e2), along1 = k.e1.normalized(), along2 = k.e2.normalized();
    const double sine = cross.norm();
    const Vector3 t1 = sine > 0 ? Vector3(cross / sine) : k.e1.unitOrthogonal();
    // What t . N changes by.
    const auto turned = [&k](const Vector3& t) {
        PairVector w = PairVector::Zero();
        w.segment<3>(3) = k.e1.cross(k.e2.cross(t));
        w.segment<3>(6) = k.e2.cross(t.cross(k.e1));
        return w;
    };
    const double normal = std::max(0.0, q.f * m.value * (4 * b.second * d * d + 2 * b.first));
    const double coupling = 4 * q.f * b.first * m.first * d * sine;
    const double turning = 2 * q.f * b.value * m.first;
    add_positive_pair(normal, coupling, turning + 4 * q.f * b.value * m.second * sine * sine, pull_back(n, arms.first, arms.second),
                      turned(t1), h);
    add_outer_product(h, turning, turned(along1.cross(t1)));
    add_outer_product(h, turning, turned(along1));
    const double second = turning * sine * std::sqrt(k.e1.squaredNorm() * k.e2.squaredNorm());
    h.block<3, 3>(3, 3) += second * (Matrix3::Identity() - along1 * along1.transpose());
    h.block<3, 3>(6, 6) += second * (Matrix3::Identity() - along2 * along2.transpose());
    if (m.value > 0) add_positive_sliding(pair, arms, -2 * q.f * m.value * b.first, d, n, h);
}

void add_mollified(const ContactPair& pair, const Arms& arms, const BarrierParameters& p, HessianKind kind, BodyPairSum& sum) {
    const Mollified q{mollifier_of(pair), barrier_of(pair, p), edge_cross(pair.x), p.factor * pair.weight};
    const Vector3 force = 2 * q.f * q.m.value * q.b.first * pair.closest.difference;
    sum.first.add_force(force, arms.first);
    sum.second.add_force(-force, arms.second);
    const double turning = q.f * q.b.value * q.m.first;
    sum.first.arm += turning * q.k.c1 * q.k.e1.transpose();
    sum.second.arm += turning * q.k.c2 * q.k.e2.transpose();
    if (kind == HessianKind::none) return;
    if (kind == HessianKind::exact)
        add_exact_mollified_hessian(pair, arms, q, sum.hessian);
    else
        add_positive_mollified_hessian(pair, arms, q, sum.hessian);
}

}  // namespace

RoundBarrier round_barrier(const ContactPair& pair, const BarrierParameters& p) {
    const RoundGap& round = pair.round;
    const double d = std::sqrt(pair.closest.distance_squared), radius = round.radius();
    const ScalarDerivatives near = barrier_of_gap(round.side * (d - radius), p);
    if (!round.has_far) return {{near.value, round.side * near.first, near.second}, -near.second};
    const ScalarDerivatives far = barrier_of_gap(radius + d, p);
    return {{near.value + far.value, far.first - near.first, near.second + far.second}, far.second - near.second};
}

Vector3 contact_normal(const ContactPair& pair) {
    const double d = std::sqrt(pair.closest.distance_squared);
    return d > 0 || pair.round.side == 0 ? Vector3(pair.closest.difference / d) : (pair.x[2] - pair.x[1]).unitOrthogonal();
}

ScalarDerivatives barrier_of(const ContactPair& pair, const BarrierParameters& p) {
    if (pair.round.side != 0) return barrier_of_round(pair, p);
    return barrier(pair.closest.distance_squared - p.dmin * p.dmin, p.gap_hat);
}

void add_outer_product(PairMatrix& hessian, double factor, const PairVector& v) {
    if (base::has_wide_instructions())
        add_columns_wide(factor, v, hessian);
    else
        add_columns(factor, v, hessian);
}

PairMatrix positive_part(const PairMatrix& lower) {
    const linear::SymmetricEigen<9> eigen = linear::symmetric_eigen<9>(lower);
    return eigen.values[0] >= 0 ? lower : PairMatrix(linear::positive_part(eigen));
}

Matrix12 in_both_bodies(const PairMatrix& hessian) {
    const PairMatrix h = hessian.selfadjointView<Eigen::Lower>();
    const auto shift = h.topLeftCorner<3, 3>();
    const auto shift_first = h.block<3, 3>(0, 3), shift_second = h.block<3, 3>(0, 6);
    Matrix12 full;
    full << shift, shift_first, -shift, shift_second,                                                 //
        shift_first.transpose(), h.block<3, 3>(3, 3), -shift_first.transpose(), h.block<3, 3>(3, 6),  //
        -shift, -shift_first, shift, -shift_second,                                                   //
        shift_second.transpose(), h.block<3, 3>(6, 3), -shift_second.transpose(), h.block<3, 3>(6, 6);
    return full;
}

double pair_potential(const ContactPair& pair, const BarrierParameters& p) {
    const double d = gap_of(pair), gap = d * d - p.dmin * p.dmin;
    if (gap >= p.gap_hat) return 0;
    return p.factor * pair.weight * mollifier_of(pair).value * barrier_of(pair, p).value;
}

double normal_force(const ContactPair& pair, const BarrierParameters& p) {
    const double force =
        -2 * p.factor * pair.weight * mollifier_of(pair).value * barrier_of(pair, p).first * std::sqrt(pair.closest.distance_squared);
    return pair.round.side < 0 ? -force : force;
}

void add_rigid_stiffness(PairMatrix& hessian, double stiffness, const Vector3& direction, const Vector3& arm_first,
                         const Vector3& arm_second) {
    add_outer_product(hessian, stiffness, pull_back(direction, arm_first, arm_second));
}

std::array<Vector3, 4> pair_forces(const ContactPair& pair, const BarrierParameters& p) {
    const ScalarDerivatives m = mollifier_of(pair);
    const ScalarDerivatives b = barrier_of(pair, p);
    std::array<Vector3, 4> f;
    for (int i = 0; i < 4; ++i) f[i] = 2 * p.factor * pair.weight * m.value * b.first * pair.closest.weight[i] * pair.closest.difference;
    if (m.first != 0) {
        const EdgeCross k = edge_cross(pair.x);
        const double g = p.factor * pair.weight * b.value * m.first;
        f[0] -= g * k.c1;
        f[1] += g * k.c1;
        f[2] -= g * k.c2;
        f[3] += g * k.c2;
    }
    return f;
}

std::array<Vector3, 4> pair_hessian_product(const ContactPair& pair, const BarrierParameters& p, const std::array<Vector3, 4>& v) {
    const ClosestPoints& c = pair.closest;
    const ScalarDerivatives m = mollifier_of(pair);
    const ScalarDerivatives b = barrier_of(pair, p);
    const Vector3& r = c.difference;

    // d(D) along v, and the change of r when the interior parameters follow: dr = sum w_i v_i + sum_a r_a dbeta_a.
    Vector3 wv = Vector3::Zero();
    for (int i = 0; i < 4; ++i) wv += c.weight[i] * v[i];
    const FreeDirections free = free_directions(c, pair.x);
    std::array<double, 2> beta{0, 0};  // K^-1 (A^T v), A_a^T v = r_a . wv + r . (sum w'_a,i v_i)
    for (int a = 0; a < c.free_count; ++a) {
        Vector3 turn = Vector3::Zero();
        for (int i = 0; i < 4; ++i) turn += c.free_weight[a][i] * v[i];
        beta[a] = free.r[a].dot(wv) + r.dot(turn);
    }
    forward_solve(free.l, c.free_count, beta);
    if (c.free_count > 1) beta[1] /= free.l(1, 1);
    if (c.free_count > 0) beta[0] = (beta[0] - (c.free_count > 1 ? free.l(1, 0) * beta[1] : 0.0)) / free.l(0, 0);
    Vector3 dr = wv;
    for (int a = 0; a < c.free_count; ++a) dr -= beta[a] * free.r[a];

    const double dD = 2 * r.dot(wv);
    const double f = p.factor * pair.weight;
    std::array<Vector3, 4> out;
    for (int i = 0; i < 4; ++i) {
        double slide = 0;  // change of w_i
        for (int a = 0; a < c.free_count; ++a) slide -= beta[a] * c.free_weight[a][i];
        out[i] = f * m.value * (b.second * dD * 2 * c.weight[i] * r + b.first * 2 * (c.weight[i] * dr + slide * r));
    }
    if (m.first == 0) return out;
    const EdgeCross k = edge_cross(pair.x);
    const Vector3 v1 = v[1] - v[0], v2 = v[3] - v[2];
    const double dc = k.c1.dot(v1) + k.c2.dot(v2);
    const Vector3 g1 = k.c11 * v1 + k.c12 * v2, g2 = k.c12.transpose() * v1 + k.c22 * v2;
    const double s = f * (b.first * m.first * dD + b.value * m.second * dc), t = f * b.value * m.first;
    for (int i = 0; i < 4; ++i) out[i] += f * b.first * m.first * dc * 2 * c.weight[i] * r;
    out[0] -= s * k.c1 + t * g1;
    out[1] += s * k.c1 + t * g1;
    out[2] -= s * k.c2 + t * g2;
    out[3] += s * k.c2 + t * g2;
    return out;
}

void add_pair_derivatives(const ContactPair& pair, const BarrierParameters& p, HessianKind kind, const Vector3& first_position,
                          const Vector3& second_position, BodyPairSum& sum) {
    const Arms arms = arms_of(pair, first_position, second_position);
    if (is_mollified(pair)) {
        add_mollified(pair, arms, p, kind, sum);
        return;
    }
    ScalarDerivatives b = barrier_of(pair, p);
    b.first *= p.factor * pair.weight;
    b.second *= p.factor * pair.weight;
    const Vector3 force = 2 * b.first * pair.closest.difference;
    sum.first.add_force(force, arms.first);
    sum.second.add_force(-force, arms.second);
    if (kind != HessianKind::none) add_distance_hessian(pair, arms, b, kind, sum.hessian);
}

}  // namespace fettle::core::contact
