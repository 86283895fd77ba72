// SPDX-License-Identifier: MIT
/// The changes of `fettle fit`: bores, pins, balls and sockets that are too tight for a process are opened to its clearance.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/features/resize.hpp"
#include "core/features/wall.hpp"
#include "design/features/features_report.hpp"

namespace fettle::design::features {

enum class FitChange { holes, pins, both };

struct FitWish {
    std::optional<double> clearance{};  ///< per side [m]; nothing: what the report's process needs
    FitChange change = FitChange::holes;
    bool close = false;  ///< what is looser is closed to that, too
    double reserve = 0;  ///< [m] beyond what is asked for: the digits of the files that are written
};

struct ChangedFeature {
    core::features::FeatureOf feature;
    double radius_before = 0, radius_after = 0;  ///< of its surface [m]
    std::optional<core::features::Wall> wall{};  ///< what is left behind a hole, measured
};

struct FitPlan {
    std::vector<double> required;             ///< [fit of the report] [m], per side
    std::vector<core::geometry::Mesh> parts;  ///< [body] as assembled; those without a change as they were
    std::vector<ChangedFeature> changes;
};

/// A hole takes the most that any of its fits asks for, and so does a pin; of `both` each takes a half.
/// Errors: changes that are refused (core/features/resize.hpp), by "base.B1"; a process that does not say what a pair needs.
Result<FitPlan> plan_fits(const FeaturesReport& report, const FitWish& wish);

/// A fit of the parts as they were written and read again.
struct JudgedFit {
    std::string name;                 ///< "pin.P1 in base.B1"
    double required = 0, before = 0;  ///< [m]; before: by the facets, less how far it is off centre
    double assembled = 0;             ///< proven gap as assembled [m]
    std::optional<double> turned{};   ///< proven gap over a whole turn about the pin [m]; nothing: of balls
    double known() const { return turned ? std::min(assembled, *turned) : assembled; }
};

/// @param before  what `plan` was made of; `after` the parts as written, with the same names. Fits that are no longer found have a gap of
/// 0.
std::vector<JudgedFit> judge_fits(const FeaturesReport& before, const FitPlan& plan, const FeaturesReport& after,
                                  const std::function<bool()>& should_stop);

nlohmann::ordered_json fit_plan_json(const FeaturesReport& before, const FitPlan& plan, const std::vector<JudgedFit>& fits);
std::string fit_plan_text(const FeaturesReport& before, const FitPlan& plan, const std::vector<JudgedFit>& fits);

}  // namespace fettle::design::features
