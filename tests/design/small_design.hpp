// SPDX-License-Identifier: MIT
/// A small design whose simulation takes a fraction of a second: a box that falls 0.02 mm onto a table that a motor tilts; contact is
/// active.
#pragma once

#include <string>

#include "tests/support/temporary_folder.hpp"
#include "tests/support/text.hpp"

namespace fettle::tests::design_support {

inline const char* small_scene = R"({
  "fettle_scene": 1, "units": "mm", "gravity": [0, 0, -9.81], "timestep": 0.005, "end_time": 0.1,
  "contact": { "dhat": 0.1 },
  "bodies": [
    { "name": "table", "type": "kinematic",
      "shape": { "part": "box", "dimensions": { "size_x": 60, "size_y": 60, "size_z": 10 } },
      "position": [0, 0, -5], "prescribed": { "ry": { "rate": 40 } } },
    { "name": "cube", "density": 1000, "angular_velocity": [20, 10, 0],
      "shape": { "part": "box", "dimensions": { "size_x": 20, "size_y": 12, "size_z": 10 } }, "position": [3, 1, 5.12] },
    { "name": "wall", "type": "static",
      "shape": { "part": "box", "dimensions": { "size_x": 5, "size_y": 60, "size_z": 60 } }, "position": [40, 0, 0] }
  ]
})";

inline const char* small_design = R"({
  "fettle_design": 1, "scene": "small.scene.json", "units": "mm",
  "parameters": [
    { "name": "height", "value": 10, "lower": 6, "upper": 14 },
    { "name": "width", "value": 20, "lower": 15, "upper": 30 },
    { "name": "place", "value": 3, "lower": -5, "upper": 20 },
    { "name": "density", "value": 1000, "lower": 500, "upper": 2000, "unit": "kg/m^3" },
    { "name": "speed", "value": 40, "lower": 10, "upper": 60, "unit": "deg/s" }
  ],
  "set": {
    "/bodies/cube/shape/dimensions/size_z": "= height",
    "/bodies/cube/shape/dimensions/size_x": "= width",
    "/bodies/cube/position/0": "= place",
    "/bodies/cube/position/2": "= height / 2 + 0.12",
    "/bodies/cube/density": "= density",
    "/bodies/table/prescribed/ry/rate": "= speed"
  },
  "objective": [
    { "type": "mass", "bodies": ["cube"], "weight": 1 },
    { "type": "marker_path", "body": "cube", "point": [3, 2, 1], "points": [[4, 2, 7], [8, 3, 6]], "times": [0.052, 0.1], "weight": 0.1 },
    { "type": "marker_path", "body": "cube", "point": [0, 0, 5], "points": [[3, 1, 11]], "weight": 0.1 },
    { "type": "play", "a": "cube", "b": "wall", "weight": 0.5 },
    { "type": "stroke", "body": "cube", "axis": [0, 0, 2], "target": 1, "weight": 1 }
  ],
  "constraints": [
    { "type": "clearance", "a": "cube", "b": "wall", "minimum": 15, "motion": true },
    { "type": "clearance", "a": "cube", "b": "wall", "minimum": 16, "motion": true, "windows": 2 },
    { "type": "stroke", "body": "cube", "axis": [0, 0, 1], "lower": 0, "upper": 30 },
    { "type": "mass", "bodies": ["cube"], "lower": 1.5, "upper": 4 }
  ],
  "optimiser": { "name": "mma", "max_evaluations": 8 }
})";

/// A folder of its own with the two files in it.
struct DesignFolder : support::TemporaryFolder {
    explicit DesignFolder(const std::string& design = small_design, const std::string& scene = small_scene) {
        write("small.scene.json", scene);
        write("small.design.json", design);
    }
    std::string design() const { return file("small.design.json"); }
};

using support::replaced;

}  // namespace fettle::tests::design_support
