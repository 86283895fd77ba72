// SPDX-License-Identifier: MIT
/// A pin in the bore of a plate, both at rest: where the pin stands are two parameters. Play is 0.426 mm, from flats to flats, less the
/// distance from the centre.
#pragma once

#include <string>

namespace fettle::tests::design_support {

inline const char* bore_scene = R"({
  "fettle_scene": 1, "units": "mm", "timestep": 0.01, "end_time": 0.01,
  "bodies": [
    { "name": "plate", "type": "static",
      "shape": { "part": "plate_with_hole",
                 "dimensions": { "size_x": 30, "size_y": 30, "thickness": 5, "hole_radius": 5.4524 }, "counts": { "segments": 32 } } },
    { "name": "pin", "type": "static", "density": 1000,
      "shape": { "part": "cylinder", "dimensions": { "radius": 5, "length": 20 }, "counts": { "segments": 32 } } }
  ]
})";

/// @param x, y  Where the pin stands [mm].  @param sums  "objective" and "constraints" of the file.
inline std::string bore_design(const std::string& x, const std::string& y, const std::string& sums) {
    return R"({
  "fettle_design": 1, "scene": "small.scene.json", "units": "mm",
  "parameters": [
    { "name": "x", "value": )" +
           x + R"(, "lower": -0.25, "upper": 0.25 },
    { "name": "y", "value": )" +
           y + R"(, "lower": -0.25, "upper": 0.25 },
    { "name": "radius", "value": 5, "lower": 4.9, "upper": 5.02 }
  ],
  "set": { "/bodies/pin/position": ["= x", "= y", 0], "/bodies/pin/shape/dimensions/radius": "= radius" },
  )" + sums +
           R"(,
  "optimiser": { "name": "sqp", "max_evaluations": 60 }
})";
}

inline const char* large_play = R"("objective": [{ "type": "play", "a": "pin", "b": "plate", "weight": -1 },
                                                { "type": "mass", "bodies": ["pin"], "weight": -0.1 }], "constraints": [])";
inline const char* least_play = R"("objective": [{ "type": "mass", "bodies": ["pin"], "weight": -1 }],
                 "constraints": [{ "type": "play", "a": "pin", "b": "plate", "lower": 0.4 }])";

}  // namespace fettle::tests::design_support
