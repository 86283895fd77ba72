// SPDX-License-Identifier: MIT
#include "core/scene/place.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "core/scene_files/scene_reader.hpp"

namespace fettle::core::scene::place_test {

namespace {

using base::Dimension;

const char* text = R"({
  "fettle_scene": 1, "units": "mm", "gravity": [0, 0, -9.81], "contact": { "dmin": 0.1 },
  "materials": { "steel": { "mu": 0.2 }, "brass/2": { "mu": 0.3 }, "wood": {} },
  "friction": { "mu": 0.3, "pairs": [{ "a": "steel", "b": "wood", "mu": 0.1 }] },
  "bodies": [
    { "name": "pin", "density": 1000, "mu": 0.5, "position": [1, 2, 3], "vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]],
      "triangles": [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]], "prescribed": { "rz": { "rate": 40 } } },
    { "name": "2", "inertial": { "mass": "1 g", "centre": [0, 0, 0], "inertia": [[1e-6, 0, 0], [0, 1e-6, 0], [0, 0, 1e-6]] },
      "vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], "triangles": [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]] }
  ],
  "joints": [
    { "name": "hinge", "type": "revolute", "b": "pin", "point": [0, 0, 0], "axis": [0, 0, 1], "stiffness": 2, "preload": 1, "limits": [-90, 90] },
    { "name": "slide", "type": "prismatic", "b": "2", "point": [50, 0, 0], "axis": [1, 0, 0], "stiffness": 300, "rest": 2 },
    { "name": "ball", "type": "ball", "a": "pin", "b": "2", "point": [0, 0, 0] },
    { "name": "pinion", "type": "rack", "of": ["hinge", "slide"], "radius": 10 }
  ],
  "springs": [{ "name": "across", "a": "pin", "b": "2", "point_a": [5, 0, 0], "point_b": [-5, 3, 0], "stiffness": 100, "damping": 3 },
              { "name": "along", "joint": "slide", "stiffness": 100 }],
  "dampers": [{ "name": "dash", "joint": "slide", "damping": 4 }],
  "motors": [{ "name": "push", "joint": "hinge", "torque": { "times": [0, 0.1], "values": [1, 2] } },
             { "name": "drive", "joint": "slide", "speed": 20 }],
  "loads": [{ "name": "pull", "body": "pin", "point": [10, 0, 0], "force": [0, 1, 0] }]
})";

Scene shop() {
    auto scene = scene_files::parse_scene(text, "a.scene.json");
    if (!scene) UNSCOPED_INFO(scene.errors()[0].where << ": " << scene.errors()[0].message);
    REQUIRE(scene);
    scene->bodies[0].shape = ShapeSpec{"box", {{"size_x", 0.02}, {"size_y", 0.03}}, {}};
    return *scene;
}

std::string fault(const std::string& pointer) {
    const auto found = find_place(shop(), pointer);
    return found ? "" : found.errors()[0].message;
}

}  // namespace

TEST_CASE("every place has a pointer that names it, and is set and read there and nowhere else") {
    Scene scene = shop();
    const std::vector<Place> places = places_of(scene);
    CHECK(places.size() > 100);
    std::vector<std::string> pointers;
    for (const Place& place : places) {
        pointers.push_back(pointer_to(scene, place));
        INFO(pointers.back());
        const auto found = find_place(scene, pointers.back());
        INFO((found ? "" : found.errors()[0].message));
        REQUIRE(found);
        CHECK(*found == place);
    }
    for (std::size_t k = 0; k < places.size(); ++k) {
        const double number = 1000 + static_cast<double>(k);
        at(scene, places[k]) = number;
    }
    for (std::size_t k = 0; k < places.size(); ++k) {
        INFO(pointers[k]);
        CHECK(value_at(scene, places[k]) == 1000 + static_cast<double>(k));
        CHECK(&at(scene, places[k]) == &at(scene, places[k]));
    }
    clear_numbers(scene);
    for (const Place& place : places) CHECK(value_at(scene, place) == 0);
}

TEST_CASE("places are what files say, by number or by name, each in its dimension") {
    const Scene scene = shop();
    const auto check = [&](const std::string& pointer, double value, Dimension dimension) {
        const auto found = find_place(scene, pointer);
        INFO(pointer << (found ? "" : ": " + found.errors()[0].message));
        REQUIRE(found);
        CHECK(value_at(scene, *found) == Approx(value).epsilon(1e-14));
        CHECK(dimension_at(scene, *found) == dimension);
    };
    const double degree = std::acos(-1.0) / 180;
    check("/gravity/2", -9.81, Dimension::acceleration);
    check("/contact/dmin", 1e-4, Dimension::length);
    check("/materials/brass~12/mu", 0.3, Dimension::number);
    check("/friction/pairs/0/mu", 0.1, Dimension::number);
    check("/bodies/pin/position/1", 2e-3, Dimension::length);
    check("/bodies/pin/turn/1", 0, Dimension::angle);
    check("/bodies/0/shape/dimensions/size_y", 0.03, Dimension::length);
    check("/bodies/pin/prescribed/rz/rate", 40 * degree, Dimension::angular_speed);
    check("/joints/hinge/stiffness", 2, Dimension::angular_stiffness);
    check("/joints/slide/stiffness", 300, Dimension::stiffness);
    check("/joints/hinge/preload", 1, Dimension::torque);
    check("/joints/0/limits/0", -90 * degree, Dimension::angle);
    check("/joints/slide/rest", 2e-3, Dimension::length);
    check("/joints/pinion/radius", 0.01, Dimension::length);
    check("/springs/across/point_a/0", 5e-3, Dimension::length);
    check("/dampers/0/damping", 4, Dimension::number);
    check("/springs/dash/damping", 4, Dimension::number);
    check("/motors/push/torque/values/1", 2, Dimension::torque);
    check("/motors/push/curve/values/1", 2, Dimension::torque);
    check("/motors/1/speed", 0.02, Dimension::speed);
    check("/loads/pull/force/1", 1, Dimension::force);
    CHECK(pointer_to(scene, *find_place(scene, "/springs/dash/damping")) == "/dampers/0/damping");
    CHECK(pointer_to(scene, *find_place(scene, "/motors/drive/speed")) == "/motors/1/travel/rate");
    CHECK(std::isnan(value_at(scene, *find_place(scene, "/springs/along/rest"))));
}

TEST_CASE("what has no place is told with the name of the part, or the nearest that has one") {
    for (const auto& [pointer, part] : {std::pair("/joints/ball/stiffness", "`ball` has no coordinate"),
                                        std::pair("/joints/ball/axis_b/0", "`ball` has no axis"),
                                        std::pair("/joints/pinion/point_a/0", "`pinion` has no point"),
                                        std::pair("/springs/along/point_a/0", "`along` has no point"),
                                        std::pair("/joints/hinge/rest", "`hinge` has a `preload`"),
                                        std::pair("/joints/slide/preload", "`slide` has a `rest`"),
                                        std::pair("/springs/along/damping", "`along` has no `damping`"),
                                        std::pair("/springs/across/limits/0", "`across` has no `limits`"),
                                        std::pair("/joints/hinge/pitch", "`hinge` is not a screw"),
                                        std::pair("/joints/hinge/ratio", "`hinge` is not a gear"),
                                        std::pair("/motors/push/torque/values/5", "no such value"),
                                        std::pair("/motors/push/angle/values/0", "nothing at `angle/values/0`"),
                                        std::pair("/loads/1/force/0", "there is no load of that number"),
                                        std::pair("/joints/hing/rest", "did you mean `hinge`?"),
                                        std::pair("/bodies/2/density", "there is no body of that number"),
                                        std::pair("/bodies/1/density", "is given"),
                                        std::pair("/bodies/pin/prescribed/rx/rate", "no motor on that coordinate"),
                                        std::pair("/bodies/pin/shape/dimensions/size_z", "no such value"),
                                        std::pair("/bodies/pin/densty", "did you mean `density`?"),
                                        std::pair("/materials/wood/mu", "material `wood` has no `mu`"),
                                        std::pair("/contact/kappa", "nothing at `contact/kappa` that can be moved"),
                                        std::pair("gravity", "a place in a scene is expected"),
                                        std::pair("", "a place in a scene is expected"),
                                        std::pair("/bodies", "nothing at `bodies`"),
                                        std::pair("/bodies/", "there is no body ``"),
                                        std::pair("/bodies/0", "nothing at ``"),
                                        std::pair("/gravity/3", "no such value")}) {
        CAPTURE(pointer, fault(pointer));
        CHECK(fault(pointer).find(part) != std::string::npos);
    }
}

TEST_CASE("numbers that leave no derivative are told") {
    const auto faults = [](const std::string& pointer, double value) {
        Scene scene = shop();
        const Place place = find_place(scene, pointer).value();
        at(scene, place) = value;
        const base::Errors errors = faults_at(scene, place);
        return errors.empty() ? "" : errors[0].where + " " + errors[0].message;
    };
    CHECK(faults("/joints/hinge/stiffness", 1).empty());
    CHECK(faults("/joints/hinge/stiffness", 0) == "`hinge` its `stiffness` must be greater than 0 for a derivative");
    CHECK(faults("/joints/hinge/stiffness", std::nan("")).find("greater than 0") != std::string::npos);
    CHECK(faults("/bodies/pin/mu", -0.1).find("body `pin` its `mu` must be greater than 0") == 0);
    CHECK(faults("/contact/dmin", 0).empty());
    CHECK(faults("/contact/dmin", -1).find("must not be negative") != std::string::npos);
    CHECK(faults("/joints/pinion/radius", 0).find("must not be 0") != std::string::npos);
    CHECK(faults("/joints/hinge/limits/0", 3).find("must be less than the upper one") != std::string::npos);
    CHECK(faults("/loads/pull/force/1", 0).find("force must be greater than 0") != std::string::npos);
}

}  // namespace fettle::core::scene::place_test
