// SPDX-License-Identifier: MIT
/// Runs assimp_importer.cpp or core/step_importer on a file. assimp reads dozens of formats, Open CASCADE shapes of any making, and a
/// hostile or damaged file can make them crash, abort, loop or ask for all memory; so they never run in this process. An importer is a
/// small program that the library carries within itself, as bytes:
/// it has no place that an installation, a wheel or a program that links the library statically could get wrong. It is started from an
/// anonymous file in memory (core/files/process.hpp).
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace fettle::core::mesh_files {

struct ImportLimits {
    unsigned seconds = 0;       ///< of processor time; ten times as long may pass by the clock
    std::uint64_t memory = 0;   ///< of the process [bytes]
    std::uint64_t largest = 0;  ///< of what it writes [bytes]
};

/// How an import ended, and what came of it.
struct ImportOutcome {
    enum class End { exited, killed, out_of_time, too_large, stopped, not_started } end = End::not_started;
    int code = 0;         ///< the exit code; the signal that killed it; errno of what could not be started
    std::string written;  ///< as import_format.hpp says; exited alone
};

enum class Importer { assimp, step };
/// Was it built? Open CASCADE need not have been there.
bool has_importer(Importer importer);

/// Safe from any thread. Throws for want of memory, and what should_stop throws; the process ends with this call in any case.
/// @param more         words behind those that limits make
/// @param should_stop  asked ten times a second at least; true ends the import.
ImportOutcome run_importer(Importer importer, const std::string& path, const std::vector<std::string>& more, const ImportLimits& limits,
                           const std::function<bool()>& should_stop = {});

}  // namespace fettle::core::mesh_files
