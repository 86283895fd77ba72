// SPDX-License-Identifier: MIT
/// An exploration on the workers of a Dask cluster, which Python reaches: a process of its own (design/python/fettle/__main__.py) connects,
/// hands the jobs to the scheduler, and prints each result as a line.
#pragma once

#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "design/cli/child_process.hpp"
#include "design/studies/exploration.hpp"

namespace fettle::design::cli {

/// The design that the workers get.
struct DaskDesign {
    std::string path;
    std::vector<std::string> mesh_dirs;
    bool allow_programs = false;
};

class DaskCluster {
public:
    /// Errors: there is no Python package, no Dask (file_not_found), no scheduler at that address, what Python says of the design.
    static Result<DaskCluster> connect(const std::string& address, const DaskDesign& design);

    /// As studies::explore. Errors: the process that reaches the cluster ended before its time.
    Result<studies::Explored> explore(const std::vector<studies::ExplorationJob>& jobs, studies::ExplorationFile& file,
                                      const studies::ExploreOptions& options);

private:
    explicit DaskCluster(TalkingProcess process) : process_(std::move(process)) {}

    TalkingProcess process_;
};

}  // namespace fettle::design::cli
