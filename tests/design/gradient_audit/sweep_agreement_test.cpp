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
        at.simulation.trajectory.poses[3][1].position.z() += 1e-6;
        at.simulation.trajectory.steps[2].nodes.back()[1].position.z() += 1e-6;
        CHECK(compare_sweeps(problem, at).failure.find("out of balance") != std::string::npos);
    }
}

}  // namespace fettle::design::gradient_audit::sweep_agreement_test
