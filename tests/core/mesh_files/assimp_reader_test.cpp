// SPDX-License-Identifier: MIT
// Formats that assimp reads: their units, placements and precision; and that whatever a file makes of assimp is an error here.
#include <assimp/cexport.h>
#include <assimp/cimport.h>
#include <assimp/scene.h>
#include <sys/wait.h>
#include <catch2/catch.hpp>

#include <new>
#include <thread>

#include "core/geometry/mass_moments.hpp"
#include "core/mesh_files/import_format.hpp"
#include "core/mesh_files/import_process.hpp"
#include "core/mesh_files/mesh_reader.hpp"
#include "core/mesh_files/mesh_writer.hpp"
#include "core/solids/mesh_validity.hpp"
#include "tests/support/box_mesh.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/text.hpp"

namespace fettle::core::mesh_files::assimp_reader_test {

using tests::support::contains;
using tests::support::contents;
using tests::support::replaced;
using tests::support::TemporaryFolder;

namespace {

/// A box of 1 x 2 x 3 of the file's unit, in one of assimp's formats.
std::string exported(const TemporaryFolder& folder, const char* format, const std::string& name) {
    const geometry::Mesh box = tests::support::box_mesh(Vector3::Zero(), {1e-3, 2e-3, 3e-3});  // OBJ is written in millimetres
    const std::string source = folder.write("source.obj", obj_text({{"brick", &box}}));
    const aiScene* scene = aiImportFile(source.c_str(), 0);
    REQUIRE(scene != nullptr);
    REQUIRE(aiExportScene(scene, format, folder.file(name).c_str(), 0) == aiReturn_SUCCESS);
    aiReleaseImport(scene);
    return folder.file(name);
}

void check_box(const std::string& path, const Vector3& size, double unit = 1) {
    INFO(path);
    const auto mesh = read_mesh(path, {unit, true});
    REQUIRE(mesh);
    CHECK(mesh->vertices.cols() == 8);
    CHECK(solids::validate_mesh(*mesh, {}).empty());
    const Vector3 found = mesh->vertices.rowwise().maxCoeff() - mesh->vertices.rowwise().minCoeff();
    CHECK((found - size).norm() < 1e-6 * size.norm());
    CHECK(geometry::solid_moments(mesh->vertices, mesh->triangles)(3, 3) == Approx(size.prod()).epsilon(1e-6));
}

std::string amf(const std::string& attributes, const std::string& last_corner = "3") {
    std::string text = "<?xml version=\"1.0\"?>\n<amf " + attributes + "><object id=\"1\"><mesh><vertices>\n";
    for (const char* x : {"<x>0</x><y>0</y><z>0</z>", "<x>1</x><y>0</y><z>0</z>", "<x>0</x><y>1</y><z>0</z>", "<x>0</x><y>0</y><z>1</z>"})
        text += std::string("<vertex><coordinates>") + x + "</coordinates></vertex>\n";
    text += "</vertices><volume>";
    for (const char* t : {"<v1>0</v1><v2>2</v2><v3>1</v3>", "<v1>0</v1><v2>1</v2><v3>3</v3>", "<v1>0</v1><v2>3</v2><v3>2</v3>"})
        text += std::string("<triangle>") + t + "</triangle>";
    return text + "<triangle><v1>1</v1><v2>2</v2><v3>" + last_corner + "</v3></triangle></volume></mesh></object></amf>\n";
}

/// For which assimp 5.2 looks for the end of the header for ever.
const std::string endless = "ply\nformat ascii 1.0\n";

}  // namespace

TEST_CASE("COLLADA, glTF, 3DS and AMF: each in its own unit, with the axes of the file") {
    const TemporaryFolder folder;
    const Vector3 size(1, 2, 3);
    // What has a unit is in it, whatever the reader is told.
    check_box(exported(folder, "gltf2", "a.gltf"), size, 17);
    check_box(exported(folder, "glb2", "a.GLB"), size, 17);
    check_box(exported(folder, "3ds", "a.3ds"), 0.5 * size, 0.5);
    const std::string collada = contents(exported(folder, "collada", "a.dae"));
    check_box(folder.file("a.dae"), size, 17);
    const std::string inches = replaced(collada, "<unit name=\"meter\" meter=\"1\" />", "<unit name=\"inch\" meter=\"0.0254\" />");
    check_box(folder.write("inches.dae", inches), 0.0254 * size);
    check_box(folder.write("z_up.dae", replaced(inches, "Y_UP", "Z_UP")), 0.0254 * size);
    for (const auto& [attributes, unit] : {std::pair{"unit=\"inch\"", 0.0254}, {"", 1e-3}, {"unit='feet'", 0.3048}}) {
        const auto mesh = read_mesh(folder.write("a.amf", amf(attributes)), {17, true});
        REQUIRE(mesh);
        CHECK(mesh->vertices.maxCoeff() == Approx(unit).epsilon(1e-12));
        CHECK(solids::validate_mesh(*mesh, {}).empty());
    }
    CHECK(contains(read_mesh(folder.write("a.amf", amf("unit=\"ell\""))).errors().front().message, "the unit `ell` must be millimeter"));
}

TEST_CASE("A mirrored node of glTF stays a solid, where it is placed, with its name") {
    const TemporaryFolder folder;
    std::string text = contents(exported(folder, "gltf2", "a.gltf"));
    const auto node = text.find("\"mesh\"");
    REQUIRE(node != std::string::npos);
    text.insert(node, "\"scale\": [-1, 1, 1], \"translation\": [10, 0, 0], ");
    check_box(folder.write("b.gltf", text), {1, 2, 3});
    const auto mesh = read_mesh(folder.file("b.gltf"));
    CHECK(mesh->vertices.row(0).minCoeff() > 5);
    CHECK(contains(mesh->shell_names.front(), "brick"));
}

TEST_CASE("What a file makes of assimp is an error: a wrong index, no end, no memory, an abort") {
    const TemporaryFolder folder;
    const auto fault = [&](const std::string& path) {
        const auto mesh = read_mesh(path);
        REQUIRE_FALSE(mesh);
        return mesh.errors().front().message;
    };
    CHECK(contains(fault(folder.write("a.amf", amf("", "9"))), "cannot be read: "));
    CHECK(contains(fault(folder.write("a.glb", "glTF")), "cannot be read: "));
    for (const char* empty : {"a.3ds", "empty.glb", "empty.gltf", "empty.dae", "empty.amf"})
        CHECK(contains(fault(folder.write(empty, "")), "is empty; export or download it again"));
    CHECK(contains(fault(folder.write("junk.gltf", "This is a letter.")), "its contents are not of the kind that its name says"));
    CHECK(contains(fault(folder.write("junk.dae", "junk")), "it is damaged or not XML"));
    const std::string path = folder.write("a.gltf", endless);  // by what is in it, not by its name
    const ImportOutcome slow = run_importer(Importer::assimp, path, {}, {1, 1 << 30, 1 << 30});
    CHECK(slow.end == ImportOutcome::End::out_of_time);
    const ImportOutcome large = run_importer(Importer::assimp, exported(folder, "glb2", "box.glb"), {}, {4, 1 << 30, 100});
    CHECK(large.end == ImportOutcome::End::too_large);
    const ImportOutcome good = run_importer(Importer::assimp, folder.file("box.glb"), {}, {4, 1 << 30, 1 << 30});
    CHECK(good.end == ImportOutcome::End::exited);
    CHECK(good.code == import_written);
    std::string vertices = "o a\n";  // 20 MB of text, for which assimp wants more than what is left of 64 MiB
    for (int i = 0; i < 1'000'000; ++i) vertices += "v 1.25 2.25 3.25\nv 1 2 3\n";
    const ImportOutcome poor =
        run_importer(Importer::assimp, folder.write("large.obj", vertices), {}, {4, std::uint64_t{64} << 20, 1 << 30});
    CHECK(poor.end == ImportOutcome::End::exited);
    CHECK(poor.code == import_out_of_memory);
}

TEST_CASE("An import ends when it is told to, or when what is asked throws, and leaves no process behind") {
    const TemporaryFolder folder;
    const std::string path = folder.write("a.gltf", endless);
    int asked = 0;
    const ImportOutcome stopped = run_importer(Importer::assimp, path, {}, {30, 1 << 30, 1 << 30}, [&] { return ++asked == 2; });
    CHECK(stopped.end == ImportOutcome::End::stopped);
    CHECK(::waitpid(-1, nullptr, WNOHANG) == -1);
    const auto throws = [&] { run_importer(Importer::assimp, path, {}, {30, 1 << 30, 1 << 30}, []() -> bool { throw std::bad_alloc(); }); };
    CHECK_THROWS_AS(throws(), std::bad_alloc);
    CHECK(::waitpid(-1, nullptr, WNOHANG) == -1);
    const auto mesh = read_mesh(path, {1, true, [] { return true; }});
    REQUIRE_FALSE(mesh);
    CHECK(contains(mesh.errors().front().message, "stopped on request"));
}

TEST_CASE("A face of glTF that names no vertex is refused, not left out") {
    const TemporaryFolder folder;
    exported(folder, "gltf2", "a.gltf");  // whose indices, of 32 bits, stand in a.bin, behind the coordinates
    std::string bytes = contents(folder.file("a.bin"));
    REQUIRE(bytes.size() >= 4);
    bytes[bytes.size() - 4] = 'z';
    folder.write("a.bin", bytes);
    const auto mesh = read_mesh(folder.file("a.gltf"));
    REQUIRE_FALSE(mesh);
    CHECK(contains(mesh.errors().front().message, "names a vertex that is not there"));
}

TEST_CASE("What places more than ten million vertices and triangles is refused where it is read") {
    const TemporaryFolder folder;
    std::string roots, nodes;  // a thousand times 9999 vertices and 3333 triangles, from 130 kB
    for (int i = 0; i < 1000; ++i) {
        roots += (i > 0 ? "," : "") + std::to_string(i);
        nodes += i > 0 ? R"(,{"mesh":0})" : R"({"mesh":0})";
    }
    folder.write("a.bin", std::string(12 * 9999, '\0'));
    const std::string text = R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[)" + roots + R"(]}],"nodes":[)" + nodes +
                             R"(],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"accessors":[{"bufferView":0,)" +
                             R"("componentType":5126,"count":9999,"type":"VEC3","min":[0,0,0],"max":[0,0,0]}],)" +
                             R"("bufferViews":[{"buffer":0,"byteLength":119988}],"buffers":[{"byteLength":119988,"uri":"a.bin"}]})";
    const auto mesh = read_mesh(folder.write("a.gltf", text));
    REQUIRE_FALSE(mesh);
    CHECK(mesh.errors().front().code == base::ErrorCode::out_of_range);
    CHECK(contains(mesh.errors().front().message, "places more than 10 million vertices and triangles"));
}

TEST_CASE("Files are imported from several threads at once, and no process is left behind") {
    const TemporaryFolder folder;
    const std::string path = exported(folder, "glb2", "a.glb");
    std::vector<std::size_t> triangles(8);
    std::vector<std::thread> threads;
    for (std::size_t& count : triangles) threads.emplace_back([&] { count = read_mesh(path).value().triangles.size(); });
    for (std::thread& thread : threads) thread.join();
    CHECK(triangles == std::vector<std::size_t>(8, 12));
    CHECK(::waitpid(-1, nullptr, WNOHANG) == -1);
}

}  // namespace fettle::core::mesh_files::assimp_reader_test
