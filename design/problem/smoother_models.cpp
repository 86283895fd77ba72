// SPDX-License-Identifier: MIT
#include "fettle/design/problem/smoother_models.hpp"

#include <algorithm>
#include <cmath>

#include "fettle/core/base/text.hpp"
#include "fettle/core/clearance/clearance.hpp"

namespace fettle::design::problem {

namespace {

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
    for (const auto& pair : core::clearance::certify_clearance(*model, start, pairs_that_may_meet(*model), options)) {
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
        const std::string name = "contact " + core::base::length_text(width, problem.design().scene.length_unit) + " wide";
        models.push_back({name, width, std::move(wide).value()});
    }
    return models;
}

}  // namespace fettle::design::problem
