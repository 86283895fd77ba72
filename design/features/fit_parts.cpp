// SPDX-License-Identifier: MIT
#include "design/features/fit_parts.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "core/base/rounded_lengths.hpp"
#include "core/base/text.hpp"
#include "core/features/fit_gap.hpp"
#include "core/model/body_geometry.hpp"

namespace fettle::design::features {

namespace {

using core::base::formatted;
using core::base::Towards;
using core::features::Fit;
using core::features::Resize;
using Json = nlohmann::ordered_json;

double play_of(const Fit& fit) { return fit.facets_play - fit.off_centre; }

Result<std::vector<double>> required_of(const FeaturesReport& report, const FitWish& wish) {
    std::vector<double> out;
    for (const FoundFit& found : report.fits) {
        if (wish.clearance) {
            out.push_back(*wish.clearance);
            continue;
        }
        const ProcessVerdict& verdict = found.processes.front();
        if (!verdict.fault.empty())
            return Error{ErrorCode::out_of_range, report.name_of(found.fit.pin) + " in " + report.name_of(found.fit.hole),
                         verdict.fault + "; say what is wanted: --clearance 0.3mm"};
        out.push_back(verdict.required);
    }
    return out;
}

// By body and feature: what its radius grows by.
using Growths = std::map<std::pair<int, int>, double>;

Growths growths_of(const FeaturesReport& report, const std::vector<double>& required, const FitWish& wish) {
    Growths out;
    const double share = wish.change == FitChange::both ? 0.5 : 1;
    const auto ask = [&](const core::features::FeatureOf& of, double by) {
        const auto [at, is_new] = out.emplace(std::pair(of.body, of.feature), by);
        if (!is_new && by > at->second) at->second = by;
    };
    for (std::size_t k = 0; k < report.fits.size(); ++k) {
        const Fit& fit = report.fits[k].fit;
        const double play = play_of(fit), lacks = required[k] + wish.reserve - play;
        if (play >= required[k] && !(wish.close && -lacks > wish.reserve)) {
            // Another fit may ask for more, but this one for no less than it has.
            if (wish.change != FitChange::pins) ask(fit.hole, 0);
            if (wish.change != FitChange::holes) ask(fit.pin, 0);
            continue;
        }
        if (wish.change != FitChange::pins) ask(fit.hole, share * lacks);
        if (wish.change != FitChange::holes) ask(fit.pin, share * lacks);
    }
    std::erase_if(out, [](const auto& each) { return each.second == 0; });
    return out;
}

std::string in_millimetres(double x, int digits = 4) { return formatted("%.*g", digits, 1e3 * x); }

}  // namespace

Result<FitPlan> plan_fits(const FeaturesReport& report, const FitWish& wish) {
    FitPlan plan;
    const Result<std::vector<double>> required = required_of(report, wish);
    if (!required) return required.errors();
    plan.required = *required;
    const Growths growths = growths_of(report, *required, wish);
    Errors errors;
    for (int b = 0; b < count_of(report.parts); ++b) {
        const core::features::Features& features = report.parts[b];
        core::geometry::Mesh mesh = core::model::mesh_at_start(report.model.bodies[b]);
        std::vector<Resize> changes;
        for (const auto& [of, by] : growths)
            if (of.first == b) changes.push_back({of.second, features.features[of.second].is_hole ? by : -by});
        if (!changes.empty()) {
            Result<core::geometry::Mesh> made = core::features::resized(mesh, features, changes);
            for (Error error : made.errors()) {
                error.where = report.model.bodies[b].name + "." + error.where;
                errors.push_back(std::move(error));
            }
            if (!made) continue;
            mesh = *std::move(made);
        }
        for (const Resize& change : changes) {
            const core::features::Feature& feature = features.features[change.feature];
            const double facets = feature.is_hole ? feature.facets_least : feature.facets_largest, before = feature.surface.radius;
            ChangedFeature changed{{b, change.feature}, before, before * (facets + change.by) / facets};
            if (feature.is_hole) changed.wall = core::features::wall_behind(mesh, feature);
            plan.changes.push_back(std::move(changed));
        }
        plan.parts.push_back(std::move(mesh));
    }
    if (!errors.empty()) return errors;
    return plan;
}

std::vector<JudgedFit> judge_fits(const FeaturesReport& before, const FitPlan& plan, const FeaturesReport& after,
                                  const std::function<bool()>& should_stop) {
    // The same features by their names, whether or not they would count as a fit now.
    std::vector<Fit> fits;
    std::vector<std::size_t> place;  // among those of before
    const auto now = [&](core::features::FeatureOf of) {
        of.feature = after.parts[of.body].find(before.parts[of.body].features[of.feature].name);
        return of;
    };
    std::vector<JudgedFit> out;
    for (std::size_t k = 0; k < before.fits.size(); ++k) {
        Fit fit = before.fits[k].fit;
        const bool is_ball = before.parts[fit.pin.body].features[fit.pin.feature].surface.kind == core::features::SurfaceKind::sphere;
        out.push_back({before.name_of(fit.pin) + " in " + before.name_of(fit.hole), plan.required[k], play_of(fit)});
        if (!is_ball) out.back().turned = 0;
        fit.pin = now(fit.pin);
        fit.hole = now(fit.hole);
        if (fit.pin.feature < 0 || fit.hole.feature < 0) continue;
        fits.push_back(fit);
        place.push_back(k);
    }
    const std::vector<core::clearance::PairClearance> gaps = core::features::fit_gaps(after.model, after.parts, fits, should_stop);
    const std::vector<double> turned = core::features::gaps_over_a_turn(after.model, after.parts, fits, should_stop);
    for (std::size_t j = 0; j < fits.size(); ++j) {
        JudgedFit& judged = out[place[j]];
        judged.assembled = gaps[j].is_clash() ? 0 : gaps[j].lower;
        if (judged.turned) judged.turned = turned[j];
    }
    return out;
}

Json fit_plan_json(const FeaturesReport& before, const FitPlan& plan, const std::vector<JudgedFit>& fits) {
    Json out{{"changes", Json::array()}, {"fits", Json::array()}};
    for (const ChangedFeature& change : plan.changes)
        out["changes"].push_back({{"feature", before.name_of(change.feature)},
                                  {"radius_before", change.radius_before},
                                  {"radius", change.radius_after},
                                  {"wall", change.wall ? Json(change.wall->thickness) : Json()}});
    for (const JudgedFit& fit : fits)
        out["fits"].push_back({{"fit", fit.name},
                               {"required", fit.required},
                               {"before", fit.before},
                               {"assembled", fit.assembled},
                               {"turned", fit.turned ? Json(*fit.turned) : Json()},
                               {"enough", fit.known() >= fit.required}});
    return out;
}

std::string fit_plan_text(const FeaturesReport& before, const FitPlan& plan, const std::vector<JudgedFit>& fits) {
    std::string out;
    if (plan.changes.empty()) out += "nothing to change: every fit has what is asked for\n";
    for (const ChangedFeature& change : plan.changes) {
        out += "changed  " + core::base::shown_on_one_line(before.name_of(change.feature)) + ": diameter " +
               in_millimetres(2 * change.radius_before) + " -> " + in_millimetres(2 * change.radius_after) + " mm";
        if (change.wall) out += ", walls of " + in_millimetres(change.wall->thickness, 3) + " mm and more left (measured)";
        out += "\n";
    }
    const core::base::RoundedLengths lengths("mm", 4);
    for (const JudgedFit& fit : fits) {
        const bool enough = fit.known() >= fit.required;
        out += (enough ? "enough   " : "NOT ENOUGH  ") + core::base::shown_on_one_line(fit.name) + ": " + in_millimetres(fit.before, 3) +
               " -> " + lengths.fixed(fit.known(), Towards::down) + " mm per side, asked for " + in_millimetres(fit.required, 3);
        if (enough) out += fit.turned ? "; proven as assembled and over a whole turn about the pin" : "; proven as assembled";
        out += "\n";
    }
    return out;
}

}  // namespace fettle::design::features
