// SPDX-License-Identifier: MIT
// What values and gradients say before a search: of numbers that are given.
#include "design/gradient_audit/gradient_warnings.hpp"

#include <catch2/catch.hpp>

#include "tests/design/small_problem.hpp"

namespace fettle::design::gradient_audit::gradient_warnings_test {

namespace {

using namespace fettle::tests::design_support;
using description::Design;

// The small design: 4 constraints of two clearances, a stroke of 0 to 30 mm and a mass of 1.5 to 4 g; 5 parameters.
struct Numbers {
    Design design;
    VectorX values = VectorX::Zero(6);
    MatrixX gradients = MatrixX::Zero(6, 5);

    Numbers() : design(problem_of(DesignFolder()).design()) {
        REQUIRE(design.constraints.size() == 5);
        values << 3, 20e-3, 20e-3, 20e-3, 15e-3, 2e-3;
        for (Eigen::Index q = 0; q < 6; ++q) gradients(q, 2) = q == 0 ? 100 : 1;  // all depend on the place, of a range of 25 mm
    }
    GradientWarnings look() const { return gradient_warnings(design, values, gradients); }
};

constexpr int stroke = 3;  // of the constraints

bool has(const std::string& text, const std::string& words) { return text.find(words) != std::string::npos; }

}  // namespace

TEST_CASE("gradients that can be followed are passed over in silence") {
    const GradientWarnings found = Numbers().look();
    CHECK(found.warnings.empty());
    CHECK(found.notes.empty());
}

TEST_CASE("a violated requirement that no parameter moves is a warning, with its name, numbers and what to do") {
    Numbers numbers;
    numbers.values[1 + stroke] = 31e-3;
    CHECK_FALSE(is_out_of_reach(numbers.design, stroke, 31e-3, numbers.gradients.row(1 + stroke).transpose()));
    CHECK(numbers.look().warnings.empty());  // it has a gradient
    numbers.gradients.row(1 + stroke).setZero();
    CHECK(is_out_of_reach(numbers.design, stroke, 31e-3, numbers.gradients.row(1 + stroke).transpose()));
    GradientWarnings found = numbers.look();
    REQUIRE(found.warnings.size() == 1);
    CHECK(found.notes.empty());
    CHECK(has(found.warnings[0], "constraint `" + numbers.design.constraints[stroke].name + "`: it is 31 mm, required 0 to 30 mm"));
    CHECK(has(found.warnings[0], "no parameter changes it at this design"));
    CHECK(has(found.warnings[0], "What to do: "));
    CHECK_FALSE(has(found.warnings[0], "stop"));  // the scene has no joint that could reach one
    core::scene::Joint slide;
    slide.name = "slide";
    slide.forces.limits = {0, 30e-3};
    numbers.design.scene.mechanism.joints.push_back(slide);
    CHECK(has(numbers.look().warnings[0], "a joint at its stop (`slide` may reach one)"));
    // A little: a stop gives way. 0.05 mm over the whole range, of 1 mm that are missing.
    numbers.gradients(1 + stroke, 2) = 2e-3;
    found = numbers.look();
    REQUIRE(found.warnings.size() == 1);
    CHECK(has(found.warnings[0], "change it by 0.05 mm at most"));
    numbers.gradients(1 + stroke, 2) = 5e-3;  // 0.125 mm
    CHECK(numbers.look().warnings.empty());
}

TEST_CASE("what no parameter moves and is met is a note") {
    Numbers numbers;
    numbers.gradients.row(0).setZero();
    numbers.gradients.row(1 + stroke).setZero();
    const GradientWarnings found = numbers.look();
    CHECK(found.warnings.empty());
    REQUIRE(found.notes.size() == 1);
    CHECK(found.notes[0] == "no parameter changes the objective, constraint `" + numbers.design.constraints[stroke].name +
                                "` at this design, by the derivatives");
}

TEST_CASE("a gradient that is too steep to be followed is a warning, with remedies") {
    Numbers numbers;
    numbers.gradients(1 + stroke, 2) = 2e3;  // 50 mm for a thousandth of the range, of a value of 15 mm
    const GradientWarnings found = numbers.look();
    REQUIRE(found.warnings.size() == 1);
    CHECK(has(found.warnings[0], "constraint `" + numbers.design.constraints[stroke].name + "`: its gradient is too steep to be followed"));
    CHECK(has(found.warnings[0],
              "as `place` moves by 0.025 mm, a thousandth of its range, it would change by 50 mm, and its value is 15 mm"));
    CHECK(has(found.warnings[0], "What would help: a wider contact.dhat"));
    numbers.gradients(1 + stroke, 2) = 0.5e3;
    CHECK(numbers.look().warnings.empty());
}

}  // namespace fettle::design::gradient_audit::gradient_warnings_test
