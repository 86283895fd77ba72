// SPDX-License-Identifier: MIT
#include "tests/fuzz/readers.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

#include "core/certificate/certificate_checker.hpp"
#include "core/expression/parse_formula.hpp"
#include "core/files/json_document.hpp"
#include "core/files/json_keys.hpp"
#include "core/mesh_files/mesh_reader.hpp"
#include "core/model/check_scene.hpp"
#include "core/part_files/part_file.hpp"
#include "core/records/continuation.hpp"
#include "core/records/poses_file.hpp"
#include "core/records/trajectory_io.hpp"
#include "core/scene_files/scene_reader.hpp"
#include "core/setup/build_model.hpp"
#include "core/solids/mesh_judgement.hpp"
#include "core/solids/mesh_repair.hpp"
#include "core/solids/mesh_validity.hpp"
#include "design/clearance/read_subject.hpp"
#include "design/coupons/coupon_form.hpp"
#include "design/problem/design_problem.hpp"
#include "design/reading/design_reader.hpp"
#include "design/reading/process_file.hpp"
#include "design/reading/scene_shapes.hpp"
#include "design/report/exploration_report.hpp"
#include "design/report/report_folder.hpp"
#include "design/report/search_curves.hpp"
#include "design/shapes/part_library.hpp"
#include "design/studies/history.hpp"
#include "design/urdf/urdf_parser.hpp"
#include "design/urdf/urdf_scene.hpp"
#include "tests/support/ccd_queries.hpp"
#include "tests/support/temporary_folder.hpp"

/// What a thread of TBB's that is still waiting for work holds at the end of the process is no leak.
extern "C" const char* __lsan_default_suppressions() { return "leak:enqueue_task\n"; }

namespace fettle::tests::fuzz {
namespace {

namespace fs = std::filesystem;
using core::files::JsonNode;

/// A folder for files that readers take by name, with what the samples refer to beside them.
class Scratch {
public:
    Scratch() {
        fs::create_directory(folder_.path / "run");
        for (const char* beside : {"obj/parts.obj", "design/slider.json", "scene/shapes.json", "scene/lever.json"})
            fs::copy_file(corpus() / beside, folder_.path / fs::path(beside).filename());
        fs::copy_file(corpus() / "scene/shapes.json", folder_.path / "follower.scene.json");
        fs::copy_file(corpus() / "obj/parts.obj", folder_.path / "tetrahedron.obj");
    }
    std::string file(const std::string& name) const { return folder_.file(name); }
    std::string write(const std::string& name, std::string_view bytes) const {
        const std::string path = file(name);
        const int out = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
        for (std::string_view left = bytes; out >= 0 && !left.empty();) {
            const ssize_t written = ::write(out, left.data(), left.size());
            if (written <= 0) throw std::runtime_error("cannot write " + path);
            left.remove_prefix(static_cast<std::size_t>(written));
        }
        ::close(out);
        return path;
    }
    static fs::path corpus() { return fs::path(FETTLE_SOURCE_DIR) / "tests/fuzz/corpus"; }

private:
    support::TemporaryFolder folder_;
};

const Scratch& scratch() {
    static const Scratch folder;
    return folder;
}

/// What `fettle validate` does with a mesh.
void read_mesh_as(const std::string& name, std::string_view bytes) {
    const std::string path = scratch().write(name, bytes);
    auto mesh = core::mesh_files::read_mesh(path);
    if (name == "a.3mf") (void)core::mesh_files::read_mesh_parts(path, {1e-3, false});
    if (!mesh) return;
    (void)core::solids::validate_mesh(*mesh, {});
    core::solids::repair_mesh(*mesh);
    (void)core::solids::judge_mesh(*mesh, true);
}

void visit(const JsonNode& node) {
    (void)node.number();
    (void)node.length(1e-3);
    (void)node.boolean();
    (void)node.string();
    (void)node.numbers();
    (void)node.vector3();
    (void)node.shown();
    (void)node["units"].choice({"mm", "m"});
    if (node.is_array())
        for (const JsonNode& each : node.elements()) visit(each);
    if (!node.is_object()) return;
    node.allow_keys({"units", "number"});
    for (const auto& [key, each] : node.members()) visit(each);
}

void read_json(std::string_view bytes) {
    (void)core::files::has_top_level_key(scratch().write("a.json", bytes), "fettle_design");
    auto document = core::files::JsonDocument::parse(std::string(bytes), "a.json");
    if (!document) return;
    visit(document->root());
    (void)document->warnings();
}

/// Small enough to be built while others are waiting.
bool is_small(const core::scene::Scene& scene) {
    std::size_t triangles = 0;
    for (const core::scene::Body& body : scene.bodies) triangles += body.mesh.triangles.size() + body.mesh.edges.size();
    return scene.bodies.size() < 20 && triangles < 5000;
}

void read_scene(std::string_view bytes) {
    for (const bool strict : {false, true}) {
        core::scene::ReadOptions options = design::reading::scene_read_options();
        options.strict_meshes = strict;
        const auto scene = core::scene_files::parse_scene(std::string(bytes), scratch().file("a.scene.json"), options);
        if (!scene || !is_small(*scene)) return;
        (void)core::model::check_scene(*scene, strict);
        if (!strict) (void)core::setup::build_model(*scene);
    }
}

void read_design(std::string_view bytes) {
    auto file = design::reading::parse_design(std::string(bytes), scratch().file("a.design.json"));
    if (!file || !is_small(file->design.scene)) return;
    (void)design::problem::DesignProblem::create(std::move(file->design));
}

void read_trajectory(std::string_view bytes) {
    const auto stored = core::records::read_trajectory(scratch().write("a.trajectory.json", bytes));
    if (stored) (void)core::records::resumable(*stored, stored->model);
}

const core::records::StoredTrajectory& sample(const std::string& name) {
    static const auto path = core::records::read_trajectory(Scratch::corpus() / "trajectory/path.json").value();
    static const auto start = core::records::read_trajectory(Scratch::corpus() / "trajectory/start.json").value();
    return name == "path" ? path : start;
}

void read_certificate(std::string_view bytes) {
    const auto certificate = core::certificate::read_certificate(scratch().write("a.certificate.json", bytes));
    if (!certificate) return;
    auto fitting = *certificate;  // a changed hash would end the check at once
    const core::records::StoredTrajectory& about = sample(fitting.linkage ? "start" : "path");
    fitting.geometry_hash = core::records::geometry_hash(about.model);
    fitting.path_hash = core::records::path_hash(about.trajectory);
    (void)core::certificate::check_certificate(fitting, about);
    (void)uncovered_pairs(fitting, 2);
}

void read_poses_as(const char* name, std::string_view bytes) {
    (void)core::records::read_poses(scratch().write(name, bytes), sample("path").model);
}

void read_process(std::string_view bytes) { static_cast<void>(design::reading::parse_process(std::string(bytes), "a.process.json")); }

void read_form(std::string_view bytes) {
    const auto features = design::coupons::parse_form(std::string(bytes), "a.csv");
    if (features) static_cast<void>(design::tolerances::fit_process(*features, "a.csv"));
}

void read_urdf(std::string_view bytes) {
    const auto robot = design::urdf::parse_urdf(bytes, "a.urdf");
    if (!robot) return;
    const auto scene = design::urdf::scene_of_robot(*robot, {{scratch().file(""), {}}, "a", false});
    if (scene && bytes.size() < 10'000) (void)core::scene_files::parse_scene(scene->files.front().second, scratch().file("a.scene.json"));
}

void read_part(std::string_view bytes) {
    const auto part = core::part_files::PartFile::parse(std::string(bytes), "a.part.json");
    if (!part) return;
    std::vector<double> values;
    for (const auto& dimension : part->dimensions()) values.push_back(dimension.value);
    core::parts::Facets coarse;
    coarse.segments = 8;
    (void)part->drawn(values, coarse);
    // And one dimension far from what the file says, which one and how far by the file's size.
    if (values.empty()) return;
    values[bytes.size() % values.size()] *= std::pow(10.0, static_cast<double>(bytes.size() / 7 % 61) - 30);
    (void)part->drawn(values, coarse);
}

/// A part of the library, which the first byte chooses, with dimensions far from the usual: two bytes each, a power of ten and a factor.
void draw_library_part(std::string_view bytes) {
    const auto byte = [&](std::size_t k) { return k < bytes.size() ? static_cast<unsigned char>(bytes[k]) : 0U; };
    const auto& library = design::shapes::part_library();
    const auto part = core::part_files::PartFile::parse(std::string(library[byte(0) % library.size()].text), "library.part.json");
    if (!part) throw std::runtime_error("a part of the library cannot be read");
    std::vector<double> values;
    for (const auto& dimension : part->dimensions()) {
        const std::size_t k = 1 + 2 * values.size();
        const int power = static_cast<signed char>(byte(k));
        const double factor = 1 + static_cast<signed char>(byte(k + 1)) / 64.0;  // from -1 to 3
        values.push_back((dimension.value == 0 ? 1e-3 * (factor - 1) : dimension.value * factor) * std::pow(10.0, power / 4.0));
    }
    core::parts::Facets coarse;
    coarse.segments = 8;
    const auto drawn = part->drawn(values, coarse);
    if (!drawn && drawn.errors().empty()) throw std::runtime_error("a refusal without words");
    if (drawn && !drawn->mesh.vertices.allFinite()) throw std::runtime_error("corners that are not finite");
}

/// A design's tolerances, as far as they are recorded on its parts and joints.
void read_tolerances(std::string_view bytes) {
    design::clearance::SubjectOptions options;
    options.path = scratch().write("b.design.json", bytes);
    options.tolerances = true;
    for (const bool kinematic : {false, true}) {
        options.kinematic = kinematic;
        options.steps = kinematic ? 3 : -1;
        (void)design::clearance::read_subject(options, {});
    }
}

void read_expression(std::string_view bytes) {
    using namespace core::expression;
    Scope scope;
    scope.names = {{"width", powers_of(Dimension::length)}, {"height", powers_of(Dimension::length)}};
    const auto formula = parse_formula(bytes, scope, "formula");
    const std::vector<double> inputs(formula ? formula->inputs.size() : 0, 0.5);
    if (formula) (void)differentiated(*formula, inputs);
}

void read_ccd(std::string_view bytes) {
    for (const char* name : {"a-vf.csv", "a.ccd.json"}) (void)support::read_ccd_queries(scratch().write(name, bytes));
}

void read_result(std::string_view bytes) {
    scratch().write("run/result.json", bytes);
    (void)design::report::write_report(scratch().file("run"));
}

void read_exploration(std::string_view bytes) { (void)design::report::write_exploration_report(scratch().write("a.jsonl", bytes)); }

/// For a run that goes on, and for the report.
void read_history(std::string_view bytes) {
    static const design::description::Design slider = design::reading::read_design(scratch().file("slider.json")).value().design;
    design::studies::HistoryHeader header;
    header.design_hash = "x";
    for (const auto& parameter : slider.parameters) header.parameters.push_back(parameter.name);
    for (const auto& constraint : slider.constraints) header.constraints.push_back(constraint.name);
    (void)design::report::search_curves(std::string(bytes), slider);
    scratch().write("run/history.jsonl", bytes);
    (void)design::studies::History::open(scratch().file("run"), header, design::studies::LineFileMode::resume);
}

}  // namespace

const std::vector<Reader>& readers() {
    static const std::vector<Reader> all{
        {"stl", [](std::string_view bytes) { read_mesh_as("a.stl", bytes); }},
        {"obj", [](std::string_view bytes) { read_mesh_as("a.obj", bytes); }},
        {"off", [](std::string_view bytes) { read_mesh_as("a.off", bytes); }},
        {"ply", [](std::string_view bytes) { read_mesh_as("a.ply", bytes); }},
        {"3mf", [](std::string_view bytes) { read_mesh_as("a.3mf", bytes); }},
        {"json", read_json},
        {"scene", read_scene},
        {"design", read_design},
        {"trajectory", read_trajectory},
        {"certificate", read_certificate},
        {"poses", [](std::string_view bytes) { read_poses_as("a.csv", bytes); }},
        {"poses_json", [](std::string_view bytes) { read_poses_as("a.poses.json", bytes); }},
        {"urdf", read_urdf},
        {"process", read_process},
        {"coupon", read_form},
        {"expression", read_expression},
        {"part", read_part},
        {"library", draw_library_part},
        {"tolerances", read_tolerances},
        {"ccd", read_ccd},
        {"result", read_result},
        {"exploration", read_exploration},
        {"history", read_history},
        {"dae", [](std::string_view bytes) { read_mesh_as("a.dae", bytes); }, true},
        {"gltf", [](std::string_view bytes) { read_mesh_as("a.gltf", bytes); }, true},
        {"3ds", [](std::string_view bytes) { read_mesh_as("a.3ds", bytes); }, true},
        {"amf", [](std::string_view bytes) { read_mesh_as("a.amf", bytes); }, true},
    };
    return all;
}

}  // namespace fettle::tests::fuzz
