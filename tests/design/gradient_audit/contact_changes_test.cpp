// SPDX-License-Identifier: MIT
// Contacts made to change at moves of a parameter that are known beforehand.
#include "design/gradient_audit/contact_changes.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "design/gradient_audit/difference_check.hpp"
#include "tests/design/small_problem.hpp"

namespace fettle::design::gradient_audit::contact_changes_test {

namespace {

using namespace fettle::tests::design_support;
using Kind = ContactFeature::Kind;

// A block that is held but along y, over a table: `place` is its pose, `parameter` the only one of the design. Range: 10 of its unit.
CheckReport checked(const std::string& place, const std::string& parameter, const std::string& table = R"("type": "static")") {
    const std::string scene = R"({
  "fettle_scene": 1, "units": "mm", "gravity": [0, 0, 0], "timestep": 0.001, "end_time": 0.003,
  "contact": { "dhat": 0.1, "kappa": 100 }, "friction": { "mu": 0.2 },
  "bodies": [
    { "name": "table", "shape": { "part": "box", "dimensions": { "size_x": 60, "size_y": 60, "size_z": 10 } },
      "position": [0, 0, -5], )" +
                              table + R"( },
    { "name": "block", "density": 1000, "fixed": ["px", "pz", "rx", "ry", "rz"],
      "shape": { "part": "box", "dimensions": { "size_x": 20, "size_y": 12, "size_z": 10 } }, )" +
                              place + R"( }
  ]
})";
    const std::string design = R"({
  "fettle_design": 1, "scene": "small.scene.json", "units": "mm",
  "parameters": [ { "name": "p", )" +
                               parameter + R"( },
  "objective": [ { "type": "mass", "bodies": ["block"], "weight": 1 } ],
  "constraints": [ { "type": "stroke", "body": "block", "axis": [0, 1, 0], "lower": 0, "upper": 30 } ]
})";
    const DesignFolder folder(design, scene);
    const problem::DesignProblem problem = problem_of(folder);
    const VectorX p = description::values_of(problem.design().parameters);
    const problem::DesignEvaluation at = problem.evaluate(p);
    INFO(at.reason);
    REQUIRE(at.usable);
    return check_gradients(problem, p, at);
}

const ContactChange* find(const CheckReport& report, ContactEvent event) {
    const auto at = std::find_if(report.contact_changes.begin(), report.contact_changes.end(),
                                 [=](const ContactChange& c) { return c.at.event == event; });
    return at == report.contact_changes.end() ? nullptr : &*at;
}

// The change lies at this move of the parameter, and between the two that are told.
void check_found(const CheckReport& report, ContactEvent event, double move) {
    const ContactChange* change = find(report, event);
    CAPTURE(report.contact_changes.size());
    REQUIRE(change != nullptr);
    CAPTURE(change->from, change->to, move, sentence_of(*change));
    CHECK(change->parameter == "p");
    CHECK(change->body_a == "table");
    CHECK(change->body_b == "block");
    CHECK(std::abs(change->from) < std::abs(move));
    CHECK(std::abs(move) <= std::abs(change->to));
    CHECK(change->to * move > 0);
    CHECK(report.contacts_reach(0, move > 0 ? 1 : 0) == 1e-2);
}

}  // namespace

TEST_CASE("contact changes: what comes within reach, and what leaves it", "[contact]") {
    const std::string height = R"("value": 5, "lower": 0, "upper": 10 } ], "set": { "/bodies/block/position/2": "= p + )";
    const CheckReport apart = checked(R"("position": [0, 0, 5.12])", height + "0.12\"");
    check_found(apart, ContactEvent::touch, -2e-5);
    CHECK(apart.contact_changes.size() == 1);
    CHECK(apart.contact_changes[0].count == 4 * 3);  // vertices, steps
    CHECK(apart.contact_changes[0].time == Approx(0.001));
    CHECK(apart.contact_changes[0].at.is.on_a.kind == Kind::face);
    CHECK(apart.contact_changes[0].at.is.on_b.kind == Kind::vertex);
    CHECK_FALSE(is_kink(ContactEvent::touch));
    const CheckReport close = checked(R"("position": [0, 0, 5.07])", height + "0.07\"");
    check_found(close, ContactEvent::part, 3e-5);
    CHECK(close.contact_changes.size() == 1);
    CHECK(close.contacts_reach(0, 0) == Approx(1e-3));  // farther down they would intersect
    // Farther than a hundredth of the range: nothing is about to change.
    CHECK(checked(R"("position": [0, 0, 5.3])", height + "0.3\"").contact_changes.empty());
}

TEST_CASE("contact changes: a corner that leaves a face for its edge", "[contact]") {
    const CheckReport report = checked(R"("position": [19.98, 0, 5.05])",
                                       R"("value": 19.98, "lower": 15, "upper": 25 } ], "set": { "/bodies/block/position/0": "= p")");
    check_found(report, ContactEvent::new_features, 2e-5);
    const ContactChange& change = *find(report, ContactEvent::new_features);
    CHECK(change.at.was.on_a.kind == Kind::face);
    CHECK(change.at.is.on_a.kind == Kind::edge);
    CHECK(is_kink(change.at.event));
    CHECK(sentence_of(change).find(
              "at t = 0.001 s 'table' and 'block' touch elsewhere, an edge of 'table' on an edge of 'block' in place of a "
              "face of 'table' on a vertex of 'block', near (30") == 0);
}

TEST_CASE("contact changes: what begins to slide, and what begins to stick", "[contact]") {
    const auto driven = [](double speed) {
        const std::string rate = std::to_string(speed);
        return checked(
            R"("position": [0, 0, 5.05])",
            "\"value\": " + rate + R"(, "lower": 0, "upper": 10, "unit": "mm/s" } ], "set": { "/bodies/table/prescribed/px/rate": "= p")",
            R"("type": "kinematic", "prescribed": { "px": { "rate": )" + rate + " } }");
    };
    check_found(driven(0.95), ContactEvent::slide, 5e-5);
    CHECK(driven(0.95).contact_changes.size() == 1);
    check_found(driven(1.03), ContactEvent::stick, -3e-5);
}

TEST_CASE("contact changes: edges that become nearly parallel", "[contact]") {
    // The block's lower edge crosses the table's upper one at an angle just above the mollifier's.
    const double limit = std::asin(std::sqrt(1e-3)) * 180 / std::acos(-1.0);
    const std::string angle = std::to_string(limit + 0.02);
    const CheckReport report =
        checked(R"("position": [20, 0, 5.05], "rotation": [0, 0, )" + angle + "]",
                R"("value": 0, "lower": -5, "upper": 5, "unit": "deg" } ], "set": { "/bodies/block/rotation/2": "= p + )" + angle + "\"");
    check_found(report, ContactEvent::parallel, -0.02 * std::acos(-1.0) / 180);
    CHECK(is_kink(ContactEvent::parallel));
    CHECK(find(report, ContactEvent::crossing) == nullptr);
}

TEST_CASE("contact changes: of two sets of contacts, each change is one", "[contact]") {
    const auto contact = [](int on_a, int on_b) {
        ContactState s;
        s.b = 1;
        s.on_a = {Kind::face, {on_a, on_a + 1, on_a + 2}};
        s.on_b = {Kind::vertex, {on_b}};
        return s;
    };
    const std::vector<std::vector<ContactState>> before{{contact(0, 3), contact(0, 5)}, {contact(0, 3)}};
    std::vector<std::vector<ContactState>> after{{contact(0, 3), contact(2, 5)}, {contact(0, 3), contact(8, 9)}};
    after[1][0].slides = true;
    const std::vector<ContactDifference> found = contact_differences(before, after);
    REQUIRE(found.size() == 3);
    CHECK(found[0].event == ContactEvent::new_features);
    CHECK(found[0].step == 0);
    CHECK(found[1].event == ContactEvent::slide);
    CHECK(found[2].event == ContactEvent::touch);
    CHECK(found[2].step == 1);
    CHECK(found[2].others);
    after[1].pop_back();
    std::vector<std::vector<ContactState>> none{{}, {contact(0, 3)}};
    CHECK_FALSE(contact_differences(none, before)[0].others);
    CHECK_FALSE(contact_differences(before, none)[0].others);
    CHECK(contact_differences(before, before).empty());
    CHECK(contact_differences(after, before).size() == 2);
}

}  // namespace fettle::design::gradient_audit::contact_changes_test
