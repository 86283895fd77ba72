// SPDX-License-Identifier: MIT
#pragma once

namespace fettle::tests::design_support {

/// Two bars in a plane, the second one's corner towards a post: nearest where they are stretched and the corner is on the axis.
inline const char* const two_bars = R"json({"fettle_scene": 1, "units": "mm", "timestep": 0.01,
    "variables": {"upper_length": "60 mm", "fore_length": "40 mm", "width": "12 mm", "post_at": "115 mm"},
    "bodies": [
      {"name": "upper", "density": 1240, "shape": {"part": "box", "dimensions": {"size_x": "= upper_length", "size_y": "= width", "size_z": 4}},
       "position": ["= upper_length / 2", 0, -6]},
      {"name": "fore", "density": 1240, "shape": {"part": "box", "dimensions": {"size_x": "= fore_length", "size_y": "= width", "size_z": 4}},
       "position": ["= upper_length + fore_length / 2", 0, 0]},
      {"name": "post", "type": "static", "shape": {"part": "box", "dimensions": {"size_x": 20, "size_y": 40, "size_z": 20}},
       "position": ["= post_at + 10 mm", 0, 0]}],
    "joints": [
      {"name": "shoulder", "type": "revolute", "b": "upper", "point": [0, 0, 0], "axis": [0, 0, 1], "limits": [-60, 40]},
      {"name": "elbow", "type": "revolute", "a": "upper", "b": "fore", "point": ["= upper_length", 0, 0], "axis": [0, 0, 1],
       "limits": [-50, 30]}]})json";

}  // namespace fettle::tests::design_support
