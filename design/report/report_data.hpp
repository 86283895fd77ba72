// SPDX-License-Identifier: MIT
/// What a report says, as the page takes it: one JSON object. Lengths in mm, times in s; arrays of numbers as packed_numbers.hpp has them.
///   format          1
///   program         version that made the results; made_by_other: this page's, if it is another
///   command         that made the results; null if not known
///   kind            "optimise", "simulate", "clearance"; of pages with data of their own "explore" (exploration_data.hpp), "tolerance"
///                   (tolerance_data.hpp), "studio" (docs/studio.md)
///   name, folder, description (null: the files have none), up: the direction against gravity
///   status, message
///   why_not_optimal, evaluations, failed, violation, optimality {worth}, repair, objective {start, end}: of an optimisation
///   motion, step [s], steps, duration [s]
///   least           proven over the path [mm]; null if there is none
///   meshes, views   moving_parts.hpp: "before" (of an optimisation) and "after", then those of other scenarios
///   pairs, pair_count: of how many the rows are the worst, margins: pair_rows.hpp
///   scenarios       list of {name: null of a design without, view: the name of its view, quantities: quantity_curves.hpp, series:
///                   step_curves.hpp}: first the one of `motion`, whose view is "after"
///   ranges          is a clearance over all positions of the joints?
///   requirements, parameters, starts, resolution: design_rows.hpp
///   limits          texts
///   history         search_curves.hpp; null if there is none
///   series_note, notices: texts
///   files           names in the page's folder that it offers
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/model/model.hpp"
#include "core/stepper/trajectory.hpp"
#include "design/description/design.hpp"
#include "design/quantities/expression.hpp"
#include "design/report/step_curves.hpp"

namespace fettle::design::report {

/// Bodies and their motion.
struct Motion {
    core::model::Model model;  ///< geometry and names
    core::stepper::Trajectory trajectory;
    std::string scene_path = {};  ///< of the scene's file; empty: not known
};

/// A scenario of a design beside the first, at its end.
struct ScenarioMotion {
    std::string name;
    Motion motion;
    StepCurves steps;
};

enum class ReportKind { optimise, simulate, clearance };

/// What a folder of results holds.
struct ReportSource {
    ReportKind kind = ReportKind::simulate;
    std::string folder, name, description;
    Vector3 gravity = Vector3::Zero();
    nlohmann::ordered_json result;
    std::optional<Motion> motion, before;
    std::optional<description::Design> design;
    std::string history;
    StepCurves steps;
    std::string scenario;                               ///< whose motion it is; empty: the design has none
    std::vector<ScenarioMotion> others;                 ///< the design's other scenarios, in their order
    std::vector<quantities::NamedQuantity> quantities;  ///< that have curves
    VectorX values;                                     ///< of the design's parameters
    std::vector<std::string> notices;
    std::vector<std::string> files;  ///< that the page offers, as they are called in its folder
};

/// Which command answered so; nothing if none of them did.
std::optional<ReportKind> kind_of(const nlohmann::ordered_json& result);

/// @param should_stop  asked while distances are certified; true leaves the rest out.
nlohmann::ordered_json report_data(
    const ReportSource& source, const std::function<bool()>& should_stop = [] { return false; });

}  // namespace fettle::design::report
