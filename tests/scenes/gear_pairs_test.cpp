// SPDX-License-Identifier: MIT
// Pairs of spur gears of the library at random: they mesh by contact, turn in the ratio of their teeth, and have the play that involutes
// have.
//
// With pitch radii r = m z / 2, base radii r cos(alpha), and teeth of the thickness s = m (pi / 2 + 2 x tan(alpha)) - backlash along the
// pitch circles, two gears at the centre distance C work at the angle alpha_w, cos(alpha_w) = (r_1 + r_2) cos(alpha) / C. Along the line of
// action their flanks have the play
//     j(C) = cos(alpha) (pi m - s_1 - s_2 + 2 (r_1 + r_2) (inv(alpha_w) - inv(alpha))),  inv(a) = tan(a) - a,
// and with the pinion held the wheel turns by j / (r_2 cos(alpha)). A larger centre distance adds
//     dj / dC = 2 sin(alpha_w),  along the working pitch circles 2 dC tan(alpha_w),
// to first order; to second order dC^2 / (C tan(alpha_w)) more, at most.
//
// Parts never touch: where the wheel is at rest against the pinion their meshes are at the distance d that the simulation reports, and
// their flanks, on which the vertices lie, at one from d - deviation to d, the deviation being that of both.
#include <random>

#include "tests/scenes/part_mechanism.hpp"

namespace fettle::tests::scenes::gear_pairs_test {

using namespace part_mechanism;

namespace {

constexpr double pi = std::numbers::pi, degrees = std::numbers::pi / 180;

double inv(double angle) { return std::tan(angle) - angle; }

struct Gear {
    int teeth = 20;
    double shift = 0, backlash = 0.1;  ///< [modules], [mm]
};

/// In mm.
struct Pair {
    double module = 2, alpha = 20 * degrees, root_fillet = 0.6, width = 5;
    double facets = 0;  ///< 0: as the part has them
    Gear pinion, wheel;

    double pitch_radius(const Gear& gear) const { return module * gear.teeth / 2; }
    double base_radius(const Gear& gear) const { return pitch_radius(gear) * std::cos(alpha); }
    double tip_radius(const Gear& gear) const { return pitch_radius(gear) + module * (1 + gear.shift); }
    double root_radius(const Gear& gear) const { return pitch_radius(gear) - module * (1.25 - gear.shift); }
    double thickness(const Gear& gear) const { return module * (pi / 2 + 2 * gear.shift * std::tan(alpha)) - gear.backlash; }
    /// Where the fillet ends that the cutter leaves.
    double form_radius(const Gear& gear) const {
        const double depth = module * (1.25 - gear.shift) - root_fillet;
        return std::hypot(root_radius(gear) + root_fillet * (1 - std::sin(alpha)), depth / std::tan(alpha) + root_fillet * std::cos(alpha));
    }

    double sum() const { return pitch_radius(pinion) + pitch_radius(wheel); }
    double working_angle(double distance) const { return std::acos(sum() * std::cos(alpha) / distance); }
    double play(double distance) const {
        return std::cos(alpha) *
               (pi * module - thickness(pinion) - thickness(wheel) + 2 * sum() * (inv(working_angle(distance)) - inv(alpha)));
    }
    /// Where teeth without backlash would have no play.
    double centre_distance() const {
        const double wanted = inv(alpha) + module * (pinion.shift + wheel.shift) * std::tan(alpha) / sum();
        double low = 1e-3, high = 1;
        for (int k = 0; k < 60; ++k) (inv((low + high) / 2) < wanted ? low : high) = (low + high) / 2;
        return sum() * std::cos(alpha) / std::cos(low);
    }

    double contact_length(double distance) const {
        const auto along = [&](const Gear& gear) { return std::sqrt(std::pow(tip_radius(gear), 2) - std::pow(base_radius(gear), 2)); };
        return along(pinion) + along(wheel) - distance * std::sin(working_angle(distance));
    }
    /// Whether a designer would take it: more than one pair of teeth in contact, tips free of roots, contact on involutes alone.
    bool is_sound(double distance) const {
        if (contact_length(distance) < 1.15 * 2 * pi * base_radius(pinion) / pinion.teeth) return false;
        for (const auto& [a, b] : {std::pair{pinion, wheel}, std::pair{wheel, pinion}}) {
            if (distance - tip_radius(a) - root_radius(b) < 0.1 * module) return false;
            const double reached =
                distance * std::sin(working_angle(distance)) - std::sqrt(std::pow(tip_radius(a), 2) - std::pow(base_radius(a), 2));
            if (reached < std::sqrt(std::pow(form_radius(b), 2) - std::pow(base_radius(b), 2))) return false;
        }
        return true;
    }

    Part part(const Gear& gear) const {
        return {"spur_gear",
                {{"module", module},
                 {"pressure_angle", alpha / degrees},
                 {"profile_shift", gear.shift},
                 {"backlash", gear.backlash},
                 {"root_fillet", root_fillet},
                 {"width", width},
                 {"shaft_radius", 2}},
                {{"teeth", gear.teeth}},
                facets};
    }
    /// The inertia of the wheel about its axis [kg m^2], as of a disc of its pitch circle.
    double inertia() const { return 1240e-15 * width * pi / 2 * std::pow(pitch_radius(wheel), 4); }

    /// @param pinion_type, motors  What holds or drives them.
    std::string scene(double distance, double end_time, const std::string& pinion_type, const std::string& motors) const {
        return formatted(R"({
          "fettle_scene": 1, "units": "mm", "timestep": 0.01, "end_time": %.17g,
          "bodies": [
            {"name": "pinion", "density": 1240, "type": "%s", "shape": %s},
            {"name": "wheel", "density": 1240, "position": [%.17g, 0, 0], "rotation": [0, 0, %.17g], "shape": %s}
          ],
          "joints": [
            {"name": "pinion_hinge", "type": "revolute", "b": "pinion", "point": [0, 0, 0], "axis": [0, 0, 1]},
            {"name": "wheel_hinge", "type": "revolute", "b": "wheel", "point": [%.17g, 0, 0], "axis": [0, 0, 1], "damping": %.17g}
          ],
          "motors": [%s]
        })",
                         end_time, pinion_type.c_str(), shape_text(part(pinion)).c_str(), distance, 180 + 180.0 / wheel.teeth,
                         shape_text(part(wheel)).c_str(), distance, inertia() / 0.02, motors.c_str());
    }
};

Pair random_pair(std::mt19937& random) {
    const auto between = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
    const auto count = [&](int low, int high) { return std::uniform_int_distribution<int>(low, high)(random); };
    for (int trial = 0; trial < 1000; ++trial) {
        Pair pair;
        pair.module = between(1, 2.5);
        pair.alpha = between(18, 26) * degrees;
        pair.root_fillet = between(0.15, 0.3) * pair.module;
        pair.width = between(3, 8);
        pair.pinion = {count(12, 30), between(-0.2, 0.5), between(0.02, 0.08) * pair.module};
        pair.wheel = {count(12, 40), between(-0.3, 0.5), between(0.02, 0.08) * pair.module};
        const double distance = pair.centre_distance();
        if (!pair.is_sound(distance) || !pair.is_sound(distance + 0.1 * pair.module)) continue;
        if (drawn(pair.part(pair.pinion)) && drawn(pair.part(pair.wheel))) return pair;
    }
    FAIL("no sound pair found");
    return {};
}

std::string name_of(const Pair& pair) {
    return formatted("module %.3f, alpha %.2f, %d and %d teeth, shifts %.3f and %.3f, backlashes %.3f and %.3f", pair.module,
                     pair.alpha / degrees, pair.pinion.teeth, pair.wheel.teeth, pair.pinion.shift, pair.wheel.shift, pair.pinion.backlash,
                     pair.wheel.backlash);
}

constexpr int steps_per_pitch = 25;
constexpr double rounding = 1e-4;  // mm; of what the solver leaves, too

/// Two pitches and a half; in the first half the wheel comes to rest against the pinion.
Run meshing(const Pair& pair, double distance) {
    const double rate = 360.0 / pair.pinion.teeth / (0.01 * steps_per_pitch);
    const std::string drive = formatted(R"({"name": "drive", "joint": "pinion_hinge", "angle": {"rate": %.17g}})", rate);
    return run(pair.scene(distance, 0.01 * (2.5 * steps_per_pitch + 0.5), "dynamic", drive));
}

/// Whole pitches, from every step at which one can begin, against the ratio of a pair's teeth.
std::string fault_of_ratio(const Run& run, const Pair& pair) {
    const std::vector<double> pinion = run.turned(0), wheel = run.turned(1);
    double worst = 0;
    for (int t = steps_per_pitch / 2; t + steps_per_pitch <= run.steps(); ++t) {
        const double ratio = -(pinion[t + steps_per_pitch] - pinion[t]) / (wheel[t + steps_per_pitch] - wheel[t]);
        worst = std::max(worst, std::abs(ratio * pair.pinion.teeth / pair.wheel.teeth - 1));
    }
    return worst < 1e-3 ? "" : formatted("the ratio over a pitch is off by %.2g of it", worst);
}

/// At every step: along the line of action the wheel is behind by half of the play, with which it began, less the gap of the flanks. That
/// is within the contact's distance, for the wheel brakes, and no less than what the meshes leave: tips that are about to meet a flank may
/// be somewhat nearer than the flanks that touch.
std::string fault_of_transmission(const Run& run, const Pair& pair, double distance, double deviation) {
    const std::vector<double> pinion = run.turned(0), wheel = run.turned(1);
    for (int t = steps_per_pitch / 2; t <= run.steps(); ++t) {
        const double behind = pinion[t] * pair.base_radius(pair.pinion) + wheel[t] * pair.base_radius(pair.wheel),
                     gap = pair.play(distance) / 2 - behind, least = 1e3 * run.distance(t) - deviation, most = 1e3 * run.model.dhat;
        if (!(gap > least - rounding && gap < most))
            return formatted("step %d: the flanks are %.4f mm apart, allowed: from %.4f to %.4f", t, gap, least, most);
    }
    return {};
}

struct FreeTurn {
    double along = 0;   ///< that the wheel turns by, times its base radius [mm]
    double gaps = 0;    ///< at its two ends [mm]
    double covers = 0;  ///< of the round surfaces there, of which the play knows nothing [mm]
};

/// A torque turns the wheel one way, then back, with the pinion held.
FreeTurn free_turn(const Run& run, const Pair& pair) {
    const std::vector<double> wheel = run.turned(1);
    const int half = run.steps() / 2;
    return {(wheel[half] - wheel[run.steps()]) * pair.base_radius(pair.wheel), 1e3 * (run.distance(half) + run.distance(run.steps())),
            2e3 * run.covers()};
}

Run turned_both_ways(const Pair& pair, double distance) {
    constexpr double push = 0.2;  // N, at the base circle
    const double torque = push * 1e-3 * pair.base_radius(pair.wheel);
    const std::string motor = formatted(
        R"({"name": "hand", "joint": "wheel_hinge", "torque": {"times": [0.4, 0.41], "values": [%.17g, %.17g]}})", torque, -torque);
    return run(pair.scene(distance, 0.805, "static", motor));
}

/// Against the closed form; the meshes' facets are off by `deviation`.
std::string fault_of_play(const FreeTurn& turn, const Pair& pair, double distance, double deviation) {
    const double found = turn.along + turn.gaps, play = pair.play(distance);
    if (found > play - turn.covers - rounding && found < play + 2 * deviation + rounding) return {};
    return formatted("the play is from %.4f to %.4f mm, by the closed form %.4f", found - 2 * deviation, found + turn.covers, play);
}

double deviation_of(const Pair& pair) {
    return 1e3 * (drawn(pair.part(pair.pinion))->deviation.out + drawn(pair.part(pair.wheel))->deviation.out);
}

void check(const Pair& pair) {
    INFO(name_of(pair));
    const double distance = pair.centre_distance();
    const Run meshed = meshing(pair, distance);
    CHECK(fault_of(meshed) == "");
    CHECK(fault_of_ratio(meshed, pair) == "");
    CHECK(fault_of_transmission(meshed, pair, distance, deviation_of(pair)) == "");
    Pair other = pair;
    ++other.wheel.teeth;
    CHECK(fault_of_ratio(meshed, other) != "");
    CHECK(fault_of_transmission(meshed, other, distance, deviation_of(pair)) != "");

    Pair fine = pair;
    fine.facets = 0.002;
    const double deviation = deviation_of(fine), apart = 0.1 * pair.module;
    for (const double at : {distance, distance + apart}) {
        const Run turned = turned_both_ways(fine, at);
        CHECK(fault_of(turned) == "");
        const FreeTurn turn = free_turn(turned, fine);
        CHECK(fault_of_play(turn, fine, at, deviation) == "");
        CHECK(fault_of_play(turn, fine, at + 0.02, deviation) != "");
        other = fine;
        other.wheel.backlash -= 0.02;
        CHECK(fault_of_play(turn, other, at, deviation) != "");
    }
    // To first order, along the working pitch circles.
    const double angle = pair.working_angle(distance), more = (pair.play(distance + apart) - pair.play(distance)) / std::cos(angle);
    CHECK(more == Approx(2 * apart * std::tan(angle)).margin(apart * apart / (distance * std::tan(angle))));
}

}  // namespace

TEST_CASE("gear pairs: two pairs turn in the ratio of their teeth, with the play of involutes") {
    std::mt19937 random(3);
    for (int k = 0; k < 2; ++k) check(random_pair(random));
}

TEST_CASE("gear pairs: twenty pairs turn in the ratio of their teeth, with the play of involutes", "[slow]") {
    std::mt19937 random(4);
    for (int k = 0; k < 20; ++k) check(random_pair(random));
}

}  // namespace fettle::tests::scenes::gear_pairs_test
