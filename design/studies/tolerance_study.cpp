// SPDX-License-Identifier: MIT
#include "design/studies/tolerance_study.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <map>
#include <mutex>
#include <utility>

#include "core/base/parallel.hpp"
#include "design/gradient_audit/contact_states.hpp"
#include "design/problem/motion_warnings.hpp"

namespace fettle::design::studies {

namespace {

using description::Tolerance;
using problem::DesignEvaluation;
using problem::DesignProblem;
using tolerances::Moments;

constexpr int predicted_samples = 1 << 17;  // of the second order alone, whose yield the control variate takes as known

class ToleranceStudy {
public:
    ToleranceStudy(const DesignProblem& problem, const std::vector<Tolerance>& tolerances, const ToleranceOptions& options)
        : tolerances_(tolerances),
          options_(options),
          made_(problem, tolerances, options.should_stop, [this] { count(); }),
          n_(count_of(tolerances)) {
        for (const Tolerance& tolerance : tolerances) deviations_.push_back(moments_of(tolerance.deviation));
        to_do_ = 1 + (options.second_order ? 2 * n_ : 0);
        for (int k = 0; k < options.samples; ++k)
            if (options.file == nullptr || options.file->find(k) == nullptr) ++to_do_;
    }

    ToleranceReport run() {
        report_.seed = options_.seed;
        for (const AskedNumber& number : made_.numbers()) {
            Response response;
            static_cast<AskedNumber&>(response) = number;
            report_.responses.push_back(std::move(response));
        }
        const MadeEvaluation nominal = as_drawn();
        if (!nominal.usable) {
            report_.interrupted = nominal.interrupted;
            report_.reason = "the design as drawn cannot be simulated: " + nominal.reason;
            return std::move(report_);
        }
        for (int i = 0; i < count_of(report_.responses); ++i) {
            report_.responses[i].nominal = nominal.values[i];
            report_.responses[i].gradient = nominal.jacobian.row(i).transpose();
        }
        if (options_.second_order) take_curvatures(nominal.jacobian);
        for (Response& response : report_.responses) predict(response);
        if (options_.worst_case && !report_.interrupted) find_worst_cases();
        if (options_.samples > 0 && !report_.interrupted) sample();
        if (!report_.interrupted) find_switched_contacts();
        return std::move(report_);
    }

private:
    MadeEvaluation as_drawn() {
        const problem::DesignEvaluation evaluation = made_.simulate(VectorX::Zero(n_), true, true);
        report_.warnings = problem::motion_warnings(made_.design(), evaluation);
        return made_.measured(evaluation, true);
    }

    void count() {
        ++done_;
        if (options_.on_simulation) options_.on_simulation(done_, std::max(done_, to_do_));
    }

    // By central differences of gradients at one standard deviation of each tolerance; a tolerance of no width has none.
    void take_curvatures(const MatrixX& here) {
        std::vector<MadeEvaluation> at(2 * n_);
        core::base::parallel_for(2 * n_, 1, [&](int task) {
            const int k = task / 2;
            if (deviations_[k].standard_deviation == 0) return;
            VectorX deviations = VectorX::Zero(n_);
            deviations[k] = (task % 2 == 0 ? 1 : -1) * deviations_[k].standard_deviation;
            at[task] = made_.evaluate(deviations, true);
        });
        std::vector<MatrixX> curvatures(report_.responses.size(), MatrixX::Zero(n_, n_)), thirds = curvatures;
        for (int k = 0; k < n_; ++k) {
            if (deviations_[k].standard_deviation == 0) continue;
            const MadeEvaluation &up = at[2 * k], &down = at[2 * k + 1];
            if (!up.usable || !down.usable) {
                report_.interrupted = report_.interrupted || up.interrupted || down.interrupted;
                report_.no_second_order = "with `" + tolerances_[k].of + "` one standard deviation " + (up.usable ? "smaller" : "larger") +
                                          ": " + (up.usable ? down : up).reason;
                return;
            }
            const double step = deviations_[k].standard_deviation;
            for (int i = 0; i < count_of(curvatures); ++i) {
                curvatures[i].row(k) = (up.jacobian.row(i) - down.jacobian.row(i)) / (2 * step);
                thirds[i].row(k) = (up.jacobian.row(i) - 2 * here.row(i) + down.jacobian.row(i)) / (step * step);
            }
        }
        for (std::size_t i = 0; i < curvatures.size(); ++i) {
            report_.responses[i].curvature = 0.5 * (curvatures[i] + curvatures[i].transpose());
            take_second_order(report_.responses[i], thirds[i]);
        }
    }

    Moments quadratic_of(const Response& response) const {
        return tolerances::predict_quadratically(response.nominal, inputs_.map.transpose() * response.gradient,
                                                 inputs_.map.transpose() * response.curvature * inputs_.map, inputs_.moments);
    }

    // With the third derivatives that the same gradients show, d^3 y / dd_j^2 dd_l, if they are those at the means of deviations that are
    // independent; in three different deviations they are not known. Where they would change the variance by more than half, as where a
    // contact begins within the tolerances, they are no derivatives of anything.
    void take_second_order(Response& response, const MatrixX& third) const {
        constexpr double much = 0.5;
        response.second_order = quadratic_of(response);
        const bool at_means = std::all_of(deviations_.begin(), deviations_.end(), [](const Moments& d) { return d.mean == 0; });
        if (!at_means || !inputs_.groups.empty()) return;
        VectorX v = response.gradient;
        for (int j = 0; j < n_; ++j) v[j] *= deviations_[j].standard_deviation * deviations_[j].standard_deviation;
        double along = 0;
        for (int j = 0; j < n_; ++j)
            for (int l = 0; l < n_; ++l) along += (j == l ? 1 : 3) * third(j, l) * v[j] * v[j] * v[l];
        const Moments all = tolerances::predict_with_third_derivatives(response.nominal, response.gradient, response.curvature,
                                                                       {third, along}, deviations_);
        const double before = std::pow(response.second_order->standard_deviation, 2), after = std::pow(all.standard_deviation, 2);
        response.is_rough = std::abs(after - before) > much * before;
        if (!response.is_rough) response.second_order = all;
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

    // All searches share their simulations.
    void find_worst_cases() {
        WorstCaseSearch search(made_);
        std::vector<int> wanted;
        for (int i = 0; i < count_of(report_.responses); ++i)
            if (has_bounds(report_.responses[i])) wanted.push_back(i);
        std::atomic<bool> is_interrupted = false;
        core::base::parallel_for(2 * count_of(wanted), 1, [&](int task) {
            Response& response = report_.responses[wanted[task / 2]];
            const bool is_most = task % 2 != 0;
            if (is_interrupted) return;
            try {
                (is_most ? response.most_found : response.least_found) =
                    search.extreme(wanted[task / 2], is_most ? 1 : -1, {response.nominal, response.gradient, response.curvature});
            } catch (const optimisers::Interrupted&) {
                is_interrupted = true;
            }
        });
        report_.interrupted = report_.interrupted || is_interrupted;
    }

    // Nothing: not begun, or interrupted.
    std::optional<MadeSample> sample_of(int number, const description::DeviationSamples& deviations) {
        MadeSample out;
        out.number = number;
        out.deviations = deviations.at(number);
        if (const SampleOutcome* known = options_.file != nullptr ? options_.file->find(number) : nullptr; known != nullptr) {
            static_cast<SampleOutcome&>(out) = *known;
            return out;
        }
        if (made_.should_stop()) return std::nullopt;
        MadeEvaluation evaluation = made_.evaluate(out.deviations, false);
        if (evaluation.interrupted) return std::nullopt;
        out.values = std::move(evaluation.values);
        out.met = std::move(evaluation.met);
        out.reason = std::move(evaluation.reason);
        const std::lock_guard lock(file_mutex_);
        if (options_.file != nullptr) options_.file->append(number, out);
        return out;
    }

    void sample() {
        const description::DeviationSamples deviations(tolerances_, options_.seed);
        std::vector<std::optional<MadeSample>> samples(options_.samples);
        core::base::parallel_for(options_.samples, 1, [&](int k) { samples[k] = sample_of(k, deviations); });
        for (std::optional<MadeSample>& sample : samples) {
            if (!sample) {
                report_.interrupted = true;
                continue;
            }
            const bool met_all = !sample->failed() && std::all_of(sample->met.begin(), sample->met.end(), [](bool met) { return met; });
            if (met_all) ++report_.met_all;
            report_.samples.push_back(std::move(*sample));
        }
        std::vector<const MadeSample*> simulated;
        for (const MadeSample& sample : report_.samples)
            if (!sample.failed()) simulated.push_back(&sample);
        if (simulated.size() < 2) return;
        for (int i = 0; i < count_of(report_.responses); ++i) describe(i, simulated);
        control_yields();
    }

    void describe(int i, const std::vector<const MadeSample*>& simulated) {
        Response& response = report_.responses[i];
        const auto count = static_cast<Eigen::Index>(simulated.size());
        VectorX values(count), predictions(count);
        SampledResponse out;
        for (Eigen::Index k = 0; k < count; ++k) {
            const MadeSample& sample = *simulated[k];
            values[k] = sample.values[i];
            predictions[k] = predicted(response, sample.deviations);
            if (sample.met[i]) ++out.met;
        }
        Eigen::Index at = 0;
        out.least = values.minCoeff(&at);
        out.least_sample = simulated[at]->number;
        out.most = values.maxCoeff(&at);
        out.most_sample = simulated[at]->number;
        const VectorX missed = (values - predictions).cwiseAbs();
        out.farthest = missed.maxCoeff(&at);
        out.farthest_sample = simulated[at]->number;
        out.moments = tolerances::sample_moments(values);
        const Moments& moments = out.moments.moments;
        if (moments.standard_deviation > 0)
            out.unexplained = std::sqrt(missed.squaredNorm() / static_cast<double>(count)) / moments.standard_deviation;
        out.capability =
            tolerances::estimated_capability(moments.mean, moments.standard_deviation, limits_of(response), static_cast<int>(count));
        if (response.second_order && count >= 3)
            out.controlled_mean = tolerances::controlled_mean(values, predictions, quadratic_of(response).mean);
        response.sampled = out;
    }

    static bool is_predicted_good(const Response& response, const VectorX& deviations) {
        const double value = predicted(response, deviations);
        return value >= response.bounds.lower && value <= response.bounds.upper;
    }

    // Samples that failed are lost where they were predicted to be good.
    void control_yields() {
        const int m = count_of(report_.responses), all = m;  // the last count is of all responses together
        if (std::any_of(report_.responses.begin(), report_.responses.end(), [](const Response& r) { return !r.second_order; })) return;
        const auto goods = [&](const VectorX& deviations) {
            std::vector<char> good(m + 1, 1);
            for (int i = 0; i < m; ++i) {
                good[i] = is_predicted_good(report_.responses[i], deviations) ? 1 : 0;
                good[all] = good[all] & good[i];
            }
            return good;
        };
        std::vector<int> predicted_good(m + 1, 0), gained(m + 1, 0), lost(m + 1, 0);
        const description::DeviationSamples many(tolerances_, options_.seed + 1);
        for (int k = 0; k < predicted_samples; ++k) {
            const std::vector<char> good = goods(many.at(k));
            for (int i = 0; i <= m; ++i) predicted_good[i] += good[i];
        }
        for (const MadeSample& sample : report_.samples) {
            const std::vector<char> good = goods(sample.deviations);
            bool met_all = true;
            for (int i = 0; i <= m; ++i) {
                const bool met = i == all ? met_all : !sample.failed() && sample.met[i];
                met_all = met_all && met;
                if (met && good[i] == 0) ++gained[i];
                if (!met && good[i] != 0) ++lost[i];
            }
        }
        // Where predictions err seldom but samples nearly all agree, the count alone says more.
        const auto estimate = [&](int i, int met) -> std::optional<tolerances::CountedYield> {
            const int n = count_of(report_.samples);
            const auto width = [](const tolerances::CountedYield& yield) { return yield.most.within - yield.least.within; };
            const auto controlled =
                tolerances::controlled_yield(static_cast<double>(predicted_good[i]) / predicted_samples, gained[i], lost[i], n, confidence);
            if (!(width(controlled) < width(tolerances::counted_yield(met, n, confidence)))) return std::nullopt;
            return controlled;
        };
        for (int i = 0; i < m; ++i)
            if (has_bounds(report_.responses[i]))
                report_.responses[i].sampled->controlled_yield = estimate(i, report_.responses[i].sampled->met);
        report_.controlled_yield = estimate(all, report_.met_all);
    }

    void find_switched_contacts() {
        std::map<int, std::vector<int>> farthest;  // responses by sample
        for (int i = 0; i < count_of(report_.responses); ++i) {
            const auto& sampled = report_.responses[i].sampled;
            if (sampled && sampled->unexplained > much_unexplained) farthest[sampled->farthest_sample].push_back(i);
        }
        if (farthest.empty()) return;
        const DesignEvaluation drawn = made_.simulate(VectorX::Zero(n_), false);
        const description::DeviationSamples deviations(tolerances_, options_.seed);
        for (const auto& [number, responses] : farthest) {
            const DesignEvaluation evaluation = made_.simulate(deviations.at(number), false);
            if (!drawn.usable || !evaluation.usable) continue;
            report_.switched.push_back({number, responses, changes_between(drawn, evaluation)});
        }
    }

    std::vector<gradient_audit::ContactChange> changes_between(const DesignEvaluation& drawn, const DesignEvaluation& sample) const {
        std::vector<gradient_audit::ContactChange> out;
        for (std::size_t s = 0; s < drawn.runs.size(); ++s) {
            const problem::Run &from = drawn.runs[s], &to = sample.runs[s];
            const auto contacts = gradient_audit::contact_states(*from.model, from.simulation.trajectory);
            gradient_audit::ContactWatch watch(contacts);
            watch.add(1, *to.model, to.simulation.trajectory);
            for (auto& change : watch.changes({}, 1, 1, *from.model, from.simulation.trajectory)) {
                if (!made_.design().scenarios.empty()) change.scenario = made_.design().scenarios[s].name;
                out.push_back(std::move(change));
            }
        }
        std::stable_sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.time < b.time; });
        return out;
    }

    const std::vector<Tolerance>& tolerances_;
    const ToleranceOptions& options_;
    const MadeResponses made_;
    const int n_;
    const description::IndependentInputs inputs_ = independent_inputs(tolerances_);
    std::vector<Moments> deviations_;  // of each tolerance as a whole
    std::mutex file_mutex_;
    int done_ = 0, to_do_ = 0;
    ToleranceReport report_;
};

}  // namespace

double predicted(const Response& response, const VectorX& deviations) {
    const double linear = response.nominal + response.gradient.dot(deviations);
    return response.curvature.size() == 0 ? linear : linear + 0.5 * deviations.dot(response.curvature * deviations);
}

tolerances::RequirementLimits limits_of(const Response& response) { return {response.bounds.lower, response.bounds.upper}; }

ToleranceReport study_tolerances(const DesignProblem& problem, const std::vector<Tolerance>& tolerances, const ToleranceOptions& options) {
    return ToleranceStudy(problem, tolerances, options).run();
}

std::optional<WorstSample> worst_sample(const ToleranceReport& report) {
    std::optional<WorstSample> worst;
    double most = 0;
    for (int i = 0; i < count_of(report.responses); ++i) {
        const Response& response = report.responses[i];
        if (!response.sampled || !has_bounds(response)) continue;
        const double sigma = response.sampled->moments.moments.standard_deviation;
        if (!(sigma > 0)) continue;
        for (const MadeSample& sample : report.samples) {
            if (sample.failed()) continue;
            const double value = sample.values[i];
            const double beyond = std::max(response.bounds.lower - value, value - response.bounds.upper) / sigma;
            if (worst && !(beyond > most)) continue;
            worst = WorstSample{sample.number, i, !sample.met[i]};
            most = beyond;
        }
    }
    return worst;
}

std::vector<FailureKind> kinds_of_failure(const ToleranceReport& report) {
    const auto without_numbers = [](const std::string& reason) {
        std::string out;
        for (const char c : reason)
            if (std::strchr("0123456789.+-", c) == nullptr) out += c;
        return out;
    };
    std::vector<std::pair<std::string, FailureKind>> kinds;
    for (const MadeSample& sample : report.samples) {
        if (!sample.failed()) continue;
        const std::string kind = without_numbers(sample.reason);
        const auto found = std::find_if(kinds.begin(), kinds.end(), [&](const auto& each) { return each.first == kind; });
        if (found == kinds.end())
            kinds.push_back({kind, {sample.number, 1, sample.reason}});
        else
            ++found->second.count;
    }
    std::stable_sort(kinds.begin(), kinds.end(), [](const auto& a, const auto& b) { return a.second.count > b.second.count; });
    std::vector<FailureKind> out;
    for (auto& each : kinds) out.push_back(std::move(each.second));
    return out;
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
