// SPDX-License-Identifier: MIT
// The examples, tuned by the program from the start of their files: what they end at must be feasible by the certificates that the
// program returns, and as good as the best that is known.
#include <catch2/catch.hpp>

#include "fettle/tests/support/program.hpp"
#include "fettle/tests/support/temporary_folder.hpp"

namespace {

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
    CHECK(json.at("objective").get<double>() < 1.005 * best_known);
    return json;
}

}  // namespace

TEST_CASE("the four-bar linkage is tuned to its path", "[slow]") {
    const nlohmann::json json = tuned("four_bar", 8.118);
    const nlohmann::json path = json.at("terms")[0];
    CHECK(path.at("name") == "marker_path coupler");
    CHECK(path.at("value").get<double>() < 0.01e-6);  // a tenth of a millimetre, half the play of a joint
}

TEST_CASE("the eccentric is tuned to its rise", "[slow]") { tuned("follower", 9.2767); }
