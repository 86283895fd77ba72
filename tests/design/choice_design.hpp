// SPDX-License-Identifier: MIT
/// A wheel of few teeth, as light as can be, for tests of choices. Its width times its teeth is at least 100 mm, and it is at most 8 mm
/// wide: 13 teeth are the fewest, and their mass the least.
#pragma once

#include <string>

#include "tests/support/temporary_folder.hpp"

namespace fettle::tests::design_support {

inline const std::string choice_scene = R"({
  "fettle_scene": 1, "units": "mm", "timestep": 0.01, "end_time": 0.01, "gravity": [0, 0, 0],
  "variables": { "teeth": 15, "width": "7.5mm", "half_teeth": "= teeth / 2" },
  "bodies": [
    { "name": "wheel", "density": 1410,
      "shape": { "part": "spur_gear", "dimensions": { "module": 1, "pressure_angle": 28, "root_fillet": 0.1, "width": "= width", "shaft_radius": 1 },
                 "counts": { "teeth": "= teeth" }, "facets": "0.1mm" } }
  ]
})";

inline const std::string choice_design = R"({
  "fettle_design": 1, "scene": "wheel.scene.json", "units": "mm",
  "parameters": [{ "name": "width", "lower": 5, "upper": 8 }],
  "choices": {
    "material": { "options": { "POM": { "set": { "/bodies/wheel/density": 1410 } }, "PLA": { "set": { "/bodies/wheel/density": 1240 } } } },
    "teeth": { "from": 11, "to": 20 }
  },
  "objective": [{ "type": "mass", "bodies": ["wheel"] }],
  "constraints": [
    { "type": "relation", "name": "enough of it", "expression": "teeth * width", "lower": 100 },
    { "type": "relation", "name": "not 14", "expression": "(half_teeth - 7)^2", "lower": 0.01 }
  ],
  "optimiser": { "name": "sqp", "max_evaluations": 20 }
})";

/// A folder of its own with the two files in it.
struct ChoiceFolder : support::TemporaryFolder {
    explicit ChoiceFolder(const std::string& text = choice_design) {
        write("wheel.scene.json", choice_scene);
        write("wheel.design.json", text);
    }
    std::string design() const { return file("wheel.design.json"); }
};

}  // namespace fettle::tests::design_support
