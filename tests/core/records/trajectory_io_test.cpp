// SPDX-License-Identifier: MIT
#include "core/records/trajectory_io.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <random>

#include "core/files/atomic_file.hpp"
#include "core/kinematics/rotation.hpp"
#include "core/records/trajectory_lines.hpp"
#include "core/records/trajectory_reader.hpp"
#include "core/setup/build_model.hpp"
#include "core/stepper/step.hpp"
#include "tests/core/geometry/sample_meshes.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fettle::core::records::trajectory_io_test {

namespace {

namespace fs = std::filesystem;
using namespace stepper;
using base::ErrorCode;

using Folder = tests::support::TemporaryFolder;

model::Model two_boxes() {
    scene::Scene scene;
    scene.length_unit = 0.001;
    scene.dmin = 1.0 / 3e5;
    for (const char* name : {"left \"quoted\"", "right\\ \u00e9"}) {
        scene::Body body;
        body.name = name;
        body.mesh = tests::box_mesh({0, 0, 0}, {0.1, 0.2, 1.0 / 3});
        body.mesh.vertices(0, 3) += 1e-17;
        body.pose.position.x() = static_cast<double>(scene.bodies.size());
        scene.bodies.push_back(body);
    }
    scene.bodies[1].type = scene::BodyType::static_body;
    scene.bodies[1].group = 4;
    geometry::build_connectivity(scene.bodies[1].mesh, {{0, 7}});  // a codimensional edge
    return setup::build_model(scene).value();
}

Trajectory random_path(const model::Model& model, int steps) {
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> uniform(-1, 1);
    Trajectory out;
    out.timestep = model.timestep;
    for (const auto& body : model.bodies) out.body_names.push_back(body.name);
    out.poses.emplace_back();
    for (const auto& body : model.bodies) out.poses[0].push_back(body.pose_start);
    for (int t = 0; t < steps; ++t) {
        TrajectoryStep step;
        for (int node = 0; node < 2 + t % 2; ++node) {
            step.nodes.emplace_back();
            for (std::size_t b = 0; b < model.bodies.size(); ++b) {
                kinematics::ChartPoint point{out.poses.back()[b].position, Vector3::Zero()};
                for (int k = 0; k < 3 && node > 0; ++k) {
                    point.position[k] += uniform(random);
                    point.rotation_vector[k] = uniform(random);
                }
                step.nodes.back().push_back(point);
            }
        }
        std::vector<kinematics::Pose> next;
        for (std::size_t b = 0; b < model.bodies.size(); ++b) {
            const auto& last = step.nodes.back()[b];
            next.push_back(
                {kinematics::orthonormalised(kinematics::rotation(last.rotation_vector) * out.poses.back()[b].rotation), last.position});
        }
        out.poses.push_back(next);
        out.steps.push_back(step);
    }
    return out;
}

bool same_bits(const auto& a, const auto& b) {
    if (a.rows() != b.rows() || a.cols() != b.cols()) return false;
    for (Eigen::Index j = 0; j < a.cols(); ++j) {
        for (Eigen::Index i = 0; i < a.rows(); ++i) {
            if (a(i, j) != b(i, j) || std::signbit(a(i, j)) != std::signbit(b(i, j))) return false;
        }
    }
    return true;
}

TEST_CASE("A trajectory reads back bit for bit, with all that certifying needs", "[stepper]") {
    const Folder folder;
    model::Model model = two_boxes();
    model.bodies[0].mass_kind = scene::MassKind::area;
    model.bodies[1].mass_kind = scene::MassKind::area;
    model.bodies[1].mass_kind_given = false;
    Trajectory trajectory = random_path(model, 20);
    trajectory.time_start = 0.1;
    trajectory.steps[3].nodes[1][0].rotation_vector.x() = -0.0;
    trajectory.steps[3].nodes[1][0].rotation_vector.y() = 5e-324;
    trajectory.steps[3].nodes[1][0].position.x() = 9.9999999999999989e29;
    trajectory.steps[3].nodes[1][0].position.y() = 9007199254740993.0 * 1024;
    const fs::path path = folder.path / "new" / "run.trajectory.json";
    REQUIRE(write_trajectory(path, trajectory, model, "some/a.scene.json").empty());
    CHECK(is_trajectory_file(path));
    const auto stored = read_trajectory(path);
    REQUIRE(stored);
    const Trajectory& read = stored->trajectory;
    CHECK(stored->scene_path == "some/a.scene.json");
    CHECK(read.time_start == trajectory.time_start);
    CHECK(read.timestep == trajectory.timestep);
    CHECK(read.body_names == trajectory.body_names);
    REQUIRE(read.poses.size() == trajectory.poses.size());
    REQUIRE(read.steps.size() == trajectory.steps.size());
    for (std::size_t t = 0; t < read.poses.size(); ++t) {
        for (std::size_t b = 0; b < 2; ++b) {
            CHECK(same_bits(read.poses[t][b].rotation, trajectory.poses[t][b].rotation));
            CHECK(same_bits(read.poses[t][b].position, trajectory.poses[t][b].position));
        }
    }
    for (std::size_t t = 0; t < read.steps.size(); ++t) {
        REQUIRE(read.steps[t].nodes.size() == trajectory.steps[t].nodes.size());
        for (std::size_t k = 0; k < read.steps[t].nodes.size(); ++k) {
            for (std::size_t b = 0; b < 2; ++b) {
                CHECK(same_bits(read.steps[t].nodes[k][b].position, trajectory.steps[t].nodes[k][b].position));
                CHECK(same_bits(read.steps[t].nodes[k][b].rotation_vector, trajectory.steps[t].nodes[k][b].rotation_vector));
            }
        }
    }
    CHECK(geometry_hash(stored->model) == geometry_hash(model));
    CHECK(stored->model.dhat == model.dhat);
    CHECK(stored->model.dmin == model.dmin);
    CHECK(stored->model.length_unit == model.length_unit);
    for (std::size_t b = 0; b < 2; ++b) {
        const model::Body &was = model.bodies[b], &is = stored->model.bodies[b];
        CHECK(same_bits(is.mesh.vertices, was.mesh.vertices));
        CHECK(is.mesh.triangles == was.mesh.triangles);
        CHECK(is.mesh.edges == was.mesh.edges);
        CHECK(is.type == was.type);
        CHECK(is.group == was.group);
        CHECK(is.mass_kind == was.mass_kind);
        CHECK(is.mass_kind_given == was.mass_kind_given);
        CHECK(is.radius == was.radius);
        CHECK(same_bits(is.reference_point, was.reference_point));
        CHECK(is.hierarchy != nullptr);
    }
}

TEST_CASE("A trajectory without steps is the assembly", "[stepper]") {
    const Folder folder;
    const model::Model model = two_boxes();
    REQUIRE(write_trajectory(folder.path / "a.json", random_path(model, 0), model).empty());
    const auto stored = read_trajectory(folder.path / "a.json");
    REQUIRE(stored);
    CHECK(stored->trajectory.steps.empty());
    CHECK(stored->trajectory.poses.size() == 1);
}

TEST_CASE("A step's fractions and uneven times are kept", "[stepper]") {
    const Folder folder;
    const model::Model model = two_boxes();
    Trajectory trajectory = random_path(model, 2);
    trajectory.steps[1].fractions = {0, 1.0 / 3, 1};
    trajectory.times = {0, 0.1, 0.3};
    REQUIRE(write_trajectory(folder.path / "a.json", trajectory, model).empty());
    const auto stored = read_trajectory(folder.path / "a.json");
    REQUIRE(stored);
    CHECK(stored->trajectory.steps[0].fractions.empty());
    CHECK(stored->trajectory.steps[1].fractions == trajectory.steps[1].fractions);
    CHECK(stored->trajectory.times == trajectory.times);
    CHECK(path_hash(stored->trajectory) == path_hash(trajectory));
}

// A file, and what reading it says after a change of its text.
struct ChangedFile {
    const Folder folder;
    const fs::path path = folder.path / "a.json";
    std::string text, checkpoint;

    ChangedFile() {
        const model::Model model = two_boxes();
        Trajectory trajectory = random_path(model, 3);
        trajectory.steps[1].fractions = {0, 0.5, 1};
        REQUIRE(write_trajectory(path, trajectory, model).empty());
        text = files::read_file(path).value();
        stepper::Checkpoint at_step{1, stepper::start_state(model)};
        at_step.state.history.poses = trajectory.poses[1];
        checkpoint = TrajectoryLines(trajectory, model).checkpoint(at_step);
    }
    auto read(const std::string& changed) const {
        std::ofstream(path) << changed;
        return read_trajectory(path);
    }
    base::Errors errors_after(const std::string& from, const std::string& to) const {
        const auto place = text.find(from);
        REQUIRE(place != std::string::npos);
        return read(text.substr(0, place) + to + text.substr(place + from.size())).errors();
    }
    ErrorCode code_after(const std::string& from, const std::string& to) const {
        const auto errors = errors_after(from, to);
        REQUIRE_FALSE(errors.empty());
        return errors.front().code;
    }
};

TEST_CASE("A trajectory file that was changed is refused", "[stepper]") {
    const ChangedFile file;
    const auto code_after = [&](const std::string& from, const std::string& to) { return file.code_after(from, to); };
    CHECK(code_after("\"fettle_trajectory\": 2", "\"fettle_trajectory\": 3") == ErrorCode::out_of_range);
    CHECK(code_after("\"fettle_trajectory\": 2", "\"fettle_trajectory\": 1") == ErrorCode::out_of_range);
    CHECK(code_after("\"fettle_trajectory\": 2,", "") == ErrorCode::missing_key);
    CHECK(code_after("\"timestep\": 0.01", "\"timestep\": 0") == ErrorCode::out_of_range);
    CHECK(code_after("\"timestep\": 0.01", "\"timestep\": 0.02") == ErrorCode::inconsistent);  // the path's hash
    CHECK(code_after("\"timestep\": 0.01", "\"timestep\": 1e999") == ErrorCode::not_finite);
    CHECK(code_after("\"timestep\"", "\"timesteps\"") == ErrorCode::unknown_key);
    CHECK(code_after("\"triangles\": [0,2,3", "\"triangles\": [0,2,8") == ErrorCode::out_of_range);
    CHECK(code_after("\"triangles\": [0,2,3", "\"triangles\": [0,2,2") == ErrorCode::inconsistent);
    CHECK(code_after("\"triangles\": [0,2,3", "\"triangles\": [0,2,4") == ErrorCode::inconsistent);  // the hash
    CHECK(code_after("\"triangles\": [0,2,3", "\"triangles\": [0,2") == ErrorCode::inconsistent);
    CHECK(code_after("\"poses\": [[1,0,0", "\"poses\": [[1,0,1e-12") == ErrorCode::out_of_range);  // not a rotation
    CHECK(code_after("\"poses\": [[1,0,0,", "\"poses\": [[1,0,") == ErrorCode::inconsistent);
    CHECK(code_after("\"nodes\": [[[0.05", "\"nodes\": [[[0.06") == ErrorCode::inconsistent);  // a jump
    CHECK(code_after("\"nodes\": [[[", "\"nodes\": [[[1e31,") == ErrorCode::out_of_range);
    CHECK(code_after("\"nodes\": [", "\"nodes\": [[],") == ErrorCode::inconsistent);
    CHECK(code_after("\"fractions\": [0,0.5,1]", "\"fractions\": [0,0.5,0.75]") == ErrorCode::inconsistent);
    CHECK(code_after("\"fractions\": [0,0.5,1]", "\"fractions\": [0,1.5,1]") == ErrorCode::inconsistent);
    CHECK(code_after("\"fractions\": [0,0.5,1]", "\"fractions\": [0,0.6,1]") == ErrorCode::inconsistent);  // the hash
    CHECK(file.errors_after("\"fractions\": [0,0.5,1]", "\"fractions\": [0,0.6,1]").front().where.find(":3#/hash") != std::string::npos);
    CHECK(read_trajectory(file.folder.path / "absent.json").errors().front().code == ErrorCode::file_not_found);
    CHECK_FALSE(is_trajectory_file(file.folder.path / "absent.json"));
    CHECK_FALSE(file.read(""));
    CHECK_FALSE(file.read("\n\n"));
}

TEST_CASE("A trajectory of the first format is refused by name", "[stepper]") {
    const ChangedFile file;
    const auto read = file.read("{\"fettle_trajectory\": 1,\n\"scene\": \"\", \"bodies\": []}\n");
    REQUIRE_FALSE(read);
    CHECK(read.errors().front().code == ErrorCode::unsupported);
    CHECK(read.errors().front().message.find("version 1") != std::string::npos);
}

TEST_CASE("Another kind of file is told to be no trajectory, and not that its JSON is at fault", "[stepper]") {
    const ChangedFile file;
    for (const char* other : {"{\"fettle_scene\": 1,\n\"bodies\": []}\n", "{\"fettle_scene\": 1}", "[\n1,\n2]"}) {
        const auto read = file.read(other);
        REQUIRE_FALSE(read);
        CHECK(read.errors().size() == 1);
        CHECK(read.errors().front().code == ErrorCode::missing_key);
        CHECK(read.errors().front().message.find("no trajectory") != std::string::npos);
    }
    CHECK(file.read("{\"fettle_trajectory\": 2,\n").errors().front().code == ErrorCode::parse);
}

TEST_CASE("A trajectory whose last line is cut off is taken up to there, with a warning", "[stepper]") {
    const ChangedFile file;
    const std::size_t last_line = file.text.rfind('\n', file.text.size() - 2) + 1;
    for (const std::size_t size : {file.text.size() - 2, file.text.size() - 40, last_line + 1}) {
        const auto read = file.read(file.text.substr(0, size));
        REQUIRE(read);
        CHECK(read->trajectory.steps.size() == 2);
        CHECK(read->trajectory.poses.size() == 3);
        REQUIRE(read->warnings.size() == 1);
        CHECK(read->warnings[0].find("2 steps") != std::string::npos);
    }
    CHECK(file.read(file.text.substr(0, last_line))->warnings.empty());
    CHECK(file.read(file.text.substr(0, file.text.size() - 1))->trajectory.steps.size() == 3);  // only the line feed is missing
    CHECK_FALSE(file.read(file.text.substr(0, file.text.find('\n') / 2)));                      // nothing usable
    CHECK_FALSE(file.read(file.text.substr(0, last_line - 20) + "\n" + file.text.substr(last_line)));
}

TEST_CASE("A path may not jump from step to step, however far from the origin it is", "[stepper]") {
    const Folder folder;
    const model::Model model = two_boxes();
    for (const double by : {1e-12, 1.7e-3}) {
        Trajectory trajectory = random_path(model, 2);
        const auto shift = [](auto& poses) { poses[0].position.x() += 1e6; };
        for (auto& poses : trajectory.poses) shift(poses);
        for (auto& step : trajectory.steps)
            for (auto& node : step.nodes) shift(node);
        REQUIRE(write_trajectory(folder.path / "a.json", trajectory, model).empty());
        REQUIRE(read_trajectory(folder.path / "a.json"));
        auto& place = by < 1e-6 ? trajectory.steps[1].nodes.back()[1].position : trajectory.steps[1].nodes.back()[0].position;
        place.y() += by;
        REQUIRE(write_trajectory(folder.path / "a.json", trajectory, model).empty());
        CHECK_FALSE(read_trajectory(folder.path / "a.json"));
    }
    Trajectory turned = random_path(model, 2);
    turned.steps[0].nodes.back()[0].rotation_vector.x() += 1e-13;
    REQUIRE(write_trajectory(folder.path / "a.json", turned, model).empty());
    CHECK_FALSE(read_trajectory(folder.path / "a.json"));
}

TEST_CASE("Whatever is done to a trajectory file, its reader answers", "[stepper]") {
    const ChangedFile file;
    std::mt19937_64 random(17);
    const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random() % n); };
    const std::vector<std::string> tokens{"1e308", "-1",    "0",  "1e-320",     "[]", "{}", "null",
                                          "\"x\"", "[[1]]", "-0", "4294967296", ",",  "\n", "]"};
    REQUIRE(parse_trajectory("fuzz", file.text + file.checkpoint)->checkpoint);
    int refused = 0;
    constexpr int changes = 4000;
    for (int i = 0; i < changes; ++i) {
        std::string text = file.text + file.checkpoint;
        for (std::size_t n = 1 + below(3); n > 0; --n) {
            const std::size_t at = below(text.size()), length = std::min(text.size() - at, 1 + below(30));
            const std::size_t number = text.find_first_of("0123456789[\"", at), end = text.find_first_of(",]}", number);
            switch (below(5)) {
                case 0:
                    text.erase(at, length);
                    break;
                case 1:
                    text.insert(at, text.substr(below(text.size()), length));
                    break;
                case 2:
                    text[at] = static_cast<char>('0' + below(10));
                    break;
                default:
                    if (end != std::string::npos) text.replace(number, end - number, tokens[below(tokens.size())]);
            }
        }
        const auto read = parse_trajectory("fuzz", text);  // no exception, no contract broken
        if (!read) {
            ++refused;
            REQUIRE_FALSE(read.errors().empty());
        }
    }
    CHECK(refused > changes / 2);
}

}  // namespace

}  // namespace fettle::core::records::trajectory_io_test
