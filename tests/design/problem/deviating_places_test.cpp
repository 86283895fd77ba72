// SPDX-License-Identifier: MIT
// Every place of the table, moved by a deviation, in every question about clearances within tolerances: refused by name, or the bound of
// the box holds for the scene that is made anew at both ends of the deviation; what is told to have no influence has none.
#include "design/problem/deviating_places.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <set>

#include "core/certificate/toleranced.hpp"
#include "core/clearance/clearance.hpp"
#include "core/clearance/driven_ranges.hpp"
#include "core/clearance/range_clearance.hpp"
#include "core/clearance/toleranced_clearance.hpp"
#include "core/stepper/jointed_motion.hpp"
#include "core/stepper/scripted_motion.hpp"
#include "design/problem/design_problem.hpp"
#include "design/problem/toleranced_bodies.hpp"
#include "design/shapes/file_part.hpp"
#include "tests/support/mechanisms.hpp"

namespace fettle::design::problem::deviating_places_test {

using namespace fettle::tests::mechanisms;
using core::clearance::ClearanceOptions;
using core::clearance::LoopedRanges;
using core::clearance::PairClearance;
using core::clearance::PairRequest;
using core::model::Model;
using core::scene::Attachment;
using core::scene::CurveKind;
using core::scene::JointKind;
using core::scene::Place;
using core::scene::PlaceKind;
using description::Design;
using description::Tolerance;

namespace {

const Vector3 along_x = Vector3::UnitX(), along_z = Vector3::UnitZ();
constexpr double step = 0.05;
constexpr int steps = 8;
constexpr double slack = 1e-9;

core::scene::Curve table(std::vector<double> times, std::vector<double> values, CurveKind kind = CurveKind::linear) {
    core::scene::Curve out;
    out.kind = kind;
    out.times = std::move(times);
    out.values = std::move(values);
    return out;
}
core::scene::Curve even(double rate) {
    core::scene::Curve out;
    out.rate = rate;
    return out;
}

core::scene::Joint limited(core::scene::Joint joint, double low, double high) {
    joint.forces.limits = std::array{low, high};
    return joint;
}

struct Case {
    std::string name;
    Design design;
    std::vector<PairRequest> pairs;
    double accuracy = 2e-3;  // [m] of bounds; less where a proof takes long
};

// A box that is drawn, static.
void add_post(Design& design, const Vector3& position) {
    core::scene::Body post;
    post.name = "post";
    post.type = core::scene::BodyType::static_body;
    post.pose.position = position;
    post.group = 0;
    const auto shape = shapes::FilePart::create("box", {{"size_x", 0.06}, {"size_y", 0.05}, {"size_z", 0.04}});
    REQUIRE(shape);
    REQUIRE(description::add_part(design, post, *shape));
}

core::scene::Body standing(core::scene::Body body) {
    settle_rotation(body);
    return body;
}

// A hinge that carries a slide and a nut on a thread; a wheel geared to it, and a rack on that. @param motors  whether all of them are
// driven
Case machine(bool motors) {
    core::scene::Scene scene = scene_of(
        {standing(bar("arm", 0.3)), standing(bar("slide", 0.1, Vector3(0.3, 0, 0.03))), standing(bar("nut", 0.1, Vector3(0.1, 0, 0.1))),
         standing(bar("wheel", 0.08, Vector3(0.1, -0.3, 0))), standing(bar("rack", 0.1, Vector3(0.2, -0.4, 0)))},
        step);
    scene.bodies[2].material = "steel";
    scene.bodies[1].mu = 0.3;
    scene.bodies[3].material = "wood";
    scene.friction.materials = {{"steel", 0.5}};
    scene.friction.pairs = {{"wood", "steel", 0.7}};
    scene.friction.mu = 0.2;
    core::scene::Joint hinge = joint("hinge", JointKind::revolute, {"", Vector3::Zero(), along_z}, {"arm", Vector3::Zero(), along_z});
    hinge.forces = {3, 0.2, 0, 0.05, 0.03, std::array{-0.3, 0.8}};
    core::scene::Joint thread =
        limited(joint("thread", JointKind::screw, {"arm", Vector3(0.1, 0, 0.1), along_z}, {"nut", Vector3::Zero(), along_z}), -0.5, 0.5);
    thread.pitch = 0.05;
    scene.mechanism.joints = {
        hinge,
        limited(joint("guide", JointKind::prismatic, {"arm", Vector3(0.3, 0, 0.03), along_x}, {"slide", Vector3::Zero(), along_x}), -0.04,
                0.05),
        thread, joint("axle", JointKind::revolute, {"", Vector3(0.1, -0.3, 0), along_z}, {"wheel", Vector3::Zero(), along_z}),
        joint("way", JointKind::prismatic, {"", Vector3(0.2, -0.4, 0), along_x}, {"rack", Vector3::Zero(), along_x})};
    scene.mechanism.joints[1].forces.stiffness = 40;
    scene.mechanism.joints[1].forces.preload = 0.5;
    for (const auto& [name, kind, first, second, ratio] :
         {std::tuple("gear", JointKind::gear, "hinge", "axle", -0.5), std::tuple("pinion", JointKind::rack, "axle", "way", 0.1)}) {
        core::scene::Joint coupling = joint(name, kind, {}, {});
        coupling.of = {first, second};
        coupling.ratio = ratio;
        scene.mechanism.joints.push_back(coupling);
    }
    core::scene::Spring stay = spring_between("stay", {"arm", Vector3(0.1, 0, 0), along_z}, {"", Vector3(0.1, 0.2, 0), along_z}, {}), about;
    stay.forces = {7, 0.3, 0, 0.1, 0.2, std::array{0.1, 2.0}};
    about = spring_of("about", "hinge", {});
    about.forces.stiffness = 2;
    about.forces.preload = 0.3;
    about.forces.limits = std::array{-0.25, 0.75};
    core::scene::Spring dash = spring_of("dash", "guide", {});
    dash.forces.damping = 0.3;
    scene.mechanism.springs = {stay, about, dash};
    scene.mechanism.loads = {{"load", "", "arm", Vector3(0.25, 0, 0), Vector3(1, -2, 0.5)}};
    core::scene::Motor push = motor("push", "guide", table({0, 0.2}, {0.3, 0.1}));
    push.kind = core::scene::MotorKind::effort;
    push.curve.rate = 0.1;
    scene.mechanism.motors = {push};
    if (motors) {
        core::scene::Curve swing = table({0, 0.2, 0.4}, {0, 0.6, 0.2});
        swing.rate = 0.1;
        scene.mechanism.motors.push_back(motor("swing", "hinge", swing));
        scene.mechanism.motors.push_back(motor("hold slide", "guide", even(0)));
        scene.mechanism.motors.push_back(motor("hold nut", "thread", even(0)));
    }
    Case out{motors ? "machine that motors drive" : "machine", {}, {{1, 5}, {2, 5}, {4, 5}, {1, 2}}};
    out.design.scene = std::move(scene);
    add_post(out.design, Vector3(0.4, 0.35, 0.05));
    return out;
}

// Two motors at even speed, the second one's joint on the first one's, and a body that stands by itself.
Case even_speeds() {
    core::scene::Body turned = bar("turned", 0.1, Vector3(0.5, -0.2, 0));
    turned.orientation = {core::scene::Orientation::Kind::vector, Vector3(0.1, 0.4, -0.2)};
    core::scene::Scene scene =
        scene_of({standing(bar("arm", 0.3)), standing(bar("slide", 0.1, Vector3(0.3, 0, 0))), standing(turned)}, step);
    scene.mechanism.joints = {
        joint("hinge", JointKind::revolute, {"", Vector3::Zero(), along_z}, {"arm", Vector3::Zero(), along_z}),
        joint("guide", JointKind::prismatic, {"arm", Vector3(0.3, 0, 0), along_x}, {"slide", Vector3(0.01, 0, 0), along_x})};
    scene.mechanism.motors = {motor("swing", "hinge", even(1.5)), motor("push", "guide", even(0.2))};
    Case out{"even speeds", {}, {{1, 3}, {1, 2}}};
    out.design.scene = std::move(scene);
    add_post(out.design, Vector3(0.35, 0.35, 0));
    return out;
}

// A ball in its socket.
Case ball() {
    core::scene::Scene scene = scene_of({standing(bar("head", 0.1, Vector3::Zero()))}, step);
    scene.mechanism.joints = {joint("socket", JointKind::ball, {"", Vector3::Zero(), along_z}, {"head", Vector3::Zero(), along_z})};
    scene.mechanism.joints[0].swing = 0.3;
    Case out{"ball", {}, {{0, 1}}};
    out.design.scene = std::move(scene);
    add_post(out.design, Vector3(0.35, 0.35, 0));
    return out;
}

// One body goes along one of its coordinates.
Case script(int dof, double rate) {
    core::scene::Body cam = bar("cam", 0.2, Vector3(0, 0, 0));
    cam.type = core::scene::BodyType::kinematic_body;
    for (auto& each : cam.prescribed) each = core::scene::MotionCurve{};
    cam.prescribed[static_cast<std::size_t>(dof)]->rate = rate;
    cam.orientation.numbers = Vector3(0.1, -0.2, 0.3);
    Case out{"script of coordinate " + std::to_string(dof), {}, {{0, 1}}};
    out.design.scene = scene_of({standing(cam)}, step);
    add_post(out.design, Vector3(0.3, 0.3, 0.1));
    return out;
}

// A four-bar linkage that a motor drives; its positions are where its joints are met.
Case linkage(CurveKind kind) {
    const double a = 0.9, b = 1.8;  // of coupler and rocker
    const Vector3 pin(0.1, 0, 0), joint_b = pin + 0.3 * Vector3(std::cos(a), std::sin(a), 0),
                                  pivot = joint_b - 0.2 * Vector3(std::cos(b), std::sin(b), 0);
    const auto turned = [](core::scene::Body body, double angle) {
        body.orientation.numbers = Vector3(0, 0, angle);
        return standing(body);
    };
    core::scene::Scene scene = scene_of({standing(bar("crank", 0.1)), turned(bar("coupler", 0.3, pin + Vector3(0, 0, 0.03)), a),
                                         turned(bar("rocker", 0.2, pivot + Vector3(0, 0, 0.06)), b)},
                                        step);
    scene.mechanism.joints = {
        joint("O", JointKind::revolute, {"", Vector3::Zero(), along_z}, {"crank", Vector3::Zero(), along_z}),
        joint("A", JointKind::revolute, {"crank", Vector3(0.1, 0, 0.03), along_z}, {"coupler", Vector3::Zero(), along_z}),
        joint("C", JointKind::revolute, {"", pivot, along_z}, {"rocker", Vector3(0, 0, -0.06), along_z}),
        joint("B", JointKind::revolute, {"coupler", Vector3(0.3, 0, 0), along_z}, {"rocker", Vector3(0.2, 0, -0.03), along_z})};
    scene.mechanism.motors = {motor("drive", "O", table({0, 0.2, 0.4}, {0.1, 0.5, 0.3}, kind))};
    Case out{"linkage", {}, {{1, 3}, {2, 3}}, 2e-2};
    out.design.scene = std::move(scene);
    add_post(out.design, Vector3(0.25, 0.45, 0.06));
    return out;
}

std::vector<Case> cases() {
    std::vector<Case> out{machine(false), machine(true), even_speeds(), linkage(CurveKind::linear), linkage(CurveKind::trapezoid), ball()};
    for (int dof = 0; dof < 6; ++dof) out.push_back(script(dof, dof < 3 ? 0.3 : 1.2));
    return out;
}

enum class Question { assembled, ranges, motion };

// --- the box

struct Asked {
    Errors refused;  // or the bounds, of the pairs that the deviation has influence on
    std::vector<std::optional<PairClearance>> pairs;
};

Result<std::optional<LoopedRanges>> ranges_of(Question question, const Model& model) {
    using Ranges = std::optional<LoopedRanges>;
    if (question == Question::assembled && !core::clearance::closes_loops(model)) return Ranges{};
    Result<LoopedRanges> found = question == Question::motion ? core::clearance::driven_ranges(model, steps * step)
                                                              : core::clearance::looped_ranges(model, question == Question::assembled);
    if (!found) return found.errors();
    return Ranges{*std::move(found)};
}

ClearanceOptions options(double accuracy) {
    ClearanceOptions out;
    out.tolerance = accuracy;
    out.measure_overlap = out.sample_nodes = false;
    return out;
}

Asked within(const Design& design, const std::vector<Tolerance>& tolerances, const Case& of, Question question) {
    const Result<DesignProblem> problem = DesignProblem::create(design);
    for (const Error& error : problem.errors()) UNSCOPED_INFO(error.where << ": " << error.message);
    REQUIRE(problem);
    const Result<Model> model = problem->model_at(description::with_deviations(design, tolerances, base_of(tolerances)));
    REQUIRE(model);
    const auto ranges = ranges_of(question, *model);
    if (!ranges) return {ranges.errors(), {}};
    const auto toleranced = toleranced_bodies(problem->design(), tolerances, *model, *ranges);
    if (!toleranced) return {toleranced.errors(), {}};
    Asked out;
    for (const PairRequest& pair : of.pairs) {
        const bool matters = !core::certificate::toleranced_pair(*toleranced, pair.a, pair.b).deviations.empty();
        out.pairs.push_back(matters ? std::optional(core::clearance::certify(*model, *toleranced, {pair}, options(of.accuracy)).front())
                                    : std::nullopt);
    }
    return out;
}

// --- the scene made anew

// Nothing: it cannot be made.
std::optional<Model> made_anew(const Design& design, const Place& place, double deviation) {
    core::scene::Scene scene = description::described_scene(design);
    core::scene::at(scene, place) += deviation;
    const PlaceKind kind = core::scene::kind_of(place);
    if (kind == PlaceKind::rotation) settle_rotation(scene.bodies[static_cast<std::size_t>(place.item)]);
    if (kind == PlaceKind::shape_dimension) {
        core::scene::Body& body = scene.bodies[static_cast<std::size_t>(place.item)];
        std::vector<double> values;
        for (const auto& dimension : description::shape_of(design, place.item)->dimensions())
            values.push_back(body.shape->dimensions.at(dimension.name));
        body.mesh = description::shape_of(design, place.item)->mesh(values).value();
    }
    core::setup::BuildOptions build;
    build.check_start = false;
    auto model = core::setup::build_model(scene, build);
    if (!model) return std::nullopt;
    return std::move(model).value();
}

// Where the bodies of a model can be, as the question has it.
struct Positions {
    Model model;
    std::vector<std::vector<core::kinematics::Pose>> poses;  // some of them; of a motion at its nodes, of ranges at their corners
    std::optional<core::clearance::JointRanges> ranges;
};

std::vector<std::vector<core::kinematics::Pose>> corners_of(const Model& model, const core::clearance::JointRanges& ranges) {
    const auto& coordinates = ranges.linkage.coordinates;
    std::vector<std::vector<core::kinematics::Pose>> out;
    for (unsigned corner = 0; corner < 1U << coordinates.size(); ++corner) {
        PairClearance at;
        at.a = at.b = -1;  // every coordinate moves all bodies of its own
        for (int k = 0; k < count_of(coordinates); ++k) {
            at.coordinates.push_back(k);
            at.at.push_back((corner >> k & 1U) != 0 ? coordinates[static_cast<std::size_t>(k)].high
                                                    : coordinates[static_cast<std::size_t>(k)].low);
        }
        auto& poses = out.emplace_back();
        for (int i = 0; i < count_of(model.bodies); ++i) poses.push_back(core::clearance::pose_at_witness(model, ranges, at, i));
    }
    return out;
}

// Nothing: the scene has no such question.
std::optional<Positions> positions_of(Model model, Question question) {
    Positions out{std::move(model), {}, {}};
    std::vector<core::kinematics::Pose> start;
    for (const auto& body : out.model.bodies) start.push_back(body.pose_start);
    if (question == Question::assembled) {
        out.poses = {start};
    } else if (question == Question::ranges) {
        auto ranges = core::clearance::joint_ranges(out.model);
        if (!ranges) return std::nullopt;
        out.ranges = *std::move(ranges);
        out.poses = corners_of(out.model, *out.ranges);
    } else if (out.model.mechanism.rows.empty()) {
        out.poses = core::stepper::follow_scripts(out.model, steps).poses;
    } else {
        auto motion = core::stepper::follow_joints(out.model, steps, 1);
        if (!motion) return std::nullopt;
        out.poses = std::move(motion->trajectory.poses);
    }
    return out;
}

bool is_same(const Positions& a, const Positions& b) {
    for (std::size_t i = 0; i < a.model.bodies.size(); ++i)
        if (a.model.bodies[i].mesh.vertices != b.model.bodies[i].mesh.vertices) return false;
    const auto same_pose = [](const core::kinematics::Pose& x, const core::kinematics::Pose& y) {
        return x.rotation == y.rotation && x.position == y.position;
    };
    if (a.ranges && !(a.ranges->linkage == b.ranges->linkage)) return false;
    return std::equal(a.poses.begin(), a.poses.end(), b.poses.begin(), b.poses.end(),
                      [&](const auto& x, const auto& y) { return std::equal(x.begin(), x.end(), y.begin(), y.end(), same_pose); });
}

double distance_in(const Positions& positions, const PairRequest& pair) {
    Model model = positions.model;
    const ClearanceOptions fine = options(1e-9);
    double least = HUGE_VAL;
    for (const auto& poses : positions.poses) {
        for (std::size_t i = 0; i < poses.size(); ++i) model.bodies[i].pose_start = poses[i];
        least = std::min(least, core::clearance::certify(model, core::clearance::as_assembled(model), {pair}, fine).front().upper);
    }
    return least;
}

double deviation_of(const core::scene::Scene& scene, const Place& place) {
    const Dimension dimension = core::scene::dimension_at(scene, place);
    if (dimension == Dimension::length) return 8e-3;
    if (dimension == Dimension::angle) return 0.05;
    return 0.2 * std::max(0.1, std::abs(core::scene::value_at(scene, place)));
}

// Which places are looked at where not all are: what decides where bodies are, one component of each body and joint.
bool is_looked_at(const Place& place) {
    switch (core::scene::kind_of(place)) {
        case PlaceKind::motor_values:
        case PlaceKind::motor_rate:
        case PlaceKind::prescribed_rate:
            return true;
        case PlaceKind::position:
        case PlaceKind::joint_point:
        case PlaceKind::rotation:
            return place.entry == (place.item + place.row) % 3;
        default:
            return false;
    }
}

struct Deviating {
    Design design;
    std::vector<Tolerance> tolerances;
};
Deviating deviating(const Design& design, const std::string& pointer, double deviation, Dimension dimension) {
    Deviating out{design, {}};
    const auto parameter = description::add_deviation(out.design, pointer, core::base::Unit{core::base::si_unit(dimension), dimension});
    for (const Error& error : parameter.errors()) UNSCOPED_INFO(error.where << ": " << error.message);
    REQUIRE(parameter);
    Tolerance& tolerance = out.tolerances.emplace_back();
    tolerance.of = pointer;
    tolerance.parameter = *parameter;
    tolerance.deviation.lower = -deviation;
    tolerance.deviation.upper = deviation;
    return out;
}

struct Counts {
    int refused = 0, held = 0, without = 0;
};

void look_at(const Case& of, const Place& place, Question question, const Positions& designed, Counts& counts) {
    const core::scene::Scene scene = description::described_scene(of.design);
    const std::string pointer = core::scene::pointer_to(scene, place);
    const double deviation = deviation_of(scene, place);
    INFO(of.name << ", question " << static_cast<int>(question) << ": " << pointer << " +- " << deviation);
    const Deviating asked = deviating(of.design, pointer, deviation, core::scene::dimension_at(scene, place));
    const Asked box = within(asked.design, asked.tolerances, of, question);
    if (!box.refused.empty()) {
        INFO(box.refused.front().message);
        const bool is_whole_question = box.refused.front().where == "joint `socket`";  // a ball over ranges
        CHECK((is_whole_question || box.refused.front().message.find("`" + pointer + "`") != std::string::npos));
        ++counts.refused;
        return;
    }
    for (const double end : {-deviation, deviation}) {
        std::optional<Model> model = made_anew(of.design, place, end);
        const std::optional<Positions> anew = model ? positions_of(*std::move(model), question) : std::nullopt;
        if (!anew) continue;
        const bool is_as_designed = is_same(*anew, designed);
        for (std::size_t k = 0; k < of.pairs.size(); ++k) {
            const std::optional<PairClearance>& pair = box.pairs[k];
            INFO("pair " << k << " at " << end);
            ++(pair ? counts.held : counts.without);
            if (!pair && is_as_designed) continue;
            const double distance = distance_in(*anew, of.pairs[k]);
            if (!pair) {
                CHECK(std::abs(distance - distance_in(designed, of.pairs[k])) <= slack);
                continue;
            }
            INFO(distance << " in [" << pair->lower << ", " << pair->upper << "] " << pair->reason);
            CHECK(pair->lower <= distance + slack);
            CHECK(pair->upper - pair->lower <= 2 * of.accuracy);
        }
    }
}

}  // namespace

namespace {

// @param accuracy  of bounds, [m]; nothing: each case its own, and all places
void look_at_places(const std::optional<double>& accuracy) {
    std::set<int> known;
    std::map<Question, Counts> counts;
    for (Case of : cases()) {
        of.accuracy = accuracy.value_or(of.accuracy);
        const core::scene::Scene scene = description::described_scene(of.design);
        const Place none = core::scene::find_place(scene, "/gravity/0").value();
        for (const Question question : {Question::assembled, Question::motion, Question::ranges}) {
            std::optional<Model> model = made_anew(of.design, none, 0);
            REQUIRE(model);
            if (!ranges_of(question, *model)) continue;  // the case has no such question
            const std::optional<Positions> designed = positions_of(*std::move(model), question);
            if (!designed) continue;  // a loop over ranges has no oracle here
            for (const Place& place : core::scene::places_of(scene)) {
                known.insert(place.row);
                if (std::isnan(core::scene::value_at(scene, place)) || !core::scene::faults_at(scene, place).empty()) continue;
                if (!accuracy || is_looked_at(place)) look_at(of, place, question, *designed, counts[question]);
            }
        }
    }
    // All rows are among them: a new one wants a case here.
    CHECK(static_cast<int>(known.size()) == core::scene::row_count());
    for (const auto& [question, count] : counts) {
        INFO(static_cast<int>(question) << ": " << count.refused << " " << count.held << " " << count.without);
        CHECK(count.held > 20);
        if (accuracy) continue;
        CHECK(count.refused > 10);
        CHECK(count.without > 20);
    }
}

}  // namespace

TEST_CASE("Every place that a deviation moves, in every question, against the scene made anew", "[toleranced][places]") {
    look_at_places({});
}
TEST_CASE("What moves bodies, in every question, against the scene made anew, by bounds that are near", "[toleranced][places][slow]") {
    look_at_places(2e-3);
}

}  // namespace fettle::design::problem::deviating_places_test
