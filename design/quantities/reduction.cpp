// SPDX-License-Identifier: MIT
#include "design/quantities/reduction.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/base/contract.hpp"
#include "core/base/text.hpp"
#include "core/expression/dimension_powers.hpp"

namespace fettle::design::quantities {

namespace {

constexpr double of_a_step = 1e-6;  // by which times may miss an instant, rounded as they are

std::vector<double> negated(std::vector<double> y) {
    for (double& v : y) v = -v;
    return y;
}

double mean_square(const std::vector<double>& y) {
    return std::inner_product(y.begin(), y.end(), y.begin(), 0.0) / static_cast<double>(y.size());
}

// The number of the window's instants; none for `integral` and `at`, which are about times.
double number_of_window(Over over, const std::vector<double>& y) {
    switch (over) {
        case Over::sum:
            return std::accumulate(y.begin(), y.end(), 0.0);
        case Over::mean:
            return std::accumulate(y.begin(), y.end(), 0.0) / static_cast<double>(y.size());
        case Over::largest:
        case Over::peak:
        case Over::least:
            return value_of(over, extreme_of(over, y));
        case Over::rms:
            return std::sqrt(mean_square(y));
        case Over::end:
        case Over::integral:
            break;
    }
    return y.back();
}

std::vector<double> weights_of_window(Over over, const std::vector<double>& y) {
    const auto count = static_cast<double>(y.size());
    if (over == Over::sum) return std::vector<double>(y.size(), 1.0);
    if (over == Over::mean) return std::vector<double>(y.size(), 1 / count);
    std::vector<double> out(y.size(), 0.0);
    if (over == Over::rms) {
        const double rms = std::sqrt(mean_square(y));
        for (std::size_t t = 0; rms > 0 && t < y.size(); ++t) out[t] = y[t] / (count * rms);  // of the constant 0: 0
        return out;
    }
    if (over == Over::end) {
        out.back() = 1;
        return out;
    }
    return weights_of(over, extreme_of(over, y), y.size());
}

// y at a time, counted in steps from the first instant.
std::vector<double> weights_at(double time, std::size_t count) {
    std::vector<double> out(count, 0.0);
    const double place = std::clamp(time, 0.0, static_cast<double>(count) - 1);
    const auto before = std::min(static_cast<std::size_t>(place), count - 1);
    const double fraction = place - static_cast<double>(before);
    out[before] = 1 - fraction;
    if (fraction > 0) out[before + 1] = fraction;
    return out;
}

// The weights of the integral in that time, likewise; before the first instant y is constant.
std::vector<double> weights_between(double from, double to, std::size_t count) {
    std::vector<double> out(count, 0.0);
    out[0] += std::max(0.0, std::min(to, 0.0) - std::min(from, 0.0));
    for (std::size_t k = 0; k + 1 < count; ++k) {
        const auto start = static_cast<double>(k);
        const double a = std::clamp(from - start, 0.0, 1.0), b = std::clamp(to - start, 0.0, 1.0);
        const double later = (b * b - a * a) / 2;
        out[k] += b - a - later;
        out[k + 1] += later;
    }
    return out;
}

// The weights of a number that is linear in y: at a time, an integral.
std::vector<double> linear_weights(const Reduction& reduction, const Instants& instants, std::size_t count) {
    const auto place = [&](double time) { return time / instants.timestep - instants.first; };
    if (reduction.at) return weights_at(place(*reduction.at), count);
    const double last = static_cast<double>(count) - 1;
    std::vector<double> out =
        weights_between(place(reduction.from.value_or(0)), reduction.to ? std::min(place(*reduction.to), last) : last, count);
    for (double& weight : out) weight *= instants.timestep;
    return out;
}

bool is_of_times(const Reduction& reduction) { return reduction.at || reduction.over == Over::integral; }

std::vector<double> in_window(const std::pair<int, int>& window, const std::vector<double>& y) {
    FETTLE_ASSERT(0 <= window.first && window.first < window.second && window.second <= count_of(y), "a window has an instant");
    return {y.begin() + window.first, y.begin() + window.second};
}

std::string seconds(double time) { return core::base::formatted("%.9g s", time); }

}  // namespace

std::optional<Dimension> dimension_of(const Reduction& reduction, Dimension of_instants) {
    const int power = (reduction.over == Over::integral && !reduction.at ? 1 : 0) - reduction.derivative;
    if (power == 0) return of_instants;
    if (of_instants == Dimension::power && power == 1) return Dimension::energy;  // and not a torque, which has the same powers
    return core::expression::named_dimension(
        product(core::expression::powers_of(of_instants), core::expression::powers_of(Dimension::time), power));
}

Errors check(const Reduction& reduction, Dimension of_instants, const Instants& instants, int steps) {
    Errors errors;
    const auto add = [&](ErrorCode code, const std::string& message) { errors.push_back({code, "", message}); };
    if (steps < 1) add(ErrorCode::out_of_range, "what a step reports needs a step");
    if (reduction.derivative < 0 || reduction.derivative > 2)
        add(ErrorCode::out_of_range, "a derivative in time is the first or the second");
    const int count = steps + 1 - instants.first;
    if (reduction.derivative > 0 && count < 3)
        add(ErrorCode::out_of_range, "a derivative in time needs three instants, so " + std::to_string(2 + instants.first) + " steps");
    if (reduction.at && (reduction.from || reduction.to || reduction.over != Over::end))
        add(ErrorCode::inconsistent, "what is taken at a time has no window and nothing that it is taken over");
    if (!dimension_of(reduction, of_instants))
        add(ErrorCode::wrong_type,
            "there is no unit for this derivative or integral; divide by an amount in an expression over the steps, such as `force / 1 N`");
    if (!errors.empty()) return errors;
    const double end = steps * instants.timestep, room = of_a_step * instants.timestep, first = instants.first * instants.timestep;
    for (const std::optional<double>& time : {reduction.from, reduction.to, reduction.at})
        if (time && !(*time >= 0 && *time <= end + room))
            add(ErrorCode::out_of_range, seconds(*time) + " is not within the motion, which ends at " + seconds(end));
    if (errors.empty() && reduction.at && !(*reduction.at >= first - room))
        add(ErrorCode::out_of_range, "at " + seconds(*reduction.at) + " this is not known: it is a step's, and the first step ends at " +
                                         seconds(first) + ", the earliest time to ask for");
    if (reduction.from && reduction.to && !(*reduction.from < *reduction.to))
        add(ErrorCode::inconsistent, "a window begins before it ends; this one is from " + seconds(*reduction.from) + " to " +
                                         seconds(*reduction.to) + "; for one time, say `at`");
    if (!errors.empty() || is_of_times(reduction)) return errors;
    const auto [begin, past] = window_of(reduction, instants, count);
    if (begin >= past)
        add(ErrorCode::out_of_range,
            "no instant lies within the window: numbers are known every " + seconds(instants.timestep) + " from " + seconds(first) + " on");
    return errors;
}

std::vector<SignedExtreme> extremes_of(Over over, const std::vector<double>& y) {
    std::vector<SignedExtreme> out;
    if (over != Over::least)
        for (const Extreme& extreme : smooth_maxima(y)) out.push_back({extreme, 1});
    if (over != Over::largest)
        for (const Extreme& extreme : smooth_maxima(negated(y))) out.push_back({extreme, -1});
    std::stable_sort(out.begin(), out.end(),
                     [](const SignedExtreme& a, const SignedExtreme& b) { return a.extreme.value > b.extreme.value; });
    return out;
}

SignedExtreme extreme_of(Over over, const std::vector<double>& y) { return extremes_of(over, y).front(); }

double value_of(Over over, const SignedExtreme& extreme) { return over == Over::least ? -extreme.extreme.value : extreme.extreme.value; }

std::vector<double> weights_of(Over over, const SignedExtreme& extreme, std::size_t count) {
    std::vector<double> out(count, 0.0);
    const auto& weights = extreme.extreme.weights;
    for (int k = 0; k < count_of(weights); ++k)
        if (weights[k] != 0) out[extreme.extreme.first + k] = over == Over::peak ? extreme.sign * weights[k] : weights[k];
    return out;
}

std::pair<int, int> window_of(const Reduction& reduction, const Instants& instants, int count) {
    const auto place = [&](double time) { return time / instants.timestep - instants.first; };
    const int first = reduction.from ? static_cast<int>(std::ceil(place(*reduction.from) - of_a_step)) : 0;
    const int past = reduction.to ? static_cast<int>(std::floor(place(*reduction.to) + of_a_step)) + 1 : count;
    return {std::max(0, first), std::min(count, past)};
}

double number_of(const Reduction& reduction, const std::vector<double>& y, const Instants& instants) {
    FETTLE_ASSERT(!y.empty(), "what has a number at each instant needs an instant");
    if (is_of_times(reduction)) {
        const std::vector<double> weights = linear_weights(reduction, instants, y.size());
        double sum = 0;
        for (std::size_t t = 0; t < y.size(); ++t)
            if (weights[t] != 0) sum += weights[t] * y[t];
        return sum;
    }
    const std::vector<double> inside = in_window(window_of(reduction, instants, count_of(y)), y);
    const auto finite = [](double v) { return std::isfinite(v); };
    if (reduction.over != Over::end && !std::all_of(inside.begin(), inside.end(), finite)) return std::numeric_limits<double>::quiet_NaN();
    return number_of_window(reduction.over, inside);
}

std::vector<double> weights_of(const Reduction& reduction, const std::vector<double>& y, const Instants& instants) {
    if (is_of_times(reduction)) return linear_weights(reduction, instants, y.size());
    const std::pair<int, int> window = window_of(reduction, instants, count_of(y));
    const std::vector<double> of_window = weights_of_window(reduction.over, in_window(window, y));
    std::vector<double> out(y.size(), 0.0);
    std::copy(of_window.begin(), of_window.end(), out.begin() + window.first);
    return out;
}

}  // namespace fettle::design::quantities
