// SPDX-License-Identifier: MIT
// How a fixture's bodies move: scripts of poses, and the state from which a saved simulation goes on.
#include <algorithm>
#include <catch2/catch.hpp>
#include <numbers>
#include <sstream>

#include "core/scene_files/scene_motion.hpp"
#include "tests/core/paper_scenes/fixture_texts.hpp"

namespace fettle::core::paper_scenes::fixture_motion_test {

namespace {

using base::ErrorCode;
using namespace test_support;
constexpr double pi = std::numbers::pi;

Vector3 radians_of(const Vector3& degrees) { return pi / 180 * degrees; }

/// A box a x b x c about the origin, as text.
std::string box_text(double a, double b, double c) {
    std::string text = R"("vertices": [)";
    for (int i = 0; i < 8; ++i) {
        text += std::string(i ? "," : "") + "[" + std::to_string(i & 1 ? a / 2 : -a / 2) + "," + std::to_string(i & 2 ? b / 2 : -b / 2) +
                "," + std::to_string(i & 4 ? c / 2 : -c / 2) + "]";
    }
    return text + R"(], "faces": [[0,2,3],[0,3,1],[4,5,7],[4,7,6],[0,1,5],[0,5,4],[2,6,7],[2,7,3],[0,4,6],[0,6,2],[1,3,7],[1,7,5]])";
}

/// Largest difference of the body's vertices, at a pose, from those of world(x).
template <class World>
double placement_error(const scene::Body& body, const kinematics::Pose& pose, const World& world) {
    double error = 0;
    for (Eigen::Index i = 0; i < body.mesh.vertices.cols(); ++i) {
        error = std::max(error, (kinematics::world_position(pose, body.mesh.vertices.col(i)) - world(body.mesh.vertices.col(i))).norm());
    }
    return error;
}

TEST_CASE("A fixture's script is of the centre of mass and the principal axes", "[scene]") {
    const std::string script = R"(, "type": "kinematic", "position": [1, 2, 3], "kinematic_poses": [
        {"position": [0, 1, 0]}, {"rotation": [0, 0, 0.3]}, {"position": [4, 5, 6], "rotation": [0.1, 0.2, 0.3]}])";
    const auto exp = [](double a, double b, double c) { return kinematics::rotation({a, b, c}); };
    SECTION("a cube has no preferred axes: the world's") {
        const scene::Scene scene = scene_with_body(box_text(1, 1, 1) + script, R"("timestep": 0.5,)");
        const scene::Body& body = scene.bodies[0];
        CHECK(body.script.times == std::vector<double>{0.5, 1, 1.5});
        CHECK(placement_error(body, body.script.poses[0], [](const Vector3& x) { return Vector3(x + Vector3(0, 1, 0)); }) < 1e-15);
        CHECK(placement_error(body, body.script.poses[1], [&](const Vector3& x) { return Vector3(exp(0, 0, 0.3) * x); }) < 1e-15);
        CHECK(placement_error(body, body.script.poses[2],
                              [&](const Vector3& x) { return Vector3(exp(0.1, 0.2, 0.3) * x + Vector3(4, 5, 6)); }) < 1e-14);
    }
    SECTION("axes go from the least moment to the largest") {
        // Inertia of 3 x 2 x 1: least about x, most about z; of 1 x 3 x 2: least about y, then z, then x.
        const scene::Scene same = scene_with_body(box_text(3, 2, 1) + script);
        CHECK(placement_error(same.bodies[0], same.bodies[0].script.poses[1],
                              [&](const Vector3& x) { return Vector3(exp(0, 0, 0.3) * x); }) < 1e-14);
        const scene::Scene other = scene_with_body(box_text(1, 3, 2) + script);
        Matrix3 axes;  // columns y, z, x
        axes << 0, 0, 1, 1, 0, 0, 0, 1, 0;
        CHECK(placement_error(other.bodies[0], other.bodies[0].script.poses[2], [&](const Vector3& x) {
                  return Vector3(exp(0.1, 0.2, 0.3) * axes.transpose() * x + Vector3(4, 5, 6));
              }) < 1e-14);
    }
    SECTION("of the body as it is placed, about its centre of mass") {
        const std::string turned = R"(, "rotation": [20, 30, 40], "is_dof_fixed": [false, false, false, true, true, false])";
        const scene::Scene scene = scene_with_body(tet + script + turned);  // two rotations fixed: the axes are the world's
        const scene::Body& body = scene.bodies[0];
        const Vector3 centre(0.25, 0.25, 0.25);
        CHECK(placement_error(body, body.script.poses[2], [&](const Vector3& x) {
                  return Vector3(exp(0.1, 0.2, 0.3) * body.pose.rotation * (x - centre) + Vector3(4, 5, 6));
              }) < 1e-14);
    }
    SECTION("a general body: its inertia is diagonal in the axes, and the script's frame is right-handed") {
        const scene::Scene scene = scene_with_body(box_text(3, 2, 1) + R"(, "rotation": [20, 30, 40])" + script);
        const scene::Body& body = scene.bodies[0];
        const Matrix3 principal = body.pose.rotation * body.script.poses[0].rotation.transpose();  // R0, for the first rotation is none
        CHECK(principal.determinant() == Approx(1));
        const Matrix3 local = principal.transpose() * body.pose.rotation;  // the box's axes x, y, z have ascending moments
        CHECK((local.cwiseAbs() - Matrix3::Identity()).norm() < 1e-12);
    }
    SECTION("it ends in the constant velocity, and stops with everything else") {
        const std::string moving = R"(, "linear_velocity": [7, 0, 0], "kinematic_max_time": )";
        const scene::Body late = scene_with_body(box_text(1, 1, 1) + script + moving + "5", R"("timestep": 0.5,)").bodies[0];
        CHECK(late.script.times.size() == 3);
        CHECK(scene::motion_value(*late.prescribed[0], 2) - scene::motion_value(*late.prescribed[0], 1.5) == Approx(3.5));
        const scene::Body early = scene_with_body(box_text(1, 1, 1) + script + moving + "0.75", R"("timestep": 0.5,)").bodies[0];
        CHECK(early.script.times == std::vector<double>{0.5, 0.75});
        CHECK(early.script.poses[1].position.isApprox(Vector3(0, 0.5, 0)));
        CHECK(early.script.poses[1].rotation.isApprox(exp(0, 0, 0.15)));
        CHECK(scene::motion_value(*early.prescribed[0], 9) == scene::motion_value(*early.prescribed[0], 0.75));
        CHECK(scene_with_body(box_text(1, 1, 1) + script + moving + "0").bodies[0].script.empty());
    }
    const auto wrong = scene_files::parse_scene(
        R"({"rigid_body_problem": {"rigid_bodies": [{)" + tet + R"(, "type": "kinematic", "kinematic_poses": [3]}]}})", "a");
    REQUIRE(wrong.errors().size() == 1);
    CHECK(contains(wrong.errors()[0].where, "/kinematic_poses/0"));
}

TEST_CASE("A script's poses between its times", "[scene]") {
    scene::PoseScript script;
    const kinematics::Pose start{kinematics::rotation({0, 0, 0.2}), {1, 0, 0}};
    CHECK(scene::scripted_pose(script, start, 3).position == start.position);
    script.times = {1, 3};
    script.poses = {{kinematics::rotation({0, 0, 1.2}), {1, 2, 0}},
                    {kinematics::rotation({0.5, 0, 0}) * kinematics::rotation({0, 0, 1.2}), {5, 2, 0}}};
    CHECK(scene::scripted_pose(script, start, -1).position == start.position);
    CHECK(scene::scripted_pose(script, start, 0).rotation == start.rotation);
    CHECK(scene::scripted_pose(script, start, 0.5).position.isApprox(Vector3(1, 1, 0)));
    CHECK(scene::scripted_pose(script, start, 0.5).rotation.isApprox(kinematics::rotation({0, 0, 0.7})));
    CHECK(scene::scripted_pose(script, start, 1).rotation == script.poses[0].rotation);
    CHECK(scene::scripted_pose(script, start, 2).position.isApprox(Vector3(3, 2, 0)));
    CHECK(scene::scripted_pose(script, start, 2).rotation.isApprox(kinematics::rotation({0.25, 0, 0}) * script.poses[0].rotation));
    CHECK(scene::scripted_pose(script, start, 3).position == script.poses[1].position);
    CHECK(scene::scripted_pose(script, start, 9).position == script.poses[1].position);
}

std::string vector_text(const Vector3& x) {
    std::ostringstream text;
    text.precision(17);
    text << "[" << x.x() << "," << x.y() << "," << x.z() << "]";
    return text.str();
}

TEST_CASE("A saved simulation goes on from its last state", "[scene]") {
    // A body in that program's coordinates: world = exp(theta) R0^T (x_placed - c) + p, with R0 = exp(theta_start).
    const Vector3 p0(1, 2, 3), theta0(0.4, -0.3, 0.2), p1(4, 5, 6), theta1(-0.1, 0.7, 2.5), omega(0.3, 0.2, -0.5), v(7, 8, 9);
    const Matrix3 turn = kinematics::rotation(theta1) * kinematics::rotation(theta0).transpose();
    const auto state = [&](const Vector3& p, const Vector3& theta, const std::string& more) {
        return R"({"rigid_bodies": [{"position": )" + vector_text(p) + R"(, "rotation": )" + vector_text(theta) + more + "}]}";
    };
    const auto saved = [&](const std::string& body, const std::string& more) {
        return scene_files::parse_scene(R"({"args": {"timestep": 0.5, "max_time": 10, "rigid_body_problem": {"rigid_bodies": [{)" + tet +
                                            body + R"(}]}}, "animation": {"state_sequence": [)" + state(p0, theta0, "") + "," +
                                            state(p1, theta0, "") + "," + state(p1, theta1, more) + "]}, \"stats\": {}}",
                                        "a.json");
    };
    const Matrix3 placed = kinematics::rotation(radians_of({10, 0, 0}));
    const auto expected = [&](const Vector3& x) { return Vector3(turn * (placed * x + Vector3(0.1, 0.2, 0.3) - p0) + p1); };
    const std::string placement = R"(, "rotation": [10, 0, 0], "position": [0.1, 0.2, 0.3])";
    SECTION("a dynamic body, with its velocity") {
        const Matrix3 rate = cross_matrix(omega) * kinematics::rotation(theta1);
        const std::string qdot =
            R"(, "Qdot": [)" + vector_text(rate.row(0)) + "," + vector_text(rate.row(1)) + "," + vector_text(rate.row(2)) + "]";
        const std::string local = R"(, "angular_velocity": )" + vector_text(kinematics::rotation(theta1).transpose() * omega);
        for (const std::string& spin : {qdot, local}) {
            const auto scene = saved(placement, R"(, "linear_velocity": )" + vector_text(v) + spin);
            REQUIRE(scene);
            const scene::Body& body = scene->bodies[0];
            CHECK(placement_error(body, body.pose, expected) < 1e-14);
            CHECK((body.angular_velocity - omega).norm() < 1e-15);
            // v is of p1, which here is not our centre of mass
            const Vector3 centre = kinematics::world_position(body.pose, Vector3(0.25, 0.25, 0.25));
            CHECK((body.linear_velocity - (v + omega.cross(centre - p1))).norm() < 1e-14);
            CHECK(scene->end_time == Approx(9));
            CHECK(scene->warnings.empty());
        }
    }
    SECTION("a kinematic body: what is left of its script") {
        const auto scene = saved(placement + R"(, "type": "kinematic", "linear_velocity": [1, 0, 0], "kinematic_max_time": 3,
            "kinematic_poses": [{}, {}, {"position": [1, 1, 1]}, {"position": [2, 2, 2]}])",
                                 "");
        REQUIRE(scene);
        const scene::Body& body = scene->bodies[0];
        CHECK(placement_error(body, body.pose, expected) < 1e-14);
        REQUIRE(body.script.times == std::vector<double>{0.5, 1});
        CHECK((kinematics::world_position(body.script.poses[0], Vector3(0.25, 0.25, 0.25)) - Vector3(1, 1, 1)).norm() < 1e-14);
        CHECK(body.prescribed[0]->stop_time == Approx(2));
    }
    SECTION("faults") {
        const auto strange =
            scene_files::parse_scene(R"({"args": {"rigid_body_problem": {"rigid_bodies": [{)" + tet +
                                         R"(}]}}, "animation": {"state_sequence": [{"rigid_bodies": []}, {"rigid_bodies": []}]}})",
                                     "a.json");
        REQUIRE(strange.errors().size() == 1);
        CHECK(strange.errors()[0].code == ErrorCode::inconsistent);
        CHECK(contains(strange.errors()[0].where, "/animation/state_sequence"));
    }
    const auto unsaved = scene_files::parse_scene(R"({"args": {"timestep": 0.5, "rigid_body_problem": {"rigid_bodies": [{)" + tet +
                                                      R"(}]}}, "animation": {"state_sequence": []}, "stats": {}})",
                                                  "a.json");
    REQUIRE(unsaved);
    CHECK(unsaved->timestep == 0.5);
    const auto finished =
        scene_files::parse_scene(R"({"args": {"timestep": 0.5, "max_time": 1, "rigid_body_problem": {"rigid_bodies": [{)" + tet +
                                     R"(}]}}, "animation": {"state_sequence": [)" + state(p0, theta0, "") + "," + state(p0, theta0, "") +
                                     "," + state(p0, theta0, "") + "]}}",
                                 "a.json");
    REQUIRE(finished);
    CHECK(finished->end_time == 0.0);
    CHECK(finished->warnings.size() == 1);
    CHECK(finished->bodies[0].pose.position == Vector3::Zero());
}

}  // namespace

}  // namespace fettle::core::paper_scenes::fixture_motion_test
