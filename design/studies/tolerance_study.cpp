// SPDX-License-Identifier: MIT
#include "fettle/design/studies/tolerance_study.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <utility>

#include "fettle/core/base/parallel.hpp"

namespace fettle::design::studies {

namespace {

using description::Design;
using description::Tolerance;
using problem::DesignEvaluation;
using problem::DesignProblem;
using tolerances::Moments;

// Objective, constraints, relations, as all of them are in one column.
VectorX values_of(const DesignEvaluation& evaluation) {
    VectorX y(1 + count_of(evaluation.constraints) + evaluation.relations.values.size());
    y[0] = evaluation.objective;
    for (int i = 0; i < count_of(evaluation.constraints); ++i) y[1 + i] = evaluation.constraints[i].value;
    y.tail(evaluation.relations.values.size()) = evaluation.relations.values;
    return y;
}

class ToleranceStudy {
public:
    ToleranceStudy(const DesignProblem& problem, const std::vector<Tolerance>& tolerances, const ToleranceOptions& options)
        : problem_(problem), design_(problem.design()), tolerances_(tolerances), options_(options), n_(count_of(tolerances)) {
        for (const Tolerance& tolerance : tolerances) deviations_.push_back(moments_of(tolerance.deviation));
        to_do_ = 1 + (options.second_order ? 2 * n_ : 0) + options.samples;
    }

    ToleranceReport run() {
        take_requirements();
        const DesignEvaluation nominal = evaluated(VectorX::Zero(n_), true);
        if (!nominal.usable) {
            report_.interrupted = nominal.interrupted;
            report_.reason = "the design as drawn cannot be simulated: " + nominal.reason;
            return std::move(report_);
        }
        take_nominal(nominal);
        if (options_.second_order) take_curvatures();
        for (Response& response : report_.responses) predict(response);
        if (options_.worst_case && !report_.interrupted) find_worst_cases();
        if (options_.samples > 0 && !report_.interrupted) sample();
        return std::move(report_);
    }

private:
    DesignEvaluation evaluated(const VectorX& deviations, bool gradients) {
        problem::EvaluateOptions options;
        options.gradients = gradients;
        options.should_stop = options_.should_stop;
        DesignEvaluation out = problem_.evaluate(with_deviations(design_, tolerances_, deviations), options);
        const std::lock_guard lock(mutex_);
        ++done_;
        if (options_.on_simulation) options_.on_simulation(done_, to_do_);
        return out;
    }

    void take_requirements() {
        using Kind = Response::Kind;
        const auto add = [&](const std::string& name, Kind kind, int index, const description::Bounds& bounds) {
            Response response;
            response.name = name;
            response.kind = kind;
            response.index = index;
            response.bounds = bounds;
            report_.responses.push_back(std::move(response));
        };
        add("objective", Kind::objective, 0, {});
        for (int i = 0; i < count_of(design_.constraints); ++i)
            add(design_.constraints[i].name, Kind::constraint, i, design_.constraints[i].bounds);
        for (int i = 0; i < count_of(design_.relations); ++i)
            add(design_.relations[i].name, Kind::relation, i, design_.relations[i].bounds);
    }

    // Rows as of values_of, a column per tolerance.
    MatrixX gradients_of(const DesignEvaluation& evaluation) const {
        MatrixX out(count_of(report_.responses), n_);
        for (int k = 0; k < n_; ++k) {
            const int p = tolerances_[k].parameter;
            out(0, k) = evaluation.gradient[p];
            out.block(1, k, evaluation.jacobian.rows(), 1) = evaluation.jacobian.col(p);
            out.block(1 + evaluation.jacobian.rows(), k, evaluation.relations.jacobian.rows(), 1) = evaluation.relations.jacobian.col(p);
        }
        return out;
    }

    void take_nominal(const DesignEvaluation& nominal) {
        const VectorX y = values_of(nominal);
        const MatrixX g = gradients_of(nominal);
        for (int i = 0; i < count_of(report_.responses); ++i) {
            report_.responses[i].nominal = y[i];
            report_.responses[i].gradient = g.row(i).transpose();
        }
    }

    // By central differences of gradients at one standard deviation of each tolerance; a tolerance of no width has none.
    void take_curvatures() {
        std::vector<DesignEvaluation> at(2 * n_);
        core::base::parallel_for(2 * n_, 1, [&](int task) {
            const int k = task / 2;
            if (deviations_[k].standard_deviation == 0) return;
            VectorX deviations = VectorX::Zero(n_);
            deviations[k] = (task % 2 == 0 ? 1 : -1) * deviations_[k].standard_deviation;
            at[task] = evaluated(deviations, true);
        });
        const MatrixX here = all_gradients();
        std::vector<MatrixX> curvatures(report_.responses.size(), MatrixX::Zero(n_, n_)), thirds = curvatures;
        for (int k = 0; k < n_; ++k) {
            if (deviations_[k].standard_deviation == 0) continue;
            const DesignEvaluation &up = at[2 * k], &down = at[2 * k + 1];
            if (!up.usable || !down.usable) {
                report_.interrupted = report_.interrupted || up.interrupted || down.interrupted;
                report_.no_second_order = "with `" + tolerances_[k].of + "` one standard deviation " + (up.usable ? "smaller" : "larger") +
                                          ": " + (up.usable ? down : up).reason;
                return;
            }
            const MatrixX above = gradients_of(up), below = gradients_of(down);
            const double step = deviations_[k].standard_deviation;
            for (int i = 0; i < count_of(curvatures); ++i) {
                curvatures[i].row(k) = (above.row(i) - below.row(i)) / (2 * step);
                thirds[i].row(k) = (above.row(i) - 2 * here.row(i) + below.row(i)) / (step * step);
            }
        }
        for (std::size_t i = 0; i < curvatures.size(); ++i) {
            report_.responses[i].curvature = 0.5 * (curvatures[i] + curvatures[i].transpose());
            report_.responses[i].second_order = second_order_of(report_.responses[i], thirds[i]);
        }
    }

    MatrixX all_gradients() const {
        MatrixX out(count_of(report_.responses), n_);
        for (int i = 0; i < count_of(report_.responses); ++i) out.row(i) = report_.responses[i].gradient.transpose();
        return out;
    }

    // With the third derivatives that the same gradients show, d^3 y / dd_j^2 dd_l, if they are those at the means of deviations that are
    // independent; in three different deviations they are not known.
    Moments second_order_of(const Response& response, const MatrixX& third) const {
        const bool at_means = std::all_of(deviations_.begin(), deviations_.end(), [](const Moments& d) { return d.mean == 0; });
        if (!at_means || !inputs_.groups.empty())
            return tolerances::predict_quadratically(response.nominal, inputs_.map.transpose() * response.gradient,
                                                     inputs_.map.transpose() * response.curvature * inputs_.map, inputs_.moments);
        VectorX v = response.gradient;
        for (int j = 0; j < n_; ++j) v[j] *= deviations_[j].standard_deviation * deviations_[j].standard_deviation;
        double along = 0;
        for (int j = 0; j < n_; ++j)
            for (int l = 0; l < n_; ++l) along += (j == l ? 1 : 3) * third(j, l) * v[j] * v[j] * v[l];
        return tolerances::predict_with_third_derivatives(response.nominal, response.gradient, response.curvature, {third, along},
                                                          deviations_);
    }

    double predicted(const Response& response, const VectorX& deviations) const {
        const double linear = response.nominal + response.gradient.dot(deviations);
        return response.curvature.size() == 0 ? linear : linear + 0.5 * deviations.dot(response.curvature * deviations);
    }

    void predict(Response& response) const {
        VectorX lower(n_), upper(n_);
        for (int k = 0; k < n_; ++k) {
            lower[k] = tolerances_[k].deviation.lower;
            upper[k] = tolerances_[k].deviation.upper;
        }
        const VectorX by_input = inputs_.map.transpose() * response.gradient;
        response.linear = tolerances::predict_linearly(response.nominal, by_input, inputs_.moments);
        response.worst = tolerances::linear_worst_case(response.nominal, response.gradient, lower, upper);
        response.linear_yield = tolerances::normal_yield(response.linear.mean, response.linear.standard_deviation, limits_of(response));
        for (int k = 0; k < inputs_.count(); ++k) {
            const bool is_own = k < n_;
            response.contributions.push_back({is_own ? tolerances_[k].of : inputs_.groups[k - n_], is_own ? k : -1, by_input[k],
                                              response.linear.shares[k], is_own ? std::abs(by_input[k]) * (upper[k] - lower[k]) / 2 : 0});
        }
        std::stable_sort(response.contributions.begin(), response.contributions.end(),
                         [](const Contribution& a, const Contribution& b) { return a.share > b.share; });
        if (!response.second_order) return;
        response.second_order_yield = tolerances::cornish_fisher_yield(*response.second_order, limits_of(response));
    }

    // Corners that several responses name are simulated once.
    void find_worst_cases() {
        std::vector<VectorX> corners;
        const auto place_of = [&](const VectorX& corner) {
            const auto known = std::find(corners.begin(), corners.end(), corner);
            if (known != corners.end()) return static_cast<int>(known - corners.begin());
            corners.push_back(corner);
            return count_of(corners) - 1;
        };
        std::vector<std::pair<int, int>> places;  // least, most
        for (const Response& response : report_.responses)
            places.push_back(has_bounds(response) ? std::pair(place_of(response.worst.at_least), place_of(response.worst.at_most))
                                                  : std::pair(-1, -1));
        to_do_ += count_of(corners);
        std::vector<VectorX> values(corners.size());
        std::atomic<bool> is_interrupted = false;
        core::base::parallel_for(count_of(corners), 1, [&](int k) {
            const DesignEvaluation evaluation = evaluated(corners[k], false);
            if (evaluation.interrupted) is_interrupted = true;
            if (evaluation.usable) values[k] = values_of(evaluation);
        });
        report_.interrupted = report_.interrupted || is_interrupted;
        for (int i = 0; i < count_of(report_.responses); ++i) {
            if (places[i].first < 0) continue;
            const auto found = [&](int k) { return values[k].size() > 0 ? values[k][i] : std::nan(""); };
            report_.responses[i].least_found = found(places[i].first);
            report_.responses[i].most_found = found(places[i].second);
        }
    }

    struct Sample {
        VectorX deviations, values;  // values empty: it failed, or was not begun
        std::vector<bool> met;       // per response
        bool is_done = false;
        std::string reason;
    };

    Sample sample_of(int number) {
        Sample out;
        out.deviations = deviations_of_sample(tolerances_, options_.seed, number);
        if (options_.should_stop && options_.should_stop()) return out;
        const DesignEvaluation evaluation = evaluated(out.deviations, false);
        if (evaluation.interrupted) return out;
        out.is_done = true;
        out.reason = evaluation.reason;
        if (!evaluation.usable) return out;
        out.values = values_of(evaluation);
        for (const Response& response : report_.responses) out.met.push_back(is_met(response, evaluation));
        return out;
    }

    bool is_met(const Response& response, const DesignEvaluation& evaluation) const {
        switch (response.kind) {
            case Response::Kind::constraint:
                return violation(response.bounds, evaluation.constraints[response.index]) == 0;
            case Response::Kind::relation:
                return violation(design_.relations[response.index], evaluation.relations.values[response.index]) == 0;
            case Response::Kind::objective:
                break;
        }
        return true;
    }

    void sample() {
        std::vector<Sample> samples(options_.samples);
        core::base::parallel_for(options_.samples, 1, [&](int k) { samples[k] = sample_of(k); });
        std::vector<int> simulated;
        for (int k = 0; k < options_.samples; ++k) {
            const Sample& sample = samples[k];
            if (!sample.is_done) {
                report_.interrupted = true;
                continue;
            }
            ++report_.samples;
            if (sample.values.size() == 0) {
                report_.failed.push_back({k, sample.deviations, sample.reason});
                continue;
            }
            simulated.push_back(k);
            if (std::all_of(sample.met.begin(), sample.met.end(), [](bool met) { return met; })) ++report_.met_all;
        }
        if (simulated.size() < 2) return;
        for (int i = 0; i < count_of(report_.responses); ++i) describe(i, samples, simulated);
    }

    void describe(int i, const std::vector<Sample>& samples, const std::vector<int>& simulated) {
        Response& response = report_.responses[i];
        const auto count = static_cast<Eigen::Index>(simulated.size());
        VectorX values(count), missed(count);
        SampledResponse out;
        for (Eigen::Index k = 0; k < count; ++k) {
            const Sample& sample = samples[simulated[k]];
            values[k] = sample.values[i];
            missed[k] = std::abs(values[k] - predicted(response, sample.deviations));
            if (sample.met[i]) ++out.met;
        }
        Eigen::Index at = 0;
        out.least = values.minCoeff(&at);
        out.least_sample = simulated[at];
        out.most = values.maxCoeff(&at);
        out.most_sample = simulated[at];
        out.farthest = missed.maxCoeff(&at);
        out.farthest_sample = simulated[at];
        out.moments = tolerances::sample_moments(values);
        const Moments& moments = out.moments.moments;
        if (moments.standard_deviation > 0)
            out.unexplained = std::sqrt(missed.squaredNorm() / static_cast<double>(count)) / moments.standard_deviation;
        out.capability =
            tolerances::estimated_capability(moments.mean, moments.standard_deviation, limits_of(response), static_cast<int>(count));
        response.sampled = out;
    }

    const DesignProblem& problem_;
    const Design& design_;
    const std::vector<Tolerance>& tolerances_;
    const ToleranceOptions& options_;
    const int n_;
    const description::IndependentInputs inputs_ = independent_inputs(tolerances_);
    std::vector<Moments> deviations_;  // of each tolerance as a whole
    std::mutex mutex_;
    int done_ = 0, to_do_ = 0;
    ToleranceReport report_;
};

}  // namespace

bool has_bounds(const Response& response) { return std::isfinite(response.bounds.lower) || std::isfinite(response.bounds.upper); }

tolerances::RequirementLimits limits_of(const Response& response) { return {response.bounds.lower, response.bounds.upper}; }

ToleranceReport study_tolerances(const DesignProblem& problem, const std::vector<Tolerance>& tolerances, const ToleranceOptions& options) {
    return ToleranceStudy(problem, tolerances, options).run();
}

std::vector<Tightening> what_to_tighten(const ToleranceReport& report) {
    std::vector<Tightening> out;
    for (int i = 0; i < count_of(report.responses); ++i) {
        const Response& response = report.responses[i];
        const double mean = response.second_order ? response.second_order->mean : response.linear.mean;
        const double sigma = response.linear.standard_deviation;
        const double needed = std::min(response.bounds.upper - mean, mean - response.bounds.lower) / 3;
        if (!(sigma > needed) || response.contributions.empty()) continue;
        Tightening tightening{i, needed, {}, 0};
        if (needed > 0) {
            const double own = response.contributions.front().share * sigma * sigma;
            const double left = needed * needed - (sigma * sigma - own);
            const bool is_enough = left > 0 && response.contributions.front().tolerance >= 0;
            if (is_enough) tightening.tolerance = response.contributions.front().tolerance;
            tightening.factor = is_enough ? std::sqrt(left / own) : needed / sigma;
        }
        out.push_back(tightening);
    }
    return out;
}

std::vector<int> what_may_be_loosened(const ToleranceReport& report, const std::vector<Tolerance>& tolerances) {
    constexpr double little = 0.01;
    std::vector<int> out;
    for (int k = 0; k < count_of(tolerances); ++k) {
        const auto is_of_it = [&](const Contribution& c) {
            return c.tolerance == k || (c.tolerance < 0 && c.of == tolerances[k].group && tolerances[k].correlation != 0);
        };
        const bool is_little = std::all_of(report.responses.begin(), report.responses.end(), [&](const Response& response) {
            return !has_bounds(response) || std::all_of(response.contributions.begin(), response.contributions.end(),
                                                        [&](const Contribution& c) { return !is_of_it(c) || c.share <= little; });
        });
        if (is_little) out.push_back(k);
    }
    return out;
}

}  // namespace fettle::design::studies
