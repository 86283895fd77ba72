// SPDX-License-Identifier: MIT
// Contacts of round surfaces against closed forms and an independent section, differences, and themselves: sliding, anew, in threads.
#include "core/contact/round_contacts.hpp"

#include <catch2/catch.hpp>
#include <limits>
#include <map>
#include <random>

#include "core/base/parallel.hpp"
#include "core/contact/contact_set.hpp"
#include "core/linear/factorisations.hpp"
#include "tests/support/derivative_check.hpp"
#include "tests/support/prisms.hpp"
#include "tests/support/test_models.hpp"

namespace fettle::core::contact::round_contacts_test {

using kinematics::Pose;
using std::numbers::pi;
using namespace fettle::tests::support;

namespace {

using Poses = std::vector<Pose>;

struct Scene {
    model::Model model;
    Scene(const geometry::Mesh& first, const geometry::Mesh& second, double dhat, double dmin = 0) {
        model.dhat = dhat;
        model.dmin = dmin;
        model.bodies = {make_body("first", first, {}), make_body("second", second, {})};
        set_round(model);
    }
    BarrierParameters parameters() const { return barrier_parameters(model.dhat, model.dmin, 1e4, 1); }
};

ContactSet contacts_of(const Scene& scene, const Poses& poses) {
    return find_contacts(scene.model, ccd::find_candidates(scene.model, poses, 0), poses);
}

double energy(const Scene& scene, const Poses& poses) { return barrier_potential(contacts_of(scene, poses), scene.parameters()); }

double least_gap(const ContactSet& set) {
    double least = std::numeric_limits<double>::infinity();
    for (const auto& list : set.pairs)
        for (const auto& pair : list.contacts) least = std::min(least, gap_of(pair));
    return least;
}

int round_count(const ContactSet& set) {
    int count = 0;
    for (const auto& list : set.pairs)
        for (const auto& pair : list.contacts) count += pair.round.side != 0;
    return count;
}

double mesh_distance(const ContactSet& set) {
    return set.distances.empty() ? std::numeric_limits<double>::infinity() : set.distances.front().distance;
}

struct Derivatives {
    VectorX gradient = VectorX::Zero(12);
    MatrixX hessian = MatrixX::Zero(12, 12);
};

Derivatives derivatives(const Scene& scene, const Poses& poses, HessianKind kind) {
    std::vector<kinematics::PoseGradient> gradients(2);
    kinematics::BlockHessian hessian{std::vector<Matrix6>(2, Matrix6::Zero()), {}};
    add_barrier_derivatives(contacts_of(scene, poses), poses, scene.parameters(), kind, gradients, hessian);
    Derivatives out;
    out.gradient << tangent_gradient(gradients[0]), tangent_gradient(gradients[1]);
    for (Eigen::Index i = 0; i < 2; ++i) {
        const auto k = static_cast<std::size_t>(i);
        out.hessian.block<6, 6>(6 * i, 6 * i) = hessian.diagonal[k];
        if (kind == HessianKind::exact) out.hessian.block<3, 3>(6 * i + 3, 6 * i + 3) += kinematics::tangent_curvature(gradients[k].arm);
    }
    for (const auto& off : hessian.off_diagonal) {
        out.hessian.block<6, 6>(0, 6) += off.block;
        out.hessian.block<6, 6>(6, 0) += off.block.transpose();
    }
    return out;
}

Poses moved(Poses poses, const VectorX& d) {
    for (Eigen::Index i = 0; i < 2; ++i) {
        Pose& pose = poses[static_cast<std::size_t>(i)];
        pose.position += d.segment<3>(6 * i);
        pose.rotation = kinematics::rotation(d.segment<3>(6 * i + 3)) * pose.rotation;
    }
    return poses;
}

// Two bodies by their relative pose, turned and moved together.
Poses placed(const Pose& first, const Pose& frame) {
    return {{frame.rotation * first.rotation, world_position(frame, first.position)}, frame};
}

Pose random_frame(std::mt19937& random) {
    std::uniform_real_distribution<double> uniform(-1, 1);
    const auto number = [&] { return uniform(random); };
    return make_pose(Vector3::NullaryExpr(number), 0.1 * Vector3::NullaryExpr(number));
}

const Pose some_frame = make_pose({0.1, 0.2, 0.3}, {0.01, 0.02, 0.03});

double turn_of(const Vector2& a, const Vector2& b) { return std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b)); }

// The rounded section of an outline, for itself: how far a point outside is from it, and how far the outline sticks out of it.
class Section {
public:
    explicit Section(const Outline& outline) {
        const std::size_t n = outline.size();
        std::vector<Vector2> along(n);
        std::vector<double> length(n), tangent(n, 0);
        for (std::size_t k = 0; k < n; ++k) {
            along[k] = outline[(k + 1) % n] - outline[k];
            length[k] = along[k].norm();
            along[k] /= length[k];
        }
        for (std::size_t k = 0; k < n; ++k) {
            const std::size_t before = (k + n - 1) % n;
            const double turn = turn_of(along[before], along[k]);
            Arc arc{outline[k], 0, normal(along[before]), normal(along[k])};
            if (std::abs(turn) <= geometry::largest_smooth_turn) {
                tangent[k] = 0.5 * std::min(length[before], length[k]);
                arc.radius = tangent[k] / std::tan(0.5 * std::abs(turn));
                arc.centre = outline[k] - tangent[k] * along[before] - (turn > 0 ? 1 : -1) * arc.radius * normal(along[before]);
                if (turn > 0) cover = std::max(cover, (outline[k] - arc.centre).norm() - arc.radius);
            }
            if (turn > 0) arcs_.push_back(arc);  // a hollow is nowhere nearest to a small roller
        }
        for (std::size_t k = 0; k < n; ++k)
            planes_.push_back({outline[k] + tangent[k] * along[k], outline[(k + 1) % n] - tangent[(k + 1) % n] * along[k]});
    }

    double cover = 0;

    double distance(const Vector2& p) const {
        double least = std::numeric_limits<double>::infinity();
        for (const Arc& arc : arcs_) {
            const Vector2 from = p - arc.centre;
            if (turn_of(arc.first, from) >= 0 && turn_of(from, arc.last) >= 0) least = std::min(least, from.norm() - arc.radius);
        }
        for (const auto& [a, b] : planes_) {
            const Vector2 e = b - a;
            const double t = e.squaredNorm() > 0 ? std::clamp((p - a).dot(e) / e.squaredNorm(), 0.0, 1.0) : 0.0;
            least = std::min(least, (p - a - t * e).norm());
        }
        return least;
    }

private:
    struct Arc {
        Vector2 centre;
        double radius;
        Vector2 first, last;  // normals
    };
    static Vector2 normal(const Vector2& along) { return {along.y(), -along.x()}; }
    std::vector<Arc> arcs_;
    std::vector<std::array<Vector2, 2>> planes_;
};

double ellipse_radius(double angle) { return 2e-2 / std::sqrt(1 - 0.3 * std::cos(angle) * std::cos(angle)); }

geometry::Mesh pin(double half, int corners = 24) { return prism(circle_outline(corners, 5e-3), -half, half); }

constexpr int bore_corners = 32;
constexpr double bore_radius = 5.2e-3;  // of the inscribed circle
geometry::Mesh bore() {
    return plate_with_hole(circle_outline(bore_corners, bore_radius / std::cos(pi / bore_corners)), 4e-3, -4e-3, 4e-3);
}
geometry::Mesh slotted() { return plate_with_hole(slot_outline(16, bore_radius, 1e-2), 4e-3, -4e-3, 4e-3); }

// Energy and gradient along a way in small steps: no step changes them by much more than its neighbours do.
struct Slide {
    double jump = 0, gradient_jump = 0;  // the largest change of the change, over the largest value
    std::map<int, int> counts;
};

Slide slide(const Scene& scene, const std::function<Poses(double)>& at, double from, double to, int steps) {
    Slide out;
    double largest = 0, largest_gradient = 0;
    std::vector<double> values;
    std::vector<VectorX> gradients;
    for (int k = 0; k <= steps; ++k) {
        const Poses poses = at(from + (to - from) * k / steps);
        const ContactSet set = contacts_of(scene, poses);
        ++out.counts[set.count];
        CHECK(least_gap(set) <= mesh_distance(set) + 1e-15);
        values.push_back(barrier_potential(set, scene.parameters()));
        gradients.push_back(derivatives(scene, poses, HessianKind::none).gradient);
        largest = std::max(largest, values.back());
        largest_gradient = std::max(largest_gradient, gradients.back().norm());
    }
    REQUIRE(std::isfinite(largest));
    REQUIRE(largest > 0);
    for (std::size_t k = 2; k < values.size(); ++k) {
        out.jump = std::max(out.jump, std::abs(values[k] - 2 * values[k - 1] + values[k - 2]) / largest);
        out.gradient_jump = std::max(out.gradient_jump, (gradients[k] - gradients[k - 1]).norm() / largest_gradient);
    }
    return out;
}

// The largest sudden change of the energy along a way, over the energy there: the interval in which it bends most, again and again. What is
// continuous has none left in a millionth of a millionth of the way.
double sudden_change(const Scene& scene, const std::function<Poses(double)>& at, double from, double to) {
    constexpr int pieces = 100, levels = 7;
    double largest = 0;
    for (int level = 0; level < levels; ++level) {
        std::vector<double> values;
        for (int k = 0; k <= pieces; ++k)
            values.push_back(barrier_potential(contacts_of(scene, at(from + (to - from) * k / pieces)), scene.parameters()));
        int most = 1;
        const auto bend = [&](int k) { return std::abs(values[k + 1] - 2 * values[k] + values[k - 1]); };
        for (int k = 1; k < pieces; ++k)
            if (bend(k) > bend(most)) most = k;
        largest = std::abs(values[most + 1] - values[most - 1]) / *std::max_element(values.begin(), values.end());
        std::tie(from, to) = std::pair(from + (to - from) * (most - 1) / pieces, from + (to - from) * (most + 1) / pieces);
    }
    return largest;
}

}  // namespace

TEST_CASE("a roller on an outline has one contact at each end, as far away as its section", "[round_contacts]") {
    const std::vector<std::pair<std::string, Outline>> outlines{
        {"circle", circle_outline(40, 2e-2, 0.1)},
        {"ellipse", polar_outline(60, ellipse_radius)},
        {"box", {{1e-2, -8e-3}, {1e-2, 8e-3}, {-1e-2, 8e-3}, {-1e-2, -8e-3}}},
        {"link", slot_outline(16, 8e-3, 1e-2)},
    };
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(-1, 1);
    const double radius = 5e-3, half = 4e-3;
    for (const auto& [name, outline] : outlines)
        for (const double roller_half : {half, 3e-3, 6e-3}) {
            const Section section(outline);
            const Scene scene(pin(roller_half), prism(outline, -half, half), 1e-4, 2e-5);
            for (int t = 0; t < 24; ++t) {
                // Facet corners of both exactly, too, and ends that are flush or nearly.
                const double angle = t % 3 == 0 ? 2 * pi * (5 * t % 60) / 60 : pi * uniform(random);
                const double spin = t % 2 == 0 ? 0 : uniform(random), wanted = 2e-5 + 1e-4 * (0.05 + 0.9 * std::abs(uniform(random)));
                const double offset = roller_half == half ? (t % 2 == 0 ? 0 : 1e-4 * uniform(random)) : 2.5e-3 * uniform(random);
                const Vector2 way(std::cos(angle), std::sin(angle));
                double low = 0, high = 0.1;
                for (int k = 0; k < 60; ++k) {
                    const double middle = 0.5 * (low + high);
                    (section.distance(middle * way) - section.cover - radius < wanted ? low : high) = middle;
                }
                const double gap = section.distance(high * way) - section.cover - radius;
                const Matrix3 turn = t % 4 < 2 ? Matrix3(Matrix3::Identity()) : kinematics::rotation(Vector3(pi, 0, 0));
                const Pose at{turn * kinematics::rotation(Vector3(0, 0, spin)), {high * way.x(), high * way.y(), offset}};
                const ContactSet set = contacts_of(scene, placed(at, random_frame(random)));
                CAPTURE(name, roller_half, t, gap, set.count);
                CHECK(set.count == 2);
                CHECK(round_count(set) == 2);
                CHECK(least_gap(set) == Approx(gap).margin(1e-13));
                CHECK(mesh_distance(set) >= least_gap(set) - 1e-15);
                const BarrierParameters p = scene.parameters();
                const double value = 2 * p.factor * barrier(gap * gap - p.dmin * p.dmin, p.gap_hat).value;
                CHECK(barrier_potential(set, p) == Approx(value).epsilon(1e-7));
            }
        }
}

TEST_CASE("walls that are cut along their height have the same round contacts", "[round_contacts]") {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(-1, 1);
    for (const auto& [first, second] : {std::pair{1, 4}, {4, 1}, {3, 4}}) {
        const Scene scene(prism(circle_outline(24, 5e-3), -4e-3, 4e-3, first), prism(circle_outline(40, 2e-2), -5e-3, 3e-3, second), 1e-4);
        for (int t = 0; t < 30; ++t) {
            const double angle = pi * uniform(random), way = 2.5e-2 + 5e-5;
            const ContactSet set = contacts_of(
                scene, placed(make_pose({0, 0, uniform(random)}, {way * std::cos(angle), way * std::sin(angle), 0}), some_frame));
            CAPTURE(first, second, t);
            CHECK(set.count == 2);
            CHECK(round_count(set) == 2);
        }
    }
}

TEST_CASE("a pin in a bore has one contact at each end, wherever it is", "[round_contacts]") {
    std::mt19937 random(2);
    std::uniform_real_distribution<double> uniform(-1, 1);
    for (const double dhat : {5e-5, 5e-4}) {
        const Scene scene(pin(6e-3), bore(), dhat);
        const BarrierParameters p = scene.parameters();
        for (int t = 0; t < 400; ++t) {
            const double off = t % 3 == 0 ? std::pow(10.0, -5 - 9 * std::abs(uniform(random))) : 1.95e-4 * std::abs(uniform(random));
            const double angle = t % 4 == 0 ? 2 * pi * (t % 48) / 48 : t % 4 == 1 ? 2 * pi * (t % 64) / 64 : pi * uniform(random);
            const Matrix3 turn = t % 8 < 4 ? Matrix3(Matrix3::Identity()) : kinematics::rotation(Vector3(pi, 0, 0));
            const Pose at{turn * kinematics::rotation(Vector3(0, 0, t % 2 == 0 ? 0 : uniform(random))),
                          {off * std::cos(angle), off * std::sin(angle), 1e-3 * uniform(random)}};
            const Poses poses = placed(at, random_frame(random));
            const ContactSet set = contacts_of(scene, poses);
            const double gap = bore_radius - 5e-3 - off, far = bore_radius - 5e-3 + off;
            CAPTURE(dhat, t, off, angle, gap);
            CHECK(set.count == (gap < dhat ? 2 : 0));
            if (set.count == 0) continue;
            CHECK(least_gap(set) == Approx(gap).margin(1e-13));
            CHECK(mesh_distance(set) >= least_gap(set) - 1e-15);
            const double value = 2 * p.factor * (barrier(gap * gap, p.gap_hat).value + barrier(far * far, p.gap_hat).value);
            CHECK(barrier_potential(set, p) == Approx(value).epsilon(1e-9));
        }
    }
}

TEST_CASE("a pin in a bore is pushed to neither side where both have one centre line", "[round_contacts]") {
    const Scene scene(pin(6e-3), bore(), 5e-4);
    for (const Pose& frame : {Pose{}, some_frame}) {
        const Poses poses = placed({}, frame);
        const Derivatives d = derivatives(scene, poses, HessianKind::exact);
        REQUIRE(d.hessian.allFinite());
        CHECK(d.gradient.norm() <= 1e-14 * d.hessian.norm());
        // Alike in both directions across: what differs is the way that centre lines are found.
        const Matrix3 across = frame.rotation.transpose() * d.hessian.block<3, 3>(0, 0) * frame.rotation;
        CHECK(across(0, 0) > 0);
        CHECK(across(0, 0) == Approx(across(1, 1)).epsilon(1e-9));
        CHECK(std::abs(across(2, 2)) <= 1e-9 * across(0, 0));
        const auto gradient = [&](const VectorX& x) { return derivatives(scene, moved(poses, x), HessianKind::none).gradient; };
        const StepSweep sweep{1e-6, 0.25, 6};
        CHECK(check_jacobian(gradient, VectorX::Zero(12), d.hessian, sweep).relative_error < 1e-2);
    }
}

TEST_CASE("derivatives of round contacts agree with differences", "[round_contacts]") {
    const Scene in_bore(pin(6e-3), bore(), 1e-4), in_wide(pin(3e-3), bore(), 5e-4, 1e-5), longer(pin(6e-3), slotted(), 1.5e-4),
        shorter(pin(3e-3), slotted(), 1.5e-4), on_circle(pin(4e-3), prism(circle_outline(40, 2e-2), -3e-3, 5e-3), 1e-4),
        on_box(pin(4e-3), box_mesh({-1e-2, -8e-3, -3e-3}, {1e-2, 8e-3, 3e-3}), 1e-4, 1e-5),
        flat(box_mesh({-1e-2, -8e-3, -3e-3}, {1e-2, 8e-3, 3e-3}), prism(slot_outline(16, 1e-2, 3e-2), -4e-3, 4e-3), 1e-4);
    const double edge = 5e-3 + 6e-5, flat_top = 1.8e-2 + flat.model.bodies[1].round->sides[0].cover + 6e-5;
    const Vector3 flipped(pi, 0.002, 0.001), corner = Vector3(1e-2, 8e-3, 0) + edge * Vector3(0.6, 0.8, 0);
    struct Case {
        const char* name;
        const Scene& scene;
        Pose pose;
        int count;
    };
    const std::vector<Case> cases{
        {"bore", in_bore, make_pose({0.003, 0.002, 0.1}, {1e-4, 8e-5, 1e-4}), 2},
        {"bore, antiparallel", in_bore, make_pose(flipped, {1e-4, 8e-5, 1e-4}), 2},
        {"bore, far side", in_wide, make_pose({0.003, 0.002, 0.1}, {2e-5, 3e-5, 1e-4}), 2},
        {"bore, parallel", in_wide, make_pose({0, 0, 0.1}, {2e-5, 3e-5, 1e-4}), 2},
        {"slot's wall, longer", longer, make_pose({0.003, 0.002, 0.1}, {1e-3, 1e-4, 0}), 2},
        {"slot's wall, shorter", shorter, make_pose({0.003, 0.002, 0.1}, {1e-3, 1e-4, 0}), 2},
        {"slot's wall, antiparallel", longer, make_pose(flipped, {1e-3, 1e-4, 0}), 2},
        {"slot's end", longer, make_pose({0.003, 0.002, 0.1}, {1.011e-2, 8e-5, 0}), 2},
        {"circle", on_circle, make_pose({0.002, -0.003, 0.1}, {2.5e-2 + 5e-5, 1e-4, 0}), 2},
        {"circle, slanted", on_circle, make_pose({0.05, 0, 0.1}, {2.5e-2 + 5e-5, 1e-4, 0}), 2},
        {"circle, antiparallel", on_circle, make_pose(flipped, {2.5e-2 + 5e-5, 1e-4, 0}), 2},
        {"box's edge", on_box, make_pose({0.002, -0.003, 0.1}, corner), 2},
        {"box's wall", on_box, make_pose({0.002, -0.003, 0.1}, {1e-2 + edge, 1e-3, 0}), 2},
        {"flat on flat", flat, make_pose({0.0005, 0.001, 0.0003}, {1e-3, flat_top, 0}), 4},
    };
    for (const Case& c : cases) {
        const Poses poses = placed(c.pose, some_frame);
        const Derivatives exact = derivatives(c.scene, poses, HessianKind::exact);
        CAPTURE(c.name, contacts_of(c.scene, poses).count);
        CHECK(contacts_of(c.scene, poses).count == c.count);
        REQUIRE(exact.gradient.norm() > 0);
        const auto value = [&](const VectorX& x) { return energy(c.scene, moved(poses, x)); };
        const auto gradient = [&](const VectorX& x) { return derivatives(c.scene, moved(poses, x), HessianKind::none).gradient; };
        // Tangent coordinates at the moved poses: the antisymmetric part of the differences is the rotations'.
        VectorX differences(12);
        MatrixX second(12, 12);
        const double h = 1e-8;
        for (int i = 0; i < 12; ++i) {
            const VectorX e = h * VectorX::Unit(12, i);
            differences[i] = (value(e) - value(-e)) / (2 * h);
            second.col(i) = (gradient(e) - gradient(-e)) / (2 * h);
        }
        CHECK((differences - exact.gradient).norm() <= 1e-5 * exact.gradient.norm());
        CHECK((0.5 * (second + second.transpose()) - exact.hessian).norm() <= 1e-5 * exact.hessian.norm());
        const Matrix12 projected = derivatives(c.scene, poses, HessianKind::projected).hessian;
        CHECK(linear::symmetric_eigenvalues<12>(projected)[0] >= -1e-12 * projected.norm());
    }
}

TEST_CASE("round contacts do not jump from facet to facet", "[round_contacts]") {
    const auto rolled = [](const Vector3& tilt) {
        return [tilt](double a) {
            const double way = 2.5e-2 + 5e-5;
            return placed(
                {kinematics::rotation(tilt) * kinematics::rotation(Vector3(0, 0, 2 * a)), {way * std::cos(a), way * std::sin(a), 1e-3}},
                some_frame);
        };
    };
    // A contact that is missed or double is a jump of 0.5.
    const auto check = [](const Slide& s, double jump, double gradient) {
        CHECK(s.counts.size() == 1);
        CHECK(s.counts.begin()->first == 2);
        CHECK(s.jump < jump);
        CHECK(s.gradient_jump < gradient);
    };
    const Scene on_circle(pin(4e-3), prism(circle_outline(40, 2e-2), -4e-3, 4e-3), 1e-4);
    for (const Vector3& tilt : {Vector3(0, 0, 0), Vector3(0.002, 0.003, 0)})
        check(slide(on_circle, rolled(tilt), 0, 0.5, 1000), 1e-4, 2e-3);

    const Scene on_cam(pin(4e-3), prism(polar_outline(60, ellipse_radius), -3e-3, 5e-3), 1e-4);
    const auto on_ellipse = [](double a) {
        const auto at = [](double b) { return Vector2(ellipse_radius(b) * Vector2(std::cos(b), std::sin(b))); };
        const Vector2 along = (at(a + 1e-5) - at(a - 1e-5)).normalized(), p = at(a) + (5e-3 + 6e-5) * Vector2(along.y(), -along.x());
        return placed(make_pose({0, 0, a}, {p.x(), p.y(), 0}), some_frame);
    };
    check(slide(on_cam, on_ellipse, 0.1, 0.8, 2000), 3e-4, 2e-3);

    const Scene in_bore(pin(6e-3), bore(), 1e-4);
    const auto turned = [](double a) {
        return placed({kinematics::rotation(Vector3(0.003, 0.002, 0)) * kinematics::rotation(Vector3(0, 0, a)),
                       {1.2e-4 * std::cos(3 * a), 1.2e-4 * std::sin(3 * a), 0}},
                      some_frame);
    };
    check(slide(in_bore, turned, 0, 0.5, 1000), 1e-4, 4e-3);

    for (const double half : {3e-3, 6e-3}) {
        const Scene in_slot(pin(half), slotted(), 1.5e-4);
        const auto pushed = [](double x) { return placed(make_pose({0, 0, 0.1}, {x, 1e-4, 0}), some_frame); };
        check(slide(in_slot, pushed, 8e-3, 1.005e-2, 1000), 3e-3, 5e-2);
    }
}

TEST_CASE("where ends are flush, round contacts go on from one body's to the other's", "[round_contacts]") {
    const Scene scene(pin(4e-3), prism(circle_outline(40, 2e-2), -4e-3, 4e-3), 1e-4);
    for (const double gap : {3e-5, 8e-5}) {
        const auto along = [gap](double z) { return placed(make_pose({0, 0, 0.1}, {2.5e-2 + gap, 0, z}), some_frame); };
        const Slide s = slide(scene, along, -3e-4, 3e-4, 300);
        CHECK(s.counts.size() == 1);
        CHECK(s.counts.begin()->first == 2);
        CHECK(s.jump < 1e-9);
    }
    for (const double tilt : {1e-3, 1e-2}) {
        const auto along = [tilt](double z) { return placed(make_pose({0, tilt, 0}, {2.5e-2 + 5e-5 + 4e-3 * tilt, 0, z}), some_frame); };
        CAPTURE(tilt);
        CHECK(slide(scene, along, -3e-4, 3e-4, 600).jump < 1e-3);
    }
}

// Turned against the wall both ways: the wall's border is across neither the roller nor the way from it.
TEST_CASE("where a tilted roller's end passes a wall's, nothing jumps", "[round_contacts]") {
    const Scene scene(pin(4e-3), box_mesh({-1e-2, -8e-3, -4e-3}, {1e-2, 8e-3, 4e-3}), 1e-4);
    for (const Vector3& tilt : {Vector3(0.002, 0.003, 0.1), Vector3(-0.01, 0.008, 0), Vector3(0.006, -0.007, 0.3)}) {
        const double gap = 5e-5 + 4e-3 * std::abs(tilt.y());
        const auto along = [&](double z) { return placed(make_pose(tilt, {1.5e-2 + gap, 3e-3, z}), some_frame); };
        CAPTURE(tilt.transpose());
        CHECK(contacts_of(scene, along(0)).count > 0);
        CHECK(sudden_change(scene, along, -3e-4, 3e-4) < 1e-8);
    }
}

// A step lower than the contact is wide: what is over its foot is over its top too.
TEST_CASE("over the foot of a low step round contacts do not end at once", "[round_contacts]") {
    for (const double height : {1e-7, 5e-6, 3e-5}) {
        const Outline stepped{{1e-2, -8e-3}, {1e-2, 0}, {1e-2 + height, 0}, {1e-2 + height, 8e-3}, {-1e-2, 8e-3}, {-1e-2, -8e-3}};
        const Scene roller(pin(4e-3), prism(stepped, -3e-3, 3e-3), 1e-4),
            corner(prism({{0, 0}, {5e-3, -4e-3}, {5e-3, 4e-3}}, -4e-3, 4e-3), prism(stepped, -3e-3, 3e-3), 1e-4);
        const auto rolled = [&](double y) { return placed(make_pose({0.002, 0.001, 0.1}, {1.5e-2 + 6e-5, y, 0}), some_frame); };
        const auto dragged = [&](double y) { return placed(make_pose({0.002, 0.001, 0.1}, {1e-2 + 6e-5, y, 0}), some_frame); };
        CAPTURE(height);
        CHECK(sudden_change(roller, rolled, -2e-4, 3e-4) < 1e-8);
        CHECK(sudden_change(corner, dragged, -2e-4, 3e-4) < 1e-8);
    }
}

TEST_CASE("a roller on a wall has round contacts, whichever direction the wall is first taken to run along", "[round_contacts]") {
    const Vector3 half(2e-2, 1.9e-2, 1.8e-2);
    const Scene scene(pin(1e-3), box_mesh(-half, half), 1e-4);
    std::mt19937 random(6);
    std::uniform_real_distribution<double> uniform(-1, 1);
    for (int axis = 0; axis < 3; ++axis)
        for (int face = 0; face < 3; ++face)
            for (int t = 0; t < 20 && face != axis; ++t) {
                Vector3 p = Vector3::NullaryExpr([&] { return 1e-2 * uniform(random); });
                p[face] = (t % 2 == 0 ? 1 : -1) * (half[face] + 5e-3 + 5e-5);
                const Matrix3 upright = Eigen::Quaterniond::FromTwoVectors(Vector3::UnitZ(), Vector3::Unit(axis)).toRotationMatrix();
                const ContactSet set =
                    contacts_of(scene, placed({upright * kinematics::rotation(Vector3(0, 0, uniform(random))), p}, some_frame));
                CAPTURE(axis, face, t);
                CHECK(set.count == 2);
                CHECK(round_count(set) == 2);
                CHECK(least_gap(set) == Approx(5e-5).margin(1e-12));
            }
}

TEST_CASE("a flat that lies on a flat is held at both of its ends", "[round_contacts]") {
    Outline rounded;
    for (int k = 0; k < 28; ++k) {
        const int quarter = k / 7;
        const double angle = pi / 2 * quarter + pi / 12 * (k % 7);
        rounded.emplace_back((quarter == 0 || quarter == 3 ? 8e-3 : -8e-3) + 2e-3 * std::cos(angle),
                             (quarter < 2 ? 6e-3 : -6e-3) + 2e-3 * std::sin(angle));
    }
    const Outline sharp{{1e-2, -8e-3}, {1e-2, 8e-3}, {-1e-2, 8e-3}, {-1e-2, -8e-3}};
    const Outline rail = slot_outline(16, 1e-2, 3e-2);
    for (const Outline& outline : {rounded, sharp})
        for (const double x : {1e-3, 2.9e-2}) {  // wholly on it, and partly
            const Scene scene(prism(outline, -3e-3, 3e-3), prism(rail, -4e-3, 4e-3), 1e-4);
            const double top = 1.8e-2 + (outline.size() > 4 ? Section(outline).cover : 0) + Section(rail).cover + 6e-5;
            const auto tilted = [&](double a) { return placed(make_pose({0, 0, a}, {x, top, 0}), some_frame); };
            CAPTURE(outline.size(), x);
            CHECK(contacts_of(scene, tilted(0)).count == 4);
            const Slide s = slide(scene, tilted, -2e-3, 2e-3, 501);
            CHECK(s.jump < 1e-3);
            CHECK(s.gradient_jump < 3e-2);
        }
}

TEST_CASE("round contacts have the same bits however they are found", "[round_contacts]") {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> uniform(-1, 1);
    const Scene on_cam(pin(4e-3), prism(polar_outline(60, ellipse_radius), -3e-3, 5e-3), 1e-4), in_bore(pin(6e-3), bore(), 5e-4);
    int found = 0;
    for (int t = 0; t < 100; ++t) {
        const Scene& scene = t % 2 == 0 ? on_cam : in_bore;
        const double a = pi * uniform(random), way = t % 2 == 0 ? ellipse_radius(a) + 5e-3 + 8e-5 : 1e-4 * std::abs(uniform(random));
        const Vector3 tilt(1e-3 * uniform(random), 1e-3 * uniform(random), 0);
        const Poses poses = placed({kinematics::rotation(tilt), {way * std::cos(a), way * std::sin(a), 1e-4}}, random_frame(random));
        VectorX d = VectorX::NullaryExpr(12, [&] { return 5e-3 * uniform(random); });
        for (int i = 0; i < 2; ++i) d.segment<3>(6 * i) *= 4e-2;
        const ccd::Candidates candidates = ccd::find_candidates(scene.model, moved(poses, d), 2e-3);
        bool holds = !candidates.pairs.empty();
        for (const auto& list : candidates.pairs) holds = holds && ccd::motion_since(scene.model, list, poses) <= list.allowance;
        if (!holds) continue;
        const ContactSet anew = contacts_of(scene, poses), earlier = find_contacts(scene.model, candidates, poses);
        const double value = barrier_potential(anew, scene.parameters());
        CAPTURE(t, anew.count, earlier.count);
        CHECK(barrier_potential(earlier, scene.parameters()) == value);
        const base::ThreadLimit one(1);
        CHECK(energy(scene, poses) == value);
        found += anew.count > 0;
    }
    CHECK(found > 30);
}

}  // namespace fettle::core::contact::round_contacts_test
