// SPDX-License-Identifier: MIT
/// Systems of polynomial equations and inequalities in one variable on [0, 1], decided exactly.
///
/// First by subdivision in integer arithmetic: a polynomial's coefficients in Bernstein's basis bound it over an interval, and restricting
/// it to a half takes sums and shifts only. An interval is without solution if an equation's coefficients have one sign or an inequality's
/// are all negative; it holds one if the single equation changes sign between its ends while the inequalities' are all >= 0; ends and
/// middles are tried as solutions. What is still open at the last depth (double roots, several constraints that vanish together at times
/// that are no dyadic fractions) goes to algebra over the rationals: roots isolated by Sturm sequences, signs at them by greatest common
/// divisors.
#pragma once

#include <array>
#include <boost/multiprecision/gmp.hpp>
#include <cstddef>

namespace fettle::tests {

using BigInteger = boost::multiprecision::number<boost::multiprecision::gmp_int, boost::multiprecision::et_off>;
using Rational = boost::multiprecision::number<boost::multiprecision::gmp_rational, boost::multiprecision::et_off>;
__extension__ using WideInteger = __int128;

/// Degree at most 4, coefficients from the constant up; c[size], c[size + 1], ... are 0.
template <class Integer>
struct Polynomial {
    std::array<Integer, 5> c{};
    std::size_t size = 0;
};

template <class Integer>
Polynomial<Integer> operator+(Polynomial<Integer> a, const Polynomial<Integer>& b) {
    a.size = std::max(a.size, b.size);
    for (std::size_t i = 0; i < b.size; ++i) a.c[i] += b.c[i];
    return a;
}
template <class Integer>
Polynomial<Integer> operator-(Polynomial<Integer> a, const Polynomial<Integer>& b) {
    a.size = std::max(a.size, b.size);
    for (std::size_t i = 0; i < b.size; ++i) a.c[i] -= b.c[i];
    return a;
}
template <class Integer>
Polynomial<Integer> operator*(const Polynomial<Integer>& a, const Polynomial<Integer>& b) {
    Polynomial<Integer> r;
    if (a.size == 0 || b.size == 0) return r;
    r.size = a.size + b.size - 1;
    for (std::size_t i = 0; i < a.size; ++i)
        for (std::size_t j = 0; j < b.size; ++j) r.c[i + j] += a.c[i] * b.c[j];
    return r;
}

enum class Role { zero, not_negative, not_zero };

/// Up to six constraints. Integer: BigInteger, or WideInteger where coefficients stay below 2^62 (12 halvings multiply them by 2^48, and
/// sums by less than 2^11).
template <class Integer>
class System {
public:
    void add(Role role, const Polynomial<Integer>& p) { constraints_[count_++] = {role, p}; }

    /// Is there a t in [0, 1] at which all constraints hold?
    bool has_solution() const;
    /// The same by algebra alone: slow; for the test of the other.
    bool has_solution_by_algebra() const;

private:
    enum class Answer { no, yes, open };
    struct Constraint {
        Role role = Role::zero;
        Polynomial<Integer> p;
    };
    Answer search(int halvings) const;
    Answer over_interval() const;
    bool holds_at_start() const;
    bool holds_at_end() const;
    System left_half() const;
    System shifted_by_one() const;

    std::array<Constraint, 6> constraints_;
    std::size_t count_ = 0;
};

extern template class System<WideInteger>;
extern template class System<BigInteger>;

}  // namespace fettle::tests
