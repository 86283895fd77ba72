// SPDX-License-Identifier: MIT
#include "design/studies/tolerance_file.hpp"

#include <optional>
#include <utility>

#include "design/reading/design_text.hpp"

namespace fettle::design::studies {

Error no_tolerances(const reading::DesignFile& file) {
    if (!file.untoleranced.empty()) {
        std::string all;
        for (const reading::Untoleranced& each : file.untoleranced) all += (all.empty() ? "" : "; ") + each.name + ": " + each.why;
        return {ErrorCode::out_of_range, file.path, "\"*\" of its `tolerances` gives none to any of its numbers (" + all + ")"};
    }
    return {ErrorCode::missing_key, file.path,
            "it has no `tolerances`: say, for instance, \"tolerances\": {\"pin_radius\": \"+-0.05 mm\"}, by names of parameters or "
            "variables, or by places of the scene (\"/bodies/pin/shape/dimensions/radius\"); \"*\": {\"general\": \"m\"} is every length "
            "without one"};
}

SampleFileHeader samples_header(const reading::DesignFile& file, const description::Design& design, std::uint64_t seed) {
    SampleFileHeader header{reading::design_hash(file), seed, file.tolerances, {}};
    for (const AskedNumber& number : asked_numbers(design)) header.responses.push_back(number.name);
    return header;
}

Result<ToleranceReport> study_tolerances(const reading::DesignFile& file, const std::string& samples_file, ToleranceOptions options) {
    if (file.tolerances.empty()) return no_tolerances(file);
    const Result<problem::DesignProblem> problem = problem::DesignProblem::create(file.design);
    if (!problem) return problem.errors();
    std::optional<SampleFile> samples;
    if (!samples_file.empty()) {
        Result<SampleFile> opened = SampleFile::open(samples_file, samples_header(file, problem->design(), options.seed));
        if (!opened) return opened.errors();
        options.file = &samples.emplace(std::move(opened).value());
    }
    ToleranceReport report = study_tolerances(*problem, file.tolerances, options);
    if (Errors errors = samples ? samples->unwritten() : Errors{}; !errors.empty()) return errors;
    return report;
}

Result<AllocationReport> allocate(const reading::DesignFile& file, const AllocationOptions& options) {
    if (file.tolerances.empty()) return no_tolerances(file);
    const Result<problem::DesignProblem> problem = problem::DesignProblem::create(file.design);
    if (!problem) return problem.errors();
    return allocate(*problem, file.tolerances, options);
}

}  // namespace fettle::design::studies
