// SPDX-License-Identifier: MIT
#include "design/studies/limits.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "design/description/requirement_text.hpp"
#include "design/gradient_audit/gradient_warnings.hpp"
#include "design/problem/buildable.hpp"

namespace fettle::design::studies {

namespace {

using description::Bounds;
using description::Design;
using description::Parameter;

// Per parameter and direction (down, up): does it bring a violated requirement nearer, noticeably within the parameter's range?
using Wanted = std::vector<std::array<bool, 2>>;

void want(Wanted& wanted, const Design& design, const VectorX& gradient, double sign) {
    VectorX change = sign * gradient;
    for (Eigen::Index k = 0; k < change.size(); ++k) {
        const Parameter& p = design.parameters[k];
        change[k] *= p.upper - p.lower;
    }
    constexpr double noticeable = 0.1;  // of what the most effective parameter does
    const double threshold = noticeable * change.lpNorm<Eigen::Infinity>();
    for (Eigen::Index k = 0; k < change.size(); ++k) {
        if (std::abs(change[k]) > threshold) wanted[k][change[k] > 0 ? 1 : 0] = true;
    }
}

Wanted wanted_directions(const Design& design, const problem::DesignEvaluation& final, const MatrixX& jacobian) {
    const bool known = jacobian.rows() == static_cast<Eigen::Index>(final.constraints.size());
    Wanted wanted(design.parameters.size(), {!known, !known});
    for (Eigen::Index i = 0; known && i < jacobian.rows(); ++i) {
        const Bounds& bounds = design.constraints[i].bounds;
        const description::Measurement& measured = final.constraints[i];
        if (gradient_audit::is_out_of_reach(design, static_cast<int>(i), measured.value, jacobian.row(i).transpose())) continue;
        if (measured.lower < bounds.lower) want(wanted, design, jacobian.row(i).transpose(), 1);
        if (measured.upper > bounds.upper) want(wanted, design, jacobian.row(i).transpose(), -1);
    }
    for (Eigen::Index i = 0; i < final.relations.values.size(); ++i) {
        const description::Relation& relation = design.relations[i];
        const double value = final.relations.values[i];
        if (description::violation(relation, value) <= 0) continue;
        want(wanted, design, final.relations.jacobian.row(i).transpose(), value < relation.bounds.lower ? 1 : -1);
    }
    return wanted;
}

std::string amount(double si, const Unit& unit) {
    char text[80];
    std::snprintf(text, sizeof text, "%.6g %s", description::from_si(si, unit), std::string(unit.name).c_str());
    return text;
}

class Limits {
public:
    Limits(const problem::DesignProblem& problem, const VectorX& point, const problem::DesignEvaluation& final)
        : problem_(problem), design_(problem.design()), point_(point), final_(final) {}

    std::vector<std::string> run(const MatrixX& jacobian, const std::vector<FailedTrial>& failures, int trials) {
        add_out_of_reach(jacobian);
        add_parameters(wanted_directions(design_, final_, jacobian), jacobian.rows() > 0 || final_.relations.values.size() > 0);
        add_failures(failures, trials);
        if (!parts_to_blame_) add_requirements();
        return std::move(lines_);
    }

private:
    void add_out_of_reach(const MatrixX& jacobian) {
        for (Eigen::Index i = 0; i < jacobian.rows(); ++i)
            if (gradient_audit::is_out_of_reach(design_, static_cast<int>(i), final_.constraints[i].value, jacobian.row(i).transpose()))
                lines_.push_back(gradient_audit::out_of_reach_text(design_, static_cast<int>(i), final_.constraints[i].value,
                                                                   jacobian.row(i).transpose()));
    }

    void add_parameters(const Wanted& wanted, bool directions_known) {
        for (size_t k = 0; k < wanted.size(); ++k) {
            const Parameter& p = design_.parameters[k];
            for (const int up : {0, 1}) {
                if (!wanted[k][up]) continue;
                const double bound = up == 1 ? p.upper : p.lower, value = point_[k];
                if (std::abs(bound - value) <= 1e-3 * (p.upper - p.lower)) {
                    lines_.push_back("parameter " + p.name + " is at its " + (up == 1 ? "upper" : "lower") + " bound " +
                                     amount(bound, p.unit));
                } else if (directions_known) {
                    add_reach(static_cast<int>(k), bound);
                }
            }
        }
    }

    void add_reach(int k, double bound) {
        const Parameter& p = design_.parameters[k];
        const problem::Reach reach = problem::reach(problem_, point_, k, bound);
        constexpr double near = 0.1;  // of the range: an obstacle further away has not stopped the optimiser here
        if (reach.obstacles.empty() || std::abs(reach.value - point_[k]) > near * (p.upper - p.lower)) return;
        parts_to_blame_ = true;
        lines_.push_back("parameter " + p.name + " can go no further than " + amount(reach.value, p.unit) + ", though its bound is " +
                         amount(bound, p.unit) + ": " + problem::described(reach.obstacles.front()));
    }

    // By what keeps the parts from being made, or, of trials that were simulated, by the words of the first.
    void add_failures(const std::vector<FailedTrial>& failures, int trials) {
        std::vector<Errors> reasons;
        for (const FailedTrial& failure : failures) {
            Errors obstacles = problem_.obstacles(failure.point);
            if (!obstacles.empty()) parts_to_blame_ = true;
            if (obstacles.empty()) obstacles = {{ErrorCode::unsupported, "in the simulation", failure.reason}};
            reasons.push_back(std::move(obstacles));
        }
        const std::string of = " of " + std::to_string(trials) + " trials failed, ";
        for (const problem::Obstacle& obstacle : problem::tally(reasons))
            lines_.push_back(std::to_string(obstacle.designs) + of + problem::described(obstacle.example));
    }

    void add_requirements() {
        for (size_t i = 0; i < final_.constraints.size(); ++i) {
            const description::Measurement& measured = final_.constraints[i];
            const Bounds& bounds = design_.constraints[i].bounds;
            if (description::violation(bounds, measured) <= 0) continue;
            const std::string remark = problem::remark(final_, i);
            const std::string unit = description::unit_name(design_.constraints[i]);
            lines_.push_back(design_.constraints[i].name + ": " + description::known_text(measured, bounds, unit) + ", required is " +
                             description::required_text(bounds, unit) + (remark.empty() ? "" : ": " + remark));
        }
        for (size_t i = 0; i < design_.relations.size(); ++i) {
            const description::Relation& relation = design_.relations[i];
            const double value = final_.relations.values[i];
            if (description::violation(relation, value) <= 0) continue;
            const std::string unit = description::unit_name(relation);
            lines_.push_back(relation.name + " is " + description::amount_text(value, relation.bounds.unit, unit, 6) + ", required is " +
                             description::required_text(relation.bounds, unit));
        }
    }

    const problem::DesignProblem& problem_;
    const Design& design_;
    const VectorX& point_;
    const problem::DesignEvaluation& final_;
    std::vector<std::string> lines_;
    bool parts_to_blame_ = false;
};

}  // namespace

std::vector<std::string> limits_of(const problem::DesignProblem& problem, const VectorX& point, const problem::DesignEvaluation& final,
                                   const MatrixX& jacobian, const std::vector<FailedTrial>& failures, int trials) {
    return Limits(problem, point, final).run(jacobian, failures, trials);
}

}  // namespace fettle::design::studies
