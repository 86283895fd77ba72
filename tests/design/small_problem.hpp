// SPDX-License-Identifier: MIT
/// The small design of small_design.hpp as a problem.
#pragma once

#include <catch2/catch.hpp>

#include "design/problem/design_problem.hpp"
#include "design/reading/design_reader.hpp"
#include "tests/design/small_design.hpp"

namespace fettle::tests::design_support {

inline design::reading::DesignFile file_of(const DesignFolder& folder) {
    auto file = design::reading::read_design(folder.design());
    REQUIRE(file);
    return std::move(file).value();
}

inline design::problem::DesignProblem problem_of(const DesignFolder& folder) {
    auto problem = design::problem::DesignProblem::create(file_of(folder).design);
    REQUIRE(problem);
    return std::move(problem).value();
}

}  // namespace fettle::tests::design_support
