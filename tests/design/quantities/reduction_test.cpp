// SPDX-License-Identifier: MIT
// Closed forms of sines, lines and parabolas; weights against differences.
#include "design/quantities/reduction.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <numbers>

namespace fettle::design::quantities::reduction_test {

namespace {

constexpr double pi = std::numbers::pi;
constexpr double h = 0.01;
constexpr Instants of_steps{h, 1};  // as of a force: the start has no number

// Samples of f over so many steps.
std::vector<double> sampled(const std::function<double(double)>& f, int steps, const Instants& instants = of_steps) {
    std::vector<double> y;
    for (int t = instants.first; t <= steps; ++t) y.push_back(f(t * instants.timestep));
    return y;
}

Reduction taken(Over over, std::optional<double> from = {}, std::optional<double> to = {}) {
    Reduction out(over);
    out.from = from;
    out.to = to;
    return out;
}

Reduction taken_at(double time) {
    Reduction out;
    out.at = time;
    return out;
}

double sine(double time) { return std::sin(2 * pi * time); }

// A bumpy function without symmetries.
double bumpy(double time) { return std::sin(7 * time) + 0.3 * std::cos(31 * time + 1) - 0.4; }

const std::vector<Over> all{Over::end, Over::sum, Over::mean, Over::largest, Over::least, Over::peak, Over::rms, Over::integral};

}  // namespace

TEST_CASE("reductions of a sine and of a line are their closed forms") {
    const std::vector<double> y = sampled(sine, 100);
    CHECK(number_of(taken(Over::end), y, of_steps) == y.back());
    CHECK(number_of(taken(Over::end, {}, 0.25), y, of_steps) == Approx(1));
    CHECK(number_of(taken(Over::rms), y, of_steps) == Approx(std::sqrt(0.5)));
    CHECK(number_of(taken(Over::mean), y, of_steps) == Approx(0).margin(1e-12));
    CHECK(number_of(taken(Over::largest), y, of_steps) == Approx(1));
    CHECK(number_of(taken(Over::peak, 0.5), y, of_steps) == Approx(1));
    CHECK(number_of(taken(Over::largest, 0.5, 1), y, of_steps) == Approx(0).margin(1e-12));
    CHECK(number_of(taken(Over::least, 0.1, 0.4), y, of_steps) == Approx(sine(0.1)));
    CHECK(number_of(taken(Over::peak, 0.6, 0.7), y, of_steps) == Approx(-sine(0.7)));
    CHECK(number_of(taken(Over::sum, 0.2, 0.3), y, of_steps) == Approx([&] {
              double sum = 0;
              for (int t = 20; t <= 30; ++t) sum += sine(t * h);
              return sum;
          }()));
    // The trapezoidal rule, within h^2/12 times the change of the slope, and h^2/2 times the slope at the start: there it is constant.
    CHECK(number_of(taken(Over::integral, 0.01, 0.5), y, of_steps) ==
          Approx((std::cos(2 * pi * h) + 1) / (2 * pi)).margin(h * h * 4 * pi / 12));
    CHECK(number_of(taken(Over::integral), y, of_steps) == Approx(h * h * pi).margin(h * h * 0.1));
    const std::vector<double> line = sampled([](double time) { return 3 * time - 1; }, 100);
    const auto integral = [](double time) { return 1.5 * time * time - time; };
    CHECK(number_of(taken(Over::integral, 0.123, 0.457), line, of_steps) == Approx(integral(0.457) - integral(0.123)).epsilon(1e-12));
    CHECK(number_of(taken(Over::integral), line, of_steps) == Approx(integral(1) - integral(h) + h * (3 * h - 1)).epsilon(1e-12));
    CHECK(number_of(taken(Over::integral, 0.004, 0.006), line, of_steps) == Approx(0.002 * (3 * h - 1)).epsilon(1e-12));
    CHECK(number_of(taken_at(0.3), line, of_steps) == Approx(-0.1).epsilon(1e-12));
    CHECK(number_of(taken_at(0.3141), line, of_steps) == Approx(3 * 0.3141 - 1).epsilon(1e-12));
    CHECK(number_of(taken_at(h), line, of_steps) == line.front());
    CHECK(number_of(taken_at(1), line, of_steps) == line.back());
}

TEST_CASE("an integral in time ends at the order of its rule") {
    double before = 0;
    for (const int steps : {50, 100, 200}) {
        const double timestep = 0.5 / steps;
        const double error = std::abs(number_of(taken(Over::integral), sampled(sine, steps, {timestep, 1}), {timestep, 1}) - 1 / pi);
        if (before > 0) CHECK(before / error == Approx(4).epsilon(0.1));
        before = error;
    }
}

TEST_CASE("derivatives in time are exact of parabolas, second order of a sine, and transposed by their adjoint") {
    const std::vector<double> parabola = sampled([](double time) { return 2 * time * time - 3 * time + 1; }, 9);
    const std::vector<double> first = time_derivative(parabola, h, 1), second = time_derivative(parabola, h, 2);
    for (int t = 1; t <= 9; ++t) {
        CHECK(first[t - 1] == Approx(4 * t * h - 3));
        CHECK(second[t - 1] == Approx(4));
    }
    CHECK(time_derivative(parabola, h, 0) == parabola);
    for (const int order : {1, 2}) {
        double before = 0;
        for (const double timestep : {0.01, 0.005}) {
            const std::vector<double> found =
                time_derivative(sampled(sine, static_cast<int>(1 / timestep), {timestep, 1}), timestep, order);
            double worst = 0;
            for (int t = 2; t < count_of(found); ++t) {
                const double time = t * timestep, exact = order == 1 ? 2 * pi * std::cos(2 * pi * time) : -4 * pi * pi * sine(time);
                worst = std::max(worst, std::abs(found[t - 1] - exact));
            }
            if (before > 0) CHECK(before / worst == Approx(4).epsilon(0.05));
            before = worst;
        }
        for (const int steps : {3, 4, 17}) {
            const std::vector<double> u = sampled(bumpy, steps), w = sampled([](double time) { return std::cos(50 * time); }, steps);
            const std::vector<double> forward = time_derivative(u, h, order), back = time_derivative_adjoint(w, h, order);
            double one = 0, other = 0;
            for (int t = 0; t < steps; ++t) one += w[t] * forward[t], other += back[t] * u[t];
            CHECK(one == Approx(other).epsilon(1e-10));
        }
    }
}

TEST_CASE("the weights of a reduction are its derivative") {
    std::vector<Reduction> asked{taken_at(0.137), taken_at(0.01)};
    for (const Over over : all)
        for (const auto& [from, to] : {std::pair<std::optional<double>, std::optional<double>>{}, {0.093, 0.31}, {{}, 0.05}, {0.2, {}}})
            asked.push_back(taken(over, from, to));
    for (const Instants& instants : {Instants{h, 0}, of_steps})
        for (const Reduction& reduction : asked) {
            const std::vector<double> y = sampled(bumpy, 40, instants);
            CAPTURE(instants.first, static_cast<int>(reduction.over), reduction.from.value_or(-1), reduction.to.value_or(-1));
            REQUIRE(check(reduction, Dimension::force, instants, 40).empty());
            const std::vector<double> weights = weights_of(reduction, y, instants);
            for (std::size_t t = 0; t < y.size(); ++t) {
                std::vector<double> above = y, below = y;
                above[t] += 1e-6;
                below[t] -= 1e-6;
                CHECK(weights[t] ==
                      Approx((number_of(reduction, above, instants) - number_of(reduction, below, instants)) / 2e-6).margin(1e-7));
            }
        }
    CHECK(weights_of(taken(Over::rms), std::vector<double>(5, 0.0), of_steps) == std::vector<double>(5, 0.0));
}

// What it should be, of a line that falls: of the start and the steps' ends within the window, each by itself.
TEST_CASE("the start counts in every reduction where it has a number, and in none where it has not") {
    const auto f = [](double time) { return 2 - 30 * time; };
    for (const Instants& instants : {Instants{h, 0}, of_steps})
        for (const auto& window : {std::pair<std::optional<double>, std::optional<double>>{}, {0, 0.05}, {{}, 0.05}, {h, 0.05}}) {
            const std::optional<double> from = window.first, to = window.second;
            std::vector<double> inside;
            for (int t = instants.first; t <= (to ? 5 : 20); ++t)
                if (t * h >= from.value_or(0)) inside.push_back(f(t * h));
            const std::vector<double> y = sampled(f, 20, instants);
            CAPTURE(instants.first, from.value_or(-1), to.value_or(-1));
            const auto number = [&](Over over) {
                REQUIRE(check(taken(over, from, to), Dimension::force, instants, 20).empty());
                return number_of(taken(over, from, to), y, instants);
            };
            double sum = 0, squares = 0;
            for (const double v : inside) sum += v, squares += v * v;
            CHECK(number(Over::sum) == Approx(sum));
            CHECK(number(Over::mean) == Approx(sum / static_cast<double>(inside.size())));
            CHECK(number(Over::rms) == Approx(std::sqrt(squares / static_cast<double>(inside.size()))));
            CHECK(number(Over::largest) == Approx(inside.front()));
            CHECK(number(Over::least) == Approx(inside.back()));
            CHECK(number(Over::end) == Approx(inside.back()));
            CHECK(number(Over::peak) == Approx(std::max(std::abs(inside.front()), std::abs(inside.back()))));
            const double begin = from.value_or(0), end = to.value_or(0.2), held = instants.first == 1 && begin == 0 ? h : 0;
            const double linear = (end - begin - held) * (f(begin + held) + f(end)) / 2;
            CHECK(number(Over::integral) == Approx(linear + held * f(h)));
        }
    const std::vector<double> whole = sampled(f, 20, {h, 0});
    for (const double time : {0.0, 0.002, 0.01, 0.013, 0.2}) CHECK(number_of(taken_at(time), whole, {h, 0}) == Approx(f(time)));
    for (const double time : {0.0, 0.002, 0.0099}) {
        CHECK(check(taken_at(time), Dimension::force, {h, 0}, 20).empty());
        const Errors errors = check(taken_at(time), Dimension::force, of_steps, 20);
        REQUIRE(errors.size() == 1);
        CHECK(errors[0].message.find("the first step ends at 0.01 s") != std::string::npos);
    }
    CHECK(check(taken_at(0.01), Dimension::force, of_steps, 20).empty());
    CHECK(check(taken(Over::largest, 0, 0.005), Dimension::length, {h, 0}, 20).empty());
    CHECK(check(taken(Over::largest, 0, 0.005), Dimension::force, of_steps, 20)[0].message.find("from 0.01 s on") != std::string::npos);
}

TEST_CASE("a step that has no number leaves the window without one, and changes nothing outside of it") {
    std::vector<double> y = sampled(bumpy, 40);
    y[20] = std::nan("");
    for (const Over over : all) {
        CAPTURE(static_cast<int>(over));
        CHECK(std::isnan(number_of(taken(over, 0.1, 0.3), y, of_steps)) == (over != Over::end));
        CHECK(std::isfinite(number_of(taken(over, 0.25, 0.3), y, of_steps)));
    }
}

TEST_CASE("units of derivatives and integrals") {
    CHECK(dimension_of({Over::peak, 2}, Dimension::length) == Dimension::acceleration);
    CHECK(dimension_of({Over::end, 1}, Dimension::angle) == Dimension::angular_speed);
    CHECK(dimension_of({Over::end, 2}, Dimension::angle) == Dimension::angular_acceleration);
    CHECK(dimension_of({Over::end, 1}, Dimension::energy) == Dimension::power);
    CHECK(dimension_of(Over::integral, Dimension::power) == Dimension::energy);
    CHECK(dimension_of(Over::integral, Dimension::force) == Dimension::impulse);
    CHECK(dimension_of(Over::integral, Dimension::torque) == Dimension::angular_impulse);
    CHECK(dimension_of({Over::integral, 1}, Dimension::energy) == Dimension::energy);
    CHECK(dimension_of({Over::integral, 1}, Dimension::force) == Dimension::force);
    CHECK(dimension_of(Over::rms, Dimension::torque) == Dimension::torque);
    CHECK_FALSE(dimension_of({Over::end, 1}, Dimension::force));
}

TEST_CASE("reductions that a motion does not have are refused by name") {
    const auto message = [](const Reduction& reduction, int steps = 10) {
        const Errors errors = check(reduction, Dimension::length, {h, 0}, steps);
        return errors.empty() ? std::string() : errors[0].message;
    };
    CHECK(message({}).empty());
    CHECK(message(taken(Over::peak, 0.05, 0.1)).empty());
    CHECK(message({}, 0).find("needs a step") != std::string::npos);
    CHECK(message({Over::end, 1}, 1).find("so 2 steps") != std::string::npos);
    CHECK(message({Over::end, 3}).find("first or the second") != std::string::npos);
    CHECK(message(taken(Over::end, 0.2)).find("ends at 0.1 s") != std::string::npos);
    CHECK(message(taken(Over::end, 0.06, 0.05)).find("begins before it ends") != std::string::npos);
    CHECK(message(taken(Over::end, 0.051, 0.059)).find("no instant lies within") != std::string::npos);
    CHECK(check(taken(Over::integral, 0.051, 0.059), Dimension::force, of_steps, 10).empty());
    CHECK(message(taken_at(0.11)).find("ends at 0.1 s") != std::string::npos);
    Reduction both = taken_at(0.05);
    both.over = Over::peak;
    CHECK(message(both).find("at a time") != std::string::npos);
    const Errors errors = check({Over::end, 1}, Dimension::force, of_steps, 10);
    REQUIRE(errors.size() == 1);
    CHECK(errors[0].message.find("no unit") != std::string::npos);
}

}  // namespace fettle::design::quantities::reduction_test
