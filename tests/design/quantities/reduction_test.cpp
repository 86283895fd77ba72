// SPDX-License-Identifier: MIT
// Closed forms of sines, lines and parabolas; weights against differences.
#include "fettle/design/quantities/reduction.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <numbers>

namespace fettle::design::quantities::reduction_test {

namespace {

constexpr double pi = std::numbers::pi;
constexpr double h = 0.01;

// At the ends of so many steps.
std::vector<double> sampled(const std::function<double(double)>& f, int steps, double timestep = h) {
    std::vector<double> y;
    for (int t = 1; t <= steps; ++t) y.push_back(f(t * timestep));
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

// Of a bumpy sequence without symmetries.
double bumpy(double time) { return std::sin(7 * time) + 0.3 * std::cos(31 * time + 1) - 0.4; }

const std::vector<Over> all{Over::end, Over::sum, Over::mean, Over::largest, Over::least, Over::peak, Over::rms, Over::integral};

}  // namespace

TEST_CASE("reductions of a sine and of a line are their closed forms") {
    const std::vector<double> y = sampled(sine, 100);
    CHECK(number_of(taken(Over::end), y, h) == y.back());
    CHECK(number_of(taken(Over::end, {}, 0.25), y, h) == Approx(1));
    CHECK(number_of(taken(Over::rms), y, h) == Approx(std::sqrt(0.5)));
    CHECK(number_of(taken(Over::mean), y, h) == Approx(0).margin(1e-12));
    CHECK(number_of(taken(Over::largest), y, h) == Approx(1));
    CHECK(number_of(taken(Over::peak, 0.5), y, h) == Approx(1));
    CHECK(number_of(taken(Over::largest, 0.5, 1), y, h) == Approx(0).margin(1e-12));
    CHECK(number_of(taken(Over::least, 0.1, 0.4), y, h) == Approx(sine(0.1)));
    CHECK(number_of(taken(Over::peak, 0.6, 0.7), y, h) == Approx(-sine(0.7)));
    CHECK(number_of(taken(Over::sum, 0.2, 0.3), y, h) == Approx([&] {
              double sum = 0;
              for (int t = 20; t <= 30; ++t) sum += sine(t * h);
              return sum;
          }()));
    // The trapezoidal rule, within h^2/12 times the change of the slope, and h^2/2 times the slope at the start: there it is constant.
    CHECK(number_of(taken(Over::integral, 0.01, 0.5), y, h) == Approx((std::cos(2 * pi * h) + 1) / (2 * pi)).margin(h * h * 4 * pi / 12));
    CHECK(number_of(taken(Over::integral), y, h) == Approx(h * h * pi).margin(h * h * 0.1));
    const std::vector<double> line = sampled([](double time) { return 3 * time - 1; }, 100);
    const auto integral = [](double time) { return 1.5 * time * time - time; };
    CHECK(number_of(taken(Over::integral, 0.123, 0.457), line, h) == Approx(integral(0.457) - integral(0.123)).epsilon(1e-12));
    CHECK(number_of(taken(Over::integral), line, h) == Approx(integral(1) - integral(h) + h * (3 * h - 1)).epsilon(1e-12));
    CHECK(number_of(taken(Over::integral, 0.004, 0.006), line, h) == Approx(0.002 * (3 * h - 1)).epsilon(1e-12));
    CHECK(number_of(taken_at(0.3), line, h) == Approx(-0.1).epsilon(1e-12));
    CHECK(number_of(taken_at(0.3141), line, h) == Approx(3 * 0.3141 - 1).epsilon(1e-12));
    CHECK(number_of(taken_at(0), line, h) == line.front());
    CHECK(number_of(taken_at(1), line, h) == line.back());
}

TEST_CASE("an integral in time ends at the order of its rule") {
    double before = 0;
    for (const int steps : {50, 100, 200}) {
        const double timestep = 0.5 / steps;
        const double error = std::abs(number_of(taken(Over::integral), sampled(sine, steps, timestep), timestep) - 1 / pi);
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
            const std::vector<double> found = time_derivative(sampled(sine, static_cast<int>(1 / timestep), timestep), timestep, order);
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
    std::vector<Reduction> asked{taken_at(0.137), taken_at(0.001)};
    for (const Over over : all)
        for (const auto& [from, to] : {std::pair<std::optional<double>, std::optional<double>>{}, {0.093, 0.31}, {{}, 0.05}, {0.2, {}}})
            asked.push_back(taken(over, from, to));
    const std::vector<double> y = sampled(bumpy, 40);
    for (const Reduction& reduction : asked) {
        CAPTURE(static_cast<int>(reduction.over), reduction.from.value_or(-1), reduction.to.value_or(-1));
        REQUIRE(check(reduction, Dimension::force, h, count_of(y)).empty());
        const std::vector<double> weights = weights_of(reduction, y, h);
        for (std::size_t t = 0; t < y.size(); ++t) {
            std::vector<double> above = y, below = y;
            above[t] += 1e-6;
            below[t] -= 1e-6;
            CHECK(weights[t] == Approx((number_of(reduction, above, h) - number_of(reduction, below, h)) / 2e-6).margin(1e-7));
        }
    }
    CHECK(weights_of(taken(Over::rms), std::vector<double>(5, 0.0), h) == std::vector<double>(5, 0.0));
}

TEST_CASE("a step that has no number leaves the window without one, and changes nothing outside of it") {
    std::vector<double> y = sampled(bumpy, 40);
    y[20] = std::nan("");
    for (const Over over : all) {
        CAPTURE(static_cast<int>(over));
        CHECK(std::isnan(number_of(taken(over, 0.1, 0.3), y, h)) == (over != Over::end));
        CHECK(std::isfinite(number_of(taken(over, 0.25, 0.3), y, h)));
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
        const Errors errors = check(reduction, Dimension::length, h, steps);
        return errors.empty() ? std::string() : errors[0].message;
    };
    CHECK(message({}).empty());
    CHECK(message(taken(Over::peak, 0.05, 0.1)).empty());
    CHECK(message({}, 0).find("needs a step") != std::string::npos);
    CHECK(message({Over::end, 1}, 2).find("needs three steps") != std::string::npos);
    CHECK(message({Over::end, 3}).find("first or the second") != std::string::npos);
    CHECK(message(taken(Over::end, 0.2)).find("ends at 0.1 s") != std::string::npos);
    CHECK(message(taken(Over::end, 0.06, 0.05)).find("begins before it ends") != std::string::npos);
    CHECK(message(taken(Over::end, 0.051, 0.059)).find("no step ends within") != std::string::npos);
    CHECK(check(taken(Over::integral, 0.051, 0.059), Dimension::force, h, 10).empty());
    CHECK(message(taken_at(0.11)).find("ends at 0.1 s") != std::string::npos);
    Reduction both = taken_at(0.05);
    both.over = Over::peak;
    CHECK(message(both).find("at a time") != std::string::npos);
    const Errors errors = check({Over::end, 1}, Dimension::force, h, 10);
    REQUIRE(errors.size() == 1);
    CHECK(errors[0].message.find("no unit") != std::string::npos);
}

}  // namespace fettle::design::quantities::reduction_test
