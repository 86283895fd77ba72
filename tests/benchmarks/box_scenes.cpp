// SPDX-License-Identifier: MIT
#include "tests/benchmarks/box_scenes.hpp"

#include <cstdio>

namespace fettle::tests::benchmarks {
namespace {

using core::base::Vector3;

constexpr double gap = 2e-3;
constexpr int steps = 200;

// Corner i is at -1/2 or 1/2 by its bits: 1 along x, 2 along y, 4 along z. Seen from outside triangles are counter-clockwise.
constexpr const char* cube = R"("vertices": [[-0.5, -0.5, -0.5], [0.5, -0.5, -0.5], [-0.5, 0.5, -0.5], [0.5, 0.5, -0.5], )"
                             R"([-0.5, -0.5, 0.5], [0.5, -0.5, 0.5], [-0.5, 0.5, 0.5], [0.5, 0.5, 0.5]], )"
                             R"("triangles": [[0, 2, 3], [0, 3, 1], [4, 5, 7], [4, 7, 6], [0, 1, 5], [0, 5, 4], )"
                             R"([2, 6, 7], [2, 7, 3], [0, 4, 6], [0, 6, 2], [1, 3, 7], [1, 7, 5]])";
constexpr const char* plane =
    R"({"name": "plane", "type": "static", )"
    R"("vertices": [[-50, -50, 0], [50, -50, 0], [50, 50, 0], [-50, 50, 0]], "triangles": [[0, 1, 2], [0, 2, 3]]})";

std::string placed(const char* format, std::size_t i, const Vector3& center) {
    char text[256];
    std::snprintf(text, sizeof text, format, i, center.x(), center.y(), center.z());
    return text;
}

}  // namespace

BoxScene box_tower() {
    BoxScene scene{"tower", {}, steps};
    for (int i = 0; i < 10; ++i) scene.centers.emplace_back(0, 0, 0.5 + gap + i * (1 + gap));
    return scene;
}

BoxScene box_wall() {
    BoxScene scene{"wall", {}, steps};
    for (int row = 0; row < 10; ++row) {
        for (int i = 0; i < 10; ++i) scene.centers.emplace_back((i + 0.5 * (row % 2)) * (1 + gap), 0, 0.5 + gap + row * (1 + gap));
    }
    return scene;
}

BoxScene box_pile() {
    BoxScene scene{"pile", {}, steps};
    for (int layer = 0; layer < 6; ++layer) {
        for (int i = 0; i < 6; ++i) {
            for (int j = 0; j < 6; ++j) scene.centers.emplace_back(1.1 * i, 1.1 * j, 1 + 1.5 * layer);
        }
    }
    return scene;
}

std::vector<BoxScene> box_scenes() { return {box_tower(), box_wall(), box_pile()}; }

std::string fettle_scene(const BoxScene& scene) {
    std::string text = R"({"fettle_scene": 1, "units": "m", "gravity": [0, 0, -9.81], "timestep": 0.01, "end_time": )" +
                       std::to_string(0.01 * scene.steps) + R"(, "contact": {"dhat": 0.001}, "friction": {"mu": 0.5}, "bodies": [)" + "\n" +
                       plane;
    for (std::size_t i = 0; i < scene.centers.size(); ++i) {
        text += placed(",\n{\"name\": \"cube %zu\", \"density\": 1000, \"position\": [%.17g, %.17g, %.17g], ", i, scene.centers[i]);
        text += std::string(cube) + "}";
    }
    return text + "]}\n";
}

std::string mujoco_scene(const BoxScene& scene) {
    const std::size_t contacts = 10 * scene.centers.size() + 64;  // room for so many
    std::string text = "<mujoco>\n<size nconmax=\"" + std::to_string(contacts) + "\" njmax=\"" + std::to_string(4 * contacts) +
                       "\"/>\n<option timestep=\"0.01\" gravity=\"0 0 -9.81\" cone=\"elliptic\"/>\n"
                       "<default><geom friction=\"0.5 0.005 0.0001\" density=\"1000\"/></default>\n"
                       "<worldbody>\n<geom type=\"plane\" size=\"50 50 1\"/>\n";
    for (std::size_t i = 0; i < scene.centers.size(); ++i) {
        text += placed("<body name=\"cube %zu\" pos=\"%.17g %.17g %.17g\">", i, scene.centers[i]);
        text += "<freejoint/><geom type=\"box\" size=\"0.5 0.5 0.5\"/></body>\n";
    }
    return text + "</worldbody>\n</mujoco>\n";
}

}  // namespace fettle::tests::benchmarks
