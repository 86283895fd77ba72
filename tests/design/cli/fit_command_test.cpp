// SPDX-License-Identifier: MIT
// `fettle fit` from outside: changes, proofs of the files as written, refusals.
#include <catch2/catch.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/mesh_files/mesh_reader.hpp"
#include "core/mesh_files/mesh_writer.hpp"
#include "tests/core/features/known_parts.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fettle::design::cli::fit_command_test {

using namespace core::features::known_parts;  // NOLINT(google-build-using-namespace)
using fettle::tests::support::run;
using fettle::tests::support::TemporaryFolder;
using Json = nlohmann::json;

namespace {

// A pin of 2 mm through two plates, with 0.1 mm of play in one and 0.6 mm in the other; the plates are `wall` mm wider than 2.7 mm all
// round.
struct Hinge : TemporaryFolder {
    std::string files;
    explicit Hinge(double wall = 5) {
        Facets facets;
        facets.lean = Lean::through;
        const auto plate = [&](const std::string& name, double radius, double low, double high) {
            Drawing drawing(facets);
            const double half = (2.7 + wall) * mm;
            const Profile profile =
                *with_hole(*filled(rectangle({-half, -half}, 2 * half, 2 * half, "plate")), circle({}, radius * mm, "bore"));
            write_part(name, drawing, *extruded(drawing, profile, low * mm, high * mm));
        };
        plate("tight", 2.1, 0, 5);
        plate("loose", 2.6, 6, 10);
        Drawing drawing(facets);
        write_part("pin", drawing, *extruded(drawing, *filled(circle({}, 2 * mm, "pin")), -1 * mm, 11 * mm));
    }
    void write_part(const std::string& name, const Drawing& drawing, const Solid& solid) {
        const core::geometry::Mesh mesh = drawn(drawing, solid, name, {false})->mesh;
        files += " " + write(name + ".stl", core::mesh_files::stl_bytes({{name, &mesh}}));
    }
    Json fitted(const std::string& more) const {
        const auto answer = run("fit" + files + " --unit mm --to " + file("out") + " --json " + more);
        CAPTURE(answer.out);
        CHECK(answer.code == 0);
        return answer.json();
    }
};

Json fit_in(const Json& answer, const std::string& hole) {
    for (const Json& fit : answer["fits"])
        if (fit["fit"] == "pin.P1 in " + hole) return fit;
    return nullptr;
}

}  // namespace

TEST_CASE("fit: the bore that is too tight is opened, and the play is proven of what was written") {
    const Hinge hinge;
    const Json answer = hinge.fitted("--clearance 0.3mm");
    REQUIRE(answer["changes"].size() == 1);
    CHECK(answer["changes"][0]["feature"] == "tight.B1");
    CHECK(answer["changes"][0]["radius"].get<double>() == Approx(2.3e-3).margin(0.02e-3));
    CHECK(answer["changes"][0]["wall"].get<double>() == Approx(5.4e-3).margin(0.05e-3));
    const Json fit = fit_in(answer, "tight.B1");
    CHECK(fit["before"].get<double>() == Approx(0.1e-3).margin(0.01e-3));
    for (const char* proven : {"assembled", "turned"}) {
        CHECK(fit[proven].get<double>() >= 0.3e-3);
        CHECK(fit[proven].get<double>() < 0.32e-3);
    }
    CHECK(fit["enough"] == true);
    // Parts without a change have the coordinates of before, bit for bit.
    for (const std::string name : {"loose.stl", "pin.stl"}) {
        const auto before = core::mesh_files::read_mesh(hinge.file(name)), after = core::mesh_files::read_mesh(hinge.file("out/" + name));
        REQUIRE((before && after));
        CHECK(after->triangles == before->triangles);
        CHECK(after->vertices == before->vertices);
    }
    // Clearance, which knows nothing of features, agrees.
    CHECK(run("clearance " + hinge.file("out") + " --unit mm --pairs pin:tight --minimum 0.3mm").code == 0);
    CHECK(run("clearance " + hinge.file("out") + " --unit mm --pairs pin:tight --minimum 0.32mm").code == 1);
    // Once more: there is nothing to do.
    const auto again = run("fit " + hinge.file("out") + " --unit mm --clearance 0.3mm --to " + hinge.file("again"));
    CHECK(again.code == 0);
    CHECK(again.says("nothing to change"));
}

TEST_CASE("fit: pins, both, closing, a process") {
    const Hinge hinge;
    const Json pins = hinge.fitted("--clearance 0.3mm --change pins");
    REQUIRE(pins["changes"].size() == 1);
    CHECK(pins["changes"][0]["feature"] == "pin.P1");
    CHECK(pins["changes"][0]["radius"].get<double>() == Approx(1.8e-3).margin(0.02e-3));
    const Json both = hinge.fitted("--clearance 0.3mm --change both");
    CHECK(both["changes"].size() == 2);
    CHECK(fit_in(both, "tight.B1")["turned"].get<double>() >= 0.3e-3);
    const Json closed = hinge.fitted("--clearance 0.3mm --close");
    CHECK(closed["changes"].size() == 2);
    CHECK(fit_in(closed, "loose.B1")["turned"].get<double>() >= 0.3e-3);
    CHECK(fit_in(closed, "loose.B1")["turned"].get<double>() < 0.32e-3);
    // More play than a quarter of the bore, which would be no fit any more: judged all the same.
    const Json wide = hinge.fitted("--clearance 0.9mm");
    CHECK(fit_in(wide, "tight.B1")["turned"].get<double>() >= 0.9e-3);
    const Json fdm = hinge.fitted("--process fdm");
    for (const Json& fit : fdm["fits"]) {
        CHECK(fit["required"].get<double>() > 0.3e-3);
        CHECK(fit["assembled"].get<double>() >= fit["required"].get<double>());
    }
}

TEST_CASE("fit: what cannot be done is refused, and nothing is written") {
    const Hinge thin(0.5);
    const auto through = run("fit" + thin.files + " --unit mm --clearance 1.5mm --to " + thin.file("out"), true);
    CAPTURE(through.out);
    CHECK(through.code == 3);
    CHECK(through.says("tight.B1: "));
    CHECK_FALSE(std::filesystem::exists(thin.file("out")));
    for (const auto& [arguments, says] : std::vector<std::pair<std::string, std::string>>{
             {thin.files + " --unit mm", "--process"},
             {thin.files + " --unit mm --clearance 0mm", "greater than 0"},
             {thin.files + " --unit mm --clearance 0.3mm --change walls", "walls"},
             {thin.files + " --clearance 0.3mm", "--unit mm"},
             {" " + thin.file("tight.stl") + " --unit mm --clearance 0.3mm", "no pin sits in a bore"},
         }) {
        const auto answer = run("fit" + arguments + " --to " + thin.file("out"), true);
        CAPTURE(arguments, answer.out);
        CHECK(answer.code != 0);
        CHECK(answer.says(says));
        CHECK_FALSE(std::filesystem::exists(thin.file("out")));
    }
}

}  // namespace fettle::design::cli::fit_command_test
