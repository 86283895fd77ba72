// SPDX-License-Identifier: MIT
// STEP files, written by Open CASCADE (step_samples.cpp): counts, names, places, units, colours; meshes within what they are charged with.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <random>

#include "core/geometry/mass_moments.hpp"
#include "core/mesh_files/mesh_reader.hpp"
#include "core/solids/mesh_judgement.hpp"
#include "tests/support/nearest_triangle.hpp"
#include "tests/support/shared_files.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/text.hpp"

namespace fettle::core::mesh_files::step_reader_test {

namespace {

using fettle::tests::support::contents;
using fettle::tests::support::NearestTriangle;
using fettle::tests::support::TemporaryFolder;
using geometry::Mesh;

#ifndef FETTLE_STEP_SAMPLES
#define FETTLE_STEP_SAMPLES ""
#endif
bool has_open_cascade() { return std::string(FETTLE_STEP_SAMPLES) != ""; }

/// The files of step_samples.cpp, written once.
const TemporaryFolder& samples() {
    static const TemporaryFolder folder;
    static const int code = std::system(("'" FETTLE_STEP_SAMPLES "' write '" + folder.path.string() + "' >/dev/null 2>&1").c_str());
    REQUIRE(code == 0);
    return folder;
}

std::vector<Vector3> points_of(const std::string& path, long count) {
    const TemporaryFolder folder;
    const std::string out = folder.file("points");
    const std::string command =
        "'" FETTLE_STEP_SAMPLES "' points '" + path + "' " + std::to_string(count) + " '" + out + "' >/dev/null 2>&1";
    REQUIRE(std::system(command.c_str()) == 0);
    const std::string bytes = contents(out);
    std::vector<Vector3> points(bytes.size() / sizeof(Vector3));
    std::copy(bytes.begin(), bytes.end(), reinterpret_cast<char*>(points.data()));
    return points;
}

std::vector<Mesh> parts_of(const std::string& path, const MeshReadOptions& options = {}) {
    Result<std::vector<Mesh>> parts = read_mesh_parts(path, options);
    for (const Error& error : parts.errors()) UNSCOPED_INFO(error.where << ": " << error.message);
    REQUIRE(parts);
    return std::move(*parts);
}

double volume_of(const Mesh& mesh) { return 1e9 * geometry::capped_solid_moments(mesh.vertices, mesh.triangles)(3, 3); }

std::string fault_of(const std::string& path, const MeshReadOptions& options = {}) {
    const Result<Mesh> mesh = read_mesh(path, options);
    REQUIRE_FALSE(mesh);
    return mesh.errors().front().message;
}

/// No place of the exact faces is farther from the mesh than it is charged with.
void check_samples(const std::string& path, long count) {
    const Result<Mesh> mesh = read_mesh(path);
    for (const Error& error : mesh.errors()) UNSCOPED_INFO(error.where << ": " << error.message);
    REQUIRE(mesh);
    REQUIRE(mesh->deviation);
    const NearestTriangle nearest(*mesh);
    double farthest = 0;
    const std::vector<Vector3> points = points_of(path, count);
    REQUIRE(points.size() > static_cast<std::size_t>(count) / 2);
    for (const Vector3& point : points) farthest = std::max(farthest, nearest.distance(point));
    INFO(path << ": farthest " << farthest << ", out " << mesh->deviation->out << ", in " << mesh->deviation->in);
    CHECK(farthest <= std::max(mesh->deviation->out, mesh->deviation->in));
    CHECK(mesh->deviation->out_is_proven);
    constexpr std::size_t judged = 20'000;  // triangles: what is finer takes seconds
    if (mesh->triangles.size() < judged) CHECK(solids::judge_mesh(*mesh, true).errors.empty());
}

const char* const solids_of_samples[] = {"box",       "cylinder",        "cone",          "pointed_cone", "sphere",          "torus",
                                         "bored_box", "cut_cylinder",    "crossed_bores", "rounded_box",  "extruded_wave",   "turned_wave",
                                         "ellipsoid", "spline_cylinder", "spline_sphere", "spline_torus", "spline_bored_box"};

}  // namespace

TEST_CASE("STEP: without Open CASCADE one sentence says what to install") {
    if (has_open_cascade()) return;
    const TemporaryFolder folder;
    const std::string fault = fault_of(folder.write("a.step", "ISO-10303-21;"));
    CHECK(fault.find("apt-get install libocct-data-exchange-dev") != std::string::npos);
}

TEST_CASE("STEP: a solid's mesh is within its deviation of the exact faces") {
    if (!has_open_cascade()) FETTLE_SKIP("no Open CASCADE");
    for (const char* name : solids_of_samples) check_samples(samples().file(std::string(name) + ".step"), 4000);
}

TEST_CASE("STEP: ten million places of exact faces are within the deviations", "[slow]") {
    if (!has_open_cascade()) FETTLE_SKIP("no Open CASCADE");
    for (const char* name : solids_of_samples) check_samples(samples().file(std::string(name) + ".step"), 600'000);
}

TEST_CASE("STEP: closed forms of volumes; a bore's facets reach in, a pin's are reached out of") {
    if (!has_open_cascade()) FETTLE_SKIP("no Open CASCADE");
    const auto only = [](const std::string& name) { return parts_of(samples().file(name + ".step")).at(0); };
    CHECK(volume_of(only("box")) == Approx(6000));
    CHECK(volume_of(only("cylinder")) == Approx(500 * M_PI).epsilon(1e-3));
    CHECK(volume_of(only("bored_box")) == Approx(4000 - 10 * M_PI * 3.25 * 3.25).epsilon(1e-4));
    CHECK(volume_of(only("sphere")) == Approx(4.0 / 3 * M_PI * 343).epsilon(2e-3));
    CHECK(volume_of(only("torus")) == Approx(2 * M_PI * M_PI * 12 * 9).epsilon(3e-3));
    CHECK(volume_of(only("pointed_cone")) == Approx(M_PI * 36 * 15 / 3).epsilon(1e-3));
    for (const char* pin : {"cylinder", "spline_cylinder", "cone", "sphere"}) {
        const Mesh mesh = only(pin);
        INFO(pin);
        CHECK(mesh.deviation->out > 1e-6);
        CHECK(mesh.deviation->in < 1e-8);
    }
    for (const char* bore : {"bored_box", "spline_bored_box"}) {
        const Mesh mesh = only(bore);
        INFO(bore);
        CHECK(mesh.deviation->out < 1e-8);
        CHECK(mesh.deviation->in > 1e-6);
    }
    const Mesh fine = parts_of(samples().file("cylinder.step"), {.chord = 0.5e-6}).at(0);
    CHECK(fine.deviation->out < 0.6e-6);
    CHECK(fine.triangles.size() > 1.5 * static_cast<double>(only("cylinder").triangles.size()));
}

TEST_CASE("STEP: units are the file's") {
    if (!has_open_cascade()) FETTLE_SKIP("no Open CASCADE");
    const Mesh mm = parts_of(samples().file("box.step")).at(0), inch = parts_of(samples().file("box_inch.step")).at(0);
    CHECK(contents(samples().file("box_inch.step")).find("INCH") != std::string::npos);
    CHECK(mm.vertices.isApprox(inch.vertices, 1e-9));
    CHECK(mm.face_names.size() == 6);
    CHECK(mm.face_names.front() == "plane 1");
    CHECK(mm.triangle_face.size() == mm.triangles.size());
}

TEST_CASE("STEP: an assembly's solids have names, places and colours") {
    if (!has_open_cascade()) FETTLE_SKIP("no Open CASCADE");
    const std::vector<Mesh> parts = parts_of(samples().file("assembly.step"));
    std::vector<std::string> names;
    for (const Mesh& part : parts) names.push_back(part.name);
    CHECK(names == std::vector<std::string>{"plate", "pin", "pin#2", "pin#3", "pin#4"});
    const double places[4][2] = {{10, 10}, {20, 10}, {40, 10}, {40, 20}};
    for (std::size_t i = 1; i < parts.size(); ++i) {
        const Vector3 low = parts[i].vertices.rowwise().minCoeff(), high = parts[i].vertices.rowwise().maxCoeff();
        const Vector3 middle = 1e3 * (low + high) / 2;
        CHECK(middle.isApprox(Vector3(places[i - 1][0], places[i - 1][1], 10.5), 1e-3));
        CHECK(parts[i].colour == std::array<unsigned char, 3>{0, 0, 255});
    }
    CHECK(parts[0].colour == std::array<unsigned char, 3>{255, 0, 0});
    const auto pin = item_called(parts, "pin#3", "assembly.step");
    REQUIRE(pin);
    CHECK(pin->triangles == parts[3].triangles);
    const auto none = item_called(parts, "bolt", "assembly.step");
    REQUIRE_FALSE(none);
    CHECK(none.errors().front().message.find("`pin#4`") != std::string::npos);
}

TEST_CASE("STEP: what is no solid, cut off or damaged is refused with the reason") {
    if (!has_open_cascade()) FETTLE_SKIP("no Open CASCADE");
    const TemporaryFolder folder;
    CHECK(fault_of(samples().file("open_shell.step")).find("#") != std::string::npos);
    CHECK(fault_of(samples().file("open_shell.step")).find("solid") != std::string::npos);
    const std::string whole = contents(samples().file("bored_box.step"));
    CHECK(fault_of(folder.write("cut.step", whole.substr(0, whole.size() / 2))).find("END-ISO-10303-21") != std::string::npos);
    CHECK(fault_of(folder.write("none.step", "hello")).find("ISO-10303-21") != std::string::npos);
    CHECK(fault_of(folder.write("empty.step", "")).find("ISO-10303-21") != std::string::npos);
    // A face's entity is missing from its shell: the surface is open, or the file's own check says so.
    std::string open = whole;
    const std::size_t shell = open.find("CLOSED_SHELL"), first = open.find('#', shell), comma = open.find(',', first);
    open.erase(first, comma - first + 1);
    CHECK_FALSE(read_mesh(folder.write("open.step", open)));
}

TEST_CASE("STEP: damaged anywhere, a file is refused or read, in time") {
    if (!has_open_cascade()) FETTLE_SKIP("no Open CASCADE");
    const TemporaryFolder folder;
    std::mt19937 random(3);
    for (const char* name : {"box", "cylinder"}) {
        const std::string whole = contents(samples().file(std::string(name) + ".step"));
        for (int round = 0; round < 12; ++round) {
            std::string damaged = whole;
            for (int k = 0; k < 3; ++k) damaged[random() % damaged.size()] = "0#(,$*-9A;"[random() % 10];
            const auto mesh = read_mesh(folder.write("damaged.step", damaged));
            if (mesh) {
                CHECK(mesh->deviation);
            } else {
                CHECK_FALSE(mesh.errors().front().message.empty());
            }
        }
    }
}

TEST_CASE("STEP: files of other programs have the solids that they should", "[slow]") {
    if (!has_open_cascade()) FETTLE_SKIP("no Open CASCADE");
    FETTLE_NEEDS_SHARED();
    struct Expected {
        const char* file;
        std::size_t solids;
        double volume;  // [mm^3], exact
    };
    for (const Expected& each : {Expected{"as1-oc-214.stp", 18, 764'520},
                                 {"as1_pe_203.stp", 18, 1.25514e10},
                                 {"cube-in.step", 1, 1e9},
                                 {"cube-mm.step", 1, 1e9},
                                 {"cube-m.step", 1, 1e9},
                                 {"conical-surface.step", 1, 2518.885},
                                 {"dm1-oc-214.stp", 7, 108'454},
                                 {"planet_gear_sleeve_bearing-1.step", 1, 192.265},
                                 {"pin-1-1.STEP", 1, 87.1448},
                                 {"featuretype.STEP", 1, 190'447.66},
                                 {"box_sides.STEP", 10, 263'542},
                                 {"Passive_Horn_01.step", 1, 578.996},
                                 {"STS3215_03a.step", 1, 36'216.95}}) {
        const std::string path = fettle::tests::support::shared_file(std::string("files/step/") + each.file);
        const std::vector<Mesh> parts = parts_of(path);
        INFO(each.file);
        CHECK(parts.size() == each.solids);
        double volume = 0;
        for (const Mesh& part : parts) volume += volume_of(part);
        CHECK(volume == Approx(each.volume).epsilon(1e-3));
        check_samples(path, 100'000);
    }
}

}  // namespace fettle::core::mesh_files::step_reader_test
