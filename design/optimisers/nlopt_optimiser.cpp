// SPDX-License-Identifier: MIT
#include "design/optimisers/nlopt_optimiser.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "design/optimisers/nlopt_library.hpp"

namespace fettle::design::optimisers {

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double constraint_tolerance = 1e-8;  // scaled; zero makes SLSQP answer wrongly with a success code
constexpr int most_restarts = 20;

// One constraint of NLopt's form, sign * (c[row] - bound) <= 0.
struct Side {
    int row;
    double sign;
    double bound;
};

// The C interface is used, with this as its context: the C++ one hides the cause of an exception.
struct Run {
    Evaluator& evaluator;
    nlopt_opt opt;
    bool stop_at_failure;
    bool derivative_free;
    std::vector<Side> inequalities, equalities;
    bool over = false;  ///< StopOptimisation was thrown
    bool failed = false;
    VectorX failed_point;

    const Evaluation* evaluate(unsigned n, const double* x) {
        if (over || (failed && stop_at_failure)) return nullptr;
        try {
            const VectorX point = Eigen::Map<const VectorX>(x, n);
            const Evaluation& e = derivative_free ? evaluator.values_at(point) : evaluator.at(point);
            if (e.usable) return &e;
            failed = true;
            failed_point = Eigen::Map<const VectorX>(x, n);
            if (stop_at_failure) nlopt_library().force_stop(opt);
        } catch (const StopOptimisation&) {  // must not pass through C code
            over = true;
            nlopt_library().force_stop(opt);
        }
        return nullptr;
    }
};

double objective(unsigned n, const double* x, double* gradient, void* data) {
    const Evaluation* e = static_cast<Run*>(data)->evaluate(n, x);
    if (gradient) Eigen::Map<VectorX>(gradient, n) = e ? e->gradient : VectorX(VectorX::Constant(n, not_a_number));
    return e ? e->objective : not_a_number;
}

void sides(Run& run, const std::vector<Side>& list, double* result, unsigned n, const double* x, double* gradient) {
    const Evaluation* e = run.evaluate(n, x);
    for (size_t k = 0; k < list.size(); ++k) {
        const Side& side = list[k];
        result[k] = e ? side.sign * (e->constraints[side.row] - side.bound) : not_a_number;
        if (!gradient) continue;
        for (unsigned i = 0; i < n; ++i) gradient[k * n + i] = e ? side.sign * e->jacobian(side.row, i) : not_a_number;
    }
}

void inequality_sides(unsigned, double* result, unsigned n, const double* x, double* gradient, void* data) {
    Run& run = *static_cast<Run*>(data);
    sides(run, run.inequalities, result, n, x, gradient);
}

void equality_sides(unsigned, double* result, unsigned n, const double* x, double* gradient, void* data) {
    Run& run = *static_cast<Run*>(data);
    sides(run, run.equalities, result, n, x, gradient);
}

nlopt_algorithm native(NloptAlgorithm algorithm) {
    switch (algorithm) {
        case NloptAlgorithm::mma:
            return NLOPT_LD_MMA;
        case NloptAlgorithm::ccsaq:
            return NLOPT_LD_CCSAQ;
        case NloptAlgorithm::slsqp:
            return NLOPT_LD_SLSQP;
        case NloptAlgorithm::cobyla:
            return NLOPT_LN_COBYLA;
    }
    return NLOPT_LD_MMA;
}

void list_sides(Run& run, bool with_equalities) {
    const VectorX& lower = run.evaluator.scaled_constraint_lower();
    const VectorX& upper = run.evaluator.scaled_constraint_upper();
    for (int i = 0; i < lower.size(); ++i) {
        if (with_equalities && lower[i] == upper[i]) {
            run.equalities.push_back({i, 1, lower[i]});
            continue;
        }
        if (std::isfinite(lower[i])) run.inequalities.push_back({i, -1, lower[i]});
        if (std::isfinite(upper[i])) run.inequalities.push_back({i, 1, upper[i]});
    }
}

struct NativeRun {
    nlopt_result result = NLOPT_FAILURE;
    bool over = false, failed = false;
    VectorX failed_point;
};

NativeRun run_native(NloptAlgorithm algorithm, Evaluator& evaluator, const OptimiserOptions& options, const VectorX& start,
                     const VectorX& lower, const VectorX& upper) {
    const auto n = static_cast<unsigned>(evaluator.variables());
    const NloptLibrary& nlopt = nlopt_library();
    const std::unique_ptr<nlopt_opt_s, void (*)(nlopt_opt)> opt(nlopt.create(native(algorithm), n), nlopt.destroy);
    const bool recovers = algorithm == NloptAlgorithm::mma || algorithm == NloptAlgorithm::ccsaq;
    Run run{evaluator, opt.get(), !recovers, algorithm == NloptAlgorithm::cobyla, {}, {}, false, false, {}};
    list_sides(run, algorithm == NloptAlgorithm::slsqp);
    nlopt.set_min_objective(opt.get(), objective, &run);
    const std::vector<double> tolerances(std::max(run.inequalities.size(), run.equalities.size()) + 1, constraint_tolerance);
    if (!run.inequalities.empty()) {
        nlopt.add_inequality_mconstraint(opt.get(), static_cast<unsigned>(run.inequalities.size()), inequality_sides, &run,
                                         tolerances.data());
    }
    if (!run.equalities.empty()) {
        nlopt.add_equality_mconstraint(opt.get(), static_cast<unsigned>(run.equalities.size()), equality_sides, &run, tolerances.data());
    }
    nlopt.set_lower_bounds(opt.get(), lower.data());
    nlopt.set_upper_bounds(opt.get(), upper.data());
    // One step's small change is not convergence (MMA's inner steps can be tiny): two orders below the tolerance asked for.
    nlopt.set_ftol_rel(opt.get(), 1e-2 * options.tolerance);
    nlopt.set_xtol_rel(opt.get(), 1e-2 * options.tolerance);
    nlopt.set_xtol_abs1(opt.get(), 1e-2 * options.tolerance);
    nlopt.set_initial_step1(opt.get(), 0.1);
    nlopt.set_maxeval(opt.get(), 20 * options.max_evaluations);  // the evaluator counts; this only ends a loop over cached points
    VectorX x = start;
    double value = 0;
    const nlopt_result result = nlopt.optimize(opt.get(), x.data(), &value);
    return {result, run.over, run.failed, run.failed_point};
}

const char* words(nlopt_result result) {
    switch (result) {
        case NLOPT_SUCCESS:
            return "success";
        case NLOPT_STOPVAL_REACHED:
            return "stop value reached";
        case NLOPT_FTOL_REACHED:
            return "the objective changes by less than the tolerance";
        case NLOPT_XTOL_REACHED:
            return "the parameters change by less than the tolerance";
        case NLOPT_MAXEVAL_REACHED:
            return "the most evaluations that are allowed were made";
        case NLOPT_ROUNDOFF_LIMITED:
            return "steps became so short that rounding hides what they gain";
        case NLOPT_INVALID_ARGS:
            return "invalid arguments";
        case NLOPT_OUT_OF_MEMORY:
            return "out of memory";
        case NLOPT_FORCED_STOP:
            return "stopped";
        default:
            return "failed";
    }
}

}  // namespace

std::string NloptOptimiser::name() const {
    switch (algorithm_) {
        case NloptAlgorithm::mma:
            return "mma";
        case NloptAlgorithm::ccsaq:
            return "ccsaq";
        case NloptAlgorithm::slsqp:
            return "slsqp";
        case NloptAlgorithm::cobyla:
            return "cobyla";
    }
    return "nlopt";
}

NativeOutcome NloptOptimiser::minimise(Evaluator& evaluator, const OptimiserOptions& options) const {
    const int n = evaluator.variables();
    if (n == 0) return {0, "no variables"};
    VectorX start = evaluator.best_scaled_point();
    double radius = 1;
    NativeOutcome outcome;
    for (int restart = 0; restart <= most_restarts; ++restart) {
        const Evaluator::Box steps = evaluator.steps_from(start, radius);
        const VectorX lower = start + steps.lower, upper = start + steps.upper;
        const int before = evaluator.evaluations();
        const NativeRun run = run_native(algorithm_, evaluator, options, start, lower, upper);
        outcome.iterations += evaluator.evaluations() - before;
        outcome.message = words(run.result);
        if (run.over) return outcome;
        const VectorX best = evaluator.best_scaled_point();
        if (run.failed && run.result == NLOPT_FORCED_STOP) {
            radius = 0.5 * std::min(radius, (run.failed_point - best).lpNorm<Eigen::Infinity>());
            start = best;
            if (radius < 1e-2 * options.tolerance) {
                outcome.message = "the designs next to the best one cannot be evaluated";
                return outcome;
            }
            continue;
        }
        // Rounding limits SLSQP at a good optimum as often as at a bad one; the verdict does not ask it (optimisation.hpp).
        const bool ended = run.result > 0 || run.result == NLOPT_ROUNDOFF_LIMITED;
        const VectorX moved = evaluator.step_between(start, best);
        bool at_box = false;
        for (int k = 0; k < n; ++k) {
            const bool has_walls = !evaluator.is_periodic(k);
            at_box = at_box || (moved[k] <= steps.lower[k] && !(has_walls && lower[k] <= 0)) ||
                     (moved[k] >= steps.upper[k] && !(has_walls && upper[k] >= 1));
        }
        if (ended && at_box) {
            radius = std::min(1.0, 2 * radius);
            start = best;
            continue;
        }
        return outcome;
    }
    outcome.message = "designs that cannot be evaluated stand in the way again and again";
    return outcome;
}

}  // namespace fettle::design::optimisers
