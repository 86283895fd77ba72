// SPDX-License-Identifier: MIT
// Searches that end where the answer is known: the answers are those of searches to the tolerance, the bounds are true, and so are the
// certificates.
#include "core/clearance/stop_rule.hpp"

#include <functional>

#include "core/certificate/certificate_checker.hpp"
#include "core/clearance/range_clearance.hpp"
#include "core/clearance/toleranced_clearance.hpp"
#include "tests/core/clearance/random_tolerances.hpp"
#include "tests/core/clearance/tumbling_boxes.hpp"

namespace fettle::core::clearance::stop_rule_test {

using namespace fettle::tests::tolerances;

namespace {

// The same bodies over a path, over ranges of joints and over tolerances.
struct Question {
    std::string name;
    const model::Model& model;
    const stepper::Trajectory trajectory;
    PairRequest request;
    ClearanceOptions options;
    std::function<ProvenClearances(const std::vector<PairRequest>&, const ClearanceOptions&, bool proof)> certify;

    PairClearance answer(double minimum, const ClearanceOptions& with) const {
        PairRequest asked = request;
        asked.minimum = minimum;
        return certify({asked}, with, false).pairs.front();
    }
};

void check_against(const Question& question, double minimum, const PairClearance& exact) {
    ClearanceOptions options = question.options;
    options.answer_is_enough = true;
    const PairClearance full = question.answer(minimum, question.options), found = question.answer(minimum, options);
    INFO(question.name << ", minimum " << minimum << ": " << found.lower << " to " << found.upper << " in " << found.bounds << "; exactly "
                       << exact.lower << " to " << exact.upper << ", in " << full.bounds);
    CHECK(found.status == full.status);
    CHECK(found.lower <= exact.upper);
    CHECK(found.upper >= exact.lower);
    CHECK(found.bounds <= full.bounds);
    const StopRule rule{minimum, true};
    if (found.status != PairStatus::undecided && found.complete)
        CHECK(found.upper - found.lower <= std::max(rule.gap(options.tolerance, found.upper, 0), std::abs(found.upper - minimum)) + 1e-12);
    PairRequest asked = question.request;
    asked.minimum = minimum;
    const ProvenClearances proven = question.certify({asked}, options, true);
    const PairClearance& claimed = proven.pairs.front();
    CHECK(claimed.status == full.status);
    CHECK(claimed.lower <= exact.upper);
    if (proven.certificate.pairs.empty()) return;
    const auto report = certificate::check_certificate(proven.certificate, question.model, question.trajectory);
    for (const auto& fault : report.faults) UNSCOPED_INFO(fault.where << ": " << fault.message);
    CHECK(report.accepted());
    CHECK(proven.certificate.pairs.front().lower == claimed.lower);
}

void check(const Question& question) {
    const PairClearance exact = question.answer(0, question.options);
    if (!std::isfinite(exact.upper) || exact.is_clash() || !exact.complete) return;
    for (const double share : {0.01, 0.5, 0.97, 1.05, 3.0}) check_against(question, share * exact.upper, exact);
}

}  // namespace

TEST_CASE("A tenth of what is above the minimum is the gap that ends a search") {
    std::mt19937 random(5);
    const auto uniform = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
    for (int i = 0; i < 1000; ++i) {
        const double minimum = uniform(0.1, 1), lower = minimum + uniform(0, 1), upper = lower + uniform(0, 0.2);
        const StopRule rule{minimum, true};
        const double room = (upper - lower) - 0.1 * (lower - minimum);
        if (std::abs(room) > 1e-12) CHECK((upper - lower <= rule.gap(0, upper, 0)) == (room < 0));
        CHECK(rule.gap(10, upper, 0) == 10);
        CHECK(rule.is_answered(lower, upper));
        CHECK_FALSE(StopRule{upper, true}.is_answered(lower, upper));
        CHECK(StopRule{upper + 1e-9, true}.is_answered(lower, upper));
    }
    const StopRule patient{0.1, true, 100, 200};
    CHECK(patient.gap(1e-6, 1, 99) == 1e-6);  // what is quick is measured
    CHECK(patient.gap(1e-6, 1, 100) > 1e-6);
    CHECK_FALSE(patient.ends(0.1, 1, 199));
    CHECK(patient.ends(0.1, 1, 200));
    CHECK_FALSE(patient.ends(0.05, 1, 1000));
    CHECK_FALSE(StopRule{0.1, false}.ends(0.1, 1, 1000));
    CHECK(StopRule{0.1, true}.gap(1e-6, std::numeric_limits<double>::infinity(), 0) == 1e-6);  // nothing is known yet
    CHECK_FALSE(StopRule{0, true}.is_answered(0.8, 1));                                        // without a minimum: how far, about
    CHECK(StopRule{0, true}.is_answered(0.95, 1));
    CHECK_FALSE(StopRule{0, true}.is_answered(0, 0));
    const double nan = std::numeric_limits<double>::quiet_NaN();
    CHECK_FALSE(patient.is_answered(nan, nan));
}

TEST_CASE("An answer that is enough is the answer, over paths, ranges and tolerances, and its certificate is accepted") {
    std::mt19937 random(8);
    for (int i = 0; i < 6; ++i) {
        const TolerancedTree tree = random_toleranced_tree(random, 3e-4);
        ClearanceOptions options;
        options.tolerance = 1e-3 * (tree.tree.model.bodies[tree.a].radius + tree.tree.model.bodies[tree.b].radius);
        options.max_bounds = 30'000;
        check({"tolerances " + std::to_string(i),
               tree.tree.model,
               as_assembled(tree.tree.model),
               {tree.a, tree.b},
               options,
               [&](const auto& pairs, const ClearanceOptions& with, bool proof) -> ProvenClearances {
                   if (proof) return certify_with_proof(tree.tree.model, tree.toleranced, pairs, with);
                   return {certify(tree.tree.model, tree.toleranced, pairs, with), {}};
               }});
        options.tolerance = 1e-6;
        options.max_bounds = 200'000;
        check({"ranges " + std::to_string(i),
               tree.tree.model,
               as_assembled(tree.tree.model),
               {tree.a, tree.b},
               options,
               [&](const auto& pairs, const ClearanceOptions& with, bool proof) -> ProvenClearances {
                   if (proof) return certify_with_proof(tree.tree.model, tree.tree.ranges, pairs, with);
                   return {certify(tree.tree.model, tree.tree.ranges, pairs, with), {}};
               }});
    }
    for (unsigned seed = 1; seed <= 6; ++seed) {
        const auto scene = tests::clearance::tumbling(6, 3, seed);
        ClearanceOptions options;
        options.motion = true;
        options.sample_nodes = false;
        for (int b = 3; b < 6; ++b)
            check({"path " + std::to_string(seed),
                   scene.model,
                   scene.trajectory,
                   {0, b},
                   options,
                   [&](const auto& pairs, const ClearanceOptions& with, bool proof) -> ProvenClearances {
                       if (proof) return certify_with_proof(scene.model, scene.trajectory, pairs, with);
                       return {certify(scene.model, scene.trajectory, pairs, with), {}};
                   }});
    }
}

}  // namespace fettle::core::clearance::stop_rule_test
