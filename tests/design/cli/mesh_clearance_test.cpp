// SPDX-License-Identifier: MIT
// `clearance` of mesh files alone: a CAD project's check without a scene.
#include <catch2/catch.hpp>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/mesh_files/mesh_writer.hpp"
#include "tests/support/box_mesh.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/text.hpp"

namespace fettle::design::cli::mesh_clearance_test {

namespace {

using core::mesh_files::MeshPart;
using fettle::tests::support::Answer;
using fettle::tests::support::box_mesh;
using fettle::tests::support::contents;
using fettle::tests::support::run;
using fettle::tests::support::TemporaryFolder;

/// Three boxes in a row along x: 0.5 mm between the first two, 2 mm between the last two.
struct Boxes : TemporaryFolder {
    core::geometry::Mesh a = box_mesh({0, 0, 0}, {0.01, 0.01, 0.01}), b = box_mesh({0.0105, 0, 0}, {0.02, 0.01, 0.01}),
                         c = box_mesh({0.022, 0, 0}, {0.03, 0.01, 0.01});
    Boxes() {
        write("cad/base.stl", core::mesh_files::stl_bytes({{"base", &a}}));
        write("cad/lid.stl", core::mesh_files::stl_bytes({{"lid", &b}}));
        write("cad/notes.txt", "no mesh");
        write("cad/arm.obj", core::mesh_files::obj_text({{"arm", &c}}));
    }
};

}  // namespace

TEST_CASE("clearance: two meshes, with their unit, and an exit code for CI") {
    const Boxes boxes;
    const std::string files = boxes.file("cad/base.stl") + " " + boxes.file("cad/lid.stl");
    const Answer clear = run("clearance " + files + " --unit mm --minimum 0.4mm --json");
    CAPTURE(clear.out);
    CHECK(clear.code == 0);
    REQUIRE(clear.json()["pairs"].size() == 1);
    const nlohmann::json pair = clear.pair("base", "lid");
    CHECK(pair["lower"].get<double>() == Approx(0.0005).margin(2e-6));
    CHECK(pair["upper"].get<double>() == Approx(0.0005).margin(2e-6));
    CHECK(run("clearance " + files + " --unit mm --minimum 0.6mm").code == 1);
    const Answer table = run("clearance " + files + " --unit mm --minimum 0.6mm");
    CHECK(table.says("base:lid"));
    CHECK(table.says("below threshold"));
    CHECK(table.says("mm"));
    CHECK(run("clearance " + files + " --unit in --minimum 0.4in --json").json()["least"].get<double>() ==
          Approx(0.5 * 0.0254).epsilon(1e-3));
}

TEST_CASE("clearance: --unit auto takes the unit in which the parts are of a usual size, and tells it") {
    const TemporaryFolder folder;
    for (const auto& [size, unit, gap] : {std::tuple(10.0, "mm", 5e-4), std::tuple(0.01, "m", 5e-4), std::tuple(10000.0, "um", 5e-4)}) {
        const core::geometry::Mesh a = box_mesh(Vector3::Zero(), Vector3::Constant(1e-3 * size)),
                                   b = box_mesh({1.05e-3 * size, 0, 0}, {2e-3 * size, 1e-3 * size, 1e-3 * size});
        const std::string files = folder.write("a.stl", core::mesh_files::stl_bytes({{"a", &a}})) + " " +
                                  folder.write("b.stl", core::mesh_files::stl_bytes({{"b", &b}}));
        const Answer found = run("clearance " + files + " --unit auto --json", true);
        CAPTURE(unit, found.out);
        CHECK(found.code == 0);
        CHECK(found.says("--unit auto: lengths are taken as " + std::string(unit) + ","));
        const Answer same = run("clearance " + files + " --unit auto --json");
        CHECK(same.json()["least"].get<double>() == Approx(gap).epsilon(1e-2));
        CHECK(run("validate " + folder.file("a.stl") + " --unit auto").says("10 x 10 x 10 mm"));
    }
}

TEST_CASE("clearance: what meshes need is asked for, what they have not is refused") {
    const Boxes boxes;
    const std::string base = boxes.file("cad/base.stl");
    const Answer unit = run("clearance " + base + " " + boxes.file("cad/lid.stl") + " --json");
    CHECK(unit.code == 3);
    CHECK(unit.json()["errors"][0]["code"] == "missing_key");
    CHECK(unit.json()["errors"].size() == 2);
    CHECK(run("clearance " + base + " --unit mm --motion").code == 3);
    CHECK(run("clearance " + base + " " + boxes.file("cad/notes.txt") + " --unit mm").code == 3);
    CHECK(run("clearance " + base + " " + boxes.file("none.stl") + " --unit mm").code == 3);
    CHECK(run("clearance " + base + " --unit parsec").code == 3);
    CHECK(run("clearance examples/slider_crank/slider_crank.scene.json " + base).code == 3);
    CHECK(run("clearance examples/slider_crank/slider_crank.scene.json --unit mm").code == 3);
    CHECK(run("clearance " + base + " --unit mm --minimum 1mm").code == 3);  // one part: there is nothing to judge
}

TEST_CASE("several solids in one file are counted, and the way to bodies of their own is named") {
    const Boxes boxes;
    core::geometry::Mesh row = boxes.a;
    const Eigen::Index first = row.vertices.cols();
    row.vertices.conservativeResize(3, 2 * first);
    row.vertices.rightCols(first) = boxes.b.vertices;
    for (const auto& t : boxes.b.triangles)
        row.triangles.push_back({t[0] + static_cast<int>(first), t[1] + static_cast<int>(first), t[2] + static_cast<int>(first)});
    const std::string file = boxes.write("row.obj", core::mesh_files::obj_text({{"row", &row}}));
    const Answer refused = run("clearance " + file + " --unit mm --minimum 1mm --json");
    CHECK(refused.code == 3);
    CHECK(refused.says("is one part of 2 solids"));
    CHECK(refused.says("split_components"));
    CHECK(run("validate " + file + " --json").json()["solids"] == 2);
    const Answer listed = run("validate " + file + " --unit mm");
    CHECK(listed.says("2 solids that do not hang together"));
    CHECK(listed.says("    row#1  "));
    CHECK(listed.says("    row#2  "));
    CHECK(run("validate " + file + " --json").json()["parts"].size() == 2);
    CHECK(run("draw " + file + " --unit mm --split --bodies 'row#2' --out " + boxes.file("row.png")).code == 0);
    const std::string scene = boxes.write("row.scene.json", R"({"fettle_scene": 1, "units": "mm", "bodies": [
        {"name": "row", "type": "static", "mesh": "row.obj"},
        {"name": "each", "type": "static", "mesh": "row.obj", "position": [0, 50, 0], "split_components": true}]})");
    const Answer valid = run("validate " + scene + " --json");
    REQUIRE(valid.json()["parts"].size() == 3);
    CHECK(valid.json()["parts"][0]["solids"] == 2);
    CHECK(valid.json()["parts"][2]["solids"] == 1);
    CHECK(run("validate " + scene).says("  2 solids\n"));
    CHECK(run("clearance " + scene + " --pairs each-0:each-1 --minimum 0.4mm").code == 0);
}

TEST_CASE("clearance: a folder of meshes, all pairs of it") {
    const Boxes boxes;
    const Answer answer = run("clearance " + boxes.file("cad") + " --unit mm --minimum 1mm --json");
    CAPTURE(answer.out);
    CHECK(answer.code == 1);
    CHECK(answer.json()["pairs"].size() == 3);
    CHECK(answer.pair("base", "lid")["status"] == "violated");
    CHECK(answer.pair("arm", "lid")["status"] == "clear");
    CHECK(answer.pair("arm", "base")["lower"].get<double>() == Approx(0.012).margin(1e-5));
    CHECK(run("clearance " + boxes.file("cad") + " --unit mm --minimum 1mm --pairs arm:lid").code == 0);

    // A bound that meets the minimum is shown with digits enough to see it.
    const Answer near = run("clearance " + boxes.file("cad") + " --unit mm --minimum 11.9996mm --tolerance 0.1mm --pairs arm:base");
    CAPTURE(near.out);
    CHECK(near.code == 0);
    std::istringstream words(near.out.substr(near.out.find("\narm:base")));
    std::string name;
    double required = 0, lower = 0;
    words >> name >> required >> lower;
    CHECK(required == Approx(11.9996));
    CHECK(lower >= required);

    boxes.write("cad/spare/lid.stl", core::mesh_files::stl_bytes({{"lid", &boxes.b}}));
    boxes.write("none/notes.txt", "no mesh");
    CHECK(run("clearance " + boxes.file("cad") + " --unit mm --minimum 0.1mm", true).says("spare: the meshes in this folder are left out"));
    for (const std::string unit : {" --unit mm", ""}) {
        const Answer none = run("clearance " + boxes.file("none") + unit + " --json");
        CHECK(none.code == 3);
        CHECK(none.json()["errors"][0]["code"] == "file_not_found");
        CHECK(none.says("this folder has no mesh"));
    }
    boxes.write("cad/part.step", "ISO-10303-21;");
#ifdef FETTLE_STEP_SAMPLES  // built with Open CASCADE
    const std::string unread = "parse";
#else
    const std::string unread = "unsupported";
#endif
    CHECK(run("clearance " + boxes.file("cad/part.step") + " --unit mm --json").json()["errors"][0]["code"] == unread);
}

TEST_CASE("clearance --split: what is printed in place as one file is judged solid by solid") {
    const Boxes boxes;
    core::geometry::Mesh row = boxes.a;
    for (const core::geometry::Mesh* part : {&boxes.b, &boxes.c}) {
        const auto count = static_cast<int>(row.vertices.cols());
        Matrix3X x(3, count + part->vertices.cols());
        x << row.vertices, part->vertices;
        auto triangles = row.triangles;
        for (const auto& t : part->triangles) triangles.push_back({t[0] + count, t[1] + count, t[2] + count});
        row = core::geometry::make_mesh("row", x, triangles);
    }
    boxes.write("row.stl", core::mesh_files::stl_bytes({{"row", &row}}));
    const std::string file = boxes.file("row.stl") + " --unit mm --json";
    CHECK(run("clearance " + file).says("--split"));
    const Answer answer = run("clearance " + file + " --split --minimum 0.4mm --certificate " + boxes.file("row.certificate.json"));
    CAPTURE(answer.out);
    CHECK(answer.code == 0);
    CHECK(answer.json()["pairs"].size() == 3);
    CHECK(answer.pair("row#1", "row#2")["lower"].get<double>() == Approx(0.0005).margin(2e-6));
    CHECK(answer.pair("row#2", "row#3")["lower"].get<double>() == Approx(0.002).margin(2e-6));
    CHECK(run("validate " + boxes.file("row.certificate.json")).code == 0);
    CHECK(run("clearance " + boxes.file("cad/base.stl") + " " + boxes.file("row.stl") + " --unit mm --split --pairs 'base:row#3' --json")
              .pair("base", "row#3")["lower"]
              .get<double>() == Approx(0.012).margin(2e-6));
    const std::string scene = boxes.write("a.scene.json", R"({"fettle_scene": 1, "units": "mm", "timestep": 0.1, "bodies": []})");
    CHECK(run("clearance " + scene + " --split", true).says("--split"));
}

TEST_CASE("clearance: a 3MF's build items are the placement, and names that are taken are numbered") {
    const Boxes boxes;
    MeshPart first{"wheel", &boxes.a}, second{"wheel", &boxes.a}, third{"a:b,c", &boxes.a};
    second.position = Vector3(0.0107, 0, 0);
    third.rotation = Eigen::AngleAxisd(M_PI / 2, Vector3::UnitZ()).toRotationMatrix();
    third.position = Vector3(0, 0.0101, 0);  // turned, it lies at x -10 to 0, y 10.1 to 20.1
    boxes.write("plate.3mf", core::mesh_files::threemf_bytes({first, second, third}).value());
    const Answer answer = run("clearance " + boxes.file("plate.3mf") + " --minimum 0.05mm --json");
    CAPTURE(answer.out);
    CHECK(answer.code == 0);
    CHECK(answer.pair("wheel", "wheel 2")["upper"].get<double>() == Approx(0.0007).margin(2e-6));
    CHECK(answer.pair("wheel", "a_b_c")["upper"].get<double>() == Approx(0.0001).margin(2e-6));
}

TEST_CASE("clearance: a part in a mesh that is not closed is not clear of it, nor does its certificate say so") {
    const Boxes boxes;
    core::geometry::Mesh open = boxes.a;
    const core::geometry::Mesh part = box_mesh({0.004, 0.004, 0.004}, {0.006, 0.006, 0.006});
    open.triangles.pop_back();
    open = core::geometry::make_mesh("open", open.vertices, open.triangles);
    boxes.write("open.stl", core::mesh_files::stl_bytes({{"open", &open}}));
    boxes.write("part.stl", core::mesh_files::stl_bytes({{"part", &part}}));
    const std::string files = boxes.file("open.stl") + " " + boxes.file("part.stl") + " --unit mm --minimum 0.1mm";
    const Answer answer = run("clearance " + files + " --json --certificate " + boxes.file("fit.certificate.json"));
    CAPTURE(answer.out);
    CHECK(answer.code == 2);
    const nlohmann::json pair = answer.pair("open", "part");
    CHECK(pair["status"] == "undecided");
    CHECK(pair["solids"] == "not verified");
    CHECK(pair["lower"].get<double>() > 0.0035);
    CHECK(pair["reason"].get<std::string>().find("close the mesh") != std::string::npos);
    const Answer valid = run("validate " + boxes.file("fit.certificate.json") + " --minimum 0.1mm --json");
    CHECK(valid.code == 2);
    CHECK(valid.json()["judgement"] == "undecided");
    const std::string validate = "validate " + boxes.file("fit.certificate.json") + " --junit " + boxes.file("j.xml");
    CHECK(run(validate).code == 2);  // the claims are proven; that the two are apart, which the minimum needs, is none of them
    CHECK(contents(boxes.file("j.xml")).find("<failure type=\"undecided\" message=\"at least ") != std::string::npos);
    CHECK(contents(boxes.file("j.xml")).find("one may lie inside the other") != std::string::npos);
    CHECK(run(validate + " --minimum 10mm").code == 1);
    CHECK(contents(boxes.file("j.xml")).find("<failure type=\"violated\" message=\"at least ") != std::string::npos);
    CHECK(contents(boxes.file("j.xml")).find("; required 10 mm") != std::string::npos);
    const Answer beside =
        run("clearance " + boxes.file("open.stl") + " " + boxes.file("cad/lid.stl") + " --unit mm --minimum 0.1mm --json");
    CHECK(beside.code == 0);
    CHECK(beside.pair("open", "lid")["solids"] == "not closed");
}

TEST_CASE("clearance: a cavity that is the wrong way round is told, once of each mesh") {
    const Boxes boxes;
    core::geometry::Mesh block = box_mesh({0, 0, 0}, {0.01, 0.01, 0.01}), inner = box_mesh({0.002, 0.002, 0.002}, {0.008, 0.008, 0.008});
    Matrix3X vertices(3, 16);
    vertices << block.vertices, inner.vertices;
    for (const core::geometry::Triangle& triangle : inner.triangles)
        block.triangles.push_back({triangle[0] + 8, triangle[1] + 8, triangle[2] + 8});
    block = core::geometry::make_mesh("block", vertices, block.triangles);
    boxes.write("block.stl", core::mesh_files::stl_bytes({{"block", &block}}));
    const std::string command = "clearance " + boxes.file("block.stl") + " " + boxes.file("cad/arm.obj") + " --unit mm --minimum 0.1mm";
    const Answer answer = run(command, true);
    CAPTURE(answer.out);
    const std::string warning = "is a solid within a solid, and no cavity";
    const std::size_t first = answer.out.find(warning);
    REQUIRE(first != std::string::npos);
    CHECK(answer.out.find(warning, first + 1) == std::string::npos);
    CHECK(answer.code == 0);
}

TEST_CASE("clearance: a lid on its base is told as touching, is accepted where that is allowed, and found where it is in it") {
    const Boxes boxes;
    const auto written = [&](const std::string& name, const Vector3& low, const Vector3& high) {
        const core::geometry::Mesh mesh = box_mesh(low, high);
        boxes.write(name + ".stl", core::mesh_files::stl_bytes({{name, &mesh}}));
        return boxes.file(name + ".stl") + " ";
    };
    const std::string base = written("base", {0, 0, 0}, {0.06, 0.04, 0.0101}),
                      lid = written("lid", {0.013, 0.007, 0.0101}, {0.043, 0.015, 0.02}),
                      post = written("post", {0.05, 0.02, 0.015}, {0.055, 0.03, 0.02}),
                      deep = written("deep", {0.01, 0.02, 0.0099}, {0.02, 0.03, 0.02});
    const auto clearance = [&](const std::string& files, const std::string& options) {
        return run("clearance " + files + "--unit mm " + options);
    };
    const Answer refused = clearance(base + lid + post, "--minimum 0.3mm --json");
    CAPTURE(refused.out);
    CHECK(refused.code == 1);
    const nlohmann::json pair = refused.pair("base", "lid");
    CHECK(pair["finding"] == "touching");
    CHECK(pair["status"] == "violated");
    CHECK(pair["touching"]["area"].get<double>() == Approx(240e-6).epsilon(1e-5));
    CHECK(pair["touching"]["allowed"] == false);
    CHECK(clearance(base + lid, "--minimum 0.3mm").says("over 240 mm^2"));
    CHECK(clearance(base + lid, "--minimum 0.3mm").says("--allow-touch base:lid"));
    CHECK(clearance(base + lid, "--json").code == 2);
    const Answer told = clearance(base + lid + deep, "--minimum 0.3mm --markdown " + boxes.file("told.md"));  // no distances of 1e-12 mm
    const std::string file = contents(boxes.file("told.md"));
    CAPTURE(told.out, file);
    CHECK(told.says(" mm deep, "));
    CHECK(told.says(" mm^3 shared"));
    CHECK_FALSE(told.says("e-1"));
    CHECK(file.find("the parts share material: ") != std::string::npos);
    CHECK(file.find(" mm deep, ") != std::string::npos);
    CHECK(file.find("the parts touch over 240 mm^2; required 0.3 mm per side; if they are meant to, --allow-touch base:lid accepts it") !=
          std::string::npos);
    CHECK(file.find("at least 0 mm") == std::string::npos);
    for (const std::string allowed : {"base:lid", "lid:base", "'ba*:*'", "base:lid=0.01mm"}) {
        const Answer accepted = clearance(base + lid + post, "--minimum 0.3mm --json --allow-touch " + allowed);
        CAPTURE(allowed, accepted.out);
        CHECK(accepted.code == 0);
        CHECK(accepted.pair("base", "lid")["finding"] == "touching");
        CHECK(accepted.pair("base", "lid")["status"] == "contact");
        CHECK(accepted.pair("base", "lid")["minimum"].is_null());
        CHECK(accepted.pair("post", "lid")["status"] == "clear");
    }
    const Answer found = clearance(base + deep, "--minimum 0.3mm --json --allow-touch base:deep");
    CHECK(found.code == 1);
    CHECK(found.pair("base", "deep")["finding"] == "clash");
    CHECK(clearance(base + deep, "--minimum 0.3mm --allow-touch base:deep=1mm").code == 0);
    CHECK(clearance(base + lid + deep, "--minimum 0.3mm --allow-touch base:lid --allow-touch base:deep=1mm").code == 0);
    for (const std::string wrong : {"base:lib", "base", "base:base", "base:lid=0mm", "base:lid=-1mm", "'x*:lid'"})
        CHECK(clearance(base + lid, "--allow-touch " + wrong).code == 3);
    CHECK(clearance(base + lid, "--pairs base:lid=0.3mm --allow-touch base:lid").code == 3);
}

TEST_CASE("clearance: a certificate of meshes names their files, and is stale when one changes") {
    const Boxes boxes;
    const std::string certificate = boxes.file("out/fit.certificate.json");
    const std::string command = "clearance " + boxes.file("cad") + " --unit mm --minimum 0.4mm --certificate " + certificate;
    CHECK(run(command).code == 0);
    const Answer good = run("validate " + certificate + " --minimum 0.4mm --json");
    CAPTURE(good.out);
    CHECK(good.code == 0);
    CHECK(good.json()["exports"].size() == 3);
    boxes.write("cad/lid.stl", core::mesh_files::stl_bytes({{"lid", &boxes.c}}));
    const Answer stale = run("validate " + certificate + " --json");
    CHECK(stale.code == 1);
    CHECK(stale.json()["status"] == "stale");
}

TEST_CASE("clearance: meshes are moved by poses of another program") {
    const Boxes boxes;
    const std::string poses = boxes.write(
        "poses.csv", "time,body,px[mm],py[mm],pz[mm],qw,qx,qy,qz\n0,lid,0,0,0,1,0,0,0\n1,lid,-0.3,0,0,1,0,0,0\n2,lid,1,0,0,1,0,0,0\n");
    const std::string files = boxes.file("cad/base.stl") + " " + boxes.file("cad/lid.stl");
    const Answer answer = run("clearance " + files + " --unit mm --minimum 0.1mm --poses " + poses + " --json");
    CAPTURE(answer.out);
    CHECK(answer.code == 0);
    CHECK(answer.pair("base", "lid")["upper"].get<double>() == Approx(0.0002).margin(2e-6));
    CHECK(answer.pair("base", "lid")["time"].get<double>() == Approx(1).margin(1e-2));
}

}  // namespace fettle::design::cli::mesh_clearance_test
