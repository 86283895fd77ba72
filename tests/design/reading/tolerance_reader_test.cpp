// SPDX-License-Identifier: MIT
// What a process, or a general class, makes of the numbers of a design.
#include "design/reading/tolerance_reader.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "design/description/independent_inputs.hpp"
#include "design/reading/design_reader.hpp"
#include "design/reading/design_text.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fettle::design::reading::tolerance_reader_test {

namespace {

constexpr double mm = 1e-3, degree = std::numbers::pi / 180;

const char* const scene = R"({"fettle_scene": 1, "units": "mm", "gravity": [0, 0, -9.81], "timestep": 0.01, "end_time": 0.03,
    "variables": {"length": "10 mm", "twice": "2 * length", "tilt": "30 deg", "weight": "1 kg", "none": "0 mm", "back": "-40 mm",
                  "reach": "0.6 mm", "idle": "5 mm"},
    "contact": {"dhat": "= reach"},
    "bodies": [{"name": "block", "density": 1000,
                "position": ["= back", 0, 0], "rotation": [0, 0, "= tilt"],
                "shape": {"part": "box", "dimensions": {"size_x": "= length", "size_y": 10, "size_z": 10}}}]})";

struct Folder : tests::support::TemporaryFolder {
    Folder() {
        write("block.scene.json", scene);
        write("mine.process.json", R"({"fettle_process": 1, "units": "mm", "based_on": "fdm",
            "features": {"hole": {"bias": -0.1, "spread": 0.02, "from": 4, "up_to": 12}}})");
    }
    // @param keys  of the design, with its tolerances.
    Result<DesignFile> read(const std::string& keys, const std::string& process = "") const {
        DesignReadOptions options;
        options.as_made = true;
        options.process = process;
        return parse_design(R"json({"fettle_design": 1, "scene": "block.scene.json", "units": "mm",
            "parameters": [{"name": "depth", "value": 10, "lower": 5, "upper": 20}, {"name": "radius", "value": 4, "lower": 1, "upper": 9},
                           {"name": "angle", "value": 20, "lower": 1, "upper": 90, "unit": "deg"}],
            "variables": {"all": "radius + 10 mm * sin(angle)"},
            "set": {"/bodies/block/shape/dimensions/size_y": "= depth", "/bodies/block/shape/dimensions/size_z": "= all"},
            "objective": [{"type": "mass", "bodies": ["block"]}], )json" +
                                keys + "}",
                            file("x.design.json"), options);
    }
    std::string faults(const std::string& keys, const std::string& process = "") const {
        std::string told;
        const auto file = read(keys, process);
        for (const Error& error : file.errors()) told += error.where.substr(error.where.find('#') + 1) + ": " + error.message + "\n";
        return told;
    }
};

Result<DesignFile> good(Result<DesignFile> file) {
    for (const Error& error : file.errors()) UNSCOPED_INFO(error.where << ": " << error.message);
    REQUIRE(file);
    return file;
}

const description::Tolerance& of(const DesignFile& file, const std::string& name) {
    for (const description::Tolerance& tolerance : file.tolerances)
        if (tolerance.of == name) return tolerance;
    FAIL("no tolerance of " + name);
    throw 0;
}

}  // namespace

TEST_CASE("tolerances by a process: of the design, or of one entry, of diameters and radii, and of angles") {
    const Folder folder;
    const auto file = good(folder.read(R"("process": "fdm", "tolerances": {"depth": "hole", "radius": {"feature": "pin", "of": "radius"},
        "length": {"feature": "hole", "process": "sla"}, "angle": {"feature": "angle", "leg": "30 mm"},
        "/bodies/block/position/0": "+-0.1"})"));
    const auto limits = [&](const std::string& name) { return of(*file, name).deviation; };
    CHECK(limits("depth").lower == Approx(-0.5 * mm));
    CHECK(limits("depth").upper == Approx(0.1 * mm));
    CHECK(moments_of(limits("depth")).mean == Approx(-0.2 * mm));
    CHECK(moments_of(limits("depth")).standard_deviation == Approx(0.1 * mm));
    CHECK(of(*file, "depth").stated == "fdm hole");
    CHECK(limits("radius").upper == Approx(0.15 * mm));
    CHECK(limits("length").upper == Approx(0.1 * mm));
    CHECK(limits("angle").upper == Approx(0.01));
    CHECK(file->process == "fdm");
}

TEST_CASE("tolerances by a process: what one print shares, unless the entry says otherwise") {
    const Folder folder;
    const auto file = good(folder.read(R"("process": "fdm", "tolerances": {"depth": "hole", "radius": {"feature": "pin", "of": "radius"},
        "length": {"feature": "length", "correlation": 0.2}})"));
    const description::IndependentInputs inputs = description::independent_inputs(file->tolerances);
    REQUIRE(inputs.groups == std::vector<std::string>{"fdm", "fdm lengths"});
    VectorX variances(inputs.count());
    for (int k = 0; k < inputs.count(); ++k) variances[k] = inputs.moments[k].standard_deviation * inputs.moments[k].standard_deviation;
    const MatrixX covariance = inputs.map * variances.asDiagonal() * inputs.map.transpose();
    // By name: depth, length, radius.
    CHECK(std::sqrt(covariance(0, 0)) == Approx(0.1 * mm));
    CHECK(std::sqrt(covariance(2, 2)) == Approx(0.05 * mm));
    CHECK(covariance(0, 2) == Approx(-0.5 * 0.1 * mm * 0.05 * mm));  // holes small where pins are large
    CHECK(covariance(0, 1) == Approx(0).margin(1e-20));
    CHECK(of(*file, "length").correlation == 0.2);
    const auto own = good(folder.read(R"("process": "fdm", "tolerances": {"depth": {"feature": "hole", "group": "lid", "correlation": 0.3},
        "radius": {"feature": "pin", "distribution": "uniform"}, "length": {"feature": "hole", "correlation": 0}})"));
    CHECK(of(*own, "depth").group == "lid");
    CHECK(of(*own, "radius").group.empty());
    CHECK(description::independent_inputs(own->tolerances).groups == std::vector<std::string>{"lid"});
    CHECK(good(folder.read(R"("process": "cnc", "tolerances": {"depth": "hole"})"))->tolerances[0].group.empty());
}

TEST_CASE("tolerances by a process of one's own: named by the design from its folder, or in its place") {
    const Folder folder;
    for (const auto& [key, process] : {std::pair{"mine", ""}, {"mine.process.json", ""}, {"fdm", "mine"}}) {
        CAPTURE(key, process);
        const std::string named = *process == 0 ? "" : folder.file(process);
        const auto file =
            good(folder.read(R"("process": ")" + std::string(key) + R"(", "tolerances": {"depth": "hole", "radius": "pin"})", named));
        CHECK(of(*file, "depth").deviation.lower == Approx(-0.16 * mm));
        CHECK(of(*file, "depth").stated == "mine hole");
        CHECK(of(*file, "radius").deviation.upper == Approx(0.3 * mm));
        CHECK(file->process == "mine");
        CHECK(file->warnings.empty());
    }
    // A process that an entry names stays.
    const auto mixed =
        good(folder.read(R"("process": "fdm", "tolerances": {"depth": {"feature": "hole", "process": "sla"}})", folder.file("mine")));
    CHECK(of(*mixed, "depth").stated == "sla hole");
    const auto far = good(folder.read(R"("process": "mine", "tolerances": {"depth": {"feature": "hole", "of": "radius"}})"));
    REQUIRE(far->warnings.size() == 1);
    CHECK(far->warnings[0].find("20 mm is beyond the sizes at which \"mine\" was measured for this kind, 4 mm to 12 mm") !=
          std::string::npos);
    // A design that is written elsewhere still finds it.
    const std::string text = design_text(*far, description::values_of(far->design.parameters), folder.file("out"));
    CHECK(text.find("\"process\": \"../mine.process.json\"") != std::string::npos);
}

TEST_CASE("tolerances by a process: faults") {
    const Folder folder;
    CHECK(folder.faults(R"("tolerances": {"depth": "hole"})").find("/tolerances/depth: which process makes it? Say \"process\": \"fdm\"") ==
          0);
    CHECK(folder.faults(R"("process": "fdn", "tolerances": {"depth": "hole"})").find("/process: there is no process \"fdn\"") == 0);
    CHECK(folder.faults(R"("process": "fdm", "tolerances": {"depth": "hole"})", "mien")
              .find("there is no process \"mien\", nor a file mien.process.json; ") != std::string::npos);
    CHECK(folder.faults(R"("process": "laser", "tolerances": {"depth": "height"})").find("it has hole, pin, slot, gap, wall, length") !=
          std::string::npos);
    CHECK(folder.faults(R"("process": "fdm", "tolerances": {"angle": "hole"})").find("this number is an angle") != std::string::npos);
    CHECK(folder.faults(R"("process": "fdm", "tolerances": {"depth": "angle"})").find("\"angle\" is of angles") != std::string::npos);
    CHECK(folder.faults(R"("process": "fdm", "tolerances": {"angle": "angle"})").find("\"leg\": \"20 mm\"") != std::string::npos);
    CHECK(folder.faults(R"("process": "fdm", "tolerances": {"weight": "pin"})").find("a process makes lengths and angles") !=
          std::string::npos);
    CHECK(folder.faults(R"("process": "fdm", "tolerances": {"none": "pin"})").find("is no size of a feature") != std::string::npos);
    CHECK(folder.faults(R"("tolerances": {"depth": {"process": "fdm"}})").find("feature") != std::string::npos);
    CHECK(folder.faults(R"("process": "fdm", "tolerances": {"depth": {"feature": "bore"}})").find("/tolerances/depth/feature") == 0);
    CHECK(folder.faults(R"("process": "fdm", "tolerances": {"depth": {"feature": "hole", "class": "H7"}})").find("one of these") !=
          std::string::npos);
    CHECK(folder.faults(R"("process": "fdm", "tolerances": {"depth": {"feature": "hole", "leg": 3}})").find("`leg` is of an angle") !=
          std::string::npos);
    CHECK(folder.faults(R"("process": 3)").find("/process") == 0);
    CHECK(folder.faults(R"("process": "fdm", "tolerances": {"depth": {"feature": "hole", "group": "a", "distribution": "uniform"}})") !=
          "");
}

TEST_CASE("general tolerances of angles, by the shorter leg") {
    const Folder folder;
    const auto file =
        good(folder.read(R"("tolerances": {"angle": {"general": "m", "leg": "20 mm"}, "tilt": {"general": "c", "leg": 60}})"));
    CHECK(of(*file, "angle").deviation.upper == Approx(0.5 * degree));
    CHECK(of(*file, "tilt").deviation.upper == Approx(0.5 * degree));  // 30' over 50 up to 120 mm
    CHECK(folder.faults(R"("tolerances": {"angle": {"general": "m"}})").find("say \"leg\": \"20 mm\" beside it") != std::string::npos);
    CHECK(folder.faults(R"("tolerances": {"angle": {"general": "m", "leg": 0}})").find("/tolerances/angle/leg") == 0);
    CHECK(folder.faults(R"("tolerances": {"angle": {"lower": 0, "upper": 1, "leg": 3}})").find("`leg` goes with") != std::string::npos);
}

TEST_CASE("tolerances of everything else, \"*\": every length of its own, and what is left out with its reason") {
    const Folder folder;
    const auto told = [](const DesignFile& file) {
        std::string text;
        for (const Untoleranced& each : file.untoleranced) text += each.name + ": " + each.why + "\n";
        return text;
    };
    const auto file = good(folder.read(R"("tolerances": {"*": {"general": "m"}, "depth": "+-0.05 mm"})"));
    CHECK(of(*file, "depth").stated == "+-0.05 mm");
    CHECK(of(*file, "radius").deviation.upper == Approx(0.1 * mm));
    CHECK(of(*file, "length").deviation.upper == Approx(0.2 * mm));
    CHECK(of(*file, "back").deviation.upper == Approx(0.3 * mm));  // 40 mm, to the other side
    CHECK(file->tolerances.size() == 4);                           // `twice` and `all` follow from others
    CHECK(told(*file) ==
          "angle: an angle, whose tolerance goes by its shorter leg: say `leg` here, or give it one\n"
          "idle: nothing of the scene follows from it\n"
          "none: of size 0\n"
          "reach: something follows from it that no deviation can change\n"
          "tilt: an angle, whose tolerance goes by its shorter leg: say `leg` here, or give it one\n"
          "weight: no length or angle\n");
    const auto made = good(folder.read(R"("process": "fdm", "tolerances": {"*": {"feature": "length", "leg": "15 mm"}, "radius": "+-0"})"));
    CHECK(of(*made, "depth").stated == "fdm length");
    CHECK(of(*made, "tilt").deviation.upper == Approx(0.02));
    CHECK(of(*made, "radius").deviation.upper == 0);
    CHECK(of(*made, "depth").group == "fdm lengths");
    CHECK(good(folder.read(R"("process": "sls", "tolerances": {"*": "length"})"))->tolerances.size() == 4);
    // A variable that the design sets has one too.
    const auto set = good(folder.read(R"("scenarios": [{"name": "a", "set": {"/variables/back": "-30 mm"}}],
        "tolerances": {"*": {"general": "v"}})"));
    CHECK(of(*set, "back").deviation.upper == Approx(1.5 * mm));
}

TEST_CASE("tolerances of everything else: faults, once") {
    const Folder folder;
    CHECK(folder.faults(R"("tolerances": {"*": "+-0.1 mm"})")
              .find("/tolerances/*: what holds for every other length is {\"general\": \"m\"}") == 0);
    CHECK(folder.faults(R"("tolerances": {"*": "H7"})") != "");
    CHECK(folder.faults(R"("tolerances": {"*": "length"})").find("/tolerances/*: which process makes it?") == 0);
    const std::string unknown = folder.faults(R"("tolerances": {"*": {"general": "x"}})");
    CHECK(unknown.find("/tolerances/*/general") == 0);
    CHECK(std::count(unknown.begin(), unknown.end(), '\n') == 1);
    CHECK(folder.faults(R"("process": "fdm", "tolerances": {"*": {"feature": "hole", "of": "radius"}})").find("/tolerances/*/of") == 0);
}

TEST_CASE("a number that others follow from as the file is read has no tolerance of its own", "[design][tolerance]") {
    // How a joint's or spring's ends are given; which numbers the others follow from.
    struct Way {
        const char* keys;
        bool of_position, of_point_a, of_point_b;
    };
    const std::vector<Way> ways{{R"("point": [0, 0, 0])", true, false, false},
                                {R"("point_a": [0, 0, 0])", true, true, false},
                                {R"("point_b": [0, 0, 0])", true, false, true},
                                {R"("point_a": [0, 0, 0], "point_b": [0, 0, 0])", false, false, false}};
    for (const char* kind : {"joints", "springs", "dampers"})
        for (const Way& way : ways) {
            const bool is_joint = std::string(kind) == "joints", is_spring = std::string(kind) == "springs";
            const std::string more = is_joint    ? R"("type": "ball", )"
                                     : is_spring ? R"("stiffness": 100, "rest": "1 mm", )"
                                                 : R"("damping": 0.1, )";
            const Folder folder;
            folder.write("block.scene.json", R"({"fettle_scene": 1, "units": "mm", "timestep": 0.01, "end_time": 0.03, "bodies": [
                {"name": "block", "density": 1000, "position": [5, 0, 0], "rotation": [0, 0, 0],
                 "shape": {"part": "box", "dimensions": {"size_x": 10, "size_y": 10, "size_z": 10}}},
                {"name": "other", "density": 1000, "position": [30, 0, 0],
                 "shape": {"part": "box", "dimensions": {"size_x": 10, "size_y": 10, "size_z": 10}}}],
                ")" + std::string(kind) + R"(": [{"name": "held", )" +
                                                 more + R"("a": "block", "b": "other", )" + way.keys + "}]}");
            const std::string pointer = std::string("/") + kind + "/held/";
            const auto is_refused = [&](const std::string& place) {
                const std::string told = folder.faults(R"("tolerances": {")" + place + R"(": "+-0.1 mm"})");
                CAPTURE(kind, way.keys, place, told);
                const bool refused = told.find("follows from this number as the file is read") != std::string::npos;
                CHECK(refused != told.empty());  // and for no other reason
                return refused;
            };
            CHECK(is_refused("/bodies/block/position/1") == way.of_position);
            CHECK(is_refused("/bodies/other/position/0") == way.of_position);
            CHECK(is_refused(pointer + "point_a/0") == way.of_point_a);
            CHECK(is_refused(pointer + "point_b/0") == way.of_point_b);
        }
}

TEST_CASE("limits that are too near each other to be computed with are refused", "[design][tolerance]") {
    const Folder folder;
    for (const char* width : {"1e-300", "1e-160", "1e-60"})
        CHECK(folder.faults(R"("tolerances": {"radius": "+-)" + std::string(width) + R"( mm"})").find("cannot be told from none") !=
              std::string::npos);
    for (const char* width : {"0", "1e-9"})
        CHECK(folder.faults(R"("tolerances": {"radius": "+-)" + std::string(width) + R"( mm"})").empty());
}

}  // namespace fettle::design::reading::tolerance_reader_test
