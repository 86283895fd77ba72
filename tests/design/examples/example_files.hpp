// SPDX-License-Identifier: MIT
/// The mechanisms of examples/, read and evaluated.
#pragma once

#include <catch2/catch.hpp>
#include <string>

#include "design/problem/design_problem.hpp"
#include "design/reading/design_reader.hpp"

namespace fettle::tests::design_support {

struct Example {
    design::description::Design design;
    design::problem::DesignProblem problem;
    VectorX start;

    /// @param name  The name of the folder and of its files. Tests run in the project's folder.
    static Example read(const std::string& name) {
        auto file = design::reading::read_design("examples/" + name + "/" + name + ".design.json");
        REQUIRE(file);
        auto problem = design::problem::DesignProblem::create(file->design);
        REQUIRE(problem);
        return {file->design, std::move(problem).value(), design::description::values_of(file->design.parameters)};
    }

    int parameter(const std::string& parameter_name) const {
        for (size_t k = 0; k < design.parameters.size(); ++k) {
            if (design.parameters[k].name == parameter_name) return static_cast<int>(k);
        }
        FAIL("no parameter " << parameter_name);
        return -1;
    }

    /// The start with some parameters replaced [SI].
    VectorX values(const std::map<std::string, double>& changes) const {
        VectorX p = start;
        for (const auto& [name, value] : changes) p[parameter(name)] = value;
        return p;
    }

    int constraint(const std::string& part_of_name) const {
        for (size_t k = 0; k < design.constraints.size(); ++k) {
            if (design.constraints[k].name.find(part_of_name) != std::string::npos) return static_cast<int>(k);
        }
        FAIL("no constraint " << part_of_name);
        return -1;
    }
};

}  // namespace fettle::tests::design_support
