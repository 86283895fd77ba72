// SPDX-License-Identifier: MIT
/// One scene, run, timed and checked, in a process of its own (child_run.hpp).
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "tests/benchmarks/program_run.hpp"

namespace fettle::tests::benchmarks {

struct RunOptions {
    int steps = -1;  ///< negative: to the scene's own end
    int threads = 1;
    double seconds = 120;       ///< CPU time after which a run is stopped between two Newton iterations, and by force at three times that
    double check_seconds = 20;  ///< for looking for intersections, on top
    int instants_between = 3;   ///< where they are looked for between two stored nodes, besides at the nodes
    int repeat = 5;             ///< short runs are repeated up to so often, and until `repeat_seconds` are spent; the quickest counts
    double repeat_seconds = 1;
};

/// What a run says about itself. Times are of stepping alone, without reading, building and checking; `program` is the whole.
struct SceneRow {
    std::string scene;
    std::string status;   ///< of the simulation; "interrupted": out of time; "refused": not read or not built; "crashed", "hung"
    std::string message;  ///< when not ok
    long bodies = 0, triangles = 0;
    int steps = 0;  ///< done
    int steps_wanted = 0;
    long newton_iterations = 0;
    long contacts = 0;                         ///< active pairs, summed over the steps' ends
    double cpu_seconds = 0, wall_seconds = 0;  ///< cpu: of the calling thread with one thread, of the process with more
    double build_seconds = 0;                  ///< reading and building
    std::map<std::string, double> phases;      ///< CPU seconds, as far as the report tells
    double peak_memory_bytes = 0;              ///< of the process, before the check
    double minimum_distance = 0;               ///< [m], of active pairs at the steps' ends; infinite if there were none
    bool finite = true;                        ///< every number of every pose, and rotations orthonormal to 1e-12
    bool repeatable = true;                    ///< repeated runs had the same bits
    std::uint64_t bits = 0;                    ///< FNV-1a over all poses: equal for equal trajectories
    int steps_checked = 0;                     ///< for intersections: all, or as many as time allowed, spread over the run
    long intersections = 0;                    ///< found by the exact oracle; at most 10 are looked for
    std::string first_intersection;
    ProgramRun program;  ///< `fettle simulate` over the same steps

    double seconds_per_step() const { return steps > 0 ? cpu_seconds / steps : 0; }
    bool is_sound() const { return finite && repeatable && intersections == 0; }
    double memory_limit_bytes() const { return 200e6 + 2e3 * static_cast<double>(triangles); }
};

/// Runs in this process.
/// @param text  of the scene; `path` says where it stands, or would stand: meshes are looked for from there.
SceneRow run_here(const std::string& name, const std::string& text, const std::string& path, const RunOptions& options);

/// Runs in a child. Contract: no thread but the caller's has been started.
SceneRow run_apart(const std::string& name, const std::string& text, const std::string& path, const RunOptions& options);

}  // namespace fettle::tests::benchmarks
