// SPDX-License-Identifier: MIT
// Linkages of ordinary hinges along motions on which rows that are independent at the start depend on one another: by dynamics, without,
// and assembled at many places, against trigonometry.
#include "core/model/row_choice.hpp"

#include <catch2/catch.hpp>

#include "core/base/text.hpp"
#include "core/stepper/jointed_motion.hpp"
#include "tests/support/linkages.hpp"

namespace fettle::core::model::row_choice_test {

using namespace fettle::tests::mechanisms;
using core::scene::Integrator;

namespace {

constexpr double degree = M_PI / 180;

const std::vector<Matrix3>& planes() {
    static const std::vector<Matrix3> out{Matrix3::Identity(), kinematics::rotation(Vector3(0.4, -0.7, 0.3)),
                                          kinematics::rotation(Vector3(M_PI / 2, 0, 0)), kinematics::rotation(Vector3(0, M_PI / 4, 0))};
    return out;
}

// How high the last hinge of a lift stands, seen in its plane.
double height(const Model& model, const kinematics::Pose& top, const Matrix3& plane) {
    return (plane.transpose() * kinematics::world_position(top, Vector3(0.2, 0, 0) - model.bodies.back().reference_point)).y();
}

}  // namespace

TEST_CASE("row choice: a scissor lift of hinges rises through right angles of its arms, in any plane", "[rows]") {
    const int stages = GENERATE(1, 2, 3);
    const auto [from, to] = GENERATE(std::pair(30.0, 45.0), std::pair(30.0, 60.0), std::pair(45.0, 60.0), std::pair(60.0, 30.0));
    for (const Matrix3& plane : planes()) {
        scene::Scene scene = turned_as_a_whole(scissor_lift(stages, from * degree, to * degree), plane);
        const double wanted = stages * 0.2 * std::sin(to * degree);
        CAPTURE(stages, from, to, plane);
        for (const Integrator integrator : {Integrator::implicit_euler, Integrator::bdf2, Integrator::quasi_static}) {
            scene.integrator = integrator;
            const Model model = built(scene);
            CHECK(count_of(model.mechanism.dependent) == 3 * stages);
            for (const bool exactly : {false, true}) {
                const stepper::Simulation out = run(model, 10, exactly);
                CHECK(height(model, out.trajectory.poses[10].back(), plane) == Approx(wanted).epsilon(1e-9));
            }
        }
        const Model model = built(scene);
        const auto motion = stepper::follow_joints(model, 10, 1e-6);
        if (!motion) UNSCOPED_INFO(motion.errors()[0].message);
        REQUIRE(motion);
        CHECK(height(model, motion->trajectory.poses.back().back(), plane) == Approx(wanted).epsilon(1e-9));
    }
}

TEST_CASE("row choice: rows chosen anywhere are as many and independent, and the others follow", "[rows]") {
    const Model model = built(scissor_lift(3, 30 * degree, 60 * degree));
    const auto motion = stepper::follow_joints(model, 40, 1e-3);
    REQUIRE(motion);
    CHECK(!rows_to_leave_out(model, motion->trajectory.poses[0]));
    const std::size_t rows = model.mechanism.rows.size(), all = rows + model.mechanism.dependent.size();
    for (const auto& poses : motion->trajectory.poses) {
        const auto left_out = rows_to_leave_out(model, poses);
        const Mechanism mechanism = left_out ? without_rows(model, *left_out).mechanism : model.mechanism;
        CHECK(mechanism.rows.size() == rows);
        const std::vector<constraint::Row> numbered = all_rows(mechanism);
        REQUIRE(numbered.size() == all);
        for (std::size_t i = 0; i < all; ++i) CHECK(numbered[i].number == static_cast<int>(i));
        // Well apart, by a dense factorisation.
        const auto jacobian = row_jacobian(mechanism.set, mechanism.rows, placed(mechanism.set.frames, poses));
        MatrixX dense = MatrixX::Zero(6 * count_of(poses), jacobian.count());
        for (int row = 0; row < jacobian.count(); ++row)
            for (int k = jacobian.first[row]; k < jacobian.first[row + 1]; ++k)
                dense.block<6, 1>(6 * jacobian.entries[k].body, row) = jacobian.entries[k].gradient;
        const VectorX values = Eigen::JacobiSVD<MatrixX>(dense).singularValues();
        CHECK(values[values.size() - 1] > 1e-4 * values[0]);
    }
}

TEST_CASE("row choice: three cranks under a rod go round, through in line too", "[rows]") {
    const double angle = GENERATE(37.0, 91.0, 181.0, 271.0), turn = GENERATE(360.0, -75.0);
    CAPTURE(angle, turn);
    scene::Scene scene = three_cranks(angle * degree, turn * degree);
    const auto is_parallel = [&](const std::vector<kinematics::Pose>& poses) {
        for (int k = 1; k < 3; ++k)
            if (!((poses[k].rotation - poses[0].rotation).norm() < 1e-7)) return false;
        return (poses[3].rotation - Matrix3::Identity()).norm() < 1e-7;
    };
    const Model model = built(scene);
    const auto motion = stepper::follow_joints(model, 100, 1e-4);
    if (!motion) UNSCOPED_INFO(motion.errors()[0].message);
    REQUIRE(motion);
    for (const auto& poses : motion->trajectory.poses) REQUIRE(is_parallel(poses));
    const stepper::Simulation out = run(model, 100);
    for (const auto& poses : out.trajectory.poses) REQUIRE(is_parallel(poses));
}

TEST_CASE("row choice: a four-bar written in line is assembled, and that it may bend the other way is told", "[rows]") {
    using scene::JointKind;
    const Vector3 z_axis = Vector3::UnitZ();
    scene::Scene scene = scene_of({bar("crank", 0.05), bar("coupler", 0.12), bar("rocker", 0.08)}, 0.01);
    scene.mechanism.joints = {
        joint("O", JointKind::revolute, {"", Vector3::Zero(), z_axis}, {"crank", Vector3::Zero(), z_axis}),
        joint("A", JointKind::revolute, {"crank", Vector3(0.05, 0, 0), z_axis}, {"coupler", Vector3::Zero(), z_axis}),
        joint("B", JointKind::revolute, {"coupler", Vector3(0.12, 0, 0), z_axis}, {"rocker", Vector3(0.08, 0, 0), z_axis}),
        joint("C", JointKind::revolute, {"", Vector3(0.1, 0, 0), z_axis}, {"rocker", Vector3::Zero(), z_axis})};
    scene.mechanism.motors = {motor("m", "O", at_rate(6))};
    const Model model = built(scene);
    const std::string told = base::joined(model.warnings);
    CHECK(tests::support::contains(told, "say which with `assemble`"));
    const auto motion = stepper::follow_joints(model, 100, 1e-4);
    REQUIRE(motion);
    // Too short by far: no other beginning helps, and the gap is told.
    scene.mechanism.joints[3].a.point.x() = 0.3;
    const auto open = setup::build_model(scene);
    REQUIRE(!open);
    CHECK(tests::support::contains(open.errors()[0].message, "remain"));
}

}  // namespace fettle::core::model::row_choice_test
