// SPDX-License-Identifier: MIT
#include "design/studies/judged_design.hpp"

#include <utility>

#include "design/problem/smoother_models.hpp"

namespace fettle::design::studies {

using description::Design;
using problem::DesignEvaluation;

JudgedDesign judge_design(const problem::DesignProblem& problem, const VectorX& p, const JudgeOptions& options) {
    problem::EvaluateOptions once;
    once.gradients = false;
    once.balance = true;
    once.on_step = options.on_step;
    return judge_design(problem, problem.evaluate(p, once), options);
}

JudgedDesign judge_design(const problem::DesignProblem& problem, DesignEvaluation evaluated, const JudgeOptions& options) {
    JudgedDesign judged;
    judged.final = std::move(evaluated);
    if (!judged.final.usable) return judged;
    for (const description::Measurement& measured : judged.final.constraints)
        if (measured.clearance) judged.clearance.push_back(*measured.clearance);
    const problem::PlayTakenUp compared = problem::play_taken_up(problem, judged.final);
    judged.play_not_compared = compared.why_not;
    if (!compared.model) return judged;
    problem::EvaluateOptions once;
    once.gradients = false;
    once.balance = true;
    once.on_step = options.on_step;
    once.should_stop = options.should_stop;
    judged.play_taken_up_by = compared.model->name;
    judged.play_taken_up = compared.model->problem.evaluate(judged.final.parameters, once);
    judged.in_doubt = requirements_in_doubt(problem.design(), judged.final, judged.play_taken_up);
    return judged;
}

std::vector<size_t> requirements_in_doubt(const Design& design, const DesignEvaluation& own, const DesignEvaluation& other) {
    std::vector<size_t> doubtful;
    if (!own.usable || !other.usable) return doubtful;
    for (size_t i = 0; i < design.constraints.size(); ++i) {
        const description::Bounds& bounds = design.constraints[i].bounds;
        if (design.constraints[i].quantity->is_at_rest()) continue;
        const bool met = description::violation(bounds, own.constraints[i]) <= 0;
        const description::Measurement value = description::computed(other.constraints[i].value);  // it is no proof of anything
        if (met && description::violation(bounds, value) > 0) doubtful.push_back(i);
    }
    return doubtful;
}

}  // namespace fettle::design::studies
