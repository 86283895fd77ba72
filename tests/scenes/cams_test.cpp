// SPDX-License-Identifier: MIT
// Cams of the library lift their followers by contact as their laws say. The follower's origin is the centre of its roller, a point of its
// flat face, or its edge; by the law it is at low + s(angle) from the cam's axis. It is farther out by e, because parts never touch: their
// meshes are at the distance d, which the simulation reports, and their true surfaces at the distance g from d - out to d + in, where out
// and in are how far true surfaces are outside and inside of the meshes of both. So
//     d - out <= e <= (d + in) / cos(pressure),
// for the follower's line leads e away from the point of the law, to which g is the least distance, and on the way g grows by the cosine of
// the pressure angle at least. As d is below dhat, the law is met to (dhat + in) / cos(pressure).
#include <functional>

#include "tests/scenes/part_mechanism.hpp"

namespace fettle::tests::scenes::cams_test {

using namespace part_mechanism;

namespace {

constexpr double pi = std::numbers::pi, degrees = std::numbers::pi / 180;

using Law = std::function<double(double)>;

double polynomial(double x) { return x * x * x * (10 - 15 * x + 6 * x * x); }
double cycloid(double x) { return x - std::sin(2 * pi * x) / (2 * pi); }
/// By its definition: the acceleration is a sine of quick ends and a slow middle. Integrated twice, with the lift of 1.
double modified_sine(double x) {
    const double scale = 1 / (1 + 4 / pi);  // so that the lift is 1
    if (x > 0.5) return 1 - modified_sine(1 - x);
    if (x < 0.125) return scale * (x - std::sin(4 * pi * x) / (4 * pi));
    return scale * (x + 2 / pi - 9 / (4 * pi) * std::sin(pi / 3 + 4 * pi / 3 * x));
}

/// Rises, dwells, falls and rests as the parts do, if nothing else is said to them [rad -> mm].
Law rise_and_fall(double lift, const Law& law) {
    return [=](double angle) {
        const double a = angle / degrees;
        if (a < 110) return lift * law(a / 110);
        if (a < 150) return lift;
        return a < 270 ? lift * (1 - law((a - 150) / 120)) : 0;
    };
}

/// The closed cubic spline through points at every 30 degrees, by its equations: second derivatives agree at the points, where the
/// parameter grows by the roots of the chords.
Law spline_through(double low, const std::vector<double>& lifts) {
    const int n = count_of(lifts);
    MatrixX points(n, 2), right = MatrixX::Zero(n, 2), matrix = MatrixX::Zero(n, n);
    for (int k = 0; k < n; ++k) points.row(k) = (low + lifts[k]) * Vector2(std::cos(2 * pi * k / n), std::sin(2 * pi * k / n)).transpose();
    VectorX step(n);
    for (int k = 0; k < n; ++k) step[k] = std::sqrt((points.row((k + 1) % n) - points.row(k)).norm());
    for (int k = 0; k < n; ++k) {  // of the second derivatives
        const int before = (k + n - 1) % n, after = (k + 1) % n;
        matrix(k, before) += step[before] / 6;
        matrix(k, k) += (step[before] + step[k]) / 3;
        matrix(k, after) += step[k] / 6;
        right.row(k) = (points.row(after) - points.row(k)) / step[k] - (points.row(k) - points.row(before)) / step[before];
    }
    const MatrixX bends = matrix.partialPivLu().solve(right);
    return [=](double angle) {
        const int k = std::min(n - 1, static_cast<int>(angle / (2 * pi) * n)), after = (k + 1) % n;
        const auto at = [&](double u) -> Vector2 {
            const double a = 1 - u, h = step[k];
            return (a * points.row(k) + u * points.row(after) +
                    h * h / 6 * ((a * a * a - a) * bends.row(k) + (u * u * u - u) * bends.row(after)))
                .transpose();
        };
        double from = 0, to = 1;  // where the ray meets it
        for (int i = 0; i < 60; ++i) {
            const double middle = (from + to) / 2;
            const Vector2 p = at(middle);
            (std::remainder(std::atan2(p.y(), p.x()) - angle, 2 * pi) < 0 ? from : to) = middle;
        }
        return at(from).norm() - low;
    };
}

enum class Follower { roller, flat, knife };

struct Cam {
    std::string part;
    Follower follower = Follower::roller;
    double low = 25;  ///< of the follower's origin [mm]
    Law law;          ///< its lift [mm] at the cam's angle from 0 to 2 pi
};

constexpr double roller_radius = 5;  // mm, the parts' own

std::string follower_text(Follower follower, double facets) {
    const std::string with = facets > 0 ? formatted(R"(, "facets": %.17g)", facets) : "";
    if (follower == Follower::roller)
        return formatted(R"({"profiles": {"bar": {"slot": [[0, 0], [40, 0]], "radius": %g}}, "solid": {"extrude": "bar", "to": 6}%s})",
                         roller_radius, with.c_str());
    const char* path = follower == Follower::flat ? "[0, -12], [4, -12], [4, -4], [40, -4], [40, 4], [4, 4], [4, 12], [0, 12]"
                                                  : "[0, 0], [8, -4], [40, -4], [40, 4], [8, 4]";
    return formatted(R"({"profiles": {"bar": {"path": [%s]}}, "solid": {"extrude": "bar", "to": 6}%s})", path, with.c_str());
}

constexpr double start_gap = 0.1;  // mm

std::string scene_of(const Cam& cam, double facets) {
    return formatted(R"({
      "fettle_scene": 1, "units": "mm", "timestep": 0.01, "end_time": 2,
      "bodies": [
        {"name": "cam", "density": 1240, "shape": %s},
        {"name": "follower", "density": 1240, "position": [%.17g, 0, 0], "shape": %s}
      ],
      "joints": [
        {"name": "shaft", "type": "revolute", "b": "cam", "point": [0, 0, 0], "axis": [0, 0, 1]},
        {"name": "guide", "type": "prismatic", "b": "follower", "point": [60, 0, 3], "axis": [1, 0, 0], "stiffness": 200, "preload": 2}
      ],
      "motors": [{"name": "drive", "joint": "shaft", "angle": {"rate": -180}}]
    })",
                     shape_text({cam.part, {}, {}, facets}).c_str(), cam.low + cam.law(0) + start_gap,
                     follower_text(cam.follower, facets).c_str());
}

double pressure_cosine(const Cam& cam) {
    if (cam.follower == Follower::flat) return 1;
    double steepest = 0;
    constexpr int samples = 3600;
    for (int k = 1; k < samples; ++k) {
        const double angle = 2 * pi * k / samples, h = pi / samples;
        steepest = std::max(steepest, std::abs(cam.law(angle + h) - cam.law(angle - h)) / (2 * h) / (cam.low + cam.law(angle)));
    }
    return 1 / std::hypot(1, steepest);
}

/// Compares the follower with a cam's law; its meshes have facets of so much [mm].
std::string fault_of(const Run& run, const Cam& cam, double facets) {
    const auto part = drawn({cam.part, {}, {}, facets});
    if (!part) return part.errors().front().message;
    double out = 1e3 * part->deviation.out, in = 1e3 * part->deviation.in;
    if (cam.follower == Follower::roller) in += facets > 0 ? facets : roller_radius * (1 / std::cos(pi / 48) - 1);
    in += 1e3 * run.covers();
    const double cosine = pressure_cosine(cam), dhat = 1e3 * run.model.dhat;
    const std::vector<double> turned = run.turned(0);
    double worst = 0;
    for (int t = 3; t <= run.steps(); ++t) {  // the spring has pushed it onto the cam
        const double angle = std::clamp(-turned[t], 0.0, 2 * pi - 1e-12), d = 1e3 * run.distance(t);
        const double e = 1e3 * (run.x(1, t) - run.x(1, 0)) + start_gap + cam.law(0) - cam.law(angle);
        if (!(d < dhat)) return formatted("the follower has left the cam at %.1f deg", angle / degrees);
        if (e < d - out - 1e-6 || e > (d + in) / cosine + 1e-6)
            return formatted("at %.1f deg the follower is %.4f mm too far out, allowed: from %.4f to %.4f", angle / degrees, e, d - out,
                             (d + in) / cosine);
        worst = std::max(worst, std::abs(e));
    }
    return worst < (dhat + in) / cosine ? "" : "beyond the contact's distance";
}

Cam spline_cam() {
    const std::vector<double> lifts{0, 0.5, 2, 4, 5.5, 6, 5.5, 4, 2, 0.5, 0, 0};
    return {"plate_cam_spline", Follower::roller, 25, spline_through(25, lifts)};
}

std::vector<Cam> cams() {
    return {{"plate_cam_345", Follower::roller, 25, rise_and_fall(8, polynomial)},
            {"plate_cam_cycloidal", Follower::roller, 25, rise_and_fall(8, cycloid)},
            {"plate_cam_modified_sine", Follower::roller, 25, rise_and_fall(8, modified_sine)},
            {"plate_cam_345_flat", Follower::flat, 25, rise_and_fall(6, polynomial)},
            {"plate_cam_345_knife", Follower::knife, 22, rise_and_fall(8, polynomial)},
            spline_cam()};
}

}  // namespace

TEST_CASE("cams: a roller follows the 3-4-5 polynomial") {
    const Cam cam = cams().front();
    const Run turned = run(scene_of(cam, 0));
    CHECK(part_mechanism::fault_of(turned) == "");
    CHECK(fault_of(turned, cam, 0) == "");
    Cam late = cam;  // by a degree
    late.law = [law = cam.law](double angle) { return law(std::fmod(angle + 359 * degrees, 2 * pi)); };
    CHECK(fault_of(turned, late, 0) != "");
}

TEST_CASE("cams: every follower follows its law, and no other", "[slow]") {
    const std::vector<Law> laws{polynomial, cycloid, modified_sine};
    for (const Cam& cam : cams()) {
        for (const double facets : {0.0, 0.005}) {
            INFO(cam.part << ", facets of " << facets << " mm");
            const Run turned = run(scene_of(cam, facets));
            CHECK(part_mechanism::fault_of(turned) == "");
            CHECK(fault_of(turned, cam, facets) == "");
            if (facets == 0) continue;
            int met = 0;  // of the three laws: the spline meets none of them
            for (const Law& law : laws) {
                Cam other = cam;
                other.law = rise_and_fall(cam.follower == Follower::flat ? 6 : 8, law);
                met += fault_of(turned, other, facets).empty() ? 1 : 0;
            }
            CHECK(met == (cam.part == "plate_cam_spline" ? 0 : 1));
        }
    }
}

}  // namespace fettle::tests::scenes::cams_test
