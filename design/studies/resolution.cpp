// SPDX-License-Identifier: MIT
#include "fettle/design/studies/resolution.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "fettle/core/part_files/part_file.hpp"
#include "fettle/design/problem/design_problem.hpp"

namespace fettle::design::studies {

namespace {

using description::Design;
using problem::DesignEvaluation;
using problem::DesignProblem;

constexpr int times = 2;

// Settings of contact that the scene leaves open would be chosen anew, for another step and other meshes.
void take_contact(const DesignProblem& from, Design& design) {
    const auto take = [&](const core::scene::Scene& own, int scenario, core::scene::Scene& scene) {
        scene.dhat = own.dhat;
        scene.velocity_tolerance = own.velocity_tolerance;
        scene.kappa = from.kappa(scenario);
    };
    if (design.scenarios.empty()) take(from.design().scene, 0, design.scene);
    for (int s = 0; s < count_of(design.scenarios); ++s) take(from.design().scenarios[s].scene, s, design.scenarios[s].scene);
}

std::vector<std::string> fixed_meshes(const Design& design) {
    std::vector<std::string> names;
    for (const core::scene::Body& body : design.scene.bodies)
        if (!body.shape || body.shape->part.empty()) names.push_back(body.name);
    return names;
}

}  // namespace

double ResolvedQuantity::change() const {
    const double size = std::max(std::abs(as_written), std::abs(finer_both));
    return size > 0 ? std::abs(finer_both - as_written) / size : 0;
}

Result<ResolutionReport> check_resolution(const std::string& path, reading::DesignReadOptions read, const ResolutionOptions& options) {
    struct Variant {
        const char* name;
        reading::Resolution resolution;
        double ResolvedQuantity::*value;
    };
    const Variant variants[] = {{"as written", {1, 1}, &ResolvedQuantity::as_written},
                                {"with twice the facets", {times, 1}, &ResolvedQuantity::finer_facets},
                                {"with half the time step", {1, times}, &ResolvedQuantity::finer_steps},
                                {"with both", {times, times}, &ResolvedQuantity::finer_both}};
    read.made.reset();  // whose parts have other facets
    ResolutionReport report;
    std::optional<DesignProblem> written;
    for (const Variant& variant : variants) {
        if (options.on_variant) options.on_variant(variant.name);
        read.resolution = variant.resolution;
        Result<reading::DesignFile> file = reading::read_design(path, read);
        if (!file) return file.errors();
        if (written) take_contact(*written, file->design);
        Result<DesignProblem> problem = DesignProblem::create(std::move(file->design));
        if (!problem) return problem.errors();
        problem::EvaluateOptions evaluate;
        evaluate.gradients = false;
        evaluate.should_stop = options.should_stop;
        const Design& design = problem->design();
        const DesignEvaluation at = problem->evaluate(description::values_of(design.parameters), evaluate);
        if (!at.usable) {
            report.failure = std::string(variant.name) + ": " + at.reason;
            report.interrupted = at.interrupted;
            return report;
        }
        if (!written) {
            for (const auto& term : design.objective) report.quantities.push_back({term.name, true, count_of(report.quantities)});
            for (size_t i = 0; i < design.constraints.size(); ++i)
                report.quantities.push_back({design.constraints[i].name, false, static_cast<int>(i)});
            report.fixed_meshes = fixed_meshes(design);
            written.emplace(std::move(problem).value());
        }
        for (ResolvedQuantity& quantity : report.quantities)
            quantity.*variant.value = (quantity.of_objective ? at.terms : at.constraints)[quantity.index].value;
    }
    return report;
}

}  // namespace fettle::design::studies
