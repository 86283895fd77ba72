// SPDX-License-Identifier: MIT
#include "core/records/poses_file.hpp"

#include <catch2/catch.hpp>

#include "core/files/atomic_file.hpp"
#include "core/records/trajectory_io.hpp"
#include "core/setup/build_model.hpp"
#include "tests/core/geometry/sample_meshes.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fettle::core::records::poses_file_test {

namespace {

using namespace stepper;
using base::ErrorCode;

using Folder = tests::support::TemporaryFolder;

// Two boxes whose reference points lie off their file's origin, and a third that no file names.
model::Model boxes() {
    scene::Scene scene;
    scene.length_unit = 0.001;
    for (const char* name : {"crank", "rod, \"big\"", "frame"}) {
        scene::Body body;
        body.name = name;
        body.mesh = tests::box_mesh({0.1, 0.2, 0.3}, {0.2, 0.5, 0.4});
        body.pose.position.x() = static_cast<double>(scene.bodies.size());
        scene.bodies.push_back(body);
    }
    scene.bodies[2].type = scene::BodyType::static_body;
    return setup::build_model(scene).value();
}

std::string csv(const std::string& rows) { return "time,body,px[mm],py[mm],pz[mm],qw,qx,qy,qz\n" + rows; }

// The messages, one a line, with file and line of each.
std::string faults(const base::Result<PosesFile>& result) {
    std::string text;
    for (const auto& error : result.errors()) text += error.where + ": " + error.message + "\n";
    return text;
}

bool mentions(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("poses: CSV in each form of rotation says the same", "[stepper][poses]") {
    const Folder folder;
    const model::Model model = boxes();
    const auto quaternion = folder.write("q.csv",
                                         "# from elsewhere\n\ntime,body,px[mm],py[mm],pz[mm],qw,qx,qy,qz\n0,crank,1,2,3,1,0,0,0\n"
                                         "0.5,crank,1000,0,0,0.7071067811865476,0,0,0.7071067811865476\n");
    const auto vector = folder.write("v.csv",
                                     "\xEF\xBB\xBFpz[m], py[m], px[m], rz[deg], ry[deg], rx[deg], body, time[s]\r\n"
                                     "0.003,0.002,0.001,0,0,0,crank,0\r\n0,0,1,90,0,0,crank,0.5\r\n");
    const auto matrix = folder.write("m.csv",
                                     "time,body,px,py,pz,r11,r12,r13,r21,r22,r23,r31,r32,r33\n"
                                     "0,crank,1,2,3,1,0,0,0,1,0,0,0,1\n0.5,crank,1000,0,0,0,-1,0,1,0,0,0,0,1\n");
    for (const auto& read : {read_poses(quaternion, model), read_poses(vector, model), read_poses(matrix, model, 1e-3)}) {
        CAPTURE(faults(read));
        REQUIRE(read);
        const Trajectory& t = read->trajectory;
        REQUIRE(t.poses.size() == 2);
        CHECK(t.timestep == 0.5);
        CHECK(t.times.empty());
        CHECK(read->still == std::vector<std::string>{"rod, \"big\"", "frame"});
        CHECK(*read->largest_turn == Approx(M_PI / 2));
        CHECK(read->largest_rotation_error < 1e-15);
        const Vector3 corner = model.bodies[0].mesh.vertices.col(0) + model.bodies[0].reference_point;  // in the file's frame
        const auto world = [&](std::size_t at) { return kinematics::world_position(t.poses[at][0], model.bodies[0].mesh.vertices.col(0)); };
        CHECK((world(0) - corner - Vector3(0.001, 0.002, 0.003)).norm() < 1e-15);
        CHECK((world(1) - Vector3(1 - corner.y(), corner.x(), corner.z())).norm() < 1e-15);
        CHECK((t.poses[1][2].position - model.bodies[2].pose_start.position).norm() == 0);
        // Half way: at constant rate about the axis; the reference point goes straight.
        const auto middle = kinematics::pose_at(path_segment(t, 0, 0, 0), 0.5);
        CHECK((middle.rotation - kinematics::rotation({0, 0, M_PI / 4})).norm() < 1e-15);
        CHECK((middle.position - 0.5 * (t.poses[0][0].position + t.poses[1][0].position)).norm() < 1e-15);
    }
}

TEST_CASE("poses: how far the path cuts the corner of a turn about an axis elsewhere", "[stepper][poses]") {
    const Folder folder;
    const model::Model model = boxes();
    // The crank's file origin is the axis; the reference point goes round it.
    const auto file =
        folder.write("turn.csv", "time,body,px[mm],py[mm],pz[mm],rx[deg],ry[deg],rz[deg]\n0,crank,0,0,0,0,0,0\n1,crank,0,0,0,0,0,60\n");
    const auto read = read_poses(file, model);
    REQUIRE(read);
    const Vector3 half_way = kinematics::pose_at(path_segment(read->trajectory, 0, 0, 0), 0.5).position;
    const Vector3 round = kinematics::rotation({0, 0, M_PI / 6}) * model.bodies[0].reference_point;
    CHECK(read->largest_cut == Approx((round - half_way).norm()).epsilon(1e-12));
    CHECK(read->largest_cut > 0.01);
}

TEST_CASE("poses: JSON, uneven times, rotations printed with few digits", "[stepper][poses]") {
    const Folder folder;
    const model::Model model = boxes();
    const auto file = folder.write("a.json", R"({"fettle_poses": 1, "units": "cm", "rotation": "quaternion", "times": [1, 1.1, 1.5],
        "bodies": {"crank": [[0,0,0, 1,0,0,0], [1,0,0, 0.96593,0.25882,0,0], [2,0,0, 0.866025,0.5,0,0]]}})");
    CHECK(is_poses_file(file));
    const auto read = read_poses(file, model);
    CAPTURE(faults(read));
    REQUIRE(read);
    const Trajectory& t = read->trajectory;
    CHECK(t.times == std::vector<double>{1, 1.1, 1.5});
    CHECK(time_at(t, 1) == 1.1);
    CHECK(time_at(t, 1, 0, 0.25) == Approx(1.2));
    CHECK(time_at(t, -1, 0, 0) == 1);
    CHECK(read->largest_rotation_error > 1e-7);
    CHECK(read->largest_rotation_error < 1e-5);
    for (const auto& poses : t.poses)
        CHECK((poses[0].rotation.transpose() * poses[0].rotation - Matrix3::Identity()).cwiseAbs().maxCoeff() < 2e-15);
    const Vector3 origin = kinematics::world_position(t.poses[2][0], -model.bodies[0].reference_point);
    CHECK((origin - Vector3(0.02, 0, 0)).norm() < 1e-15);
}

TEST_CASE("poses: what is written reads back, and as a trajectory file too", "[stepper][poses]") {
    const Folder folder;
    const model::Model model = boxes();
    Trajectory path;
    path.timestep = 0.1;
    path.times = {0, 0.1, 0.25, 1.0 / 3};
    std::vector<kinematics::Pose> poses;
    for (const auto& body : model.bodies) poses.push_back(body.pose_start);
    for (int t = 0; t < 4; ++t) {
        for (std::size_t b = 0; b < 2; ++b) {
            poses[b].position += Vector3(0.1, 1.0 / 3, -0.7 * static_cast<double>(b));
            poses[b].rotation = kinematics::orthonormalised(kinematics::rotation({0.3, 1, 0.2 * t}) * poses[b].rotation);
        }
        path.poses.push_back(poses);
    }
    for (const char* name : {"out.csv", "out.json"}) {
        CAPTURE(name);
        const auto file = folder.path / name;
        REQUIRE(write_poses(file, path, model, "in").empty());
        const auto read = read_poses(file, model);
        CAPTURE(faults(read));
        REQUIRE(read);
        CHECK(read->still.empty());
        CHECK(read->trajectory.times == path.times);
        for (std::size_t t = 0; t < 4; ++t) {
            for (std::size_t b = 0; b < 3; ++b) {
                CHECK((read->trajectory.poses[t][b].rotation == path.poses[t][b].rotation));
                CHECK((read->trajectory.poses[t][b].position - path.poses[t][b].position).norm() < 1e-15);
            }
        }
        // A trajectory file holds the uneven times, and its reader's checks of the path pass.
        const auto stored = folder.path / "t.trajectory.json";
        REQUIRE(write_trajectory(stored, read->trajectory, model).empty());
        const auto again = read_trajectory(stored);
        REQUIRE(again);
        CHECK(again->trajectory.times == path.times);
        CHECK(again->model.end_time == path.times.back());
        std::string text = files::read_file(stored).value();
        text.replace(text.find("\"time\": 0.25,"), 12, "\"time\": 0.05");
        const auto bad = read_trajectory(folder.write("bad.trajectory.json", text));
        REQUIRE(!bad);
        CHECK(mentions(bad.errors()[0].where, "#/time"));
    }
}

TEST_CASE("poses: numbers beyond any mechanism are refused, in CSV and in JSON", "[stepper][poses]") {
    const Folder folder;
    const model::Model model = boxes();
    const std::string rows = "0,crank,0,0,0,1,0,0,0\n1,crank,1e158,0,0,1,0,0,0\n";
    const std::string position = faults(read_poses(folder.write("p.csv", csv(rows)), model));
    CHECK(mentions(position, "p.csv:3: column px: 1e158 is out of range: at most 1e30"));
    const auto turned = folder.write("r.csv", "time,body,px[m],py[m],pz[m],rx,ry,rz\n0,crank,0,0,0,0,0,0\n1,crank,0,0,0,1e160,0,0\n");
    CHECK(mentions(faults(read_poses(turned, model)), "r.csv:3: column rx: 1e160 is out of range: at most 1e30"));
    const auto json = folder.write("p.json", R"({"fettle_poses": 1, "units": "mm", "rotation": "rotation_vector", "times": [0, 1],
        "bodies": {"crank": [[0,0,0,0,0,0], [0,0,1e158,0,0,1e160]]}})");
    CHECK(mentions(faults(read_poses(json, model)), "p.json#/bodies/crank/1/2: 1e+158 is out of range: at most 1e30"));
}

TEST_CASE("poses: every fault in a CSV has its line", "[stepper][poses]") {
    const Folder folder;
    const model::Model model = boxes();
    const auto of = [&](const std::string& text) { return faults(read_poses(folder.write("bad.csv", text), model)); };
    const std::string rows =
        of(csv("0,crank,0,0,0,1,0,0,0\n0.1,krank,0,0,0,1,0,0,0\n0.2,crank,0,x,0,1,0,0,0\n0.3,crank,0,0,0,1,1,0,0\n"
               "0.4,crank,0,0\n0.5,crank,nan,0,0,1,0,0,0\n0.4,crank,0,0,0,1,0,0,0\n"));
    CAPTURE(rows);
    CHECK(mentions(rows, "bad.csv:3: the scene has no body \"krank\"; did you mean \"crank\"?"));
    CHECK(mentions(rows, "bad.csv:4: column py: \"x\" is not a number"));
    CHECK(mentions(rows, "bad.csv:5: the quaternion qw qx qy qz has length 1.41"));
    CHECK(mentions(rows, "bad.csv:6: 4 fields, the header has 9 columns"));
    CHECK(mentions(rows, "bad.csv:7: column px: \"nan\" is not a finite number"));

    CHECK(mentions(of(csv("0.1,crank,0,0,0,1,0,0,0\n0,crank,0,0,0,1,0,0,0\n")), "bad.csv:3: time 0 comes after a later one"));
    CHECK(mentions(of(csv("0,crank,0,0,0,1,0,0,0\n0,crank,0,0,0,1,0,0,0\n")), "bad.csv:3: body \"crank\" is there twice"));
    CHECK(mentions(of(csv("0,crank,0,0,0,1,0,0,0\n0,frame,0,0,0,1,0,0,0\n1,crank,0,0,0,1,0,0,0\n")),
                   "bad.csv:4: body \"frame\" is missing at this time"));
    const std::string turn = of(csv("0,crank,0,0,0,1,0,0,0\n1,crank,0,0,0,0.0174524,0.9998477,0,0\n"));
    CHECK(mentions(turn, "bad.csv:3: body \"crank\" turns by 178 degrees since time 0"));
    CHECK(mentions(turn, "write poses more often"));
    CHECK(mentions(of("time,body,px,py,pz,qw,qx,qy,qz\n0,crank,0,0,0,1,0,0,0\n"), "bad.csv:1: the unit of px, py and pz is not said"));
    CHECK(mentions(of("time,body,px[mm],py[mm],pz[m],qw,qx,qy,qz\n"), "in one unit"));
    CHECK(mentions(of("time,body,px[furlong],py[furlong],pz[furlong],qw,qx,qy,qz\n"), "unknown unit \"furlong\""));
    CHECK(mentions(of("time,body,px[mm],py[mm],pz[mm]\n"), "no rotation"));
    CHECK(mentions(of("time,body,px[mm],py[mm],pz[mm],qw,qx,qy,qz,rx,ry,rz\n"), "more than one rotation"));
    CHECK(mentions(of("time,body,px[mm],py[mm],pz[mm],p,qw,qx,qy,qz\n"), "column \"p\" is not known"));
    CHECK(mentions(of("body,px[mm],py[mm],pz[mm],qw,qx,qy,qz\n"), "column \"time\" is missing"));
    CHECK(mentions(of("time;body;px[mm];py[mm];pz[mm];qw;qx;qy;qz\n"), "not separated by commas"));
    CHECK(mentions(of("time,body,px[mm],py[mm],pz[mm],r11,r12,r13,r21,r22,r23,r31,r32,r33\n0,crank,0,0,0,1,0,0,0,1,0,0,0,-1\n"),
                   "is a reflection"));
    CHECK(mentions(of("time,body,px[mm],py[mm],pz[mm],r11,r12,r13,r21,r22,r23,r31,r32,r33\n0,crank,0,0,0,2,0,0,0,2,0,0,0,2\n"),
                   "not a rotation: R^T R is off the identity by 3"));
    CHECK(mentions(of(csv("")), "no row of poses"));
    CHECK(mentions(of(""), "empty; a header row is expected, such as time,body,px[mm]"));
    CHECK(mentions(faults(read_poses(folder.path / "none.csv", model)), "none.csv"));
    const auto file = folder.write("mm.csv", csv("0,crank,0,0,0,1,0,0,0\n"));
    CHECK(mentions(faults(read_poses(file, model, 1.0)), "in another unit by --poses-unit"));
    CHECK(read_poses(file, model, 1e-3));
    CHECK(!read_poses(file, model)->largest_turn);
}

TEST_CASE("poses: every fault in a JSON has its pointer", "[stepper][poses]") {
    const Folder folder;
    const model::Model model = boxes();
    const auto of = [&](const std::string& times, const std::string& bodies, const std::string& rotation = "quaternion") {
        return faults(read_poses(folder.write("bad.json", "{\"fettle_poses\": 1, \"units\": \"mm\", \"rotation\": \"" + rotation +
                                                              "\", \"times\": " + times + ", \"bodies\": " + bodies + "}"),
                                 model));
    };
    CHECK(mentions(of("[0,1]", R"({"crank": [[0,0,0,1,0,0,0]]})"), "bad.json#/bodies/crank: 1 poses, 2 expected"));
    CHECK(mentions(of("[0]", R"({"crank": [[0,0,0,1,0,0]]})"), "bad.json#/bodies/crank/0: 6 numbers, 7 expected"));
    CHECK(mentions(of("[0]", R"({"crank": [[0,0,0,1,0,0,1]]})"), "bad.json#/bodies/crank/0: the quaternion"));
    CHECK(mentions(of("[0]", R"({"cranc": [[0,0,0,1,0,0,0]]})"), "bad.json#/bodies/cranc: the scene has no body"));
    CHECK(mentions(of("[0,0]", R"({"crank": [[0,0,0,1,0,0,0],[0,0,0,1,0,0,0]]})"), "bad.json#/times/1: time 0 does not come after 0"));
    CHECK(mentions(of("[0]", R"({"crank": [[0,0,0,1,0,0,0]]})", "euler"), "bad.json#/rotation"));
    CHECK(mentions(of("[0,1]", R"({"crank": [[0,0,0,0,0,0],[0,0,0,3.1,0,0]]})", "rotation_vector"), "bad.json#/bodies/crank/1"));
    CHECK(of("[0,1]", R"({"crank": [[0,0,0,0,0,0],[0,0,0,2.9,0,0]]})", "rotation_vector").empty());
    CHECK(mentions(of("[]", "{}"), "at least one time"));
}

}  // namespace fettle::core::records::poses_file_test
