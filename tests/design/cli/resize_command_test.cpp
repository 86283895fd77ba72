// SPDX-License-Identifier: MIT
// `fettle resize` and `fettle stretch` from outside: files that are written, refusals.
#include <catch2/catch.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/features/find_features.hpp"
#include "core/mesh_files/mesh_reader.hpp"
#include "core/mesh_files/mesh_writer.hpp"
#include "tests/core/features/known_parts.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fettle::design::cli::resize_command_test {

using namespace core::features::known_parts;  // NOLINT(google-build-using-namespace)
using fettle::tests::support::run;
using fettle::tests::support::TemporaryFolder;

namespace {

// A block of 40 x 20 x 6 mm with bores of 4 mm at its middle and of 2 mm at x = 14 mm.
struct Block : TemporaryFolder {
    std::string path;
    Block() {
        const core::geometry::Mesh mesh = drawn_mesh([](Drawing& d) {
            const auto profile = with_holes(*filled(rectangle({-20 * mm, -10 * mm}, 40 * mm, 20 * mm, "block")),
                                            {circle({}, 4 * mm, "middle"), circle({14 * mm, 0}, 2 * mm, "side")});
            return extruded(d, *profile, 0, 6 * mm);
        });
        path = write("block.stl", core::mesh_files::stl_bytes({{"block", &mesh}}));
    }
    core::geometry::Mesh made(const std::string& name) const {
        auto mesh = core::mesh_files::read_mesh(file(name), {.unit = 1e-3});
        REQUIRE(mesh);
        return *std::move(mesh);
    }
};

double radius_of(const core::geometry::Mesh& mesh, const std::string& name) {
    const auto found = core::features::find_features(mesh);
    REQUIRE(found.find(name) >= 0);
    return found.features[found.find(name)].surface.radius;
}

}  // namespace

TEST_CASE("resize: bores and faces have what is asked for, in each format") {
    const Block block;
    for (const std::string extension : {".stl", ".3mf", ".obj"}) {
        const auto answer =
            run("resize " + block.path + " --unit mm --diameter B1=9mm --radius B2=1.5mm --offset F1=1mm --wall 0.5mm --to " +
                block.file("out" + extension) + " --json");
        CAPTURE(extension, answer.out);
        REQUIRE(answer.code == 0);
        CHECK(answer.json()["changes"].size() == 3);
        const auto mesh = block.made("out" + extension);
        CHECK(radius_of(mesh, "B1") == Approx(4.5 * mm).epsilon(1e-5));
        CHECK(radius_of(mesh, "B2") == Approx(1.5 * mm).epsilon(1e-5));
    }
}

TEST_CASE("stretch: the part is longer, and what lies beyond moves along") {
    const Block block;
    const auto answer =
        run("stretch " + block.path + " --unit mm --along x --from 5mm --upto 11mm --by 3mm --to " + block.file("out.stl") + " --json");
    CAPTURE(answer.out);
    REQUIRE(answer.code == 0);
    CHECK(answer.json()["after"]["size"][0] == Approx(43 * mm));
    CHECK(block.made("out.stl").vertices.row(0).maxCoeff() == Approx(23 * mm));
}

TEST_CASE("resize and stretch: what cannot be is refused, and nothing is written") {
    const Block block;
    const std::vector<std::pair<std::string, std::string>> refused{
        {"resize FILE --unit mm", "--diameter B1=4.4mm"},
        {"resize FILE --unit mm --diameter B1", "features and a length are expected"},
        {"resize FILE --unit mm --diameter B1=9", "unit"},
        {"resize FILE --unit mm --diameter B7=9mm", "the mesh has no feature `B7`"},
        {"resize FILE --unit mm --diameter B1,B2=9mm", "a handle is of one radius"},
        {"resize FILE --unit mm --diameter B1=26mm", "B1"},
        {"resize FILE --unit mm --diameter B1=18mm --wall 2mm", "a wall of "},
        {"resize FILE --unit mm --diameter B1=9mm --body other", "there is no body 'other'"},
        {"resize FILE --diameter B1=9mm", "--unit"},
        {"stretch FILE --unit mm --along x --from 13mm --upto 15mm --by 2mm", "would bend"},
        {"stretch FILE --unit mm --along x --from 15mm --upto 13mm --by 2mm", "more than --from"}};
    for (const auto& [command, words] : refused) {
        std::string line = command;
        line.replace(line.find("FILE"), 4, block.path);
        const auto answer = run(line + " --to " + block.file("out.stl"), true);
        CAPTURE(line, answer.out);
        CHECK(answer.code == 3);
        CHECK(answer.out.find(words) != std::string::npos);
        CHECK_FALSE(std::filesystem::exists(block.file("out.stl")));
    }
    CHECK(run("resize " + block.path + " --unit mm --diameter B1=9mm --to " + block.file("out.step"), true).code == 3);
    CHECK(run("resize " + block.path + " --unit mm --diameter B1=9mm --to " + block.path, true).code == 3);
}

}  // namespace fettle::design::cli::resize_command_test
