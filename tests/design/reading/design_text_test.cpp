// SPDX-License-Identifier: MIT
#include "design/reading/design_text.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>

#include "tests/design/small_design.hpp"

namespace fettle::design::reading::design_text_test {

namespace {

using namespace fettle::tests::design_support;
using fettle::design::description::representable;
using fettle::design::description::values_of;

std::string all(const Errors& errors) {
    std::string text;
    for (const Error& error : errors) text += error.where + ": " + error.message + "\n";
    return text;
}

}  // namespace

TEST_CASE("a design has the same hash from wherever it is read") {
    const DesignFolder folder;
    const std::filesystem::path here = std::filesystem::current_path(), design = folder.design();
    const auto hash_from = [&](const std::filesystem::path& current, const std::filesystem::path& name) {
        std::filesystem::current_path(current);
        const Result<DesignFile> read = read_design(name.string());
        const std::string hash = read ? design_hash(*read) : all(read.errors());
        std::filesystem::current_path(here);
        return hash;
    };
    const std::string hash = hash_from(here, design);
    CHECK(hash.size() == 16);
    CHECK(hash_from(design.parent_path(), design.filename()) == hash);
    CHECK(hash_from(design.parent_path().parent_path(), design.parent_path().filename() / design.filename()) == hash);
}

TEST_CASE("a rewritten design reads back bit for bit, from another folder, and has the same hash but for its values") {
    const DesignFolder folder;
    const Result<DesignFile> design = read_design(folder.design());
    REQUIRE(design);
    VectorX values(5);
    values << 0.0123456789012345678, 0.2 / 11, -1e-3 / 3, 1234.5678901234567, 0.98765432109876543;
    for (Eigen::Index k = 0; k < 5; ++k) values[k] = representable(values[k], design->design.parameters[k].unit);
    values[2] = design->design.parameters[2].upper;
    const auto out = folder.path / "out";
    std::filesystem::create_directories(out);
    const std::string path = (out / "design.final.json").string();
    std::ofstream(path) << design_text(*design, values, out.string());
    const Result<DesignFile> again = read_design(path);
    INFO(all(again.errors()));
    REQUIRE(again);
    for (Eigen::Index k = 0; k < 5; ++k) CHECK(again->design.parameters[k].value == values[k]);
    CHECK(design_hash(*again) != design_hash(*design));
    std::ofstream(path) << design_text(*design, values_of(design->design.parameters), out.string());
    CHECK(design_hash(*read_design(path)) == design_hash(*design));

    const DesignFolder moved(small_design, replaced(small_scene, "\"size_y\": 12", "\"size_y\": 12.5"));
    CHECK(design_hash(*read_design(moved.design())) != design_hash(*design));
    const DesignFolder other_optimiser(replaced(small_design, "\"max_evaluations\": 8", "\"max_evaluations\": 9"));
    CHECK(design_hash(*read_design(other_optimiser.design())) == design_hash(*design));
}

TEST_CASE("a design's hash is another when its part says something else, even if what is drawn at the start is the same") {
    const auto hash_of = [](const std::string& side) {
        const DesignFolder folder(small_design,
                                  replaced(small_scene, R"("part": "box", "dimensions": { "size_x": 20, "size_y": 12, "size_z": 10 })",
                                           R"("part": "cube.part.json", "dimensions": { "size_x": 20, "size_z": 10 })"));
        folder.write("cube.part.json", R"({"fettle_part": 1, "dimensions": {"size_x": 20, "size_z": 10},
            "solid": {"extrude": {"rectangle": ["= size_x", ")" +
                                           side + R"("]}, "from": "= -size_z / 2", "to": "= size_z / 2"}})");
        const Result<DesignFile> design = read_design(folder.design());
        INFO(all(design.errors()));
        REQUIRE(design);
        return design_hash(*design);
    };
    CHECK(hash_of("= 12") == hash_of("= 12"));
    CHECK(hash_of("= 12") != hash_of("= 2 + size_z"));
}

TEST_CASE("a design's hash is another when any file says something else that was read for it") {
    const DesignFolder folder(
        replaced(small_design, R"("optimiser":)", R"("tolerances": {"height": {"feature": "length", "process": "mine"}}, "optimiser":)"),
        replaced(small_scene, R"({ "name": "wall",)", R"(
            { "name": "wire", "type": "static", "mesh": "wire.obj", "position": [0, 50, 0] },
            { "name": "post", "type": "static", "shape": {"part": "post.part.json"}, "position": [0, 80, 0] },
            { "name": "made", "type": "static", "position": [0, 110, 0], "shape": {
              "program": ["sh", "make.sh", "{out}", "{size}"], "format": "off", "dimensions": {"size": 5} } },
            { "name": "wall",)"));
    const std::map<std::string, std::string> files{
        {"small.scene.json", ""},
        {"wire.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nl 1 2\nl 2 3\nl 3 4\n"},
        {"post.part.json",
         R"({"fettle_part": 1, "dimensions": {"side": 4}, "solid": {"extrude": {"rectangle": ["= side", "= side"]}, "to": "= side"}})"},
        {"make.sh", R"(printf 'OFF\n4 4 0\n0 0 0\n%s 0 0\n0 10 0\n0 0 10\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n' "$2" > "$1")"},
        {"mine.process.json", R"({"fettle_process": 1, "units": "mm", "features": {"length": {"bias": 0.1, "spread": 0.05}}})"}};
    for (const auto& [name, text] : files)
        if (!text.empty()) folder.write(name, text);
    DesignReadOptions options;
    options.programs = Programs::allowed;
    const auto hash = [&] {
        const Result<DesignFile> design = read_design(folder.design(), options);
        INFO(all(design.errors()));
        REQUIRE(design);
        std::set<std::string> read;
        for (const auto& [path, contents] : design->files) read.insert(std::filesystem::path(path).filename().string());
        for (const auto& [name, text] : files) CHECK(read.count(name) == 1);
        CHECK(read.count("sh") == 1);  // the program itself
        return design_hash(*design);
    };
    const std::string before = hash();
    CHECK(hash() == before);
    for (const auto& [name, text] : files) {
        INFO(name);
        const std::string was = fettle::tests::support::contents(folder.path / name);
        folder.write(name, was + "\n");
        CHECK(hash() != before);
        folder.write(name, was);
        CHECK(hash() == before);
    }
    // A wire's edges alone.
    folder.write("wire.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nl 1 2\nl 2 3\nl 4 1\n");
    CHECK(hash() != before);
    folder.write("wire.obj", files.at("wire.obj"));
    options.process = "fdm";
    CHECK(hash() != before);
    options.process.clear();
    options.resolution.steps = 2;
    CHECK(hash() != before);
}

TEST_CASE("a design's folder of results lies in its own") {
    for (const char* output : {"/tmp", "..", "../out", "a/../../out", "away", "away/below"}) {
        const DesignFolder folder(replaced(small_design, R"("optimiser":)", R"("output": ")" + std::string(output) + R"(", "optimiser":)"));
        std::filesystem::create_directory_symlink("/tmp", folder.path / "away");
        const Result<DesignFile> design = read_design(folder.design());
        INFO(output);
        REQUIRE_FALSE(design);
        CHECK(design.errors().at(0).where.ends_with("#/output"));
        CHECK(design.errors().at(0).message.find("--out") != std::string::npos);
    }
    for (const char* output : {"out", "./a/b", "a/../b", "."}) {
        const DesignFolder folder(replaced(small_design, R"("optimiser":)", R"("output": ")" + std::string(output) + R"(", "optimiser":)"));
        const Result<DesignFile> design = read_design(folder.design());
        INFO(output << "\n" << all(design.errors()));
        REQUIRE(design);
        CHECK(std::filesystem::path(design->output) == folder.path / output);
    }
}

}  // namespace fettle::design::reading::design_text_test
