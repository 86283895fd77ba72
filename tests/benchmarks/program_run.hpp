// SPDX-License-Identifier: MIT
/// `fettle simulate` as people run it: the whole program, from its start to the end of the proof, and what it says of its parts.
#pragma once

#include <cstdint>
#include <string>

namespace fettle::tests::benchmarks {

struct ProgramOptions {
    std::string program;   ///< path of the executable
    std::string mesh_dir;  ///< meshes are looked for here too, unless empty
    int steps = -1;        ///< negative: to the scene's own end
    int threads = 1;
    double seconds = 120;  ///< CPU time after which it is ended
    int repeat = 5;        ///< short runs are repeated up to so often, and until `repeat_seconds` are spent; the quickest counts
    double repeat_seconds = 1;
};

struct ProgramRun {
    std::string status = "not run";  ///< the program's; "crashed", "hung"
    std::string message;             ///< when not ok
    int steps = 0;
    double cpu_seconds = 0, wall_seconds = 0;                             ///< of the whole program
    double start_seconds = 0, stepping_seconds = 0, certify_seconds = 0;  ///< wall time of its parts, as it tells them
    double peak_memory_bytes = 0;
    double minimum_distance = 0;  ///< [m], proven over the path; infinite: none
    std::uint64_t bits = 0;       ///< FNV-1a over its answer without times: equal for equal results
};

/// @param scene  a file; meshes are looked for from there.
ProgramRun run_program(const std::string& scene, const ProgramOptions& options);

/// The program of this build, unless the environment variable FETTLE_PROGRAM names another.
std::string program_of_this_build();

}  // namespace fettle::tests::benchmarks
