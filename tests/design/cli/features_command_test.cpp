// SPDX-License-Identifier: MIT
// `fettle features` from outside: parts of the kernel as files, text, JSON, refusals.
#include <catch2/catch.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/mesh_files/mesh_writer.hpp"
#include "tests/core/features/known_parts.hpp"
#include "tests/support/program.hpp"
#include "tests/support/shared_files.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fettle::design::cli::features_command_test {

using namespace core::features::known_parts;  // NOLINT(google-build-using-namespace)
using fettle::tests::support::run;
using fettle::tests::support::TemporaryFolder;
using Json = nlohmann::json;

namespace {

// A plate with a bore of 2.1 mm across which a pin of 2 mm stands, both with corners on the circles.
struct PinInPlate : TemporaryFolder {
    std::string plate, pin;
    PinInPlate() {
        Facets facets;
        facets.lean = Lean::through;
        Drawing drawing(facets);
        const Profile with_bore =
            *with_hole(*filled(rectangle({-10 * mm, -10 * mm}, 20 * mm, 20 * mm, "plate")), circle({}, 2.1 * mm, "bore"));
        plate = written("plate", drawing, *extruded(drawing, with_bore, 0, 6 * mm));
        pin = written("pin", drawing, *extruded(drawing, *filled(circle({}, 2 * mm, "pin")), -3 * mm, 9 * mm));
    }
    std::string written(const std::string& name, const Drawing& drawing, const Solid& solid) {
        const core::geometry::Mesh mesh = drawn(drawing, solid, name, {false})->mesh;
        return write(name + ".stl", core::mesh_files::stl_bytes({{name, &mesh}}));
    }
};

}  // namespace

TEST_CASE("features: a pin in a plate, its play, and for which processes it is enough") {
    const PinInPlate files;
    const std::string both = "features " + files.plate + " " + files.pin + " --unit mm";
    const auto text = run(both);
    CAPTURE(text.out);
    CHECK(text.code == 0);
    CHECK(text.says("B1 bore d 4.2, z 0..6 on (0, 0, -), through"));
    CHECK(text.says("P1 pin d 4, z -3..9 on (0, 0, -)"));
    CHECK(text.says("pin.P1 in plate.B1: 0.09"));
    CHECK(text.says("per side, concentric, proven"));
    CHECK(text.says("too little for fdm ("));
    const auto answer = run(both + " --json --triangles");
    CAPTURE(answer.out);
    const Json json = answer.json();
    CHECK(json["status"] == "ok");
    const Json bore = json["bodies"][0]["features"][0];
    CHECK(bore["name"] == "B1");
    CHECK(bore["kind"] == "cylinder");
    CHECK(bore["side"] == "hole");
    CHECK(bore["radius"].get<double>() == Approx(2.1e-3));
    CHECK(bore["length"].get<double>() == Approx(6e-3));
    CHECK(bore["covered"].get<double>() == Approx(2 * std::numbers::pi));
    CHECK(bore["through"] == true);
    CHECK(bore["source"] == "fitted");
    CHECK(bore["triangles"].size() == bore["triangle_count"].get<std::size_t>());
    CHECK(bore["facets"]["least"].get<double>() == Approx(2.1e-3 * std::cos(std::numbers::pi / 48)));
    REQUIRE(json["fits"].size() == 1);
    const Json fit = json["fits"][0];
    CHECK(fit["pin"]["feature"] == "P1");
    CHECK(fit["hole"]["body"] == "plate");
    CHECK(fit["play"]["surfaces"].get<double>() == Approx(1e-4).margin(1e-8));
    CHECK(fit["centred"] == true);
    CHECK(fit["gap"]["proven"] == true);
    CHECK(fit["gap"]["lower"].get<double>() <= 1e-4);
    CHECK(fit["gap"]["lower"].get<double>() > 9e-5);
    CHECK(run(both + " --process fdm").code == 1);
    CHECK(run(both + " --process cnc --json").json()["fits"][0]["processes"].size() == 1);
}

TEST_CASE("features: what cannot be taken is refused by its name") {
    const PinInPlate files;
    CHECK(run("features " + files.pin).code == 3);  // no unit
    const auto process = run("features " + files.pin + " --unit mm --process fdn", true);
    CHECK(process.code == 3);
    CHECK(process.says("fdm"));
    CHECK(run("features " + files.pin + " --unit mm --tolerance -1mm").code == 3);
    CHECK(run("features " + files.pin + " --unit mm --tolerance 1").code == 3);
    CHECK(run("features " + files.file("nothing.stl") + " --unit mm").code == 3);
}

TEST_CASE("features: a stranger's box, its hinge pin and lid") {
    FETTLE_NEEDS_SHARED();
    const std::filesystem::path folder = fettle::tests::support::shared_folder() / "found/stranger_box";
    if (!std::filesystem::exists(folder)) FETTLE_SKIP("no such folder: " << folder);
    const auto at = [&](const char* name) { return " " + (folder / name).string(); };
    const auto text = run("features" + at("base.stl") + at("lid.stl") + at("pin.stl") + " --unit mm");
    CAPTURE(text.out);
    CHECK(text.says("B1 bore d 4.2, x 6..14 on (-, 44, 20), through"));
    CHECK(text.says("B2 bore d 4.2, x 46..54 on (-, 44, 20), through"));
    CHECK(text.says("B1 bore d 4.2, x 14.4..45.6 on (-, 44, 20), through"));
    CHECK(text.says("P2 pin d 4, x 5..55 on (-, 44, 20)"));
    CHECK(text.says("pin.P2 in base.B1, base.B2, lid.B1: 0.09"));
}

TEST_CASE("features: a part with 49 flat faces and 46 faces of cylinders, many of them two halves") {
    FETTLE_NEEDS_SHARED();
    const std::filesystem::path file = fettle::tests::support::shared_folder() / "files/mesh/featuretype.STL";
    if (!std::filesystem::exists(file)) FETTLE_SKIP("no such file: " << file);
    const Json json = run("features " + file.string() + " --unit in --json").json();
    int planes = 0, bores = 0, roundings = 0, others = 0;
    for (const Json& feature : json["bodies"][0]["features"]) {
        const std::string role = feature["role"];
        ++(role == "plane" ? planes : role == "bore" ? bores : role == "fillet" || role == "rounding" ? roundings : others);
    }
    CHECK(planes == 49);
    CHECK(2 * bores + roundings == 46);
    CHECK(others == 0);
}

}  // namespace fettle::design::cli::features_command_test
