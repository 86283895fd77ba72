// SPDX-License-Identifier: MIT
#include "design/features/features_report.hpp"

#include <algorithm>

#include "core/base/parallel.hpp"
#include "core/features/fit_gap.hpp"
#include "core/model/body_geometry.hpp"
#include "design/reading/process_file.hpp"
#include "design/tolerances/known_processes.hpp"
#include "design/tolerances/process_clearance.hpp"

namespace fettle::design::features {

namespace {

using core::features::Feature;
using core::features::Features;
using core::parts::SurfaceKind;

double size_of(const core::model::Body& body) {
    const Matrix3X& x = body.mesh.vertices;
    return core::geometry::box_sides(x).maxCoeff();
}

ProcessVerdict verdict_of(const tolerances::Process& process, const core::model::Model& model, const core::features::Fit& fit) {
    ProcessVerdict out;
    out.process = process.name;
    const Result<double> required =
        tolerances::required_clearance(process, size_of(model.bodies[fit.pin.body]), size_of(model.bodies[fit.hole.body]), "--process");
    if (!required) {
        out.fault = required.errors().front().message;
        return out;
    }
    out.required = *required;
    out.is_enough = fit.facets_play >= *required;
    return out;
}

}  // namespace

std::string FeaturesReport::name_of(const core::features::FeatureOf& feature) const {
    return model.bodies[feature.body].name + "." + parts[feature.body].features[feature.feature].name;
}

Result<FeaturesReport> ask_features(const core::model::Model& model, const FeaturesQuestion& question) {
    std::vector<tolerances::Process> processes;
    if (!question.process.empty()) {
        const Result<tolerances::Process> process = reading::find_process(question.process, "", "--process");
        if (!process) return process.errors();
        processes.push_back(*process);
    } else {
        for (const tolerances::Process& process : tolerances::known_processes())
            if (process.clearance) processes.push_back(process);
    }
    FeaturesReport report{model, std::vector<Features>(model.bodies.size()), {}, question.process};
    const int count = count_of(model.bodies);
    const int at_once = std::max(2, core::base::thread_count());
    for (int first = 0; first < count && !report.interrupted; first += at_once) {
        if (question.on_body) question.on_body(first, count);
        core::base::parallel_for(std::min(at_once, count - first), 1, [&](int k) {
            const core::model::Body& body = model.bodies[first + k];
            report.parts[first + k] = core::features::find_features(core::model::mesh_at_start(body), question.options);
        });
        report.interrupted = question.should_stop();
    }
    if (!question.fits || report.interrupted) return report;
    const std::vector<core::features::Fit> fits = core::features::find_fits(report.parts);
    const std::vector<core::clearance::PairClearance> gaps = core::features::fit_gaps(model, report.parts, fits, question.should_stop);
    for (std::size_t k = 0; k < fits.size(); ++k) {
        FoundFit found{fits[k], gaps[k], {}};
        for (const tolerances::Process& process : processes) found.processes.push_back(verdict_of(process, model, fits[k]));
        report.fits.push_back(std::move(found));
    }
    report.interrupted = question.should_stop();
    return report;
}

FeaturesStatus status_of(const FeaturesReport& report) {
    if (report.interrupted) return FeaturesStatus::undecided;
    FeaturesStatus out = FeaturesStatus::ok;
    for (const FoundFit& fit : report.fits)
        for (const ProcessVerdict& verdict : fit.processes) {
            if (report.judged_by.empty() || verdict.is_enough) continue;
            if (verdict.fault.empty()) return FeaturesStatus::violated;
            out = FeaturesStatus::undecided;
        }
    return out;
}

const char* to_string(FeaturesStatus status) {
    switch (status) {
        case FeaturesStatus::ok:
            return "ok";
        case FeaturesStatus::violated:
            return "violated";
        case FeaturesStatus::undecided:
            return "undecided";
    }
    return "?";
}

std::string role_of(const Feature& feature) {
    if (feature.surface.kind == SurfaceKind::plane) return "plane";
    if (feature.surface.kind != SurfaceKind::cylinder) return feature.is_hole ? "hole" : "boss";
    if (feature.is_rounding) return feature.is_hole ? "fillet" : "rounding";
    return feature.is_hole ? "bore" : "pin";
}

}  // namespace fettle::design::features
