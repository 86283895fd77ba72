// SPDX-License-Identifier: MIT
// Geneva drives turn their wheels by contact as the closed form says, to within the play of the pin in its slot and of the locking disc in
// its arc. With the centre distance c and the crank a = c sin(pi / N), the driver's angle t from the line of centres:
//     wheel(t) = -atan2(a sin t, c - a cos t)  while the pin is in a slot, |t| <= pi / 2 - pi / N;  +-pi / N in between.
// The play follows from `clearance` alone: the wheel may be off by so much that the pin touches a wall of its slot, or the locking disc an
// end of its arc. Both parts' meshes cover the true parts, so that the mesh's play is at most that.
#include "tests/scenes/part_mechanism.hpp"

namespace fettle::tests::scenes::geneva_drives_test {

using namespace part_mechanism;

namespace {

constexpr double pi = std::numbers::pi, degrees = pi / 180;

/// In m. The play is found by turning the wheel until a true surface is met.
struct GenevaDrive {
    int slots = 6;
    double centre_distance = 40e-3, pin_radius = 2.5e-3, clearance = 0.2e-3, lip = 2e-3;

    double step() const { return pi / slots; }  // half of what the wheel turns by
    double crank() const { return centre_distance * std::sin(step()); }
    double reach() const { return centre_distance * std::cos(step()); }
    double half_slot() const { return pin_radius + clearance; }
    double arc_radius() const { return crank() - half_slot() - lip; }
    double entry() const { return pi / 2 - step(); }

    Vector2 pin(double t) const { return {centre_distance - crank() * std::cos(t), -crank() * std::sin(t)}; }

    /// The wheel's angle, at the driver's angle t from -pi to pi.
    double wheel(double t) const {
        if (std::abs(t) > entry()) return t < 0 ? step() : -step();
        const Vector2 p = pin(t);
        return std::atan2(p.y(), p.x());
    }

    /// Whether the wheel's slot, in which the pin is or will be next, has room for the pin if it is `off`.
    bool pin_fits(double t, double off) const {
        const Vector2 p = Eigen::Rotation2Dd(-wheel(t) - off) * pin(t);
        const double walls = std::sqrt(reach() * reach() - half_slot() * half_slot()), beyond = std::max(0.0, p.x() - walls);
        if (beyond >= pin_radius) return true;
        return std::abs(p.y()) <= half_slot() - std::sqrt(pin_radius * pin_radius - beyond * beyond);
    }

    /// Whether the locking disc has room in the arc: an end of the arc may meet the disc, where this is not cut away.
    bool disc_fits(double t, double off) const {
        const double disc = arc_radius() - clearance, swing = reach() + clearance, c = centre_distance;
        const double half_gap = std::acos((disc * disc + c * c - swing * swing) / (2 * disc * c));
        const double half_arc = std::acos((reach() * reach() + c * c - arc_radius() * arc_radius()) / (2 * reach() * c));
        const double arc_middle = t < 0 ? wheel(t) - step() : wheel(t) + step();
        for (const double end : {-half_arc, half_arc}) {
            const double angle = arc_middle + off + end;
            const Vector2 corner(reach() * std::cos(angle) - c, reach() * std::sin(angle));  // from the driver's axis
            const double from_pin = std::remainder(std::atan2(corner.y(), corner.x()) - (pi + t), 2 * pi);
            if (std::abs(from_pin) > half_gap && corner.norm() < disc) return false;
        }
        return true;
    }

    /// How far the wheel may be off, backwards and forwards [rad].
    std::array<double, 2> play(double t) const {
        std::array<double, 2> out{};
        for (const int sign : {-1, 1}) {
            double& off = out[sign > 0];
            while (std::abs(off) < step() && pin_fits(t, off) && disc_fits(t, off)) off += sign * 1e-5;
        }
        return out;
    }

    std::string scene(double facets = 0) const {
        const std::map<std::string, double> dimensions{{"centre_distance", 1e3 * centre_distance},
                                                       {"pin_radius", 1e3 * pin_radius},
                                                       {"clearance", 1e3 * clearance},
                                                       {"lip", 1e3 * lip},
                                                       {"shaft_radius", 2}};
        return formatted(R"({
          "fettle_scene": 1, "units": "mm", "timestep": 0.01, "end_time": 2.4,
          "bodies": [
            {"name": "wheel", "density": 1240, "position": [0, 0, 0.2], "rotation": [0, 0, %.17g], "shape": %s},
            {"name": "driver", "density": 1240, "position": [%.17g, 0, 0], "shape": %s}
          ],
          "joints": [
            {"name": "wheel_hinge", "type": "revolute", "b": "wheel", "point": [0, 0, 0], "axis": [0, 0, 1], "damping": 0.001},
            {"name": "driver_hinge", "type": "revolute", "b": "driver", "point": [%.17g, 0, 0], "axis": [0, 0, 1]}
          ],
          "motors": [{"name": "drive", "joint": "driver_hinge", "angle": {"rate": 150}}]
        })",
                         180.0 / slots, shape_text({"geneva_wheel", dimensions, {{"slots", slots}}, facets}).c_str(), 1e3 * centre_distance,
                         shape_text({"geneva_driver", dimensions, {{"slots", slots}}, facets}).c_str(), 1e3 * centre_distance);
    }
};

/// Compares the wheel's angle with a drive's closed form, its driver `late` behind.
std::string fault_of(const Run& run, const GenevaDrive& drive, double late = 0) {
    const std::vector<double> driver = run.turned(1), wheel = run.turned(0);
    for (int t = 0; t <= run.steps(); ++t) {
        const double angle = driver[t] - pi - late;
        const double off = drive.step() + wheel[t] - drive.wheel(angle);
        const auto [backwards, forwards] = drive.play(angle);
        if (off < backwards - 1e-9 || off > forwards + 1e-9)
            return formatted("the driver is at %.2f deg, the wheel is off by %.3f deg, its play is from %.3f to %.3f", angle / degrees,
                             off / degrees, backwards / degrees, forwards / degrees);
    }
    return {};
}

GenevaDrive drive_of(int slots) {
    GenevaDrive drive;
    drive.slots = slots;
    if (slots == 3) drive.centre_distance = 60e-3;  // such a wheel is small beside its driver
    return drive;
}

void check(int slots) {
    const GenevaDrive drive = drive_of(slots);
    INFO(slots << " slots");
    // The play of the pin deep in its slot is the clearance, of its distance from the wheel's axis.
    CHECK(drive.play(0)[1] == Approx(std::asin(drive.clearance / (drive.centre_distance - drive.crank()))).margin(2e-5));
    const Run turned = run(drive.scene());
    CHECK(part_mechanism::fault_of(turned) == "");
    CHECK(fault_of(turned, drive) == "");
    GenevaDrive other = drive;
    ++other.slots;
    CHECK(fault_of(turned, other) != "");
    CHECK(fault_of(turned, drive, 2 * degrees) != "");
}

/// The ring turns the way of its driver, by the angle of the pin seen from its axis, atan2(a sin t, c + a cos t), while the pin is in a
/// slot: |t| < pi / 2 + pi / N. It may be off by what the pin's clearance is at its distance.
std::string fault_of_ring(const Run& run, double slots, double start) {
    constexpr double c = 24e-3, clearance = 0.2e-3;  // the parts' own
    const double crank = c * std::sin(pi / slots);
    const std::vector<double> driver = run.turned(1), ring = run.turned(0);
    const auto pin = [&](double t) { return Vector2(c + crank * std::cos(t), crank * std::sin(t)); };
    const auto angle = [](const Vector2& p) { return std::atan2(p.y(), p.x()); };
    for (int t = 0; t <= run.steps(); ++t) {
        const Vector2 p = pin(start + driver[t]);
        const double off = angle(pin(start)) + ring[t] - angle(p), play = std::asin(clearance / p.norm());
        if (std::abs(off) > play + 1e-9)
            return formatted("the driver is at %.2f deg, the ring is off by %.3f deg, its play is %.3f", (start + driver[t]) / degrees,
                             off / degrees, play / degrees);
    }
    return {};
}

void check_ring(int slots) {
    INFO(slots << " slots");
    const double entry = 90 + 180.0 / slots, start = 2 - entry;  // deg; a little within the slot
    const double crank = 24 * std::sin(pi / slots), t = start * degrees;
    const Run turned = run(formatted(R"({
      "fettle_scene": 1, "units": "mm", "timestep": 0.01, "end_time": %.17g,
      "bodies": [
        {"name": "ring", "density": 1240, "position": [0, 0, 0.2], "rotation": [0, 0, %.17g], "shape": %s},
        {"name": "driver", "density": 1240, "position": [24, 0, 0], "rotation": [0, 0, %.17g], "shape": %s}
      ],
      "joints": [
        {"name": "ring_hinge", "type": "revolute", "b": "ring", "point": [0, 0, 0], "axis": [0, 0, 1], "damping": 0.001},
        {"name": "driver_hinge", "type": "revolute", "b": "driver", "point": [24, 0, 0], "axis": [0, 0, 1]}
      ],
      "motors": [{"name": "drive", "joint": "driver_hinge", "angle": {"rate": 150}}]
    })",
                                     -2 * start / 150, std::atan2(crank * std::sin(t), 24 + crank * std::cos(t)) / degrees,
                                     shape_text({"internal_geneva_wheel", {}, {{"slots", slots}}}).c_str(), start,
                                     shape_text({"internal_geneva_driver", {}, {{"slots", slots}}}).c_str()));
    CHECK(part_mechanism::fault_of(turned) == "");
    CHECK(fault_of_ring(turned, slots, t) == "");
    CHECK(fault_of_ring(turned, slots + 1, t) != "");
    CHECK(fault_of_ring(turned, slots, t - 3 * degrees) != "");
}

}  // namespace

TEST_CASE("Geneva drives: rings of 3 to 8 slots follow the closed form to the play of the pin", "[slow]") {
    for (int slots = 3; slots <= 8; ++slots) check_ring(slots);
}

TEST_CASE("Geneva drives: a wheel of six slots follows the closed form to its play") { check(6); }

TEST_CASE("Geneva drives: a motor that outweighs contact does not close the gap of round surfaces altogether", "[slow]") {
    for (const double facets : {0.02, 0.01, 0.005}) {
        for (const double kappa : {1e5, 1e6}) {
            INFO("facets to " << facets << " mm, " << kappa << " N/m");
            const std::map<std::string, double> dimensions{{"centre_distance", 45}, {"pin_radius", 3}, {"clearance", 0.15}};
            const auto shape = [&](const char* part) { return shape_text({part, dimensions, {{"slots", 6}}, facets}); };
            const Run turned = run(formatted(R"({
              "fettle_scene": 1, "units": "mm", "timestep": 0.01, "end_time": 0.4,
              "contact": {"round": true, "dhat": 0.05, "kappa": %.17g},
              "friction": {"eps_v": 0.5},
              "bodies": [
                {"name": "wheel", "density": 1240, "position": [0, 0, 0.4], "rotation": [0, 0, 30], "shape": %s},
                {"name": "driver", "density": 1240, "position": [45, 0, 0], "rotation": [0, 0, 240], "shape": %s},
                {"name": "table", "position": [0, 0, 6], "shape": {"part": "cylinder", "dimensions": {"radius": 15, "length": 4}},
                 "inertial": {"mass": 2, "centre": [0, 0, 2], "inertia": [[0.005, 0, 0], [0, 0.005, 0], [0, 0, 0.01]]}}
              ],
              "joints": [
                {"name": "bearing", "type": "revolute", "b": "table", "point": [0, 0, 0], "axis": [0, 0, 1], "friction": 0.15},
                {"name": "hub", "type": "fixed", "a": "table", "b": "wheel", "point": [0, 0, 0]},
                {"name": "driver_hinge", "type": "revolute", "b": "driver", "point": [45, 0, 0], "axis": [0, 0, 1]}
              ],
              "motors": [{"name": "servo", "joint": "driver_hinge", "angle": {"rate": -150}}]
            })",
                                             kappa, shape("geneva_wheel").c_str(), shape("geneva_driver").c_str()));
            CHECK(part_mechanism::fault_of(turned) == "");
        }
    }
}

TEST_CASE("Geneva drives: wheels of 3 to 8 slots follow the closed form to their play", "[slow]") {
    for (const int slots : {3, 4, 5, 7, 8}) check(slots);
}

}  // namespace fettle::tests::scenes::geneva_drives_test
