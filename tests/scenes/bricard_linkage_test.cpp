// SPDX-License-Identifier: MIT
// Bricard's linkage of six equal links and six hinges (IFToMM's library of benchmarks, "Bricard's mechanism"): counted by its joints it
// cannot move, and yet it turns inside out. The links begin as six edges of a cube; the one along z is the ground, and weight pulls along
// -y. Every second hinge turns alike, so that two angles theta and phi say where all is, and
//     (1 + cos theta) (1 + cos phi) = 1
// closes the loop (Chen, You, Tarnai 2005, with twists of 90 degrees in turn to either side). With one degree of freedom s along that
// curve, the energy 1/2 M(s) s'^2 + V(s) gives the motion; it is integrated here. fettle's settings are its own.
#include "tests/scenes/part_mechanism.hpp"
#include "tests/scenes/refinement.hpp"
#include "tests/support/integrated.hpp"

namespace fettle::tests::scenes::bricard_linkage_test {

using namespace part_mechanism;
using support::State;

namespace {

constexpr double pi = std::numbers::pi;
constexpr int links = 5;                                   // that move
constexpr double length = 1, side = 0.05, gravity = 9.81;  // of a link, along -y
constexpr double density = 1 / (length * side * side);     // 1 kg each

/// At the start: the corners of the cube that the links join in turn, hinges at all of them, and the axes of these.
const std::array<Vector3, 6> corners{Vector3(0, 0, 0), Vector3(1, 0, 0), Vector3(1, 1, 0),
                                     Vector3(1, 1, 1), Vector3(0, 1, 1), Vector3(0, 0, 1)};
Vector3 link_start(int k) { return corners[(k + 1) % 6] - corners[k]; }
Vector3 axis_start(int k) { return link_start((k + 5) % 6).cross(link_start(k)); }

std::string scene(const char* integrator, double timestep, double end_time) {
    std::string bodies, joints;
    const char* names[] = {"a", "b", "c", "d", "e"};
    for (int k = 0; k < links; ++k) {
        const Vector3 middle = 0.5 * (corners[k] + corners[k + 1]), along = link_start(k).cwiseAbs();
        const Vector3 size = 1e3 * (length * along + side * (Vector3::Ones() - along));
        bodies += formatted(R"(%s
            {"name": "%s", "group": "linkage", "density": %.17g, "position": [%g, %g, %g],
             "shape": {"part": "box", "dimensions": {"size_x": %g, "size_y": %g, "size_z": %g}}})",
                            k == 0 ? "" : ",", names[k], density, 1e3 * middle.x(), 1e3 * middle.y(), 1e3 * middle.z(), size.x(), size.y(),
                            size.z());
    }
    for (int k = 0; k < 6; ++k) {
        const Vector3 &point = corners[k], axis = axis_start(k);
        joints += formatted(R"(%s
            {"name": "hinge %d", "type": "revolute", "point": [%g, %g, %g], "axis": [%g, %g, %g])",
                            k == 0 ? "" : ",", k, 1e3 * point.x(), 1e3 * point.y(), 1e3 * point.z(), axis.x(), axis.y(), axis.z());
        if (k > 0) joints += formatted(R"(, "a": "%s")", names[k - 1]);
        if (k < links) joints += formatted(R"(, "b": "%s")", names[k]);
        joints += '}';
    }
    return formatted(
        R"({"fettle_scene": 1, "units": "mm", "gravity": [0, %.17g, 0], "integrator": "%s", "timestep": %.17g, "end_time": %.17g,
      "bodies": [%s],
      "joints": [%s]
    })",
        -gravity, integrator, timestep, end_time, bodies.c_str(), joints.c_str());
}

/// The linkage at two angles, and how fast it moves as they change by a unit along the curve that closes it.
struct Linkage {
    double theta, phi;

    Vector2 tangent() const {
        const Vector2 t((1 + std::cos(theta)) * std::sin(phi), -std::sin(theta) * (1 + std::cos(phi)));
        return t.normalized();
    }
    double turn(int k) const { return (k % 2 == 0 ? theta : phi) - pi / 2; }  // of hinge k, since the start
    /// The rotations of the six links, the ground the last; from the cube's edges.
    std::array<Matrix3, 6> rotations() const {
        std::array<Matrix3, 6> out;
        Matrix3 r = Matrix3::Identity();
        for (int k = 0; k < 6; ++k) out[k] = r = r * Eigen::AngleAxisd(turn(k), axis_start(k)).toRotationMatrix();
        return out;
    }
    /// Where each link ends.
    std::array<Vector3, 6> ends() const {
        const std::array<Matrix3, 6> r = rotations();
        std::array<Vector3, 6> out;
        Vector3 end = Vector3::Zero();
        for (int k = 0; k < 6; ++k) out[k] = end += r[k] * link_start(k);
        return out;
    }
    /// M [kg m^2] and dV/ds [J].
    std::array<double, 2> mass_and_slope() const {
        const std::array<Matrix3, 6> r = rotations();
        const Vector2 t = tangent();
        Vector3 omega = Vector3::Zero(), velocity = Vector3::Zero();  // of a link, of where it begins
        double mass = 0, slope = 0;
        for (int k = 0; k < links; ++k) {
            const Matrix3 before = k == 0 ? Matrix3(Matrix3::Identity()) : r[k - 1];
            omega += t[k % 2] * (before * axis_start(k));
            const Vector3 along = r[k] * link_start(k), middle = velocity + 0.5 * omega.cross(along);
            const double spin = omega.dot(along);
            mass += middle.squaredNorm() + side * side / 6 * spin * spin +
                    (length * length + side * side) / 12 * (omega.squaredNorm() - spin * spin);
            slope += gravity * middle.y();
            velocity += omega.cross(along);
        }
        return {mass, slope};
    }
};

/// theta, phi and s' after a time, from rest.
State moved(double time) {
    const auto rates = [](const State& y) {
        const Linkage now{y[0], y[1]};
        const Vector2 t = now.tangent();
        const auto mass_at = [&](double s) { return Linkage{y[0] + s * t[0], y[1] + s * t[1]}.mass_and_slope()[0]; };
        constexpr double e = 2e-3;  // difference of fourth order
        const double change = (8 * (mass_at(e) - mass_at(-e)) - (mass_at(2 * e) - mass_at(-2 * e))) / (12 * e);
        const auto [mass, slope] = now.mass_and_slope();
        return State{t[0] * y[2], t[1] * y[2], -(slope + 0.5 * change * y[2] * y[2]) / mass};
    };
    return support::integrated({pi / 2, pi / 2, 0}, rates, time, 4000);
}

struct Errors {
    double place;   ///< of the hinges at the end, the largest [m]
    double energy;  ///< largest on the way, of the greatest kinetic energy
};

Errors errors_of(const char* integrator, double timestep, double end_time, const Linkage& expected) {
    core::stepper::SimulationOptions options;
    options.outputs = true;
    const Run run = part_mechanism::run(scene(integrator, timestep, end_time), options);
    REQUIRE(run.simulation.report.status == core::stepper::SimulationStatus::ok);
    REQUIRE(run.steps() == std::lround(end_time / timestep));
    Errors out{};
    for (int k = 0; k < links; ++k) {
        const Vector3 reached = run.pose(k, run.steps()).position + 0.5 * (run.pose(k, run.steps()).rotation * link_start(k));
        out.place = std::max(out.place, (reached - expected.ends()[k]).norm());
    }
    double start = 0, most = 0;
    for (int k = 0; k < links; ++k) start += gravity * 0.5 * (corners[k] + corners[k + 1]).y();
    for (const auto& step : run.simulation.outputs) {
        out.energy = std::max(out.energy, std::abs(step.kinetic_energy + step.potential_energy - start));
        most = std::max(most, step.kinetic_energy);
    }
    out.energy /= most;
    return out;
}

}  // namespace

TEST_CASE("Bricard's linkage: turns inside out as its one degree of freedom does, at each integrator's order") {
    constexpr double time = 1.6;
    const State end = moved(time);
    const Linkage expected{end[0], end[1]};
    // The reference closes, and keeps its energy.
    CHECK((expected.ends()[5] - corners[0]).norm() < 1e-9);
    CHECK((expected.rotations()[5] - Matrix3::Identity()).norm() < 1e-9);
    struct Case {
        const char* integrator;
        int order;
        double coarsest, place, energy;  // [s]; errors at an eighth of it: [m], share
    };
    for (const Case& c : {Case{"implicit_euler", 1, 1e-3, 0.01, 0.01}, Case{"bdf2", 2, 4e-3, 1e-4, 4e-5}}) {
        INFO(c.integrator);
        std::vector<double> places, energies;
        for (int k = 0; k <= 3; ++k) {
            const Errors errors = errors_of(c.integrator, c.coarsest / (1 << k), time, expected);
            places.push_back(errors.place);
            energies.push_back(errors.energy);
        }
        for (const double order : refinement::orders(places)) CHECK(order == Approx(c.order).margin(0.1));
        for (const double order : refinement::orders(energies)) CHECK(order == Approx(c.order).margin(0.1));
        CHECK(places.back() < c.place);
        CHECK(energies.back() < c.energy);
    }
}

}  // namespace fettle::tests::scenes::bricard_linkage_test
