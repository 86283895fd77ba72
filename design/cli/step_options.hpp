// SPDX-License-Identifier: MIT
/// The options of commands that read STEP files.
#pragma once

#include "design/cli/command_line.hpp"
#include "design/reading/step_wishes.hpp"

namespace fettle::design::cli {

/// Adds --facets and --surface-tolerance.
inline void add_step_options(CommandLine& app, reading::StepWishes& wishes) {
    app.option("--facets", wishes.facets,
               "STEP files: how far facets may be from round faces, as 5um (default: two ten-thousandths of the solid's size)");
    app.option("--surface-tolerance", wishes.surface_tolerance,
               "STEP files: your word for how far facets are from faces that no bound is known of, which are refused otherwise");
}

}  // namespace fettle::design::cli
