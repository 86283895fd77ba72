// SPDX-License-Identifier: MIT
/// The tables of a run (records/step_tables.hpp), written while it goes: they take their names with the rest of what the run leaves.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "core/files/atomic_file.hpp"
#include "core/model/model.hpp"
#include "core/stepper/simulation.hpp"

namespace fettle::design::answers {

class GrowingTables {
public:
    /// In `folder`.
    GrowingTables(const std::filesystem::path& folder, const core::model::Model& model);

    /// Before the first step: the rows of the tables beside `trajectory`, of the run that this one goes on with, up to the time `until`
    /// [s]; none where that run was killed (its file has another name), for tables that lie beside it are of another run.
    void go_on_with(const std::filesystem::path& trajectory, double until);
    /// The rows of the last step. Contract: called after each.
    void write(const core::stepper::Simulation& so_far);
    /// @return why one of them cannot be written
    [[nodiscard]] Errors add_to(core::files::FilesTogether& files);

private:
    struct Table {
        std::string name;
        std::function<std::string(const core::stepper::Simulation&)> text;  ///< header, and rows of the outputs that are kept
        core::files::NewFile file;
        std::string waiting;  ///< to be written
    };
    std::vector<Table> tables_;
};

}  // namespace fettle::design::answers
