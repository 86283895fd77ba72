// SPDX-License-Identifier: MIT
#include "design/studies/sample_maker.hpp"

#include <utility>

#include "design/description/independent_inputs.hpp"
#include "design/studies/tolerance_file.hpp"

namespace fettle::design::studies {

Result<SampleMaker> SampleMaker::create(reading::DesignFile file, std::uint64_t seed) {
    if (file.tolerances.empty()) return no_tolerances(file);
    Result<problem::DesignProblem> problem = problem::DesignProblem::create(file.design);
    if (!problem) return problem.errors();
    SampleMaker out;
    out.header_ = samples_header(file, problem->design(), seed);
    out.file_ = std::make_shared<const reading::DesignFile>(std::move(file));
    out.problem_ = std::make_shared<const problem::DesignProblem>(std::move(problem).value());
    return out;
}

std::string SampleMaker::line_of(int sample, const std::function<bool()>& should_stop) const {
    const MadeResponses made(*problem_, file_->tolerances, should_stop);
    MadeEvaluation evaluation = made.evaluate(description::DeviationSamples(file_->tolerances, header_.seed).at(sample), false);
    if (evaluation.interrupted) return {};
    SampleOutcome outcome;
    outcome.values = std::move(evaluation.values);
    outcome.met = std::move(evaluation.met);
    outcome.reason = std::move(evaluation.reason);
    return sample_line(sample, outcome);
}

}  // namespace fettle::design::studies
