// SPDX-License-Identifier: MIT
#include "design/problem/check_design.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "core/base/text.hpp"
#include "core/geometry/mass_moments.hpp"
#include "core/scene/place.hpp"
#include "design/description/requirement_text.hpp"

namespace fettle::design::problem {

namespace {

using description::Design;
using description::Parameter;
using description::Relation;
using description::Shape;

class DesignCheck {
public:
    DesignCheck(const Design& design, const std::vector<core::model::Model>& models) : design_(design), models_(models) {}

    Errors run() {
        check_names();
        std::set<std::string> names;
        for (const description::Scenario& scenario : design_.scenarios)
            if (!names.insert(scenario.name).second)
                add(ErrorCode::inconsistent, "scenario `" + scenario.name + "`", "another scenario has this name");
        for (int s = 0; s < count_of(models_); ++s) {
            where_ = scenario_prefix(design_, s);
            check_scenario(description::design_of_scenario(design_, s));
        }
        where_.clear();
        if (!(design_.clearance_tolerance > 0)) add(ErrorCode::out_of_range, "clearance_tolerance", "it must be greater than 0");
        names.clear();
        for (const Parameter& parameter : design_.parameters) {
            if (!names.insert(parameter.name).second) add(ErrorCode::inconsistent, place(parameter), "another parameter has this name");
            check_parameter(parameter);
        }
        for (const auto& term : design_.objective) {
            const std::string where = "objective `" + term.name + "`";
            if (!std::isfinite(term.weight) || !(term.unit > 0)) add(ErrorCode::out_of_range, where, "a finite weight, and a unit above 0");
            check_quantity(term.quantity.get(), where);
        }
        names.clear();
        for (const auto& relation : design_.relations) {
            if (!names.insert(relation.name).second) add(ErrorCode::inconsistent, place(relation), "another relation has this name");
            check_relation(relation);
        }
        for (const auto& constraint : design_.constraints) {
            const std::string where = "constraint `" + constraint.name + "`";
            const description::Bounds& bounds = constraint.bounds;
            if (!names.insert(constraint.name).second) add(ErrorCode::inconsistent, where, "another constraint or relation has this name");
            if (!(bounds.lower <= bounds.upper) || !(bounds.margin >= 0) || !(bounds.unit > 0))
                add(ErrorCode::out_of_range, where, "its bounds are in order, its margin is not negative, its unit is above 0");
            check_quantity(constraint.quantity.get(), where);
        }
        return errors_;
    }

private:
    // As those of bodies (core/model/check_scene.hpp).
    void check_names() {
        const auto want = [&](const auto& list, const char* what) {
            for (const auto& each : list) {
                const std::string fault = core::base::name_fault(each.name);
                if (!fault.empty())
                    add(ErrorCode::out_of_range, std::string(what) + " `" + core::base::shown_on_one_line(each.name) + "`",
                        "its name " + fault + "; a name is text on one line");
            }
        };
        want(design_.scenarios, "scenario");
        want(design_.parameters, "parameter");
        want(design_.objective, "objective");
        want(design_.relations, "relation");
        want(design_.constraints, "constraint");
    }

    static std::string place(const Parameter& parameter) { return "parameter `" + parameter.name + "`"; }

    void add(ErrorCode code, const std::string& where, const std::string& message) { errors_.push_back({code, where_ + where, message}); }

    void check_scenario(const Design& own) {
        if (own.steps < 0) add(ErrorCode::out_of_range, "steps", "the number of time steps is not negative");
        const core::scene::Scene scene = description::described_scene(own);
        for (size_t i = 0; i < own.shapes.size(); ++i) check_shape(own, scene, static_cast<int>(i));
        std::set<core::scene::Place> places;
        for (const core::scene::BoundNumber& number : own.numbers) check_number(scene, number, places);
    }

    // @param scene  With its shapes described.
    void check_shape(const Design& own, const core::scene::Scene& scene, int body) {
        const Shape* shape = description::shape_of(own, body);
        if (shape == nullptr) return;
        if (body >= count_of(own.scene.bodies)) return add(ErrorCode::out_of_range, "shapes", "there are more shapes than bodies");
        const core::scene::Body& of = own.scene.bodies[body];
        const std::string where = "shape of body `" + of.name + "`";
        const std::vector<bool> moved = description::moved_dimensions(scene, own.numbers, body, *shape);
        const Result<description::ShapeInstance> drawn = shape->differentiated(description::drawn_values(*shape), moved);
        if (!drawn) {
            for (const Error& error : drawn.errors()) add(error.code, where + ": " + error.where, error.message);
            return;
        }
        const auto vertices = drawn->mesh.vertices.cols();
        bool fits = !moved.empty() && drawn->jacobian.size() == moved.size();
        for (size_t k = 0; fits && k < moved.size(); ++k) {
            const Eigen::Index columns = drawn->jacobian[k].cols();
            fits = columns == vertices || (!moved[k] && columns == 0);
        }
        if (!fits)
            add(ErrorCode::inconsistent, where,
                "its Jacobian has a 3 x n matrix for each of its dimensions, n its vertices; it has one or more");
        if (!core::geometry::have_same_shape(drawn->mesh, of.mesh))
            add(ErrorCode::inconsistent, where, "the body's mesh is not the shape as drawn; let add_part make it");
    }

    void check_parameter(const Parameter& parameter) {
        const bool finite = std::isfinite(parameter.lower) && std::isfinite(parameter.upper);
        const auto told = [&](double si) {
            return description::amount_text(si, core::base::to_si(1, parameter.unit), std::string(parameter.unit.name));
        };
        if (!finite)
            add(ErrorCode::out_of_range, place(parameter),
                "its bounds are " + told(parameter.lower) + " and " + told(parameter.upper) + ": finite ones are expected");
        else if (!(parameter.lower <= parameter.value && parameter.value <= parameter.upper))
            add(ErrorCode::out_of_range, place(parameter),
                "its value " + told(parameter.value) + " does not lie within its bounds, " + told(parameter.lower) + " to " +
                    told(parameter.upper));
    }

    void check_number(const core::scene::Scene& scene, const core::scene::BoundNumber& number, std::set<core::scene::Place>& places) {
        const Result<core::scene::Place> found = core::scene::find_place(scene, number.place);
        for (const Error& error : found.errors()) add(error.code, error.where, error.message);
        if (!found) return;
        if (!places.insert(*found).second) add(ErrorCode::inconsistent, number.place, "another formula is given for this number");
        const core::expression::Scope scope = description::scope_of(design_.parameters);
        for (const std::string& input : number.formula.inputs)
            if (scope.find(input) == nullptr)
                return add(ErrorCode::unknown_key, number.place, "its formula names `" + input + "`, which is no parameter");
        const auto expected = core::expression::powers_of(core::scene::dimension_at(scene, *found));
        if (!same(number.formula.dimension, expected))
            return add(ErrorCode::wrong_type, number.place,
                       "its formula is " + described(number.formula.dimension) + "; " + described(expected) + " is expected");
        const description::RelationValue at =
            description::function_of(number.formula, design_.parameters)(description::values_of(design_.parameters));
        if (!std::isfinite(at.value) || !at.gradient.allFinite())
            add(ErrorCode::not_finite, number.place, "its formula or the derivative is not a finite number at the parameters' values");
    }

    static std::string place(const Relation& relation) { return "relation `" + relation.name + "`"; }

    void check_relation(const Relation& relation) {
        const description::Bounds& bounds = relation.bounds;
        if (!(bounds.lower <= bounds.upper) || !(bounds.margin >= 0) || !(bounds.unit > 0) || !(relation.tolerance >= 0))
            add(ErrorCode::out_of_range, place(relation),
                "its bounds are in order, its margin and its tolerance are not negative, its unit is above 0");
        if (!relation.at) return add(ErrorCode::missing_key, place(relation), "it has no function");
        const VectorX start = description::values_of(design_.parameters);
        const description::RelationValue at = relation.at(start);
        if (at.gradient.size() != start.size())
            return add(ErrorCode::inconsistent, place(relation), "its gradient has one entry for each parameter of the design");
        if (!std::isfinite(at.value) || !at.gradient.allFinite())
            add(ErrorCode::not_finite, place(relation), "its value or its derivative is not a finite number at the parameters' values");
    }

    void check_quantity(const description::Quantity* quantity, const std::string& where) {
        if (quantity == nullptr) return add(ErrorCode::missing_key, where, "it has no quantity");
        for (int s = 0; s < count_of(models_); ++s) {
            if (!quantity->is_about(s)) continue;
            const int steps = design_.scenarios.empty() ? design_.steps : design_.scenarios[s].steps;
            for (const Error& error : quantity->check(models_[s], steps))
                add(error.code, scenario_prefix(design_, s) + where, error.message);
        }
        const std::vector<std::string> known = description::names_of(design_.parameters);
        for (const std::string& name : quantity->parameters())
            if (std::find(known.begin(), known.end(), name) == known.end())
                add(ErrorCode::unknown_key, where, "it names `" + name + "`, which is no parameter");
    }

    const Design& design_;
    const std::vector<core::model::Model>& models_;
    std::string where_;  // the scenario that is looked at
    Errors errors_;
};

}  // namespace

Errors check_design(const Design& design, const std::vector<core::model::Model>& models) { return DesignCheck(design, models).run(); }

}  // namespace fettle::design::problem
