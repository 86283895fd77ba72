// SPDX-License-Identifier: MIT
/// Scenes of unit cubes on a plane that two programs can run: the tower, the wall and the pile that rigid body programs are compared by.
/// Lengths in metres, cubes of 1 m and 1000 kg/m^3, gravity 9.81 m/s^2 along -z, steps of 0.01 s, friction 0.5, nothing moves at the start.
#pragma once

#include <string>
#include <vector>

#include "core/base/types.hpp"

namespace fettle::tests::benchmarks {

struct BoxScene {
    std::string name;
    std::vector<core::base::Vector3> centers;  ///< of the cubes
    int steps = 0;                             ///< how far it is run
};

/// tower: 10 cubes on top of each other, 2 mm apart and above the plane; 2 s.
BoxScene box_tower();
/// wall: 10 rows of 10 cubes, every second row shifted by half a cube, 2 mm apart in both directions and above the plane; 2 s.
BoxScene box_wall();
/// pile: 6 x 6 x 6 cubes, 0.5 m between layers and below the lowest one, 0.1 m between columns, dropped; 2 s.
BoxScene box_pile();
/// All three.
std::vector<BoxScene> box_scenes();

/// As a *.scene.json: the cubes are meshes of 12 triangles, the plane is one of two; dhat is 1 mm.
std::string fettle_scene(const BoxScene& scene);

/// As MuJoCo's MJCF: free boxes over a plane. What has no default of its own here is MuJoCo's: Newton's solver, contacts with a time
/// constant of 0.02 s, no margin; but friction's cones are elliptic.
std::string mujoco_scene(const BoxScene& scene);

}  // namespace fettle::tests::benchmarks
