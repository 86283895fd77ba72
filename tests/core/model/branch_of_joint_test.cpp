// SPDX-License-Identifier: MIT
// Closed linkages are assembled on the branch that a joint says: against closed forms, from poses that lead to another or to none.
#include "core/model/branch_of_joint.hpp"

#include "core/stepper/branch_warnings.hpp"
#include "tests/support/mechanisms.hpp"

namespace fettle::core::model::branch_of_joint_test {

using core::setup::build_model;
using namespace fettle::tests::mechanisms;
using core::scene::AssembleSide;
using core::scene::JointKind;
using fettle::tests::support::contains;

namespace {

const Vector3 x_axis = Vector3::UnitX(), z_axis = Vector3::UnitZ();
const AssembleSide left = AssembleSide::left, right = AssembleSide::right, ahead = AssembleSide::ahead, behind = AssembleSide::behind;
constexpr double crank = 0.1, coupler = 0.33, rocker = 0.25;
const Vector3 pivot(0.35, -0.05, 0);

// A motor at O that begins at an angle.
void drive(scene::Scene& scene, double angle) {
    scene::Curve curve;
    curve.rate = 1;
    curve.times = {0};
    curve.values = {angle};
    scene.mechanism.motors = {motor("drive", "O", curve)};
}

scene::Joint hinge(const std::string& name, const std::string& a, const Vector3& at_a, const std::string& b, const Vector3& at_b) {
    return joint(name, JointKind::revolute, {a, at_a, z_axis}, {b, at_b, z_axis});
}

// All bars lie on one another along x, from the origin: poses that say nothing about the branch.
scene::Scene four_bar(double angle) {
    scene::Scene scene = scene_of({bar("crank", crank), bar("coupler", coupler), bar("rocker", rocker)}, 0.01);
    scene.mechanism.joints = {
        hinge("O", "", Vector3::Zero(), "crank", Vector3::Zero()), hinge("A", "crank", Vector3(crank, 0, 0), "coupler", Vector3::Zero()),
        hinge("B", "coupler", Vector3(coupler, 0, 0), "rocker", Vector3(rocker, 0, 0)), hinge("D", "", pivot, "rocker", Vector3::Zero())};
    drive(scene, angle);
    return scene;
}

// From A over B to D, turning to one side.
Vector3 closed_form(double angle, AssembleSide side) {
    const Vector3 a(crank * std::cos(angle), crank * std::sin(angle), 0), way = pivot - a;
    const double d = way.norm(), along = (coupler * coupler - rocker * rocker + d * d) / (2 * d);
    const double height = std::sqrt(coupler * coupler - along * along);
    return a + along * way / d + (side == right ? 1 : -1) * height * z_axis.cross(way / d);
}

Vector3 place(const Model& model, int body, const Vector3& file_point) {
    return world_position(model.bodies[body].pose_start, file_point - model.bodies[body].reference_point);
}

std::string errors_of(const scene::Scene& scene) {
    const auto model = build_model(scene);
    REQUIRE(!model);
    std::string out;
    for (const auto& error : model.errors()) out += error.where + ": " + error.message + "\n";
    return out;
}

}  // namespace

TEST_CASE("a four-bar is assembled on the side that is asked for", "[mechanism][branch]") {
    for (const AssembleSide side : {left, right})
        for (double angle = -3; angle < 3.2; angle += 0.25) {
            scene::Scene scene = four_bar(angle);
            scene.mechanism.joints[2].assemble = scene::Assemble{side, "", ""};
            for (int written = 0; written < 4; ++written) {
                if (written == 1) scene.bodies[1].pose.rotation = kinematics::rotation(Vector3(0, 0, 1.2));
                if (written == 2) scene.bodies[2].pose = {kinematics::rotation(Vector3(0, 0, -2)), pivot};
                if (written == 3) scene.bodies[2].pose.rotation = kinematics::rotation(Vector3(0, 0, 2));
                const Model model = built(scene);
                CAPTURE(angle, written, side == left);
                const Vector3 expected = closed_form(angle, side);
                CHECK((place(model, 1, Vector3(coupler, 0, 0)) - expected).norm() < 1e-9);
                CHECK((place(model, 2, Vector3(rocker, 0, 0)) - expected).norm() < 1e-9);
                CHECK((place(model, 1, Vector3::Zero()) - place(model, 0, Vector3(crank, 0, 0))).norm() < 1e-9);
                const constraint::Branch& branch = model.mechanism.branches.at(0);
                CHECK(side_of(branch, placed(model.mechanism.set.frames,
                                             {model.bodies[0].pose_start, model.bodies[1].pose_start, model.bodies[2].pose_start})) *
                          branch.sign >
                      0);
            }
        }
}

TEST_CASE("a linkage that is on its side as written stays as it is, bit for bit", "[mechanism][branch]") {
    scene::Scene scene = four_bar(0);
    const double angle = 0.7;
    const Vector3 a(crank * std::cos(angle), crank * std::sin(angle), 0), b = closed_form(angle, left);
    const auto turned = [](const Vector3& v) { return kinematics::rotation(Vector3(0, 0, std::atan2(v.y(), v.x()))); };
    scene.bodies[0].pose.rotation = turned(a);
    scene.bodies[1].pose = {turned(b - a), a};
    scene.bodies[2].pose = {turned(b - pivot), pivot};
    const Model plain = built(scene);
    scene.mechanism.joints[2].assemble = scene::Assemble{left, "A", "D"};
    const Model same = built(scene);
    scene.mechanism.joints[2].assemble = scene::Assemble{right, "D", "A"};  // the same way, walked back
    const Model back = built(scene);
    for (int i = 0; i < 3; ++i)
        for (const Model* model : {&same, &back}) {
            CHECK(model->bodies[i].pose_start.position == plain.bodies[i].pose_start.position);
            CHECK(model->bodies[i].pose_start.rotation == plain.bodies[i].pose_start.rotation);
        }
}

TEST_CASE("what hangs on a linkage goes over with it", "[mechanism][branch]") {
    // A pointer fixed to the coupler, and a second pair of bars on the coupler's end with a side of its own.
    for (const AssembleSide side : {left, right})
        for (const AssembleSide second : {left, right}) {
            scene::Scene scene = four_bar(0.7);
            scene.bodies.push_back(bar("pointer", 0.1, Vector3(0.1, 0, 0)));
            scene.bodies.push_back(bar("link", 0.3));
            scene.bodies.push_back(bar("arm", 0.3));
            for (scene::Body& body : scene.bodies) body.group = 0;
            const Vector3 far(0.1, 0.45, 0);
            scene.mechanism.joints.push_back(
                joint("weld", JointKind::fixed, {"coupler", Vector3(0.1, 0, 0), z_axis}, {"pointer", Vector3::Zero(), z_axis}));
            scene.mechanism.joints.push_back(hinge("E", "rocker", Vector3(rocker, 0, 0), "link", Vector3::Zero()));
            scene.mechanism.joints.push_back(hinge("F", "link", Vector3(0.3, 0, 0), "arm", Vector3(0.3, 0, 0)));
            scene.mechanism.joints.push_back(hinge("G", "", far, "arm", Vector3::Zero()));
            scene.mechanism.joints[2].assemble = scene::Assemble{side, "A", "D"};
            scene.mechanism.joints[6].assemble = scene::Assemble{second, "E", "G"};
            if (side == left) scene.mechanism.joints.back().a.point = Vector3(0.3, -0.5, 0);
            const Model model = built(scene);
            CHECK((place(model, 1, Vector3(coupler, 0, 0)) - closed_form(0.7, side)).norm() < 1e-9);
            CHECK((place(model, 3, Vector3::Zero()) - place(model, 1, Vector3(0.1, 0, 0))).norm() < 1e-9);
            const Vector3 e = place(model, 4, Vector3::Zero()), f = place(model, 4, Vector3(0.3, 0, 0)),
                          g = place(model, 5, Vector3::Zero());
            CHECK((z_axis.dot((f - e).cross(g - f)) > 0) == (second == left));
        }
}

TEST_CASE("a slider-crank has its slider ahead or behind", "[mechanism][branch]") {
    const double offset = 0.03, rod = 0.3;
    for (const AssembleSide side : {ahead, behind})
        for (double angle = -3; angle < 3.2; angle += 0.5)
            for (const bool is_back : {false, true}) {
                scene::Scene scene = scene_of({bar("crank", crank), bar("rod", rod), bar("slider", 0.05, Vector3(0, offset, 0))}, 0.01);
                scene::Joint wrist = hinge("wrist", "rod", Vector3(rod, 0, 0), "slider", Vector3::Zero());
                if (is_back) std::swap(wrist.a, wrist.b);
                const bool is_opposite = is_back;  // from the slide to the pin: the pin lies on the other side of the wrist
                const AssembleSide said = is_opposite == (side == ahead) ? behind : ahead;
                wrist.assemble = scene::Assemble{said, "", ""};
                scene.mechanism.joints = {
                    hinge("O", "", Vector3::Zero(), "crank", Vector3::Zero()),
                    hinge("pin", "crank", Vector3(crank, 0, 0), "rod", Vector3::Zero()), wrist,
                    joint("guide", JointKind::prismatic, {"", Vector3(0, offset, 0), x_axis}, {"slider", Vector3::Zero(), x_axis})};
                drive(scene, angle);
                const Model model = built(scene);
                const double reach = std::sqrt(rod * rod - std::pow(crank * std::sin(angle) - offset, 2));
                CAPTURE(angle, is_back, side == ahead);
                const Vector3 expected(crank * std::cos(angle) + (side == ahead ? reach : -reach), offset, 0);
                CHECK((place(model, 2, Vector3::Zero()) - expected).norm() < 1e-9);
            }
}

TEST_CASE("an oscillating slide has its block ahead of its pivot or behind", "[mechanism][branch]") {
    // The block slides along a link that turns about `pivot`, 0.02 beside it, and is hinged to the crank's end.
    const double beside = 0.02;
    for (const AssembleSide side : {ahead, behind})
        for (double angle = -3; angle < 3.2; angle += 0.5) {
            scene::Scene scene =
                scene_of({bar("crank", crank), bar("link", 0.5, pivot), bar("block", 0.05, pivot + Vector3(0.1, beside, 0))}, 0.01);
            scene::Joint slide =
                joint("slide", JointKind::prismatic, {"link", Vector3(0, beside, 0), x_axis}, {"block", Vector3::Zero(), x_axis});
            slide.assemble = scene::Assemble{side, "D", "pin"};
            scene.mechanism.joints = {hinge("O", "", Vector3::Zero(), "crank", Vector3::Zero()),
                                      hinge("D", "", pivot, "link", Vector3::Zero()), slide,
                                      hinge("pin", "crank", Vector3(crank, 0, 0), "block", Vector3::Zero())};
            drive(scene, angle);
            const Model model = built(scene);
            const Vector3 b(crank * std::cos(angle), crank * std::sin(angle), 0), way = b - pivot;
            const double along = (side == ahead ? 1 : -1) * std::sqrt(way.squaredNorm() - beside * beside);
            const Vector3 direction = (along * way + beside * way.cross(z_axis)) / way.squaredNorm();
            CAPTURE(angle, side == ahead);
            CHECK((place(model, 2, Vector3::Zero()) - b).norm() < 1e-9);
            CHECK((place(model, 1, Vector3(0.5, 0, 0)) - pivot - 0.5 * direction).norm() < 1e-9);
        }
}

TEST_CASE("a side that lengths do not allow is an error with the reason", "[mechanism][branch]") {
    // The rocker is above the line of the pivots in both assemblies.
    scene::Scene scene = four_bar(0.5 * std::numbers::pi);
    scene.mechanism.joints[1].a.point = Vector3(0.3, 0, 0);
    scene.mechanism.joints[2].a.point = Vector3(0.35, 0, 0);
    scene.mechanism.joints[2].b.point = Vector3(0.1, 0, 0);
    scene.mechanism.joints[3].a.point = Vector3(0.3, 0, 0);
    scene::Scene above = scene;
    above.mechanism.joints[3].assemble = scene::Assemble{left, "", ""};
    built(above);
    above.mechanism.joints[3].assemble->side = right;
    const std::string below = errors_of(above);
    CAPTURE(below);
    CHECK(contains(below,
                   "a.scene.json#/joints/D/assemble: the bodies cannot be assembled so that the way from `O` over `D` to `B` turns "
                   "right: their joints are met only where the way from `O` over `D` to `B` turns left"));
    // Too short for either side.
    scene.mechanism.joints[2].assemble = scene::Assemble{right, "", ""};
    built(scene);
    scene.mechanism.joints[2].b.point = Vector3(0.05, 0, 0);
    CHECK(contains(errors_of(scene), "the joints cannot be met"));
}

TEST_CASE("a linkage that no motor drives is assembled on the side that is asked for, where its poses are between both",
          "[mechanism][branch]") {
    for (const AssembleSide side : {left, right}) {
        scene::Scene scene = four_bar(0);
        scene.mechanism.motors.clear();
        scene.bodies[0].pose.rotation = kinematics::rotation(Vector3(0, 0, 0.7));
        scene.mechanism.joints[2].assemble = scene::Assemble{side, "", ""};
        const Model model = built(scene);
        const Vector3 a = place(model, 1, Vector3::Zero()), b = place(model, 1, Vector3(coupler, 0, 0));
        CHECK((place(model, 2, Vector3(rocker, 0, 0)) - b).norm() < 1e-9);
        CHECK((z_axis.dot((b - a).cross(pivot - b)) > 0) == (side == left));
    }
}

TEST_CASE("a side that cannot be said so is an error", "[mechanism][branch]") {
    scene::Scene scene = four_bar(0.7);
    const auto with = [&](int joint, const scene::Assemble& assemble) {
        scene::Scene out = scene;
        out.mechanism.joints[joint].assemble = assemble;
        return errors_of(out);
    };
    CHECK(contains(with(2, {ahead, "", ""}), "a.scene.json#/joints/B/assemble: `assemble` of joint `B`: `left` or `right` is expected"));
    CHECK(contains(with(2, {left, "O", ""}), "`O` does not join"));
    CHECK(contains(with(2, {left, "C", ""}), "no other joint is called `C`"));
    CHECK(contains(with(2, {left, "A", "A"}), "`A` does not join"));
    scene.bodies.push_back(bar("pendulum", 0.1));
    scene.mechanism.joints.push_back(hinge("hung", "rocker", Vector3(0.1, 0, 0), "pendulum", Vector3::Zero()));
    CHECK(contains(with(2, {left, "", ""}), "`to` is expected, one of the joints of `rocker`: `D`, `hung`"));
    CHECK(contains(with(4, {left, "", ""}), "`from` is expected, one of the joints of `rocker`: `B`, `D`"));
    CHECK(contains(with(4, {left, "D", ""}), "`to` is expected, but no other joint is at `pendulum`"));
}

TEST_CASE("a motion that goes over to the other side is told with its time", "[mechanism][branch]") {
    scene::Scene scene = four_bar(0.7);
    stepper::Trajectory trajectory;
    trajectory.timestep = 0.01;
    for (const AssembleSide side : {left, left, right, left}) {
        scene.mechanism.joints[2].assemble = scene::Assemble{side, "", ""};
        std::vector<kinematics::Pose> poses;
        for (const Body& body : built(scene).bodies) poses.push_back(body.pose_start);
        trajectory.poses.push_back(poses);
    }
    const Model model = built(scene);
    const std::vector<std::string> warnings = stepper::branch_warnings(model, trajectory);
    REQUIRE(warnings.size() == 1);
    CHECK(contains(warnings[0], "t = 0.02 s"));
    CHECK(contains(warnings[0], "the way from `A` over `B` to `D` turns right there"));
    trajectory.poses.resize(2);
    CHECK(stepper::branch_warnings(model, trajectory).empty());
}

TEST_CASE("a linkage whose side no joint says is told to pass a dead centre", "[mechanism][branch]") {
    scene::Scene scene = four_bar(0.7);
    std::vector<std::vector<kinematics::Pose>> sides;
    for (const AssembleSide side : {left, right}) {
        scene.mechanism.joints[2].assemble = scene::Assemble{side, "", ""};
        sides.emplace_back();
        for (const Body& body : built(scene).bodies) sides.back().push_back(body.pose_start);
    }
    scene.mechanism.joints[2].assemble.reset();
    const Model model = built(scene);
    const std::vector<constraint::Branch> open = branches_left_open(model);
    REQUIRE(open.size() == sides_left_open(model).size());
    stepper::Trajectory trajectory;
    trajectory.timestep = 0.01;
    trajectory.poses = {start_poses(model), start_poses(model)};
    CHECK(stepper::branch_warnings(model, trajectory).empty());
    for (const auto& side : sides) trajectory.poses.push_back(side);
    REQUIRE(open.size() == 1);
    const std::vector<std::string> warnings = stepper::branch_warnings(model, trajectory);
    REQUIRE(warnings.size() == 1);
    CHECK(contains(warnings[0], "passes a dead centre by t = 0.0"));
}

}  // namespace fettle::core::model::branch_of_joint_test
