// SPDX-License-Identifier: MIT
#include "design/studies/made_sample.hpp"

#include <catch2/catch.hpp>

#include "core/stepper/simulate.hpp"
#include "design/description/independent_inputs.hpp"
#include "design/problem/design_problem.hpp"
#include "design/studies/tolerance_file.hpp"
#include "tests/design/small_design.hpp"

namespace fettle::design::studies::made_sample_test {

using namespace fettle::tests::design_support;

TEST_CASE("a made sample: what it is simulated to is the kept sample, bit for bit") {
    const std::string entry =
        R"("tolerances": {"height": "+-0.1 mm", "width": "+-0.5 mm", "speed": {"lower": -2, "upper": 2}}, "optimiser")";
    const DesignFolder folder(replaced(small_design, "\"optimiser\"", entry));
    reading::DesignReadOptions read;
    read.as_made = true;
    const auto file = reading::read_design(folder.design(), read);
    REQUIRE(file);
    ToleranceOptions options;
    options.samples = 4;
    options.seed = 11;
    options.second_order = false;
    const auto report = study_tolerances(*file, folder.file("samples.jsonl"), options);
    REQUIRE(report);
    REQUIRE(report->samples.size() == 4);
    for (const int k : {0, 3}) {
        const auto made = load_made(folder.design(), {}, {k, 1, folder.file("samples.jsonl"), ""});
        for (const Error& error : made.errors()) UNSCOPED_INFO(error.where << ": " << error.message);
        REQUIRE(made);
        CHECK(made->seed == 11);
        CHECK((made->deviations.array() == report->samples[k].deviations.array()).all());
        // Simulated as `fettle simulate` does it, and measured.
        core::stepper::SimulationOptions simulate;
        simulate.steps = made->loaded.steps;
        simulate.outputs = simulate.last_outputs_only = true;
        problem::DesignEvaluation evaluation;
        const description::Design& design = made->loaded.problem->design();
        evaluation.parameters = description::with_deviations(design, made->tolerances, made->deviations);
        problem::Run run;
        run.model = std::make_shared<const core::model::Model>(made->loaded.model);
        run.simulation = core::stepper::simulate(*run.model, simulate);
        evaluation.runs.push_back(std::move(run));
        const problem::SimulatedDesign simulated(design, evaluation);
        REQUIRE(design.constraints.size() == 5);  // one of two windows
        for (int i = 0; i < 5; ++i) {
            INFO(design.constraints[i].name);
            const double value = design.constraints[i].quantity->value(simulated.in(0)).value;
            CHECK(value == report->samples[k].values[1 + i]);
            CHECK(value == made->kept->values[1 + i]);
        }
    }
}

}  // namespace fettle::design::studies::made_sample_test
