// SPDX-License-Identifier: MIT
/// On which sides closed linkages are assembled where a run of an optimiser begins. The bars of a loop fit together in two ways
/// (core/scene/mechanism.hpp, Assemble). Parameters lead from one to the other only through a dead centre, where nothing is smooth: so each
/// run keeps to one side, and runs of different seeds take different ones.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/result.hpp"
#include "core/model/branch_of_joint.hpp"
#include "design/problem/design_problem.hpp"
#include "design/reading/design_reader.hpp"

namespace fettle::design::studies {

using Sides = std::vector<core::model::JointSide>;

/// The sides of the design as written: those that joints say, then those that no joint says and the written poses have decided
/// (core::model::sides_left_open). Left out are joints that its scenarios assemble on different sides.
Sides sides_of(const problem::DesignProblem& problem);

/// The sides that the run of a seed tries: of its sides_of the k-th is the other one where bit k of the seed is set, so that seeds in
/// sequence take all combinations in turn. Seed 0, and a design that keeps its sides (OptimiserSettings::keep_sides): as written.
Sides sides_of_seed(const problem::DesignProblem& problem, std::uint64_t seed);

/// The design, in all scenarios, assembled so. Contract: it has these joints.
description::Design with_sides(description::Design design, const Sides& sides);

/// The design as the run of a seed has it: on the sides of the seed, or, where no mechanism can be made and assembled on them at the
/// seed's start (start_of_seed), on those as written. It says its sides at their joints. Nothing is simulated.
Result<problem::DesignProblem> problem_of_seed(const problem::DesignProblem& problem, std::uint64_t seed);

/// The same of a design file, whose text says the sides, too.
struct FileOfSeed {
    reading::DesignFile file;
    problem::DesignProblem problem;
};
/// @param problem  The problem of file.design.
Result<FileOfSeed> file_of_seed(const reading::DesignFile& file, const problem::DesignProblem& problem, std::uint64_t seed);

}  // namespace fettle::design::studies
