// SPDX-License-Identifier: MIT
#include "design/studies/allocation.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/text.hpp"
#include "design/description/made_design.hpp"

namespace fettle::design::studies {

namespace {

using description::Tolerance;
using description::ToleranceChoice;
using tolerances::Distribution;
using tolerances::Yield;

constexpr double nearly = 0.01;      // of a standard deviation, or of the way to a bound: what counts as the same
constexpr double settled_by = 2e-3;  // of a width

double half_width(const Distribution& deviation) { return (deviation.upper - deviation.lower) / 2; }

MatrixX correlation_of(const std::vector<Tolerance>& tolerances) {
    const description::Deviations deviations = description::deviations_of(tolerances);
    const VectorX sigma = deviations.standard_deviations();
    MatrixX out = MatrixX::Identity(sigma.size(), sigma.size());
    for (Eigen::Index j = 0; j < sigma.size(); ++j)
        for (Eigen::Index k = 0; k < sigma.size(); ++k)
            if (j != k && sigma[j] > 0 && sigma[k] > 0) out(j, k) = deviations.covariance(j, k) / (sigma[j] * sigma[k]);
    return out;
}

std::function<CostAt(double)> cost_function(const Tolerance& tolerance) {
    if (tolerance.cost.formula) {
        return [formula = *tolerance.cost.formula, half = half_width(tolerance.deviation)](double factor) {
            const auto at = core::expression::differentiated(formula, std::vector<double>{factor * half});
            return CostAt{at.value, at.gradient[0] * half};
        };
    }
    return [at_one = tolerance.cost.as_it_stands](double factor) { return CostAt{at_one / factor, -at_one / (factor * factor)}; };
}

std::function<CostAt(double)> constant_cost(double cost) {
    return [cost](double) { return CostAt{cost, 0}; };
}

// The cost as it stands of limits that are none of the choices is that of the widest choice that is not wider.
double cost_as_it_stands(const Tolerance& tolerance) {
    const std::vector<ToleranceChoice>& choices = tolerance.cost.choices;
    if (choices.empty()) return cost_function(tolerance)(1).value;
    double cost = choices.front().cost;
    const double width = (tolerance.deviation.upper - tolerance.deviation.lower) * (1 + 1e-9);
    for (const ToleranceChoice& choice : choices)
        if (choice.upper - choice.lower <= width) cost = choice.cost;
    return cost;
}

Distribution with_limits(Distribution deviation, double lower, double upper) {
    deviation.lower = lower;
    deviation.upper = upper;
    return deviation;
}

class Allocation {
public:
    Allocation(const problem::DesignProblem& problem, const std::vector<Tolerance>& tolerances, const AllocationOptions& options)
        : problem_(problem), given_(tolerances), options_(options), n_(count_of(tolerances)) {}

    AllocationReport run() {
        begin();
        ToleranceOptions first = options_.study;
        first.samples = 0;
        if (!study(first)) return std::move(report_);
        take_requirements();
        if (model_.requirements.empty()) return ended(AllocationStatus::not_held, "the design has no constraint or relation with a bound");
        take_corrections();
        for (report_.rounds = 0; report_.rounds < options_.most_rounds;) {
            const std::vector<int> before = choices_;
            const VectorX factors_before = factors_;
            AllocationSolution solution = solve_with_choices();
            if (!solution.is_held) return refused();
            const bool is_same =
                before == choices_ && (solution.factors.array() / factors_before.array()).log().abs().maxCoeff() < settled_by;
            if (is_same && report_.rounds > 0) return settled(AllocationStatus::held, "");
            factors_ = solution.factors;
            ++report_.rounds;
            take_limits();
            if (!study(with_corners())) return std::move(report_);
            take_corrections();
        }
        return settled(AllocationStatus::not_settled, "limits and studies of them do not settle in " +
                                                          std::to_string(options_.most_rounds) +
                                                          " rounds: the requirements are far from smooth over these tolerances");
    }

private:
    void begin() {
        model_.correlation = correlation_of(given_);
        model_.worst_case = options_.worst_case;
        model_.least = VectorX::Constant(n_, least_factor);
        factors_ = VectorX::Ones(n_);
        choices_.assign(given_.size(), -1);
        report_.tolerances = given_;
        for (int j = 0; j < n_; ++j) {
            const Tolerance& tolerance = given_[j];
            const double half = half_width(tolerance.deviation);
            model_.deviations.push_back(tolerance.deviation);
            model_.is_fixed.push_back(tolerance.is_fixed || !(half > 0));
            model_.costs.push_back(cost_function(tolerance));
            if (model_.is_fixed.back()) model_.costs.back() = constant_cost(cost_as_it_stands(tolerance));
            if (tolerance.deviation.kind == tolerances::DistributionKind::truncated && half > 0)
                model_.least[j] = std::clamp(std::abs(tolerance.deviation.shift) / half, least_factor, 1.0);
            report_.cost_before += cost_as_it_stands(tolerance);
        }
    }

    ToleranceOptions with_corners() const {
        ToleranceOptions study = options_.study;
        study.worst_case = options_.worst_case;
        return study;
    }

    // False: it ended there.
    bool study(const ToleranceOptions& options) {
        report_.study = study_tolerances(problem_, report_.tolerances, options);
        if (report_.study.interrupted) report_.status = AllocationStatus::interrupted;
        if (!report_.study.reason.empty()) report_.message = report_.study.reason;
        return !report_.study.interrupted && report_.study.reason.empty();
    }

    bool has_choices(int j) const { return !given_[j].cost.choices.empty() && !given_[j].is_fixed; }

    void take_requirements() {
        for (int i = 0; i < count_of(report_.study.responses); ++i) {
            const Response& response = report_.study.responses[i];
            if (!has_bounds(response)) continue;
            responses_.push_back(i);
            RequirementModel model;
            model.limits = limits_of(response);
            model.nominal = response.nominal;
            model.gradient = response.gradient;
            model_.requirements.push_back(std::move(model));
        }
    }

    // What the study at the present limits found beyond the model.
    void take_corrections() {
        for (std::size_t r = 0; r < responses_.size(); ++r) {
            RequirementModel& model = model_.requirements[r];
            const Response& response = report_.study.responses[responses_[r]];
            model.curvature = response.curvature;
            if (response.least_found && std::isfinite(response.least_found->value)) {
                model.least_correction = response.least_found->value - response.worst.least;
                model.most_correction = response.most_found->value - response.worst.most;
            }
            const double mean_before = std::exchange(model.mean_correction, 0), sigma_before = std::exchange(model.sigma_correction, 1);
            const ModelMoments own = moments_at(model_, model, factors_);
            const tolerances::Moments found = moments_of(response);
            model.mean_correction = std::isfinite(found.mean) ? found.mean - own.mean : mean_before;
            model.sigma_correction = own.sigma > 0 ? found.standard_deviation / own.sigma : sigma_before;
            model.outside = allowed_outside(response, found);
        }
    }

    // Those of the derivatives; the samples' mean and standard deviation where these differ by more than chance.
    static tolerances::Moments moments_of(const Response& response) {
        tolerances::Moments found{response.linear.mean, response.linear.standard_deviation, 0,
                                  3 * std::pow(response.linear.standard_deviation, 4)};
        if (response.second_order) found = *response.second_order;
        if (!response.sampled) return found;
        constexpr double chance = 2;  // standard errors
        const tolerances::SampleMoments& sampled = response.sampled->moments;
        const double mean = sampled.moments.mean, sigma = sampled.moments.standard_deviation, before = found.standard_deviation;
        if (std::abs(mean - found.mean) > chance * sampled.mean_error) found.mean = mean;
        if (!(before > 0) || !(std::abs(sigma - before) > chance * sampled.standard_deviation_error)) return found;
        found.standard_deviation = sigma;
        found.third *= std::pow(sigma / before, 3);
        found.fourth *= std::pow(sigma / before, 4);
        return found;
    }

    // With which a normal number has as much within as one of this shape is asked to have.
    double allowed_outside(const Response& response, const tolerances::Moments& found) const {
        const double asked = 1 - options_.yield;
        if (!(found.standard_deviation > 0)) return asked;
        const Yield normal = tolerances::normal_yield(found.mean, found.standard_deviation, limits_of(response));
        const std::optional<Yield> shaped = tolerances::cornish_fisher_yield(found, limits_of(response));
        constexpr double least = 1e-12;
        const double ratio = shaped ? (normal.outside + least) / (shaped->outside + least) : 1;
        return std::clamp(asked * std::clamp(ratio, 0.1, 10.0), 1e-9, 0.49);
    }

    // Limits as chosen; of those that have a choice, the factor is 1.
    void choose(AllocationModel& model, int j, int choice) const {
        const ToleranceChoice& taken = given_[j].cost.choices[choice];
        model.deviations[j] = with_limits(given_[j].deviation, taken.lower, taken.upper);
        model.is_fixed[j] = true;
        model.costs[j] = constant_cost(taken.cost);
    }

    AllocationSolution solve_with_choices() {
        AllocationModel model = model_;
        std::vector<int> taken(given_.size(), -1);
        for (int j = 0; j < n_; ++j) {
            if (!has_choices(j)) continue;
            taken[j] = 0;
            choose(model, j, 0);
        }
        AllocationSolution best = solve(model);
        for (bool goes_on = best.is_held; goes_on;) {
            goes_on = false;
            int loosened = -1;
            for (int j = 0; j < n_; ++j) {
                if (taken[j] < 0 || taken[j] + 1 >= count_of(given_[j].cost.choices)) continue;
                AllocationModel trial = model;
                choose(trial, j, taken[j] + 1);
                AllocationSolution found = solve(trial);
                if (!found.is_held || !(found.cost < best.cost)) continue;
                best = std::move(found);
                loosened = j;
            }
            if (loosened < 0) break;
            choose(model, loosened, ++taken[loosened]);
            goes_on = true;
        }
        choices_ = taken;
        model_ = std::move(model);
        return best;
    }

    void take_limits() {
        for (int j = 0; j < n_; ++j) {
            Tolerance& tolerance = report_.tolerances[j];
            const Distribution deviation = scaled(model_.deviations[j], factors_[j]);
            tolerance.deviation = deviation;
            if (choices_[j] >= 0) tolerance.stated = given_[j].cost.choices[choices_[j]].name;
            if (choices_[j] < 0 && factors_[j] != 1) tolerance.stated.clear();
        }
    }

    AllocationReport refused() {
        // At the tightest, which requirement is missed?
        VectorX tightest = model_.is_fixed.empty() ? VectorX() : model_.least;
        for (int j = 0; j < n_; ++j)
            if (model_.is_fixed[j]) tightest[j] = 1;
        std::vector<std::string> names, beyond;
        std::size_t row = 0;
        const VectorX missed = misses(model_, tightest);
        for (std::size_t r = 0; r < responses_.size(); ++r) {
            const RequirementModel& model = model_.requirements[r];
            const int rows = model_.worst_case ? std::isfinite(model.limits.lower) + std::isfinite(model.limits.upper) : 1;
            bool is_missed = false;
            for (int k = 0; k < rows; ++k) is_missed = missed[static_cast<Eigen::Index>(row++)] > 0 || is_missed;
            const double mean = moments_at(model_, model, tightest).mean;
            const bool is_beyond = !(mean > model.limits.lower && mean < model.limits.upper);
            if (is_missed) (is_beyond ? beyond : names).push_back(report_.study.responses[responses_[r]].name);
        }
        std::string message;
        if (!beyond.empty())
            message = core::base::joined(beyond) +
                      ": its mean does not lie within its bounds, however tight the tolerances are: change the design "
                      "(fettle optimise, with `over_tolerances`), or a process's shift";
        if (!names.empty())
            message += (message.empty() ? "" : "; ") + core::base::joined(names) +
                       ": what is fixed, or has no finer grade, takes more room than there is";
        return ended(AllocationStatus::not_held, message.empty() ? "no allocation was found that holds every requirement" : message);
    }

    AllocationReport ended(AllocationStatus status, const std::string& message) {
        report_.status = status;
        report_.message = message;
        return std::move(report_);
    }

    AllocationReport settled(AllocationStatus status, const std::string& message) {
        for (int j = 0; j < n_; ++j) {
            AllocatedTolerance out;
            const double before = half_width(given_[j].deviation);
            out.factor = before > 0 ? half_width(report_.tolerances[j].deviation) / before : 1;
            out.cost_before = cost_as_it_stands(given_[j]);
            out.cost = model_.costs[j](factors_[j]).value;
            if (choices_[j] >= 0) out.choice = given_[j].cost.choices[choices_[j]].name;
            out.is_widest = choices_[j] < 0 && !model_.is_fixed[j] && factors_[j] > (1 - nearly) * largest_factor;
            report_.cost += out.cost;
            report_.allocated.push_back(std::move(out));
        }
        const VectorX missed = misses(model_, factors_);
        std::vector<std::string> not_held;
        Eigen::Index row = 0;
        for (std::size_t r = 0; r < responses_.size(); ++r) {
            const Response& response = report_.study.responses[responses_[r]];
            const RequirementModel& model = model_.requirements[r];
            const int rows = model_.worst_case ? std::isfinite(model.limits.lower) + std::isfinite(model.limits.upper) : 1;
            double most = -core::base::infinity;
            for (int k = 0; k < rows; ++k) most = std::max(most, missed[row++]);
            AllocatedRequirement out{responses_[r], most <= nearly, most > -nearly, predicted(response)};
            if (!is_held_by_simulations(response)) out.is_held = false;
            if (!out.is_held) not_held.push_back(response.name);
            report_.requirements.push_back(out);
        }
        if (status == AllocationStatus::held && !not_held.empty())
            return ended(AllocationStatus::not_settled,
                         core::base::joined(not_held) + ": simulations at these limits do not agree that it is held");
        return ended(status, message);
    }

    double predicted(const Response& response) const {
        const tolerances::Moments found = moments_of(response);
        if (const auto shaped = tolerances::cornish_fisher_yield(found, limits_of(response)); shaped) return shaped->within;
        return tolerances::normal_yield(found.mean, found.standard_deviation, limits_of(response)).within;
    }

    bool is_held_by_simulations(const Response& response) const {
        if (options_.worst_case) {
            if (!response.least_found) return true;
            const double slack = nearly * (response.worst.most - response.worst.least);
            return response.least_found->value >= response.bounds.lower - slack &&
                   response.most_found->value <= response.bounds.upper + slack;
        }
        if (!response.sampled) return report_.study.samples.empty();
        return tolerances::counted_yield(response.sampled->met, count_of(report_.study.samples), confidence).most.within >= options_.yield;
    }

    const problem::DesignProblem& problem_;
    const std::vector<Tolerance>& given_;
    const AllocationOptions& options_;
    const int n_;
    AllocationModel model_;
    std::vector<int> responses_;  // of the requirements
    std::vector<int> choices_;    // per tolerance; -1: it has none
    VectorX factors_;
    AllocationReport report_;
};

}  // namespace

const char* to_string(AllocationStatus status) {
    switch (status) {
        case AllocationStatus::held:
            return "held";
        case AllocationStatus::not_held:
            return "not_held";
        case AllocationStatus::not_settled:
            return "not_settled";
        case AllocationStatus::interrupted:
            return "interrupted";
        case AllocationStatus::undecided:
            break;
    }
    return "undecided";
}

AllocationReport allocate(const problem::DesignProblem& problem, const std::vector<Tolerance>& tolerances,
                          const AllocationOptions& options) {
    return Allocation(problem, tolerances, options).run();
}

}  // namespace fettle::design::studies
