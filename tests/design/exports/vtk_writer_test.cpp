// SPDX-License-Identifier: MIT
// VTU as written, decoded by a reader of its own: header, offsets, blocks, numbers.
#include "design/exports/vtk_writer.hpp"

#include <zlib.h>

#include <catch2/catch.hpp>
#include <cstring>
#include <map>

#include "core/mesh_files/xml_reader.hpp"
#include "tests/support/box_mesh.hpp"
#include "tests/support/text.hpp"

namespace fettle::design::exports::vtk_writer_test {

namespace {

using tests::support::box_mesh;

struct Decoded {
    std::map<std::string, std::string> arrays;  ///< by name: their bytes
    int points = 0, cells = 0;
};

std::uint64_t word_at(const std::string& bytes, std::size_t at) {
    std::uint64_t word = 0;
    REQUIRE(at + 8 <= bytes.size());
    std::memcpy(&word, bytes.data() + at, 8);
    return word;
}

std::string inflated_array(const std::string& bytes, std::size_t at) {
    const std::uint64_t blocks = word_at(bytes, at), size = word_at(bytes, at + 8), last = word_at(bytes, at + 16);
    std::size_t data = at + 24 + 8 * blocks;
    std::string out;
    for (std::uint64_t b = 0; b < blocks; ++b) {
        const std::uint64_t packed = word_at(bytes, at + 24 + 8 * b);
        uLongf wanted = b + 1 == blocks && last > 0 ? last : size;
        std::string block(wanted, '\0');
        REQUIRE(uncompress(reinterpret_cast<Bytef*>(block.data()), &wanted, reinterpret_cast<const Bytef*>(bytes.data() + data), packed) ==
                Z_OK);
        REQUIRE(wanted == block.size());
        out += block;
        data += packed;
    }
    return out;
}

Decoded decoded(const std::string& bytes) {
    const std::size_t marker = bytes.find("<AppendedData encoding=\"raw\">\n_");
    REQUIRE(marker != std::string::npos);
    const std::size_t appended = bytes.find('_', marker) + 1;
    const std::string head = bytes.substr(0, marker) + "</VTKFile>";
    core::mesh_files::XmlReader xml(head, "vtu");
    Decoded out;
    xml.read([&] {
        if (!xml.opens()) return;
        const auto attribute = [&](const char* name) { return std::string(xml.attribute(name).value()); };
        if (xml.name() == "Piece") {
            out.points = std::stoi(attribute("NumberOfPoints"));
            out.cells = std::stoi(attribute("NumberOfCells"));
        }
        if (xml.name() != "DataArray") return;
        CHECK(attribute("format") == "appended");
        out.arrays[attribute("Name")] = inflated_array(bytes, appended + std::stoul(attribute("offset")));
    });
    CHECK(xml.errors().empty());
    return out;
}

template <class Number>
std::vector<Number> numbers(const std::string& bytes) {
    std::vector<Number> out(bytes.size() / sizeof(Number));
    std::memcpy(out.data(), bytes.data(), bytes.size());
    return out;
}

}  // namespace

TEST_CASE("VTU: points of all parts in the world, triangles, loose edges and points, parts by number") {
    Assembly assembly;
    AssemblyPart box{"box", {}, box_mesh({0, 0, 0}, {1, 2, 3}), Vector3::Zero(), true}, wire{"wire & rest", {}, {}, Vector3::Zero(), false};
    wire.mesh.vertices = Matrix3X::Identity(3, 3);
    core::geometry::build_connectivity(wire.mesh, {{0, 1}});
    assembly.parts = {box, wire};
    const core::kinematics::Pose start, moved{Eigen::AngleAxisd(0.5, Vector3::UnitY()).toRotationMatrix(), Vector3(5, 6, 7)};
    assembly.keyframes = {{0, true, {start, start}}, {0.5, true, {moved, start}}};
    const Decoded read = decoded(vtu_bytes(assembly, assembly.keyframes[1]));
    CHECK(read.points == 11);
    CHECK(read.cells == 14);
    const auto points = numbers<double>(read.arrays.at("Points")), displacement = numbers<double>(read.arrays.at("displacement"));
    REQUIRE(points.size() == 33);
    for (int i = 0; i < 8; ++i) {
        const Vector3 X = box.mesh.vertices.col(i), now = moved.rotation * X + moved.position;
        for (int k = 0; k < 3; ++k) {
            CHECK(points[3 * i + k] == now[k]);
            CHECK(displacement[3 * i + k] == now[k] - X[k]);
        }
    }
    const auto corners = numbers<std::int64_t>(read.arrays.at("connectivity")), ends = numbers<std::int64_t>(read.arrays.at("offsets"));
    REQUIRE(corners.size() == 36 + 2 + 1);
    for (std::size_t t = 0; t < 12; ++t)
        for (std::size_t k = 0; k < 3; ++k) CHECK(corners[3 * t + k] == box.mesh.triangles[t][k]);
    CHECK(std::vector<std::int64_t>(corners.end() - 3, corners.end()) == std::vector<std::int64_t>{8, 9, 10});
    CHECK(ends.back() == 39);
    CHECK(ends[11] == 36);
    CHECK(numbers<unsigned char>(read.arrays.at("types")).back() == 1);
    CHECK(numbers<unsigned char>(read.arrays.at("types"))[12] == 3);
    CHECK(numbers<std::int32_t>(read.arrays.at("part"))[11] == 0);
    CHECK(numbers<std::int32_t>(read.arrays.at("part"))[12] == 1);
    CHECK(read.arrays.at("part_names") == "box\nwire & rest");
}

TEST_CASE("VTU: arrays of more than one block; a collection names its frames") {
    Assembly assembly;
    AssemblyPart many{"many", {}, {}, Vector3::Zero(), false};
    many.mesh.vertices = Matrix3X::Random(3, 5000);
    core::geometry::build_connectivity(many.mesh);
    assembly.parts = {many};
    assembly.keyframes = {{0, true, {core::kinematics::Pose{}}}};
    const Decoded read = decoded(vtu_bytes(assembly, assembly.keyframes[0]));
    const auto points = numbers<double>(read.arrays.at("Points"));
    REQUIRE(points.size() == 15000);
    CHECK(std::equal(points.begin(), points.end(), many.mesh.vertices.data()));
    CHECK(tests::support::contains(pvd_text({{0.25, "a_0001.vtu"}}), "<DataSet timestep=\"0.25\" part=\"0\" file=\"a_0001.vtu\"/>"));
}

}  // namespace fettle::design::exports::vtk_writer_test
