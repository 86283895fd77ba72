// SPDX-License-Identifier: MIT
// Andrews' squeezer (Hairer and Wanner, Solving Ordinary Differential Equations II; test set for IVP solvers): seven bodies in a plane, ten
// hinges, one spring, a crank that a constant torque turns two and a half times in 0.03 s. The scene is the published data, and fettle's
// settings are its own.
#include "tests/scenes/part_mechanism.hpp"
#include "tests/scenes/refinement.hpp"

namespace fettle::tests::scenes::andrews_squeezer_test {

using namespace part_mechanism;

namespace {

constexpr double end_time = 0.03;

// The published coordinates are angles (beta, Theta, gamma, Phi, delta, Omega, epsilon); K2, K4 and K6 turn by sums of two.
std::string scene(int steps) {
    std::string bodies;
    const auto body = [&](const char* name, const char* position, const char* angle, double mass, const char* centre, double inertia,
                          const char* points, const char* wires) {
        bodies += formatted(R"(%s
            {"name": "%s", "group": "squeezer", "position": [%s, 0], "rotation": [0, 0, "= %s"], "vertices": [%s], "edges": [%s],
             "inertial": {"mass": %.17g, "centre": [%s, 0], "inertia": [[%.17g, 0, 0], [0, %.17g, 0], [0, 0, %.17g]]}})",
                            bodies.empty() ? "" : ",", name, position, angle, points, wires, mass, centre, inertia, inertia, inertia);
    };
    const char *link = "[0, 1]", *triangle = "[0, 1], [1, 2], [2, 0]";
    body("K1", "0, 0", "beta", 0.04325, R"("= ra", 0)", 2.194e-6, R"([0, 0, 0], ["= rr", 0, 0])", link);
    body("K2", R"("= fx", "= fy")", "beta + theta", 0.00365, R"("= -da", 0)", 4.410e-7, R"([0, 0, 0], ["= -d", 0, 0])", link);
    body("K3", R"("= xb", "= yb")", "gamma", 0.02373, R"("= sb", "= -sa")", 5.255e-6, R"([0, 0, 0], [0, "= -ss", 0], ["= sd", "= -sc", 0])",
         triangle);
    body("K4", R"("= gx", "= gy")", "phi + delta", 0.00706, R"(0, "= ea - e")", 5.667e-7, R"([0, 0, 0], [0, "= -e", 0])", link);
    body("K5", R"("= xa", "= ya")", "delta", 0.0705, R"("= ta", "= tb")", 1.169e-5, R"([0, 0, 0], ["= zt", 0, 0])", link);
    body("K6", R"("= hx", "= hy")", "omega + epsilon", 0.00706, R"("= zf - fa", 0)", 5.667e-7, R"([0, 0, 0], ["= zf", 0, 0])", link);
    body("K7", R"("= xa", "= ya")", "epsilon", 0.05498, R"("= -ub", "= -ua")", 1.912e-5, R"([0, 0, 0], [0, "= -u", 0])", link);
    return formatted(R"json({
      "fettle_scene": 1, "units": "m", "integrator": "bdf2", "timestep": %.17g, "end_time": %.17g,
      "variables": {
        "xa": "-0.06934m", "ya": "-0.00227m", "xb": "-0.03635m", "yb": "0.03273m", "xc": "0.014m", "yc": "0.072m",
        "rr": "0.007m", "ra": "0.00092m", "d": "0.028m", "da": "0.0115m", "e": "0.02m", "ea": "0.01421m",
        "ss": "0.035m", "sa": "0.01874m", "sb": "0.01043m", "sc": "0.018m", "sd": "0.02m", "zf": "0.02m", "fa": "0.01421m",
        "zt": "0.04m", "ta": "0.02308m", "tb": "0.00916m", "u": "0.04m", "ua": "0.01228m", "ub": "0.00449m",
        "beta": "-0.0617138900142764496rad", "theta": "0rad", "gamma": "0.455279819163070380rad", "phi": "0.222668390165885885rad",
        "delta": "0.487364979543842550rad", "omega": "-0.222668390165885885rad", "epsilon": "1.23054744454982125rad",
        "fx": "= rr * cos(beta)", "fy": "= rr * sin(beta)", "gx": "= xa + zt * cos(delta)", "gy": "= ya + zt * sin(delta)",
        "hx": "= xa + u * sin(epsilon)", "hy": "= ya - u * cos(epsilon)"
}
,
      "bodies": [%s],
      "joints": [
        {"name": "O", "type": "revolute", "b": "K1", "point": [0, 0, 0], "axis": [0, 0, 1]},
        {"name": "A5", "type": "revolute", "b": "K5", "point": ["= xa", "= ya", 0], "axis": [0, 0, 1]},
        {"name": "A7", "type": "revolute", "b": "K7", "point": ["= xa", "= ya", 0], "axis": [0, 0, 1]},
        {"name": "B", "type": "revolute", "b": "K3", "point": ["= xb", "= yb", 0], "axis": [0, 0, 1]},
        {"name": "F", "type": "revolute", "a": "K1", "b": "K2", "point": ["= fx", "= fy", 0], "axis": [0, 0, 1]},
        {"name": "G", "type": "revolute", "a": "K4", "b": "K5", "point": ["= gx", "= gy", 0], "axis": [0, 0, 1]},
        {"name": "H", "type": "revolute", "a": "K6", "b": "K7", "point": ["= hx", "= hy", 0], "axis": [0, 0, 1]},
        {"name": "E3", "type": "revolute", "a": "K2", "b": "K3", "point_a": ["= -d", 0, 0], "point_b": [0, "= -ss", 0], "axis": [0, 0, 1]},
        {"name": "E4", "type": "revolute", "a": "K2", "b": "K4", "point_a": ["= -d", 0, 0], "point_b": [0, "= -e", 0], "axis": [0, 0, 1]},
        {"name": "E6", "type": "revolute", "a": "K2", "b": "K6", "point_a": ["= -d", 0, 0], "point_b": ["= zf", 0, 0], "axis": [0, 0, 1]}
      ],
      "springs": [{"name": "spring", "b": "K3", "point_a": ["= xc", "= yc", 0], "point_b": ["= sd", "= -sc", 0],
                   "stiffness": 4530, "rest": 0.07785}],
      "motors": [{"name": "drive", "joint": "O", "torque": {"times": [0], "values": [0.033]}}]
})json",
                     end_time / steps, end_time, bodies.c_str());
}

using Angles = std::array<double, 7>;
constexpr Angles start{-0.0617138900142764496, 0, 0.455279819163070380, 0.222668390165885885, 0.487364979543842550, -0.222668390165885885,
                       1.23054744454982125};
constexpr Angles reference{15.81077119629904,  -15.75637105984298, 0.04082224013073101, -0.5347301163226948,
                           0.5244099658805304, 0.5347301163226948, 1.048080741042263};

/// The published coordinates at the end.
Angles end_of(int steps) {
    const Run run = part_mechanism::run(scene(steps));
    REQUIRE(run.simulation.report.status == core::stepper::SimulationStatus::ok);
    REQUIRE(run.steps() == steps);
    Angles turned{};
    for (int k = 0; k < 7; ++k) turned[k] = run.turned(k).back();
    const Angles change{turned[0], turned[1] - turned[0], turned[2], turned[3] - turned[4], turned[4], turned[5] - turned[6], turned[6]};
    Angles out{};
    for (std::size_t k = 0; k < out.size(); ++k) out[k] = start[k] + change[k];
    return out;
}

/// For each coordinate its values as the time step is halved.
std::array<std::vector<double>, 7> refined(int steps, int halvings) {
    std::array<std::vector<double>, 7> out;
    for (int k = 0; k <= halvings; ++k) {
        const Angles end = end_of(steps << k);
        for (std::size_t i = 0; i < out.size(); ++i) out[i].push_back(end[i]);
    }
    return out;
}

void check_order(const std::vector<double>& values, double expected, double band) {
    std::vector<double> errors;
    for (const double value : values) errors.push_back(value - expected);
    for (const double e : errors) UNSCOPED_INFO("error " << e);
    for (const double order : refinement::orders(errors)) CHECK(order == Approx(2).margin(band));
}

}  // namespace

TEST_CASE("Andrews' squeezer: the reference values, at the second order of BDF2") {
    const auto values = refined(2000, 2);
    for (std::size_t i = 0; i < values.size(); ++i) {
        INFO("coordinate " << i);
        check_order(values[i], reference[i], 0.25);
        CHECK(values[i].back() == Approx(reference[i]).margin(1e-3).epsilon(0));
        CHECK(refinement::extrapolated(values[i], 2) == Approx(reference[i]).margin(3e-5).epsilon(0));
    }
}

// The order is that of the integrator, so that extrapolation is justified; the limit has the solver's error too.
TEST_CASE("Andrews' squeezer: to 1e-6 of the reference values as the time step goes to 0", "[slow]") {
    const auto values = refined(3000, 3);
    for (std::size_t i = 0; i < values.size(); ++i) {
        INFO("coordinate " << i);
        check_order(values[i], reference[i], 0.12);
        const double limit = refinement::extrapolated(values[i], 2);
        CHECK(limit == Approx(reference[i]).epsilon(1e-6));
        CHECK(limit == Approx(reference[i]).margin(1e-6).epsilon(0));
    }
}

}  // namespace fettle::tests::scenes::andrews_squeezer_test
