// SPDX-License-Identifier: MIT
#include "fettle/design/studies/difference_check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>

#include "fettle/core/base/contract.hpp"
#include "fettle/core/base/limits.hpp"
#include "fettle/core/base/parallel.hpp"

namespace fettle::design::studies {

namespace {

// Objective, then constraints.
VectorX quantities(const problem::DesignEvaluation& e) {
    VectorX q(static_cast<Eigen::Index>(e.constraints.size()) + 1);
    q[0] = e.objective;
    for (size_t i = 0; i < e.constraints.size(); ++i) q[static_cast<Eigen::Index>(i) + 1] = e.constraints[i].value;
    return q;
}

struct ParameterDifferences {
    std::vector<DifferenceEstimate> estimates;  ///< per quantity
    int simulations = 0;
    std::string failure;
    bool interrupted = false;
};

class ParameterCheck {
public:
    ParameterCheck(const problem::DesignProblem& problem, const VectorX& p, int parameter, const CheckOptions& options)
        : problem_(problem), p_(p), parameter_(parameter), options_(options) {}

    ParameterDifferences run() {
        const description::Parameter& parameter = problem_.design().parameters[static_cast<size_t>(parameter_)];
        const double range =
            parameter.upper > parameter.lower ? parameter.upper - parameter.lower : std::max(std::abs(parameter.value), 1e-6);
        double step = options_.first_step * range;
        for (int size = 0; size < options_.sizes; ++size, step /= options_.ratio) {
            add_difference(step);
            if (result_.interrupted || getting_worse()) break;
        }
        result_.estimates = estimates();
        return std::move(result_);
    }

private:
    // p +- step as the doubles they are: their distance is exact, not 2 step. Where a trial fails the sequence begins anew with the next
    // size: extrapolation needs one ratio throughout.
    void add_difference(double step) {
        VectorX above = p_, below = p_;
        above[parameter_] += step;
        below[parameter_] -= step;
        problem::EvaluateOptions options;
        options.gradients = false;
        options.should_stop = options_.should_stop;
        const problem::DesignEvaluation up = problem_.evaluate(above, options);
        const problem::DesignEvaluation down = up.usable ? problem_.evaluate(below, options) : problem::DesignEvaluation{};
        result_.simulations += 2;
        if (!up.usable || !down.usable) {
            result_.interrupted = up.interrupted || down.interrupted;
            result_.failure = up.usable ? down.reason : up.reason;
            differences_.clear();
            return;
        }
        result_.failure.clear();
        differences_.push_back((quantities(up) - quantities(down)) / (above[parameter_] - below[parameter_]));
    }

    std::vector<DifferenceEstimate> estimates() const {
        std::vector<DifferenceEstimate> result;
        if (differences_.empty()) return result;
        for (Eigen::Index q = 0; q < differences_.front().size(); ++q) {
            std::vector<double> column;
            for (const VectorX& d : differences_) column.push_back(d[q]);
            result.push_back(ridders_estimate(column, options_.ratio));
        }
        return result;
    }

    // All quantities' newest differences disagree more than those before: rounding has taken over.
    bool getting_worse() const {
        const size_t n = differences_.size();
        if (n < 4) return false;
        const VectorX now = (differences_[n - 1] - differences_[n - 2]).cwiseAbs(),
                      before = (differences_[n - 2] - differences_[n - 3]).cwiseAbs();
        return (now.array() >= 2 * before.array()).all();
    }

    const problem::DesignProblem& problem_;
    const VectorX& p_;
    int parameter_;
    const CheckOptions& options_;
    std::vector<VectorX> differences_;
    ParameterDifferences result_;
};

// Per quantity: scale_fraction * norm of the gradient in parameters scaled by their ranges.
VectorX comparison_scales(const MatrixX& adjoint, const VectorX& ranges, double fraction) {
    VectorX scales(adjoint.rows());
    for (Eigen::Index q = 0; q < adjoint.rows(); ++q) scales[q] = fraction * adjoint.row(q).transpose().cwiseProduct(ranges).norm();
    return scales;
}

}  // namespace

DifferenceEstimate ridders_estimate(const std::vector<double>& differences, double ratio) {
    FETTLE_ASSERT(!differences.empty() && ratio > 1, "differences of shrinking step size");
    DifferenceEstimate best{differences.front(), infinity};
    std::vector<double> previous, row;
    for (const double difference : differences) {
        row.assign(1, difference);
        double factor = ratio * ratio;
        for (size_t j = 1; j <= previous.size(); ++j, factor *= ratio * ratio) {
            row.push_back(row[j - 1] + (row[j - 1] - previous[j - 1]) / (factor - 1));
            const double error = std::max(std::abs(row[j] - row[j - 1]), std::abs(row[j] - previous[j - 1]));
            if (error < best.error) best = {row[j], error};
        }
        previous = row;
    }
    return best;
}

CheckReport check_gradients(const problem::DesignProblem& problem, const VectorX& p, const problem::DesignEvaluation& at,
                            const CheckOptions& options) {
    FETTLE_ASSERT(at.usable && at.gradient.size() == p.size(), "the gradients to check");
    const description::Design& design = problem.design();
    const int n = problem.parameter_count();
    std::vector<ParameterDifferences> found(static_cast<size_t>(n));
    std::mutex progress;
    int done = 0;
    core::base::parallel_for(n, 1, [&](int k) {
        found[static_cast<size_t>(k)] = ParameterCheck(problem, p, k, options).run();
        const std::lock_guard<std::mutex> lock(progress);
        if (options.on_parameter) options.on_parameter(++done, n);
    });

    CheckReport report;
    MatrixX adjoint(at.jacobian.rows() + 1, n);
    adjoint << at.gradient.transpose(), at.jacobian;
    VectorX ranges(n);
    for (int k = 0; k < n; ++k) {
        const description::Parameter& parameter = design.parameters[static_cast<size_t>(k)];
        ranges[k] = parameter.upper > parameter.lower ? parameter.upper - parameter.lower : std::max(std::abs(parameter.value), 1e-6);
    }
    const VectorX scales = comparison_scales(adjoint, ranges, options.scale_fraction);
    for (Eigen::Index q = 0; q < adjoint.rows(); ++q) {
        for (int k = 0; k < n; ++k) {
            const ParameterDifferences& differences = found[static_cast<size_t>(k)];
            if (differences.estimates.empty()) continue;
            const DifferenceEstimate& estimate = differences.estimates[static_cast<size_t>(q)];
            const double a = adjoint(q, k) * ranges[k], d = estimate.value * ranges[k];
            const double scale = std::max({std::abs(a), std::abs(d), scales[q]});
            CheckRow row;
            row.quantity = q == 0 ? "objective" : design.constraints[static_cast<size_t>(q) - 1].name;
            row.parameter = design.parameters[static_cast<size_t>(k)].name;
            row.adjoint = adjoint(q, k);
            row.difference = estimate.value;
            row.difference_error = scale > 0 ? estimate.error * ranges[k] / scale : 0;
            row.relative_error = scale > 0 ? std::abs(a - d) / scale : 0;
            report.largest_relative_error = std::max(report.largest_relative_error, row.relative_error);
            report.rows.push_back(std::move(row));
        }
    }
    for (int k = 0; k < n; ++k) {
        const ParameterDifferences& differences = found[static_cast<size_t>(k)];
        report.simulations += differences.simulations;
        report.interrupted = report.interrupted || differences.interrupted;
        if (differences.estimates.empty())
            report.failures.push_back(design.parameters[static_cast<size_t>(k)].name + ": " + differences.failure);
    }
    return report;
}

}  // namespace fettle::design::studies
