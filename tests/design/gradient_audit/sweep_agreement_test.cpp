// SPDX-License-Identifier: MIT
#include "fettle/design/gradient_audit/sweep_agreement.hpp"

#include <catch2/catch.hpp>

#include "fettle/tests/design/small_problem.hpp"

namespace fettle::design::gradient_audit::sweep_agreement_test {

using namespace fettle::tests::design_support;

TEST_CASE("backwards and forwards agree on a design's own simulation", "[gradient]") {
    const std::string rubbing = replaced(small_scene, R"("end_time": 0.1,)", R"("end_time": 0.1, "friction": { "mu": 0.3 },)");
    for (const std::string& scene : {std::string(small_scene), rubbing}) {
        const DesignFolder folder(small_design, scene);
        const problem::DesignProblem problem = problem_of(folder);
        const VectorX p = description::values_of(problem.design().parameters);
        problem::DesignEvaluation at = problem.evaluate(p);
        INFO(at.reason);
        REQUIRE(at.usable);
        const SweepAgreement agreement = compare_sweeps(problem, at);
        CAPTURE(agreement.quantity, agreement.disagreement);
        CHECK(agreement.failure.empty());
        CHECK(agreement.disagreement > 0);
        CHECK(agreement.disagreement < 1e-9);

        // What neither can differentiate is told.
        at.runs.front().simulation.trajectory.poses[3][1].position.z() += 1e-6;
        at.runs.front().simulation.trajectory.steps[2].nodes.back()[1].position.z() += 1e-6;
        CHECK(compare_sweeps(problem, at).failure.find("out of balance") != std::string::npos);
    }
}

TEST_CASE("backwards and forwards agree on what friction carries, by every integrator", "[gradient]") {
    std::string design = small_design;
    const size_t objective = design.find(R"("objective": [)") + std::string(R"("objective": [)").size();
    design.insert(objective, R"(
    { "type": "contact_force", "body": "cube", "of": "table", "axis": [1, 0, 0], "over": "end", "weight": 1 },
    { "type": "contact_torque", "body": "cube", "of": "table", "point": [3, 2, 1], "axis": [0, 1, 0], "over": "mean", "weight": 1 },)");
    for (const char* integrator : {"implicit_euler", "bdf2", "newmark"})
        for (const char* rounds : {"1", "3", R"("converged")"}) {
            std::string scene = replaced(small_scene, R"("end_time": 0.1,)",
                                         R"("end_time": 0.1, "integrator": "I", "friction": { "mu": 0.3, "rounds": R },)");
            scene = replaced(replaced(scene, R"("I")", "\"" + std::string(integrator) + "\""), "\"rounds\": R",
                             "\"rounds\": " + std::string(rounds));
            const DesignFolder folder(design, scene);
            const problem::DesignProblem problem = problem_of(folder);
            const problem::DesignEvaluation at = problem.evaluate(description::values_of(problem.design().parameters));
            INFO(integrator << ", rounds " << rounds << ": " << at.reason);
            REQUIRE(at.usable);
            const SweepAgreement agreement = compare_sweeps(problem, at);
            CAPTURE(agreement.quantity, agreement.disagreement, agreement.failure);
            CHECK(agreement.failure.empty());
            CHECK(agreement.disagreement < 1e-8);
        }
}

}  // namespace fettle::design::gradient_audit::sweep_agreement_test
