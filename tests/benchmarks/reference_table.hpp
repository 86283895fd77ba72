// SPDX-License-Identifier: MIT
/// How long the source paper's own program (rigid-ipc 23b6ba6, one thread, whole process) takes for its scenes: docs/reference_seconds.tsv.
#pragma once

#include <string>
#include <vector>

namespace fettle::tests::benchmarks {

struct ReferenceRun {
    std::string scene;   ///< under scenes/fixtures of the shared folder, without .json
    int steps = 0;       ///< the first so many
    double seconds = 0;  ///< of the processor, over these steps, start included

    /// Over fewer steps, in proportion.
    double seconds_of(int some_steps) const { return seconds * some_steps / steps; }
};

/// Tab-separated, columns by the names in the first line: scene, steps_run, cpu_s. Ends the program (3) if there is no such file.
std::vector<ReferenceRun> read_reference_table(const std::string& path);

const ReferenceRun* find_reference(const std::vector<ReferenceRun>& table, const std::string& scene);

}  // namespace fettle::tests::benchmarks
