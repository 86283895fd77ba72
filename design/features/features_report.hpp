// SPDX-License-Identifier: MIT
/// The one question of `fettle features`: which planes, bores, pins, cones, spheres and tori parts have, which sit in which, with how much
/// play, and for which processes that is enough.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/clearance/pair_clearance.hpp"
#include "core/features/find_features.hpp"
#include "core/features/fits.hpp"
#include "core/model/model.hpp"
#include "design/tolerances/process.hpp"

namespace fettle::design::features {

struct FeaturesQuestion {
    core::features::FeatureOptions options;
    std::string process;  ///< a name or a file (reading/process_file.hpp); empty: all known ones, and nothing is judged
    bool fits = true;
    std::function<void(int done, int of)> on_body{};  ///< optional
    std::function<bool()> should_stop = [] { return false; };
};

/// Whether a fit's play, per side by the facets, is what the process needs between parts of their sizes.
struct ProcessVerdict {
    std::string process;
    double required = 0;  ///< [m], per side; 0: not known
    bool is_enough = false;
    std::string fault{};  ///< why it is not known, such as a part beyond the process' sizes
};

struct FoundFit {
    core::features::Fit fit;
    core::clearance::PairClearance gap;  ///< of the two features' facets, as assembled, proven
    std::vector<ProcessVerdict> processes;
};

struct FeaturesReport {
    const core::model::Model& model;
    std::vector<core::features::Features> parts;  ///< [body], as assembled
    std::vector<FoundFit> fits;
    std::string judged_by;     ///< the process; empty: none
    bool interrupted = false;  ///< parts and fits are those found by then

    std::string name_of(const core::features::FeatureOf& feature) const;  ///< "pin.P1"
};

/// Contract: the model stays where it is as long as the report. Errors: the process'.
Result<FeaturesReport> ask_features(const core::model::Model& model, const FeaturesQuestion& question);

enum class FeaturesStatus {
    ok,
    violated,  ///< a fit has less play than the process that was asked for needs
    undecided  ///< interrupted, or what is needed is not known
};
FeaturesStatus status_of(const FeaturesReport& report);
const char* to_string(FeaturesStatus status);

/// "bore", "pin", "hole", "boss", "fillet" (of a corner), "rounding" (of an edge), "plane".
std::string role_of(const core::features::Feature& feature);

/// Keys: docs/interface.md. SI.
nlohmann::ordered_json features_json(const FeaturesReport& report, bool triangles);
/// Millimetres. @param all  flat faces and rounded edges too, one by one
std::string features_text(const FeaturesReport& report, bool all);
/// "pin.P1 in base.B1: 0.0997 mm per side as assembled, centred, proven".
std::string fit_sentence(const FeaturesReport& report, const FoundFit& fit);

}  // namespace fettle::design::features
