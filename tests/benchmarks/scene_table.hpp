// SPDX-License-Identifier: MIT
/// The paper's scenes that speed is judged by: how far each is run, what the reference program (rigid-ipc 23b6ba6, -O3, native code, one
/// thread, 2 cores at 2.5 GHz) needs per step over the same steps of the same scene, and what we want to need at most.
#pragma once

#include <array>

namespace fettle::tests::benchmarks {

struct TableScene {
    const char* name;          ///< under ../shared/scenes/fixtures, without .json
    int steps;                 ///< the first so many
    double reference_seconds;  ///< reference program, CPU seconds per step
    double goal_seconds;       ///< ours, at most
};

inline constexpr std::array<TableScene, 20> scene_table{{
    {"unit-tests/5-cubes", 1000, 0.0048, 0.0003},
    {"unit-tests/cube-falling-on-edge", 1000, 0.0074, 0.0004},
    {"unit-tests/erleben/spike-in-hole", 200, 0.045, 0.0015},
    {"unit-tests/erleben/wedges", 125, 0.068, 0.002},
    {"compactor/single-cube", 1000, 0.0073, 0.0004},
    {"chain/10-links", 1000, 0.031, 0.002},
    {"chain/chain-net/chain-net-4x4", 63, 1.27, 0.03},
    {"codimensional/edges/chain-net-4x4", 127, 0.25, 0.01},
    {"blender/blender-10", 62, 0.44, 0.02},
    {"pendulum/pendulum", 13, 1.46, 0.03},
    {"pendulum/double-pendulum", 3, 4.85, 0.10},
    {"mechanisms/bolt", 14, 4.18, 0.08},
    {"mechanisms/507-movements/092-piston", 7, 16.4, 0.10},  // 4.6 with its STL vertices welded
    {"mechanisms/507-movements/140-punching-press", 6, 15.4, 0.30},
    {"mechanisms/507-movements/493-Lewis", 500, 0.077, 0.003},
    {"mechanisms/gears/single", 87, 0.38, 0.01},
    {"friction/arch/arch-25-stones", 765, 0.131, 0.005},
    {"friction/incline-plane/slopeTest_highSchoolPhysics_mu=0.5", 1000, 0.0060, 0.0003},
    {"friction/turntable/turntable-mu=0.5", 800, 0.0123, 0.0008},
    {"minimum-separation/cube-falling-on-edge", 71, 0.93, 0.01},
}};

}  // namespace fettle::tests::benchmarks
