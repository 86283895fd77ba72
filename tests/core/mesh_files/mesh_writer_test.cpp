// SPDX-License-Identifier: MIT
// STL, OBJ and 3MF as written, read back by our readers, by assimp and by minizip.
#include <assimp/cimport.h>
#include <assimp/scene.h>

#include <minizip/unzip.h>

#include <catch2/catch.hpp>
#include <fstream>
#include <random>

#include "core/mesh_files/mesh_reader.hpp"
#include "core/mesh_files/mesh_writer.hpp"
#include "core/mesh_files/millimetres.hpp"
#include "core/mesh_files/zip_archive.hpp"
#include "core/solids/mesh_validity.hpp"
#include "tests/support/box_mesh.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/text.hpp"

namespace fettle::core::mesh_files::mesh_writer_test {

namespace {

using geometry::Mesh;
using tests::support::box_mesh;
using tests::support::contains;
using tests::support::TemporaryFolder;

/// Coordinates without short decimals, so that rounding shows.
Mesh awkward_box(double size) { return box_mesh(Vector3(-1 / 3.0, 0.1, 1e-7) * size, Vector3(0.7, 1 / 1.7, 2 / 3.0) * size); }

MeshPart placed(const std::string& name, const Mesh& mesh, const Colour& colour = {1, 2, 3}) {
    MeshPart part{name, &mesh, colour};
    part.rotation = Eigen::AngleAxisd(0.3, Vector3(1, 2, 3).normalized()).toRotationMatrix();
    part.position = Vector3(0.1, -0.2, 1 / 3.0);
    return part;
}

}  // namespace

TEST_CASE("Millimetres: decimals that a reader scales back to the same double") {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> number(-0.3, 0.3);
    int same = 0, near = 0;
    constexpr int count = 20000;
    for (int i = 0; i < count; ++i) {
        const double x = number(random), back = std::stod(millimetres(x)) * 1e-3;
        same += back == x ? 1 : 0;
        near += std::abs(back - x) <= 3e-16 * std::abs(x) ? 1 : 0;
    }
    CHECK(near == count);
    CHECK(same > count * 9 / 10);
    CHECK(millimetres(0.03) == "30");
    CHECK(millimetres(-0.0003) == "-0.3");
    CHECK(millimetres(0) == "0");
}

TEST_CASE("3MF: objects in their own frames with names and colours, build items that place them") {
    const TemporaryFolder folder;
    const Mesh box = awkward_box(0.04), other = box_mesh(Vector3(0, 0, 0), Vector3(0.01, 0.01, 0.01));
    const MeshPart first = placed("wheel & \"axle\" <1>", box), second{"lid", &other, {255, 0, 16}};
    const Result<std::string> bytes = threemf_bytes({first, second});
    REQUIRE(bytes);
    const std::string path = folder.write("a.3mf", *bytes);
    const auto parts = read_mesh_parts(path);
    REQUIRE(parts);
    REQUIRE(parts->size() == 2);
    CHECK((*parts)[0].name == first.name);
    CHECK((*parts)[1].name == "lid");
    CHECK((*parts)[1].vertices == other.vertices);  // placed nowhere: to the bit
    CHECK((*parts)[1].triangles == other.triangles);
    const Matrix3X there = (first.rotation * box.vertices).colwise() + first.position;
    CHECK(((*parts)[0].vertices - there).cwiseAbs().maxCoeff() < 1e-16);
    CHECK((*parts)[0].triangles == box.triangles);
    const auto whole = read_mesh(path);
    REQUIRE(whole);
    CHECK(whole->vertices.cols() == 16);
    CHECK(whole->shell_names == std::vector<std::string>{first.name, "lid"});

    const auto archive = ZipArchive::open(*bytes, "a.3mf");
    REQUIRE(archive);
    const std::string model = archive->unpacked("3D/3dmodel.model", 1 << 30).value();
    CHECK(contains(model, "unit=\"millimeter\""));
    CHECK(contains(model, "displaycolor=\"#010203\""));
    CHECK(contains(model, "displaycolor=\"#FF0010\""));
    CHECK(contains(model, "pid=\"1\" pindex=\"1\""));
    CHECK(archive->unpacked("[Content_Types].xml", 1 << 30).has_value());
    CHECK(bytes->substr(0, 4) == "PK\3\4");
}

TEST_CASE("3MF: what is open is a surface, what has no triangle is left out") {
    Mesh open = awkward_box(0.02);
    open.triangles.pop_back();
    geometry::build_connectivity(open);
    Mesh wire;
    wire.vertices = Matrix3X::Identity(3, 3);
    geometry::build_connectivity(wire, {{0, 1}, {1, 2}});
    const Mesh closed = awkward_box(0.01);
    const auto bytes = threemf_bytes({{"open", &open}, {"wire", &wire}, {"closed", &closed}});
    REQUIRE(bytes);
    const std::string model = ZipArchive::open(*bytes, "").value().unpacked("3D/3dmodel.model", 1 << 30).value();
    CHECK(contains(model, "type=\"surface\" name=\"open\""));
    CHECK(contains(model, "type=\"model\" name=\"closed\""));
    CHECK_FALSE(contains(model, "wire"));
    CHECK(threemf_bytes({{"wire", &wire}}).errors().front().code == ErrorCode::mesh_invalid);
}

TEST_CASE("Zip: minizip unpacks what was packed, and equal entries make equal archives") {
    const TemporaryFolder folder;
    const std::vector<ZipEntry> entries{
        {"a/b.txt", std::string(100000, 'x') + "end"}, {"empty", ""}, {"3D/\xc3\xa4.model", "\x01\x02 text"}};
    const std::string bytes = zipped(entries);
    CHECK(bytes.size() < 2000);
    CHECK(zipped(entries) == bytes);
    unzFile file = unzOpen64(folder.write("a.zip", bytes).c_str());
    REQUIRE(file != nullptr);
    int code = unzGoToFirstFile(file);
    for (const ZipEntry& entry : entries) {
        REQUIRE(code == UNZ_OK);
        char name[100];
        unz_file_info64 info;
        REQUIRE(unzGetCurrentFileInfo64(file, &info, name, sizeof name, nullptr, 0, nullptr, 0) == UNZ_OK);
        CHECK(name == entry.name);
        REQUIRE(unzOpenCurrentFile(file) == UNZ_OK);
        std::string text(info.uncompressed_size, '\0');
        CHECK(unzReadCurrentFile(file, text.data(), static_cast<unsigned>(text.size())) == count_of(text));
        CHECK(unzCloseCurrentFile(file) == UNZ_OK);  // checks the checksum
        CHECK(text == entry.contents);
        code = unzGoToNextFile(file);
    }
    CHECK(code == UNZ_END_OF_LIST_OF_FILE);
    unzClose(file);
}

TEST_CASE("STL: read by us and by assimp alike, in millimetres, rounded as it says") {
    const TemporaryFolder folder;
    const Mesh box = awkward_box(0.1), other = awkward_box(0.02);
    const std::vector<MeshPart> parts{placed("a", box), {"b", &other}};
    const auto read = read_mesh(folder.write("a.stl", stl_bytes(parts)), {1e-3});
    REQUIRE(read);
    REQUIRE(read->vertices.cols() == 16);
    CHECK(read->triangles.size() == 24);
    CHECK(solids::validate_mesh(*read, {}).empty());
    const aiScene* scene = aiImportFile(folder.file("a.stl").c_str(), 0);
    REQUIRE(scene != nullptr);
    int corners = 0;
    for (unsigned m = 0; m < scene->mNumMeshes; ++m) {
        for (unsigned v = 0; v < scene->mMeshes[m]->mNumVertices; ++v, ++corners) {
            const aiVector3D& x = scene->mMeshes[m]->mVertices[v];
            CHECK((read->vertices.colwise() - 1e-3 * Vector3(x.x, x.y, x.z)).colwise().norm().minCoeff() == 0);
        }
    }
    aiReleaseImport(scene);
    CHECK(corners == 72);
    double largest = 0;
    for (const auto& x : read->vertices.colwise()) {
        double nearest = 1;
        for (const MeshPart& part : parts)
            for (const auto& v : part.mesh->vertices.colwise()) nearest = std::min(nearest, (part.rotation * v + part.position - x).norm());
        largest = std::max(largest, nearest);
    }
    CHECK(largest == Approx(stl_rounding(parts)).epsilon(1e-6));
    CHECK(largest > 1e-12);
    CHECK(largest < 1e-7);
}

TEST_CASE("OBJ: parts by name, loose edges and points too") {
    const TemporaryFolder folder;
    const Mesh box = awkward_box(0.1);
    Mesh wire;
    wire.vertices = Matrix3X::Zero(3, 3);
    wire.vertices.row(0) << 1, 2, 3;
    geometry::build_connectivity(wire, {{0, 1}});
    const std::vector<MeshPart> parts{{"two words", &box}, {"wire", &wire}};
    const std::string text = obj_text(parts, "a.mtl");
    CHECK(contains(text, "o two_words\nusemtl two_words\n"));
    CHECK(contains(mtl_text(parts), "newmtl two_words\nKd 0.5020"));
    const auto read = read_mesh(folder.write("a.obj", text), {1e-3});
    REQUIRE(read);
    REQUIRE(read->vertices.cols() == 11);
    CHECK((read->vertices.leftCols(8) - box.vertices).cwiseAbs().maxCoeff() < 1e-16);
    CHECK(read->triangles == box.triangles);
    CHECK(read->edges.back() == geometry::Edge{8, 9});
    CHECK(read->codimensional_points == std::vector<int>{10});
    CHECK(read->shell_names == std::vector<std::string>{"two_words"});
}

TEST_CASE("Parts of a file that is no 3MF are one, called as it is") {
    const TemporaryFolder folder;
    const Mesh box = awkward_box(0.1);
    const auto parts = read_mesh_parts(folder.write("bracket.obj", obj_text({{"x", &box}})), {1e-3});
    REQUIRE(parts);
    REQUIRE(parts->size() == 1);
    CHECK(parts->front().name == "bracket");
    CHECK(read_mesh_parts(folder.file("none.3mf")).errors().front().code == ErrorCode::file_not_found);
}

}  // namespace fettle::core::mesh_files::mesh_writer_test
