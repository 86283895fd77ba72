// SPDX-License-Identifier: MIT
#include "design/problem/smoother_models.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/text.hpp"
#include "core/clearance/clearance.hpp"

namespace fettle::design::problem {

namespace {

std::string name_of_width(const DesignProblem& problem, double width) {
    return "contact " + core::base::length_text(width, problem.design().scene.length_unit) + " wide";
}

constexpr double worth_a_stage = 1.25;  // a width that is less than this times the design's own is none of its own

std::vector<core::clearance::PairRequest> pairs_that_may_meet(const core::model::Model& model) {
    std::vector<core::clearance::PairRequest> pairs;
    for (int a = 0; a < count_of(model.bodies); ++a) {
        for (int b = a + 1; b < count_of(model.bodies); ++b) {
            if (core::model::may_collide(model, a, b)) pairs.push_back({a, b, 0});
        }
    }
    return pairs;
}

}  // namespace

double play_of_fits(const DesignProblem& problem, const VectorX& p) {
    const Result<core::model::Model> model = problem.model_at(p);
    if (!model) return 0;
    core::stepper::SimulationOptions nothing;
    nothing.steps = 0;
    const core::stepper::Trajectory start = core::stepper::simulate(*model, nothing).trajectory;
    core::clearance::ClearanceOptions options;
    options.measure_overlap = false;
    std::vector<double> plays;
    for (const auto& pair : core::clearance::certify(*model, start, pairs_that_may_meet(*model), options)) {
        if (pair.lower > 0 && pair.upper < fit_reach * model->dhat) plays.push_back(pair.upper);
    }
    if (plays.empty()) return 0;
    const auto middle = plays.begin() + static_cast<long>((plays.size() - 1) / 2);
    std::nth_element(plays.begin(), middle, plays.end());
    return *middle;
}

std::vector<SmootherDesign> smoother_models(const DesignProblem& problem, const VectorX& p) {
    std::vector<SmootherDesign> models;
    const Result<core::model::Model> model = problem.model_at(p);
    if (!model) return models;
    const double widest = widest_share * play_of_fits(problem, p);
    for (int k = 0; std::ldexp(widest, -k) > worth_a_stage * model->dhat; ++k) {  // halved each time, exactly
        const double width = std::ldexp(widest, -k);
        Result<DesignProblem> wide = problem.with_contact_width(width);
        if (!wide) continue;
        models.push_back({name_of_width(problem, width), width, std::move(wide).value()});
    }
    return models;
}

PlayTakenUp play_taken_up(const DesignProblem& problem, const DesignEvaluation& at) {
    PlayTakenUp out;
    const core::model::Model& model = *at.runs.front().model;
    const Fits fits = fits_of(model);
    const double width = widest_share * std::min(fits.play(), fits.nearest_other), least = worth_a_stage * model.dhat;
    if (!(widest_share * fits.play() > least)) return out;
    if (!(width > least)) {
        out.why_not = "contact that reaches farther would reach across a gap of " +
                      core::base::length_text(fits.nearest_other, problem.design().scene.length_unit) + " that is none of a fit's";
        return out;
    }
    for (const Run& run : at.runs)
        if (const auto touching = touching_without_fit(*run.model, run.simulation.trajectory, fits)) {
            out.why_not = "`" + model.bodies[touching->a].name + "` and `" + model.bodies[touching->b].name +
                          "` touch from one side, which contact that reaches farther changes as well";
            return out;
        }
    Result<DesignProblem> wide = problem.with_contact_width(width, DesignProblem::Surfaces::as_written);
    if (wide) out.model = {name_of_width(problem, width), width, std::move(wide).value()};
    return out;
}

}  // namespace fettle::design::problem
