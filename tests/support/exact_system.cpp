// SPDX-License-Identifier: MIT
#include "exact_system.hpp"

#include <algorithm>
#include <type_traits>
#include <vector>

namespace fettle::tests {

namespace {

int sign_of(const Rational& x) { return x > 0 ? 1 : (x < 0 ? -1 : 0); }

/// Coefficients from the constant up, no leading zeros; empty is 0.
struct RationalPolynomial {
    std::vector<Rational> c;

    void trim() {
        while (!c.empty() && c.back() == 0) c.pop_back();
    }
    bool zero() const { return c.empty(); }
    std::size_t size() const { return c.size(); }
    Rational at(const Rational& t) const {
        Rational v = 0;
        for (auto it = c.rbegin(); it != c.rend(); ++it) v = v * t + *it;
        return v;
    }
};

RationalPolynomial operator-(const RationalPolynomial& a) {
    RationalPolynomial r{a.c};
    for (Rational& x : r.c) x = -x;
    return r;
}
RationalPolynomial derivative(const RationalPolynomial& a) {
    RationalPolynomial r;
    for (std::size_t i = 1; i < a.size(); ++i) r.c.push_back(a.c[i] * static_cast<int>(i));
    return r;
}

struct Division {
    RationalPolynomial quotient, remainder;
};
Division divide(RationalPolynomial a, const RationalPolynomial& b) {
    Division d;
    if (a.size() >= b.size()) d.quotient.c.resize(a.size() - b.size() + 1);
    while (a.size() >= b.size()) {
        const std::size_t shift = a.size() - b.size();
        const Rational factor = a.c.back() / b.c.back();
        d.quotient.c[shift] = factor;
        for (std::size_t i = 0; i + 1 < b.size(); ++i) a.c[shift + i] -= factor * b.c[i];
        a.c.pop_back();
        a.trim();
    }
    d.remainder = a;
    return d;
}
RationalPolynomial common_divisor(RationalPolynomial a, RationalPolynomial b) {
    while (!b.zero()) {
        RationalPolynomial r = divide(a, b).remainder;
        a = b;
        b = r;
    }
    return a;
}
RationalPolynomial square_free(const RationalPolynomial& a) {
    const RationalPolynomial d = common_divisor(a, derivative(a));
    return d.size() <= 1 ? a : divide(a, d).quotient;
}

/// Counts distinct roots in (low, high]. For a polynomial that is not zero.
class Sturm {
public:
    explicit Sturm(const RationalPolynomial& p) {
        chain_.push_back(square_free(p));
        RationalPolynomial next = derivative(chain_.back());
        while (!next.zero()) {
            chain_.push_back(next);
            next = -divide(chain_[chain_.size() - 2], next).remainder;
        }
    }
    int count(const Rational& low, const Rational& high) const { return variations(low) - variations(high); }

private:
    int variations(const Rational& t) const {
        int changes = 0, last = 0;
        for (const RationalPolynomial& p : chain_) {
            const int s = sign_of(p.at(t));
            if (s != 0 && last != 0 && s != last) ++changes;
            if (s != 0) last = s;
        }
        return changes;
    }
    std::vector<RationalPolynomial> chain_;
};

/// The one root of `polynomial` (square-free) in (low, high].
struct Root {
    RationalPolynomial polynomial;
    Rational low, high;
};

int sign_at(const RationalPolynomial& h, Root root) {
    if (h.zero()) return 0;
    if (h.size() == 1) return sign_of(h.c[0]);
    const RationalPolynomial shared = common_divisor(root.polynomial, h);
    if (shared.size() > 1 && Sturm(shared).count(root.low, root.high) > 0) return 0;
    const Sturm own(root.polynomial), other(h);
    while (other.count(root.low, root.high) > 0) {
        const Rational middle = (root.low + root.high) / 2;
        (own.count(root.low, middle) > 0 ? root.high : root.low) = middle;
    }
    return sign_of(h.at(root.high));
}

void isolate(const RationalPolynomial& p, const Sturm& sturm, const Rational& low, const Rational& high, std::vector<Root>& roots) {
    const int n = sturm.count(low, high);
    if (n == 0) return;
    if (n == 1) {
        roots.push_back({p, low, high});
        return;
    }
    const Rational middle = (low + high) / 2;
    isolate(p, sturm, low, middle, roots);
    isolate(p, sturm, middle, high, roots);
}

/// equations = 0, inequalities >= 0, nonzero != 0.
struct RationalSystem {
    std::vector<RationalPolynomial> equations, inequalities, nonzero;

    bool holds_at(const Rational& t) const {
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
        if (holds_at(Rational(0)) || holds_at(Rational(1))) return true;
        RationalPolynomial shared;
        for (const RationalPolynomial& p : equations) shared = common_divisor(shared, p);
        std::vector<RationalPolynomial> candidates{shared};
        if (shared.zero()) candidates = inequalities;
        for (const RationalPolynomial& p : candidates) {
            if (p.size() <= 1) continue;
            const RationalPolynomial simple = square_free(p);
            std::vector<Root> roots;
            isolate(simple, Sturm(simple), Rational(0), Rational(1), roots);
            if (std::any_of(roots.begin(), roots.end(), [&](const Root& r) { return holds_at(r); })) return true;
        }
        return false;
    }
};

/// Number of ways to choose k of n <= 4.
constexpr std::array<std::array<int, 5>, 5> choose{{{1, 0, 0, 0, 0}, {1, 1, 0, 0, 0}, {1, 2, 1, 0, 0}, {1, 3, 3, 1, 0}, {1, 4, 6, 4, 1}}};

struct Signs {
    bool any_positive = false, any_negative = false, any_zero = false;
    bool one_sign() const { return !any_zero && any_positive != any_negative; }
    bool none() const { return !any_positive && !any_negative; }
};

/// Signs of the coefficients in Bernstein's basis of degree n: b_j C(n, j) = sum_i C(n - i, n - j) c_i.
template <class Integer>
Signs bernstein_signs(const Polynomial<Integer>& p) {
    Signs signs;
    if (p.size == 0) signs.any_zero = true;
    for (std::size_t j = 0, n = p.size - 1; j < p.size; ++j) {
        Integer sum = 0;
        for (std::size_t i = 0; i <= j; ++i) sum += p.c[i] * choose[n - i][n - j];
        (sum > 0 ? signs.any_positive : sum < 0 ? signs.any_negative : signs.any_zero) = true;
    }
    return signs;
}

template <class Integer>
Integer value_at_end(const Polynomial<Integer>& p) {
    return p.c[0] + p.c[1] + p.c[2] + p.c[3] + p.c[4];
}

template <class Integer>
bool holds(Role role, const Integer& value) {
    return role == Role::zero ? value == 0 : role == Role::not_negative ? value >= 0 : value != 0;
}

Rational rational(const BigInteger& x) { return Rational(x); }
Rational rational(WideInteger x) {
    const auto high = static_cast<long long>(x >> 64);
    const auto low = static_cast<unsigned long long>(x);
    return Rational((BigInteger(high) << 64) + low);
}

}  // namespace

template <class Integer>
bool System<Integer>::holds_at_start() const {
    return std::all_of(constraints_.begin(), constraints_.begin() + count_, [](const Constraint& k) { return holds(k.role, k.p.c[0]); });
}

template <class Integer>
bool System<Integer>::holds_at_end() const {
    return std::all_of(constraints_.begin(), constraints_.begin() + count_,
                       [](const Constraint& k) { return holds(k.role, value_at_end(k.p)); });
}

/// p(x/2) 2^n
template <class Integer>
System<Integer> System<Integer>::left_half() const {
    System half = *this;
    for (std::size_t k = 0; k < count_; ++k) {
        Polynomial<Integer>& p = half.constraints_[k].p;
        for (std::size_t i = 0; i + 1 < p.size; ++i) p.c[i] *= 1 << (p.size - 1 - i);
    }
    return half;
}

/// p(x + 1)
template <class Integer>
System<Integer> System<Integer>::shifted_by_one() const {
    System next = *this;
    for (std::size_t k = 0; k < count_; ++k) {
        Polynomial<Integer>& p = next.constraints_[k].p;
        for (std::size_t i = 0; i + 1 < p.size; ++i)
            for (std::size_t j = p.size - 1; j-- > i;) p.c[j] += p.c[j + 1];
    }
    return next;
}

template <class Integer>
typename System<Integer>::Answer System<Integer>::over_interval() const {
    bool all_hold = true;
    const Constraint* equation = nullptr;
    for (std::size_t k = 0; k < count_; ++k) {
        const Constraint& constraint = constraints_[k];
        const Signs signs = bernstein_signs(constraint.p);
        if (constraint.role == Role::not_negative) {
            if (!signs.any_positive && !signs.any_zero) return Answer::no;
            all_hold = all_hold && !signs.any_negative;
        } else if (constraint.role == Role::not_zero) {
            if (signs.none()) return Answer::no;
            all_hold = all_hold && signs.one_sign();
        } else if (!signs.none()) {
            if (signs.one_sign()) return Answer::no;
            all_hold = all_hold && equation == nullptr;
            equation = &constraint;
        }
    }
    if (!all_hold) return Answer::open;
    if (equation == nullptr) return Answer::yes;
    const Integer start = equation->p.c[0], end = value_at_end(equation->p);
    return (start < 0 && end > 0) || (start > 0 && end < 0) ? Answer::yes : Answer::open;
}

/// Ends have been tried.
template <class Integer>
typename System<Integer>::Answer System<Integer>::search(int halvings) const {
    const Answer here = over_interval();
    if (here != Answer::open || halvings == 0) return here;
    const System left = left_half(), right = left.shifted_by_one();
    if (right.holds_at_start()) return Answer::yes;
    const Answer first = left.search(halvings - 1);
    if (first == Answer::yes) return Answer::yes;
    const Answer second = right.search(halvings - 1);
    return second == Answer::no ? first : second;
}

template <class Integer>
bool System<Integer>::has_solution() const {
    if (holds_at_start() || holds_at_end()) return true;
    constexpr int halvings = std::is_same_v<Integer, WideInteger> ? 12 : 40;
    const Answer answer = search(halvings);
    return answer == Answer::open ? has_solution_by_algebra() : answer == Answer::yes;
}

template <class Integer>
bool System<Integer>::has_solution_by_algebra() const {
    RationalSystem system;
    for (std::size_t k = 0; k < count_; ++k) {
        RationalPolynomial p;
        for (std::size_t i = 0; i < constraints_[k].p.size; ++i) p.c.push_back(rational(constraints_[k].p.c[i]));
        p.trim();
        const Role role = constraints_[k].role;
        (role == Role::zero ? system.equations : role == Role::not_negative ? system.inequalities : system.nonzero).push_back(p);
    }
    return system.has_solution();
}

template class System<WideInteger>;
template class System<BigInteger>;

}  // namespace fettle::tests
