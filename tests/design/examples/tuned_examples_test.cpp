// SPDX-License-Identifier: MIT
// The examples, tuned by the program from the start of their files: what they end at must be feasible by the certificates that the
// program returns, and as good as the best that is known.
#include <catch2/catch.hpp>

#include "design/optimisers/optimisation.hpp"
#include "design/problem/optimiser_problem.hpp"
#include "design/reading/design_reader.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fettle::design::examples::tuned_examples_test {

namespace {

using namespace fettle::design::optimisers;
using fettle::design::problem::DesignProblem;
using fettle::design::reading::read_design;
using fettle::tests::support::Answer;

nlohmann::json tuned(const std::string& name, double best_known) {
    const fettle::tests::support::TemporaryFolder folder;
    const Answer answer =
        fettle::tests::support::run("optimise examples/" + name + "/" + name + ".design.json --json --out " + folder.file("out"));
    const nlohmann::json json = answer.json();
    CAPTURE(json.dump(1));
    CHECK(json.at("constraint_violation_start") > 0);
    CHECK(json.at("constraint_violation") == 0);
    for (const auto& constraint : json.at("constraints")) CHECK(constraint.at("met") == true);
    CHECK(json.at("clearance").at("status") == "clear");
    CHECK(json.at("objective").get<double>() < 1.001 * best_known);
    CHECK(json.at("status") == "optimal");
    CHECK(json.at("evaluations").get<int>() <= 60);
    return json;
}

// Leaves a design where it is: what remains is the verdict.
class Idle : public Optimiser {
public:
    std::string name() const override { return "idle"; }
    NativeOutcome minimise(Evaluator&, const OptimiserOptions&) const override { return {}; }
};

}  // namespace

TEST_CASE("where an optimiser stopped short, the design is called feasible, not optimal, and what could move is named", "[slow]") {
    auto file = read_design("examples/slider_crank/slider_crank.design.json", {});
    REQUIRE(file);
    // Where an interior-point method ends that knows nothing of how rough the stroke is, moved by 0.02 mm in journal_radius, 0.1 in
    // crank_radius, 0.04 in rod_length and 0.05 in piston_length, so that the motion within the play leaves rod and block their millimetre.
    const double millimetres[] = {5.122, 4.13335901529852, 3.1247302191549657, 14.43, 41.4, 20.7, 9.78168131970727};
    const auto problem = DesignProblem::create(std::move(file->design));
    REQUIRE(problem);
    auto seen = fettle::design::problem::optimiser_problem(*problem);
    for (int k = 0; k < 7; ++k) seen.start[k] = 1e-3 * millimetres[k];
    OptimiserOptions options;
    options.max_evaluations = 30;
    const OptimiserReport report = optimise(seen, Idle(), options);
    CHECK(report.start.objective == Approx(16.689).epsilon(1e-3));
    CHECK(report.status == OptimiserStatus::feasible);
    std::vector<std::string> named;
    for (const int k : report.optimality.improvable) named.push_back(problem->design().parameters[k].name);
    REQUIRE(!named.empty());
    CHECK(std::find(named.begin(), named.end(), "piston_length") != named.end());
    CHECK(report.optimality.step[5] < 0);
}

TEST_CASE("the slider-crank is tuned to its stroke", "[slow]") {
    const nlohmann::json json = tuned("slider_crank", 16.0009);
    CHECK(json.at("optimality").at("held_by").at("piston_length") == "lower bound");
    CHECK(json.at("stages").size() == 3);
    // Play in three joints: the stroke with it taken up is another one than that of parts that rattle within it.
    const auto& stroke = json.at("by_models").at("constraints").back();
    CHECK(stroke.at("name") == "stroke piston");
    CHECK(stroke.at("as_written").get<double>() == Approx(0.03).margin(0.00005));
    CHECK(stroke.at("play_taken_up").get<double>() == Approx(0.029).margin(0.0005));
    CHECK(stroke.at("play_taken_up") != stroke.at("as_written"));
    CHECK(json.at("by_models").at("in_doubt") == nlohmann::json({"stroke piston"}));
}

TEST_CASE("the four-bar linkage is tuned to its path", "[slow]") {
    const nlohmann::json json = tuned("four_bar", 8.118);
    const nlohmann::json path = json.at("terms")[0];
    CHECK(path.at("name") == "marker_path coupler");
    CHECK(path.at("value").get<double>() < 0.01e-6);  // a tenth of a millimetre, half the play of a joint
}

TEST_CASE("the eccentric is tuned to its rise", "[slow]") { tuned("follower", 9.2767); }

}  // namespace fettle::design::examples::tuned_examples_test
