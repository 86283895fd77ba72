// SPDX-License-Identifier: MIT
#include "design/problem/witness_branches.hpp"

#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace fettle::design::problem {

namespace {

using description::Design;

VectorX ranges_of(const Design& design) {
    VectorX ranges(design.parameters.size());
    for (Eigen::Index k = 0; k < ranges.size(); ++k) ranges[k] = design.parameters[k].upper - design.parameters[k].lower;
    return ranges;
}

VectorX values_of(const QuantityBranches& quantity) {
    VectorX values(quantity.branches.size());
    for (Eigen::Index k = 0; k < values.size(); ++k) values[k] = quantity.branches[k].value;
    return values;
}

struct Row {
    int of;
    double value;
    VectorX gradient;
};

optimisers::Branches joined(const std::vector<Row>& rows, Eigen::Index parameters) {
    optimisers::Branches branches;
    branches.values.resize(rows.size());
    branches.jacobian.resize(branches.values.size(), parameters);
    for (const Row& row : rows) {
        const auto at = static_cast<Eigen::Index>(branches.of.size());
        branches.of.push_back(row.of);
        branches.values[at] = row.value;
        branches.jacobian.row(at) = row.gradient.transpose();
    }
    return branches;
}

bool is_about_one_scenario(const Design& design, const description::Quantity& quantity) {
    int about = 0;
    for (int s = 0; s < description::scenario_count(design); ++s) about += quantity.is_about(s) ? 1 : 0;
    return about == 1;
}

// What a branch may be to be asked for; nothing where none is.
std::optional<double> limit_of(const Design& design, const QuantityBranches& quantity, const description::Quantity& of, double value,
                               BranchReach reach) {
    const auto index = static_cast<size_t>(quantity.index);
    if (reach == BranchReach::none) return std::nullopt;
    if (reach == BranchReach::tied) return value + design.clearance_tolerance;
    if (quantity.of_objective) {  // a kink that a minimum keeps to
        const double weight = design.objective[index].weight;
        if (of.is_greatest_branch()) return weight > 0 ? std::optional(std::numeric_limits<double>::infinity()) : std::nullopt;
        return weight < 0 ? std::optional(value + std::abs(value)) : std::nullopt;
    }
    const description::Bounds& bounds = design.constraints[index].bounds;
    const double bound = of.is_greatest_branch() ? bounds.upper : bounds.lower;
    if (!std::isfinite(bound)) return std::nullopt;
    const double beyond = of.is_greatest_branch() ? value - bound : bound - value;  // by as much the bound is missed
    const double behind = beyond + (bound != 0 ? std::abs(bound) : std::abs(value));
    return behind >= 0 ? std::optional(value + behind) : std::nullopt;
}

}  // namespace

std::vector<QuantityBranches> branches_of(const Design& design, const description::Simulated& simulated, const Measurements& measured,
                                          BranchReach reach) {
    std::vector<QuantityBranches> all;
    const auto add = [&](QuantityBranches quantity, const description::Quantity& of, const description::Measurement& at, size_t least) {
        if (!of.is_about(simulated.scenario)) return;
        const std::optional<double> limit = limit_of(design, quantity, of, at.value, reach);
        if (!limit) return;
        quantity.branches = of.branches(simulated, at, *limit);
        if (quantity.branches.size() >= least) all.push_back(std::move(quantity));
    };
    for (size_t k = 0; k < design.objective.size(); ++k)
        add({true, static_cast<int>(k), false, {}, {}}, *design.objective[k].quantity, measured.terms[k], 1);
    for (size_t i = 0; i < design.constraints.size(); ++i) {
        const description::Quantity& of = *design.constraints[i].quantity;
        const bool is_in_one_row = is_about_one_scenario(design, of);
        add({false, static_cast<int>(i), is_in_one_row, {}, {}}, of, measured.constraints[i], is_in_one_row ? 2 : 1);
    }
    return all;
}

void add_seeds(const QuantityBranches& quantity, const description::Simulated& simulated, std::vector<adjoint::Seeds>& seeds) {
    for (size_t k = quantity.is_in_one_row ? 1 : 0; k < quantity.branches.size(); ++k) {
        seeds.push_back(adjoint::zero_seeds(simulated.model, count_of(simulated.trajectory.steps)));
        quantity.branches[k].add_seeds(1, seeds.back());
    }
}

void take_jacobians(const MatrixX& rows, const MatrixX& constraint_jacobian, std::vector<QuantityBranches>& all) {
    Eigen::Index next = 0;
    for (QuantityBranches& quantity : all) {
        const auto count = static_cast<Eigen::Index>(quantity.branches.size());
        const Eigen::Index own = quantity.is_in_one_row ? count - 1 : count;
        quantity.jacobian.resize(count, rows.cols());
        if (quantity.is_in_one_row) quantity.jacobian.row(0) = constraint_jacobian.row(quantity.index);
        quantity.jacobian.bottomRows(own) = rows.middleRows(next, own);
        next += own;
    }
}

std::vector<int> telling_branches(const VectorX& values, const MatrixX& jacobian, const VectorX& ranges) {
    const double negligible = 1e-6 * jacobian.row(0).cwiseAbs().dot(ranges.transpose());
    const auto nothing_beside = [&](Eigen::Index j, Eigen::Index k) {
        const double reach = (jacobian.row(j) - jacobian.row(k)).cwiseAbs().dot(ranges.transpose());
        return reach <= values[j] - values[k] + negligible;
    };
    std::vector<int> kept{0};
    for (Eigen::Index j = 1; j < values.size(); ++j) {
        bool telling = true;
        for (const int k : kept) telling = telling && !nothing_beside(j, k);
        if (telling) kept.push_back(static_cast<int>(j));
    }
    kept.erase(kept.begin());
    return kept;
}

optimisers::Branches constraint_rows(const Design& design, const std::vector<QuantityBranches>& all) {
    const VectorX ranges = ranges_of(design);
    std::vector<Row> rows;
    for (const QuantityBranches& quantity : all) {
        if (quantity.of_objective) continue;
        const VectorX values = values_of(quantity);
        const double sign = design.constraints[quantity.index].quantity->is_greatest_branch() ? -1 : 1;
        for (const int j : telling_branches(sign * values, sign * quantity.jacobian, ranges))
            rows.push_back({quantity.index, values[j], quantity.jacobian.row(j).transpose()});
    }
    return joined(rows, ranges.size());
}

optimisers::Branches objective_rows(const Design& design, const std::vector<QuantityBranches>& all) {
    const VectorX ranges = ranges_of(design);
    std::vector<Row> rows;
    for (const QuantityBranches& quantity : all) {
        if (!quantity.of_objective) continue;
        const description::ObjectiveTerm& term = design.objective[quantity.index];
        const double scale = term.weight / term.unit;
        const VectorX values = values_of(quantity);
        const double sign = term.quantity->is_greatest_branch() ? -1 : 1;
        std::vector<int> kept = telling_branches(sign * values, sign * quantity.jacobian, ranges);
        kept.insert(kept.begin(), 0);
        for (const int j : kept) rows.push_back({quantity.index, scale * values[j], scale * quantity.jacobian.row(j).transpose()});
    }
    return joined(rows, ranges.size());
}

std::vector<Tie> ties_of(const Design& design, const std::vector<QuantityBranches>& all) {
    const VectorX ranges = ranges_of(design);
    std::vector<Tie> ties;
    for (const QuantityBranches& quantity : all) {
        const VectorX same = VectorX::Constant(quantity.branches.size(), quantity.branches.front().value);
        const std::vector<int> others = telling_branches(same, quantity.jacobian, ranges);
        if (others.empty()) continue;
        Tie tie{quantity.of_objective, quantity.index, 1 + count_of(others), quantity.jacobian.row(0).transpose(), {}};
        tie.greatest = tie.least;
        for (const int j : others) {
            tie.least = tie.least.cwiseMin(quantity.jacobian.row(j).transpose());
            tie.greatest = tie.greatest.cwiseMax(quantity.jacobian.row(j).transpose());
        }
        ties.push_back(std::move(tie));
    }
    return ties;
}

}  // namespace fettle::design::problem
