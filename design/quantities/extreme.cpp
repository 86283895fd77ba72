// SPDX-License-Identifier: MIT
#include "design/quantities/extreme.hpp"

#include <algorithm>
#include <unsupported/Eigen/AutoDiff>
#include <utility>

#include "core/base/contract.hpp"
#include "core/base/text.hpp"

namespace fettle::design::quantities {

namespace {

// With its derivative in the five numbers.
using Scalar = Eigen::AutoDiffScalar<Eigen::Matrix<double, 5, 1>>;

// 0 up to x = 0, 1 from x = 1.
Scalar fade(const Scalar& x) {
    if (x.value() <= 0) return Scalar(0.0);
    if (x.value() >= 1) return Scalar(1.0);
    return x * x * (3.0 - 2.0 * x);
}

Scalar lesser(const Scalar& x, const Scalar& y) { return y.value() < x.value() ? y : x; }
Scalar greater(const Scalar& x, const Scalar& y) { return y.value() > x.value() ? y : x; }

// Where two lines meet above the largest number, in the interval on one side of it, and how far they are to be believed, 0 to 1.
struct Cliff {
    Scalar height = Scalar(0.0), belief = Scalar(0.0);

    Cliff() = default;
    // @param above  the largest number less its neighbour on the other side  @param bend  its own  @param near, far  its neighbours'
    Cliff(const Scalar& above, const Scalar& bend, const Scalar& near, const Scalar& far) {
        if (near.value() < -1e-9 * bend.value()) return;
        const Scalar share = above / (bend + near);
        const Scalar is_steep = fade((0.3 - lesser(share, Scalar(1.0 - share))) / 0.2);
        height = share * near;
        belief = is_steep * fade(Scalar(1.0 - greater(far, Scalar(-far)) / bend));
    }
    Scalar lift() const { return height * belief; }
};

// That of a number that none beside it is above.
Extreme maximum_at(int at, const std::vector<double>& y) {
    const int last = count_of(y) - 1;
    const Extreme itself{y[at], at - 2, {0, 0, 1, 0, 0}, 0};
    if (at == 0 || at == last) return itself;
    const auto number = [&](int k) { return Scalar(y[at + k], 5, k + 2); };
    const Scalar largest = number(0), before = number(-1), after = number(1);
    const Scalar above_before = largest - before, above_after = largest - after, bend = above_before + above_after;
    if (bend.value() <= 0) return itself;  // three equal: flat
    const bool has_before = at >= 2, has_after = at + 2 <= last;
    const Scalar bend_before = has_before ? Scalar(2.0 * before - number(-2) - largest) : bend;
    const Scalar bend_after = has_after ? Scalar(2.0 * after - number(2) - largest) : bend;
    const Scalar is_bent = fade(2.0 * lesser(bend_before, bend_after) / bend);
    const Scalar skew = above_before - above_after, parabola = skew * skew / (8.0 * bend);
    Cliff cliff;
    if (has_before && has_after) {
        const Cliff later(above_before, bend, bend_after, bend_before), earlier(above_after, bend, bend_before, bend_after);
        const auto rank = [](const Cliff& c) { return std::pair(c.lift().value(), c.belief.value()); };
        cliff = rank(earlier) > rank(later) ? earlier : later;
    }
    const Scalar value = largest + is_bent * parabola + (1.0 - is_bent) * cliff.lift();
    Extreme out{value.value(), at - 2, {}, 0};
    for (int k = 0; k < 5; ++k) out.weights[k] = value.derivatives()[k];
    out.doubt = (1 - is_bent.value()) * (1 - cliff.belief.value()) * std::min(above_before.value(), above_after.value());
    return out;
}

}  // namespace

std::vector<Extreme> smooth_maxima(const std::vector<double>& y) {
    FETTLE_ASSERT(!y.empty(), "the extreme of nothing");
    std::vector<Extreme> out;
    for (int k = 0; k < count_of(y);) {
        int next = k + 1;  // the first number that is another one
        while (next < count_of(y) && y[next] == y[k]) ++next;
        const bool is_above_before = k == 0 || y[k] > y[k - 1], is_above_after = next == count_of(y) || y[k] > y[next];
        if (is_above_before && is_above_after) out.push_back(maximum_at(k, y));
        k = next;
    }
    std::stable_sort(out.begin(), out.end(), [](const Extreme& a, const Extreme& b) { return a.value > b.value; });
    return out;
}

Extreme smooth_maximum(const std::vector<double>& y) { return smooth_maxima(y).front(); }

}  // namespace fettle::design::quantities
