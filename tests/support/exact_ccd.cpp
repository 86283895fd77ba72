// SPDX-License-Identifier: MIT
#include "exact_ccd.hpp"

#include <algorithm>
#include <boost/multiprecision/gmp.hpp>
#include <vector>

namespace fettle::tests {

using core::contact::PairType;
using core::contact::PairVertices;

namespace {

using Number = boost::multiprecision::number<boost::multiprecision::gmp_rational, boost::multiprecision::et_off>;

int sign_of(const Number& x) { return x > 0 ? 1 : (x < 0 ? -1 : 0); }

/// Coefficients from the constant up, no leading zeros; empty is 0.
struct Polynomial {
    std::vector<Number> c;

    void trim() {
        while (!c.empty() && c.back() == 0) c.pop_back();
    }
    bool zero() const { return c.empty(); }
    std::size_t size() const { return c.size(); }
    Number at(const Number& t) const {
        Number v = 0;
        for (auto it = c.rbegin(); it != c.rend(); ++it) v = v * t + *it;
        return v;
    }
};

Polynomial operator+(const Polynomial& a, const Polynomial& b) {
    Polynomial r{a.c};
    if (r.size() < b.size()) r.c.resize(b.size());
    for (std::size_t i = 0; i < b.size(); ++i) r.c[i] += b.c[i];
    r.trim();
    return r;
}
Polynomial operator-(const Polynomial& a) {
    Polynomial r{a.c};
    for (Number& x : r.c) x = -x;
    return r;
}
Polynomial operator-(const Polynomial& a, const Polynomial& b) { return a + (-b); }
Polynomial operator*(const Polynomial& a, const Polynomial& b) {
    if (a.zero() || b.zero()) return {};
    Polynomial r;
    r.c.resize(a.size() + b.size() - 1);
    for (std::size_t i = 0; i < a.size(); ++i)
        for (std::size_t j = 0; j < b.size(); ++j) r.c[i + j] += a.c[i] * b.c[j];
    return r;
}
Polynomial derivative(const Polynomial& a) {
    Polynomial r;
    for (std::size_t i = 1; i < a.size(); ++i) r.c.push_back(a.c[i] * static_cast<int>(i));
    return r;
}

struct Division {
    Polynomial quotient, remainder;
};
Division divide(Polynomial a, const Polynomial& b) {
    Division d;
    if (a.size() >= b.size()) d.quotient.c.resize(a.size() - b.size() + 1);
    while (a.size() >= b.size()) {
        const std::size_t shift = a.size() - b.size();
        const Number factor = a.c.back() / b.c.back();
        d.quotient.c[shift] = factor;
        for (std::size_t i = 0; i + 1 < b.size(); ++i) a.c[shift + i] -= factor * b.c[i];
        a.c.pop_back();
        a.trim();
    }
    d.remainder = a;
    return d;
}
Polynomial common_divisor(Polynomial a, Polynomial b) {
    while (!b.zero()) {
        Polynomial r = divide(a, b).remainder;
        a = b;
        b = r;
    }
    return a;
}
Polynomial square_free(const Polynomial& a) {
    const Polynomial d = common_divisor(a, derivative(a));
    return d.size() <= 1 ? a : divide(a, d).quotient;
}

/// Counts distinct roots in (low, high]. For a polynomial that is not zero.
class Sturm {
public:
    explicit Sturm(const Polynomial& p) {
        chain_.push_back(square_free(p));
        Polynomial next = derivative(chain_.back());
        while (!next.zero()) {
            chain_.push_back(next);
            next = -divide(chain_[chain_.size() - 2], next).remainder;
        }
    }
    int count(const Number& low, const Number& high) const { return variations(low) - variations(high); }

private:
    int variations(const Number& t) const {
        int changes = 0, last = 0;
        for (const Polynomial& p : chain_) {
            const int s = sign_of(p.at(t));
            if (s != 0 && last != 0 && s != last) ++changes;
            if (s != 0) last = s;
        }
        return changes;
    }
    std::vector<Polynomial> chain_;
};

/// The one root of `polynomial` (square-free) in (low, high].
struct Root {
    Polynomial polynomial;
    Number low, high;
};

int sign_at(const Polynomial& h, Root root) {
    if (h.zero()) return 0;
    if (h.size() == 1) return sign_of(h.c[0]);
    const Polynomial shared = common_divisor(root.polynomial, h);
    if (shared.size() > 1 && Sturm(shared).count(root.low, root.high) > 0) return 0;
    const Sturm own(root.polynomial), other(h);
    while (other.count(root.low, root.high) > 0) {
        const Number middle = (root.low + root.high) / 2;
        (own.count(root.low, middle) > 0 ? root.high : root.low) = middle;
    }
    return sign_of(h.at(root.high));
}

void isolate(const Polynomial& p, const Sturm& sturm, const Number& low, const Number& high, std::vector<Root>& roots) {
    const int n = sturm.count(low, high);
    if (n == 0) return;
    if (n == 1) {
        roots.push_back({p, low, high});
        return;
    }
    const Number middle = (low + high) / 2;
    isolate(p, sturm, low, middle, roots);
    isolate(p, sturm, middle, high, roots);
}

/// equations = 0, inequalities >= 0, nonzero != 0.
struct System {
    std::vector<Polynomial> equations, inequalities, nonzero;

    bool holds_at(const Number& t) const {
        return std::all_of(equations.begin(), equations.end(), [&](const auto& p) { return p.at(t) == 0; }) &&
               std::all_of(inequalities.begin(), inequalities.end(), [&](const auto& p) { return p.at(t) >= 0; }) &&
               std::all_of(nonzero.begin(), nonzero.end(), [&](const auto& p) { return p.at(t) != 0; });
    }
    bool holds_at(const Root& root) const {
        return std::all_of(equations.begin(), equations.end(), [&](const auto& p) { return sign_at(p, root) == 0; }) &&
               std::all_of(inequalities.begin(), inequalities.end(), [&](const auto& p) { return sign_at(p, root) >= 0; }) &&
               std::all_of(nonzero.begin(), nonzero.end(), [&](const auto& p) { return sign_at(p, root) != 0; });
    }
    bool has_solution() const {
        if (holds_at(Number(0)) || holds_at(Number(1))) return true;
        Polynomial shared;
        for (const Polynomial& p : equations) shared = common_divisor(shared, p);
        std::vector<Polynomial> candidates{shared};
        if (shared.zero()) candidates = inequalities;
        for (const Polynomial& p : candidates) {
            if (p.size() <= 1) continue;
            const Polynomial simple = square_free(p);
            std::vector<Root> roots;
            isolate(simple, Sturm(simple), Number(0), Number(1), roots);
            if (std::any_of(roots.begin(), roots.end(), [&](const Root& r) { return holds_at(r); })) return true;
        }
        return false;
    }
};

using Point = std::array<Polynomial, 3>;

Point operator-(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Polynomial dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Point cross(const Point& a, const Point& b) { return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}; }

bool vertices_meet(const Point& a, const Point& b) {
    const Point d = a - b;
    return System{{d[0], d[1], d[2]}, {}, {}}.has_solution();
}

bool vertex_meets_edge(const Point& p, const Point& a, const Point& b) {
    const Point e = b - a, w = p - a, n = cross(e, w);
    const Polynomial along = dot(e, w), length = dot(e, e);
    return System{{n[0], n[1], n[2]}, {along, length - along}, {length}}.has_solution() || vertices_meet(p, a) || vertices_meet(p, b);
}

/// No contact of the interior if a cubic's Bernstein coefficients have one sign.
bool keeps_sign(const Polynomial& f) {
    std::array<Number, 4> c{};
    std::copy(f.c.begin(), f.c.end(), c.begin());
    const std::array<int, 4> s{sign_of(c[0]), sign_of(3 * c[0] + c[1]), sign_of(3 * c[0] + 2 * c[1] + c[2]),
                               sign_of(c[0] + c[1] + c[2] + c[3])};
    return s[0] != 0 && s[1] == s[0] && s[2] == s[0] && s[3] == s[0];
}

bool vertex_meets_triangle(const std::array<Point, 4>& x) {
    const Point n = cross(x[2] - x[1], x[3] - x[1]);
    const Polynomial f = dot(n, x[0] - x[1]);
    if (keeps_sign(f)) return false;
    System face{{f}, {}, {dot(n, n)}};
    for (int i = 0; i < 3; ++i) {
        const Point &a = x[1 + i], &b = x[1 + (i + 1) % 3];
        face.inequalities.push_back(dot(n, cross(b - a, x[0] - a)));
    }
    return face.has_solution() || vertex_meets_edge(x[0], x[1], x[2]) || vertex_meets_edge(x[0], x[2], x[3]) ||
           vertex_meets_edge(x[0], x[3], x[1]);
}

bool edges_meet(const std::array<Point, 4>& x) {
    const Point p = x[1] - x[0], q = x[3] - x[2], w = x[2] - x[0], n = cross(p, q);
    const Polynomial f = dot(n, w);
    if (keeps_sign(f)) return false;
    const Polynomial nn = dot(n, n), s = dot(cross(w, q), n), t = dot(cross(w, p), n);
    return System{{f}, {s, nn - s, t, nn - t}, {nn}}.has_solution() || vertex_meets_edge(x[0], x[2], x[3]) ||
           vertex_meets_edge(x[1], x[2], x[3]) || vertex_meets_edge(x[2], x[0], x[1]) || vertex_meets_edge(x[3], x[0], x[1]);
}

std::array<Point, 4> moving(const PairVertices& t0, const PairVertices& t1) {
    std::array<Point, 4> x;
    for (std::size_t i = 0; i < 4; ++i)
        for (int k = 0; k < 3; ++k) {
            const Number a(t0[i][k]), b(t1[i][k]);
            x[i][static_cast<std::size_t>(k)].c = {a, b - a};
            x[i][static_cast<std::size_t>(k)].trim();
        }
    return x;
}

using Fixed = std::array<Number, 3>;
Fixed operator-(const Fixed& a, const Fixed& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Number dot(const Fixed& a, const Fixed& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Fixed cross(const Fixed& a, const Fixed& b) { return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}; }

Number vertex_edge_squared(const Fixed& p, const Fixed& a, const Fixed& b) {
    const Fixed e = b - a, w = p - a;
    const Number along = dot(e, w), length = dot(e, e);
    if (along <= 0 || length == 0) return dot(w, w);
    if (along >= length) return dot(p - b, p - b);
    return dot(w, w) - along * along / length;
}

Number distance_squared(PairType type, const std::array<Fixed, 4>& x) {
    if (type == PairType::point_triangle) {
        const Fixed n = cross(x[2] - x[1], x[3] - x[1]);
        const Number nn = dot(n, n), off = dot(n, x[0] - x[1]);
        bool inside = nn > 0;
        for (std::size_t i = 0; i < 3; ++i) inside = inside && dot(n, cross(x[1 + (i + 1) % 3] - x[1 + i], x[0] - x[1 + i])) >= 0;
        if (inside) return off * off / nn;
        return std::min(
            {vertex_edge_squared(x[0], x[1], x[2]), vertex_edge_squared(x[0], x[2], x[3]), vertex_edge_squared(x[0], x[3], x[1])});
    }
    const Fixed p = x[1] - x[0], q = x[3] - x[2], w = x[2] - x[0], n = cross(p, q);
    const Number nn = dot(n, n), s = dot(cross(w, q), n), t = dot(cross(w, p), n), off = dot(n, w);
    if (nn > 0 && s >= 0 && s <= nn && t >= 0 && t <= nn) return off * off / nn;
    return std::min({vertex_edge_squared(x[0], x[2], x[3]), vertex_edge_squared(x[1], x[2], x[3]), vertex_edge_squared(x[2], x[0], x[1]),
                     vertex_edge_squared(x[3], x[0], x[1])});
}

}  // namespace

bool exact_linear_contact(PairType type, const PairVertices& t0, const PairVertices& t1) {
    const std::array<Point, 4> x = moving(t0, t1);
    return type == PairType::point_triangle ? vertex_meets_triangle(x) : edges_meet(x);
}

bool exact_distance_at_most(PairType type, const PairVertices& t0, const PairVertices& t1, double t, double distance) {
    std::array<Fixed, 4> x;
    for (std::size_t i = 0; i < 4; ++i)
        for (int k = 0; k < 3; ++k)
            x[i][static_cast<std::size_t>(k)] = Number(t0[i][k]) + Number(t) * (Number(t1[i][k]) - Number(t0[i][k]));
    return distance_squared(type, x) <= Number(distance) * Number(distance);
}

}  // namespace fettle::tests
