// SPDX-License-Identifier: MIT
// Values by hand, and every derivative against central differences.
#include "core/measure/measure.hpp"

#include <catch2/catch.hpp>
#include <numbers>

#include "tests/support/derivative_check.hpp"
#include "tests/support/test_models.hpp"

namespace fettle::core::measure::measure_test {

using namespace fettle::tests::support;
using kinematics::Pose;

namespace {

Matrix3 axes_of(const Vector3& rotation_vector) { return kinematics::rotation(rotation_vector); }

// Bodies 0 and 1, with a frame each, and a frame of the world.
MeasureSet samples() {
    MeasureSet set;
    set.frames = {{0, Vector3(0.3, -0.2, 0.5), axes_of({0.3, 0.9, -0.4})},
                  {1, Vector3(-0.1, 0.4, 0.2), axes_of({-1.1, 0.2, 0.5})},
                  {world, Vector3(0.2, 0.1, -0.3), axes_of({0.1, -0.7, 1.3})}};
    for (const int b : {1, 2}) {
        for (const OffsetAxis whose : {OffsetAxis::of_a, OffsetAxis::of_b, OffsetAxis::of_world})
            set.measures.push_back({MeasureKind::offset, 0, b, 1, 0, whose});
        set.measures.push_back({MeasureKind::product, 0, b, 2, 1, {}});
        set.measures.push_back({MeasureKind::distance, 0, b, 0, 0, {}});
        set.measures.push_back({MeasureKind::angle, 0, b, 0, 0, {}});
        set.measures.push_back({MeasureKind::angle, b, 0, 0, 0, {}});
    }
    return set;
}

std::vector<Pose> sample_poses() {
    return {make_pose(Vector3(0.4, -0.3, 0.8), Vector3(0.5, 0.7, -0.2)), make_pose(Vector3(-0.2, 1.1, 0.3), Vector3(-0.4, 0.3, 0.9))};
}

std::vector<Pose> moved(const std::vector<Pose>& poses, const VectorX& d) {
    std::vector<Pose> out = poses;
    for (int i = 0; i < 2; ++i) {
        out[i].position += d.segment<3>(6 * i);
        out[i].rotation = kinematics::rotation(d.segment<3>(6 * i + 3)) * out[i].rotation;
    }
    return out;
}

// (q, phi) of bodies 0 and 1.
VectorX gradient_at(const MeasureSet& set, const Measure& m, const std::vector<Pose>& poses) {
    const auto frames = placed(set.frames, poses);
    const PoseGradients g = pose_gradients(m, vector_function(m, frames), frames);
    VectorX out = VectorX::Zero(12);
    for (const auto& [side, gradient] : {std::pair(m.a, g.a), std::pair(m.b, g.b)}) {
        const int body = set.frames[side].body;
        if (body != world) out.segment<6>(6 * body) += tangent_gradient(gradient);
    }
    return out;
}

// Hessian of m(exp(d) pose) at d = 0: what measure.hpp gives, and the rotations' curvature from the arms.
MatrixX hessian_at(const MeasureSet& set, const Measure& m, const std::vector<Pose>& poses) {
    const auto frames = placed(set.frames, poses);
    const VectorFunction f = vector_function(m, frames);
    const PoseGradients g = pose_gradients(m, f, frames);
    Matrix12 h = gauss_newton_hessian(m, f, frames);
    h.block<3, 3>(3, 3) += kinematics::tangent_curvature(g.a.arm);
    h.block<3, 3>(9, 9) += kinematics::tangent_curvature(g.b.arm);
    MatrixX out = MatrixX::Zero(12, 12);
    const std::array<int, 2> body{set.frames[m.a].body, set.frames[m.b].body};
    for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 2; ++j)
            if (body[i] != world && body[j] != world) out.block<6, 6>(6 * body[i], 6 * body[j]) += h.block<6, 6>(6 * i, 6 * j);
    return out;
}

MeasureSet with_placement(MeasureSet set, int frame, const VectorX& placement) {
    set.frames[frame].point = placement.head<3>();
    set.frames[frame].axes = placement.tail<9>().reshaped(3, 3);
    return set;
}

VectorX placement_of(const Frame& frame) {
    VectorX out(12);
    out << frame.point, frame.axes.reshaped();
    return out;
}

VectorX flat(const FrameGradient& g) {
    VectorX out(12);
    out << g.point, g.axes.reshaped();
    return out;
}

std::vector<Matrix3> rotations_of(const MeasureSet& set, const std::vector<Pose>& poses) {
    std::vector<Matrix3> out;
    for (const Frame& f : set.frames) out.push_back(f.body == world ? Matrix3(Matrix3::Identity()) : poses[f.body].rotation);
    return out;
}

}  // namespace

TEST_CASE("measures of a hinge's frames are what they are called", "[measure]") {
    MeasureSet set;
    set.frames = {{world, Vector3(1, 0, 0), Matrix3::Identity()}, {0, Vector3(0, 2, 0), Matrix3::Identity()}};
    const std::vector<Pose> poses{make_pose(Vector3(0, 0, 0.7), Vector3(1, 0, 3))};
    const auto frames = placed(set.frames, poses);
    CHECK(value_of({MeasureKind::angle, 0, 1, 0, 0, {}}, frames) == Approx(0.7).margin(1e-15));
    CHECK(value_of({MeasureKind::angle, 1, 0, 0, 0, {}}, frames) == Approx(-0.7).margin(1e-15));
    CHECK(value_of({MeasureKind::offset, 0, 1, 2, 0, OffsetAxis::of_a}, frames) == Approx(3));
    CHECK(value_of({MeasureKind::offset, 0, 1, 1, 0, OffsetAxis::of_b}, frames) == Approx(2));
    CHECK(value_of({MeasureKind::offset, 0, 1, 0, 0, OffsetAxis::of_world}, frames) == Approx(-2 * std::sin(0.7)));
    CHECK(value_of({MeasureKind::product, 0, 1, 0, 1, {}}, frames) == Approx(-std::sin(0.7)));
    CHECK(value_of({MeasureKind::distance, 0, 1, 0, 0, {}}, frames) == Approx(std::sqrt(4.0 + 9.0)));
}

TEST_CASE("a measure without a derivative has none that passes for a number", "[measure]") {
    MeasureSet set;
    set.frames = {{world, Vector3(1, 0, 3), Matrix3::Identity()}, {0, Vector3::Zero(), Matrix3::Identity()}};
    const auto frames = placed(set.frames, {make_pose(Vector3::Zero(), Vector3(1, 0, 3))});
    const VectorFunction f = vector_function({MeasureKind::distance, 0, 1, 0, 0, {}}, frames);
    CHECK(f.value == 0);
    CHECK(!f.gradient[0].allFinite());
}

TEST_CASE("turns are counted by the reference", "[measure]") {
    const double turn = 2 * std::numbers::pi;
    CHECK(nearest_turn(3.0, 3.2) == 3.0);
    CHECK(nearest_turn(-3.0, 3.2) == Approx(turn - 3.0));
    CHECK(nearest_turn(0.1, 5 * turn - 0.2) == Approx(5 * turn + 0.1));
    CHECK(nearest_turn(0.1, -7 * turn) == Approx(0.1 - 7 * turn));
}

TEST_CASE("derivatives of measures in the poses agree with differences", "[measure]") {
    const MeasureSet set = samples();
    const std::vector<Pose> poses = sample_poses();
    for (std::size_t k = 0; k < set.measures.size(); ++k) {
        const Measure& m = set.measures[k];
        CAPTURE(k, static_cast<int>(m.kind));
        const auto value = [&](const VectorX& d) { return value_of(m, placed(set.frames, moved(poses, d))); };
        CHECK(vector_function(m, placed(set.frames, poses)).value == value(VectorX::Zero(12)));
        CHECK(check_gradient(value, VectorX::Zero(12), gradient_at(set, m, poses)).relative_error < 1e-9);
        // The gradient at a moved pose is in that pose's tangent: its derivative along psi is H psi + psi x g / 2 (exp(phi)
        // exp(psi) is exp(phi + psi + phi x psi / 2 + ...)).
        const auto gradient = [&](const VectorX& d) { return gradient_at(set, m, moved(poses, d)); };
        const MatrixX h = hessian_at(set, m, poses);
        MatrixX bracket = MatrixX::Zero(12, 12);
        const VectorX g = gradient_at(set, m, poses);
        for (int i = 0; i < 2; ++i) bracket.block<3, 3>(6 * i + 3, 6 * i + 3) = -0.5 * cross_matrix(g.segment<3>(6 * i + 3));
        CHECK(check_jacobian(gradient, VectorX::Zero(12), h + bracket).relative_error < 1e-9);
    }
}

TEST_CASE("derivatives of measures in the frames' placement agree with differences", "[measure]") {
    const MeasureSet set = samples();
    const std::vector<Pose> poses = sample_poses();
    const std::vector<Matrix3> rotations = rotations_of(set, poses);
    Vector12 motion;
    motion << 0.3, -0.2, 0.7, 0.5, -0.9, 0.4, -0.6, 0.1, 0.2, -0.3, 0.8, 0.6;
    for (std::size_t k = 0; k < set.measures.size(); ++k) {
        const Measure& m = set.measures[k];
        CAPTURE(k, static_cast<int>(m.kind));
        const auto frames = placed(set.frames, poses);
        const VectorFunction f = vector_function(m, frames);
        std::vector<FrameGradient> of_value(set.frames.size()), of_change(set.frames.size());
        add_placement_gradient(f, 1.7, rotations, of_value);
        Vector12 sides = Vector12::Zero();  // of a's body, then of b's
        for (const auto& [side, at] : {std::pair(m.a, 0), std::pair(m.b, 6)})
            if (set.frames[side].body != world) sides.segment<6>(at) = motion.segment<6>(6 * set.frames[side].body);
        add_placement_gradient_of_change(m, f, 1.7, {frames, rotations}, sides, of_change);
        for (const int side : {m.a, m.b}) {
            const auto value = [&](const VectorX& x) { return 1.7 * value_of(m, placed(with_placement(set, side, x).frames, poses)); };
            const auto change = [&](const VectorX& x) { return 1.7 * gradient_at(with_placement(set, side, x), m, poses).dot(motion); };
            const VectorX x = placement_of(set.frames[side]);
            CHECK(check_gradient(value, x, flat(of_value[side])).relative_error < 1e-9);
            CHECK(check_gradient(change, x, flat(of_change[side])).relative_error < 1e-9);
        }
    }
}

}  // namespace fettle::core::measure::measure_test
