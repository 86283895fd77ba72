// SPDX-License-Identifier: MIT
#include "design/description/made_design.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/contract.hpp"
#include "design/description/independent_inputs.hpp"

namespace fettle::design::description {

namespace {

// Each with one of its bounds; the design's other numbers as they are.
template <class Requirement>
std::vector<Requirement> one_sided(const std::vector<Requirement>& all, const std::vector<bool>& is_over) {
    std::vector<Requirement> out;
    for (std::size_t i = 0; i < all.size(); ++i) {
        const Bounds& bounds = all[i].bounds;
        if (!is_over[i] || !std::isfinite(bounds.lower) || !std::isfinite(bounds.upper)) {
            out.push_back(all[i]);
            continue;
        }
        Requirement lower = all[i], upper = all[i];
        lower.name += ", at least";
        lower.bounds.upper = Bounds().upper;
        upper.name += ", at most";
        upper.bounds.lower = Bounds().lower;
        out.push_back(std::move(lower));
        out.push_back(std::move(upper));
    }
    return out;
}

template <class Requirement>
std::vector<bool> asked_over_tolerances(const std::vector<Requirement>& all) {
    std::vector<bool> out;
    for (const Requirement& each : all) out.push_back(each.bounds.over_tolerances.has_value());
    return out;
}

// r(p) + offset, from a relation of the parameters as made.
std::function<RelationValue(const VectorX&)> with_reserve(std::function<RelationValue(const VectorX&)> at, const Bounds& bounds,
                                                          std::shared_ptr<const MadeDesign> made) {
    return [at = std::move(at), over = *bounds.over_tolerances, side = side_of(bounds), made = std::move(made)](const VectorX& p) {
        const VectorX here = made->extended(p);
        RelationValue r = at(here);
        const auto offset = offset_of(over, made->by_deviation(r.gradient), made->deviations, side);
        r.value += offset.offset;
        const VectorX step = made->moved_by(offset.direction);
        constexpr double share = 1e-3;  // of w: of a formula the difference errs by a millionth of its third derivative's part there
        if (!step.isZero(0)) r.gradient += (at(here + share * step).gradient - at(here - share * step).gradient) / (2 * share);
        r.gradient.conservativeResize(p.size());
        return r;
    };
}

}  // namespace

Deviations deviations_of(const std::vector<Tolerance>& tolerances) {
    const IndependentInputs inputs = independent_inputs(tolerances);
    VectorX mean(inputs.count()), variance(inputs.count());
    for (int k = 0; k < inputs.count(); ++k) {
        mean[k] = inputs.moments[k].mean;
        variance[k] = inputs.moments[k].standard_deviation * inputs.moments[k].standard_deviation;
    }
    Deviations out{inputs.map * mean, VectorX(tolerances.size()), VectorX(tolerances.size()),
                   inputs.map * variance.asDiagonal() * inputs.map.transpose()};
    for (int k = 0; k < count_of(tolerances); ++k) {
        out.lower[k] = tolerances[k].deviation.lower;
        out.upper[k] = tolerances[k].deviation.upper;
    }
    return out;
}

tolerances::RobustOffset offset_of(const OverTolerances& over, const VectorX& gradient, const Deviations& deviations, int side) {
    if (over.kind == OverTolerances::Kind::worst_case) return tolerances::worst_offset(gradient, deviations.lower, deviations.upper, side);
    return tolerances::offset_at_sigmas(gradient, deviations.mean, deviations.covariance, side * over.sigmas);
}

VectorX MadeDesign::extended(const VectorX& drawn) const {
    VectorX all = values_of(design.parameters);
    FETTLE_ASSERT(drawn.size() <= all.size(), "a value for each parameter as drawn");
    all.head(drawn.size()) = drawn;
    return all;
}

VectorX MadeDesign::by_deviation(const VectorX& gradient) const {
    VectorX out(tolerances.size());
    for (int k = 0; k < count_of(tolerances); ++k) out[k] = gradient[tolerances[k].parameter];
    return out;
}

VectorX MadeDesign::moved_by(const VectorX& deviations_of_each) const {
    VectorX out = VectorX::Zero(count_of(design.parameters));
    for (int k = 0; k < count_of(tolerances); ++k) out[tolerances[k].parameter] += deviations_of_each[k];
    return out;
}

bool asks_over_tolerances(const Design& design) {
    const auto asks = [](const auto& each) { return each.bounds.over_tolerances.has_value(); };
    return std::any_of(design.objective.begin(), design.objective.end(),
                       [](const ObjectiveTerm& term) { return term.over_tolerances.has_value(); }) ||
           std::any_of(design.constraints.begin(), design.constraints.end(), asks) ||
           std::any_of(design.relations.begin(), design.relations.end(), asks);
}

int side_of(const Bounds& bounds) {
    FETTLE_ASSERT(std::isfinite(bounds.lower) != std::isfinite(bounds.upper), "over tolerances a bound has one side");
    return std::isfinite(bounds.upper) ? 1 : -1;
}

Design over_tolerances(Design drawn, Design as_made, std::vector<Tolerance> tolerances) {
    FETTLE_ASSERT(drawn.constraints.size() == as_made.constraints.size() && drawn.relations.size() == as_made.relations.size() &&
                      drawn.objective.size() == as_made.objective.size(),
                  "the same design, as drawn and as made");
    auto made = std::make_shared<MadeDesign>();
    const std::vector<bool> constraints = asked_over_tolerances(drawn.constraints), relations = asked_over_tolerances(drawn.relations);
    as_made.constraints = one_sided(as_made.constraints, constraints);
    const std::vector<Relation> of_all = one_sided(as_made.relations, relations);
    as_made.relations.clear();
    for (std::size_t k = 0; k < drawn.objective.size(); ++k)
        if (drawn.objective[k].over_tolerances)
            as_made.constraints.push_back(
                {"objective " + drawn.objective[k].name + " over the tolerances", {}, as_made.objective[k].quantity});
    made->deviations = deviations_of(tolerances);
    made->design = std::move(as_made);
    made->tolerances = std::move(tolerances);
    drawn.constraints = one_sided(drawn.constraints, constraints);
    drawn.relations = one_sided(drawn.relations, relations);
    for (std::size_t i = 0; i < drawn.relations.size(); ++i) {
        Relation& relation = drawn.relations[i];
        if (relation.bounds.over_tolerances) relation.at = with_reserve(of_all[i].at, relation.bounds, made);
    }
    drawn.as_made = std::move(made);
    return drawn;
}

void change_scenes(Design& design, const std::function<void(core::scene::Scene&)>& change) {
    change(design.scene);
    for (Scenario& scenario : design.scenarios) change(scenario.scene);
    if (!design.as_made) return;
    auto made = std::make_shared<MadeDesign>(*design.as_made);
    change_scenes(made->design, change);
    design.as_made = std::move(made);
}

}  // namespace fettle::design::description
