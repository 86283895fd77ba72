// SPDX-License-Identifier: MIT
#include "design/studies/starting_sides.hpp"

#include <algorithm>
#include <utility>

#include "core/base/contract.hpp"
#include "design/description/made_design.hpp"
#include "design/reading/design_text.hpp"
#include "design/studies/random_start.hpp"

namespace fettle::design::studies {

namespace {

constexpr size_t most_tried = 16;  // loops that seeds turn over

bool same(const std::optional<core::scene::Assemble>& a, const std::optional<core::scene::Assemble>& b) {
    if (!a || !b) return a.has_value() == b.has_value();
    return a->side == b->side && a->from == b->from && a->to == b->to;
}

core::scene::Joint& joint_of(core::scene::Scene& scene, const std::string& name) {
    std::vector<core::scene::Joint>& joints = scene.mechanism.joints;
    const auto joint = std::find_if(joints.begin(), joints.end(), [&](const core::scene::Joint& each) { return each.name == name; });
    FETTLE_ASSERT(joint != joints.end(), "the scene has the joint");
    return *joint;
}

// Does each scenario say the same of this joint?
bool is_one(const description::Design& design, const std::string& name) {
    std::optional<core::scene::Assemble> said = {};
    for (int s = 0; s < description::scenario_count(design); ++s) {
        core::scene::Scene scene = description::design_of_scenario(design, s).scene;
        const std::optional<core::scene::Assemble>& here = joint_of(scene, name).assemble;
        if (s > 0 && !same(said, here)) return false;
        said = here;
    }
    return true;
}

// The problem on these sides; the very same one where it has them.
Result<problem::DesignProblem> on_sides(const problem::DesignProblem& problem, const Sides& sides) {
    if (sides.empty()) return problem;
    return problem::DesignProblem::create(with_sides(problem.design(), sides));
}

// What the run of a seed takes: its sides, if something can be made there.
Sides sides_taken(const problem::DesignProblem& problem, std::uint64_t seed) {
    const Sides written = sides_of(problem), tried = sides_of_seed(problem, seed);
    const bool is_other = !std::equal(written.begin(), written.end(), tried.begin(),
                                      [](const auto& a, const auto& b) { return a.assemble.side == b.assemble.side; });
    if (!is_other) return written;
    const Result<problem::DesignProblem> other = on_sides(problem, tried);
    return other && other->obstacles(start_of_seed(*other, seed)).empty() ? tried : written;
}

}  // namespace

Sides sides_of(const problem::DesignProblem& problem) {
    const description::Design& design = problem.design();
    const description::Design first = description::design_of_scenario(design, 0);
    Sides sides;
    for (const core::scene::Joint& joint : first.scene.mechanism.joints)
        if (joint.assemble) sides.push_back({joint.name, *joint.assemble});
    if (const Result<core::model::Model> model = problem.model_at(description::values_of(design.parameters))) {
        const Sides open = core::model::sides_left_open(*model);
        sides.insert(sides.end(), open.begin(), open.end());
    }
    sides.erase(std::remove_if(sides.begin(), sides.end(), [&](const auto& side) { return !is_one(design, side.joint); }), sides.end());
    return sides;
}

Sides sides_of_seed(const problem::DesignProblem& problem, std::uint64_t seed) {
    Sides sides = sides_of(problem);
    if (problem.design().optimiser.keep_sides) return sides;
    for (size_t k = 0; k < std::min(sides.size(), most_tried); ++k)
        if ((seed >> k) % 2 == 1) sides[k].assemble.side = core::model::other_side(sides[k].assemble.side);
    return sides;
}

description::Design with_sides(description::Design design, const Sides& sides) {
    description::change_scenes(design, [&](core::scene::Scene& scene) {
        for (const core::model::JointSide& side : sides) joint_of(scene, side.joint).assemble = side.assemble;
    });
    return design;
}

Result<problem::DesignProblem> problem_of_seed(const problem::DesignProblem& problem, std::uint64_t seed) {
    return on_sides(problem, sides_taken(problem, seed));
}

Result<FileOfSeed> file_of_seed(const reading::DesignFile& file, const problem::DesignProblem& problem, std::uint64_t seed) {
    const Sides sides = sides_taken(problem, seed);
    Result<problem::DesignProblem> begun = on_sides(problem, sides);
    if (!begun) return begun.errors();
    FileOfSeed out{file, std::move(begun).value()};
    if (sides.empty()) return out;
    out.file.text = reading::text_with_sides(file, sides);
    out.file.design = with_sides(file.design, sides);
    return out;
}

}  // namespace fettle::design::studies
