// SPDX-License-Identifier: MIT
#include "design/gradient_audit/difference_check.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <mutex>
#include <numeric>
#include <utility>

#include "core/base/contract.hpp"
#include "core/base/limits.hpp"
#include "core/base/parallel.hpp"
#include "design/gradient_audit/design_line.hpp"

namespace fettle::design::gradient_audit {
namespace {

using core::base::infinity;

// The differences of all quantities to either side of a design, by steps that shrink; per unit of the parameter's range.
struct QuantitySlopes {
    std::vector<double> steps;
    std::vector<VectorX> below, above;

    SideSlopes of(Eigen::Index q) const {
        SideSlopes result{steps, {}, {}};
        for (const VectorX& slopes : below) result.below.push_back(slopes[q]);
        for (const VectorX& slopes : above) result.above.push_back(slopes[q]);
        return result;
    }
};

// What the roughness of the quantities says about differences; steps and derivatives in parameters scaled by their ranges.
struct DifferenceSteps {
    double first = 0;   ///< step that differences begin with
    VectorX values;     ///< per quantity: where the gradients are checked
    VectorX noise;      ///< per quantity: its rounding
    VectorX size;       ///< per quantity: its largest value
    VectorX tolerance;  ///< per quantity: what need not be distinguished

    // The error of (q(s) - q(-s)) / 2s by noise: standard deviation noise / (sqrt(2) s), three of it.
    double noise_error(Eigen::Index q, double step) const { return 3 / std::sqrt(2.0) * noise[q] / step; }
    // What a derivative is compared with at least, per unit of the range.
    double floor(Eigen::Index q, const CheckOptions& options) const { return std::max(options.size_fraction * size[q], tolerance[q]); }
    // One that the check would see: it makes a central difference wrong by half of it.
    Kink kink(Eigen::Index q, const QuantitySlopes& slopes, double slope, const CheckOptions& options) const {
        return kink_of(slopes.of(q), noise[q], options.limit * std::max(std::abs(slope), floor(q, options)));
    }
};

// Differences begin where the gradients of all quantities hold, or at the usual step if they do so farther. But never below the step that
// would be best for a quantity whose third derivative is its own size (the next size is that): a wrong adjoint, whose prediction holds
// nowhere, must not lead to steps at which noise hides that.
DifferenceSteps difference_steps(const RoughnessReport& roughness, const VectorX& values, const CheckOptions& options) {
    DifferenceSteps steps{options.usual_step, values, std::numeric_limits<double>::epsilon() * values.cwiseAbs(), values.cwiseAbs(),
                          VectorX::Zero(values.size())};
    double least = 0;
    for (Eigen::Index q = 0; q < values.size() && roughness.measured; ++q) {
        const QuantityRoughness& quantity = roughness.quantities[q];
        steps.noise[q] = quantity.rounding;
        steps.size[q] = quantity.size;
        steps.tolerance[q] = quantity.tolerance;
        steps.first = std::min(steps.first, quantity.holds);
        if (quantity.size > 0) least = std::max(least, optimisers::best_central_step(quantity.rounding, quantity.size));
    }
    steps.first = std::max(steps.first, std::min(least * options.ratio, options.largest_step));
    return steps;
}

struct ParameterDifferences {
    std::vector<DifferenceEstimate> estimates;  ///< per quantity, per unit of the parameter's range
    std::vector<Kink> kinks;                    ///< per quantity, likewise
    std::vector<ContactChange> contact_changes;
    Vector2 contacts_reach = Vector2::Zero();
    std::string failure;
    bool interrupted = false;
};

// Where the gradients are checked: how it was simulated, and its contacts.
struct CheckedDesign {
    const problem::DesignEvaluation& evaluation;
    std::vector<std::vector<std::vector<ContactState>>> contacts;  ///< of each scenario
};

class ParameterCheck {
public:
    ParameterCheck(const problem::DesignProblem& problem, const VectorX& p, int parameter, const DifferenceSteps& steps,
                   const CheckOptions& options, const CheckedDesign& at)
        : problem_(problem),
          p_(p),
          parameter_(parameter),
          range_(parameter_ranges(problem.design())[parameter]),
          steps_(steps),
          options_(options),
          at_(at),
          above_(at.contacts.begin(), at.contacts.end()),
          below_(at.contacts.begin(), at.contacts.end()) {}

    ParameterDifferences run(const std::function<void()>& on_simulation) {
        on_simulation_ = on_simulation;
        double step = steps_.first;
        if (options_.contact_reach > step)
            for (const double side : {1.0, -1.0}) simulate_beside(side, options_.contact_reach);
        if (result_.interrupted) return std::move(result_);
        for (int size = 0; size < options_.sizes; ++size, step /= options_.ratio) {
            if (!add_difference(step)) break;
            result_.estimates = estimates(step);
            if (result_.interrupted || good_enough(step)) break;
        }
        result_.kinks = kinks();
        result_.contacts_reach = {below_.front().reach(), above_.front().reach()};
        for (size_t s = 0; s < above_.size(); ++s) {
            const problem::Run& at = at_.evaluation.runs[s];
            const auto& scenarios = problem_.design().scenarios;
            for (const auto& [side, watch] : {std::pair(-1.0, &below_[s]), std::pair(1.0, &above_[s])})
                for (ContactChange& change : watch->changes(name(), side, range_, *at.model, at.simulation.trajectory)) {
                    if (!scenarios.empty()) change.scenario = scenarios[s].name;
                    result_.contact_changes.push_back(std::move(change));
                }
        }
        return std::move(result_);
    }

private:
    const std::string& name() const { return problem_.design().parameters[parameter_].name; }

    struct Trial {
        problem::DesignEvaluation evaluation;
        double value = 0;  ///< of the parameter, as the double that it is
    };
    Trial simulate_beside(double side, double step) {
        VectorX p = p_;
        p[parameter_] += side * step * range_;
        problem::EvaluateOptions options;
        options.gradients = false;
        options.should_stop = options_.should_stop;
        Trial trial{problem_.evaluate(p, options), p[parameter_]};
        on_simulation_();
        result_.interrupted = result_.interrupted || trial.evaluation.interrupted;
        for (size_t s = 0; trial.evaluation.usable && s < above_.size(); ++s) {
            const problem::Run& run = trial.evaluation.runs[s];
            (side > 0 ? above_ : below_)[s].add(step, *run.model, run.simulation.trajectory);
        }
        return trial;
    }

    // Where a trial fails the sequence begins anew with the next size, for extrapolation needs one ratio throughout; false: it ends, with
    // enough differences to extrapolate and to say how good that is.
    bool add_difference(double step) {
        constexpr std::size_t enough = 3;
        const Trial up = simulate_beside(1, step);
        const Trial down = up.evaluation.usable ? simulate_beside(-1, step) : Trial{};
        if (!down.evaluation.usable) {
            result_.failure = up.evaluation.usable ? down.evaluation.reason : up.evaluation.reason;
            if (differences_.size() >= enough) return false;
            differences_.clear();
            slopes_ = {};
            return true;
        }
        result_.failure.clear();
        const VectorX above = quantities_of(up.evaluation), below = quantities_of(down.evaluation);
        differences_.push_back((above - below) * (range_ / (up.value - down.value)));  // their distance is exact, not 2 step
        slopes_.steps.push_back(step);
        slopes_.above.push_back((above - steps_.values) * (range_ / (up.value - p_[parameter_])));
        slopes_.below.push_back((steps_.values - below) * (range_ / (p_[parameter_] - down.value)));
        return true;
    }

    // @param step  The step of the newest difference.
    std::vector<DifferenceEstimate> estimates(double step) const {
        std::vector<DifferenceEstimate> result;
        if (differences_.empty()) return result;
        const double first = step * std::pow(options_.ratio, static_cast<double>(differences_.size()) - 1);
        for (Eigen::Index q = 0; q < differences_.front().size(); ++q) {
            std::vector<double> column;
            for (const VectorX& d : differences_) column.push_back(d[q]);
            result.push_back(ridders_estimate(column, options_.ratio, steps_.noise_error(q, first)));
        }
        return result;
    }

    std::vector<Kink> kinks() const {
        std::vector<Kink> found(static_cast<size_t>(steps_.values.size()));
        for (Eigen::Index q = 0; q < steps_.values.size() && !differences_.empty(); ++q)
            found[static_cast<size_t>(q)] = steps_.kink(q, slopes_, differences_.back()[q], options_);
        return found;
    }

    // Each estimate is a hundred times better than asked for, or noise at the next size would outweigh the error that it has.
    bool good_enough(double step) const {
        if (differences_.size() < 3) return false;
        for (size_t k = 0; k < result_.estimates.size(); ++k) {
            const DifferenceEstimate& estimate = result_.estimates[k];
            const Eigen::Index q = static_cast<Eigen::Index>(k);
            const double scale = std::max(std::abs(estimate.value), steps_.floor(q, options_));
            const bool accurate = estimate.error <= 1e-2 * options_.limit * scale;
            const bool noisy = steps_.noise_error(q, step / options_.ratio) >= estimate.error;
            if (!accurate && !noisy) return false;
        }
        return true;
    }

    const problem::DesignProblem& problem_;
    const VectorX& p_;
    int parameter_;
    double range_;
    const DifferenceSteps& steps_;
    const CheckOptions& options_;
    const CheckedDesign& at_;
    std::vector<ContactWatch> above_, below_;  // of each scenario
    std::function<void()> on_simulation_;
    std::vector<VectorX> differences_;
    QuantitySlopes slopes_;
    ParameterDifferences result_;
};

// a, d: adjoint and difference; floor: what is less is compared at that. All per unit of the parameter's range.
CheckRow compared(double a, const DifferenceEstimate& d, double floor, double limit) {
    const double scale = std::max({std::abs(a), std::abs(d.value), floor});
    CheckRow row;
    if (!(scale > 0)) return row;
    row.difference_error = d.error / scale;
    row.relative_error = std::abs(a - d.value) / scale;
    row.resolved = d.noise_error <= limit * scale;
    return row;
}

// The part of a row's error that noise cannot make. At a kink no difference is a derivative: 0 where the gradient lies between the slopes.
template <class Row>
double told_error(const Row& row) {
    if (row.lies_between) return 0;
    return row.resolved ? row.relative_error : std::max(0.0, row.relative_error - row.difference_error);
}

// Differences that ended early are taken only if they are as good as the limit. @return per parameter, whether some of it, or all, was not
// compared
std::vector<bool> compare(const problem::DesignProblem& problem, const MatrixX& adjoint, const std::vector<ParameterDifferences>& found,
                          const DifferenceSteps& steps, const CheckOptions& options, CheckReport& report) {
    std::vector<bool> is_open(found.size(), false);
    const std::vector<std::string> names = quantity_names(problem.design());
    const VectorX ranges = parameter_ranges(problem.design());
    for (Eigen::Index q = 0; q < adjoint.rows(); ++q) {
        const double norm = adjoint.row(q).transpose().cwiseProduct(ranges).norm();
        const double floor = std::max(options.scale_fraction * norm, steps.floor(q, options));
        for (Eigen::Index k = 0; k < adjoint.cols(); ++k) {
            const ParameterDifferences& differences = found[k];
            if (differences.estimates.empty()) {
                is_open[k] = true;
                continue;
            }
            const DifferenceEstimate& estimate = differences.estimates[q];
            CheckRow row = compared(adjoint(q, k) * ranges[k], estimate, floor, options.limit);
            if (!differences.failure.empty() && !(row.difference_error <= options.limit)) {
                is_open[k] = true;
                continue;
            }
            row.quantity = names[q];
            row.parameter = problem.design().parameters[k].name;
            row.adjoint = adjoint(q, k);
            row.difference = estimate.value / ranges[k];
            const Kink& kink = differences.kinks[static_cast<size_t>(q)];
            row.kink = kink.jump() / ranges[k];
            row.lies_between = kink.jump() != 0 && kink.lies_between(adjoint(q, k) * ranges[k], options.limit * floor);
            report.largest_relative_error = std::max(report.largest_relative_error, told_error(row));
            report.rows.push_back(std::move(row));
        }
    }
    return is_open;
}

// Along one direction: steps fall from the first that differences begin with, by sqrt(10).
class LineCheck {
public:
    LineCheck(const problem::DesignProblem& problem, const VectorX& p, const VectorX& direction, const DifferenceSteps& steps,
              const CheckOptions& options)
        : problem_(problem),
          names_(quantity_names(problem.design())),
          p_(p),
          way_(direction.cwiseProduct(parameter_ranges(problem.design()))),
          steps_(steps),
          options_(options) {}

    /// @param slopes  of the quantities along the direction, by the adjoint. @return empty if the line cannot be simulated
    std::vector<LineRow> run(const VectorX& slopes, const std::function<void()>& on_simulation) {
        const int count = options_.line_sizes;
        std::vector<double> t(count, steps_.first);
        for (size_t k = 1; k < t.size(); ++k) t[k] = t[k - 1] / ratio;
        std::vector<VectorX> above(count), below = above;
        core::base::parallel_for(2 * count, 1, [&](int k) {
            const size_t at = static_cast<size_t>(k % count);
            (k < count ? above : below)[at] = change(k < count ? t[at] : -t[at]);
            on_simulation();
        });
        for (size_t k = 0; k < t.size(); ++k)
            if (above[k].size() == 0 || below[k].size() == 0) return {};
        QuantitySlopes sides{t, {}, {}};
        for (size_t k = 0; k < t.size(); ++k) {
            sides.above.push_back(above[k] / t[k]);
            sides.below.push_back(-below[k] / t[k]);
        }
        std::vector<LineRow> rows;
        for (Eigen::Index q = 0; q < slopes.size(); ++q) {
            std::vector<double> differences, up, down;
            for (size_t k = 0; k < t.size(); ++k) {
                differences.push_back((above[k][q] - below[k][q]) / (2 * t[k]));
                up.push_back(above[k][q] - t[k] * slopes[q]);
                down.push_back(below[k][q] + t[k] * slopes[q]);
            }
            rows.push_back(row(q, slopes[q], differences));
            const Kink kink = steps_.kink(q, sides, slopes[q], options_);
            rows.back().kink = kink.jump();
            rows.back().lies_between = kink.jump() != 0 && kink.lies_between(slopes[q], options_.limit * steps_.floor(q, options_));
            const double a = slope_of(t, up, q), b = slope_of(t, down, q);
            rows.back().slope = std::isfinite(a) && !(std::abs(b - 2) > std::abs(a - 2)) ? a : b;
        }
        return rows;
    }

private:
    VectorX change(double t) const {
        problem::EvaluateOptions options;
        options.gradients = false;
        options.should_stop = options_.should_stop;
        const problem::DesignEvaluation there = problem_.evaluate(p_ + t * way_, options);
        return there.usable ? VectorX(quantities_of(there) - steps_.values) : VectorX();
    }

    LineRow row(Eigen::Index q, double slope, const std::vector<double>& differences) const {
        const DifferenceEstimate d = ridders_estimate(differences, ratio, steps_.noise_error(q, steps_.first));
        const CheckRow c = compared(slope, d, steps_.floor(q, options_), options_.limit);
        LineRow result;
        result.quantity = names_[q];
        result.adjoint = slope;
        result.difference = d.value;
        result.difference_error = c.difference_error;
        result.relative_error = c.relative_error;
        result.resolved = c.resolved;
        return result;
    }

    // NaN: too few remainders stand clear of noise.
    double slope_of(const std::vector<double>& t, const std::vector<double>& remainder, Eigen::Index q) const {
        constexpr double fewest = 4, most = 5, clear = 30;  // points; times the noise
        std::vector<double> x, y;
        for (size_t k = t.size(); k-- > 0 && static_cast<double>(x.size()) < most;) {
            if (!(std::abs(remainder[k]) > clear * steps_.noise[q])) continue;
            x.push_back(std::log(t[k]));
            y.push_back(std::log(std::abs(remainder[k])));
        }
        if (static_cast<double>(x.size()) < fewest) return std::numeric_limits<double>::quiet_NaN();
        const Eigen::Map<const VectorX> at(x.data(), x.size()), of(y.data(), y.size());
        const VectorX offset = at.array() - at.mean();
        return offset.dot(of) / offset.squaredNorm();
    }

    static constexpr double ratio = 3.1622776601683795;
    const problem::DesignProblem& problem_;
    const std::vector<std::string> names_;
    const VectorX& p_;
    const VectorX way_;
    const DifferenceSteps& steps_;
    const CheckOptions& options_;
};

// In the order of the design; those that the objective depends on most, if not all.
std::vector<int> parameters_to_check(const problem::DesignProblem& problem, const VectorX& gradient, int most) {
    std::vector<int> order(gradient.size());
    std::iota(order.begin(), order.end(), 0);
    if (most <= 0 || most >= count_of(order)) return order;
    const VectorX share = gradient.cwiseProduct(parameter_ranges(problem.design())).cwiseAbs();
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return share[a] > share[b]; });
    order.resize(most);
    std::sort(order.begin(), order.end());
    return order;
}

}  // namespace

DifferenceEstimate ridders_estimate(const std::vector<double>& differences, double ratio, double noise_error) {
    FETTLE_ASSERT(!differences.empty() && ratio > 1, "differences of shrinking step size");
    DifferenceEstimate best{differences.front(), infinity, noise_error};
    std::vector<double> previous, row;
    for (const double difference : differences) {
        row.assign(1, difference);
        double factor = ratio * ratio;
        for (size_t j = 1; j <= previous.size(); ++j, factor *= ratio * ratio) {
            row.push_back(row[j - 1] + (row[j - 1] - previous[j - 1]) / (factor - 1));
            const double error = std::max({std::abs(row[j] - row[j - 1]), std::abs(row[j] - previous[j - 1]), noise_error});
            if (error < best.error) best = {row[j], error, noise_error};
        }
        previous = row;
        noise_error *= ratio;
    }
    return best;
}

bool Kink::lies_between(double slope, double accuracy) const {
    const double open = error + accuracy;
    return slope >= std::min(below, above) - open && slope <= std::max(below, above) + open;
}

Kink kink_of(const SideSlopes& slopes, double noise, double least) {
    FETTLE_ASSERT(slopes.below.size() == slopes.steps.size() && slopes.above.size() == slopes.steps.size(), "a slope per step and side");
    for (size_t k = slopes.steps.size(); k-- > 1;) {
        const double noise_error = 3 * std::sqrt(2.0) * noise / slopes.steps[k];  // of a slope: three standard deviations
        const double jump = slopes.above[k] - slopes.below[k], before = slopes.above[k - 1] - slopes.below[k - 1];
        if (!(std::abs(jump) > 2 * noise_error)) {
            if (2 * noise_error <= least) return {};  // one that counts would show
            continue;
        }
        const bool stays = std::abs(jump) > 0.6 * std::abs(before) && jump * before > 0;
        if (!stays || !(std::abs(jump) > least)) return {};
        const double change = std::max(std::abs(slopes.above[k] - slopes.above[k - 1]), std::abs(slopes.below[k] - slopes.below[k - 1]));
        if (change + noise_error > std::abs(jump)) return {};  // known too little to judge a gradient by
        return {slopes.below[k], slopes.above[k], change + noise_error};
    }
    return {};
}

int check_cost(int parameters, const CheckOptions& options) {
    if (options.most_parameters > 0) parameters = std::min(parameters, options.most_parameters);
    return options.roughness.intervals * (options.roughness.fine_spacing > 0 ? 2 : 1) + options.roughness.distances +
           2 * options.line_sizes + 2 * (options.sizes + (options.contact_reach > 0 ? 1 : 0)) * parameters;
}

CheckReport check_gradients(const problem::DesignProblem& problem, const VectorX& p, const problem::DesignEvaluation& at,
                            const CheckOptions& options) {
    FETTLE_ASSERT(at.usable && at.gradient.size() == p.size(), "the gradients to check");
    const int n = problem.parameter_count();
    CheckReport report;
    std::mutex progress;
    const std::function<void()> count = [&] {
        const std::lock_guard<std::mutex> lock(progress);
        ++report.simulations;
        if (options.on_simulation) options.on_simulation(report.simulations, std::max(check_cost(n, options), report.simulations));
    };
    RoughnessOptions roughness = options.roughness;
    roughness.should_stop = options.should_stop;
    roughness.on_simulation = [&](int, int) { count(); };
    report.roughness = measure_roughness(problem, p, at, roughness);
    report.interrupted = report.roughness.interrupted;
    if (report.interrupted) return report;

    const DifferenceSteps steps = difference_steps(report.roughness, quantities_of(at), options);
    report.first_step = steps.first;
    report.sweeps = compare_sweeps(problem, at);
    if (report.roughness.measured && options.line_sizes > 0) {
        const VectorX& direction = report.roughness.direction;
        report.along = LineCheck(problem, p, direction, steps, options)
                           .run(quantity_gradients(at) * direction.cwiseProduct(parameter_ranges(problem.design())), count);
        for (const LineRow& row : report.along) report.largest_relative_error = std::max(report.largest_relative_error, told_error(row));
    }
    const std::vector<int> chosen = parameters_to_check(problem, at.gradient, options.most_parameters);
    std::vector<ParameterDifferences> found(n);
    CheckedDesign checked{at, {}};
    for (const problem::Run& run : at.runs) checked.contacts.push_back(contact_states(*run.model, run.simulation.trajectory));
    core::base::parallel_for(count_of(chosen), 1, [&](int i) {
        const int k = chosen[i];
        found[k] = ParameterCheck(problem, p, k, steps, options, checked).run(count);
    });
    const std::vector<bool> is_open = compare(problem, quantity_gradients(at), found, steps, options, report);
    report.contacts_reach = MatrixX::Zero(n, 2);
    for (int k = 0; k < n; ++k) {
        if (!std::binary_search(chosen.begin(), chosen.end(), k)) {
            report.left_out.push_back(problem.design().parameters[k].name);
            continue;
        }
        ParameterDifferences& differences = found[k];
        report.contacts_reach.row(k) = differences.contacts_reach.transpose();
        std::move(differences.contact_changes.begin(), differences.contact_changes.end(), std::back_inserter(report.contact_changes));
        report.interrupted = report.interrupted || differences.interrupted;
        if (is_open[k]) report.failures.push_back(problem.design().parameters[k].name + ": " + differences.failure);
    }
    std::stable_sort(report.contact_changes.begin(), report.contact_changes.end(),
                     [](const ContactChange& a, const ContactChange& b) { return a.share < b.share; });
    return report;
}

}  // namespace fettle::design::gradient_audit
