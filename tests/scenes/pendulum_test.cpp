// SPDX-License-Identifier: MIT
// A bar on a hinge swings from rest at a large angle as elliptic functions say, with fettle's own settings. With k = sin(amplitude / 2) and
// omega = sqrt(m g lever / inertia about the hinge):
//     sin(angle(t) / 2) = k cd(omega t, k),   period = 4 K(k) / omega.
#include <boost/math/special_functions/jacobi_elliptic.hpp>

#include "tests/scenes/part_mechanism.hpp"
#include "tests/scenes/refinement.hpp"

namespace fettle::tests::scenes::pendulum_test {

using namespace part_mechanism;

namespace {

constexpr double pi = std::numbers::pi, length = 0.2, side = 0.02, gravity = 9.81, degrees = pi / 180;

/// From rest at an amplitude [rad].
struct Swing {
    double amplitude;
    double modulus() const { return std::sin(amplitude / 2); }
    double omega() const { return std::sqrt(gravity * length / 2 / ((length * length + side * side) / 12 + length * length / 4)); }
    double period() const { return 4 * std::comp_ellint_1(modulus()) / omega(); }
    double angle(double time) const { return 2 * std::asin(modulus() * boost::math::jacobi_cd(modulus(), omega() * time)); }
};

/// The bar hangs along -z from the origin and turns about y, by a hinge or by what is left free of it.
std::string scene(const Swing& swing, const char* integrator, bool hinged, double timestep, double end_time) {
    const std::string held = hinged ? "" : R"("reference_point": [0, 0, "= size_z / 2"], "fixed": ["px", "py", "pz", "rx", "rz"],)";
    const std::string hinge = hinged ? R"({"name": "hinge", "type": "revolute", "b": "bar", "point": [0, 0, 0], "axis": [0, 1, 0]})" : "";
    return formatted(R"json({
      "fettle_scene": 1, "units": "mm", "gravity": [0, 0, %.17g], "integrator": "%s", "timestep": %.17g, "end_time": %.17g,
      "variables": {"size_z": "%.17gmm", "angle": "%.17gdeg"},
      "bodies": [{"name": "bar", "density": 1240, %s "rotation": [0, "= angle", 0],
                  "position": ["= -size_z / 2 * sin(angle)", 0, "= -size_z / 2 * cos(angle)"],
                  "shape": {
        "part" : "box", "dimensions" : { "size_x" : % .17g, "size_y" : % .17g, "size_z" : "= size_z" }}
}],
      "joints": [%s]
})json",
                     -gravity, integrator, timestep, end_time, 1e3 * length, swing.amplitude / degrees, held.c_str(), 1e3 * side,
                     1e3 * side, hinge.c_str());
}

/// Angles at the ends of steps, the start first.
std::vector<double> angles(const std::string& scene_text) {
    const Run run = part_mechanism::run(scene_text);
    REQUIRE(run.simulation.report.status == core::stepper::SimulationStatus::ok);
    std::vector<double> out;
    for (int t = 0; t <= run.steps(); ++t) {
        const Matrix3& r = run.pose(0, t).rotation;
        out.push_back(std::atan2(r(0, 2), r(2, 2)));
    }
    return out;
}

/// The times at which values pass 0, in steps: by the cubic through the four about each.
std::vector<double> passages(const std::vector<double>& v) {
    std::vector<double> out;
    for (std::size_t t = 1; t + 2 < v.size(); ++t) {
        if (!(v[t] * v[t + 1] < 0)) continue;
        const auto cubic = [&](double s) {
            return v[t - 1] * -s * (s - 1) * (s - 2) / 6 + v[t] * (s + 1) * (s - 1) * (s - 2) / 2 - v[t + 1] * (s + 1) * s * (s - 2) / 2 +
                   v[t + 2] * (s + 1) * s * (s - 1) / 6;
        };
        double low = 0, high = 1;
        while (high - low > 1e-12) {
            const double middle = 0.5 * (low + high);
            (cubic(middle) * v[t] > 0 ? low : high) = middle;
        }
        out.push_back(static_cast<double>(t) + low);
    }
    return out;
}

struct Errors {
    double angle;    ///< the largest in a period and a half [rad]
    double quarter;  ///< of the time to the first passage, relative
    double period;   ///< of the time from the first passage to the third, relative
};

Errors errors_of(const Swing& swing, const char* integrator, bool hinged, double timestep) {
    const double period = swing.period();
    const std::vector<double> found = angles(scene(swing, integrator, hinged, timestep, 1.5 * period));
    Errors out{};
    for (std::size_t t = 0; t < found.size(); ++t)
        out.angle = std::max(out.angle, std::abs(found[t] - swing.angle(static_cast<double>(t) * timestep)));
    const std::vector<double> zeros = passages(found);
    REQUIRE(zeros.size() == 3);
    out.quarter = std::abs(4 * zeros[0] * timestep / period - 1);
    out.period = std::abs((zeros[2] - zeros[0]) * timestep / period - 1);
    return out;
}

/// With what the bar is run, and the errors at the finest of four time steps.
struct Case {
    const char* integrator;
    bool hinged;
    int order;
    double coarsest;  // [s]
    Errors finest;
};

void check(const Swing& swing, const Case& c, const std::vector<double Errors::*>& of_order) {
    INFO(c.integrator << (c.hinged ? ", hinged" : ", held"));
    std::vector<Errors> errors;
    for (int k = 0; k <= 3; ++k) errors.push_back(errors_of(swing, c.integrator, c.hinged, c.coarsest / (1 << k)));
    for (const auto which : of_order) {
        std::vector<double> values;
        for (const Errors& e : errors) values.push_back(e.*which);
        for (const double order : refinement::orders(values)) CHECK(order == Approx(c.order).margin(0.12));
    }
    CHECK(errors.back().angle < c.finest.angle);
    CHECK(errors.back().quarter < c.finest.quarter);
    CHECK(errors.back().period < c.finest.period);
}

}  // namespace

TEST_CASE("Pendulum: swings of 90 degrees are those of elliptic functions, at each integrator's order") {
    const Swing swing{90 * degrees};
    for (const Case& c : {Case{"implicit_euler", true, 1, 5e-4, {0.016, 1e-4, 1.4e-3}},
                          Case{"implicit_euler", false, 1, 5e-4, {0.016, 1e-4, 1.4e-3}}, Case{"bdf2", true, 2, 2e-3, {8e-5, 6e-6, 6e-6}},
                          Case{"bdf2", false, 2, 2e-3, {8e-5, 6e-6, 6e-6}}, Case{"newmark", false, 2, 2e-3, {1e-5, 7e-7, 7e-7}}})
        check(swing, c, {&Errors::angle, &Errors::quarter, &Errors::period});
}

// Near the top the time depends so much on the energy that errors of higher order show in later swings at these time steps: the order is
// that of the way down alone.
TEST_CASE("Pendulum: swings of 150 degrees are those of elliptic functions, the way down at each integrator's order") {
    const Swing swing{150 * degrees};
    for (const Case& c : {Case{"implicit_euler", true, 1, 2.5e-4, {0.3, 5e-5, 0.02}}, Case{"bdf2", true, 2, 4e-3, {5e-4, 3e-5, 2e-5}},
                          Case{"bdf2", false, 2, 4e-3, {5e-4, 3e-5, 2e-5}}, Case{"newmark", false, 2, 4e-3, {6e-5, 2e-6, 2.5e-6}}})
        check(swing, c, {&Errors::quarter});
}

TEST_CASE("Pendulum: hangs down in the first quasi-static step") {
    const std::vector<double> found = angles(scene({90 * degrees}, "quasi_static", true, 0.01, 0.02));
    CHECK(std::abs(found[1]) < 1e-6);  // the proximal term's share
    CHECK(std::abs(found[2]) < 1e-9);
}

}  // namespace fettle::tests::scenes::pendulum_test
